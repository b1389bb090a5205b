#!/usr/bin/env python3
"""Compiles laws.cpp and compares the compiler's messages for each law with the lines `// error: …` above it.

  check.py SOURCE COMPILER FLAG…      exit status 1 if a message is missing, or there is one that is not expected
"""
import re
import subprocess
import sys
from pathlib import Path


def expected(lines):
    """By law: parts of the expected messages; by line: the law."""
    messages, place, waiting, law = {}, {}, [], None
    for number, line in enumerate(lines, 1):
        if line.startswith('// error: '):
            waiting.append(line.removeprefix('// error: '))
        elif found := re.match(r'struct (\w+) :', line):
            law = found.group(1)
            messages[law], waiting = waiting, []
        place[number] = law
    return messages, place


def given(text, place):
    """By law: the compiler's errors, without line breaks."""
    errors, name = {}, None
    for error in re.split(r'(?m)^(?=\S+:\d+:\d+: (?:fatal )?error: )', text)[1:]:
        law = re.search(r'check_law(?:<|\(\) \[with Law = )(?:somewhere::)?(\w+)[>\]]', error)
        line = re.match(r'\S+?laws\.cpp:(\d+):', error)
        # A message without a law belongs to the previous error.
        name = law.group(1) if law else place.get(int(line.group(1))) if line else name
        errors.setdefault(name, []).append(error)
    return errors


def main():
    source, *command = sys.argv[1:]
    messages, place = expected(Path(source).read_text(encoding='utf-8').splitlines())
    done = subprocess.run([*command, '-fsyntax-only', source], capture_output=True, text=True)
    # g++ names the law in the lines before an error.
    text = re.sub(r"(?m)^(\S+: In instantiation of [^\n]*check_law[^\n]*)\n((?:[^\n]*required from[^\n]*\n)*)(\S+:\d+:\d+: error: [^\n]*)",
                  r'\3 \1', done.stderr)
    errors = given(text, place)
    wrong = []
    for law, parts in messages.items():
        own = errors.pop(law, [])
        wrong += [f'{law}: missing: {part}' for part in parts if not any(part in ' '.join(one.split()) for one in own)]
        if not parts and own:
            wrong += [f'{law}: should compile: {one.splitlines()[0]}' for one in own]
        # The compiler may add notes on the failed static_assert, but no other message.
        said = [one for one in own if 'assertion failed' in one.splitlines()[0]]
        wrong += [f'{law}: not expected: {one.splitlines()[0]}' for one in said
                  if parts and not any(part in ' '.join(one.split()) for part in parts)]
    wrong += [f'not of a law: {one.splitlines()[0]}' for own in errors.values() for one in own]
    print('\n'.join(wrong) or f'{len(messages)} laws: all messages as expected')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
