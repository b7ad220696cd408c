#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The response field against finite elements made for it: bench/truth/references.sh [FINENESS [CASE...]], the
# table of docs/accuracy.md. FINENESS: patch radius over the elements' edges at its rim, 10 if left out. All
# cases take an hour on one core, with 16 three times that. References stay in out/truth/FINENESS and are not
# made again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source tools/need.sh
need cmake make libeigen3-dev libbenchmark-dev gmsh libmumps-seq-dev
need_compiler
build bench palpate_bench_make_reference palpate_bench_truth_cases palpate_bench_judge_case

program=$PWD/build/bench/bench/palpate_bench_
fineness=${1:-10}
shift || true
out=out/truth/$fineness
mkdir -p "$out"
export OPENBLAS_NUM_THREADS=1  # its threads cost more than they save
cases=("$@")
[ ${#cases[@]} -gt 0 ] || mapfile -t cases < <("${program}make_reference")
for ((i = 0; i < ${#cases[@]}; ++i)); do
  case=${cases[i]}
  stage "$case ($((i + 1)) of ${#cases[@]})"
  if [ ! -f "$out/$case/done" ]; then
    "${program}make_reference" "$case" "$out/$case" "$fineness"
    touch "$out/$case/done"
  fi
  for order in "" linear; do
    [ -f "$out/$case/force${order:+_linear}.csv" ] || continue  # of a ball there is nothing linear
    "${program}truth_cases" "$out/$case" "$out/u.csv" "$out/f.csv" 600 $order >/dev/null
    "${program}judge_case" "$out/$case" "$out/u.csv" "$out/f.csv" $order | tee "$out/$case/errors${order:+_linear}.txt"
  done
done
stage ""
grep -H ^displacement "$out"/*/errors.txt
