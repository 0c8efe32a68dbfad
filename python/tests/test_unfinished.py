# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests load(DIR, incomplete=True) on a run that goes on, on one that was killed, and on damaged journals."""

import os
import pathlib
import pickle
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import warnings
import zlib

import numpy as np

import greatx
import support
from greatx.unfinished import read_journal


def load_incomplete(folder):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return greatx.load(folder, incomplete=True)


def contents(sequence):
    """Returns copies of the records of all arrays of a sequence, by sensor and array."""
    return {
        (name, array): [np.array(sensor[array][i]) for i in range(len(sensor))]
        for name, sensor in sequence.sensors.items()
        for array in sensor.arrays
    }


class Unfinished(unittest.TestCase):
    def start(self, *arguments):
        """Starts a run and stops it when it has committed some ticks of its second sequence."""
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.out = pathlib.Path(holder.name, "data")
        scenario = support.scenario_file("street", support.STREET)
        command = [os.environ["GREATX_PROGRAM"], "generate", scenario, "-o", self.out, "-q"]
        self.run = subprocess.Popen([*map(str, command), "--ticks", "12", "--sequences", "2", *arguments])
        self.addCleanup(self.run.wait)
        self.addCleanup(self.run.kill)
        journal = self.out / "journal.txt"
        while self.run.poll() is None and not (
            journal.is_file() and b'{"packet":[1,2,' in journal.read_bytes()
        ):
            time.sleep(0.002)
        if self.run.poll() is None:
            self.run.send_signal(signal.SIGSTOP)

    def check_prefix(self, before, whole):
        for key, records in before.items():
            self.assertLessEqual(len(records), len(whole[key]))
            for mine, theirs in zip(records, whole[key]):
                self.assertEqual((mine.dtype, mine.shape), (theirs.dtype, theirs.shape), key)
                self.assertEqual(mine.tobytes(), theirs.tobytes(), key)

    def go_on(self, *arguments):
        self.start(*arguments)
        with self.assertRaisesRegex(
            greatx.DatasetError, "1 of 2 sequences are whole, and .* incomplete=True"
        ):
            greatx.load(self.out)
        with self.assertWarnsRegex(UserWarning, "1 of 2 sequences are whole, and [0-9]+ ticks of sequence 1"):
            ds = greatx.load(self.out, incomplete=True)
        opened = ds.sequences[1]
        self.assertTrue(ds.sequences[0].whole and not opened.whole)
        self.assertGreaterEqual(len(opened.ticks), 3)
        before = contents(opened)
        # Arrays that were opened before go on giving the same records while the run appends and renames.
        kept = opened["csi"].cfr, opened["csi"].delay
        copies = [np.array(kept[0]), [np.array(kept[1][i]) for i in range(len(kept[1]))]]
        samples = ds.samples(["csi/cfr", "csi/paths/delay"], sequences=[1])
        self.run.send_signal(signal.SIGCONT)
        later = load_incomplete(self.out)
        self.check_prefix(before, contents(later.sequences[1]))
        self.assertEqual(self.run.wait(), 0)
        # What was loaded before still reads its records, from files that have other names now.
        ds.files.drop(lambda key: True)
        after = contents(ds.sequences[1])
        whole = contents(greatx.load(self.out).sequences[1])
        for each in (before, after):
            self.check_prefix(each, whole)
        self.assertEqual([len(v) for v in before.values()], [len(v) for v in after.values()])
        np.testing.assert_array_equal(kept[0], copies[0])
        for i, delays in enumerate(copies[1]):
            np.testing.assert_array_equal(kept[1][i], delays)
        again = pickle.loads(pickle.dumps(samples))
        self.assertEqual(len(again), len(samples))
        np.testing.assert_array_equal(again[-1]["csi/cfr"], samples[-1]["csi/cfr"])

    def test_a_run_that_goes_on(self):
        self.go_on()

    def test_a_compressed_run_that_goes_on(self):
        self.go_on("--compression", "fast")

    def test_a_killed_run_and_damage(self):
        self.start()
        self.run.kill()
        self.run.wait()
        packets = [p for p in read_journal(self.out) if p.sequence == 1]
        ds = load_incomplete(self.out)
        self.assertEqual([int(t) for t in ds.sequences[1].ticks], [p.tick for p in packets])
        journal = self.out / "journal.txt"
        text = journal.read_bytes()

        def ticks():
            return len(load_incomplete(self.out).sequences[1].ticks)

        # A line that is cut or changed ends the journal.
        journal.write_bytes(text[:-5])
        self.assertEqual(ticks(), len(packets) - 1)
        journal.write_bytes(text[:-12] + b"\t00000000\n")
        self.assertEqual(ticks(), len(packets) - 1)
        journal.write_bytes(text)
        # A frame that is gone takes its tick and all later ones with it, and so does a row.
        frames = sorted((self.out / "sequence_0001/car/lidar/points").iterdir())
        moved = frames[1].read_bytes()
        frames[1].unlink()
        self.assertEqual(ticks(), 2)
        frames[1].write_bytes(moved)
        stack = self.out / "sequence_0001/csi/cfr.npy.part"
        row = ds.sequences[1]["csi"].cfr[0].nbytes
        os.truncate(stack, 256 + row + 5)
        self.assertEqual(ticks(), 1)
        # A stack that links to another file is not read.
        stack.rename(stack.with_name("other"))
        stack.symlink_to("other")
        with self.assertRaisesRegex(greatx.DatasetError, "symbolic link"):
            load_incomplete(self.out)
        # A journal that no run has written.
        for entry in (
            b'{"packet":[1,0],"records":[],"files":[]}',
            b'{"packet":[1,0,0],"records":[[9,0]],"files":[]}',
            b"[]",
        ):
            body = text[: text.index(b'{"packet":[1,')] + entry
            line = body[body.rindex(b"\n") + 1 :]
            journal.write_bytes(body + b"\t%08x\n" % zlib.crc32(line))
            with self.assertRaisesRegex(greatx.DatasetError, "journal.txt|symbolic link"):
                load_incomplete(self.out)

    def test_before_the_first_tick(self):
        folder = support.copy_of(support.street())
        (folder / "manifest.json").unlink()
        shutil.rmtree(folder / "sequence_0000")
        with self.assertRaisesRegex(greatx.DatasetError, "0 of 1"):
            load_incomplete(folder)
        (folder / "journal.txt").touch()
        sequence = load_incomplete(folder).single()
        self.assertEqual((len(sequence), len(sequence["csi"].cfr), len(sequence["car/front"].rgb)), (0, 0, 0))


class OpenArrays(unittest.TestCase):
    def test_few_stay_open_and_none_is_lost(self):
        ds = greatx.load(support.street())
        ds.files.most = 3
        whole = contents(greatx.load(support.street()).single())
        for _ in range(2):
            again = contents(ds.single())
            self.assertLessEqual(len(ds.files), 3)
            for key, records in whole.items():
                for mine, theirs in zip(records, again[key]):
                    np.testing.assert_array_equal(mine, theirs)

    def test_files_close(self):
        handles = lambda: len(os.listdir("/proc/self/fd"))
        before = handles()
        ds = greatx.Dataset(support.street(), files=greatx.opened.OpenArrays(4))
        contents(ds.single())
        self.assertLessEqual(handles() - before, 2 * 4)
        with self.assertRaises(ValueError):
            greatx.opened.OpenArrays(0)


if __name__ == "__main__":
    unittest.main()
