# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes channels by hand for the tests of the task csi_feedback."""
import numpy as np

from tasks.csi_feedback import sets, transforms


def path_response(angle, delay, ports=32, subcarriers=64):
    """Returns H of one path with a phase of 2 pi angle/ports a port and a delay in bins."""
    k = np.arange(subcarriers) - subcarriers // 2
    port = np.exp(2j * np.pi * angle * np.arange(ports) / ports)
    return port[:, None] * np.exp(-2j * np.pi * k * delay / subcarriers)


def sparse_channels(count, seed, paths=3):
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
