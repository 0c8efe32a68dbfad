# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Computes pictures, disparity and optical flow of the rectified views from those of the cameras.

A camera whose own pixels are those of the rectified view needs no resampling: pictures are copied, and
disparity and flow are those of the data set's truth to the step of the format. Otherwise pictures are
interpolated between four pixels, and the truth is that of the nearest pixel of the camera: its own surface
point, seen in the rectified view. That point is up to sqrt(1/2) pixel of the camera away from the ray of the
rectified pixel, so outlines of objects move by as much.
"""

from __future__ import annotations

from typing import Tuple

import numpy as np

from .rig import View

#: Steps of DSEC's 16-bit pictures, pixels.
DISPARITY_STEP, FLOW_STEP = 1 / 256, 1 / 128


def _nearest(view: View) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns the row and column of the camera's pixel nearest to each rectified pixel, and whether it is
    within the picture."""
    places = view.unrectify(view.grid())
    inside = np.all(np.isfinite(places), -1)
    whole = np.rint(np.where(inside[..., None], places, 0)).astype(int)
    columns, rows = whole[..., 0], whole[..., 1]
    inside &= (columns >= 0) & (columns < view.lens.width) & (rows >= 0) & (rows < view.lens.height)
    return np.where(inside, rows, 0), np.where(inside, columns, 0), inside


def rectified_picture(view: View, picture: np.ndarray) -> np.ndarray:
    """Returns uint8 [h, w, 3] of the rectified view by bilinear interpolation; black outside the picture."""
    places = view.unrectify(view.grid())
    height, width = picture.shape[:2]
    size = np.array([width - 1, height - 1], float)
    inside = np.all(np.isfinite(places) & (places >= 0) & (places <= size), -1)
    places = np.where(inside[..., None], places, 0)
    low = np.minimum(np.floor(places), np.maximum(size - 1, 0)).astype(int)
    part = places - low
    out = np.zeros(picture.shape, float)
    for dx in (0, 1):
        for dy in (0, 1):
            weight = np.abs(1 - dx - part[..., 0]) * np.abs(1 - dy - part[..., 1])
            column, row = np.minimum(low[..., 0] + dx, width - 1), np.minimum(low[..., 1] + dy, height - 1)
            out += weight[..., None] * picture[row, column]
    return np.where(inside[..., None], np.rint(out), 0).astype(np.uint8)


def disparity(view: View, depth: np.ndarray) -> np.ndarray:
    """Returns uint16 [h, w], 256 x disparity in pixels of the rectified left view from planar depth in m; 0
    where there is no surface, or where the disparity does not fit."""
    if view.is_rectified:
        z = depth.astype(float)
    else:
        rows, columns, inside = _nearest(view)
        points = view.lens.undistort(view.lens.normalised(np.stack([columns, rows], -1)))
        rays = np.concatenate([points, np.ones((*points.shape[:-1], 1))], -1) @ view.rectified_from_camera.T
        z = np.where(inside, depth[rows, columns].astype(float) * rays[..., 2], np.inf)
    with np.errstate(divide="ignore"):
        steps = np.rint(view.focal[0] * view.baseline / z / DISPARITY_STEP)
    return np.where(np.isfinite(z) & (z > 0) & (steps <= 0xFFFF), steps, 0).astype(np.uint16)


def optical_flow(view: View, flow: np.ndarray) -> np.ndarray:
    """Returns uint16 [h, w, 3] of the rectified view: 128 u + 2^15, 128 v + 2^15, and 1 where it is valid."""
    if view.is_rectified:
        moved, inside = flow.astype(float), np.ones(flow.shape[:2], bool)
    else:
        rows, columns, inside = _nearest(view)
        start = np.stack([columns, rows], -1).astype(float)
        there = flow[rows, columns].astype(float)
        known = inside & np.all(np.isfinite(there), -1)
        moved = np.full(flow.shape, np.nan)
        moved[known] = view.rectify(start[known] + there[known]) - view.rectify(start[known])
        inside = known
    steps = np.rint(moved / FLOW_STEP) + 2**15
    valid = inside & np.all(np.isfinite(moved), -1) & np.all((steps >= 0) & (steps <= 0xFFFF), -1)
    out = np.zeros((*flow.shape[:2], 3), np.uint16)
    out[valid, :2] = steps[valid]
    out[valid, 2] = 1
    return out
