#!/usr/bin/python3
"""Disturbs runs of grit and continues them with --resume: nothing that was finished may be lost, and no bit may differ.

  faults.py [--times N | --minutes M] [--only FAULT]... [--scene NAME]... [--seed S] [--grit FILE] [--shim FILE] [--markdown [PAGE]]
  faults.py --only FAULT --case I --seed S       repeats one case

Six small scenes run to their ends first, undisturbed, with 1, 2 and 3 threads. Then each fault is applied N times, or all in turn
for M minutes, at random moments beside a busy process: signals, calls of the system that fail or in which the process is killed (by
the library of tests/faults, which a build makes), too little memory, a folder that is removed, clocks that jump, two runs into one
folder. After a fault must hold:

  lost    what is on disk reads; --resume continues from the last checkpoint, or further, with another number of threads, to the end
  bits    all results are those of the undisturbed runs (same_results.py)
  status  the exit status is as documented (grit --help), and the message names a file, a place in the description or a command

Fault, scene and moment of a case follow from the seed. A case that fails keeps its folder, with the messages of its runs in log.txt.
--scale shortens all scenes. --undisturbed takes the undisturbed runs of a campaign that was kept. --markdown writes the table into
PAGE, docs/evidence/reliability.md unless given; rows of other faults stay.

Exit status: 0 all held; 1 some did not; 2 wrong use.
"""
import argparse
import fnmatch
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path

import h5py

import brief
import mpi
import same_results
import tables

ROOT = Path(__file__).resolve().parents[1]
WORK = ROOT / 'results' / 'faults'
PAGE = ROOT / 'docs' / 'evidence' / 'reliability.md'

# Exit statuses of grit (core/src/app/exit_status.hpp).
DONE, DESCRIPTION, PLUGIN, FILES, INTERRUPTED = 0, 2, 3, 5, 130
NOT_LOADED = 127                                         # by the system, which found no memory for its libraries
NOTHING_WRITTEN = 'nothing was written'                  # the message of a run that is interrupted before it begins

CHECKPOINT_EVERY = 0.05                                  # s; no more often than 1 % of the run allows
THREADS = 1, 2, 3                                        # of undisturbed runs
FRAMES = 12                                              # in each scene, about
POLL = 0.002                                             # s
BUSY = 'import os, sys\nwhile os.getppid() == int(sys.argv[1]): pass'  # until this process ends, however it does
SPARE = 1 << 25                                          # bytes of address space
MPI_STARTS, MPI_ENDS = 0.3, 10                          # s, before it computes, and after a rank was killed
PATIENCE = 120                                           # s that a run may take, besides 50 times that of the undisturbed one


# ---- scenes

@dataclass(frozen=True)
class Scene:
    """A short version of a description of sims/: steps of each stage (None: to its own end), values, and groups of bodies that are
    replaced in part."""
    source: str
    steps: tuple
    sets: tuple = ()


SCENES = {
    'silo': Scene('beverloo/slot.json', (5000, 8000), (
        '/bodies/sand/source/high=["20 mm", "10 mm", "6 mm"]', '/bodies/sand/source/count=1400')),
    'clumps': Scene('triaxial/quick-clumps.json', (3000, 2000, 1000, 3000), (
        '/scenario/size=["40 mm", "40 mm", "40 mm"]',)),
    'source': Scene('heap/quick.json', (14000, 2000)),
    'growth': Scene('triaxial/quick-growth.json', (16000, 4000, 4000, 4000, 8000), (
        '/scenario/size=["40 mm", "40 mm", "40 mm"]', '/scenario/void_ratio=0.7')),
    'deforming-cell': Scene('simple-shear/quick.json', (8000, 2000, 8000)),
    'servo': Scene('three-stresses/quick-sample.json', (16000,)),
}


