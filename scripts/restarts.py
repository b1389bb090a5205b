#!/usr/bin/python3
"""Stops and continues a short version of every quick description of sims/, and of scenes for plugins that none of them uses: the
results must have the same bits as those of a run that was never stopped.

  restarts.py [--only PATTERN]... [--steps N] [--ranks N,M] [--grit FILE] [--shim FILE] [--markdown [PAGE]]

Each stage ends after N steps (fewer if a guard would stop the run), so that a run passes through all that its stages change and
measure. It stops at the frame next after half of its steps, by a signal that the library of tests/faults sends there, and continues
from its checkpoint. It takes one thread without the stop, two before and three after it, or with --ranks so many processes of MPI.
Compared are all results (same_results.py).

Prints a table, and the plugins that no scene used, which is a failure unless --only is given. --markdown writes the table into PAGE,
docs/evidence/reliability.md unless given.

Exit status: 0 the same bits everywhere; 1 not so; 2 wrong use.
"""
import argparse
import fnmatch
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

import brief
import mpi
import same_results
import tables

ROOT = Path(__file__).resolve().parents[1]
WORK = ROOT / 'results' / 'restarts'
PAGE = ROOT / 'docs' / 'evidence' / 'reliability.md'

DONE, NUMERICS, INTERRUPTED = 0, 4, 130
FEWEST = 50                                              # steps of a stage
FRAMES_PER_STAGE = 4
KINDS = {'bodies': 'body', 'contacts': 'contact', 'engines': 'engine', 'geometry': 'geometry', 'probes': 'probe',
         'scenarios': 'scenario'}

HERTZ = {'young_modulus': '50 MPa', 'poisson_ratio': 0.2, 'friction_angle': '25 deg', 'restitution': 0.6, 'density': '2600 kg/m^3'}
# Plugins that no quick description uses, in scenes of sims/: what is merged into the description, null removes.
EXTRA = {
    'hertz-mindlin': ('column/quick.json', {
        'contacts': {'type': 'hertz-mindlin'}, 'materials': {'sand': HERTZ | {'rolling_stiffness': 0.5, 'rolling_limit': 0.2}}}),
    'jkr': ('column/quick.json', {'contacts': {'type': 'jkr'}, 'materials': {'sand': HERTZ | {'surface_energy': 0.01}}}),
    'capillary': ('column/quick.json', {
        'contacts': {'type': 'capillary', 'bridge_volume': 1e-12},
        'materials': {'sand': {'contact_modulus': '10 MPa', 'friction_angle': '25 deg', 'restitution': 0.6, 'density': '2600 kg/m^3'}}}),
    'drag, force-field': ('column/quick.json', {'engines': {
        'air': {'type': 'drag', 'viscosity': 1.8e-5, 'density': 1.2},
        'shaking': {'type': 'force-field', 'x': '2 * sin(200 * time)'}}}),
    'planar': ('column/quick.json', {
        'bodies': {'sand': {'source': {
            'type': 'lattice', 'kind': 'simple-cubic', 'low': ['1 mm', '4 mm', '1 mm'], 'high': ['19 mm', '6 mm', '61 mm'],
            'diameter': '2 mm', 'count': None, 'sizes': None}}},
        'engines': {'plane': {'type': 'planar'}}}),
    'facets': ('screw/quick.json', {'probes': {'facets': {'type': 'facets', 'wall': 'flight', 'every_steps': 50}}}),
}


def merged(description, changes):
    for key, value in changes.items():
        if value is None:
            description.pop(key, None)
        elif isinstance(value, dict) and isinstance(description.get(key), dict):
            merged(description[key], value)
        else:
            description[key] = value
    return description


def of_materials(description, changes):
    """Materials whose laws differ have other parameters: those of the changes replace the old ones."""
    for name in changes.get('materials', {}):
        description['materials'].pop(name, None)
    return merged(description, changes)


def scenario_of(file):
    """The scenario that a description, or one that it extends, names; None without."""
    while True:
        description = json.loads(file.read_text(encoding='utf-8'))
        scenario = description.get('scenario', {})
        if 'type' in scenario:
            return scenario['type']
        if 'extends' not in description:
            return None
        file = file.parent / description['extends']


def scenes():
    """Name: file and changes."""
    found = {f'{file.parent.name}/{file.stem}': (file, {}) for file in sorted(ROOT.glob('sims/*/quick*.json'))}
    for name, (file, changes) in EXTRA.items():
        found[name] = ROOT / 'sims' / file, changes
    return found


def plugins():
    """Those of this tree: {(kind, name)}."""
    return {(kind, folder.name) for place, kind in KINDS.items() for folder in (ROOT / 'plugins' / place).glob('*/') if folder.is_dir()}


def ranks_of(text):
    before, after = (int(number) for number in text.split(','))
    return before, after


