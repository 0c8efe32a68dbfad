#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a small rig for very many ticks and checks that nothing grows and nothing drifts.

    python3 tests/soak/soak.py --program build/release/greatx --ticks 100000

A terminal goes round a square of 40 m, once in 4 s, on level ground under a mast, for the whole run. Then
- memory: the resident set, sampled all the way, grows by the rows of the index and of the consistency table
  and by nothing else. Both are kept until their sequence ends: 40 bytes a record, some 150 a comparison.
  The medians of the fifth and of the last tenth differ by less than --growth bytes for each tick between
  them, plus 2 MiB for the allocator.
- drift: c times the delay of the line of sight is the distance of the antennas at every tick, in closed form,
  and the ground's reflection has the length of its image: 1e-9 m and the rounding of the terminal's place.
  Every time of the index is tick / rate, to the nanosecond.
- files: `greatx verify` finds everything whole.
Exit code 0: all of that; 1: a fault, which is printed.
"""
import argparse
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

RATE_HZ = 10
C = 299792458.0
CORNERS = [(10.0, 10.0), (-10.0, 10.0), (-10.0, -10.0), (10.0, -10.0)]
MAST, HEIGHT = (3.0, 2.0, 25.0), 1.5

SCENARIO = """greatx: 1
name: soak
seed: 1
ticks: {ticks}
tick_rate_hz: {rate}
scene: {{file: ground.gltf, origin_m: [0, 0, 0]}}
nodes:
  - name: mast
    trajectory: {{type: static, position_m: [3, 2, 25]}}
    sensors: [{{name: antenna, type: antenna}}]
  - name: walker
    trajectory: {{type: waypoints, csv: walk.csv, interpolation: linear}}
    sensors:
      - {{name: antenna, type: antenna}}
      - {{name: camera, type: camera, rate_hz: 1/10, width: 16, height: 12, fov_deg: 90,
          outputs: [rgb, depth]}}
      - {{name: lidar, type: lidar, rate_hz: 1/10, channels: 2, elevation_min_deg: -30,
          elevation_max_deg: -10, azimuth_steps: 16}}
channels:
  - {{name: csi, tx: mast/antenna, rx: [walker/antenna], rate_hz: {rate}, carrier_hz: 3.5e9,
      bandwidth_hz: 20e6, subcarriers: 4, max_depth: 1, outputs: [cfr, paths]}}
"""

GROUND = """{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"mesh": 0, "name": "ground"}}],
"materials": [{{"name": "itu_concrete"}}],
"meshes": [{{"name": "ground", "primitives":
  [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}}],
"accessors": [
 {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
  "min": [-64, 0, -64], "max": [64, 0, 64]}},
 {{"bufferView": 1, "componentType": 5125, "count": 6, "type": "SCALAR"}}],
"bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": 48}},
 {{"buffer": 0, "byteOffset": 48, "byteLength": 24}}],
