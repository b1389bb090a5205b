"""Properties that a test program reports besides passing or failing."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def tests(name, page):
    """(name, properties) of each test of build/tests/NAME; the first command-line argument names another build. Exits
    if there is no such program (status 2) or a test fails (status 1); `page` is then unchanged."""
    build = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / 'build').resolve()
    program = build / 'tests' / name
    if not program.is_file():
        print(f'{program}: no such program; build it (cmake --build --preset release)', file=sys.stderr)
        sys.exit(2)
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / 'report.json'
        done = subprocess.run([program, '--gtest_brief=1', f'--gtest_output=json:{report}'], cwd=folder)
        if done.returncode != 0:
            print(f'{page} is unchanged: tests failed', file=sys.stderr)
            sys.exit(1)
        suites = json.loads(report.read_text(encoding='utf-8'))['testsuites']
    return [(f"{suite['name']}.{test['name']}", test) for suite in suites for test in suite['testsuite']]
