# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the task csi_feedback without its networks: transforms, metrics, sets, floors and impairments against
closed forms."""
import json
import pathlib
import tempfile
import unittest

import numpy as np

from csi_channels import path_response, sparse_channels
from greatx.errors import Error
from tasks.csi_feedback import floors, impair, metrics, sets, transforms


class Transforms(unittest.TestCase):
    def test_a_path_on_the_grid_is_one_entry(self):
        x, outside = transforms.angular_delay(path_response(5, 9)[None], 32)
        self.assertEqual(np.unravel_index(np.abs(x[0]).argmax(), x[0].shape), (5, 9))
        self.assertAlmostEqual(abs(x[0, 5, 9]) ** 2, 32 * 64, delta=0.01)
        self.assertLess(outside[0], 1e-6)

    def test_a_path_between_bins_has_dirichlets_kernel(self):
        delay, subcarriers = 6.3, 64
        x, _ = transforms.angular_delay(path_response(0, delay)[None], 32)
        away = np.arange(32) - delay
        kernel = np.sin(np.pi * away) / np.sin(np.pi * away / subcarriers)
        np.testing.assert_allclose(np.abs(x[0, 0]), np.abs(kernel) * np.sqrt(32 / subcarriers), rtol=1e-4)

    def test_all_bins_keep_the_power_and_lead_back(self):
        rng = np.random.default_rng(1)
        h = rng.normal(size=(3, 32, 48, 2)) @ [1, 1j]
        x, outside = transforms.angular_delay(h, 48)
        self.assertLess(outside.max(), 1e-6)
        np.testing.assert_allclose(transforms.frequency_response(x, 48), h, atol=1e-5)
        np.testing.assert_allclose(transforms.in_angles(transforms.in_ports(x)), x, atol=1e-5)

    def test_later_power_is_told(self):
        h = np.stack([path_response(1, 4) + 2 * path_response(2, 40)])
        _, outside = transforms.angular_delay(h, 32)
        self.assertAlmostEqual(float(outside[0]), 0.8, places=4)

    def test_images_lie_around_a_half_and_lead_back(self):
        x = sparse_channels(5, 1).channels
        pictures = transforms.images(x)
        self.assertTrue(pictures.min() >= 0 and pictures.max() <= 1 and pictures.dtype == np.float32)
        np.testing.assert_allclose(transforms.matrices(pictures), floors.unit(x), atol=1e-6)

    def test_faulty_input(self):
        for call, text in (
            (lambda: transforms.angular_delay(np.zeros((1, 32, 64)), 32), "found none in number 0"),
            (lambda: transforms.angular_delay(np.zeros((32, 64)), 32), "port, subcarrier"),
            (lambda: transforms.delay_matrix(16, 32), "expected 1 to 16"),
            (lambda: transforms.images(np.zeros((2, 32, 32))), "expected power"),
        ):
            with self.assertRaisesRegex(Error, text):
                call()


class Metrics(unittest.TestCase):
    def test_known_errors(self):
        x = sparse_channels(4, 2).channels
        self.assertAlmostEqual(metrics.nmse_db(metrics.normalized_errors(x, 0 * x)), 0, places=6)
        self.assertAlmostEqual(metrics.nmse_db(metrics.normalized_errors(x, 1.1 * x)), -20, places=4)

    def test_the_mean_of_ratios_is_not_the_ratio_of_means(self):
        x = np.ones((2, 32, 32), complex)
        x[1] *= 10
        found = x.copy()
        found[0] = 0
        self.assertAlmostEqual(metrics.nmse_db(metrics.normalized_errors(x, found)), 10 * np.log10(0.5), 6)

    def test_rho_is_that_of_the_frequency_responses(self):
        x = sparse_channels(6, 3).channels
        y = x + 0.3 * np.abs(x).max() * sparse_channels(6, 4).channels / np.abs(x).max()
        h, g = (transforms.frequency_response(m, 64) for m in (x, y))
        product = np.abs(np.sum(np.conj(g) * h, 1)) / np.linalg.norm(g, axis=1) / np.linalg.norm(h, axis=1)
        np.testing.assert_allclose(metrics.similarities(x, y, 64), product.mean(1), rtol=1e-5)
        np.testing.assert_allclose(metrics.similarities(x, y, 64, 4), product[:, ::4].mean(1), rtol=1e-5)

    def test_rho_forgives_gain_and_phase_only(self):
        x = sparse_channels(3, 5).channels
        np.testing.assert_allclose(metrics.similarities(x, -2j * x, 64), 1, rtol=1e-6)
        other, _ = transforms.angular_delay(path_response(3, 4)[None], 32)
        same, _ = transforms.angular_delay(path_response(8, 4)[None], 32)
        self.assertLess(metrics.similarities(other, same, 64)[0], 1e-5)
        self.assertEqual(metrics.similarities(other, 0 * other, 64)[0], 0)


class Sets(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name) / "set"
        self.given = sparse_channels(7, 1)
        sets.save(self.folder, self.given)

    def test_reads_what_it_writes(self):
        found = sets.load(self.folder)
        np.testing.assert_array_equal(found.channels, self.given.channels)
        np.testing.assert_array_equal(found.position_m, self.given.position_m)
        self.assertEqual((found.name, len(found), len(found.part(np.array([1, 3])))), ("hand 1", 7, 2))

    def test_damage_is_named(self):
        def json_without(key, value):
            facts = json.loads((self.folder / "set.json").read_text())
            facts[key] = value
            (self.folder / "set.json").write_text(json.dumps(facts))

        broken = self.given.channels.copy()
        broken[2] = np.nan
        for damage, text in (
            (lambda: np.save(self.folder / "channels.npy", broken), "channels.npy: .*number 2"),
            (lambda: np.save(self.folder / "channels.npy", broken.real), "expected complex64"),
            (lambda: np.save(self.folder / "outside.npy", np.zeros(3, np.float32)), r"outside.npy: .*\[7\]"),
            (lambda: (self.folder / "position_m.npy").write_bytes(b"no array"), "position_m.npy"),
            (lambda: json_without("subcarriers", None), "subcarriers: expected a number, found None"),
            (lambda: json_without("format_version", 9), "format_version: expected 1, found 9"),
            (lambda: json_without("format", "other"), "format: expected 'greatx-csi-set'"),
            (lambda: (self.folder / "set.json").write_text("{"), "is no JSON"),
            (lambda: (self.folder / "set.json").unlink(), "set.json: No such file"),
        ):
            sets.save(self.folder, self.given)
            damage()
            with self.subTest(text), self.assertRaisesRegex(sets.SetError, text):
                sets.load(self.folder)


class Floors(unittest.TestCase):
    def test_channels_of_few_directions_are_restored_exactly(self):
        rng = np.random.default_rng(1)
        base = rng.normal(size=(3, 32, 32, 2)) @ [1, 1j]
        x = np.einsum("nk,kad->nad", rng.normal(size=(50, 3, 2)) @ [1, 1j], base)
        principal = floors.Principal.fit(x)
        self.assertEqual(len(principal.components), 6)  # a complex direction has two real ones
        self.assertLess(metrics.normalized_errors(floors.unit(x), principal.restored(x, 6)).max(), 1e-10)
        self.assertGreater(metrics.normalized_errors(floors.unit(x), principal.restored(x, 4)).mean(), 1e-3)

    def test_the_error_is_that_of_the_components_left_out(self):
        for count in (200, 1500):  # fewer and more than entries
            x = sparse_channels(count, 2).channels
            principal = floors.Principal.fit(x)
            for size in (16, 64):
                error = metrics.normalized_errors(floors.unit(x), principal.restored(x, size)).mean()
                self.assertAlmostEqual(error, principal.variances[size:].sum(), places=4)

    def test_a_mean_of_second_moments_serves_both_sets(self):
        x, y = sparse_channels(300, 2).channels, sparse_channels(300, 3, paths=5).channels
        moments = [floors.second_moment(m) for m in (x, y)]
        both = floors.Principal.of((moments[0] + moments[1]) / 2, (32, 32))
        joint = floors.Principal.fit(np.concatenate([x, y]))
        np.testing.assert_allclose(both.variances[:50], joint.variances[:50], rtol=1e-4)
        self.assertAlmostEqual(np.trace(moments[0]), 1, places=5)

    def test_components_are_orthonormal_and_in_order(self):
        principal = floors.Principal.fit(sparse_channels(100, 3).channels)
        gram = principal.components @ principal.components.T
        np.testing.assert_allclose(gram, np.eye(len(gram)), atol=1e-4)
        self.assertTrue(np.all(np.diff(principal.variances) <= 1e-9))

    def test_the_mean_tells_nothing_where_phases_are_uniform(self):
        x = sparse_channels(2000, 4).channels
        error = metrics.normalized_errors(floors.unit(x), floors.mean_restored(x, x))
        self.assertAlmostEqual(metrics.nmse_db(error), 0, delta=0.02)


class Impairments(unittest.TestCase):
    def test_the_tail_has_its_power_and_its_decay(self):
        x = np.repeat(transforms.angular_delay(path_response(5, 2)[None], 32)[0], 400, axis=0)
        decay, bandwidth = 250e-9, 20e6
        y = impair.diffuse_tail(x, -6.0, decay, bandwidth, np.random.default_rng(1)) - x
        power = np.square(np.abs(y)).sum((1, 2)).mean() / np.square(np.abs(x)).sum((1, 2)).mean()
        self.assertAlmostEqual(10 * np.log10(power), -6, delta=0.05)
        profile = np.square(np.abs(y)).mean((0, 1))
        self.assertLess(np.abs(profile[:2]).max(), 1e-9 * profile.max())  # nothing before the first path
        slope = np.polyfit(np.arange(20) / bandwidth, np.log(profile[2:22]), 1)[0]
        self.assertAlmostEqual(-1 / slope / decay, 1, delta=0.05)
        by_angle = np.square(np.abs(y)).mean((0, 2))
        self.assertLess(by_angle.max() / by_angle.min(), 1.2)

    def test_the_array_has_the_errors_that_were_asked_for(self):
        ports = 2048
        x = transforms.in_angles(np.ones((1, ports, 1), np.complex64))
        y = impair.calibration_error(x, 0.5, 5.0, np.random.default_rng(2))
        c = transforms.in_ports(y)[0, :, 0]
        gain = 20 * np.log10(np.abs(c))
        self.assertAlmostEqual(np.std(gain), 0.5, delta=0.5 * 3 / np.sqrt(2 * ports))
        self.assertAlmostEqual(np.degrees(np.std(np.angle(c))), 5, delta=5 * 3 / np.sqrt(2 * ports))
        self.assertAlmostEqual(np.mean(np.abs(c) ** 2), 1, places=4)

    def test_all_users_have_one_array(self):
        x = sparse_channels(5, 1).channels
        c = transforms.in_ports(impair.calibration_error(x, 1, 10, np.random.default_rng(3)))
        c = c[:, :, 8] / transforms.in_ports(x)[:, :, 8]
        np.testing.assert_allclose(c, np.broadcast_to(c[0], c.shape), rtol=1e-2)

    def test_the_oscillator_walks(self):
        users, linewidth, spacing = 4000, 50.0, 1e-4
        x = transforms.in_angles(np.ones((users, 32, 1), np.complex64))
        y = impair.phase_noise(x, linewidth, spacing, np.random.default_rng(4))
        np.testing.assert_allclose(
            np.square(np.abs(y)).sum((1, 2)), np.square(np.abs(x)).sum((1, 2)), rtol=1e-4
        )
        phase = np.unwrap(np.angle(transforms.in_ports(y)[:, :, 0]), axis=1)
        step = 2 * np.pi * linewidth * spacing
        for lag in (1, 8):
            variance = np.var(phase[:, lag::lag] - phase[:, :-lag:lag])
            self.assertAlmostEqual(variance / (lag * step), 1, delta=0.05)

    def test_a_field_names_its_impairments_and_follows_from_its_seed(self):
        clean = sparse_channels(6, 1)
        values = dict(tail=(-10.0, 1e-7), calibration=(0.5, 5.0), oscillator=(10.0, 7e-5))
        made = [impair.field(clean, seed, **values) for seed in (1, 1, 2)]
        np.testing.assert_array_equal(made[0].channels, made[1].channels)
        self.assertFalse(np.array_equal(made[0].channels, made[2].channels))
        self.assertEqual(
            made[0].facts["impairments"]["phase_noise"], {"linewidth_hz": 10.0, "spacing_s": 7e-5}
        )
        self.assertEqual(made[0].name, "hand 1, impaired")


if __name__ == "__main__":
    unittest.main()
