# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Trains networks on one domain, and tries them on others, beside what needs no training."""
from __future__ import annotations

import copy
import dataclasses
import pathlib
from typing import Dict, List, Tuple

import numpy as np
import torch

from greatx.errors import Error

from ..common.command import Context
from ..common.config import positive, shares
from ..common.splits import by_place
from ..common.training import Fit, seed_everything
from . import tune
from .floors import Principal, mean_restored, second_moment, unit
from .metrics import normalized_errors, similarities
from .models import Autoencoder, network
from .sets import ChannelSet
from .start import principal_restart, principal_start
from .transforms import images


@dataclasses.dataclass
class Transfer:
    """How networks are tuned to another domain."""

    size: int
    users: List[int]
    source_weight: float
    training: tune.Training

    def __post_init__(self) -> None:
        positive(source_weight=self.source_weight)


@dataclasses.dataclass
class Config:
    """config.yaml explains the fields."""

    source: str
    targets: List[str]
    cell_m: float
    shares: Dict[str, float]
    most_train: int
    most_validation: int
    most_test: int
    sizes: List[int]
    extra_sizes: List[int]
    csinet: tune.Training
    crnet: tune.Training
    transfer: Transfer
    subcarrier_step: int
    draws: int

    def __post_init__(self) -> None:
        positive(cell_m=self.cell_m, subcarrier_step=self.subcarrier_step, draws=self.draws)
        shares(self.shares)
        if self.transfer.size not in self.sizes:
            raise ValueError(
                f"transfer.size: expected one of sizes, {self.sizes}, found {self.transfer.size}"
            )
        if not set(self.extra_sizes) <= set(self.sizes):
            raise ValueError(f"extra_sizes: expected some of sizes, {self.sizes}, found {self.extra_sizes}")


@dataclasses.dataclass
class Split:
    """The users of a domain in three parts by place."""

    channels: ChannelSet
    train: np.ndarray  #: complex64 [n, angle, delay]
    validation: np.ndarray
    test: np.ndarray
    places: np.ndarray  #: int64 [test]: the cell of each user of the test, for the bootstrap


@dataclasses.dataclass
class Score:
    """The users of a test, restored by one method with one seed or with several."""

    errors: np.ndarray  #: [n] or [seeds, n]: normalized_errors
    similarities: np.ndarray  #: of the same shape: rho
    cpu_seconds: float = 0.0  #: of its training, mean over seeds


def split(channels: ChannelSet, config: Config) -> Split:
    """Cuts a set into parts by place. A part with more users than the configuration's most is thinned."""
    parts = by_place(channels.position_m, config.cell_m, config.shares)
    chosen: Dict[str, np.ndarray] = {}
    for name, most in (
        ("train", config.most_train),
        ("validation", config.most_validation),
        ("test", config.most_test),
    ):
        items = parts[name]
        order = np.random.default_rng(0).permutation(len(items))[:most]
        chosen[name] = items[np.sort(order)]
    cells = np.floor(channels.position_m[chosen["test"], :2] / config.cell_m).astype(np.int64)
    _, places = np.unique(cells, axis=0, return_inverse=True)
    return Split(channels, *(channels.channels[chosen[n]] for n in chosen), places.reshape(-1))


def score(data: Split, restored: np.ndarray, config: Config, cpu_seconds: float = 0.0) -> Score:
    """Compares restored matrices of the test with the true ones."""
    true = unit(data.test)
    rho = similarities(true, restored, data.channels.facts["subcarriers"], config.subcarrier_step)
    return Score(normalized_errors(true, restored), rho, cpu_seconds)


def joined(scores: List[Score]) -> Score:
    """Returns the scores of several seeds as one, [seeds, n]."""
    return Score(
        np.stack([s.errors for s in scores]),
        np.stack([s.similarities for s in scores]),
        float(np.mean([s.cpu_seconds for s in scores])),
    )


