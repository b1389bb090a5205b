#!/usr/bin/env python3
"""Whether the SDK refuses to be compiled with options that change results, and compiles without them.

  fast_math.py SOURCE COMPILER FLAG…      exit status 1 if it does not
"""
import subprocess
import sys

MESSAGE = 'grit: compile without -ffast-math and its parts'


def compiled(source, command, *more):
    """Whether a source compiles, and what the compiler prints."""
    done = subprocess.run([*command, *more, '-fsyntax-only', source], capture_output=True, text=True, check=False)
    return done.returncode == 0, done.stderr


def main():
    source, *command = sys.argv[1:]
    wrong = []
    for option in ('-ffast-math', '-Ofast', '-ffinite-math-only'):
        good, text = compiled(source, command, option)
        if good or MESSAGE not in text:
            wrong.append(f'{option}: expected "{MESSAGE}", found "{text[:300]}"')
    good, text = compiled(source, command)
    if not good:
        wrong.append(f'without such an option: {text[:300]}')
    print('\n'.join(wrong) or 'all as expected')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
