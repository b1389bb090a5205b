"""usage: test_verdicts.py ROOT [what unittest takes]

What the scripts of bench/ conclude, on figures that are given: a stand-in for grit, and peers that answer as told.
"""
import contextlib
import importlib.machinery
import importlib.util
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

sys.dont_write_bytecode = True
ROOT = Path(sys.argv[1]).resolve()
BENCH = ROOT / 'bench'
sys.path.insert(0, str(BENCH))
_store = tempfile.TemporaryDirectory()
os.environ['GRIT_BENCH_STORE'] = _store.name
from measure import bounds, disassembly, flow, grit, limits, machine, packing, peers, scaling  # noqa: E402

STORE = Path(_store.name)


def script(name):
    loader = importlib.machinery.SourceFileLoader('bench_' + name, str(BENCH / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def quiet():
    """No other process took anything."""
    return mock.patch.object(machine, '_all_busy', lambda: 0.0)


def busy():
    """Others took all cores, and more."""
    return mock.patch.object(machine, '_all_busy', lambda: 1000 * time.perf_counter())


class Given(unittest.TestCase):
    def setUp(self):
        self.place = Path(tempfile.mkdtemp(dir=STORE))
        self.fake = self.place / 'bin' / 'grit'
        self.fake.parent.mkdir()
        shutil.copy(Path(__file__).with_name('fake_grit.py'), self.fake)

    def told(self, **scenes):
        """What the stand-in is to say, until the test ends."""
        patch = mock.patch.dict(os.environ, {'FAKE_GRIT': json.dumps(scenes)})
        patch.start()
        self.addCleanup(patch.stop)

    def call(self, module, *words):
        """Exit status, standard output and error of a script."""
        out, errors = io.StringIO(), io.StringIO()
        before = [signal.getsignal(one) for one in (signal.SIGINT, signal.SIGTERM)]
        try:
            with mock.patch.object(sys, 'argv', [str(module.__file__ or BENCH), *map(str, words)]), \
                    mock.patch.object(machine, '_deadline', None), \
                    contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors), \
                    self.assertRaises(SystemExit) as ended:
                machine.main(module.main)
        finally:
            for one, handler in zip((signal.SIGINT, signal.SIGTERM), before):
                signal.signal(one, handler)
        return ended.exception.code, out.getvalue(), errors.getvalue()


class Rows(Given):
    def rows(self, *words):
        return self.call(script('rows'), '--grit', self.fake, '--rounds', 1, *words)

    def test_the_row_of_probes_times_all_stages(self):
        self.told(**{'curves': {'end': 10.0}, 'every': {'end': 12.0}})
        with quiet():
            status, out, errors = self.rows('probes')
        self.assertIn('1.2 times as long', out, errors)
        self.assertIn('10 and 12 s', out)
        self.assertIn(bounds.MISSES, out)
        self.assertEqual(status, 1)

    def test_the_row_of_sampling_has_no_bound(self):
        self.told(**{'curves': {'end': 10.0}, 'every': {'end': 12.0}})
        with quiet():
            status, out, errors = self.rows('sampling')
        self.assertIn('10.0 and 12.0 s', out, errors)
        self.assertNotIn(bounds.MISSES, out)
        self.assertEqual(status, 0)

    def test_a_bound_that_holds(self):
        self.told(**{'curves': {'end': 10.0}, 'every': {'end': 10.1}})
        with quiet():
            status, out, _ = self.rows('probes')
        self.assertIn('| holds |', out)
        self.assertEqual(status, 0)

    def test_no_verdict_beside_others(self):
        self.told(**{'curves': {'end': 10.0}, 'every': {'end': 12.0}})
        with busy():
            status, out, _ = self.rows('probes')
        self.assertIn('1.2 times as long !', out)
        self.assertNotIn(bounds.MISSES, out)
        self.assertEqual(status, 0)

    def test_rounds_that_were_disturbed_do_not_count(self):
        bench = script('rows').Bench(mock.Mock(rounds=3), self.fake, None)
        figures, others = iter([1.0, 9.0, 3.0]), iter([0.0, 0.5, 0.0])

        def one():
            bench.beside(next(others))
            return next(figures)
        with contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(bench.rounds(one), [2.0])
        self.assertFalse(bench.disturbed)

    def test_memory_is_taken_over_two_searches(self):
        self.told(**{'dense-box': {'rebuilds': 1}})
        status, out, errors = self.rows('--short', 'memory')
        self.assertIn('1 neighbour search(es)', errors)
        self.assertEqual(status, 1)
        self.told(**{'dense-box': {'rebuilds': 2}})
        status, out, errors = self.rows('--short', 'memory')
        self.assertIn('; 2 neighbour searches', out, errors)
        self.assertEqual(status, 0)

    def test_start_and_memory_are_marked_when_disturbed(self):
        for disturbance, mark in ((busy, ' !'), (quiet, '')):
            with disturbance():
                _, out, errors = self.rows('--short', 'start', 'memory')
            for unit in ('s', 'B'):
                self.assertRegex(out, rf'\| [-+.e0-9]+ {unit}{mark} \|', errors)

    def test_a_row_that_fails_leaves_the_others_their_figures(self):
        self.told(**{'drum': {'fails': 'a grain was lost'}})
        written = self.place / 'rows.json'
        with quiet():
            status, out, errors = self.rows('--short', 'threads', 'drum', 'size', '--json', written)
        self.assertIn('a grain was lost', errors)
        self.assertIn('2 threads against 1', out)
        self.assertIn('1 000 000 grains against 50 000', out)
        self.assertEqual([one['row'] for one in json.loads(written.read_text())['rows']], ['threads', 'size'])
        self.assertEqual(status, 1)

    def test_a_run_that_is_stopped_tells_what_it_has(self):
        module = script('rows')
        module.ROWS['size'] = mock.Mock(side_effect=KeyboardInterrupt, __doc__='stopped by hand')
        with quiet():
            status, out, errors = self.call(module, '--grit', self.fake, '--short', 'threads', 'size')
        self.assertIn('2 threads against 1', out, errors)
        self.assertEqual(status, 130)

    def test_growth_is_drawn(self):
        rows, picture = self.place / 'growth.json', self.place / 'growth.svg'
        status, out, errors = self.rows('--short', 'growth', '--json', rows)
        self.assertEqual(status, 0, errors)
        status, _, errors = self.call(script('growth'), rows, '--out', picture)
        self.assertEqual(status, 0, errors)
        self.assertEqual(picture.read_text().count('<polyline points'), picture.read_text().count('#ccc') + 2)
        self.assertEqual(picture.read_text().count('r="6"'), 8)


class Check(Given):
    COMMIT = 'c0ffee' + 34 * '0'

    def check(self, *words):
        module = script('check')
        module.settings_of = lambda build: []
        module.build = lambda folder, jobs: self.fake
        module.resolved = lambda name: self.COMMIT if name in ('HEAD~1', 'c0ffee') else ''
        return self.call(module, '--rounds', 1, '--grains', 8, *words)

    def test_speed_is_held_against_the_bound(self):
        for seconds, status in ((1.04, 0), (1.07, 1)):
            self.told(**{'present': {'end': 1 + seconds}, 'earlier': {'revision': 'c0ffee'}})
            with quiet():
                found, out, errors = self.check('--reference-grit', self.fake)
            self.assertIn(f'{1 / seconds:.3f}', out, errors)
            self.assertEqual(found, status)

    def test_a_program_of_another_commit_is_refused(self):
        self.told(**{'earlier': {'revision': 'bad'}})
        status, _, errors = self.check('--reference-grit', self.fake)
        self.assertIn('found revision "bad"; expected c0ffee000000', errors)
        self.assertEqual(status, 2)

    def test_what_is_no_grit_is_refused(self):
        status, _, errors = self.check('--reference-grit', '/bin/true')
        self.assertIn('/true: does not run here as grit', errors)
        self.assertEqual(status, 2)

    def test_no_verdict_beside_others(self):
        self.told(**{'earlier': {'revision': 'c0ffee'}})
        with busy():
            status, _, errors = self.check('--reference-grit', self.fake)
        self.assertIn('there is no verdict', errors)
        self.assertEqual(status, 2)


class Compare(Given):
    def compare(self, speeds, *words, others=0.0):
        """`speeds` in particle-steps/s by code, or what is raised."""
        def run(box, code, law, threads, warm, steps):
            if isinstance(speeds[code], BaseException):
                raise speeds[code]
            return peers.Timed(speeds[code], 4.0, others, 0.8 if code == 'grit' else None)
        path = self.place / 'box.txt'
        path.write_text('# cell 0 0 0 to 1 1 1, m\n' + 10000 * '0.5 0.5 0.5 0.1\n')
        with mock.patch.object(peers.Box, 'run', run), mock.patch.object(peers, 'installed', lambda code: True), \
                mock.patch.object(peers, 'versions', lambda codes, program: {}):
            return self.call(script('compare'), '--grit', self.fake, '--codes', ','.join(speeds), '--laws', 'rolling',
                             '--threads', 1, '--packing', path, '--rounds', 1, *words)

    def test_a_miss_is_an_exit_status(self):
        for ratio, status, verdict in ((6.5, 0, 'as wanted'), (5, 0, 'holds'), (4, 1, bounds.MISSES)):
            found, out, errors = self.compare({'grit': ratio * 1e6, 'lammps': 1e6})
            self.assertIn(f'| {ratio:.2f} | ≥ 4.5, wanted 6 | {verdict} |', out, errors)
            self.assertEqual(found, status)

    def test_the_step_is_told_over_the_critical_one(self):
        _, out, _ = self.compare({'grit': 1e7})
        self.assertIn('| 4.00 | 0.80 | 10.00 |', out)

    def test_no_verdict_beside_others(self):
        status, out, _ = self.compare({'grit': 4e6, 'lammps': 1e6}, others=0.5)
        self.assertIn('1.00 !', out)
        self.assertNotIn(bounds.MISSES, out)
        self.assertEqual(status, 0)

    def test_a_code_that_fails_leaves_the_others_their_figures(self):
        written = self.place / 'rows.json'
        lost = subprocess.CalledProcessError(3, ['lmp'], 'ERROR: Lost atoms')
        status, out, errors = self.compare({'lammps': lost, 'grit': 4e6}, '--json', written)
        self.assertIn('Lost atoms', errors)
        self.assertIn('| 4.00 |', out)
        self.assertEqual([row['code'] for row in json.loads(written.read_text())['rows']], ['grit'])
        self.assertEqual(status, 1)

    def test_a_run_that_is_stopped_tells_what_it_has(self):
        written = self.place / 'rows.json'
        status, out, _ = self.compare({'grit': 4e6, 'lammps': KeyboardInterrupt()}, '--json', written)
        self.assertIn('| 4.00 |', out)
        self.assertEqual([row['code'] for row in json.loads(written.read_text())['rows']], ['grit'])
        self.assertEqual(status, 130)

    def test_quick_ends_within_its_time(self):
        module = script('compare')
        module.QUICK = 0
        with mock.patch.object(peers, 'installed', lambda code: True):
            path = self.place / 'box.txt'
            path.write_text('# cell 0 0 0 to 1 1 1, m\n0.5 0.5 0.5 0.1\n')
            # What the machine allows takes of that time too.
            self.fake.with_name('bench_kernels').touch(mode=0o755)
            status, out, errors = self.call(module, '--quick', '--grit', self.fake, '--codes', 'grit', '--packing', path)
        self.assertIn('0 s are over', errors)
        self.assertRegex(out, 'one core of this machine: not measured: .*bench_kernels: there is no time left')
        self.assertIn('| code | law |', out)
        self.assertEqual(status, 1)


class Flows(Given):
    FLOW = packing.Flow(Path('/store/flow/grains.data'), 40000, (1.5e-3, 1.75e-3), 'c0ffee')

    def flow(self, scene):
        with mock.patch.object(packing, 'flowing', lambda program, scene, settings: self.FLOW):
            return flow.Flow(scene, self.fake)

    def compare(self, speeds, *words, energies=None, others=0.0):
        """`speeds` in particle-steps/s by code; grit's own step is twice as long."""
        def run(box, code, law, threads, warm, steps):
            figures = {'energy': (energies or {}).get(code, 5e-7), 'flow': 27.5, 'step': 3.7e-5, 'seconds_per_second': 1e9 / speeds[code]}
            if code == flow.OWN_STEP:
                figures |= {'step': 7.4e-5, 'seconds_per_second': 0.5e9 / speeds[code]}
            return peers.Timed(speeds[code], 4.2, others, flow=figures)
        speeds = speeds | ({flow.OWN_STEP: speeds['grit']} if 'grit' in speeds else {})
        with mock.patch.object(packing, 'flowing', lambda program, scene, settings: self.FLOW), \
                mock.patch.object(flow.Flow, 'run', run), mock.patch.object(peers, 'installed', lambda code: True), \
                mock.patch.object(peers, 'versions', lambda codes, program: {}):
            return self.call(script('compare'), '--grit', self.fake, '--codes', ','.join(one for one in speeds if one != flow.OWN_STEP),
                             '--scenes', 'drum', '--threads', 1, '--rounds', 1, *words)

    def test_a_flow_has_its_bound(self):
        written = self.place / 'rows.json'
        for ratio, status, verdict in ((5.5, 0, 'as wanted'), (4.5, 0, 'holds'), (3, 1, bounds.MISSES)):
            found, out, errors = self.compare({'grit': ratio * 1e6, 'lammps': 1e6}, '--json', written)
            self.assertRegex(out, rf'\| drum \| lammps \| 40000 \| 1 \| 4.20 \| 0.500 \| 27.5° \| 37 .*\| {ratio:.2f} \| ≥ 4, wanted 5 '
                             rf'\| {re.escape(verdict)} \| 1000 \| {2 * ratio:.2f} \|', errors)
            self.assertNotIn('| code | law |', out)
            self.assertEqual(found, status)
        rows = json.loads(written.read_text())['rows']
        self.assertEqual([(row['scene'], row['code']) for row in rows], [('drum', 'grit'), ('drum', flow.OWN_STEP), ('drum', 'lammps')])

    def test_another_flow_gets_no_verdict(self):
        status, out, errors = self.compare({'grit': 3e6, 'lammps': 1e6}, energies={'lammps': 5.5e-7})
        self.assertIn('| another flow |', out, errors)
        self.assertNotIn(bounds.MISSES, out)
        self.assertEqual(status, 0)

    def test_a_flow_needs_a_code_that_runs_it(self):
        status, _, errors = self.compare({'yade': 1e6})
        self.assertIn('none that is installed and runs drum; allowed are grit, liggghts, lammps', errors)
        self.assertEqual(status, 2)

    def test_states_of_other_codes_are_read(self):
        said = ('STATE 40000 4.2 0.020 0.01 -0.01732\nTIMED\nLoop time of 4 on 1 procs for 200 steps with 40000 atoms\nEND\n'
                'STATE 39000 4.0 0.039 0.02 -0.02\n')
        for scene, figure in (('drum', 37.5), ('silo', 1000 / (200 * 3.7e-5))):
            box = self.flow(scene)
            box.folder = self.place
            with mock.patch.object(machine, 'run', lambda *words: machine.Run(said, 5.0, 0.0)):
                found = box.run('lammps', 'hertz', 1, 100, 200)
                self.assertEqual((found.speed, round(found.contacts, 6)), (39500 * 200 / 4, 4.1))
                self.assertAlmostEqual(found.flow['energy'], 0.75e-6)
                self.assertAlmostEqual(found.flow['flow'] / figure, 1, 3)
                self.assertAlmostEqual(found.flow['seconds_per_second'], 4 / (200 * 3.7e-5))
            with mock.patch.object(machine, 'run', lambda *words: machine.Run(said.replace('STATE 39', 'ERROR'), 5.0, 0.0)), \
                    self.assertRaisesRegex(machine.Complaint, 'lammps ended without a result'):
                box.run('lammps', 'hertz', 1, 100, 200)

    def test_states_of_grit_are_read(self):
        said = ('packing_before/coordination_number: peak 4.3, final 4.2\npacking_before/kinetic_energy: peak 21 mJ, final 20 mJ\n'
                'bed_before/angle: peak 30, final 30\npacking/coordination_number: peak 4.2, final 4\n'
                'packing/kinetic_energy: peak 20 mJ, final 20 mJ\nbed/angle: peak 31, final 31\n')
        stages = [{'bodies': 40000, 'step': 100, 'time': 0.5, 'wall_s': 1.0}, {'bodies': 40000, 'step': 300, 'time': 0.75, 'wall_s': 3.0}]
        done = grit.Done(said, 0.0, {'stages': stages, 'time_step_s': 4e-5, 'critical_time_step_s': 5e-5})
        with mock.patch.object(grit, 'run', lambda *words: done):
            found = self.flow('drum').run(flow.OWN_STEP, 'hertz', 1, 100, 200)
        self.assertEqual((found.speed, found.of_critical), (40000 * 200 / 2, 0.8))
        self.assertEqual([round(found.flow[key], 9) for key in flow.FIGURES], [5e-7, 30.5, 0.00125, 8.0])
        self.assertAlmostEqual(found.contacts, 4.1)
        with self.assertRaisesRegex(machine.Complaint, 'no "packing/void_ratio" in numbers in the summary'):
            done.final('packing/void_ratio')

    def test_grains_in_motion_are_a_data_file(self):
        (self.place / 'frames').mkdir()
        (self.place / 'frames' / '000000.dump').write_text(
            'ITEM: TIMESTEP\n7\nITEM: ATOMS id type x y z radius vx vy vz omegax omegay omegaz\n'
            '0 1 .01 .02 .03 0.001 1 2 3 4 5 6\n1 1 .04 .05 -.002 0.003 1 2 3 4 5 6\n2 1 .04 .05 .06 0.002 7 8 9 10 11 12\n')
        with mock.patch.object(packing, '_fill', lambda program, scene, settings: self.place):
            found = packing.flowing(self.fake, 'drum-hertz')
        self.assertEqual((found.grains, found.radii), (2, (0.001, 0.0015)), 'without the one below the domain')
        written = found.path.read_text()
        self.assertIn('2 atoms\n1 atom types\n\n-0.101 0.101 xlo xhi\n', written)
        self.assertIn('\nAtoms\n\n1 1 0.002 2500 .01 .02 .03\n2 1 0.004 2500 .04 .05 .06\n\nVelocities\n\n1 1 2 3 4 5 6\n2 7 8', written)


class Measuring(Given):
    def test_what_an_earlier_run_said_does_not_count(self):
        folder = self.place / 'run'
        scene = BENCH / 'scenes' / 'dense-box.json'
        grit.window(self.fake, scene, folder, 1)
        self.told(**{'*': {'silent': True}})
        with self.assertRaisesRegex(machine.Complaint, 'wrote no .*run.json'):
            grit.window(self.fake, scene, folder, 1)

    def test_a_run_that_hangs_is_stopped(self):
        with self.assertRaisesRegex(machine.OutOfTime, 'did not end within 0 s, and was stopped: sleep 60'):
            machine.run(['sleep', 60], 1, '/', timeout=0.2)

    def test_ctrl_c_after_the_last_word_is_one_interrupt(self):
        communicate = subprocess.Popen.communicate

        def interrupted(process, *words, **more):
            communicate(process, *words, **more)
            raise KeyboardInterrupt
        with mock.patch.object(subprocess.Popen, 'communicate', interrupted), self.assertRaises(KeyboardInterrupt) as seen:
            machine.run(['true'], 1, '/')
        self.assertIsNone(seen.exception.__context__)

    def test_a_neighbour_that_is_meant_is_not_among_others(self):
        busy_of, alone = {7: 20.0}, 5.0  # s of the neighbour, and of all others
        with mock.patch.object(machine, '_busy_of', busy_of.__getitem__), \
                mock.patch.object(machine, '_own_busy', lambda: 1.0), \
                mock.patch.object(machine, '_all_busy', lambda: 1.0 + busy_of[7] + alone), \
                mock.patch.object(machine.Watch, 'seconds', lambda watch: 2.0):
            plain, friendly = machine.Watch(), machine.Watch([7])
            busy_of[7] += 1.5
            self.assertEqual((plain.others(), friendly.others()), (0.75, 0.0))
            alone += 0.5
            self.assertEqual((plain.others(), friendly.others()), (1.0, 0.25))

    def test_the_time_of_a_process_is_read_behind_its_name(self):
        ticks = os.sysconf('SC_CLK_TCK')
        said = f'7 (a ) 1 2 3) R 1 1 1 0 -1 4194304 100 0 0 0 {3 * ticks} {2 * ticks} 8 9 20 0 1 0\n'
        with mock.patch.object(Path, 'read_text', lambda path, **how: said if str(path) == '/proc/7/stat' else ''):
            self.assertEqual(machine._busy_of(7), 5.0)

    def test_flops_are_counted_by_lane(self):
        loop = ['vmulpd %zmm1,%zmm2,%zmm3', 'vfmadd213pd %ymm1,%ymm2,%ymm3', 'vaddsd %xmm1,%xmm2,%xmm3',
                'vmaxps (%rax),%zmm1,%zmm2', 'vmovapd %zmm1,%zmm2', 'call 1230']
        self.assertEqual(disassembly.flops(loop, 8), (8 + 2 * 4 + 1 + 16) / 8)

    def test_the_machine_stands_beside_the_table(self):
        self.assertIn('no ' + str(self.fake.parent / 'bench_kernels'), limits.measured(self.fake)[1])
        kernels = self.fake.parent / 'bench_kernels'
        kernels.write_text('#!/bin/sh\nfor word; do case $word in --benchmark_out=*) cat > "${word#*=}" <<END\n' + json.dumps(
            {'benchmarks': [{'name': 'machine/triad/629145600', 'bytes_per_s': 2e10},
                            {'name': 'machine/triad/4194304', 'bytes_per_s': 9e10},
                            {'name': 'machine/multiply-add', 'flops_per_s': 5e10},
                            {'name': 'contacts/linear-rolling/10000', 'across_fraction': 0.25}]})
            + '\nEND\nesac; done\n')
        kernels.chmod(0o755)
        with quiet():
            allowed, line = limits.measured(self.fake)
        self.assertEqual(line, '20 GB/s of memory, 90 GB/s of caches, 50 Gflop/s')
        # 2 contacts a grain: by hand, arithmetic 2 * 300 + 90 + 8 * 0.5, bytes 2 * 248.125 + 292.
        window = grit.Window(1000, 10, 1e-3, 4.0, 0.0, {'model': {'bytes': 1}})
        bytes_each = 2 * (8.125 + 96 + 0.25 * 128 + 0.5 * 224) + 256 + 0.5 * 72
        expected = 1e7 / min(5e10 / 694, 9e10 / bytes_each)
        self.assertEqual(allowed.share('linear-rolling', 300, window), f'{expected:.0%}, caches or arithmetic')

    def test_every_geometry_has_a_kernel(self):
        kernels = (BENCH / 'kernels' / 'geometry.cpp').read_text()
        shapes = [path.parent.name for path in (ROOT / 'plugins' / 'geometry').glob('*/*.cpp')
                  if path.stem == path.parent.name.replace('-', '_') or path.stem == path.parent.name]
        self.assertGreater(len(shapes), 6)
        self.assertEqual([shape for shape in shapes if f'{{"type", "{shape}"}}' not in kernels], [])


class Scaling(unittest.TestCase):
    @staticmethod
    def fits(of_chunk=0.0, steps=100.0):
        """Of ranks with 1000, 8000 and 64 000 particles, whose counts follow their surfaces."""
        def count(ranks):
            bodies = 512000 // ranks
            neighbours = 8 / round(bodies ** (1 / 3))
            return scaling.Count({'neighbours': neighbours, 'shared_pairs': neighbours / 4, 'independent_pairs': 1 - neighbours,
                                  'step': {'messages': 10.0, 'bytes': 72 * neighbours * bodies},
                                  'search': {'bytes': 0.0, 'gathers': 0.0, 'gathered_bytes': of_chunk * 2000 * (1 - 1 / ranks)}}, 0)
        found = {ranks: count(ranks) for ranks in (8, 64, 512)}
        return scaling.Fits(512000, found, scaling.Alone(50e-9, 0.8, steps))

    def test_a_node(self):
        # 8000 particles: 0.4 ms; 0.4 neighbours and 0.1 pairs more, so 1.08 times 1.03 as long; twelve levels of reductions of 2 us
        # each; 3200 neighbours of 72 bytes at 5 GB/s. Ten messages of 2 us take no time, as 0.6 of the pairs are evaluated meanwhile.
        expected = 0.4e-3 / (0.4e-3 * 1.08 * 1.03 + 12 * 2e-6 + 3200 * 72 / 5e9)
        self.assertAlmostEqual(self.fits().efficiency(8000, 64), expected, places=12)
        self.assertEqual(self.fits().efficiency(8000, 1), 1)

    def test_many_nodes(self):
        # 1000 particles: 50 us; 0.8 neighbours and 0.2 pairs more. Sixteen times the bytes of a rank pass the network of its node; 0.2 of
        # the pairs are evaluated meanwhile.
        expected = 50e-6 / (50e-6 * 1.16 * 1.03 + 16 * 2e-6 + 800 * 72 / 5e9 + 10 * 2e-6 + 16 * 800 * 72 / 25e9 - 50e-6 * 0.8 * 0.2)
        self.assertAlmostEqual(self.fits().efficiency(1000, 256), expected, places=12)

    def test_what_all_ranks_collect(self):
        # 100 bytes of each of 8000 chunks, at 5 GB/s, in each tenth step.
        fits = self.fits(of_chunk=100.0, steps=10.0)
        slower = 1 / fits.efficiency(8000, 256) - 1 / self.fits().efficiency(8000, 256)
        self.assertAlmostEqual(slower, 100 * 8000 * 256 / 256 / 5e9 / 10 / 0.4e-3, places=12)


unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