class Source:
    """The networks that are trained on the source domain."""

    def __init__(self, context: Context, data: Split):
        self.context, self.config, self.data = context, context.config, data
        if data.channels.channels.shape[1:] != (32, 32):
            shape = list(data.channels.channels.shape[1:])
            raise Error(f"{data.channels.name}: expected 32 angles and 32 delays, found {shape}")
        self.moment = second_moment(data.train)
        self.shape = data.train.shape[1:]
        self.principal = Principal.of(self.moment, self.shape)
        self._fits: Dict[Tuple[str, int, int], Fit] = {}  #: by network, size, seed

    def blended(self, few: np.ndarray) -> Principal:
        """Returns components of the source and of some users of a target. The source counts as much as
        `transfer.source_weight` users, which keeps the estimate from few users from being a fit to them."""
        share = len(few) / (len(few) + self.config.transfer.source_weight)
        return Principal.of((1 - share) * self.moment + share * second_moment(few), self.shape)

    def trained(self, name: str, size: int, seed: int) -> "tuple[Autoencoder, float]":
        """Returns a trained network, a copy that may be changed, and the CPU seconds of its training."""
        key = (name, size, seed)
        if key not in self._fits:
            self._fits[key] = self._train(*key)
        return copy.deepcopy(self._fits[key].model), self._fits[key].cpu_seconds

    def _train(self, name: str, size: int, seed: int) -> Fit:
        """Trains a network, or goes on where a run was stopped."""
        training = getattr(self.config, name)
        seed_everything(seed)
        model = network(name, size)
        if training.start == "principal":
            few = torch.from_numpy(images(self.data.train[:1000]))
            principal_start(model, self.principal, few)
        return tune.train(
            self.context.out / "networks" / f"{name}_{size}_{seed}",
            model,
            training,
            self.data.train,
            self.data.validation,
            seed=seed,
            device=self.context.device,
            title=f"{name}, M = {size}, seed {seed}",
            tensorboard=self.context.tensorboard,
        )

    def scores(self, name: str, size: int) -> Score:
        """Returns a network's score on the source's test, [seeds, n]."""
        out = []
        for seed in self.context.seeds:
            model, seconds = self.trained(name, size, seed)
            restored = tune.restore(model, self.data.test, self.context.device)
            out.append(score(self.data, restored, self.config, seconds))
        return joined(out)


def source_scores(source: Source) -> Dict[str, Dict[int, Score]]:
    """Returns the scores of all methods by size, on the domain on which they were trained."""
    data, config = source.data, source.config
    mean = score(data, mean_restored(data.train, data.test), config)
    out: Dict[str, Dict[int, Score]] = {"mean": {size: mean for size in config.sizes}}
    out["pca"] = {
        size: score(data, source.principal.restored(data.test, size), config) for size in config.sizes
    }
    out["csinet"] = {size: source.scores("csinet", size) for size in config.sizes}
    out["crnet"] = {size: source.scores("crnet", size) for size in config.extra_sizes}
    return out


def target_scores(source: Source, name: str, data: Split) -> Dict[str, Score]:
    """Returns the scores on another domain: methods of the source as they are, and tuned to users of the
    target."""
    config, context, size = source.config, source.context, source.config.transfer.size
    out = {
        "mean of the target": score(data, mean_restored(data.train, data.test), config),
        "pca of the source": score(data, source.principal.restored(data.test, size), config),
    }
    for network_name in ["csinet"] + (["crnet"] if size in config.extra_sizes else []):
        shots = []
        for seed in context.seeds:
            model, _ = source.trained(network_name, size, seed)
            shots.append(score(data, tune.restore(model, data.test, context.device), config))
        out[f"{network_name} of the source"] = joined(shots)
    for users in config.transfer.users:
        if users > len(data.train):
            continue  # a small set: the table has a gap
        rows: Dict[str, List[Score]] = {}
        for seed in context.seeds:
            few = data.train[np.random.default_rng(seed).permutation(len(data.train))[:users]]
            blended = source.blended(few)
            own = Principal.fit(few).restored(data.test, size)
            rows.setdefault(f"pca of {users} users", []).append(score(data, own, config))
            both = score(data, blended.restored(data.test, size), config)
            rows.setdefault(f"pca of the source and {users} users", []).append(both)
            tuned = _tuned(source, name, data, few, seed, blended)
            rows.setdefault(f"csinet tuned to {users} users", []).append(tuned)
        out.update({method: joined(scores) for method, scores in rows.items()})
    return out


def _tuned(source: Source, name: str, data: Split, few: np.ndarray, seed: int, blended: Principal) -> Score:
    config, context = source.config, source.context
    model, _ = source.trained("csinet", config.transfer.size, seed)
    if config.transfer.training.start == "principal":
        principal_restart(model, blended, torch.from_numpy(images(few[:1000])).to(context.device))
    fit = tune.train(
        context.out / "tuned" / f"{name}_{len(few)}_{seed}",
        model,
        config.transfer.training,
        few,
        data.validation,
        seed=seed,
        device=context.device,
        title=f"csinet tuned to {len(few)} users of {name}, seed {seed}",
    )
    return score(data, tune.restore(fit.model, data.test, context.device), config, fit.cpu_seconds)


def existing(data: pathlib.Path, targets: List[str]) -> "tuple[List[str], List[str]]":
    """Returns the targets that DATA has, and those that it lacks."""
    there = [name for name in targets if (data / name / "set.json").is_file()]
    return there, [name for name in targets if name not in there]
