# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the task blockage: its labels on sequences made by hand, its measures, a whole run."""
import importlib.util
import json
import pathlib
import tempfile
import unittest
from types import SimpleNamespace

import numpy as np

from greatx.errors import Error
from tasks.blockage import baselines, labels, measures
from tasks.street import geometry

TORCH = importlib.util.find_spec("torch") is not None
if TORCH:
    import torch

    from street_data import run_task, tiny
    from tasks.blockage import experiment, outcome
    from tasks.street import drives, inputs


class Labels(unittest.TestCase):
    def test_the_ticks_to_the_first_blockage(self):
        sight = [1, 1, 1, 1, 0, 0, 1, 1, 1, 1, 1]
        #        0 of 3 ahead; then 3, 2, 1; blocked; 3 free ahead; the last three have no future
        self.assertEqual(labels.first_blockage(sight, 3).tolist(), [0, 3, 2, 1, -1, -1, 0, 0, -1, -1, -1])

    def test_a_blockage_of_one_tick_and_one_right_after_the_begin(self):
        self.assertEqual(labels.first_blockage([1, 0, 1, 1, 0, 1], 2).tolist(), [1, -1, 2, 1, -1, -1])

    def test_drives_that_are_blocked_or_free_throughout(self):
        self.assertEqual(labels.first_blockage([0] * 5, 2).tolist(), [-1] * 5)
        self.assertEqual(labels.first_blockage([1] * 5, 2).tolist(), [0, 0, 0, -1, -1])

    def test_a_drive_that_is_shorter_than_the_horizon_has_no_labels(self):
        self.assertEqual(labels.first_blockage([1, 0], 2).tolist(), [-1, -1])
        self.assertEqual(labels.first_blockage([], 2).tolist(), [])

    def test_labels_are_those_of_the_definition(self):
        generator = np.random.default_rng(1)
        for _ in range(50):
            sight = generator.random(20) < 0.8
            first = labels.first_blockage(sight, 4)
            for tick in range(20):
                known = sight[tick] and tick + 4 < 20
                self.assertEqual(first[tick] >= 0, known)
                for k in range(1, 5):
                    if known:
                        within = 0 < first[tick] <= k
                        self.assertEqual(within, not all(sight[tick + 1 : tick + 1 + k]))

    def test_onsets_begin_after_a_tick_with_line_of_sight(self):
        self.assertEqual(labels.onsets([0, 0, 1, 0, 1, 1, 0, 0]).tolist(), [3, 6])
        self.assertEqual(labels.onsets([1, 1]).tolist(), [])

    def test_uneven_ticks_are_an_error(self):
        drive = np.array([0, 0, 0, 1, 1, 1])
        self.assertEqual(labels.check_steps(np.array([0, 2, 4, 0, 2, 4]), drive), 2)
        with self.assertRaisesRegex(Error, r"even steps of ticks, found steps of \[2, 3\]"):
            labels.check_steps(np.array([0, 2, 4, 0, 2, 5]), drive)


class Measures(unittest.TestCase):
    def setUp(self):
        generator = np.random.default_rng(3)
        self.truth = generator.random(60) < 0.3
        self.score = np.round(generator.normal(size=60) + self.truth, 1)  # with equal scores

    def test_average_precision_is_the_sum_over_thresholds(self):
        total, before = 0.0, 0.0
        for threshold in sorted(set(self.score), reverse=True):
            alarm = self.score >= threshold
            recall = np.mean(alarm[self.truth])
            total += (recall - before) * np.mean(self.truth[alarm])
            before = recall
        self.assertAlmostEqual(measures.average_precision(self.score, self.truth), total)

    def test_roc_auc_is_the_share_of_pairs_in_the_right_order(self):
        pairs = [
            1.0 if p > n else 0.5 if p == n else 0.0
            for p in self.score[self.truth]
            for n in self.score[~self.truth]
        ]
        self.assertAlmostEqual(measures.roc_auc(self.score, self.truth), np.mean(pairs))

    def test_equal_scores_for_all_tell_nothing(self):
        same = np.ones(60)
        self.assertAlmostEqual(measures.average_precision(same, self.truth), self.truth.mean())
        self.assertEqual(measures.roc_auc(same, self.truth), 0.5)

    def test_perfect_scores(self):
        self.assertEqual(measures.average_precision(self.truth + 0.0, self.truth), 1)
        self.assertEqual(measures.roc_auc(self.truth + 0.0, self.truth), 1)
        self.assertEqual(measures.f1(self.truth, self.truth), 1)

    def test_one_kind_alone(self):
        for truth in (np.zeros(4, bool), np.ones(4, bool)):
            self.assertEqual(measures.average_precision(np.arange(4.0), truth), truth.mean())
            self.assertEqual(measures.roc_auc(np.arange(4.0), truth), 0.5)
        self.assertEqual(measures.f1(np.zeros(4, bool), np.zeros(4, bool)), 0)

    def test_the_best_threshold_has_the_highest_f1(self):
        best = measures.best_threshold(self.score, self.truth)
        values = [measures.f1(self.score >= t, self.truth) for t in set(self.score)]
        self.assertAlmostEqual(measures.f1(self.score >= best, self.truth), max(values))

    def test_alarms_keep_the_share_of_false_ones(self):
        for share in (0.05, 0.2, 0.5):
            threshold = measures.alarm_threshold(self.score, self.truth, share)
            self.assertLessEqual(np.mean(self.score[~self.truth] >= threshold), share)
            lower = max(self.score[self.score < threshold])
            self.assertGreater(np.mean(self.score[~self.truth] >= lower), share)

    def test_lead_time_counts_back_to_the_first_silence(self):
        alarm = np.array([1, 0, 1, 1, 1, 0], bool)
        self.assertEqual(measures.lead_ticks(alarm, 5), 3)
        self.assertEqual(measures.lead_ticks(alarm, 2), 0)
        self.assertEqual(measures.lead_ticks(alarm, 1), 1)
        self.assertEqual(measures.lead_ticks(alarm, 6), 0)


