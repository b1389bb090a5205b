#!/usr/bin/python3
"""Writes the tables of docs/evidence/silos.md from finished runs of the full silos.

  silos.py [--results FOLDER]

FOLDER/silo-quasistatic/full-* and FOLDER/silo-discharge/full-* (results/reproduce unless given) are read. What is found in a run is
kept in docs/evidence/silos.json, so that the tables also have runs of other machines. A run replaces an earlier one of its name.
"""
import argparse
import json
import re
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parents[1]
PAGE, FIGURES = ROOT / 'docs/evidence/silos.md', ROOT / 'docs/evidence/silos.json'
# mm that the bottom was lowered by, and shares that flowed out, of the columns of the tables
LOWERED, DISCHARGED = (0.25, 0.5, 1, 2, 5, 10, 20, 30), (0.01, 0.05, 0.1, 0.2, 0.3, 0.4)
FRACTIONS = {'P/G': 'bottom_fraction', 'T/G': 'wall_shear_fraction', 'N/G': 'wall_normal_fraction', 'φ_w': 'wall_friction_angle'}
LAYERS = 10                                              # of which the tables have wall stresses
# Shear zones at the walls, in layers from one height to another [m]: rotation is averaged over columns of this width [m]
ZONES, COLUMN = ((0.05, 0.15), (0.15, 0.25), (0.25, 0.35)), 0.0025


