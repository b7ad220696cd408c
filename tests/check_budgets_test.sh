#!/bin/sh
# SPDX-License-Identifier: MIT
# check_budgets_test.sh DIRECTORY: shows that the benchmarks' budgets refuse what is over them, with tables
# made in DIRECTORY.
set -eu
bench=$(cd "$(dirname "$0")/../bench" && pwd)
rm -rf "$1"
mkdir -p "$1"
cd "$1"

failures=0
passes() {  # COMMAND...
  "$@" >report || { echo "FAILED: refused: $*"; cat report; failures=1; }
}
refuses() {  # MESSAGE COMMAND...
  message=$1
  shift
  if "$@" >report; then
    echo "FAILED: accepted, expected: $message"
    failures=1
  elif ! grep -qF "$message" report; then
    echo "FAILED: expected '$message', got:"
    cat report
    failures=1
  fi
}

counts() {  # INSTRUCTIONS HEAP
  echo "scene,composition,state_bytes,instructions_per_tick,heap_allocations,binary_bytes"
  echo "contact,point,8,$1,$2,1000"
}
{ echo "# why"; echo "scene,composition,instructions"; echo "contact,point,1000"; } >budgets.csv
counts 1000 0 >counts.csv
passes "$bench/skip/check" counts.csv budgets.csv
counts 1001 0 >counts.csv
refuses "contact point takes 1001 instructions, budget 1000" "$bench/skip/check" counts.csv budgets.csv
counts 1000 2 >counts.csv
refuses "contact point allocated on the heap 2 times" "$bench/skip/check" counts.csv budgets.csv
counts 1000 0 | sed 's/point/region/' >counts.csv
refuses "contact region has no budget" "$bench/skip/check" counts.csv budgets.csv
: >counts.csv
refuses "no counts" "$bench/skip/check" counts.csv budgets.csv

slowest() {  # MICROSECONDS, or nothing where no position was met often enough
  echo "scene,composition,scalar,points,regions,empty_p50_us,own_p50_us,own_max_us,mean_force_N"
  echo "back_to_back,sphere,double,1,1,0.1,0.1,0.12,1"
  echo "back_to_back,box,float,1000,8,1,20,$1,1"
}
slowest 29.9 >times.csv
passes "$bench/force_budget/check" times.csv
slowest 30.1 >times.csv
refuses "back_to_back, box, float, 1000 points: slowest position 30.1 us, budget 30" \
  "$bench/force_budget/check" times.csv
slowest "" | sed 2d >times.csv
refuses "no solver has a slowest position" "$bench/force_budget/check" times.csv

# The counts that were accepted last keep to the budgets themselves.
{ sed 1,2d "$bench/skip/baseline.csv" | awk -F, 'BEGIN {print "header"} {print $1 "," $2 ",0," $3 ",0,0"}'; } >counts.csv
passes "$bench/skip/check" counts.csv "$bench/skip/budgets.csv"
[ $failures -eq 0 ] && echo "All as it should be."
exit $failures
