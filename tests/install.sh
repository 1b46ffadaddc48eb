#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs a build into a scratch folder and uses what is there as a stranger would: gst-inspect
# finds every element, an application builds against the pkg-config file and reads objects, and
# Python finds the typelib.
#
# usage: install.sh VIDEO                       (BUILD_DIR as for run.sh)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build}")
video=$(realpath "${1:?usage: install.sh VIDEO}")
target=$(mktemp -d)
trap 'rm -rf "$target"' EXIT

option() { meson introspect --buildoptions "$build" |
  /usr/bin/python3 -c 'import json, sys
print(next(o["value"] for o in json.load(sys.stdin) if o["name"] == sys.argv[1]))' "$1"; }

DESTDIR=$target meson install -C "$build" --no-rebuild --quiet
prefix=$(option prefix)
libraries=$target$prefix/$(option libdir)
test -f "$libraries/libgstregiongraph-1.0.so.0"
# The .pc file names the prefix without the scratch folder.
sed -i "s|^prefix=.*|prefix=$target$prefix|" "$libraries/pkgconfig/gstregiongraph-1.0.pc"
export GST_PLUGIN_PATH=$libraries/gstreamer-1.0 GST_REGISTRY=$target/registry.bin
export LD_LIBRARY_PATH=$libraries PKG_CONFIG_PATH=$libraries/pkgconfig

for element in bgremove hsvsegment srg prmmotion mrfmerge regionoverlay regionmask regiontext \
  regionwrite regiontrack haardetect; do
  gst-inspect-1.0 "$element" >"$target/$element" || { echo "install: no $element" >&2; exit 1; }
done

read -r -a flags <<<"$(pkg-config --cflags --libs gstregiongraph-1.0 gstreamer-app-1.0)"
"${CXX:-g++}" -std=c++17 "$root/examples/read_objects.cpp" "${flags[@]}" -o "$target/reader"
"$target/reader" "$video" >"$target/objects"
grep -q '^frame' "$target/objects" || { echo 'install: the reader found nothing' >&2; exit 1; }
if [[ $(option introspection) != disabled ]]; then
  test -f "$target$prefix/$(option datadir)/gir-1.0/GstRegionGraph-1.0.gir"
  export GI_TYPELIB_PATH=$libraries/girepository-1.0
  (cd "$target" && /usr/bin/python3 "$root/examples/python/masks.py" "$video" >"$target/boxes")
  grep -q '^object' "$target/boxes" || { echo 'install: Python found nothing' >&2; exit 1; }
  test -s "$target/labels.npy" && test -s "$target/mask.pgm"
fi
echo "install: 11 elements, an application that read $(wc -l <"$target/objects") objects"
