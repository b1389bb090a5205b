#!/usr/bin/env python3
"""The Python module against plain h5py, and its words for what is not there.

usage: test_grit.py GRIT     exit status 77 where there is no h5py
"""

import fcntl
import json
import os
import pathlib
import shutil
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

try:
    import h5py
    import numpy
except ImportError:
    print("skipped: Python's h5py is not installed (Debian: python3-h5py)")
    sys.exit(77)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
import grit.results

GRIT = None

SCENE = {
    "title": "two grains that fall",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "1 MPa"}},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": [
        {"position": [0, 0, "2 mm"], "radius": "1 mm"}, {"position": [0, "3 mm", "2 mm"], "radius": "1 mm"}]}}},
    "walls": {"floor": {"type": "rectangle", "corner": ["-10 mm", "-10 mm", 0], "edge_a": ["20 mm", 0, 0], "edge_b": [0, "20 mm", 0], "material": "sand"}},
    "engines": {"gravity": {"type": "gravity"}},
    "stages": [{"name": "fall", "until": {"type": "time", "value": "20 ms"}, "limit": "1 s"}],
    "probes": {"packing": {"type": "packing", "every_time": "1 ms"}},
    "output": {"frames": {"every_time": "5 ms"}},
}


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="grit-python-")
        cls.folder = pathlib.Path(cls.place.name)
        (cls.folder / "fall.json").write_text(json.dumps(SCENE))
        subprocess.run([GRIT, "run", "fall.json", "--out", "fall", "--threads", "1", "--quiet", "--no-report"], cwd=cls.folder, check=True,
                       stdout=subprocess.DEVNULL)
        cls.run_ = grit.open(cls.folder / "fall")

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def copy(self, status="done"):
        target = self.folder / self.id().rsplit(".", 1)[1]
        shutil.copytree(self.folder / "fall", target)
        facts = json.loads((target / "run.json").read_text())
        (target / "run.json").write_text(json.dumps({**facts, "status": status}))
        return target

    def test_run_json_as_attributes(self):
        written = json.loads((self.folder / "fall/run.json").read_text())
        self.assertEqual((self.run_.status, self.run_.bodies), ("done", 2))
        for key, value in written.items():
            self.assertEqual(getattr(self.run_, key), value)
        self.assertEqual(self.run_.description["title"], SCENE["title"])
        self.assertIn("time_step_s", dir(self.run_))
        with self.assertRaisesRegex(AttributeError, "there is no key of run.json 'statu'; did you mean 'status'"):
            self.run_.statu

    def test_series_are_those_of_the_file(self):
        with h5py.File(self.folder / "fall/series.h5") as file:
            names = [f"{probe}/{channel}" for probe in file for channel in file[probe]]
            self.assertEqual(list(self.run_.series), names)
            self.assertEqual(len(self.run_.series), len(names))
            self.assertGreater(len(names), 10)
            for name in names:
                values = self.run_.series[name]
                self.assertIs(type(values), numpy.ndarray)
                self.assertEqual(values.shape, file[name].shape)
                self.assertEqual(values.tobytes(), file[name][()].tobytes())
                self.assertEqual(self.run_.series.units(name), file[name].attrs["units"].decode())
                self.assertEqual(self.run_.series.about(name), file[name].attrs["long_name"].decode())
        self.assertEqual(self.run_.series.units("packing/time"), "s")
        self.assertEqual(self.run_.series["packing/stress"].shape[1:], (3, 3))

    def test_curves_are_drawn(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("matplotlib is not installed")
        matplotlib.use("agg")
        axes = self.run_.plot("packing/kinetic_energy")
        self.assertEqual(axes.lines[0].get_ydata().tobytes(), self.run_.series["packing/kinetic_energy"].tobytes())
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("packing/time [s]", "packing/kinetic_energy [J]"))
        axes = self.run_.plot("packing/kinetic_energy", "packing/void_ratio", against="packing/step")
        self.assertEqual([len(axes.lines), axes.get_xlabel()], [2, "packing/step [1]"])
        with self.assertRaisesRegex(KeyError, "did you mean 'packing/void_ratio'"):
            self.run_.plot("packing/void_rati")

    def test_a_channel_that_is_not_there(self):
        for name, said in (("packing/void_rati", "did you mean 'packing/void_ratio'"), ("void_ratio", "There are: packing/"), ("packing", "There are:"), ("", "There are:")):
            with self.assertRaises(KeyError) as raised:
                self.run_.series[name]
            self.assertIn(f"there is no channel {name!r}", str(raised.exception))
            self.assertIn(said, str(raised.exception))
        self.assertNotIn("packing/nothing", self.run_.series)

    def test_frames_are_those_of_the_files(self):
        files = sorted((self.folder / "fall/frames").iterdir())
        self.assertEqual(len(self.run_.frames), len(files))
        self.assertGreater(len(files), 3)
        for frame, path in zip(self.run_.frames, files):
            with h5py.File(path) as file:
                self.assertEqual((frame.time, frame.step, frame.stage), (file.attrs["time"], file.attrs["step"], file.attrs["stage"].decode()))
                for table, group in ((frame.bodies, file["bodies"]), (frame.contacts, file["contacts"])):
                    self.assertEqual(list(table), sorted(group))
                    for name in table:
                        self.assertEqual(table[name].tobytes(), group[name][()].tobytes())
                        self.assertEqual(table.units(name), group[name].attrs["units"].decode())
                wall, written = frame.walls["floor"], file["walls/floor"]
                self.assertEqual(wall.triangles.tobytes(), written[()].tobytes())
                self.assertEqual(list(wall.force), [written.attrs[f"force_{axis}"] for axis in "xyz"])
                self.assertEqual((wall.index, wall.pressure), (written.attrs["index"], written.attrs["pressure"]))
        self.assertEqual(self.run_.frames[-1].time, self.run_.frames[len(files) - 1].time)
        self.assertEqual([frame.step for frame in self.run_.frames[1:3]], [self.run_.frames[1].step, self.run_.frames[2].step])
        with self.assertRaisesRegex(IndexError, f"there is no frame 99 of {len(files)}"):
            self.run_.frames[99]
        with self.assertRaisesRegex(KeyError, "there is no array 'positon'; did you mean 'position'"):
            self.run_.frames[0].bodies["positon"]
        self.assertEqual(len(self.run_.frames[0].clumps), 0)

    def test_records_are_rows(self):
        bodies = self.run_.frames[0].bodies
        records = bodies.records()
        self.assertEqual(len(records), 2)
        self.assertEqual(set(records.dtype.names), set(bodies))
        self.assertEqual(records["position"].tobytes(), bodies["position"].tobytes())
        self.assertEqual(records[1]["radius"], bodies["radius"][1])
        self.assertEqual(len(self.run_.frames[0].clumps.records()), 0)
        self.assertEqual(list(bodies.all()), list(bodies))

    def test_a_probe_at_once(self):
        channels = self.run_.series.probe("packing")
        self.assertEqual({f"packing/{name}" for name in channels}, set(self.run_.series))
        for name, values in channels.items():
            self.assertEqual(values.tobytes(), self.run_.series[f"packing/{name}"].tobytes())
        with self.assertRaisesRegex(KeyError, "there is no probe 'pack'; did you mean 'packing'"):
            self.run_.series.probe("pack")

    def test_a_run_that_goes_on_and_is_interrupted(self):
        # It ends when it is told to: a second of it takes hours.
        scene = dict(SCENE, stages=[dict(SCENE["stages"][0], until={"type": "time", "value": "1e6 s"}, limit="1e7 s")],
                     engines={"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.7}},
                     probes={"packing": {"type": "packing", "every_steps": 1000}}, output={"frames": {"every_steps": 200000}})
        (self.folder / "going.json").write_text(json.dumps(scene))
        going = subprocess.Popen([GRIT, "run", "going.json", "--out", "going", "--threads", "1", "--quiet", "--no-report"], cwd=self.folder,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            while not (self.folder / "going/series.h5").exists():
                self.assertIsNone(going.poll())
            run = grit.open(self.folder / "going")
            self.assertEqual(run.status, "running")
            seen = [0]
            while len(seen) < 4 or len(run.frames) < 3:
                samples = run.series.probe("packing")
                self.assertEqual({len(values) for values in samples.values()}, {len(samples["time"])})
                self.assertEqual(samples["step"].tolist(), list(range(0, 1000 * len(samples["step"]), 1000)), "none is missing, torn or from elsewhere")
                if len(samples["time"]) > seen[-1]:
                    seen.append(len(samples["time"]))
            for frame in run.frames:
                self.assertEqual(frame.bodies["position"].shape, (2, 3))
        finally:
            going.send_signal(signal.SIGINT)
            self.assertEqual(going.wait(), 130)
        self.assertEqual(run.status, "running", "run.json is as it was when the run was opened")
        run = grit.open(self.folder / "going")
        self.assertEqual(run.status, "interrupted")
        self.assertGreater(len(run.series["packing/time"]), seen[-1])
        self.assertEqual((run.frames[-1].step, run.frames[-1].time), (run.steps, run.time))

    def test_a_file_that_is_being_written_is_waited_for(self):
        target = self.copy()
        whole, series = (target / "series.h5").read_bytes(), target / "series.h5"
        series.write_bytes(whole[:300])
        looks = []

        def mend(path, stamp=grit.results._stamp):
            looks.append(path)
            if len(looks) == 2:
                series.write_bytes(whole)
            return stamp(path)

        with unittest.mock.patch("grit.results._stamp", mend):
            self.assertEqual(grit.open(target).series["packing/time"].tobytes(), self.run_.series["packing/time"].tobytes())

    def test_a_file_that_bears_the_mark_of_its_writer_is_not_believed(self):
        target = self.copy()
        whole, series, run = (target / "series.h5").read_bytes(), target / "series.h5", grit.open(target)
        with series.open("r+b") as writer, unittest.mock.patch("grit.results._PATIENCE", 0):
            fcntl.fcntl(writer, fcntl.F_OFD_SETLK, struct.pack("hhqqi0q", fcntl.F_WRLCK, 0, 0, 0, 0))
            os.utime(series, (0, 0))  # it has rested for long, as where a writer got no processor
            for cut in (0, 100, 300, len(whole) // 2, len(whole)):
                writer.truncate(cut)
                os.utime(series, (0, 0))
                with self.assertRaisesRegex(grit.ResultsError, "series.h5: has been written to for 0 s; try again"):
                    run.series["packing/time"]
        series.write_bytes(whole)
        self.assertEqual(run.series["packing/time"].tobytes(), self.run_.series["packing/time"].tobytes())

    def test_fields_of_probes_and_vectors_of_walls(self):
        target = self.copy()
        with h5py.File(target / "frames/000000.h5", "r+") as file:
            for place, (name, axis) in enumerate((name, axis) for name in ("displacement", "force") for axis in "xyz"):
                file["walls/floor"].attrs[f"{name}_{axis}"] = place
            field = file.create_dataset("probes/cells/centre", data=numpy.arange(6.0).reshape(2, 3))
            field.attrs["units"] = numpy.bytes_("m")
        wall = grit.open(target).frames[0].walls["floor"]
        self.assertEqual((wall.displacement.tolist(), wall.force.tolist()), ([0, 1, 2], [3, 4, 5]))
        cells = grit.open(target).frames[0].probes["cells"]
        self.assertEqual(cells["centre"].tolist(), [[0, 1, 2], [3, 4, 5]])
        self.assertEqual(cells.units("centre"), "m")

    def test_no_run_is_said(self):
        for folder in (self.folder / "nowhere", self.folder, self.folder / "fall.json"):
            with self.assertRaisesRegex(grit.ResultsError, r"holds no run \(no run.json\); give a folder that 'grit run' has written"):
                grit.open(folder)

    def test_what_is_torn_or_missing_is_said(self):
        target = self.copy("interrupted")
        run = grit.open(target)
        (target / "series.h5").write_bytes((target / "series.h5").read_bytes()[:300])
        with self.assertRaisesRegex(grit.ResultsError, "series.h5: cannot be read: .*the file is damaged"):
            run.series["packing/time"]
        (target / "series.h5").unlink()
        with self.assertRaisesRegex(grit.ResultsError, "series.h5: there is no such file"):
            list(run.series)
        (target / "frames/000001.h5").write_bytes(b"")
        with self.assertRaisesRegex(grit.ResultsError, "000001.h5: cannot be read"):
            run.frames[1]
        (target / "run.json").write_text('{"status": ')
        with self.assertRaisesRegex(grit.ResultsError, "run.json: not JSON"):
            grit.open(target)

    def test_what_is_no_regular_file_is_refused_before_it_is_opened(self):
        readers = {"run.json": lambda folder: grit.open(folder), "series.h5": lambda folder: list(grit.open(folder).series),
                   "frames/000001.h5": lambda folder: grit.open(folder).frames[1]}
        kinds = {"a named pipe": os.mkfifo, "a folder": os.mkdir, "a device": lambda path: os.symlink("/dev/zero", path), "a socket": lambda path: os.mknod(path, stat.S_IFSOCK | 0o600)}
        target = self.copy()
        for name, read in readers.items():
            path, kept = target / name, target / "kept"
            path.rename(kept)
            for kind, make in kinds.items():
                make(path)
                with self.assertRaisesRegex(grit.ResultsError, f"{name}: is {kind}, not a file that grit wrote; restore it", msg=name):
                    read(target)
                path.rmdir() if kind == "a folder" else path.unlink()
            os.symlink(path.name, path)
            with self.assertRaisesRegex(grit.ResultsError, f"{name}: cannot be read: Too many levels"):
                read(target)
            path.unlink()
            kept.rename(path)
        self.assertEqual(grit.open(target).frames[1].step, self.run_.frames[1].step)

    def test_run_json_that_is_no_facts_of_a_run_is_refused(self):
        target = self.copy()
        facts = json.loads((target / "run.json").read_text())
        del facts["status"]
        for text in ("[]", "null", "3", '"done"', "{}", '{"status": null}', '{"status": ["done"]}', json.dumps(facts)):
            (target / "run.json").write_text(text)
            with self.assertRaisesRegex(grit.ResultsError, "run.json: is no JSON object with a text 'status'; the file is damaged", msg=text):
                grit.open(target)
        for content in (b"", b"[" * 100000, b'{"status": "\xff"}', b"\xff\xfe{}", b'{"time": 1' + b"0" * 5000 + b"}"):
            (target / "run.json").write_bytes(content)
            with self.assertRaisesRegex(grit.ResultsError, "run.json: not JSON: ", msg=content[:20]):
                grit.open(target)

    def test_frames_that_are_no_folder_are_refused(self):
        target = self.copy()
        run = grit.open(target)
        (target / "frames").rename(target / "away")
        self.assertEqual(len(run.frames), 0)
        (target / "frames").write_text("")
        for read in (lambda: len(run.frames), lambda: run.frames[0], lambda: list(run.frames)):
            with self.assertRaisesRegex(grit.ResultsError, "frames: cannot be read: Not a directory; restore the folder"):
                read()

    def test_frames_without_what_grit_writes_are_refused(self):
        target = self.copy()
        path, run = target / "frames/000001.h5", grit.open(target)
        whole = path.read_bytes()

        def attribute(place, name, value):
            return lambda file: file[place].attrs.__setitem__(name, value)

        def replaced(place, value):
            return lambda file: (file.__delitem__(place), file.__setitem__(place, value))

        def grouped(place):
            return lambda file: (file.__delitem__(place), file.create_group(place))

        def refused(change, words, read=lambda frame: None):
            path.write_bytes(whole)
            with h5py.File(path, "r+") as file:
                change(file)
            os.utime(path, (0, 0))
            with self.assertRaisesRegex(grit.ResultsError, f"000001.h5.*: {words}"):
                read(run.frames[1])

        for name in ("time", "step", "stage"):
            refused(lambda file: file.attrs.__delitem__(name), f"lacks the attribute '{name}'")
        refused(attribute("/", "time", numpy.bytes_("soon")), "its attribute 'time' is a text, not a number")
        refused(attribute("/", "stage", 3), "its attribute 'stage' is a number, not a text")
        for value in (numpy.nan, numpy.inf):
            refused(attribute("/", "step", value), "cannot be read: cannot convert float")
        refused(attribute("/", "stage", numpy.bytes_(b"\xff")), "cannot be read: 'utf-8' codec")
        refused(lambda file: file.__delitem__("walls"), "lacks 'walls'")
        refused(lambda file: file.__delitem__("probes"), "lacks 'probes'")
        refused(replaced("walls", 3.0), "'walls' is no group")
        refused(grouped("walls/floor"), "'floor' is no dataset")
        refused(attribute("walls/floor", "index", numpy.inf), "cannot be read: cannot convert float")
        refused(attribute("walls/floor", "force_x", numpy.bytes_("much")), "its attribute 'force_x' is a text")
        refused(replaced("bodies", 3.0), "'bodies' is no group", lambda frame: frame.bodies["radius"])
        for read in (lambda frame: frame.bodies["radius"], lambda frame: frame.bodies.all(), lambda frame: frame.bodies.units("radius")):
            refused(grouped("bodies/radius"), "'radius' is no dataset", read)
        for radius in ([1.0], 1.0):
            refused(replaced("bodies/radius", radius), "its arrays have different numbers of rows", lambda frame: frame.bodies.records())
        refused(attribute("bodies/radius", "units", 3), "its attribute 'units' is a number", lambda frame: frame.bodies.units("radius"))
        path.write_bytes(whole)
        for name in (3, "", ".", "/", "position/", "../bodies/radius"):
            with self.assertRaisesRegex(grit.ResultsError, "there is no array"):
                run.frames[1].bodies[name]

    def test_flipped_bytes_are_found(self):
        target = self.copy()
        run = grit.open(target)
        frame, series = target / "frames/000001.h5", target / "series.h5"
        before = {name: values.tobytes() for name, values in run.frames[1].bodies.all().items()}

        def flipped(path, act):
            whole = path.read_bytes()
            for place in range(0, len(whole) - 60, max(1, len(whole) // 300)):
                path.write_bytes(whole[:place] + bytes([whole[place] ^ 1 << place % 8]) + whole[place + 1:])
                os.utime(path, (0, place))  # it has rested
                act(place)
            path.write_bytes(whole)

        def frame_is_the_same_or_refused(place):
            try:
                now = run.frames[1]
                self.assertEqual(({name: values.tobytes() for name, values in now.bodies.all().items()}, now.stage), (before, "fall"), place)
            except (grit.ResultsError, KeyError):
                pass

        def series_are_refused(place):
            with self.assertRaisesRegex(grit.ResultsError, "series.h5: is damaged, or was changed by another program", msg=place):
                run.series["packing/time"]

        whole = series.read_bytes()
        series.write_bytes(whole[:-1])
        os.utime(series, (0, 0))
        with self.assertRaisesRegex(grit.ResultsError, "series.h5: is damaged: its run is done, and the checksum at its end is missing"):
            run.series["packing/time"]
        series.write_bytes(whole)
        flipped(frame, frame_is_the_same_or_refused)
        flipped(series, series_are_refused)

    def test_odd_files_are_refused_in_words(self):
        target = self.copy("interrupted")
        series, run = target / "series.h5", grit.open(target)

        def refused(act, words):
            with h5py.File(series, "w") as file:
                group = file.create_group("packing")
                group["time"] = numpy.arange(3.0)
                group["time"].attrs["units"] = numpy.bytes_("s")
                act(file)
            os.utime(series, (0, 0))
            with self.assertRaisesRegex(grit.ResultsError, words):
                run.series["packing/time"], run.series.units("packing/time")
            report = subprocess.run([GRIT, "report", target, "--out", target / "odd.html"], capture_output=True, text=True)
            self.assertGreaterEqual(report.returncode, 0, report.stderr)
            self.assertIn("series.h5", report.stderr)

        def replace(file, **dataset):
            del file["packing/time"]
            file["packing"].create_dataset("time", **dataset)

        def link(file):
            file["packing/more"] = h5py.ExternalLink(str(target / "frames/000000.h5"), "/bodies/radius")
            del file["packing/time"]
            file["packing/time"] = h5py.SoftLink("/packing/more")

        refused(link, "is a link")
        refused(lambda file: file["packing/time"].attrs.create("units", "s"), "neither a number nor a text of fixed length")
        refused(lambda file: file["packing/time"].attrs.create("units", [1, 2, 3]), "neither a number nor a text of fixed length")
        refused(lambda file: replace(file, shape=(1 << 45,), chunks=(1024,), dtype="f8"), "more numbers than a file of")
        refused(lambda file: replace(file, shape=(1 << 20,), chunks=(1 << 20,), compression="gzip", dtype="f8"), "does not hold plain numbers")
        refused(lambda file: replace(file, shape=(3,), dtype="f8", external=[(str(target / "run.json"), 0, 24)]), "does not hold plain numbers")
        refused(lambda file: replace(file, data=numpy.array([(1, 2)], dtype="i4,i4")), "does not hold plain numbers")
        refused(lambda file: replace(file, data="text"), "does not hold plain numbers")
        refused(lambda file: (file.__delitem__("packing/time"), file.create_group("packing/time")), "'time' is no dataset")
        refused(lambda file: (file.__delitem__("packing"), file.create_dataset("packing", data=1.0)), "'packing' is no group")
        for read in (lambda: list(run.series), lambda: len(run.series), lambda: run.series.probe("packing"), lambda: "packing/time" in run.series):
            with self.assertRaisesRegex(grit.ResultsError, "'packing' is no group"):
                read()


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    GRIT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=1)
