# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""radar_points.py FOLDER: computes the beat signal of point targets before an FMCW radar from the transmitted
phase, and compares a cube with it.

The reference uses no expansion. It evaluates the phase of the oscillator at the time of a sample and at the
time at which the wave that arrives then was transmitted: earlier by twice the distance of the point at that
sample, divided by c. Waves are plane over the elements; their direction is that of the point in the middle of
the frame.
"""
import pathlib
import sys

import numpy as np

C = 299792458.0
folder = pathlib.Path(sys.argv[1])


def read(name, dtype=np.float64):
    return np.fromfile(folder / name, dtype)


carrier, slope, rate, adc_start, interval, samples, slots, transmitters, receivers, power = read("radar.bin")
samples, slots, transmitters, receivers = int(samples), int(slots), int(transmitters), int(receivers)
elements = read("elements.bin").reshape(-1, 3)
sent_from, received_at = elements[:transmitters], elements[transmitters:]
points = read("points.bin").reshape(-1, 8)
cube = read("cube.bin", np.complex64).reshape(receivers, transmitters, slots // transmitters, samples)

# Frequency at the start of the ramp, which passes the carrier when half of the samples are taken.
start_hz = carrier - slope * (adc_start + (samples // 2) / rate)
frame_middle = (slots - 1) / 2 * interval + adc_start + (samples // 2) / rate


def oscillator_turns(since_ramp):
    return start_hz * since_ramp + slope * since_ramp**2 / 2


expected = np.zeros(cube.shape, np.complex128)
since_ramp = adc_start + np.arange(samples) / rate
for x, y, z, vx, vy, vz, amplitude, phase in points:
    start, velocity = np.array([x, y, z]), np.array([vx, vy, vz])
    middle = start + velocity * frame_middle
    toward = middle / np.linalg.norm(middle)
    for slot in range(slots):
        transmitter, chirp = slot % transmitters, slot // transmitters
        position = start + np.multiply.outer(slot * interval + since_ramp, velocity)
        way = 2 * np.linalg.norm(position, axis=1)
        for receiver in range(receivers):
            delay = (way - toward @ (sent_from[transmitter] + received_at[receiver])) / C
            turns = oscillator_turns(since_ramp) - oscillator_turns(since_ramp - delay)
            received = amplitude * np.exp(
                1j * phase
            )  # with e^{+j omega t}; the mixer conjugates the received signal
            expected[receiver, transmitter, chirp] += (
                np.sqrt(power) * np.conj(received) * np.exp(2j * np.pi * turns)
            )

scale = np.sqrt(power) * points[:, 6].sum()
fault = np.abs(cube - expected).max() / scale
print(f"largest difference {fault:.2e} of the sum of amplitudes")
sys.exit(0 if fault < 2e-5 else 1)
