# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Lets nuscenes-devkit read the data sets of `greatx.convert nuscenes` and compares with the data set.

    python3 tests/peer/exports_nuscenes.py [--scenes FOLDER]

The script loads tables, points, radar detections and point labels, takes boxes into each sensor's frame,
projects points, and renders a sample. It prints the largest difference of each kind beside its bound, and
exits with 1 if one exceeds it.
"""

import sys

from environment import Worst
from exports_setup import DRIVING, main


def check_sensor(kit, token, sequence, tick, name, worst):
    """Compares the frame and the boxes of a sensor with the data set's."""
    import numpy as np
    from greatx.convert.poses import Pose, optical_pose, sensor_pose
    from nuscenes.utils.data_classes import LidarPointCloud, RadarPointCloud
    from nuscenes.utils.geometry_utils import points_in_box
    from pyquaternion import Quaternion

    record = sequence[name].at(tick)
    path, boxes, intrinsic = kit.get_sample_data(token)
    origin = np.array(kit.log[0]["greatx_origin_m"])
    data = kit.get("sample_data", token)
    calibrated = kit.get("calibrated_sensor", data["calibrated_sensor_token"])
    ego = kit.get("ego_pose", data["ego_pose_token"])
    rotation = Quaternion(ego["rotation"]) * Quaternion(calibrated["rotation"])
    position = (
        Quaternion(ego["rotation"]).rotate(np.array(calibrated["translation"])) + ego["translation"] + origin
    )
    if data["sensor_modality"] == "camera":
        want = optical_pose(record)
    else:
        want = sensor_pose(record)
        if data["sensor_modality"] == "lidar":  # x right, y forward
            want = want @ Pose(np.zeros(3), np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]))
    worst.add("place of a sensor, m", np.abs(position - want.position), 1e-9)
    worst.add("rotation of a sensor", np.abs(rotation.rotation_matrix - want.rotation), 1e-12)
    if data["sensor_modality"] == "lidar":
        cloud = LidarPointCloud.from_file(path).points
        back = want.apply(cloud[:3].T.astype(float))
        there = sensor_pose(record).apply(record["points"][:, :3])
        worst.add("LiDAR points in the world, m", np.abs(back - there), 1e-5)
        for box in boxes if data["channel"] == "LIDAR_TOP" else []:
            row = kit.get("sample_annotation", box.token)
            # Points on a face go in or out by their rounding.
            least, most = (int(points_in_box(box, cloud[:3], factor).sum()) for factor in (0.999, 1.003))
            outside = max(least - row["num_lidar_pts"], row["num_lidar_pts"] - most, 0)
            worst.add("num_lidar_pts beyond the kit's points_in_box (0.999 to 1.003)", outside, 0)
    if data["sensor_modality"] == "radar":
        found = RadarPointCloud.from_file(path).points
        detections = np.array(record["detections"])
        worst.add(
            "number of detections that pass the kit's filters", abs(found.shape[1] - len(detections)), 0
        )
        if len(detections):
            worst.add("radar x, y, z, rcs", np.abs(found[[0, 1, 2, 5]].T - detections), 0)
            sight = detections[:, :3] / np.linalg.norm(detections[:, :3], axis=1, keepdims=True)
            radial = np.array(record["velocity"])[:, None] * sight[:, :2]
            worst.add("radar vx, vy, m/s", np.abs(found[[6, 7]].T - radial), 1e-5)
    if data["sensor_modality"] == "camera" and "box_center" in sequence[name].arrays:
        check_boxes(kit, boxes, record, intrinsic, worst)
    return len(boxes)


def check_boxes(kit, boxes, record, intrinsic, worst):
    """Compares boxes in a camera's frame, and the rectangles that they project to."""
    import numpy as np
    from greatx.convert.poses import OPTICAL_FROM_BODY
    from greatx.links import rotation
    from nuscenes.utils.geometry_utils import view_points

    centres = np.array(record["box_sensor_center"]).reshape(-1, 3) @ OPTICAL_FROM_BODY.T
    for box in boxes:
        off = np.linalg.norm(centres - box.center, axis=1)
        row = int(np.argmin(off))
        worst.add("centre of a box in a camera, m", off[row], 1e-5)
        want = OPTICAL_FROM_BODY @ rotation(record["box_sensor_orientation"][row])
        worst.add("rotation of a box in a camera", np.abs(box.rotation_matrix - want), 1e-6)
        length, width, height = record["box_size"][row]
        worst.add("width, length, height of a box, m", np.abs(box.wlh - [width, length, height]), 1e-6)
        uv = view_points(box.corners(), intrinsic, normalize=True)[:2] + 0.5
        low, high = uv.min(axis=1), uv.max(axis=1)
        inner = record["box_unclipped"][row]
        # The projected box holds the projected mesh.
        worst.add(
            "mesh beyond its projected box, pixels",
            np.maximum(low - inner[:2], inner[2:] - high).clip(0),
            2e-3,
        )
        level = kit.get("sample_annotation", box.token)["visibility_token"]
        share = float(record["box_visibility"][row])
        worst.add(
            "visibility below that of the picture", max(0.0, share - [0.4, 0.6, 0.8, 1.0][int(level) - 1]), 0
        )


