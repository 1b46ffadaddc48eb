#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tests and measures the kernels on this machine's GPU, from the folder that bundle.sh made:
# operations and stages against the CPU's bits, NVIDIA's checkers where they are installed, times.
# What it prints goes into kernels/MEASURED.md. Fails when a comparison or a checker does; exits
# with 77 where there is no GPU.
#
# usage: on_gpu.sh [PART...]     PART: parity checkers times (default: all)
set -uo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export LD_LIBRARY_PATH=$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
PATH=$PATH:/usr/local/cuda/bin
parts=("$@")
((${#parts[@]})) || parts=(parity checkers times)
failed=()
processes=$(nproc)

step() {  # NAME COMMAND...
  local name=$1 begin=$SECONDS
  shift
  printf '\n== %s\n' "$name"
  "$@"
  local status=$?
  ((status == 77)) && exit 77
  ((status == 0)) || failed+=("$name")
  echo "($name: $((SECONDS - begin)) s)"
}

# The tests of a program, dealt to COUNT processes that run side by side.
in_shards() {  # COUNT COMMAND...
  local count=$1 logs i status=0
  shift
  logs=$(mktemp -d)
  for ((i = 0; i < count; i++)); do
    (
      export GTEST_TOTAL_SHARDS=$count GTEST_SHARD_INDEX=$i
      "$@" >"$logs/$i" 2>&1
      echo $? >"$logs/$i.status"
    ) &
  done
  wait
  for ((i = 0; i < count; i++)); do
    local shard
    shard=$(<"$logs/$i.status")
    ((shard == 0)) && continue
    status=$shard
    printf -- '-- part %d of %d: exit status %d\n' $((i + 1)) "$count" "$shard"
    tail -n 60 "$logs/$i"
  done
  echo "passed: $(cat "$logs"/* | grep -c '^\[       OK \]')," \
    "skipped: $(cat "$logs"/* | grep -c '^\[  SKIPPED \] .*ms)$')"
  rm -r "$logs"
  return "$status"
}

run_parity() {
  step 'operations against the CPU' in_shards "$processes" "$here/parity-gpu"
  step 'stages against the CPU' in_shards "$processes" "$here/backend-gpu"
}

# Memory where kernels have plain device memory, as in elements; what threads of a block share, in
# each operation. It takes long: a checker slows a program down by hundreds.
run_checkers() {
  command -v compute-sanitizer >/dev/null || { echo 'not run: no compute-sanitizer here'; return; }
  local checker=(compute-sanitizer --error-exitcode 1)
  local tool stages=6
  for tool in memcheck initcheck; do
    step "$tool, stages" in_shards "$stages" "${checker[@]}" --tool "$tool" "$here/backend-gpu" \
      --gtest_filter='*TheSameOnADevice'
  done
  for tool in racecheck synccheck; do
    step "$tool, operations" in_shards "$processes" "${checker[@]}" --tool "$tool" \
      "$here/parity-gpu"
  done
}

run_times() {
  local backend
  for backend in cpu cuda; do
    step "640x480, 160 regions, $backend" "$here/bench-gpu" --backend "$backend" --size 640x480 \
      --regions 160
    step "1920x1080, 512 regions, $backend" "$here/bench-gpu" --backend "$backend" \
      --size 1920x1080 --regions 512
    step "3840x2160, 1024 regions, $backend" "$here/bench-gpu" --backend "$backend" \
      --size 3840x2160 --regions 1024 --frames 20 --warm-up 20
    local streams
    for streams in 1 8 32 64; do
      step "$streams streams of 1920x1080, $backend" "$here/bench-gpu" --backend "$backend" \
        --size 1920x1080 --regions 512 --scope foreground --streams "$streams" --frames 20 \
        --warm-up 15
    done
  done
  step 'the model, to compare: 640x480' "$here/kernel-model" 640 480
  step 'the model, to compare: 1920x1080' "$here/kernel-model" 1920 1080
}

date -u +'%Y-%m-%d %H:%M UTC'
nvidia-smi --query-gpu=name,driver_version,memory.total --format=csv,noheader 2>/dev/null ||
  echo 'nvidia-smi tells nothing'
grep -m 1 'model name' /proc/cpuinfo
nproc
[[ ! -f $here/commit ]] || cat "$here/commit"
for part in "${parts[@]}"; do
  case $part in
    parity | checkers | times) "run_$part" ;;
    *) sed -n '3,8s/^# \?//p' "$0"; exit 2 ;;
  esac
done
if ((${#failed[@]})); then
  printf '\nfailed: %s\n' "${failed[@]}"
  exit 1
fi
printf '\nall well\n'
