# SPDX-License-Identifier: MIT
# Rows: bodies. Columns: how far the surface moves, where two models are wrong, a section. In percent of the tool's displacement.
set terminal pngcairo size 1500,800 font "Sans,11" background rgb "white"
set output "shape_error.png"
fields = "shape_error.tsv"
way = 4.0
array names[2] = ["ellipsoid", "cube"]
length(x, y, z) = 100 / way * sqrt(x * x + y * y + z * z)
set multiplot layout 2, 4 title "Tool pressed 4 mm into rubber: predicted against nonlinear finite elements"
unset key
do for [body = 0:1] {
  set view equal xyz
  set view 55, 30, (body == 0 ? 1.45 : 0.95)
  unset border; unset tics; set colorbox
  set palette defined (0 "#f7fbff", 0.15 "#9ecae1", 0.5 "#3182bd", 1 "#08306b")
  set cbrange [0:100]; set cbtics format "%g %%"
  set title names[body + 1].": how far it moves (finite elements)"
  splot fields index body using 1:(-$3):2:(length($4, $5, $6)) with points pt 7 ps (body == 0 ? 0.7 : 0.6) palette
  set palette defined (0 "#dcdcdc", 0.03 "#e8dcd8", 0.2 "#fcbba1", 0.5 "#fb6a4a", 1 "#67000d")
  set cbrange [0:10]
  set title "error of HalfSpaceDeformation"
  splot fields index body using 1:(-$3):2:(length($7 - $4, $8 - $5, $9 - $6)) with points pt 7 ps (body == 0 ? 0.7 : 0.6) palette
  set title "error of ResponseField, 600 vertices"
  splot fields index body using 1:(-$3):2:(length($10 - $4, $11 - $5, $12 - $6)) with points pt 7 ps (body == 0 ? 0.7 : 0.6) palette
  unset view; set border; set tics
  set title "slice |z| < 3 mm under the tool [mm]"
  set key bottom center
  set xrange [-30:30]
  near(z) = abs(z) < 3 ? 1 : NaN
  set yrange [body == 0 ? 30 : 92 : body == 0 ? 41 : 101]
  plot fields index body using ($1 * near($3)):2 with points pt 7 ps 0.3 lc rgb "#bbbbbb" title "at rest", \
    fields index body using (($1 + $4) * near($3)):($2 + $5) with points pt 6 ps 0.9 lc rgb "black" title "finite elements", \
    fields index body using (($1 + $7) * near($3)):($2 + $8) with points pt 2 ps 0.6 lc rgb "#1f77b4" title "half-space", \
    fields index body using (($1 + $10) * near($3)):($2 + $11) with points pt 7 ps 0.4 lc rgb "#d62728" title "response field"
  unset key; set autoscale x; set autoscale y
}
unset multiplot
