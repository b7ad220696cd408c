#!/bin/sh
# SPDX-License-Identifier: MIT
# check_house_test.sh DIRECTORY: shows that check_house.sh finds each kind of mistake, in a tree made in
# DIRECTORY.
set -eu
check=$(cd "$(dirname "$0")" && pwd)/check_house.sh
rm -rf "$1"
mkdir -p "$1/include/palpate/core" "$1/include/palpate/law" "$1/include/palpate/elsewhere" "$1/tests" "$1/docs"
cd "$1"
printf '@book{known2000,\n}\n' >docs/references.bib
{
  printf '// SPDX-License-Identifier: MIT\n#pragma once\n/// @file  Version.\n'
  printf '#define PALPATE_VERSION_%s\n' 'MAJOR 7' 'MINOR 6' 'PATCH 5'
} >include/palpate/version.hpp
echo 'A page.' >README.md
header() {
  { printf '// SPDX-License-Identifier: MIT\n#pragma once\n/// @file  A header. [known2000]\n'; cat; } >"include/palpate/$1"
}

header core/good.hpp <<'END'
#include <palpate/core/other.hpp>
static_assert(true);  // std::isnan and std::mutex in a comment are not code
static constexpr int answer = 42;
static int function(int x = 1);
[[nodiscard]] static bool operator==(int, int) { return (std::min)(1, 2) == 1; }
inline constexpr int other = 1;
END
"$check" . || { echo "FAILED: a good tree is refused"; exit 1; }

failures=0
expect() {  # expect MESSAGE: check_house.sh must refuse the tree as it is now, with this message
  if "$check" . >report; then
    echo "FAILED: accepted, expected: $1"
    failures=1
  elif ! grep -qF "$1" report; then
    echo "FAILED: expected '$1', got:"
    cat report
    failures=1
  fi
}
expect_line() {  # expect_line MESSAGE LINE: the same for a header of core/ with this line
  printf '%s\n' "$2" | header core/bad.hpp
  expect "$1"
  rm include/palpate/core/bad.hpp
}
expect_line 'core/ includes law/, which comes after it' '#include <palpate/law/force.hpp>'
expect_line '<palpate/law/detail/force.hpp> is machinery of law/' '#include <palpate/law/detail/force.hpp>'
expect_line 'include with <>' '#include "other.hpp"'
expect_line '<iostream> has no place in a header' '#include <iostream>'
expect_line '<Eigen/Dense> has no place in a header' '#include <Eigen/Dense>'
expect_line 'the umbrella is for users' '#include <palpate/palpate.hpp>'
expect_line '[unknown1999] is not in docs/references.bib' '/// Source: [known2000], [unknown1999].'
expect_line 'a reference is still to be filled in' '/// Source: paper eq. (?)'
expect_line 'unfinished' '// TODO: the rest'
expect_line 'static state' 'static int counter = 0;'
expect_line 'static state' '  static const Table table = make();'
expect_line 'static state' 'inline int counter = 0;'
expect_line 'state, I/O, lock' 'thread_local int counter;'
expect_line 'state, I/O, lock' '  if (std::isnan(x)) return;'
expect_line 'depends on where its vector lies' '  return v.stableNorm();'
expect_line 'parenthesise (std::min)' '  return std::min(a, b);'
expect_line 'parenthesise (std::min)' '  return std::numeric_limits<S>::max();'

expect_line 'more than 110 columns' "// $(printf '%0108d' 0)"

header elsewhere/bad.hpp </dev/null
expect 'folder elsewhere is not in the list of layers'
rm include/palpate/elsewhere/bad.hpp

awk 'BEGIN { for (i = 0; i < 400; i++) print "// line" }' | header core/bad.hpp
expect '403 lines; a header is read in one sitting'
printf 'int x();\n' >include/palpate/core/bad.hpp
expect 'the first line is not the licence'
expect 'no #pragma once'
expect 'no /// @file sentence'
rm include/palpate/core/bad.hpp

echo 'project(palpate VERSION 7.6.5)' >CMakeLists.txt
expect 'the version is stated in version.hpp alone'
rm CMakeLists.txt
echo 'CHECK(x == doctest::Approx(1));' >tests/bad_test.cpp
expect 'CHECK_RELATIVE or CHECK_ABSOLUTE'
echo 'std::mt19937 random(std::random_device{}());' >tests/bad_test.cpp
expect 'seeded generators only'
rm tests/bad_test.cpp
mkdir tests/mutants
printf 'core/good.hpp\n- static constexpr int answer = 42;\n+ static constexpr int answer = 43;\n' >tests/mutants/by_hand.txt
"$check" . || { echo "FAILED: a mutant of a line that is there is refused"; failures=1; }
printf -- '- static constexpr int answer = 41;\n+\n' >>tests/mutants/by_hand.txt
expect 'core/good.hpp has this line 0 times'
rm -r tests/mutants
printf '@book{known2000,\n}\n' >>docs/references.bib
expect 'known2000 is there twice'
exit $failures
