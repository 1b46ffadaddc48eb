#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What an integrator does with the installed packages; tests/contact/run.sh starts it in a chroot.

usage: contact.py FOLDER       the folder of the documentation: README.md and examples

Runs every command of the README that an installed copy is meant for, and reads the objects of one
clip by lines, C++, Python and DL Streamer's rule. Prints what fails or differs; exits with 1 then.
"""
import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SHOWN = 5  # Differences of one kind.
SIZE, FRAMES = (320, 240), 120
CLIP = (f'gst-launch-1.0 -q videotestsrc pattern=ball num-buffers={FRAMES} ! video/x-raw,'
        f'format=I420,width={SIZE[0]},height={SIZE[1]},framerate=25/1 ! jpegenc ! avimux ! '
        'filesink location=clip.avi')
# What the README's three dots stand for.
SOURCE = 'gst-launch-1.0 filesrc location=clip.avi ! decodebin ! videoconvert'
# Commands that build from source, or that packages make needless.
OF_THE_SOURCE = re.compile(
    r'(\./examples/demo\.sh|\./examples/paper/|\./tests/|meson |ninja |sudo |build/)')
PRESENT = ('tracked', 'stopped', 'occluded')
IN_CPP = re.compile(r'^frame (\d+)  object (\d+)  (\w+)  (\d+)x(\d+) at (-?\d+),(-?\d+)', re.M)
BY_RULE = re.compile(r'^frame (\d+)  object (\d+)  (\d+)x(\d+) at (\d+),(\d+)$', re.M)

failures = []


def fail(what):
    print(f'contact: {what}', file=sys.stderr)
    failures.append(what)


def shell(command):
    done = subprocess.run(['bash', '-o', 'pipefail', '-c', command], capture_output=True, text=True,
                          timeout=300, check=False)
    if done.returncode != 0:
        fail(f'{command}\n  ended with {done.returncode}: {done.stderr.strip()[-500:]}')
    return done.stdout


def commands_of(readme):
    """Commands of its indented blocks; one that goes on, by a backslash or in quotes, is one."""
    text = re.sub(r' \\\n +', ' ', readme)
    for block in re.findall(r'(?:^    .*\n)+', text, re.M):
        command = ''
        for line in re.sub(r'^    ', '', block, flags=re.M).splitlines():
            command += line
            if command.count("'") % 2 == 0:
                yield command
                command = ''
            else:
                command += '\n'


def run_readme(readme):
    ran = 0
    for command in commands_of(readme):
        if OF_THE_SOURCE.match(command):
            continue
        print(f'contact: $ {command.splitlines()[0]}')
        printed = shell(command.replace('...', SOURCE, 1) if command.startswith('...') else command)
        if 'ERROR' in printed:
            fail(f'{command}\n  printed {printed[-500:]}')
        if 'python' in command and not printed:
            fail(f'{command}\n  printed nothing')
        ran += 1
    if ran < 8:
        fail(f'only {ran} commands were found in the README')


def clipped(x, y, width, height):
    right, bottom = min(x + width, SIZE[0]), min(y + height, SIZE[1])
    return max(x, 0), max(y, 0), right - max(x, 0), bottom - max(y, 0)


def by_lines():
    lines = shell('gst-launch-1.0 -q filesrc location=clip.avi ! decodebin ! videoconvert ! '
                  'regiontrack ! regionwrite ! fakesink')
    return {(line['frame'], o['id']): clipped(o['x'], o['y'], o['w'], o['h'])
            for line in map(json.loads, lines.splitlines()) for o in line['objects']
            if o['state'] in PRESENT}


def in_cpp(examples):
    shell(f'g++ -std=c++17 -Wall -Wextra -Werror {examples}/read_objects.cpp $(pkg-config --cflags '
          '--libs gstregiongraph-1.0 gstreamer-app-1.0) -o read_objects')
    found = IN_CPP.findall(shell('./read_objects clip.avi'))
    return {(int(frame), int(number)): clipped(int(x), int(y), int(width), int(height))
            for frame, number, state, width, height, x, y in found if state in PRESENT}


def in_python():
    import gi
    for name in ('Gst', 'GstApp', 'GstRegionGraph'):
        gi.require_version(name, '1.0')
    from gi.repository import Gst, GstApp, GstRegionGraph  # noqa: F401
    Gst.init(None)
    pipeline = Gst.parse_launch(f'{SOURCE[len("gst-launch-1.0"):]} ! regiontrack ! appsink '
                                'name=sink sync=false')
    pipeline.set_state(Gst.State.PLAYING)
    found, frame = {}, 0
    while sample := pipeline.get_by_name('sink').try_pull_sample(20 * Gst.SECOND):
        frame += 1
        meta = GstRegionGraph.buffer_get_region_objects_meta(sample.get_buffer())
        for index in range(meta.get_n_objects()):
            item = meta.get_object(index)[1]
            box = item.get_box()
            if item.state.value_nick in PRESENT:
                found[frame, item.id] = clipped(box.x, box.y, box.width, box.height)
    pipeline.set_state(Gst.State.NULL)
    return found


def by_rule():
    has_analytics = subprocess.run(['pkg-config', '--exists', 'gstreamer-analytics-1.0'],
                                   check=False).returncode == 0
    libraries = 'gstreamer-app-1.0 gstreamer-video-1.0' + (
        ' gstreamer-analytics-1.0' if has_analytics else '')
    shell(f'g++ -std=c++17 -Wall -Wextra -Werror {HERE}/read_by_rule.cpp '
          f'$(pkg-config --cflags --libs {libraries}) -o read_by_rule')
    found = BY_RULE.findall(shell('./read_by_rule clip.avi'))
    return {(int(frame), int(number)): tuple(map(int, (x, y, width, height)))
            for frame, number, width, height, x, y in found}


def compare(name, found, lines):
    different = [f'frame {frame}, object {number}: {found.get((frame, number), "missing")}, lines: '
                 f'{lines.get((frame, number), "missing")}'
                 for frame, number in sorted(found.keys() | lines.keys())
                 if found.get((frame, number)) != lines.get((frame, number))]
    print(f'contact: {name}: {len(found)} boxes, {len(different)} differ from the lines')
    if different:
        fail(f'{name} differs from the lines\n  ' + '\n  '.join(different[:SHOWN]))


def check_versions():
    """The headers', the library's and the plugins' version are one."""
    version = shell('pkg-config --modversion gstregiongraph-1.0').strip()
    numbers = version.replace('.', ', ')
    pathlib.Path('version.c').write_text(
        '#include <gstregiongraph.h>\n'
        f'_Static_assert(GST_REGION_CHECK_VERSION({numbers}), "older");\n'
        f'_Static_assert(!GST_REGION_CHECK_VERSION({numbers} + 1), "newer");\n', encoding='ascii')
    shell('cc -fsyntax-only version.c $(pkg-config --cflags gstregiongraph-1.0)')
    for plugin in ('regiongraph', 'regiongraphoverlay'):
        told = shell(f'gst-inspect-1.0 {plugin}')
        if not re.search(rf'^ *Version +{re.escape(version)}$', told, re.M):
            fail(f'{plugin} has another version than {version}')
        folder = shell('pkg-config --variable=pluginsdir gstregiongraph-1.0').strip()
        file = re.search(r'^ *Filename +(\S+)$', told, re.M)
        if not file or os.path.realpath(file[1]) != os.path.realpath(f'{folder}/libgst{plugin}.so'):
            fail(f'{plugin} does not lie in {folder}')


