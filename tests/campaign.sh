#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tries to break the elements: fuzzers, threads, failing allocations, endless frames. Stops at the
# first finding, which it names with the command that repeats it.
#
# usage: campaign.sh [--hours H] [PART...]     H of fuzzing in all (default 1), the rest as long as
#                                              it takes
#        campaign.sh --short [PART...]         what .ci/run does, some minutes
#        campaign.sh --keep                    the fuzzers' new inputs, as few as reach what all
#                                              reach, into tests/fuzz/corpus
#        campaign.sh --configure               only makes the build folder of the fuzzers
# PART: tidy plain fuzz threads allocations soak camera (default: all; --short: all but the first
# two)
# FUZZ_BUILD, PLAIN_BUILD, TSAN_BUILD, BUILD_DIR: build folders (default: build-fuzz, build-plain,
# build-tsan, build)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
fuzz_build=$(realpath -m "${FUZZ_BUILD:-$root/build-fuzz}")
plain_build=$(realpath -m "${PLAIN_BUILD:-$root/build-plain}")
tsan_build=$(realpath -m "${TSAN_BUILD:-$root/build-tsan}")
build=$(realpath -m "${BUILD_DIR:-$root/build}")
cache=$(command -v ccache || true)
targets=(cascades chain lines metas objects text)
corpora=corpus  # The folder of what the fuzzers reach.
most_kept=100  # Inputs of a target in tests/fuzz/corpus.

hours=1
is_short=0
is_keeping=0
is_configuring=0
parts=()
while (($#)); do
  case $1 in
    --hours) hours=$2; shift ;;
    --short) is_short=1 ;;
    --keep) is_keeping=1 ;;
    --configure) is_configuring=1 ;;
    tidy | plain | fuzz | threads | allocations | soak | camera) parts+=("$1") ;;
    *) sed -n '3,15s/^# \?//p' "$0"; exit 2 ;;
  esac
  shift
