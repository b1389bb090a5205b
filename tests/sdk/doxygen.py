#!/usr/bin/env python3
"""Runs Doxygen on the headers of the SDK. Warnings fail, and types without a comment.

  doxygen.py ROOT              checks the tree at ROOT; exit status 1 with the warnings, 77 without Doxygen
  doxygen.py --self-test ROOT  spoils copies of a header and sees what is noticed
"""
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HEADERS, DOXYFILE, SKIPPED = Path('core/include/grit'), Path('docs/plugins/Doxyfile'), 77
# Members without a comment are hidden, so that only types are asked for; a namespace has none.
OF_TYPES = 'EXTRACT_ALL = NO\nHIDE_UNDOC_MEMBERS = YES\n'


def warnings(root):
    """Lines that Doxygen prints about the headers at a root."""
    lines = []
    for more in ('', OF_TYPES):
        with tempfile.TemporaryDirectory() as place:
            namespace = Path(place) / 'namespace.dox'
            namespace.write_text('/** @namespace grit\n The SDK. */\n', encoding='utf-8')
            settings = (root / DOXYFILE).read_text(encoding='utf-8') + f'OUTPUT_DIRECTORY = {place}\nINPUT += {namespace}\n' + more
            done = subprocess.run(['doxygen', '-'], cwd=root, input=settings, capture_output=True, text=True, check=False)
            found = [line for line in done.stderr.splitlines() if line.strip()]
            if done.returncode != 0 and not found:
                found = [f'doxygen: exit status {done.returncode}']
            lines += [line for line in found if line not in lines]
    return lines


def self_test(root):
    cases = [
        # what, pattern and replacement in engine.hpp, part of a warning; '' if none is expected
        ('a comment', r'\Z', '/// Another comment.\nstruct Planted { int a; };\n', ''),
        ('a type without a comment', r'(?=/// Base class of plugins)', 'struct Planted { int a; };\n\n', 'Planted is not documented'),
        ('a reference to nothing', r'(?=/// Base class of plugins)', '/// See @ref nowhere.\nstruct Planted {};\n\n', 'nowhere'),
        ('an unknown command', r'(?=/// Base class of plugins)', '/// Has @planted.\nstruct Planted {};\n\n', 'planted'),
        ('a parameter of another name', r'(?=/// Base class of plugins)',
         '/// Plants.\n/// @param tree what\ninline void plant(int bush) { (void)bush; }\n\n', 'tree'),
    ]
    wrong = []
    for what, pattern, replacement, part in cases:
        with tempfile.TemporaryDirectory() as place:
            copy = Path(place)
            header = copy / HEADERS / 'engine.hpp'       # alone: the others take ten times as long
            for file in (header, copy / DOXYFILE):
                file.parent.mkdir(parents=True)
                shutil.copy(root / file.relative_to(copy), file)
            old = header.read_text(encoding='utf-8')
            new = re.sub(pattern, replacement, old, count=1)
            if new == old:
                wrong.append(f'{what}: nothing to change')
            header.write_text(new, encoding='utf-8')
            found = warnings(copy)
            if bool(found) != bool(part) or part not in ' '.join(found):
                wrong.append(f'{what}: expected "{part}", found {found}')
    return wrong


def main():
    if shutil.which('doxygen') is None:
        print('skipped: no doxygen')
        return SKIPPED
    found = (self_test if sys.argv[1] == '--self-test' else warnings)(Path(sys.argv[-1]).resolve())
    print('\n'.join(found) or 'no warnings')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
