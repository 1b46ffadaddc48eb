#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Does what an integrator does, on a clean Debian and with nothing but the packages: installs the
# stages, and sees that OpenCV stays away; runs every launch line of README and gst-inspect-1.0 as
# it stands; reads objects in C++, in Python and by DL Streamer's rule. Prints what differs, and
# fails where something does.
#
# usage: run.sh [SUITE [FOLDER]]     SUITE: bookworm (default), trixie
# FOLDER: packages that examples/packaging/build.sh made (default: it makes them now)
# Needs root or sudo, and debootstrap.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
((EUID == 0)) || exec sudo --preserve-env=DEBIAN_MIRROR,XDG_CACHE_HOME,HOME "$0" "$@"
# shellcheck source=examples/packaging/chroot.sh
source "$root/examples/packaging/chroot.sh"

suite=${1:-bookworm}
packages=${2:-}
if [[ -z $packages ]]; then
  packages=$chroots/../packages/$suite
  "$root/examples/packaging/build.sh" "$suite" "$packages"
fi

make_chroot "$suite"
mkdir -p "$chroot/packages" "$chroot/contact"
cp "$packages"/*.deb "$chroot/packages"
cp "$root"/tests/contact/{contact.py,read_by_rule.cpp} "$root/tests/gst/test_first_run.py" \
  "$chroot/contact"

echo "contact: the stages alone, on a clean $suite"
# shellcheck disable=SC2016
install_there $(cd "$chroot" && printf '/%s\n' packages/gstreamer1.0-regiongraph_*.deb \
  packages/libgstregiongraph-1.0-0_*.deb) gstreamer1.0-tools gstreamer1.0-plugins-base
if in_chroot dpkg-query -W -f '${Package}\n' | grep opencv; then
  echo 'contact: the stages bring OpenCV with them' >&2
  exit 1
fi
in_chroot gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=60 ! \
  video/x-raw,format=I420,framerate=30/1 ! regiontrack ! regionwrite ! fakesink \
  >"$chroot/contact/stages.jsonl"
grep -q '"objects":\[{' "$chroot/contact/stages.jsonl" ||
  { echo 'contact: the stages alone find nothing' >&2; exit 1; }

echo 'contact: all packages'
extra=()
[[ $suite == bookworm ]] || extra+=(libgstreamer-plugins-bad1.0-dev)
# Of what the packages suggest, haardetect's launch line needs the cascades of opencv-data.
install_there $(cd "$chroot" && printf '/%s\n' packages/*.deb) opencv-data \
  xvfb xauth gstreamer1.0-x g++ pkgconf python3 python3-gi python3-numpy gir1.2-gstreamer-1.0 \
  gir1.2-gst-plugins-base-1.0 gir1.2-gst-rtsp-server-1.0 gstreamer1.0-tools \
  gstreamer1.0-plugins-base gstreamer1.0-plugins-good gstreamer1.0-plugins-bad gstreamer1.0-libav \
  "${extra[@]}"
# autovideosink wants a screen, which by default closes for a moment with its last window.
in_chroot xvfb-run -a -s -noreset /contact/contact.py /usr/share/doc/gst-regiongraph-doc
echo 'contact: the launch lines of gst-inspect-1.0 and copies of the examples'
in_chroot /usr/bin/python3 /contact/test_first_run.py /usr/share/doc/gst-regiongraph-doc/examples
echo "contact: all well on $suite"
