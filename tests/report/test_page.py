#!/usr/bin/env python3
"""A report in a browser: curves equal series.h5, frames are shown, files are saved, nothing is fetched.

usage: test_page.py GRIT     exit status 77 where there is no Chromium or no h5py
"""

import base64
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

from browser import BOX_OF_GRAINS, GRAINS, MAP, Browser, find_chromium, h5py_or_skip, skip, write_scene

h5py = h5py_or_skip()
import numpy  # comes with h5py

CHROMIUM = find_chromium()
GRIT = None

SCENE = {
    **BOX_OF_GRAINS,
    "stages": [{"name": "fall", "until": {"type": "time", "value": "60 ms"}, "limit": "1 s"}],
    "probes": {"packing": {"type": "packing", "every_time": "1 ms"}, "walls": {"type": "walls", "every_time": "2 ms"}},
    "output": {"frames": {"every_time": "10 ms"},
               "picture": {"x": "packing/time", "y": ["packing/coordination_number"], "color": "rotation", "view": "xz"}},
}
LISTS = {"listening": {"type": "spectrum", "region_low": [0, 0, 0], "region_high": ["8 mm", "6 mm", "12 mm"], "interval": "0.2 ms", "points": 64, "every_time": "0.2 ms"},
         "forces": {"type": "force-chains", "every_time": "2 ms"}, "moved": {"type": "displacements", "every_time": "2 ms"}}
SVG = "{http://www.w3.org/2000/svg}"
WINDOW = 1000, 800  # CSS pixels; a larger one takes longer to draw
DRAWN = "document.querySelector('figure.grains')?.grains.shownPlaces && document.querySelector('figure.chart[data-drawn]')"


