# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Chooses the up to four cameras of a DSEC rig and computes their rectified views.

DSEC has event cameras on the left (cam0) and right (cam3), and frame cameras beside them (cam1, cam2). Events
and pictures of each pair are rectified: seen by two pinhole cameras of equal intrinsics and axes, whose
baseline is along x. Data flow: names -> View (lens, mount) -> pair() -> Rectified views.

**Rectification.** The rectified x axis is the direction from the left camera to the right one, the z axis is
the mean of both optical axes made perpendicular to it, and y = z x x (Fusiello, Trucco, Verri, "A compact
algorithm for rectification of stereo pairs", 2000, with the mean axis in place of the old left one). The
intrinsics are those of the left camera, so disparity is 0 at infinity. A camera without a partner keeps its
axes and its intrinsics, and is only undistorted.
"""

from __future__ import annotations

import dataclasses
from typing import Dict, List, Optional, Tuple

import numpy as np

from ...dataset import Dataset, Sequence
from ...errors import DatasetError
from ..optics import Lens, lens_of
from ..poses import OPTICAL_FROM_BODY, Pose, mount, node_of, nodes_of

#: Rotations nearer to the identity than this are the identity.
SAME = 1e-12


@dataclasses.dataclass(frozen=True)
class View:
    """A camera and its rectified view."""

    name: str  #: of the sensor
    lens: Lens
    body_from_camera: Pose  #: optical axes
    rectified_from_camera: np.ndarray  #: rotation [3, 3]
    focal: Tuple[float, float]  #: fx, fy of the rectified view, pixels
    centre: Tuple[float, float]  #: cx, cy of the rectified view; pixel centres are at whole numbers
    baseline: float  #: m to the partner; 0: none

    @property
    def is_rectified(self) -> bool:
        """Whether the camera's own pixels are those of the rectified view."""
        own = (self.lens.fx, self.lens.fy), (self.lens.cx, self.lens.cy)
        return (
            not self.lens.distorts
            and own == (self.focal, self.centre)
            and bool(np.array_equal(self.rectified_from_camera, np.eye(3)))
        )

    def rectify(self, pixels: np.ndarray) -> np.ndarray:
        """Returns where pixels [..., 2] of the camera are in the rectified view; NaN behind it."""
        points = self.lens.undistort(self.lens.normalised(pixels))
        rays = np.concatenate([points, np.ones((*points.shape[:-1], 1))], -1) @ self.rectified_from_camera.T
        depth = np.where(rays[..., 2:] > 0, rays[..., 2:], np.nan)
        return rays[..., :2] / depth * self.focal + self.centre

    def unrectify(self, pixels: np.ndarray) -> np.ndarray:
        """Returns where pixels [..., 2] of the rectified view are in the camera's picture; NaN behind it. It
        is the closed form of the lens."""
        points = (np.asarray(pixels, float) - self.centre) / self.focal
        rays = np.concatenate([points, np.ones((*points.shape[:-1], 1))], -1) @ self.rectified_from_camera
        depth = np.where(rays[..., 2:] > 0, rays[..., 2:], np.nan)
        return self.lens.pixels(self.lens.distort(rays[..., :2] / depth))

    def grid(self) -> np.ndarray:
        """Returns the pixels [h, w, 2] (column, row)."""
        rows, columns = np.mgrid[0 : self.lens.height, 0 : self.lens.width]
        return np.stack([columns, rows], -1).astype(float)

    def matrix(self) -> np.ndarray:
        return np.array([[self.focal[0], 0, self.centre[0]], [0, self.focal[1], self.centre[1]], [0, 0, 1.0]])


def _view(sequence: Sequence, name: str) -> Tuple[Lens, Pose]:
    sensor = sequence[name]
    if len(sensor) == 0:
        raise DatasetError(f"{sequence.path}: {name}: expected records, found none")
    return lens_of(sensor), mount(sensor.record(0)) @ Pose(np.zeros(3), OPTICAL_FROM_BODY.T)


def pair(sequence: Sequence, left: str, right: Optional[str]) -> List[View]:
    """Returns the rectified view of a camera, or of two cameras. Raises DatasetError if the right one is not
    to the right of the left one, or if their pictures have different sizes."""
    lens, pose = _view(sequence, left)
    focal, centre = (lens.fx, lens.fy), (lens.cx, lens.cy)
    if right is None:
        return [View(left, lens, pose, np.eye(3), focal, centre, 0.0)]
    other_lens, other = _view(sequence, right)
    where = f"{sequence.dataset.path}: {left} and {right}"
    if (lens.width, lens.height) != (other_lens.width, other_lens.height):
        raise DatasetError(
            f"{where}: expected pictures of one size, found {lens.width} x {lens.height} and "
            f"{other_lens.width} x {other_lens.height}"
        )
    way = other.position - pose.position
    baseline = float(np.linalg.norm(way))
    forward = pose.rotation[:, 2] + other.rotation[:, 2]
    if baseline == 0 or pose.rotation[:, 0] @ way < 0.5 * baseline or np.linalg.norm(forward) < 1.0:
        raise DatasetError(
            f"{where}: expected the second camera to the right of the first one, looking the same way; found "
            f"it at {np.round(pose.inverse().apply(other.position), 6).tolist()} m in optical axes (x right, "
            "y down, z forward)"
        )
    x = way / baseline
    z = forward - (forward @ x) * x
    z /= np.linalg.norm(z)
    axes = np.stack([x, np.cross(z, x), z])  # rectified from body
    views = []
    for name, own_lens, own in ((left, lens, pose), (right, other_lens, other)):
        turn = axes @ own.rotation
        if np.max(np.abs(turn - np.eye(3))) < SAME:
            turn = np.eye(3)
        views.append(View(name, own_lens, own, turn, focal, centre, baseline))
    return views


@dataclasses.dataclass(frozen=True)
class Names:
    """Names the sensors of a rig; None: there is none."""

    events_left: str
    events_right: Optional[str]
    images_left: Optional[str]
    images_right: Optional[str]


def pick_names(
    dataset: Dataset,
    events_left: Optional[str],
    events_right: Optional[str],
    images_left: Optional[str],
    images_right: Optional[str],
) -> Names:
    """Checks the names. The left event camera is the only one by default, and the left frame camera that
    which shares its pixels. Raises DatasetError for a name that is none of the node's sensors of its kind."""
    found = {
        kind: [n for n, s in dataset.sensors.items() if s.kind == kind] for kind in ("event_camera", "camera")
    }
    events = [n for n in found["event_camera"] if "t" in dataset.sensors[n].arrays]
    if events_left is None:
        if len(events) != 1:
            raise DatasetError(
                f"{dataset.path}: expected one event camera with events, or its name (--events-left), found "
                f"{', '.join(events) or 'none'}"
            )
        events_left = events[0]
    shared = dataset.sensors[events_left].metadata.get("camera") if events_left in dataset.sensors else None
    if images_left is None and isinstance(shared, str) and shared in found["camera"]:
        images_left = shared if "rgb" in dataset.sensors[shared].arrays else None
    if images_right is not None and images_left is None:
        raise DatasetError(f"{dataset.path}: expected a left camera (--images-left) beside the right one")
    names = Names(events_left, events_right, images_left, images_right)
    nodes = nodes_of(dataset.sequences[0])
    for name, known, what in (
        (events_left, events, "an event camera with events"),
        (events_right, events, "an event camera with events"),
        (images_left, found["camera"], "a camera"),
        (images_right, found["camera"], "a camera"),
    ):
        if name is None:
            continue
        if name not in known:
            raise DatasetError(
                f"{dataset.path}: expected {what}, found {name!r}; there are {', '.join(known)}"
            )
        if node_of(name, nodes) != node_of(events_left, nodes):
            raise DatasetError(f"{dataset.path}: {name} and {events_left}: expected sensors of one node")
    return names


def views_of(sequence: Sequence, names: Names) -> Dict[int, View]:
    """Returns the views by DSEC's numbers: 0 and 3 of events, 1 and 2 of pictures."""
    views: Dict[int, View] = {}
    views.update(zip((0, 3), pair(sequence, names.events_left, names.events_right)))
    if names.images_left is not None:
        views.update(zip((1, 2), pair(sequence, names.images_left, names.images_right)))
    return dict(sorted(views.items()))


def _rows(matrix: np.ndarray) -> str:
    return "[" + ", ".join("[" + ", ".join(repr(float(v)) for v in row) + "]" for row in matrix) + "]"


def _list(values: object) -> str:
    return "[" + ", ".join(repr(v) for v in values) + "]"  # type: ignore[attr-defined]


def calibration(views: Dict[int, View]) -> str:
    """Returns the text of cam_to_cam.yaml."""
    lines = ["intrinsics:"]
    for i, view in views.items():
        lens = view.lens
        size = [lens.width, lens.height]
        coefficients = lens.coefficients(5)
        lines += [
            f"  cam{i}:  # {view.name}",
            f"    camera_matrix: {_list([lens.fx, lens.fy, lens.cx, lens.cy])}",
            f"    distortion_coeffs: {_list(coefficients if coefficients[4] else coefficients[:4])}",
            "    distortion_model: radtan",
            "    camera_model: pinhole",
            f"    resolution: {size}",
            f"  camRect{i}:",
            f"    camera_matrix: {_list([*view.focal, *view.centre])}",
            "    camera_model: pinhole",
            f"    resolution: {size}",
        ]
    lines.append("extrinsics:")
    numbers = list(views)
    for before, after in zip(numbers, numbers[1:]):
        turn = views[after].body_from_camera.inverse() @ views[before].body_from_camera
        lines.append(f"  T_{after}{before}: {_rows(turn.matrix())}")
    lines += [f"  R_rect{i}: {_rows(view.rectified_from_camera)}" for i, view in views.items()]
    pairs = [(a, b) for a, b in ((0, 3), (1, 2)) if a in views and b in views]
    if pairs:
        lines.append("disparity_to_depth:")
    for a, b in pairs:
        view = views[a]
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[1, 1] = 1.0, view.focal[0] / view.focal[1]
        matrix[0, 3], matrix[1, 3] = -view.centre[0], -view.centre[1] * view.focal[0] / view.focal[1]
        matrix[2, 3], matrix[3, 2] = view.focal[0], 1.0 / view.baseline
        lines.append(f"  cams_{a}{b}: {_rows(matrix)}")
    return "\n".join(lines) + "\n"
