#!/usr/bin/env python3
"""The VTK files and LAMMPS dumps of a run, read as XML and text, and by VTK's own reader if there is one.

usage: test_vtk.py GRIT
"""

import base64
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError:
    vtkXMLPolyDataReader = None

GRIT = None
GRAIN = {"type": "sphere", "material": "sand"}
SCENE = {
    "title": "two groups and a clump that fall on each other",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"contact_modulus": "1 MPa"}},
    "bodies": {
        "balls": {**GRAIN, "source": {"type": "list", "bodies": [{"position": [0, 0, "1 mm"], "radius": "1 mm"}]}},
        "grains": {**GRAIN, "source": {"type": "list", "bodies": [{"position": ["3 mm", 0, "2 mm"], "radius": "0.5 mm", "spin": [1, 2, 3]}]}},
        "pair": {"type": "clump", "material": "sand", "shape": {"type": "rod"}, "source": {"type": "list", "bodies": [{"position": [0, 0, "3.2 mm"], "radius": "1 mm"}]}},
    },
    "walls": {"box": {"type": "box", "low": ["-5 mm", "-5 mm", 0], "high": ["5 mm", "5 mm", "9 mm"], "open": ["z_high"], "material": "sand"},
              "shelf": {"type": "plane", "point": [0, 0, "-1 mm"], "extent": "20 mm", "material": "sand"}},
    "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.7}},
    "stages": [{"name": "fall", "until": {"type": "time", "value": "20 ms"}, "limit": "1 s"}],
    "output": {"frames": {"every_time": "5 ms", "formats": ["vtk", "lammps-dump"]}},
}
CODES = {"Float64": "d", "Int64": "q", "Int32": "i"}


def values(array):
    """The numbers of a DataArray."""
    data = base64.b64decode(array.text, validate=True)
    (size,) = struct.unpack("<Q", data[:8])
    assert size == len(data) - 8
    code = CODES[array.get("type")]
    return struct.unpack(f"<{size // struct.calcsize(code)}{code}", data[8:])


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="grit-vtk-")
        folder = pathlib.Path(cls.place.name)
        (folder / "fall.json").write_text(json.dumps(SCENE))
        subprocess.run([GRIT, "run", "fall.json", "--out", "fall", "--threads", "1", "--quiet", "--no-report"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        cls.results = folder / "fall"
        rows = [line for line in (cls.results / "packing.txt").read_text().splitlines() if not line.startswith("#")]
        cls.packing = [tuple(map(float, row.split())) for row in rows]

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def collection(self, name):
        entries = ElementTree.parse(self.results / name).getroot().findall("Collection/DataSet")
        return [(float(entry.get("timestep")), self.results / entry.get("file")) for entry in entries]

    def piece(self, path):
        root = ElementTree.parse(path).getroot()
        self.assertEqual((root.get("type"), root.get("byte_order"), root.get("header_type")), ("PolyData", "LittleEndian", "UInt64"))
        return root.find("PolyData/Piece")

    def arrays(self, piece, part):
        return {array.get("Name"): values(array) for array in piece.findall(f"{part}/DataArray")}

    def test_collections_have_all_frames(self):
        frames = sorted((self.results / "frames").glob("*.h5"))
        self.assertGreater(len(frames), 4)
        for name in ("grains.pvd", "walls.pvd"):
            files = self.collection(name)
            self.assertEqual(len(files), len(frames))
            self.assertEqual([time for time, _ in files], sorted(time for time, _ in files))
            self.assertAlmostEqual(files[-1][0], 20e-3, delta=1e-4)

    def test_grains_are_those_of_the_packing(self):
        path = self.collection("grains.pvd")[-1][1]
        piece = self.piece(path)
        self.assertEqual(piece.get("NumberOfPoints"), str(len(self.packing)))
        position, data = self.arrays(piece, "Points")["position"], self.arrays(piece, "PointData")
        self.assertEqual([(*position[3 * i:3 * i + 3], data["radius"][i]) for i in range(len(self.packing))], self.packing)
        self.assertEqual(data["id"], tuple(range(len(self.packing))))
        self.assertEqual(data["group"][:2], (0, 1))
        self.assertEqual(set(data["group"][2:]), {2})
        self.assertEqual(data["clump"][:2], (-1, -1))
        self.assertEqual(len(data["velocity"]), 3 * len(self.packing))
        first = self.arrays(self.piece(self.collection("grains.pvd")[0][1]), "PointData")
        self.assertEqual(first["spin"][3:6], (1, 2, 3))
        if vtkXMLPolyDataReader is not None:
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(str(path))
            reader.Update()
            grains = reader.GetOutput()
            self.assertEqual(grains.GetNumberOfVerts(), len(self.packing))
            for i, row in enumerate(self.packing):
                self.assertEqual((*grains.GetPoint(i), grains.GetPointData().GetArray("radius").GetValue(i)), row)

    def test_walls_have_their_triangles(self):
        piece = self.piece(self.collection("walls.pvd")[-1][1])
        self.assertEqual(piece.get("NumberOfPolys"), "12")
        self.assertEqual(self.arrays(piece, "CellData")["wall"], (0,) * 10 + (1,) * 2)
        corners = self.arrays(piece, "Points")["position"]
        self.assertEqual(len(corners), 12 * 9)
        for i in range(10 * 9 + 2, 12 * 9, 3):
            self.assertAlmostEqual(corners[i], -1e-3, delta=1e-15)

    def test_a_dump_is_a_packing(self):
        dump = sorted((self.results / "frames").glob("*.dump"))[-1]
        rows = [line.split() for line in dump.read_text().splitlines()[9:]]
        self.assertEqual([tuple(map(float, row[2:6])) for row in rows], self.packing)
        self.assertEqual([row[1] for row in rows[:3]], ["1", "2", "3"])


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    GRIT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=1)