def check_documentation(folder):
    """What hotdoc reads tells of the elements that are installed."""
    described = json.loads((folder / 'elements/gst_plugins_cache.json').read_text(encoding='utf-8'))
    for plugin in ('regiongraph', 'regiongraphoverlay'):
        told = re.findall(r'^  (\w+): ', shell(f'gst-inspect-1.0 {plugin}'), re.M)
        if not told or sorted(described[plugin]['elements']) != sorted(told):
            fail(f'gst_plugins_cache.json does not describe the elements of {plugin}')


def has(element):
    is_there = subprocess.run(['gst-inspect-1.0', '--exists', element], check=False).returncode == 0
    if not is_there:
        print(f'contact: no {element} here')
    return is_there


def check_other_process():
    """From GStreamer 1.24 on what one process finds another one writes."""
    if not has('unixfdsink'):
        return
    shell(f'{SOURCE} ! regiontrack ! regionwrite location=near.jsonl ! unixfdsink '
          'socket-path=socket wait-for-connection=true & until [[ -S socket ]]; do sleep 0.1; '
          'done; timeout 100 gst-launch-1.0 unixfdsrc socket-path=socket ! regionwrite '
          'location=far.jsonl ! fakesink; wait')
    # Times are those of each pipeline's clock.
    near, far = ([{**json.loads(line), 'pts': 0} for line in open(name, encoding='ascii')]
                 for name in ('near.jsonl', 'far.jsonl'))
    if near != far or len(near) != FRAMES:
        fail('another process does not write what this one found')


def check_analytics_consumer():
    """Debian 13's objectdetectionoverlay draws what it reads of GstAnalytics."""
    if not has('objectdetectionoverlay'):
        return
    plain, unseen, seen = [
        shell(f'{SOURCE} {stages} ! videoconvert ! video/x-raw,format=BGRA {drawing} ! '
              f'filesink location=drawn.raw && md5sum drawn.raw').splitlines()[-1]
        for stages, drawing in (('', ''), ('', '! objectdetectionoverlay'),
                                ('! regiontrack', '! objectdetectionoverlay'))]
    if unseen != plain:
        fail('objectdetectionoverlay draws what nobody found')
    if seen == plain:
        fail('objectdetectionoverlay sees no objects')


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1]).resolve()
    readme = folder / 'README.md'
    text = (readme.read_text(encoding='utf-8') if readme.exists()
            else gzip.open(f'{readme}.gz', 'rt', encoding='utf-8').read())
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        shutil.copytree(folder / 'examples', 'examples')
        shell(CLIP)
        run_readme(text)
        check_versions()
        check_documentation(folder)
        lines = by_lines()
        if len(lines) < FRAMES / 2:
            fail(f'only {len(lines)} boxes were found')
        compare('C++', in_cpp('examples'), lines)
        compare('Python', in_python(), lines)
        compare("DL Streamer's rule", by_rule(), lines)
        check_other_process()
        check_analytics_consumer()
    print(f'contact: {len(failures)} failures')
    sys.exit(1 if failures else 0)


if __name__ == '__main__':
    main()
