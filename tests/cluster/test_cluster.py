#!/usr/bin/python3
"""A sweep done by a scheduler that disturbs its runs has the same bits as one done here.

  test_cluster.py slurm|parallel GRIT

Exit status: 0 passed; 1 failed; 77 the scheduler is not installed.
"""
import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import slurm_here
from verdict import SKIPPED, Failed, expect

# A second each, with many checkpoints.
SCENE = {
    'title': 'a grain that bounces',
    'contacts': {'type': 'linear-rolling'},
    'materials': {'sand': {'contact_modulus': '1 MPa'}},
    'bodies': {'grains': {'type': 'sphere', 'material': 'sand', 'source': {
        'type': 'list', 'bodies': [{'position': [0, 0, '3 mm'], 'radius': '1 mm'}]}}},
    'walls': {'floor': {'type': 'plane', 'material': 'sand'}},
    'engines': {'gravity': {'type': 'gravity'}, 'damping': {'type': 'local-damping', 'coefficient': 0.1}},
    'time_step': {'safety': 0.001, 'steps_per_impact': 0},
    'stages': [{'name': 'fall', 'until': {'type': 'time', 'value': '150 ms'}, 'limit': '10 s'}],
    'probes': {'packing': {'type': 'packing', 'every_time': '1 ms'}},
    'output': {'checkpoint_every': '50 ms'},
}
SWEEP = {
    'title': 'damping of a bouncing grain',
    'scene': 'fall.json',
    'purpose': 'sweep',
    'settings': {'damping': {'pointers': ['/engines/damping/coefficient'], 'values': [0.1, 0.2, 0.3]}},
    'seeds': {'values': [1]},
    'metrics': {'energy': {'type': 'maximum', 'of': 'packing/kinetic_energy'}},
}
RUNS = [f'runs/damping={value}/seed-1' for value in SWEEP['settings']['damping']['values']]


class Sweep:
    """The sweep in a folder with an odd name."""

    def __init__(self, place, grit, environment):
        self.place, self.grit, self.environment = place / "it's a sweep", grit, environment
        self.place.mkdir()
        (self.place / 'fall.json').write_text(json.dumps(SCENE))
        (self.place / 'sweep.json').write_text(json.dumps(SWEEP))

    def study(self, *words, status=0):
        outcome = subprocess.run([self.grit, 'study', 'sweep.json', *words], cwd=self.place, env=self.environment,
                                 text=True, capture_output=True)
        text = outcome.stdout + outcome.stderr
        expect(outcome.returncode == status, f'{words}: status {outcome.returncode}, not {status}:\n{text}')
        return text

    def results(self, run):
        return self.place / 'results/sweep' / run

    def run_json(self, run):
        return json.loads((self.results(run) / 'run.json').read_text())

    def wait_for_checkpoint(self, run, seconds=240):
        deadline = time.monotonic() + seconds
        while not (self.results(run) / 'checkpoint.h5').exists():
            expect(time.monotonic() < deadline, f'{run} has no checkpoint; it was done too early, or did not begin')
            time.sleep(0.01)

    def halt(self, run):
        """Halts a run at its first checkpoint: it does not end before what is done to it. Its process."""
        self.wait_for_checkpoint(run)
        process = process_of(self, run)
        os.kill(process, signal.SIGSTOP)
        return process

    def expect_same(self, other):
        """The same bits in all runs, and the same metrics, as in another folder."""
        import h5py
        for run in RUNS:
            expect(self.run_json(run)['status'] == 'done', f'{run} is not done')
            with h5py.File(self.results(run) / 'series.h5') as own, h5py.File(other.results(run) / 'series.h5') as one:
                names = []
                one.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
                expect(names, f'{run}: no channels')
                for name in names:
                    expect(own[name][()].tobytes() == one[name][()].tobytes(), f'{run}: {name} differs')
        for row, theirs in zip(self.table(), other.table(), strict=True):
            for name in ('variant', 'metric', 'mean', 'samples_done'):
                expect(row[name] == theirs[name], f'{name} of {row["variant"]}: {row[name]}, not {theirs[name]}')

    def table(self):
        with open(self.place / 'results/sweep/study.csv', newline='') as file:
            return list(csv.DictReader(file))


