# SPDX-License-Identifier: MIT
# The paper's Fig. 12, forces at both pins over time: gnuplot -e "out='out'" fig12.gp
set datafile separator ','
set terminal pngcairo size 1000,560 font 'sans,12'
set output out.'/heart/fig12.png'
set grid lc rgb '#dddddd'
set key left top reverse Left samplen 2
set xrange [0:*]
set yrange [0:*]
set xlabel 'time [s]'
set ylabel 'force on the pin [N]'
set title 'Fig. 12: a compass touches a heart with one pin, then with both'
data = out.'/heart/contacts.csv'
first = sprintf("< awk -F, 'NR > 1 && $3 < 0.018' %s", data)   # column 3: where on the tool
second = sprintf("< awk -F, 'NR > 1 && $3 > 0.018' %s", data)
plot first using 1:7 with lines lw 2 lc rgb '#c0392b' title 'first pin', \
     second using 1:7 with lines lw 2 lc rgb '#1f618d' title 'second pin'
