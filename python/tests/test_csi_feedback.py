# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the task csi_feedback: transforms, metrics, sets, floors and impairments against closed forms, the
networks against published sizes, and a short run of all of it."""
import contextlib
import importlib.util
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

from greatx.errors import Error
from tasks.csi_feedback import floors, impair, metrics, sets, transforms

TORCH = importlib.util.find_spec("torch") is not None
if TORCH:
    import torch

    from tasks.common.models import macs, parameters
    from tasks.csi_feedback import models, start, tune

TASK = pathlib.Path(sets.__file__).resolve().parent


def path_response(angle, delay, ports=32, subcarriers=64):
    """Returns H of one path with a phase of 2 pi angle/ports a port and a delay in bins."""
    k = np.arange(subcarriers) - subcarriers // 2
    port = np.exp(2j * np.pi * angle * np.arange(ports) / ports)
    return port[:, None] * np.exp(-2j * np.pi * k * delay / subcarriers)


def sparse_channels(count, seed, paths=3, sites=1):
    """Returns a set of channels of a few paths that depend on the user's place."""
    rng = np.random.default_rng(seed)
    position = np.concatenate([rng.uniform(0, 200, (count, 2)), np.full((count, 1), 1.5)], axis=1)
    response = np.zeros((count, 32, 64), complex)
    for p in range(paths):
        angle = (position[:, 0] / 10 + 7 * p) % 32
        delay = 2 + position[:, 1] / 20 + 3 * p
        gain = np.exp(2j * np.pi * rng.uniform(size=count)) / (1 + p)
        response += np.stack([g * path_response(a, d) for g, a, d in zip(gain, angle, delay)])
    matrices, outside = transforms.angular_delay(response, 32)
    facts = {"name": f"hand {seed}", "subcarriers": 64, "bandwidth_hz": 20e6, "carrier_hz": 3.5e9}
    return sets.ChannelSet(matrices, position, outside, facts)


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


@unittest.skipUnless(TORCH, "needs torch")
class Networks(unittest.TestCase):
    def test_multiply_adds_are_the_published_ones(self):
        # Z. Lu, J. Wang, J. Song 2020, tables I and II, in millions, for 1/4, 1/8, 1/16, 1/32.
        published = {"csinet": (5.41, 4.37, 3.84, 3.58), "crnet": (5.12, 4.07, 3.55, 3.29)}
        for name, millions in published.items():
            for size, expected in zip((512, 256, 128, 64), millions):
                found = macs(models.network(name, size), torch.zeros(1, 2, 32, 32))
                self.assertEqual(round(found / 1e6 + 1e-9, 2), expected, (name, size))

    def test_parameters_by_arithmetic(self):
        dense = 2048 * 512 + 512 + 512 * 2048 + 2048
        refine = 2 * (9 * (2 * 8 + 8 * 16 + 16 * 2) + 2 * (8 + 16 + 2))
        expected = dense + (9 * 4 + 2 * 2) + refine + (9 * 4 + 2)
        self.assertEqual(parameters(models.csinet(512)), expected)
        # The published program has 2,103,904: biases before the normalisations, and seven normalisations
        # with four numbers (two of them not trained) for each of 32 columns instead of for each channel.
        channels = 2 * 2 + 2 * 2 * (8 + 16 + 2)
        biases = 2 + 2 * (8 + 16 + 2)
        self.assertEqual(expected - channels + biases + 7 * 4 * 32, 2_103_904)

    def test_outputs_are_pictures(self):
        for name in models.NETWORKS:
            net = models.network(name, 32).eval()
            x = torch.rand(3, 2, 32, 32)
            with torch.no_grad():
                y, code = net(x), net.encoder(x)
            self.assertEqual((tuple(y.shape), tuple(code.shape)), ((3, 2, 32, 32), (3, 32)))
            self.assertTrue(0 <= float(y.min()) and float(y.max()) <= 1)
        with self.assertRaisesRegex(Error, "csinet, crnet"):
            models.network("other", 32)

    def test_they_start_as_principal_components(self):
        x = sparse_channels(400, 1).channels
        principal = floors.Principal.fit(x)
        few = torch.from_numpy(transforms.images(x))
        for name, worse in (("csinet", 1.05), ("crnet", 2.5)):
            net = models.network(name, 64)
            start.principal_start(net, principal, few)
            found = tune.restore(net, x, torch.device("cpu"))
            floor = metrics.normalized_errors(floors.unit(x), principal.restored(x, 64)).mean()
            error = metrics.normalized_errors(floors.unit(x), found).mean()
            self.assertLess(floor, 0.9)
            self.assertLess(error, worse * floor, name)
            with self.assertRaisesRegex(Error, "expected training data for 64 components"):
                start.principal_start(net, floors.Principal.fit(x[:20]), few)

    def test_learning_rates(self):
        t = training(epochs=12, warm_up=2, rate=1e-3, final_rate=1e-4)
        rates = [tune.rate_factor(t, epoch) for epoch in range(13)]
        np.testing.assert_allclose(rates[:3], [1 / 3, 2 / 3, 1])
        self.assertAlmostEqual(rates[7], (1 + 0.1) / 2)
        self.assertAlmostEqual(rates[12], 0.1)
        constant = training(epochs=5, warm_up=0, rate=1e-3, final_rate=1e-3)
        self.assertEqual({tune.rate_factor(constant, epoch) for epoch in range(5)}, {1.0})

    def test_the_encoders_rows_keep_their_mean(self):
        net = models.csinet(32)
        optimizer = tune._optimizer(net, training(start="principal"))
        before = net.encoder.dense.weight.detach().clone()
        for _ in range(3):
            optimizer.zero_grad()
            net(torch.rand(4, 2, 32, 32)).square().sum().backward()
            optimizer.step()
        after = net.encoder.dense.weight.detach()
        self.assertGreater(float((after - before).abs().max()), 1e-5)
        np.testing.assert_allclose(after.mean(1), before.mean(1), atol=1e-8)

    def test_an_epoch_takes_each_user_before_any_comes_again(self):
        drawn = tune._drawn(10, 25, np.random.default_rng(1))
        counts = np.bincount(drawn, minlength=10)
        self.assertEqual((len(drawn), counts.min(), counts.max()), (25, 2, 3))

    def test_training_lowers_the_error_and_can_be_repeated(self):
        x = sparse_channels(300, 1).channels
        principal, errors = floors.Principal.fit(x), []
        for _ in range(2):
            torch.manual_seed(1)
            net = models.csinet(64)
            start.principal_start(net, principal, torch.from_numpy(transforms.images(x)))
            values = dict(epochs=3, samples=300, batch=25, dense_rate=0.5, rotate=True)
            with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
                fit = tune.train(
                    pathlib.Path(folder) / "fit",
                    net,
                    training(start="principal", **values),
                    x,
                    x,
                    seed=1,
                    device=torch.device("cpu"),
                    title="test",
                )
            found = tune.restore(fit.model, x, torch.device("cpu"))
            errors.append(metrics.normalized_errors(floors.unit(x), found))
        np.testing.assert_array_equal(errors[0], errors[1])
        losses = [row["validation_loss"] for row in fit.rows]
        self.assertLess(losses[-1], losses[0] - 0.01)
        self.assertAlmostEqual(errors[0].mean(), min(losses), places=4)  # the weights of the best epoch


