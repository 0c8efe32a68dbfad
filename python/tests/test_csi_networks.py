# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the networks of the task csi_feedback against published sizes, their training, and a short run of the
whole task."""
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

from csi_channels import sparse_channels
from greatx.errors import Error
from tasks.csi_feedback import floors, metrics, sets, transforms

TORCH = importlib.util.find_spec("torch") is not None
if TORCH:
    import torch

    from tasks.common.models import macs, parameters
    from tasks.common.training import cosine_factor
    from tasks.csi_feedback import models, start, tune

TASK = pathlib.Path(sets.__file__).resolve().parent


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

    def test_a_restart_takes_other_components_and_keeps_the_refinement(self):
        x, y = sparse_channels(400, 1).channels, sparse_channels(400, 2, paths=4).channels
        net = models.network("csinet", 64)
        first, other = floors.Principal.fit(x), floors.Principal.fit(y)
        start.principal_start(net, first, torch.from_numpy(transforms.images(x)))
        refinement = {k: v.clone() for k, v in net.decoder.state_dict().items()}
        start.principal_restart(net, other, torch.from_numpy(transforms.images(y)))
        error = metrics.normalized_errors(floors.unit(y), tune.restore(net, y, torch.device("cpu"))).mean()
        floor = metrics.normalized_errors(floors.unit(y), other.restored(y, 64)).mean()
        self.assertLess(error, 1.05 * floor)
        self.assertLess(floor, metrics.normalized_errors(floors.unit(y), first.restored(y, 64)).mean())
        for key, value in net.decoder.state_dict().items():
            self.assertTrue(torch.equal(value, refinement[key]), key)

    def test_learning_rates(self):
        rates = [cosine_factor(epoch, epochs=12, warm_up=2, last=0.1) for epoch in range(13)]
        np.testing.assert_allclose(rates[:3], [1 / 3, 2 / 3, 1])
        self.assertAlmostEqual(rates[7], (1 + 0.1) / 2)
        self.assertAlmostEqual(rates[12], 0.1)
        self.assertEqual({cosine_factor(epoch, epochs=5, last=1.0) for epoch in range(5)}, {1.0})

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
            + ["pca of the source and 40 users", "csinet tuned to 40 users"],
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