class Baselines(unittest.TestCase):
    def test_the_base_rate_is_that_of_the_training_items(self):
        first = np.array([0, 1, 2, 3, 0, 1])
        out = baselines.base_rate(first, np.arange(5), np.array([5]), 3)
        np.testing.assert_allclose(out, [[0.2, 0.4, 0.6]])

    def test_straight_on_meets_the_box_when_it_arrives(self):
        still, turn = np.zeros((1, 3)), np.eye(3)[None]
        link = geometry.Ends(still, still + [10, 0, 0], turn, still)
        # The front of the box is 1 m beside the line and comes nearer at 4 m/s: it meets it after 0.25 s.
        low, high = np.array([-1.0, -1, -1]), np.array([1.0, 1, 1])
        body = geometry.Body("bus", low, high, np.array([[5, 2, 0]]), turn, np.array([[0, -4.0, 0]]))
        out = baselines.straight_on(link, [body], np.array([0]), 4, 0.1)
        np.testing.assert_allclose(out, [[0, 0, 0.5, 0.5]])
        away = body._replace(velocity_m_s=np.array([[0, 4.0, 0]]))
        np.testing.assert_allclose(baselines.straight_on(link, [away], np.array([0]), 4, 0.1), 0)


@unittest.skipUnless(TORCH, "needs PyTorch")
class Task(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.made.cleanup)
        cls.out = pathlib.Path(cls.made.name) / "run"
        shares = ("--set", "shares={train: 0.5, validation: 0.25, test: 0.25}")
        cls.arguments = (tiny(), "-o", cls.out, "--quick", "--threads", "1", *shares)
        cls.printed = run_task(experiment.run, *cls.arguments)

    def test_results_are_written(self):
        results = json.loads((self.out / "results.json").read_text())
        names = ["base rate", "true motion, straight on", "power", "events + radar + csi"]
        self.assertEqual(list(results), names)
        for of in results.values():
            self.assertEqual(list(of["average_precision"]), ["1", "3"])
        for title in ("Blocked within 3 ticks", "events + radar + csi minus another network", "Lead time"):
            self.assertIn(f"## {title}", self.printed)
        for name in ("horizon", "precision_recall", "lead", "timeline"):
            self.assertGreater((self.out / f"{name}.png").stat().st_size, 5000)

    def test_probabilities_grow_with_the_horizon(self):
        stored = np.load(self.out / "probabilities.npz")
        for name in ("base rate", "power", "events + radar + csi"):
            self.assertTrue(np.all(np.diff(stored[name], axis=-1) >= 0))
            self.assertTrue(np.all((stored[name] >= 0) & (stored[name] <= 1)))

    def test_probabilities_of_logits(self):
        out = experiment.within(np.log(np.array([[0.5, 0.2, 0.3]], np.float32)) + 7)
        np.testing.assert_allclose(out, [[0.2, 0.5]], rtol=1e-6)

    def test_the_past_is_in_order_and_of_the_same_drive(self):
        opened = drives.open_drives(tiny(), ["csi"], {"train": 0.5, "validation": 0.25, "test": 0.25})
        number = np.arange(len(opened), dtype=np.float32)[:, None]
        problem = experiment.Problem(opened, None, None, None, {"power": number}, 3, 4, {}, None)
        items = np.flatnonzero(opened.order >= 2)
        past = problem.gather(["power"], items)["power"].numpy()
        np.testing.assert_array_equal(past, items[:, None] + [-2, -1, 0])
        self.assertTrue(np.all(opened.drive[items - 2] == opened.drive[items]))

    def test_a_mirror_turns_what_has_a_left_and_a_right(self):
        batch = {
            "power": torch.tensor([[1.0, 2], [3, 4]]),
            "csi": torch.tensor(
                [[0.0, 1, 2, 3, 10, 11, 12, 13]] * 2
            ),  # two ticks of beams at -1, -1/2, 0, 1/2
            "events": torch.arange(16.0).reshape(2, 4, 1, 2),
            "radar": torch.arange(16.0).reshape(2, 4, 1, 2),  # azimuth, velocity, azimuth, velocity
            "label": torch.tensor([1, 0]),
        }
        out = experiment.mirrored(batch, np.array([False, True]), 2)
        for name, value in batch.items():
            np.testing.assert_array_equal(out[name][0], value[0])
        self.assertEqual(out["csi"][1].tolist(), [0, 3, 2, 1, 10, 13, 12, 11])
        np.testing.assert_array_equal(out["events"][1], batch["events"][1].flip(-1))
        np.testing.assert_array_equal(out["radar"][1, ::2], batch["radar"][1, ::2].flip(-1))
        np.testing.assert_array_equal(out["radar"][1, 1::2], batch["radar"][1, 1::2])
        np.testing.assert_array_equal(out["power"], batch["power"])
        self.assertEqual(out["label"].tolist(), [1, 0])

    def test_events_are_counted_in_their_cells(self):
        opened = drives.open_drives(tiny(), ["bs/events"], {"train": 0.5, "validation": 0.25, "test": 0.25})
        record = opened.sequences[0]["bs/events"].record(5)
        made = inputs.events("bs/events", (4, 8))[2](record)
        counts = record.events().counts().reshape(2, 4, 4, 8, 4).sum((2, 4))
        np.testing.assert_allclose(np.expm1(made), counts, atol=1e-9)
        self.assertGreater(counts.sum(), 0)

    def test_without_line_of_sight_a_box_stands_between(self):
        """A blocked link has a body between its ends; the box of a body is larger than the body, so that the
        reverse holds for most ticks alone."""
        opened = drives.open_drives(tiny(), ["csi"], {"train": 0.5, "validation": 0.25, "test": 0.25})
        sight = opened.gather("csi", "line_of_sight")[:, 0, 0] > 0
        bus = [body for body in geometry.bodies(opened) if body.node == "bus"]
        met = geometry.blocked(geometry.ends(opened, "csi"), bus)
        self.assertEqual(geometry.receiver_node(opened, "csi"), "car")
        self.assertEqual(np.count_nonzero(~sight & ~met), 0)
        self.assertGreater(np.mean(~sight[met]), 0.6)
        self.assertGreater(np.count_nonzero(~sight), 10)

    def test_differences_take_the_same_drives_of_both(self):
        """A method minus itself is 0 in every draw, and a perfect method is better than one without
        information by one minus the share of positives."""
        first = np.array([0, 1, 0, 2, 0, 0, 1, 0])
        items = np.arange(8)
        opened = SimpleNamespace(trajectory=items // 2, drive=items // 2)
        split = {"validation": items, "test": items}
        problem = SimpleNamespace(split=split, asked=items, first=first, drives=opened)
        truth = ((first > 0) & (first <= 1)).astype(float)
        perfect = outcome.Scored(np.tile(truth[None, :, None], (2, 1, 1)), items, problem, 100)
        blind = outcome.Scored(np.zeros((2, 8, 1)), items, problem, 100)
        same = outcome.difference(perfect, perfect, measures.average_precision, 1)
        self.assertEqual(same, (0, 0, 0))
        gain = outcome.difference(perfect, blind, measures.average_precision, 1)
        self.assertAlmostEqual(gain.value, 1 - 2 / 8)
        self.assertEqual(perfect.f1(1).value, 1)

    def test_a_run_goes_on(self):
        before = (self.out / "results.json").read_text()
        printed = run_task(experiment.run, *self.arguments)
        self.assertNotIn("epoch", printed.split("#")[0])
        self.assertEqual(before, (self.out / "results.json").read_text())

    def test_faulty_configurations_are_errors(self):
        other = pathlib.Path(self.made.name) / "other"
        for change, message in (
            ("shown=2", "shown: expected one of the horizons"),
            ("horizons=[3, 1]", "horizons: expected different ticks in ascending order"),
            ("networks=[[lidar]]", "networks: expected lists of power, csi, events, radar"),
        ):
            with self.assertRaisesRegex(Error, message):
                run_task(experiment.run, tiny(), "-o", other, "--quick", "--set", change)


if __name__ == "__main__":
    unittest.main()
