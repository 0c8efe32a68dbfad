# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests what the learning tasks share: configurations, splits, statistics, the training loop."""
import csv
import dataclasses
import importlib.util
import pathlib
import tempfile
import unittest
from typing import Dict, List, Optional, Tuple

import numpy as np

from greatx.errors import Error

TORCH = importlib.util.find_spec("torch") is not None
if TORCH:
    import torch
    from torch import nn

    from tasks.common import models, training
from tasks.common import config, splits, statistics  # noqa: E402


@dataclasses.dataclass
class Optimizer:
    rate: float
    steps: int


@dataclasses.dataclass
class Settings:
    name: str
    on: bool
    sizes: List[int]
    span: Tuple[float, float]
    limit: Optional[float]
    weights: Dict[str, float]
    optimizer: Optimizer

    def __post_init__(self):
        config.positive(rate=self.optimizer.rate)


CONFIG = """name: task
on: true
sizes: [1, 2]
span: [0, 1.5]
limit: null
weights: {a: 1, b: 0.5}
optimizer:
  rate: 1e-3
  steps: 10
"""


class Config(unittest.TestCase):
    def setUp(self):
        self.made = tempfile.TemporaryDirectory()
        self.addCleanup(self.made.cleanup)
        self.folder = pathlib.Path(self.made.name)

    def load(self, text=CONFIG, small=None, sets=()):
        (self.folder / "config.yaml").write_text(text)
        if small is not None:
            (self.folder / "small.yaml").write_text(small)
        return config.load_config(Settings, self.folder, None if small is None else "small", sets)

    def test_presets_and_changes_replace_fields_and_leave_the_others(self):
        found = self.load(small="optimizer: {steps: 3}\nsizes: [7]\n", sets=["optimizer.rate=2", "limit=4"])
        self.assertEqual(found.optimizer, Optimizer(2.0, 3))
        self.assertEqual((found.sizes, found.limit, found.name), ([7], 4.0, "task"))
        self.assertEqual(found.span, (0.0, 1.5))
        self.assertEqual(self.load().optimizer.rate, 1e-3)

    def test_errors_name_file_line_and_field(self):
        for text, small, sets, expected in (
            (
                CONFIG.replace("steps: 10", "steps: ten"),
                None,
                (),
                "config.yaml:9: optimizer.steps: expected a ",
            ),
            (
                CONFIG.replace("on: true", "on: 1"),
                None,
                (),
                "config.yaml:2: on: expected true or false, found 1",
            ),
            (CONFIG.replace("[1, 2]", "[1, 2.5]"), None, (), r"config.yaml:3: sizes\[1\]: expected a whole"),
            (CONFIG.replace("[0, 1.5]", "[0]"), None, (), "config.yaml:4: span: expected 2 values"),
            (CONFIG + "more: 1\n", None, (), "config.yaml:10: more: is not known"),
            (CONFIG.replace("on: true\n", ""), None, (), "config.yaml:1: on: expected a value, found none"),
            (CONFIG + "on: false\n", None, (), "config.yaml:10: on: expected one value, found a second"),
            (CONFIG, "optimizer:\n  step: 3\n", (), r"small.yaml:2: optimizer.step: .*did you mean 'steps'"),
            (CONFIG, None, ["optimizer.rate=-1"], "rate: expected more than 0, found -1.0"),
            (CONFIG, None, ["name"], "--set name: expected FIELD=VALUE"),
            (CONFIG, None, ["sizes=3"], "--set sizes=3: sizes: expected a list, found 3"),
            ("a: [", None, (), "is no YAML"),
        ):
            with self.subTest(expected), self.assertRaisesRegex(config.ConfigError, expected):
                self.load(text, small, sets)
        (self.folder / "config.yaml").write_text(CONFIG)
        with self.assertRaisesRegex(config.ConfigError, "none.yaml: No such file"):
            config.load_config(Settings, self.folder, "none")

    def test_the_first_change_between_two_runs_is_named(self):
        now = config.to_dict(self.load())
        self.assertIsNone(config.changed(now, config.to_dict(self.load())))
        then = config.to_dict(self.load(sets=["optimizer.steps=11"]))
        self.assertEqual(config.changed(now, then), ("optimizer.steps", 10, 11))


