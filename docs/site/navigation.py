"""The navigation of the site, read from the page docs/README.md, so that it cannot differ from it.

Its ordered list gives the entries: the first link of an item is an entry and the others are its children; where it is an anchor, its children
are the links of that section. A README adds the pages of its folder that it links to, a page of the reference those of plugins. Sphinx warns
of pages that none of these reach.
"""
import posixpath
from dataclasses import dataclass, field
from html import escape
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode
from sphinx.util import logging

INDEX = 'docs/README'


@dataclass
class Entry:
    """A line of the navigation: a page, or a section of the index."""
    page: str
    label: str = ''                                     # the title of the page if empty
    anchor: str = ''
    children: list = field(default_factory=list)

    def walk(self):
        yield self
        for child in self.children:
            yield from child.walk()


def text_of(node):
    return ''.join(inner.content for inner in node.walk() if inner.type in ('text', 'code_inline'))


def slug(heading):
    """The anchor of a heading on GitHub."""
    return ''.join(letter for letter in heading.lower().replace(' ', '-') if letter.isalnum() or letter in '-_')


class Reader:
    """Pages of a tree, and what they link to."""

    def __init__(self, root):
        self.root, self.markdown = Path(root), MarkdownIt('commonmark').enable('table')

    def tree(self, page):
        return SyntaxTreeNode(self.markdown.parse((self.root / f'{page}.md').read_text(encoding='utf-8')))

    def links(self, page, node):
        """Entries of the pages of this tree, and of the anchors of this page, that a node links to."""
        for link in (inner for inner in node.walk() if inner.type == 'link'):
            target, _, anchor = link.attrs['href'].partition('#')
            path = posixpath.normpath(posixpath.join(posixpath.dirname(page), target)) if target else f'{page}.md'
            if path.endswith('.md') and (self.root / path).is_file():
                label = text_of(link)
                yield Entry(path[:-len('.md')], label if '.' in label else label[:1].upper() + label[1:], '' if target else anchor)


def entries(root):
    """The navigation of the tree at a root."""
    reader = Reader(root)
    items, sections, current = [], {}, None
    for node in reader.tree(INDEX).children:
        if node.type == 'heading':
            current = sections.setdefault(slug(text_of(node)), [])
        elif node.type == 'ordered_list':
            items += [list(reader.links(INDEX, item)) for item in node.children]
        else:
            current += [link for link in reader.links(INDEX, node) if not link.anchor]

    top = []
    for first, *others in (item for item in items if item):
        first.children = sections.get(first.anchor, []) if first.anchor else others
        top.append(first)
    known = {entry.page for first in top for entry in first.walk()} | {INDEX}
    for entry in [entry for first in top for entry in first.walk() if not entry.anchor]:
        entry.children += [Entry(page) for page in indexed(reader, entry.page) if page not in known]
    return top


def indexed(reader, page):
    """Pages that a listed page adds, being an index itself."""
    folder, name = posixpath.split(page)
    if folder == 'docs/reference':
        below = 'plugins/'
    elif name == 'README' and folder.startswith('docs/'):
        below = f'{folder}/'
    else:
        return []
    return dict.fromkeys(link.page for link in reader.links(page, reader.tree(page)) if link.page.startswith(below))


def pages(top):
    """The pages in reading order, each once."""
    return list(dict.fromkeys([INDEX] + [entry.page for first in top for entry in first.walk()]))


def lists(entry_list, pathto, titles, current, depth=1):
    """A list in the markup of Sphinx, and whether the current page is in it."""
    lines, inside = [], False
    for entry in entry_list:
        children, below = lists(entry.children, pathto, titles, current, depth + 1) if entry.children else ('', False)
        here = entry.page == current and not entry.anchor
        inside = inside or here or below
        shown = ' current' if here or below else ''
        label = entry.label or titles[entry.page].astext()
        href = f'{pathto(entry.page).rstrip("#")}#{entry.anchor}' if entry.anchor else pathto(entry.page)
        lines.append(f'<li class="toctree-l{depth}{shown}"><a class="reference internal{" current" if here else ""}" href="{href}">'
                     f'{escape(label)}</a>{children}</li>')
    return f'<ul{" class=current" if inside else ""}>{"".join(lines)}</ul>', inside


def read(app):
    app.env.navigation = [entry for entry in entries(app.srcdir) if entry.page != app.config.root_doc]


def add_toctree(app, page, source):
    """Previous and next page follow the navigation."""
    if page == app.config.root_doc:
        source[0] += '\n\n```{toctree}\n:hidden:\n\n' + '\n'.join(f'/{each}' for each in pages(app.env.navigation)) + '\n```\n'


def show(app, page, _template, context, _doctree):
    top = [Entry(INDEX), *app.env.navigation]
    # The theme adds the arrows that open and close parts of it.
    context['toctree'] = lambda **_: lists(top, context['pathto'], app.env.titles, page)[0]


def warn_of_sections(app, _env):
    """A section of the index that no item of its list names would have no entry."""
    listed = {entry.anchor for entry in app.env.navigation}
    headings = [text_of(node) for node in Reader(app.srcdir).tree(INDEX).children if node.type == 'heading' and node.tag != 'h1']
    for heading in headings:
        if slug(heading) not in listed:
            logging.getLogger(__name__).warning(f'section "{heading}" is missing in the list on top, as [{heading}](#{slug(heading)})', location=INDEX)


def setup(app):
    app.connect('builder-inited', read)
    app.connect('source-read', add_toctree)
    app.connect('env-check-consistency', warn_of_sections)
    app.connect('html-page-context', show, priority=400)  # before the theme's
    return {'parallel_read_safe': False}
