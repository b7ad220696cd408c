# SPDX-License-Identifier: MIT
# Panels of run time against error; `name`, `columns`, `panel` (width), `unit` and `headline` say which.
load here."/common.gp"
set datafile separator "\t"
count = int(system("cat ".data."/".name.".count"))
rows = (count + columns - 1) / columns
set terminal pngcairo size panel*columns, 430*rows + 40 font "Sans,10"
set output name.".png"
set logscale xy
set format x "10^{%T}"
set xlabel "time [".unit."]"
set key outside right top Left reverse samplen 2 font ",9" width -2
array warm[8] = ["#d62728", "#ff7f0e", "#9a0a2b", "#e377c2", "#b8860b", "#ff5050", "#8c3b00", "#f5a3a3"]
array cold[10] = ["#1f77b4", "#17becf", "#2ca02c", "#6a51a3", "#08306b", "#74a9cf", "#66a61e", "#807dba", "#41b6c4", "#444444"]
lines(file) = int(system("wc -l < ".file))
line(file, i) = system(sprintf("sed -n %dp %s", i, file))
set multiplot layout rows,columns title headline
do for [i=1:count] {
  base = sprintf("%s/%s.%d", data, name, i)
  set title line(base.".name", 1)
  plot base.".front" using 1:2 with steps lw 6 lc rgb "#cccccc" title "Pareto front", \
    for [j=1:lines(base.".ours")] sprintf("%s.ours.%d", base, j) using 1:2 with linespoints pt 7 ps 1.1 lw 2 lc rgb warm[(j-1)%8+1] \
      title line(base.".ours", j), \
    for [j=1:lines(base.".theirs")] sprintf("%s.theirs.%d", base, j) using 1:2 with linespoints pt 6 ps 1 dt 3 lc rgb cold[(j-1)%10+1] \
      title line(base.".theirs", j)
}
unset multiplot
