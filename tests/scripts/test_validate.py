"""usage: test_validate.py ROOT [what unittest takes]

What scripts/validate.py makes of quantities that are given, and that docs/evidence/validation.md and validation.csv agree.
"""
import csv
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = sys.argv[1]
sys.path.insert(0, f'{ROOT}/scripts')
import validate  # noqa: E402

TESTS = [('Impact.Sticks', {'name': 'Sticks', 'verified: speed [m/s]': '2 2.02 1.0e-02 0.1', 'verified: spin': '0 0.03 3.0e-02 0.04'}),
         ('Impact.Slides', {'beside: spin at 5°': '19 47 +1.4', 'beside: spin at 10°': '100 90 -0.1', 'beside: spin at 15°': '100 99 -0.01'})]


class Validate(unittest.TestCase):
    def test_a_row_has_its_columns_and_the_name_of_its_test(self):
        table = [*validate.rows(TESTS)]
        self.assertEqual(table[0], ['Impact.Sticks', 'speed [m/s]', '2', '2.02', '1.0e-02', '0.1', '', ''])
        self.assertEqual(table[2], ['Impact.Slides', 'spin at 5°', '', '47', '', '', '19', '+1.4'])

    def test_the_page_shows_what_comes_nearest_to_its_allowance(self):
        page = validate.page([*validate.rows(TESTS)])
        self.assertIn('2 quantities with a closed form were computed by 1 tests', page)
        self.assertIn('\n1 of them use more than half of their allowance.', page)
        self.assertIn('| Impact | 2 | 0.75 | Sticks: spin |\n', page)
        self.assertIn('| Impact | 3 | 0.1 | +1.4 | spin at 5° |\n', page)

    def test_page_and_table_agree(self):
        with open(f'{ROOT}/docs/evidence/validation.csv', encoding='utf-8', newline='') as file:
            columns, *table = csv.reader(file)
        self.assertEqual(tuple(columns), validate.COLUMNS)
        with open(f'{ROOT}/docs/evidence/validation.md', encoding='utf-8') as file:
            self.assertEqual(file.read(), validate.page(table), 'run scripts/validate.py')
        self.assertLessEqual(max(validate.share(row) for row in table if row[5]), 1)


unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