def write_scene(grit, scene, path, scale):
    steps = [max(20, round(scale * count)) for count in scene.steps]
    description = brief.shorten(brief.expanded(grit, ROOT / 'sims' / scene.source, scene.sets), steps)
    brief.set_output(description, frames={'every_steps': max(1, sum(steps) // FRAMES)}, checkpoint_every=CHECKPOINT_EVERY)
    path.write_text(json.dumps(description, indent=1), encoding='utf-8')


# ---- processes

class Process:
    """A run of grit, whose messages are appended to a log, and what it prints to output.txt beside it."""

    def __init__(self, words, log, environment=None, before=None):
        self.log, self.begin = log, log.stat().st_size if log.exists() else 0
        with log.open('ab') as messages, (log.parent / 'output.txt').open('ab') as output:
            messages.write(f'$ {" ".join(map(str, words))} {environment or ""}\n'.encode())
            messages.flush()
            self.process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=output, stderr=messages, cwd=log.parent,
                                            start_new_session=True, env=os.environ | (environment or {}), preexec_fn=before)
        self.started = time.monotonic()
        self.sizes = set()                               # of address space [bytes], since it began

    def ends_within(self, seconds):
        """Waits so long, and sees how much memory it takes. Whether it ended."""
        until = time.monotonic() + seconds
        while self.process.poll() is None:
            if time.monotonic() >= until:
                return False
            self.sizes |= self.sizes_now()
            time.sleep(POLL)
        return True

    def sizes_now(self):
        """Of its address space, now and at most; none while the system still loads its libraries, or it has ended."""
        try:
            facts = dict(re.findall(r'^(\w+):\s*(\w+)', Path(f'/proc/{self.process.pid}/status').read_text(encoding='ascii'), re.M))
        except OSError:
            return set()
        has_begun = int(facts['SigIgn'], 16) >> (signal.SIGXFSZ - 1) & 1   # the first that the program does
        return {1024 * int(facts[key]) for key in ('VmSize', 'VmPeak') if has_begun and key in facts}

    def send(self, *signals):
        for one in signals:
            self.process.send_signal(one)                # nothing if it has ended

    def text(self):
        """Its messages."""
        with self.log.open('rb') as output:
            output.seek(self.begin)
            return output.read().split(b'\n', 1)[-1].decode(errors='replace')


def is_helpful(text, folder):
    """Whether a message names the results or a file, a place in the description, or a command or size that helps."""
    names = r"""(^|[\s"'(])/[a-z_]+|\S\.(h5|json|journal|xdmf|pvd|txt|so|html)\b|'grit [a-z]+|'ulimit|use fewer (bodies|threads)"""
    return str(folder) in text or re.search(names, text) is not None


# ---- what is on disk

def state_step(path):
    """The step of a checkpoint, all of which is read."""
    with h5py.File(path) as file:
        json.loads(file['facts'][...].tobytes())
        file['state'][...]
        return int(file.attrs['step'])


def unreadable(folder):
    """What is under its name but does not read, except for series.h5, which a run changes in place and --resume restores."""
    wrong = []
    for path in (*folder.glob('*.json'), *folder.glob('checkpoint*.h5'), *folder.glob('final.h5'), *folder.glob('frames/*.h5')):
        try:
            if path.suffix == '.json':
                json.loads(path.read_text(encoding='utf-8'))
            elif path.parent.name == 'frames':
                same_results.content(path)
            else:
                state_step(path)
        except Exception as error:                       # whatever h5py makes of damage
            wrong.append(f'{path.relative_to(folder)} does not read: {error}')
    return wrong


def saved_step(folder):
    """That of the last checkpoint; None without one."""
    steps = []
    for name in ('checkpoint.h5', 'checkpoint-previous.h5'):
        try:
            steps.append(state_step(folder / name))
        except Exception:                                # missing, or reported by unreadable()
            pass
    return max(steps, default=None)


def status_of(folder):
    try:
        return json.loads((folder / 'run.json').read_text(encoding='utf-8'))
    except (OSError, ValueError):
        return {}


# References of the scenes by name, for the processes that read results: damaged files may crash the HDF5 library.
REFERENCES = {}


def examine(folder):
    return unreadable(folder), saved_step(folder)


def compare(name, folder):
    try:
        return REFERENCES[name].differences(folder)
    except Exception as error:
        return [f'the results do not read: {error}']


class Reader:
    """Reads results in another process."""

    def __init__(self):
        self.pool = None

    def __call__(self, function, *arguments):
        """What the function returns; None if its process crashed."""
        if self.pool is None:
            self.pool = ProcessPoolExecutor(1, get_context('fork'))
        try:
            return self.pool.submit(function, *arguments).result()
        except BrokenProcessPool:
            self.pool = None
            return None

    def close(self):
        if self.pool is not None:
            self.pool.shutdown()


# ---- one case

class NotApplied(Exception):
    """The run had ended before the fault, or never met it."""


class TooLate(NotApplied):
    """The run had ended."""


@dataclass
class Prepared:
    """A scene, and what its undisturbed runs took."""
    name: str
    file: Path
    seconds: float
    sizes: list                                          # of address space [bytes] at some moments, sorted
    calls: dict


@dataclass
class Case:
    campaign: 'Campaign'
    scene: Prepared
    fault: str
    folder: Path
    random: random.Random
    late: int = 0                                        # cases of this fault in a row whose run had ended before it
    ranks: int = 1                                       # processes of a run
    lost: list = field(default_factory=list)
    bits: list = field(default_factory=list)
    status: list = field(default_factory=list)

    def __post_init__(self):
        self.out = self.folder / 'results of the run'    # quoted in messages
        self.page = self.random.random() < 0.2
        self.patience = PATIENCE + 50 * self.scene.seconds

    @property
    def failed(self):
        return self.lost or self.bits or self.status

    def words(self, *more, of_folder=False):
        threads = self.random.choice((1, 2, 3))
        page = [] if self.page else ['--no-report']
        what = [self.out] if of_folder else [self.scene.file, '--out', self.out]
        return mpi.words(self.ranks, [self.campaign.grit, 'run', *what, '--threads', str(threads), '--quiet', *page, *more])

    def start(self, *more, environment=None, before=None, of_folder=False):
        if self.ranks > 1:
            environment = mpi.ENVIRONMENT | (environment or {})
        return Process(self.words(*more, of_folder=of_folder), self.folder / 'log.txt', environment, before)

    def resume(self, **how):
        """By the description, or by the folder, if it has what that needs."""
        whole = (self.out / 'run.json').exists() and (self.out / 'description.json').exists()
        return self.start('--resume', of_folder=whole and self.random.random() < 0.5, **how)

    def moment(self):
        """Sooner where the computer has become faster since the undisturbed runs."""
        return self.random.uniform(0, 1.05 * self.scene.seconds) / 2 ** self.late

    def status_of(self, run):
        """The exit status of a run; one that does not end is killed."""
        if not run.ends_within(self.patience):
            run.send(signal.SIGKILL)
            run.process.wait()
            self.status.append(f'did not end within {self.patience:.0f} s')
        return run.process.returncode

    def expect(self, run, allowed):
        """The exit status, which must be an allowed one, with a message."""
        status = self.status_of(run)
        text = run.text()
        if self.status:
            return status
        if status not in allowed:
            self.status.append(f'exit status {status}, allowed {", ".join(map(str, allowed))}: {text.strip()[-300:]}')
        elif status > 0 and not is_helpful(text, self.out) and NOTHING_WRITTEN not in text:
            self.status.append(f'exit status {status} with a message that names nothing: {text.strip()[-300:] or "none"}')
        return status

    def examine(self):
        """Sees that what is on disk reads. The step of the last checkpoint."""
        found = self.campaign.read(examine, self.out)
        if found is None:
            self.lost.append('a file on disk crashes its reader')
            return None
        self.lost += found[0]
        return found[1]

    def finish(self):
        """Continues to the end, and compares the results."""
        saved, before = self.examine(), status_of(self.out)
        run = self.resume()
        status = self.status_of(run)
        if status != DONE:
            self.lost.append(f'--resume ends with exit status {status}: {run.text().strip()[-300:]}')
            return
        after = status_of(self.out)
        if before.get('status') == 'done' and after != before:
            self.lost.append('a complete run was changed by --resume')
        if before.get('status') != 'done' and saved is not None and after.get('resumed_at_step', -1) < saved:
            self.lost.append(f'the checkpoint at step {saved} was not used: continued at step {after.get("resumed_at_step")}')
        if self.page and not (self.out / 'report.html').exists():
            self.lost.append('no report.html')
        self.lost += [f'{name} was left' for name in ('checkpoint.h5', 'checkpoint-previous.h5', 'series.journal') if (self.out / name).exists()]
        lines = self.campaign.read(compare, self.scene.name, self.out)
        self.bits += ['the results crash their reader'] if lines is None else lines


# ---- faults

def killed(case):
    """Once, and then perhaps as it is resumed."""
    for again in range(case.random.choice((1, 1, 2, 3))):
        run = case.resume() if again else case.start()
        if run.ends_within(case.moment()) and again == 0:
            raise TooLate
        run.send(signal.SIGKILL)
        case.expect(run, (-signal.SIGKILL, DONE))
        case.examine()
    case.finish()


def was_untouched(out, before):
    """Whether a run left its folder as it was, as run.json tells."""
    return stamp_of(out) == before


def stamp_of(out):
    try:
        found = (out / 'run.json').stat()
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns


def check_interrupted(case, run, allowed, before):
    """After a signal that saves: 130 with a checkpoint at the last step; or nothing was written, as the run had not begun."""
    status = case.expect(run, (DONE, INTERRUPTED, *allowed))
    if status < 0 and status in (-signal.SIGTERM, -signal.SIGINT, -signal.SIGHUP) and was_untouched(case.out, before):
        case.status = []                                 # before the program could take it
        return
    if status != INTERRUPTED:
        return
    text = run.text()
    if was_untouched(case.out, before) or NOTHING_WRITTEN in text:
        return
    saved, facts = case.examine(), status_of(case.out)
    if facts.get('status') != 'interrupted':
        case.status.append(f'run.json has the status {facts.get("status")!r} after exit status 130')
    elif saved is None or saved < facts.get('steps', 0):
        case.lost.append(f'interrupted at step {facts.get("steps")}, saved at {saved}')
    elif '--resume' not in text:
        case.status.append('the message does not say how to continue')


def interrupted(case, *signals, later=0.0):
    """By a signal, or two: the second may end the run at once, or come after its end."""
    resumed = case.random.random() < 0.3
    if resumed:                                          # the one that is interrupted continues another
        first = case.start()
        if first.ends_within(case.moment()):
            raise TooLate
        first.send(signal.SIGTERM)
        case.status_of(first)
    before = stamp_of(case.out)
    run = case.resume() if resumed else case.start()
    if run.ends_within(case.moment()):
        raise TooLate
    run.send(signals[0])
    for one in signals[1:]:
        run.ends_within(later)
        run.send(one)
    check_interrupted(case, run, [-one for one in signals[1:]], before)
    case.finish()


def two_signals(case):
    choice = (signal.SIGINT, signal.SIGTERM)
    interrupted(case, case.random.choice(choice), case.random.choice(choice), later=case.random.choice((0, 0.001, 0.01, 0.1)))


def fails_in(case, call, error, how):
    """Runs until a call of the system fails. The run that meets it, which begins, or continues another."""
    count = case.scene.calls.get(call, 0)
    if count == 0:
        raise NotApplied
    resumed = case.random.random() < 0.3
    if resumed:
        first = case.start()
        if first.ends_within(case.moment()):
            raise TooLate
        first.send(signal.SIGTERM)
        case.status_of(first)
        case.examine()
    log = case.folder / 'calls.txt'
    environment = case.campaign.shim_environment(case.out, log) | {'FAULTS_FAIL': f'{call}:{case.random.randint(1, count)}:{error}:{how}'}
    return (case.resume if resumed else case.start)(environment=environment), log


def met(log):
    return log.exists() and 'failed ' in log.read_text(encoding='ascii')


def killed_in_call(case):
    """In the middle of a call: what it writes is there by half."""
    run, log = fails_in(case, case.random.choice(('write', 'write', 'fsync', 'rename', 'open', 'remove')), 'KILL', 'once')
    case.expect(run, (-signal.SIGKILL, DONE))
    if not met(log) and not case.failed:
        raise NotApplied
    case.finish()


def refused(call, error):
    """A fault: a call that fails, once or from then on, as that disk would."""
    def apply(case):
        run, log = fails_in(case, call, error, case.random.choice(('once', 'on')))
        case.expect(run, (DONE, FILES))
        if not met(log) and not case.failed:
            raise NotApplied
        case.finish()

    return apply


def out_of_memory(case):
    """Less address space than the undisturbed run took, from the start: about what that had at some moment, or anything between. Or
    little more than the run has at a moment: SPARE, as grit leaves some to libraries that crash where a call finds none."""
    sizes = case.scene.sizes
    if case.random.random() < 0.3:
        run = case.start()
        if run.ends_within(case.moment()):
            raise TooLate
        most = min(run.sizes_now(), default=0) + SPARE
        try:
            if most > SPARE:
                resource.prlimit(run.process.pid, resource.RLIMIT_AS, (most, most))
        except ProcessLookupError:
            raise NotApplied from None
    else:
        most = case.random.choice((case.random.choice(sizes) + case.random.choice((0, 1 << 16, 1 << 20)),
                                   case.random.randint(sizes[0], sizes[-1])))
        run = case.start(before=lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most)))
    status = case.status_of(run)
    if status == NOT_LOADED:
        raise NotApplied
    case.expect(run, (DONE, DESCRIPTION, PLUGIN, FILES))
    case.finish()


