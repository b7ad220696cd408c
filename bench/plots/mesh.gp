# SPDX-License-Identifier: MIT
load here."/common.gp"
set terminal pngcairo size 900,600 font "Sans,11"
set output "mesh.png"
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set key top left samplen 2
set title "A mesh as the elastic object: tool of 1,000 points, about 80 touch"
set xlabel "triangles"
set ylabel "time [us]"
plot "mesh.csv" skip 1 using 1:6 with linespoints pt 7 lc rgb ours title "force tick on the mesh, median", \
  "" skip 1 using 1:9 with linespoints pt 5 lc rgb "#2ca02c" title "force tick on its samples, median", \
  "" skip 1 using 1:($5/1000) with linespoints pt 9 lc rgb theirs title "one closest point", \
  "" skip 1 using 1:3 with linespoints pt 11 lc rgb "#9467bd" title "refit, 1 in 100 vertices moved", \
  "" skip 1 using 1:4 with linespoints pt 13 lc rgb "#8c564b" title "refit, all moved"
