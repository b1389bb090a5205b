"""usage: test_bench.py ROOT GRIT [what unittest takes]

Runs the scripts of bench/ as a user would, on some grains, and every scene of bench/scenes through `grit check`.
"""
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT, GRIT = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
BENCH = ROOT / 'bench'
KERNELS, CLOCK = GRIT.with_name('bench_kernels'), GRIT.parents[1] / 'lib' / 'bench_clock.so'


def call(*words):
    # No time limit: ctest has one for all.
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)


def lattice(path, per_side=8, spacing=0.5e-3, comment=True):
    """Grains that overlap a little, in a periodic cell that they fill."""
    numbers = random.Random(1)
    side = per_side * spacing
    with open(path, 'w', encoding='utf-8') as out:
        if comment:
            out.write(f'# cell 0 0 0 to {side} {side} {side}, m\n')
        for place in range(per_side ** 3):
            x, y, z = (spacing * (place // per_side ** axis % per_side + 0.5) for axis in range(3))
            out.write(f'{x} {y} {z} {spacing * numbers.uniform(0.498, 0.504)}\n')
    return path


class Bench(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.place = Path(cls.folder.name)
        cls.packing = lattice(cls.place / 'packing.txt')
        os.environ['GRIT_BENCH_STORE'] = str(cls.place / 'store')

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def refused(self, done, *parts):
        self.assertEqual(done.returncode, 2, done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)
        self.assertNotIn('Traceback', done.stderr)

    def test_each_script_explains_itself(self):
        for script in ('compare', 'rows', 'check', 'roofline', 'growth', 'scale'):
            done = call(BENCH / script, '--help')
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn('usage:', done.stdout)

    def test_compare_times_every_law(self):
        out = self.place / 'compare.json'
        done = call(BENCH / 'compare', '--grit', GRIT, '--codes', 'grit', '--threads', 1, '--packing', self.packing, '--rounds', 2,
                    '--warm-up', 20, '--steps', 50, '--attempts', 1, '--json', out)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads(out.read_text(encoding='utf-8'))['rows']
        self.assertEqual([row['law'] for row in rows], ['rolling', 'no-rolling', 'hertz'])
        for row in rows:
            self.assertEqual((row['code'], row['grains'], row['threads']), ('grit', 512, 1))
            self.assertGreater(row['contacts_per_grain'], 1)
            self.assertTrue(0 < row['lowest'] <= row['median'] <= row['highest'])
            self.assertIn(f"| grit | {row['law']}", done.stdout)
            self.assertTrue(0.2 < row['of_critical'] < 1, row['of_critical'])

    def test_flows_agree_between_codes(self):
        sys.path.insert(0, str(BENCH))
        from measure import flow, peers  # knows the store from here on
        # Few grains near the wall, or the floor.
        few = {'drum': {'region': {'type': 'box', 'low': [-0.02, -0.09, 0], 'high': [0.02, -0.06, 0.1]}, 'count': 400},
               'silo': {'high': [0.16, 0.05, 0.04], 'count': 1000}}
        for scene, source in few.items():
            settings = {f'/bodies/sand/source/{key}': value for key, value in source.items()} | {'/stages/0/until/value': 0.4}
            box = flow.Flow(scene, GRIT, settings | ({'/stages/1/until/value': 0.02} if scene == 'silo' else {}))
            found = {code: box.run(code, 'hertz', 1, 20, 100) for code in ('grit', flow.OWN_STEP, 'liggghts', 'lammps')
                     if code == flow.OWN_STEP or peers.installed(code)}
            for code, one in found.items():
                with self.subTest(scene=scene, code=code):
                    self.assertGreater(one.contacts, 0.2)
                    self.assertTrue(0 < one.of_critical < 1.5 if 'grit' in code else one.of_critical is None)
                    for figure, own in ((one.contacts, found['grit'].contacts), (one.flow['energy'], found['grit'].flow['energy'])):
                        self.assertAlmostEqual(figure / own, 1, delta=0.05)

    @unittest.skipIf(not CLOCK.is_file(), 'built without GRIT_BENCH')
    def test_rows_are_measured(self):
        out = self.place / 'rows.json'
        # A test with all probes takes too long.
        names = ['threads', 'alone', 'alone_in_flow', 'size', 'grading', 'drum', 'silo', 'clumps', 'memory', 'start', 'busy', 'walls', 'phases', 'growth']
        from measure import grit  # knows the store from here on
        if grit.has_ranks(GRIT):
            names.insert(1, 'ranks')
        if (GRIT.parent / 'bench_kernels').is_file():
            names += ['guards', 'bare']
        done = call(BENCH / 'rows', '--grit', GRIT, '--short', '--json', out, *names)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads(out.read_text(encoding='utf-8'))['rows']
        self.assertEqual([row['row'] for row in rows], names)
        for row in rows:
            self.assertTrue(0 < row['figure'] < float('inf'), row)
            self.assertEqual(row['verdict'], '')  # a trial gives none
            self.assertIn(row['what'], done.stdout)

    def test_ranks_are_counted(self):
        from measure import grit  # knows the store from here on
        if not grit.has_ranks(GRIT):
            self.skipTest('built without MPI')
        done = call(BENCH / 'scale', '--grit', GRIT, '--base', 500, '--grains', 2000, '--ranks', '2,3', '--out', self.place)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (self.place / 'scale.md').read_text(encoding='utf-8')
        for ranks in (2, 3):
            row = next(line for line in page.splitlines() if line.startswith(f'| {ranks} | {2000 // ranks} |'))
            neighbours, pairs, messages = (float(cell.strip(' %')) for cell in row.split('|')[3:6])
            self.assertTrue(0.1 < neighbours < 3 and 1 < pairs < 100 and messages >= ranks - 1, row)
        self.assertIn('</svg>', (self.place / 'scale.svg').read_text(encoding='utf-8'))

    def test_wrong_use_is_explained(self):
        compare = [BENCH / 'compare', '--grit', GRIT]
        self.refused(call(BENCH / 'compare', '--grit', self.place / 'nothing'), 'no such program', 'build it')
        self.refused(call(*compare, '--packing', self.place / 'nothing.txt'), 'no such packing', 'omit --packing')
        self.refused(call(*compare, '--laws', 'rolling,rocking'), '--laws', 'rocking', 'allowed are rolling, no-rolling, hertz')
        self.refused(call(*compare, '--codes', 'esys'), 'esys', 'allowed are grit')
        for option in ('--scenes', '--codes', '--laws', '--threads', '--grains'):
            self.refused(call(*compare, option, ''), option, 'found ""')
        self.refused(call(*compare, '--threads', '1,1'), '--threads', '"1,1"', 'each once')
        self.refused(call(*compare, '--threads', 'x'), '--threads', 'found "x"', 'whole numbers')
        self.refused(call(*compare, '--threads', 1000), 'found 1000 threads')
        for side in ('-1', 'nan', 'inf'):
            self.refused(call(*compare, '--packing', self.packing, f'--side={side}'), '--side', f'"{side}"', 'above 0')
        self.refused(call(*compare, '--packing', self.packing, '--grains', 500), '--grains', 'beside --packing')
        self.refused(call(BENCH / 'scale', '--ranks', '1,2'), '--ranks', 'found 1', 'allowed are 2 and more')
        self.refused(call(*compare, '--side', 1), '--side', 'without --packing')
        self.refused(call(*compare, '--scenes', 'drum,sand'), '--scenes', 'found "drum,sand"', 'allowed are dense, drum, silo')
        self.refused(call(*compare, '--scenes', 'drum', '--quick'), '--scenes', 'found "drum" beside --quick')
        for option, value in (('--laws', 'rolling'), ('--grains', 500), ('--packing', self.packing)):
            self.refused(call(*compare, '--scenes', 'drum,silo', option, value), option, 'without dense in --scenes')
        self.refused(call(*compare, '--rounds', 0), 'at least 1')
        for script in ('compare', 'rows'):
            self.refused(call(BENCH / script, '--grit', GRIT, '--json', self.place / 'no' / 'rows.json'), '--json',
                         'cannot be written')
        self.refused(call(BENCH / 'rows', '--rounds', 'x'), '--rounds', 'found "x"')
        self.refused(call(BENCH / 'check', '--bound', 'nan'), '--bound', '"nan"', 'above 0')
        bare = lattice(self.place / 'bare.txt', comment=False)
        self.refused(call(*compare, '--packing', bare), 'has no cell', '--side')
        wrong = self.place / 'wrong.txt'
        wrong.write_text('# cell 0 0 0 to 1 1 1, m\n0 0 0\n', encoding='utf-8')
        self.refused(call(*compare, '--packing', wrong), 'wrong.txt:2', 'x y z r')
        self.refused(call(BENCH / 'rows', '--grit', GRIT, 'speed'), 'no row "speed"', 'allowed are threads')
        self.refused(call(BENCH / 'check', 'no-such-commit'), 'no such commit')
        self.refused(call(BENCH / 'roofline', self.place / 'nothing.json'), 'no such file', 'bench_kernels')
        self.refused(call(BENCH / 'growth', self.place / 'nothing.json'), 'no such file', 'bench/rows growth')
        other = self.place / 'other.json'
        other.write_text('{"rows": []}', encoding='utf-8')
        self.refused(call(BENCH / 'growth', other), 'has no row "growth"')

    def test_why_a_program_does_not_run_is_told(self):
        broken = self.place / 'broken'
        broken.write_text('#!/bin/sh\necho "no such instruction set" >&2\nexit 2\n', encoding='utf-8')
        broken.chmod(0o755)
        for script in ('compare', 'rows'):
            self.refused(call(BENCH / script, '--grit', broken), 'exit status 2 of --version', 'no such instruction set')

    @unittest.skipIf(shutil.which('objdump') is None, 'flops are counted by objdump')
    def test_roofline_draws_what_kernels_measured(self):
        kernels = self.place / 'kernels.json'
        one = {'contacts_per_grain': 4.5, 'across_fraction': 0.3, 'run_type': 'iteration'}
        kernels.write_text(json.dumps({'benchmarks': [
            {'name': 'machine/triad/629145600', 'bytes_per_s': 2e10}, {'name': 'machine/triad/4194304', 'bytes_per_s': 9e10},
            {'name': 'machine/multiply-add', 'flops_per_s': 5e10},
            one | {'name': 'contacts/linear-rolling/10000', 'contacts_per_s': 5e7},
            one | {'name': 'motion/10000', 'grains_per_s': 8e7}]}), encoding='utf-8')
        picture = self.place / 'roofline.svg'
        done = call(BENCH / 'roofline', kernels, '--out', picture, '--build', GRIT.parents[1])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('| contacts, linear-rolling | 10000 | 20.0 |', done.stdout)
        self.assertEqual(picture.read_text(encoding='utf-8').count('stroke-width="2" fill='), 2)
        # All of the arithmetic of a contact with rolling: about 300 with either compiler, by hand 295 of one build.
        flops = float(re.search(r'flops of a contact: (\d+) linear-rolling', done.stdout).group(1))
        self.assertTrue(200 < flops < 450, flops)

    @unittest.skipIf(not KERNELS.is_file(), 'Google Benchmark is not installed')
    def test_every_wall_of_the_kernels_is_touched(self):
        out = self.place / 'touch.json'
        done = call(KERNELS, '--benchmark_filter=^touch/', '--benchmark_min_time=0.001', f'--benchmark_out={out}')
        self.assertEqual(done.returncode, 0, done.stderr)
        walls = json.loads(out.read_text(encoding='utf-8'))['benchmarks']
        self.assertGreater(len(walls), 8)
        for wall in walls:
            self.assertNotIn('error_occurred', wall)
            self.assertTrue(0.05 < wall['touching_fraction'] < 1.5, wall)

    def test_every_scene_is_a_description(self):
        scenes = sorted((BENCH / 'scenes').glob('*.json'))
        self.assertGreater(len(scenes), 5)
        boxes = ['/bodies/sand/source/path', '/domain/high']
        settings = {'dense-box': boxes, 'press': boxes, 'silo': boxes[:1], 'drum': boxes[:1]}
        for scene in scenes:
            words = []
            for name, pointers in settings.items():
                if scene.stem.startswith(name) and not scene.stem.endswith('-fill'):
                    values = {'/bodies/sand/source/path': str(self.packing), '/domain/high': [4e-3] * 3}
                    for pointer in pointers:
                        words += ['--set', f'{pointer}={json.dumps(values[pointer])}']
            # As many grains as it takes to see that the scene is one.
            if '"cloud"' in scene.read_text(encoding='utf-8'):
                words += ['--set', '/bodies/sand/source/count=200']
            with self.subTest(scene=scene.name):
                done = call(GRIT, 'check', scene, *words)
                self.assertEqual(done.returncode, 0, done.stderr)


unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
