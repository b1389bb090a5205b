"""Runs of grit and their run.json."""
import json
import os
import re
import shutil
import subprocess
import time
from pathlib import Path
from typing import NamedTuple

from . import machine
from .machine import Complaint

ROOT = Path(__file__).resolve().parents[2]


class Window(NamedTuple):
    """Results of the stage named "timed"."""
    grains: int
    steps: int
    seconds: float
    contacts_per_grain: float
    others: float  # cores that other processes kept busy during the run
    facts: dict    # all of run.json

    def particle_steps_per_second(self):
        return self.grains * self.steps / self.seconds

    def seconds_per_contact(self):
        """Of one contact in one step."""
        if not self.contacts_per_grain:
            raise Complaint('there are no contacts in the timed stage; make the stages before it longer')
        return self.seconds / self.steps / (0.5 * self.contacts_per_grain * self.grains)


def program(path=None):
    path = Path(path or ROOT / 'build' / 'bin' / 'grit').resolve()
    if not (path.is_file() and os.access(path, os.X_OK)):
        raise Complaint(f'{path}: no such program; build it (cmake --preset release && cmake --build --preset release '
                        '--target grit_app grit_plugins), or give its path (--grit FILE)')
    return path


def version(path):
    done = subprocess.run([path, '--version'], capture_output=True, text=True)
    if done.returncode != 0 or not done.stdout.startswith('grit '):
        said = (done.stderr or done.stdout).strip() or 'nothing'
        raise Complaint(f'{path}: does not run here as grit: exit status {done.returncode} of --version, output: '
                        f'{said}; build it again, or give another (--grit FILE)')
    return done.stdout.strip()


def command(path, scene, folder, threads, settings):
    words = [path, 'run', scene, '--out', folder, '--overwrite', '--quiet', '--threads', threads]
    for pointer, value in (settings or {}).items():
        words += ['--set', f'{pointer}={json.dumps(value)}']
    return [str(word) for word in words]


class Done(NamedTuple):
    output: str
    others: float
    facts: dict

    def final(self, series, unit=''):
        """The last value of a series of the summary, in `unit`; it may be printed with a prefix."""
        found = re.search(rf'^{series}: .*final (\S+) ?([GMkmµ]?){unit}$', self.output, re.M)
        if not found:
            raise Complaint(f'there is no "{series}" in {unit or "numbers"} in the summary:\n{self.output[-2000:]}')
        value, prefix = found.groups()
        return float(value) * {'G': 1e9, 'M': 1e6, 'k': 1e3, '': 1, 'm': 1e-3, 'µ': 1e-6}[prefix]


def _fresh(folder):
    """Makes the folder, without run.json of an earlier run."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    file = Path(folder) / 'run.json'
    file.unlink(missing_ok=True)
    return file


def _facts(path, file):
    if not file.is_file():
        raise Complaint(f'{path}: exit status 0, but wrote no {file}; is it grit?')
    return json.loads(file.read_text(encoding='utf-8'))


def read_facts(folder):
    """run.json of a results folder."""
    return json.loads((Path(folder) / 'run.json').read_text(encoding='utf-8'))


def has_ranks(path):
    """Whether this grit runs in several processes, and mpirun is there."""
    return shutil.which('mpirun') is not None and (Path(path).parents[1] / 'lib/grit/mpi.so').is_file()


# Open MPI refuses to run as root otherwise, as in a container.
MPI_AS_ROOT = {'OMPI_ALLOW_RUN_AS_ROOT': '1', 'OMPI_ALLOW_RUN_AS_ROOT_CONFIRM': '1'} if os.geteuid() == 0 else {}


def on_ranks(ranks, words):
    """The command on so many ranks; one rank needs no MPI."""
    return ['mpirun', '--bind-to', 'none', '--oversubscribe', '-n', str(ranks), *words] if ranks > 1 else words


def run(path, scene, folder, threads, settings=None, environment=None, friends=(), ranks=1):
    """Runs a scene, pinned to as many cores as it has threads; threads None: all. `ranks`: processes, each with so many threads."""
    file = _fresh(folder)
    threads = threads or len(os.sched_getaffinity(0))
    words = on_ranks(ranks, command(path, scene, folder, threads, settings))
    done = machine.run(words, threads * ranks, ROOT, MPI_AS_ROOT | (environment or {}), friends=friends)
    return Done(done.output, done.others, _facts(path, file))


def window(path, scene, folder, threads, settings=None, **more):
    """Runs a scene whose last stage is "timed" and follows one for warm-up."""
    done = run(path, scene, folder, threads, settings, **more)
    before, timed = done.facts['stages'][-2:]
    if timed['name'] != 'timed':
        raise Complaint(f'{scene}: its last stage is "{timed["name"]}"; name it "timed"')
    # If the summary has the coordination number, its final value is used: it may change during the warm-up.
    contacts = re.search(r'^packing/coordination_number: .*final (\S+)', done.output, re.M)
    return Window(done.facts['bodies'], timed['step'] - before['step'], timed['wall_s'] - before['wall_s'],
                  float(contacts.group(1)) if contacts else done.facts['contacts_per_body'], done.others, done.facts)


def probes(path, scene):
    """Names of the probes of a description, including those of its scenario."""
    said = subprocess.run([str(path), 'expand', str(scene)], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return list(json.loads(said)['probes'])


def all_stages(path, scene, folder, threads, settings=None):
    """Seconds of all stages of a scene, with probes and output, and how many cores others kept busy meanwhile."""
    done = run(path, scene, folder, threads, settings)
    # Not the run's wall_s, which excludes probes and output.
    return done.facts['stages'][-1]['wall_s'], done.others


def _started(path, scene, folder, threads, settings):
    """A run in progress."""
    return machine.started(command(path, scene, folder, threads, settings), threads, ROOT,
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def _ended(process):
    _, errors = process.communicate()
    if process.returncode != 0:
        raise subprocess.CalledProcessError(process.returncode, process.args, errors)


def peak_memory(path, scene, folder, threads, settings=None):
    """Peak memory of the process [bytes], cores used by others, and run.json."""
    file, watch, peak = _fresh(folder), machine.Watch(), 0
    with _started(path, scene, folder, threads, settings) as process:
        while process.poll() is None:
            # Not getrusage(): it includes the memory of this process at the fork.
            try:
                status = Path(f'/proc/{process.pid}/status').read_text(encoding='ascii')
            except OSError:
                break
            peak = max([peak] + [1024 * int(line.split()[1]) for line in status.splitlines()
                                 if line.startswith('VmHWM')])
            time.sleep(0.002)
        _ended(process)
    return peak, watch.others(), _facts(path, file)


def seconds_to_first_stage(path, scene, folder, threads, settings=None):
    """Seconds from the start of the process until run.json has its first stage; cores used by others."""
    file, watch, seconds = _fresh(folder), machine.Watch(), None
    with _started(path, scene, folder, threads, settings) as process:
        while seconds is None and process.poll() is None:
            if file.is_file() and json.loads(file.read_text(encoding='utf-8'))['stages']:
                seconds = watch.seconds()
            time.sleep(0.002)
        _ended(process)
    if not _facts(path, file)['stages']:
        raise Complaint(f'{path}: ended before the end of its first stage')
    return seconds or watch.seconds(), watch.others()
