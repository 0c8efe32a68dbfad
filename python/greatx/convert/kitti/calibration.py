# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the calibration files of KITTI's layouts from one Calibration.

The raw recordings keep three files for a day; the benchmarks keep one file for a sequence or a picture, in
which the names of the entries differ (readme.txt of each development kit).
"""

from __future__ import annotations

import numpy as np

from ..poses import Pose
from .source import Calibration, numbers

#: The date in calib_time, which no reader evaluates.
CALIBRATED = "01-Jan-2000 00:00:00"


def rows(pose: Pose) -> np.ndarray:
    """Returns the upper three rows [3, 4] of a homogeneous matrix."""
    return pose.matrix()[:3]


def cam_to_cam(calibration: Calibration) -> str:
    """Returns calib_cam_to_cam.txt of the raw recordings."""
    size = f"{calibration.left.width:.12e} {calibration.left.height:.12e}"
    lines = [f"calib_time: {CALIBRATED}", "corner_dist: 0.000000e+00"]
    for camera in range(4):
        projection = calibration.projection(camera)
        translation = np.array([projection[0, 3] / projection[0, 0], 0.0, 0.0])
        lines += [
            f"S_{camera:02d}: {size}",
            f"K_{camera:02d}: {numbers(projection[:, :3])}",
            f"D_{camera:02d}: {numbers(np.zeros(5))}",
            f"R_{camera:02d}: {numbers(np.eye(3))}",
            f"T_{camera:02d}: {numbers(translation)}",
            f"S_rect_{camera:02d}: {size}",
            f"R_rect_{camera:02d}: {numbers(np.eye(3))}",
            f"P_rect_{camera:02d}: {numbers(projection)}",
        ]
    return "\n".join(lines) + "\n"


def _rigid(pose: Pose) -> str:
    return f"calib_time: {CALIBRATED}\nR: {numbers(pose.rotation)}\nT: {numbers(pose.position)}\n"


def velo_to_cam(calibration: Calibration) -> str:
    """Returns calib_velo_to_cam.txt of the raw recordings."""
    zeros = numbers(np.zeros(2))
    return _rigid(calibration.camera_from_lidar) + f"delta_f: {zeros}\ndelta_c: {zeros}\n"


def imu_to_velo(calibration: Calibration) -> str:
    """Returns calib_imu_to_velo.txt of the raw recordings. The IMU's frame is that of the body."""
    return _rigid(calibration.lidar_from_body)


def _projections(calibration: Calibration) -> str:
    return "".join(f"P{camera}: {numbers(calibration.projection(camera))}\n" for camera in range(4))


def odometry(calibration: Calibration) -> str:
    """Returns calib.txt of the odometry benchmark."""
    return _projections(calibration) + f"Tr: {numbers(rows(calibration.camera_from_lidar))}\n"


def object_(calibration: Calibration) -> str:
    """Returns a calibration file of the object benchmark."""
    return (
        _projections(calibration)
        + f"R0_rect: {numbers(np.eye(3))}\n"
        + f"Tr_velo_to_cam: {numbers(rows(calibration.camera_from_lidar))}\n"
        + f"Tr_imu_to_velo: {numbers(rows(calibration.lidar_from_body))}\n"
    )


def tracking(calibration: Calibration) -> str:
    """Returns a calibration file of the tracking benchmark, whose last three names have no colon."""
    return (
        _projections(calibration)
        + f"R_rect {numbers(np.eye(3))}\n"
        + f"Tr_velo_cam {numbers(rows(calibration.camera_from_lidar))}\n"
        + f"Tr_imu_velo {numbers(rows(calibration.lidar_from_body))}\n"
    )
