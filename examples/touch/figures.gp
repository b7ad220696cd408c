# SPDX-License-Identifier: MIT
# The pictures of README and docs/paper.md, the paper's model left and the response field right, after
# `examples/run --paper` and `examples/run --scene all`: gnuplot -e "out='out'; to='docs/figures'" figures.gp
model = 'paper .'
array name[2]; name[1] = "as the paper has it"; name[2] = "response field"
red = '#c0392b'; blue = '#1f618d'; green = '#1e8449'
set datafile separator ','

# ---- shapes
set terminal pngcairo size 1240,440 font 'sans,10'
unset border; unset xtics; unset ytics; unset key; unset colorbox
array scene[3]; array figure[3]
scene[1] = 'ellipsoid'; scene[2] = 'cube-tail'; scene[3] = 'heart'
figure[1] = 'figure10_shape'; figure[2] = 'figure11_shape'; figure[3] = 'figure12_shape'
do for [k=1:3] {
  set output to.'/'.figure[k].'.png'
  set multiplot layout 1,2 margins 0,1,0,1 spacing 0
  set size ratio -1
  do for [m=1:2] {
    plot out.'/'.word(model, m).'/'.scene[k].'/shape.png' binary filetype=png with rgbimage
  }
  unset multiplot
}
set size noratio
set border; set xtics; set ytics

# ---- curves
set grid lc rgb '#dddddd'
set key left top reverse Left samplen 1.5
set terminal pngcairo size 1100,560 font 'sans,10'
set output to.'/figure10.png'
set multiplot layout 2,2 columnsfirst margins 0.06,0.985,0.09,0.94 spacing 0.06,0.06
do for [m=1:2] {
  data = out.'/'.word(model, m).'/ellipsoid/forces.csv'
  set xrange [1:6]
  set format x ''; unset xlabel
  set title name[m]
  set ylabel 'normal force [N]'
  plot data using 1:5 with lines lw 1.4 lc rgb red title 'F_x', \
       data using 1:6 with lines lw 1.4 lc rgb blue title 'F_y', \
       data using 1:7 with lines lw 1.4 lc rgb green title 'F_z'
  set format x '%g'; set xlabel 'time [s]'; unset title
  set ylabel 'friction [N]'
  plot data using 1:8 with lines lw 1.4 lc rgb red title 'f_x', \
       data using 1:9 with lines lw 1.4 lc rgb blue title 'f_y', \
       data using 1:10 with lines lw 1.4 lc rgb green title 'f_z'
}
unset multiplot

set terminal pngcairo size 1100,400 font 'sans,10'
set output to.'/figure11.png'
set multiplot layout 1,2 margins 0.06,0.985,0.13,0.91 spacing 0.08
set xrange [0:1.2]; set yrange [0:*]
set xlabel 'force [N]'
do for [m=1:2] {
  head = out.'/'.word(model, m).'/cube-head/contacts.csv'
  tail = out.'/'.word(model, m).'/cube-tail/contacts.csv'
  set title name[m]
  set ylabel m == 1 ? 'modified D = w D [mm]' : 'D [mm]'
  plot tail using 7:(1e3*$11) with lines lw 2 lc rgb red title 'tail, radius 10 mm', \
       head using 7:(1e3*$11) with lines lw 2 lc rgb blue title 'head, radius 30 mm'
}
unset multiplot

set output to.'/figure12.png'
set multiplot layout 1,2 margins 0.06,0.985,0.13,0.91 spacing 0.08
set xrange [1:7]
set xlabel 'time [s]'; set ylabel 'force on the pin [N]'
do for [m=1:2] {
  data = out.'/'.word(model, m).'/heart/contacts.csv'
  set title name[m]
  plot sprintf("< awk -F, 'NR > 1 && $3 < 0.018' %s", data) using 1:7 with lines lw 2 lc rgb red title 'first pin', \
       sprintf("< awk -F, 'NR > 1 && $3 > 0.018' %s", data) using 1:7 with lines lw 2 lc rgb blue title 'second pin'
}
unset multiplot
