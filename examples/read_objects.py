#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads the objects of a video from the standard GstVideoRegionOfInterestMeta: their numbers are in
the param object_id.

usage: read_objects.py VIDEO

Any program that knows GStreamer's own metas can do this; nothing here is of regiongraph but the
elements' names. PyGObject can't iterate over a buffer's metas, so their ids are listed with ctypes.
"""
import ctypes
import sys

import gi
gi.require_version('Gst', '1.0')
gi.require_version('GstApp', '1.0')
gi.require_version('GstVideo', '1.0')
from gi.repository import GLib, Gst, GstApp, GstVideo  # noqa: E402,F401

PIPELINE = ('filesrc name=file ! decodebin ! videoconvert ! '
            'bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ! '
            'appsink name=sink sync=false max-buffers=4')


class RoiMeta(ctypes.Structure):
    """The head of struct GstVideoRegionOfInterestMeta."""
    _fields_ = [('flags', ctypes.c_int), ('info', ctypes.c_void_p), ('roi_type', ctypes.c_uint32),
                ('id', ctypes.c_int), ('parent_id', ctypes.c_int)]


gstreamer = ctypes.CDLL('libgstreamer-1.0.so.0')
gstreamer.gst_buffer_iterate_meta_filtered.restype = ctypes.POINTER(RoiMeta)
gstreamer.gst_buffer_iterate_meta_filtered.argtypes = [
    ctypes.c_void_p, ctypes.POINTER(ctypes.c_void_p), ctypes.c_size_t]
libvideo = ctypes.CDLL('libgstvideo-1.0.so.0')
libvideo.gst_video_region_of_interest_meta_api_get_type.restype = ctypes.c_size_t


def roi_metas(buffer):
    """All GstVideoRegionOfInterestMeta of the buffer."""
    api = libvideo.gst_video_region_of_interest_meta_api_get_type()
    state = ctypes.c_void_p()
    while True:
        found = gstreamer.gst_buffer_iterate_meta_filtered(
            hash(buffer), ctypes.byref(state), api)
        if not found:
            return
        yield GstVideo.buffer_get_video_region_of_interest_meta_id(buffer, found.contents.id)


def print_objects(frame, buffer):
    for meta in roi_metas(buffer):
        number = meta.get_param('object_id').get_int('id').value
        print(f'frame {frame}  {GLib.quark_to_string(meta.roi_type)} {number}  '
              f'{meta.w}x{meta.h} at {meta.x},{meta.y}')


def read_all(sink, bus):
    """Prints the objects of every frame until the stream ends; returns its error message or None.

    Not every error reaches the sink as an end, so the bus is looked at whenever nothing comes.
    """
    frame = 0
    while not sink.is_eos():
        sample = sink.try_pull_sample(Gst.SECOND // 10)
        if sample:
            frame += 1
            print_objects(frame, sample.get_buffer())
        elif failure := bus.pop_filtered(Gst.MessageType.ERROR):
            return failure
    return bus.pop_filtered(Gst.MessageType.ERROR)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    Gst.init(None)
    pipeline = Gst.parse_launch(PIPELINE)
    pipeline.get_by_name('file').set_property('location', sys.argv[1])
    sink = pipeline.get_by_name('sink')
    pipeline.set_state(Gst.State.PLAYING)
    failure = read_all(sink, pipeline.get_bus())
    pipeline.set_state(Gst.State.NULL)
    if failure:
        sys.exit(f'read_objects.py: {failure.parse_error().gerror.message}')


if __name__ == '__main__':
    main()
