"""usage: test_faults.py campaign | self-test | restarts ROOT GRIT SHIM

campaign   each fault of scripts/faults.py once, in short scenes, with a fixed seed
self-test  what scripts/faults.py finds in a grit that is wrong, and what it writes
restarts   scripts/restarts.py with a scene of each kind
"""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

WHAT, ROOT, GRIT, SHIM = sys.argv[1], *map(Path, sys.argv[2:5])
HERE = Path(__file__).resolve().parent
SKIPPED = 77

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / 'scripts'))
try:
    import h5py                                          # noqa: F401
    import numpy                                         # noqa: F401
except ImportError as missing:
    print(f'skipped: {missing}')
    sys.exit(SKIPPED)
import tables                                            # noqa: E402
import faults                                            # noqa: E402
import restarts                                          # noqa: E402


def script(name, *words, grit=GRIT, **environment):
    """Runs a script with the results in a folder of its own. Its status, and what it printed."""
    with tempfile.TemporaryDirectory() as place:
        done = subprocess.run(['/usr/bin/python3', ROOT / 'scripts' / name, '--grit', grit, '--shim', SHIM, '--work', place, *words],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, env=os.environ | environment)
        return done.returncode, done.stdout


class Campaign(unittest.TestCase):
    def test_nothing_is_lost(self):
        status, text = script('faults.py', '--times', '1', '--seed', '1', '--scale', '0.05', '--no-load')
        print(text)
        self.assertEqual(status, 0, text)


class Restarts(unittest.TestCase):
    def test_have_the_same_bits(self):
        names = ('direct-shear/quick-every-probe', 'heap/quick', 'triaxial/quick-clumps', 'simple-shear/quick', 'screw/quick', 'jkr', 'capillary',
                 'drag, force-field')
        status, text = script('restarts.py', '--steps', '100', *(word for name in names for word in ('--only', name)))
        self.assertEqual(status, 0, text)
        self.assertEqual(text.count('| same bits |'), len(names), text)


class WrongPrograms(unittest.TestCase):
    """Each does one thing wrong, which is counted in its column. All are compared with the undisturbed runs of one that does not."""

    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.place.cleanup)
        cls.right = cls.run_broken('not at all', 'SIGTERM', '--scale', '0.1', '--keep', '--work', cls.place.name)
        cls.undisturbed = re.search(r'^the runs are in (.+)$', cls.right[1], re.M)

    @staticmethod
    def run_broken(how, fault, *words):
        return script('faults.py', '--times', '4', '--only', fault, '--scene', 'deforming-cell', '--no-load', *words,
                      grit=HERE / 'broken_grit.py', BROKEN_GRIT=str(GRIT), BROKEN_HOW=how)

    def counts(self, fault, status, text):
        found = re.search(rf'^\| {re.escape(fault)} \| (\d+) \| (\d+) \| (\d+) \| (\d+) \|', text, re.M)
        self.assertTrue(found, text)
        tried, lost, bits, wrong_status = map(int, found.groups())
        self.assertGreater(tried, 0, text)
        self.assertEqual(status, 0 if lost + bits + wrong_status == 0 else 1, text)
        return lost, bits, wrong_status

    def row(self, how, fault):
        self.assertTrue(self.undisturbed, self.right[1])
        status, text = self.run_broken(how, fault, '--undisturbed', self.undisturbed[1])
        return self.counts(fault, status, text), text

    def test_nothing_is_found_where_nothing_is_wrong(self):
        status, text = self.right
        self.assertEqual(self.counts('SIGTERM', status, text), (0, 0, 0), text)

    def test_runs_that_have_become_faster_are_disturbed(self):
        with tempfile.TemporaryDirectory() as place:
            copy = shutil.copytree(self.undisturbed[1], place, dirs_exist_ok=True)
            file = Path(copy, 'undisturbed/deforming-cell/facts.json')
            facts = json.loads(file.read_text(encoding='utf-8'))
            file.write_text(json.dumps(facts | {'seconds': 20 * facts['seconds']}), encoding='utf-8')
            status, text = self.run_broken('not at all', 'SIGTERM', '--undisturbed', copy)
        self.assertEqual(self.counts('SIGTERM', status, text), (0, 0, 0), text)
        self.assertIn('| SIGTERM | 4 |', text)

    def test_a_dropped_sample(self):
        (lost, bits, _), text = self.row('sample', 'SIGTERM')
        self.assertEqual((lost, bits > 0), (0, True), text)
        self.assertIn('bits: series.h5: ', text)

    def test_a_changed_bit(self):
        (lost, bits, _), text = self.row('bit', 'SIGTERM')
        self.assertEqual((lost, bits > 0), (0, True), text)
        self.assertRegex(text, 'bits: series.h5: .*time differs')

    def test_a_changed_bit_of_the_final_state(self):
        (lost, bits, _), text = self.row('state', 'SIGTERM')
        self.assertEqual((lost, bits > 0), (0, True), text)
        self.assertIn('bits: final.h5: 1 bytes of the state differ, the first is byte 64', text)

    def test_a_run_that_begins_anew(self):
        (lost, bits, _), text = self.row('checkpoint', 'SIGTERM')
        self.assertEqual((lost > 0, bits), (True, 0), text)
        self.assertIn('was not used', text)

    def test_another_exit_status(self):
        (_, _, status), text = self.row('status', 'disk full at write')
        self.assertGreater(status, 0, text)
        self.assertIn('exit status 70, allowed 0, 5', text)

    def test_an_error_without_a_message(self):
        (_, _, status), text = self.row('silence', 'disk full at write')
        self.assertGreater(status, 0, text)
        self.assertIn('with a message that names nothing: none', text)


