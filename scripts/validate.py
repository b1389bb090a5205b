#!/usr/bin/env python3
"""Writes docs/validation.md: every figure with a known answer, as the tests of physics and of clumps of a build find it,
and what takes longer than a test (scripts/beverloo.py, scripts/planted.py).

  validate.py [BUILD]      BUILD is build unless given; exit status 1 if a test fails, and nothing is written
"""
import sys

sys.dont_write_bytecode = True
import reported  # noqa: E402

VERIFIED, BESIDE = 'verified: ', 'beside: '
HEAD = '''# Validation
Written by `scripts/validate.py` from what the tests in [tests/physics](../tests/physics) and [tests/clumps](../tests/clumps) find. Do not edit. Each row is a figure with a closed
form; the error is relative to it unless the row says otherwise. Errors are those of the time step that the test takes, and
fall as it says; `build/tests/test_physics --gtest_filter=NAME` repeats one, or `test_clumps`. Whole tests of sand beside those of a reference work stand in [reproduction](reproduction.md).

Contacts are evaluated in SIMD lanes. Of every law, force, moment and memory of a contact agree with those of a scalar twin within 1e-14 (1 + 0.1 size / overlap) of the
force, with the sum of the radii and the longest component of the branch for size: an overlap is a small difference of large numbers.
[tests/contracts/contact_law.cpp](../tests/contracts/contact_law.cpp) holds that.

| test | figure | closed form | found | error | allowed |
| --- | --- | --- | --- | --- | --- |
'''
OTHERS = '''
## Beside figures of others
What grit computes from friction and restitution, beside what others found; the difference is relative unless the row says otherwise. It is that of the
law, of its parameters and of the other figure: that grit computes what the law says, the table above holds at the same angles. Those that were measured are
of Kharaz, Gorham & Salman (2001), doi:10.1016/S0032-5910(01)00283-2, as read off their figures for an example of [Lethe](https://github.com/chaos-polymtl/lethe); those without a
word are the points given for the fourth test of Chung & Ooi (2011), doi:10.1007/s10035-011-0277-0. These are said to be measured too, but their
restitutions lie by the closed form of sliding within 0.4 % at all its angles, and at 5° far from what was measured: they are taken for computed.

| test | figure | others | found | difference |
| --- | --- | --- | --- | --- |
'''


def rows(tests, prefix):
    for name, properties in tests:
        for key, value in properties.items():
            if key.startswith(prefix):
                yield ' | '.join([f'| {name}', key[len(prefix):], *value.split()]) + ' |\n'
                name = ''


PROGRAMS = ('test_physics', 'test_clumps')
tests = [test for program in PROGRAMS for test in reported.tests(program, 'docs/validation.md')]
table = ''.join(rows(tests, VERIFIED))
beside = OTHERS + ''.join(rows(tests, BESIDE))
longer = '\n'.join((reported.ROOT / 'docs' / page).read_text(encoding='utf-8') for page in ('beverloo.md', 'planted.md'))
(reported.ROOT / 'docs' / 'validation.md').write_text(HEAD + table + beside + '\n' + longer, encoding='utf-8')
print(f'docs/validation.md: {table.count(chr(10))} figures')
