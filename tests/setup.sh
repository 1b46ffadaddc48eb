#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs the Debian packages that the build, the tests and the demo need, and what more can be
# built with where CUDA's compiler is. Does nothing when all of them are there. Needs root or sudo
# only when something is missing.
set -euo pipefail

packages=(
  # build
  g++ clang meson ninja-build pkg-config git
  libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev libglib2.0-dev
  libopencv-dev opencv-data libpango1.0-dev libhwy-dev libtbb-dev libpng-dev
  gobject-introspection libgirepository1.0-dev
  # checks and tests
  clang-format clang-tidy libclang-rt-dev libgtest-dev libgmock-dev nlohmann-json3-dev
  binutils debootstrap locales valgrind libc6-dbg
  python3 python3-numpy python3-opencv python3-scipy python3-jsonschema python3-matplotlib
  python3-gi gir1.2-gstreamer-1.0 gir1.2-gst-plugins-base-1.0 gir1.2-gst-rtsp-server-1.0
  # running pipelines
  gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-good gstreamer1.0-plugins-bad
  gstreamer1.0-libav
)
# Frames in a GPU's memory; the build goes without.
optional=()
PATH=$PATH:/usr/local/cuda/bin
! command -v nvcc >/dev/null || optional=(libgstreamer-plugins-bad1.0-dev)

installed() { dpkg-query -W -f '${Status}\n' "$1" 2>/dev/null | grep -q 'ok installed'; }

missing=()
for package in "${packages[@]}"; do
  installed "$package" || missing+=("$package")
done
wanted=()
for package in "${optional[@]}"; do
  installed "$package" || wanted+=("$package")
done
((${#missing[@]} + ${#wanted[@]})) || exit 0

as_root=()
if ((EUID)); then
  if ! command -v sudo >/dev/null; then
    ((${#missing[@]})) || exit 0
    echo "setup: these packages are missing; as root, run: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "setup: installing ${missing[*]} ${wanted[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y "$@" >"$log" 2>&1; }
# A list of packages that is out of date is no reason to fail while what is needed can be had.
apt update || echo "setup: apt-get update failed; trying with the package lists as they are" >&2
if ((${#missing[@]})) && ! apt install --no-install-recommends "${missing[@]}"; then
  tail -n 20 "$log" >&2
  echo "setup: apt-get install failed: ${missing[*]}" >&2
  exit 1
fi
if ((${#wanted[@]})) && ! apt install --no-install-recommends "${wanted[@]}"; then
  echo "setup: going without ${wanted[*]}, which can't be installed" >&2
fi
