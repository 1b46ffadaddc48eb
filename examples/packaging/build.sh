#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds Debian packages of this tree in a clean chroot, and has lintian judge them.
#
# usage: build.sh [SUITE [FOLDER]]       SUITE: bookworm (default), trixie
# FOLDER: where the packages go (default: packages/SUITE in the cache folder); what is there of the
# kind goes. Needs root or sudo, and debootstrap. DEBIAN_MIRROR: see chroot.sh
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
((EUID == 0)) || exec sudo --preserve-env=DEBIAN_MIRROR,XDG_CACHE_HOME,HOME "$0" "$@"
# shellcheck source=examples/packaging/chroot.sh
source "$root/examples/packaging/chroot.sh"

suite=${1:-bookworm}
folder=${2:-$chroots/../packages/$suite}

make_chroot "$suite"
copy_source "$root" /build/source
cp -r "$root/examples/packaging/debian" "$chroot/build/source/debian"
echo "build: what the packages need, on a clean $suite"
install_there build-essential debhelper
# shellcheck disable=SC2016
in_chroot sh -c 'cd /build/source && apt-get -qq -y build-dep --no-install-recommends ./' \
  >"$chroot/install.log" 2>&1 || { tail -n 20 "$chroot/install.log" >&2; exit 1; }
echo 'build: the packages'
in_chroot sh -c 'cd /build/source && dpkg-buildpackage -us -uc' >"$chroot/build.log" 2>&1 ||
  { tail -n 40 "$chroot/build.log" >&2; exit 1; }
if grep -E '\.[ch](pp)?:[0-9:]+ warning: ' "$chroot/build.log"; then
  echo 'build: the compiler warned' >&2
  exit 1
fi
echo 'build: lintian'
install_there lintian
in_chroot sh -c 'cd /build && lintian --allow-root --fail-on error *.changes'

rm -rf "$folder"
mkdir -p "$folder"
cp "$chroot"/build/*.deb "$chroot"/build/*.dsc "$chroot"/build/*.tar.* "$chroot"/build/*.changes \
  "$folder"
echo "build: done, in $(realpath "$folder")"
ls "$folder"
