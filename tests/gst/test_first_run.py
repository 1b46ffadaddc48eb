#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The first half hour: the launch lines that gst-inspect-1.0 gives show something, those of the
examples end without an error, copies of the examples run with installed elements, and a camera that
dies is looked for until it is back.

usage: test_first_run.py EXAMPLES      GST_PLUGIN_PATH names the plugin
"""
import gzip
import importlib.util
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(sys.argv[1])
ELEMENTS = ('bgremove', 'hsvsegment', 'srg', 'prmmotion', 'mrfmerge', 'regionmask', 'regiontext',
            'regiontrack', 'regionwrite', 'regionoverlay', 'haardetect')
BALL = ('videotestsrc pattern=ball num-buffers={} ! video/x-raw,format=I420,framerate=30/1 ! '
        'regiontrack ! regionwrite format=graph ! fakesink')
PORT = 18557
SERVER = f'''
import gi
gi.require_version('Gst', '1.0')
gi.require_version('GstRtspServer', '1.0')
from gi.repository import GLib, Gst, GstRtspServer
Gst.init(None)
server = GstRtspServer.RTSPServer()
server.set_service('{PORT}')
factory = GstRtspServer.RTSPMediaFactory()
factory.set_launch('( videotestsrc is-live=true pattern=ball ! '
                   'video/x-raw,format=I420,width=160,height=120,framerate=20/1 ! jpegenc ! '
                   'rtpjpegpay name=pay0 )')
server.get_mount_points().add_factory('/camera', factory)
server.attach(None)
print('ready', flush=True)
GLib.MainLoop().run()
'''


def shell(command, folder):
    return subprocess.run(['bash', '-o', 'pipefail', '-c', command], capture_output=True,
                          cwd=folder, timeout=300, check=False)


def start_server():
    """None where Python has no RTSP server."""
    server = subprocess.Popen([sys.executable, '-c', SERVER], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True)
    if server.stdout.readline() == 'ready\n':
        return server
    stop(server)
    return None


def stop(process):
    process.kill()
    process.wait()
    process.stdout.close()


def readme():
    """Packages have it compressed."""
    path = EXAMPLES.parent / 'README.md'
    if path.exists():
        return path.read_text(encoding='utf-8')
    return gzip.decompress(path.with_suffix('.md.gz').read_bytes()).decode()


class FirstRun(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def example_of(self, element):
        about = subprocess.run(['gst-inspect-1.0', element], capture_output=True, text=True,
                               check=False).stdout
        lines = [line.split(maxsplit=1)[1] for line in about.splitlines()
                 if line.split()[:1] == ['Example']]
        return lines[0] if lines else None

    def check_shows_something(self, done):
        """Objects or regions among the lines, or pictures that differ."""
        written = done.stdout + b''.join(p.read_bytes() for p in self.folder.glob('*.jsonl'))
        pictures = {path.read_bytes() for path in self.folder.glob('*.png')}
        if pictures:
            self.assertGreater(len(pictures), 20)
        elif b'"objects"' in written:
            self.assertGreater(written.count(b'"objects":[{'), 90)
        else:
            self.assertGreater(written.count(b'\n'), 200)

    def test_the_launch_lines_of_gst_inspect_show_something(self):
        for element in ELEMENTS:
            line = self.example_of(element)
            if line is None and element == 'regionoverlay':
                continue
            with self.subTest(element):
                done = shell(line, self.folder)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertNotIn(b'ERROR', done.stderr)
                self.check_shows_something(done)
                for path in (*self.folder.glob('*.png'), *self.folder.glob('*.jsonl')):
                    path.unlink()

    def test_a_frame_is_drawn_without_cutting_off_who_writes_the_lines(self):
        line = f'gst-launch-1.0 -q {BALL.format(400)} | {EXAMPLES}/graph.py - 20 > graph.svg'
        done = shell(line, self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, b''))
        self.assertIn('<circle', (self.folder / 'graph.svg').read_text(encoding='utf-8'))

    def copied(self):
        """The examples as a user has them who copied them from somewhere."""
        return pathlib.Path(shutil.copytree(EXAMPLES, self.folder / 'copied' / 'examples'))

    def clip(self):
        path = self.folder / 'clip.avi'
        made = shell('gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=60 ! '
                     f'video/x-raw,format=I420 ! jpegenc ! avimux ! filesink location={path}',
                     self.folder)
        self.assertEqual(made.returncode, 0, made.stderr)
        return path

    def test_copied_examples_run_with_the_installed_elements(self):
        examples, clip = self.copied(), self.clip()
        for script in ('file.sh', 'moving_camera.sh', 'paper/literal.sh',
                       'paper/literal.sh --moving'):
            done = shell(f'{examples}/{script} {clip}', self.folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            lines = [json.loads(line) for line in done.stdout.splitlines()]
            self.assertEqual([line['frame'] for line in lines], list(range(1, 61)))

    @unittest.skipUnless(importlib.util.find_spec('cv2'), 'no OpenCV')
    def test_the_demo_prints_no_error(self):
        done = shell(f'{self.copied()}/demo.sh {self.clip()}', self.folder)
        if b'no element "' in done.stderr:
            self.skipTest('built without the overlay, or no encoder')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn(b'error', (done.stdout + done.stderr).lower())
        for name in ('annotated.mp4', 'still.png', 'objects.jsonl'):
            self.assertGreater((self.folder / 'demo-output' / name).stat().st_size, 0)

    def test_gst_inspect_tells_a_script_that_they_exist(self):
        def exists(version):
            return shell(f'gst-inspect-1.0 --exists --atleast-version={version} bgremove',
                         self.folder).returncode == 0
        documented = re.search(r'--atleast-version=([0-9.]+)', readme())[1]
        self.assertTrue(exists(documented))
        self.assertFalse(exists('99.0'))

    def test_a_copied_report_says_that_it_needs_the_source(self):
        done = shell(f'{self.copied()}/paper/reproduce.sh --quick', self.folder)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn(b'run this in the source tree', done.stderr)

    def test_copied_examples_say_that_the_elements_are_missing(self):
        environment = {**os.environ, 'GST_PLUGIN_PATH': '', 'GST_REGISTRY': f'{self.folder}/none'}
        if subprocess.run(['gst-inspect-1.0', 'regiontrack'], env=environment, check=False,
                          stdout=subprocess.DEVNULL).returncode == 0:
            self.skipTest('the elements are installed')
        done = subprocess.run([self.copied() / 'file.sh', sys.argv[0]], capture_output=True,
                              text=True, env=environment, timeout=300, check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('the elements are not installed', done.stderr)

    def test_a_camera_that_dies_is_looked_for(self):
        server = start_server()
        if server is None:
            self.skipTest('no RTSP server')
        script = subprocess.Popen(
            [self.copied() / 'rtsp.sh', f'rtsp://127.0.0.1:{PORT}/camera'],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True,
            env={**os.environ, 'RETRY_SECONDS': '0.2'})
        lines = (json.loads(line) for line in script.stdout)
        try:
            first = next(line for line in lines if 'utc' in line)
            self.assertGreater(first['frame'], 0)
            stop(server)
            server = None
            while server is None:
                server = start_server()
            again = next(line for line in lines if line['frame'] == 1)
            self.assertEqual(again['resolution'], {'width': 160, 'height': 120})
        finally:
            os.killpg(script.pid, signal.SIGKILL)
            script.wait()
            script.stdout.close()
            if server:
                stop(server)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
