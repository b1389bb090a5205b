#!/usr/bin/python3
"""Compares the results of two complete runs of one description bit by bit.

  same_results.py FOLDER OTHER

Compared are series.h5, every frame, final.h5, packing.txt, and what run.json says of the run: all but clock times, the
computer and the command. The state in final.h5 holds clock times too. Other runs of the same description tell where they are:
Reference takes several; what differs between them, up to 7 bytes on each side included, is not compared, nor are zeros between such
bytes. The two runs of the command line are not enough for that, so that their states are not compared.

Exit status: 0 all bits are the same; 1 some differ; 2 wrong use.
"""
import argparse
import json
import re
import sys
from pathlib import Path

import h5py
import numpy

# Of run.json.
FACTS = ('status', 'seed', 'stage', 'time', 'steps', 'bodies', 'time_step_s', 'critical_time_step_s', 'contacts_per_body', 'rebuilds',
         'warnings')
# The time of day at which a run began, in its state: the length of a text, and the text. Stages with clock times follow.
STARTED = re.compile(rb'\x14\0{7}\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ')
LENGTH = 8                                               # bytes of the length of a list in a state
CLOCKS = 2 * 8                                           # bytes of the two clock times that follow the stages
WIDEST_GAP = 64                                          # bytes of clock times that are all 0, between others
MOST_CLOCKS = 0.02                                       # of the bytes of a state
SHOWN = 4                                                # differences of one kind


def bits(value):
    """A value of HDF5 as something that is equal only if all bits are."""
    array = numpy.asarray(value)
    if array.dtype.hasobject:
        return array.shape, repr(array.tolist())
    return array.dtype.str, array.shape, array.tobytes()


def content(path):
    """All datasets and attributes of a file, by their paths in it."""
    found = {}

    def visit(name, item):
        for key, value in item.attrs.items():
            found[f'{name}@{key}'] = bits(value)
        if isinstance(item, h5py.Dataset):
            found[name] = bits(item[...])

    with h5py.File(path) as file:
        visit('', file)
        file.visititems(visit)
    return found


def without_clocks(stages):
    return [{key: value for key, value in stage.items() if key != 'wall_s'} for stage in stages]


def facts(folder):
    """What run.json says that does not depend on clocks and the computer."""
    run = json.loads((folder / 'run.json').read_text(encoding='utf-8'))
    found = {key: run.get(key) for key in FACTS}
    found['stages'] = without_clocks(run.get('stages', []))
    found['samples'] = {name: probe['samples'] for name, probe in run.get('probes', {}).items()}
    return found


class State:
    """The state in final.h5: bytes before the facts of run.json, these facts, bytes after them."""

    def __init__(self, folder):
        with h5py.File(folder / 'final.h5') as file:
            state = numpy.asarray(file['state'][...]).tobytes()
        *_, started = STARTED.finditer(state)            # the last one
        begin = started.end() + LENGTH
        end = begin + int.from_bytes(state[started.end():begin], 'little')
        self.before = numpy.frombuffer(state[:started.start()], numpy.uint8)
        self.stages = without_clocks(json.loads(state[begin:end]))
        self.after = state[end + CLOCKS:]


def near(marked):
    """True where one of eight neighbours is: a clock time has eight bytes, some of which may be the same by chance."""
    wide = marked.copy()
    for by in range(1, 8):
        wide[by:] |= marked[:-by]
        wide[:-by] |= marked[by:]
    return wide


def clocks_of(states):
    """The bytes of clock times in states that are otherwise the same. Zeros between clock times are of what took no time."""
    differ = numpy.zeros(len(states[0]), bool)
    for state in states[1:]:
        differ |= state != states[0]
    marked = near(differ)
    places = numpy.flatnonzero(marked)
    for last, first in zip(places[:-1], places[1:]):
        if 1 < first - last <= WIDEST_GAP and not any(state[last + 1:first].any() for state in states):
            marked[last:first] = True
    return marked


class Reference:
    """Undisturbed runs of one description, with which others are compared. Throws ValueError if they differ themselves."""

    def __init__(self, folders):
        self.folder = folders[0]
        self.clocks = None                               # the bytes of the state that are not compared
        states = [State(folder) for folder in folders]
        self.state = states[0]
        for folder, state in zip(folders[1:], states[1:]):
            lines = differences(self.folder, folder)
            if not lines and len(state.before) != len(self.state.before):
                lines = ['final.h5: the states have different lengths']
            if lines:
                raise ValueError(f'{folder} differs from {self.folder}, though neither was disturbed: ' + '; '.join(lines))
        if len(states) > 1:
            self.clocks = clocks_of([state.before for state in states])
            if self.clocks.mean() > MOST_CLOCKS:
                raise ValueError(f'{self.folder}: {self.clocks.mean():.0%} of the states of undisturbed runs differ; not only clock times do')

    def differences(self, folder):
        """Lines that describe how a run differs."""
        lines = differences(self.folder, folder)
        if self.clocks is None or lines:
            return lines
        state = State(folder)
        if len(state.before) != len(self.state.before):
            return ['final.h5: the state has another length']
        wrong = numpy.flatnonzero((state.before != self.state.before) & ~self.clocks)
        if len(wrong):
            lines.append(f'final.h5: {len(wrong)} bytes of the state differ, the first is byte {wrong[0]}')
        if state.stages != self.state.stages or state.after != self.state.after:
            lines.append('final.h5: the facts of the run in the state differ')
        return lines


def compared(where, a, b):
    """Lines for the keys at which two dictionaries differ."""
    keys = [key for key in sorted(a.keys() | b.keys()) if a.get(key) != b.get(key)]
    lines = [f'{where}: {key} differs' if key in a and key in b else f'{where}: {key} is only in one of them' for key in keys[:SHOWN]]
    return lines + ([f'{where}: and {len(keys) - SHOWN} more'] if len(keys) > SHOWN else [])


def differences(a, b):
    """Lines that describe how two folders of results differ, except for the states."""
    lines = compared('series.h5', content(a / 'series.h5'), content(b / 'series.h5'))
    frames, others = ({path.name for path in (folder / 'frames').glob('*.h5')} for folder in (a, b))
    if frames != others:
        lines.append(f'frames: {len(frames)} and {len(others)} files')
    for name in sorted(frames & others):
        lines += compared(f'frames/{name}', content(a / 'frames' / name), content(b / 'frames' / name))
    ends = []
    for folder in (a, b):
        end = content(folder / 'final.h5')
        end['state'] = end['state'][0]                   # compared by Reference
        ends.append(end)
    lines += compared('final.h5', *ends)
    if (a / 'packing.txt').read_bytes() != (b / 'packing.txt').read_bytes():
        lines.append('packing.txt differs')
    return lines + compared('run.json', facts(a), facts(b))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder', type=Path)
    parser.add_argument('other', type=Path)
    given = parser.parse_args()
    lines = differences(given.folder, given.other)
    print('\n'.join(lines) if lines else 'same bits')
    return 1 if lines else 0


if __name__ == '__main__':
    sys.exit(main())
