#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes an impaired "field" set from a set of clean channels.

    python3 python/tasks/csi_feedback/impair.py out/csi/etoile -o out/csi/field --seed 1

Each impairment is a function of its own with a published model. They follow each other as in the field: the
air adds a diffuse tail, the array has calibration errors, and its oscillator drifts while the ports are
sounded one after the other. Nothing of this is measured: the set is simulated and named so."""
from __future__ import annotations

import argparse
import pathlib
import sys
from typing import Any, Dict, Tuple

import numpy as np

if __package__ in (None, ""):
    # Behind PYTHONPATH, which names the folder of the greatx that has the compiled module.
    sys.path.append(str(pathlib.Path(__file__).resolve().parents[2]))
    __package__ = "tasks.csi_feedback"

from greatx.errors import Error

from .sets import ChannelSet, load, save
from .transforms import in_angles, in_ports


def diffuse_tail(
    matrices: np.ndarray, power_db: float, decay_s: float, bandwidth_hz: float, generator: np.random.Generator
) -> np.ndarray:
    """Returns matrices with a tail of dense multipath added, complex64 [n, angle, delay].

    The tail is complex Gaussian, equally strong in all angles, and falls from the bin of the largest power on
    as e^{-tau/decay_s}: the dense multipath components of A. Richter ("Estimation of radio channel
    parameters", TU Ilmenau, 2005, section 2.5) for a bandwidth far above 1 / decay_s and white angles. Its
    expected power is `power_db` relative to that of the matrix.
    """
    count, angles, delays = matrices.shape
    bins = np.arange(delays)
    first = np.square(np.abs(matrices)).sum(1).argmax(1)
    behind = bins[None] - first[:, None]
    profile = np.where(behind >= 0, np.exp(-behind / (decay_s * bandwidth_hz)), 0.0)
    profile /= profile.sum(1, keepdims=True) * angles
    power = np.square(np.abs(matrices), dtype=np.float64).sum((1, 2)) * 10 ** (power_db / 10)
    draws = generator.standard_normal((count, angles, delays, 2)) @ [1, 1j] / np.sqrt(2)
    tail = draws * np.sqrt(power[:, None] * profile)[:, None]
    return (matrices + tail).astype(np.complex64)


def calibration_error(
    matrices: np.ndarray, gain_db: float, phase_deg: float, generator: np.random.Generator
) -> np.ndarray:
    """Returns matrices of an array whose ports have errors of gain and phase, the same for all users.

    Port m is multiplied by c_m = 10^(g_m/20) e^{j p_m}, where g_m and p_m are normal with the rms `gain_db`
    and `phase_deg` (the diagonal model of R. Rogalin et al., "Scalable synchronization and reciprocity
    calibration for distributed multiuser MIMO", IEEE Trans. Wireless Commun. 13(4), 2014, section IV), scaled
    to a mean |c_m|^2 of 1.
    """
    ports = matrices.shape[1]
    gain = generator.normal(0, gain_db, ports)
    phase = np.radians(generator.normal(0, phase_deg, ports))
    c = 10 ** (gain / 20) * np.exp(1j * phase)
    c /= np.sqrt(np.mean(np.abs(c) ** 2))
    return in_angles((in_ports(matrices) * c[:, None]).astype(np.complex64))


def phase_noise(
    matrices: np.ndarray, linewidth_hz: float, spacing_s: float, generator: np.random.Generator
) -> np.ndarray:
    """Returns matrices that were sounded port by port with a free-running oscillator. Their power is kept.

    The phase from port to port is a random walk (a Wiener process), whose steps have the variance
    2 pi linewidth_hz spacing_s for a Lorentzian line of that full width at half its height (A. Demir, A.
    Mehrotra, J. Roychowdhury, "Phase noise in oscillators: a unifying theory", IEEE Trans. Circuits Syst. I
    47(5), 2000). Each user has a walk of its own.
    """
    count, ports, _ = matrices.shape
    step = np.sqrt(2 * np.pi * linewidth_hz * spacing_s)
    walk = np.cumsum(generator.normal(0, step, (count, ports)), axis=1)
    turn = np.exp(1j * (walk - walk[:, :1]))
    return in_angles((in_ports(matrices) * turn[:, :, None]).astype(np.complex64))


def field(
    channels: ChannelSet,
    seed: int,
    *,
    tail: Tuple[float, float],
    calibration: Tuple[float, float],
    oscillator: Tuple[float, float],
) -> ChannelSet:
    """Returns a set with all impairments, and their values in its facts.

    tail         power in dB relative to the channel, decay in s
    calibration  rms of the gains in dB and of the phases in degrees
    oscillator   linewidth in Hz, time between ports in s
    """
    air, array, drift = (np.random.default_rng([seed, k]) for k in range(3))
    matrices = diffuse_tail(channels.channels, *tail, channels.facts["bandwidth_hz"], air)
    matrices = calibration_error(matrices, *calibration, array)
    matrices = phase_noise(matrices, *oscillator, drift)
    impairments: Dict[str, Any] = {
        "seed": seed,
        "diffuse_tail": dict(zip(("power_db", "decay_s"), tail)),
        "calibration_error": dict(zip(("gain_db", "phase_deg"), calibration)),
        "phase_noise": dict(zip(("linewidth_hz", "spacing_s"), oscillator)),
    }
    facts = {**channels.facts, "name": f"{channels.name}, impaired", "impairments": impairments}
    return ChannelSet(matrices, channels.position_m, channels.outside, facts)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("set", type=pathlib.Path, metavar="SET", help="folder of a set")
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True, help="folder of the impaired set")
    parser.add_argument("--seed", type=int, default=1)
    pair = dict(nargs=2, type=float)
    parser.add_argument("--tail", **pair, default=(-10.0, 100e-9), metavar=("DB", "S"))
    parser.add_argument("--calibration", **pair, default=(0.5, 5.0), metavar=("DB", "DEG"))
    parser.add_argument("--oscillator", **pair, default=(10.0, 71.4e-6), metavar=("HZ", "S"))
    options = parser.parse_args()
    if options.tail[1] <= 0 or min(*options.calibration, *options.oscillator) < 0:
        raise Error("--tail, --calibration, --oscillator: expected a decay above 0 and nothing below 0")
    if (options.out / "set.json").exists():
        raise Error(f"{options.out}: expected no set there, found one")
    made = field(
        load(options.set),
        options.seed,
        tail=tuple(options.tail),
        calibration=tuple(options.calibration),
        oscillator=tuple(options.oscillator),
    )
    save(options.out, made)
    print(f"{options.out}: {len(made)} users, {made.name}")


if __name__ == "__main__":
    from tasks.common.command import main as run

    run(main)
