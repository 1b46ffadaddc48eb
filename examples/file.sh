#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# The objects of a video file, camera standing still, as JSON lines on the standard output.
#
# usage: file.sh VIDEO
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

(($# == 1)) || fail 'usage: file.sh VIDEO'
video=$(readable_file "$1")
build_elements >&2

in_build gst-launch-1.0 -q \
  filesrc location="$video" ! decodebin ! videoconvert ! \
  bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! \
  regionwrite format=jsonl location=- ! fakesink sync=false
