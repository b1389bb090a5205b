"""usage: test_estimates.py ROOT [what unittest takes]

What scripts/estimates.py reads from `grit check` and concludes from runs that are given.
"""
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = sys.argv[1]
sys.path.insert(0, f'{ROOT}/scripts')
import estimates  # noqa: E402

KNOWN = '''stages
  fall            0.3 s, 12742 steps
  rotate          6 s, 254831 steps

estimated time on 1 thread at 18 M particle-steps/s: 0.01 h (1 min 28 s)
'''
USUAL = '''stages
  pour            1 s, 42702 steps
  rest            usually 0.5 s, 21351 steps (ends by its condition, 3 s at most)

estimated time on 1 thread at 18 M particle-steps/s: 0.00 h (10 s), at most 1.01 h (1 h 01 min) if stages run to their limits
'''
BOUNDED = '''stages
  rest            at most 3 s, 300 steps (ends by its condition)

estimated time on 1 thread at 18 M particle-steps/s: 0.00 h (4 s) at least (the end of a stage without typical_time is unknown), at most 0.01 h (26 s) if stages run to their limits
'''


def ran(cpu):
    return {'cpu_s': cpu, 'steps': 1000, 'bodies': 2000}


class Estimates(unittest.TestCase):
    def test_durations_are_those_of_grit(self):
        for text, known in (('0 s', 0), ('1 min 46 s', 106), ('2 h 51 min', 10260)):
            self.assertEqual(estimates.seconds(text), known)

    def test_reads_what_is_known_and_what_is_usual(self):
        self.assertEqual(estimates.estimate(KNOWN), {'seconds': 88, 'at_least': False, 'most': 88, 'steps': 267573})
        self.assertEqual(estimates.estimate(USUAL), {'seconds': 10, 'at_least': False, 'most': 3660, 'steps': 64053})

    def test_reads_bounds(self):
        self.assertEqual(estimates.estimate(BOUNDED), {'seconds': 4, 'at_least': True, 'most': 26, 'steps': 300})

    def test_a_run_may_take_half_and_twice_the_estimate(self):
        usual, bounded = estimates.estimate(USUAL), estimates.estimate(BOUNDED)
        for took, good in ((4.9, False), (5.1, True), (19.9, True), (20.1, False)):
            self.assertEqual(estimates.holds(usual, took), good, took)
        for took, good in ((1.9, False), (2.1, True), (51.9, True), (52.1, False)):
            self.assertEqual(estimates.holds(bounded, took), good, took)

    def test_the_page_names_what_missed(self):
        text = estimates.page({'drum/quick': (estimates.estimate(KNOWN), ran(60)), 'box/quick': (estimates.estimate(USUAL), ran(40)),
                               'bin/quick': (estimates.estimate(BOUNDED), ran(12))})
        self.assertIn('2 of 3 quick descriptions', text)
        self.assertIn('Others: box/quick.\n', text)
        self.assertIn('| drum/quick | 88 | 60.0 | 0.68 | 267573 | 1000 | 0.0 |\n', text)
        self.assertIn('| bin/quick | 4 … 26 | 12.0 |  | 300 | 1000 | 0.2 |\n', text)


unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
