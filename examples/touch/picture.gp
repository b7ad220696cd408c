# SPDX-License-Identifier: MIT
# Puts legend and caption around the rendered frames: gnuplot -e "folder='out/heart'" picture.gp
frames = folder.'/frames/'
load frames.'legend.gp'
set datafile separator ','
list = frames.'frames.csv'
stats list using 2 skip 1 nooutput
n = STATS_records

unset border
unset xtics
unset ytics
unset key
set cbrange [0:most]
set cblabel 'displacement [mm]'
set size ratio -1
set lmargin at screen 0
set rmargin at screen 0.86
set tmargin at screen 0.92
set bmargin at screen 0.07
set colorbox user origin 0.875, 0.15 size 0.025, 0.7
set title title offset 0, -0.4

# The line of frames.csv that belongs to the picture, and the picture. The one point outside brings the colour box.
caption(t, F, u) = sprintf('t = %.2f s     |F| = %.2f N     largest displacement %.2f mm', t, F, u)
number(i, column) = real(word(system(sprintf("awk -F, 'NR==%d{print $%d}' %s", i + 2, column, list)), 1))
draw(i) = caption(number(i, 2), number(i, 3), number(i, 5))
arrow = sprintf('green: force on the tool, %g mm per N; shape as it is, not enlarged', per_newton)

set terminal pngcairo size 1000,700 font 'sans,13'
set output folder.'/shape.png'
set label 1 draw(key_number) at screen 0.03, 0.045
set label 2 arrow at screen 0.03, 0.018 font ',10'
plot frames.'key.png' binary filetype=png with rgbimage, NaN palette

set terminal gif animate delay 12 loop 0 size 560,400 font 'sans,9'
set output folder.'/animation.gif'
unset label 2
do for [i=0:n-1] {
  set label 1 draw(i) at screen 0.03, 0.035
  plot sprintf('%sframe_%03d.png', frames, i) binary filetype=png with rgbimage, NaN palette
}
