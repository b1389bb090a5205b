#!/usr/bin/env python3
"""Whether what is compiled into plugins has changed without the SDK version being raised: the headers of core/include/grit,
and the options of the compiler. Comments and blank space do not count, nor does grit/testing, which no plugin contains.
tests/house/sdk_version.txt has the version and a hash of each part.

  sdk_version.py ROOT              checks the tree at ROOT; exit status 1 if the version must be raised or the file renewed
  sdk_version.py --renew ROOT      writes the file, after the version was raised
  sdk_version.py --self-test ROOT  changes copies of what is read and sees what is noticed
"""
import hashlib
import re
import shutil
import sys
import tempfile
from pathlib import Path

HEADERS, TAG = Path('core/include/grit'), Path('core/include/grit/build_tag.hpp')
OPTIONS = (Path('core/CMakeLists.txt'), Path('cmake/GritPlugin.cmake'))
KEPT = Path('tests/house/sdk_version.txt')
VERSION = re.compile(r'(?<=\bsdk_version = )\d+(?=;)')

TOKEN = re.compile(r'''
    (?P<comment> //(?:\\\n|[^\n])* | /\*.*?\*/ )
  | (?P<text> (?:u8|[uUL])?R"(?P<end>[^()\s\\]*)\(.*?\)(?P=end)" | "(?:\\.|[^"\\\n])*" )
  | (?P<directive> ^[^\S\n]*\# )
  | (?P<word> \.?\d(?:'\w|[eEpP][-+]|[\w.])* | \w+ | '(?:\\.|[^'\\\n])+'
      | <=> | <<= | >>= | ->\* | \.\.\. | :: | -> | \+\+ | -- | << | >> | && | \|\| | \#\# | [-+*/%&|^<>=!]= | [^\s\\] )
  | (?P<continued> \\\n ) | (?P<newline> \n ) | \s | \\
''', re.VERBOSE | re.DOTALL | re.MULTILINE)
# Commands for the target of the SDK, and for the objects of a plugin.
COMMAND = re.compile(r'^[ \t]*\w+\((?:grit_sdk|\$\{target\}_objects)\b(?:[^()]|\([^()]*\))*\)', re.MULTILINE)


def tokens_of(code):
    """Words of C++, one a line; a directive of the preprocessor ends where its line does."""
    tokens, in_directive = [], False
    for found in TOKEN.finditer(code):
        kind = found.lastgroup if found.lastgroup != 'end' else 'text'
        if kind == 'directive':
            in_directive = True
        if kind in ('text', 'word', 'directive'):
            tokens.append(found.group().strip())
        elif in_directive and (kind == 'newline' or kind == 'comment' and '\n' in found.group()):
            tokens.append('end of directive')
            in_directive = False
    return '\n'.join(tokens)


def options_of(script):
    """Commands of CMake that matter."""
    script = re.sub(r'#[^\n]*', '', script)
    return '\n'.join(' '.join(found.group().split()) for found in COMMAND.finditer(script))


def digest(text):
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def parts(root):
    """The version, and a hash of each part by name."""
    version = int(VERSION.search((root / TAG).read_text(encoding='utf-8')).group())
    headers = sorted(file.relative_to(root) for file in (root / HEADERS).rglob('*.hpp')
                     if 'testing' not in file.relative_to(root / HEADERS).parts)
    hashes = {}
    for name in headers:
        code = (root / name).read_text(encoding='utf-8')
        hashes[str(name)] = digest(tokens_of(VERSION.sub('N', code) if name == TAG else code))
    for name in OPTIONS:
        hashes[f'{name} (options)'] = digest(options_of((root / name).read_text(encoding='utf-8')))
    return version, hashes


def text_of(version, hashes):
    """What is kept. The first line has a hash of all, so that two branches that raise the version collide."""
    lines = [f'{value} {name}' for name, value in hashes.items()]
    return '\n'.join([f'{version} {digest(chr(10).join(lines))}', *lines, ''])


def kept(root):
    """The version and the hashes when the file was written."""
    first, *lines = (root / KEPT).read_text(encoding='utf-8').splitlines()
    return int(first.split()[0]), {name: value for value, name in (line.split(' ', 1) for line in lines)}