def process_of(sweep, run):
    """The process that does a run."""
    for entry in Path('/proc').iterdir():
        if not entry.name.isdigit():
            continue
        try:
            words = (entry / 'cmdline').read_bytes().split(b'\0')
            # Of this test only, whatever else runs.
            if b'run' in words[1:2] and any(word.endswith(run.encode()) for word in words) and \
                    (entry / 'cwd').resolve() == sweep.place:
                return int(entry.name)
        except OSError:
            pass
    raise Failed(f'no process does {run}')


def continue_at_signal(process, seconds=240):
    """Lets a halted process go on when it has a signal to handle, unless who sent that did."""
    deadline = time.monotonic() + seconds
    while True:
        try:
            status = Path(f'/proc/{process}/status').read_text()
        except OSError:
            return
        if any(int(mask, 16) for mask in re.findall(r'^(?:Sig|Shd)Pnd:\s*(\w+)', status, re.MULTILINE)):
            break
        expect(time.monotonic() < deadline, f'no signal for process {process}')
        time.sleep(0.01)
    os.kill(process, signal.SIGCONT)


def by_slurm(place, grit, here):
    with slurm_here.Slurm(place / 'slurm') as slurm:
        sweep = Sweep(place / 'cluster', grit, slurm.environment)
        refused = sweep.study('--submit', 'slurm', '--sbatch=--partition=none', status=5)
        expect('invalid partition' in refused, f'what Slurm said is not shown:\n{refused}')

        text = sweep.study('--submit', 'slurm', '--sbatch', '--partition=all --time=5')
        job = re.search(r'^job (\d+): 3 runs$', text, re.MULTILINE)
        expect(job, f'no job:\n{text}')
        tasks = [f'{job[1]}_{index}' for index in range(3)]
        processes = [sweep.halt(run) for run in RUNS]
        going = sweep.study('--collect')
        expect('of 3 runs are done; ' in going and 'under way: ' in going, f'not collected on the way:\n{going}')
        expect('in the queue of Slurm' in sweep.study('--submit', 'slurm', status=5), 'submitted twice')

        # Preempted; out of time; preempted, and the folder of its run is lost.
        slurm.call('scontrol', 'requeue', tasks[0])
        slurm.call('scancel', '--batch', '--signal=USR1', tasks[1])
        slurm.call('scontrol', 'requeue', tasks[2])
        for process in processes:
            continue_at_signal(process)
        slurm.wait(lambda: slurm.state(tasks[2]) == 'PENDING', 'a task that waits')
        shutil.rmtree(sweep.results(RUNS[2]))
        slurm.wait(lambda: slurm.state(tasks[1]) in ('PENDING', 'RUNNING', 'COMPLETED') and
                   'out of time' in sweep_log(sweep, tasks[1]), 'a task out of time')
        for task in tasks:  # Slurm waits for two minutes before a task starts again
            if slurm.state(task) == 'PENDING':
                slurm.call('scontrol', 'update', f'JobId={task}', 'StartTime=now', check=False)
        for task in tasks:
            slurm.wait(lambda: slurm.state(task) in ('COMPLETED', 'FAILED', 'CANCELLED'), f'the end of {task}')
            expect(slurm.state(task) == 'COMPLETED', f'{task} is {slurm.state(task)}:\n{sweep_log(sweep, task)}')
        for run, resumed in zip(RUNS, (1, 1, 0)):
            expect(sweep.run_json(run).get('resumed', 0) == resumed, f'{run}: resumed {sweep.run_json(run)["resumed"]}')
        sweep.study('--collect')
        sweep.expect_same(here)

        # What is done is not submitted again; a run that was lost since is.
        expect('0 of 3 runs to do' in sweep.study('--submit', 'slurm'), 'submitted again')
        shutil.rmtree(sweep.results(RUNS[1]))
        text = sweep.study('--submit', 'slurm')
        job = re.search(r'^job (\d+): 1 run$', text, re.MULTILINE)
        expect(job, f'not submitted alone:\n{text}')
        slurm.wait(lambda: slurm.state(job[1]) in ('COMPLETED', 'FAILED', 'CANCELLED'), 'the end of the lost run')
        sweep.study('--collect')
        sweep.expect_same(here)


