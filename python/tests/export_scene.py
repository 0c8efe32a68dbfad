# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the data sets on which the exporters are tested, and compares points with a camera's truth.

The scene is asymmetric, so that a wrong sign of any axis shows: the carrier `ego` turns and has a yaw, a
pitch and a roll, its sensors are mounted askew, and a car drives ahead of it, to the left and above. `level`
has a yaw alone, and its camera looks along the horizon.
"""

import pathlib
import tempfile

import numpy as np

import greatx
import support

#: Extent of the generated car along its own x, y, z: length, width, height (m).
CAR_M = (4.06, 1.95, 1.46)

SCENE = """
greatx: 1
name: export
ticks: 5
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 9, size_m: 80}}
environment: {clouds: 0}
nodes:
  - name: ego
    trajectory:
      type: waypoints
      points: [{t_s: 0, position_m: [2.4, -30, 1], rotation_deg: [82, 5, -7]}, \
{t_s: 1, position_m: [2.2, -20, 1.5], rotation_deg: [95, -3, 8]}]
    sensors:
      - {name: front, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 80, \
outputs: [rgb, depth, ids, boxes], mount: {position_m: [1.5, 0.2, 0.8], rotation_deg: [3, 2, 1]}}
      - {name: side, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 80, \
outputs: [rgb, depth, ids, boxes], mount: {position_m: [1.0, 0.6, 0.8], rotation_deg: [50, -4, 2]}}
      - {name: lidar, type: lidar, rate_hz: 5, channels: 16, elevation_min_deg: -25, elevation_max_deg: 15, \
azimuth_steps: 256, max_range_m: 80, mount: {position_m: [0, 0.1, 2], rotation_deg: [30, -2, 3]}}
      - {name: spin, type: lidar, rate_hz: 5, sweep_s: 0.1, channels: 16, elevation_min_deg: -25, \
elevation_max_deg: 15, azimuth_steps: 256, max_range_m: 80, \
mount: {position_m: [0, 0.1, 2], rotation_deg: [30, -2, 3]}}
      - name: radar
        type: radar
        rate_hz: 10
        mount: {position_m: [1.6, 0.3, 0.5], rotation_deg: [-4, 0, 0]}
        waveform: {carrier_hz: 77e9, bandwidth_hz: 300e6, samples: 128, sample_rate_hz: 12.5e6, \
adc_start_s: 1.5e-6, chirp_s: 13e-6, interval_s: 14e-6, chirps: 32}
        receive: {pattern: tr38901, columns: 4}
        power_dbm: 20
  - name: level
    trajectory: {type: static, position_m: [-2, -26, 1.6], rotation_deg: [75, 0, 0]}
    sensors:
      - {name: left, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, \
outputs: [rgb, depth, ids, boxes]}
      - {name: right, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, outputs: [rgb], \
mount: {position_m: [0, -0.5, 0]}}
      - {name: lidar, type: lidar, rate_hz: 10, channels: 8, elevation_min_deg: -20, elevation_max_deg: 20, \
azimuth_steps: 360, max_range_m: 60, mount: {position_m: [-0.4, 0.1, 0.3]}}
  - name: car
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [0, -18, 3]}, \
{t_s: 1, position_m: [0.5, -9, 3]}]}
    model: {generate: {kind: car}}
    class: vehicle
"""

#: One camera without boxes, compressed; nothing else.
PLAIN = """
greatx: 1
name: plain
ticks: 2
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 9, size_m: 80}, optical_only: true}
environment: {clouds: 0}
nodes:
  - name: pole
    trajectory: {type: static, position_m: [-2, -26, 1.6], rotation_deg: [75, 0, 0]}
    sensors:
      - {name: eye, type: camera, rate_hz: 10, width: 32, height: 24, fov_deg: 90}
      - {name: bent, type: camera, rate_hz: 10, width: 32, height: 24, fov_deg: 90, distortion: {k1: 0.1}}
"""


def scene(compression: str = "none") -> pathlib.Path:
    """Returns the folder of a data set of SCENE, which tests must not change."""
    return support.made(f"export_{compression}", SCENE, "--compression", compression)


def plain() -> pathlib.Path:
    """Returns the folder of a data set of PLAIN, which has two sequences."""
    return support.made("export_plain", PLAIN, "--compression", "fast", "--sequences", "2")


def out_folder() -> pathlib.Path:
    """Returns a path in a new folder, at which nothing is yet."""
    return pathlib.Path(tempfile.mkdtemp(dir=support._folder())) / "out"


def car_id(dataset: greatx.Dataset) -> int:
    """Returns the instance id of the car."""
    return 1 + [entry["name"] for entry in dataset.instances].index("car/car")


def agreement(points: np.ndarray, projection: np.ndarray, depth: np.ndarray) -> float:
    """Returns the share of points, of those in the picture, whose distance along the optical axis lies
    between the least and the largest depth of their pixel and its eight neighbours, to 0.5 %.

    `points` [n, 3] are in the camera's optical frame, and `projection` [3, 3 or 4] has the centre of the
    first pixel at 0, 0.
    """
    points = points[points[:, 2] > 0.5]
    homogeneous = np.hstack([points, np.ones((len(points), 1))])[:, : projection.shape[1]] @ projection.T
    uv = np.rint(homogeneous[:, :2] / homogeneous[:, 2:]).astype(int)
    height, width = depth.shape
    inside = (uv[:, 0] >= 1) & (uv[:, 0] < width - 1) & (uv[:, 1] >= 1) & (uv[:, 1] < height - 1)
    uv, z = uv[inside], points[inside, 2]
    if len(z) < 20:
        raise AssertionError(f"only {len(z)} points are in the picture")
    near = np.stack([depth[uv[:, 1] + dv, uv[:, 0] + du] for du in (-1, 0, 1) for dv in (-1, 0, 1)])
    good = (z > 0.995 * near.min(axis=0)) & (z < 1.005 * near.max(axis=0))
    return float(good.mean())


def within(points: np.ndarray, centre: np.ndarray, rotation: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Returns how far points [n, 3] lie outside of a box, m (0 inside)."""
    local = np.abs((points - centre) @ rotation) - np.asarray(size) / 2
    return np.maximum(local, 0).max(axis=1)
