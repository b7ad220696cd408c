# SPDX-License-Identifier: MIT
# The bodies of tests/support/response_bodies.hpp, each pressed by a patch (shape_error/bodies.hpp), fixed below.
set terminal pngcairo size 1500,760 font "Sans,11" background rgb "white"
set output "bodies.png"
array names[8] = ["torus", "L", "plate, lying", "plate, standing", "two spheres", "box", "bowl", "block with a hole"]
array way[8] = [4, 4, 1, 2, 4, 4, 3, 4]
array drawn[8] = [3, 3, 3, 6, 3, 3, 4, 3]
array size_of[8] = [1.6, 1.25, 1.4, 1.2, 1.7, 1.05, 1.1, 1.1]
set multiplot layout 2, 4 title "Response field: pressed by one patch; colour: displacement by the tool's way"
unset key; unset border; unset tics; unset colorbox
set view equal xyz
set pm3d depthorder border lc rgb "#a0a0a0" lw 0.1
set palette defined (0 "#f7fbff", 0.15 "#9ecae1", 0.5 "#3182bd", 1 "#08306b")
set cbrange [0:1]
do for [b = 1:8] {
  if (b == 8) { set colorbox; set cbtics 0.5 }
  set view 60, 35, size_of[b]
  set title sprintf("%s: %g mm, drawn %g times", names[b], way[b], drawn[b])
  k = drawn[b]
  splot sprintf("< awk 'NF {mine = $1 == %d} mine' bodies.tsv", b - 1) \
    using ($2 + k * $5):(-$4 - k * $7):($3 + k * $6):8 with pm3d
}
unset multiplot
