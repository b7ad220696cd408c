#!/bin/sh
# SPDX-License-Identifier: MIT
# check_readme.sh ROOT: programs shown in pages are those of examples/, which are built and run: in README.md
# examples/minimal/main.cpp, in docs/device.md examples/openhaptics/main.cpp.
set -eu
cd "$1"
compare() {  # PAGE PROGRAM MARK: the page's first code block is what stands between two lines `// [MARK]`
  wanted=$(sed -n "/^\/\/ \[$3\]\$/,/^\/\/ \[$3\]\$/p" "$2" | sed '1d;$d')
  shown=$(awk '/^```cpp$/ { on = 1; next } /^```$/ { if (on) exit } on' "$1")
  if [ -z "$wanted" ] || [ "$wanted" != "$shown" ]; then
    echo "$1: the program is not the one in $2"
    exit 1
  fi
}
compare README.md examples/minimal/main.cpp readme
compare docs/device.md examples/openhaptics/main.cpp openhaptics
