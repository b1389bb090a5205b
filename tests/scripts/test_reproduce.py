"""usage: test_reproduce.py ROOT [what unittest takes]

What scripts/reproduce.py keeps of docs/evidence/reproduction.md, and what it writes anew. Exit status 77 where there is no h5py.
"""
import json
import pathlib
import shutil
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
import reproduce  # noqa: E402

NAMES = ('shear/run-long-ago', 'shear/run-now', 'shear/timed', 'shear/never-run')
PAGE = '''# Reproduction

## shear/run-long-ago

100 bodies, by commit 111111111111.

| figure | reference | grit | deviation | |
| --- | --- | --- | --- | --- |
| peak | 2 ± 0.5 | 2.25 | +0.25 | within |

As it was.

## shear/run-now

100 bodies, by commit 111111111111.

| figure | reference | grit | deviation | |
| --- | --- | --- | --- | --- |
| peak | 2 ± 0.5 | 1 | -1 | outside |

## All quick descriptions, run to their ends
| description | ended | steps | core-seconds | commit | figures |
| --- | --- | --- | --- | --- | --- |
| shear/quick-long-ago | done | 9,000 | 7 | 111111111111 | peak: 3.50 |

## Not run to their ends
| description | hours by `grit check` | timed | M particle-steps a core-second | core-hours by that, at least | with sand that lies |
| --- | --- | --- | --- | --- | --- |
| shear/timed | 9.00 | 1.6 %, 21,766 steps | 25.7 | 2.6 | 22 |
| shear/never-run | 9.00 | | | | |
'''


