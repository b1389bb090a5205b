"""Files and folders of the tree that pages link to, as pages of the site: text with colours, lists of folders. Others are copied as they are.

Headers of the SDK are linked to Doxygen's pages if `sdk_tags` names its tag file, which lies beside them.
"""
import functools
import posixpath
import shutil
import xml.etree.ElementTree
from html import escape
from pathlib import Path

from docutils import nodes
from pygments.lexers import get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx import addnodes
from sphinx.util.osutil import relative_uri

HEADERS = 'core/include/grit'
COPIED = {'.html', '.csv', '.png', '.svg', '.stl', '.gz', '.h5'}
LANGUAGES = {'CMakeLists.txt': 'cmake'}


def is_shown(path):
    """Whether a file or folder is one of the sources: none that a run or an editor left there."""
    return not path.name.startswith(('.', '__')) and path.suffix != '.pyc'


class Files:
    """What is linked, by its path in the tree."""

    def __init__(self, root, tags):
        self.root, self.linked, self.sdk = Path(root), set(), {}
        if tags:
            self.sdk = {HEADERS: 'sdk/index.html'}
            for compound in xml.etree.ElementTree.parse(tags).iter('compound'):
                if compound.get('kind') == 'file':
                    header = Path(compound.findtext('path'), compound.findtext('name')).relative_to(self.root)
                    self.sdk[str(header)] = 'sdk/' + compound.findtext('filename')

    def address(self, path):
        """Where a file or folder is on the site."""
        if path in self.sdk:
            return self.sdk[path]
        if (self.root / path).is_dir():
            readme = f'{path}/README'
            return f'{readme}.html' if (self.root / f'{readme}.md').is_file() else f'{path}/index.html'
        if path.endswith('.md'):
            return path[:-len('.md')] + '.html'
        return path if Path(path).suffix in COPIED else f'{path}.html'

    def add(self, path):
        """Notes a file or folder, with what a list of it links to."""
        if path in self.linked or path in self.sdk or path.endswith('.md'):
            return
        full = self.root / path
        if full.is_dir():
            if (full / 'README.md').is_file():
                return
            for entry in full.iterdir():
                if is_shown(entry):
                    self.add(f'{path}/{entry.name}')
        self.linked.add(path)

    def list_of(self, path):
        """A folder as HTML."""
        entries = sorted((entry for entry in (self.root / path).iterdir() if is_shown(entry)), key=lambda entry: (entry.is_file(), entry.name))
        here = self.address(path)
        items = ''.join(f'<li><a href="{escape(relative_uri(here, self.address(f"{path}/{entry.name}")))}"><code>'
                        f'{escape(entry.name)}{"/" if entry.is_dir() else ""}</code></a></li>' for entry in entries)
        return f'<ul class="files">{items}</ul>'


@functools.lru_cache
def language(kind):
    """The name of Pygments' lexer for files of a kind, which is the end of their names or all of it."""
    try:
        return LANGUAGES.get(kind) or get_lexer_for_filename(f'x{kind}').aliases[0]
    except ClassNotFound:
        return 'text'


def begin(app):
    app.env.files = Files(app.srcdir, app.config.sdk_tags)


def link(app, tree):
    """Resolves links to files and folders before Sphinx copies the former as downloads and misses the latter."""
    files, page = app.env.files, app.env.docname
    for node in [*tree.findall(addnodes.download_reference), *tree.findall(addnodes.pending_xref)]:
        if node.get('reftype') != 'myst':
            continue
        path = posixpath.normpath(posixpath.join(posixpath.dirname(page), node['reftarget']))
        full = files.root / path
        if '#' in path or path.startswith('..') or not (full.is_dir() or full.is_file() and full.suffix != '.md'):
            continue
        files.add(path)
        uri = relative_uri(app.builder.get_target_uri(page), files.address(path))
        node.replace_self(nodes.reference('', '', *node.children, internal=True, refuri=uri))


def write(app):
    """Yields the pages of what was linked."""
    files = app.env.files
    for path in sorted(files.linked):
        source, address = files.root / path, files.address(path)
        if not address.endswith('.html') or address == path:
            target = Path(app.outdir) / address
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
            continue
        body = files.list_of(path) if source.is_dir() else app.builder.highlighter.highlight_block(
            source.read_text(encoding='utf-8'), language(source.suffix if source.suffix != '.txt' else source.name), force=True, location=path)
        folder, name = posixpath.split(path)
        above = f'<a href="{relative_uri(address, files.address(folder))}">{escape(folder)}</a>' if folder in files.linked else escape(folder)
        title = f'<h1 class="path">{above}/<wbr>{escape(name)}</h1>' if folder else f'<h1 class="path">{escape(name)}</h1>'
        yield address[:-len('.html')], {'title': path, 'body': title + body}, 'page.html'


def open_at_root(app, error):
    """The first page is the README; a folder on a server, and a reader of files, open index.html."""
    if not error:
        shutil.copyfile(Path(app.outdir) / f'{app.config.root_doc}.html', Path(app.outdir) / 'index.html')


def setup(app):
    app.add_config_value('sdk_tags', '', 'env')
    app.connect('builder-inited', begin)
    app.connect('doctree-read', link, priority=400)     # before Sphinx collects downloads
    app.connect('html-collect-pages', write)
    app.connect('build-finished', open_at_root)
    return {'parallel_read_safe': False}
