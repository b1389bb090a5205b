"""usage: test_site.py ROOT [what unittest takes]

The site that scripts/site.sh builds: no warning, every page in the navigation, links that lead somewhere, nothing from the network; and that faults
of pages are noticed. Exit status 77 where a tool is missing.
"""
import html
import importlib.util
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

ROOT = pathlib.Path(sys.argv[1]).resolve()
MISSING = [name for name in ('sphinx', 'myst_parser', 'furo', 'sphinx_copybutton') if importlib.util.find_spec(name) is None] + [
    name for name in ('doxygen', '/usr/share/doxygen-awesome-css/doxygen-awesome.css') if shutil.which(name) is None and not pathlib.Path(name).is_file()]
if MISSING:
    print(f'skipped: no {", ".join(MISSING)} (scripts/install-deps.sh --site)')
    sys.exit(77)


class Page:
    """What a page links to and loads, its anchors, and the links of its navigation."""

    def __init__(self, path):
        text = path.read_text(encoding='utf-8', errors='replace')
        self.links = self.values('a', 'href', text)
        self.loads = self.values('(?:img|script|iframe|source|video)', 'src', text) + self.values('link', 'href', text)
        self.anchors = set(re.findall(r'<[^<>]+ (?:id|name)="([^"]+)"', text))
        self.navigation = self.values('a', 'href', text.partition('class="sidebar-tree"')[2].partition('</aside>')[0])

    @staticmethod
    def values(tag, name, text):
        return [html.unescape(value) for value in re.findall(f'<{tag}\\s(?:[^<>]*\\s)?{name}="([^"]*)"', text)]


def build(root, folder):
    return subprocess.run([root / 'scripts/site.sh', folder], capture_output=True, text=True, check=False)


