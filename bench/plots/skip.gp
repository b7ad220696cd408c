# SPDX-License-Identifier: MIT
load here."/common.gp"
set terminal pngcairo size 1100,560 font "Sans,11"
set output "skip.png"
set logscale y
set format y "10^{%T}"
set yrange [1:*]
set style data histogram
set style histogram clustered gap 1
set style fill solid 0.9 noborder
set boxwidth 0.9
set xtics rotate by -25
set key top left
set title "Instructions of a tick: what an absent policy and an idle phase save"
set ylabel "instructions"
of(scene) = "< awk -F, '$1 == \"".scene."\" {n = $2; gsub(\"_\", \" \", n); print n \",\" $4}' skip.csv"
plot of("contact") using 2:xtic(1) lc rgb ours title "in contact, moving", \
  of("nothing_moved") using 2 lc rgb "#ff9896" title "in contact, nothing moved", \
  of("out_of_reach") using 2 lc rgb theirs title "out of reach"
