"""usage: test_beverloo.py ROOT [what unittest takes]

What scripts/beverloo.py concludes from rates that are given.
"""
import re
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = sys.argv[1]
sys.path.insert(0, f'{ROOT}/scripts')
import beverloo  # noqa: E402

SIZES = (8, 10, 12, 16, 24)


def rates(k, hole, slot, noise=0.0):
    """Of both kinds, C (D − k)^n; noise is up and down in turn."""
    return {kind: [(size, 0.3 * (size - k) ** n * (1 + noise * (-1) ** i)) for i, size in enumerate(SIZES)]
            for kind, n in (('hole', hole), ('slot', slot))}


def verdicts(found):
    """The row of the fitted k, and of holes and of slots what was fitted and whether it holds."""
    row = next(line for line in beverloo.page(found).splitlines() if ', fitted' in line)
    return [cell.strip() for cell in row.strip('|').split('|')]


class Beverloo(unittest.TestCase):
    def test_his_own_law_gives_its_k_and_its_exponents(self):
        self.assertEqual(verdicts(rates(1.9, 2.5, 1.5)), ['1.90, fitted', '2.50 ± 0.000', 'holds', '1.50 ± 0.000', 'holds'])

    def test_one_k_serves_not_where_exponents_are_others(self):
        k, hole, of_hole, slot, of_slot = verdicts(rates(1.4, 2.5, 1.8))
        self.assertEqual((of_hole, of_slot), ('misses', 'misses'), 'k is pulled up by slots, which takes holes down')
        self.assertGreater(float(slot.split()[0]), 1.6)
        self.assertLess(float(hole.split()[0]), 2.4)

    def test_k_of_one_kind_judges_the_other(self):
        lines = beverloo.page(rates(1.4, 2.5, 1.8)).splitlines()
        self.assertIn('- k = 1.40 from holes: exponent of slots 1.80 ± 0.000, misses', lines)

    def test_the_bound_is_a_tenth_on_either_side(self):
        for n, said in ((1.39, 'misses'), (1.41, 'holds'), (1.59, 'holds'), (1.61, 'misses')):
            self.assertEqual(beverloo.verdict('slot', n), said)
            self.assertEqual(beverloo.verdict('hole', n + 1), said)

    def test_the_standard_error_is_that_of_the_scatter(self):
        # y = 0, 1, 1, 2 over x = 0, 1, 2, 3: slope 0.6, left 0.2, over 2 degrees of freedom and a spread of 5.
        slope, start, error, left = beverloo.line([(0, 0), (1, 1), (2, 1), (3, 2)])
        for found, known in ((slope, 0.6), (start, 0.1), (error, 0.02 ** 0.5), (left, 0.2)):
            self.assertAlmostEqual(found, known, places=12)

    def test_the_page_holds_by_the_rates_that_it_tells(self):
        with open(f'{ROOT}/docs/evidence/beverloo.md', encoding='utf-8') as page:
            text = page.read()
        told = {'hole': [], 'slot': []}
        for kind, size, measured in re.findall(r'^\| (hole|slot) \| (\d+) \| ([0-9., ]+) \|', text, re.MULTILINE):
            told[kind] += [(int(size), 1e-3 * float(rate)) for rate in measured.split(', ')]
        self.assertEqual({kind: len({size for size, _ in of}) for kind, of in told.items()}, {'hole': 4, 'slot': 4}, 'outlets of each kind')
        k, hole, of_hole, slot, of_slot = verdicts(told)
        self.assertEqual((of_hole, of_slot), ('holds', 'holds'))
        self.assertIn(f'| {k} | {hole} | holds | {slot} | holds |', text, 'rates of four digits tell the exponents of the page')

    def test_both_free_find_what_was_put_in(self):
        for kind, n in (('hole', 2.7), ('slot', 1.6)):
            k, exponent = beverloo.best_of_both(rates(1.3, 2.7, 1.6)[kind])
            self.assertAlmostEqual(k, 1.3, places=9)
            self.assertAlmostEqual(exponent, n, places=9)


unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
