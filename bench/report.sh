#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Writes out/bench/report.md to standard output: bench/report.sh COMMAND
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

table() {  # CSV file as a table
  awk -F, '{printf "|"; for (i = 1; i <= NF; ++i) printf " %s |", $i; print ""}
           NR == 1 {printf "|"; for (i = 1; i <= NF; ++i) printf " --- |"; print ""}' "$1"
}
# Flags of a program, from the compiler's own command line: the last -O is the one that counts.
flags() {
  grep -F "CMakeFiles/$1.dir/" build/bench/compile_commands.json | grep -m1 '"command"' |
    grep -oE ' -(O|march=|m|f|std=|D|g)[^ "]*' | tr -d '\n' || true
}

echo "# Benchmarks"
echo
echo "| | |"
echo "| --- | --- |"
echo "| machine | $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores, $(uname -sm) |"
load=$(cut -d' ' -f1-3 /proc/loadavg)
echo "| load at the end | $load: above 1 others used the machine, and times are upper bounds |"
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' build/bench/CMakeCache.txt)
echo "| compiler | $("$compiler" --version | head -1) |"
echo "| flags, times |$(flags palpate_bench_force_budget | sed "s/ -DSCALAR=double//") |"
echo "| flags, instruction counts |$(flags palpate_bench_skip_point | sed 's/-DCOMPOSITION=point//') |"
commit=$(git rev-parse --short HEAD 2>/dev/null || echo "none, not in git")
if git rev-parse HEAD >/dev/null 2>&1 && ! git diff --quiet HEAD; then commit+=", with changes"; fi
echo "| commit | $commit |"
echo "| command | \`$1\` |"
for file in out/bench/*.csv; do
  name=$(basename "$file" .csv)
  echo
  echo "## $name"
  echo
  if [ -f "out/bench/$name.png" ]; then
    echo "![$name]($name.png)"
    echo
  fi
  if [ -f "out/bench/$name.log" ]; then
    notes=$(grep -E "PASS|OFFENDERS|^slowest|^scheduling|^reading the clock" "out/bench/$name.log" |
      sed 's/^/- /' || true)
    if [ -n "$notes" ]; then
      echo "$notes"
      echo
    fi
  fi
  rows=$(wc -l <"$file")
  if [ "$rows" -gt 60 ]; then echo "<details><summary>$((rows - 1)) rows</summary>"; echo; fi
  table "$file"
  if [ "$rows" -gt 60 ]; then echo; echo "</details>"; fi
done
