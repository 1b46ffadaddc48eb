#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs the demo's pipeline under GStreamer's leaks tracer; a leak or a warning is an error.
#
# usage: leaks.sh VIDEO [FRAMES]                (default 60 frames; BUILD_DIR as for run.sh)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build}")
video=$(realpath "${1:?usage: leaks.sh VIDEO [FRAMES]}")
frames=${2:-60}
log=$(mktemp)
trap 'rm -f "$log"' EXIT

status=0
meson devenv -C "$build" env GST_DEBUG=GST_TRACER:7 GST_DEBUG_NO_COLOR=1 G_DEBUG=fatal-warnings \
  GST_TRACERS='leaks(check-refs=true,filters="GstBuffer,GstCaps,GstEvent,GstElement,GstPad")' \
  gst-launch-1.0 -q \
  filesrc location="$video" ! decodebin ! identity eos-after="$frames" ! videoconvert ! queue ! \
  bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! \
  regionwrite format=jsonl location=/dev/null ! regionoverlay ! videoconvert ! \
  fakesink sync=false >"$log" 2>&1 || status=$?
if ((status)); then
  tail -n 40 "$log" >&2
  echo "leaks: the pipeline ended with status $status" >&2
  exit 1
fi
echo "leaks: none in $frames frames"
