# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of an experiment's inputs and estimates."""
from __future__ import annotations

import pathlib
from typing import Dict

import numpy as np

from tasks.common import plots

from .training import Data


def flights_map(path: pathlib.Path, data: Data, flights: np.ndarray, said: Dict[str, np.ndarray]) -> None:
    """Draws the test flights from above, and where the networks of the first seed say that the drone is."""
    test = data.parts["test"]
    true = data.position_m[test].numpy()
    names = ["student distilled", "teacher"]
    with plots.figure(path, 8.0, 4.0, ncols=2, sharex=True, sharey=True) as axes:
        for ax, name in zip(axes, names):
            for flight in np.unique(flights):
                rows = np.flatnonzero(flights == flight)
                # A place splits flights: a line joins neighbouring records alone.
                for part in np.split(rows, np.flatnonzero(np.diff(test[rows]) > 1) + 1):
                    ax.plot(*true[part, :2].T, color="0.6", linewidth=1.2, zorder=1)
            where = said[name]
            segments = np.stack([true[:, :2], where[:, :2]], 1)
            for (x0, y0), (x1, y1) in segments:
                ax.plot([x0, x1], [y0, y1], color="tab:red", linewidth=0.3, alpha=0.5, zorder=2)
            ax.scatter(where[:, 0], where[:, 1], s=2.5, color="tab:blue", zorder=3)
            ax.set(title=name, xlabel="x, m", aspect="equal")
        axes[0].set_ylabel("y, m")


def inputs_picture(path: pathlib.Path, data: Data) -> None:
    """Draws the networks' inputs of the test record with the most modalities: of several one beyond
    the middle, which is rarely the first of a flight, when an event camera has seen nothing yet.
    """
    test = data.parts["test"]
    count = data.present[test].sum(1).numpy()
    most = test[count == count.max()]
    record = most[len(most) // 2 + len(most) // 50]
    shown = {}
    for i, name in enumerate(data.modalities):
        if data.present[record, i]:
            value = np.asarray(data.arrays[name][record]).astype(np.float32)
            # csi: the level; lidar: the range; events: the sum over the bins
            planes = {"rgb": value.transpose(1, 2, 0) / 255, "csi": value[2 % len(value)]}
            shown[name] = planes.get(name, value.sum(0) if name == "events" else value[0])
    with plots.figure(path, 2.2 * len(shown), 2.5, ncols=len(shown), squeeze=False) as axes:
        for ax, (name, plane) in zip(axes[0], shown.items()):
            size = " x ".join(map(str, data.arrays[name].shape[1:]))
            most = max(float(np.abs(plane).max()), 1e-6)
            signed = {"cmap": "coolwarm", "vmin": -most, "vmax": most} if name == "events" else {}
            ax.imshow(plane, aspect="auto", **signed)
            ax.set_title(f"{name}: {size}", fontsize=8)
            ax.set_xticks([])
            ax.set_yticks([])
