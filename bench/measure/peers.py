"""The dense box in the other codes: input, runs and results."""
import json
import math
import re
import shutil
import subprocess
from pathlib import Path
from typing import NamedTuple, Optional

from . import grit, machine
from .machine import Complaint
from .packing import STORE

ROOT = Path(__file__).resolve().parents[2]
INPUTS = ROOT / 'bench' / 'peers'
PROGRAMS = {'yade': 'yade', 'liggghts': 'liggghts', 'lammps': 'lmp'}
CODES = ('grit', *PROGRAMS)
RANKS = 'grit, ranks'  # grit in processes of one thread, as the other codes

# Name of the law in each code. Differences: bench/README.md.
LAWS = {
    'rolling': {'grit': 'linear-rolling', 'liggghts': 'hooke/stiffness, epsd2', 'lammps': 'granular hooke, sds',
                'yade': 'CohFrict 6D, moments'},
    'no-rolling': {'grit': 'linear-frictional', 'liggghts': 'hooke/stiffness', 'lammps': 'gran/hooke/history',
                   'yade': 'Cundall-Strack'},
    'hertz': {'grit': 'hertz-mindlin', 'liggghts': 'hertz', 'lammps': 'gran/hertz/history', 'yade': 'Hertz-Mindlin'},
}
SCENES = {'rolling': 'dense-box.json', 'no-rolling': 'dense-box-no-rolling.json', 'hertz': 'dense-box-hertz.json'}

TIME_STEP = 2.5e-7  # s
RATE = 10.0         # 1/s, along the axis that shortens
SKIN = 3e-5         # m; the fastest of 2e-5 … 15e-5 within noise, for LAMMPS and LIGGGHTS
MODULUS, SHEAR_TO_NORMAL, YOUNG, POISSON, RESTITUTION = 300e6, 0.3, 3.64e9, 0.3, 0.85
# LAMMPS and LIGGGHTS have one stiffness for all pairs: modulus × 0.24 mm, the mean of 2 Ra Rb / (Ra + Rb) over contacts.
STIFFNESS = MODULUS * 0.24e-3
FRICTION = math.tan(math.radians(18))
# 1/s. About 5 % of critical for the mean pair, which gives a restitution of 0.85.
DAMPING = 8e4
# LAMMPS multiplies this for Hertz by √(overlap × reduced radius), 1.1e-5 m at the mean contact, which is softer than above.
DAMPING_HERTZ = 0.77 * DAMPING / 1.1e-5


def versions(codes, program):
    said = {}
    for code in codes:
        if code == 'grit':
            said[code] = grit.version(program)
        else:
            package = subprocess.run(['dpkg-query', '-W', '-f', '${Version}', code], capture_output=True, text=True)
            said[code] = package.stdout.strip() or 'version unknown'
    return said


def installed(code):
    return code == 'grit' or shutil.which(PROGRAMS[code]) is not None


class Timed(NamedTuple):
    speed: float     # particle-steps per second
    contacts: float  # per grain
    others: float    # cores that other processes kept busy meanwhile
    of_critical: Optional[float] = None  # the time step over the critical one, if known
    reached: str = ''                    # fraction of the limit of the machine, as text
    flow: Optional[dict] = None          # figures to compare flows, and the time that it takes


def molecular(code, scene, values, threads, folder):
    """LAMMPS or LIGGGHTS, one rank per core: (the run, seconds of the timed steps)."""
    command = [PROGRAMS[code], '-in', INPUTS / f'{scene}.{code}', '-log', 'none']
    for name, value in values.items():
        command += ['-var', name, f'{value:.12e}' if isinstance(value, float) else value]
    if threads > 1:
        command = ['mpirun', '--allow-run-as-root', '-np', threads, '--bind-to', 'core', *command]
    done = machine.run(command, threads, folder)
    timed = re.search(r'^TIMED$(.*?)^END$', done.output, re.M | re.S)
    loop = timed and re.search(rf"^Loop time of (\S+) on \d+ procs for {values['steps']} steps", timed.group(1), re.M)
    if not loop:
        raise no_result(code, done)
    return done, float(loop.group(1))


def no_result(code, done):
    return Complaint(f'{code} ended without a result; its output:\n{done.output[-2000:]}')


