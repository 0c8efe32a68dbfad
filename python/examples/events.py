# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the events of an event camera, and makes a picture of 10 ms and a tensor for a network of them.

    greatx generate scenario.yaml -o out/events        # with a sensor of type event_camera
    python3 python/examples/events.py out/events

Writes events.ppm.
"""
import pathlib
import sys

import numpy as np

import greatx

# %% Load the stream as views of the files: t in nanoseconds since the sequence's first tick, ascending
greatx.print_errors_plainly()
if len(sys.argv) != 2:
    sys.exit(__doc__)
ds = greatx.load(sys.argv[1])
camera = ds.sequences[0].first("event_camera", ["t", "x", "y", "p"])
events = camera.events()
duration_s = max(camera.times_s[-1] - camera.times_s[0], 1e-9)
print(
    f"{camera.name}: {len(events)} events, {len(events) / duration_s / 1e6:.2f} million a second, "
    f"{100 * np.mean(events.p):.0f} % brighter, {int(camera.dropped.sum())} left out"
)

# %% Find the record with the most events: a record holds the events since the record before
counts = np.diff(camera["t"].offsets)
busiest = int(np.argmax(counts))
record = camera.record(busiest)
print(
    f"record {busiest} at {record.time_s:g} s is the busiest: {counts[busiest]} events "
    f"in {record.pictures} sub-steps"
)

# %% Draw a picture of 10 ms: red pixels got brighter, blue ones darker
moment = events.between(record.time_ns - 10_000_000, record.time_ns)
picture = moment.picture()
pathlib.Path("events.ppm").write_bytes(b"P6 %d %d 255\n" % picture.shape[1::-1] + picture.tobytes())
print(f"events.ppm: {len(moment)} events on {picture.shape[1]} x {picture.shape[0]} pixels")

# %% Make a voxel grid: float32 [bin, row, column]
grid = record.events().voxel_grid(5)
print(f"voxel grid {grid.shape} {grid.dtype}, sum {grid.sum():.1f}")
try:
    import torch
except ImportError:
    print("no torch (pip install torch): the grid stays an array")
else:
    print(torch.from_numpy(grid)[None].shape, "is a batch of one")

# %% Count the events by the instance that their pixel saw
if events.instance is not None:
    ids, of_each = np.unique(events.instance, return_counts=True)
    for i in np.argsort(-of_each)[:5]:
        name = ds.instances[ids[i] - 1]["name"] if ids[i] else "sky"
        print(f"  {of_each[i]:8} {name}")
