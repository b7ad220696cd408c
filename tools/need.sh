# SPDX-License-Identifier: MIT
# Sourced by the run scripts. `need NAME...` makes sure that each Debian package NAME, or a command of that
# name, is there, and installs what is missing with apt-get. It also has the small things that those scripts
# share.

# stage TEXT: a heading, with the seconds that the stage before it took.
stage() {
  if [ -n "${stage_name:-}" ]; then echo "== $stage_name: $((SECONDS - stage_start)) s"; fi
  stage_name=$1
  stage_start=$SECONDS
  if [ -n "$1" ]; then echo "== $1"; fi
}

need() {
  local name missing=()
  for name in "$@"; do
    command -v "$name" >/dev/null 2>&1 || dpkg -s "$name" >/dev/null 2>&1 || missing+=("$name")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  if ! command -v apt-get >/dev/null 2>&1; then
    echo "Missing: ${missing[*]} (names of Debian packages). Install them and run this again." >&2
    return 1
  fi
  local root=()
  if [ "$(id -u)" -ne 0 ]; then root=(sudo); fi
  echo "Installing ${missing[*]} with apt-get${root[0]:+, as root through sudo}"
  # apt-get may find the lock held by the machine's own updates just after it started.
  local apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300)
  if [ -z "${package_lists:-}" ]; then "${apt[@]}" update </dev/null || return 1; fi
  package_lists=fresh
  "${apt[@]}" install -y --no-install-recommends "${missing[@]}" </dev/null || return 1
}

# need_compiler: a C++20 compiler, the one that CXX names or g++ 12 or newer, is in CXX afterwards.
need_compiler() {
  if [ -n "${CXX:-}" ]; then return 0; fi
  need g++ || return 1
  CXX=g++
  if [ "$(g++ -dumpversion | cut -d. -f1)" -lt 12 ]; then  # Ubuntu 22.04 has 11 under this name
    need g++-12 || return 1
    CXX=g++-12
  fi
  export CXX
}

# build PRESET TARGET...: configures and builds build/PRESET with one job per core.
build() {
  local preset=$1
  shift
  mkdir -p build
  # A build tree keeps its compiler: start afresh when CXX names another one.
  local cache=build/$preset/CMakeCache.txt
  if [ -n "${CXX:-}" ] && [ -f "$cache" ] &&
    ! grep -qxF "CMAKE_CXX_COMPILER:FILEPATH=$(command -v "$CXX")" "$cache"; then
    rm -r "build/$preset"
  fi
  # Where ccache is installed, what has been compiled once is taken from it.
  if command -v ccache >/dev/null 2>&1; then
    export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
    export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS-pch_defines,time_macros}
  fi
  echo "Configuring build/$preset"
  cmake --preset "$preset" >"build/$preset.log" 2>&1 || { cat "build/$preset.log" >&2; return 1; }
  cmake --build "build/$preset" --parallel "$(nproc)" --target "$@"
}
