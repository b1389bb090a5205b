"""usage: test_silos.py ROOT [what unittest takes]

The tables that scripts/silos.py writes, from results with known values. Exit status 77 where there is no h5py.
"""
import json
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

try:
    import h5py
    import numpy
except ImportError:
    print("skipped: Python's h5py is not installed (Debian: python3-h5py)")
    sys.exit(77)

sys.dont_write_bytecode = True
ROOT = sys.argv[1]
sys.path.insert(0, f'{ROOT}/scripts')
import silos  # noqa: E402

PAGE = 'Above.\n\n' + ''.join(f'<!-- {name} -->\n<!-- end of {name} -->\n\n' for name in ('at rest', 'lowered', 'ends', 'discharged', 'walls', 'zones', 'runs'))
# P/G falls to 0.2 at a displacement of 1 mm and stays; the wall carries the rest.
WAY = numpy.array([0, 0, 0.5e-3, 1e-3, 5e-3, 10e-3])
BOTTOM = numpy.array([0.9, 0.5, 0.3, 0.2, 0.2, 0.2])
FRICTION = numpy.array([50, 30, 40, 44, 43, 41])         # the first is before it rests
STRIPS = 21


def write(folder, status='done'):
    """A run of 100 grains of 10 N between walls of 0.5 m height and 0.2 m distance."""
    folder.mkdir(parents=True)
    (folder / 'run.json').write_text(json.dumps({
        'status': status, 'commands': [['grit', 'run', 'full.json', '--set', '/scenario/seed=2', '--out', 'x']], 'bodies': 1000, 'steps': 5000,
        'cpu_s': 1800, 'started': '2026-01-02T03:04:05Z', 'grit': {'revision': 'abcdef', 'instruction_set': 'x86-64-v3'}}), encoding='utf-8')
    constants = {'area': 0.002, 'height': 0.5, 'width': 0.2}
    references = {'P_over_G_after_filling_Grabowski_2024': 0.55, 'Janssen_P_over_G': 0.6, 'Janssen_K': 0.5, 'Janssen_wall_friction': 45,
                  'EN_1991-4': 3, 'P_in_the_end_Grabowski_2024': 4}
    (folder / 'description.json').write_text(json.dumps({
        'probes': {'test': {'constants': {name: {'value': value} for name, value in constants.items()}}},
        'output': {'references': {name: {'value': value} for name, value in references.items()} | {'curve': {'file': 'x.csv'}}}}), encoding='utf-8')
    steps = numpy.arange(len(WAY)) * 100
    with h5py.File(folder / 'series.h5', 'w') as series:
        for name, values in {'step': steps, 'settlement': WAY, 'bottom_fraction': BOTTOM, 'bottom_force': 10 * BOTTOM, 'wall_shear_fraction': (1 - BOTTOM) / 2,
                             'wall_normal_fraction': 0.4 + 0 * WAY, 'wall_friction_angle': FRICTION, 'lateral_stress_ratio': 0.7 + 0 * WAY,
                             'void_ratio': 0.65 + 0 * WAY, 'balance': 1 + 0 * WAY, 'weight': 10 + 0 * WAY}.items():
            series[f'test/{name}'] = values
        # The stress is 1 kPa in each layer at rest and 10 kPa by the number of the layer in the end; nothing is above the filling.
        heights = (numpy.arange(STRIPS) + 0.5) * 0.525 / STRIPS
        layers = numpy.minimum(heights // 0.05, 10) + 1
        for channel, factor in (('normal_stress', 1), ('shear_stress', 0.5)):
            at_rest = numpy.where(heights < 0.5, 1e3, -7e9)
            series[f'wall-profile/{channel}'] = factor * numpy.array([0 * layers, at_rest, at_rest, 1e4 * layers])
        series['wall-profile/position'] = numpy.tile(heights, (4, 1))
        series['wall-profile/step'] = [0, 100, 300, 500]
    # Rotation decreases linearly from 40° at the wall to 0 at 20 mm, where d50 is 2 mm; the right wall has half of the width.
    x, z = numpy.meshgrid(numpy.arange(0.00125, 0.2, 0.0025), numpy.arange(0.005, 0.5, 0.01))
    x, z = x.ravel(), z.ravel()
    turned = numpy.radians(numpy.maximum(0, 40 - 2e3 * x) + numpy.maximum(0, 40 - 4e3 * (0.2 - x)))
    (folder / 'frames').mkdir()
    for number, scale in ((0, 0), (1, 1)):
        with h5py.File(folder / f'frames/00000{number}.h5', 'w') as frame:
            frame['bodies/position'] = numpy.column_stack([x, 0 * x, z])
            frame['bodies/radius'] = 0 * x + 0.001
            frame['bodies/rotation'] = scale * numpy.column_stack([0 * x + 9, -turned, 0 * x])


class Silos(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        self.root = pathlib.Path(self.place.name)
        self.page, self.figures = self.root / 'silos.md', self.root / 'silos.json'
        self.page.write_text(PAGE, encoding='utf-8')

    def run_script(self):
        with unittest.mock.patch.multiple(silos, PAGE=self.page, FIGURES=self.figures), \
                unittest.mock.patch('sys.argv', ['silos.py', '--results', str(self.root / 'results')]), unittest.mock.patch('builtins.print'):
            silos.main()
        return self.page.read_text(encoding='utf-8')

    def row(self, page, table, *begin):
        """The cells after those that a row of a table begins with."""
        lines = page.partition(f'<!-- {table} -->')[2].partition(f'<!-- end of {table} -->')[0].splitlines()
        found = [line for line in lines if line.startswith('| ' + ' | '.join(begin) + ' |')]
        self.assertEqual(len(found), 1, page)
        return [cell.strip() for cell in found[0].split('|')[1 + len(begin):-1]]

    def test_tables_have_what_was_found(self):
        write(self.root / 'results/silo-quasistatic/full-a')
        page = self.run_script()
        name = 'silo-quasistatic/full-a'
        self.assertTrue(page.startswith('Above.\n'))
        self.assertEqual(self.row(page, 'at rest', name), ['0.50 (0.55)', '0.25', '0.40', '30.0', '0.60', '', '', '0.70', '0.650', '1.0000'])
        # mm: 0.25 has the nearest sample, that at rest; 20 and 30 were not reached
        self.assertEqual(self.row(page, 'lowered', name, 'P/G'), ['0.500', '0.300', '0.200', '0.200', '0.200', '0.200', '', ''])
        self.assertEqual(self.row(page, 'lowered', name, 'φ_w')[1:3], ['40.0', '44.0'])
        # the last quarter of the way is its last sample
        self.assertEqual(self.row(page, 'ends', name), ['44.0', '1.00', '41.0', '2.00 (4.00)', '', '3.00'])
        self.assertEqual(self.row(page, 'runs', name), ['`/scenario/seed=2`', '1,000', '5,000', '0.50', 'abcdef', 'x86-64-v3, 2026-01-02'])

    def test_stresses_are_those_of_layers(self):
        write(self.root / 'results/silo-quasistatic/full-a')
        page = self.run_script()
        name = 'silo-quasistatic/full-a'
        self.assertEqual(self.row(page, 'walls', name, 'at rest, σ_n'), ['1.00'] * 10)
        self.assertEqual(self.row(page, 'walls', name, 'in the end, σ_n'), [f'{10 * layer:.2f}' for layer in range(1, 11)])
        self.assertEqual(self.row(page, 'walls', name, 'in the end, τ'), [f'{5 * layer:.2f}' for layer in range(1, 11)])
        # γ = 10 N over 0.002 m2 and 0.5 m is 10 kPa/m, b / (2 tan 45°) is 0.1 m, 2 K tan 45° / b is 5 m-1: 1 kPa (1 - exp(-5 z))
        depths = [0.475, 0.025]
        expected = [f'{1 - numpy.exp(-5 * depth):.2f}' for depth in depths]
        found = self.row(page, 'walls', name, 'Janssen, σ_n')
        self.assertEqual([found[0], found[-1]], expected)
        self.assertEqual(self.row(page, 'walls', name, 'Janssen, τ'), found)

    def test_zones_end_where_rotation_does(self):
        write(self.root / 'results/silo-quasistatic/full-a')
        page = self.run_script()
        # 1.25 mm from the wall it is 37.5°; less than a twentieth of it from 20 mm on
        self.assertEqual(self.row(page, 'zones', 'silo-quasistatic/full-a', 'left'), ['10.0'] * 3)
        self.assertEqual(self.row(page, 'zones', 'silo-quasistatic/full-a', 'right'), ['5.0'] * 3)

    def test_runs_of_other_machines_are_kept(self):
        write(self.root / 'results/silo-quasistatic/full-a')
        first = self.run_script()
        (self.root / 'results/silo-quasistatic/full-a').rename(self.root / 'elsewhere')
        write(self.root / 'results/silo-quasistatic/full-b')
        write(self.root / 'results/silo-quasistatic/full-c', status='interrupted')
        page = self.run_script()
        self.assertEqual(self.row(page, 'at rest', 'silo-quasistatic/full-a'), self.row(first, 'at rest', 'silo-quasistatic/full-a'))
        self.assertEqual(set(json.loads(self.figures.read_text(encoding='utf-8'))), {'silo-quasistatic/full-a', 'silo-quasistatic/full-b'})
        self.assertEqual(self.run_script(), page)

    def test_a_page_without_a_place_is_refused(self):
        self.page.write_text(PAGE.replace('<!-- walls -->', ''), encoding='utf-8')
        write(self.root / 'results/silo-quasistatic/full-a')
        with self.assertRaisesRegex(ValueError, '<!-- walls -->'):
            self.run_script()

    def test_the_page_has_the_places(self):
        page = (pathlib.Path(ROOT) / 'docs/evidence/silos.md').read_text(encoding='utf-8')
        kept = pathlib.Path(ROOT) / 'docs/evidence/silos.json'
        runs = json.loads(kept.read_text(encoding='utf-8')) if kept.exists() else {}
        self.assertEqual(silos.with_tables(page, silos.pages(runs)), page, 'run scripts/silos.py')


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