def run(folder, name, **changes):
    """Results with their page, NAME/report.html."""
    write_scene(folder, name, {**SCENE, **changes})
    subprocess.run([GRIT, "run", f"{name}.json", "--out", name, "--threads", "1", "--quiet"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)


def reads(test):
    """A test that leaves the page of one run as it is, so that the next one need not open it again."""
    test.reads = True
    return test


def opens_pages(test):
    """A test that begins with another page than that of one run."""
    test.opens_pages = True
    return test


def load_tests(loader, *_):
    """Those that share a page are the first."""
    names = loader.getTestCaseNames(Page)
    return unittest.TestSuite(Page(name) for name in sorted(names, key=lambda name: not hasattr(getattr(Page, name), "reads")))


class Page(unittest.TestCase):
    untouched = False  # whether the page of one run is open, as it was when it was opened

    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="grit-page-")
        cls.folder = pathlib.Path(cls.place.name)
        run(cls.folder, "one")
        run(cls.folder, "two", seed=2, probes={"packing": {"type": "packing", "every_time": "3 ms"}, "walls": SCENE["probes"]["walls"]})
        run(cls.folder, "lists", probes=LISTS, output={})
        subprocess.run([GRIT, "report", "one"], cwd=cls.folder, check=True, stdout=subprocess.DEVNULL)
        subprocess.run([GRIT, "report", "one", "two", "--out", "both.html"], cwd=cls.folder, check=True, stdout=subprocess.DEVNULL)
        cls.browser = Browser(CHROMIUM, *WINDOW, timeout=150).__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()
        cls.place.cleanup()

    def setUp(self):
        test = getattr(self, self._testMethodName)
        if not Page.untouched and not hasattr(test, "opens_pages"):
            self.open("one/report.html")
        Page.untouched = hasattr(test, "reads")

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])
        self.assertEqual(self.browser.requests(), [])

    def open(self, name):
        self.browser.open(self.folder / name)
        self.browser.evaluate("document.querySelector('figure.chart').scrollIntoView({block: 'center'})")  # drawn when visible
        self.browser.wait(DRAWN)

    def press(self, key, text=""):
        for kind in ("keyDown", "keyUp"):
            self.browser.call("Input.dispatchKeyEvent", type=kind, key=key, text=text if kind == "keyDown" else "")

    def saved(self, figure, button):
        """Name and content of the file that a button saves."""
        self.browser.evaluate("save.last = null")
        self.browser.evaluate(f"[...document.querySelector('{figure}').querySelectorAll('button')].find((b) => b.textContent === '{button}').click()")
        self.browser.wait("save.last")
        address = self.browser.evaluate("""new Promise((done) => { const reader = new FileReader();
            reader.onload = () => done(reader.result);
            reader.readAsDataURL(save.last.blob); })""")
        return self.browser.evaluate("save.last.name"), base64.b64decode(address.split(",", 1)[1])

    @opens_pages
    def test_linear_chains_are_lines_of_their_own(self):
        # A column of five in contact, of which three carry more than the mean, and two with a weak contact.
        grains = [{"position": ["4 mm", "3 mm", f"{0.5 + 0.99 * k} mm"], "radius": "0.5 mm"} for k in range(5)]
        grains += [{"position": [f"{x} mm", "1 mm", "8 mm"], "radius": "0.5 mm"} for x in (1, 1.999)]
        run(self.folder, "column", bodies={"grains": {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": grains}}},
            stages=[{"name": "stand", "until": {"type": "steps", "value": 2}, "limit": "1 s"}], output={"frames": {"every_steps": 2}},
            probes={"packing": {"type": "packing", "every_steps": 1}, "forces": {"type": "force-chains", "every_steps": 1}})
        self.open("column/report.html")
        lines = f"""(async (name, on) => {{
            const view = {GRAINS};
            await view.turn(0);
            await view.change({{walls: false, cut: 0}});
            if (view[name].checked !== on) view[name].click();
            await view.show(view.now);
            const {{from, to}} = view.shownSegments;
            return Array.from(from, (x, i) => [x, to[i]]);
        }})"""
        shown = lambda name, on: self.browser.evaluate(f"{lines}('{name}', {str(on).lower()})")
        self.assertEqual(shown("chains", False), [])
        self.assertEqual(len(shown("chains", True)), 2 * 4)
        linear = shown("linear", True)
        self.assertEqual(len(linear), 2 * 2)
        heights = sorted(round(1e3 * z, 1) for pair in linear[1::2] for z in pair)
        for height, expected in zip(heights, (1.5, 2.5, 2.5, 3.5)):
            self.assertAlmostEqual(height, expected, delta=0.1)
        self.assertEqual(len(shown("linear", False)), 2 * 4)
        self.open("one/report.html")
        self.assertTrue(self.browser.evaluate(f"{GRAINS}.linearLabel.hidden"))

    def test_every_curve_is_that_of_the_series(self):
        evaluate = self.browser.evaluate
        evaluate("document.querySelectorAll('details.probe').forEach((part) => (part.open = true))")
        self.browser.wait("document.querySelectorAll('details.probe .charts').length === 2")
        compared = 0
        with h5py.File(self.folder / "one/series.h5") as series:
            for probe, group in series.items():
                for name, channel in group.items():
                    if name in ("time", "step") or not channel[()].any():  # a channel that is 0 throughout has no chart
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
        self.assertGreater(compared, 10)

    def test_zero_channels_share_a_line(self):
        self.browser.evaluate("document.querySelectorAll('details.probe').forEach((part) => (part.open = true))")
        self.browser.wait("document.querySelectorAll('details.probe .charts').length === 2")
        lines = self.browser.evaluate("Object.fromEntries([...document.querySelectorAll('details.probe')].filter((part) => part.querySelector('.zero')).map((part) => [part.charts.name, part.querySelector('.zero').textContent]))")
        charts = self.browser.evaluate("[...document.querySelectorAll('figure.chart')].map(({chart}) => `${chart.group.name}/${chart.name}`)")
        zero = {}
        with h5py.File(self.folder / "one/series.h5") as series:
            for probe, group in series.items():
                for name, channel in group.items():
                    if name in ("time", "step") or not numpy.isfinite(channel[()]).any():
                        continue
                    if (numpy.nan_to_num(channel[()]) == 0).all():
                        zero.setdefault(probe, []).append(name)
                        self.assertNotIn(f"{probe}/{name}", charts)
                    else:
                        self.assertIn(f"{probe}/{name}", charts)
        self.assertGreater(len(zero), 0)
        self.assertEqual(sorted(lines), sorted(zero))
        for probe, names in zero.items():
            self.assertTrue(lines[probe].startswith("0 throughout: "))
            self.assertEqual(len(lines[probe].split(": ", 1)[1].split(", ")), len(names), lines[probe])

    def test_the_probe_of_the_picture_is_unfolded(self):
        unfolded = "[...document.querySelectorAll('details.probe')].filter((part) => part.open).map((part) => part.charts.name)"
        self.assertEqual(self.browser.evaluate(unfolded), ["packing"])
        run(self.folder, "named", probes={"energy": {"type": "energy", "every_time": "5 ms"}, **SCENE["probes"]},
            output={"picture": {"x": "packing/time", "y": ["walls/box_pressure", "packing/coordination_number"]}})
        self.browser.open(self.folder / "named/report.html")
        self.browser.wait("document.querySelector('details.probe')")
        self.assertEqual(self.browser.evaluate(unfolded), ["packing", "walls"])

    @opens_pages
    def test_profiles_name_their_axis_and_the_progress_of_the_test(self):
        run(self.folder, "moving", probes={"packing": SCENE["probes"]["packing"], "moved": LISTS["moved"]},
            output={"picture": {"x": "packing/void_ratio_overall", "y": ["moved/zone_thickness"]}})
        self.browser.open(self.folder / "moving/report.html")
        self.browser.wait("document.querySelector('figure.chart')")
        axis, labels = self.browser.evaluate("""(async () => {
            const {chart} = [...document.querySelectorAll('figure.chart')].find(({chart}) => chart.group.name === 'moved' && chart.name === 'profile');
            await chart.draw();
            return [chart.abscissa.label, chart.series.map(({label}) => label)];
        })()""")
        self.assertEqual(axis, "z")
        self.assertEqual(len(labels), 3)
        with h5py.File(self.folder / "moving/series.h5") as series:
            at = dict(zip(series["packing/time"][()], series["packing/void_ratio_overall"][()]))
            times = series["moved/time"][()]
        for label, wanted in zip(labels, (1 / 3, 2 / 3, 1)):
            instant = times[times <= wanted * times[-1] + 1e-12][-1]
            self.assertRegex(label, r"^[0-9.]+ ms: void ratio overall [0-9.]+$")
            self.assertAlmostEqual(float(label.split()[-1]), at[max(t for t in at if t <= instant)], delta=1e-3)

    def test_another_abscissa_can_be_chosen(self):
        self.browser.evaluate("""(() => { const choice = document.querySelector('.against select');
            choice.value = 'void_ratio'; choice.dispatchEvent(new Event('change')); })()""")
        self.browser.wait("document.querySelector('figure.chart[data-drawn]')")
        x = self.browser.evaluate("Array.from(document.querySelector('figure.chart').chart.series[0].x, String)")
        with h5py.File(self.folder / "one/series.h5") as series:
            self.assertEqual([float(v) for v in x], list(series["packing/void_ratio"][()]))

    def test_values_are_shown_at_the_pointer_and_by_keys(self):
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

    def test_frames_change_by_slider_keys_and_play(self):
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
        self.browser.wait(f"{frame} === '{last}' && !{GRAINS}.player.playing")

    @reads
    def test_grains_are_those_of_the_frames(self):
        for number in (0, 3):
            shown = self.browser.evaluate(f"""(async () => {{ const frames = {GRAINS}.frames, frame = await frames.frame({number});
                const list = (values, axis) => Array.from(values, (q) => frames.metres(axis, q));
                return {{time: frame.time, id: [...frame.id], radius: [...frame.radius], position: ['x', 'y', 'z'].map((name, axis) => list(frame[name], axis)),
                         rotation: Array.from(frame.rotation[1], (q) => (q / 65535 * 2 - 1) * frames.json.stages[frame.stage].ranges.rotation),
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
        self.assertEqual(self.saved("figure.chart", "PNG")[1][:8], b"\x89PNG\r\n\x1a\n")
        name, csv = self.saved("figure.chart", "CSV")
        self.assertEqual(name, "one-packing-coordination_number.csv")
        lines = bytes(csv).decode().splitlines()
        self.assertEqual(lines[0], '"time [s]","coordination_number"')
        with h5py.File(self.folder / "one/series.h5") as series:
            pairs = zip(series["packing/time"][()], series["packing/coordination_number"][()])
            self.assertEqual([tuple(map(float, line.split(","))) for line in lines[1:]], list(pairs))
        lines = self.saved("figure.grains", "CSV")[1].decode().splitlines()
        self.assertEqual(lines[0], "id,x [m],y [m],z [m],radius [m],rotation [°]")
        self.assertEqual(len(lines), 41)

    def size_of_png(self):
        return self.browser.evaluate("createImageBitmap(save.last.blob).then(({width, height}) => [width, height])")

    @opens_pages
    def test_files_do_not_depend_on_the_mode_of_the_page(self):
        """Of a width for print, on white, in any window, in light and dark mode."""
        def files():
            self.open("one/report.html")
            self.go(5)
            everything = {}
            for figure in ("figure.chart", "figure.grains", "figure.map"):
                svg = self.saved(figure, "SVG")[1].decode()
                everything[figure] = self.saved(figure, "PNG")[1], svg
                self.assertGreaterEqual(self.size_of_png()[0], 1800, figure)
                self.assertEqual(self.browser.evaluate("""createImageBitmap(save.last.blob).then((image) => {
                    const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
                    canvas.drawImage(image, 0, 0);
                    return Array.from(canvas.getImageData(1, 1, 1, 1).data); })"""), [255, 255, 255, 255], figure)
                self.assertNotIn("#17181a", everything[figure][1])
                self.assertIn("#fff", everything[figure][1])
            return everything
        by_day = files()
        self.browser.resize(400, 800)
        self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        try:
            by_night = files()
        finally:
            self.browser.resize(*WINDOW)
            self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "light"}])
        for figure, (png, svg) in by_day.items():
            self.assertTrue(svg == by_night[figure][1], f"the SVG of {figure}")
            self.assertTrue(png == by_night[figure][0], f"the PNG of {figure}")

    def test_every_view_and_colour_is_drawn(self):
        seen = set()
        for view, colour in (("xz", "rotation"), ("yz", "rotation"), ("xy", "rotation"), ("xy", "speed"), ("xy", "radius")):
            self.browser.evaluate(f"{GRAINS}.change({{view: '{view}', colour: '{colour}', chains: {str(colour == 'radius').lower()}}})")
            seen.add(self.saved("figure.grains", "PNG")[1])
        self.assertEqual(len(seen), 5)

    @opens_pages
    def test_runs_share_charts(self):
        self.open("both.html")
        self.assertEqual(self.browser.evaluate("document.querySelector('figure.chart').chart.series.map((one) => one.label)"), ["one", "two"])
        self.assertEqual(self.browser.evaluate("getComputedStyle(document.querySelector('header td:not(.name) small')).display"), "block", "a note is separate from its number")
        self.assertEqual(self.browser.evaluate("[...document.querySelectorAll('header .differs')].map((row) => [...row.cells].map((cell) => cell.textContent).join(' '))"),
                         ["/seed 1 2", "/probes/packing/every_time 0.001 0.003"])
        self.assertTrue(self.browser.evaluate("(() => { const table = document.querySelector('header .wide'); return table.scrollWidth <= table.clientWidth; })()"), "the table fits")
        self.assertTrue(self.browser.evaluate("[...document.querySelector('[name=run]').options].map((one) => one.text).join() === 'one,two'"))
        first = self.saved("figure.grains", "PNG")[1]
        self.browser.evaluate("(() => { const choice = document.querySelector('[name=run]'); choice.value = 1; choice.dispatchEvent(new Event('change')); })()")
        self.browser.wait(f"{GRAINS}.now === {GRAINS}.painted && {GRAINS}.state.run === 1")
        name, second = self.saved("figure.grains", "PNG")
        self.assertTrue(name.startswith("two-"))
        self.assertNotEqual(first, second)

    @opens_pages
    def test_runs_of_different_tests_share_charts_where_possible(self):
        formulas = lambda **curves: {"test": {"type": "formula", "every_time": "2 ms", "curves": {name: {"formula": formula} for name, formula in curves.items()}}}
        picture = lambda x: {"output": {"picture": {"x": f"test/{x}", "y": ["test/shared"]}}}
        run(self.folder, "push", probes=formulas(way="2 * time", ratio="time / 3", shared="time", never="(time - time) / 0"), **picture("way"))
        run(self.folder, "pour", probes=formulas(share="5 * time", rate="7 * time", shared="-time", never="1 / 0"), **picture("share"))
        subprocess.run([GRIT, "report", "push", "pour", "--out", "unlike.html"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        self.browser.open(self.folder / "unlike.html")
        charts = "[...document.querySelectorAll('figure.chart')].map(({chart}) => chart)"
        self.browser.evaluate(f"Promise.all({charts}.map((chart) => chart.draw()))")
        shown = self.browser.evaluate(f"{charts}.map((chart) => [chart.name, chart.abscissa.name, chart.series.map(({{label}}) => label), chart.figure.querySelector('.about').textContent])")
        self.assertEqual({name: (x, runs) for name, x, runs, _ in shown},
                         {"shared": ("way", ["push"]), "ratio": ("way", ["push"]), "rate": ("share", ["pour"]), "share": ("time", ["pour"])})
        self.assertEqual({name: about for name, _, _, about in shown}["shared"], "time; not against way: pour", "the doc of a formula is the formula")
        self.browser.evaluate("(() => { const choice = document.querySelector('.against select'); choice.value = 'time'; choice.dispatchEvent(new Event('change')); })()")
        shown = self.browser.evaluate(f"Promise.all({charts}.map((chart) => chart.draw().then(() => [chart.name, chart.series.map(({{run, y}}) => [run.name, y.at(-1)])])))")
        last = dict(shown)["shared"]
        self.assertEqual([name for name, _ in last], ["push", "pour"])
        self.assertTrue(last[0][1] > 0 > last[1][1])
        self.assertNotIn("never", dict(shown), "no run has finite values")

    @opens_pages
    def test_infinite_values_are_gaps(self):
        run(self.folder, "broken", probes={"test": {"type": "formula", "every_time": "1 ms", "curves": {
            "late": {"formula": "time < 0.02 ? 1 / 0 : time < 0.03 ? time : time < 0.04 ? (time - time) / 0 : -time"}}}}, output={})
        self.browser.open(self.folder / "broken/report.html")
        chart = "document.querySelector('figure.chart').chart"
        self.browser.evaluate(f"{chart}.draw()")
        with h5py.File(self.folder / "broken/series.h5") as series:
            values = series["test/late"][()]
        self.assertTrue(numpy.isinf(values).any() and numpy.isnan(values).any())
        drawn = self.browser.evaluate(f"{chart}.view.data('curves').map(({{y}}) => y === null ? 'gap' : y)")
        self.assertEqual(drawn, [float(value) if numpy.isfinite(value) else "gap" for value in values])
        root = xml.etree.ElementTree.fromstring(self.browser.evaluate(f"{chart}.view.toSVG()"))
        line = next(group for group in root.iter(f"{SVG}g") if group.get("class", "").startswith("mark-line")).find(f"{SVG}path")
        self.assertEqual(line.get("d").count("M"), 2, "two pieces")
        self.assertNotRegex(line.get("d"), "NaN|Infinity")
        self.browser.evaluate(f"{chart}.show([0])")
        self.assertRegex(self.browser.evaluate("document.querySelector('.values').textContent"), "late –$")
        self.assertEqual(self.browser.evaluate(f"{chart}.view.data('near').length"), 0)
        finite = int(numpy.argmax(numpy.isfinite(values)))
        self.browser.evaluate(f"{chart}.show([{finite}])")
        self.browser.wait(f"{chart}.view.data('near').length === 1")

    @opens_pages
    def test_a_direction_without_a_number_is_a_gap(self):
        self.browser.open(self.folder / "lists/report.html")
        self.browser.evaluate("document.querySelectorAll('details.probe').forEach((part) => (part.open = true))")
        points = self.browser.evaluate("""(() => { const {chart} = [...document.querySelectorAll('figure.chart')].find(({chart}) => chart.name === 'force_by_direction');
            return chart.outline({shownX: [10, 30, 50], shownY: Float64Array.of(1, Infinity, NaN), s: '0'}).map(({x}) => x === null); })()""")
        self.assertEqual(points, [False] * 5 + [True] * 10 + [False])

    @opens_pages
    def test_spectra_have_logarithmic_axes(self):
        self.browser.open(self.folder / "lists/report.html")
        self.browser.evaluate("document.querySelectorAll('details.probe').forEach((part) => (part.open = true))")
        chart = "[...document.querySelectorAll('figure.chart')].find(({chart}) => chart.name === 'pressure_density').chart"
        self.browser.wait(f"{chart}.group.choice.span")
        self.browser.evaluate(f"{chart}.draw()")
        self.assertEqual(self.browser.evaluate(f"['x', 'y'].map((axis) => {chart}.view.scale(axis).type)"), ["log", "log"])
        with h5py.File(self.folder / "lists/series.h5") as series:
            frequency, density = series["listening/frequency"][-1], series["listening/pressure_density"][-1]
        self.assertEqual(frequency[0], 0)
        low, high = self.browser.evaluate(f"{chart}.xDomain")
        self.assertEqual((low, high), (frequency[1], frequency[-1]), "zero is not drawn")
        low, high = self.browser.evaluate(f"{chart}.yDomain.map(Math.log10)")
        numpy.testing.assert_allclose([low % 1, high % 1], 0, atol=1e-9)
        self.assertGreaterEqual(10**high, density[1:].max() * (1 - 1e-9))
        last = self.browser.evaluate(f"{chart}.series.at(-1).s")
        drawn = self.browser.evaluate(f"{chart}.view.data('curves').filter(({{s}}) => s === '{last}').map(({{x}}) => x === null ? 'gap' : x)")
        self.assertEqual(drawn, ["gap", *frequency[1:]])
        words = [text.text for text in xml.etree.ElementTree.fromstring(self.browser.evaluate(f"{chart}.view.toSVG()")).findall(f".//{SVG}g[@class='mark-text role-axis-label']/{SVG}text")]
        self.assertTrue(any(word.startswith("10") for word in words), words)
        linear = self.browser.evaluate("[...document.querySelectorAll('figure.chart')].find(({chart}) => chart.name === 'profile').chart.byPowers")
        self.assertFalse(linear)

    @reads
    def test_ticks_of_powers(self):
        for domain, count, wanted in (([1e-3, 1e3], 8, [1e-3, 1e-2, 0.1, 1, 10, 100, 1000]), ([1e-9, 1e9], 5, [1e-8, 1e-4, 1, 1e4, 1e8]), ([30, 400], 5, [50, 100, 200])):
            numpy.testing.assert_allclose(self.browser.evaluate(f"powersWithin({domain}, {count})"), wanted, rtol=1e-12)
        self.assertEqual(self.browser.evaluate("[0.01, 500, 1e5, 2e-7, 1e-12].map(atPower)"), ["0.01", "500", "10⁵", "2·10⁻⁷", "10⁻¹²"])

    @opens_pages
    def test_legends_never_overlap(self):
        names = [f"{'a-rather-long-name-of-a-run-' * (1 + i % 4)}{i}" for i in range(9)]
        for name in names:
            (self.folder / name).symlink_to(self.folder / "two")
        subprocess.run([GRIT, "report", *names, "--out", "many.html"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        for width in (1400, 390):
            self.browser.resize(width, 1000)
            try:
                self.open("many.html")
                boxes, below, bottom = self.browser.evaluate("""(() => { const plot = document.querySelector('figure.chart .plot'), box = (one) => { const {left, right, top, bottom} = one.getBoundingClientRect(); return [left, right, top, bottom]; };
                    return [[...plot.querySelectorAll('.legend-names text')].map(box), Math.max(...[...plot.querySelectorAll('.role-axis-title text')].map((one) => box(one)[3])), box(plot.querySelector('svg'))]; })()""")
            finally:
                self.browser.resize(*WINDOW)
            self.assertEqual(len(boxes), len(names))
            for i, (left, right, top, end) in enumerate(boxes):
                self.assertTrue(bottom[0] <= left < right <= bottom[1] and below <= top < end <= bottom[3], f"entry {i} at {width}: {boxes[i]} in {bottom} below {below}")
                for other in boxes[:i]:
                    self.assertTrue(right <= other[0] or other[1] <= left or end <= other[2] + 1 or other[3] <= top + 1, f"entry {i} at {width}")

    @opens_pages
    def test_the_others_are_shown_if_one_grain_is_far_away(self):
        bodies = {**SCENE["bodies"], "lost": {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": [{"position": ["4 mm", "3 mm", "500 mm"], "radius": "0.5 mm"}]}}}
        run(self.folder, "lost", bodies=bodies)
        self.browser.open(self.folder / "lost/report.html")
        self.browser.wait(f"{GRAINS}?.painted")
        self.assertEqual(self.browser.evaluate(f"{GRAINS}.now.count"), 41)
        extent = self.browser.evaluate(f"{GRAINS}.extent()")
        self.assertLess(extent["high"][2], 0.0125)
        self.assertIn("far from all others and initially out of view: 1", self.browser.evaluate(f"{GRAINS}.about.textContent"))
        self.browser.evaluate(f"{GRAINS}.change({{colour: 'layers'}})")
        self.browser.wait(f"{GRAINS}.layers && {GRAINS}.now === {GRAINS}.painted")
        self.assertGreater(len(set(self.browser.evaluate(f"[...{GRAINS}.layers.values()]"))), 7, "layers are those of the others")

    @opens_pages
    def test_the_view_fits_large_grains_and_walls(self):
        boulder = {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": [{"position": ["4 mm", "3 mm", "13 mm"], "radius": "2.9 mm"}]}}
        box = {**SCENE["walls"]["box"], "high": ["8 mm", "6 mm", "17 mm"]}
        run(self.folder, "boulder", bodies={**SCENE["bodies"], "boulder": boulder},
            walls={"box": box, "far": {"type": "plane", "material": "sand", "point": [0, 0, "-400 mm"]}})
        self.browser.open(self.folder / "boulder/report.html")
        self.browser.wait(f"{GRAINS}?.painted")
        inside = f"""(async () => {{
            const view = {GRAINS}, {{layout, now, frames}} = view, {{width, height, margin}} = layout, [right, up] = [view.view.right, view.view.up];
            const lists = [now.x, now.y, now.z], slack = 0.5, off = [];
            const check = (x, y, r) => {{ const [u, v] = [layout.across(x), layout.down(y)], p = r / layout.metresPerPixel;
                off.push(Math.min(u - p - margin.left, width - margin.right - u - p), Math.min(v - p - margin.top, height - margin.bottom - v - p)); }};
            for (let i = 0; i < now.count; ++i) check(frames.metres(right, lists[right][i]), frames.metres(up, lists[up][i]), now.radius[i]);
            check(0, 0, 0), check(8e-3, 0, 0);
            const {{from, to}} = view.shownSegments;
            return {{off: Math.min(...off), tops: Math.max(...Array.from(from).filter((_, i) => i % 2 === 1)), zoom: view.state.zoom, above: layout.metresUp(margin.top), below: layout.metresUp(height - margin.bottom)}}; }})()"""
        last = len(list((self.folder / "boulder/frames").iterdir())) - 1
        for number in (0, last):
            self.browser.evaluate(f"{GRAINS}.player.go({number})")
            self.browser.wait(f"{GRAINS}.painted.number === {number}")
            seen = self.browser.evaluate(inside)
            self.assertGreater(seen["off"], -0.5, "grains and the floor are in the frame, with their surfaces")
            self.assertGreaterEqual(seen["above"], 17e-3 - 1e-6, "the top of the box is in the frame")
            self.assertGreater(seen["below"], -3e-3, "a wall far away makes nothing smaller")
        whole = self.browser.evaluate(f"{GRAINS}.layout.metresPerPixel")
        self.browser.evaluate(f"{GRAINS}.fit()")
        seen = self.browser.evaluate(inside)
        self.assertGreater(seen["off"], -0.5, "what is there now is in the frame")
        self.assertLess(self.browser.evaluate(f"{GRAINS}.layout.metresPerPixel"), whole)
        self.browser.evaluate(f"{GRAINS}.change({{walls: false}})")
        self.browser.evaluate(f"{GRAINS}.fit()")
        seen = self.browser.evaluate(inside.replace("check(0, 0, 0), check(8e-3, 0, 0);", ""))
        self.assertGreater(seen["off"], -0.5)
        self.assertLess(seen["off"], 1, "they fill it")
        self.browser.evaluate("document.querySelector('.stage').dispatchEvent(new Event('dblclick'))")
        self.assertEqual(self.browser.evaluate(f"[{GRAINS}.state.zoom, ...{GRAINS}.state.pan]"), [1, 0, 0])

    @opens_pages
    def test_grains_are_coloured_by_a_field_of_a_probe(self):
        picture = {**SCENE["output"]["picture"], "color": "moved/fluctuation/x"}
        run(self.folder, "moved", probes={"packing": SCENE["probes"]["packing"], "moved": LISTS["moved"]},
            output={**SCENE["output"], "picture": picture, "color_scales": [{"of": "moved/fluctuation/x", "high": 0.25e-3}, {"of": "packing/void_ratio", "low": 0.5, "high": 2}]})
        self.browser.open(self.folder / "moved/report.html")
        self.browser.wait(f"{GRAINS}?.painted")
        self.assertEqual(self.browser.evaluate("[...document.querySelector('[name=colour]').options].map(({label}) => label).filter((label) => label.startsWith('moved'))"),
                         [f"moved: fluctuation{part}" for part in ("", " x", " y", " z")])
        self.assertEqual(self.browser.evaluate(f"{GRAINS}.state.colour"), "moved/fluctuation/x", "that of the description")
        low, high, factor = self.browser.evaluate(f"(({{colours: {{low, high}}, colouring}}) => [low, high, colouring.factor])({GRAINS})")
        self.assertAlmostEqual(high, 0.25e-3 * factor)
        self.assertAlmostEqual(low, -high)
        for number in (2, 5):
            for colour, wanted in (("moved/fluctuation/x", lambda rows: rows[:, 0]), ("moved/fluctuation", lambda rows: numpy.linalg.norm(rows, axis=1))):
                shown = self.browser.evaluate(f"""(async () => {{ const view = {GRAINS}; await view.change({{colour: '{colour}'}}); await view.turn({number});
                    const value = view.valueOf(view.now); return [...view.now.id].map((id, i) => [id, String(value(i))]); }})()""")
                with h5py.File(self.folder / f"moved/frames/{number:06}.h5") as frame:
                    expected = dict(zip(frame["probes/moved/id"][()].astype(int), wanted(frame["probes/moved/fluctuation"][()])))
                self.assertEqual(len(shown), 40)
                most = max(abs(value) for value in expected.values() if value == value)
                for number_of_body, value in shown:
                    value = float(value) / factor
                    if expected[number_of_body] == expected[number_of_body]:
                        self.assertAlmostEqual(value, expected[number_of_body], delta=1e-2 * most)
                    else:
                        self.assertNotEqual(value, value)
        self.browser.evaluate(f"{MAP}.takeField('packing/void_ratio')")
        self.browser.wait(f"{MAP}.now && {MAP}.colours")
        self.assertEqual(self.browser.evaluate(f"[{MAP}.colours.low, {MAP}.colours.high]"), [0.5, 2])
        self.assertIn("ends set by the description", self.browser.evaluate(f"{MAP}.about.textContent"))

    @opens_pages
    def test_walls_are_coloured_by_the_pressure_on_their_facets(self):
        corners = [(0, 0), (8, 0), (8, 6)], [(0, 0), (8, 6), (0, 6)]
        facets = "".join("facet normal 0 0 1\nouter loop\n" + "".join(f"vertex {x} {y} 0\n" for x, y in three) + "endloop\nendfacet\n" for three in corners)
        (self.folder / "tray.stl").write_text(f"solid tray\n{facets}endsolid tray\n")
        run(self.folder, "tray", walls={"box": {**SCENE["walls"]["box"], "open": ["z_high", "z_low"]}, "tray": {"type": "mesh", "path": "tray.stl", "scale": "1 mm", "open": True, "material": "sand"}},
            probes={**SCENE["probes"], "facets": {"type": "facets", "wall": "tray", "every_time": "1 ms"}})
        self.browser.open(self.folder / "tray/report.html")
        self.browser.wait(f"{GRAINS}?.painted")
        names = self.browser.evaluate("[...document.querySelector('[name=wall-colour]').options].map(({label}) => label)")
        self.assertEqual(names[0], "none")
        self.assertIn("pressure of tray", names)
        place = names.index("pressure of tray") - 1
        shown = self.browser.evaluate(f"""(async () => {{ const view = {GRAINS}; await view.change({{wallField: {place}, cut: 0}});
            const {{tint, from}} = view.shownSegments, {{table, high}} = view.scaleOfWalls(view.now);
            return {{inks: Array.from({{length: tint.length / 4}}, (_, i) => [...tint.slice(4 * i, 4 * i + 4)]).filter((ink) => ink[3] > 0), high, table: table.map((one) => one.join())}}; }})()""")
        last = sorted((self.folder / "tray/frames").iterdir())[-1]
        with h5py.File(last) as frame:
            pressure = frame["probes/facets/pressure"][()]
        self.assertEqual(len(shown["inks"]), 2, "the section cuts both facets, and the box has no field")
        places = sorted(shown["table"].index(",".join(map(str, ink[:3]))) for ink in shown["inks"])
        for got, wanted in zip(places, sorted(255 * min(1, value / shown["high"]) for value in pressure)):
            self.assertAlmostEqual(got, wanted, delta=1)
        svg = self.saved("figure.grains", "SVG")[1].decode()
        for ink in shown["inks"]:
            self.assertIn(f'stroke="rgb({ink[0]},{ink[1]},{ink[2]})"', svg)
        self.open("one/report.html")
        self.assertTrue(self.browser.evaluate(f"{GRAINS}.wallPlace.hidden"))

    def test_layers_are_those_of_the_start_of_a_stage(self):
        self.go(5)
        self.browser.evaluate(f"{GRAINS}.change({{colour: 'layers'}})")
        self.browser.wait(f"{GRAINS}.layers && {GRAINS}.now === {GRAINS}.painted")
        ids, layers = self.browser.evaluate(f"[...{GRAINS}.layers.keys()]"), self.browser.evaluate(f"[...{GRAINS}.layers.values()]")
        with h5py.File(self.folder / "one/frames/000000.h5") as frame:
            height = dict(zip(frame["bodies/id"][()].tolist(), frame["bodies/position"][:, 2].tolist()))
        low, high = min(height.values()), max(height.values())
        self.assertEqual(sorted(ids), sorted(height))
        for one, layer in zip(ids, layers):
            share = 10 * (height[one] - low) / (high - low)
            if min(share % 1, 1 - share % 1) > 1e-3 or share > 9:
                self.assertEqual(layer, min(10, 1 + int(share)))
        self.assertEqual(set(layers) & {1, 10}, {1, 10})
        by_id, shown = dict(zip(ids, layers)), self.browser.evaluate(f"[[...{GRAINS}.now.id], [...{GRAINS}.shownPlaces]]")
        numpy.testing.assert_allclose(shown[1], [(by_id[one] - 1) / 9 for one in shown[0]], atol=1e-6)

    @opens_pages
    def test_a_graphics_processor_and_none_draw_the_same(self):
        self.browser.resize(1400, 1000)  # edges, where they differ, are a small part
        self.addCleanup(self.browser.resize, *WINDOW)
        self.open("one/report.html")
        for view, zoom, most in (("xz", 1, 0.6), ("yz", 1, 0.6), ("xy", 1, 0.6), ("xz", 12, 0.15)):  # so close that points would be too large
            colours, off, apart = self.browser.evaluate(f"""(async () => {{ const view = {GRAINS}, {{painter}} = view;
                const {{low, high}} = view.extent(), {{now}} = view, middle = (axis) => (low[axis] + high[axis]) / 2;
                const pan = {zoom} === 1 ? [0, 0] : [view.frames.metres(0, now.x[7]) - middle(0), view.frames.metres(2, now.z[7]) - middle(2)];
                await view.change({{view: '{view}', zoom: {zoom}, pan, cut: {zoom} === 1 ? 0.4 : 0, chains: false}});
                let what;
                view.painter = {{draw: (all) => void (what = all)}};
                view.paint(true);
                view.painter = painter;
                const {{width, height}} = view.canvas, pixels = (Painter) => {{
                    const canvas = make('canvas', {{width, height}}), one = new Painter(canvas), seen = new OffscreenCanvas(width, height).getContext('2d');
                    one.setBodies(view.now), one.setPlaces(view.shownPlaces), one.setSegments(view.shownSegments), one.setColours(view.colours.table);
                    one.draw(what);
                    seen.fillStyle = 'white', seen.fillRect(0, 0, width, height), seen.drawImage(canvas, 0, 0);
                    return seen.getImageData(0, 0, width, height).data; }};
                const a = pixels(GlPainter), b = pixels(PixelPainter), differences = a.map((value, i) => Math.abs(value - b[i]));
                return [new Set(new Uint32Array(a.buffer)).size, differences.reduce((sum, one) => sum + one, 0) / a.length, differences.filter((one) => one > 100).length / a.length]; }})()""")
            self.assertGreater(colours, 20)
            self.assertLess(off, most, "mean difference, of 255")
            self.assertLess(apart, 2e-3)

    def test_grains_have_dark_rims(self):
        middle, rim = self.browser.evaluate(f"""(async () => {{ const view = {GRAINS}, {{now}} = view, {{low, high}} = view.extent(), at = (axis, list) => view.frames.metres(axis, list[i]);
            const i = now.y.reduce((best, y, k) => (y < now.y[best] ? k : best), 0);  // the nearest
            await view.change({{view: 'xz', zoom: 6, pan: [at(0, now.x) - (low[0] + high[0]) / 2, at(2, now.z) - (low[2] + high[2]) / 2], cut: 0, colour: 'radius'}});
            view.paint(true);
            const {{layout}} = view, x = layout.across(at(0, now.x)), y = layout.down(at(2, now.z)), left = x - now.radius[i] / layout.metresPerPixel;
            const row = view.canvas.getContext('2d').getImageData(0, y, view.canvas.width, 1).data;
            const shade = (column) => row.slice(4 * Math.floor(column), 4 * Math.floor(column) + 3).reduce((sum, one) => sum + one);
            return [shade(x), Math.min(shade(left), shade(left + 1))]; }})()""")
        self.assertLess(rim, 0.75 * middle)

    @reads
    def test_a_graphics_processor_is_used_where_there_is_one(self):
        for renderer, painter in (("ANGLE (NVIDIA GeForce RTX)", "GlPainter"), ("ANGLE (Google, Vulkan (SwiftShader Device))", "PixelPainter"), ("llvmpipe (LLVM 15)", "PixelPainter")):
            self.assertEqual(self.browser.evaluate(f"""(() => {{ const {{prototype}} = WebGL2RenderingContext, {{getParameter}} = prototype;
                prototype.getParameter = () => '{renderer}';
                try {{ return painterFor(make('canvas')).constructor.name; }} finally {{ prototype.getParameter = getParameter; }} }})()"""), painter)

    def test_slow_drawings_are_refined_at_rest(self):
        coarse = self.browser.evaluate(f"""(() => {{ const view = {GRAINS}, {{painter}} = view, draw = painter.draw.bind(painter), answers = [];
            painter.draw = (what) => (answers.push(draw(what)), answers.at(-1));
            painter.took = 1e9;
            view.paint(true), (painter.took = 1e9), view.paint();
            return answers; }})()""")
        self.assertEqual(coarse, [False, True])
        self.browser.wait(f"{GRAINS}.painter.took < 1e9")

    @reads
    def test_grains_are_sorted_by_depth(self):
        ways = self.browser.evaluate("""(() => { const list = Uint16Array.of(500, 65535, 0, 500, 7, 40000);
            return [ordered(list, 0, 65535, true), ordered(list, 0, 65535, false), ordered(list, 7.5, Infinity, true), ordered(list, -Infinity, 6, false)].map((places) => [...places]); })()""")
        self.assertEqual(ways, [[2, 4, 0, 3, 5, 1], [1, 5, 3, 0, 4, 2], [0, 3, 5, 1], [2]])

    @opens_pages
    def test_a_wall_that_a_stage_moves_is_drawn_there(self):
        gate = lambda z: {"type": "rectangle", "corner": [0, 0, z], "edge_a": ["8 mm", 0, 0], "edge_b": [0, "6 mm", 0], "material": "sand"}
        stages = [{"name": name, "until": {"type": "time", "value": "10 ms"}, "limit": "1 s", "change": change}
                  for name, change in (("shut", {}), ("open", {"walls": {"gate": {"corner": [0, 0, "-20 mm"]}}}))]
        run(self.folder, "gate", walls={**SCENE["walls"], "gate": gate("11 mm")}, stages=stages, output={"frames": {"every_time": "5 ms"}})
        with h5py.File(self.folder / "gate/frames/000000.h5") as first, h5py.File(self.folder / "gate/frames/000004.h5") as last:
            self.assertEqual([frame["walls/gate"][0, 0, 2] for frame in (first, last)], [0.011, -0.02])
            self.assertEqual(last.attrs["stage"], b"open")
        self.browser.open(self.folder / "gate/report.html")
        self.browser.wait(f"{GRAINS}?.painted")
        heights = self.browser.evaluate(f"""Promise.all([0, 4].map(async (frame) => (await {GRAINS}.frames.walls(frame)).find(({{name}}) => name === 'gate').corners[2]))""")
        numpy.testing.assert_allclose(heights, [0.011, -0.02], rtol=1e-6)

    def test_channels_of_the_picture_are_first(self):
        shown = "[...document.querySelectorAll('details.probe')[0].querySelectorAll('figure.chart')].filter((figure) => !figure.hidden).map(({chart}) => chart.name)"
        self.assertEqual(self.browser.evaluate(shown), ["coordination_number"])
        count = self.browser.evaluate("document.querySelectorAll('details.probe')[0].querySelectorAll('figure.chart').length")
        self.assertEqual(self.browser.evaluate("document.querySelector('.more').textContent"), f"{count - 1} more")
        self.browser.evaluate("document.querySelector('.more').click()")
        self.assertEqual(len(self.browser.evaluate(shown)), count)
        self.assertEqual(self.browser.evaluate("document.querySelector('.more').getAttribute('aria-expanded')"), "true")
        self.browser.evaluate("document.querySelector('.more').click()")
        self.assertEqual(len(self.browser.evaluate(shown)), 1)

    @opens_pages
    def test_charts_out_of_view_are_drawn(self):
        # For printing.
        self.browser.open(self.folder / "lists/report.html")
        charts = "[...document.querySelectorAll('figure.chart')]"
        self.browser.wait(f"{charts}.every(({{dataset}}) => dataset.drawn)")
        self.assertTrue(self.browser.evaluate(f"{charts}.at(-1).getBoundingClientRect().top > innerHeight + 400"), "it is out of view")

    def test_playing_is_not_doubled(self):
        # Stopped and started again between two frames: the first player stops.
        ended_at, last = self.browser.evaluate(f"""(async () => {{ const {{player}} = {GRAINS};
            await player.go(0);
            const first = player.start();
            player.stop();
            const second = player.start();
            await first;
            const {{number}} = player;
            await second;
            return [number, player.number]; }})()""")
        self.assertEqual(last, len(list((self.folder / "one/frames").iterdir())) - 1)
        self.assertLess(ended_at, last)

    @reads
    def test_times_have_readable_units(self):
        for seconds, largest, written in ((0, 0, "0 s"), (0.06, 0.06, "60 ms"), (-0.5, -0.5, "−500 ms"), (2.5e-5, 2.5e-5, "25 µs"), (0.06, 3, "0.06 s"), (1234.5, 1234.5, "1235 s")):
            self.assertEqual(self.browser.evaluate(f"writtenTime({seconds}, {largest})"), written)

    def test_the_grain_under_a_finger_is_shown(self):
        self.go(5)
        for colour, told in (("layers", r"layer \d+$"), ("rotation", r"rotation −?[\d.]+°$"), ("speed", "speed .* [mµn]?m/s$")):
            self.browser.evaluate(f"{GRAINS}.change({{colour: '{colour}', cut: 0}})")
            self.browser.wait(f"{GRAINS}.shownOf?.includes(' {colour} ')")
            said = self.browser.evaluate(f"""(() => {{ const view = {GRAINS}, {{stage, layout, now, frames}} = view, i = view.seen().at(-1);
                const {{left, top}} = stage.getBoundingClientRect(), place = {{pointerType: 'touch', pointerId: 1, bubbles: true,
                    clientX: left + layout.across(frames.metres(0, now.x[i])), clientY: top + layout.down(frames.metres(2, now.z[i]))}};
                stage.setPointerCapture = () => null;
                stage.dispatchEvent(new PointerEvent('pointerdown', place));
                stage.dispatchEvent(new PointerEvent('pointerup', place));
                return view.under.lastChild?.textContent; }})()""")
            self.assertRegex(said, told)

    @reads
    def test_axes_go_from_tick_to_tick(self):
        # With zero if it is near, no extra tick for noise about one, and a minimum range for a constant.
        for span, wanted in (([0, 1.03], [0, 1]), ([0.4, 1], [0, 1]), ([-0.03, 1], [0, 1]), ([-0.2, 1], [-0.2, 1]), ([99, 101], [99, 101]), ([7, 7], [3.5, 10.5]), ([0, 0], [-1, 1])):
            numpy.testing.assert_allclose(self.browser.evaluate(f"settled({span}).ends"), wanted, atol=1e-12)

    @reads
    def test_units_stand_behind_numbers_and_labels(self):
        for unit, behind, beside in (("kg/m³", "7 kg/m³", "it [kg/m³]"), ("°", "7°", "it [°]"), ("1", "7", "it"), ("", "7", "it")):
            self.assertEqual(self.browser.evaluate(f"valueWithUnit(7, {{shown_unit: '{unit}'}})"), behind)
            self.assertEqual(self.browser.evaluate(f"withUnit('it', '{unit}')"), beside)

    def go(self, frame):
        self.browser.evaluate(f"{GRAINS}.player.go({frame})")
        self.browser.wait(f"document.querySelector('.map .stage').dataset.frame === '{frame}'")

    def test_maps_are_those_of_the_frames(self):
        compared = 0
        for number in (1, 4):
            self.go(number)
            with h5py.File(self.folder / f"one/frames/{number:06}.h5") as frame:
                tables = frame["probes/packing"]
                for name in ("void_ratio", "coordination_number", "stress"):
                    shown = self.browser.evaluate(f"""(async () => {{ const map = {MAP};
                        map.takeField('packing/{name}');
                        await map.turn({number});
                        const {{cells}} = map.now, width = Math.max(1, map.field.components.length), text = (list) => Array.from(list, String);
                        return {{centre: cells.centre.map(text), size: cells.size.map(text), components: map.field.components,
                                 values: Array.from({{length: width}}, (_, k) => text(cells.list(map.place(map.field, k))))}}; }})()""")
                    for got, wanted in ((shown["centre"], tables["centre"]), (shown["size"], tables["size"]), (shown["values"], tables[name])):
                        wanted = wanted[()].reshape(len(tables["centre"]), -1).T.astype(numpy.float32)
                        numpy.testing.assert_array_equal(numpy.array([[float(value) for value in row] for row in got], numpy.float32), wanted)
                        compared += wanted.size
                    self.assertEqual(shown["components"], "xx xy xz yx yy yz zx zy zz".split() if name == "stress" else [])
        self.assertGreater(compared, 100)

    def test_maps_follow_the_frames_and_keep_their_colours(self):
        self.browser.evaluate(f"{MAP}.takeField('packing/stress')")
        scales, pictures = set(), set()
        for number in (1, 3, 5):
            self.browser.evaluate(f"(() => {{ const slider = document.querySelector('.map [name=frame]'); slider.value = {number}; slider.dispatchEvent(new Event('input')); }})()")
            for stage in (".grains .stage", ".map .stage"):
                self.browser.wait(f"document.querySelector('{stage}').dataset.frame === '{number}'")
            scales.add(self.browser.evaluate(f"JSON.stringify([{MAP}.colours.low, {MAP}.colours.high])"))
            pictures.add(self.saved("figure.map", "PNG")[1])
        self.assertEqual(len(scales), 1)
        self.assertEqual(len(pictures), 3)

    def test_maps_show_values_and_are_saved(self):
        self.browser.evaluate(f"{MAP}.takeField('packing/coordination_number')")
        self.go(5)
        place = self.browser.evaluate(f"""(() => {{ const map = {MAP}, {{cells}} = map.now, {{left, top}} = map.stage.getBoundingClientRect();
            map.stage.scrollIntoView({{block: 'center'}});
            const at = map.stage.getBoundingClientRect(), view = views[map.state.view], i = map.shown.at(-1);
            return {{x: at.left + map.layout.across(cells.centre[view.right][i]), y: at.top + map.layout.down(cells.centre[view.up][i]), i}}; }})()""")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=place["x"], y=place["y"])
        told = self.browser.wait(f"{MAP}.under.textContent") and self.browser.evaluate(f"{MAP}.under.textContent")
        field, component = self.browser.evaluate(f"[{MAP}.field.name, {MAP}.state.component]")
        with h5py.File(self.folder / "one/frames/000005.h5") as frame:
            tables = frame["probes/packing"]
            wanted, cells = tables[field][()].reshape(len(tables["centre"]), -1)[:, component], tables["centre"][()]
        self.assertIn(f"coordination number {float(format(wanted[place['i']], '.4g')):g}", told)
        name, svg = self.saved("figure.map", "SVG")
        self.assertEqual(name, f"one-packing-{field}-005.svg")
        self.assertEqual(len(xml.etree.ElementTree.fromstring(bytes(svg).decode()).findall(f".//{SVG}image")), 2, "cells, and the colour bar")
        lines = self.saved("figure.map", "CSV")[1].decode().splitlines()
        self.assertEqual(len(lines), len(cells) + 1)
        self.assertTrue(lines[0].startswith("x [m],y [m],z [m],size x [m],size y [m],size z [m]," + field))
        numpy.testing.assert_allclose([float(line.split(",")[2]) for line in lines[1:]], cells[:, 2], rtol=1e-6)
        numpy.testing.assert_allclose([float(line.split(",")[6]) for line in lines[1:]], wanted, rtol=1e-6)

    def test_maps_have_axes_walls_and_no_seams(self):
        self.browser.evaluate(f"{MAP}.takeField('packing/void_ratio')")
        self.go(5)
        root = xml.etree.ElementTree.fromstring(self.saved("figure.map", "SVG")[1].decode())
        words = [text.text for text in root.findall(f".//{SVG}text")]
        for wanted in ("x [mm]", "z [mm]", "void ratio", "0", "2", "8"):
            self.assertIn(wanted, words)
        # The sides of the box at 0 and 8 mm and its floor, at the coordinates of the axes.
        layout = f"{MAP}.arranged(fileSize, views.xz)"
        across = self.browser.evaluate(f"(() => {{ const layout = {layout}; return [layout.across(0), layout.across(8e-3), layout.down(0)]; }})()")
        walls = [[float(line.get(name)) for name in ("x1", "y1", "x2", "y2")] for line in root.findall(f".//{SVG}g/{SVG}line")]
        for x in across[:2]:
            self.assertTrue(any(abs(x1 - x) < 0.01 and abs(x2 - x) < 0.01 and abs(y1 - y2) > 20 for x1, y1, x2, y2 in walls), "a side")
        self.assertTrue(any(abs(y1 - across[2]) < 0.01 and abs(y2 - across[2]) < 0.01 for _, y1, _, y2 in walls), "the floor")
        # A line of pixels through the cells contains only their colours.
        seen, expected = self.browser.evaluate(f"""(async () => {{ const map = {MAP}, layout = {layout}, {{cells}} = map.now, {{frame}} = layout;
            const {{owner, width, height}} = map.paint(new CanvasPen(make('canvas').getContext('2d')), filesLook(), layout, filePixels);
            const values = cells.list(map.place(map.field, 0)), row = Math.floor((layout.down(cells.centre[2][map.shown[0]]) - frame.top) * filePixels);
            const list = Array.from({{length: width}}, (_, column) => owner[row * width + column]), first = list.findIndex((k) => k >= 0), last = list.findLastIndex((k) => k >= 0);
            return [list.slice(first, last + 1), map.shown.filter((i) => Math.abs(cells.centre[2][i] - cells.centre[2][map.shown[0]]) < 0.4 * cells.size[2][i]).length]; }})()""")
        self.assertNotIn(-1, seen)
        self.assertEqual(len(set(seen)), expected, "all cells of a row")

    @reads
    def test_cells_that_have_moved_apart_meet(self):
        """Two by two cells, ten pixels wide, in rows with gaps and overlaps; and an isolated one."""
        owner = self.browser.evaluate("""(() => { const {x, y} = {x: [10, 22, 11, 20, 60], y: [10, 10, 21, 21, 10]}, half = x.map(() => 5);
            return [...cellsByPixel({x, y, w: half, h: half}, 70, 30)]; })()""")
        image = numpy.array(owner).reshape(30, 70)
        self.assertEqual(list(image[10, 4:28]), [-1] + [0] * 11 + [1] * 11 + [-1])
        self.assertNotIn(-1, image[6:25, 7:24], "gaps between two and four cells are closed")
        self.assertEqual(list(image[21, 6:25]), [2] * 10 + [3] * 9, "each gets half of an overlap")
        self.assertEqual(set(image[10, 27:55]), {-1}, "the isolated cell stays isolated")
        self.assertEqual(list(image[10, 55:66]), [4] * 10 + [-1])

    @reads
    def test_no_hole_is_left_where_gaps_cross(self):
        """Four by three cells, ten pixels wide, with columns shifted by half a cell, and gaps between columns and rows."""
        centres = [(10 + 16 * i, 10 + 16 * j + 5 * (i % 2)) for i in range(4) for j in range(3)]
        owner = self.browser.evaluate(f"""(() => {{ const centres = {json.dumps(centres)}, half = centres.map(() => 5);
            return [...cellsByPixel({{x: centres.map((one) => one[0]), y: centres.map((one) => one[1]), w: half, h: half}}, 68, 58)]; }})()""")
        image = numpy.array(owner).reshape(58, 68)
        self.assertNotIn(-1, image[10:47, 5:63])
        for i in range(4):  # no larger than the cells, except for gaps
            first = 5 + 5 * (i % 2)
            column = image[:, 10 + 16 * i]
            self.assertEqual([k for k in range(58) if column[k] >= 0], list(range(first, first + 42)))
        self.assertEqual(set(image[:, :5].flat) | set(image[:, 63:].flat) | set(image[52:].flat), {-1})

    @reads
    def test_a_missing_cell_leaves_a_hole(self):
        centres = [(10 + 10 * i, 10 + 10 * j) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
        owner = self.browser.evaluate(f"""(() => {{ const centres = {json.dumps(centres)}, half = centres.map(() => 5);
            return [...cellsByPixel({{x: centres.map((one) => one[0]), y: centres.map((one) => one[1]), w: half, h: half}}, 40, 40)]; }})()""")
        image = numpy.array(owner).reshape(40, 40)
        self.assertEqual(set(image[15:25, 15:25].flat), {-1})
        self.assertEqual(int((image < 0).sum()), 40 * 40 - 8 * 100)

    def test_axes_have_four_to_eight_ticks(self):
        """With a spacing of 1, 2 or 5 times a power of ten."""
        counts = self.browser.evaluate("""(() => { const counts = [];
            for (let i = 0; i < 500; ++i) {
                const high = 10 ** (-6 + 12 * i / 500), step = tickStep(-0.04 * high, high), lead = step / 10 ** Math.floor(Math.log10(step * 1.0001));
                if (![1, 2, 5].some((one) => Math.abs(lead - one) < 1e-9)) throw Error(`a step of ${step}`);
                counts.push(multiples(step, -0.04 * high, high).length);
            }
            return counts; })()""")
        self.assertTrue(all(4 <= count <= 8 for count in counts), sorted(set(counts)))
        for low, high in ((0, 1), (-7.3e-5, 2.1e-5), (0.9, 7.96), (199.41, 200.77), (-3, -2.99), (0.2, 1.45), (199.67, 200.26)):
            shown, step = self.browser.evaluate(f"(() => {{ const {{ends, step}} = settled([{low}, {high}]); return [ends, step]; }})()")
            self.assertLessEqual(shown[0], low + 0.03 * (high - low) + 1e-12)
            self.assertGreaterEqual(shown[1], high - 0.03 * (high - low) - 1e-12)
            for end in shown:
                self.assertAlmostEqual(end / step, round(end / step), 6)
                self.assertEqual(end, float(f"{end:.10g}"), "a tick, to the last bit")
            self.assertIn(round((shown[1] - shown[0]) / step) + 1, range(4, 9))
        for low, high, tall in ((-0.72, 0.72, 240), (-59, 59, 194), (0, 441, 240), (0.53, 0.86, 126)):
            words = self.browser.evaluate(f"""(() => {{ const words = [], pen = {{image() {{}}, line() {{}}, text: (x, y, said) => words.push(said)}};
                drawColourBar(pen, theme(), {{left: 0, top: 0, tall: {tall}, low: {low}, high: {high}, table: colourTables.diverging, factor: 1}});
                return words; }})()""")
            self.assertIn(len(words), range(4, 9), f"{words} of colours")
        for width, height in ((390, 844), (1400, 1000), (2560, 1440)):
            self.browser.resize(width, height)
            try:
                self.browser.evaluate("(async () => { const {chart} = document.querySelector('figure.chart'); chart.fit(); await chart.draw(); })()")
                ticks = self.browser.evaluate("[...document.querySelectorAll('figure.chart .role-axis')].slice(0, 2).map((axis) => axis.querySelectorAll('.role-axis-grid line').length)")
                for count in ticks:
                    self.assertIn(count, range(4, 9), f"{ticks} at {width}")
                last, top = self.browser.evaluate("(() => { const {chart} = document.querySelector('figure.chart'); return [chart.view.scale('y')(chart.yDomain[1]), Math.min(...[...document.querySelectorAll('figure.chart .role-axis')[1].querySelectorAll('.role-axis-grid line')].map((line) => line.transform.baseVal[0].matrix.f))]; })()")
                self.assertAlmostEqual(last, top, delta=1, msg="a line at the upper end")
            finally:
                self.browser.resize(*WINDOW)

    def test_a_colour_scale_depends_on_the_field_and_not_on_its_values(self):
        for number in (1, 5):
            self.go(number)
            for field, component, table in (("void_ratio", 0, "sequential"), ("stress", 0, "sequential"), ("stress", 2, "diverging"), ("stress", 8, "sequential")):
                self.browser.evaluate(f"(() => {{ {MAP}.takeField('packing/{field}'); {MAP}.state.component = {component}; }})()")
                for values in ([1, 2], [-2, 3]):
                    self.browser.evaluate(f"Object.values({MAP}.field.ranges).forEach((ranges) => (ranges[{component}] = {values}))")
                    self.browser.evaluate(f"{MAP}.turn({number})")
                    self.assertEqual(self.browser.evaluate(f"{MAP}.colours.table === colourTables.{table}"), True, f"{field} {component} of {values}")
                low, high, kind = self.browser.evaluate(f"(({{low, high, table}}) => [low, high, Object.keys(colourTables).find((name) => colourTables[name] === table)])({MAP}.colours)")
                self.assertEqual(kind, table, field)
                if table == "diverging":
                    self.assertEqual(low, -high)

    @reads
    def test_the_most_informative_map_is_the_first(self):
        self.assertEqual(self.browser.evaluate("[...document.querySelector('[name=field]').options].map(({value}) => value)"),
                         ["packing/void_ratio", "packing/solid_fraction", "packing/stress", "packing/coordination_number"])
        self.assertEqual(self.browser.evaluate(f"{MAP}.state.field"), "packing/void_ratio")

    def list_chart(self, probe, name):
        """Kind and series, as [label, x, y], of a chart of lists."""
        return self.browser.evaluate(f"""(async () => {{
            const {{chart}} = [...document.querySelectorAll('figure.chart')].find(({{chart}}) => chart.group.name === '{probe}' && chart.name === '{name}');
            await chart.draw();
            return [chart.constructor.name, chart.series.map(({{label, x, y}}) => [label, Array.from(x, String), Array.from(y, String)])]; }})()""")

    @opens_pages
    def test_profiles_and_directions_are_those_of_the_series(self):
        self.browser.open(self.folder / "lists/report.html")
        self.browser.evaluate("document.querySelectorAll('details.probe').forEach((part) => (part.open = true))")
        self.browser.wait("[...document.querySelectorAll('.times .clock')].filter((clock) => clock.textContent).length === 3")
        numbers = lambda row: [float(value) for value in row]
        with h5py.File(self.folder / "lists/series.h5") as series:
            for probe, name, at, kind in (("moved", "profile", "position", "ListChart"), ("moved", "fluctuation", "position", "ListChart"),
                                          ("forces", "force_by_direction", "direction", "PolarChart"), ("forces", "contacts_by_direction", "direction", "PolarChart")):
                found, shown = self.list_chart(probe, name)
                self.assertEqual(found, kind)
                time = series[f"{probe}/time"][()]
                samples = [max(i for i, t in enumerate(time) if t <= part * (time[-1] - time[0]) + time[0]) for part in (1 / 3, 2 / 3, 1)]
                self.assertEqual([label for label, _, _ in shown], [f"{float(format(1e3 * time[i], '.4g')):g} ms" for i in samples])
                for (_, x, y), i in zip(shown, samples):
                    numpy.testing.assert_array_equal(numbers(x), series[f"{probe}/{at}"][i])
                    numpy.testing.assert_array_equal(numbers(y), series[f"{probe}/{name}"][i])
            self.assertFalse(self.browser.evaluate("[...document.querySelectorAll('figure.chart')].some(({chart}) => ['place', 'direction'].includes(chart.name))"))
            # Another time only, then that one together with a third.
            act = "(() => {{ const box = [...document.querySelectorAll('details.probe')].find((part) => part.querySelector('summary').textContent.startsWith('{}')), slider = box.querySelector('[name=sample]'); {} }})()"
            press = "[...box.querySelectorAll('.times button')].find((button) => button.textContent === '{}').click();"
            turn = "slider.value = {}; slider.dispatchEvent(new Event('input'));"
            self.browser.evaluate(act.format("forces", press.format("only this") + turn.format(500) + press.format("keep") + turn.format(250)))
            _, shown = self.list_chart("forces", "force_by_direction")
            time = series["forces/time"][()]
            samples = [max(i for i, t in enumerate(time) if t <= part * (time[-1] - time[0]) + time[0]) for part in (0.5, 0.25)]
            self.assertEqual([numbers(y) for _, _, y in shown], [list(series["forces/force_by_direction"][i]) for i in samples])
        chart = "[...document.querySelectorAll('figure.chart')].find(({chart}) => chart.name === 'force_by_direction')"
        root = xml.etree.ElementTree.fromstring(self.browser.evaluate(f"{chart}.chart.view.toSVG()"))
        self.assertGreater(len(root.findall(".//{http://www.w3.org/2000/svg}path")), 5)
        # Pointing upwards shows the values near 90°.
        area = self.browser.evaluate(f"(() => {{ {chart}.scrollIntoView({{block: 'center'}}); const {{left, right, top, bottom}} = {chart}.chart.area(); return {{left, right, top, bottom}}; }})()")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=(area["left"] + area["right"]) / 2 + 1, y=0.7 * area["top"] + 0.3 * area["bottom"])
        self.browser.wait(f"{chart}.querySelector('.values').textContent.includes('direction 85°')")

    @opens_pages
    def test_keys_select_the_same_abscissa_in_all_runs(self):
        self.open("both.html")
        self.browser.evaluate("document.querySelector('figure.chart').focus()")
        for _ in range(7):
            self.press("ArrowRight")
        times = self.browser.evaluate("(({series, places}) => series.map(({x}, k) => x[places[k]]))(document.querySelector('figure.chart').chart)")
        self.assertAlmostEqual(times[0], 6e-3, delta=2e-5)
        self.assertAlmostEqual(times[1], 6e-3, delta=2e-5)

    @opens_pages
    def test_a_file_of_many_runs_has_a_name_that_file_systems_take(self):
        self.open("both.html")
        name = "(() => { const {runs} = report; report.runs = Array.from({length: %d}, (_, i) => runs[i %% 2]); try { return document.querySelector('figure.chart').chart.fileName; } finally { report.runs = runs; } })()"
        self.assertEqual(self.browser.evaluate(name % 2), "one-two-packing-coordination_number")
        self.assertEqual(self.browser.evaluate(name % 40), "one-and-39-more-packing-coordination_number")

    @reads
    def test_new_data_are_drawn_if_they_arrive_during_the_first_drawing(self):
        drawn = self.browser.evaluate("""(async () => { const {chart} = document.querySelector('figure.chart'), one = chart.group.chart(chart.name), load = one.load.bind(one);
            let count = 0;
            one.load = async () => { const number = ++count; return Object.assign(await load(), {number}); };
            const first = one.draw();
            await one.refresh();
            await first;
            return one.series.number; })()""")
        self.assertEqual(drawn, 2)

    @reads
    def test_long_series_are_drawn_by_their_extremes(self):
        count, lowest, highest, gap = self.browser.evaluate("""(() => { const y = Float64Array.from({length: 100001}, (_, i) => Math.sin(i));
            y[5000] = -7, y[70000] = 9, y[30000] = NaN;
            const places = [...pointsToDraw(y, 800)];
            return [places.length, places.includes(5000), places.includes(70000), places.includes(30000)]; })()""")
        self.assertLess(count, 5000)
        self.assertTrue(lowest and highest and gap)
        self.assertTrue(self.browser.evaluate("[...pointsToDraw(Float64Array.of(1, 2, 3), 800)].join() === '0,1,2'"))

    def test_figures_have_a_description_as_text(self):
        with h5py.File(self.folder / "one/series.h5") as series:
            last = series["packing/time"][-1]
        said = self.browser.evaluate("document.querySelector('figure.chart .plot[role=img]').getAttribute('aria-label')")
        self.assertRegex(said, rf"^coordination number against time: coordination number 0 to .* over 0 s to {float(format(last, '.4g')):g} s$")
        self.assertRegex(self.browser.evaluate("document.querySelector('.grains .stage[role=img]').getAttribute('aria-label')"), "^40 grains at ")
        self.go(5)
        self.assertRegex(self.browser.evaluate("document.querySelector('.map .stage[role=img]').getAttribute('aria-label')"), r"^\w[\w ]* of \d+ cells of packing at ")

    @opens_pages
    def test_phones_and_dark_mode(self):
        self.browser.resize(400, 800)
        self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        try:
            self.open("one/report.html")
            self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), 400)
            self.assertEqual(self.browser.evaluate("getComputedStyle(document.body).backgroundColor"), "rgb(23, 24, 26)")
            self.assertIn("#17181a", self.browser.evaluate("document.querySelector('figure.chart').chart.view.background()"))
        finally:
            self.browser.resize(*WINDOW)
            self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "light"}])

    @opens_pages
    def test_dark_mode_is_printed_on_white(self):
        emulate = lambda media: self.browser.call("Emulation.setEmulatedMedia", media=media, features=[{"name": "prefers-color-scheme", "value": "dark"}])
        def expect(*wanted):
            """These are the papers of a chart and of grains, soon."""
            shown = self.browser.evaluate(f"""(async () => {{
                const ink = (canvas) => {{ const {{width, height}} = canvas, copy = new OffscreenCanvas(width, height).getContext('2d', {{willReadFrequently: true}});
                    copy.drawImage(canvas, 0, 0);
                    const {{data}} = copy.getImageData(0, Math.floor(0.9 * height), Math.floor(0.3 * width), Math.floor(0.1 * height));
                    let light = 0, dark = 0;
                    for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200) (data[i] > 200 ? (light += 1) : data[i] < 60 ? (dark += 1) : 0);
                    return light > dark ? 'paper is light' : 'paper is dark'; }};
                for (const until = performance.now() + 5000;;) {{
                    const now = [document.querySelector('figure.chart').chart.view.background(), ink(document.querySelector('.grains .overlay'))];
                    if (now.join() === {json.dumps(wanted)}.join() || performance.now() > until) return now;
                    await new Promise((go) => setTimeout(go, 20)); }} }})()""")
            self.assertEqual(shown, list(wanted))
        emulate("")
        try:
            self.open("one/report.html")
            self.browser.wait(f"{GRAINS}.painted")
            expect("#17181a", "paper is dark")
            emulate("print")
            self.assertEqual(self.browser.evaluate("getComputedStyle(document.body).backgroundColor"), "rgb(255, 255, 255)")
            self.browser.evaluate("dispatchEvent(new Event('beforeprint'))")
            expect("#fff", "paper is light")
            emulate("")
            self.browser.evaluate("dispatchEvent(new Event('afterprint'))")
            expect("#17181a", "paper is dark")
        finally:
            self.browser.call("Emulation.setEmulatedMedia", media="", features=[{"name": "prefers-color-scheme", "value": "light"}])

    @reads
    def test_shrinking_does_not_distort_grains(self):
        """As in printing: without a redraw."""
        wide, shrunk = self.browser.evaluate(f"""(() => {{ const {{canvas, stage}} = {GRAINS}, size = () => {{
                const {{width, height}} = canvas.getBoundingClientRect(), scale = Math.min(width / canvas.width, height / canvas.height);
                return getComputedStyle(canvas).objectFit === 'contain' ? [scale, scale] : [width / canvas.width, height / canvas.height]; }};
            const wide = size();
            stage.style.width = '50%';
            const shrunk = size();
            stage.style.width = '';
            return [wide, shrunk]; }})()""")
        self.assertAlmostEqual(wide[0], wide[1], 6)
        self.assertAlmostEqual(shrunk[0], shrunk[1], 6)
        self.assertLess(shrunk[0], 0.6 * wide[0])

    @opens_pages
    def test_grains_are_drawn_without_webgl(self):
        script = self.browser.call("Page.addScriptToEvaluateOnNewDocument", source="""
            const context = HTMLCanvasElement.prototype.getContext;
            HTMLCanvasElement.prototype.getContext = function (kind, ...rest) { return kind === 'webgl2' ? null : context.call(this, kind, ...rest); };""")
        try:
            self.open("one/report.html")
            self.assertTrue(self.browser.evaluate(f"{GRAINS}.painter instanceof PixelPainter"))
            covered = self.browser.evaluate(f"""(() => {{ const {{canvas}} = {GRAINS};
                const pixels = new Uint32Array(canvas.getContext('2d').getImageData(0, 0, 0.7 * canvas.width, 0.8 * canvas.height).data.buffer);
                return pixels.filter((pixel) => pixel !== 0).length / pixels.length; }})()""")
            self.assertGreater(covered, 0.04, "apart from the colour scale and the scale bar")
        finally:
            self.browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script["identifier"])


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    GRIT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    if CHROMIUM is None:
        skip("there is no Chromium to open the page with (Debian: chromium)")
    unittest.main(verbosity=1)
