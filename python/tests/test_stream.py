# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests greatx.stream against the data set that the program writes of the same scenario."""
import importlib.util
import itertools
import json
import os
import subprocess
import sys
import threading
import unittest

import numpy as np

import greatx
from greatx.batch_reader import BatchReader, samples_of
from greatx.modalities import CsiMap, EventVoxels, Picture
import support

HAS_TORCH = importlib.util.find_spec("torch") is not None

# Flights of their own in every sequence; events, which remember, at half the rate of the channel.
FLIGHT = """
greatx: 1
name: flight
seed: 4
ticks: 6
tick_rate_hz: 20
scene: {generate: {kind: canyon, seed: 9, size_m: 80}}
environment: {clouds: 0}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [6.3, -21.7, 9.4], rotation_deg: [90, 0, 0]}
    sensors: [{name: panel, type: antenna, columns: 4}]
  - name: uav
    trajectory: {type: bezier, box: {min_m: [-3, -15, 3], max_m: [3, 15, 8]}}
    sensors:
      - {name: cam, type: camera, rate_hz: 10, width: 24, height: 16, fov_deg: 90, outputs: [rgb]}
      - {name: dvs, type: event_camera, rate_hz: 10, width: 24, height: 16, fov_deg: 90, steps: 2, \
noise: {shot_rate_hz: 20}}
      - {name: antenna, type: antenna}
channels:
  - {name: csi, tx: bs/panel, rx: [uav/antenna], rate_hz: 20, bandwidth_hz: 20e6, subcarriers: 16, \
max_depth: 1}
"""
# The channel alone, in free space, whose sequences begin at once.
LINK = """
greatx: 1
name: link
seed: 4
ticks: 6
tick_rate_hz: 20
nodes:
  - name: bs
    trajectory: {type: static, position_m: [0, 0, 10]}
    sensors: [{name: antenna, type: antenna, columns: 4}]
  - name: uav
    trajectory: {type: bezier, box: {min_m: [10, -15, 3], max_m: [30, 15, 8]}}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: bs/antenna, rx: [uav/antenna], rate_hz: 10, bandwidth_hz: 20e6, subcarriers: 16}
"""
CSI = {"csi": CsiMap("csi", 8)}
MODALITIES = {"rgb": Picture("uav/cam", 8), "csi": CsiMap("csi", 8), "events": EventVoxels("uav/dvs", 3, 8)}


def open_link(modalities=None, **options):
    return greatx.stream(support.scenario_file("link", LINK), modalities or CSI, **{"seed": 4, **options})


def open_flight(modalities=None, **options):
    file = support.scenario_file("flight", FLIGHT)
    return greatx.stream(file, modalities or MODALITIES, **{"seed": 4, **options})


def take(stream, count):
    return list(itertools.islice(stream, count))


def places(items):
    return [(item["sequence"], item["tick"]) for item in items]


