# SPDX-License-Identifier: MIT
load here."/common.gp"
set terminal pngcairo size 1150,560 font "Sans,11"
set output "force_budget.png"
set logscale xy
set yrange [0.02:3000]
set xrange [0.7:1500]
set xlabel "points of the tool that touch"
set ylabel "time of a force tick [us]"
set key top left Left reverse samplen 2
rows(scene, name, column) = sprintf("< awk -F, '$1 == \"%s\" && $2 == \"%s\" && $3 == \"double\" {print $4 \",\" $%d}' force_budget.csv", \
  scene, name, column)
point = "ellipsoid duffing fibre point"
one = "ellipsoid duffing fibre region"
eight = "ellipsoid duffing fibre regions<8>"
set multiplot layout 1,2 title "One force tick: ellipsoid, Duffing law, friction, double precision"
do for [scene in "back_to_back paced_1kHz"] {
  set title (scene eq "back_to_back" ? "back to back" : "paced at 1 kHz: caches used by others in between")
  plot 30 with lines lw 2 dt 2 lc rgb "black" title "budget, 30 us for 99.9 %", \
    rows(scene, point, 6) using 1:2 with points pt 9 ps 1.6 lc rgb theirs title "a point: median", \
    rows(scene, point, 8) using 1:2 with points pt 8 ps 1.6 lc rgb theirs title "a point: 99.9 %", \
    rows(scene, one, 6) using 1:2 with linespoints pt 7 lc rgb ours title "1 region: median", \
    rows(scene, one, 8) using 1:2 with linespoints pt 6 dt 3 lc rgb ours title "1 region: 99.9 %", \
    rows(scene, eight, 6) using 1:2 with linespoints pt 5 lc rgb "#9467bd" title "8 regions: median", \
    rows(scene, eight, 8) using 1:2 with linespoints pt 4 dt 3 lc rgb "#9467bd" title "8 regions: 99.9 %", \
    "<printf '1,0.1\n100,1\n'" using 1:2 with points pt 2 ps 2 lw 2 lc rgb "black" title "budgets of the median"
}
unset multiplot
