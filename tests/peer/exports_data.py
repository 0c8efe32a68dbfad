# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Lets the tools themselves read what `greatx.convert` writes for h5py, webdataset, evo, tonic and
DSEC's conventions, RADIal and CARRADA, and lets Open3D read a LiDAR's PLY; compares with the data set.

    python3 tests/peer/exports_data.py [--scenes FOLDER]

It prints the largest difference of each kind beside its bound, and exits with 1 if one exceeds it.
"""

import json
import pathlib
import sys

from environment import Worst
from exports_setup import main

PACKAGES = (
    "numpy<2",
    "h5py==3.14.0",
    "webdataset==0.2.111",
    "evo==1.31.1",
    "tonic==1.7.0",
    "imageio==2.37.0",
    "pypng==0.20220715.0",
    "pillow",
    "pyyaml",
    "opencv-python-headless==4.11.0.86",
    "open3d==0.19.0",
)


def check_open3d(name, data, worst):
    """Open3D's tensor reader keeps every property of a LiDAR's PLY."""
    import open3d

    for sequence in data.sequences:
        for sensor in sequence.sensors.values():
            if sensor.kind != "lidar" or "cloud" not in sensor:
                continue
            for record in sensor:
                cloud = open3d.t.io.read_point_cloud(str(sensor["cloud"].path(record.row)))
                worst.differs("Open3D: positions", cloud.point["positions"].numpy(), record.points[:, :3])
                for array, info in sensor.arrays.items():
                    if array == "points":
                        continue
                    worst.add("Open3D: properties that it drops", float(array not in cloud.point), 0)
                    found = cloud.point[array].numpy()[:, 0]
                    wanted = record[array]
                    kind = "int32" if info.dtype.str == "<u4" else info.dtype.name
                    worst.add("Open3D: types", float(found.dtype.name != kind), 0)
                    worst.differs("Open3D: properties", found.astype(info.dtype), wanted)


def check_hdf5(name, data, out, worst):
    import h5py
    from greatx.convert.hdf5 import write_hdf5

    write_hdf5(data, out)
    with h5py.File(out) as file:
        for sequence in data.sequences:
            for sensor in sequence.sensors.values():
                group = file[sequence.path.name][sensor.name]
                for array in sensor.arrays:
                    stored = group[array]
                    offsets = group[stored.attrs["offsets"]][:] if "offsets" in stored.attrs else None
                    for i in range(len(sensor)):
                        part = stored[i] if offsets is None else stored[offsets[i] : offsets[i + 1]]
                        worst.differs("h5py", part, sensor[array][i])


def check_webdataset(name, data, out, worst):
    import webdataset
    from greatx.convert.webdataset import write_webdataset

    write_webdataset(data, out, shard_mb=4)
    shards = sorted(str(p) for p in out.glob("*.tar"))
    ticks = [tick for sequence in data.sequences for tick in sequence]
    for decoded in (True, False):
        stream = webdataset.WebDataset(shards, shardshuffle=False, empty_check=False)
        samples = list(stream.decode("rgb8") if decoded else stream)
        worst.add("webdataset: samples", abs(len(samples) - len(ticks)), 0)
        for sample, tick in zip(samples, ticks):
            about = sample["json"] if decoded else json.loads(sample["json"])
            worst.add("webdataset: ticks", abs(about["tick"] - tick.tick), 0)
            for sensor, record in tick.items():
                for array in record.sensor.arrays:
                    member = f"{sensor.replace('/', '.')}.{array}"
                    if decoded and member + ".npy" in sample:
                        worst.differs("webdataset: .npy", sample[member + ".npy"], record[array])
                    if decoded and array == "rgb":
                        worst.differs("webdataset: pictures", sample[member + ".png"], record[array])


def check_trajectories(name, data, out, worst):
    import numpy as np
    from evo.core import lie_algebra, metrics, sync
    from evo.tools import file_interface
    from greatx.convert.euroc import write_euroc
    from greatx.convert.trajectories import write_tum
    from greatx.links import rotation

    write_tum(data, out / "tum")
    write_euroc(data, out / "euroc")
    node = next(n.split("/")[0] for n, s in data.sensors.items() if s.kind == "camera")
    for sequence in data.sequences:
        number = sequence.poses.metadata["nodes"].index(node)
        folder = out / "euroc" / sequence.path.name / "mav0"
        tum = file_interface.read_tum_trajectory_file(str(out / "tum" / sequence.path.name / f"{node}.txt"))
        euroc = file_interface.read_euroc_csv_trajectory(str(folder / "state_groundtruth_estimate0/data.csv"))
        for path in (tum, euroc):
            worst.add("evo: times, s", np.abs(path.timestamps - sequence.poses.index[:, 1] * 1e-9), 1e-9)
            worst.add("evo: positions, m", np.abs(path.positions_xyz - sequence.poses.position[:, number]), 0)
            wanted = rotation(sequence.poses.orientation[:, number])
            found = np.array(path.poses_se3)[:, :3, :3]
            worst.add("evo: rotations", np.abs(found - wanted), 1e-12)
            worst.add("evo: poses that are none", float(not path.check()[0]), 0)
        error = metrics.APE(metrics.PoseRelation.full_transformation)
        error.process_data(sync.associate_trajectories(tum, euroc))
        worst.add(
            "evo: absolute pose error of one against the other",
            error.get_statistic(metrics.StatisticsType.max),
            1e-9,
        )
        assert lie_algebra.is_se3(euroc.poses_se3[0])


def main_check(folder, data_sets, program):
    import greatx
    from exports_folders import check_carrada, check_dsec, check_radial

    worst = Worst()
    for name, path in data_sets.items():
        data = greatx.load(path)
        check_open3d(name, data, worst)
        check_hdf5(name, data, folder / f"{name}.h5", worst)
        check_webdataset(name, data, folder / f"{name}_webdataset", worst)
        check_trajectories(name, data, folder / f"{name}_trajectories", worst)
        check_dsec(name, data, folder / f"{name}_dsec", worst)
        check_carrada(name, data, folder / f"{name}_carrada", worst)
        check_radial(name, data, folder / f"{name}_radial", worst)
        sizes = {
            p.name: sum(f.stat().st_size for f in [p, *p.rglob("*")] if f.is_file()) for p in folder.iterdir()
        }
        print(name, {key: value for key, value in sorted(sizes.items()) if key.startswith(name)})
    return 1 if worst.failed() else 0


if __name__ == "__main__":
    sys.path.insert(0, str(pathlib.Path(__file__).parent))
    sys.exit(main(__file__, main_check, "exports_data", PACKAGES))
