# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes trajectories in the formats of TUM RGB-D and EuRoC, which evo and most SLAM programs read
(docs/exports.md, "Trajectories").

Data flow: the poses of a node at every record, turned by the mount of a sensor if one is asked for -> TUM's
lines; or, with the node's velocity, acceleration and rate of turn -> EuRoC's true states and inertial sensor.
Times are whole nanoseconds of the data set's index. Numbers have 17 digits, so that no bit is lost.
"""

from __future__ import annotations

import argparse
import os
import pathlib
from typing import Any, Dict, List, Optional, Sequence as SequenceOf, Tuple, Union

import numpy as np

from ..dataset import Dataset, Sequence
from ..errors import DatasetError
from ..files import interpreting
from ..links import rotation
from .common import Command, link_argument, sequence_argument
from .files import stacked
from .folders import Progress, new_folder, place
from .optics import lens_of
from .poses import OPTICAL_FROM_BODY, Pose, mount, node_of, nodes_of
from .rig import picture_file, sequences_of

#: Standard gravity, m/s^2 (3rd CGPM, 1901).
STANDARD_GRAVITY = 9.80665


class _Motion:
    """Holds the motion of one node over a sequence."""

    def __init__(self, sequence: Sequence, node: str):
        nodes = nodes_of(sequence)
        if node not in nodes:
            raise DatasetError(f"{sequence.dataset.path}: has no node {node!r}; nodes are {', '.join(nodes)}")
        number, poses = nodes.index(node), sequence.poses
        with interpreting(sequence.path / poses.name):
            self.time_ns = poses.index[:, 1]
            self.position = stacked(poses, "position")[:, number]
            self.rotation = rotation(stacked(poses, "orientation")[:, number])
            self._arrays = {
                name: stacked(poses, name)[:, number]
                for name in ("velocity", "acceleration", "angular_velocity")
                if name in poses
            }
        self._where = f"{sequence.dataset.path}: {poses.name}"

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._arrays:
            raise DatasetError(f"{self._where}: expected an array {name!r}, found none")
        return self._arrays[name]

    def poses(self, node_from_frame: Pose) -> List[Pose]:
        """Returns world from a frame at the node, at every record."""
        return [Pose(p, r) @ node_from_frame for p, r in zip(self.position, self.rotation)]


def continuous(quaternions: SequenceOf[np.ndarray]) -> List[np.ndarray]:
    """Returns the same rotations with the signs that make neighbours similar."""
    out: List[np.ndarray] = []
    for q in quaternions:
        out.append(-q if out and float(q @ out[-1]) < 0 else q)
    return out


def frame_of(sequence: Sequence, name: str) -> Tuple[str, Pose]:
    """Returns the node, and node from frame, of a node or a sensor. The frame of a camera is optical."""
    nodes = nodes_of(sequence)
    if name in nodes:
        return name, Pose(np.zeros(3), np.eye(3))
    if name not in sequence.sensors or "/" not in name:
        known = [*nodes, *(s for s in sequence.sensors if "/" in s)]
        raise DatasetError(
            f"{sequence.dataset.path}: has no node or mounted sensor {name!r}; it has {', '.join(known)}"
        )
    sensor = sequence[name]
    if len(sensor) == 0:
        raise DatasetError(f"{sequence.path}: {name}: expected records, found none")
    pose = mount(sensor.record(0))
    if sensor.kind in ("camera", "event_camera"):
        pose = pose @ Pose(np.zeros(3), OPTICAL_FROM_BODY.T)
    return node_of(name, nodes), pose


def decimal_seconds(time_ns: int) -> str:
    """Returns nanoseconds as seconds with nine decimals, exactly."""
    return f"{time_ns // 10**9}.{time_ns % 10**9:09d}"


def number(value: float) -> str:
    return repr(float(value))


def write_tum(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    frames: Optional[SequenceOf[str]] = None,
    sequence: Optional[int] = None,
) -> Dict[str, int]:
    """Writes OUT/sequence_0000/NAME.txt with lines `timestamp tx ty tz qx qy qz qw`: the pose in the world of
    each node or sensor in `frames`, by default of every node. A `/` in a name becomes `_`. A node has x
    forward, y left, z up; a camera has optical axes. Returns counts of the written objects. Raises
    DatasetError, or FileExistsError if OUT is not empty.
    """
    sequences = sequences_of(dataset, sequence)
    counts = {"sequences": len(sequences), "trajectories": 0, "poses": 0}
    with new_folder(out) as root:
        for each in sequences:
            folder = root / each.path.name
            folder.mkdir()
            for name in nodes_of(each) if frames is None else frames:
                node, pose = frame_of(each, name)
                motion = _Motion(each, node)
                path = folder / (name.replace("/", "_") + ".txt")
                if path.exists():
                    raise DatasetError(
                        f"{dataset.path}: {name}: another trajectory is written to {path.name}"
                    )
                poses = motion.poses(pose)
                lines = [f"# world from {name}, m\n# timestamp tx ty tz qx qy qz qw\n"]
                for time_ns, at, q in zip(motion.time_ns, poses, continuous([p.quaternion for p in poses])):
                    values = " ".join(number(v) for v in (*at.position, *q[[1, 2, 3, 0]]))
                    lines.append(f"{decimal_seconds(int(time_ns))} {values}\n")
                path.write_text("".join(lines), encoding="utf-8")
                counts["trajectories"] += 1
                counts["poses"] += len(poses)
    return counts


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
    folder: pathlib.Path, sequence: Sequence, cameras: List[str], start_ns: int, link: bool
) -> int:
    written = 0
    for i, name in enumerate(cameras):
        sensor = sequence[name]
        lens = lens_of(sensor, fisheye=True)
        coefficients = lens.coefficients(4)
        target = folder / f"cam{i}"
        (target / "data").mkdir(parents=True)
        _, body_from_camera = frame_of(sequence, name)
        intrinsics = ", ".join(number(v) for v in (lens.fx, lens.fy, lens.cx, lens.cy))
        (target / "sensor.yaml").write_text(
            f"# {name}; pixel centres are at whole numbers\nsensor_type: camera\ncomment: {name}\n\n"
            "# camera's optical frame (x right, y down, z forward) to the body's\n"
            + _matrix("T_BS", body_from_camera)
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


def _write_body(folder: pathlib.Path, sequence: Sequence, node: str, gravity: float, start_ns: int) -> int:
    """Writes ground truth and inertial sensor of a node. Returns the number of their records."""
    motion = _Motion(sequence, node)
    poses = motion.poses(Pose(np.zeros(3), np.eye(3)))
    quaternions = continuous([p.quaternion for p in poses])
    rate, angular, acceleration = motion["velocity"], motion["angular_velocity"], motion["acceleration"]
    turned = np.swapaxes(motion.rotation, 1, 2)  # body from world
    gyro = np.einsum("nij,nj->ni", turned, angular)
    force = np.einsum("nij,nj->ni", turned, acceleration + [0.0, 0.0, gravity])
    times = [int(t) + start_ns for t in motion.time_ns]
    truth, imu = folder / "state_groundtruth_estimate0", folder / "imu0"
    for each in (truth, imu):
        each.mkdir(parents=True)
    zero = [number(0.0)] * 6
    _csv(
        truth / "data.csv",
        "timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
        "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], "
        "b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], "
        "b_a_RS_S_z [m s^-2]",
        [
            [t, *(number(x) for x in (*p.position, *q, *v)), *zero]
            for t, p, q, v in zip(times, poses, quaternions, rate)
        ],
    )
    _csv(
        imu / "data.csv",
        "timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
        "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]",
        [[t, *(number(x) for x in (*w, *f))] for t, w, f in zip(times, gyro, force)],
    )
    identity = _matrix("T_BS", Pose(np.zeros(3), np.eye(3)))
    rate_hz = _rate(sequence, sequence.poses.name)
    (truth / "sensor.yaml").write_text(
        f"sensor_type: visual-inertial\ncomment: true state of {node}, without biases\n" + identity,
        encoding="utf-8",
    )
    (imu / "sensor.yaml").write_text(
        f"# true angular velocity and specific force of {node} at its origin: R^T (a + g z), "
        f"g = {number(gravity)} m/s^2\nsensor_type: imu\n"
        f"comment: ideal inertial sensor of {node}\n\n{identity}\nrate_hz: {rate_hz}\n\n"
        "gyroscope_noise_density: 0.0\ngyroscope_random_walk: 0.0\n"
        "accelerometer_noise_density: 0.0\naccelerometer_random_walk: 0.0\n",
        encoding="utf-8",
    )
    (folder / "body.yaml").write_text(f"comment: {node}, x forward, y left, z up\n", encoding="utf-8")
    return len(times)


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
) -> Dict[str, int]:
    """Writes OUT/sequence_0000/mav0 of a node, by default the only one with cameras: its cameras with their
    pictures, an ideal inertial sensor at its origin, and its true state. Times are nanoseconds from the
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
    counts = {"sequences": len(sequences), "cameras": len(cameras), "pictures": 0, "states": 0}
    progress = Progress(len(sequences), "sequences")
    with new_folder(out) as root:
        for each in sequences:
            folder = root / each.path.name / "mav0"
            counts["states"] += _write_body(folder, each, node, gravity, start_ns)
            counts["pictures"] += _write_cameras(folder, each, cameras, start_ns, link)
            progress.step()
    progress.end()
    return counts


def _tum_arguments(parser: argparse.ArgumentParser) -> None:
    sequence_argument(parser)
    parser.add_argument(
        "--frame",
        action="append",
        metavar="NAME",
        help="a node or sensor; may be repeated; default: every node",
    )


def _euroc_arguments(parser: argparse.ArgumentParser) -> None:
    sequence_argument(parser)
    parser.add_argument("--node", help="node that is the body; needed if several have cameras")
    parser.add_argument("--gravity", type=float, default=STANDARD_GRAVITY, help="m/s^2; default: 9.80665")
    parser.add_argument("--start-ns", type=int, default=0, help="time of tick 0, ns; default: 0")
    link_argument(parser)


COMMANDS = (
    Command(
        "tum",
        "trajectories of nodes and sensors, TUM RGB-D",
        lambda dataset, given: write_tum(dataset, given.OUT, given.frame, given.sequence),
        _tum_arguments,
    ),
    Command(
        "euroc",
        "cameras, inertial sensor and true states of a node, EuRoC MAV",
        lambda dataset, given: write_euroc(
            dataset, given.OUT, given.node, given.sequence, given.gravity, given.start_ns, given.link
        ),
        _euroc_arguments,
    ),
)
