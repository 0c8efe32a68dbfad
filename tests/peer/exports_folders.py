# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What exports_data.py checks of the folders of DSEC, CARRADA and RADIal. Their loaders are no packages of
PyPI, except for tonic's reader of DSEC, so the steps of the published loaders are done here.
"""

import csv
import json


def check_dsec(name, data, out, worst):
    """tonic reads the data; OpenCV undistorts, rectifies and reads the pictures by cam_to_cam.yaml."""
    import cv2
    import h5py
    import numpy as np
    import yaml
    from greatx.convert.dsec import write_dsec

    names = {"events_left": next(n for n, s in data.sensors.items() if s.kind == "event_camera")}
    if name == "rig":
        names.update(events_right="car/dvs2", images_left="car/front", images_right="car/right")
    else:
        names.update(images_left=next(n for n, s in data.sensors.items() if s.kind == "camera"))
    write_dsec(data, out, **names)
    for sequence in data.sequences:
        folder = out / sequence.path.name
        entries = yaml.safe_load((folder / "calibration/cam_to_cam.yaml").read_text())
        sides = {0: ("left", names["events_left"]), 3: ("right", names.get("events_right"))}
        for number, (side, sensor) in sides.items():
            if sensor is None:
                continue
            own = entries["intrinsics"][f"cam{number}"]
            width, height = own["resolution"]
            matrix = _matrix(own["camera_matrix"])
            rectified = _matrix(entries["intrinsics"][f"camRect{number}"]["camera_matrix"])
            turn = np.array(entries["extrinsics"][f"R_rect{number}"])
            grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1).astype(np.float64)
            stop = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 200, 1e-14)
            wanted = cv2.undistortPointsIter(
                grid.reshape(-1, 1, 2), matrix, np.array(own["distortion_coeffs"]), turn, rectified, stop
            )
            with h5py.File(folder / f"events/{side}/rectify_map.h5") as file:
                places = file["rectify_map"][:]
            worst.add(
                "DSEC: rectify_map against OpenCV, pixels",
                np.abs(places - wanted.reshape(places.shape)),
                1e-5,
            )
            check_slices(folder / f"events/{side}/events.h5", sequence[sensor], worst)
        check_dsec_pictures(folder, sequence, names, entries, worst)
    check_tonic(out, data, names, worst)


def _matrix(values):
    import numpy as np

    fx, fy, cx, cy = values
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])


def check_slices(path, sensor, worst):
    """Takes windows of time by ms_to_idx as DSEC's EventSlicer does, and compares with the data set."""
    import h5py
    import numpy as np

    events = sensor.events()
    times = events.t // 1000
    with h5py.File(path) as file:
        index, t = file["ms_to_idx"][:].astype(int), file["events/t"][:].astype(int)
        offset = int(file["t_offset"][()])
        last = len(index) - 1
        for begin in np.linspace(0, max(1000 * (last - 1), 1), 20).astype(int):
            end = min(begin + 15_300, 1000 * last)
            first, stop = index[begin // 1000], index[-(-end // 1000)]
            window = t[first:stop]
            mine = slice(first + np.searchsorted(window, begin), first + np.searchsorted(window, end))
            wanted = np.flatnonzero((times >= begin) & (times < end))
            found = np.arange(len(t))[mine]
            worst.add("DSEC: events of a window that differ", float(not np.array_equal(found, wanted)), 0)
        for key in ("x", "y", "p"):
            worst.differs("DSEC: events", file[f"events/{key}"][:], getattr(events, key))
        worst.add("DSEC: times, us", np.abs(t + offset - times), 0)


def check_dsec_pictures(folder, sequence, names, entries, worst):
    import cv2
    import numpy as np

    times = np.loadtxt(folder / "images/timestamps.txt", dtype="int64", ndmin=1)
    camera = sequence[names["images_left"]]
    worst.add("DSEC: times of pictures, us", np.abs(times - camera.index[:, 1] // 1000), 0)
    for number, record in enumerate(camera):
        picture = cv2.imread(str(folder / f"images/left/rectified/{number:06d}.png"))[..., ::-1]
        own = entries["intrinsics"]["cam1"]
        matrix, rectified = _matrix(own["camera_matrix"]), _matrix(
            entries["intrinsics"]["camRect1"]["camera_matrix"]
        )
        turn = np.array(entries["extrinsics"]["R_rect1"])
        size = tuple(own["resolution"])
        maps = cv2.initUndistortRectifyMap(
            matrix, np.array(own["distortion_coeffs"]), turn, rectified, size, cv2.CV_32FC1
        )
        wanted = cv2.remap(np.ascontiguousarray(record["rgb"]), *maps, cv2.INTER_LINEAR)
        # OpenCV interpolates in steps of 1/32 pixel. Both leave the rim black, but not the same half pixel.
        far = np.all(wanted > 0, -1) & np.all(picture > 0, -1)
        difference = np.abs(picture.astype(int) - wanted.astype(int)).max(-1)[far]
        worst.add("DSEC: rectified pictures against OpenCV, mean of the levels", difference.mean(), 0.5)
    pair = entries.get("disparity_to_depth", {}).get("cams_12")
    if pair is not None:
        turn = np.array(entries["extrinsics"]["R_rect1"])
        for number, record in enumerate(camera):
            coded = cv2.imread(str(folder / f"disparity/image/{number:06d}.png"), cv2.IMREAD_ANYDEPTH)
            points = cv2.reprojectImageTo3D((coded / 256).astype(np.float32), np.array(pair, np.float32))
            # The points, turned back into the camera and shown through its lens, have the depth of the truth.
            inside = coded > 256
            back = points[inside].astype(float) @ turn
            pixels, _ = cv2.projectPoints(
                back,
                np.zeros(3),
                np.zeros(3),
                _matrix(entries["intrinsics"]["cam1"]["camera_matrix"]),
                np.array(entries["intrinsics"]["cam1"]["distortion_coeffs"]),
            )
            at = np.rint(pixels[:, 0]).astype(int)
            there = np.all((at >= 0) & (at < [record["depth"].shape[1], record["depth"].shape[0]]), 1)
            truth = record["depth"][at[there, 1], at[there, 0]]
            # A step of disparity is 1/256 pixel; the median is free of the outlines of objects.
            error = np.abs(back[there, 2] / truth - 1)
            worst.add(
                "DSEC: depth by OpenCV from disparity, median relative error",
                np.median(error[np.isfinite(error)]),
                2e-3,
            )
    flows = sorted((folder / "flow/forward").glob("*.png")) if (folder / "flow").is_dir() else []
    for path in flows:
        coded = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[..., ::-1].astype(float)
        worst.add("DSEC: type of flow", float(coded.shape[-1] != 3), 0)
        valid = coded[..., 2] == 1
        worst.add("DSEC: pixels without flow, share", 1 - valid.mean(), 0.05)


def check_tonic(out, data, names, worst):
    """tonic knows the recordings of DSEC by name, in folders of its own, which links make here."""
    import imageio
    import numpy as np
    import tonic

    imageio.plugins.freeimage.download = lambda *a, **k: None  # tonic falls back to pypng
    sequence = data.sequences[0]
    folder = (out / sequence.path.name).resolve()
    recording = "zurich_city_01_a"
    root = out.parent / f"{out.name}_tonic" / "DSEC" / recording
    places = {
        "events_left": "events/left",
        "images_rectified_left": "images/left/rectified",
        "disparity_image": "disparity/image",
        "optical_flow_forward_event": "flow/forward",
    }
    files = {
        "image_timestamps": "images/timestamps.txt",
        "disparity_timestamps": "disparity/timestamps.txt",
        "optical_flow_forward_timestamps": "flow/forward_timestamps.txt",
    }
    root.mkdir(parents=True)
    for key, place in places.items():
        if (folder / place).exists():
            (root / key).symlink_to(folder / place)
    for key, place in files.items():
        if (folder / place).exists():
            (root / key).mkdir()
            (root / key / f"{recording}_{key}.txt").symlink_to(folder / place)
    targets = [k for k in [*places, *files] if ("disparity" in k or "flow" in k) and (root / k).exists()]
    reader = tonic.datasets.DSEC(
        str(root.parents[1]),
        recording,
        ["events_left", "images_rectified_left", "image_timestamps"],
        target_selection=targets or None,
    )
    (events, pictures, times), found = reader[0]
    wanted = sequence[names["events_left"]].events()
    got = events["events_left"]
    worst.add("tonic: events", abs(len(got) - len(wanted)), 0)
    for key, value in (("x", wanted.x), ("y", wanted.y), ("t", wanted.t // 1000), ("p", wanted.p)):
        worst.add("tonic: values of events", np.abs(got[key].astype(int) - value.astype(int)), 0)
    worst.add("tonic: pictures", abs(len(pictures) - len(times)), 0)
    by_name = dict(zip(targets, found))
    if "optical_flow_forward_event" in by_name:
        flow = by_name["optical_flow_forward_event"]
        camera = sequence[sequence[names["events_left"]].metadata["camera"]]
        worst.add("tonic: flows", abs(len(flow) - (len(camera) - 1)), 0)
        valid = flow[0][..., 2] == 1
        # Behind a lens the flow differs little from that of the picture.
        truth = np.nanmedian(camera.record(0)["flow"], axis=(0, 1))
        worst.add("tonic: median flow, pixels", np.abs(np.median(flow[0][valid][:, :2], axis=0) - truth), 0.5)
        begin, end = by_name["optical_flow_forward_timestamps"][0]
        worst.add("tonic: times of a flow, us", abs(end - begin - 66666), 1)


def check_carrada(name, data, out, worst):
    """Does the steps of MVRSS' loader: lists of annotated frames, maps of three views, masks by label."""
    import numpy as np
    from greatx.convert.radar import write_carrada

    camera = next(n for n, s in data.sensors.items() if s.kind == "camera" and "box_center" in s.arrays)
    write_carrada(data, out, camera=camera, classes={"vehicle": "car", "uav": "cyclist"})
    reference = json.loads((out / "data_seq_ref.json").read_text())
    light = json.loads((out / "light_dataset_frame_oriented.json").read_text())
    radar = next(n for n, s in data.sensors.items() if s.kind == "radar")
    for sequence in data.sequences:
        worst.add("CARRADA: splits", float(reference[sequence.path.name]["split"] != "Train"), 0)
        folder = out / sequence.path.name
        shapes = {"range_doppler": sequence[radar].arrays["range_doppler"].shape}
        shapes["range_angle"] = sequence[radar].arrays["range_azimuth"].shape
        shapes["angle_doppler"] = (shapes["range_angle"][1], shapes["range_doppler"][1])
        for frame in light[sequence.path.name]:
            for view, shape in shapes.items():
                for form in ("raw", "processed"):
                    matrix = np.load(folder / f"{view}_{form}" / f"{frame}.npy")
                    worst.add("CARRADA: shapes of maps", float(matrix.shape != shape), 0)
                    worst.add("CARRADA: values that are not finite", np.sum(~np.isfinite(matrix)), 0)
            for form in ("sparse", "dense"):
                for view in ("range_doppler", "range_angle"):
                    mask = np.load(folder / "annotations" / form / frame / f"{view}.npy")
                    worst.add("CARRADA: shapes of masks", float(mask.shape != (4, *shapes[view])), 0)
                    worst.add("CARRADA: cells without one label", np.sum(mask.sum(axis=0) != 1), 0)
            # A point is at a peak of the map: no neighbour is 1 dB above it.
            mask = np.load(folder / "annotations/sparse" / frame / "range_doppler.npy")
            matrix = np.load(folder / "range_doppler_processed" / f"{frame}.npy")
            for row, column in zip(*np.nonzero(1 - mask[0])):
                near = matrix[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2]
                worst.add("CARRADA: a neighbour above a point, dB", near.max() - matrix[row, column], 1.0)


def check_radial(name, data, out, worst):
    """Does the steps of RADIal's loader, but for the mask of free space."""
    import numpy as np
    from greatx.convert.radar import write_radial
    from PIL import Image

    camera = next(n for n, s in data.sensors.items() if s.kind == "camera" and "box_center" in s.arrays)
    radar = next(n for n, s in data.sensors.items() if s.kind == "radar")
    write_radial(data, out, camera=camera, classes=("vehicle", "uav"))
    with open(out / "labels.csv", newline="") as file:
        header, *rows = list(csv.reader(file))
    worst.add("RADIal: columns", abs(len(header) - 17), 0)
    labels = np.array(rows, dtype=object)
    numbers = np.unique(labels[:, 0].astype(int))
    count = sum(len(sequence[radar]) for sequence in data.sequences)
    worst.add("RADIal: samples", abs(len(numbers) - count), 0)
    for sample in numbers:
        mine = labels[labels[:, 0].astype(int) == sample]
        boxes = mine[:, 1:-3].astype(np.float32)
        worst.add("RADIal: numbers of a label", abs(boxes.shape[1] - 13), 0)
        spectra = np.load(out / "radar_FFT" / f"fft_{sample:06d}.npy", allow_pickle=True)
        both = np.concatenate([spectra.real, spectra.imag], axis=2)
        worst.add("RADIal: channels", float(both.shape[2] % 2 or both.ndim != 3), 0)
        points = np.load(out / "radar_PCL" / f"pcl_{sample:06d}.npy", allow_pickle=True)[[5, 6, 7], :]
        worst.add("RADIal: coordinates of radar points", abs(points.shape[0] - 3), 0)
        laser = np.load(out / "laser_PCL" / f"pcl_{sample:06d}.npy", allow_pickle=True)[:, :3]
        worst.add("RADIal: coordinates of LiDAR points", abs(laser.shape[1] - 3), 0)
        picture = np.asarray(Image.open(out / "camera" / f"image_{sample:06d}.jpg"))
        sequence = next(s for s in data.sequences if s.path.name == mine[0, 14])
        truth = sequence[camera].at(int(sequence[radar].ticks[int(mine[0, 15])]))["rgb"]
        worst.add("RADIal: pictures, mean of the levels", np.abs(picture.astype(int) - truth).mean(), 3)
