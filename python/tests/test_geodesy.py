# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests places on the Earth: the constants of tests/core/geodesy_test.cpp, and the places that the program
writes into a data set."""

import unittest

import numpy as np

import greatx
import support
from greatx.geodesy import LocalFrame, geocentric, geodetic

SITE = """
greatx: 1
name: site
ticks: 3
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 9, size_m: 60}, optical_only: true,
  georeference: {latitude_deg: -17, longitude_deg: 179.99999, height_m: 60, undulation_m: 61.5,
                 vertical_datum: MSL}}
environment: {clouds: 0}
nodes:
  - name: mast
    trajectory: {type: static, position_deg: [-17.0001, -179.9999, 8]}
  - name: eye
    trajectory: {type: waypoints, points: [{t_s: 0, position_deg: [-17, 179.9999, 2]}, \
{t_s: 1, position_deg: [-17, -179.9999, 2]}]}
    sensors: [{name: cam, type: camera, rate_hz: 10, width: 8, height: 6, fov_deg: 60}]
"""

# (origin, place, x y z) by PROJ 9.1.1, as in tests/core/geodesy_test.cpp.
PROJ = [
    ((52.0116, 4.3571, 45.0), (52.05, 4.5, 60.0), (9803.232578, 4282.363689, 6.043678)),
    ((52.0116, 4.3571, 45.0), (52.0116, 4.2115, 45.0), (-9996.993940, 10.011041, -7.818219)),
    ((-17.0, 179.99, 60.0), (-17.02, -179.95, 30.0), (6388.500656, -2214.375723, -33.585161)),
    ((-17.0, 179.99, 60.0), (-16.95, 179.93, 530.0), (-6391.371345, 5532.932676, 464.385090)),
    ((-54.8, -68.3, 25.0), (-54.72, -68.2, 1500.0), (6445.408564, 8903.023610, 1465.539073)),
    ((90.0, 0.0, 0.0), (89.92, 12.0, 10.0), (1857.801019, -8740.266610, 3.761823)),
    ((-90.0, 30.0, 2835.0), (-89.92, 45.0, 2850.0), (2313.711495, 8634.888855, 8.759054)),
]


class Geodesy(unittest.TestCase):
    """The formulas are those of the program."""

    def test_proj(self):
        for origin, place, expected in PROJ:
            frame = LocalFrame(*origin)
            np.testing.assert_allclose(frame.local(place), expected, rtol=0, atol=1e-6)
            there = geocentric(frame.place(expected))
            np.testing.assert_allclose(there, geocentric(place), rtol=0, atol=1e-6)

    def test_guidance_note(self):
        place = [53 + 48 / 60 + 33.820 / 3600, 2 + 7 / 60 + 46.380 / 3600, 73.0]
        expected = [3771793.968, 140253.342, 5124304.349]
        np.testing.assert_allclose(geocentric(place), expected, rtol=0, atol=1e-3)
        local = LocalFrame(55, 5, 200).local(place)
        np.testing.assert_allclose(local, [-189013.869, -128642.040, -4220.171], rtol=0, atol=1e-3)

    def test_round_trip_of_arrays(self):
        latitude, longitude, height = np.meshgrid(
            np.linspace(-90, 90, 37), np.linspace(-180, 165, 24), [-1000.0, 0.0, 1e6], indexing="ij"
        )
        places = np.stack([latitude, longitude, height], axis=-1)
        positions = geocentric(places)
        back = geodetic(positions)
        self.assertEqual(back.shape, (37, 24, 3, 3))
        self.assertLess(np.abs(geocentric(back) - positions).max(), 1e-8)
        self.assertLess(np.abs(back[..., 2] - height).max(), 1e-8)
        self.assertEqual(geodetic([0.0, 0.0, 6356752.314245179 + 5.0])[1], 0.0)

    def test_heights(self):
        frame = LocalFrame(52, 4, 45, 43.4, "NAP")
        np.testing.assert_allclose(frame.local([52, 4, 1.6], heights="datum"), [0, 0, 0], atol=1e-8)
        self.assertAlmostEqual(frame.place([0, 0, 0], heights="datum")[2], 1.6, places=8)

    def test_faults(self):
        frame = LocalFrame(52, 4, 45)
        for act, words in (
            (lambda: LocalFrame(91, 0, 0), "LocalFrame: latitude_deg: expected -90 to 90, found 91"),
            (lambda: LocalFrame(0, float("nan"), 0), "LocalFrame: longitude_deg: expected -180 to 180"),
            (lambda: frame.local([1, 2]), r"LocalFrame.local\(\): expected an array \[..., 3\]"),
            (lambda: frame.local([1, 2, 3], heights="sea"), "heights: expected 'ellipsoid' or 'datum'"),
            (lambda: geodetic(1.0), r"geodetic\(\): expected an array"),
            (lambda: LocalFrame.of(greatx.load(support.truth())), "expected a scene with a georeference"),
        ):
            with self.assertRaisesRegex(greatx.Error, words):
                act()


class Site(unittest.TestCase):
    """A data set says where its nodes are."""

    @classmethod
    def setUpClass(cls):
        cls.ds = greatx.load(support.made("site", SITE))

    def test_places(self):
        poses = self.ds.single().poses
        tick = self.ds.single().at(2)["poses"]
        self.assertEqual(tick.geodetic.shape, (2, 3))
        frame = LocalFrame.of(self.ds)
        places = np.array(poses["geodetic"])
        self.assertEqual(places.shape, (3, 2, 3))
        np.testing.assert_allclose(places, frame.place(poses["position"]), rtol=0, atol=1e-8)
        np.testing.assert_allclose(tick.geodetic[0], [-17.0001, -179.9999, 69.5], rtol=0, atol=1e-8)
        # The way from 179.9999 to -179.9999 degrees goes on eastwards, a tenth of it a tick.
        np.testing.assert_allclose(places[:, 1, 1], [179.9999, 179.99992, 179.99994], rtol=0, atol=1e-9)
        self.assertEqual(poses.metadata["undulation_m"], 61.5)
        self.assertEqual(poses.metadata["vertical_datum"], "MSL")

    def test_georeference(self):
        self.assertEqual(
            self.ds.georeference,
            {
                "latitude_deg": -17,
                "longitude_deg": 179.99999,
                "height_m": 60,
                "undulation_m": 61.5,
                "vertical_datum": "MSL",
            },
        )
        self.assertIsNone(greatx.load(support.truth()).georeference)

    def test_hostile_georeference(self):
        copy = support.copy_of(self.ds.path)
        support.edit_json(
            copy / "dataset.json", lambda info: info["run"]["georeference"].update(latitude_deg=1e9)
        )
        with self.assertRaisesRegex(
            greatx.DatasetError, r"run\.georeference\.latitude_deg: expected a number from -90 to 90"
        ):
            greatx.load(copy).georeference


if __name__ == "__main__":
    unittest.main()
