# SPDX-License-Identifier: MIT
# Plots of the benchmarks, run in out/bench/ by bench/run.
set datafile separator ","
set terminal pngcairo size 1000,640 font "Sans,12"
set grid
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set key left top

set output "force_budget.png"
set title "One force tick on an exact surface, double, ellipsoid with friction; 30 us is the budget"
set xlabel "points of the tool that touch"
set ylabel "time of a tick [us]"
set yrange [0.02:100]
row(s, r, p) = (stringcolumn(1) eq s && stringcolumn(3) eq "double" && stringcolumn(2) eq r) ? p : 1/0
plot 30 lw 2 dt 2 lc "red" title "budget", \
  "force_budget.csv" skip 1 using (column(4)):(row("back_to_back", "ellipsoid duffing fibre region", column(6))) with linespoints pt 7 title "one region, median", \
  "" skip 1 using (column(4)):(row("back_to_back", "ellipsoid duffing fibre region", column(8))) with linespoints pt 6 title "one region, 99.9 %", \
  "" skip 1 using (column(4)):(row("back_to_back", "ellipsoid duffing fibre regions<8>", column(6))) with points pt 9 title "8 regions, median", \
  "" skip 1 using (column(4)):(row("back_to_back", "ellipsoid duffing fibre regions<8>", column(8))) with points pt 8 title "8 regions, 99.9 %"

set output "growth.png"
set title "Growth with the display mesh: the force does not, the shape does, as a copy of its bytes"
set xlabel "vertices"
set ylabel "time [us]"
set yrange [0.1:*]
only(p) = column(3) == 100 ? p : 1/0
plot "growth.csv" skip 1 using (column(1)):(only(column(5))) with linespoints pt 7 title "force, 100 points", \
  "" skip 1 using (column(1)):(only(column(6))) with linespoints pt 7 title "shape", \
  "" skip 1 using (column(1)):(only(column(7))) with linespoints pt 7 title "shape and normals", \
  "" skip 1 using (column(1)):(only(column(9))) with lines dt 2 lc "black" title "plain copy of the positions"
