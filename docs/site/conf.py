"""Settings of the documentation as a site: Sphinx reads the pages of the whole tree as they are. scripts/site.sh builds it."""
import gc
import re
import sys
from pathlib import Path

from pygments.lexers import JsonLexer, PythonLexer, TextLexer
from pygments.token import Error, Punctuation

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.dont_write_bytecode = True
gc.disable()  # a seventh of the time goes into searching trees of pages for garbage, of which there is little
sys.path.insert(0, str(HERE))

project = 'grit'
release = re.search(r'^project\(grit VERSION (\S+)', (ROOT / 'CMakeLists.txt').read_text(encoding='utf-8'), re.M)[1]
root_doc = 'README'
include_patterns = ['**.md']
exclude_patterns = ['build*', 'results*', '.*']

extensions = ['myst_parser', 'sphinx_copybutton', 'navigation', 'files', 'typography', 'theme']
myst_heading_anchors = 6                                # those of GitHub
smartquotes = False

html_theme = 'furo'
html_title = f'grit {release}'
html_static_path = ['site.css']
html_css_files = ['site.css']
html_copy_source = False
html_show_copyright = False
html_domain_indices = False
html_use_index = False
highlight_language = 'text'
pygments_style = 'friendly'
pygments_dark_style = 'monokai'
copybutton_selector = 'div.highlight:not(.highlight-text *) > pre'


class Excerpt(JsonLexer):
    """JSON in which … stands for what is left out."""

    def get_tokens_unprocessed(self, text):
        for place, kind, value in super().get_tokens_unprocessed(text):
            yield place, Punctuation if kind is Error and set(value) == {'…'} else kind, value


def setup(app):
    app.add_lexer('json', Excerpt)
    app.add_lexer('pvpython', PythonLexer)
    app.add_lexer('stl', TextLexer)
