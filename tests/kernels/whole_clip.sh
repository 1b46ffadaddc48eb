#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# A video through all stages, on the CPU and with the kernels on the host (kernels/shim): the same
# objects, regions and vectors, byte for byte. A tenth of its frames also as before a moving camera,
# and by the stages' other methods.
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

# Decoded and scaled once. After an early end a decoder's threads may pass frames for a while: no
# more are read than are asked for.
gst-launch-1.0 -q filesrc location="$video" ! decodebin ! identity eos-after="$frames" ! \
  videoconvert ! videoscale ! "$size" ! jpegenc quality=95 ! \
  multifilesink location="$folder/%05d.jpg"

launch() {  # FRAMES ELEMENT...
  local last=$(($1 - 1))
  shift
  "$build/tests/kernels/launch-on-host" multifilesrc location="$folder/%05d.jpg" \
    stop-index="$last" caps=image/jpeg,framerate=10/1 ! jpegdec ! videoconvert ! "$@" ! \
    fakesink sync=false
}
run_on() {  # BACKEND
  launch "$frames" regiontrack backend="$1" ! \
    regionwrite format=graph location="$folder/$1.graph" ! \
    regionwrite format=jsonl location="$folder/$1.jsonl"
}
run_moving_on() {  # BACKEND
  local on=backend=$1
  launch $((frames / 10 + 2)) hsvsegment scope=frame max-regions=200 "$on" ! srg "$on" ! \
    prmmotion "$on" ! mrfmerge "$on" ! regionwrite location="$folder/$1.jsonl"
}
# What the paper says, literally, and its section 2.1.
run_paper_on() {  # BACKEND
  local on=backend=$1
  launch $((frames / 10 + 8)) bgremove method=paper training-frames=5 "$on" ! \
    hsvsegment colour-space=hsv "$on" ! srg "$on" ! prmmotion method=literal max-shift=4 "$on" ! \
    mrfmerge method=literal "$on" ! regionwrite location="$folder/$1.jsonl"
}
run_difference_on() {  # BACKEND
  launch $((frames / 10 + 8)) regiontrack bgremove::method=frame-difference backend="$1" ! \
    regionwrite location="$folder/$1.jsonl"
}

compare() {  # SUFFIX...
  local lines
  for lines; do
    cmp "$folder/cpu.$lines" "$folder/cuda.$lines"
  done
  local objects
  objects=$(grep -c '"id":' "$folder/cpu.jsonl") || true
  echo "$(wc -l <"$folder/cpu.jsonl") frames, $objects of them with objects: the same on both"
  ((objects > 0))
}

run_on cpu
run_on cuda
compare graph jsonl
run_moving_on cpu
run_moving_on cuda
compare jsonl
for way in paper difference; do
  "run_${way}_on" cpu
  "run_${way}_on" cuda
  compare jsonl
done
