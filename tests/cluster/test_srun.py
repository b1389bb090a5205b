#!/usr/bin/python3
"""A run shared by ranks that srun starts has the same bits as one process, also where Slurm asks it to end on the way.

  test_srun.py GRIT

Exit status: 0 passed; 1 failed; 77 Slurm with PMIx is not installed.
"""
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import slurm_here
from verdict import SKIPPED, Failed, expect

ROOT = Path(__file__).resolve().parents[2]
SCENE = {
    'title': 'grains that fall and roll',
    'contacts': {'type': 'linear-rolling'},
    'materials': {'sand': {'contact_modulus': '10 MPa'}},
    'bodies': {'grains': {'type': 'sphere', 'material': 'sand', 'source': {
        'type': 'lattice', 'kind': 'fcc', 'low': [0, 0, 0], 'high': ['40 mm', '40 mm', '80 mm'], 'diameter': '2 mm'}}},
    'walls': {'floor': {'type': 'plane', 'material': 'sand'}},
    'engines': {'gravity': {'type': 'gravity'}},
    'stages': [{'name': 'fall', 'until': {'type': 'steps', 'value': 2000}, 'limit': '10 s'}],
    'probes': {'packing': {'type': 'packing', 'every_steps': 100}},
    'output': {'checkpoint_every': '50 ms'},
}


class Runs:
    def __init__(self, place, grit, slurm):
        self.place, self.slurm = place, slurm
        # Beside other tests: a rank that waits lets others use its core.
        slurm.environment['OMPI_MCA_mpi_yield_when_idle'] = '1'
        self.command = [grit, 'run', 'fall.json', '--no-report', '--threads', '1']
        (place / 'fall.json').write_text(json.dumps(SCENE))

    def srun(self, tasks, *words, pmix=True):
        return ['srun', *(['--mpi=pmix'] if pmix else []), f'--ntasks={tasks}', *self.command, *words]

    def finish(self, words, status=0):
        outcome = subprocess.run(words, cwd=self.place, env=self.slurm.environment, text=True, capture_output=True)
        text = outcome.stdout + outcome.stderr
        expect(outcome.returncode == status, f'{words}: status {outcome.returncode}, not {status}:\n{text}')
        return text

    def run_json(self, folder):
        return json.loads((self.place / folder / 'run.json').read_text())

    def wait_for_checkpoint(self, folder, seconds=240):
        deadline = time.monotonic() + seconds
        while not (self.place / folder / 'checkpoint.h5').exists():
            expect(time.monotonic() < deadline, f'{folder} has no checkpoint')
            time.sleep(0.01)


def by_slurm(runs):
    runs.finish([*runs.command, '--out', 'alone'])

    with subprocess.Popen(runs.srun(2, '--out', 'shared'), cwd=runs.place, env=runs.slurm.environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as program:
        runs.wait_for_checkpoint('shared')
        step = runs.slurm.call('squeue', '--steps', '--noheader', '--format=%i')
        runs.slurm.call('scancel', '--signal=TERM', step)
        text = program.communicate(timeout=240)[0]
    expect(program.returncode == 130 and '2 ranks of 1 thread' in text, f'status {program.returncode}, not 130:\n{text}')
    expect(runs.run_json('shared')['status'] == 'interrupted', 'the state was not saved')
    runs.finish(runs.srun(3, '--out', 'shared', '--resume'))
    found = runs.run_json('shared')
    expect(found['ranks'] == 3 and found['resumed'] == 1, f'{found["ranks"]} ranks, resumed {found["resumed"]}')
    runs.finish(['/usr/bin/python3', str(ROOT / 'scripts' / 'same_results.py'), 'alone', 'shared'])

    text = runs.finish(runs.srun(2, '--out', 'refused', pmix=False), status=2)
    expect('use srun --mpi=pmix' in text, f'not said how to start it:\n{text}')
    expect(not (runs.place / 'refused').exists(), 'ranks that are not connected have begun a run')


def main():
    grit = str(Path(sys.argv[1]).resolve())
    if why := slurm_here.missing():
        print(f'skipped: {why}')
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix='grit-srun-') as folder:
        try:
            with slurm_here.Slurm(Path(folder) / 'slurm') as slurm:
                kinds = subprocess.run(['srun', '--mpi=list'], env=slurm.environment, text=True, capture_output=True)
                if 'pmix' not in kinds.stdout + kinds.stderr:
                    print('skipped: this Slurm has no PMIx')
                    return SKIPPED
                by_slurm(Runs(Path(folder), grit, slurm))
        except (Failed, RuntimeError) as error:
            print(f'failed: {error}')
            return 1
    print('the same bits')
    return 0


if __name__ == '__main__':
    sys.exit(main())
