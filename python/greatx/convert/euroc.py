# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a node in the folders of EuRoC MAV (the ASL format), which visual-inertial programs read
(docs/exports.md, "Trajectories").

Data flow: the body is the node's inertial sensor, or the node itself if it has none -> cameras with their
T_BS, the inertial sensor's samples, positions of a GNSS receiver, and the true states of the body.
"""

from __future__ import annotations

import argparse
import os
import pathlib
from typing import Any, Dict, List, Optional, Union

import numpy as np

from ..dataset import Dataset, Sequence
from ..errors import DatasetError
from .common import Command, link_argument, sequence_argument
from .files import stacked
from .folders import Progress, new_folder, place
from .inertial import Imu, NoiseModel, at_times, pick_imu, read_imu, sensors_of
from .motion import Motion, continuous, frame_of, number
from .optics import lens_of
from .poses import Pose, mount, node_of, nodes_of
from .rig import picture_file, sequences_of

#: Standard gravity, m/s^2 (3rd CGPM, 1901).
STANDARD_GRAVITY = 9.80665

_IDENTITY = Pose(np.zeros(3), np.eye(3))


def _matrix(name: str, pose: Pose) -> str:
    values = pose.matrix().ravel()
    rows = [", ".join(number(v) for v in values[i : i + 4]) for i in range(0, 16, 4)]
    return f"{name}:\n  cols: 4\n  rows: 4\n  data: [" + ",\n         ".join(rows) + "]\n"


def _rate(sequence: Sequence, name: str) -> str:
    rate = sequence[name].info.rate_hz
    return number(float(sequence.dataset.tick_rate_hz if rate is None else rate))


def _csv(path: pathlib.Path, header: str, rows: List[List[Any]]) -> None:
    lines = [f"#{header}\n", *(",".join(map(str, row)) + "\n" for row in rows)]
    path.write_text("".join(lines), encoding="utf-8")


def _write_cameras(
    folder: pathlib.Path, sequence: Sequence, cameras: List[str], body: Pose, start_ns: int, link: bool
) -> int:
    """`body`: node from body."""
    written = 0
    for i, name in enumerate(cameras):
        sensor = sequence[name]
        lens = lens_of(sensor, fisheye=True)
        coefficients = lens.coefficients(4)
        target = folder / f"cam{i}"
        (target / "data").mkdir(parents=True)
        _, node_from_camera = frame_of(sequence, name)
        intrinsics = ", ".join(number(v) for v in (lens.fx, lens.fy, lens.cx, lens.cy))
        (target / "sensor.yaml").write_text(
            f"# {name}; pixel centres are at whole numbers\nsensor_type: camera\ncomment: {name}\n\n"
            "# camera's optical frame (x right, y down, z forward) to the body's\n"
            + _matrix("T_BS", body.inverse() @ node_from_camera)
            + f"\nrate_hz: {_rate(sequence, name)}\nresolution: [{lens.width}, {lens.height}]\n"
            f"camera_model: pinhole\nintrinsics: [{intrinsics}] # fu, fv, cu, cv\n"
            f"distortion_model: {'equidistant' if lens.fisheye else 'radial-tangential'}\n"
            f"distortion_coefficients: [{', '.join(number(v) for v in coefficients)}]\n",
            encoding="utf-8",
        )
        rows: List[List[Any]] = []
        for record in sensor:
            time_ns = record.time_ns + start_ns
            place(picture_file(record), target / "data" / f"{time_ns}.png", link)
            rows.append([time_ns, f"{time_ns}.png"])
            written += 1
        _csv(target / "data.csv", "timestamp [ns],filename", rows)
    return written


def _ideal_imu(motion: Motion, node: str, rate_hz: float, gravity: float) -> Imu:
    """Returns an inertial sensor without errors at a node's origin, with a sample at every record of poses:
    the rate R^T w and the specific force R^T (a + g z)."""
    turned = np.swapaxes(motion.rotation, 1, 2)  # body from world
    none = np.zeros_like(motion.position)
    return Imu(
        name=f"{node} (ideal)",
        body_from_sensor=_IDENTITY,
        rate_hz=rate_hz,
        time_ns=motion.time_ns,
        rate=np.einsum("nij,nj->ni", turned, motion["angular_velocity"]),
        force=np.einsum("nij,nj->ni", turned, motion["acceleration"] + [0.0, 0.0, gravity]),
        rate_bias=none,
        force_bias=none,
        gyroscope=NoiseModel(0.0, 0.0),
        accelerometer=NoiseModel(0.0, 0.0),
    )


def _write_imu(folder: pathlib.Path, imu: Imu, comment: str, start_ns: int) -> None:
    folder.mkdir(parents=True)
    _csv(
        folder / "data.csv",
        "timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
        "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]",
        [
            [int(t) + start_ns, *(number(x) for x in (*w, *f))]
            for t, w, f in zip(imu.time_ns, imu.rate, imu.force)
        ],
    )
    (folder / "sensor.yaml").write_text(
        f"# {comment}\nsensor_type: imu\ncomment: {imu.name}\n\n{_matrix('T_BS', _IDENTITY)}\n"
        f"rate_hz: {number(imu.rate_hz)}\n\n"
        f"gyroscope_noise_density: {number(imu.gyroscope.density)}\n"
        f"gyroscope_random_walk: {number(imu.gyroscope.walk)}\n"
        f"accelerometer_noise_density: {number(imu.accelerometer.density)}\n"
        f"accelerometer_random_walk: {number(imu.accelerometer.walk)}\n",
        encoding="utf-8",
    )


def _write_states(folder: pathlib.Path, motion: Motion, imu: Imu, start_ns: int) -> int:
    """Writes the true states of the body, the frame of the inertial sensor. Returns their number."""
    folder.mkdir(parents=True)
    poses = motion.poses(imu.body_from_sensor)
    lever = np.einsum("nij,j->ni", motion.rotation, imu.body_from_sensor.position)
    velocity = motion["velocity"] + np.cross(motion["angular_velocity"], lever)
    gyroscope = at_times(imu.time_ns, imu.rate_bias, motion.time_ns)
    accelerometer = at_times(imu.time_ns, imu.force_bias, motion.time_ns)
    _csv(
        folder / "data.csv",
        "timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
        "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], "
        "b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], "
        "b_a_RS_S_z [m s^-2]",
        [
            [int(t) + start_ns, *(number(x) for x in (*p.position, *q, *v, *w, *a))]
            for t, p, q, v, w, a in zip(
                motion.time_ns,
                poses,
                continuous([p.quaternion for p in poses]),
                velocity,
                gyroscope,
                accelerometer,
            )
        ],
    )
    (folder / "sensor.yaml").write_text(
        f"sensor_type: visual-inertial\ncomment: true state of {imu.name}\n" + _matrix("T_BS", _IDENTITY),
        encoding="utf-8",
    )
    return len(poses)


def _write_positions(folder: pathlib.Path, sequence: Sequence, name: str, body: Pose, start_ns: int) -> int:
    """Writes the fixes of a GNSS receiver like EuRoC's leica0. Returns their number."""
    sensor = sequence[name]
    if len(sensor) == 0:
        return 0
    folder.mkdir(parents=True)
    positions, fixes = stacked(sensor, "position"), stacked(sensor, "fix")[:, 0] > 0
    rows = [
        [int(t) + start_ns, *(number(x) for x in p)]
        for t, p, fix in zip(sensor.index[:, 1], positions, fixes)
        if fix
    ]
    _csv(folder / "data.csv", "timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m]", rows)
    (folder / "sensor.yaml").write_text(
        f"# positions of the antenna in the world; epochs without a fix are left out\n"
        f"sensor_type: position\ncomment: {name}\n\n"
        + _matrix("T_BS", body.inverse() @ mount(sensor.record(0)))
        + f"\nrate_hz: {_rate(sequence, name)}\n",
        encoding="utf-8",
    )
    return len(rows)


