# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Lets KITTI's tools read the data sets of `greatx.convert kitti-...` and compares with the data set.

    python3 tests/peer/exports_kitti.py [--scenes FOLDER]

pykitti reads the raw, odometry and tracking layouts, and nuscenes-devkit's KittiDB the object layout. The
script prints the largest difference of each kind beside its bound, and exits with 1 if one exceeds it.
"""

import sys

from environment import Worst
from exports_setup import DRIVING, main


def relative(pose, other):
    """Returns the largest difference of two matrices 4 x 4 or 3 x 4."""
    import numpy as np

    return np.abs(np.asarray(pose)[:3] - np.asarray(other)[:3])


def check_raw(data, out, choice, worst):
    import datetime

    import numpy as np
    import pykitti
    from export_scene import agreement
    from greatx.convert import write_kitti_raw
    from greatx.convert.poses import node_pose, nodes_of, optical_pose, sensor_pose
    from greatx.convert.rig import common_ticks

    sequence = data.sequences[0]
    write_kitti_raw(data, out, **choice)
    node = choice["node"]
    camera, lidar = (sequence[f"{node}/{choice[key]}"] for key in ("camera", "lidar"))
    ticks = common_ticks(sequence, [camera.name, lidar.name])
    kitti = pykitti.raw(str(out), "2000_01_01", "0000")
    worst.add("raw: number of frames", abs(len(kitti) - len(ticks)), 0)
    first = node_pose(sequence, node, int(ticks[0])).position
    for i, tick in enumerate(int(t) for t in ticks):
        want = node_pose(sequence, node, tick)
        got = kitti.oxts[i].T_w_imu
        worst.add("raw: position of the carrier, m", np.abs(got[:3, 3] - (want.position - first)), 1e-8)
        worst.add("raw: rotation of the carrier", np.abs(got[:3, :3] - want.rotation), 1e-12)
        optical = optical_pose(camera.at(tick)).inverse()
        from_lidar = (optical @ sensor_pose(lidar.at(tick))).matrix()
        worst.add(
            "raw: camera 2 from LiDAR, m and rotation", relative(kitti.calib.T_cam2_velo, from_lidar), 1e-11
        )
        worst.add(
            "raw: camera 2 from IMU", relative(kitti.calib.T_cam2_imu, (optical @ want).matrix()), 1e-11
        )
        points = kitti.get_velo(i)
        worst.add("raw: points, m", np.abs(points - lidar.at(tick)["points"]), 0)
        worst.add("raw: pixels", np.abs(np.array(kitti.get_cam2(i)).astype(int) - camera.at(tick)["rgb"]), 0)
        at_camera = (
            points[:, :3].astype(float) @ kitti.calib.T_cam2_velo[:3, :3].T + kitti.calib.T_cam2_velo[:3, 3]
        )
        share = agreement(at_camera, kitti.calib.K_cam2, camera.at(tick)["depth"])
        worst.add("raw: share of points off the depth picture", 1 - share, 0.05)
        seconds = (kitti.timestamps[i] - datetime.datetime(2000, 1, 1)).total_seconds()
        worst.add("raw: time of a frame, s", abs(seconds - tick / data.tick_rate_hz), 1e-6)
        velocity = np.array(sequence.at(tick)["poses"]["velocity"][nodes_of(sequence).index(node)])
        packet = kitti.oxts[i].packet
        turned = np.array([packet.vf, packet.vl, packet.vu])
        c, s = np.cos(packet.yaw), np.sin(packet.yaw)
        back = [c * turned[0] - s * turned[1], s * turned[0] + c * turned[1], turned[2]]
        worst.add("raw: velocity, m/s", np.abs(np.array(back) - velocity), 1e-9)


def check_odometry(data, out, choice, worst):
    import numpy as np
    import pykitti
    from greatx.convert import write_kitti_odometry
    from greatx.convert.poses import optical_pose, sensor_pose
    from greatx.convert.rig import common_ticks

    sequence = data.sequences[0]
    write_kitti_odometry(data, out, **choice)
    node = choice["node"]
    camera, lidar = (sequence[f"{node}/{choice[key]}"] for key in ("camera", "lidar"))
    ticks = [int(tick) for tick in common_ticks(sequence, [camera.name, lidar.name])]
    kitti = pykitti.odometry(str(out), "00")
    worst.add("odometry: number of frames", abs(len(kitti) - len(ticks)), 0)
    first = optical_pose(camera.at(ticks[0])).inverse()
    for i, tick in enumerate(ticks):
        want = (first @ optical_pose(camera.at(tick))).matrix()
        worst.add("odometry: pose of camera 0, m and rotation", relative(kitti.poses[i], want), 1e-10)
        from_lidar = (optical_pose(camera.at(tick)).inverse() @ sensor_pose(lidar.at(tick))).matrix()
        worst.add("odometry: camera 0 from LiDAR", relative(kitti.calib.T_cam0_velo, from_lidar), 1e-11)
        worst.add("odometry: points, m", np.abs(kitti.get_velo(i) - lidar.at(tick)["points"]), 0)
        worst.add(
            "odometry: pixels", np.abs(np.array(kitti.get_cam2(i)).astype(int) - camera.at(tick)["rgb"]), 0
        )
        seconds = kitti.timestamps[i].total_seconds()
        worst.add("odometry: time of a frame, s", abs(seconds - (tick - ticks[0]) / data.tick_rate_hz), 1e-6)


def check_stereo(data, out, worst):
    import pykitti
    from greatx.convert import write_kitti_raw

    write_kitti_raw(data, out, node="level", camera="left", right="right", lidar="lidar")
    kitti = pykitti.raw(str(out), "2000_01_01", "0000")
    worst.add("raw: baseline of a pair 0.5 m apart, m", abs(kitti.calib.b_rgb - 0.5), 1e-12)
    want = data.sequences[0]["level/right"].record(2)["rgb"]
    import numpy as np

    worst.add("raw: pixels of camera 3", np.abs(np.array(kitti.get_cam3(2)).astype(int) - want), 0)


def check_object(data, out, choice, worst, tilted):
    """Compares the boxes of KittiDB, which are in nuScenes' LiDAR frame, with the data set's."""
    import numpy as np
    from greatx.convert import write_kitti_object
    from greatx.convert.poses import OPTICAL_FROM_BODY, Pose, mount
    from greatx.convert.rig import common_ticks
    from greatx.links import rotation
    from nuscenes.utils.kitti import KittiDB

    sequence = data.sequences[0]
    write_kitti_object(data, out, types=["uav=Car"], **choice)
    node = choice["node"]
    camera, lidar = (sequence[f"{node}/{choice[key]}"] for key in ("camera", "lidar"))

    class Database(KittiDB):
        """Makes the rotation orthogonal, which the kit rounds to 32 bits and pyquaternion then refuses."""

        @staticmethod
        def get_transforms(token, root):
            found = KittiDB.get_transforms(token, root)
            u, _, v = np.linalg.svd(found["velo_to_cam"]["R"].astype(float))
            found["velo_to_cam"]["R"] = u @ v
            return found

    database = Database(str(out), splits=("training",))
    ticks = [int(tick) for tick in common_ticks(sequence, [camera.name, lidar.name])]
    worst.add("object: number of frames", abs(len(database.tokens) - len(ticks)), 0)
    turn = Pose(np.zeros(3), np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]))
    for token, tick in zip(database.tokens, ticks):
        record = camera.at(tick)
        boxes = database.get_boxes(token)
        named = np.isin(
            [data.semantic_classes[k] for k in record["box_semantic"]], ["vehicle", "uav", "person"]
        )
        rows = np.flatnonzero(named & (record["box_visible_pixels"] > 0))
        worst.add("object: number of boxes", abs(len(boxes) - len(rows)), 0)
        lidar_from_camera = turn @ mount(lidar.at(tick)).inverse() @ mount(record)
        for box, row in zip(boxes, rows):
            centre = lidar_from_camera.apply(record["box_sensor_center"][row])
            # The kit keeps the calibration in 32 bits.
            worst.add("object: centre of a box, m", np.abs(box.center - centre), 5e-5)
            length, width, height = record["box_size"][row]
            worst.add("object: width, length, height, m", np.abs(box.wlh - [width, length, height]), 1e-6)
            if not tilted:
                want = lidar_from_camera.rotation @ rotation(record["box_sensor_orientation"][row])
                worst.add("object: rotation of a box, level camera", np.abs(box.rotation_matrix - want), 2e-6)
            else:
                at_camera = OPTICAL_FROM_BODY @ rotation(record["box_sensor_orientation"][row])
                optical = OPTICAL_FROM_BODY @ lidar_from_camera.rotation.T @ box.rotation_matrix
                cross = optical[0, 0] * at_camera[2, 0] - optical[2, 0] * at_camera[0, 0]
                dot = optical[0, 0] * at_camera[0, 0] + optical[2, 0] * at_camera[2, 0]
                worst.add("object: heading of a box, tilted camera, rad", abs(np.arctan2(cross, dot)), 2e-6)
        cloud = database.get_pointcloud(token, root=str(out)).points.T
        worst.add("object: points, m", np.abs(cloud - lidar.at(tick)["points"]), 0)


def check_tracking(data, out, choice, worst):
    import numpy as np
    import pykitti
    from greatx.convert import write_kitti_tracking
    from greatx.convert.rig import common_ticks
    from pykitti.tracking import KittiTrackingLabels

    sequence = data.sequences[0]
    write_kitti_tracking(data, out, types=["uav=Car"], **choice)
    node = choice["node"]
    camera, lidar = (sequence[f"{node}/{choice[key]}"] for key in ("camera", "lidar"))
    ticks = [int(tick) for tick in common_ticks(sequence, [camera.name, lidar.name])]
    kitti = pykitti.tracking(str(out / "training"), "0000")
    worst.add("tracking: number of pictures", abs(len(kitti.cam2_files) - len(ticks)), 0)
    labels = KittiTrackingLabels(str(out / "training/label_02/0000.txt"))
    frames = list(labels._df.index)
    worst.add("tracking: frames of labels", abs(len(set(frames)) - len(ticks)), 0)
    for i, tick in enumerate(ticks):
        worst.add("tracking: points, m", np.abs(kitti.get_velo(i) - lidar.at(tick)["points"]), 0)
        record = camera.at(tick)
        rows = labels._df.loc[[i]]
        amodal = np.clip(record["box_amodal"] - 0.5, 0, np.array([camera.width - 1, camera.height - 1] * 2))
        for values in rows[["x1", "y1", "x2", "y2"]].values:
            worst.add("tracking: rectangles, pixels", np.abs(amodal - values).max(axis=1).min(), 6e-3)


def check(folder, data_sets, program):
    import greatx

    worst = Worst()
    data = greatx.load(data_sets["asymmetric"])
    ego = {"node": "ego", "camera": "front", "lidar": "lidar"}
    level = {"node": "level", "camera": "left", "lidar": "lidar"}
    for name, choice in (("ego", ego), ("level", level)):
        check_raw(data, folder / f"raw_{name}", choice, worst)
        check_odometry(data, folder / f"odometry_{name}", choice, worst)
        check_object(data, folder / f"object_{name}", choice, worst, tilted=name == "ego")
        check_tracking(data, folder / f"tracking_{name}", choice, worst)
    check_stereo(data, folder / "stereo", worst)
    if "etoile" in data_sets:
        data = greatx.load(data_sets["etoile"])
        uav = {"node": "uav", "camera": "front", "lidar": "lidar"}
        check_raw(data, folder / "raw_uav", uav, worst)
        check_odometry(data, folder / "odometry_uav", uav, worst)
        check_object(data, folder / "object_uav", uav, worst, tilted=True)
        check_tracking(data, folder / "tracking_uav", uav, worst)
    return 1 if worst.failed() else 0


if __name__ == "__main__":
    sys.exit(main(__file__, check, "exports", DRIVING, of_rig=False))
