# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the task beam_prediction: its beams and labels in closed form, its measures, a whole run."""
import csv
import importlib.util
import json
import pathlib
import tempfile
import unittest
from types import SimpleNamespace

import numpy as np

from greatx.errors import Error
from tasks.beam_prediction import measures
from tasks.street import beams as street_beams
from tasks.street import geometry

TORCH = importlib.util.find_spec("torch") is not None
if TORCH:
    import torch

    from street_data import run_task, tiny
    from tasks.beam_prediction import baselines, experiment
    from tasks.street import drives, inputs


def single_path(cosine: float, columns: int) -> np.ndarray:
    """Returns `cfr` [1, rx, rx_ant, tx, tx_ant, time, subcarrier] of one path that leaves an array with half
    a wavelength between columns at a direction cosine: column m is ahead by pi m cos (TR 38.901, 7.5-22)."""
    h = 1e-4 * np.exp(1j * np.pi * np.arange(columns) * cosine)
    return np.broadcast_to(h[None, None, None, None, :, None, None], (1, 1, 1, 1, columns, 1, 3))


class Beams(unittest.TestCase):
    def test_cosines_ascend_in_even_steps_from_minus_one(self):
        beams = street_beams.codebook(8, 2)
        np.testing.assert_allclose(beams.cosine, np.arange(16) / 8 - 1, atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(beams.weights, axis=1), 1)

    def test_a_path_in_the_direction_of_a_beam_has_that_beam_as_its_best(self):
        beams = street_beams.codebook(8, 2)
        for number, cosine in enumerate(beams.cosine):
            power = street_beams.powers(single_path(cosine, 8), beams)[0]
            self.assertEqual(power.argmax(), number)
            self.assertAlmostEqual(power.max() / 8e-8, 1)  # 8 columns in phase, each with 1/sqrt(8)

    def test_a_path_between_two_beams_has_the_gain_of_dirichlets_kernel(self):
        beams = street_beams.codebook(8, 1)
        cosine = beams.cosine[5] + 0.125  # half a step of 1/4
        power = street_beams.powers(single_path(cosine, 8), beams)[0]
        phase = np.pi * 0.125
        expected = 1e-8 * (np.sin(8 * phase / 2) / np.sin(phase / 2)) ** 2 / 8
        np.testing.assert_allclose(power[[5, 6]], expected)
        self.assertEqual(set(np.argsort(power)[-2:]), {5, 6})

    def test_free_space_agrees_with_the_channel_of_a_path(self):
        beams = street_beams.codebook(16, 2)
        for degrees in (-70, -20, 0, 3, 45):
            direction = np.array([[np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0]])
            of_path = street_beams.powers(single_path(direction[0, 1], 16), beams)
            np.testing.assert_allclose(
                street_beams.free_space(direction, beams) * 1e-8, of_path, rtol=1e-9, atol=1e-20
            )

    def test_a_mirror_changes_the_sign_of_the_cosine(self):
        beams = street_beams.codebook(8, 2)
        mirrored = beams.cosine[beams.mirrored(np.arange(1, 16))]
        np.testing.assert_allclose(mirrored, -beams.cosine[1:])
        self.assertEqual(beams.mirrored(0), 0)  # -1 and 1 are one beam

    def test_panels_that_are_no_row_are_an_error(self):
        antenna = {
            "name": "bs/panel",
            "columns": 4,
            "rows": 2,
            "ports": 8,
            "plane": "yz",
            "body_from_antenna": {"position_m": [0, 0, 0], "orientation_wxyz": [1, 0, 0, 0]},
        }
        where = SimpleNamespace()
        channel = SimpleNamespace(
            kind="csi",
            name="csi",
            metadata=_Metadata({"transmitters": [antenna], "carrier_hz": 28e9}),
            where=where,
        )
        with self.assertRaisesRegex(
            Error, "csi: expected a transmitter of one row .*found 2 rows, 4 columns"
        ):
            street_beams.codebook_of(channel, 1)


class _Metadata(dict):
    where = "dataset.json"


