#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The typelib: what Python reads of a frame is what regionwrite says of it. Exits with 77 where
PyGObject or numpy is missing.

GST_PLUGIN_PATH, GI_TYPELIB_PATH and LD_LIBRARY_PATH name what was built.
"""
import gc
import json
import pathlib
import sys
import tempfile
import unittest

try:
    import gi
    import numpy
except ImportError as missing:
    print(f'skipped: {missing}')
    sys.exit(77)

gi.require_version('Gst', '1.0')
gi.require_version('GstApp', '1.0')
gi.require_version('GstRegionGraph', '1.0')
from gi.repository import GLib, Gst, GstApp, GstRegionGraph  # noqa: E402,F401

SIZE, FRAMES, ENTERS, LOOKED_AT = (240, 160), 70, 30, 60
KINDS = ('foreground', 'labels', 'graph', 'motion', 'objects')
CAPS = f'video/x-raw,format=RGB,width={SIZE[0]},height={SIZE[1]},framerate=25/1'
LONGEST_WAIT = 20 * Gst.SECOND


def picture(number, noise):
    """A body of two colours that crosses a yard after a while."""
    yard = numpy.full((SIZE[1], SIZE[0], 3), 110) + noise.integers(-2, 3, (SIZE[1], SIZE[0], 3))
    left = 3 * (number - ENTERS) - 20
    if left > -20:
        columns = slice(max(left, 0), left + 20)
        yard[60:90, columns] = (200, 60, 50)
        yard[90:125, columns] = (40, 50, 160)
    return yard.astype(numpy.uint8)


def panned(number, _):
    """What a camera sees that turns to the right by three pixels a frame."""
    y, x = numpy.mgrid[:SIZE[1], 3 * number:SIZE[0] + 3 * number]
    grey = 40 + (x // 9 * 7919 + y // 9 * 104729) * 2654435761 % 2**32 // 2**8 % 160
    return numpy.repeat(grey[:, :, numpy.newaxis], 3, axis=2).astype(numpy.uint8)


def pull(lines, stages='bgremove ! hsvsegment', paint=picture):
    """The sample that is looked at, of a pipeline that is gone, and regionwrite's line of it."""
    pipeline = Gst.parse_launch(
        f'appsrc name=source format=time caps={CAPS} ! {stages} ! srg ! prmmotion ! mrfmerge ! '
        f'regionwrite contours=true location={lines} ! appsink name=sink sync=false')
    source, sink = pipeline.get_by_name('source'), pipeline.get_by_name('sink')
    pipeline.set_state(Gst.State.PLAYING)
    noise, samples = numpy.random.default_rng(7), []
    for number in range(FRAMES):
        buffer = Gst.Buffer.new_wrapped(paint(number, noise).tobytes())
        buffer.pts, buffer.duration = number * Gst.SECOND // 25, Gst.SECOND // 25
        source.push_buffer(buffer)
    source.end_of_stream()
    while sample := sink.try_pull_sample(LONGEST_WAIT):
        samples.append(sample)
    pipeline.set_state(Gst.State.NULL)
    line = pathlib.Path(lines).read_text(encoding='ascii').splitlines()[LOOKED_AT]
    return samples[LOOKED_AT], json.loads(line)


def meta_of(sample, kind):
    return getattr(GstRegionGraph, f'buffer_get_region_{kind}_meta')(sample.get_buffer())


def pixels(meta):
    is_there, plane = meta.map()
    assert is_there
    kind = {1: numpy.uint8, 2: numpy.uint16}[plane.pixel_bytes]
    held = plane.get_bytes()
    height, width = plane.height, plane.width
    plane.unmap()
    return held, lambda: numpy.frombuffer(held.get_data(), kind).reshape(height, width)


def fields_of(value):
    """Reads all that a value shows; returns the names."""
    names = [name for name in dir(value) if not name.startswith('_')]
    for name in names:
        member = getattr(value, name)
        if name.startswith('get_') and callable(member):
            member()
    return names