def training(**values):
    """Returns a training with some values of its own."""
    defaults = dict(
        start="random",
        epochs=2,
        samples=None,
        batch=10,
        rate=1e-3,
        final_rate=1e-4,
        warm_up=0,
        dense_rate=0.2,
    )
    return tune.Training(**{**defaults, "rotate": False, **values})


@unittest.skipUnless(TORCH, "needs torch")
class Run(unittest.TestCase):
    """The command, on sets that are made by hand."""

    def run_task(self, *arguments):
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        return subprocess.run(
            [sys.executable, str(TASK), *map(str, arguments)], capture_output=True, text=True, env=environment
        )

    def test_a_short_run(self):
        with tempfile.TemporaryDirectory() as folder:
            data, out = pathlib.Path(folder) / "data", pathlib.Path(folder) / "out"
            sets.save(data / "city", sparse_channels(400, 1))
            sets.save(data / "etoile", sparse_channels(400, 2, paths=4))
            done = self.run_task(data, "-o", out, "--quick")
            self.assertEqual(done.returncode, 0, done.stderr)
            results = json.loads((out / "results.json").read_text())
            self.check(results)
            self.assertIn("sionna is not there", (out / "results.md").read_text())
            self.assertTrue((out / "nmse.png").is_file())
            again = self.run_task(data, "-o", out, "--quick")  # all trainings are done
            self.assertEqual(json.loads((out / "results.json").read_text())["source"], results["source"])
            self.assertEqual(again.returncode, 0, again.stderr)

    def check(self, results):
        rows = {(row["method"], row["size"]): row for row in results["source"]["methods"]}
        self.assertEqual(
            set(rows), {(m, s) for m in ("mean", "pca", "csinet") for s in (64, 32)} | {("crnet", 32)}
        )
        for row in rows.values():
            interval = row["nmse_db"]
            self.assertTrue(interval["low"] <= interval["value"] <= interval["high"])
        self.assertLess(rows["pca", 64]["nmse_db"]["value"], rows["pca", 32]["nmse_db"]["value"])
        self.assertLess(rows["pca", 32]["nmse_db"]["value"], rows["mean", 32]["nmse_db"]["value"])
        self.assertEqual(
            [row["method"] for row in results["targets"]["etoile"]["methods"]],
            ["mean of the target", "pca of the source", "csinet of the source", "pca of 40 users"]
            + ["csinet tuned to 40 users"],
        )

    def test_faults_are_told_in_a_line(self):
        with tempfile.TemporaryDirectory() as folder:
            data, out = pathlib.Path(folder) / "data", pathlib.Path(folder) / "out"
            sets.save(data / "city", sparse_channels(60, 1))
            for arguments, text in (
                ((data / "none", "-o", out, "--quick"), "set.json"),
                ((data, "-o", out, "--quick", "--set", "transfer.size=48"), "transfer.size"),
                ((data, "-o", out, "--quick", "--set", "csinet.start=warm"), "start: expected random or"),
                ((data, "-o", out, "--quick", "--set", "csinet.warm_up=9"), "warm_up: expected 0 to 1"),
            ):
                done = self.run_task(*arguments)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(text, done.stderr)
                self.assertEqual(done.stderr.count("\n"), 1, done.stderr)


if __name__ == "__main__":
    unittest.main()
