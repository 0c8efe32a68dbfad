# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes data sets for the tests by the program that GREATX_PROGRAM names, and one data set by hand."""
import atexit
import functools
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

C = 299792458.0

# A street with two panels, two receivers, time samples with Doppler, and a camera and a LiDAR at half the
# rate. Without beam_squint the response is the sum of e^{-j 2 pi f tau} over the paths.
STREET = """
greatx: 1
name: street
ticks: 4
tick_rate_hz: 20
scene: {generate: {kind: canyon, seed: 9, size_m: 120}}
environment: {clouds: 0}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [6.3, -21.7, 9.4], rotation_deg: [90, 0, 0]}
    sensors: [{name: panel, type: antenna, polarization: slant, rows: 1, columns: 2}]
  - name: corner
    trajectory: {type: static, position_m: [-6.3, 21.7, 7], rotation_deg: [-90, 0, 0]}
    sensors: [{name: panel, type: antenna, polarization: slant, rows: 1, columns: 2}]
  - name: car
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2.4, -30, 0]}, \
{t_s: 1, position_m: [2.4, -20, 0]}]}
    model: {generate: {kind: car, variant: hatchback}}
    class: vehicle
    sensors:
      - {name: front, type: camera, rate_hz: 10, width: 31, height: 24, fov_deg: 90,
         outputs: [rgb, depth, ids, hdr, depth_png24], mount: {position_m: [1.2, 0, 1.4]}}
      - {name: lidar, type: lidar, rate_hz: 10, channels: 8, elevation_min_deg: -45, elevation_max_deg: 15,
         azimuth_steps: 64, max_range_m: 150, mount: {position_m: [0, 0, 2]}, \
outputs: [points, ply, pcd, kitti]}
      - {name: antenna, type: antenna, mount: {position_m: [0, 0, 1.6]}}
  - name: walker
    trajectory: {type: static, position_m: [-5, 20, 1.5]}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: [bs/panel, corner/panel], rx: [car/antenna, walker/antenna], rate_hz: 20, \
carrier_hz: 3.5e9,
     bandwidth_hz: 100e6, subcarriers: 64, time_samples: 3, time_spacing_s: 1e-3, max_depth: 2}
effects: {beam_squint: off}
"""

# A van that follows a car, with all kinds of ground truth of a camera.
TRUTH = """
greatx: 1
name: truth
ticks: 3
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 9, size_m: 80}, optical_only: true}
environment: {clouds: 0}
nodes:
  - name: van
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2.4, -30, 0]}, \
{t_s: 1, position_m: [2.2, -20, 0]}]}
    model: {generate: {kind: car, variant: van}}
    sensors:
      - {name: front, type: camera, rate_hz: 10, width: 62, height: 48, fov_deg: 80, \
mount: {position_m: [1.5, 0, 1.8]},
         outputs: [rgb, depth, ids, depth_ray, normals, flow, boxes]}
  - name: car
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2, -20, 0]}, \
{t_s: 1, position_m: [2, -9, 0]}]}
    model: {generate: {kind: car}}
    class: vehicle
"""

# A turning event camera with all outputs.
EVENTS = """
greatx: 1
name: events
ticks: 100
tick_rate_hz: 1000
scene: {generate: {kind: canyon, seed: 9, size_m: 80}, optical_only: true}
environment: {clouds: 0}
nodes:
  - name: car
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2.4, -30, 1.5], rotation_deg: [90, 0, 0]},
                                           {t_s: 0.1, position_m: [2.4, -29, 1.5], rotation_deg: [95, 0, 0]}]}
    sensors:
      - {name: dvs, type: event_camera, rate_hz: 30, width: 62, height: 48, fov_deg: 80, steps: 4,
         noise: {shot_rate_hz: 5}, outputs: [events, differences, hdf5, text, instance], \
difference: {on: 0.02, off: 0.02}}
"""

