#!/bin/sh
# SPDX-License-Identifier: MIT
# check_house.sh ROOT: the rules of the house that a script can check, over include/, tests/ and docs/.
# Prints file:line: what is wrong, and fails if there was anything.
set -eu
cd "$1"

# Reading order of the folders; each includes only those before it and itself. What lies in detail/, setup/ or
# tick/ is the folder's machinery: only the folder itself includes it, and the machinery of other folders.
layers="core geometry display detection contact law elasticity luo_xiao response resolved solver device calibrate"
layers="$layers touch adapters"

version=$(awk '$2 ~ /^PALPATE_VERSION_(MAJOR|MINOR|PATCH)$/ { v = v "." $3 } END { print substr(v, 2) }' \
  include/palpate/version.hpp)

report=$(mktemp)
trap 'rm -f "$report"' EXIT
{
  find include -name '*.hpp' | sort | xargs awk -v layers="$layers" '
    function bad(what) { print FILENAME ":" FNR ": " what }
    function end_of_file() {
      if (!once) print last ": no #pragma once"
      if (!file) print last ": no /// @file sentence"
      if (lines > 400) print last ": " lines " lines; a header is read in one sitting, at most 400"
    }
    BEGIN {
      n = split(layers, names, " ")
      for (i = 1; i <= n; i++) rank[names[i]] = i
      while ((getline line < "docs/references.bib") > 0)
        if (match(line, /^@[a-z]+[{][^,]+,/)) {
          sub(/^@[a-z]+[{]/, "", line); sub(/,.*/, "", line)
          if (line in key) print "docs/references.bib: " line " is there twice"
          key[line] = 1
        }
    }
    FNR == 1 {
      if (last != "") end_of_file()
      last = FILENAME; once = file = lines = 0
      split(FILENAME, part, "/")
      folder = part[3] ~ /[.]hpp$/ ? "" : part[3]
      if (folder != "" && !(folder in rank)) bad("folder " folder " is not in the list of layers")
      if ($0 != "// SPDX-License-Identifier: MIT") bad("the first line is not the licence")
    }
    { lines = FNR }
    /^#pragma once/ { once = 1 }
    /^\/\/\/ @file / { file = 1 }
    /[(][?][)]/ { bad("a reference is still to be filled in") }
    /TODO|FIXME|XXX/ { bad("unfinished") }
    {
      rest = $0
      while (match(rest, /\[[a-z]+[12][0-9][0-9][0-9][a-z]?\]/)) {
        k = substr(rest, RSTART + 1, RLENGTH - 2)
        if (!(k in key)) bad("[" k "] is not in docs/references.bib")
        rest = substr(rest, RSTART + RLENGTH)
      }
    }
    /^#include/ {
      if ($2 ~ /^"/) bad("include with <>, not with quotes")
      if ($2 ~ /^<(iostream|mutex|shared_mutex|condition_variable|future|Eigen\/Dense)>/)
        bad($2 " has no place in a header")
      if (match($2, /^<palpate\/[a-z_]+\//)) {
        other = substr($2, 10, RLENGTH - 10)
        if (folder == "" && FILENAME ~ /\/(config|version)[.]hpp$/)
          bad("this header stands below all folders")
        if ((folder in rank) && (other in rank) && rank[other] > rank[folder])
          bad(folder "/ includes " other "/, which comes after it")
        machinery = "/(detail|setup|tick)/"
        if (other != folder && $2 ~ machinery && FILENAME !~ machinery) bad($2 " is machinery of " other "/")
      }
      if ($2 == "<palpate/palpate.hpp>") bad("the umbrella is for users")
      next
    }
    {
      code = $0
      sub(/\/\/.*/, "", code)
      gsub(/"[^"]*"/, "\"\"", code)
      if (code ~ /(^|[^_A-Za-z0-9])(thread_local|errno|std::(cout|cerr|mutex|isnan|isfinite|isinf))([^_A-Za-z0-9]|$)/)
        bad("state, I/O, lock, or a test that -ffast-math removes")
      if (code ~ /[.]stableNorm[(]/)
        bad("the last digit of stableNorm depends on where its vector lies: stable_norm")
      # `static` is for functions and constants: what stands before the first bracket must not be a variable.
      before = code
      gsub(/operator[^(]*/, "", before)
      sub(/[(].*/, "", before)
      if (before ~ /(^|[ \t])(static|inline)[ \t].*[=;{]/ &&
          before !~ /constexpr|consteval|inline[ \t]+(namespace|const)[ \t]/)
        bad("static state")
      if (code ~ /std::(min|max)[(]|>::(min|max)[(][)]/)
        bad("parenthesise (std::min) and (std::numeric_limits<S>::max): Windows has macros of these names")
    }
    END { end_of_file() }
  '

  # Lines that a page shows whole. A table that does not fit becomes two.
  LC_ALL=C.UTF-8 grep -rnE --include='*.hpp' --include='*.md' '.{111}' include docs README.md |
    sed -E 's/^([^:]*:[0-9]*):.*/\1: more than 110 columns/' || true

  # The version is stated once.
  grep -rnF --include='*.hpp' --include='CMakeLists.txt' --include='*.cmake' --include='*.json' --include='*.md' \
    --exclude='CHANGELOG.md' --exclude-dir=build --exclude-dir=out "$version" . |
    grep -E "(^|[^0-9.])$(echo "$version" | sed 's/[.]/[.]/g')([^0-9.]|\$)" |
    sed 's/$/: the version is stated in version.hpp alone/' || true

  # Mutants by hand name lines that are there.
  if [ -f tests/mutants/by_hand.txt ]; then
    awk '
      /^#/ || /^[+]/ || /^$/ { next }
      /^- / {
        line = substr($0, 3); found = 0
        while ((getline code < path) > 0) { gsub(/^[ \t]+|[ \t]+$/, "", code); found += code == line }
        close(path)
        if (found != 1) print FILENAME ":" FNR ": " path " has this line " found " times"
        next
      }
      { path = "include/palpate/" $0 }
    ' tests/mutants/by_hand.txt
  fi

  # How tests compare.
  grep -rnE --include='*.hpp' --include='*.cpp' 'doctest::Approx|[^a-zA-Z_]Approx[(]' tests |
    sed 's/$/: CHECK_RELATIVE or CHECK_ABSOLUTE, with a tolerance that says why/' || true
  grep -rnE --include='*.hpp' --include='*.cpp' 'random_device|std::rand[(]|srand[(]' tests |
    sed 's/$/: seeded generators only/' || true
} >"$report"

cat "$report"
[ ! -s "$report" ]
