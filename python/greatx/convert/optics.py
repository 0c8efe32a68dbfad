# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Describes the lens of a camera or an event camera as OpenCV does, and maps its pixels.

A pixel's centre is at whole numbers here, as in OpenCV, and at +0.5 in greatx (docs/camera.md). The model is
that of Brown and Conrady with OpenCV's order of coefficients (docs/film.md):

    x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
    y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y

`distort` computes it as it stands. `undistort` solves it by Newton's method with the analytic Jacobian, to
1e-13 in normalised coordinates (below 1e-9 pixels); the engine has tested that the model does not fold within
the picture.
"""

from __future__ import annotations

import dataclasses
from typing import Dict, List

import numpy as np

from ..dataset import Sensor
from ..errors import DatasetError
from ..files import Field

COEFFICIENTS = ("k1", "k2", "p1", "p2", "k3")
#: Of a fisheye (Kannala and Brandt, as OpenCV's fisheye).
FISHEYE_COEFFICIENTS = ("k1", "k2", "k3", "k4")


@dataclasses.dataclass(frozen=True)
class Lens:
    """Holds a camera's intrinsics, with the centre of the first pixel at 0, 0."""

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int
    distortion: Dict[str, float]  #: k1, k2, p1, p2, k3; all 0 for a pinhole camera; of a fisheye k1 to k4
    where: str = dataclasses.field(default="", compare=False)  #: the camera, in messages
    fisheye: bool = False  #: whether `distortion` is that of a fisheye; distort() and undistort() know none

    @property
    def distorts(self) -> bool:
        return any(self.distortion.values())

    def matrix(self) -> np.ndarray:
        """Returns the intrinsic matrix [3, 3]."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    def coefficients(self, most: int = 5) -> List[float]:
        """Returns k1, k2, p1, p2 and, if `most` is 5, k3; of a fisheye k1 to k4. Raises DatasetError if k3
        has no place and is not 0.
        """
        if self.fisheye:
            return [self.distortion[name] for name in FISHEYE_COEFFICIENTS]
        values = [self.distortion[name] for name in COEFFICIENTS]
        if any(values[most:]):
            raise DatasetError(
                f"{self.where}: expected k3 = 0, for which this format has no place, found {values[4]}"
            )
        return values[:most]

    def normalised(self, pixels: np.ndarray) -> np.ndarray:
        """Returns (u - cx) / fx, (v - cy) / fy of pixels [..., 2]."""
        return (np.asarray(pixels, float) - [self.cx, self.cy]) / [self.fx, self.fy]

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Returns the pixels [..., 2] of normalised coordinates."""
        return np.asarray(points, float) * [self.fx, self.fy] + [self.cx, self.cy]

    def distort(self, points: np.ndarray) -> np.ndarray:
        """Returns where the lens shows undistorted normalised coordinates [..., 2]."""
        k1, k2, p1, p2, k3 = (self.distortion[name] for name in COEFFICIENTS)
        x, y = np.moveaxis(np.asarray(points, float), -1, 0)
        r2 = x * x + y * y
        radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        return np.stack(
            [
                x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
            ],
            -1,
        )

    def _jacobian(self, points: np.ndarray) -> np.ndarray:
        """Returns the derivatives of distort(), [..., 2, 2]."""
        k1, k2, p1, p2, k3 = (self.distortion[name] for name in COEFFICIENTS)
        x, y = np.moveaxis(points, -1, 0)
        r2 = x * x + y * y
        radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3))  # d radial / d x is slope x
        mixed = slope * x * y + 2 * p1 * x + 2 * p2 * y
        rows = [
            [radial + slope * x * x + 2 * p1 * y + 6 * p2 * x, mixed],
            [mixed, radial + slope * y * y + 6 * p1 * y + 2 * p2 * x],
        ]
        return np.stack([np.stack(row, -1) for row in rows], -2)

    def undistort(self, shown: np.ndarray) -> np.ndarray:
        """Returns the undistorted coordinates [..., 2] of what the lens shows at normalised coordinates.
        Raises DatasetError if the iteration does not end, as beyond the fold of a lens."""
        shown = np.asarray(shown, float)
        if not self.distorts:
            return shown.copy()
        points = shown.copy()
        for _ in range(100):
            error = self.distort(points) - shown
            worst = np.max(np.abs(error), initial=0.0)
            if not np.isfinite(worst):
                break
            step = np.linalg.solve(self._jacobian(points), error[..., None])[..., 0]
            length = np.linalg.norm(step, axis=-1, keepdims=True)
            reach = 0.3 * np.maximum(1.0, np.linalg.norm(points, axis=-1, keepdims=True))
            points = points - step * np.minimum(1.0, reach / np.maximum(length, 1e-300))
            if worst < 1e-13 * (1.0 + np.max(np.abs(shown), initial=0.0)):
                return points
        raise DatasetError(f"{self.where}: expected a distortion with an inverse within the picture")


def lens_model(sensor: Sensor) -> str:
    """Returns `pinhole` (with or without distortion), `fisheye` or `equirectangular`."""
    field = Field(sensor.metadata.where, sensor.metadata)
    return field["lens"]["model"].text() if "lens" in field else "pinhole"


def lens_of(sensor: Sensor, fisheye: bool = False) -> Lens:
    """Returns the lens of a camera or an event camera. `fisheye` says whether it may be one. Raises
    DatasetError if its description lacks it, or if it is a lens that the caller does not know.
    """
    field = Field(sensor.metadata.where, sensor.metadata)
    model = lens_model(sensor)
    if model not in (("pinhole", "fisheye") if fisheye else ("pinhole",)):
        raise DatasetError(
            f"{sensor.sequence.dataset.path}: {sensor.name}: expected a pinhole camera"
            f"{' or a fisheye' if fisheye else ''}, for this format describes no other, found {model!r}"
        )
    numbers = [field[key].number(-1e9, 1e9) for key in ("fx", "fy", "cx", "cy")]
    centre = field["pixel_center"].number(0.0, 0.5)
    distortion = {name: 0.0 for name in COEFFICIENTS}
    if "distortion" in field:
        distortion = {name: field["distortion"][name].number(-1e6, 1e6) for name in COEFFICIENTS}
    if model == "fisheye":
        distortion = {name: field["lens"][name].number(-1e6, 1e6) for name in FISHEYE_COEFFICIENTS}
    if not (numbers[0] > 0 and numbers[1] > 0):
        raise DatasetError(f"{sensor.metadata.where}: expected fx and fy above 0, found {numbers[:2]}")
    return Lens(
        numbers[0],
        numbers[1],
        numbers[2] - centre,
        numbers[3] - centre,
        field["width"].integer(1, 1 << 20),
        field["height"].integer(1, 1 << 20),
        distortion,
        str(sensor.metadata.where),
        model == "fisheye",
    )
