#!/usr/bin/env python3
"""Measures how fast grains flow through round holes and slots, against Beverloo's law: writes docs/beverloo.md.

  beverloo.py [BUILD]      BUILD is build unless given; results/beverloo has the runs, and those that are done are not run again

Runs of sims/beverloo, a minute or two each on one core, one after the other. Needs python3-h5py.
"""
import json
import math
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[1]
SEEDS = (1,)
KEEPS_OFF = 1.4                                          # Beverloo's own k
# Diameter or width [mm], and the share of the mass that leaves.
OUTLETS = {'hole': ((6, 0.08), (7, 0.12), (9, 0.2), (12, 0.3)), 'slot': ((6, 0.2), (7, 0.25), (9, 0.3), (12, 0.35))}
STEADY_FROM = 0.03                                       # share

HEAD = '''## Beverloo's law
Written by `scripts/beverloo.py` from runs of [sims/beverloo](../sims/beverloo). Do not edit. Grains of 0.9 to 1.1 mm (d = 1 mm) without rolling resistance,
friction 25°, flow out of a flat-bottomed bin through a round hole (22 000 grains), or through a slot of which 10 mm repeat (16 000). Rates are
slopes of the mass that has left, from 3 % of it on; fitted is C (D − k d)^n with k = 1.4 and the n that fits best.

| outlet | D/d | rate, g/s | fitted |
| --- | --- | --- | --- |
'''


def settings(kind, width, share, seed):
    half = f'{0.5e-3 * width:g}'
    of = {'hole': [f'/walls/bottom/start_radius={half}'],
          'slot': [f'/walls/bottom-left/edge_a/0={25e-3 - 0.5e-3 * width:g}', f'/walls/bottom-right/corner/0={half}']}
    return of[kind] + [f'/stages/1/until/share={share:g}', f'/seed={seed}']


def run(grit, kind, width, share, seed):
    """The results' folder of one outlet."""
    folder = ROOT / 'results' / 'beverloo' / f'{kind}-{width}-{seed}'
    try:
        if json.loads((folder / 'run.json').read_text())['status'] == 'done':
            return folder
    except FileNotFoundError:
        pass
    sets = [word for one in settings(kind, width, share, seed) for word in ('--set', one)]
    subprocess.run([grit, 'run', ROOT / 'sims' / 'beverloo' / f'{kind}.json', '--threads', '1', '--overwrite', '--out',
                    folder, *sets], check=True)
    return folder


def slope(points):
    """Of the straight line through points, by least squares."""
    n = len(points)
    x, y = (sum(p[k] for p in points) / n for k in (0, 1))
    return sum((p[0] - x) * (p[1] - y) for p in points) / sum((p[0] - x) ** 2 for p in points)


def rate(folder):
    """Mass that leaves in a second [g/s], once it flows steadily."""
    import h5py
    with h5py.File(folder / 'series.h5') as series:
        flow = {name: series['flow'][name][:] for name in ('time', 'mass', 'mass_left')}
    all_mass = flow['mass'][-1] + flow['mass_left'][-1]
    return 1e3 * slope([(t, m) for t, m in zip(flow['time'], flow['mass']) if m > STEADY_FROM * all_mass])


def exponent(rates, keeps_off):
    """(n, ln C) of W = C (D − k d)^n, d = 1 mm."""
    points = [(math.log(width - keeps_off), math.log(w)) for width, w in rates]
    n = slope(points)
    return n, sum(y - n * x for x, y in points) / len(points)


def main():
    grit = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / 'build').resolve() / 'bin' / 'grit'
    found = {kind: [(width, [rate(run(grit, kind, width, share, seed)) for seed in SEEDS]) for width, share in outlets]
             for kind, outlets in OUTLETS.items()}
    means = {kind: [(width, sum(rates) / len(rates)) for width, rates in outlets] for kind, outlets in found.items()}
    text = HEAD
    for kind, rates in found.items():
        n, constant = exponent(means[kind], KEEPS_OFF)
        for width, samples in rates:
            fitted = math.exp(constant) * (width - KEEPS_OFF) ** n
            text += f'| {kind} | {width} | {", ".join(f"{one:.2f}" for one in samples)} | {fitted:.2f} |\n'
    text += '\n| k | exponent of holes, 2.5 by Beverloo | of slots, 1.5 |\n| --- | --- | --- |\n'
    for k in (1.2, 1.4, 1.6, 1.8, 2.0):
        text += f'| {k} | {exponent(means["hole"], k)[0]:.2f} | {exponent(means["slot"], k)[0]:.2f} |\n'
    page = ROOT / 'docs' / 'beverloo.md'
    page.write_text(text, encoding='utf-8')
    print(text)


if __name__ == '__main__':
    main()
