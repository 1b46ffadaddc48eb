#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds this tree on another Debian, in a clean chroot, with warnings as errors, and runs the tests
# there: the same source fits GStreamer 1.22 (bookworm) and 1.26 (trixie). Its last line is that of
# tests/run.sh.
#
# usage: on_debian.sh [SUITE [arguments of meson test]]     SUITE: trixie (default), bookworm
# Needs root or sudo, and debootstrap.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
((EUID == 0)) || exec sudo --preserve-env=DEBIAN_MIRROR,XDG_CACHE_HOME,HOME "$0" "$@"
# shellcheck source=examples/packaging/chroot.sh
source "$root/examples/packaging/chroot.sh"

suite=${1:-trixie}
shift || true
(($#)) || set -- --suite build --suite core --suite gst --suite examples --suite fuzz

make_chroot "$suite"
copy_source "$root" /source
echo "on_debian: what the build and the tests need, on a clean $suite"
# GstAnalytics, where there is any, is among its headers. Meson takes ccache where it finds it.
install_there libgstreamer-plugins-bad1.0-dev ccache
in_chroot /source/tests/setup.sh
in_chroot env CCACHE_SLOPPINESS=pch_defines,time_macros /source/tests/run.sh "$@"
