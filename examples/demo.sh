#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the elements, runs them on a video and leaves an annotated video, a picture and the objects
# as text in ./demo-output.
#
# usage: demo.sh [VIDEO]
# VIDEO: any file that GStreamer can decode. Default: vtest.avi, people in a street, from Debian's
# opencv-doc package (downloaded into the cache folder when it is not installed).
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

package_clip=usr/share/doc/opencv-doc/examples/data/vtest.avi

# Copies the clip from a tree that holds the package's files; Debian may have compressed it.
copy_clip() {  # TREE TARGET
  if [[ -f $1/$package_clip ]]; then
    cp "$1/$package_clip" "$2"
  elif [[ -f $1/$package_clip.gz ]]; then
    gunzip -c "$1/$package_clip.gz" >"$2"
  else
    return 1
  fi
}

download_clip() {  # TARGET
  local unpacked
  unpacked=$(mktemp -d)
  echo "$program: downloading Debian's opencv-doc package for its clip (96 MB, once)" >&2
  (cd "$unpacked" && apt-get -q -o APT::Sandbox::User=root download opencv-doc >&2) ||
    { rm -rf "$unpacked"; fail 'apt-get download opencv-doc failed; give a VIDEO instead'; }
  dpkg-deb -x "$unpacked"/opencv-doc_*.deb "$unpacked"
  copy_clip "$unpacked" "$1" || { rm -rf "$unpacked"; fail 'no vtest.avi in opencv-doc'; }
  rm -rf "$unpacked"
}

default_clip() {
  local cache=${XDG_CACHE_HOME:-$HOME/.cache}/gst-regiongraph
  local clip=$cache/vtest.avi
  if [[ ! -s $clip ]]; then
    mkdir -p "$cache"
    copy_clip / "$clip.part" || download_clip "$clip.part"
    mv "$clip.part" "$clip"
  fi
  echo "$clip"
}

# At the end the encoder is given no frame, so that it gives out those that it holds; OpenH264 calls
# that an error, which it is none.
run_pipeline() {  # VIDEO OUTPUT
  in_build gst-launch-1.0 -q -e \
    filesrc location="$1" ! decodebin ! videoconvert ! queue ! \
    bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! \
    regionwrite format=jsonl location="$2/objects.jsonl" ! \
    regionoverlay ! progressreport name=demo update-freq=2 ! queue ! \
    videoconvert ! openh264enc bitrate=6000000 complexity=low ! h264parse ! mp4mux ! \
    filesink location="$2/annotated.mp4" 2> >(grep -v 'OpenH264.*cmInitParaError' >&2)
}

(($# <= 1)) || fail 'usage: demo.sh [VIDEO]'
[[ ${1:-} != -h && ${1:-} != --help ]] || { sed -n '3,8s/^# \{0,1\}//p' "$0"; exit 0; }
if (($#)); then
  video=$(readable_file "$1")
fi
build_elements
if ((!$#)); then
  video=$(default_clip)
fi

output=$PWD/demo-output
mkdir -p "$output"
rm -f "$output"/{objects.jsonl,annotated.mp4,still.png}
echo "$program: $video"
run_pipeline "$video" "$output" || fail "the pipeline failed on $video"
/usr/bin/python3 "$here/still.py" "$output"
echo "$program: done. Look at the files in $output:"
echo '  annotated.mp4  the video with boxes, numbers and trails'
echo '  still.png      one frame of it'
echo '  objects.jsonl  a line for each frame: its objects'
