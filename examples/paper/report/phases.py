# SPDX-License-Identifier: LGPL-2.1-or-later
"""Time of the phases: figures 14, 20 and 21, and the sweep over the frame sizes.

CPU times are those of one core: others on the machine and threads don't count.
What a GPU would take is modelled (tests/kernels/model.cpp): bytes over an H200's bandwidth, integer
operations over its rate, and the launches of CUDA graphs. Nothing was measured on one. There is no
kernel that merges: mrfmerge's time on the CPU is added.
"""
from . import plots, published
from .section import Section
from .workshop import STAGES

REGIONS = (10, 20, 40, 80, 120, 160)
SHIFTS = (5, 10, 15, 20)
NAMES = {'hsvsegment': 'colour segmentation', 'srg': 'region graph', 'prmmotion': 'PRM',
         'mrfmerge': 'MRF merging'}
MODELLED = ('hsvsegment', 'srg', 'prmmotion')
NOTE = ('GPU figures are modelled, not measured: memory traffic and operations of each launch over '
        'an H200\'s data sheet, launches as CUDA graphs, and the measured CPU time of MRF '
        'merging, which has no kernel.')


def bench(shop, size, regions, shift, is_literal=False):
    key = ('bench', size, regions, shift, is_literal)
    return shop.once(key, lambda: shop.bench(size, regions, shift, is_literal))


def modelled(shop, size, regions, shift):
    """ms of each phase on the GPU: its work and its share of the launches."""
    stages = shop.once(('model', size, regions, shift), lambda: shop.model(size, regions, shift))
    ms = {stage: sum(stages[stage]) for stage in MODELLED}
    ms['mrfmerge'] = bench(shop, size, regions, shift)['mrfmerge']
    ms['total'] = sum(ms.values())
    return ms


def curves(times):
    return {NAMES[stage]: [one[stage] for one in times] for stage in STAGES}


def rows_of(points, times, extra=()):
    return [[point, *(f'{one[stage]:.3f}' for stage in STAGES), f'{one["total"]:.3f}',
             *(column[i] for column in extra)] for i, (point, one) in enumerate(zip(points, times))]


HEADER = [*(f'{name} [ms]' for name in NAMES.values()), 'together [ms]']


def growth(times):
    """How many times as long each phase takes at the last point as at the first."""
    return ', '.join(f'{NAMES[stage]} {times[-1][stage] / max(times[0][stage], 1e-3):.1f}'
                     for stage in STAGES)


def regions_of(shop):
    return shop.choose(REGIONS, (10, 160))


def figure_14(shop):
    made = Section()
    size, regions = (200, 200), regions_of(shop)
    ours = [bench(shop, size, n, 20) for n in regions]
    literal = [bench(shop, size, n, 20, True) for n in regions]
    made.finding = (f'From {regions[0]} to {regions[-1]} regions the phases grow by these factors: '
                    f'{growth(ours)}.')
    for name, times, words in (('fig-14', ours, 'Our defaults'),
                               ('fig-14-literal', literal, 'The paper\'s own system, literally')):
        made.picture(plots.lines(shop.output, name, regions, curves(times),
                                 ('largest number of regions', 'ms of one core a frame'),
                                 is_log=True),
                     f'{words}: 200x200, shifts of up to 20 px, medians, logarithmic')
    found = [one['regions'] for one in ours]
    made.table(['regions at most', *HEADER, 'regions found'], rows_of(regions, ours, [found]),
               'Our defaults')
    made.table(['regions at most', *HEADER], rows_of(regions, literal), 'Literally')
    made.text('The paper prints no numbers for this figure. It concludes that segmentation and '
              'graph hardly depend on the number of regions, motion on it and on the shift, and '
              'that merging grows faster than the number. Literally, the factors are '
              f'{growth(literal)}.')
    return made


