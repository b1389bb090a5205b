#!/usr/bin/env python3
"""Writes docs/validation.md: every figure with a known answer, as the tests of physics and of clumps of a build find it,
and what takes longer than a test (scripts/beverloo.py, scripts/planted.py).

  validate.py [BUILD]      BUILD is build unless given; exit status 1 if a test fails, and nothing is written
"""
import sys

sys.dont_write_bytecode = True
import reported  # noqa: E402

PREFIX = 'verified: '
HEAD = '''# Validation
Written by `scripts/validate.py` from what the tests in [tests/physics](../tests/physics) and [tests/clumps](../tests/clumps) find. Do not edit. Each row is a figure with a closed
form; the error is relative to it unless the row says otherwise. Errors are those of the time step that the test takes, and
fall as it says; `build/tests/test_physics --gtest_filter=NAME` repeats one, or `test_clumps`.

Contacts are evaluated in SIMD lanes. Of every law, force, moment and memory of a contact agree with those of a scalar twin within 1e-14 (1 + 0.1 size / overlap) of the
force, with the sum of the radii and the longest component of the branch for size: an overlap is a small difference of large numbers.
[tests/contracts/contact_law.cpp](../tests/contracts/contact_law.cpp) holds that.

| test | figure | closed form | found | error | allowed |
| --- | --- | --- | --- | --- | --- |
'''


def rows(tests):
    for name, properties in tests:
        for key, value in properties.items():
            if key.startswith(PREFIX):
                known, found, error, allowed = value.split()
                yield f'| {name} | {key[len(PREFIX):]} | {known} | {found} | {error} | {allowed} |\n'
                name = ''


PROGRAMS = ('test_physics', 'test_clumps')
table = ''.join(row for program in PROGRAMS for row in rows(reported.tests(program, 'docs/validation.md')))
longer = '\n'.join((reported.ROOT / 'docs' / page).read_text(encoding='utf-8') for page in ('beverloo.md', 'planted.md'))
(reported.ROOT / 'docs' / 'validation.md').write_text(HEAD + table + '\n' + longer, encoding='utf-8')
print(f'docs/validation.md: {table.count(chr(10))} figures')
