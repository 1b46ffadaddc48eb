#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# The objects of a network camera as JSON lines on the standard output. The leaky queue drops frames
# when the machine or the reader is too slow, so that the delay stays short; the elements go by the
# frames' times.
#
# usage: rtsp.sh URL            for example: rtsp.sh rtsp://user:password@192.0.2.1/stream
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

(($# == 1)) || fail 'usage: rtsp.sh URL'
[[ $1 == rtsp://* || $1 == rtsps://* ]] || fail "not an RTSP address: $1"
build_elements >&2

in_build gst-launch-1.0 -q \
  rtspsrc location="$1" latency=200 ! application/x-rtp,media=video ! decodebin ! videoconvert ! \
  queue leaky=downstream max-size-buffers=2 max-size-bytes=0 max-size-time=0 ! \
  bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! \
  regionwrite format=jsonl location=- drop=false ! fakesink sync=false