class Undisturbed(unittest.TestCase):
    """Runs that are given."""

    def test_that_are_missing_are_reported(self):
        status, text = script('faults.py', '--undisturbed', '/nowhere')
        self.assertEqual((status, text.splitlines()[0]), (
            1, 'faults: /nowhere/undisturbed/silo/facts.json does not exist; --undisturbed takes a folder that a campaign with --keep has printed'))

    def test_have_a_length(self):
        status, text = script('faults.py', '--undisturbed', '/nowhere', '--scale', '0.1')
        self.assertEqual(status, 2)
        self.assertIn('--scale beside --undisturbed, whose scenes have a length; omit it', text)


class RemovedSeries(unittest.TestCase):
    def run_halted(self, place, name, fail=None):
        """A short run of which calls on series.h5 are counted, and one may halt it."""
        out = place / name
        environment = {'LD_PRELOAD': str(SHIM), 'FAULTS_BELOW': str(out / 'series.h5'), 'FAULTS_LOG': str(place / 'calls.txt')}
        words = ('--set', '/stages/1/until/value=200', '--set', '/probes={"packing": {"type": "packing", "every_steps": 50}}')
        run = faults.Process([GRIT, 'run', ROOT / 'bench/scenes/tiny.json', '--out', out, '--threads', '1', '--quiet', '--no-report', *words],
                             place / 'log.txt', environment | ({'FAULTS_FAIL': f'{fail}:STOP:once'} if fail else {}))
        os.waitid(os.P_PID, run.process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
        return run, out

    def test_is_noticed_before_each_call(self):
        with tempfile.TemporaryDirectory() as place:
            place, applied = Path(place), 0
            run, _ = self.run_halted(place, 'undisturbed')
            self.assertEqual(run.process.wait(), faults.DONE, run.text())
            counts = re.findall(r'^(open|fsync) (\d+)$', (place / 'calls.txt').read_text(encoding='ascii'), re.M)
            for call, number in ((call, number) for call, count in counts for number in range(1, int(count) + 1)):
                run, out = self.run_halted(place, f'{call}-{number}', f'{call}:{number}')
                applies = faults.status_of(out).get('status') == 'running' and (out / 'series.h5').exists()
                if applies:
                    (out / 'series.h5').unlink()
                run.send(signal.SIGCONT)
                self.assertEqual(run.process.wait(), faults.FILES if applies else faults.DONE, f'{call} {number}: {run.text()}')
                if applies:
                    applied += 1
                    self.assertIn('series.h5: ', run.text(), f'{call} {number}')
            self.assertGreater(applied, 5, counts)


class Memory(unittest.TestCase):
    def test_that_ends_before_an_exception_can_be_thrown_is_told(self):
        done = subprocess.run([GRIT, 'check', '/nowhere.json'], capture_output=True, text=True, check=False,
                              env=os.environ | {'LD_PRELOAD': str(SHIM), 'FAULTS_MEMORY': '0'})
        self.assertEqual((done.returncode, done.stderr), (
            faults.FILES, "grit: out of memory as the program began; 'ulimit -v' prints its limit in kB\n"))

    def limited(self, size, *words):
        """The exit status and messages of grit with so much address space [kB]."""
        done = subprocess.run(['prlimit', f'--as={1024 * size}', GRIT, *words], capture_output=True, text=True, check=False)
        return done.returncode, done.stderr

    def test_of_any_size_that_the_program_begins_with_ends_in_words(self):
        too_little, enough = 0, 1 << 20
        while enough - too_little > 16:
            size = (too_little + enough) // 2
            too_little, enough = (too_little, size) if self.limited(size, '--version')[0] == 0 else (size, enough)
        statuses = set()
        for size in range(enough + 16, enough + 24000, 120):
            status, text = self.limited(size, 'check', ROOT / 'sims/heap/quick.json', '--threads', '1')
            statuses.add(status)
            self.assertIn(status, (faults.DONE, faults.DESCRIPTION, faults.PLUGIN, faults.FILES), f'{size} kB: {text}')
            self.assertTrue(status == 0 or faults.is_helpful(text, '/nowhere'), text)
        self.assertIn(faults.FILES, statuses)
        self.assertIn(faults.DONE, statuses)


class Messages(unittest.TestCase):
    def test_must_name_something(self):
        for text in ('grit: out/series.h5: cannot write: No space left on device', 'grit: /guards/travel: a body moved by 1 m',
                     "grit: not enough memory; 'grit check' reports how much it needs", 'grit: cannot write to /tmp/here'):
            self.assertTrue(faults.is_helpful(text, '/tmp/elsewhere'), text)
        for text in ('', 'Aborted', 'grit: defect of grit or of a plugin; please report it: std::exception', '1/2 of it'):
            self.assertFalse(faults.is_helpful(text, '/tmp/elsewhere'), text)


class Pages(unittest.TestCase):
    PAGE = 'before\n<!-- faults -->\n| fault | tried |\n| --- | --- |\n| b | 1 |\n| c | 2 |\n<!-- end of faults -->\nafter\n'

    def test_rows_are_replaced_and_kept_in_order(self):
        text = tables.with_table(self.PAGE, 'faults', ('fault', 'tried'), [['a', 7], ['c', 8]], ['a', 'b', 'c'])
        self.assertEqual(text, 'before\n<!-- faults -->\n| fault | tried |\n| --- | --- |\n| a | 7 |\n| b | 1 |\n| c | 8 |\n'
                               '<!-- end of faults -->\nafter\n')

    def test_one_row_is_replaced_or_added(self):
        text = tables.with_row(tables.with_row(self.PAGE, 'faults', ['b', 5]), 'faults', ['a', 2])
        self.assertEqual(text, self.PAGE.replace('| b | 1 |', '| b | 5 |')
                         .replace('<!-- end', '| a | 2 |\n<!-- end'))
        with self.assertRaisesRegex(ValueError, 'found 1 cells, b; the table faults has 2: fault, tried'):
            tables.with_row(self.PAGE, 'faults', ['b'])
        with self.assertRaisesRegex(ValueError, 'no markers <!-- fuzzing -->'):
            tables.with_row(self.PAGE, 'fuzzing', ['b', 1])

    def test_the_page_has_all_tables(self):
        page = (ROOT / 'docs/evidence/reliability.md').read_text(encoding='utf-8')
        self.assertLessEqual(set(tables.rows_of(page, 'faults')), set(faults.FAULTS))
        self.assertLessEqual(set(tables.rows_of(page, 'restarts')), set(restarts.scenes()))
        self.assertLessEqual(set(tables.rows_of(page, 'fuzzing')), {file.stem for file in (ROOT / 'tests/fuzz').glob('*.cpp')})
        self.assertLessEqual(set(tables.rows_of(page, 'sanitizers')), {'address', 'thread', 'valgrind'})


CASES = {'campaign': (Campaign,), 'restarts': (Restarts,), 'self-test': (WrongPrograms, Undisturbed, RemovedSeries, Memory, Messages, Pages)}
suite = unittest.TestSuite(unittest.defaultTestLoader.loadTestsFromTestCase(case) for case in CASES[WHAT])
sys.exit(0 if unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful() else 1)
