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

run_parity() {
  step 'operations against the CPU' "$here/parity-gpu" --gtest_brief=1
  step 'stages against the CPU' "$here/backend-gpu" --gtest_brief=1
}

# With plain device memory, as elements have it; racecheck and synccheck on what has barriers.
run_checkers() {
  command -v compute-sanitizer >/dev/null || { echo 'not run: no compute-sanitizer here'; return; }
  local tool
  for tool in memcheck initcheck racecheck synccheck; do
    step "$tool" compute-sanitizer --tool "$tool" --error-exitcode 1 "$here/backend-gpu" \
      --gtest_brief=1 --gtest_filter='*TheSameOnADevice'
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
