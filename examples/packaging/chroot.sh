# SPDX-License-Identifier: LGPL-2.1-or-later
# Clean Debian systems in folders, for building and trying packages. Sourced, not run; needs root,
# and debootstrap when it runs for the first time.
# DEBIAN_MIRROR: default http://deb.debian.org/debian
# shellcheck shell=bash

mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
chroots=${XDG_CACHE_HOME:-$HOME/.cache}/gst-regiongraph/chroots

# A system without anything of ours in $chroot, which is gone when the script ends. The base that it
# is copied from, packages that were downloaded, and what ccache (where a script installs it) keeps,
# stay for the next time.
make_chroot() {  # SUITE
  local base=$chroots/$1
  archives=$chroots/$1-archives
  compiled=$chroots/$1-ccache
  mkdir -p "$archives" "$compiled"
  if [[ ! -d $base ]]; then
    rm -rf "$base.part"
    debootstrap --variant=minbase "$1" "$base.part" "$mirror" >"$base.log" 2>&1 ||
      { tail -n 5 "$base.log" >&2; return 1; }
    printf '#!/bin/sh\nexit 101\n' >"$base.part/usr/sbin/policy-rc.d"
    chmod +x "$base.part/usr/sbin/policy-rc.d"
    mv "$base.part" "$base"
  fi
  chroot=$(mktemp -d "$chroots/$1.XXXXXX")
  trap 'rm -rf --one-file-system "$chroot"' EXIT
  cp -a --reflink=auto "$base/." "$chroot"
  mkdir -p "$chroot/var/cache/ccache"
}

# Runs a command there. Its mounts and processes end with it; it is not the first of them, which
# gets no signals.
in_chroot() {
  # shellcheck disable=SC2016
  unshare --mount --pid --fork bash -ec '
    mount -t proc proc "$1/proc"
    mount --bind "$2" "$1/var/cache/apt/archives"
    mount --bind "$3" "$1/var/cache/ccache"
    where=$1
    shift 3
    env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
      DEBIAN_FRONTEND=noninteractive CCACHE_DIR=/var/cache/ccache chroot "$where" "$@" || exit' \
    bash "$chroot" "$archives" "$compiled" "$@"
}

# Installs packages, by name or as files in the chroot, without what they only recommend.
install_there() {
  in_chroot apt-get -qq update &&
    in_chroot apt-get -qq -y install --no-install-recommends "$@" >"$chroot/install.log" 2>&1 ||
    { tail -n 20 "$chroot/install.log" >&2; return 1; }
}

# The repository's files as they are now, without what git ignores.
copy_source() {  # ROOT FOLDER-IN-CHROOT
  mkdir -p "$chroot$2"
  git -C "$1" ls-files -z --cached --others --exclude-standard |
    (cd "$1" && xargs -0 sh -c 'for f; do [ ! -e "$f" ] || printf "%s\0" "$f"; done' sh) |
    tar -C "$1" --null --no-recursion -T - -cf - | tar -C "$chroot$2" --no-same-owner -xf -
}