def check_pictures(kit, sample, sequence, tick, cameras, worst):
    """Compares the depth of the points that the kit projects into a camera with the camera's depth."""
    import numpy as np

    for channel, name in cameras.items():
        points, depths, _ = kit.explorer.map_pointcloud_to_image(
            sample["data"]["LIDAR_TOP"], sample["data"][channel]
        )
        depth = sequence[name].at(tick)["depth"]
        uv = np.rint(points[:2]).astype(int)
        height, width = depth.shape
        keep = (uv[0] > 0) & (uv[0] < width - 1) & (uv[1] > 0) & (uv[1] < height - 1)
        uv, z = uv[:, keep], depths[keep]
        near = np.stack([depth[uv[1] + v, uv[0] + u] for u in (-1, 0, 1) for v in (-1, 0, 1)])
        off = (z < 0.995 * near.min(axis=0)) | (z > 1.005 * near.max(axis=0))
        worst.add("share of projected points off the depth picture", off.mean() if len(z) else 0.0, 0.06)


def check_one(data, out, worst, node, **arguments):
    import numpy as np
    from greatx.convert import write_nuscenes
    from nuscenes.nuscenes import NuScenes
    from nuscenes.utils.data_classes import LidarPointCloud, LidarSegPointCloud

    sequence = data.sequences[0]
    counts = write_nuscenes(data, out, node=node, **arguments)
    kit = NuScenes(version="v1.0-mini", dataroot=str(out), verbose=False)
    worst.add("number of samples", abs(len(kit.sample) - counts["samples"]), 0)
    boxes = 0
    names = dict(zip(_channels(data, sequence, node).values(), _channels(data, sequence, node)))
    for sample in kit.sample:
        tick = round((sample["timestamp"] - 946684800 * 10**6) * 1e-6 * float(data.tick_rate_hz))
        worst.add("channels of a sample", len(set(names) ^ set(sample["data"])), 0)
        for channel, token in sample["data"].items():
            boxes += check_sensor(kit, token, sequence, tick, names[channel], worst)
        cameras = {c: n for c, n in names.items() if c.startswith("CAM_") and "depth" in sequence[n].arrays}
        check_pictures(kit, sample, sequence, tick, cameras, worst)
        labels = kit.get("lidarseg", sample["data"]["LIDAR_TOP"])["filename"]
        path = kit.get_sample_data_path(sample["data"]["LIDAR_TOP"])
        segmented = LidarSegPointCloud(path, str(out / labels))
        want = np.array(["", *(i["class"] for i in data.instances)])[
            sequence[names["LIDAR_TOP"]].at(tick)["instance"]
        ]
        is_car = segmented.labels == kit.lidarseg_name2idx_mapping["vehicle.car"]
        worst.add(
            "points of vehicles that lidarseg gives another class", (is_car != (want == "vehicle")).sum(), 0
        )
        for token in sample["anns"]:
            velocity = kit.box_velocity(token)
            row = kit.get("sample_annotation", token)
            instance = data.instances[_instance(kit, row, data)]
            if "node" in instance and (row["prev"] and row["next"]):
                mean = _mean_velocity(data, sequence, instance["node"], kit, row)
                worst.add("box_velocity against the poses, m/s", np.abs(velocity - mean), 1e-5)
    last = kit.sample[-1]
    cloud, times = LidarPointCloud.from_file_multisweep(kit, last, "LIDAR_TOP", "LIDAR_TOP", nsweeps=3)
    worst.add("multisweep: span of times missing (0 if there are several sweeps)", float(times.max() <= 0), 0)
    render(kit, kit.sample[0], out)
    if any(row["category_name"] == "vehicle.car" for row in kit.sample_annotation):
        check_evaluation(kit, out, worst)
    return counts, boxes


