#!/usr/bin/env python3
"""What ParaView's own reader makes of frames.xdmf, held against the frames; and that the script in docs/how-to/paraview.md draws.

usage: test_xdmf.py GRIT     exit status 77 where there is no h5py or no ParaView
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    import h5py
    import numpy
    from vtkmodules.vtkIOXdmf3 import vtkXdmf3Reader
    from vtkmodules.util.numpy_support import vtk_to_numpy
except ImportError as error:
    print(f"skipped: {error} (Debian: python3-h5py, python3-paraview)")
    sys.exit(77)

GRIT = None
DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs/how-to/paraview.md"

GRAIN = {"type": "sphere", "material": "sand"}
SCENE = {
    "title": "a clump and a grain that fall on each other",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "1 MPa"}},
    "bodies": {
        "single": {**GRAIN, "source": {"type": "list", "bodies": [{"position": [0, 0, "1 mm"], "radius": "1 mm"}]}},
        "pair": {"type": "clump", "material": "sand", "shape": {"type": "rod"}, "source": {"type": "list", "bodies": [{"position": [0, 0, "3.2 mm"], "radius": "1 mm"}]}},
    },
    "walls": {"box": {"type": "box", "low": ["-5 mm", "-5 mm", 0], "high": ["5 mm", "5 mm", "9 mm"], "open": ["z_high"], "material": "sand"},
              "shelf": {"type": "plane", "point": [0, 0, "-1 mm"], "extent": "20 mm", "material": "sand"}},
    "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.7}},
    "stages": [{"name": "fall", "until": {"type": "time", "value": "40 ms"}, "limit": "1 s"}],
    "output": {"frames": {"every_time": "5 ms"}},
}


class InParaView(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="grit-xdmf-")
        cls.folder = pathlib.Path(cls.place.name)
        (cls.folder / "fall.json").write_text(json.dumps(SCENE))
        subprocess.run([GRIT, "run", "fall.json", "--out", "fall", "--threads", "1", "--quiet", "--no-report"], cwd=cls.folder, check=True,
                       stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def reader(self):
        reader = vtkXdmf3Reader()
        reader.SetFileName(str(self.folder / "fall/frames.xdmf"))
        reader.UpdateInformation()
        return reader

    def times(self):
        reader = self.reader()
        return reader.GetOutputInformation(0).Get(reader.GetExecutive().TIME_STEPS())

    def test_blocks_are_those_of_the_frames(self):
        reader, times = self.reader(), self.times()
        files = sorted((self.folder / "fall/frames").iterdir())
        self.assertEqual(len(times), len(files))
        touched = 0
        for time, path in zip(times, files):
            reader.UpdateTimeStep(time)
            blocks = reader.GetOutputDataObject(0)
            grains, contacts, *walls = (blocks.GetBlock(i) for i in range(blocks.GetNumberOfBlocks()))
            with h5py.File(path) as frame:
                self.assertEqual(time, frame.attrs["time"])
                self.check(grains, frame["bodies"], "position")
                self.check(contacts, frame["contacts"], "middle")
                touched += contacts.GetNumberOfPoints()
                bodies, table = frame["bodies"], frame["contacts"]
                place = numpy.searchsorted(bodies["id"][:], table["body_a"][:])
                self.assertTrue(numpy.array_equal(table["middle"][:], bodies["position"][:][place] + table["branch"][:] / 2))
                self.assertEqual([wall.GetNumberOfCells() for wall in walls], [10, 2])
                for wall, name in zip(walls, ("box", "shelf")):
                    for i, triangle in enumerate(frame[f"walls/{name}"][:]):
                        self.assertEqual([wall.GetCell(i).GetPoints().GetPoint(k) for k in range(3)], [tuple(corner) for corner in triangle])
                for name in ("radius", "velocity", "spin", "id", "material", "clump"):
                    self.assertTrue(grains.GetPointData().HasArray(name), name)
                for name in ("normal_force", "force", "branch", "body_a", "body_b"):
                    self.assertEqual(contacts.GetPointData().HasArray(name), len(table["middle"]) > 0, name)
        self.assertGreater(touched, 10)

    @unittest.skipIf(shutil.which("pvpython") is None or shutil.which("Xvfb") is None, "there is no pvpython or no Xvfb (scripts/install-deps.sh --viewers)")
    def test_the_documented_script_draws_force_chains(self):
        script = re.search("```pvpython\n(.*?)```", DOCS.read_text(), re.S)[1]
        script = script.replace("/home/me/results/box", str(self.folder / "fall"))
        self.assertIn("GoToLast()", script)
        script = script.replace("GoToLast()", f"AnimationTime = {self.times()[1]}")  # while grains touch
        measured = """
tubes.UpdatePipeline(GetAnimationScene().AnimationTime)
lines, contacts = servermanager.Fetch(lines).GetBlock(0), servermanager.Fetch(contacts).GetBlock(0)
ends = [[lines.GetCell(i).GetPoints().GetPoint(k) for k in (0, -1 + lines.GetCell(i).GetNumberOfPoints())] for i in range(lines.GetNumberOfCells())]
import json
print(json.dumps([tubes.GetDataInformation().GetNumberOfCells(), ends]))
"""
        (self.folder / "chains.py").write_text(script + measured)
        screen = subprocess.Popen(["Xvfb", "-displayfd", "1", "-nolisten", "tcp", "-noreset"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        try:
            display = {"DISPLAY": ":" + screen.stdout.readline().strip()}
            ended = subprocess.run(["pvpython", "chains.py"], cwd=self.folder, env={**os.environ, **display}, capture_output=True, text=True)
        finally:
            screen.terminate()
            screen.wait()
            screen.stdout.close()
        self.assertEqual(ended.returncode, 0, ended.stderr)
        cells, ends = json.loads(ended.stdout.splitlines()[-1])
        with h5py.File(sorted((self.folder / "fall/frames").iterdir())[1]) as frame:
            middle, branch = frame["contacts/middle"][:], frame["contacts/branch"][:]
        self.assertGreater(len(branch), 0)
        self.assertGreaterEqual(cells, len(branch))
        # A line for each contact, from the first centre to the second; glyphs have single precision.
        self.assertTrue(numpy.allclose(ends, numpy.stack([middle - branch / 2, middle + branch / 2], axis=1), rtol=0, atol=1e-9))
        from PIL import Image  # ParaView needs it too
        colours = Image.open(self.folder / "force-chains.png").convert("RGB").getcolors(1 << 24)
        self.assertEqual(max(colours)[1], (255, 255, 255))
        self.assertGreater(len(colours), 1, "something is drawn")

    def check(self, points, group, position):
        """Points and all arrays of a block are those of a group."""
        self.assertEqual(points.GetNumberOfPoints(), len(group[position]))
        if points.GetNumberOfPoints() == 0:
            return
        self.assertTrue(numpy.array_equal(vtk_to_numpy(points.GetPoints().GetData()), group[position][:]))
        data = points.GetPointData()
        for i in range(data.GetNumberOfArrays()):
            self.assertTrue(numpy.array_equal(vtk_to_numpy(data.GetArray(i)), group[data.GetArrayName(i)][:]), data.GetArrayName(i))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    GRIT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=1)
