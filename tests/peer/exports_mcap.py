# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the files of `greatx.convert mcap` by the reader of MCAP itself and compares with the data set: every
topic, the number, times and values of its messages, and the poses that the tree of transforms gives.

    python3 tests/peer/exports_mcap.py [--scenes FOLDER]

It prints the largest difference of each kind beside its bound, and exits with 1 if one exceeds it.
"""

import collections
import json
import os
import pathlib
import subprocess
import sys

from environment import Worst
from exports_setup import main

PACKAGES = ("numpy", "mcap==1.6.0", "mcap-protobuf-support==0.6.0", "foxglove-schemas-protobuf==0.4.0")
START_NS = 1_700_000_000_123_456_789


class JsonFactory:
    """Decodes messages in JSON for mcap's reader, which has a decoder for protobuf alone."""

    def decoder_for(self, message_encoding, schema):
        return json.loads if message_encoding == "json" else None


def pose_of(translation, rotation):
    import numpy as np
    from greatx.convert.poses import Pose
    from greatx.links import rotation as matrix

    turn = matrix([rotation.w, rotation.x, rotation.y, rotation.z])
    return Pose(np.array([translation.x, translation.y, translation.z]), turn)


def columns_of(cloud):
    """Returns the columns of a point cloud by what its fields say."""
    import numpy as np

    types = {1: "u1", 2: "i1", 3: "<u2", 4: "<i2", 5: "<u4", 6: "<i4", 7: "<f4", 8: "<f8"}
    kind = np.dtype(
        {
            "names": [f.name for f in cloud.fields],
            "formats": [types[f.type] for f in cloud.fields],
            "offsets": [f.offset for f in cloud.fields],
            "itemsize": cloud.point_stride,
        }
    )
    return np.frombuffer(cloud.data, kind)


def check_tree(sequence, messages, worst):
    """Composes world from node, sensor and optical frame, and compares with the poses of the data set."""
    import numpy as np
    from greatx.convert.poses import optical_pose, sensor_pose
    from greatx.links import antenna_pose, receivers

    for log_time, message in messages["/tf"]:
        frames = {t.child_frame_id: t for t in message.transforms}
        tick = next(t for t in sequence if t.time_ns + START_NS == log_time)

        def world_from(child):
            entry = frames[child]
            here = pose_of(entry.translation, entry.rotation)
            parent = entry.parent_frame_id
            return here if parent == "world" else world_from(parent) @ here

        for name, record in tick.items():
            wanted = {}
            if "body_from_sensor" in record.sensor.metadata:
                wanted[name] = sensor_pose(record)
                if record.sensor.kind in ("camera", "event_camera"):
                    wanted[name + "/optical"] = optical_pose(record)
            for frame, pose in wanted.items():
                worst.add(
                    "tf: position of a sensor, m", np.abs(world_from(frame).position - pose.position), 1e-9
                )
                worst.add(
                    "tf: rotation of a sensor", np.abs(world_from(frame).rotation - pose.rotation), 1e-12
                )
            if record.sensor.kind == "csi":
                for end in receivers(record.sensor):
                    place, _ = antenna_pose(record, end)
                    worst.add("tf: antennas, m", np.abs(world_from(end["name"]).position - place), 1e-9)


