# SPDX-License-Identifier: MIT
# Pictures of pressure.csv and tactile.csv: gnuplot -e "folder='out'" tactile.gp
points = folder.'/pressure.csv'
taxels = folder.'/tactile.csv'
set datafile separator ','
set border lc rgb '#666666'
set tics scale 0.4
set palette defined (0 '#f7fbff', 0.2 '#9ecae1', 0.5 '#3182bd', 0.8 '#08306b', 1 '#000000')
set cblabel 'pressure [kPa]'
set xlabel 'x [mm]' offset 0, 0.5
set size ratio -1
unset key
stats points using 4 nooutput prefix 'points'
stats taxels using 4 nooutput prefix 'taxels'
bar = "if (last) { set colorbox user origin 0.938, 0.17 size 0.011, 0.6 } else { unset colorbox }"

# ---- points, of three of the six moments: tilted, part slips, all slips
array moment[3] = [3, 4, 5]
do for [m=1:3] {  # before the axes have ranges, which stats heeds
  stats points index moment[m] using 1:6 nooutput prefix sprintf("down%d", m)
  stats points index moment[m] using 5:8 nooutput prefix sprintf("along%d", m)
}
do for [i=0:5] { stats taxels index i using 1 nooutput prefix sprintf("image%d", i) }
of(name, m, what) = value(sprintf("%s%d_%s", name, m, what))
set terminal pngcairo size 1240,470 font 'sans,11'
set output folder.'/pressure.png'
set multiplot layout 1,3 margins 0.05,0.925,0.1,0.84 spacing 0.03 title \
  "A tilted fingertip is dragged along x: pressure at its points; arrows: friction on it; red rings: slips"
set cbrange [0:1e-3*points_max]
set xrange [-9:13]
set yrange [-11:11]
set ylabel 'z [mm]' offset 1
do for [m=1:3] {
  i = moment[m]
  last = m == 3
  eval bar
  set title sprintf("%.0f ms: %.2f N down, %.2f N along; %d of %d points slip", 1e3*of('down', m, 'max_x'), \
    of('down', m, 'sum_y'), -of('along', m, 'sum_x'), of('along', m, 'records')-of('along', m, 'sum_y'), \
    of('along', m, 'records')) font ',10'
  plot points index i using (1e3*$2):(1e3*$3):(1e-3*$4) with points pt 7 ps 2.3 lc palette, \
    '' index i using (1e3*$2):($8 == 0 ? 1e3*$3 : NaN) with points pt 6 ps 2.4 lw 1.5 lc rgb '#c0392b', \
    '' index i using (1e3*$2):(1e3*$3):(100*$5):(100*$7) with vectors size 0.5,20 filled \
      lw 1.2 lc rgb '#e67e22'
  unset ylabel
  set format y ''
}
unset multiplot

# ---- images
set terminal pngcairo size 1500,340 font 'sans,11'
set output folder.'/tactile.png'
set multiplot layout 1,6 margins 0.04,0.93,0.14,0.8 spacing 0.01 title \
  "What a tactile sensor on the finger reads: down until 200 ms, tilted until 300 ms, dragged until 600 ms"
set cbrange [0:1e-3*taxels_max]
set xrange [-11.2:11.2]
set yrange [-11.2:11.2]
set ylabel 'z [mm]' offset 1
set format y '%g'
do for [i=0:5] {
  last = i == 5
  eval bar
  set title sprintf("%.0f ms", 1e3*value(sprintf("image%d_max", i))) font ',10'
  plot taxels index i every ::(i == 0) using (1e3*$2):(1e3*$3):(1e-3*$4) with image
  unset ylabel
  set format y ''
}
unset multiplot
