# SPDX-License-Identifier: MIT
name = "work_precision_shape"
columns = 2
unit = "us per tick"
headline = "Deformed shape against nonlinear finite elements, mean over depths of 1, 2, 4 and 8 mm: down and to the left is better"
set ylabel "relative L2 error of the surface's displacement"
set yrange [0.01:3]
set xrange [0.5:1e6]
set ytics ("1 %%" 0.01, "2 %%" 0.02, "5 %%" 0.05, "10 %%" 0.1, "20 %%" 0.2, "50 %%" 0.5, "100 %%" 1, "200 %%" 2)
set label 1 "nothing drawn" at graph 0.02, first 1.3 font ",9" tc rgb "#666666"
set arrow 1 from graph 0, first 1 to graph 1, first 1 nohead dt 2 lc rgb "black"
panel = 950
load here."/work_precision.gp"
