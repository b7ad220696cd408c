# SPDX-License-Identifier: MIT
# The paper's Fig. 11, from the scenes cube-head and cube-tail: gnuplot -e "out='out'" fig11.gp
set datafile separator ','
set terminal pngcairo size 900,560 font 'sans,12'
set output out.'/fig11.png'
set grid lc rgb '#dddddd'
set key left top reverse Left samplen 2
set xrange [0:1.2]
set yrange [0:*]
set xlabel 'force [N]'
set ylabel 'modified D = w D [mm]'
set title 'Fig. 11: the same force through a mallet''s head (radius 30 mm) and tail (10 mm) on a cube'
head = out.'/cube-head/contacts.csv'
tail = out.'/cube-tail/contacts.csv'
plot tail using 7:(1e3*$11) with lines lw 2.2 lc rgb '#c0392b' title 'tail', \
     head using 7:(1e3*$11) with lines lw 2.2 lc rgb '#1f618d' title 'head', \
     head using 7:(1e3*$8) with lines lw 1.2 dt 2 lc rgb '#888888' title 'D of both, without the local neighbourhood''s w'
