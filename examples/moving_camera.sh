#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# The objects of a video whose camera moves, as JSON lines on the standard output. There is no
# background to learn, so bgremove is left out: the whole frame is segmented, and the largest group
# of regions that move alike is the background.
#
# usage: moving_camera.sh VIDEO
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

(($# == 1)) || fail 'usage: moving_camera.sh VIDEO'
video=$(readable_file "$1")
build_elements >&2

in_build gst-launch-1.0 -q \
  filesrc location="$video" ! decodebin ! videoconvert ! \
  hsvsegment ! srg ! prmmotion ! mrfmerge ! \
  regionwrite format=jsonl location=- ! fakesink sync=false
