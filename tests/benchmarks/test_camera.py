#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cost of a camera is told of each element, and the five stages cost more than one of them.

usage: test_camera.py CAMERA.PY        GST_PLUGIN_PATH names the plugin
"""
import re
import subprocess
import sys
import tempfile
import unittest

CLIP = ('gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=240 ! '
        'video/x-raw,format=I420,width=320,height=240,framerate=25/1 ! jpegenc ! avimux ! filesink '
        'location=clip.avi')
ELEMENTS = ('bgremove threads=1', 'regiontrack threads=1')
LINE = re.compile(r'^320x240, 25 frames a second: (.+): ([0-9.]+) ms of a core a frame, ([0-9.]+)',
                  re.M)


class Camera(unittest.TestCase):
    def test_the_cost_of_a_frame_is_that_of_its_stages(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(['bash', '-c', CLIP], cwd=folder, check=True, timeout=60)
            done = subprocess.run([sys.argv[1], '--camera', '320x240@25', 'clip.avi', *ELEMENTS],
                                  cwd=folder, capture_output=True, text=True, timeout=100,
                                  check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        told = {name: (float(ms), float(cameras))
                for name, ms, cameras in LINE.findall(done.stdout)}
        self.assertEqual(tuple(told), ELEMENTS)
        for ms, cameras in told.values():
            self.assertAlmostEqual(cameras * ms * 25 / 1000, 1, delta=0.1)
        self.assertGreater(told[ELEMENTS[1]][0], told[ELEMENTS[0]][0])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
