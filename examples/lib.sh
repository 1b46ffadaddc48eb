# SPDX-License-Identifier: LGPL-2.1-or-later
# What the example scripts share. Sourced, not run.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build-release}")
program=$(basename "$0")

fail() {
  echo "$program: $*" >&2
  exit 1
}

# Installs what is missing and builds the elements, without tests, into a folder of their own.
build_elements() {
  "$root/tests/setup.sh"
  if [[ ! -f $build/build.ninja ]]; then
    meson setup "$build" "$root" --buildtype=release -Dtests=disabled -Dbenchmarks=disabled
  fi
  ninja -C "$build"
}

# Runs a command where the elements are found without being installed, in the caller's folder.
in_build() { meson devenv -C "$build" --workdir "$PWD" "$@"; }

# Fails with a clear word when the file can't be read; prints its absolute path otherwise.
readable_file() {
  [[ -e $1 ]] || fail "no such file: $1"
  [[ -f $1 ]] || fail "not a file: $1"
  [[ -r $1 ]] || fail "no permission to read: $1"
  [[ -s $1 ]] || fail "the file is empty: $1"
  realpath "$1"
}