class WholeSite(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(place.cleanup)
        cls.site = pathlib.Path(place.name).resolve() / 'site'
        done = build(ROOT, cls.site)
        cls.said = done.stdout + done.stderr
        cls.status = done.returncode
        cls.pages = {path: Page(path) for path in cls.site.rglob('*.html')}

    def setUp(self):
        self.assertEqual(self.status, 0, self.said)

    def test_there_is_no_warning(self):
        self.assertEqual(self.said, f'site: {self.site}/index.html\n')

    def test_all_pages_are_in_the_navigation(self):
        listed = {link.partition('#')[0] for link in self.pages[self.site / 'index.html'].navigation}
        wanted = {str(page.relative_to(ROOT).with_suffix('.html')) for page in [*ROOT.glob('docs/**/*.md'), *ROOT.glob('plugins/**/*.md')]}
        self.assertGreater(len(wanted), 90)
        self.assertEqual(listed, wanted | {'CHANGELOG.html', 'CONTRIBUTING.html', 'bench/README.html'})

    def test_links_lead_somewhere(self):
        broken, checked = [], 0
        for path, page in self.pages.items():
            for link in set(page.links + page.loads):
                url = urllib.parse.urlsplit(link)
                target = (path.parent / urllib.parse.unquote(url.path)).resolve() if url.path else path
                if url.scheme:
                    continue
                checked += 1
                known = self.pages.get(target)
                # Doxygen writes the anchors of letters in lists by scripts.
                anchor = urllib.parse.unquote(url.fragment) if known and 'sdk' not in path.parts else ''
                if not target.is_file() or anchor and anchor not in known.anchors:
                    broken.append(f'{path.relative_to(self.site)}: {link}')
        self.assertEqual(broken, [])
        self.assertGreater(checked, 10000)

    def test_nothing_comes_from_the_network(self):
        loads = {load for page in self.pages.values() for load in page.loads if urllib.parse.urlsplit(load).scheme not in ('', 'data', 'javascript')}
        loads |= {str(style) for style in self.site.rglob('*.css') if 'url(http' in style.read_text(encoding='utf-8') or '@import' in style.read_text(encoding='utf-8')}
        self.assertEqual(loads, set())

    def test_scripts_and_colours_work_on_pages_read_from_files(self):
        script = (self.site / '_static/scripts/furo.js').read_text(encoding='utf-8')
        self.assertNotRegex(script, '(?m)^(import|export) ')
        self.assertIn('root.Gumshoe = factory(root)', script)
        self.assertRegex((self.site / '_static/styles/furo.css').read_text(encoding='utf-8'),
                         r'prefers-color-scheme: dark\) \{ body:not\(\[data-theme="light"\]\) \{[^}]*--color-background-primary: #131416')

    def test_headers_are_those_of_doxygen(self):
        guide = self.site / 'docs/plugins/README.html'
        self.assertIn('../../sdk/index.html', self.pages[guide].links)
        self.assertIn('sdk/testing_2probe_8hpp.html', self.pages[self.site / 'CONTRIBUTING.html'].links)
        self.assertIn('../docs/plugins/probe.html', self.pages[self.site / 'sdk/index.html'].links)

    def test_pages_are_written_as_they_are_read(self):
        law = (self.site / 'plugins/contacts/linear-rolling/README.html').read_text(encoding='utf-8')
        self.assertIn('F<sub>n</sub> = max(0, K<sub>n</sub> δ', law)
        self.assertIn('<span class="pre">shear_x,</span>', law)
        reference = (self.site / 'docs/reference/contact.html').read_text(encoding='utf-8')
        self.assertRegex(reference, r'<td><p><code[^>]*><span class="pre">friction_angle</span></code></p></td>\s*<td><p>phi</p></td>')
        self.assertIn('<span class="nt">&quot;stages&quot;</span>', (self.site / 'sims/heap/quick.json.html').read_text(encoding='utf-8'))


class Faults(unittest.TestCase):
    """A small tree, in which each fault is planted."""

    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.root = pathlib.Path(place.name).resolve()
        for part in ('docs/site', 'docs/plugins/Doxyfile', 'scripts/site.sh', 'CMakeLists.txt'):
            copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
            (self.root / part).parent.mkdir(parents=True, exist_ok=True)
            copy(ROOT / part, self.root / part)
        self.write('core/include/grit/probe.hpp', '/// @file\n/// Probes.\n\nnamespace grit {\n/// A probe.\nstruct Probe {};\n}\n')
        self.write('docs/site/sdk.dox', '/** @mainpage Headers\n See @ref grit/probe.hpp.\n\n @namespace grit\n The SDK.\n*/\n')
        self.write('README.md', '# Small\n[Index](docs/README.md), [a file](sims/one.json), [a folder](sims).\n')
        self.write('docs/README.md', '# Index\n1. [README](../README.md)\n2. [Page](page.md)\n3. [More](#more)\n\n## More\n- [Other](other.md)\n')
        self.write('docs/page.md', '# Page\n## A part\n[Here](#a-part), [there](other.md#b-part), [header](../core/include/grit/probe.hpp).\n')
        self.write('docs/other.md', '# Other\n## B part\nText.\n')
        self.write('sims/one.json', '{}\n')

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding='utf-8')

    def test_a_tree_without_faults_is_built_and_built_again(self):
        for _ in range(2):
            done = build(self.root, self.root / 'site')
            self.assertEqual((done.returncode, done.stderr), (0, ''))
        self.assertTrue((self.root / 'site/sims/one.json.html').is_file())

    def test_faults_are_named(self):
        gone = ['gone.md', '../sims/gone.json', '../gone', '#gone-part', 'other.md#gone-there', 'gone.png']
        links = '\n\n'.join(f'{"!" if name.endswith("png") else ""}[gone]({name})' for name in gone)
        self.write('docs/page.md', f'# Page\n{links}\n### Too deep\n```jsn\n{{}}\n```\n')
        self.write('docs/unlisted.md', '# Unlisted\n')
        self.write('docs/README.md', (self.root / 'docs/README.md').read_text(encoding='utf-8') + '\n## Unlisted section\n- [Other](other.md)\n')
        done = build(self.root, self.root / 'site')
        self.assertNotEqual(done.returncode, 0)
        self.assertFalse((self.root / 'site').exists())
        for wanted in [*(f'docs/page.md:{2 + 2 * number}: .* (docs/)?{re.escape(name)}\n' for number, name in enumerate(gone)), 'docs/page.md:13: .*H1 to H3',
                       "docs/page.md:14: .*'jsn'", "docs/unlisted.md: .*isn't included in any toctree", 'docs/README.md: .*section "Unlisted section" is missing']:
            self.assertRegex(done.stderr, wanted)

    def test_warnings_of_doxygen_fail(self):
        header = self.root / 'core/include/grit/probe.hpp'
        self.write('core/include/grit/probe.hpp', header.read_text(encoding='utf-8') + '\n/// See @ref nowhere.\nstruct Planted {};\n')
        done = build(self.root, self.root / 'site')
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('nowhere', done.stderr)

    def test_a_folder_that_is_no_site_is_kept(self):
        self.write('mine/notes.txt', 'mine')
        done = build(self.root, self.root / 'mine')
        self.assertEqual(done.returncode, 1)
        self.assertIn('is not empty and no site; name another folder', done.stderr)
        self.assertTrue((self.root / 'mine/notes.txt').is_file())


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
