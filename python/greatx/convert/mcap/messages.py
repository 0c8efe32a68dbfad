# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the messages of cameras, LiDARs, radars, event cameras and nodes.

Frames: `world` (x east, y north, z up), NODE and NODE/SENSOR (x forward, y left, z up), and
NODE/SENSOR/optical of a camera (x right, y down, z forward), to which its pictures belong.
"""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np

from ...arrays import Frames
from ...dataset import Record, Sensor, Sequence
from ...files import read_bytes
from ...links import receivers, rotation, transmitters
from ..files import Records
from ..optics import lens_model, lens_of
from ..poses import OPTICAL_FROM_BODY, Pose, mount, node_of, nodes_of
from .output import Foxglove

WORLD = "world"
#: Topic, message.
Named = Tuple[str, Any]
#: Foxglove's names of encodings of pictures of integers.
ENCODINGS = {"u1": "8UC1", "u2": "16UC1"}


def optical_frame(sensor: str) -> str:
    return f"{sensor}/optical"


class Mounts:
    """Holds the frames that do not move within their nodes: those of sensors, cameras and antennas."""

    def __init__(self, fox: Foxglove, sequence: Sequence):
        nodes = nodes_of(sequence)
        turned = Pose(np.zeros(3), OPTICAL_FROM_BODY.T)
        self.frames: Dict[str, Tuple[str, Pose]] = {}  # child: parent, parent from child
        for name, sensor in sequence.sensors.items():
            if "body_from_sensor" in sensor.metadata and len(sensor):
                self.frames[name] = (node_of(name, nodes), mount(sensor.record(0)))
                if sensor.kind in ("camera", "event_camera"):
                    self.frames[optical_frame(name)] = (name, turned)
            if sensor.kind == "csi":
                for end in [*transmitters(sensor), *receivers(sensor)]:
                    place = end["body_from_antenna"]
                    pose = Pose(np.array(place["position_m"], float), rotation(place["orientation_wxyz"]))
                    self.frames[end["name"]] = (node_of(end["name"], nodes), pose)
        self._fox = fox

    def messages(self, time: Any) -> List[Any]:
        return [
            transform(self._fox, time, parent, child, pose) for child, (parent, pose) in self.frames.items()
        ]


def transform(fox: Foxglove, time: Any, parent: str, child: str, pose: Pose) -> Any:
    return fox.FrameTransform(
        timestamp=time,
        parent_frame_id=parent,
        child_frame_id=child,
        translation=fox.vector(pose.position),
        rotation=fox.quaternion(pose.quaternion),
    )


def node_messages(fox: Foxglove, record: Record, time: Any, mounts: Mounts) -> Iterator[Named]:
    """Gives the transforms of all nodes and mounts, and pose and place of each node."""
    nodes = nodes_of(record.sensor.sequence)
    position, orientation = np.array(record["position"]), np.array(record["orientation"])
    poses = [Pose(p, rotation(q)) for p, q in zip(position, orientation)]
    moving = [transform(fox, time, WORLD, node, pose) for node, pose in zip(nodes, poses)]
    yield "/tf", fox.FrameTransforms(transforms=moving + mounts.messages(time))
    geodetic = np.array(record["geodetic"]) if "geodetic" in record.sensor.arrays else None
    for i, node in enumerate(nodes):
        yield f"/{node}/pose", fox.PoseInFrame(timestamp=time, frame_id=WORLD, pose=fox.pose(poses[i]))
        if geodetic is not None:
            latitude, longitude, height = (float(v) for v in geodetic[i])
            yield f"/{node}/location", fox.LocationFix(
                timestamp=time, frame_id=node, latitude=latitude, longitude=longitude, altitude=height
            )


def trajectories(fox: Foxglove, sequence: Sequence, time: Any) -> Iterator[Named]:
    """Gives the whole way of each node, as one message."""
    position = np.array(sequence.poses["position"][:], float)
    orientation = rotation(np.array(sequence.poses["orientation"][:], float))
    for i, node in enumerate(nodes_of(sequence)):
        poses = [fox.pose(Pose(p, r)) for p, r in zip(position[:, i], orientation[:, i])]
        yield f"/{node}/trajectory", fox.PosesInFrame(timestamp=time, frame_id=WORLD, poses=poses)


def _raw(fox: Foxglove, time: Any, frame: str, array: np.ndarray, encoding: str) -> Any:
    array = np.ascontiguousarray(array)
    return fox.RawImage(
        timestamp=time,
        frame_id=frame,
        width=array.shape[1],
        height=array.shape[0],
        encoding=encoding,
        step=array.nbytes // array.shape[0],
        data=array.tobytes(),
    )


def _picture(fox: Foxglove, record: Record, time: Any, name: str) -> Optional[Any]:
    """Returns a message of one array of pixels, or None if Foxglove has no encoding for it."""
    frame, opened = optical_frame(record.sensor.name), record.sensor[name]
    located = record.sensor.info.locate(name)
    assert located is not None and located[1] is not None
    dtype, shape = located[1].dtype, located[1].shape
    if name == "rgb" and located[0].format == "png" and isinstance(opened, Frames):
        data = read_bytes(opened.path(record.row))
        return fox.CompressedImage(timestamp=time, frame_id=frame, format="png", data=data)
    if len(shape) == 3 and shape[2] == 3 and dtype == np.uint8:
        return _raw(fox, time, frame, np.asarray(record[name]), "rgb8")
    if len(shape) != 2:
        return None
    if dtype == np.float32:
        return _raw(fox, time, frame, np.asarray(record[name]), "32FC1")
    if dtype.str[1:] in ENCODINGS:
        return _raw(fox, time, frame, np.asarray(record[name]), ENCODINGS[dtype.str[1:]])
    return None


def calibration(fox: Foxglove, sensor: Sensor, time: Any) -> Any:
    """Returns the intrinsics. Pixel centres are at whole numbers, as ROS and OpenCV have them."""
    lens = lens_of(sensor, fisheye=True)
    matrix = lens.matrix()
    return fox.CameraCalibration(
        timestamp=time,
        frame_id=optical_frame(sensor.name),
        width=lens.width,
        height=lens.height,
        distortion_model="kannala_brandt" if lens.fisheye else "plumb_bob",
        D=lens.coefficients(5),
        K=matrix.ravel().tolist(),
        R=np.eye(3).ravel().tolist(),
        P=np.hstack([matrix, np.zeros((3, 1))]).ravel().tolist(),
    )


def camera_messages(fox: Foxglove, record: Record, time: Any, left_out: Dict[str, int]) -> Iterator[Named]:
    name = record.sensor.name
    if lens_model(record.sensor) != "equirectangular":  # Foxglove has no calibration of a panorama
        yield f"/{name}/calibration", calibration(fox, record.sensor, time)
    for array, info in record.sensor.arrays.items():
        if array.startswith("box_") or len(info.shape) < 2 or -1 in info.shape:
            continue
        message = _picture(fox, record, time, array)
        if message is None:
            left_out[f"{name}/{array}"] = left_out.get(f"{name}/{array}", 0) + 1
        else:
            yield f"/{name}/{array}", message


def event_messages(fox: Foxglove, record: Record, time: Any, left_out: Dict[str, int]) -> Iterator[Named]:
    """Gives the events of a record as a picture: red for brighter, blue for darker pixels."""
    name = record.sensor.name
    yield f"/{name}/calibration", calibration(fox, record.sensor, time)
    if "t" in record.sensor.arrays:
        yield f"/{name}/events", _raw(fox, time, optical_frame(name), record.events().picture(), "rgb8")
        left_out[f"{name}/t, x, y, p"] = left_out.get(f"{name}/t, x, y, p", 0) + 1


def cloud(fox: Foxglove, time: Any, frame: str, columns: Dict[str, np.ndarray]) -> Any:
    """Returns a point cloud with a field for each column [n], in their order and types."""
    kinds = fox.PackedElementField
    types = {
        "u1": kinds.UINT8,
        "i1": kinds.INT8,
        "u2": kinds.UINT16,
        "u4": kinds.UINT32,
        "i4": kinds.INT32,
        "f4": kinds.FLOAT32,
        "f8": kinds.FLOAT64,
    }
    columns = {k: v for k, v in columns.items() if v.dtype.str[1:] in types}
    kind = np.dtype([(name, values.dtype.newbyteorder("<")) for name, values in columns.items()])
    rows = np.empty(len(next(iter(columns.values()))), kind)
    for name, values in columns.items():
        rows[name] = values
    fields = [
        kinds(name=name, offset=kind.fields[name][1], type=types[values.dtype.str[1:]])
        for name, values in columns.items()
    ]
    return fox.PointCloud(
        timestamp=time,
        frame_id=frame,
        pose=fox.pose(Pose(np.zeros(3), np.eye(3))),
        point_stride=kind.itemsize,
        fields=fields,
        data=rows.tobytes(),
    )


def _columns(arrays: Dict[str, np.ndarray], points: str, fourth: str) -> Dict[str, np.ndarray]:
    """Returns x, y, z and the fourth number of `points`, and all other arrays of as many rows."""
    place = arrays[points]
    columns = {name: place[:, i] for i, name in enumerate(("x", "y", "z", fourth))}
    columns.update({k: v for k, v in arrays.items() if k != points and v.shape == (len(place),)})
    return columns


def lidar_messages(fox: Foxglove, record: Record, time: Any, records: Records) -> Iterator[Named]:
    name = record.sensor.name
    if "points" in record.sensor.arrays:
        yield f"/{name}/points", cloud(fox, time, name, _columns(records[record.row], "points", "intensity"))


def radar_messages(fox: Foxglove, record: Record, time: Any, left_out: Dict[str, int]) -> Iterator[Named]:
    """Gives detections as a cloud, and maps as pictures of dBm."""
    name, arrays = record.sensor.name, record.sensor.arrays
    if "detections" in arrays:
        ragged = {a: record[a] for a, info in arrays.items() if info.shape[:1] == (-1,)}
        columns = _columns({k: np.asarray(v) for k, v in ragged.items()}, "detections", "rcs_dbsm")
        yield f"/{name}/detections", cloud(fox, time, name, columns)
    for array in ("range_doppler", "range_azimuth"):
        if array in arrays:
            power = np.asarray(record[array], np.float64)
            with np.errstate(divide="ignore"):
                dbm = (10 * np.log10(1000 * power)).astype(np.float32)
            yield f"/{name}/{array}_dbm", _raw(fox, time, name, dbm, "32FC1")
    if "cube" in arrays:
        left_out[f"{name}/cube"] = left_out.get(f"{name}/cube", 0) + 1
