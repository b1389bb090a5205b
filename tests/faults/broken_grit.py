#!/usr/bin/python3
"""Stands for a grit that is wrong: runs $BROKEN_GRIT and spoils what $BROKEN_HOW names. scripts/faults.py has to notice."""
import os
import signal
import subprocess
import sys
from pathlib import Path

GRIT, HOW, WORDS = os.environ['BROKEN_GRIT'], os.environ['BROKEN_HOW'], sys.argv[1:]
FILES, DEFECT = 5, 70


def folder():
    """Of the results."""
    return Path(WORDS[WORDS.index('--out') + 1] if '--out' in WORDS else WORDS[1])


def run():
    """Its exit status. What ends this process ends that one."""
    with subprocess.Popen([GRIT, *WORDS]) as process:
        signal.signal(signal.SIGTERM, lambda *_: process.send_signal(signal.SIGTERM))
        return process.wait()


def drop_a_sample(file):
    def cut(_, item):
        if hasattr(item, 'resize') and len(item) > 1:    # not a group
            item.resize(len(item) - 1, axis=0)

    next(iter(file.values())).visititems(cut)


def change_a_bit(file):
    time = next(iter(file.values()))['time']
    values = time[...]
    values.view('u1')[-1] ^= 1
    time[...] = values


def change_the_state(file):
    """A coordinate of the first wall, or a count, is near the beginning."""
    state = file['state'][...]
    state[64] ^= 1
    file['state'][...] = state


AFTER = {'sample': ('series.h5', drop_a_sample), 'bit': ('series.h5', change_a_bit), 'state': ('final.h5', change_the_state)}

if '--resume' in WORDS and HOW in AFTER:
    status = run()
    name, spoil = AFTER[HOW]
    if status == 0:
        import h5py                                      # here, as it takes longer than a run
        with h5py.File(folder() / name, 'r+') as opened:
            spoil(opened)
    sys.exit(status)
if '--resume' in WORDS and HOW == 'checkpoint':          # begins anew
    for checkpoint in folder().glob('checkpoint*.h5'):
        checkpoint.unlink()
if HOW == 'status':
    result = run()
    sys.exit(DEFECT if result == FILES else result)
if HOW == 'silence' and 'expand' not in WORDS:
    with open(os.devnull, 'wb') as nowhere:
        sys.exit(subprocess.run([GRIT, *WORDS], stderr=nowhere, check=False).returncode)
os.execv(GRIT, [GRIT, *WORDS])
