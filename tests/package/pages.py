#!/usr/bin/env python3
"""Reads the pages of an installation as somebody does who has no source tree: links and paths lead to what is there.

  pages.py PREFIX        of `cmake --install`
  pages.py --deb DEBS    of the Debian packages in a folder
  pages.py --self-test   sees that wrong pages are noticed
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

CODE = re.compile(r'(?ms)^```.*?^```$|`[^`\n]+`')
FOLDERS = r'\.ci|bench|build|cmake|core|docs|plugins|python|scripts|sims|tests'
PATH = re.compile(rf'(?<![\w./~-])(?:\./)?((?:{FOLDERS})/[\w./*+-]*\w)')
ANCHORED = re.compile(r'(?<![\w./~-])(PREFIX|/usr)/([\w./+-]*\w)')
NOTE = re.compile(r'(?m)^> What this page names in (.*?) is in the source tree only\.')


def is_there(folder, path):
    """A path, perhaps with stars. In capitals are words that the reader replaces."""
    return bool(re.search(r'(^|/)[A-Z]+(/|\.|$)', path)) or ('*' in path and any(folder.glob(path))) or (folder / path).exists()


def holds_something(path):
    """Whether there is a file, or a folder with any."""
    return any(path.iterdir()) if path.is_dir() else path.exists()


def faults(prefix, root, page):
    text = page.read_text(encoding='utf-8')
    prose = re.sub(r'(?ms)^```.*?^```$', '', text)
    for target in re.findall(r'\]\(([^)#]+)(?:#[^)]*)?\)', prose):
        if not re.match('[a-z]+:', target) and not holds_something(page.parent / target):
            yield f'a link to {target}, which is not there'
    for program in re.findall(r'build/bin/grit\b', text):
        yield f'{program}, which is in a source tree only'
    for mark in re.findall(r'<!-- (?:in the source tree|installed).*|@[A-Z_]+@', text):
        yield f'{mark}, which is for the installation'
    noted = re.findall('`(.*?)`', ''.join(NOTE.findall(text)))
    for code in CODE.findall(NOTE.sub('', text)):
        for path in PATH.findall(code):
            own = page.is_relative_to(root / 'docs/plugins') and path == 'build/lib/grit'  # of the reader's project
            if not own and not is_there(root, path) and not any((path + '/').startswith(folder + '/') for folder in noted):
                yield f'{path}, which is not there and not told to be in the source tree'
        for begin, path in ANCHORED.findall(code):
            if (begin == 'PREFIX' or path.startswith('share/')) and not (prefix / path).exists():
                yield f'{begin}/{path}, which is not there'


def check(prefix):
    """The number of faults."""
    root = prefix / 'share/doc/grit'
    pages = sorted(root.rglob('*.md'))
    if len(pages) < 100:
        print(f'{root}: {len(pages)} pages')
        return 1
    found = [f'{page.relative_to(root)}: {fault}' for page in pages for fault in faults(prefix, root, page)]
    print('\n'.join(found or [f'{len(pages)} pages']))
    return len(found)


def self_test():
    wrong = ['[a](nothing.md)', '[a](empty)', '[a](docs/nothing.md#part)', '```sh\nbuild/bin/grit run x.json\n```', 'the program `build/bin/grit`',
             '`sims/nothing.json`', '`sims/a/full*.json`', '```\nscripts/x.sh --all\n```', '`build/lib/grit`', '@PREFIX@', '<!-- installed:',
             '`PREFIX/share/nothing`', '```sh\ncp /usr/share/nothing .\n```',
             '> What this page names in `tests` is in the source tree only.\n\n`scripts/x.sh`']
    right = ['[a](docs/a.md#part) [b](https://example.org) [c](#d)', '```cpp\nauto f = [this](int a) {};\n```', '`grit run sims/a/quick.json`',
             '`sims/a/q*.json`, `sims/…/x`, `sims/NAME.json`', '`PREFIX/share/doc/grit`, `/usr/share/doc/grit`, `/usr/bin/env`',
             '> What this page names in `scripts` is in the source tree only.\n\n`scripts/x.sh`', '~/grit/build/x `include/grit/testing/x`']
    failed = 0
    with tempfile.TemporaryDirectory() as place:
        root = Path(place) / 'share/doc/grit'
        for file in ('docs/a.md', 'sims/a/quick.json'):
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).touch()
        (root / 'empty').mkdir()
        page = root / 'page.md'
        for text, expected in [(text, True) for text in wrong] + [(text, False) for text in right]:
            page.write_text(f'# Title\n\n{text}\n', encoding='utf-8')
            found = list(faults(Path(place), root, page))
            if bool(found) != expected:
                print('not noticed:' if expected else f'{found}:', text)
                failed += 1
    return failed


def main():
    if sys.argv[1] == '--self-test':
        return self_test()
    if sys.argv[1] != '--deb':
        return check(Path(sys.argv[1]))
    with tempfile.TemporaryDirectory() as place:
        for package in Path(sys.argv[2]).glob('*.deb'):
            subprocess.run(['dpkg-deb', '-x', package, place], check=True)
        return check(Path(place) / 'usr')


if __name__ == '__main__':
    sys.exit(main() != 0)