def _channels(data, sequence, node):
    from greatx.convert.nuscenes.channels import assign
    from greatx.convert.rig import pick_rig

    return assign(sequence, pick_rig(data, node, False, False))


def _instance(kit, row, data):
    name = kit.get("instance", row["instance_token"])["greatx_name"]
    return [i["name"] for i in data.instances].index(name)


def _mean_velocity(data, sequence, node, kit, row):
    """Returns the difference quotient of the node's poses between the neighbours of an annotation."""
    import numpy as np
    from greatx.convert.poses import node_pose

    ends = []
    for token in (row["prev"], row["next"]):
        sample = kit.get("sample", kit.get("sample_annotation", token)["sample_token"])
        seconds = (sample["timestamp"] - 946684800 * 10**6) * 1e-6
        tick = round(seconds * float(data.tick_rate_hz))
        other = kit.get("sample_annotation", token)
        ends.append((seconds, node_pose(sequence, node, tick), np.array(other["translation"])))
    (t0, a, _), (t1, b, _) = ends
    # The box's centre is fixed in the body.
    at_body = a.inverse().apply(ends[0][2] + np.array(kit.log[0]["greatx_origin_m"]))
    return (b.apply(at_body) - a.apply(at_body)) / (t1 - t0)


def check_evaluation(kit, out, worst):
    """Gives the kit's evaluation the annotations themselves as predictions, which are perfect: its own
    reading of categories, attributes, velocities and points must agree with that."""
    import json

    from nuscenes.eval.common.config import config_factory
    from nuscenes.eval.detection.evaluate import DetectionEval
    from nuscenes.eval.detection.utils import category_to_detection_name

    results = {sample["token"]: [] for sample in kit.sample}
    for row in kit.sample_annotation:
        name = category_to_detection_name(row["category_name"])
        if name is None:
            continue
        (attribute,) = row["attribute_tokens"]
        results[row["sample_token"]].append(
            {
                "sample_token": row["sample_token"],
                **{key: row[key] for key in ("translation", "size", "rotation")},
                "velocity": kit.box_velocity(row["token"])[:2].tolist(),
                "detection_name": name,
                "detection_score": 0.5,
                "attribute_name": kit.get("attribute", attribute)["name"],
            }
        )
    meta = {
        key: key == "use_lidar" for key in ("use_camera", "use_lidar", "use_radar", "use_map", "use_external")
    }
    path = out / "results.json"
    path.write_text(json.dumps({"meta": meta, "results": results}))
    evaluation = DetectionEval(
        kit, config_factory("detection_cvpr_2019"), str(path), "all", str(out / "evaluation"), verbose=False
    )
    metrics, _ = evaluation.evaluate()
    worst.add(
        "1 - average precision of the annotations themselves (car)", 1 - metrics.mean_dist_aps["car"], 1e-9
    )
    for name in ("trans_err", "scale_err", "orient_err", "vel_err", "attr_err"):
        worst.add(
            f"evaluation: {name} of the annotations themselves", metrics.get_label_tp("car", name), 1e-6
        )


def render(kit, sample, out):
    """Draws what users draw first. Raises an exception if the kit cannot."""
    kit.render_sample(sample["token"], out_path=str(out / "sample.png"), verbose=False)
    camera = next(c for c in sample["data"] if c.startswith("CAM_"))
    for more in ({}, {"show_lidarseg": True}):
        kit.render_pointcloud_in_image(
            sample["token"],
            pointsensor_channel="LIDAR_TOP",
            camera_channel=camera,
            out_path=str(out / "points.png"),
            verbose=False,
            **more,
        )
    if sample["anns"]:
        kit.render_annotation(sample["anns"][0], out_path=str(out / "annotation.png"))
    kit.list_scenes()


def check(folder, data_sets, program):
    import greatx

    worst = Worst()
    data = greatx.load(data_sets["asymmetric"])
    print(check_one(data, folder / "nuscenes_ego", worst, "ego", keyframes_hz=0.0))
    print(check_one(data, folder / "nuscenes_level", worst, "level", keyframes_hz=5.0))
    if "etoile" in data_sets:
        data = greatx.load(data_sets["etoile"])
        print(check_one(data, folder / "nuscenes_etoile", worst, "uav", keyframes_hz=5.0))
    return 1 if worst.failed() else 0


if __name__ == "__main__":
    sys.exit(main(__file__, check, "exports", DRIVING, of_rig=False))