def sweep_log(sweep, task):
    log = sweep.place / f'results/sweep/cluster/{task}.txt'
    return log.read_text() if log.exists() else ''


def by_parallel(place, grit, here):
    # "ssh" to hosts that are this machine.
    ssh = place / 'ssh'
    ssh.write_text('#!/bin/bash\necho "$@" >> "${0%/*}/hosts.txt"\nshift\n[[ $1 != -- ]] || shift\n'
                   'exec /bin/bash -c "$*"\n')
    ssh.chmod(0o700)
    sweep = Sweep(place / 'cluster', grit, dict(os.environ, PARALLEL_SSH=str(ssh)))
    command = [grit, 'study', 'sweep.json', '--submit', 'parallel', '--jobs', '3']
    with subprocess.Popen(command, cwd=sweep.place, env=sweep.environment, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT) as program:
        os.kill(sweep.halt(RUNS[0]), signal.SIGKILL)
        text = program.communicate(timeout=400)[0]
    expect(program.returncode == 5 and '1 run did not end' in text, f'status {program.returncode}:\n{text}')
    expect('2 of 3 runs are done; 1 under way: damping=0.1, seed 1.' in text, f'not named:\n{text}')
    text = sweep.study('--submit', 'parallel', '--hosts', '1/one,1/two')
    expect('1 of 3 runs to do' in text, f'what is done is done again:\n{text}')
    expect((place / 'hosts.txt').exists(), 'no host was used')
    expect(sweep.run_json(RUNS[0])['resumed'] == 1, 'not resumed')
    sweep.expect_same(here)

    # Interrupted, its runs save checkpoints; the script continues without grit.
    shutil.rmtree(sweep.place / 'results')
    with subprocess.Popen(command, cwd=sweep.place, env=sweep.environment, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT) as program:
        processes = [sweep.halt(run) for run in RUNS]
        program.send_signal(signal.SIGTERM)
        for process in processes:
            continue_at_signal(process)
        text = program.communicate(timeout=400)[0]
    expect(program.returncode == 130 and 'run the same command again' in text, f'{program.returncode}:\n{text}')
    for run in RUNS:
        expect(sweep.run_json(run)['status'] == 'interrupted', f'{run} did not save its state')
    subprocess.run([sweep.place / 'results/sweep/cluster/parallel.sh'], check=True, env=sweep.environment,
                   capture_output=True)
    sweep.study('--collect')
    sweep.expect_same(here)


def main():
    how, grit = sys.argv[1], str(Path(sys.argv[2]).resolve())
    if how == 'slurm':
        why = slurm_here.missing()
    else:
        gnu = shutil.which('parallel') and 'GNU parallel' in subprocess.run(
            ['parallel', '--version'], text=True, capture_output=True).stdout
        why = '' if gnu else 'not installed: GNU parallel'
    try:
        import h5py  # noqa: F401
    except ImportError:
        why = why or 'not installed: h5py'
    if why:
        print(f'skipped: {why}')
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix='grit-cluster-') as folder:
        place = Path(folder).resolve()
        for name in ('here', 'cluster'):
            (place / name).mkdir()
        try:
            here = Sweep(place / 'here', grit, os.environ)
            here.study('--quiet')
            {'slurm': by_slurm, 'parallel': by_parallel}[how](place, grit, here)
        except (Failed, RuntimeError) as error:
            print(f'failed: {error}')
            return 1
    print('the same bits')
    return 0


if __name__ == '__main__':
    sys.exit(main())
