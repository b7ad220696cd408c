# SPDX-License-Identifier: MIT
# Sourced by examples/run. `render FOLDER PLOTS` turns the frames of a scene into FOLDER/shape.png and
# FOLDER/animation.gif; PLOTS is this folder.

render() {
  local folder=$1 here=$2 frame key
  local frames=$folder/frames
  # Render small, for the animation; then the frame that stands for all once more, large.
  local count=0 all=("$frames"/frame_*.pov)
  echo "rendering      ${#all[@]} pictures"
  for frame in "${all[@]}"; do
    count=$((count + 1))
    if [ -t 1 ]; then printf '\rpicture        %d of %d' "$count" "${#all[@]}"; fi
    ray "$frame" 480 360
  done
  if [ -t 1 ]; then echo; fi
  key=$(sed -n "s/^key = '\(.*\)'/\1/p" "$frames/legend.gp")
  ray "$frames/frame_$key.pov" 960 720 "$frames/key.png"
  gnuplot -e "folder='$folder'" "$here/picture.gp"
  echo "wrote          $folder/shape.png, $folder/animation.gif"
}

# ray FILE.pov WIDTH HEIGHT [FILE.png]
ray() {
  local png=${4:-${1%.pov}.png}
  (cd "$(dirname "$1")" && povray -D -GA +A0.2 +W"$2" +H"$3" +I"$1" +O"$png" >povray.log 2>&1) ||
    { tail -20 "$(dirname "$1")/povray.log" >&2; return 1; }
}

# figure NAME FILE: the paper's figure over several scenes; uses $plots and $out.
figure() {
  gnuplot -e "out='$out'" "$plots/$1.gp"
  echo "wrote          $2"
}
