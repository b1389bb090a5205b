#!/usr/bin/env python3
"""Writes docs/evidence/validation.md and validation.csv: every quantity with a closed form, as computed by the tests of
physics and clumps of a build.

  validate.py [BUILD]      BUILD is build unless given; exit status 1 if a test fails, and nothing is written
"""
import csv
import io
import sys

sys.dont_write_bytecode = True
import reported  # noqa: E402

VERIFIED, BESIDE = 'verified: ', 'beside: '
PROGRAMS = ('test_physics', 'test_clumps')
HEAD = '''# Validation
Written by `scripts/validate.py` from the tests in [tests/physics](../../tests/physics) and [tests/clumps](../../tests/clumps). Do not edit.

**Summary.** {figures} quantities with a closed form were computed by {tests} tests; all errors are within what their tests allow.
{tight} of them use more than half of their allowance.

[validation.csv](validation.csv) has every quantity: test, closed form, result, error, allowed error, literature value and difference from it.
`build/tests/test_physics --gtest_filter=NAME` repeats a test; those of clumps are in `build/tests/test_clumps`.

- Errors are relative to the closed form unless the quantity says otherwise.
- Errors depend on the time step of the test, and shrink with it.
- SIMD and scalar evaluation of a contact law agree within 1e-14 (1 + 0.1 size / overlap) of the force
  ([contact_law.cpp](../../core/src/testing/contact_law.cpp)). The size is the sum of the radii plus the longest branch component.

Whole tests of sand are compared with a reference work in [reproduction](reproduction.md). Flow through outlets is compared with
[Beverloo's law](beverloo.md). [Planted errors](planted.md) shows which tests detect which error in the code.

## By test
The last two columns show the quantity that comes nearest to its allowance.

| tests | quantities | error over allowed | quantity |
| --- | --- | --- | --- |
'''
LITERATURE = '''
## Beside literature
{count} quantities of oblique impacts are compared with values of others. The difference measures the law and its parameters, not the arithmetic.

- Kharaz, Gorham & Salman (2001), doi:10.1016/S0032-5910(01)00283-2, measured. The values were read off their figures for an example of
  [Lethe](https://github.com/chaos-polymtl/lethe). These quantities are marked "measured".
- Chung & Ooi (2011), doi:10.1007/s10035-011-0277-0, fourth test. The values are called measured there, but agree with the closed form of sliding
  within 0.4 % and differ from the measurements at 5°. They are taken for computed.

| tests | quantities | median difference | largest | quantity |
| --- | --- | --- | --- | --- |
'''
COLUMNS = ('test', 'quantity', 'closed form', 'found', 'error', 'allowed', 'literature', 'difference')


def rows(tests):
    """A list of COLUMNS for each quantity."""
    for name, properties in tests:
        for key, value in properties.items():
            words = value.split() if isinstance(value, str) else []
            if key.startswith(VERIFIED):
                yield [name, key[len(VERIFIED):], *words, '', '']
            if key.startswith(BESIDE):
                literature, found, difference = words
                yield [name, key[len(BESIDE):], '', found, '', '', literature, difference]


def share(row):
    """Error over allowed error."""
    return abs(float(row[4])) / float(row[5]) if float(row[5]) else 0.0


def by_suite(table):
    suites = {}
    for row in table:
        suites.setdefault(row[0].partition('.')[0], []).append(row)
    return sorted(suites.items())


def page(table):
    verified = [row for row in table if row[5]]
    beside = [row for row in table if row[6]]
    text = HEAD.format(figures=len(verified), tests=len({row[0] for row in verified}), tight=sum(share(row) > 0.5 for row in verified))
    for suite, group in by_suite(verified):
        worst = max(group, key=share)
        text += f"| {suite} | {len(group)} | {share(worst):.2g} | {worst[0].partition('.')[2]}: {worst[1]} |\n"
    text += LITERATURE.format(count=len(beside))
    for suite, group in by_suite(beside):
        relative = [row for row in group if 'difference in' not in row[1]]
        sizes = sorted(abs(float(row[7])) for row in relative)
        worst = max(relative, key=lambda row: abs(float(row[7])))
        text += f"| {suite} | {len(relative)} | {sizes[len(sizes) // 2]:.2g} | {worst[7]} | {worst[1]} |\n"
    return text


def table_as_csv(table):
    out = io.StringIO()
    csv.writer(out, lineterminator='\n').writerows([COLUMNS, *table])
    return out.getvalue()


def main():
    table = [*rows([test for program in PROGRAMS for test in reported.tests(program, 'docs/evidence/validation.md')])]
    folder = reported.ROOT / 'docs' / 'evidence'
    (folder / 'validation.md').write_text(page(table), encoding='utf-8')
    (folder / 'validation.csv').write_text(table_as_csv(table), encoding='utf-8')
    print(f'docs/evidence/validation.md: {len(table)} quantities')


if __name__ == '__main__':
    main()
