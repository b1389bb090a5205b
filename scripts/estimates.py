#!/usr/bin/env python3
"""Compares the times that `grit check` estimates for sims/*/quick*.json with those of their runs: writes docs/evidence/estimates.md.

  estimates.py [--only PATTERN] [--at-most MINUTES] [BUILD]

BUILD is build unless given. Runs are in results/estimates; finished ones are not run again. --only runs the descriptions that
match (as 'triaxial/*'), --at-most those whose estimate is not longer. The page lists all whose runs are finished. All take
about two hours of one core.
"""
import argparse
import fnmatch
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RUNS = ROOT / 'results' / 'estimates'
PAGE = ROOT / 'docs' / 'evidence' / 'estimates.md'
FACTOR = 2                                               # between the estimate and the run
SECONDS = {'h': 3600, 'min': 60, 's': 1}

HEAD = '''# Estimated times of runs
Written by `scripts/estimates.py`. Do not edit.

'''
TABLE = '''
Seconds of one core. The number of steps depends on typical durations of stages, that of bodies on streams, but not on bodies that leave.
A stage without `typical_time` counts as long as its condition cannot be met: then the time is between two bounds.

| description | estimate, s | run, s | run over estimate | steps, estimate | steps, run | M particle-steps/s at the end |
| --- | --- | --- | --- | --- | --- | --- |
'''


def seconds(text):
    """Of a duration as grit writes it: '1 min 46 s'."""
    return sum(int(count) * SECONDS[unit] for count, unit in re.findall(r'(\d+) (h|min|s)\b', text))


def estimate(text):
    """What `grit check` printed: seconds, whether that is a lower bound, the upper bound, and the number of steps."""
    match = re.search(r'^estimated time.* M particle-steps/s: [0-9.]+ h \((.*?)\)( at least)?(?:.*?, at most [0-9.]+ h \((.*?)\))?', text, re.M)
    least = max(seconds(match[1]), 0.5)                  # printed without decimals
    steps = sum(int(count) for count in re.findall(r'^  .* s, (\d+) steps', text, re.M))
    return {'seconds': least, 'at_least': match[2] is not None, 'most': seconds(match[3]) if match[3] else least, 'steps': steps}


def holds(expected, took):
    """Whether a run took as long as estimated, within the factor."""
    most = expected['most'] if expected['at_least'] else expected['seconds']
    return expected['seconds'] / FACTOR <= took <= most * FACTOR


def row(name, expected, run):
    words = f"{expected['seconds']:g} … {expected['most']:g}" if expected['at_least'] else f"{expected['seconds']:g}"
    took = run['cpu_s']
    over = '' if expected['at_least'] else f"{took / expected['seconds']:.2f}"
    speed = 1e-6 * run['steps'] * run['bodies'] / took
    return f"| {name} | {words} | {took:.1f} | {over} | {expected['steps']} | {run['steps']} | {speed:.1f} |\n"


def page(found):
    """`found`: by name of the description its estimate and the run.json of its run."""
    missed = [name for name, (expected, run) in found.items() if not holds(expected, run['cpu_s'])]
    text = (f'**Summary.** Does `grit check` estimate the time of a run? {len(found) - len(missed)} of {len(found)} quick descriptions took the '
            f'estimated time within a factor of {FACTOR}.\n')
    if missed:
        text += f'Others: {", ".join(missed)}.\n'
    return HEAD + text + TABLE + ''.join(row(name, *both) for name, both in sorted(found.items()))


def finished(name):
    """run.json of a finished run, or None."""
    try:
        run = json.loads((RUNS / name.replace('/', '-') / 'run.json').read_text(encoding='utf-8'))
    except FileNotFoundError:
        return None
    return run if run['status'] == 'done' else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--only', default='*')
    parser.add_argument('--at-most', type=float, default=float('inf'), metavar='MINUTES')
    parser.add_argument('build', nargs='?', default=ROOT / 'build', type=Path)
    given = parser.parse_args()
    grit = given.build.resolve() / 'bin' / 'grit'
    found = {}
    for file in sorted(ROOT.glob('sims/*/quick*.json')):
        name = f'{file.parent.name}/{file.stem}'
        expected = estimate(subprocess.run([grit, 'check', file, '--threads', '1'], check=True, capture_output=True, text=True).stdout)
        run = finished(name)
        if run is None and fnmatch.fnmatch(name, given.only) and expected['seconds'] <= 60 * given.at_most:
            subprocess.run([grit, 'run', file, '--threads', '1', '--overwrite', '--no-report', '--quiet', '--out', RUNS / name.replace('/', '-')],
                           check=True)
            run = finished(name)
        if run is not None:
            found[name] = expected, run
    PAGE.write_text(page(found), encoding='utf-8')
    return 0 if all(holds(expected, run['cpu_s']) for expected, run in found.values()) else 1


if __name__ == '__main__':
    sys.exit(main())