def _pick_node(dataset: Dataset, node: Optional[str]) -> str:
    nodes = nodes_of(dataset.sequences[0])
    if node is not None:
        if node not in nodes:
            raise DatasetError(f"{dataset.path}: has no node {node!r}; nodes are {', '.join(nodes)}")
        return node
    cameras = {node_of(n, nodes) for n, info in dataset.sensors.items() if info.kind == "camera"}
    chosen = sorted(cameras) if cameras else nodes
    if len(chosen) == 1:
        return chosen[0]
    raise DatasetError(f"{dataset.path}: {', '.join(chosen) or 'no node'}: say which node (--node)")


def write_euroc(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    node: Optional[str] = None,
    sequence: Optional[int] = None,
    gravity: float = STANDARD_GRAVITY,
    start_ns: int = 0,
    link: bool = False,
    imu: Optional[str] = None,
) -> Dict[str, int]:
    """Writes OUT/sequence_0000/mav0 of a node, by default the only one with cameras: its cameras with their
    pictures, its inertial sensor, the positions of its GNSS receivers, and its true state. `imu` names the
    sensor if there are several. Its frame is then the body's, as in EuRoC. A node without one, or `none`, has
    an ideal inertial sensor at its origin, where gravity is `gravity`. Times are nanoseconds from the
    beginning of the sequence, plus `start_ns`. Returns counts of the written objects. Raises DatasetError, or
    FileExistsError if OUT is not empty.
    """
    node = _pick_node(dataset, node)
    sequences = sequences_of(dataset, sequence)
    nodes = nodes_of(dataset.sequences[0])
    cameras = [
        name
        for name, info in dataset.sensors.items()
        if info.kind == "camera" and node_of(name, nodes) == node and info.locate("rgb") is not None
    ]
    chosen, receivers = pick_imu(dataset, node, imu), sensors_of(dataset, node, "gnss")
    counts = {"sequences": len(sequences), "cameras": len(cameras), "pictures": 0, "states": 0, "samples": 0}
    if receivers:
        counts["positions"] = 0
    progress = Progress(len(sequences), "sequences")
    with new_folder(out) as root:
        for each in sequences:
            folder = root / each.path.name / "mav0"
            motion = Motion(each, node)
            if chosen is None:
                samples = _ideal_imu(motion, node, float(_rate(each, each.poses.name)), gravity)
                comment = (
                    f"true angular velocity and specific force of {node} at its origin: R^T (a + g z), "
                    f"g = {number(gravity)} m/s^2"
                )
            else:
                samples = read_imu(each, chosen)
                comment = f"measured by {chosen}, whose frame is the body's"
            _write_imu(folder / "imu0", samples, comment, start_ns)
            counts["samples"] += len(samples.time_ns)
            counts["states"] += _write_states(
                folder / "state_groundtruth_estimate0", motion, samples, start_ns
            )
            body = samples.body_from_sensor
            counts["pictures"] += _write_cameras(folder, each, cameras, body, start_ns, link)
            for i, name in enumerate(receivers):
                counts["positions"] += _write_positions(folder / f"gnss{i}", each, name, body, start_ns)
            (folder / "body.yaml").write_text(
                f"comment: {samples.name}, x forward, y left, z up\n", encoding="utf-8"
            )
            progress.step()
    progress.end()
    return counts


def _arguments(parser: argparse.ArgumentParser) -> None:
    sequence_argument(parser)
    parser.add_argument("--node", help="node that is the body; needed if several have cameras")
    parser.add_argument(
        "--imu", metavar="NAME", help="inertial sensor of the node, or none for an ideal one at its origin"
    )
    parser.add_argument(
        "--gravity", type=float, default=STANDARD_GRAVITY, help="of an ideal one, m/s^2; default: 9.80665"
    )
    parser.add_argument("--start-ns", type=int, default=0, help="time of tick 0, ns; default: 0")
    link_argument(parser)


COMMAND = Command(
    "euroc",
    "cameras, inertial sensor and true states of a node, EuRoC MAV",
    lambda dataset, given: write_euroc(
        dataset,
        given.OUT,
        given.node,
        given.sequence,
        given.gravity,
        given.start_ns,
        given.link,
        given.imu,
    ),
    _arguments,
)
