#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# A video through all stages, on the CPU and with the kernels on the host (kernels/shim): the same
# objects, regions and vectors, byte for byte.
#
# usage: whole_clip.sh VIDEO [FRAMES [WIDTH HEIGHT]]   (default 100 frames of 384x288; BUILD_DIR as
# for run.sh)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build}")
video=$(realpath "${1:?usage: whole_clip.sh VIDEO [FRAMES [WIDTH HEIGHT]]}")
frames=${2:-100}
size=video/x-raw,width=${3:-384},height=${4:-288}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Cut out and scaled once: which frame is the last before an early end is a matter of chance.
gst-launch-1.0 -q filesrc location="$video" ! decodebin ! identity eos-after="$frames" ! \
  videoconvert ! videoscale ! "$size" ! jpegenc quality=95 ! avimux ! \
  filesink location="$folder/clip.avi"

run_on() {  # BACKEND
  "$build/tests/kernels/launch-on-host" filesrc location="$folder/clip.avi" ! decodebin ! \
    videoconvert ! regiontrack backend="$1" ! \
    regionwrite format=graph location="$folder/$1.graph" ! \
    regionwrite format=jsonl location="$folder/$1.jsonl" ! fakesink sync=false
}

run_on cpu
run_on cuda
for lines in graph jsonl; do
  cmp "$folder/cpu.$lines" "$folder/cuda.$lines"
done
objects=$(grep -c '"id":' "$folder/cpu.jsonl") || true
echo "$(wc -l <"$folder/cpu.jsonl") frames, $objects of them with objects: the same on both"
((objects > 0))