class Run:
    """What is read of the results of one run."""

    def __init__(self, folder):
        self.facts = json.loads((folder / 'run.json').read_text(encoding='utf-8'))
        self.constants = {name: entry['value'] for name, entry in self.description(folder)['probes']['test']['constants'].items()}
        self.references = {name: entry['value'] for name, entry in self.description(folder)['output']['references'].items() if 'value' in entry}
        with h5py.File(folder / 'series.h5') as series:
            self.series = {f'{probe}/{name}': values[()] for probe in ('test', 'wall-profile', 'flow') if probe in series
                           for name, values in series[probe].items()}
        with h5py.File(max((folder / 'frames').glob('*.h5'))) as frame:
            self.bodies = {name: frame['bodies'][name][()] for name in ('position', 'radius', 'rotation')}
        self.way = 'test/settlement' if 'test/settlement' in self.series else 'test/discharged_fraction'

    @staticmethod
    def description(folder):
        return json.loads((folder / 'description.json').read_text(encoding='utf-8'))

    def rest(self, probe='test'):
        """The last sample of a probe before the bottom or the gate moves."""
        moves = self.series['test/step'][numpy.nonzero(self.series[self.way] > 0)[0][0]]
        return int(numpy.searchsorted(self.series[f'{probe}/step'], moves)) - 1

    def at(self, channel, way):
        """The mean of a channel around a place on the way: its samples from 0.9 to 1.1 times that, or the nearest one."""
        passed, values = self.series[self.way][self.rest():], self.series[channel][self.rest():]
        near = numpy.abs(passed - way) <= 0.1 * way
        return float(values[near].mean()) if near.any() else float(values[numpy.abs(passed - way).argmin()])

    def figures(self):
        rest = self.rest()
        value = {name: float(self.series[f'test/{channel}'][rest]) for name, channel in FRACTIONS.items()}
        value |= {'K': float(self.series['test/lateral_stress_ratio'][rest]), 'e': float(self.series['test/void_ratio'][rest]),
                  '(P + 2T)/G': float(self.series['test/balance'][rest]), 'G': float(self.series['test/weight'][rest])}
        scale, places = (1e3, LOWERED) if self.way == 'test/settlement' else (1, DISCHARGED)
        gone = scale * self.series[self.way].max()
        places = [place for place in places if place <= 1.001 * gone]
        along = {name: [self.at(f'test/{channel}', place / scale) for place in places] for name, channel in FRACTIONS.items()}
        friction = self.series['test/wall_friction_angle']
        late = self.series[self.way] >= 0.75 * self.series[self.way].max()
        ended = {'largest φ_w': float(friction[rest:].max()), 'at': scale * float(self.series[self.way][rest + friction[rest:].argmax()]),
                 'φ_w': float(friction[late].mean()), 'P': float(self.series['test/bottom_force'][late].mean())}
        if 'flow/discharge_rate' in self.series:
            rate = self.series['flow/discharge_rate']
            ended['rate'] = float(rate[len(rate) // 2:].mean())
        return {'rest': value, 'places': places, 'along': along, 'end': ended, 'references': self.references,
                'walls': self.walls(), 'zones': self.zones(), 'run': self.made()}

    def walls(self):
        """Stresses on the walls by layers from the bottom up [Pa], at rest and in the end, and by Janssen."""
        if 'wall-profile/normal_stress' not in self.series:
            return None
        # The highest strip is above the filling.
        heights = self.series['wall-profile/position'][self.rest('wall-profile')]
        height, last = self.constants['height'], len(self.series['wall-profile/step'])

        def layers(channel, samples):
            stress = self.series[f'wall-profile/{channel}'][samples].mean(axis=0)
            return [float(stress[numpy.minimum(heights // (height / LAYERS), LAYERS).astype(int) == layer].mean()) for layer in range(LAYERS)]

        at_rest, at_the_end = slice(self.rest('wall-profile'), self.rest('wall-profile') + 1), slice(last - max(1, last // 4), last)
        found = {f'{when}, {what}': layers(channel, samples) for when, samples in (('at rest', at_rest), ('in the end', at_the_end))
                 for what, channel in (('σ_n', 'normal_stress'), ('τ', 'shear_stress'))}
        if {'Janssen_K', 'Janssen_wall_friction'} <= set(self.references):
            friction, ratio = numpy.tan(numpy.radians(self.references['Janssen_wall_friction'])), self.references['Janssen_K']
            weight = float(self.series['test/weight'][self.rest()]) / (self.constants['area'] * height)
            depth = height * (1 - (numpy.arange(LAYERS) + 0.5) / LAYERS)
            normal = weight * self.constants['width'] / (2 * friction) * (1 - numpy.exp(-2 * ratio * friction * depth / self.constants['width']))
            found |= {'Janssen, σ_n': normal.tolist(), 'Janssen, τ': (friction * normal).tolist()}
        return found

    def zones(self):
        """Widths of the shear zones at the left and right wall in the last frame, over d50 by mass: mean rotation falls to a twentieth of its largest
        value, above the mean of the middle half of the silo."""
        x, _, z = self.bodies['position'].T
        mass, turned = self.bodies['radius']**3, numpy.abs(self.bodies['rotation'][:, 1])
        ascending = numpy.argsort(mass)
        d50 = 2 * self.bodies['radius'][ascending][numpy.searchsorted(numpy.cumsum(mass[ascending]), mass.sum() / 2)]
        width, found = self.constants['width'], {'left': [], 'right': []}
        for low, high in ZONES:
            layer = (z >= low) & (z < high)
            middle = layer & (numpy.abs(x - width / 2) < width / 4)
            least = numpy.average(turned[middle], weights=mass[middle])
            for side, distance in (('left', x), ('right', width - x)):
                half = layer & (distance < width / 2)
                column = numpy.maximum(distance[half] // COLUMN, 0).astype(int)
                mean = numpy.bincount(column, mass[half] * turned[half]) / numpy.bincount(column, mass[half]) - least
                ends = numpy.nonzero(mean < mean.max() / 20)[0]
                found[side].append(float(COLUMN * ends[ends > mean.argmax()][0] / d50))
        return found

    def made(self):
        """By which command, commit and machine."""
        words = self.facts['commands'][0]
        sets = [words[i + 1] for i, word in enumerate(words) if word == '--set']
        return {'settings': sets, 'commit': self.facts['grit'].get('revision') or 'unknown', 'bodies': self.facts['bodies'], 'steps': self.facts['steps'],
                'core_hours': self.facts['cpu_s'] / 3600, 'instruction_set': self.facts['grit']['instruction_set'], 'date': self.facts['started'][:10]}


def table(head, lines):
    return [f'| {" | ".join(head)} |', f'|{" --- |" * len(head)}', *(f'| {" | ".join(map(str, line))} |' for line in lines)]


def compared(value, reference, digits):
    return f'{value:.{digits}f}' + ('' if reference is None else f' ({reference:.{digits}f})')


def pages(runs):
    """Name of each table and its lines."""
    def reference(run, name):
        return run['references'].get(f'{name}_Grabowski_2024')

    rest, lowered, flowing, ends, walls, zones, made = [], [], [], [], [], [], []
    for name, run in runs.items():
        value, end = run['rest'], run['end']
        rest.append([name, *(compared(value[short], reference(run, f'{label}_after_filling'), digits) for short, label, digits in
                             (('P/G', 'P_over_G', 2), ('T/G', 'T_over_G', 2), ('N/G', 'N_over_G', 2), ('φ_w', 'wall_friction_angle', 1))),
                     *(f'{run["references"][f"Janssen_{short}_over_G"]:.2f}' if f'Janssen_{short}_over_G' in run['references'] else '' for short in 'PTN'),
                     f'{value["K"]:.2f}', f'{value["e"]:.3f}', f'{value["(P + 2T)/G"]:.4f}'])
        along = lowered if name.startswith('silo-quasistatic') else flowing
        for short in FRACTIONS:
            digits = 1 if short == 'φ_w' else 3
            numbers = [f'{number:.{digits}f}' for number in run['along'][short]]
            along.append([name, short, *numbers, *[''] * (len(LOWERED if along is lowered else DISCHARGED) - len(numbers))])
        if along is lowered:
            ends.append([name, f'{compared(end["largest φ_w"], reference(run, "largest_wall_friction_angle"), 1)}', f'{end["at"]:.2f}', f'{end["φ_w"]:.1f}',
                         compared(end['P'], reference(run, 'P_in_the_end'), 2),
                         *(f'{run["references"][formula]:.2f}' if formula in run['references'] else '' for formula in ('Drescher', 'EN_1991-4'))])
        if run['walls']:
            walls += [[name, what, *(f'{stress / 1e3:.2f}' for stress in stresses)] for what, stresses in run['walls'].items()]
        zones += [[name, side, *(f'{width:.1f}' for width in widths)] for side, widths in run['zones'].items()]
        by = run['run']
        made.append([name, ' '.join(f'`{one}`' for one in by['settings']) or 'as described', f'{by["bodies"]:,}', f'{by["steps"]:,}',
                     f'{by["core_hours"]:.2f}', by['commit'], f'{by["instruction_set"]}, {by["date"]}'])
    return {
        'at rest': table(['run', 'P/G', 'T/G', 'N/G', 'φ_w, deg', 'Janssen P/G', 'T/G', 'N/G', 'K', 'e', '(P + 2T)/G'], rest),
        'lowered': table(['run', 'lowered by, mm', *map(str, LOWERED)], lowered) if lowered else [],
        'ends': table(['run', 'largest φ_w, deg', 'at, mm', 'φ_w in the end', 'P in the end, N', 'Drescher', 'EN 1991-4'], ends) if ends else [],
        'discharged': table(['run', 'share that flowed out', *map(str, DISCHARGED)], flowing) if flowing else [],
        'walls': table(['run', 'kPa, by layers from the bottom up', *(str(layer + 1) for layer in range(LAYERS))], walls),
        'zones': table(['run', 'wall', *(f'{1e3 * low:.0f} to {1e3 * high:.0f} mm' for low, high in ZONES)], zones),
        'runs': table(['run', 'settings', 'grains', 'steps', 'core-hours', 'commit', 'machine'], made),
    }


def with_tables(page, tables):
    """The page with each table between its markers."""
    for name, lines in tables.items():
        begin, end = f'<!-- {name} -->', f'<!-- end of {name} -->'
        if page.count(begin) != 1 or page.count(end) != 1:
            raise ValueError(f'docs/evidence/silos.md: found no place for a table; it needs one line {begin} and one line {end} below')
        text = '\n'.join(lines)
        page = re.sub(f'{re.escape(begin)}\n.*?{re.escape(end)}', lambda _, begin=begin, text=text, end=end: f'{begin}\n{text}\n{end}', page, flags=re.DOTALL)
    return page


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--results', default=ROOT / 'results' / 'reproduce', type=Path)
    given = parser.parse_args()
    runs = json.loads(FIGURES.read_text(encoding='utf-8')) if FIGURES.exists() else {}
    for folder in sorted(given.results.glob('silo-*/full-*')):
        try:
            if json.loads((folder / 'run.json').read_text(encoding='utf-8'))['status'] != 'done':
                continue
        except OSError:
            continue
        runs[f'{folder.parent.name}/{folder.name}'] = Run(folder).figures()
    runs = dict(sorted(runs.items()))
    FIGURES.write_text(json.dumps(runs, indent=1, ensure_ascii=False) + '\n', encoding='utf-8')
    PAGE.write_text(with_tables(PAGE.read_text(encoding='utf-8'), pages(runs)), encoding='utf-8')
    print(f'docs/evidence/silos.md: {len(runs)} runs')


if __name__ == '__main__':
    main()