class Reproduction(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        self.given = {'figures': [{'description': name, 'figure': 'peak', 'of': 'test/y', 'how': 'maximum', 'reference': 2, 'allowed': 0.5}
                                  for name in NAMES],
                      'resting': {'shear/timed': 3}, 'older': [], 'quick': [], 'notes': {'shear/run-long-ago': 'As it was.'}}
        for name in NAMES:
            self.file(f'sims/{name}.json', '{}')
        self.file('docs/evidence/reproduction.md', PAGE)
        self.checks_as('3.00 h (3 h)')

    def test_figures_are_scaled_and_put_off(self):
        row = {'of': 'y', 'how': 'last', 'scale': 10, 'plus': 180}
        self.assertEqual(reproduce.found({'y': numpy.array([1.0, -2.5])}, row), 155)

    def test_a_figure_may_be_a_component(self):
        row = {'of': 'force', 'how': 'last', 'component': 2}
        self.assertEqual(reproduce.found({'force': numpy.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])}, row), 6)

    def test_a_figure_may_be_of_the_end_of_a_stage(self):
        series = {'test/y': numpy.array([1.0, 2.0, 3.0]), 'test/step': numpy.array([10, 20, 21])}
        row = {'of': 'test/y', 'how': 'at the end of a stage', 'stage': 'settle'}
        self.assertEqual(reproduce.found(series, row, {'fill': 10, 'settle': 20, 'discharge': 90}), 2)

    def checks_as(self, hours):
        self.file('grit', f'#!/bin/sh\necho "estimated time on 2 threads at 0.000463 M particle-steps/s: {hours}"\n').chmod(0o700)

    def file(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding='utf-8')
        return path

    def ran(self, name, status, commit, y=(1, 2.5, 2), **more):
        """A run's results."""
        run = {'status': status, 'grit': {'revision': commit}, 'bodies': 100, 'steps': 5000, 'threads': 2, 'wall_s': 2, 'cpu_s': 4,
               'time_step_s': 1e-3, 'particle_steps_per_s': 250000, 'message': '', **more}
        path = self.file(f'results/{name}/run.json', json.dumps(run))
        with h5py.File(path.parent / 'series.h5', 'w') as series:
            series['test/y'] = y

    def written(self):
        """The page, as {heading: text below it}, and all of it."""
        self.file('docs/evidence/reproduction.json', json.dumps(self.given))
        words = ['', '--results', str(self.root / 'results'), '--grit', str(self.root / 'grit')]
        with unittest.mock.patch.object(reproduce, 'ROOT', self.root), unittest.mock.patch('sys.argv', words), \
                unittest.mock.patch('builtins.print'):
            reproduce.main()
        page = (self.root / 'docs/evidence/reproduction.md').read_text(encoding='utf-8')
        return reproduce.sections(page), page

    def test_without_results_all_stays(self):
        sections, page = self.written()
        was = reproduce.sections(PAGE)
        self.assertEqual({name: sections[name] for name in was if name in NAMES}, {name: was[name] for name in was if name in NAMES})
        self.assertIn('| shear/timed | 3.00 | 1.6 %, 21,766 steps | 25.7 | 2.6 | 22 |\n| shear/never-run | 3.00 | | | | |\n', page)
        self.assertEqual(self.written()[1], page)

    def test_a_finished_run_has_its_section_written_anew_and_names_its_commit(self):
        self.ran('shear/run-now', 'done', '222222222222')
        sections, _ = self.written()
        self.assertIn('by commit 222222222222.\n', sections['shear/run-now'])
        self.assertIn('| peak | 2 ± 0.5 | 2.5 | +0.5 | within |\n', sections['shear/run-now'])
        self.assertEqual(sections['shear/run-long-ago'], reproduce.sections(PAGE)['shear/run-long-ago'])

    def test_all_commits_of_several_packings_are_named(self):
        self.ran('shear/run-now', 'done', '222222222222')
        self.ran('shear/run-now-sample-2', 'done', '333333333333')
        self.assertIn('by commits 222222222222, 333333333333.\n', self.written()[0]['shear/run-now'])

    def test_what_is_not_there_is_none_and_is_in_no_mean(self):
        none = [numpy.nan, numpy.nan]
        self.given['figures'][0]['how'] = 'last'
        name = self.given['figures'][0]['description']
        self.ran(name, 'done', '222222222222', none)
        self.assertIn('| peak | 2 ± 0.5 | none | | |\n', self.written()[0][name])
        self.ran(f'{name}-sample-2', 'done', '222222222222')
        self.assertIn('| peak | 2 ± 0.5 | 2 in 1 of 2 | +0 | within |\n', self.written()[0][name])

    def test_a_run_that_has_not_ended_takes_no_section(self):
        self.ran('shear/run-long-ago', 'interrupted', '222222222222')
        self.assertEqual(self.written()[0]['shear/run-long-ago'], reproduce.sections(PAGE)['shear/run-long-ago'])

    def test_a_newer_timing_counts(self):
        self.ran('shear/timed', 'interrupted', '222222222222')
        self.assertIn('| shear/timed | 3.00 | 10.0 %, 5,000 steps by 222222222222 | 0.1 | 0.0 | 0 |\n', self.written()[1])

    def test_hours_have_what_limits_allow_beside_them(self):
        self.checks_as('3.00 h (3 h 00 min), at most 9.04 h (9 h 02 min) if stages run to their limits')
        self.assertIn('| shear/never-run | 3.00 … 9.0 | | | | |\n', self.written()[1])
        self.checks_as('0.00 h (0 s), at most 9.04 h (9 h 02 min) if stages run to their limits')
        self.assertIn('| shear/never-run | 0.00 … 9.0 | | | | |\n', self.written()[1])

    def test_full_descriptions_without_figures_are_listed_too(self):
        self.file('sims/shear/full-other.json', '{}')
        self.assertIn('| shear/full-other | 3.00 | | | | |\n', self.written()[1])
        self.ran('shear/full-other', 'done', '222222222222')
        sections, page = self.written()
        self.assertNotIn('| shear/full-other |', page)
        self.assertIn('by commit 222222222222.', sections['shear/full-other'])
        shutil.rmtree(self.root / 'results')
        self.assertEqual(self.written()[1], page)

    def test_what_has_not_run_has_its_note_below_the_table(self):
        self.given['notes'][reproduce.UNFINISHED] = 'Twice that.'
        for _ in range(2):
            self.assertTrue(self.written()[1].endswith('| shear/never-run | 3.00 | | | | |\n\nTwice that.\n'))

    def test_a_note_is_the_one_of_the_figures(self):
        self.given['notes']['shear/run-long-ago'] = 'Said better.'
        section = self.written()[0]['shear/run-long-ago']
        self.assertTrue(section.endswith('within |\n\nSaid better.\n\n'), section)

    def test_what_is_asked_otherwise_is_to_be_run_again(self):
        row, = (row for row in self.given['figures'] if row['description'] == 'shear/run-long-ago')
        for change in ({'figure': 'residual'}, {'reference': 3}, {'allowed': 1}):
            with self.subTest(change), unittest.mock.patch.dict(row, change):
                self.file('docs/evidence/reproduction.md', PAGE)
                self.expect_not_run()
        self.given['figures'].append({**row, 'figure': 'residual'})
        self.file('docs/evidence/reproduction.md', PAGE)
        self.expect_not_run()

    def test_a_description_that_is_gone_is_listed_as_not_run(self):
        (self.root / 'sims/shear/run-long-ago.json').unlink()
        self.expect_not_run()

    def quick(self, name):
        """What the table of quick descriptions says of one, or None."""
        lines = [line for line in self.written()[0].get(reproduce.QUICK, '').splitlines() if line.startswith(f'| {name} | ')]
        return lines[0].removeprefix(f'| {name} | ') if lines else None

    def test_a_quick_run_has_its_line_with_the_figures_of_its_kind(self):
        self.file('sims/shear/quick.json', '{}')
        self.given['quick'] = [{'descriptions': ['shear/quick*'], 'figures': [{'figure': 'peak', 'of': 'test/y', 'how': 'maximum', 'scale': 2},
                                                                              {'figure': 'least', 'of': 'test/y', 'how': 'minimum'}]},
                               {'descriptions': ['silo/*'], 'figures': [{'figure': 'not of this one', 'of': 'test/z', 'how': 'last'}]}]
        self.assertEqual(self.quick('shear/quick'), 'not run | | | | |')
        self.ran('shear/quick', 'interrupted', '222222222222')
        self.assertEqual(self.quick('shear/quick'), 'not run | | | | |')
        self.ran('shear/quick', 'done', '222222222222')
        self.assertEqual(self.quick('shear/quick'), 'done | 5,000 | 4 | 222222222222 | peak: 5.00; least: 1.00 |')
        self.assertIsNone(self.quick('shear/run-now'))

    def test_a_quick_run_that_failed_says_why(self):
        self.file('sims/shear/quick.json', '{}')
        self.ran('shear/quick', 'failed', '222222222222', message='grain 7 is gone\nlook at frame 3')
        self.assertEqual(self.quick('shear/quick'), 'failed: grain 7 is gone | 5,000 | 4 | 222222222222 |  |')

    def test_of_a_quick_run_that_is_not_at_hand_the_line_stays_while_there_is_its_description(self):
        description = self.file('sims/shear/quick-long-ago.json', '{}')
        self.assertEqual(self.quick('shear/quick-long-ago'), 'done | 9,000 | 7 | 111111111111 | peak: 3.50 |')
        self.assertEqual(self.quick('shear/quick-long-ago'), 'done | 9,000 | 7 | 111111111111 | peak: 3.50 |')
        description.unlink()
        self.assertIsNone(self.quick('shear/quick-long-ago'))

    def test_a_quick_run_with_a_section_is_told_there(self):
        self.file('sims/shear/quick.json', '{}')
        self.file('docs/evidence/reproduction.md', PAGE.replace('## shear/run-long-ago\n\n100 bodies, by', '## shear/quick\n\n100 bodies, 8,000 steps, '
                                                       '60 core-seconds on 2 threads, by', 1).replace('1111.\n', '1111-dirty.\n', 1))
        figures = self.given['figures']
        figures.append({**figures[0], 'description': 'shear/quick'})
        self.assertEqual(self.quick('shear/quick'), 'done | 8,000 | 60 | 111111111111-dirty | see its section |')
        figures[-1]['reference'] = 3
        self.assertEqual(self.quick('shear/quick'), 'not run | | | | |')

    def test_a_quick_run_with_a_section_is_told_of_in_what_that_lacks(self):
        self.file('sims/shear/quick.json', '{}')
        self.given['figures'].append({**self.given['figures'][0], 'description': 'shear/quick'})
        self.given['quick'] = [{'descriptions': ['shear/quick*'], 'figures': [{'figure': 'peak', 'of': 'test/y', 'how': 'maximum', 'scale': 2},
                                                                              {'figure': 'least', 'of': 'test/y', 'how': 'minimum'}]}]
        self.ran('shear/quick', 'done', '222222222222')
        for told_by in ('the run', 'the page'):
            with self.subTest(told_by):
                self.assertEqual(self.quick('shear/quick'), 'done | 5,000 | 4 | 222222222222 | see its section; least: 1.00 |')
            shutil.rmtree(self.root / 'results', ignore_errors=True)

    def expect_not_run(self):
        sections, page = self.written()
        self.assertNotIn('shear/run-long-ago', sections)
        self.assertIn('| shear/run-long-ago | 3.00 | | | | |\n', page)
        self.assertIn('shear/run-now', sections)


unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
