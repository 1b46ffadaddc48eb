#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Lays all that tests and measures the kernels on a GPU into a folder, with the libraries that it
# needs beside those of the C library and the driver: for a machine without packages of ours.
# There: FOLDER/on_gpu.sh
#
# usage: bundle.sh FOLDER
# BUILD_DIR: a build folder with CUDA (default: build in the repository).
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build}")
(($# == 1)) || { sed -n '3,8s/^# \?//p' "$0"; exit 2; }
folder=$1

programs=(tests/kernels/parity-gpu tests/kernels/backend-gpu tests/benchmarks/bench-gpu
  tests/kernels/kernel-model)
ninja -C "$build" "${programs[@]}" >/dev/null ||
  { echo 'bundle: the build has no CUDA: meson setup -Dcuda=enabled' >&2; exit 1; }

mkdir -p "$folder/lib"
for program in "${programs[@]}"; do
  cp "$build/$program" "$folder"
  ldd "$build/$program" | awk '$2 == "=>" && $3 ~ /^\// { print $3 }'
done | sort -u | while read -r library; do
  case ${library##*/} in
    libc.so.* | libm.so.* | libpthread.so.* | libdl.so.* | librt.so.*) ;;
    *) cp -L "$library" "$folder/lib" ;;
  esac
done
cp "$root/tests/kernels/on_gpu.sh" "$folder"
git -C "$root" rev-parse HEAD >"$folder/commit" 2>/dev/null || rm -f "$folder/commit"
du -sh "$folder"