class Splits(unittest.TestCase):
    SHARES = {"train": 0.6, "validation": 0.2, "test": 0.2}

    def test_trajectories_stay_whole_and_shares_are_kept(self):
        trajectory = np.repeat(np.arange(50) * 7 + 3, 20)
        found = splits.by_trajectory(trajectory, self.SHARES)
        sets = {name: set(trajectory[items]) for name, items in found.items()}
        self.assertEqual(sum(len(s) for s in sets.values()), 50)
        self.assertEqual(sorted(np.concatenate(list(found.values()))), list(range(1000)))
        for name, share in self.SHARES.items():
            self.assertLessEqual(abs(len(sets[name]) - 50 * share), 1.5)

    def test_places_keep_their_distance(self):
        place = np.random.default_rng(1).uniform(-100, 100, (4000, 3))
        for gap in (0.0, 3.0):
            found = splits.by_place(place, 20, self.SHARES, seed=2, gap_m=gap)
            for a, b in (("train", "test"), ("train", "validation"), ("validation", "test")):
                away = np.linalg.norm(place[found[a], None, :2] - place[None, found[b], :2], axis=2)
                cells = [set(map(tuple, np.floor(place[found[n], :2] / 20))) for n in (a, b)]
                self.assertFalse(cells[0] & cells[1])
                self.assertGreaterEqual(away.min(), gap)
        # All cells are full here, so an item is left out just if a cell of another part is near it.
        kept = np.concatenate(list(found.values()))
        every = splits.by_place(place, 20, self.SHARES, seed=2)
        part = np.empty(4000, int)
        for i, items in enumerate(every.values()):
            part[items] = i
        for i in range(0, 4000, 40):
            cell = np.floor(place[i, :2] / 20)
            near = False
            for other in np.unique(np.floor(place[:, :2] / 20), axis=0):
                low, high = other * 20, other * 20 + 20
                inside = (np.floor(place[:, :2] / 20) == other).all(1)
                if part[inside][0] != part[i] and (other != cell).any():
                    near |= np.linalg.norm(place[i, :2] - np.clip(place[i, :2], low, high)) < 3
            self.assertEqual(near, i not in kept)

    def test_bad_requests(self):
        with self.assertRaisesRegex(Error, "no trajectory fell to 'validation'"):
            splits.by_trajectory(np.zeros(10), self.SHARES)
        with self.assertRaisesRegex(Error, "sum to 1"):
            splits.by_trajectory(np.arange(10), {"train": 0.5})
        with self.assertRaisesRegex(Error, "gap_m below its half"):
            splits.by_place(np.zeros((4, 3)), 10, self.SHARES, gap_m=5)


class Statistics(unittest.TestCase):
    def test_the_interval_of_a_mean_covers_it_as_often_as_it_says(self):
        """Groups of ten have a common part of deviation 1 and own parts of deviation 0.2: drawing items one
        by one would give intervals three times too narrow."""
        generator = np.random.default_rng(5)
        groups = np.repeat(np.arange(40), 10)
        hits = alone = 0
        for trial in range(100):
            values = np.repeat(generator.standard_normal(40), 10) + 0.2 * generator.standard_normal(400)
            found = statistics.bootstrap(values, statistics.mean, groups, draws=200, seed=trial)
            hits += found.low <= 0 <= found.high
            found = statistics.bootstrap(values, statistics.mean, draws=200, seed=trial)
            alone += found.low <= 0 <= found.high
        self.assertTrue(86 <= hits <= 100, hits)  # 95 +- 4 standard deviations
        self.assertLess(alone, 75)

    def test_seeds_widen_the_interval(self):
        same = np.random.default_rng(1).standard_normal(500)
        shifted = np.stack([same - 1, same, same + 1])
        one = statistics.bootstrap(same, statistics.mean)
        all_ = statistics.bootstrap(shifted, statistics.mean)
        self.assertAlmostEqual(one.value, all_.value)
        self.assertGreater(all_.high - all_.low, 3 * (one.high - one.low))

    def test_a_paired_difference_is_that_of_the_same_items(self):
        hard = np.random.default_rng(1).exponential(10, 300)
        found = statistics.paired_difference(hard, hard - 0.5, statistics.mean)
        for value in found:
            self.assertAlmostEqual(value, 0.5)
        with self.assertRaisesRegex(ValueError, "as many errors"):
            statistics.paired_difference(hard, hard[1:], statistics.mean)

    def test_summary(self):
        found = statistics.error_summary(np.arange(101.0))
        self.assertEqual([found[k].value for k in ("mean", "median", "p90")], [50, 50, 90])
        self.assertEqual(found["p90"].text(1)[:6], "90.0 (")


