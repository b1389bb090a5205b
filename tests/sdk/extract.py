#!/usr/bin/env python3
"""Writes the code of pages to files: each block ```LANGUAGE NAME of a page becomes the file NAME.

  extract.py FOLDER PAGE…      exit status 1 if a page has no such block, or two have one name
"""
import re
import sys
from pathlib import Path


def main():
    folder, pages = Path(sys.argv[1]), [Path(page) for page in sys.argv[2:]]
    folder.mkdir(parents=True, exist_ok=True)
    written = set()
    for page in pages:
        blocks = re.findall(r'(?ms)^```\w+ (\S+)\n(.*?)^```$', page.read_text(encoding='utf-8'))
        if not blocks:
            sys.exit(f'{page}: no block with a name')
        for name, text in blocks:
            if name in written:
                sys.exit(f'{page}: a second {name}')
            written.add(name)
            (folder / name).write_text(text, encoding='utf-8')
    print(f'{len(written)} files of {len(pages)} pages')


if __name__ == '__main__':
    sys.exit(main())