class Typelib(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            cls.sample, cls.line = pull(pathlib.Path(folder, 'lines.jsonl'))

    def objects(self):
        """{id: (1 + index, object)}"""
        meta = meta_of(self.sample, 'objects')
        found = [meta.get_object(index) for index in range(meta.get_n_objects())]
        self.assertTrue(all(is_there for is_there, _ in found))
        return {item.id: (slot, item) for slot, (_, item) in enumerate(found, 1)}

    def test_objects_are_those_of_the_lines(self):
        objects = self.objects()
        gc.collect()
        self.assertTrue(self.line['objects'])
        for told in self.line['objects']:
            item = objects[told['id']][1]
            box = item.get_box()
            self.assertEqual((box.x, box.y, box.width, box.height),
                             (told['x'], told['y'], told['w'], told['h']))
            self.assertEqual(item.area, told['area'])
            self.assertEqual(item.state.value_nick, told['state'])
            self.assertEqual('#%02x%02x%02x' % tuple(item.get_colour()), told['colour'])

    def test_the_mask_of_an_object_is_that_of_the_lines(self):
        slots = pixels(meta_of(self.sample, 'objects'))[1]()
        told = self.line['objects'][0]
        rows, columns = numpy.nonzero(slots == self.objects()[told['id']][0])
        self.assertEqual(len(rows), told['area'])
        x, y = zip(*told['contour'])
        self.assertEqual((min(x), max(x)), (columns.min(), columns.max()))
        self.assertEqual((min(y), max(y)), (rows.min(), rows.max()))

    def test_the_label_map_is_that_of_the_graph(self):
        labels = pixels(meta_of(self.sample, 'labels'))[1]()
        graph = meta_of(self.sample, 'graph')
        areas = [graph.get_region(index)[1].area for index in range(graph.get_n_regions())]
        self.assertEqual(numpy.bincount(labels.ravel())[1:].tolist(), areas)

    def test_a_camera_that_stands_still_has_the_unit_matrix(self):
        self.assertEqual(meta_of(self.sample, 'objects').get_camera_matrix(),
                         [1, 0, 0, 0, 1, 0, 0, 0, 1])

    def test_the_matrix_of_a_camera_outlives_the_buffer(self):
        with tempfile.TemporaryDirectory() as folder:
            sample, line = pull(pathlib.Path(folder, 'lines.jsonl'), 'hsvsegment', panned)
        matrix = meta_of(sample, 'objects').get_camera_matrix()
        del sample
        gc.collect()
        self.assertEqual(len(matrix), 9)
        self.assertEqual(matrix[8], 1)
        middle = SIZE[0] // 2, SIZE[1] // 2, 1
        rows = [sum(number * at for number, at in zip(matrix[i:i + 3], middle)) for i in (0, 3, 6)]
        self.assertAlmostEqual(rows[0] / rows[2] - middle[0], 3, delta=0.3)
        for at, axis in enumerate('xy'):
            moved = middle[at] - rows[at] / rows[2]
            self.assertAlmostEqual(moved, line['camera'][axis], delta=0.05)

    def test_bytes_outlive_the_buffer(self):
        with tempfile.TemporaryDirectory() as folder:
            sample, _ = pull(pathlib.Path(folder, 'lines.jsonl'))
        kept = {kind: pixels(meta_of(sample, kind)) for kind in ('foreground', 'labels', 'objects')}
        before = {kind: look().copy() for kind, (_, look) in kept.items()}
        del sample
        gc.collect()
        for kind, (_, look) in kept.items():
            self.assertTrue((look() == before[kind]).all(), kind)
        self.assertEqual(set(numpy.unique(before['foreground'])) - {0, 128, 255}, set())

    def test_nothing_that_can_be_touched_ends_the_interpreter(self):
        for kind in KINDS:
            meta = meta_of(self.sample, kind)
            self.assertEqual(meta.get_status()[0], GstRegionGraph.RegionStatus.OK)
            for name in dir(meta):
                if name.startswith('get_n_'):
                    getattr(meta, name)()
            if hasattr(meta, 'map'):
                plane = meta.map()[1]
                self.assertIn('data', fields_of(plane))
                plane.height = plane.width = 100000
                self.assertEqual(plane.get_bytes().get_size() % (SIZE[0] * SIZE[1]), 0)
                plane.unmap()
                plane.unmap()
                self.assertIsNone(plane.get_bytes())
        for item in [item for _, item in self.objects().values()]:
            self.assertIn('area', fields_of(item))
        graph, motion = meta_of(self.sample, 'graph'), meta_of(self.sample, 'motion')
        for value in (graph.get_region(0)[1], graph.get_arc(0)[1], motion.get_vector(0)[1],
                      GstRegionGraph.RegionPlane(), GstRegionGraph.RegionObject()):
            self.assertTrue(fields_of(value))
        self.assertFalse(graph.get_region(99999)[0])

    def test_a_frame_without_metas_has_none(self):
        for kind in KINDS:
            find = getattr(GstRegionGraph, f'buffer_get_region_{kind}_meta')
            self.assertIsNone(find(Gst.Buffer.new()))


if __name__ == '__main__':
    Gst.init(None)
    unittest.main()
