# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames through the elements: BGR pictures go in, pictures or lines come out."""
import json
import pathlib
import shlex
import subprocess
import tempfile
import threading

import numpy as np

OURS = 'bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge'
AFTER_LITERAL = 'srg ! prmmotion method=literal ! mrfmerge method=literal'
LITERAL = f'bgremove method=paper ! hsvsegment colour-space=hsv ! {AFTER_LITERAL}'
LITERAL_FRAME = f'hsvsegment colour-space=hsv scope=frame ! {AFTER_LITERAL}'
BY_PAPERS_MASK = 'bgremove method=paper ! hsvsegment ! srg ! prmmotion ! mrfmerge'
BY_DIFFERENCE = 'bgremove method=frame-difference ! hsvsegment ! srg ! prmmotion ! mrfmerge'


def feed(pipe, first, frames):
    """A reader that has gone away ends it: what that means its exit status says."""
    try:
        with pipe:
            pipe.write(four_bytes(first))
            for frame in frames:
                pipe.write(four_bytes(frame))
    except BrokenPipeError:
        pass


def four_bytes(frame):
    """As BGRx, whose rows have no padding."""
    return np.dstack([frame, np.zeros(frame.shape[:2], np.uint8)]).tobytes()


def launch(frames, line, fps):
    frames = iter(frames)
    first = next(frames)
    height, width = first.shape[:2]
    head = (f'fdsrc fd=0 blocksize={4 * width * height} ! rawvideoparse format=bgrx '
            f'width={width} height={height} framerate={fps}/1')
    process = subprocess.Popen(['gst-launch-1.0', '-q', *shlex.split(f'{head} ! {line}')],
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
    threading.Thread(target=feed, args=(process.stdin, first, frames), daemon=True).start()
    return process, (height, width)


def pictures(frames, line, fps=25):
    """Yields what the line makes of each frame, BGR; one for one."""
    process, (height, width) = launch(
        frames, f'{line} ! videoconvert ! video/x-raw,format=BGRx ! fdsink fd=1', fps)
    complaints = []
    reader = threading.Thread(target=lambda: complaints.append(process.stderr.read()))
    reader.start()
    size = 4 * width * height
    try:
        while len(raw := process.stdout.read(size)) == size:
            yield np.frombuffer(raw, np.uint8).reshape(height, width, 4)[:, :, :3]
    finally:
        process.stdout.close()
        status = process.wait()
        reader.join()
    if status:
        raise RuntimeError(f'{line}: {complaints[0].decode(errors="replace")[-2000:]}')


def last_picture(frames, line, fps=25):
    last = None
    for last in pictures(frames, line, fps):
        pass
    return last


def masks_at(frames, line, wanted, fps=25):
    """{number: mask} of those frames, from 0; line ends with regionmask."""
    return {i: picture[:, :, 0] == 255 for i, picture in enumerate(pictures(frames, line, fps))
            if i in wanted}


def write_lines(frames, line, kind, fps):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, 'lines')
        process, _ = launch(
            frames, f'{line} ! regionwrite format={kind} location={path} ! fakesink', fps)
        errors = process.stderr.read()
        if process.wait():
            raise RuntimeError(f'{line}: {errors.decode(errors="replace")[-2000:]}')
        return path.read_text(encoding='utf-8').splitlines()


def objects(frames, line, fps=25):
    """Of each frame its objects as regionwrite's JSON lines tell them."""
    return [json.loads(text)['objects'] for text in write_lines(frames, line, 'jsonl', fps)]


def boxes(frames, line, fps=25):
    """[(frame from 1, id, x, y, w, h)] of what is told."""
    rows = (text.split(',') for text in write_lines(frames, line, 'mot', fps))
    return [(int(row[0]), int(row[1]), *map(float, row[2:6])) for row in rows]
