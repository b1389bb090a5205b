"""The flowing scenes in grit, LIGGGHTS and LAMMPS: one state of motion, runs and results."""
import json
import math
import re
import statistics
from typing import NamedTuple

from . import grit, packing, peers
from .peers import ROOT, STORE, Timed

SCENES = ('drum', 'silo')
LAWS = ('hertz',)
PEERS = ('grit', 'liggghts', 'lammps')
OWN_STEP = 'grit, own step'  # grit with the time step that it chooses
# Of a run, beside those of a dense packing: J per grain, degrees or grains/s, s, s per simulated s.
FIGURES = ('energy', 'flow', 'step', 'seconds_per_second')
WARM_UP, STEPS = 1000, 2000

RAYLEIGH = 0.2    # the time step of all codes over the Rayleigh time of the smallest grain, as users of the others choose it
SKIN = 1.2e-3     # m; the fastest of 5e-4 … 17e-4 within noise, for LAMMPS and LIGGGHTS
OVERLAP = 2e-5    # m, of the mean contact: LAMMPS's dashpot is there as strong as the others'
DIFFERS = 0.05    # flows differ if contacts or energy per grain do by more than this fraction


class State(NamedTuple):
    grains: int
    contacts: float  # per grain
    energy: float    # J, of motion, of all grains
    angle: float     # degrees, of the centre of mass of a drum's bed from the lowest point


def among(codes):
    """Those that run the scenes, and grit once more with its own step."""
    return [one for code in codes if code in PEERS for one in ((code, OWN_STEP) if code == 'grit' else (code,))]


