#!/usr/bin/env python3
"""Writes docs/validation.md: every figure with a known answer, as the physics tests of a build find it.

  validate.py [BUILD]      BUILD is build unless given; exit status 1 if a test fails, and nothing is written
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PREFIX = 'verified: '
HEAD = '''# Validation
Written by `scripts/validate.py` from what the tests in [tests/physics](../tests/physics) find. Do not edit. Each row is a figure with a closed
form; the error is relative to it unless the row says otherwise. Errors are those of the time step that the test takes, and
fall as it says; `build/tests/test_physics --gtest_filter=NAME` repeats one.

| test | figure | closed form | found | error | allowed |
| --- | --- | --- | --- | --- | --- |
'''


def rows(report):
    for suite in report['testsuites']:
        for test in suite['testsuite']:
            name = f"{suite['name']}.{test['name']}"
            for key, value in test.items():
                if key.startswith(PREFIX):
                    known, found, error, allowed = value.split()
                    yield f'| {name} | {key[len(PREFIX):]} | {known} | {found} | {error} | {allowed} |\n'
                    name = ''


def main():
    build = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / 'build').resolve()
    program = build / 'tests' / 'test_physics'
    if not program.is_file():
        print(f'{program}: no such program; build it (cmake --build --preset release)', file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / 'report.json'
        done = subprocess.run([program, '--gtest_brief=1', f'--gtest_output=json:{report}'], cwd=folder)
        if done.returncode != 0:
            print('docs/validation.md is as it was: tests failed', file=sys.stderr)
            return 1
        table = ''.join(rows(json.loads(report.read_text(encoding='utf-8'))))
    (ROOT / 'docs' / 'validation.md').write_text(HEAD + table, encoding='utf-8')
    print(f'docs/validation.md: {table.count(chr(10))} figures')
    return 0


sys.exit(main())
