#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# The objects of a network camera as JSON lines on the standard output, with the time of day (utc)
# at which the camera took each frame, once it has told its clock. The leaky queue drops frames when
# the machine or the reader is too slow, so that the delay stays short; the elements go by the
# frames' times. When the camera goes away it is looked for again until it is back; its frames and
# objects are counted from 1 then.
#
# usage: rtsp.sh URL            for example: rtsp.sh rtsp://user:password@192.0.2.1/stream
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

watch_camera() {  # URL
  in_build gst-launch-1.0 -q \
    rtspsrc location="$1" latency=200 add-reference-timestamp-meta=true ! \
    application/x-rtp,media=video ! watchdog timeout=10000 ! decodebin ! videoconvert ! \
    queue leaky=downstream max-size-buffers=2 max-size-bytes=0 max-size-time=0 ! \
    bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! \
    regionwrite format=jsonl location=- drop=false ! fakesink sync=false
}

(($# == 1)) || fail 'usage: rtsp.sh URL'
[[ $1 == rtsp://* || $1 == rtsps://* ]] || fail "not an RTSP address: $1"
build_elements >&2

errors=$(mktemp)
trap 'rm -f "$errors"' EXIT
trap 'exit 130' INT TERM
while true; do
  watch_camera "$1" 2>"$errors" || true
  if grep -q 'Could not write to "-"' "$errors"; then
    fail 'nobody reads the lines any more'
  fi
  reason=$(sed -n 's/^ERROR: from element [^ ]*: //p' "$errors" | head -n 1)
  echo "$program: the camera is gone (${reason:-the stream ended}); looking for it again" >&2
  sleep "${RETRY_SECONDS:-2}"
done
