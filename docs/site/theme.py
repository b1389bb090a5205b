"""Completes Furo as Debian 12 has it: its scripts and styles were not bundled, so that they work on no page that is read from a file."""
import re
from pathlib import Path

NORMALIZE = Path('/usr/share/javascript/normalize.css/normalize.css')
DARK = re.compile(r'body\[data-theme="dark"\] (\{[^}]*\})')


def edit(path, change):
    path.write_text(change(path.read_text(encoding='utf-8')), encoding='utf-8')


def complete_style(text):
    """Includes the style that is loaded from the root of a server, and adds the dark colours of readers who prefer them."""
    text = text.replace('@import url(/javascript/normalize.css/normalize.css);', NORMALIZE.read_text(encoding='utf-8'))
    return text + f'\n@media screen and (prefers-color-scheme: dark) {{ body:not([data-theme="light"]) {DARK.search(text)[1]} }}\n'


def complete(app, error):
    static = Path(app.outdir) / '_static'
    if error:
        return
    edit(static / 'styles/furo.css', complete_style)
    # Browsers load no modules from files.
    part = (static / 'scripts/gumshoe-patched.js').read_text(encoding='utf-8')
    edit(static / 'scripts/furo.js', lambda text: text.replace('import Gumshoe from "./gumshoe-patched.js";', part))


def setup(app):
    app.connect('build-finished', complete)
    return {'parallel_read_safe': False}
