# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests changes of a scenario's environment from Python: sun, moon, place and time."""

import unittest

import greatx

EMPTY = {"greatx": 1, "name": "empty", "ticks": 1}
PARIS = {"latitude_deg": 48.87, "longitude_deg": 2.29}
NOON, NIGHT = "2026-06-21T13:50:00+02:00", "2026-12-21T01:00:00+01:00"


class Light(unittest.TestCase):
    """`environment=` changes only the named fields."""

    def sim(self, environment=None, **base):
        return greatx.Simulation({**EMPTY, "environment": base}, environment=environment, validation=True)

    def placed(self, environment=None):
        return self.sim(environment, place=PARIS, time=NOON)

    def test_place_stays(self):
        self.assertIsNone(self.sim().place)
        for change in (
            None,
            {"rain_mm_h": 2},
            {"sun": {"illuminance_lux": 5e4}},
            {"moon": {"illuminance_lux": 0.1}},
        ):
            place = self.placed(change).place
            self.assertEqual(place["time"], NOON)
            self.assertAlmostEqual(place["latitude_deg"], 48.87, places=12)
            self.assertAlmostEqual(place["longitude_deg"], 2.29, places=12)

    def test_place_and_time_change_alone(self):
        place = self.placed({"time": NIGHT}).place
        self.assertEqual(place["time"], NIGHT)
        self.assertAlmostEqual(place["latitude_deg"], 48.87, places=12)
        place = self.placed({"place": {"latitude_deg": -33.9}}).place
        self.assertEqual((place["time"], place["latitude_deg"]), (NOON, -33.9))
        self.assertAlmostEqual(place["longitude_deg"], 2.29, places=12)
        self.assertEqual(
            self.sim({"place": PARIS, "time": NIGHT}, sun={"elevation_deg": 10}).place["time"], NIGHT
        )

    def test_place_of_the_scene(self):
        site = {"latitude_deg": -36.85, "longitude_deg": 174.76, "height_m": 60.5, "undulation_m": 33.5}
        base = {**EMPTY, "scene": {"georeference": site}}
        sim = greatx.Simulation(base, environment={"time": NOON}, validation=True)
        self.assertEqual(sim.georeference, {**site, "vertical_datum": ""})
        self.assertEqual(sim.place["time"], NOON)
        self.assertAlmostEqual(sim.place["latitude_deg"], -36.85, places=12)
        self.assertAlmostEqual(sim.place["longitude_deg"], 174.76, places=12)
        self.assertAlmostEqual(sim.place["height_m"], 27.0, places=9)
        self.assertIsNone(self.sim().georeference)
        with self.assertRaisesRegex(greatx.Error, "a scene with a georeference"):
            self.sim({"time": NOON})

    def test_sun_by_hand(self):
        self.assertIsNone(self.placed({"sun": {"azimuth_deg": 10, "elevation_deg": 20}}).place)
        for angle in ("azimuth_deg", "elevation_deg"):
            with self.assertRaisesRegex(
                greatx.Error, rf"environment\.sun\.{angle}: expected azimuth_deg and elevation_deg both"
            ):
                self.placed({"sun": {angle: 10}})
            self.assertIsNone(self.sim({"sun": {angle: 10}}).place)

    def test_what_contradicts_a_place(self):
        for change in (
            {"time": NIGHT, "sun": {"azimuth_deg": 1, "elevation_deg": 2}},
            {"moon": {"azimuth_deg": 1, "elevation_deg": 2}},
        ):
            with self.assertRaisesRegex(
                greatx.Error, "expected nothing: place and time say where the (sun|moon) is"
            ):
                self.placed(change)
        with self.assertRaisesRegex(greatx.Error, "time: expected a place beside it"):
            self.sim({"time": NIGHT})
        with self.assertRaisesRegex(greatx.Error, "latitude_deg: expected .*91"):
            self.placed({"place": {"latitude_deg": 91}})

    def test_pictures_follow(self):
        def luminance(environment):
            sim = self.placed(environment)
            sim.add_node(
                {
                    "name": "eye",
                    "trajectory": {"type": "static", "position_m": [0, 0, 0]},
                    "sensors": [
                        {
                            "name": "up",
                            "type": "camera",
                            "rate_hz": 30,
                            "width": 8,
                            "height": 8,
                            "fov_deg": 60,
                            "outputs": ["hdr"],
                            "mount": {"rotation_deg": [0, -80, 0]},
                        }
                    ],
                }
            )
            return next(iter(sim.run()))["eye/up"].hdr.mean()

        noon, night, low = (
            luminance(None),
            luminance({"time": NIGHT}),
            luminance({"sun": {"azimuth_deg": 10, "elevation_deg": 1}}),
        )
        self.assertLess(night, 1e-4 * noon)
        self.assertNotEqual(low, noon)


if __name__ == "__main__":
    unittest.main()
