# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests heights from point clouds: cells of arrays, and files if laspy is installed."""

import contextlib
import importlib.util
import io
import pathlib
import tempfile
import unittest
from unittest import mock

import numpy as np

from greatx import Error, point_cloud
from greatx.point_cloud import Bounds, Grid

HAS_LASPY = importlib.util.find_spec("laspy") is not None


def run(*arguments):
    """Returns exit code, output and errors of the command."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = point_cloud.main([str(a) for a in arguments])
    return code, out.getvalue(), err.getvalue()


class Cells(unittest.TestCase):
    def test_terrain_is_the_mean_of_ground_and_surface_the_highest_but_noise(self):
        grid = Grid(Bounds(10.2, 20.1, 11.9, 20.9), 1.0)
        self.assertEqual((grid.columns, grid.rows, grid.west, grid.south), (2, 1, 10.0, 20.0))
        x = np.array([10.2, 10.4, 10.6, 10.8, 10.9, 11.5])
        z = np.array([1.0, 3.0, 9.0, 99.0, -50.0, 7.0])
        grid.add(x, np.full(6, 20.5), z, np.array([2, 2, 6, 18, 7, 1]))
        np.testing.assert_array_equal(grid.terrain(), [[2.0, np.nan]])
        np.testing.assert_array_equal(grid.surface(), [[9.0, 7.0]])
        self.assertEqual((grid.points, grid.ground_points, grid.noise_points), (6, 2, 2))

    def test_rows_run_from_the_north_and_edges_belong_to_the_north_and_east(self):
        grid = Grid(Bounds(-1.0, -1.0, 1.0, 1.0), 0.5)
        self.assertEqual((grid.columns, grid.rows), (5, 5))
        grid.add(
            np.array([-1.0, 1.0, 0.5]), np.array([-1.0, 1.0, 0.0]), np.array([1.0, 2.0, 3.0]), np.ones(3)
        )
        surface = grid.surface()
        self.assertEqual((surface[4, 0], surface[0, 4], surface[2, 3]), (1.0, 2.0, 3.0))
        self.assertEqual(int(np.isnan(surface).sum()), 22)

    def test_chunks_give_the_same_as_all_at_once(self):
        random = np.random.default_rng(5)
        x, y, z = random.uniform(0, 20, (3, 4000))
        classes = random.choice([1, 2, 6, 7], 4000)
        whole, parts = Grid(Bounds(0, 0, 20, 20), 0.7), Grid(Bounds(0, 0, 20, 20), 0.7)
        whole.add(x, y, z, classes)
        for i in range(0, 4000, 333):
            parts.add(*(a[i : i + 333] for a in (x, y, z, classes)))
        np.testing.assert_allclose(parts.terrain(), whole.terrain(), rtol=1e-13)
        np.testing.assert_array_equal(parts.surface(), whole.surface())
        for i in range(50):  # against the definition
            row, column = i % whole.rows, i // whole.rows
            inside = (np.floor(x / 0.7) == column) & (np.floor(y / 0.7) == whole.rows - 1 - row)
            ground = inside & (classes == 2)
            expected = z[ground].mean() if ground.any() else np.nan
            np.testing.assert_allclose(whole.terrain()[row, column], expected, rtol=1e-12)

    def test_faults(self):
        for cell in (0.0, -1.0, float("nan")):
            with self.assertRaisesRegex(Error, "cell: expected a positive size"):
                Grid(Bounds(0, 0, 1, 1), cell)
        with self.assertRaisesRegex(Error, "take larger cells"):
            Grid(Bounds(0, 0, 1e6, 1e6), 0.5)
        grid = Grid(Bounds(0, 0, 1, 1), 0.5)
        with self.assertRaisesRegex(Error, "1 lie outside"):
            grid.add(np.array([5.0]), np.zeros(1), np.zeros(1), np.zeros(1))
        with self.assertRaisesRegex(Error, "finite"):
            grid.add(np.zeros(1), np.zeros(1), np.array([np.nan]), np.zeros(1))

    def test_ascii_grid(self):
        text = point_cloud.ascii_grid(np.array([[1.0, np.nan], [2.5, -3.25]]), 100.0, 200.5, 0.5)
        self.assertEqual(
            text,
            "ncols 2\nnrows 2\nxllcorner 100.0\nyllcorner 200.5\ncellsize 0.5\nNODATA_value -9999\n"
            "1.000 -9999\n2.500 -3.250\n",
        )


class Command(unittest.TestCase):
    def test_without_laspy_it_says_what_to_install(self):
        with mock.patch.dict("sys.modules", {"laspy": None}):
            code, _, errors = run("a.las", "--terrain", "t.asc")
        self.assertEqual(code, 1)
        self.assertIn("pip install laspy lazrs", errors)

    def test_without_outputs(self):
        code, _, errors = run("a.las")
        self.assertEqual(code, 1)
        self.assertIn("--terrain, --surface or both", errors)


@unittest.skipUnless(HAS_LASPY, "laspy is not installed")
class Files(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())

    def write(self, name, x, z, classes, epsg=None, withheld=None):
        import laspy

        header = laspy.LasHeader(point_format=6, version="1.4")
        header.offsets, header.scales = [0, 0, 0], [0.001, 0.001, 0.001]
        if epsg is not None:
            header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(f'PROJCS["{epsg}"]'))
        cloud = laspy.LasData(header)
        cloud.x, cloud.y, cloud.z = np.array(x), np.full(len(x), 500.25), np.array(z)
        cloud.classification = np.array(classes, np.uint8)
        if withheld is not None:
            cloud.withheld = np.array(withheld)
        path = self.folder / name
        cloud.write(path)
        return path

    def test_las_and_laz(self):
        names = ["a.las"] + (["a.laz"] if importlib.util.find_spec("lazrs") is not None else [])
        for name in names:
            path = self.write(name, [100.2, 100.3, 101.7], [5.0, 8.0, 6.0], [2, 6, 2], "here", [0, 0, 0])
            terrain, surface = self.folder / "t.asc", self.folder / "s.asc"
            code, out, errors = run(path, "--terrain", terrain, "--surface", surface, "--cell", 1)
            self.assertEqual((code, errors), (0, ""))
            self.assertIn("3 points, 2 on the ground, 0 noise", out)
            self.assertTrue(terrain.read_text().endswith("NODATA_value -9999\n5.000 6.000\n"))
            self.assertTrue(surface.read_text().endswith("NODATA_value -9999\n8.000 6.000\n"))
            self.assertEqual((self.folder / "t.prj").read_text(), 'PROJCS["here"]\n')

    def test_withheld_points_and_several_files(self):
        one = self.write("1.las", [100.2, 100.4], [5.0, 50.0], [2, 2], withheld=[0, 1])
        two = self.write("2.las", [102.6], [7.0], [2])
        code, out, errors = run(one, two, "--terrain", self.folder / "t.asc", "--cell", 1)
        self.assertEqual((code, errors), (0, ""))
        self.assertIn("5.000 -9999 7.000", (self.folder / "t.asc").read_text())
        self.assertIn("3 x 1 cells, 1 without a height", out)
        self.assertIn("place.yaml needs crs", out)
        self.assertFalse((self.folder / "t.prj").exists())

    def test_faults(self):
        unclassified = self.write("u.las", [1.0], [1.0], [0])
        code, _, errors = run(unclassified, "--terrain", self.folder / "t.asc")
        self.assertEqual(code, 1)
        self.assertIn("no point has the class ground", errors)
        other = self.write("o.las", [1.0], [1.0], [2], "elsewhere")
        code, _, errors = run(unclassified, other, "--surface", self.folder / "s.asc")
        self.assertEqual(code, 1)
        self.assertIn("expected the coordinate system of", errors)
        damaged = self.folder / "d.las"
        damaged.write_bytes(b"LASF" + bytes(50))
        code, _, errors = run(damaged, "--terrain", self.folder / "t.asc")
        self.assertEqual(code, 1)
        self.assertIn("d.las: expected a LAS or LAZ file", errors)


if __name__ == "__main__":
    unittest.main()
