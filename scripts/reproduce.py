#!/usr/bin/python3
"""Writes docs/reproduction.md: what tests of the reference work come to in grit, beside what they came to there.

  reproduce.py [--run GLOB]… [--threads N] [--results FOLDER] [--grit FILE]

docs/reproduction.json has the figures. Each description of sims/ whose finished run lies in FOLDER/TEST/NAME (results/reproduce
unless given) gets its rows; the others are listed with the time they would take. --run runs those that GLOB fits and
that are not there yet, e.g. --run '*/quick*', --run interface-shear/full-rn-100.
"""
import argparse
import fnmatch
import json
import re
import subprocess
import sys
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parents[1]
HEAD = '''# Reproduction
Written by `scripts/reproduce.py` from finished runs of [sims](../sims); do not edit. The reference is YADE's (A. Grabowski, doctoral dissertation,
Gdańsk 2024), at full size. `full` descriptions are of that size; `quick` ones are smaller boxes with fewer grains, sheared faster, to show order and
shape, and differ as the notes below them say. Either is one sample of one packing.

'''


def found(series, row):
    """The figure that a row asks for."""
    of, how = series[row['of']][:], row['how']
    if how == 'maximum':
        figure = of.max()
    elif how == 'last':
        figure = of[-1]
    elif how == 'mean of the last quarter':
        figure = of[-max(1, len(of) // 4):].mean()
    elif how == 'at the start':  # the last sample before the test moves
        figure = of[numpy.nonzero(series[row['before']][:] <= 0)[0][-1]]
    elif how == 'where largest':
        figure = series[row['against']][of.argmax()]
    else:
        sys.exit(f'docs/reproduction.json: found "how": "{how}"; allowed are maximum, last, mean of the last quarter, at the start, '
                 'where largest')
    return row.get('scale', 1) * float(figure)


def state(folder):
    """What run.json says of a run, or None."""
    try:
        return json.loads((folder / 'run.json').read_text(encoding='utf-8'))
    except (FileNotFoundError, json.JSONDecodeError):
        return None


def lacks(series, row):
    """The first channel of a row that a run did not record, or None."""
    return next((row[key] for key in ('of', 'against', 'before') if key in row and row[key] not in series), None)


def table(name, folder, run, rows, note, older):
    yield f'## {name}\n'
    yield (f"{run['bodies']:,} bodies, {run['steps']:,} steps, {run['wall_s']:.0f} s on {run['threads']} "
           f"thread{'s' if run['threads'] > 1 else ''}, {run['particle_steps_per_s'] / 1e6:.1f} M particle-steps/s.\n")
    yield '| figure | reference | grit | deviation | |'
    yield '| --- | --- | --- | --- | --- |'
    with h5py.File(folder / 'series.h5') as series:
        for row in rows:
            reference, allowed = row['reference'], row['allowed']
            if channel := lacks(series, row):
                if not older:
                    sys.exit(f'docs/reproduction.json: {name}, "{row["figure"]}": found the channel "{channel}", which '
                             f'{folder / "series.h5"} lacks; correct it, run {name} again, or name it under "older" if its '
                             'run is from before there was that channel')
                yield f"| {row['figure']} | {reference:g} ± {allowed:g} | not recorded | | |"
                continue
            figure = found(series, row)
            verdict = 'within' if abs(figure - reference) <= allowed else 'outside'
            yield f"| {row['figure']} | {reference:g} ± {allowed:g} | {figure:.3g} | {figure - reference:+.2g} | {verdict} |"
    if note:
        yield '\n' + note
    yield ''


def estimate(program, description):
    words = subprocess.run([program, 'check', description], capture_output=True, text=True, check=False).stdout
    match = re.search(r'^estimated time.*$', words, re.M)
    return match.group(0) if match else 'grit check refuses it'


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--run', action='append', default=[], metavar='GLOB')
    parser.add_argument('--threads', default='2')
    parser.add_argument('--results', default=ROOT / 'results' / 'reproduce', type=Path)
    parser.add_argument('--grit', default=ROOT / 'build' / 'bin' / 'grit')
    given = parser.parse_args()
    reference = json.loads((ROOT / 'docs' / 'reproduction.json').read_text(encoding='utf-8'))
    names = list(dict.fromkeys(row['description'] for row in reference['figures']))

    for name in names:
        folder = given.results / name
        if (state(folder) or {}).get('status') != 'done' and any(fnmatch.fnmatch(name, glob) for glob in given.run):
            subprocess.run([given.grit, 'run', ROOT / 'sims' / f'{name}.json', '--out', folder, '--overwrite',
                            '--threads', given.threads], check=False)

    lines, missing = [], []
    for name in names:
        folder = given.results / name
        run = state(folder)
        if run is None or run['status'] != 'done':
            stopped = run['message'] if run and run['status'] == 'failed' else ''
            missing.append(f"| {name} | {estimate(given.grit, ROOT / 'sims' / f'{name}.json')} | {stopped} |")
        else:
            lines += table(name, folder, run, [row for row in reference['figures'] if row['description'] == name],
                           reference['notes'].get(name), name in reference['older'])
    if missing:
        lines += ['## Not run to their ends', '| description | by `grit check` | |', '| --- | --- | --- |', *missing]
    (ROOT / 'docs' / 'reproduction.md').write_text(HEAD + '\n'.join(lines) + '\n', encoding='utf-8')
    print(f'docs/reproduction.md: {len(names) - len(missing)} of {len(names)} descriptions')


main()
