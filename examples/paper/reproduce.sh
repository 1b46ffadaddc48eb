#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Every table and figure of the paper that can be measured, made again on this machine, with the
# paper's own figures beside: builds the elements and the benchmarks, runs them, and leaves one
# report, paper-report/index.html in the working folder. Fails where an item of it is missing.
#
# usage: reproduce.sh [--data DIR] [--quick] [--only ID,ID...]
# --data   folder of sequences: wallflower/NAME with a video (or numbered pictures), script.txt and
#          hand_segmented_*.BMP; pets09_s2l1 with vtest.avi and gt.txt. Those that are not there are
#          listed as missing; without DIR the synthetic parts run
# --quick  few frames and few points: shows that all works, the times mean little
# --only   these items alone; the report lacks the others, and so the command fails
# BUILD_DIR: the build folder (default: build-paper in the repository)
set -euo pipefail
BUILD_DIR=${BUILD_DIR:-$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")/build-paper}
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

arguments=()
while (($#)); do
  case $1 in
    --data | --only)
      (($# > 1)) || fail "$1 needs a value"
      value=$2
      if [[ $1 == --data ]]; then
        [[ -d $2 ]] || fail "no such folder: $2"
        value=$(realpath "$2")
      fi
      arguments+=("$1" "$value")
      shift 2
      ;;
    --quick)
      arguments+=("$1")
      shift
      ;;
    -h | --help)
      sed -n '3,15s/^# \{0,1\}//p' "$0"
      exit 0
      ;;
    *) fail "unknown argument: $1 (see --help)" ;;
  esac
done

is_source || fail 'the benchmarks are built from the source: run this in the source tree'
build_tools
PYTHONPATH=$here/paper in_build /usr/bin/python3 -m report --build "$build" "${arguments[@]}"
