#!/usr/bin/env python3
"""The page that a run serves: access, its behaviour in a browser, and no influence on the run.

usage: test_watch.py GRIT     exit status 77 where there is no h5py; without Chromium the browser tests are skipped
"""

import filecmp
import http.client
import json
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

from browser import BOX_OF_GRAINS, GRAINS, MAP, Browser, PageError, find_chromium, h5py_or_skip, write_scene

h5py = h5py_or_skip()
CHROMIUM = find_chromium()
GRIT = None

# It ends when interrupted: one simulated second takes hours.
SCENE = {
    **BOX_OF_GRAINS,
    "title": "grains that are watched",
    "stages": [{"name": "fall", "until": {"type": "time", "value": "1e6 s"}, "limit": "1e7 s"}],
    "probes": {"packing": {"type": "packing", "every_steps": 200}},
    "output": {"frames": {"every_steps": 20000}},
}
SHORT = [{"name": "fall", "until": {"type": "time", "value": "0.3 s"}, "limit": "1 s"}]


class WatchedRun:
    """A run with --watch; killed at the end of the block, as one that is interrupted waits for pages that were asked for."""

    def __init__(self, folder, name, *words, **changes):
        write_scene(folder, name, {**SCENE, **changes})
        self.process = subprocess.Popen([GRIT, "run", f"{name}.json", "--out", name, "--threads", "1", "--quiet", "--watch", *words],
                                        cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        said = self.process.stderr.readline()
        self.address = re.search(r"http://127\.0\.0\.1:\d+/", said)[0]
        self.port = int(self.address.rsplit(":", 1)[1].rstrip("/"))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.process.stderr.close()

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait()

    def ask(self, path="/", method="GET", host=None):
        """Status, headers and body of a response."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.putrequest(method, path, skip_host=True)
        connection.putheader("Host", f"127.0.0.1:{self.port}" if host is None else host)
        connection.endheaders()
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer.status, answer.headers, body

    def news(self, since):
        return json.loads(self.ask(f"/new?since={since}&page=test")[2])


def samples(report):
    """Values of the first channel of the first probe in a page's JSON."""
    return report["runs"][0]["probes"][0]["channels"][0]["samples"] if report["runs"] else 0


class Served(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="grit-watch-")
        cls.folder = pathlib.Path(cls.place.name)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def test_only_this_machine_has_access(self):
        with WatchedRun(self.folder, "asked") as run:
            for host in ("localhost", f"localhost:{run.port}", "127.0.0.1", "[::1]:9000"):
                status, headers, body = run.ask(host=host)
                self.assertEqual(status, 200, host)
                self.assertIn(b"</html>", body)
            self.assertEqual(headers["Cache-Control"], "no-store")
            self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
            self.assertNotIn("Access-Control-Allow-Origin", headers)
            for host in ("evil.example", f"evil.example:{run.port}", "127.0.0.1.evil.example", "localhost@evil.example", ""):
                for path in ("/", "/new?since=0&page=x"):
                    status, _, body = run.ask(path, host=host)
                    self.assertEqual(status, 403, host)
                    self.assertNotIn(b"html", body)
            addresses = pathlib.Path("/proc/net/tcp").read_text(), pathlib.Path("/proc/net/tcp6").read_text()
            listening = [line.split()[1] for text in addresses for line in text.splitlines()[1:] if line.split()[3] == "0A"]
            self.assertEqual([one for one in listening if one.endswith(f":{run.port:04X}")], [f"0100007F:{run.port:04X}"])

    def test_nothing_but_get_is_answered(self):
        with WatchedRun(self.folder, "methods") as run:
            for method in ("POST", "PUT", "DELETE", "HEAD", "OPTIONS"):
                self.assertEqual(run.ask(method=method)[0], 405, method)
            for path in ("/run.json", "/../run.json", "/new", "//", "/report.html"):
                self.assertEqual(run.ask(path)[0], 404, path)
            for since in ("", "x", "-1", "1e3", "99999999999999999999999"):
                self.assertEqual(run.ask(f"/new?since={since}&page=x")[0], 400, since)
            with socket.create_connection(("127.0.0.1", run.port)) as other:
                other.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"x" * 100_000 + b"\r\n\r\n")
                other.settimeout(60)
                try:
                    self.assertEqual(other.recv(100), b"")
                except ConnectionResetError:
                    pass
            self.assertEqual(run.ask()[0], 200, "it is still running")

    def test_a_port_in_use_is_reported_before_the_run(self):
        with socket.create_server(("127.0.0.1", 0)) as other:
            port = other.getsockname()[1]
            write_scene(self.folder, "refused", SCENE)
            ended = subprocess.run([GRIT, "run", "refused.json", "--out", "refused", "--watch", "--port", str(port)], cwd=self.folder,
                                   capture_output=True, text=True)
        self.assertEqual(ended.returncode, 1)
        self.assertEqual(ended.stderr, f"grit: --port {port}: this port of 127.0.0.1 is in use; give another, or omit --port to get a free one\n")
        self.assertFalse((self.folder / "refused").exists())

    def test_invalid_ports_are_reported(self):
        write_scene(self.folder, "none", SCENE)
        for words, said in ((["--watch", "--port", "65536"], 'grit: --port takes a number from 1 to 65535, not "65536"\n'),
                            (["--watch", "--port", "http"], 'grit: --port takes a number from 1 to 65535, not "http"\n'),
                            (["--port", "8000"], "grit: --port needs --watch; give both\n")):
            ended = subprocess.run([GRIT, "run", "none.json", *words], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual((ended.returncode, ended.stderr), (1, said))

    def test_new_data_are_sent_once(self):
        with WatchedRun(self.folder, "news") as run:
            news = run.news(0)
            while samples(news.get("report", {"runs": []})) < 1:
                news = run.news(news.get("since", 0))
            later = run.news(news["since"])
            while "report" not in later:
                later = run.news(news["since"])
            self.assertGreater(samples(later["report"]), samples(news["report"]))
            self.assertGreaterEqual(min(map(int, later["elements"]), default=news["since"]), news["since"])
            self.assertLess(set(map(int, later["elements"])), set(later["used"]), "unchanged curves are not sent again")
            self.assertIn("fall", later["progress"])
            # A reader waiting at the end gets the last state.
            run.process.send_signal(signal.SIGINT)
            while not later["ended"]:
                later = run.news(later.get("since", news["since"]))
            self.assertIn("interrupted", later["head"])
            with h5py.File(self.folder / "news/series.h5") as series:
                self.assertEqual(samples(later["report"]), len(series["packing/time"]))
            self.assertEqual(run.process.wait(), 130)
            with self.assertRaises(ConnectionRefusedError):
                run.ask()

    def test_the_run_is_not_affected(self):
        write_scene(self.folder, "alone", {**SCENE, "stages": SHORT})
        subprocess.run([GRIT, "run", "alone.json", "--out", "alone", "--threads", "1", "--quiet"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        with WatchedRun(self.folder, "seen", stages=SHORT) as run:
            news = {"ended": False}
            while not news["ended"]:
                try:
                    news = run.news(0)
                except ConnectionError:
                    break
            self.assertEqual(run.process.wait(), 0)
        self.assertTrue(filecmp.cmp(self.folder / "alone/packing.txt", self.folder / "seen/packing.txt", shallow=False))
        with h5py.File(self.folder / "alone/series.h5") as alone, h5py.File(self.folder / "seen/series.h5") as seen:
            compared = [name for name in alone["packing"] if alone["packing"][name][()].tobytes() == seen["packing"][name][()].tobytes()]
            self.assertEqual(compared, list(seen["packing"]))
        for frame in sorted((self.folder / "alone/frames").iterdir()):
            with h5py.File(frame) as alone, h5py.File(self.folder / "seen/frames" / frame.name) as seen:
                for name in alone["bodies"]:
                    self.assertEqual(alone["bodies"][name][()].tobytes(), seen["bodies"][name][()].tobytes())

    def test_idle_connections_keep_nobody_out(self):
        with WatchedRun(self.folder, "idle") as run:
            idle = [socket.create_connection(("127.0.0.1", run.port)) for _ in range(100)]
            self.assertEqual(run.ask()[0], 200)
            self.assertEqual(run.ask("/new?since=0&page=x")[0], 200)
            for one in idle:
                one.close()

    def test_the_folder_of_a_killed_run_is_free_at_once(self):
        with WatchedRun(self.folder, "killed") as run:
            run.ask()  # the server waits for this page
            run.process.kill()
            run.process.wait()
            write_scene(self.folder, "killed", {**SCENE, "stages": [dict(SHORT[0], until={"type": "steps", "value": 10})]})
            ended = subprocess.run([GRIT, "run", "killed.json", "--out", "killed", "--overwrite", "--quiet"], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))

    def test_a_run_continues_without_its_server(self):
        # Long enough for several progress reports to that process.
        stages = [dict(SHORT[0], until={"type": "time", "value": "3 s"}, limit="10 s")]
        with WatchedRun(self.folder, "left", stages=stages) as run:
            children = pathlib.Path(f"/proc/{run.process.pid}/task/{run.process.pid}/children")
            run.ask()  # it is running now
            subprocess.run(["kill", "-KILL", children.read_text().strip()], check=True)
            self.assertEqual(run.process.wait(), 0)
        self.assertEqual(json.loads((self.folder / "left/run.json").read_text())["status"], "done")


@unittest.skipIf(CHROMIUM is None, "there is no Chromium to open the page with (Debian: chromium)")
class InABrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="grit-watch-")
        cls.folder = pathlib.Path(cls.place.name)
        cls.browser = Browser(CHROMIUM, 1000, 800, timeout=150).__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()
        cls.place.cleanup()

    def tearDown(self):
        self.browser.open("about:blank")  # the page of a run that has ended keeps asking for another one

    def shown(self):
        """Number of samples in the first curve, and number of frames."""
        return self.browser.evaluate(f"[document.querySelector('figure.chart').chart.series[0].x.length, {GRAINS}.frames.count]")

    def seen(self, condition):
        """Whether it holds; false while the page is replaced by another one."""
        try:
            return self.browser.evaluate(f"!!({condition})")
        except PageError:
            return False

    def test_it_updates_without_a_reload(self):
        wait, evaluate = self.browser.wait, self.browser.evaluate
        with WatchedRun(self.folder, "watched") as run:
            self.browser.open(run.address)
            evaluate("window.sameDocument = true")
            wait("document.querySelector('figure.chart[data-drawn]') && document.querySelector('figure.grains')?.grains.painted")
            curve, frames = self.shown()
            evaluate("document.querySelector('header details').open = true")
            wait(f"document.querySelector('figure.chart').chart.series[0].x.length > {curve} && {GRAINS}.frames.count > {frames + 1}")
            self.assertIn("fall", evaluate("document.querySelector('.progress').textContent"))
            wait(f"{GRAINS}.painted?.number === {GRAINS}.frames.count - 1")  # follows the last frame
            self.assertTrue(evaluate("document.querySelector('header details').open"), "an open section stays open")

            # Another frame or abscissa stays selected.
            evaluate(f"{GRAINS}.player.go(1)")
            wait(f"{GRAINS}.painted?.number === 1")
            step = evaluate(f"{GRAINS}.json.frames[1].step")
            evaluate("""(() => { const choice = document.querySelector('.against select');
                choice.value = 'void_ratio'; choice.dispatchEvent(new Event('change')); })()""")
            frames = evaluate(f"{GRAINS}.frames.count")
            wait(f"{GRAINS}.frames.count > {frames} && {GRAINS}.painted")
            self.assertEqual(evaluate(f"{GRAINS}.json.frames[{GRAINS}.state.frame].step"), step)
            self.assertEqual(evaluate("document.querySelector('.against select').value"), "void_ratio")
            self.assertEqual(self.browser.complaints(), [])

            run.process.send_signal(signal.SIGINT)
            wait("document.querySelector('.status.interrupted')")
            self.assertEqual(run.process.wait(), 130)
            wait("document.querySelector('.progress').textContent.startsWith('The run has ended')")
            self.assertTrue(evaluate("window.sameDocument"))

            # To the last bit, as in the file.
            evaluate("(() => { const choice = document.querySelector('.against select'); choice.value = 'time'; choice.dispatchEvent(new Event('change')); })()")
            with h5py.File(self.folder / "watched/series.h5") as series:
                group = series["packing"]
                for name in ("coordination_number", "kinetic_energy"):
                    got = evaluate(f"""(async () => {{ const charts = document.querySelector('details.probe').charts;
                        const [{{channel}}] = charts.channelsNamed('{name}'); return Array.from(await numbersOf(channel.data), String); }})()""")
                    self.assertEqual([float(value) for value in got], list(group[name][()]))
            self.assertEqual(evaluate(f"{GRAINS}.frames.count"), len(list((self.folder / "watched/frames").glob("*.h5"))))

    def test_maps_profiles_and_directions_are_updated(self):
        wait, evaluate = self.browser.wait, self.browser.evaluate
        probes = {**SCENE["probes"], "forces": {"type": "force-chains", "every_steps": 2000}, "moved": {"type": "displacements", "every_steps": 2000}}
        found = "[...document.querySelectorAll('figure.chart')].find(({{chart}}) => chart.group.name === '{}' && chart.name === '{}').chart".format
        forces, moved = found("forces", "force_by_direction"), found("moved", "profile")
        with WatchedRun(self.folder, "lists", probes=probes) as run:
            self.browser.open(run.address)
            wait("document.querySelectorAll('details.probe').length === 3 && document.querySelector('figure.map')?.map.now")
            evaluate("document.querySelectorAll('details.probe').forEach((part) => (part.open = true))")
            wait("[...document.querySelectorAll('.times .clock')].filter((clock) => clock.textContent).length === 2")
            for chart in (forces, moved):
                evaluate(f"{chart}.draw()")
            evaluate(f"{MAP}.takeField('packing/stress')")
            # Cells of each new frame are decoded in the background; until then there are none.
            frame, end = evaluate(f"""(async () => {{ while (!{MAP}.now) await new Promise((go) => setTimeout(go, 20));
                return [{MAP}.now.number, {moved}.group.choice.now]; }})()""")
            # One slider stays at its time, the other at the end.
            evaluate(f"(() => {{ const {{slider}} = {forces}.group.choice; slider.value = 500; slider.dispatchEvent(new Event('input')); }})()")
            chosen = evaluate(f"{forces}.group.choice.now")
            self.assertLess(chosen, 0.6 * end)
            wait(f"{MAP}.now?.number > {frame + 1} && {moved}.group.choice.now > {1.2 * end}")
            self.assertEqual(evaluate(f"[{forces}.group.choice.now, {MAP}.state.field, {MAP}.fieldChoice.value]"), [chosen, "packing/stress", "packing/stress"])
            self.assertLess(evaluate(f"+{forces}.group.choice.slider.value"), 450)
            self.assertEqual(evaluate(f"{moved}.group.choice.slider.value"), "1000")
            self.assertEqual(self.browser.complaints(), [])

            run.process.send_signal(signal.SIGINT)
            wait("document.querySelector('.progress').textContent.startsWith('The run has ended')")
            self.assertEqual(run.process.wait(), 130)
            last = len(list((self.folder / "lists/frames").glob("*.h5"))) - 1
            wait(f"document.querySelector('.map .stage').dataset.frame === '{last}'")
            with h5py.File(self.folder / "lists/series.h5") as series:
                for chart, name, time in ((forces, "force_by_direction", chosen), (moved, "profile", None)):
                    probe, wanted = evaluate(f"{chart}.group.name"), evaluate(f"Array.from({chart}.series.at(-1).y, String)")
                    times = list(series[f"{probe}/time"])
                    sample = max(i for i, t in enumerate(times) if time is None or t <= time)
                    self.assertEqual([float(value) for value in wanted], list(series[f"{probe}/{name}"][sample]))
            with h5py.File(self.folder / f"lists/frames/{last:06}.h5") as frame:
                shown = evaluate(f"Array.from({MAP}.now.cells.list({MAP}.place({MAP}.field, 0)), String)")
                self.assertEqual([float(value) for value in shown], frame["probes/packing/stress"][:].reshape(len(shown), 9)[:, 0].astype("float32").tolist())

    def test_a_failed_run_is_shown(self):
        # Grains do not come to rest within such a short time.
        stages = [dict(SHORT[0], until={"type": "time", "value": "3 s"}, limit="10 s"),
                  {"name": "rest", "until": {"type": "unbalanced-force", "below": 1e-15}, "limit": "10 ms"}]
        with WatchedRun(self.folder, "failing", stages=stages) as run:
            self.assertEqual(run.ask("/none")[0], 404)  # it is served now
            run.process.send_signal(signal.SIGSTOP)  # it does not end before the browser requests the page
            self.browser.open(run.address)
            run.process.send_signal(signal.SIGCONT)
            self.browser.evaluate("window.sameDocument = true")
            self.browser.wait("document.querySelector('.status.failed')")
            self.assertEqual(run.process.wait(), 4)
            self.browser.wait("document.querySelector('.progress').textContent.startsWith('The run has ended')")
            self.assertTrue(self.browser.evaluate("window.sameDocument"))
            message = json.loads((self.folder / "failing/run.json").read_text())["message"]
            self.assertIn("/stages/1", message)
            self.assertEqual(self.browser.evaluate("document.querySelector('.message').textContent"), message)
            # All its results are complete.
            with h5py.File(self.folder / "failing/series.h5") as series:
                self.browser.wait(f"document.querySelector('figure.chart')?.chart.series?.[0].x.length === {len(series['packing/time'])}")
            self.assertEqual(self.browser.evaluate(f"{GRAINS}.frames.count"), len(list((self.folder / "failing/frames").glob("*.h5"))))
            self.assertEqual([one for one in self.browser.complaints() if "ERR_CONNECTION_REFUSED" not in one], [], "only refused connections")

    def test_a_page_that_is_busy_when_the_run_ends_gets_the_last_state(self):
        with WatchedRun(self.folder, "busy") as run:
            self.browser.open(run.address)
            self.browser.wait("document.querySelector('figure.chart[data-drawn]') && document.querySelector('figure.grains')?.grains.painted")
            with self.browser.paused():
                self.assertEqual(run.interrupt(), 130)
            self.browser.wait("document.querySelector('.status.interrupted')")
            self.browser.wait("document.querySelector('.progress').textContent.startsWith('The run has ended')")
            with h5py.File(self.folder / "busy/series.h5") as series:
                self.assertEqual(self.shown(), [len(series["packing/time"]), len(list((self.folder / "busy/frames").glob("*.h5")))])

    def test_removed_frames_disappear(self):
        # As in a run resumed from a checkpoint before its first frame.
        drawn = "document.querySelector('figure.grains')?.grains.painted"
        with WatchedRun(self.folder, "back") as run:
            self.browser.open(run.address)
            self.browser.wait(drawn)
            left = self.browser.evaluate("""(async () => {
                const grains = document.getElementById('grains'), maps = document.getElementById('maps');
                report.runs[0].grains = null;
                await Follower.prototype.showFrames(grains, maps);
                return [grains.children.length, maps.children.length]; })()""")
            self.assertEqual(left, [0, 0])
            self.browser.wait(drawn)  # new data arrived
            self.assertEqual(self.browser.complaints(), [])

    def test_it_requests_nothing_else(self):
        with WatchedRun(self.folder, "asking") as run:
            self.browser.open(run.address)
            self.browser.wait("document.querySelector('figure.chart[data-drawn]') && document.querySelector('figure.grains')?.grains.painted")
            asked = self.browser.requests()
            self.assertGreater(len(asked), 0)
            for url in asked:
                self.assertTrue(url.startswith(run.address + "new?since="), url)

    def test_the_next_run_at_a_port_is_shown(self):
        with WatchedRun(self.folder, "first") as run:
            port = run.port
            self.browser.open(run.address)
            self.browser.wait("document.querySelector('.status.running')")
            self.assertEqual(run.interrupt(), 130)
        with WatchedRun(self.folder, "second", "--port", str(port), title="the next one"):
            while not self.seen("document.querySelector('h1')?.textContent === 'the next one' && document.querySelector('.status.running')"):
                pass


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    GRIT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=1)
