#!/usr/bin/python3
"""Runs descriptions with two builds and compares their series bit by bit.

  same_bits.py OLD [NEW] [--only PATTERN] [--seconds S] [--renames FILE]

OLD and NEW are trees with a build in build/, each of which runs its own descriptions; NEW is this tree unless given.
By default all sims/*/quick*.json run to their ends. With --seconds a run is interrupted after S seconds, and the samples
that both builds reached are compared, except the last one, which is taken at the interruption. FILE lists what was renamed
in NEW: {"groups": {"old": "new"}, "channels": {"old": "new"}}; scripts/renames.json unless given. An old channel is a
regular expression for "channel", or for "group/channel" in the old series, and a new one its expansion.

Exit status: 0 all bits are the same; 1 some differ, or a run failed; 2 wrong use.
"""
import argparse
import json
import re
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parent.parent
INTERRUPTED = 130


def run(tree, description, folder, seconds):
    """Whether the run reached its end."""
    command = [tree / 'build/bin/grit', 'run', description, '--out', folder, '--threads', '1', '--quiet', '--no-report']
    with subprocess.Popen(command, cwd=tree, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        try:
            _, errors = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate()
    if process.returncode not in (0, INTERRUPTED):
        raise RuntimeError(f'{tree}: {description}: exit status {process.returncode}\n{errors}')
    return process.returncode == 0


def series(folder):
    """All datasets of series.h5 as {(group, channel): array}."""
    found = {}
    with h5py.File(folder / 'series.h5') as file:
        for group, members in file.items():
            for channel, dataset in members.items():
                found[group, channel] = dataset[...]
    return found


def renamed(found, renames, present):
    """`found` under the names of today. What `present` knows by its name has been renamed already."""
    def channel_of(group, channel):
        if (groups.get(group, group), channel) in present:
            return channel
        for old, new in renames.get('channels', {}).items():
            match = re.fullmatch(old, f'{group}/{channel}' if '/' in old else channel)
            if match:
                return match.expand(new)
        return channel

    groups = renames.get('groups', {})
    return {(groups.get(group, group), channel_of(group, channel)): values for (group, channel), values in found.items()}


def differences(old, new, whole):
    """Lines that describe the differences, and the number of samples compared."""
    lines, compared = [], 0
    for name in sorted(old.keys() ^ new.keys()):
        lines.append(f'{"/".join(name)} is only in the {"old" if name in old else "new"} series')
    for name in sorted(old.keys() & new.keys()):
        a, b = old[name], new[name]
        if not whole:
            count = max(0, min(len(a), len(b)) - 1)
            a, b = a[:count], b[:count]
        compared += len(a)
        if a.shape != b.shape:
            lines.append(f'{"/".join(name)}: shape {a.shape} before, {b.shape} now')
        elif a.tobytes() != b.tobytes():
            at = numpy.flatnonzero((a != b).reshape(len(a), -1).any(axis=1))
            lines.append(f'{"/".join(name)}: {len(at)} of {len(a)} samples differ, the first is sample {at[0] if len(at) else "?"}')
    return lines, compared


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('old', type=Path)
    parser.add_argument('new', type=Path, nargs='?', default=ROOT)
    parser.add_argument('--only', default='sims/*/quick*.json', metavar='PATTERN', help='glob in the trees')
    parser.add_argument('--seconds', type=float, help='interrupt each run after this time')
    parser.add_argument('--renames', type=Path, default=ROOT / 'scripts/renames.json')
    given = parser.parse_args()
    for tree in (given.old, given.new):
        if not (tree / 'build/bin/grit').is_file():
            parser.error(f'{tree}/build/bin/grit does not exist; build that tree')
    renames = json.loads(given.renames.read_text(encoding='utf-8')) if given.renames.is_file() else {}
    descriptions = sorted(path.relative_to(given.new) for path in given.new.glob(given.only))
    if not descriptions:
        parser.error(f'no description matches {given.only}')
    added = [description for description in descriptions if not (given.old / description).is_file()]
    for description in added:
        print(f'{description}: only in the new tree, not compared')
    descriptions = [description for description in descriptions if description not in added]

    failed = 0
    for description in descriptions:
        with tempfile.TemporaryDirectory() as place:
            folders = [Path(place) / 'old', Path(place) / 'new']
            try:
                done = [run(tree.resolve(), description, folder, given.seconds)
                        for tree, folder in zip((given.old, given.new), folders)]
                old, new = (series(folder) for folder in folders)
                lines, compared = differences(renamed(old, renames, new), new, all(done))
            except (RuntimeError, OSError) as error:
                lines, compared = [str(error)], 0
        if not lines and not compared:
            lines = ['no sample was compared; let the runs take longer with --seconds']
        failed += bool(lines)
        print(f'{description}: ' + ('not the same' if lines else f'same bits, {compared} samples'), flush=True)
        for line in lines:
            print(f'  {line}')
    print(f'{len(descriptions) - failed} of {len(descriptions)} descriptions have the same bits')
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