# All kinds of sensors on a car that turns, asymmetric in every axis, at times that are no whole microseconds.
# Its event cameras have the pixels of a camera with distortion and look beside each other.
RIG = """
greatx: 1
name: rig
ticks: 4
tick_rate_hz: 30
scene:
  generate: {kind: canyon, seed: 9, size_m: 80}
  georeference: {latitude_deg: 52.0116, longitude_deg: 4.3571, height_m: 45, undulation_m: 43.4, \
vertical_datum: NAP}
environment: {clouds: 0}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [6.3, -21.7, 9.4], rotation_deg: [90, 0, 0]}
    sensors: [{name: panel, type: antenna, polarization: slant}]
  - name: car
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2.4, -30, 0], rotation_deg: [90, 2, 1]}, \
{t_s: 1, position_m: [3.4, -18, 0.5], rotation_deg: [110, -2, 4]}]}
    model: {generate: {kind: car}}
    class: vehicle
    sensors:
      - {name: front, type: camera, rate_hz: 15, width: 62, height: 48, fov_deg: 80,
         mount: {position_m: [1.5, 0.2, 1.6], rotation_deg: [3, 5, 1]}, \
distortion: {k1: -0.2, k2: 0.05, p1: 0.003, p2: -0.002}, outputs: [rgb, depth, ids, flow, boxes]}
      - {name: right, type: camera, rate_hz: 15, width: 62, height: 48, fov_deg: 80, \
mount: {position_m: [1.55, -0.2, 1.65], rotation_deg: [1, 4, 0]}, outputs: [rgb]}
      - {name: dvs, type: event_camera, camera: front, rate_hz: 15, steps: 2, outputs: [events, hdf5]}
      - {name: dvs2, type: event_camera, camera: right, rate_hz: 15, steps: 1, outputs: [events]}
      - {name: lidar, type: lidar, rate_hz: 15, channels: 8, elevation_min_deg: -45, elevation_max_deg: 15,
         azimuth_steps: 64, max_range_m: 150, mount: {position_m: [0, 0, 2], rotation_deg: [10, 0, 2]}, \
outputs: [ply]}
      - name: radar
        type: radar
        rate_hz: 15
        mount: {position_m: [2, 0.1, 0.6], rotation_deg: [-4, 0, 0]}
        waveform: {bandwidth_hz: 300e6, samples: 64, sample_rate_hz: 6.25e6, adc_start_s: 1.5e-6, \
chirp_s: 12e-6, interval_s: 13e-6, chirps: 32}
        transmit: {pattern: tr38901, columns: 2, column_spacing_wl: 2}
        receive: {pattern: tr38901, columns: 4}
        echoes: {tubes: 1500}
        outputs: [range_doppler, range_azimuth, detections, cube]
        receiver: {noise_figure_db: 12}
      - {name: antenna, type: antenna, mount: {position_m: [0, 0, 1.6]}}
  - name: van
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2, -20, 0]}, \
{t_s: 1, position_m: [2, -9, 0]}]}
    model: {generate: {kind: car, variant: van}}
    class: vehicle
channels:
  - {name: csi, tx: bs/panel, rx: [car/antenna], rate_hz: 30, carrier_hz: 3.5e9, bandwidth_hz: 100e6, \
subcarriers: 32, max_depth: 1}
"""

# Two antennas in free space, for which closed forms exist. The second one moves away. The data set has two
# sequences.
SPACE = """
greatx: 1
name: space
ticks: 3
tick_rate_hz: 10
nodes:
  - name: bs
    trajectory: {type: static, position_m: [0, 0, 10], rotation_deg: [30, 0, 0]}
    sensors: [{name: antenna, type: antenna}]
  - name: uav
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [30, 40, 10]}, \
{t_s: 1, position_m: [60, 80, 10]}]}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: bs/antenna, rx: [uav/antenna], rate_hz: 10, carrier_hz: 3.5e9, bandwidth_hz: 20e6, \
subcarriers: 8}
"""


@functools.lru_cache(maxsize=None)
def _folder() -> pathlib.Path:
    folder = tempfile.mkdtemp(prefix="greatx_python_")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return pathlib.Path(folder)


def scenario_file(name: str, text: str) -> pathlib.Path:
    """Writes a scenario to a file and returns its path."""
    path = _folder() / f"{name}.yaml"
    path.write_text(text)
    return path


@functools.lru_cache(maxsize=None)
def made(name: str, text: str, *arguments: str) -> pathlib.Path:
    """Returns the folder of a data set of a scenario, which tests must not change."""
    scenario, out = scenario_file(name, text), _folder() / name
    subprocess.run(
        [os.environ["GREATX_PROGRAM"], "generate", scenario, "-o", out, "-q", *arguments], check=True
    )
    return out


def street() -> pathlib.Path:
    """Returns the folder of a data set of STREET, which tests must not change."""
    return made("street", STREET)


def truth() -> pathlib.Path:
    """Returns the folder of a data set of TRUTH, which tests must not change."""
    return made("truth", TRUTH)


def events() -> pathlib.Path:
    """Returns the folder of a data set of EVENTS, which tests must not change."""
    return made("events", EVENTS)


def rig() -> pathlib.Path:
    """Returns the folder of a data set of RIG with two sequences, which tests must not change."""
    return made("rig", RIG, "--sequences", "2")


def space() -> pathlib.Path:
    """Returns the folder of a data set of SPACE with two sequences, which tests must not change."""
    return made("space", SPACE, "--sequences", "2")


