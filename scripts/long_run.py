#!/usr/bin/python3
"""A long run that is stopped and continued again and again: memory stays flat, files grow as `grit check` says, and the results have the
same bits as those of runs that were never stopped.

  long_run.py [DESCRIPTION] [--restarts N] [--set /POINTER=VALUE]... [--grit FILE] [--shim FILE] [--markdown [PAGE]]

DESCRIPTION is sims/drum/quick.json unless given: 5·10⁸ particle-steps. It runs with one and with two threads without a stop. Then it
is stopped N times (default 20), at frames that follow each other at equal distances, by a SIGTERM that the library of tests/faults
sends there, and continued with --resume. Memory is the largest of each part, as the system counts it: the last part may take at most
a tenth more than the largest of the first three. Frames may take at most a tenth more than said.

Exit status: 0 all held; 1 not so; 2 wrong use.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import same_results
import tables

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / 'docs' / 'evidence' / 'reliability.md'
HEAD = ('description', 'particle-steps', 'restarts', 'memory of first parts [MB]', 'of the last part [MB]', 'frames as said [MB]', 'found [MB]',
        'result', 'date')

DONE, INTERRUPTED = 0, 130
GROWTH = 1.1                                             # of memory and files
FIRST = 3                                                # parts
POLL = 0.005                                             # s
UNITS = {'kB': 1e-3, 'MB': 1, 'GB': 1e3}


def largest_memory(process):
    """Of a process so far [MB]; 0 if it is no more. That which wait() returns has the memory of this script, before it began."""
    try:
        found = re.search(r'^VmHWM:\s*(\d+) kB$', Path(f'/proc/{process}/status').read_text(encoding='ascii'), re.M)
    except OSError:
        return 0.0
    return int(found[1]) / 1e3 if found else 0.0


def run(words, expected, **environment):
    """Runs grit to this exit status: the largest memory that it had [MB]. Throws ValueError for another status."""
    with tempfile.TemporaryFile() as log, subprocess.Popen([*words, '--quiet', '--no-report'], stdout=log, stderr=log,
                                                           env=os.environ | environment) as process:
        memory = 0.0
        while process.poll() is None:
            memory = max(memory, largest_memory(process.pid))
            time.sleep(POLL)
        if process.returncode != expected:
            log.seek(0)
            raise ValueError(f'exit status {process.returncode}, not {expected}: {log.read().decode(errors="replace")[-500:]}')
        return memory


def stops(folder, restarts):
    """The frames at which a run like that in the folder is stopped. Throws ValueError if it has too few."""
    frames = sorted(path.name for path in (folder / 'frames').glob('*.h5'))[1:-1]
    if len(frames) < restarts:
        raise ValueError(f'{restarts} restarts need {restarts + 2} frames, but the run has {len(frames) + 2}; set /output/frames')
    return [frames[(2 * i + 1) * len(frames) // (2 * restarts)] for i in range(restarts)]


def said_of_frames(grit, words):
    """The size of all frames that `grit check` says [MB]."""
    text = subprocess.run([grit, 'check', *words], capture_output=True, text=True, check=True).stdout
    found = re.search(r'^frames: .* ([\d.]+) (kB|MB|GB) in all', text, re.M)
    return float(found[1]) * UNITS[found[2]] if found else 0.0


def size(folder):
    return sum(file.stat().st_size for file in folder.rglob('*') if file.is_file()) / 1e6


def long_run(given, place):
    """The row of the table, and lines for what did not hold. Throws ValueError."""
    description = [given.description, *(word for one in given.set for word in ('--set', one))]
    whole, again, part = place / 'whole', place / 'again', place / 'part'
    run([given.grit, 'run', *description, '--threads', '1', '--out', whole], DONE)
    run([given.grit, 'run', *description, '--threads', '2', '--out', again], DONE)
    memory, command = [], [given.grit, 'run', *description, '--threads', '1', '--out', part]
    for frame in stops(whole, given.restarts):
        memory.append(run(command, INTERRUPTED, LD_PRELOAD=str(given.shim), FAULTS_BELOW=str(part / 'frames' / frame), FAULTS_FAIL='rename:1:TERM:once'))
        command = [given.grit, 'run', '--resume', part, '--threads', '1']
        print(f'stopped at {frame}: {memory[-1]:.1f} MB', flush=True)
    memory.append(run(command, DONE))
    facts = json.loads((part / 'run.json').read_text(encoding='utf-8'))
    said, found = said_of_frames(given.grit, description), size(part / 'frames')
    lines = same_results.Reference([whole, again]).differences(part)
    if facts['resumed'] != given.restarts:
        lines.append(f'run.json has {facts["resumed"]} restarts, not {given.restarts}')
    if memory[-1] > GROWTH * max(memory[:FIRST]):
        lines.append(f'memory grows: {", ".join(f"{one:.1f}" for one in memory)} MB')
    if found > GROWTH * said:
        lines.append(f'frames take {found:.1f} MB, but check says {said:.1f} MB')
    sims = ROOT / 'sims'
    name = given.description.relative_to(sims).with_suffix('') if given.description.is_relative_to(sims) else given.description.stem
    return [name, f'{facts["steps"] * facts["bodies"]:.2g}', given.restarts, f'{min(memory[:FIRST]):.1f} … {max(memory[:FIRST]):.1f}', f'{memory[-1]:.1f}',
            f'{said:.1f}', f'{found:.1f}', '; '.join(lines) or 'same bits', tables.today()], lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('description', type=Path, nargs='?', default=ROOT / 'sims/drum/quick.json', metavar='DESCRIPTION')
    parser.add_argument('--restarts', type=int, default=20, metavar='N')
    parser.add_argument('--set', action='append', default=[], metavar='/POINTER=VALUE')
    parser.add_argument('--grit', type=Path, default=ROOT / 'build/bin/grit', metavar='FILE')
    parser.add_argument('--shim', type=Path, default=ROOT / 'build/tests/faults/faults_shim.so', metavar='FILE')
    parser.add_argument('--markdown', type=Path, nargs='?', const=PAGE, metavar='PAGE')
    given = parser.parse_args()
    for file in (given.grit, given.shim, given.description):
        if not file.is_file():
            parser.error(f'{file} does not exist')
    if given.restarts < 1:
        parser.error(f'--restarts: found {given.restarts}; allowed is a number from 1')
    given.grit, given.shim, given.description = given.grit.resolve(), given.shim.resolve(), given.description.resolve()
    with tempfile.TemporaryDirectory(prefix='grit-long-run-') as place:
        try:
            row, lines = long_run(given, Path(place))
        except ValueError as error:
            print(f'long_run: {error}', file=sys.stderr)
            return 1
    print(tables.table(HEAD, [row]), end='')
    for line in lines:
        print(f'long_run: {line}', file=sys.stderr)
    if given.markdown and not lines:
        given.markdown.write_text(tables.with_row(given.markdown.read_text(encoding='utf-8'), 'long runs', [str(cell) for cell in row]), encoding='utf-8')
    return 1 if lines else 0


if __name__ == '__main__':
    sys.exit(main())
