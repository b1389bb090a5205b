#!/usr/bin/env python3
"""Whether scripts/planted.py can still plant each of its errors, and docs/evidence/planted.md is of these. Builds nothing. Prints what
is wrong; exit status 1 if anything is.

  planted.py ROOT      checks the tree at ROOT
  planted.py --self-test ROOT   breaks each rule in a copy of what is read and sees that it is noticed
"""
import fnmatch
import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(sys.argv[-1]).resolve()
sys.path.insert(0, str(ROOT / 'scripts'))
import planted  # noqa: E402

PAGE = 'docs/evidence/planted.md'


def tree():
    """What is checked: sources of parts, names of laws, sources of tests, pages."""
    read = lambda path: path.read_text(encoding='utf-8')  # noqa: E731
    return {'sources': {part: read(room / source) for part, (room, source, _) in planted.PARTS.items()},
            'laws': sorted(folder.name for folder in planted.LAWS.iterdir() if folder.is_dir()),
            'tests': '\n'.join(read(file) for folder in ('physics', 'run')
                               for file in sorted((ROOT / 'tests' / folder).glob('*.cpp'))),
            PAGE: read(ROOT / PAGE)}


def problems(found):
    wrong = [f'{law}: no error is planted in this law' for law in found['laws'] if law not in planted.PARTS]
    for part, (_, source, errors) in planted.PARTS.items():
        wrong += [f'{part}: {what}: stands {count} times in {source}, not once: {text}' for what, text, _ in errors
                  if (count := found['sources'][part].count(text)) != 1]

    known = {'.'.join(names) for names in re.findall(r'^TEST(?:_[PF])?\((\w+),\s*(\w+)\)', found['tests'], re.MULTILINE)}
    wrong += [f'left out, but no test: {pattern}' for pattern in planted.SLOW + planted.OF_WALLS
              if not fnmatch.filter(known, pattern)]

    page = found[PAGE]
    if not page.startswith(planted.HEAD):
        wrong.append(f'{PAGE}: its head is not that of scripts/planted.py')
    rows = [tuple(line.strip('| ').split(' | ')) for line in page.splitlines()[planted.HEAD.count('\n'):]]
    listed = [row[:2] for row in rows]
    wanted = [(part, what) for part, (_, _, errors) in planted.PARTS.items() for what, _, _ in errors]
    wrong += [f'{PAGE}: lacks "{part} | {what}"' for part, what in wanted if (part, what) not in listed]
    wrong += [f'{PAGE}: nothing plants "{" | ".join(one)}"' for one in listed if one not in wanted]
    if sorted(listed) == sorted(wanted) and listed != wanted:
        wrong.append(f'{PAGE}: is not in the order of scripts/planted.py')
    if len(listed) != len(set(listed)):
        wrong.append(f'{PAGE}: has a row twice')
    for row in rows:
        tests = row[2].split(', ') if len(row) == 3 else []
        wrong += [f'{PAGE}: {" | ".join(row[:2])}: no such test: {test}' for test in tests or ['none']
                  if test not in known]
    return wrong


def self_test():
    """Each rule broken alone."""
    def broken(key, old, new, part=None):
        found = tree()
        room = found['sources'] if part else found
        assert old in room[part or key], f'{old} is not in {part or key}'
        room[part or key] = room[part or key].replace(old, new, 1)
        return found

    page = tree()[PAGE]
    rows = page[len(planted.HEAD):].splitlines(True)
    law, (_, _, errors) = next(iter(planted.PARTS.items()))
    what, text, _ = errors[0]
    test = rows[0].strip('|\n ').split(' | ')[2].split(', ')[0]
    suite, name = test.split('.')
    slow = planted.SLOW[0].split('.')[0]
    cases = [
        (broken('', text, 'another form', law), f'{what}: stands 0 times'),
        (broken('', text, f'{text} + {text}', law), f'{what}: stands 2 times'),
        ({**tree(), 'laws': [*tree()['laws'], 'bouncy']}, 'bouncy: no error is planted'),
        (broken('tests', f'({suite}, {name})', f'({suite}, {name}Now)'), f'no such test: {test}'),
        ({**tree(), 'tests': tree()['tests'].replace(f'TEST({slow},', f'TEST(Other{slow},')}, f'left out, but no test: {slow}.*'),
        (broken(PAGE, rows[0], ''), f'lacks "{law} | {what}"'),
        (broken(PAGE, rows[0], rows[0] + rows[0].replace(what, 'gravity × 2')), f'nothing plants "{law} | gravity × 2"'),
        (broken(PAGE, rows[0] + rows[1], rows[1] + rows[0]), 'is not in the order'),
        (broken(PAGE, rows[0], rows[0] * 2), 'has a row twice'),
        (broken(PAGE, rows[0], f'| {law} | {what} | none |\n'), 'no such test: none'),
        (broken(PAGE, 'Planted errors', 'Errors'), 'its head is not'),
    ]
    unseen = [words for found, words in cases if not any(words in line for line in problems(found))]
    return [f'passed unnoticed: {words}' for words in unseen]


wrong = self_test() if sys.argv[1] == '--self-test' else problems(tree())
print(*wrong, sep='\n', end='\n' if wrong else '')
sys.exit(1 if wrong else 0)