def copy_of(folder: pathlib.Path) -> pathlib.Path:
    """Returns a copy that a test may damage."""
    out = pathlib.Path(tempfile.mkdtemp(dir=_folder())) / folder.name
    shutil.copytree(folder, out)
    return out


def edit_json(path: pathlib.Path, change) -> None:
    value = json.loads(path.read_text())
    change(value)
    path.write_text(json.dumps(value))


def two_transmitters() -> pathlib.Path:
    """Writes a data set by hand and returns its folder. It has two transmitters, three receivers, of which
    number 1 has no paths, and two ticks, of which the second has no paths.
    """
    out = pathlib.Path(tempfile.mkdtemp(dir=_folder()))
    links = np.array([[0, 0], [0, 1], [0, 1], [2, 0], [2, 0], [2, 1]], np.int32)  # rx, tx of each path
    n = len(links)
    angle = np.full((n, 2), np.pi / 2)
    paths = {
        "rx": links[:, 0].copy(),
        "tx": links[:, 1].copy(),
        "delay": 1e-7 * np.arange(1, n + 1),
        "doppler": np.zeros(n),
        "amplitude": np.full((n, 1, 1), 1e-3, np.complex64),
        "departure": angle,
        "arrival": angle,
        "transfer": (np.arange(1, n + 1)[:, None, None] * np.eye(2)).astype(np.complex64),
        "interaction": np.tile(np.array([1, 2], np.uint8), (n, 1)),
        "vertex": np.zeros((n, 2, 3)),
        "object": np.tile(np.array([1, 2], np.uint32), (n, 1)),
    }
    paths["transfer"][1, 0, 0] = 0  # path 1 has no vertical amplitude
    end = {"body_from_antenna": {"position_m": [0, 0, 1], "orientation_wxyz": [1, 0, 0, 0]}, "ports": 1}
    names = ["a", "b", "c", "d", "e"]
    meta = {
        "carrier_hz": 1e9,
        "subcarriers": 4,
        "first_subcarrier": -2,
        "subcarrier_spacing_hz": 1e6,
        "time_samples": 1,
        "time_spacing_s": 1e-3,
        "doppler_in_time_samples": False,
        "max_depth": 2,
        "walls": [],
        "transmitters": [{**end, "name": f"{name}/antenna"} for name in names[:2]],
        "receivers": [{**end, "name": f"{name}/antenna"} for name in names[2:]],
    }
    stacks = {
        "cfr": np.zeros((2, 3, 1, 2, 1, 1, 4), np.complex64),
        "path_count": np.zeros((2, 3, 2), np.int32),
    }
    position = np.zeros((2, 5, 3))
    position[:, :, 0] = np.arange(5)
    poses = {"position": position, "orientation": np.tile([1.0, 0, 0, 0], (2, 5, 1))}

    def save(name, value):
        path = out / "sequence_0000" / f"{name}.npy"
        path.parent.mkdir(parents=True, exist_ok=True)
        np.save(path, value)

    def arrays(values, rows):
        return [
            {"name": k, "dtype": v.dtype.str, "shape": [*rows, *v.shape[1:]], "unit": "1", "description": ""}
            for k, v in values.items()
        ]

    def outputs(values, kind, prefix=""):
        return [{"name": prefix + k, "format": kind, "arrays": [k]} for k in values]

    for k, v in poses.items():
        save(f"poses/{k}", v)
    for k, v in stacks.items():
        save(f"csi/{k}", v)
    for k, v in paths.items():
        save(f"csi/paths/{k}", v)
        save(f"csi/paths/{k}_offsets", np.array([0, n, n]))
    save("index", np.array([[0, 0, 0, 0, 0], [0, 0, 1, 0, 0], [5, 5000, 0, 1, 1], [5, 5000, 1, 1, 1]]))
    sensors = [
        {
            "name": "poses",
            "kind": "pose",
            "rate_hz": "",
            "arrays": arrays(poses, []),
            "outputs": outputs(poses, "npy_stack"),
            "metadata": {"nodes": names},
        },
        {
            "name": "csi",
            "kind": "csi",
            "rate_hz": "200",
            "arrays": arrays(stacks, []) + arrays(paths, [-1]),
            "outputs": outputs(stacks, "npy_stack") + outputs(paths, "npy_ragged", "paths/"),
            "metadata": meta,
        },
    ]
    info = {
        "format": "greatx-dataset",
        "format_version": 1,
        "sequences": 1,
        "tick_rate_hz": "1000",
        "sensors": sensors,
        "run": {"greatx": "0", "scenario": "hand", "materials": [], "instances": [], "semantic_classes": []},
    }
    (out / "dataset.json").write_text(json.dumps(info))
    (out / "manifest.json").write_text("{}")
    return out
