#!/bin/sh
# SPDX-License-Identifier: MIT
# check_docs_test.sh DIRECTORY: shows that check_docs.sh finds each kind of mistake, in a tree made in
# DIRECTORY.
set -eu
check=$(cd "$(dirname "$0")" && pwd)/check_docs.sh
rm -rf "$1"
mkdir -p "$1/include/palpate/law/detail" "$1/tests/unit" "$1/docs"
cd "$1"
header=include/palpate/law/concept.hpp
printf 'namespace palpate {\nconcept Law = true;\nnamespace detail {\nconcept Hidden = true;\n}  // namespace detail\nstruct Spring;\n}\n' >$header
echo 'concept Hidden = true;' >include/palpate/law/detail/hidden.hpp
printf '// [extending]\nstruct Mine {};\n// [extending]\n' >tests/unit/mine_test.cpp
printf '| law | `Law` | `law/concept.hpp` |\n\n```cpp\nstruct Mine {};\n```\n' >docs/extending.md
printf '| code | file | test |\n| --- | --- | --- |\n| `Spring::Law` | `law/concept.hpp` | `unit/mine_test.cpp` |\n' >docs/notation.md
echo 'Run `out/bench/x.sh`; see `concept.hpp`, `docs/`, `law/detail/` and `N/m`.' >README.md
"$check" . || { echo "FAILED: a good tree is refused"; exit 1; }

failures=0
expect() {  # expect MESSAGE FILE LINE: with this line at the end of the file check_docs.sh must refuse, with this message
  cp "$2" kept
  printf '%b\n' "$3" >>"$2"
  if "$check" . >report; then
    echo "FAILED: accepted, expected: $1"
    failures=1
  elif ! grep -qF "$1" report; then
    echo "FAILED: expected '$1', got:"
    cat report
    failures=1
  fi
  mv kept "$2"
}
expect 'concept Other has no row in docs/extending.md' $header 'concept Other = true;'
expect 'no test has this code between two lines // [extending]' docs/extending.md '```cpp\nstruct Other {};\n```'
expect 'the code above is not in docs/extending.md' tests/unit/mine_test.cpp '// [extending]\nstruct Other {};\n// [extending]'
expect 'there is no unit/other_test.cpp' docs/notation.md '`unit/other_test.cpp`'
expect 'there is no other.hpp' docs/extending.md 'See `other.hpp`.'
expect 'there is no law/other/' README.md '`law/other/`'
expect "Mass is in none of this row's files" docs/notation.md '| `Spring`, `Mass` | `law/concept.hpp` | |'
expect "Spring is in none of this row's files" docs/notation.md '| `Spring` | `law/detail/hidden.hpp` | |'
exit $failures
