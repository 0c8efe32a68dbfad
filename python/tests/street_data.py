# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""A small data set like the campaign `street`, for the tests of the tasks that use it."""
import contextlib
import io
import pathlib
import sys
import unittest.mock

import support

# A car drives behind a bus in a street, eight times.
TINY = """
greatx: 1
name: tiny_street
seed: 3
ticks: 12
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 9, size_m: 60}}
environment: {clouds: 0}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [5.5, 0, 3], rotation_deg: [180, 0, 0]}
    sensors:
      - {name: view, type: camera, rate_hz: 10, width: 48, height: 24, fov_deg: 120, outputs: [rgb]}
      - {name: lidar, type: lidar, rate_hz: 10, channels: 8, elevation_min_deg: -35, elevation_max_deg: 3,
         azimuth_steps: 32, azimuth_start_deg: 70, azimuth_span_deg: -140, outputs: [points]}
      - {name: events, type: event_camera, rate_hz: 10, width: 32, height: 16, fov_deg: 120, steps: 1}
      - name: radar
        type: radar
        rate_hz: 10
        waveform: {bandwidth_hz: 200e6, samples: 64, sample_rate_hz: 6.25e6, adc_start_s: 1.5e-6,
                   chirp_s: 12e-6, interval_s: 13e-6, chirps: 16}
        transmit: {pattern: tr38901, columns: 1}
        receive: {pattern: tr38901, columns: 4}
        echoes: {tubes: 500, max_bounces: 1}
        processing: {azimuths: 16}
        receiver: {noise_figure_db: 12}
        outputs: [range_doppler, range_azimuth]
      - {name: panel, type: antenna, columns: 8}
  - name: car
    trajectory: {type: bezier, box: {min_m: [-4, -12, 0], max_m: [-3.5, 12, 0]}}
    model: {generate: {kind: car}}
    class: vehicle
    sensors: [{name: antenna, type: antenna, mount: {position_m: [0, 0, 1.6]}}]
  - name: bus
    trajectory: {type: bezier, box: {min_m: [1.5, -12, 0], max_m: [2, 12, 0]}}
    model: {generate: {kind: car, variant: van}, scale: [1.6, 1, 1.45]}
    class: vehicle
channels:
  - {name: csi, tx: bs/panel, rx: [car/antenna], rate_hz: 10, carrier_hz: 28e9, bandwidth_hz: 100e6,
     subcarriers: 4, max_depth: 1, outputs: [cfr]}
"""


def tiny() -> pathlib.Path:
    """Returns the folder of a data set of TINY with eight sequences, which tests must not change."""
    return support.made("tiny_street", TINY, "--sequences", "8")


def run_task(run, *arguments) -> str:
    """Runs a task with a command line, and returns what it prints."""
    printed = io.StringIO()
    line = ["task", *map(str, arguments)]
    with unittest.mock.patch.object(sys, "argv", line), contextlib.redirect_stdout(printed):
        run()
    return printed.getvalue()
