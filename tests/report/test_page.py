#!/usr/bin/env python3
"""What a browser makes of a report: every curve is that of series.h5, frames turn, files are saved, nothing is fetched.

usage: test_page.py GRIT     exit status 77 where there is no Chromium or no h5py
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

try:
    import h5py
except ImportError:
    print("skipped: Python's h5py is not installed (Debian: python3-h5py)")
    sys.exit(77)

from browser import Browser, find_chromium

CHROMIUM = find_chromium()
GRIT = None

SCENE = {
    "title": "grains in a <box> & a probe",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"density": 2600, "contact_modulus": "1 MPa", "friction_angle": "30 deg"}},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "grains": {
        "type": "cloud", "low": [0, 0, 0], "high": ["8 mm", "6 mm", "10 mm"], "count": 40,
        "sizes": {"type": "uniform", "smallest": "1 mm", "largest": "1.5 mm"}}}},
    "walls": {"box": {"type": "box", "low": [0, 0, 0], "high": ["8 mm", "6 mm", "12 mm"], "open": ["z_high"], "material": "sand"}},
    "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.2}},
    "stages": [{"name": "fall", "until": {"type": "time", "value": "60 ms"}, "limit": "1 s"}],
    "probes": {"packing": {"type": "packing", "every_time": "1 ms"}, "walls": {"type": "walls", "every_time": "2 ms"}},
    "output": {"frames": {"every_time": "10 ms"},
               "picture": {"x": "packing/time", "y": ["packing/coordination_number"], "color": "rotation", "view": "xz"}},
}
GRAINS = "document.querySelector('figure.grains').grains"
DRAWN = "document.querySelector('figure.grains')?.grains.shownPlaces && document.querySelector('figure.chart[data-drawn]')"


def run(folder, name, **changes):
    scene = json.loads(json.dumps(SCENE))
    scene.update(changes)
    (folder / f"{name}.json").write_text(json.dumps(scene))
    subprocess.run([GRIT, "run", f"{name}.json", "--out", name, "--threads", "1", "--quiet"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="grit-page-")
        cls.folder = pathlib.Path(cls.place.name)
        run(cls.folder, "one")
        run(cls.folder, "two", seed=2)
        subprocess.run([GRIT, "report", "one"], cwd=cls.folder, check=True, stdout=subprocess.DEVNULL)
        subprocess.run([GRIT, "report", "one", "two", "--out", "both.html"], cwd=cls.folder, check=True, stdout=subprocess.DEVNULL)
        cls.browser = Browser(CHROMIUM, timeout=150).__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()
        cls.place.cleanup()

    def setUp(self):
        self.open("one/report.html")

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])
        self.assertEqual(self.browser.requests(), [])

    def open(self, name):
        self.browser.open(self.folder / name)
        self.browser.evaluate("document.querySelector('figure.chart').scrollIntoView({block: 'center'})")  # drawn when seen
        self.browser.wait(DRAWN)

    def press(self, key, text=""):
        for kind in ("keyDown", "keyUp"):
            self.browser.call("Input.dispatchKeyEvent", type=kind, key=key, text=text if kind == "keyDown" else "")

    def saved(self, figure, button):
        """Name and, as text of one letter a byte, content of what a button saves."""
        self.browser.evaluate("save.last = null")
        self.browser.evaluate(f"[...document.querySelector('{figure}').querySelectorAll('button')].find((b) => b.textContent === '{button}').click()")
        self.browser.wait("save.last")
        return self.browser.evaluate("save.last.name"), self.browser.evaluate(
            "save.last.blob.arrayBuffer().then((b) => Array.from(new Uint8Array(b)))")

    def test_every_curve_is_that_of_the_series(self):
        evaluate = self.browser.evaluate
        evaluate("document.querySelectorAll('details.probe').forEach((part) => (part.open = true))")
        self.browser.wait("document.querySelectorAll('details.probe .charts').length === 2")
        compared = 0
        with h5py.File(self.folder / "one/series.h5") as series:
            for probe, group in series.items():
                for name, channel in group.items():
                    if name in ("time", "step"):
                        continue
                    shown = evaluate(f"""(async () => {{
                        const figure = [...document.querySelectorAll('figure.chart')].find(({{chart}}) => chart.group.name === '{probe}' && chart.name === '{name}');
                        await figure.chart.draw();
                        return figure.chart.series.map(({{x, y}}) => [Array.from(x, String), Array.from(y, String)]);
                    }})()""")
                    width = channel[()].reshape(len(channel), -1).shape[1]
                    self.assertEqual(len(shown), width, name)
                    for k, (x, y) in enumerate(shown):
                        expected = channel[()].reshape(len(channel), -1)[:, k]
                        for got, wanted in ((x, group["time"][()]), (y, expected)):
                            self.assertEqual(len(got), len(wanted))
                            for a, b in zip(got, wanted):
                                self.assertTrue(float(a) == b or (a == "NaN" and b != b), f"{probe}/{name}: {a} is not {b}")
                    compared += 1
        self.assertGreater(compared, 15)

    def test_another_abscissa_can_be_chosen(self):
        self.browser.evaluate("""(() => { const choice = document.querySelector('.against select');
            choice.value = 'void_ratio'; choice.dispatchEvent(new Event('change')); })()""")
        self.browser.wait("document.querySelector('figure.chart[data-drawn]')")
        x = self.browser.evaluate("Array.from(document.querySelector('figure.chart').chart.series[0].x, String)")
        with h5py.File(self.folder / "one/series.h5") as series:
            self.assertEqual([float(v) for v in x], list(series["packing/void_ratio"][()]))

    def test_values_are_told_under_the_pointer_and_by_keys(self):
        area = self.browser.evaluate("(({left, right, top, bottom}) => ({left, right, top, bottom}))(document.querySelector('figure.chart').chart.area())")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=(area["left"] + area["right"]) / 2, y=(area["top"] + area["bottom"]) / 2)
        self.browser.wait("document.querySelector('figure.chart .values').textContent")
        told = self.browser.evaluate("document.querySelector('figure.chart .values').textContent")
        place = self.browser.evaluate("document.querySelector('figure.chart').chart.places[0]")
        with h5py.File(self.folder / "one/series.h5") as series:
            time, number = series["packing/time"][()], series["packing/coordination_number"][()]
        self.assertLess(abs(time[place] - (time[0] + time[-1]) / 2), 2.5e-3)
        self.assertIn(f"coordination number {float(f'{number[place]:.4g}'):g}", told)
        self.browser.evaluate("document.querySelector('figure.chart').focus()")
        self.press("ArrowRight")
        self.assertEqual(self.browser.evaluate("document.querySelector('figure.chart').chart.places[0]"), place + 1)

    def test_frames_turn_by_slider_keys_and_play(self):
        last = len(list((self.folder / "one/frames").iterdir())) - 1
        frame = "document.querySelector('.stage').dataset.frame"
        self.assertEqual(self.browser.evaluate(frame), str(last))
        before = self.saved("figure.grains", "PNG")[1]
        self.browser.evaluate("(() => { const slider = document.querySelector('[name=frame]'); slider.value = 2; slider.dispatchEvent(new Event('input')); })()")
        self.browser.wait(f"{frame} === '2'")
        self.assertNotEqual(self.saved("figure.grains", "PNG")[1], before)
        self.browser.evaluate("document.querySelector('.stage').focus()")
        self.press("ArrowLeft")
        self.browser.wait(f"{frame} === '1'")
        self.assertIn("fall · 2/", self.browser.evaluate("document.querySelector('.clock').textContent"))
        self.press(" ", " ")
        self.browser.wait(f"{frame} === '{last}' && !{GRAINS}.playing")

    def test_grains_are_those_of_the_frames(self):
        for number in (0, 3):
            shown = self.browser.evaluate(f"""(async () => {{ const frames = {GRAINS}.frames, frame = await frames.frame({number});
                const list = (values, axis) => Array.from(values, (q) => frames.metres(axis, q));
                return {{time: frame.time, id: [...frame.id], radius: [...frame.radius], position: ['x', 'y', 'z'].map((name, axis) => list(frame[name], axis)),
                         rotation: Array.from(frame.rotation[1], (q) => (q / 65535 * 2 - 1) * frames.json.ranges.rotation),
                         quantum: frames.json.high.map((high, axis) => (high - frames.json.low[axis]) / 65535)}}; }})()""")
            with h5py.File(self.folder / f"one/frames/{number:06}.h5") as frame:
                self.assertEqual(shown["time"], frame.attrs["time"])
                self.assertEqual(shown["id"], list(frame["bodies/id"]))
                for got, wanted in zip(shown["radius"], frame["bodies/radius"]):
                    self.assertAlmostEqual(got, wanted, delta=1e-7 * wanted)
                for axis in range(3):
                    for got, wanted in zip(shown["position"][axis], frame["bodies/position"][:, axis]):
                        self.assertLess(abs(got - wanted), 0.51 * shown["quantum"][axis])
                for got, wanted in zip(shown["rotation"], frame["bodies/rotation"][:, 1]):
                    self.assertLess(abs(got - wanted), 1e-4 * max(abs(frame["bodies/rotation"][:, 1]).max(), 1))

    def test_pictures_and_numbers_are_saved(self):
        name, png = self.saved("figure.grains", "PNG")
        self.assertEqual(name, "one-grains-006.png")
        self.assertEqual(bytes(png[:8]), b"\x89PNG\r\n\x1a\n")
        covered = self.browser.evaluate("""(async () => { const image = await createImageBitmap(save.last.blob), width = Math.round(0.7 * image.width);
            const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
            canvas.drawImage(image, 0, 0);
            const pixels = new Uint32Array(canvas.getImageData(0, 0, width, image.height).data.buffer);
            return pixels.filter((pixel) => pixel !== 0xffffffff).length / pixels.length; })()""")
        self.assertGreater(covered, 0.1, "grains are drawn, not only walls and scales")
        for figure, circles in (("figure.grains", True), ("figure.chart", False)):
            name, svg = self.saved(figure, "SVG")
            root = xml.etree.ElementTree.fromstring(bytes(svg).decode())
            self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
            if circles:
                self.assertGreater(len(root.findall(".//{http://www.w3.org/2000/svg}circle")), 10)
        self.assertEqual(bytes(self.saved("figure.chart", "PNG")[1][:8]), b"\x89PNG\r\n\x1a\n")
        name, csv = self.saved("figure.chart", "CSV")
        self.assertEqual(name, "one-packing-coordination_number.csv")
        lines = bytes(csv).decode().splitlines()
        self.assertEqual(lines[0], '"time [s]","coordination_number"')
        with h5py.File(self.folder / "one/series.h5") as series:
            pairs = zip(series["packing/time"][()], series["packing/coordination_number"][()])
            self.assertEqual([tuple(map(float, line.split(","))) for line in lines[1:]], list(pairs))
        lines = bytes(self.saved("figure.grains", "CSV")[1]).decode().splitlines()
        self.assertEqual(lines[0], "id,x [m],y [m],z [m],radius [m],rotation [°]")
        self.assertEqual(len(lines), 41)

    def test_every_view_and_colour_is_drawn(self):
        seen = set()
        for view in ("xz", "yz", "xy"):
            for colour in ("rotation", "speed", "radius"):
                self.browser.evaluate(f"{GRAINS}.change({{view: '{view}', colour: '{colour}', chains: {str(colour == 'radius').lower()}}})")
                seen.add(bytes(self.saved("figure.grains", "PNG")[1]))
        self.assertEqual(len(seen), 9)

    def test_runs_lie_over_each_other(self):
        self.open("both.html")
        self.assertEqual(self.browser.evaluate("document.querySelector('figure.chart').chart.series.map((one) => one.label)"), ["one", "two"])
        self.assertTrue(self.browser.evaluate("[...document.querySelector('[name=run]').options].map((one) => one.text).join() === 'one,two'"))
        first = self.saved("figure.grains", "PNG")[1]
        self.browser.evaluate("(() => { const choice = document.querySelector('[name=run]'); choice.value = 1; choice.dispatchEvent(new Event('change')); })()")
        self.browser.wait(f"{GRAINS}.now === {GRAINS}.painted && {GRAINS}.state.run === 1")
        name, second = self.saved("figure.grains", "PNG")
        self.assertTrue(name.startswith("two-"))
        self.assertNotEqual(first, second)

    def test_a_phone_and_the_dark_have_it_too(self):
        self.browser.resize(400, 800)
        self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        try:
            self.open("one/report.html")
            self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), 400)
            self.assertEqual(self.browser.evaluate("getComputedStyle(document.body).backgroundColor"), "rgb(23, 24, 26)")
            self.assertIn("#17181a", bytes(self.saved("figure.chart", "SVG")[1]).decode())
        finally:
            self.browser.resize(1400, 1000)
            self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "light"}])

    def test_grains_are_drawn_without_webgl(self):
        script = self.browser.call("Page.addScriptToEvaluateOnNewDocument", source="""
            const context = HTMLCanvasElement.prototype.getContext;
            HTMLCanvasElement.prototype.getContext = function (kind, ...rest) { return kind === 'webgl2' ? null : context.call(this, kind, ...rest); };""")
        try:
            self.open("one/report.html")
            self.assertTrue(self.browser.evaluate(f"{GRAINS}.painter === null"))
            pixels = self.browser.evaluate("""(() => { const {canvas} = document.querySelector('.overlay').getContext('2d');
                return new Set(new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size; })()""")
            self.assertGreater(pixels, 100)
        finally:
            self.browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script["identifier"])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    GRIT = str(pathlib.Path(sys.argv.pop()).resolve())
    if CHROMIUM is None:
        print("skipped: there is no Chromium to open the page with (Debian: chromium)")
        sys.exit(77)
    unittest.main(verbosity=1)
