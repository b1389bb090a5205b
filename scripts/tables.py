#!/usr/bin/env python3
"""Tables in pages, between the markers <!-- NAME --> and <!-- end of NAME -->. Rows have names, in their first column.

  tables.py PAGE NAME CELL…     replaces the row whose name is the first cell, or adds it; a cell of today's date follows

Exit status: 0 written; 1 the page has no such table; 2 wrong use.
"""
import sys
from datetime import date
from pathlib import Path


def lines_of(text, name):
    """The lines of a table as lists of cells: the head, the rule under it, rows."""
    begin, end = markers(name)
    if begin not in text or end not in text:
        raise ValueError(f'the page has no markers {begin} and {end}')
    lines = text[text.index(begin):text.index(end)].splitlines()
    return [[cell.strip() for cell in line.strip('|').split('|')] for line in lines if line.startswith('|')]


def rows_of(text, name):
    """The rows of a table, by their first column."""
    return {row[0]: row for row in lines_of(text, name)[2:]}


def markers(name):
    return f'<!-- {name} -->', f'<!-- end of {name} -->'


def with_table(text, name, head, rows, order):
    """The page with its table replaced. Rows that are not given stay as they are; `order` has the first columns."""
    known = rows_of(text, name) | {str(row[0]): [str(cell) for cell in row] for row in rows}
    names = [one for one in order if one in known] + sorted(known.keys() - set(order))
    begin, end = markers(name)
    return text[:text.index(begin)] + begin + '\n' + table(head, [known[one] for one in names]) + text[text.index(end):]


def with_row(text, name, row):
    """The page with one row replaced, or added at the end."""
    head, _, *rows = lines_of(text, name)
    if len(head) != len(row):
        raise ValueError(f'found {len(row)} cells, {", ".join(row)}; the table {name} has {len(head)}: {", ".join(head)}')
    return with_table(text, name, head, [row], [one[0] for one in rows])


def table(head, rows):
    lines = [head, ['---'] * len(head), *rows]
    return ''.join('| ' + ' | '.join(str(cell) for cell in line) + ' |\n' for line in lines)


def today():
    return date.today().isoformat()


def main(words):
    if len(words) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    page, name, *row = words
    try:
        text = Path(page).read_text(encoding='utf-8')
        Path(page).write_text(with_row(text, name, [*row, today()]), encoding='utf-8')
    except (OSError, ValueError) as error:
        print(f'tables: {page}: {error}', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
