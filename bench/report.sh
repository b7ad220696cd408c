#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Writes out/bench/report.md to standard output: bench/report.sh COMMAND
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

table() {  # CSV file as a table
  awk -F, '{printf "|"; for (i = 1; i <= NF; ++i) printf " %s |", $i; print ""}
           NR == 1 {printf "|"; for (i = 1; i <= NF; ++i) printf " --- |"; print ""}' "$1"
}
setting() { sed -n "s/^$1:[A-Z]*=//p" build/bench/CMakeCache.txt; }

echo "# Benchmarks"
echo
echo "| | |"
echo "| --- | --- |"
echo "| machine | $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores, $(uname -sm) |"
echo "| load while writing this | $(cut -d' ' -f1-3 /proc/loadavg) |"
echo "| compiler | $("$(setting CMAKE_CXX_COMPILER)" --version | head -1) |"
echo "| flags | $(setting CMAKE_CXX_FLAGS_RELEASE) $(setting CMAKE_CXX_FLAGS) -std=c++20 |"
echo "| commit | $(git rev-parse --short HEAD 2>/dev/null || echo none)$(git diff --quiet HEAD 2>/dev/null || echo ", with changes") |"
echo "| command | \`$1\` |"
echo
for file in out/bench/*.csv; do
  name=$(basename "$file" .csv)
  echo "## $name"
  echo
  table "$file"
  echo
  if [ -f "out/bench/$name.log" ]; then
    grep -E "PASS|OFFENDERS|^scheduling|over the budget" "out/bench/$name.log" | sed 's/^ */- /' || true
    echo
  fi
  if [ -f "out/bench/$name.png" ]; then echo "![$name]($name.png)"; echo; fi
done
