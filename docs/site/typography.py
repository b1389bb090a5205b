"""What plain text cannot show: indices as F_n below the line, and the tables that `grit describe` prints as tables."""
import re

from docutils import nodes

# A letter, also with a dot above or a d before it; what follows _ is the index. Longer names, and all code, are left alone.
INDEX = re.compile(r'(?<![^\W\d])(d?[^\W\d_][\u0300-\u036f]?)_([^\W_²³]+)(?![^\W²³])')
KEPT = (nodes.literal, nodes.literal_block, nodes.image, nodes.comment, nodes.title)


def is_in(node, kinds):
    while node.parent is not None:
        node = node.parent
        if isinstance(node, kinds):
            return True
    return False


def lower_indices(text):
    """Nodes of a text."""
    place = 0
    for found in INDEX.finditer(text):
        yield nodes.Text(text[place:found.end(1)])
        yield nodes.subscript('', found[2])
        place = found.end()
    yield nodes.Text(text[place:])


def cells(line, starts):
    """The columns of a line, or None if a word crosses the start of one."""
    if any(start < len(line) and line[start - 1] != ' ' for start in starts[1:]):
        return None
    return [line[start:end].rstrip() for start, end in zip(starts, [*starts[1:], None])]


def table_of(rows):
    """A table of rows of text, the first of which is its head; columns without a value are left out."""
    used = [number for number, column in enumerate(zip(*rows[1:])) if any(column)]
    group = nodes.tgroup(cols=len(used))
    group += [nodes.colspec(colwidth=1) for _ in used]

    def row_of(row):
        node = nodes.row()
        for number in used:
            # The names of members are indented.
            depth = len(row[number]) - len(row[number].lstrip())
            text = nodes.Text(row[number].strip())
            word = nodes.literal('', '', text) if number == 0 and row is not rows[0] else text
            node += nodes.entry('', nodes.paragraph('', '', nodes.Text('\u2003' * (depth // 2)), word) if row[number] else nodes.paragraph())
        return node
    group += nodes.thead('', row_of(rows[0]))
    group += nodes.tbody('', *[row_of(row) for row in rows[1:]])
    return nodes.table('', group, classes=['parameters'])


def parameters(text):
    """Nodes of what `grit describe` prints, None if it is laid out otherwise."""
    shown = []
    for part in text.split('\n\n'):
        lines = part.splitlines()
        head = next((number for number, line in enumerate(lines) if re.match(r'name  .*unit or type', line)), len(lines))
        if head:
            shown.append(nodes.paragraph('', ' '.join(lines[:head])))
        if head < len(lines):
            starts = [found.start() for found in re.finditer(r'\S+(?: \S+)*', lines[head])]
            rows = [cells(line, starts) for line in lines[head:]]
            if None in rows:
                return None
            shown.append(table_of(rows))
    return shown


def improve(app, tree):
    for node in list(tree.findall(nodes.Text)):
        if INDEX.search(node) and not is_in(node, KEPT):
            node.parent.replace(node, list(lower_indices(str(node))))
    if app.env.docname.startswith('docs/reference/'):
        for node in list(tree.findall(nodes.literal_block)):
            node.replace_self(parameters(node.astext()) or node)


def setup(app):
    app.connect('doctree-read', improve)
    return {'parallel_read_safe': False}
