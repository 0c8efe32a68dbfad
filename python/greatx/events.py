# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the events of an event camera, and makes pictures and tensors of them (docs/events.md)."""
from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Optional, Tuple

import numpy as np

from .errors import DatasetError
from .files import Field

if TYPE_CHECKING:
    from .dataset import Sensor

#: Colours of Events.picture for pixels that got brighter, got darker, and did not change.
ON, OFF, NEUTRAL = (214, 39, 40), (31, 90, 200), (128, 128, 128)


@dataclasses.dataclass(frozen=True)
class Events:
    """Holds events, sorted by (t, y, x, p). Each array has one entry per event."""

    t: np.ndarray  #: int64, ns since the sequence's first tick
    x: np.ndarray  #: uint16, column
    y: np.ndarray  #: uint16, row
    p: np.ndarray  #: uint8, 1: brighter, 0: darker
    width: int
    height: int
    instance: Optional[np.ndarray] = None  #: uint32, index into instances + 1, if the data set has it

    @classmethod
    def of(cls, sensor: "Sensor", first: int, last: int) -> "Events":
        """Returns the events of the records first to last - 1 of an event camera, as views of its files if
        these can be memory-mapped. Raises DatasetError if the sensor is no event camera or its arrays are not
        valid.
        """
        if sensor.kind != "event_camera" or "t" not in sensor.arrays:
            raise DatasetError(f"{sensor.name}: is no event camera with events, but {sensor.kind}")
        for name, kind in (("x", np.uint16), ("y", np.uint16), ("p", np.uint8), ("t", np.int64)):
            if (
                name not in sensor.arrays
                or sensor.arrays[name].dtype != kind
                or sensor.arrays[name].shape != (-1,)
            ):
                raise DatasetError(
                    f"{sensor.metadata.where}: expected an event camera's array {name!r}, "
                    f"{np.dtype(kind).name} [n]"
                )
            if not np.array_equal(sensor[name].offsets, sensor["t"].offsets):
                raise DatasetError(
                    f"{sensor.sequence.path / sensor.name}: expected as many of {name!r} as of 't' in each "
                    "record"
                )
        columns = {
            name: sensor[name].rows(first, last)
            for name in ("t", "x", "y", "p", "instance")
            if name in sensor.arrays
        }
        size = Field(sensor.metadata.where, sensor.metadata)
        width, height = (size[side].integer(1, 65536) for side in ("width", "height"))
        for name, side in (("x", width), ("y", height)):
            if len(columns["t"]) and columns[name].max() >= side:
                raise DatasetError(
                    f"{sensor.sequence.path / sensor.name}: expected {name} below {side}, found "
                    f"{columns[name].max()}"
                )
        if len(columns["t"]) and columns["p"].max() > 1:
            raise DatasetError(
                f"{sensor.sequence.path / sensor.name}: expected p of 0 and 1, found {columns['p'].max()}"
            )
        return cls(width=width, height=height, **columns)

    def __len__(self) -> int:
        return len(self.t)

    def between(self, begin_ns: int, end_ns: int) -> "Events":
        """Returns the events with begin_ns < t <= end_ns. A record holds such an interval from one tick to
        the next.
        """
        part = slice(*np.searchsorted(self.t, [begin_ns, end_ns], side="right"))
        return dataclasses.replace(
            self,
            t=self.t[part],
            x=self.x[part],
            y=self.y[part],
            p=self.p[part],
            instance=None if self.instance is None else self.instance[part],
        )

    def counts(self) -> np.ndarray:
        """Returns int32 [2, height, width], the numbers of darker and of brighter events of each pixel."""
        bins = (self.p.astype(np.int64) * self.height + self.y) * self.width + self.x
        return (
            np.bincount(bins, minlength=2 * self.height * self.width)
            .reshape(2, self.height, self.width)
            .astype(np.int32)
        )

    def frame(self) -> np.ndarray:
        """Returns int32 [height, width], the number of brighter minus the number of darker events. This
        number times the threshold is the change of ln(luminance).
        """
        darker, brighter = self.counts()
        return brighter - darker

    def voxel_grid(self, bins: int, span_ns: Optional[Tuple[int, int]] = None) -> np.ndarray:
        """Returns float32 [bins, height, width], the polarities (1, -1) distributed linearly to the two
        nearest bins in time (A. Zhu et al., "Unsupervised Event-based Learning", CVPR 2019, eq. 1-2).
        `span_ns` holds the times of the first and the last bin, by default those of the first and the last
        event. torch.from_numpy accepts the result.
        """
        grid = np.zeros(bins * self.height * self.width)
        if len(self):
            begin, end = span_ns or (int(self.t[0]), int(self.t[-1]))
            time = (self.t - begin) * ((bins - 1) / max(end - begin, 1))
            low = np.floor(time).astype(np.int64)
            pixel = self.y.astype(np.int64) * self.width + self.x
            polarity = 2.0 * self.p - 1.0
            for bin_, weight in ((low, low + 1 - time), (low + 1, time - low)):
                inside = (bin_ >= 0) & (bin_ < bins)
                grid += np.bincount(
                    bin_[inside] * self.height * self.width + pixel[inside],
                    (polarity * weight)[inside],
                    minlength=grid.size,
                )
        return grid.reshape(bins, self.height, self.width).astype(np.float32)

    def picture(self) -> np.ndarray:
        """Returns a picture for viewing, uint8 [height, width, 3]. Pixels that got brighter are red, pixels
        that got darker are blue, the others are grey. The saturation increases with the number of events up
        to three.
        """
        frame = self.frame()
        strength = np.minimum(np.abs(frame), 3)[..., None] / 3.0
        color = np.where((frame > 0)[..., None], ON, OFF)
        return np.rint(NEUTRAL + (color - np.array(NEUTRAL)) * strength).astype(np.uint8)
