#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Looks at one frame with numpy: prints its objects' boxes, writes labels.npy and mask.pgm.

usage: masks.py VIDEO [FRAME]        FRAME counts from 1 (default: 60)
"""
import sys

import gi
import numpy

for name in ('Gst', 'GstApp', 'GstRegionGraph'):
    gi.require_version(name, '1.0')
from gi.repository import Gst, GstApp, GstRegionGraph  # noqa: E402,F401


def pixels(meta):
    """The meta's plane as an array, which stays when the frame is gone."""
    _, plane = meta.map()
    kind = numpy.uint8 if plane.pixel_bytes == 1 else numpy.uint16
    array = numpy.frombuffer(plane.get_bytes().get_data(), kind)
    array = array.reshape(plane.height, plane.width)
    plane.unmap()
    return array


if len(sys.argv) not in (2, 3):
    sys.exit(__doc__)
Gst.init(None)
pipeline = Gst.parse_launch(
    'filesrc name=file ! decodebin ! videoconvert ! bgremove ! hsvsegment ! srg ! prmmotion ! '
    'mrfmerge ! appsink name=sink sync=false max-buffers=4')
pipeline.get_by_name('file').set_property('location', sys.argv[1])
pipeline.set_state(Gst.State.PLAYING)
sink = pipeline.get_by_name('sink')
for _ in range(int(sys.argv[2]) if len(sys.argv) == 3 else 60):
    sample = sink.try_pull_sample(5 * Gst.SECOND) or sys.exit('masks.py: no such frame')

buffer = sample.get_buffer()  # Lives as long as the sample, and its metas as long as the buffer.
meta = GstRegionGraph.buffer_get_region_objects_meta(buffer)
objects = [meta.get_object(index)[1] for index in range(meta.get_n_objects())]
for item in objects:
    print(f'object {item.id}', item.state.value_nick, item.get_box(), f'{item.area} px')

numpy.save('labels.npy', pixels(GstRegionGraph.buffer_get_region_labels_meta(buffer)))
owners = pixels(meta)  # Of each pixel: 1 + index of its object, 0 = none.
largest = max(range(len(objects)), key=lambda index: objects[index].area, default=0)
mask = owners == largest + 1
with open('mask.pgm', 'wb') as file:
    file.write(b'P5 %d %d 255\n' % mask.shape[::-1] + (mask * numpy.uint8(255)).tobytes())
pipeline.set_state(Gst.State.NULL)
