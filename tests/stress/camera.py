#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""A network camera that dies and comes back: an RTSP server is killed and started again, the
elements are taken down to READY and up again as a media server does. What is in use of the heap
must not grow by more than it does without our elements: rtspsrc and GLib keep a little of each
connection.

usage: camera.py [--restarts N] [--without]     BUILD_DIR: the build folder (default: build)
--without: the same pipeline without our elements

Prints the heap in use after every tenth restart and its slope over the last half, for a pipeline
with and then for one without our elements; fails where the first is steeper by more than 64 bytes a
restart, or where no frame comes.
"""
import argparse
import ctypes
import gc
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get('BUILD_DIR', ROOT / 'build')).resolve()
PORT = 18554
MOST_BYTES = 64
FRAMES = 15
PATIENCE_S = 20
SERVER = f'''
import gi
gi.require_version('Gst', '1.0')
gi.require_version('GstRtspServer', '1.0')
from gi.repository import GLib, Gst, GstRtspServer
Gst.init(None)
server = GstRtspServer.RTSPServer()
server.set_service('{PORT}')
factory = GstRtspServer.RTSPMediaFactory()
factory.set_launch('( videotestsrc is-live=true pattern=ball background-color=0xff808080 ! '
                   'video/x-raw,format=I420,width=160,height=120,framerate=50/1 ! jpegenc ! '
                   'rtpjpegpay name=pay0 )')
factory.set_shared(True)
server.get_mount_points().add_factory('/camera', factory)
server.attach(None)
print('ready', flush=True)
GLib.MainLoop().run()
'''


class Mallinfo(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in (
        'arena', 'ordblks', 'smblks', 'hblks', 'hblkhd', 'usmblks', 'fsmblks', 'uordblks',
        'fordblks', 'keepcost')]


LIBC = ctypes.CDLL(None)
LIBC.mallinfo2.restype = Mallinfo


def bytes_in_use():
    gc.collect()
    LIBC.malloc_trim(0)
    info = LIBC.mallinfo2()
    return info.uordblks + info.hblkhd


def start_server():
    server = subprocess.Popen([sys.executable, '-c', SERVER], stdout=subprocess.PIPE, text=True)
    if server.stdout.readline().strip() != 'ready':
        sys.exit('camera: the RTSP server does not start')
    return server


def slope(values):
    """The median of the slopes between all pairs (Theil and Sen)."""
    return statistics.median((b - a) / (j - i) for i, a in enumerate(values)
                             for j, b in enumerate(values) if j > i)


def watch(Gst, pipeline, counter):
    """Plays until enough frames have come, then until the server's death is noticed."""
    server = start_server()
    counter['frames'] = 0
    pipeline.set_state(Gst.State.PLAYING)
    bus = pipeline.get_bus()
    end = time.monotonic() + PATIENCE_S
    while counter['frames'] < FRAMES and time.monotonic() < end:
        message = bus.timed_pop_filtered(20 * Gst.MSECOND, Gst.MessageType.ERROR)
        if message:
            print('camera:', *message.parse_error(), file=sys.stderr)
    server.send_signal(signal.SIGKILL)
    server.wait()
    server.stdout.close()
    bus.timed_pop_filtered(Gst.SECOND, Gst.MessageType.ERROR | Gst.MessageType.EOS)
    pipeline.set_state(Gst.State.READY)
    bus.set_flushing(True)
    bus.set_flushing(False)
    return counter['frames'] >= FRAMES


def play(restarts, elements):
    """The slope of the heap in use, in bytes a restart; None for too few of them."""
    os.environ['GST_PLUGIN_PATH'] = str(BUILD / 'gst' / 'plugin')
    os.environ.setdefault('GST_REGISTRY', str(BUILD / 'camera.reg'))
    import gi
    gi.require_version('Gst', '1.0')
    from gi.repository import Gst
    Gst.init(None)
    pipeline = Gst.parse_launch(
        f'rtspsrc name=camera location=rtsp://127.0.0.1:{PORT}/camera latency=0 protocols=tcp '
        'rtpjpegdepay name=payload ! jpegdec ! videoconvert ! '
        f'{elements} ! identity name=counter signal-handoffs=true ! fakesink sync=false')
    counter = {'frames': 0}

    def count(*_):
        counter['frames'] += 1

    pipeline.get_by_name('counter').connect('handoff', count)
    # The camera's pads are new ones after each restart.
    payload = pipeline.get_by_name('payload').get_static_pad('sink')
    pipeline.get_by_name('camera').connect('pad-added', lambda _, pad: pad.link(payload))
    used = []
    for i in range(restarts):
        if not watch(Gst, pipeline, counter):
            pipeline.set_state(Gst.State.NULL)
            sys.exit(f'camera: only {counter["frames"]} frames came after restart {i}')
        used.append(bytes_in_use())
        if i % 10 == 9:
            print(f'restart {i + 1}: {used[-1]} bytes in use', flush=True)
    pipeline.set_state(Gst.State.NULL)
    settled = used[len(used) // 2:]
    return slope(settled) if len(settled) >= 10 else None


def slope_without(restarts):
    """In a process of its own, whose heap has seen nothing else."""
    run = subprocess.run([sys.executable, __file__, '--without', '--restarts', str(restarts)],
                         stdout=subprocess.PIPE, text=True, check=True)
    return float(run.stdout.rsplit(maxsplit=1)[-1])


def begin_with_plain_heap():
    """What threads keep for their next allocations counts as in use: starts anew without it."""
    tunables = 'glibc.malloc.tcache_count=0:glibc.malloc.arena_max=1'
    if os.environ.get('GLIBC_TUNABLES') != tunables:
        os.environ['GLIBC_TUNABLES'] = tunables
        os.execv(sys.executable, [sys.executable, *sys.argv])


def main():
    begin_with_plain_heap()
    parser = argparse.ArgumentParser()
    parser.add_argument('--restarts', type=int, default=200)
    parser.add_argument('--without', action='store_true')
    options = parser.parse_args()
    grows = play(options.restarts, 'identity' if options.without else 'regiontrack')
    if grows is None:
        print(f'{options.restarts} restarts, too few for a slope')
        return
    if options.without:
        print(f'bytes in use more after each restart without our elements: {grows:.1f}')
        return
    others = slope_without(options.restarts)
    print(f'{options.restarts} restarts: {grows:+.1f} bytes in use more after each, '
          f'{others:+.1f} without our elements')
    if grows - others > MOST_BYTES:
        sys.exit('camera: the heap grows')


main()