def check_record(name, record, at, worst):
    """Compares the messages of one record. `at` gives the message of a topic at the record's time."""
    import numpy as np

    sensor = record.sensor
    for array, info in sensor.arrays.items():
        message = at(f"/{name}/{array}")
        if message is None or sensor.kind not in ("camera",):
            continue
        worst.add("frames of pictures", float(message.frame_id != f"{name}/optical"), 0)
        if array == "rgb":
            png = sensor["rgb"].path(record.row).read_bytes()
            worst.add(
                "pictures: PNG files that differ", float(message.data != png or message.format != "png"), 0
            )
            continue
        pixels = np.frombuffer(message.data, info.dtype).reshape(message.height, message.width)
        encodings = {"f4": "32FC1", "u2": "16UC1", "u1": "8UC1"}
        worst.add("encodings", float(message.encoding != encodings[info.dtype.str[1:]]), 0)
        worst.add("row strides", abs(message.step - message.width * info.dtype.itemsize), 0)
        worst.differs("depth and ids", pixels, record[array])
    if sensor.kind in ("camera", "event_camera"):
        k = np.array(at(f"/{name}/calibration").K).reshape(3, 3)
        meta = sensor.metadata
        wanted = [meta["fx"], meta["fy"], meta["cx"] - 0.5, meta["cy"] - 0.5]
        worst.add("intrinsics, pixels", np.abs([k[0, 0], k[1, 1], k[0, 2], k[1, 2]] - np.array(wanted)), 0)
    if sensor.kind == "event_camera":
        message = at(f"/{name}/events")
        pixels = np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, 3)
        worst.differs("events as pictures", pixels, record.events().picture())
    if sensor.kind == "lidar":
        points = columns_of(at(f"/{name}/points"))
        for i, column in enumerate(("x", "y", "z", "intensity")):
            worst.differs("LiDAR", points[column], record["points"][:, i])
        for array in sensor.arrays:
            if array != "points":
                worst.differs("LiDAR", points[array], record[array])
    if sensor.kind == "radar":
        points = columns_of(at(f"/{name}/detections"))
        for i, column in enumerate(("x", "y", "z", "rcs_dbsm")):
            worst.differs("radar detections", points[column], record["detections"][:, i])
        for array in ("range", "velocity", "snr", "power", "instance"):
            worst.differs("radar detections", points[array], record[array])
        for array in ("range_doppler", "range_azimuth"):
            message = at(f"/{name}/{array}_dbm")
            dbm = np.frombuffer(message.data, np.float32).reshape(message.height, message.width)
            some = np.asarray(record[array]) > 0
            wanted = 10 * np.log10(1000 * np.asarray(record[array], float)[some])
            worst.add("radar maps, dB", np.abs(dbm[some] - wanted), 1e-4)
    if sensor.kind == "csi":
        check_channel(name, record, at, worst)
    boxes = at(f"/{name}/boxes")
    if boxes is not None:
        worst.add("boxes: their number", abs(len(boxes.entities) - len(record.box_instance)), 0)
        for entity, centre, size, turn in zip(
            boxes.entities, record.box_center, record.box_size, record.box_orientation
        ):
            cube = entity.cubes[0]
            pose = pose_of(cube.pose.position, cube.pose.orientation)
            from greatx.links import rotation

            worst.add("boxes: centre, m", np.abs(pose.position - centre), 1e-9)
            worst.add("boxes: rotation", np.abs(pose.rotation - rotation(turn)), 1e-12)
            worst.add(
                "boxes: size, m", np.abs(np.array([cube.size.x, cube.size.y, cube.size.z]) - size), 1e-6
            )


def check_channel(name, record, at, worst):
    """The length of each line, over the speed of light, is the delay of a path."""
    import numpy as np

    lines = at(f"/{name}/paths")
    delays = []
    for entity in lines.entities:
        points = np.array([[p.x, p.y, p.z] for p in entity.lines[0].points])
        delays.append(np.linalg.norm(np.diff(points, axis=0), axis=1).sum() / 299792458.0)
    paths = record.paths()
    power = np.mean(np.abs(paths["amplitude"].astype(complex)) ** 2, axis=(1, 2))
    wanted = paths["delay"][np.argsort(-power, kind="stable")[: len(delays)]]
    worst.add("paths: their number", abs(len(delays) - min(len(paths["delay"]), 200)), 0)
    worst.add("paths: length over c against delay, relative", np.abs(np.array(delays) / wanted - 1), 1e-9)
    links = at(f"/{name}/statistics")["links"]
    for number, link in enumerate(links):
        rx, tx = divmod(number, record["path_count"].shape[1])
        worst.add("statistics: paths", abs(link["path_count"] - int(record["path_count"][rx, tx])), 0)
        for key in ("mean_delay", "delay_spread", "doppler_spread"):
            value = float(record[key][rx, tx])
            found = float("nan") if link[key] is None else link[key]
            worst.add(
                "statistics: delays and Doppler",
                0.0 if np.isnan([found, value]).all() else abs(found - value),
                0,
            )
        if link["path_gain_db"] is not None:
            gain = 10 * np.log10(float(record["path_gain"][rx, tx]))
            worst.add("statistics: gain, dB", abs(link["path_gain_db"] - gain), 1e-9)


