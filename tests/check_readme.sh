#!/bin/sh
# SPDX-License-Identifier: MIT
# check_readme.sh ROOT: the program in README.md is examples/minimal/main.cpp, which is built and run.
set -eu
cd "$1"
wanted=$(sed -n '/^\/\/ \[readme\]$/,/^\/\/ \[readme\]$/p' examples/minimal/main.cpp | sed '1d;$d')
shown=$(awk '/^```cpp$/ { on = 1; next } /^```$/ { if (on) exit } on' README.md)
if [ "$wanted" != "$shown" ]; then
  echo "README.md: the program is not the one in examples/minimal/main.cpp"
  exit 1
fi
