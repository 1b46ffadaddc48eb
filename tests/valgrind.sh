#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs tests that reach every stage and its SIMD kernels under valgrind. What is decided by bytes
# that nobody wrote, and reads and writes where nothing is, are errors; leaks are LeakSanitizer's
# business. valgrind knows no AVX-512: of the SIMD targets, those up to AVX2 are looked at.
#
# usage: valgrind.sh                            (BUILD_DIR as for run.sh)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# All of the core but what takes longest and reaches nothing that the others don't, and what has an
# operator new of its own, whose place valgrind takes.
left_out_of_core=(
  'Background.AStoppedThingStaysForAnHour*' 'BackgroundTargets.*'
  'Detection.ASearchFindsWhatThePlainVersionFinds' 'Exposure.AHuntingGain*'
  'Exposure.LightThatGoesOn*' 'FrameDifference.Areas*'
  'Image.WithoutMemory*' 'LiteralSearch.SumsOfTheLargest*' 'MergeChains.WorkFollows*'
  'MergeContraction.WorkFollows*' 'ScopeAreas.*' 'Scopes/ChainTargets.*' 'SearchWindows.*'
  'StageMemory.*' 'Stages/SceneChanges.*' 'WeakContrast.AWalkerIsFound*'
)
gst=(
  'ForeignMetas.*' 'GraphMeta.*' 'HostileFrame.*' 'HostileSegment.MayRun*' 'HueProperties.*'
  'LockedMemory.*' 'MaskFiles.*' 'Meta.*' 'MotionMeta.*' 'ObjectsMeta.*' 'OddSizes.*' 'OurMetas.*'
  'Painter.Cuts*' 'Painter.Draws*' 'Painter.Survives*'
  'Pipeline.FindsTheTwoBodiesAndKeepsTheirNumbers' 'Plane.*' 'ReadOnlyMemory.*' 'RegionMask.*'
  'RegionOverlay.BlacksOut*' 'RegionTrack.SaysWhatTheFiveElementsSay' 'RegionWrite.Writes*'
  'ScopeAreas.*' 'SharedFrames.*' 'Stages/EveryStage.FollowsNewCaps*'
  'Stages/EveryStage.LeavesPixels*' 'Stages/EveryStage.SharesTheMemory*'
  'Stages/EveryStage.SkipsGap*' 'Stages/EveryStage.SurvivesAFlush/*'
  'Stages/EveryStage.TakesNewPropertyValues*' 'Stages/EveryStage.TakesOdd*'
  'Stages/EveryStage.WorksWithoutTimes/*' 'Stages/NewCaps.TheStoryAfterwardsIsThatOfAFreshChain/1'
)

export G_SLICE=always-malloc G_DEBUG=gc-friendly ORC_CODE=backup
export GST_REGISTRY=$folder/registry.bin GST_PLUGIN_PATH=

join() { local IFS=:; echo "$*"; }

# A name that has changed would take its test out of the selection unnoticed.
check_names() {  # PROGRAM PATTERN...
  local program=$1 pattern names
  shift
  for pattern; do
    names=$("$program" --gtest_list_tests --gtest_filter="$pattern")
    grep -q '^  ' <<<"$names" || { echo "valgrind: no test is named $pattern" >&2; return 1; }
  done
}

check() {  # NAME FILTER
  local name=$1 log=$folder/$1${GTEST_SHARD_INDEX:-}.log status=0
  LD_PRELOAD=$build/tests/timer_resolution.so valgrind --tool=memcheck --quiet --leak-check=no \
    --error-exitcode=20 --num-callers=20 --fair-sched=try \
    "$build/tests/$name/$name-tests" --gtest_filter="$2" >"$log" 2>&1 || status=$?
  local passed
  passed=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) tests\?\.$/\1/p' "$log")
  if ((status || ${passed:-0} == 0)); then
    grep -E '^==|^\[  FAILED|Failure' "$log" | head -n 60 >&2
    echo "valgrind: $name ended with status $status, ${passed:-0} tests passed" >&2
    return 1
  fi
  echo "valgrind: $name: nothing found in $passed tests"
}

check_names "$build/tests/core/core-tests" "${left_out_of_core[@]}"
check_names "$build/tests/gst/gst-tests" "${gst[@]}"
# Side by side, for valgrind runs one thread of a process at a time; the elements' tests take about
# as long as a third of core's.
core_filter=-$(join "${left_out_of_core[@]}")
check_third_of_core() { GTEST_TOTAL_SHARDS=3 GTEST_SHARD_INDEX=$1 check core "$core_filter"; }
(check_third_of_core 0 && check_third_of_core 1) &
running=$!
status=0
check_third_of_core 2 || status=1
check gst "$(join "${gst[@]}")" || status=1
wait "$running" || status=1
exit "$status"
