#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Plots of out/bench/*.csv, beside them.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../out/bench"
data=$(mktemp -d)
trap 'rm -r "$data"' EXIT

# Work against precision: a file per case and method, and the Pareto front, the points that no other beats in
# both. split CSV X Y: $data/CSV.I.name, .front, .ours and .theirs (names of the methods), .ours.J and
# .theirs.J (time, error). Method names of the library begin with "palpate". Its float rows are methods of
# their own, those of others are left out.
split() {
  awk -F, -v x="$2" -v y="$3" -v data="$data/$1" '
    NR == 1 || !($x > 0 && $y > 0) || $y == "inf" {next}
    {
      whose = $2 ~ /^palpate/ ? "ours" : "theirs"
      if ($3 == "float" && whose == "theirs") next
      if (!($1 in n)) {n[$1] = ++count; print $1 >(data "." count ".name")}
      base = data "." n[$1]
      method = $2
      sub(/^palpate /, "", method)
      if (data ~ /shape/) {
        sub(/ResponseField [0-9]+/, "ResponseField", method)  # one model with several sizes or settings
        sub(/ [0-9]+( x [0-9]+)? (sweeps|steps)$/, "", method)
      }
      if ($3 == "float" && data !~ /shape/) method = method ", float"
      id = base SUBSEP whose SUBSEP method
      if (!(id in m)) {m[id] = ++methods[base, whose]; print (whose == "ours" ? "ours: " : "") method >(base "." whose)}
      print $x "\t" $y >(base "." whose "." m[id])
      print $x "\t" $y >(base ".all")
    }
    END {print count + 0}' "$1.csv" >"$data/$1.count"
  for all in "$data/$1".*.all; do
    [ -f "$all" ] || continue
    sort -g -k1,1 -k2,2 "$all" | awk -F'\t' 'NR == 1 || $2 < best {print; best = $2}' >"${all%.all}.front"
    for whose in ours theirs; do  # gnuplot's loop runs once at least
      if [ ! -f "${all%.all}.$whose" ]; then echo >"${all%.all}.$whose"; echo "NaN NaN" >"${all%.all}.$whose.1"; fi
    done
  done
}
if [ -f work_precision_force.csv ]; then split work_precision_force 5 6; fi
if [ -f work_precision_shape.csv ]; then split work_precision_shape 6 7; fi
for plot in force_budget mesh work_precision_force work_precision_shape shape_error bodies growth skip; do
  if [ -f "$plot.csv" ] || [ -f "$plot.tsv" ]; then gnuplot -e "data='$data'; here='$here/plots'" "$here/plots/$plot.gp"; fi
done
