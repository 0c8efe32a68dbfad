# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the task positioning: its network, losses, floors and splits by closed forms, and a whole run."""
import contextlib
import csv
import functools
import importlib.util
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

import greatx
from greatx import inputs
from greatx.errors import Error

TORCH = all(importlib.util.find_spec(name) for name in ("torch", "torchvision"))
if TORCH:
    import torch

    from tasks.common.inputs import tensor
    from tasks.positioning import cache, cost, distillation, experiment, models, records, settings, training
from tasks.positioning import floors

BASE = """
greatx: 1
name: base
seed: 3
ticks: 4
tick_rate_hz: 2
storage: {compression: fast}
scene: {generate: {kind: canyon, seed: 3, size_m: 60}}
environment: {clouds: 0}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [1, -28, 6], rotation_deg: [90, 0, 0]}
    sensors: [{name: a, type: antenna, rows: 2, columns: 2, polarization: slant}]
  - name: uav
    trajectory: {type: bezier, box: {min_m: [-3, -20, 3], max_m: [3, 25, 8]}}
    sensors:
      - {name: a, type: antenna}
      - {name: cam, type: camera, rate_hz: 2, width: 24, height: 24, fov_deg: 90}
      - {name: dvs, type: event_camera, rate_hz: 2, width: 16, height: 16, fov_deg: 90, steps: 2,
         max_events_per_pixel: 64}
      - {name: lidar, type: lidar, rate_hz: 2, channels: 4, elevation_min_deg: -60, elevation_max_deg: 5,
         azimuth_steps: 32}
channels:
  - {name: csi, tx: bs/a, rx: [uav/a], rate_hz: 2, bandwidth_hz: 100e6, subcarriers: 32, max_depth: 1,
     outputs: [cfr]}
"""
# By night there are other flights, and no LiDAR.
CAMPAIGN = """
greatx_campaign: 1
name: tiny
base: base.yaml
sequences: 10
axes:
  light:
    day: {}
    night:
      seed: 4
      environment: {sun: {elevation_deg: -20}}
      nodes[uav].sensors[lidar].rate_hz: 0.1
split: {train: 0.6, validation: 0.2, test: 0.2}
"""
TEMPORARY = tempfile.TemporaryDirectory()


@functools.lru_cache(maxsize=None)
def campaign() -> pathlib.Path:
    folder = pathlib.Path(TEMPORARY.name)
    (folder / "base.yaml").write_text(BASE)
    (folder / "tiny.yaml").write_text(CAMPAIGN)
    for command in ("run", "merge"):
        program = os.environ["GREATX_PROGRAM"]
        run = [program, "campaign", command, folder / "tiny.yaml", "-o", folder / "data", "-q"]
        subprocess.run(run, check=True)
    return folder / "data"


def command(out: pathlib.Path, *options: str) -> str:
    """Runs the task on the tiny campaign, and returns what it prints."""
    arguments = ["positioning", str(campaign()), "-o", str(out), "--quick", "--threads", "1", *options]
    printed = io.StringIO()
    with mock.patch.object(sys, "argv", arguments), contextlib.redirect_stdout(printed):
        experiment.run()
    return printed.getvalue()