class Scene:
    def __init__(self, given, name, file, changes, place):
        self.given, self.name, self.file, self.changes = given, name, file, changes
        self.place = place / name.replace('/', '-').replace(', ', '-')
        self.place.mkdir()
        self.used = set()

    def run(self, threads, *more, ranks=1, environment=None):
        words = mpi.words(ranks, [self.given.grit, 'run', *more, '--threads', str(threads), '--no-report'])
        done = subprocess.run(words, capture_output=True, text=True, check=False, env=os.environ | mpi.ENVIRONMENT | (environment or {}))
        return done.returncode, done.stderr.strip()

    def write(self, steps):
        description = of_materials(brief.expanded(self.given.grit, self.file), self.changes)
        brief.shorten(description, steps)
        brief.set_output(description, frames={'every_steps': max(1, steps // FRAMES_PER_STAGE)}, checkpoint_every=0)
        path = self.place / 'scene.json'
        path.write_text(json.dumps(description, indent=1), encoding='utf-8')
        return path

    def whole(self):
        """Runs without a stop, with fewer steps if a guard stops it. The description that was run."""
        steps = self.given.steps
        while True:
            scene = self.write(steps)
            status, errors = self.run(1, scene, '--out', self.place / 'whole', '--overwrite')
            if status == DONE:
                return scene
            if status != NUMERICS or steps <= FEWEST:
                raise ValueError(f'exit status {status}: {errors[-300:]}')
            steps = max(FEWEST, steps // 4)

    def restart(self):
        """The step of the restart, the number of steps, and lines for what differs. Throws ValueError."""
        scene = self.whole()
        whole, part = self.place / 'whole', self.place / 'part'
        facts = json.loads((whole / 'run.json').read_text(encoding='utf-8'))
        self.used = {(plugin['kind'], plugin['name']) for plugin in facts['plugins']}
        before, after = self.given.ranks
        status, errors = self.run(2 if before == after == 1 else 1, scene, '--out', self.place / 'again')
        if status != DONE:
            raise ValueError(f'a second run ends with exit status {status}: {errors[-300:]}')
        frame = self.frame_after(whole, facts['steps'] / 2)
        environment = {'LD_PRELOAD': str(self.given.shim), 'FAULTS_BELOW': str(part.resolve() / 'frames' / frame),
                       'FAULTS_FAIL': 'rename:1:TERM:once'}
        status, errors = self.run(2 if before == 1 else 1, scene, '--out', part, ranks=before, environment=environment)
        if status != INTERRUPTED:
            raise ValueError(f'the run was not stopped at frames/{frame}: exit status {status}: {errors[-300:]}')
        status, errors = self.run(3 if after == 1 else 1, part, '--resume', ranks=after)
        if status != DONE:
            raise ValueError(f'--resume ends with exit status {status}: {errors[-300:]}')
        step = json.loads((part / 'run.json').read_text(encoding='utf-8'))['resumed_at_step']
        return step, facts['steps'], same_results.Reference([whole, self.place / 'again']).differences(part)

    @staticmethod
    def frame_after(folder, step):
        for path in sorted((folder / 'frames').glob('*.h5')):
            with h5py.File(path) as file:
                if int(file.attrs['step']) > step:
                    return path.name
        raise ValueError(f'no frame after step {step:g}')


HEAD = ('description', 'steps', 'restarted at step', 'result', 'date')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--only', action='append', default=[], metavar='PATTERN', help="of descriptions ('triaxial/*') and plugins ('jkr')")
    parser.add_argument('--ranks', type=ranks_of, default=(1, 1), metavar='N,M', help='processes of MPI before and after the restart')
    parser.add_argument('--steps', type=int, default=1000, metavar='N', help='of each stage')
    parser.add_argument('--grit', type=Path, default=ROOT / 'build/bin/grit', metavar='FILE')
    parser.add_argument('--shim', type=Path, default=ROOT / 'build/tests/faults/faults_shim.so', metavar='FILE')
    parser.add_argument('--work', type=Path, default=WORK, metavar='DIR', help='where the runs are')
    parser.add_argument('--markdown', type=Path, nargs='?', const=PAGE, metavar='PAGE')
    given = parser.parse_args()
    for file in (given.grit, given.shim):
        if not file.is_file():
            parser.error(f'{file} does not exist; build the tree, with its tests, or name the file')
    given.grit, given.shim = given.grit.resolve(), given.shim.resolve()
    chosen = {name: scene for name, scene in scenes().items() if not given.only or any(fnmatch.fnmatch(name, one) for one in given.only)}
    if not chosen:
        parser.error('no description matches')
    given.work.mkdir(parents=True, exist_ok=True)
    place = Path(tempfile.mkdtemp(prefix='', dir=given.work.resolve()))
    rows, used, failed = [], set(), 0
    for name, (file, changes) in chosen.items():
        scene = Scene(given, name, file, changes, place)
        try:
            step, steps, lines = scene.restart()
            result = '; '.join(lines) if lines else 'same bits'
        except (ValueError, OSError) as error:
            step, steps, lines = '', '', [str(error)]
            result = 'failed'
        failed += bool(lines)
        rows.append([name, steps, step, result, tables.today()])
        print(f'{name}: {result}' + ('' if result != 'failed' else f': {lines[0]}'), flush=True)
        used |= scene.used
        scenario = scenario_of(file)
        if scenario:
            used.add(('scenario', scenario))
        if not lines:
            shutil.rmtree(scene.place)
    print(tables.table(HEAD, rows), end='')
    if given.markdown is not None:
        page = given.markdown.read_text(encoding='utf-8')
        given.markdown.write_text(tables.with_table(page, 'restarts' if given.ranks == (1, 1) else 'ranks', HEAD, rows, list(scenes())), encoding='utf-8')
    if failed:
        print(f'the runs that failed are in {place}')
    else:
        shutil.rmtree(place)
    unused = sorted(plugins() - used)
    if unused and not given.only:
        print('in no scene: ' + ', '.join(' '.join(one) for one in unused) + '; add one to EXTRA')
        failed += 1
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