def check_sequence(path, sequence, worst):
    import numpy as np
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    messages = collections.defaultdict(list)
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory(), JsonFactory()], validate_crcs=True)
        last = 0
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            messages[channel.topic].append((message.log_time, decoded))
            worst.add("times: messages before the one before", max(last - message.log_time, 0), 0)
            last = message.log_time
            stamp = getattr(decoded, "timestamp", None)
            if stamp is not None:
                worst.add("times: ns", abs(stamp.seconds * 10**9 + stamp.nanos - message.log_time), 0)
        summary = reader.get_summary()
        counts = summary.statistics.channel_message_counts
        for number, channel in summary.channels.items():
            worst.add("counts of the file's summary", abs(counts[number] - len(messages[channel.topic])), 0)
        (attachment,) = reader.iter_attachments()
        worst.add("dataset.json", float(json.loads(attachment.data) != sequence.dataset.info), 0)
    check_tree(sequence, messages, worst)
    seen = set()
    for tick in sequence:
        by_topic = {
            topic: [m for time, m in entries if time == tick.time_ns + START_NS]
            for topic, entries in messages.items()
        }

        def at(topic):
            found = by_topic.get(topic, [])
            if found:
                seen.add(topic)
            return found[0] if found else None

        for name, record in tick.items():
            check_record(name, record, at, worst)
        poses = tick[sequence.poses.name]
        for i, node in enumerate(poses.sensor.metadata["nodes"]):
            here = at(f"/{node}/pose").pose.position
            worst.add("nodes: position, m", np.abs(np.array([here.x, here.y, here.z]) - poses.position[i]), 0)
            if "geodetic" in poses.sensor.arrays:
                fix = at(f"/{node}/location")
                place = [fix.latitude, fix.longitude, fix.altitude]
                worst.add("nodes: latitude, longitude, height", np.abs(place - poses.geodetic[i]), 0)
            whole = messages[f"/{node}/trajectory"][0][1].poses
            worst.add("nodes: poses of the trajectory", abs(len(whole) - len(sequence.poses)), 0)
            seen.add(f"/{node}/trajectory")
        seen.add("/tf")
    worst.add("topics that were not compared", len(set(messages) - seen), 0)
    return len(messages), sum(map(len, messages.values()))


def check(folder, data_sets, program):
    import greatx
    from greatx.convert.mcap import write_mcap

    worst = Worst()
    for name, path in data_sets.items():
        data = greatx.load(path)
        write_mcap(data, folder / f"mcap_{name}", start_ns=START_NS)
        for sequence in data.sequences:
            file = folder / f"mcap_{name}" / f"{sequence.path.name}.mcap"
            topics, count = check_sequence(file, sequence, worst)
            print(f"{name} {sequence.number}: {topics} topics, {count} messages, {file.stat().st_size} B")
        # Another process, with another seed of hashes, writes the same bytes.
        for compression in ("zstd", "lz4"):
            files = []
            for seed in ("1", "2"):
                out = folder / f"{name}_{compression}_{seed}.mcap"
                command = [sys.executable, "-m", "greatx.convert", "mcap", path, out, "--sequence", "0"]
                variables = {**os.environ, "PYTHONHASHSEED": seed}
                subprocess.run(
                    [*command, "--compression", compression],
                    check=True,
                    env=variables,
                    stdout=subprocess.DEVNULL,
                )
                files.append(pathlib.Path(out).read_bytes())
            worst.add("bytes of two processes that differ", float(files[0] != files[1]), 0)
    return 1 if worst.failed() else 0


if __name__ == "__main__":
    sys.exit(main(__file__, check, "exports_mcap", PACKAGES))
