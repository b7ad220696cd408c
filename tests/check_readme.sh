#!/bin/sh
# SPDX-License-Identifier: MIT
# check_readme.sh ROOT: programs shown in pages are those of examples/, which are built and run: in README.md
# examples/short/main.cpp and examples/minimal/main.cpp, in docs/device.md examples/openhaptics/main.cpp, in
# docs/resolved.md examples/resolved/main.cpp.
set -eu
cd "$1"
compare() {  # PAGE N PROGRAM MARK: the page's Nth code block is what stands between two lines `// [MARK]`
  wanted=$(sed -n "/^\/\/ \[$4\]\$/,/^\/\/ \[$4\]\$/p" "$3" | sed '1d;$d')
  shown=$(awk -v n="$2" '/^```cpp$/ { on = ++k == n; next } /^```$/ { on = 0 } on' "$1")
  if [ -z "$wanted" ] || [ "$wanted" != "$shown" ]; then
    echo "$1: the program is not the one in $3"
    exit 1
  fi
}
compare README.md 1 examples/short/main.cpp readme
compare README.md 2 examples/minimal/main.cpp minimal
compare docs/device.md 1 examples/openhaptics/main.cpp openhaptics
compare docs/resolved.md 1 examples/resolved/main.cpp resolved
