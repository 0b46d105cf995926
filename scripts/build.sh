# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by ./taut, ./taut-check, ./taut-python and ./test, with `root` set to the source tree: builds build/release
# when it is out of date. Anything that goes wrong here exits with 4, taut's code for an internal failure.
# shellcheck shell=bash
# shellcheck disable=SC2154  # root

build=$root/build/release
log=$root/build/release.log
stamp=$build/.built # as old as the start of the last good build; holds the path of the tree that it was made from

# Whether the programs exist and are newer than everything that they are made of. It takes a few milliseconds at every
# start. Directories count too, so that an added or removed file is noticed.
is_current() {
  local built_from newer room rooms=()
  [[ -x $build/cli/taut && -x $build/checker/taut-check && -r $stamp ]] || return
  read -r built_from <"$stamp" && [[ $built_from == "$root" ]] || return
  for room in "$root"/*/CMakeLists.txt; do
    [[ $room == "$root"/@(bench|tests)/* ]] || rooms+=("${room%/*}")
  done
  newer=$(find "${rooms[@]}" "$root"/{cmake,scripts} "$root"/CMake{Lists.txt,Presets.json} "$root/package-lock.json" \
    -newer "$stamp" -print -quit 2>/dev/null) || return
  [[ -z $newer ]]
}

# Whether the Python module is there, too, and was built from the same sources as the programs, or later ones.
is_python_current() {
  is_current && [[ -r $stamp-python && ! $stamp -nt $stamp-python ]] &&
    [[ -z $(find "$root/python" -newer "$stamp-python" -not -path '*/__pycache__*' -print -quit 2>/dev/null) ]]
}

# build_release_now [CMAKE_OPTION…] -- [TARGET…]; no target means all.
build_release_now() {
  local options=()
  while [[ $1 != -- ]]; do
    options+=("$1")
    shift
  done
  shift
  # Depends on what the compiler says it read: preprocessing each file first would take a third of a build.
  if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$root CCACHE_DEPEND=1
    [[ -n ${HOME:-} ]] || export CCACHE_DIR=$root/build/ccache
  fi
  # A tree that was moved or copied can't go on with the old directory.
  if [[ -f $build/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$build/CMakeCache.txt"; then
    rm -rf "$build"
  fi
  mkdir -p "$build"
  echo "$root" >"$stamp.new"
  cd "$root" || return
  cmake --preset release "${options[@]}" && cmake --build "$build" --parallel "$(nproc)" ${1:+--target "$@"} &&
    mv "$stamp.new" "$stamp"
}

# under_lock COMMAND…: runs it while no other start builds this tree; output to stderr and to the log.
# A subshell, so that the lock's descriptor is gone when it ends.
under_lock() (
  set -o pipefail
  mkdir -p "$root/build" && exec 9>"$root/build/.lock" || exit 4
  flock 9
  "$@" 2>&1 </dev/null | tee "$log" >&2
)

# install_for GROUP…: Debian's packages of these groups, and npm's.
install_for() {
  "$root/scripts/install-packages" "$@" && "$root/scripts/install-web"
}

build_programs() {
  is_current && return # another start has built it while this one waited
  echo "building taut in $build (first use, or newer sources) ..."
  local tests=()
  [[ -f $build/CMakeCache.txt ]] || tests=(-DTAUT_TESTS=OFF) # ./test turns them on
  install_for build && build_release_now "${tests[@]}" -- taut taut-check
}

build_python() {
  is_python_current && return
  echo "building taut's Python module in $build (first use, or newer sources) ..."
  local tests=()
  [[ -f $build/CMakeCache.txt ]] || tests=(-DTAUT_TESTS=OFF)
  install_for build python && build_release_now "${tests[@]}" -DTAUT_PYTHON=ON -- taut taut-check taut_python &&
    cp -p "$stamp" "$stamp-python"
}

build_all() {
  install_for build test python && build_release_now -DTAUT_TESTS=ON -DTAUT_PYTHON=ON -- &&
    cp -p "$stamp" "$stamp-python"
}

# or_exit_4 COMMAND…
or_exit_4() {
  "$@" && return
  echo "${0##*/}: the build failed; its output is above and in $log" >&2
  exit 4
}
