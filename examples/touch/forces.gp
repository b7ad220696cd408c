# SPDX-License-Identifier: MIT
# Plots forces.csv as the paper's Fig. 10: gnuplot -e "folder='out'" forces.gp
set datafile separator ','
set terminal pngcairo size 1000,620 font 'sans,11'
set output folder.'/forces.png'
set multiplot layout 2,1 margins 0.09,0.86,0.1,0.95 spacing 0.06
set grid lc rgb '#dddddd'
set key outside right top samplen 1.5
set xrange [0:*]
set format x ''
set ylabel 'normal force [N]'
data = folder.'/forces.csv'
plot data using 1:5 with lines lw 1.6 lc rgb '#c0392b' title 'F_x', \
     data using 1:6 with lines lw 1.6 lc rgb '#1f618d' title 'F_y', \
     data using 1:7 with lines lw 1.6 lc rgb '#1e8449' title 'F_z'
set format x '%g'
set xlabel 'time [s]'
set ylabel 'friction [N]'
plot data using 1:8 with lines lw 1.6 lc rgb '#c0392b' title 'f_x', \
     data using 1:9 with lines lw 1.6 lc rgb '#1f618d' title 'f_y', \
     data using 1:10 with lines lw 1.6 lc rgb '#1e8449' title 'f_z'
