"""Runs of grit, and what their run.json says."""
import json
import os
import re
import subprocess
import time
from pathlib import Path
from typing import NamedTuple

from . import machine
from .machine import Complaint

ROOT = Path(__file__).resolve().parents[2]


class Window(NamedTuple):
    """What happened in the stage named "timed"."""
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
        return self.seconds / self.steps / (0.5 * self.contacts_per_grain * self.grains)


def program(path=None):
    path = Path(path or ROOT / 'build' / 'bin' / 'grit').resolve()
    if not (path.is_file() and os.access(path, os.X_OK)):
        raise Complaint(f'{path}: no such program; build it (cmake --preset release && cmake --build --preset release '
                        '--target grit_app grit_plugins), or say where it is (--grit FILE)')
    return path


def version(path):
    return subprocess.run([path, '--version'], capture_output=True, text=True, check=True).stdout.strip()


def command(path, scene, folder, threads, settings):
    words = [path, 'run', scene, '--out', folder, '--overwrite', '--quiet', '--threads', threads]
    for pointer, value in (settings or {}).items():
        words += ['--set', f'{pointer}={json.dumps(value)}']
    return [str(word) for word in words]


def run(path, scene, folder, threads, settings=None):
    """Runs a scene, pinned to as many cores as it has threads; all threads that there are, unless given."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    threads = threads or len(os.sched_getaffinity(0))
    return machine.run(command(path, scene, folder, threads, settings), threads, ROOT)


def window(path, scene, folder, threads, settings=None):
    """Runs a scene whose last stage is "timed" and comes after another, which warms up."""
    done = run(path, scene, folder, threads, settings)
    facts = json.loads((Path(folder) / 'run.json').read_text(encoding='utf-8'))
    before, timed = facts['stages'][-2:]
    if timed['name'] != 'timed':
        raise Complaint(f'{scene}: its last stage is "{timed["name"]}"; name it "timed"')
    # Where a scene has its contacts summed up, those of the end count: they may change while it warms up.
    contacts = re.search(r'^packing/coordination_number: .*final (\S+)', done.output, re.M)
    return Window(facts['bodies'], timed['step'] - before['step'], timed['wall_s'] - before['wall_s'],
                  float(contacts.group(1)) if contacts else facts['contacts_per_body'], done.others, facts)


def stepping(path, scene, folder, threads, settings=None):
    """Seconds of all stages of a scene, and how many cores other processes kept busy meanwhile."""
    done = run(path, scene, folder, threads, settings)
    return json.loads((Path(folder) / 'run.json').read_text(encoding='utf-8'))['wall_s'], done.others


def _started(path, scene, folder, threads, settings):
    """A run that is watched while it goes on."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    (Path(folder) / 'run.json').unlink(missing_ok=True)
    words = machine.pinned(command(path, scene, folder, threads, settings), threads)
    return subprocess.Popen(words, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def _ended(process):
    _, errors = process.communicate()
    if process.returncode != 0:
        raise subprocess.CalledProcessError(process.returncode, process.args, errors)


def peak_memory(path, scene, folder, threads, settings=None):
    """The most memory that the process ever had in hand [bytes]."""
    process = _started(path, scene, folder, threads, settings)
    peak = 0
    while process.poll() is None:
        # Not getrusage(): that begins with what this process had when it forked.
        try:
            status = Path(f'/proc/{process.pid}/status').read_text(encoding='ascii')
        except OSError:
            break
        peak = max([peak] + [1024 * int(line.split()[1]) for line in status.splitlines() if line.startswith('VmHWM')])
        time.sleep(0.002)
    _ended(process)
    return peak


def seconds_to_first_stage(path, scene, folder, threads, settings=None):
    """From the start of the process to the end of its first stage, as run.json comes to say it."""
    begin = time.perf_counter()
    process = _started(path, scene, folder, threads, settings)
    file, seconds = Path(folder) / 'run.json', None
    while seconds is None and process.poll() is None:
        if file.is_file() and json.loads(file.read_text(encoding='utf-8'))['stages']:
            seconds = time.perf_counter() - begin
        time.sleep(0.002)
    _ended(process)
    return seconds or time.perf_counter() - begin