class Measures(unittest.TestCase):
    def setUp(self):
        generator = np.random.default_rng(5)
        self.power = generator.exponential(size=(40, 7))
        self.score = generator.normal(size=(40, 7))

    def test_hits_and_losses_are_those_of_trying_one_beam_after_the_other(self):
        rank = measures.ranking(self.score)
        hits, losses = measures.hits(rank, self.power), measures.losses_db(rank, self.power)
        for i in range(40):
            order = sorted(range(7), key=lambda b: -self.score[i, b])
            for k in range(1, 8):
                best = max(self.power[i, b] for b in order[:k])
                self.assertEqual(hits[i, k - 1], best == max(self.power[i]))
                self.assertAlmostEqual(losses[i, k - 1], 10 * np.log10(max(self.power[i]) / best))

    def test_a_perfect_ranking_needs_one_beam_and_a_reversed_one_all(self):
        perfect = measures.losses_db(measures.ranking(self.power), self.power)
        self.assertEqual(measures.beams_to_try(perfect, 1e-9), 1)
        self.assertAlmostEqual(measures.saved_share(perfect, 1e-9), 6 / 7)
        reversed_ = measures.losses_db(measures.ranking(-self.power), self.power)
        self.assertEqual(measures.saved_share(reversed_, 1e-9), 0)

    def test_equal_scores_keep_the_order_of_beams(self):
        np.testing.assert_array_equal(measures.ranking(np.zeros((1, 4))), [[0, 1, 2, 3]])


class Geometry(unittest.TestCase):
    def test_segments_meet_boxes_as_points_along_them_do(self):
        generator = np.random.default_rng(2)
        a, b = generator.uniform(-3, 3, (2, 300, 3))
        low, high = np.array([-1, -0.5, 0]), np.array([1, 1.5, 0.7])
        points = a[:, None] + np.linspace(0, 1, 4001)[:, None] * (b - a)[:, None]
        inside = np.all((points >= low) & (points <= high), axis=-1).any(1)
        met = geometry.crosses(a, b, low, high)
        self.assertTrue(np.all(met[inside]))
        self.assertLess(np.count_nonzero(met & ~inside), 3)  # corners between two points
        self.assertGreater(np.count_nonzero(inside), 20)

    def test_segments_along_an_axis_beside_in_and_before_a_box(self):
        low, high = np.array([0.0, 0, 0]), np.array([1.0, 1, 1])
        a = np.array([[0.5, 0.5, -1], [2, 0.5, -1], [0.5, 0.5, 0.2], [0.5, 0.5, -2]])
        b = np.array([[0.5, 0.5, 3], [2, 0.5, 3], [0.5, 0.5, 0.4], [0.5, 0.5, -1]])
        self.assertEqual(geometry.crosses(a, b, low, high).tolist(), [True, False, True, False])


