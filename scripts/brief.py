"""Short versions of descriptions, and markers in pages, for faults.py and restarts.py."""
import json
import subprocess
from datetime import date

LIMIT = '1 h'                                            # of a stage that ends after steps


def expanded(grit, description, sets=()):
    """The whole description as JSON, with absolute paths. Throws ValueError with grit's message."""
    words = [grit, 'expand', description, *(word for one in sets for word in ('--set', one))]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ValueError(f'{description}: exit status {done.returncode}: {done.stderr.strip()}')
    return json.loads(done.stdout)


def shorten(description, steps):
    """Ends stages after steps: those of a list, which has one number for each stage, or None to keep its condition; or the same
    number for all. Nothing else ends them or the run."""
    stages = description['stages']
    if isinstance(steps, int):
        steps = [steps] * len(stages)
    if len(steps) != len(stages):
        raise ValueError(f'{len(steps)} numbers of steps for {len(stages)} stages: {", ".join(stage["name"] for stage in stages)}')
    for stage, count in zip(stages, steps):
        stage.pop('expect', None)
        if count is not None:
            stage['until'] = {'type': 'steps', 'value': count}
            stage['limit'] = LIMIT
    return description


def set_output(description, **values):
    output = description.setdefault('output', {})
    output.pop('picture', None)
    output.pop('summary', None)
    output.update(values)
    return description


# ---- tables in pages

def rows_of(text, name):
    """The rows between the markers of a table, by their first column."""
    begin, end = markers(name)
    if begin not in text or end not in text:
        raise ValueError(f'the page has no markers {begin} and {end}')
    lines = text[text.index(begin):text.index(end)].splitlines()
    rows = [[cell.strip() for cell in line.strip('|').split('|')] for line in lines if line.startswith('|')]
    return {row[0]: row for row in rows[2:]}             # after the head


def markers(name):
    return f'<!-- {name} -->', f'<!-- end of {name} -->'


def with_table(text, name, head, rows, order):
    """The page with its table replaced. Rows that are not given stay as they are; `order` has the first columns."""
    known = rows_of(text, name) | {str(row[0]): [str(cell) for cell in row] for row in rows}
    names = [one for one in order if one in known] + sorted(known.keys() - set(order))
    begin, end = markers(name)
    return text[:text.index(begin)] + begin + '\n' + table(head, [known[one] for one in names]) + text[text.index(end):]


def table(head, rows):
    lines = [head, ['---'] * len(head), *rows]
    return ''.join('| ' + ' | '.join(str(cell) for cell in line) + ' |\n' for line in lines)


def today():
    return date.today().isoformat()