done
if ((${#parts[@]} == 0)); then
  parts=(tidy plain fuzz threads allocations soak camera)
  ((is_short == 0)) || parts=("${parts[@]:2}")
fi

export G_SLICE=always-malloc G_DEBUG=gc-friendly ORC_CODE=backup GST_PLUGIN_PATH=

# Without the compiler's cache: clang's precompiled headers name the folder they were made in.
configure_fuzzers() {
  [[ -f $fuzz_build/build.ninja ]] ||
    CC=clang CXX=clang++ meson setup "$fuzz_build" "$root" -Dwerror=true \
      -Dcuda=disabled -Dfuzz=true -Db_lundef=false -Db_sanitize=address,undefined -Doptimization=1 \
      -Dcpp_args='-fsanitize=fuzzer-no-link -D_GLIBCXX_ASSERTIONS' \
      >/dev/null
}

build_fuzzers() {
  configure_fuzzers
  ninja -C "$fuzz_build" fuzzers >/dev/null
}

# Leaks are what tests/leaks.sh and the soak look for; GLib's own would end every run here.
fuzz_environment=(env GST_REGISTRY="$fuzz_build/gst.reg" ASAN_OPTIONS=detect_leaks=0
  UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1)

fuzz_one() {  # TARGET SECONDS [arguments of libFuzzer]
  local target=$1 seconds=$2 corpus=$fuzz_build/$corpora/$1 log=$fuzz_build/fuzz-$1.log status=0
  shift 2
  mkdir -p "$corpus" "$fuzz_build/slow/$target" "$fuzz_build/found"
  RG_SLOW_DIR=$fuzz_build/slow/$target "${fuzz_environment[@]}" \
    "$fuzz_build/tests/fuzz/fuzz-$target" -max_total_time="$seconds" -max_len=1500 -len_control=0 \
    -timeout=240 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$fuzz_build/found/$target-" "$@" \
    "$corpus" "$root/tests/fuzz/corpus/$target" >"$log" 2>&1 || status=$?
  local runs
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  printf '  %-8s %s runs, %s inputs\n' "$target" "${runs:-?}" "$(find "$corpus" -type f | wc -l)"
  ((status == 0)) && return
  grep -E 'ERROR|runtime error|SUMMARY|do not fit|does not fit' "$log" | head -5
  echo "  repeat with: tests/fuzz/fuzz-$target \$(ls -t $fuzz_build/found/$target-* | head -1)" >&2
  return 1
}

# All sources of core and all checks, the analyser among them; .ci/run has the quicker ones on what
# has changed lately.
run_tidy() {
  local log=$fuzz_build/tidy.log
  configure_fuzzers
  ninja -C "$fuzz_build" >/dev/null
  run-clang-tidy -quiet -p "$fuzz_build" "^$root/core/.*\.cpp$" >"$log" 2>&1 ||
    { grep -A 5 -E 'warning:|error:' "$log"; return 1; }
}

# Without optimiser nothing hides what is read before it is written. The linker sees all types at
# once and compares those of one name. Without precompiled headers each source includes what it
# uses. What compares instruction sets waits for the optimiser.
run_plain() {
  [[ -f $plain_build/build.ninja ]] ||
    CC="$cache gcc" CXX="$cache g++" meson setup "$plain_build" "$root" -Dwerror=true \
      -Dcuda=disabled -Db_pch=false -Doptimization=0 -Db_lto=true -Db_lundef=false \
      -Dcpp_link_args='-Wodr -Werror=odr' >/dev/null
  ninja -C "$plain_build" tests/core/core-tests tests/gst/gst-tests tests/accuracy/scenes >/dev/null
  "$plain_build/tests/core/core-tests" --gtest_brief=1 \
    --gtest_filter='-*Targets*:*AnHourIfAsked'
  meson test -C "$plain_build" --no-rebuild --print-errorlogs --timeout-multiplier 10 \
    'gst, half 0' 'gst, half 1'
  "$plain_build/tests/accuracy/scenes" --pan --seeds 1:2 --gate 2
}

run_fuzz() {
  build_fuzzers
  local seconds target
  if ((is_short)); then  # Much the same inputs each time: a test must not fail by chance.
    local -A runs=([cascades]=1000 [chain]=8 [lines]=15000 [metas]=50 [objects]=100 [text]=1500)
    corpora=corpus-short
    rm -rf "${fuzz_build:?}/$corpora"
    for target in "${targets[@]}"; do
      RG_NO_COSTS=1 fuzz_one "$target" 120 -seed=1 -runs="${runs[$target]}"
    done
    return
  fi
  seconds=$(/usr/bin/python3 -c "print(int(3600 * $hours / ${#targets[@]}))")
  for target in "${targets[@]}"; do fuzz_one "$target" "$seconds"; done
}

build_stress() {
  [[ -f $tsan_build/build.ninja ]] ||
    CC="$cache gcc" CXX="$cache g++" meson setup "$tsan_build" "$root" -Dwerror=true \
      -Dcuda=disabled -Db_sanitize=thread -Doptimization=1 -Db_lundef=false >/dev/null
  ninja -C "$tsan_build" tests/stress/stress >/dev/null
}

run_threads() {
  build_stress
  local stress=("$tsan_build/tests/stress/stress")
  export TSAN_OPTIONS=halt_on_error=1:history_size=4:second_deadlock_stack=1
  TSAN_OPTIONS+=:suppressions=$root/tests/tsan.supp:print_suppressions=0
  export GST_REGISTRY=$tsan_build/gst.reg
  if "${stress[@]}" --races 100 >/dev/null 2>&1; then
    echo 'threads: a race of an executor was not found' >&2
    return 1
  fi
  if ((is_short)); then
    "${stress[@]}" --pushes 1000
    return
  fi
  "${stress[@]}" --pushes 250000
  "${stress[@]}" --pushes 2500 --size 640x480
}

run_allocations() {
  ninja -C "$build" tests/alloc/allocation-failures >/dev/null
  local every=1
  ((is_short)) && every=29
  "$build/tests/alloc/allocation-failures" --every "$every"
}

run_soak() {
  ninja -C "$build" tests/stress/soak >/dev/null
  if "$build/tests/stress/soak" --frames 20000 --scene empty --lose 2 >/dev/null; then
    echo 'soak: two bytes lost in every 1500 frames were not found' >&2
    return 1
  fi
  if ((is_short)); then
    "$build/tests/stress/soak" --frames 40000 --scene typical
    "$build/tests/stress/soak" --frames 40000 --scene cuts
    "$build/tests/stress/soak" --frames 20000 --scene empty
    return
  fi
  "$build/tests/stress/soak" --frames 1000000
  "$build/tests/stress/soak" --frames 10000 --size 640x480
}

run_camera() {
  local times=200
  ((is_short)) && times=3
  BUILD_DIR=$build "$root/tests/stress/camera.py" --restarts "$times"
}

keep() {
  local target kept
  for target in "${targets[@]}"; do
    kept=$fuzz_build/kept/$target
    rm -rf "$kept"
    mkdir -p "$kept"
    "${fuzz_environment[@]}" "$fuzz_build/tests/fuzz/fuzz-$target" -merge=1 -max_len=1500 "$kept" \
      "$root/tests/fuzz/corpus/$target" "$fuzz_build/corpus/$target" >/dev/null 2>&1
    # libFuzzer's merge prefers small inputs; of too many the smallest are kept.
    find "$kept" -type f -printf '%s %f\n' | sort -n | tail -n "+$((most_kept + 1))" |
      while read -r _ name; do rm "$kept/$name"; done
    find "$root/tests/fuzz/corpus/$target" -type f ! -name 'found-*' -delete
    cp "$kept"/* "$root/tests/fuzz/corpus/$target/"
    printf '  %-8s %s inputs kept\n' "$target" "$(find "$kept" -type f | wc -l)"
  done
}

if ((is_configuring)); then
  configure_fuzzers
  exit
fi
if ((is_keeping)); then
  build_fuzzers
  keep
  exit
fi
run_parts() {
  local part
  for part; do
    printf '%s (%d s so far)\n' "$part" "$SECONDS"
    "run_$part"
  done
}

# What runs for hours is watched one after the other. The short parts are processes of one thread
# each: side by side, once that is built which uses all cores by itself.
if ((is_short && ${#parts[@]} > 1)); then
  first=() second=()
  for part in "${parts[@]}"; do
    case $part in
      fuzz) build_fuzzers; first+=("$part") ;;
      threads) build_stress; first+=("$part") ;;
      *) second+=("$part") ;;
    esac
  done
  run_parts "${first[@]}" &
  running=$!
  status=0
  (run_parts "${second[@]}") & wait "$!" || status=1
  wait "$running" || status=1
  exit "$status"
fi
run_parts "${parts[@]}"
