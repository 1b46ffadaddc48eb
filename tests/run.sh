#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds everything and runs all tests. Its last line is "N passed, N failed", with ", N skipped"
# where tests were skipped. Exits with an error when a test failed or none ran.
#
# usage: run.sh [arguments of meson test]          for example: run.sh --suite core
#        run.sh --gpu [PART...]                    what a GPU is needed for: tests/kernels/on_gpu.sh
# BUILD_DIR: the build folder (default: build in the repository); MESON_ARGS: for meson setup.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build}")
"$root/tests/setup.sh"

read -r -a setup_arguments <<<"${MESON_ARGS:-}"
[[ ${1:-} != --gpu ]] || setup_arguments+=(-Dcuda=enabled)
if [[ -f $build/build.ninja ]]; then
  ((${#setup_arguments[@]} == 0)) || meson configure "$build" "${setup_arguments[@]}"
else
  # What packagers are not to be held to.
  meson setup "$build" "$root" -Dwerror=true -Doptimization=3 "${setup_arguments[@]}"
fi
if [[ ${1:-} == --gpu ]]; then
  BUILD_DIR=$build "$root/tests/kernels/bundle.sh" "$build/gpu"
  exec "$build/gpu/on_gpu.sh" "${@:2}"
fi
ninja -C "$build"

log=$build/meson-logs/testlog.json
rm -f "$log"
status=0
meson test -C "$build" --no-rebuild --print-errorlogs "$@" || status=$?
/usr/bin/python3 "$root/tests/summary.py" "$log" || status=1
exit "$status"
