# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes range images of the points of a LiDAR (docs/lidar.md)."""
from __future__ import annotations

import math
from typing import Any, Mapping, Optional, Tuple

import numpy as np

from .errors import Error
from .sizes import Size, result, sides_of


def _of(metadata: Mapping[str, Any], key: str) -> Any:
    if key not in metadata:
        raise Error(f"metadata: expected {key!r} of a LiDAR, found {', '.join(sorted(metadata))}")
    return metadata[key]


def _widened(ends_deg: Any, shots: int) -> Tuple[float, float]:
    """Returns the ends of the cells of evenly spaced shots, of which the first and the last are given."""
    low, high = sorted(float(end) for end in ends_deg)
    half = (high - low) / (shots - 1) / 2 if shots > 1 else 0.0
    return low - half, high + half


def _azimuths(metadata: Mapping[str, Any]) -> Tuple[float, float]:
    """Returns the left end of the map and its width, degrees. Shots lie in the middle of cells, so that
    rounding moves none to the next one.
    """
    if "azimuth_steps" in metadata:
        start, span = (float(_of(metadata, f"azimuth_{key}_deg")) for key in ("start", "span"))
        step = abs(span) / int(metadata["azimuth_steps"])
        if abs(span) >= 360.0:
            return start + (math.floor((180.0 - start) / step) + 0.5) * step, 360.0
        return (start + span - step / 2 if span > 0 else start + step / 2), abs(span)
    if "azimuth_deg" in metadata:
        low, high = _widened(metadata["azimuth_deg"], int(metadata.get("columns", 1)))
        return high, high - low
    if "deflection_deg" in metadata:
        reach = sum(float(d) for d in metadata["deflection_deg"])
        return reach, 2 * reach
    return 180.0, 360.0


def _columns(azimuth_deg: np.ndarray, metadata: Mapping[str, Any], columns: int) -> np.ndarray:
    left, width = _azimuths(metadata)
    beside = (360.0 - width) / 2  # what is not on the map lies half to the left of it, half to the right
    offset = (left - azimuth_deg + beside) % 360.0 - beside
    return np.floor(offset * (columns / width)).astype(np.int64)


def _rows(elevation_deg: np.ndarray, metadata: Mapping[str, Any], rows: int) -> np.ndarray:
    if "elevations_deg" in metadata:
        channels = np.sort(np.asarray(metadata["elevations_deg"], np.float64))
        if rows > len(channels):
            raise Error(f"size: expected at most {len(channels)} rows, one for each channel, found {rows}")
        ring = np.searchsorted((channels[1:] + channels[:-1]) / 2, elevation_deg)
        return rows - 1 - ring * rows // len(channels)
    if "deflection_deg" in metadata:
        high = sum(float(d) for d in metadata["deflection_deg"])
        low = -high
    else:
        low, high = _widened(_of(metadata, "elevation_deg"), int(metadata.get("rows", 1)))
    return np.floor((high - elevation_deg) * (rows / (high - low))).astype(np.int64)


def lidar_map(
    points: Any, metadata: Mapping[str, Any], size: Size = (64, 256), out: Optional[np.ndarray] = None
) -> np.ndarray:
    """Returns a LiDAR's range image, float32 [2, rows, columns]: range / max_range_m, cut off at 1, and
    intensity (docs/lidar.md; 0 to 1 but for glare). A cell without a return is 0 in both. Of several returns
    in a cell the nearest is there.

    points    float32 [n, 4] of a record: x, y, z in m in the sensor's frame, intensity
    metadata  of the sensor. To that of a table of shots add elevation_deg, [lowest, highest], and, unless the
              map covers all directions, azimuth_deg, [right, left]

    Rows go from the highest to the lowest elevation: of a spinning LiDAR by the nearest channel (rows may be
    fewer than channels), otherwise evenly. Columns go evenly from the left (+y) to the right. The middle of a
    map of all directions is straight ahead.
    """
    cloud = np.asarray(points)
    if cloud.ndim != 2 or cloud.shape[1] != 4:
        raise Error(f"points: expected [n, 4], found {list(cloud.shape)}")
    rows, columns = sides_of(size)
    out = result(out, (2, rows, columns), np.float32)
    x, y, z = (cloud[:, i] for i in range(3))
    plane = np.hypot(x, y)
    distance = np.hypot(plane, z)
    row = _rows(np.degrees(np.arctan2(z, plane)), metadata, rows)
    column = _columns(np.degrees(np.arctan2(y, x)), metadata, columns)
    inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
    cell, distance, intensity = (row * columns + column)[inside], distance[inside], cloud[inside, 3]
    farthest_first = np.argsort(-distance, kind="stable")  # the last one written to a cell stays
    cell = cell[farthest_first]
    flat = out.reshape(2, -1)
    flat[...] = 0
    flat[0][cell] = np.minimum(distance[farthest_first] / float(_of(metadata, "max_range_m")), 1)
    flat[1][cell] = intensity[farthest_first]
    return out
