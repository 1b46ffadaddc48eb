#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# The paper's own system, to the letter, on a video file; the objects as JSON lines on the standard
# output. Sections 2.2.1 (bgremove method=paper), 2.2.2 and 2.3 (regions that grow by hue,
# saturation and value, whole-pixel vectors by the sum of absolute differences over all of a region,
# groups by the energy of this frame's regions, the largest the background). Only what follows the
# groups from frame to frame is ours. For comparison: the elements' defaults do better (README).
#
# usage: literal.sh [--moving] VIDEO
# --moving: the camera moves; there is no background to remove, and the whole frame is segmented.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

background=(bgremove method=paper !)
if [[ ${1:-} == --moving ]]; then
  background=()
  shift
fi
(($# == 1)) || fail 'usage: literal.sh [--moving] VIDEO'
video=$(readable_file "$1")
build_elements >&2

in_build gst-launch-1.0 -q \
  filesrc location="$video" ! decodebin ! videoconvert ! \
  "${background[@]}" hsvsegment colour-space=hsv analysis-height=0 ! srg ! \
  prmmotion method=literal ! mrfmerge method=literal ! \
  regionwrite format=jsonl location=- ! fakesink sync=false