def sizes(shop):
    made = Section()
    shown = shop.choose(published.SIZES, ((100, 100), (640, 480)))
    ours = [bench(shop, size, 160, 20) for size in shown]
    gpu = [modelled(shop, size, 160, 20) for size in shown]
    names = [f'{width}x{height}' for width, height in shown]
    made.finding = (f'{ours[0]["total"]:.2f} ms at {names[0]}, {ours[-1]["total"]:.2f} ms at '
                    f'{names[-1]}, with at most 160 regions and shifts of up to 20 px.')
    made.picture(plots.stacked(shop.output, 'sizes', names, curves(ours),
                               ('frame', 'ms of one core a frame')),
                 'CPU, measured')
    made.picture(plots.stacked(shop.output, 'sizes-gpu', names, curves(gpu),
                               ('frame', 'ms a frame')),
                 'GPU (H200), modelled; merging measured on the CPU')
    made.table(['frame', *HEADER], rows_of(names, ours), 'CPU, measured')
    made.table(['frame', *HEADER], rows_of(names, gpu), 'GPU (H200), modelled')
    made.text(NOTE)
    return made


def sweep(shop):
    """{shift: times by number of regions} at 640x480."""
    shifts = shop.choose(SHIFTS, (5, 20))
    return {shift: [bench(shop, (640, 480), n, shift) for n in regions_of(shop)]
            for shift in shifts}


def literal_at_160(shop):
    return bench(shop, (640, 480), 160, 20, True)


def figure_20(shop):
    made = Section()
    regions, times = regions_of(shop), sweep(shop)
    gpu = [modelled(shop, (640, 480), n, 20) for n in regions]
    last, literal = times[20][-1], literal_at_160(shop)
    cpu, on_gpu = published.CPU_MS, published.GPU_MS
    made.finding = (f'With 160 regions and shifts of up to 20 px a frame takes {last["total"]:.2f} '
                    f'ms of one core here: {cpu / last["total"]:.0f} times as fast as the paper\'s '
                    f'CPU, {on_gpu / last["total"]:.1f} times as fast as its GPU.')
    made.picture(plots.panels(shop.output, 'fig-20', regions,
                              {f'shift {shift} px': curves(one) for shift, one in times.items()},
                              ('regions at most', 'ms of one core a frame'), is_log=True),
                 'CPU, measured: 640x480, by the largest shift')
    made.picture(plots.lines(shop.output, 'fig-20-gpu', regions, curves(gpu),
                             ('regions at most', 'ms a frame')),
                 'GPU (H200), modelled, shift 20 px; merging measured on the CPU')
    for shift, one in times.items():
        made.table(['regions at most', *HEADER], rows_of(regions, one),
                   f'CPU, measured, shifts of up to {shift} px')
    made.table(['regions at most', *HEADER], rows_of(regions, gpu), 'GPU (H200), modelled')
    made.text(f'The paper: {cpu} ms on its CPU and {on_gpu} ms on its GPU, that is '
              f'{cpu / on_gpu:.1f} times, or {100 * (1 - on_gpu / cpu):.1f} % less. "An order of '
              '64 %" is wrong, "64 times" is right. Its own system, literally, takes '
              f'{literal["total"]:.0f} ms of one core here, of which '
              f'{literal["prmmotion"]:.0f} ms are the sums of absolute differences.')
    made.text(f'{NOTE} Frames: {last["scene"]}.')
    return made


def figure_21(shop):
    made = Section()
    regions, times = regions_of(shop), sweep(shop)
    rate = {f'one core, shift {shift} px': [1000 / one['total'] for one in by]
            for shift, by in times.items()}
    gpu = [1000 / modelled(shop, (640, 480), n, 20)['total'] for n in regions]
    rate['GPU (H200), modelled'] = gpu
    rate['paper'] = [published.GPU_FPS.get(n) for n in regions]
    cpu = rate[f'one core, shift {max(times)} px']
    made.finding = (f'{cpu[0]:.0f} to {cpu[-1]:.0f} frames a second on one core with {regions[0]} '
                    f'to {regions[-1]} regions; the paper\'s GPU made 86 to 44, on average '
                    f'{published.GPU_MEAN_FPS}.')
    made.picture(plots.lines(shop.output, 'fig-21', regions, rate,
                             ('regions at most', 'frames a second'), is_log=True),
                 'Frames of 640x480 a second by equation (13), logarithmic')
    made.table(['regions at most', *rate],
               [[n, *('' if values[i] is None else f'{values[i]:.0f}' for values in rate.values())]
                for i, n in enumerate(regions)])
    made.text(f'{NOTE} The paper needs {published.NEEDED_FPS[0]} to {published.NEEDED_FPS[1]} '
              'frames a second.')
    return made