def problem(root):
    """What is wrong; empty if nothing is."""
    (version, hashes), (before, known) = parts(root), kept(root)
    changed = sorted(name for name in hashes.keys() | known.keys() if hashes.get(name) != known.get(name))
    if version < before:
        return f'{TAG}: found sdk_version {version}; allowed is {before} or more, as in {KEPT}'
    if changed and version == before:
        return '\n  '.join([f'what is compiled into plugins changed, and the SDK version is still {version}:', *changed,
                            f'raise sdk_version in {TAG} to {version + 1}, then run: tests/house/sdk_version.py --renew .'])
    if (root / KEPT).read_text(encoding='utf-8') != text_of(version, hashes):
        return f'{KEPT} is not that of SDK version {version}\n  run: tests/house/sdk_version.py --renew .'
    return ''


def renew(root):
    """Writes the file. Returns what forbids it: a version that was not raised."""
    version, hashes = parts(root)
    if (root / KEPT).exists():
        before, known = kept(root)
        if version < before or version == before and hashes != known:
            return problem(root)
    (root / KEPT).write_text(text_of(version, hashes), encoding='utf-8')
    return ''


def self_test(root):
    """Each change alone, in a copy."""
    header, script = HEADERS / 'engine.hpp', OPTIONS[0]
    raised = (TAG, VERSION.pattern, lambda found: str(int(found.group()) + 1))
    cases = [
        # what, changes as (file, pattern, replacement), part of the message; '' if none is expected
        ('a comment', [(header, r'\A', '// Another comment\n/* and\n one */\n')], ''),
        ('a comment behind code', [(header, r'double damping = 0;', r'\g<0>  // another')], ''),
        ('blank space', [(header, r'(?<=\S) (?=\S*\(\))', '\n      ')], ''),
        ('a contract for tests', [(HEADERS / 'testing/engine.hpp', r'\Z', 'int more;\n')], ''),
        ('a command for tests', [(OPTIONS[1], r'\Z', 'target_compile_options(grit_testing PRIVATE -O2)\n')], ''),
        ('a member', [(header, r'double damping = 0;', r'\g<0> double more = 0;')], str(header)),
        ('a default', [(header, r'double damping = 0;', 'double damping = 1;')], str(header)),
        ('a virtual function', [(header, r'virtual ~Engine', 'virtual void more() {}\n  \\g<0>')], str(header)),
        ('blank space in a text', [(TAG, r'"clang "', '"clang  "')], str(TAG)),
        ('the end of a directive', [(TAG, r'#else\n', '#else ')], str(TAG)),
        ('a new header', [(HEADERS / 'more.hpp', r'\A', 'int more;\n')], 'more.hpp'),
        ('an option of the compiler', [(script, r'-fno-math-errno', '-fmath-errno')], f'{script} (options)'),
        ('a raised version alone', [raised], 'run: tests/house/sdk_version.py --renew .'),
        ('a raised version with a member', [raised, (header, r'double damping = 0;', r'\g<0> double more = 0;')],
         'run: tests/house/sdk_version.py --renew .'),
        ('a lower version', [(TAG, VERSION.pattern, '1')], 'found sdk_version 1; allowed is'),
        ('a file of another branch', [(KEPT, r'^(\d+) \w+', r'\1 0123456789abcdef')], 'is not that of SDK version'),
    ]
    wrong = []
    for what, changes, message in cases:
        with tempfile.TemporaryDirectory() as place:
            copy = Path(place)
            shutil.copytree(root / HEADERS, copy / HEADERS)
            for name in (*OPTIONS, KEPT):
                (copy / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(root / name, copy / name)
            for name, pattern, replacement in changes:
                file = copy / name
                old = file.read_text(encoding='utf-8') if file.exists() else ''
                new = re.sub(pattern, replacement, old, count=1)
                if new == old:
                    wrong.append(f'{what}: nothing to change in {name}')
                file.write_text(new, encoding='utf-8')
            found = problem(copy)
            if message not in found or bool(message) != bool(found):
                wrong.append(f'{what}: expected "{message}", found "{found}"')
            is_raised = raised in changes
            refused = renew(copy)
            if bool(refused) != (bool(message) and not is_raised and 'branch' not in what):
                wrong.append(f'{what}: --renew: "{refused}"')
            if not refused and problem(copy):
                wrong.append(f'{what}: still wrong after --renew: {problem(copy)}')
    if problem(root):
        wrong.append('the tree itself is wrong: run without --self-test')
    if not wrong:
        print(f'self-test: {len(cases)} changes as expected')
    return '\n'.join(wrong)


def main():
    work = {'--renew': renew, '--self-test': self_test}.get(sys.argv[1], problem)
    wrong = work(Path(sys.argv[-1]))
    if wrong:
        print(wrong)
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
