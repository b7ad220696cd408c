#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Contact references by finite elements: bench/truth/contact.sh FINENESS [FILE|CHECK...]
# FILE: a case (bench/truth/case_file.hpp), those of bench/truth/data/contact if left out. CHECK: hertz,
# elliptic, "rounded punch", cattaneo: against closed forms. FINENESS: 3 takes minutes a case on one core.
# Results are in out/contact/FINENESS.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source tools/need.sh
# With the BLAS that comes with MUMPS it takes three times as long.
need cmake make libeigen3-dev libbenchmark-dev gmsh libmumps-seq-dev libopenblas0-serial
need_compiler
build bench palpate_bench_make_reference

program=$PWD/build/bench/bench/palpate_bench_make_reference
fineness=$1
shift
[ $# -gt 0 ] || set -- bench/truth/data/contact/*/case.txt
export OPENBLAS_NUM_THREADS=1
for case in "$@"; do
  if [ -f "$case" ]; then
    name=$(basename "${case%.txt}")
    [ "$name" != case ] || name=$(basename "$(dirname "$case")")
    "$program" --case "$case" "out/contact/$fineness/$name" "$fineness"
  else
    "$program" --check "$case" "out/contact/$fineness/$case" "$fineness"
  fi
done