def stopped(case):
    """A run that is halted at a moment or before a call of the system, so that its folder can be changed at once. Not before it renames
    files: the last of them is run.json, with which it is done."""
    if case.random.random() < 0.5:
        run, _ = fails_in(case, case.random.choice(('write', 'fsync', 'open')), 'STOP', 'once')
    else:
        run = case.start()
        if run.ends_within(case.moment()):
            raise TooLate
        run.send(signal.SIGSTOP)
    os.waitid(os.P_PID, run.process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
    return run


def go_on_without(case, run, remove):
    """Its results are removed, unless it has not begun or is done. It ends with an error, and can be made again."""
    status = status_of(case.out).get('status')
    applies = status == 'running' and (case.out / 'series.h5').exists()
    if applies:
        remove()
    run.send(signal.SIGCONT)
    case.expect(run, (FILES,) if applies else (DONE,))
    if not applies and not case.failed:
        raise NotApplied
    case.finish()


def folder_removed(case):
    go_on_without(case, stopped(case), lambda: shutil.rmtree(case.out))


def series_removed(case):
    go_on_without(case, stopped(case), (case.out / 'series.h5').unlink)


def clocks_jump(case):
    environment = case.campaign.shim_environment(None, None) | {
        'FAULTS_CLOCK': f'{case.random.randint(1, 10**9)}:{case.random.choice((10, 300, 10000))}'}
    before = stamp_of(case.out)
    run = case.start(environment=environment)
    if not run.ends_within(case.moment()) and case.random.random() < 0.5:
        run.send(signal.SIGTERM)
        check_interrupted(case, run, (), before)
    else:
        case.expect(run, (DONE,))
    case.finish()


def two_runs(case):
    """A second run into the folder of one that writes is refused, or does the same after its end."""
    first = case.start()
    first.ends_within(case.moment())
    second = case.start(*case.random.choice(((), ('--overwrite',), ('--resume',))))
    statuses = [case.expect(run, (DONE, FILES)) for run in (first, second)]
    if DONE not in statuses and not case.failed:
        case.lost.append('neither of two runs was completed')
    case.finish()


def rank_killed(case):
    """One of several processes of mpirun, which ends the others and reports which it was."""
    case.ranks = case.random.choice((2, 3))
    run = case.start()
    if run.ends_within(MPI_STARTS + case.moment()):
        raise TooLate
    ranks = mpi.processes_of(run.process.pid)
    if len(ranks) < case.ranks:
        run.send(signal.SIGKILL)
        case.status_of(run)
        raise NotApplied
    try:
        os.kill(case.random.choice(ranks), signal.SIGKILL)
    except ProcessLookupError:
        raise TooLate from None
    until = time.monotonic() + MPI_ENDS
    status, text = case.status_of(run), run.text()       # those of mpirun
    if status not in (128 + signal.SIGKILL, DONE):
        case.status.append(f'exit status {status}, allowed {128 + signal.SIGKILL}: {text.strip()[-300:]}')
    elif status != DONE and not re.search(r'rank \d+ with PID \d+ on node \S+ exited on signal 9', text):
        case.status.append(f'the message does not name the rank: {text.strip()[-300:]}')
    while time.monotonic() < until and any(map(mpi.is_running, ranks)):
        time.sleep(POLL)
    if left := list(filter(mpi.is_running, ranks)):
        case.status.append(f'processes that run {MPI_ENDS} s later: {left}')
    case.examine()
    case.ranks = case.random.choice((1, 2))
    case.finish()


RANK_KILLED = 'a rank killed'                            # with MPI only
FAULTS = {
    'SIGKILL': killed,
    'SIGKILL in a call of the system': killed_in_call,
    'SIGTERM': lambda case: interrupted(case, signal.SIGTERM),
    'Ctrl-C': lambda case: interrupted(case, signal.SIGINT),
    'two signals in a row': two_signals,
    'SIGHUP': lambda case: interrupted(case, signal.SIGHUP),
    'disk full at write': refused('write', 'ENOSPC'),
    'disk full at open': refused('create', 'ENOSPC'),
    'disk full at rename': refused('rename', 'ENOSPC'),
    'disk full at fsync': refused('fsync', 'ENOSPC'),
    'read-only at write': refused('write', 'EROFS'),
    'read-only at open': refused('create', 'EROFS'),
    'read-only at rename': refused('rename', 'EROFS'),
    'read-only at remove': refused('remove', 'EROFS'),
    'I/O error at write': refused('write', 'EIO'),
    'I/O error at open': refused('open', 'EIO'),
    'I/O error at rename': refused('rename', 'EIO'),
    'I/O error at fsync': refused('fsync', 'EIO'),
    'I/O error at remove': refused('remove', 'EIO'),
    'out of memory': out_of_memory,
    'folder removed': folder_removed,
    'series.h5 removed': series_removed,
    'clocks that jump': clocks_jump,
    'two runs into one folder': two_runs,
    RANK_KILLED: rank_killed,
}
HEAD = ('fault', 'tried', 'lost', 'wrong bits', 'wrong status', 'hours', 'date')


# ---- the campaign

@dataclass
class Tally:
    tried: int = 0
    lost: int = 0
    bits: int = 0
    status: int = 0
    seconds: float = 0
    asked: int = 0                                       # with those in which the fault was not met
    late: int = 0                                        # of those, in a row

    def row(self, fault):
        return [fault, self.tried, self.lost, self.bits, self.status, f'{self.seconds / 3600:.2f}', tables.today()]


class Campaign:
    def __init__(self, given, place):
        self.given, self.place = given, place
        self.grit, self.shim = given.grit.resolve(), given.shim.resolve()
        self.scenes = []
        self.read = Reader()
        self.tallies = {fault: Tally() for fault in FAULTS if matches(fault, given.only)}

    def shim_environment(self, below, log):
        environment = {'LD_PRELOAD': str(self.shim)}
        if below is not None:
            environment['FAULTS_BELOW'] = str(below)
        if log is not None:
            environment['FAULTS_LOG'] = str(log)
        return environment

    def prepare(self):
        """Runs the scenes undisturbed, unless they are given. Throws ValueError if they cannot be run or differ."""
        for name, scene in SCENES.items():
            if not matches(name, self.given.scene):
                continue
            folder = (self.given.undisturbed or self.place).resolve() / 'undisturbed' / name
            facts = folder / 'facts.json'
            if self.given.undisturbed is None:
                facts.write_text(json.dumps(self.run_undisturbed(name, scene, folder)), encoding='utf-8')
            elif not facts.exists():
                raise ValueError(f'{facts} does not exist; --undisturbed takes a folder that a campaign with --keep has printed')
            REFERENCES[name] = same_results.Reference([folder / str(threads) for threads in THREADS])
            self.scenes.append(Prepared(name, folder / 'scene.json', **json.loads(facts.read_text(encoding='utf-8'))))
            one = self.scenes[-1]
            print(f'{name}: {one.seconds:.1f} s, {one.sizes[-1] >> 20} MB of address space, {one.calls}', flush=True)

    def run_undisturbed(self, name, scene, folder):
        """What the runs of a scene took, as in Prepared."""
        folder.mkdir(parents=True)
        file = folder / 'scene.json'
        write_scene(self.grit, scene, file, self.given.scale)
        seconds, sizes, calls = [], set(), {}
        for threads in THREADS:
            out, log = folder / str(threads), folder / f'calls-{threads}.txt'
            run = Process([self.grit, 'run', file, '--out', out, '--threads', str(threads), '--quiet', '--no-report'], folder / 'log.txt',
                          self.shim_environment(out, log))
            run.ends_within(3600)
            if run.process.poll() is None:
                run.send(signal.SIGKILL)
            if run.process.wait() != DONE:
                raise ValueError(f'{name}: the undisturbed run ends with exit status {run.process.returncode}:\n{run.text()}')
            seconds.append(time.monotonic() - run.started)
            sizes |= run.sizes
            for call, count in re.findall(r'^([a-z]+) (\d+)$', log.read_text(encoding='ascii'), re.M):
                calls[call] = max(calls.get(call, 0), int(count))
        if calls.get('write', 0) == 0:
            raise ValueError(f'{self.shim} counts no call of {self.grit}: it does not stand before the functions of the C library')
        return {'seconds': sum(seconds) / len(seconds), 'sizes': sorted(sizes), 'calls': calls}

    def try_case(self, fault, index):
        """One case. Whether the fault was applied."""
        tally = self.tallies[fault]
        chance = random.Random(f'{self.given.seed}/{fault}/{index}')
        scene = self.scenes[(index + list(FAULTS).index(fault)) % len(self.scenes)]
        case = Case(self, scene, fault, self.place / f'{re.sub(r"[^a-z0-9]+", "-", fault.lower())}-{index}', chance, tally.late)
        case.folder.mkdir()
        began = time.monotonic()
        applied, late = True, 0
        try:
            FAULTS[fault](case)
        except NotApplied as reason:
            applied = bool(case.failed)
            late = tally.late + 1 if isinstance(reason, TooLate) else 0
        tally.asked, tally.late = tally.asked + 1, late
        tally.seconds += time.monotonic() - began
        if applied:
            tally.tried += 1
            tally.lost += bool(case.lost)
            tally.bits += bool(case.bits)
            tally.status += bool(case.status)
        if case.failed:
            print(f'{fault}, case {index}, scene {scene.name}: see {case.folder}', flush=True)
            for kind in ('lost', 'bits', 'status'):
                for line in getattr(case, kind):
                    print(f'  {kind}: {line}', flush=True)
            print(f'  again: scripts/faults.py --seed {self.given.seed} --scale {self.given.scale:g} --only "{fault}" --case {index}', flush=True)
        elif not self.given.keep:
            shutil.rmtree(case.folder)
        return applied

    def run(self):
        if self.given.case is not None:
            for fault in self.tallies:
                self.try_case(fault, self.given.case)
            return
        end = time.monotonic() + 60 * self.given.minutes if self.given.minutes is not None else None
        index = 0
        while True:
            due = [fault for fault, tally in self.tallies.items()
                   if end is not None or (tally.tried < self.given.times and tally.asked < 4 * self.given.times + 20)]
            if not due:
                return
            for fault in due:
                if end is not None and time.monotonic() >= end:
                    return
                self.try_case(fault, index)
            index += 1

    def report(self):
        rows = [tally.row(fault) for fault, tally in self.tallies.items()]
        print(tables.table(HEAD, rows), end='')
        if self.given.markdown is not None:
            page = self.given.markdown.read_text(encoding='utf-8')
            tried = [row for row in rows if row[1] > 0]
            self.given.markdown.write_text(tables.with_table(page, 'faults', HEAD, tried, list(FAULTS)), encoding='utf-8')
        never = [fault for fault, tally in self.tallies.items() if tally.tried == 0]
        if never:
            print(f'never applied: {", ".join(never)}')
        return not never and not any(tally.lost or tally.bits or tally.status for tally in self.tallies.values())


def matches(name, patterns):
    return not patterns or any(fnmatch.fnmatch(name, pattern) for pattern in patterns)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    length = parser.add_mutually_exclusive_group()
    length.add_argument('--times', type=int, default=10, metavar='N')
    length.add_argument('--minutes', type=float, metavar='M')
    length.add_argument('--case', type=int, metavar='I')
    parser.add_argument('--only', action='append', default=[], metavar='FAULT', help=f'one of: {", ".join(FAULTS)}; or a pattern')
    parser.add_argument('--scene', action='append', default=[], metavar='NAME', help=f'one of: {", ".join(SCENES)}; or a pattern')
    parser.add_argument('--seed', type=int, default=1, metavar='S')
    parser.add_argument('--grit', type=Path, default=ROOT / 'build/bin/grit', metavar='FILE')
    parser.add_argument('--shim', type=Path, default=ROOT / 'build/tests/faults/faults_shim.so', metavar='FILE')
    parser.add_argument('--scale', type=float, default=1, metavar='X', help='of the number of steps of all scenes')
    parser.add_argument('--work', type=Path, default=WORK, metavar='DIR', help='where the runs are')
    parser.add_argument('--undisturbed', type=Path, metavar='DIR', help='the folder of a campaign that was kept, whose undisturbed runs are taken')
    parser.add_argument('--keep', action='store_true', help='keep the folders of all cases')
    parser.add_argument('--no-load', action='store_true', help='without the busy process')
    parser.add_argument('--markdown', type=Path, nargs='?', const=PAGE, metavar='PAGE')
    given = parser.parse_args()
    for file in (given.grit, given.shim):
        if not file.is_file():
            parser.error(f'{file} does not exist; build the tree, with its tests, or name the file')
    if given.undisturbed is not None and given.scale != 1:
        parser.error('--scale beside --undisturbed, whose scenes have a length; omit it')
    if not mpi.is_there(given.grit):
        del FAULTS[RANK_KILLED]
    campaign_faults = [fault for fault in FAULTS if matches(fault, given.only)]
    if not campaign_faults or not any(matches(name, given.scene) for name in SCENES):
        parser.error('no fault or no scene matches')
    given.work.mkdir(parents=True, exist_ok=True)
    place = Path(tempfile.mkdtemp(prefix='', dir=given.work.resolve()))
    campaign = Campaign(given, place)
    busy = None if given.no_load else subprocess.Popen([sys.executable, '-c', BUSY, str(os.getpid())])
    held = False
    try:
        campaign.prepare()
        campaign.run()
        held = campaign.report()
    except ValueError as error:
        print(f'faults: {error}', file=sys.stderr)
    finally:
        if busy is not None:
            busy.kill()
            busy.wait()
        campaign.read.close()
        if held and not given.keep:
            shutil.rmtree(place)
        else:
            print(f'the runs are in {place}')
    return 0 if held else 1


if __name__ == '__main__':
    sys.exit(main())