@unittest.skipUnless(TORCH, "needs torch and torchvision")
class Network(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(1)
        self.network = settings.Network(18, 0.0625, 8, True)
        self.model = models.Positioner({"rgb": 3, "csi": 4, "lidar": 2}, self.network)
        self.inputs = {"rgb": torch.rand(5, 3, 16, 16), "csi": torch.rand(5, 4, 8, 16)}
        self.inputs["lidar"] = torch.rand(5, 2, 4, 16)

    def test_attention_is_a_softmax_over_what_is_present(self):
        scores = torch.tensor([[0.0, 1.0, 2.0], [3.0, -1.0, 50.0], [7.0, 7.0, 7.0]])
        present = torch.tensor([[True, True, True], [True, True, False], [False, True, False]])
        weights = models.attention(scores, present).numpy()
        e = np.exp
        expected = [
            [1 / (1 + e(1) + e(2)), e(1) / (1 + e(1) + e(2)), e(2) / (1 + e(1) + e(2))],
            [1 / (1 + e(-4)), e(-4) / (1 + e(-4)), 0],
            [0, 1, 0],
        ]
        np.testing.assert_allclose(weights, expected, rtol=1e-6)
        self.assertTrue((weights[~present.numpy()] == 0).all())
        with self.assertRaisesRegex(ValueError, "found a record without any"):
            models.attention(scores, torch.zeros(3, 3, dtype=torch.bool))

    def test_an_absent_modality_changes_nothing(self):
        self.model.eval()
        present = torch.tensor([[True, True, False]] * 4 + [[False, True, True]])
        with torch.no_grad():
            first = self.model(self.inputs, present)
            other = {**self.inputs, "lidar": self.inputs["lidar"].clone()}
            other["lidar"][:4] = 100.0
            second = self.model(other, present)
            alone = self.model({k: v[:1] for k, v in self.inputs.items()}, present[:1])
        torch.testing.assert_close(first.position, second.position, rtol=0, atol=0)
        torch.testing.assert_close(first.weights.sum(1), torch.ones(5))
        self.assertEqual(float(first.weights[:4, 2].abs().max()), 0.0)
        # A record's estimate does not depend on what is beside it.
        torch.testing.assert_close(alone.position, first.position[:1], rtol=1e-4, atol=1e-5)

    def test_coordinates_run_from_edge_to_edge(self):
        out = models.with_coordinates(torch.zeros(2, 4, 3, 5))
        self.assertEqual(tuple(out.shape), (2, 6, 3, 5))
        np.testing.assert_allclose(out[1, 4].numpy(), [[-1] * 5, [0] * 5, [1] * 5])
        np.testing.assert_allclose(out[1, 5].numpy(), [[-1, -0.5, 0, 0.5, 1]] * 3)

    def test_training_takes_single_records(self):
        self.model.train()
        present = torch.tensor([[True, False, False]] + [[False, True, True]] * 4)
        self.model(self.inputs, present).position.sum().backward()
        gradients = [p.grad for p in self.model.encoders["rgb"].parameters()]
        self.assertTrue(all(g is not None and torch.isfinite(g).all() for g in gradients))
        self.assertTrue(self.model.encoders["rgb"].training)

    def test_dropout_leaves_one_and_has_its_probability(self):
        present = torch.ones(20000, 3, dtype=torch.bool)
        present[:, 2] = False
        kept = models.drop_modalities(present, 0.5)
        self.assertTrue(bool(kept.any(1).all()))
        self.assertFalse(bool(kept[:, 2].any()))
        # Each of the two stays with 1/2, and alone in half of the quarter that would lose both: 5/8.
        np.testing.assert_allclose(kept[:, :2].float().mean(0), [0.625, 0.625], atol=0.015)
        self.assertTrue(bool((models.drop_modalities(present, 0.0) == present).all()))


@unittest.skipUnless(TORCH, "needs torch and torchvision")
class Losses(unittest.TestCase):
    def test_distillation_is_a_weighted_sum_of_mean_squares(self):
        position, fused = torch.tensor([[1.0, 2.0, 3.0]]), torch.tensor([[1.0, 0.0]])
        estimate = models.Estimate(position, fused, torch.ones(1, 1))
        truth = torch.tensor([[1.0, 2.0, 0.0]])
        targets = distillation.Targets(torch.tensor([[0.0, 2.0, 3.0]]), torch.tensor([[0.0, 2.0]]))
        weights = settings.Distillation(truth=1.0, feature=0.5, output=2.0)
        loss, parts = distillation.student_loss(estimate, truth, targets, weights)
        # 9/3, (1 + 4)/2, 1/3
        self.assertAlmostEqual(float(loss), 3 + 0.5 * 2.5 + 2 / 3, places=6)
        self.assertEqual([round(parts[n], 6) for n in ("truth", "feature", "output")], [3.0, 2.5, 0.333333])
        alone, none = distillation.student_loss(estimate, truth, None, weights)
        self.assertEqual((float(alone), none), (3.0, {}))

    def test_the_teacher_learns_with_each_modality_alone(self):
        torch.manual_seed(2)
        model = models.Positioner({"csi": 4, "lidar": 2}, settings.Network(18, 0.0625, 8, False)).eval()
        given = {"csi": torch.rand(3, 4, 8, 8), "lidar": torch.rand(3, 2, 8, 8)}
        present = torch.tensor([[True, True], [True, False], [False, True]])
        truth = torch.rand(3, 3)
        loss, parts = distillation.teacher_loss(model, given, present, truth, 0.25)

        def square(row, mask):
            one = {name: value[row : row + 1] for name, value in given.items()}
            said = model(one, torch.tensor([mask])).position
            return float(((said - truth[row]) ** 2).mean())

        fused = np.mean([square(0, [True, True]), square(1, [True, False]), square(2, [False, True])])
        pairs = [(0, [True, False]), (0, [False, True]), (1, [True, False]), (2, [False, True])]
        each = np.mean([square(*pair) for pair in pairs])
        self.assertAlmostEqual(float(loss), fused + 0.25 * each, places=5)
        self.assertAlmostEqual(parts["alone"], each, places=5)

    def test_a_phase_turns_the_map_as_the_channel(self):
        generator = np.random.default_rng(1)
        h = generator.standard_normal((4, 16)) + 1j * generator.standard_normal((4, 16))
        angle = 2.5
        turned = distillation.random_phase(
            torch.from_numpy(inputs.csi_map(h, 8))[None], torch.tensor([angle])
        )[0].numpy()
        expected = inputs.csi_map(h * np.exp(1j * angle), 8)
        np.testing.assert_allclose(turned[:3], expected[:3], atol=2e-6)
        apart = np.exp(1j * np.pi * (turned[3] - expected[3]))
        np.testing.assert_allclose(apart, 1, atol=1e-5)
        self.assertLessEqual(np.abs(turned[3]).max(), 1.0)

    def test_the_frame_is_one_scale(self):
        position = torch.tensor([[0.0, 0.0, 10.0], [8.0, 4.0, 10.0]], dtype=torch.float64)
        frame = distillation.Frame.of(position)
        self.assertAlmostEqual(frame.scale_m, ((16 + 4) / 3) ** 0.5)
        torch.testing.assert_close(frame.metres(frame.standardised(position)), position, atol=1e-5, rtol=0)

    def test_noise_of_the_estimated_channel(self):
        # k T B F over the pilot's power: -174 dBm/Hz + 60 dBHz + 10 dB, and 20 dBm over 100 subcarriers.
        sigma = cache.channel_noise(1e6, 100, 20.0, 10.0)
        self.assertAlmostEqual(20 * np.log10(sigma), -173.975 + 60 + 10, places=2)


class Floors(unittest.TestCase):
    def test_neighbours_are_those_of_brute_force(self):
        generator = np.random.default_rng(2)
        train = generator.standard_normal((60, 7)).astype(np.float32)
        query = generator.standard_normal((9, 7)).astype(np.float32)
        found = floors.neighbours(train, query, 5)
        for row, one in zip(found, query):
            distance = [float(np.sum((one - t) ** 2)) for t in train]
            self.assertEqual(row.tolist(), sorted(range(60), key=lambda i: distance[i])[:5])

    def test_positions_are_means_of_the_nearest(self):
        train_m = np.array([[0.0, 0, 0], [3, 0, 0], [6, 0, 9]])
        out = floors.neighbour_positions(np.array([[2, 0, 1]]), train_m)
        np.testing.assert_allclose(out[0], [[6, 0, 9], [3, 0, 4.5], [3, 0, 3]])

    def test_k_is_chosen_on_validation(self):
        # On a line with noise-free features, two neighbours are better than one halfway between them.
        train = np.arange(20.0)[:, None]
        line = np.concatenate([train, 0 * train, 0 * train], 1)
        query = np.arange(0.5, 18)[:, None]
        query_m = np.concatenate([query, 0 * query, 0 * query], 1)
        errors, k = floors.neighbour_errors((train, query, query[:4]), (line, query_m, query_m[:4]), 6)
        self.assertIn(k, (2, 4, 6))
        np.testing.assert_allclose(errors[2:], 0, atol=1e-9)

    def test_the_mean_position(self):
        errors = floors.mean_errors(np.array([[0.0, 0, 0], [2, 0, 0]]), np.array([[1.0, 3, 4]]))
        np.testing.assert_allclose(errors, [5.0])


@unittest.skipUnless(TORCH, "needs torch and torchvision")
class Data(unittest.TestCase):
    def setUp(self):
        self.wanted = list(settings.MODALITIES)
        self.opened = greatx.load(campaign())
        self.records = records.find(self.opened, self.wanted)
        self.split = settings.Split("trajectory", {"train": 0.6, "validation": 0.2, "test": 0.2}, 15.0, 2.0)

    def test_records_have_the_truth_of_the_data(self):
        found = self.records
        self.assertEqual(len(found), 2 * 10 * 4)
        self.assertEqual(
            (found.modalities, found.absent), (["rgb", "depth", "csi", "lidar", "events"], ["radar"])
        )
        night = found.cell == found.cells.index("night")
        # Of the LiDAR's own rate there is the first tick alone.
        np.testing.assert_array_equal(found.present[night, 3], found.tick[night] == 0)
        self.assertTrue(found.present[~night].all())
        i = int(np.flatnonzero(night & (found.tick == 2))[3])
        sequence = self.opened["night"].sequences[found.sequence[i]]
        np.testing.assert_array_equal(found.position_m[i], sequence.at(2)["poses"]["position"][1])

    def test_no_flight_is_in_two_parts(self):
        self.assertEqual(len(np.unique(self.records.trajectory)), 20)
        parts = self.records.split(self.split)
        seen = [set(self.records.trajectory[rows].tolist()) for rows in parts.values()]
        self.assertEqual(sum(map(len, seen)), len(set.union(*seen)))
        self.assertEqual(sum(map(len, parts.values())), len(self.records))

    def test_equal_flights_in_two_parts_are_an_error(self):
        self.records.trajectory[:] = 0
        with self.assertRaisesRegex(Error, "a flight is in 'train' and in"):
            self.records.split(self.split)

    def test_places_are_apart(self):
        split = settings.Split("place", {"train": 0.5, "validation": 0.25, "test": 0.25}, 6.0, 1.0)
        parts = self.records.split(split)
        places = {n: self.records.position_m[rows][:, :2] for n, rows in parts.items()}
        for one, other in (("train", "test"), ("train", "validation"), ("validation", "test")):
            cells = [set(map(tuple, np.floor(places[n] / 6.0).tolist())) for n in (one, other)]
            self.assertFalse(cells[0] & cells[1])
            apart = np.linalg.norm(places[one][:, None] - places[other][None], axis=2)
            self.assertGreaterEqual(apart.min(), 1.0)

    def test_the_cache_has_the_inputs_and_is_made_once(self):
        folder = pathlib.Path(TEMPORARY.name) / "cache"
        config = settings.Inputs(16, 50.0, 16, 60.0, None, 7.0, 8, 16, 16, 16, 3, 8)
        made = cache.cached(folder, self.opened, self.records, config)
        i = 7
        dataset = self.opened[self.records.cells[self.records.cell[i]]]
        tick = dataset.sequences[self.records.sequence[i]].at(int(self.records.tick[i]))
        np.testing.assert_array_equal(made.arrays["rgb"][i], inputs.picture(tick["uav/cam"].rgb, 16))
        h = tick["csi"].cfr[0, 0, 0, :, 0, :]
        expected = inputs.csi_map(h, 16, panel=(2, 2, 2))
        np.testing.assert_allclose(made.arrays["csi"][i], expected, atol=1e-3)
        voxels = inputs.event_voxels(tick["uav/dvs"].events(), 3, 8)
        np.testing.assert_allclose(np.expm1(np.abs(made.arrays["events"][i])), np.abs(voxels), rtol=0.01)
        self.assertEqual(made.arrays["lidar"].shape[1:], (2, 8, 16))
        self.assertGreater(made.arrays["lidar"][i].max(), 0)
        batch = tensor(made.arrays["rgb"], np.array([9, 2, 5]))
        np.testing.assert_allclose(batch.numpy(), made.arrays["rgb"][[9, 2, 5]] / 255.0, atol=1e-6)

        with mock.patch.object(cache, "_make", side_effect=AssertionError("made again")):
            again = cache.cached(folder, self.opened, self.records, config)
            self.assertEqual(again.seconds, made.seconds)
            with self.assertRaisesRegex(AssertionError, "made again"):
                other = settings.Inputs(16, 60.0, 16, 60.0, None, 7.0, 8, 16, 16, 16, 3, 8)
                cache.cached(folder, self.opened, self.records, other)

    def test_a_data_set_is_split_by_its_sequences(self):
        found = records.find(self.opened["day"], ["csi"])
        self.assertIsNone(found.part)
        parts = found.split(self.split)
        seen = [set(found.sequence[rows].tolist()) for rows in parts.values()]
        self.assertEqual(sum(map(len, seen)), 10)
        self.assertEqual(set.union(*seen), set(range(10)))


@unittest.skipUnless(TORCH, "needs torch and torchvision")
class WholeRun(unittest.TestCase):
    def test_a_run_gives_its_results_and_goes_on(self):
        whole = pathlib.Path(TEMPORARY.name) / "whole"
        printed = command(whole, "--seeds", "1", "2")
        self.assertIn("has no radar, which is left out of this run", printed)
        found = json.loads((whole / "results.json").read_text())
        self.assertEqual(found["absent"], ["radar"])
        self.assertEqual(len(found["subsets"]), 1 + 5 + 5)
        self.assertAlmostEqual(sum(found["attention"].values()), 1.0, places=5)
        for errors in (*found["errors"].values(), *found["subsets"].values()):
            for interval in errors.values():
                self.assertLessEqual(interval["low"], interval["value"] + 1e-9)
                self.assertGreater(interval["value"], 0)
        methods = {
            "mean position",
            "nearest neighbours",
            "student alone",
            "student distilled",
            "teacher, all",
        }
        self.assertEqual(set(found["errors"]), methods)
        for name in ("cdf.png", "cdf_subsets.png", "map.png", "inputs.png"):
            self.assertEqual((whole / name).read_bytes()[1:4], b"PNG")

        # A run that ends after the teacher's first epoch, and goes on.
        part = pathlib.Path(TEMPORARY.name) / "part"
        with mock.patch("tasks.common.training._Progress.show", side_effect=KeyboardInterrupt):
            with self.assertRaises(KeyboardInterrupt):
                command(part, "--seeds", "1", "2")
        with open(part / "seed_1/teacher/log.csv") as rows:
            self.assertEqual(len(list(csv.DictReader(rows))), 1)
        command(part, "--seeds", "1", "2")
        again = json.loads((part / "results.json").read_text())
        for key in ("errors", "subsets", "distilled_minus_alone", "attention"):
            self.assertEqual(again[key], found[key], key)

    def test_the_teacher_stays_as_it_is(self):
        out = pathlib.Path(TEMPORARY.name) / "teacher"
        weights = []
        honest = training.train_student

        def watched(folder, data, seed, targets):
            names = {"best.pt", "last.pt", "log.csv"}
            weights.append({n: (folder.parent / "teacher" / n).read_bytes() for n in names})
            if targets is not None:
                self.assertFalse(targets.position.requires_grad or targets.fused.requires_grad)
            return honest(folder, data, seed, targets)

        with mock.patch.object(experiment, "train_student", watched):
            command(out)
        after = {n: (out / "seed_1" / "teacher" / n).read_bytes() for n in weights[0]}
        self.assertEqual(weights, [after, after])

    def test_students_differ_by_their_losses_alone(self):
        out = pathlib.Path(TEMPORARY.name) / "students"
        command(out, "--set", "distillation={truth: 1.0, feature: 0.0, output: 0.0}", "--set", "alone=1")
        weights = [torch.load(out / "seed_1" / f"student_{n}" / "best.pt") for n in ("alone", "distilled")]
        for name, value in weights[0].items():
            self.assertTrue(torch.equal(value, weights[1][name]), name)
        found = json.loads((out / "results.json").read_text())["errors"]
        self.assertEqual(found["student alone"], found["student distilled"])

    def test_faults_are_plain(self):
        out = pathlib.Path(TEMPORARY.name) / "fault"
        with self.assertRaisesRegex(Error, "modalities: expected csi among them"):
            command(out, "--set", "modalities=[rgb]")
        with self.assertRaisesRegex(Error, "by: expected trajectory or place, found 'frame'"):
            command(out, "--set", "split.by=frame")

    def test_measure_says_what_a_run_takes(self):
        out = pathlib.Path(TEMPORARY.name) / "measure"
        printed = command(out, "--measure", "1")
        self.assertRegex(printed, r"teacher: 0\.\d million parameters, 0\.00 G multiply-adds a record")
        self.assertRegex(printed, r"an estimate for a GPU of 156 Tflop/s")
        self.assertFalse((out / "seed_1").exists())
        # A convolution of 3 x 3 from 2 to 5 channels on 4 x 4 pixels, and a linear layer of 80 to 3.
        layers = torch.nn.Sequential(
            torch.nn.Conv2d(2, 5, 3, padding=1), torch.nn.Flatten(), torch.nn.Linear(80, 3)
        )
        self.assertEqual(cost.macs(layers, torch.rand(1, 2, 4, 4)), 16 * 5 * 2 * 9 + 240)


if __name__ == "__main__":
    unittest.main()