@unittest.skipUnless(TORCH, "torch is not installed (GREATX_LEARNING=1 scripts/setup.sh)")
class Training(unittest.TestCase):
    def setUp(self):
        self.made = tempfile.TemporaryDirectory()
        self.addCleanup(self.made.cleanup)
        self.folder = pathlib.Path(self.made.name)
        generator = np.random.default_rng(3)
        self.x = generator.standard_normal((64, 3)).astype(np.float32)
        self.y = self.x @ np.array([[1.0], [-2.0], [0.5]], np.float32)

    def fit(self, name, epochs, stop=None, seed=1, **options):
        training.seed_everything(seed)
        model = nn.Sequential(nn.Linear(3, 8), nn.Dropout(0.1), nn.BatchNorm1d(8), nn.Linear(8, 1))
        self.seen = []

        def batches(generator):
            if stop is not None and len(self.seen) == stop:
                raise KeyboardInterrupt
            self.seen.append(generator.integers(1 << 30))
            for items in training.shuffled(np.arange(64), 16, generator):
                yield {"x": torch.from_numpy(self.x[items]), "y": torch.from_numpy(self.y[items])}

        def loss(net, batch):
            value = (net(batch["x"]) - batch["y"]).square().mean()
            return value, {"twice": 2 * float(value.detach())}

        def validate(net):
            return {"loss": float((net(torch.from_numpy(self.x)) - torch.from_numpy(self.y)).square().mean())}

        return training.fit(
            self.folder / name,
            model,
            batches,
            loss,
            validate,
            epochs=epochs,
            optimizer=lambda p: torch.optim.Adam(p, 0.05),
            scheduler=lambda o: torch.optim.lr_scheduler.CosineAnnealingLR(o, epochs),
            seed=seed,
            device=torch.device("cpu"),
            title=name,
            **options,
        )

    def test_a_stopped_training_goes_on_to_the_same_weights_and_log(self):
        whole = self.fit("whole", 8)
        with self.assertRaises(KeyboardInterrupt):
            self.fit("stopped", 8, stop=3)
        again = self.fit("stopped", 8)
        self.assertEqual(len(self.seen), 5)
        for a, b in zip(whole.model.state_dict().values(), again.model.state_dict().values()):
            self.assertTrue(torch.equal(a, b))
        logs = [
            list(csv.DictReader((self.folder / name / "log.csv").read_text().splitlines()))
            for name in ("whole", "stopped")
        ]
        for a, b in zip(*logs):
            for name in ("epoch", "loss", "twice", "validation_loss", "learning_rate"):
                self.assertEqual(a[name], b[name])
        self.assertEqual(len(logs[1]), 8)

    def test_it_learns_and_returns_the_best_epoch(self):
        found = self.fit("learns", 40)
        losses = [row["validation_loss"] for row in found.rows]
        with torch.no_grad():
            now = (found.model(torch.from_numpy(self.x)) - torch.from_numpy(self.y)).square().mean()
        self.assertAlmostEqual(float(now), min(losses), places=5)
        self.assertLess(min(losses), 0.1 * losses[0])

    def test_seeds_decide(self):
        one, two, other = self.fit("a", 2), self.fit("b", 2), self.fit("c", 2, seed=2)
        self.assertEqual(one.rows[1]["loss"], two.rows[1]["loss"])
        self.assertNotEqual(one.rows[1]["loss"], other.rows[1]["loss"])

    def test_patience(self):
        self.y = np.random.default_rng(9).standard_normal((64, 1)).astype(np.float32)
        found = self.fit("patient", 400, patience=3)
        losses = [row["validation_loss"] for row in found.rows]
        self.assertLess(len(losses), 400)
        self.assertEqual(int(np.argmin(losses)), len(losses) - 4)
        self.assertEqual(
            self.fit("patient", 400, patience=3).epochs, len(losses)
        )  # a second call trains no more

    def test_faults(self):
        self.y[3] = np.nan
        with self.assertRaisesRegex(Error, "nan: the loss of epoch 1 is not finite"):
            self.fit("nan", 3)
        (self.folder / "torn").mkdir()
        (self.folder / "torn" / "last.pt").write_bytes(b"PK\x03\x04 no checkpoint")
        with self.assertRaisesRegex(Error, "expected a checkpoint of this model"):
            self.fit("torn", 3)

    def test_resnets_have_the_published_sizes(self):
        """K. He et al., table 1: ResNet-18 has 1.8e9, ResNet-34 3.6e9 multiply-adds for 224 x 224 x 3, and
        11.69 and 21.80 million parameters with a classifier of 1,000 classes (513,000)."""
        for depth, count, work in ((18, 11689512, 1.8e9), (34, 21797672, 3.6e9)):
            net = models.resnet(depth, 1.0, 3, 512)
            self.assertEqual(models.parameters(net), count - 513000)
            self.assertAlmostEqual(models.macs(net, torch.zeros(1, 3, 224, 224)) / work, 1, delta=0.03)
        half = models.resnet(18, 0.5, 2, 512)
        self.assertEqual(half(torch.zeros(2, 2, 64, 64)).shape, (2, 512))
        with self.assertRaisesRegex(Error, "depth: expected one of 18, 34"):
            models.resnet(50, 1.0, 3, 512)


if __name__ == "__main__":
    unittest.main()
