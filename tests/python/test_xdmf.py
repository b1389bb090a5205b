#!/usr/bin/env python3
"""What ParaView's own reader makes of frames.xdmf, held against the frames.

usage: test_xdmf.py GRIT     exit status 77 where there is no h5py or no ParaView
"""

import json
import pathlib
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

GRAIN = {"type": "sphere", "material": "sand"}
SCENE = {
    "title": "a clump and a grain that fall on each other",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "1 MPa"}},
    "bodies": {
        "single": {**GRAIN, "grains": {"type": "list", "grains": [{"position": [0, 0, "1 mm"], "radius": "1 mm"}]}},
        "pair": {"type": "clump", "material": "sand", "shape": {"type": "rod"}, "grains": {"type": "list", "grains": [{"position": [0, 0, "3.2 mm"], "radius": "1 mm"}]}},
    },
    "walls": {"box": {"type": "box", "low": ["-5 mm", "-5 mm", 0], "high": ["5 mm", "5 mm", "9 mm"], "open": ["z_high"], "material": "sand"}},
    "engines": {"gravity": {"type": "gravity"}},
    "stages": [{"name": "fall", "until": {"type": "time", "value": "20 ms"}, "limit": "1 s"}],
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

    def test_blocks_are_those_of_the_frames(self):
        reader = vtkXdmf3Reader()
        reader.SetFileName(str(self.folder / "fall/frames.xdmf"))
        reader.UpdateInformation()
        times = reader.GetOutputInformation(0).Get(reader.GetExecutive().TIME_STEPS())
        files = sorted((self.folder / "fall/frames").iterdir())
        self.assertEqual(len(times), len(files))
        touched = 0
        for time, path in zip(times, files):
            reader.UpdateTimeStep(time)
            blocks = reader.GetOutputDataObject(0)
            grains, contacts, box = (blocks.GetBlock(i) for i in range(3))
            with h5py.File(path) as frame:
                self.assertEqual(time, frame.attrs["time"])
                self.check(grains, frame["bodies"], "position")
                self.check(contacts, frame["contacts"], "middle")
                touched += contacts.GetNumberOfPoints()
                bodies, table = frame["bodies"], frame["contacts"]
                place = numpy.searchsorted(bodies["id"][:], table["body_a"][:])
                self.assertTrue(numpy.array_equal(table["middle"][:], bodies["position"][:][place] + table["branch"][:] / 2))
                corners = frame["walls/box"][:]
                self.assertEqual(box.GetNumberOfCells(), len(corners))
                for i, triangle in enumerate(corners):
                    self.assertEqual([box.GetCell(i).GetPoints().GetPoint(k) for k in range(3)], [tuple(corner) for corner in triangle])
                for name in ("radius", "velocity", "spin", "id", "material", "clump"):
                    self.assertTrue(grains.GetPointData().HasArray(name), name)
                for name in ("normal_force", "force", "branch", "body_a", "body_b"):
                    self.assertTrue(contacts.GetPointData().HasArray(name), name)
        self.assertGreater(touched, 3)

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
