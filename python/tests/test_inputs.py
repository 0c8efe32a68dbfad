# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests greatx.inputs by closed forms, and on the records of a data set."""
import unittest

import numpy as np

import greatx
from greatx import inputs
import support

CARRIER_HZ, SPACING_HZ, SUBCARRIERS = 3.5e9, 390625.0, 256


def one_path(ports_m, cosine, delay_s, amplitude=1.0):
    """Returns H [ports, subcarriers] of a plane wave: an element at d along the axis is ahead by d cosine / c
    (TR 38.901, eq. 7.5-22), at the carrier alone.
    """
    offsets = (np.arange(SUBCARRIERS) - SUBCARRIERS // 2) * SPACING_HZ
    ahead = np.exp(2j * np.pi * CARRIER_HZ / support.C * np.asarray(ports_m) * cosine)
    return amplitude * ahead[:, None] * np.exp(-2j * np.pi * (CARRIER_HZ + offsets) * delay_s)[None, :]


def line(elements, spacing_wl=0.5):
    return np.arange(elements) * spacing_wl * support.C / CARRIER_HZ


class Channels(unittest.TestCase):
    bandwidth_hz = SUBCARRIERS * SPACING_HZ

    def test_a_path_in_the_middle_of_a_cell_has_its_amplitude_there_and_nothing_elsewhere(self):
        for beam, tap in ((0, 0), (5, 17), (-7, 63), (-32, 40)):
            delay_s, amplitude = tap / self.bandwidth_hz, 3e-5 * np.exp(0.7j)
            h = one_path(line(64), beam / (64 * 0.5), delay_s, amplitude)
            value = inputs.angle_delay(h, 64)
            self.assertEqual((value.shape, value.dtype), ((64, 64), np.complex64))
            self.assertEqual(np.unravel_index(np.abs(value).argmax(), value.shape), (32 + beam, tap))
            expected = amplitude * np.exp(-2j * np.pi * CARRIER_HZ * delay_s)
            self.assertLess(abs(value[32 + beam, tap] - expected), 1e-6 * abs(amplitude))
            rest = np.abs(value)
            rest[32 + beam, tap] = 0
            self.assertLess(rest.max(), 1e-6 * abs(amplitude))

    def test_a_path_between_cells_is_the_product_of_two_dirichlet_kernels(self):
        h = one_path(line(16), 2.3 / 8, 20.6 / self.bandwidth_hz)
        value = np.abs(inputs.angle_delay(h))

        def kernel(x, n):
            return np.abs(np.sin(np.pi * x) / (n * np.sin(np.pi * x / n)))

        expected = np.outer(kernel(np.arange(-8, 8) - 2.3, 16), kernel(np.arange(256) - 20.6, 256))
        np.testing.assert_allclose(value, expected, atol=2e-6)

    def test_parseval(self):
        rng = np.random.default_rng(1)
        h = rng.normal(size=(3, 2, 24, 40)) + 1j * rng.normal(size=(3, 2, 24, 40))
        for panel, polarizations in ((None, 1), ((3, 4, 2), 2)):
            value = inputs.angle_delay(h, panel=panel)
            np.testing.assert_allclose(
                (np.abs(value) ** 2).sum((-2, -1)),
                polarizations * (np.abs(h) ** 2).mean((-2, -1)),
                rtol=1e-5,
            )

    def test_delays_are_absolute_and_wrap_at_the_inverse_of_the_spacing(self):
        for tap, seen in ((200, 200), (256 + 12, 12)):
            value = np.abs(inputs.angle_delay(one_path([0.0], 0.0, tap / self.bandwidth_hz)))
            self.assertEqual(value[0].argmax(), seen)

    def test_more_beams_interpolate(self):
        h = one_path(line(8), 0.375, 5 / self.bandwidth_hz)  # beam 1.5 of 8, beam 6 of 32
        value = np.abs(inputs.angle_delay(h, 16, beams=32))
        self.assertEqual(np.unravel_index(value.argmax(), value.shape), (16 + 6, 5))
        self.assertAlmostEqual(float(value.max()), 1.0, places=5)

    def test_a_panel_keeps_rows_columns_and_polarizations_apart(self):
        rows, columns = 4, 8
        row, column, polarization = 1, -3, np.array([2.0, 1.0j])
        wave = np.exp(
            2j * np.pi * (np.arange(rows)[:, None] * row / rows + np.arange(columns) * column / columns)
        )
        ports = (wave[..., None] * polarization).reshape(-1)
        h = ports[:, None] * np.exp(-2j * np.pi * np.arange(SUBCARRIERS) * 9 / SUBCARRIERS)
        value = inputs.angle_delay(h, 32, panel=(rows, columns, 2))
        place = (rows // 2 + row) * columns + columns // 2 + column
        np.testing.assert_allclose(np.abs(value[[place, rows * columns + place], 9]), [2, 1], rtol=1e-6)
        self.assertAlmostEqual(float((np.abs(value) ** 2).sum()), 5.0, places=5)
        self.assertEqual(inputs.panel_of({"rows": 4, "columns": 8, "ports": 64}), (4, 8, 2))

    def test_the_four_channels(self):
        value = np.array([[1e-5, 1e-6j], [-1e-7, 0]], np.complex64)
        channels = inputs.csi_channels(value, floor_db=60)
        self.assertEqual((channels.shape, channels.dtype), ((4, 2, 2), np.float32))
        np.testing.assert_allclose(channels[0], [[1, 0], [-0.01, 0]], atol=1e-6)
        np.testing.assert_allclose(channels[1], [[0, 0.1], [0, 0]], atol=1e-6)
        np.testing.assert_allclose(channels[2], [[1, 1 - 20 / 60], [1 - 40 / 60, 0]], atol=1e-6)
        np.testing.assert_allclose(channels[3], [[0, 0.5], [1, 0]], atol=1e-6)
        self.assertAlmostEqual(float(inputs.csi_scale_db(value)), -100.0, places=4)
        np.testing.assert_allclose(inputs.csi_channels(value, reference=1e-4)[0, 0, 0], 0.1, rtol=1e-6)
        self.assertFalse(inputs.csi_channels(np.zeros((2, 2), np.complex64))[[0, 1, 3]].any())

    def test_a_batch_is_its_items(self):
        rng = np.random.default_rng(2)
        h = (rng.normal(size=(3, 8, 32)) + 1j * rng.normal(size=(3, 8, 32))).astype(np.complex64)
        batch = np.full((3, 4, 8, 16), np.nan, np.float32)
        self.assertIs(inputs.csi_map(h, 16, out=batch), batch)
        for item, expected in zip(batch, h):
            np.testing.assert_array_equal(item, inputs.csi_map(expected, 16))

    def test_a_link_of_a_record(self):
        cfr = np.arange(2 * 2 * 3 * 4 * 1 * 5).reshape(2, 2, 3, 4, 1, 5)
        link = inputs.link_cfr(cfr, rx=1, tx=2)
        self.assertEqual(link.shape, (8, 5))
        np.testing.assert_array_equal(link[4 + 3], cfr[1, 1, 2, 3, 0])
        self.assertTrue(np.shares_memory(inputs.link_cfr(cfr[:, :1]), cfr))

    def test_faulty_arguments_are_named(self):
        h = np.ones((4, 8), np.complex64)
        for arguments, message in (
            ({"delays": 9}, "delays: expected 1 to 8"),
            ({"beams": 3}, "beams: expected 4"),
            ({"panel": (2, 2, 2)}, r"panel: .* 4 ports, found \(2, 2, 2\)"),
            ({"delays": 4, "out": np.zeros((4, 4, 5), np.float32)}, r"out: expected float32 \[4, 4, 4\]"),
        ):
            with self.assertRaisesRegex(greatx.Error, message):
                inputs.csi_map(h, **{"delays": 8, **arguments})
        with self.assertRaisesRegex(greatx.Error, "cfr: expected"):
            inputs.angle_delay(np.ones(4))
        with self.assertRaisesRegex(IndexError, "tx: expected 0 to 0, found 1"):
            inputs.link_cfr(np.zeros((1, 1, 1, 1, 1, 1)), tx=1)


class Pictures(unittest.TestCase):
    def test_whole_pixels_are_averaged(self):
        rgb = np.random.default_rng(3).integers(0, 256, (12, 20, 3), np.uint8)
        small = inputs.picture(rgb, (4, 5))
        expected = rgb.reshape(4, 3, 5, 4, 3).mean(axis=(1, 3)).transpose(2, 0, 1)
        self.assertEqual((small.shape, small.dtype), ((3, 4, 5), np.uint8))
        self.assertLessEqual(np.abs(small - expected).max(), 0.5 + 1e-4)

    def test_parts_of_pixels_count_by_their_area(self):
        rgb = np.zeros((1, 3, 3), np.uint8)
        rgb[0, :, 0] = (10, 100, 250)
        small = inputs.picture(rgb, (1, 2))[0, 0]  # a pixel and a half each
        np.testing.assert_array_equal(small, [(10 + 50) / 1.5, (50 + 250) / 1.5])

    def test_the_mean_stays_and_a_picture_of_the_size_is_copied(self):
        rgb = np.random.default_rng(4).integers(0, 256, (48, 62, 3), np.uint8)
        self.assertAlmostEqual(inputs.picture(rgb, 17).mean(), rgb.mean(), delta=0.1)
        np.testing.assert_array_equal(inputs.picture(rgb, (48, 62)), rgb.transpose(2, 0, 1))

    def test_depth_of_a_tilted_plane(self):
        # Of a plane n . p = d, the planar depth is d / (n . ray) for the ray (x, y, 1).
        x, y = np.meshgrid((np.arange(64) + 0.5 - 32) / 32, (np.arange(48) + 0.5 - 24) / 32)
        depth = (6.0 / (0.2 * x + 0.6 * y + 0.8)).astype(np.float32)
        depth[:4] = np.inf
        value = inputs.depth_map(depth, (12, 16), 9.0)
        self.assertEqual((value.shape, value.dtype), ((1, 12, 16), np.float32))
        self.assertFalse(value[0, 0].any())
        expected = np.minimum(depth[2::4, 2::4] / 9, 1)[1:]  # the pixel whose middle is the next one
        np.testing.assert_allclose(value[0, 1:], expected, rtol=1e-6)
        self.assertEqual(value.max(), 1)

    def test_faulty_arguments_are_named(self):
        with self.assertRaisesRegex(greatx.Error, "rgb: expected uint8"):
            inputs.picture(np.zeros((4, 4, 3)), 2)
        with self.assertRaisesRegex(greatx.Error, "size: expected one or two numbers"):
            inputs.picture(np.zeros((4, 4, 3), np.uint8), 0)
        with self.assertRaisesRegex(greatx.Error, "max_m: expected a number above 0"):
            inputs.depth_map(np.zeros((4, 4), np.float32), 2, -1.0)


class RangeImages(unittest.TestCase):
    spinning = {
        "elevations_deg": [-20.0, -10.0, 0.0, 10.0],
        "azimuth_start_deg": 0.0,
        "azimuth_span_deg": 360.0,
        "azimuth_steps": 16,
        "max_range_m": 50.0,
    }

    @staticmethod
    def shots(azimuth_deg, elevation_deg, distance_m, intensity=0.5):
        a, e, r, i = np.broadcast_arrays(azimuth_deg, elevation_deg, distance_m, intensity)
        a, e = np.radians(a), np.radians(e)
        points = np.stack([r * np.cos(e) * np.cos(a), r * np.cos(e) * np.sin(a), r * np.sin(e), i], -1)
        return points.reshape(-1, 4).astype(np.float32)

    def test_every_shot_has_its_cell(self):
        azimuth, elevation = np.meshgrid(np.arange(16) * 22.5, self.spinning["elevations_deg"])
        distance = 5 + np.arange(64).reshape(4, 16) / 4
        value = inputs.lidar_map(
            self.shots(azimuth, elevation, distance, distance / 100), self.spinning, (4, 16)
        )
        # Top row: 10 degrees. Columns: from just right of the rear over the left side to straight ahead, 0.
        order = (-np.arange(16) + 8) % 16
        np.testing.assert_allclose(value[0], distance[::-1][:, order] / 50, rtol=1e-5)
        np.testing.assert_allclose(value[1], distance[::-1][:, order] / 100, rtol=1e-5)

    def test_a_wall_at_a_known_distance(self):
        azimuth, elevation = np.meshgrid(np.arange(-11, 12) * 22.5 / 4, self.spinning["elevations_deg"])
        distance = 8 / (np.cos(np.radians(azimuth)) * np.cos(np.radians(elevation)))  # the plane x = 8
        value = inputs.lidar_map(self.shots(azimuth, elevation, distance), self.spinning, (4, 64))
        seen = value[0] > 0
        self.assertEqual(seen.sum(), azimuth.size)
        self.assertTrue(seen.any(axis=1).all())
        np.testing.assert_allclose(value[0].min(axis=1, initial=9, where=seen)[1], 8 / 50, rtol=1e-5)

    def test_the_nearest_of_a_cell_stays_and_what_is_beyond_the_range_is_cut(self):
        points = self.shots([0, 0, 90], [0, 0, 0], [20, 10, 80], [0.1, 0.2, 0.3])
        for order in ([0, 1, 2], [2, 1, 0]):
            value = inputs.lidar_map(points[order], self.spinning, (4, 16))
            np.testing.assert_allclose(value[:, 1, 8], [0.2, 0.2], rtol=1e-6)
            np.testing.assert_allclose(value[:, 1, 4], [1, 0.3], rtol=1e-6)
            self.assertEqual(np.count_nonzero(value[0]), 2)

    def test_other_patterns(self):
        raster = {
            "azimuth_deg": [-30, 30],
            "elevation_deg": [-10, 10],
            "columns": 7,
            "rows": 3,
            "max_range_m": 9,
        }
        azimuth, elevation = np.meshgrid(np.linspace(-30, 30, 7), [-10, 0, 10])
        distance = 1 + np.arange(21).reshape(3, 7) / 3
        value = inputs.lidar_map(self.shots(azimuth, elevation, distance), raster, (3, 7))
        np.testing.assert_allclose(value[0], distance[::-1, ::-1] / 9, rtol=1e-5)
        rosette = {"deflection_deg": [10, 10], "max_range_m": 9}
        value = inputs.lidar_map(self.shots([19, -19], [19, 0], [3, 6]), rosette, (2, 2))
        np.testing.assert_allclose(value[0], [[3 / 9, 0], [0, 6 / 9]], rtol=1e-5)
        with self.assertRaisesRegex(greatx.Error, "elevation_deg"):
            inputs.lidar_map(np.zeros((1, 4), np.float32), {"max_range_m": 1.0}, (2, 2))
        with self.assertRaisesRegex(greatx.Error, "at most 4 rows"):
            inputs.lidar_map(np.zeros((1, 4), np.float32), self.spinning, (5, 2))


class RadarMaps(unittest.TestCase):
    def test_decibels_over_the_noise(self):
        power = np.full((8, 10), 2e-15, np.float32)
        power[3, 4], power[5, 5], power[0, 0] = 2e-12, 2e-5, 1e-16
        value = inputs.radar_map(power, span_db=60)
        self.assertEqual((value.shape, value.dtype), ((1, 8, 10), np.float32))
        np.testing.assert_allclose(value[0, [3, 5, 0, 1], [4, 5, 0, 1]], [0.5, 1, 0, 0], atol=1e-5)
        np.testing.assert_allclose(
            inputs.radar_map(power, noise_w=2e-13, span_db=20)[0, 3, 4], 0.5, atol=1e-5
        )
        self.assertFalse(inputs.radar_map(np.zeros((4, 4), np.float32)).any())

    def test_powers_are_averaged(self):
        power = np.full((4, 4), 1e-15, np.float32)
        power[0, 0] = 4e-13 - 3e-15
        value = inputs.radar_map(power, 2, span_db=40)
        np.testing.assert_allclose(value[0], [[0.5, 0], [0, 0]], atol=1e-5)


class Voxels(unittest.TestCase):
    def setUp(self):
        rng = np.random.default_rng(5)
        n = 5000
        self.events = greatx.Events(
            t=np.sort(rng.integers(1000, 9000, n)),
            x=rng.integers(0, 30, n).astype(np.uint16),
            y=rng.integers(0, 20, n).astype(np.uint16),
            p=rng.integers(0, 2, n).astype(np.uint8),
            width=30,
            height=20,
        )

    def test_an_event_is_shared_by_two_bins(self):
        one = greatx.Events(
            *(np.array([v], k) for v, k in ((1750, "i8"), (7, "u2"), (3, "u2"), (0, "u1"))), 10, 6
        )
        value = inputs.event_voxels(one, 5, (3, 5), (1000, 2000))
        self.assertEqual((value.shape, value.dtype), ((5, 3, 5), np.float32))
        expected = np.zeros((5, 3, 5))
        expected[3, 1, 3] = -1  # 1750 is bin 3 of 0, 250, 500, ...
        np.testing.assert_allclose(value, expected, atol=1e-7)
        value = inputs.event_voxels(one, 3, None, (1000, 2000))
        np.testing.assert_allclose(value[:, 3, 7], [0, -0.5, -0.5], atol=1e-7)

    def test_it_is_the_grid_of_events(self):
        for bins, span in ((1, None), (5, None), (9, (0, 10000)), (4, (3000, 7000)), (3, (20000, 30000))):
            np.testing.assert_allclose(
                inputs.event_voxels(self.events, bins, span_ns=span),
                self.events.voxel_grid(bins, span),
                atol=1e-5,
            )

    def test_a_smaller_grid_is_the_sum_of_its_pixels(self):
        whole = inputs.event_voxels(self.events, 4)
        small = inputs.event_voxels(self.events, 4, (4, 10))
        np.testing.assert_allclose(small, whole.reshape(4, 4, 5, 10, 3).sum((2, 4)), atol=1e-4)

    def test_no_events(self):
        self.assertFalse(inputs.event_voxels(self.events.between(0, 10), 3, 8).any())
        with self.assertRaisesRegex(greatx.Error, "bins: expected 1 or more"):
            inputs.event_voxels(self.events, 0)


class Records(unittest.TestCase):
    """The functions on what the engine records."""

    @classmethod
    def setUpClass(cls):
        cls.ds = greatx.load(support.rig())
        cls.sequence = cls.ds.sequences[1]

    def test_the_strongest_tap_is_the_direct_path(self):
        csi = self.sequence["csi"]
        h = inputs.link_cfr(csi.cfr[2])
        value = np.abs(inputs.angle_delay(h))
        bandwidth_hz = csi.subcarriers * csi.subcarrier_spacing_hz
        expected = csi.record(2).delay.min() * bandwidth_hz
        self.assertLess(abs(value.max(axis=0).argmax() - expected), 1)

    def test_ranges_are_those_of_the_points(self):
        lidar = self.sequence["car/lidar"]
        record = lidar.record(1)
        cloud = record.cloud
        value = inputs.lidar_map(cloud["points"], lidar.metadata, (8, 64))
        self.assertEqual(np.count_nonzero(value[0]), len(cloud["points"]))
        nearest = np.full(8, np.inf)
        np.minimum.at(nearest, 7 - cloud["ring"].astype(int), cloud["range"])
        seen = np.where(value[0] > 0, value[0], np.inf).min(axis=1) * lidar.max_range_m
        np.testing.assert_allclose(seen, nearest, rtol=1e-5)

    def test_pictures_maps_and_events(self):
        tick = self.sequence.at(2)
        self.assertEqual(inputs.picture(tick["car/front"].rgb, 24).shape, (3, 24, 24))
        depth = inputs.depth_map(tick["car/front"].depth, 24, 100.0)
        self.assertTrue(0 <= depth.min() and depth.max() <= 1)
        value = inputs.radar_map(tick["car/radar"].range_doppler)
        place = np.unravel_index(tick["car/radar"].range_doppler.argmax(), value.shape[1:])
        self.assertEqual(value[0][place], value.max())
        events = tick["car/dvs"].events()
        grid = inputs.event_voxels(events, 5, 16)
        self.assertAlmostEqual(float(grid.sum()), float((2.0 * events.p - 1).sum()), delta=0.1)


if __name__ == "__main__":
    unittest.main()
