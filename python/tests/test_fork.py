# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests that a forked child gets an error at once if it uses its parent's Simulation, and that both processes
end.
"""
import os
import signal
import subprocess
import sys
import unittest

SCRIPT = """
import os, sys, greatx
sim = greatx.Simulation({"greatx": 1, "name": "empty", "ticks": 3, "tick_rate_hz": 10})
sim.place_transmitter("bs", [0, 0, 10])
sim.place_receiver("ue", [30, 40, 10])
sim.add_channel("csi", carrier_hz=3.5e9, bandwidth_hz=20e6, subcarriers=8)
paths, run = sim.paths(), sim.run()
next(run)
child = os.fork()
if child == 0:
    for use in (lambda: sim.paths(), lambda: sim.name, lambda: sim.add_node({}), lambda: next(run), \
lambda: run.summary(),
                lambda: sim.device, lambda: repr(sim)):
        try:
            use()
        except greatx.Error as error:
            assert f"made by process {os.getppid()}, of which process {os.getpid()} is a fork" \
in str(error), error
        else:
            sys.exit(3)
    assert paths.cfr().shape == (1, 1, 1, 1, 1, 8)  # what is computed already
    own = greatx.Simulation({"greatx": 1, "name": "own", "ticks": 1})
    assert own.name == "own"
    sys.exit(7)  # with the interpreter's own end, which drops what the parent made
_, status = os.waitpid(child, 0)
assert os.WIFEXITED(status) and os.WEXITSTATUS(status) == 7, status
next(run)
assert len(sim.paths()) == 1
print("parent goes on")
"""


class Fork(unittest.TestCase):
    def test_a_child_is_told_and_ends(self):
        with subprocess.Popen(
            [sys.executable, "-c", SCRIPT],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        ) as process:
            try:
                out, _ = process.communicate(timeout=120)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                raise
        self.assertEqual(process.returncode, 0, out)
        self.assertIn("parent goes on", out)


if __name__ == "__main__":
    unittest.main()
