# SPDX-License-Identifier: MIT
load here."/common.gp"
set terminal pngcairo size 900,600 font "Sans,11"
set output "growth.png"
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set key top left Left reverse samplen 2
set title "Growth with the display mesh: force is to stay flat, shape to grow no faster than a copy of its bytes"
set xlabel "vertices"
set ylabel "time [us]"
# The tool with fewest points.
small = system("awk -F, 'NR > 1 && (!n || $3 < n) {n = $3} END {print n}' growth.csv")
of(column) = "< awk -F, '$3 == \"".small."\" {print $1 \",\" $".column."}' growth.csv"
plot of("4") using 1:2 with linespoints pt 5 lc rgb "#9467bd" title "detection", \
  of("5") using 1:2 with linespoints pt 7 lc rgb ours title "force, in one thread with the shape", \
  of("11") using 1:2 with linespoints pt 6 lc rgb ours title "force, another thread draws", \
  of("6") using 1:2 with linespoints pt 9 lc rgb theirs title "shape", \
  of("7") using 1:2 with linespoints pt 11 lc rgb "#2ca02c" title "shape and normals", \
  of("12") using 1:2 with linespoints pt 8 lc rgb theirs title "shape, linear, vertices sorted by face", \
  of("9") using 1:2 with lines dt 2 lw 2 lc rgb "black" title "plain copy of the same bytes"
