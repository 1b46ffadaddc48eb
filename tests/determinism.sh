#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# The same video gives the same JSON lines, byte for byte: on one thread, again on one thread, on
# two, and in one element instead of five.
#
# usage: determinism.sh VIDEO [FRAMES]          (default 250 frames; BUILD_DIR as for run.sh)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build}")
video=$(realpath "${1:?usage: determinism.sh VIDEO [FRAMES]}")
frames=${2:-250}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

in_build() { meson devenv -C "$build" gst-launch-1.0 -q "$@"; }

# The frames are cut out once: with a decoder that works on several frames at a time, which frame is
# the last one before an early end is a matter of chance.
in_build filesrc location="$video" ! decodebin ! identity eos-after="$frames" ! videoconvert ! \
  jpegenc quality=95 ! avimux ! filesink location="$folder/clip.avi"

write_objects() {  # NAME ELEMENTS...
  local name=$1
  shift
  in_build filesrc location="$folder/clip.avi" ! decodebin ! videoconvert ! "$@" ! \
    regionwrite format=jsonl location="$folder/$name" ! fakesink sync=false
}

five() {  # THREADS
  echo "bgremove threads=$1 ! hsvsegment threads=$1 ! srg threads=$1 ! prmmotion threads=$1 ! \
    mrfmerge threads=$1"
}

read -r -a on_one <<<"$(five 1)"
read -r -a on_two <<<"$(five 2)"
write_objects one "${on_one[@]}"
write_objects again "${on_one[@]}"
write_objects two "${on_two[@]}"
write_objects bin regiontrack

grep -q '"id":' "$folder/one" || { echo 'determinism: no object in the output' >&2; exit 1; }
for other in again two bin; do
  cmp "$folder/one" "$folder/$other" || { echo "determinism: $other differs" >&2; exit 1; }
done
echo "determinism: $(wc -l <"$folder/one") identical lines from four runs"