@unittest.skipUnless(TORCH, "needs PyTorch")
class Task(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.made.cleanup)
        cls.out = pathlib.Path(cls.made.name) / "run"
        cls.printed = run_task(experiment.run, tiny(), "-o", cls.out, "--quick", "--threads", "1")

    def test_results_are_written(self):
        results = json.loads((self.out / "results.json").read_text())
        names = [
            "most frequent beam",
            "last sweep, 1 ticks ago",
            "last sweep, 2 ticks ago",
            "similar pictures",
        ]
        self.assertEqual(list(results), [*names, "true position", "camera + lidar"])
        for of in results.values():
            self.assertLessEqual(of["top_1_percent"]["value"], of["top_5_percent"]["value"])
            self.assertGreaterEqual(of["loss_mean_db"]["value"], 0)
        for title in ("All test items", "camera + lidar minus another method", "By condition"):
            self.assertIn(f"## {title}", self.printed)
        for name in ("top_k", "sweep", "example"):
            self.assertGreater((self.out / f"{name}.png").stat().st_size, 5000)
        with open(self.out / "camera_lidar_1" / "log.csv", newline="") as file:
            self.assertEqual([row["epoch"] for row in csv.DictReader(file)], ["1", "2"])

    def test_rankings_give_the_reported_accuracy(self):
        stored = np.load(self.out / "rankings.npz")
        opened = drives.open_drives(tiny(), ["csi"], {"train": 0.6, "validation": 0.15, "test": 0.25})
        beams = street_beams.codebook_of(opened.sequences[0]["csi"], 2)
        best = street_beams.powers(opened.gather("csi", "cfr"), beams)[stored["items"]].argmax(1)
        results = json.loads((self.out / "results.json").read_text())
        for name in ("true position", "camera + lidar"):
            share = np.mean(stored[name][:, :, 0] == best)
            self.assertAlmostEqual(results[name]["top_1_percent"]["value"], 100 * share)

    def test_in_sight_the_best_beam_points_at_the_car(self):
        opened = drives.open_drives(tiny(), ["csi"], {"train": 0.6, "validation": 0.15, "test": 0.25})
        beams = street_beams.codebook_of(opened.sequences[0]["csi"], 2)
        best = street_beams.powers(opened.gather("csi", "cfr"), beams).argmax(1)
        sight = opened.gather("csi", "line_of_sight")[:, 0, 0] > 0
        truth = geometry.ends(opened, "csi").direction()[:, 1]
        off = np.abs(beams.cosine[best] - truth)
        self.assertLess(np.median(np.minimum(off, 2 - off)[sight]), 1 / 16 + 1e-6)  # half a step of 1/8

    def test_no_trajectory_is_in_two_parts_and_the_past_is_of_the_same_drive(self):
        opened = drives.open_drives(tiny(), ["csi"], {"train": 0.6, "validation": 0.15, "test": 0.25})
        for trajectory in np.unique(opened.trajectory):
            self.assertEqual(len(np.unique(opened.part[opened.trajectory == trajectory])), 1)
        power = np.arange(len(opened))[:, None] * np.ones((1, 3))
        late = np.flatnonzero(opened.order >= 2)
        np.testing.assert_array_equal(baselines.last_sweep(power, opened, late, 2)[:, 0], late - 2)
        self.assertTrue(np.all(opened.drive[late - 2] == opened.drive[late]))
        with self.assertRaises(ValueError):
            baselines.last_sweep(power, opened, np.array([1]), 2)

    def test_similar_pictures_of_the_training_items_are_themselves(self):
        generator = np.random.default_rng(0)
        pictures, power = generator.random((12, 3, 4, 4)), generator.random((12, 5))
        train = np.arange(8)
        score = baselines.similar_pictures(pictures, power, train, train, 1)
        np.testing.assert_allclose(score, power[:8] / power[:8].max(1, keepdims=True))

    def test_inputs_are_made_once_and_again_for_other_settings(self):
        opened = drives.open_drives(tiny(), ["bs/view"], {"train": 0.6, "validation": 0.15, "test": 0.25})
        with tempfile.TemporaryDirectory() as folder:
            where = pathlib.Path(folder)
            first = inputs.cached(where, opened, {"camera": inputs.camera("bs/view", (6, 8))}, "a")["camera"]
            picture = np.asarray(opened.sequences[1]["bs/view"].record(3)["rgb"], float)
            mean = picture.reshape(6, 4, 8, 6, 3).mean((1, 3)).transpose(2, 0, 1)
            np.testing.assert_allclose(first[12 + 3], mean, atol=0.5)
            broken = {"camera": ("bs/view", np.dtype(np.uint8), lambda record: 1 / 0)}
            again = inputs.cached(where, opened, broken, "a")["camera"]
            np.testing.assert_array_equal(first, again)
            with self.assertRaises(ZeroDivisionError):
                inputs.cached(where, opened, broken, "b")

    def test_a_mirrored_batch_has_mirrored_pictures_and_beams(self):
        beams = street_beams.codebook(4, 1)
        batch = {"camera": torch.arange(24.0).reshape(2, 3, 1, 4), "label": torch.tensor([1, 3])}
        out = experiment.mirrored(batch, beams, np.array([True, False]))
        np.testing.assert_array_equal(out["camera"][0], batch["camera"][0].flip(-1))
        np.testing.assert_array_equal(out["camera"][1], batch["camera"][1])
        self.assertEqual(out["label"].tolist(), [3, 3])

    def test_a_run_goes_on_and_refuses_another_configuration(self):
        before = (self.out / "camera_lidar_1" / "log.csv").read_text()
        printed = run_task(experiment.run, tiny(), "-o", self.out, "--quick", "--threads", "1")
        self.assertNotIn("epoch", printed.split("#")[0])
        self.assertEqual(before, (self.out / "camera_lidar_1" / "log.csv").read_text())
        with self.assertRaisesRegex(Error, "config.neighbours"):
            run_task(experiment.run, tiny(), "-o", self.out, "--quick", "--set", "neighbours=3")

    def test_a_sensor_that_is_not_there_is_an_error(self):
        out = pathlib.Path(self.made.name) / "other"
        with self.assertRaisesRegex(Error, "expected the sensor 'bs/eye' of the configuration, found poses"):
            run_task(experiment.run, tiny(), "-o", out, "--quick", "--set", "sensors.camera=bs/eye")


if __name__ == "__main__":
    unittest.main()