class Flow:
    """A scene, for every code."""

    def __init__(self, scene, program, settings=None):
        """settings: of the filling."""
        self.scene, self.program = scene, program
        self.file = ROOT / 'bench' / 'scenes' / f'{scene}-hertz.json'
        self.packing = packing.flowing(program, f'{scene}-hertz', settings)
        self.folder = STORE / 'compare' / self.packing.digest
        self.given = json.loads(self.file.read_text(encoding='utf-8'))
        self.grain = self.given['materials']['sand']
        self.step = self._step()

    def run(self, code, _law, threads, warm, steps):
        """Runs the code: Timed."""
        self.folder.mkdir(parents=True, exist_ok=True)
        if code in ('grit', OWN_STEP):
            return self._grit(code == OWN_STEP, threads, warm, steps)
        return self._molecular(code, threads, warm, steps)

    def _step(self):
        """The common time step, with two digits."""
        nu, rho = self.grain['poisson_ratio'], self.grain['density']
        rayleigh = math.pi * self.packing.radii[0] * math.sqrt(rho / self._shear_modulus()) / (0.1631 * nu + 0.8766)
        return float(f'{RAYLEIGH * rayleigh:.2g}')

    def _shear_modulus(self):
        return self.grain['young_modulus'] / (2 * (1 + self.grain['poisson_ratio']))

    def _grit(self, own, threads, warm, steps):
        settings = {'/bodies/sand/source/path': str(self.packing.path)}
        for stage, length in enumerate((warm, steps)):
            until = {'type': 'time', 'value': length * self.step} if own else {'type': 'steps', 'value': length}
            settings[f'/stages/{stage}/until'] = until
        if not own:
            settings['/time_step'] = {'value': self.step, 'allow_unstable': True}
        done = grit.run(self.program, self.file, self.folder / ('grit-own-step' if own else 'grit'), threads, settings)
        stages = done.facts['stages']
        states = [State(stage['bodies'], done.final(f'packing{when}/coordination_number'),
                        done.final(f'packing{when}/kinetic_energy', 'J'),
                        done.final(f'bed{when}/angle') if self.scene == 'drum' else 0.0)
                  for stage, when in zip(stages, ('_before', ''))]
        steps, seconds, span = (stages[1][key] - stages[0][key] for key in ('step', 'wall_s', 'time'))
        critical = done.facts['critical_time_step_s']
        return self._timed(states, steps, seconds, span, done.others, critical and done.facts['time_step_s'] / critical)

    def _molecular(self, code, threads, warm, steps):
        values = {'data': self.packing.path, 'skin': SKIN, 'dt': self.step, 'warm': warm, 'steps': steps,
                  'mu': math.tan(self.grain['friction_angle'])} | getattr(self, '_' + code)() | getattr(self, '_' + self.scene)(code)
        done, seconds = peers.molecular(code, self.scene, values, threads, self.folder)
        states = []
        for line in re.findall(r'^STATE (.*)$', done.output, re.M):
            grains, contacts, energy, *centre = map(float, line.split())
            states.append(State(round(grains), contacts, energy, math.degrees(math.atan2(centre[0], -centre[1])) if centre else 0.0))
        if len(states) != 2:
            raise peers.no_result(code, done)
        return self._timed(states, steps, seconds, steps * self.step, done.others, None)

    def _timed(self, states, steps, seconds, span, others, of_critical):
        before, after = states
        flow = statistics.mean((before.angle, after.angle)) if self.scene == 'drum' else (before.grains - after.grains) / span
        return Timed(statistics.mean((before.grains, after.grains)) * steps / seconds,
                     statistics.mean(one.contacts for one in states), others, of_critical,
                     flow=dict(zip(FIGURES, (statistics.mean(one.energy / one.grains for one in states), flow, span / steps,
                                             seconds / span))))

    def _liggghts(self):
        return {'young': self.grain['young_modulus'], 'poisson': self.grain['poisson_ratio'],
                'restitution': self.grain['restitution']}

    def _lammps(self):
        nu, shear = self.grain['poisson_ratio'], self._shear_modulus()
        radius = self.packing.radii[1] / 2  # both of the mean pair
        mass = self.grain['density'] * 4 / 3 * math.pi * self.packing.radii[1] ** 3 / 2
        ratio = -math.log(self.grain['restitution']) / math.hypot(math.log(self.grain['restitution']), math.pi)
        # The others' dashpot is 2 √(5/6) ratio √(2 E* a mass), with the radius a of the contact area; this one gamma a mass.
        gamma = 2 * ratio * math.sqrt(5 / 6 * 2 * shear / (1 - nu) / (math.sqrt(radius * OVERLAP) * mass))
        return {'kn': 4 * shear / (3 * (1 - nu)), 'kt': 4 * shear / (2 - nu), 'gamma': gamma}

    def _drum(self, code):
        drum = self.given['walls']['drum']
        radius, spin = drum['radius'], drum['motion']['spin'][2]
        # LIGGGHTS takes the speed of this wall at the centre of a grain.
        arm = 1 - self.packing.radii[1] / radius if code == 'liggghts' else 1
        return {'radius': radius, 'length': self.given['walls']['far']['point'][2], 'spin': spin / arm}

    def _silo(self, _code):
        walls = self.given['walls']
        (left, right), depth, width = (
            [walls[name]['corner'][0] for name in ('floor_left', 'floor_right')], walls['back']['point'][1], walls['right']['point'][0])
        left += walls['floor_left']['edge_a'][0]
        floor = self.folder / 'floor.stl'
        with open(floor, 'w', encoding='ascii') as out:
            out.write('solid floor\n')
            for low, high in ((0.0, left), (right, width)):
                a, b, c, d = (low, 0.0), (high, 0.0), (high, depth), (low, depth)
                for corners in ((a, b, c), (a, c, d)):
                    out.write('facet normal 0 0 1\nouter loop\n' + ''.join(f'vertex {x!r} {y!r} 0.0\n' for x, y in corners)
                              + 'endloop\nendfacet\n')
            out.write('endsolid floor\n')
        return {'width': width, 'depth': depth, 'left': left, 'right': right, 'floor': floor}


def differs(one, other):
    """Whether two rows of a scene are of different flows."""
    return any(abs(one[key] - other[key]) > DIFFERS * other[key] for key in ('contacts_per_grain', 'energy'))


def in_words(scene, flow):
    return f'{flow:.1f}°' if scene == 'drum' else f'{flow:.0f} grains/s'
