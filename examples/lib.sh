# SPDX-License-Identifier: LGPL-2.1-or-later
# What the example scripts share. Sourced, not run.
# shellcheck shell=bash

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(dirname "$here")
build=$(realpath -m "${BUILD_DIR:-$root/build-release}")
program=$(basename "$0")

fail() {
  echo "$program: $*" >&2
  exit 1
}

# Whether the scripts lie in the source tree; a copy elsewhere runs with the installed elements.
is_source() { [[ -x $root/tests/setup.sh && -f $root/meson.build ]]; }

# Installs what is missing and builds the elements, without tests, into a folder of their own.
build_elements() {
  if ! is_source; then
    gst-inspect-1.0 regiontrack >/dev/null 2>&1 ||
      fail 'the elements are not installed: see the README, or run this in the source tree'
    return
  fi
  "$root/tests/setup.sh"
  if [[ ! -f $build/build.ninja ]]; then
    meson setup "$build" "$root" --buildtype=release -Dtests=disabled -Dbenchmarks=disabled \
      -Dcuda=disabled
  fi
  ninja -C "$build"
}

# The same with the benchmarks and what else the report on the paper runs.
build_tools() {
  "$root/tests/setup.sh"
  if [[ ! -f $build/build.ninja ]]; then
    meson setup "$build" "$root" --buildtype=release -Dtests=enabled -Dbenchmarks=enabled \
      -Dcuda=disabled -Dintrospection=disabled
  fi
  local targets=(gst/plugin/libgstregiongraph.so gst/overlay/libgstregiongraphoverlay.so
    tests/benchmarks/bench{,-areas} tests/kernels/kernel-model)
  [[ ! -f $root/tests/benchmarks/search_windows.cpp ]] ||
    targets+=(tests/benchmarks/search-windows)
  ninja -C "$build" "${targets[@]}"
}

# Runs a command where the elements are found without being installed, in the caller's folder.
in_build() {
  if is_source; then
    meson devenv -C "$build" --workdir "$PWD" "$@"
  else
    "$@"
  fi
}

# Fails with a clear word when the file can't be read; prints its absolute path otherwise.
readable_file() {
  [[ -e $1 ]] || fail "no such file: $1"
  [[ -f $1 ]] || fail "not a file: $1"
  [[ -r $1 ]] || fail "no permission to read: $1"
  [[ -s $1 ]] || fail "the file is empty: $1"
  realpath "$1"
}