class Streams(unittest.TestCase):
    def assert_same(self, one, two):
        self.assertEqual(len(one), len(two))
        for a, b in zip(one, two):
            self.assertEqual(a.keys(), b.keys())
            for name in a:
                np.testing.assert_array_equal(a[name], b[name], name)

    def test_the_items_are_those_of_the_data_set(self):
        ds = greatx.load(support.made("flight", FLIGHT, "--sequences", "3"))
        reader = BatchReader(samples_of(ds, MODALITIES), MODALITIES)
        count = len(reader.samples)
        self.assertEqual(count, 9)
        expected = reader.empty(count)
        reader.read(np.arange(count), expected)
        stream = open_flight()
        items = take(stream, count)
        for name, value in expected.items():
            np.testing.assert_array_equal(np.stack([item[name] for item in items]), value, name)
        self.assertTrue(expected["events"].any())
        # The third item of a sequence, whose event camera remembers the first two.
        stream.load_state_dict({**stream.state_dict(), "round": 1, "tick": 3, "given": 5})
        np.testing.assert_array_equal(take(stream, 1)[0]["events"], expected["events"][5])
        # As they are recorded.
        names = ["csi/cfr", "csi/paths/delay", "uav/dvs/t"]
        for item, sample in zip(open_flight(names), ds.samples(names, [0])):
            self.assertEqual(item.keys(), sample.keys())
            for name in sample:
                np.testing.assert_array_equal(item[name], sample[name], name)

    def test_a_run_goes_on_with_another_sequence(self):
        sim = greatx.Simulation(support.scenario_file("flight", FLIGHT), sequences=3)
        run = sim.run()
        next(run)  # the rest of this sequence is lost
        for sequence, first in ((2, 0), (1, 3), (1, 0)):
            run.restart(sequence, first)
            ticks, expected = list(run), list(sim.run(sequence, first))
            self.assertEqual([t.tick for t in ticks], [t.tick for t in expected])
            for one, other in zip(ticks, expected):
                self.assertEqual(list(one), list(other))
                for sensor in one:
                    for name in one[sensor]:
                        np.testing.assert_array_equal(one[sensor][name], other[sensor][name], name)
        for place, message in (((3, 0), "sequence: expected 0 to 2"), ((0, 6), "tick: expected 0 to 5")):
            with self.assertRaisesRegex(greatx.Error, message):
                run.restart(*place)
        run.restart(0, 5)
        self.assertEqual([tick.tick for tick in run], [5])

    def test_it_has_no_end_and_its_seed_decides(self):
        items = take(open_link(ticks=1), 7)
        self.assertEqual(places(items), [(sequence, 0) for sequence in range(7)])
        same, other = take(open_link(ticks=1), 2), take(open_link(ticks=1, seed=5), 2)
        self.assert_same(same, items[:2])
        self.assertFalse(np.array_equal(other[0]["csi"], same[0]["csi"]))
        self.assertFalse(np.array_equal(same[0]["csi"], same[1]["csi"]))

    def test_it_goes_on_where_it_was(self):
        for buffer, prefetch in ((1, 0), (1, 3), (5, 2)):
            whole = take(open_link(buffer=buffer, prefetch=prefetch), 11)
            for split in (1, 4, 6):
                first = open_link(buffer=buffer, prefetch=prefetch)
                begun = take(first, split)
                state = json.loads(json.dumps(first.state_dict()))
                second = open_link(buffer=buffer, prefetch=0)
                second.load_state_dict(state)
                self.assert_same(begun + take(second, 11 - split), whole)

    def test_one_stream_goes_on_too(self):
        stream = open_link(buffer=3)
        whole = take(open_link(buffer=3), 8)
        self.assert_same(take(stream, 3) + take(stream, 5), whole)
        fresh = open_link(buffer=3)
        fresh.load_state_dict(open_link(buffer=3).state_dict())
        self.assert_same(take(fresh, 2), whole[:2])

    def test_a_buffer_mixes_and_loses_nothing(self):
        straight = places(take(open_link(), 60))
        stream = open_link(buffer=8)
        mixed = places(take(stream, 40))
        self.assertEqual(len(set(mixed)), 40)
        held = {tuple(place) for place in stream.state_dict()["held"]}
        self.assertEqual(set(mixed) | held, set(straight[:47]))
        self.assertEqual(len(held), 7)
        moved = sum(a != b for a, b in zip(mixed, straight))
        self.assertGreater(moved, 25)

    def test_parts_share_the_sequences(self):
        for place in range(2):
            items = take(open_link(ticks=1, part=(place, 2)), 3)
            self.assertEqual(places(items), [(place + 2 * i, 0) for i in range(3)])

    def test_its_thread_ends_with_the_iteration(self):
        items = iter(open_link(["csi/cfr"]))
        next(items)
        self.assertIn("greatx.stream", [thread.name for thread in threading.enumerate()])
        items.close()
        self.assertNotIn("greatx.stream", [thread.name for thread in threading.enumerate()])

    def test_a_process_may_end_within_a_stream(self):
        file = support.scenario_file("link", LINK)
        text = (
            f"import greatx; items = iter(greatx.stream({str(file)!r}, ['csi/cfr'], seed=4, prefetch=2));"
            "print(next(items)['tick'])"
        )
        done = subprocess.run([sys.executable, "-c", text], env=os.environ, capture_output=True, timeout=120)
        self.assertEqual((done.returncode, done.stdout.strip()), (0, b"0"), done.stderr)

    def test_what_is_wrong_is_said(self):
        for options, message in (
            ({"modalities": ["csi/nothing"]}, "expected arrays of the run, .*csi/cfr.*; found 'csi/nothing'"),
            ({"modalities": {"rgb": Picture("uav/nothing")}}, "found 'uav/nothing/rgb'"),
            ({"buffer": 0}, "buffer: expected 1"),
            ({"seed": -1}, "seed: expected 0"),
            ({"part": (1, 1)}, "part: expected"),
        ):
            for prefetch in (0, 2):
                with self.assertRaisesRegex(greatx.Error, message):
                    take(open_link(prefetch=prefetch, **options), 1)
        state = open_link().state_dict()
        for name, value in (("seed", 5), ("buffer", 2), ("part", [0, 2]), ("version", 0)):
            with self.assertRaisesRegex(greatx.Error, f"state: expected {name} "):
                open_link().load_state_dict({**state, name: value})

    @unittest.skipUnless(HAS_TORCH, "torch is not installed")
    def test_a_training_goes_on_with_the_same_batches(self):
        import torch

        def loader(stream):
            return torch.utils.data.DataLoader(stream, batch_size=2)

        whole = take(loader(open_link(buffer=4).torch()), 5)
        self.assertEqual(tuple(whole[0]["csi"].shape), (2, 4, 4, 8))
        for batch, item in zip(whole, take(open_link(buffer=4), 9)[::2]):
            np.testing.assert_array_equal(batch["csi"][0], item["csi"])
        first = open_link(buffer=4).torch()
        begun = take(loader(first), 2)
        second = open_link(buffer=4).torch()
        second.load_state_dict(first.state_dict())
        for a, b in zip(begun + take(loader(second), 3), whole):
            for name in a:
                self.assertTrue(torch.equal(a[name], b[name]), name)

    @unittest.skipUnless(HAS_TORCH, "torch is not installed")
    def test_workers_compute_sequences_of_their_own(self):
        import torch

        stream = open_link(["csi/cfr"], ticks=3, prefetch=0).torch(transform=lambda item: item["sequence"])
        loader = torch.utils.data.DataLoader(stream, batch_size=None, num_workers=2)
        self.assertEqual(take(loader, 6), [0, 1, 0, 1, 2, 3])


if __name__ == "__main__":
    unittest.main()