"buffers": [{{"byteLength": 72, "uri": "ground.bin"}}]}}
"""


def write_inputs(folder, ticks):
    """Writes the scenario, the ground and the way of the terminal, which goes on beyond the last tick."""
    (folder / "soak.yaml").write_text(SCENARIO.format(ticks=ticks, rate=RATE_HZ))
    (folder / "ground.gltf").write_text(GROUND.format())
    corners = np.array([[-64, 0, -64], [64, 0, -64], [64, 0, 64], [-64, 0, 64]], "<f4")
    (folder / "ground.bin").write_bytes(corners.tobytes() + np.array([0, 2, 1, 0, 3, 2], "<u4").tobytes())
    with open(folder / "walk.csv", "w", encoding="utf-8") as way:
        way.write("t_s,x_m,y_m,z_m\n")
        for second in range(ticks // RATE_HZ + 2):
            x, y = CORNERS[second % 4]
            way.write(f"{second},{x},{y},{HEIGHT}\n")


def place(tick):
    """Returns where the terminal is at a tick, in closed form."""
    second, part = divmod(tick, RATE_HZ)
    (x0, y0), (x1, y1) = CORNERS[second % 4], CORNERS[(second + 1) % 4]
    share = part / RATE_HZ
    return x0 + share * (x1 - x0), y0 + share * (y1 - y0)


def run(program, folder, ticks, growth):
    """Runs the scenario and returns the faults of its memory."""
    environment = dict(os.environ, GREATX_CACHE="off")
    command = [program, "generate", str(folder / "soak.yaml"), "-o", str(folder / "out"), "-q"]
    samples = []
    with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL) as process:
        while process.poll() is None:
            try:
                status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
                samples.append(int(status.split("VmRSS:")[1].split()[0]) / 1024.0)
            except (IndexError, OSError):
                pass
            time.sleep(0.02)
    if process.returncode != 0:
        return [f"exit code {process.returncode}"]
    tenth = max(1, len(samples) // 10)
    tenths = [statistics.median(samples[i * tenth : (i + 1) * tenth]) for i in range(10)]
    print(
        f"memory, MiB, median of each tenth of {len(samples)} samples: {' '.join(f'{m:.1f}' for m in tenths)}"
    )
    grown, most = tenths[9] - tenths[4], 2.0 + growth * ticks / 2 / (1 << 20)
    print(
        f"memory has grown by {grown:.1f} MiB from the fifth tenth to the last, at most {most:.1f} expected"
    )
    if grown > most:
        return [f"memory has grown by {grown:.1f} MiB, expected at most {most:.1f}"]
    return []


def check_drift(folder, ticks):
    """Returns the faults of delays and times."""
    paths = folder / "out/sequence_0000/csi/paths"
    delays, offsets = np.load(paths / "delay.npy"), np.load(paths / "delay_offsets.npy")
    faults = []
    if len(offsets) != ticks + 1:
        faults.append(f"{len(offsets) - 1} records, expected {ticks}")
    worst = 0.0
    for tick in range(len(offsets) - 1):
        lengths = np.sort(C * delays[offsets[tick] : offsets[tick + 1]])
        x, y = place(tick)
        run_m = math.hypot(x - MAST[0], y - MAST[1])
        expected = [math.hypot(run_m, MAST[2] - HEIGHT), math.hypot(run_m, MAST[2] + HEIGHT)]
        if len(lengths) != 2:
            return faults + [f"tick {tick}: {len(lengths)} paths, expected 2"]
        worst = max(worst, *np.abs(lengths - expected))
    # A time of 1e4 s has a rounding of 2e-12 s, in which the terminal goes 4e-11 m.
    bound = 1e-9 + 20.0 * 4.0 * np.finfo(float).eps * ticks / RATE_HZ
    print(f"drift: {worst:.2e} m at most over {ticks} ticks (bound {bound:.2e} m)")
    if worst > bound:
        faults.append(f"lengths are wrong by {worst} m")
    index = np.load(folder / "out/sequence_0000/index.npy")  # tick, time_ns, sensor, sample, row
    if index[-1, 0] != ticks - 1:
        faults.append(f"the last tick of the index is {index[-1, 0]}, expected {ticks - 1}")
    wrong = int(np.count_nonzero(index[:, 1] * RATE_HZ != index[:, 0] * 1_000_000_000))
    if wrong > 0:
        faults.append(f"{wrong} rows of the index are not at tick / rate")
    return faults


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--program", required=True)
    parser.add_argument("--ticks", type=int, default=100_000)
    parser.add_argument("--growth", type=float, default=300.0, help="bytes a tick that memory may grow")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="greatx_soak_") as name:
        folder = pathlib.Path(name)
        write_inputs(folder, options.ticks)
        begin = time.monotonic()
        faults = run(options.program, folder, options.ticks, options.growth)
        print(f"{options.ticks} ticks in {time.monotonic() - begin:.0f} s")
        if not faults:
            faults = check_drift(folder, options.ticks)
        if not faults:
            verified = subprocess.run(
                [options.program, "verify", str(folder / "out")], capture_output=True, text=True, check=False
            )
            if verified.returncode != 0:
                faults.append(f"verify: {verified.stdout}{verified.stderr}")
    for fault in faults:
        print(f"FAULT: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
