# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the task throughput in the size of the tests, whose times mean nothing, and tests its measures."""
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

HAS_TORCH = all(importlib.util.find_spec(name) for name in ("torch", "torchvision", "yaml", "matplotlib"))
PYTHON = pathlib.Path(__file__).resolve().parents[1]
if HAS_TORCH:
    sys.path.append(str(PYTHON))
    from tasks.throughput import measures


@unittest.skipUnless(HAS_TORCH, "torch, torchvision, yaml or matplotlib is not installed")
class Throughput(unittest.TestCase):
    def test_the_task_writes_its_tables(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            command = [sys.executable, str(PYTHON / "tasks" / "throughput"), "-o", str(out), "--quick"]
            done = subprocess.run(
                [*command, "--threads", "1"], capture_output=True, text=True, env=os.environ
            )
            self.assertEqual(done.returncode, 0, done.stderr)
            results = json.loads((out / "results.json").read_text())
            self.assertEqual(list(results["storage"]), ["none", "fast"])
            rows = [(row["way"], row["storage"], row["workers"]) for row in results["loader"]]
            self.assertEqual(
                rows,
                [("greatx.batches", storage, workers) for storage in ("none", "fast") for workers in (0, 1)]
                + [("DataLoader", "none", workers) for workers in (0, 1)],
            )
            for row in results["loader"]:
                self.assertGreater(row["items_per_s"]["least"], 0)
                self.assertGreater(row["cpu_ms"]["least"], 0)
            bytes_of = {
                storage: {name: part["bytes"] for name, part in found["parts"].items()}
                for storage, found in results["storage"].items()
            }
            self.assertGreater(bytes_of["none"]["csi"], 64 * 256 * 8)  # complex64 and the header
            self.assertEqual(bytes_of["none"]["csi"], bytes_of["fast"]["csi"])
            self.assertLess(bytes_of["fast"]["events"], bytes_of["none"]["events"])
            self.assertTrue(results["stream"]["resume_same"])
            self.assertGreater(results["training"]["macs"], 0)
            text = (out / "results.md").read_text()
            for word in ("greatx.batches", "Straight from the engine", "A training loop", "parts.png"):
                self.assertIn(word, text)
            self.assertGreater((out / "parts.png").stat().st_size, 1000)


@unittest.skipUnless(HAS_TORCH, "torch, torchvision, yaml or matplotlib is not installed")
class Measures(unittest.TestCase):
    def test_processor_time_is_that_of_the_work(self):
        parts = measures.Parts()
        with parts:
            deadline = time.thread_time() + 0.05
            while time.thread_time() < deadline:
                pass
            parts.end("work")
            parts.end("nothing")
        self.assertGreaterEqual(parts.seconds["work"][0], 0.05)
        self.assertEqual(list(parts.seconds), ["work", "nothing"])

    def test_other_processes_count(self):
        text = "import time\nwhile time.process_time() < 0.3: pass\nprint(flush=True)\ninput()"
        with subprocess.Popen(
            [sys.executable, "-c", text], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        ) as other:
            other.stdout.readline()
            self.assertGreaterEqual(measures.cpu_seconds([other.pid]) - measures.cpu_seconds(), 0.2)
            other.communicate(b"\n")

    def test_a_spread(self):
        spread = measures.Spread.of([3.0, 1.0, 2.0])
        self.assertEqual((spread.median, spread.least, spread.most), (2, 1, 3))
        self.assertEqual(spread.text(1), "2.0 (1.0 to 3.0)")


if __name__ == "__main__":
    unittest.main()
