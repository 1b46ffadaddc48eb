#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the region graph of one frame: what regionwrite format=graph wrote, as SVG or for GraphViz.

usage: graph.py LINES [FRAME] [--dot]       LINES is a file, or - for standard input

FRAME counts from 1; without it the frame with the most broken arcs is drawn, since these say where
objects part. Regions are discs of their colour and area with their motion as a line; kept arcs are
solid, broken ones dashed. Each tells its figures when the pointer rests on it (SVG).

    gst-launch-1.0 -q filesrc location=clip.avi ! decodebin ! videoconvert ! bgremove ! \\
      hsvsegment ! srg ! prmmotion ! mrfmerge ! regionwrite format=graph ! fakesink |
      ./graph.py - 120 > graph.svg
"""
import argparse
import json
import math
import signal
import sys
from xml.sax.saxutils import escape

PALETTE = ('#e6194b', '#3cb44b', '#4363d8', '#f58231', '#911eb4', '#008080', '#9a6324', '#808000')


def choose(lines, number):
    """The frame of that number, or the one with the most broken arcs."""
    best, most = None, -1
    for line in lines:
        frame = json.loads(line)
        if number is not None:
            if frame['frame'] == number:
                return frame
            continue
        broken = sum(not arc['kept'] for arc in frame['arcs'])
        if frame['regions'] and broken > most:
            best, most = frame, broken
    if best is None:
        sys.exit('graph.py: no such frame' if number else 'graph.py: no frame has regions')
    return best


def outline(region):
    return PALETTE[region['object'] % len(PALETTE)] if region['object'] else '#000000'


def region_text(region):
    motion = region['motion']
    return (f'region {region["id"]}: area {region["area"]} px, motion ({motion["x"]}, '
            f'{motion["y"]}) px, reliability {region["reliability"]}, group {region["group"]}, '
            f'expected {region["expected"] or "nothing"}, object {region["object"] or "none"}')


def arc_text(arc):
    verdict = 'kept' if arc['kept'] else 'broken'
    return (f'{arc["a"]}–{arc["b"]} {verdict}: weight {arc["weight"]} = border {arc["border"]} + '
            f'arc {arc["arc"]} + prediction {arc["prediction"]} − motion {arc["motion"]}')


def svg(frame):
    size = frame['resolution']
    places = {region['id']: region['centroid'] for region in frame['regions']}
    yield (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size["width"]} '
           f'{size["height"]}" width="{size["width"]}" height="{size["height"]}">')
    yield '<rect width="100%" height="100%" fill="#ffffff"/>'
    for arc in frame['arcs']:
        a, b = places[arc['a']], places[arc['b']]
        style = '' if arc['kept'] else ' stroke-dasharray="3 2"'
        yield (f'<line x1="{a["x"]}" y1="{a["y"]}" x2="{b["x"]}" y2="{b["y"]}" '
               f'stroke="{"#404040" if arc["kept"] else "#d00000"}"{style}>'
               f'<title>{escape(arc_text(arc))}</title></line>')
    for region in frame['regions']:
        place, motion = region['centroid'], region['motion']
        radius = max(2.0, math.sqrt(region['area'] / math.pi) / 2)
        yield (f'<circle cx="{place["x"]}" cy="{place["y"]}" r="{radius:.1f}" '
               f'fill="{region["colour"]}" stroke="{outline(region)}" stroke-width="1.5">'
               f'<title>{escape(region_text(region))}</title></circle>')
        yield (f'<line x1="{place["x"]}" y1="{place["y"]}" x2="{place["x"] + 4 * motion["x"]:.1f}" '
               f'y2="{place["y"] + 4 * motion["y"]:.1f}" stroke="{outline(region)}" '
               f'stroke-opacity="{region["reliability"]}"/>')
    yield '</svg>'


def dot(frame):
    yield f'graph "frame {frame["frame"]}" {{'
    yield '  node [shape=circle, style=filled, fontcolor=white];'
    for region in frame['regions']:
        place = region['centroid']
        yield (f'  {region["id"]} [pos="{place["x"]},{-place["y"]}!", fillcolor="'
               f'{region["colour"]}", color="{outline(region)}", '
               f'tooltip="{region_text(region)}"];')
    for arc in frame['arcs']:
        style = 'solid' if arc['kept'] else 'dashed'
        yield (f'  {arc["a"]} -- {arc["b"]} [style={style}, label="{arc["weight"]}", '
               f'tooltip="{arc_text(arc)}"];')
    yield '}'


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('lines')
    parser.add_argument('frame', nargs='?', type=int)
    parser.add_argument('--dot', action='store_true')
    options = parser.parse_args()
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    try:
        if options.lines == '-':
            frame = choose(sys.stdin, options.frame)
        else:
            with open(options.lines, encoding='ascii') as lines:
                frame = choose(lines, options.frame)
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f'graph.py: {options.lines} is not what regionwrite format=graph wrote: {error!r}')
    print('\n'.join((dot if options.dot else svg)(frame)), flush=True)
    if options.lines == '-':  # Whoever writes the lines shall not be cut off.
        for _ in sys.stdin:
            pass


if __name__ == '__main__':
    main()