class Box:
    """One packing, for every code."""

    scene = 'dense'
    shares = None  # fractions of the limits of the machine, if known

    def __init__(self, packing, program):
        self.packing, self.program = packing, program
        self.folder = STORE / 'compare' / packing.digest
        self._data = self._rows = None

    def run(self, code, law, threads, warm, steps):
        """Runs the code: Timed."""
        self.folder.mkdir(parents=True, exist_ok=True)
        if code == RANKS:
            return Timed(*self._grit(law, 1, warm, steps, ranks=threads))
        return Timed(*getattr(self, '_' + code)(law, threads, warm, steps))

    def _grit(self, law, threads, warm, steps, ranks=1):
        settings = self.packing.settings() | {'/stages/0/until/value': warm, '/stages/1/until/value': steps}
        window = grit.window(self.program, ROOT / 'bench' / 'scenes' / SCENES[law], self.folder / 'grit', threads,
                             settings, ranks=ranks)
        critical = window.facts['critical_time_step_s']
        return (window.particle_steps_per_second(), window.contacts_per_grain, window.others,
                critical and window.facts['time_step_s'] / critical,
                self.shares.of(LAWS[law]['grit'], threads, window) if self.shares and ranks == 1 else '')

    def _yade(self, law, threads, warm, steps):
        given = {'grains': str(self._plain()), 'sides': self.packing.cell.sides(), 'law': law, 'density': 2600.0,
                 'mu': FRICTION, 'modulus': MODULUS, 'shear_to_normal': SHEAR_TO_NORMAL, 'young': YOUNG,
                 'poisson': POISSON, 'restitution': RESTITUTION, 'dt': TIME_STEP, 'rate': RATE, 'warm': warm,
                 'steps': steps}
        done = machine.run(['yade', f'-j{threads}', '-n', '-x', INPUTS / 'dense-box.yade.py'], threads, self.folder,
                           {'DENSE_BOX': json.dumps(given), 'OMP_NUM_THREADS': str(threads),
                            'OMP_PROC_BIND': 'true', 'OMP_PLACES': 'cores'})
        found = re.search(r'^RESULT (\[.*\])', done.output, re.M)
        if not found:
            raise no_result('yade', done)
        seconds, before, after = json.loads(found.group(1))
        return self.packing.grains * steps / seconds, (before + after) / 2, done.others

    def _lammps(self, law, threads, warm, steps):
        kn, kt, gamma = STIFFNESS, SHEAR_TO_NORMAL * STIFFNESS, DAMPING
        if law == 'hertz':
            shear = YOUNG / (2 * (1 + POISSON))
            kn, kt, gamma = 4 * shear / (3 * (1 - POISSON)), 4 * shear / (2 - POISSON), DAMPING_HERTZ
        values = {'law': law.replace('-', '_'), 'kn': kn, 'kt': kt, 'gamma': gamma, 'mu': FRICTION, 'rolling': 0.8, 'rate': RATE}
        return self._molecular('lammps', values, threads, warm, steps)

    def _liggghts(self, law, threads, warm, steps):
        values = {'model': 'hertz' if law == 'hertz' else 'hooke/stiffness',
                  'resistance': 'epsd2' if law == 'rolling' else 'off', 'kn': STIFFNESS,
                  'kt': SHEAR_TO_NORMAL * STIFFNESS, 'gamma': DAMPING, 'mu': FRICTION, 'rolling': 0.8, 'young': YOUNG,
                  'poisson': POISSON, 'restitution': RESTITUTION, 'half': RATE / 2, 'less': -RATE}
        # LIGGGHTS does not evaluate formulas within a command.
        for axis, side, rate in zip('xyz', self.packing.cell.sides(), (RATE / 2, RATE / 2, -RATE)):
            values |= {f'{axis}high': side, f'v{axis}': rate * side / 2, f'v{axis}_low': -rate * side / 2}
        return self._molecular('liggghts', values, threads, warm, steps)

    def _molecular(self, code, values, threads, warm, steps):
        values |= {'data': self._atoms(), 'skin': SKIN, 'dt': TIME_STEP, 'warm': warm, 'steps': steps}
        done, seconds = molecular(code, 'dense-box', values, threads, self.folder)
        contacts = re.findall(r'^CONTACTS (\S+)$', done.output, re.M)
        if len(contacts) != 2:
            raise no_result(code, done)
        return self.packing.grains * steps / seconds, sum(map(float, contacts)) / 2, done.others

    def _plain(self):
        """The grains without comments, relative to the corner of the cell."""
        path = self.folder / 'grains.txt'
        if self._rows is None:
            self._rows = path
            with open(path, 'w', encoding='utf-8') as out:
                out.writelines(f'{x!r} {y!r} {z!r} {r!r}\n' for x, y, z, r in self.packing.rows())
        return path

    def _atoms(self):
        """LAMMPS's data file."""
        path = self.folder / 'atoms.data'
        if self._data is None:
            self._data = path
            with open(path, 'w', encoding='utf-8') as out:
                out.write(f'dense box\n\n{self.packing.grains} atoms\n1 atom types\n\n')
                out.writelines(f'0.0 {side!r} {axis}lo {axis}hi\n' for axis, side in zip('xyz', self.packing.cell.sides()))
                out.write('\nAtoms\n\n')
                out.writelines(f'{i} 1 {2 * r!r} 2600.0 {x!r} {y!r} {z!r}\n'
                               for i, (x, y, z, r) in enumerate(self.packing.rows(), 1))
        return path
