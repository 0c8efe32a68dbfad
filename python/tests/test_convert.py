# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the converters against closed forms and against the data set's own response. tests/peer/deepmimo.py,
which is not part of these tests, checks that DeepMIMO itself reads the result.
"""

import contextlib
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import greatx
import support
from greatx.convert import sionna_paths, write_deepmimo, write_sionna
from greatx.convert.__main__ import main
from support import C


class Converted(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.out = pathlib.Path(holder.name, "scenario")

    def matrix(self, key, folder="", tx=0):
        return np.load(self.out / folder / f"{key}_t000_tx{tx:03}_r001.npz")[key]


class DeepMimo(Converted):
    def test_line_of_sight_in_closed_form(self):
        ds = greatx.load(support.space())
        summary = write_deepmimo(ds, self.out, sequence=1)
        self.assertEqual((summary["snapshots"], summary["paths"]), (3, 3))
        self.assertEqual(
            sorted(p.name for p in self.out.iterdir()),
            ["params.json"] + [f"snapshot_00000{i}" for i in range(3)],
        )
        for i in range(3):
            folder, d = f"snapshot_00000{i}", 50.0 + 5 * i
            turns = -3.5e9 * d / C
            for key, wanted, error in (
                ("power", 20 * np.log10(C / 3.5e9 / (4 * np.pi * d)), 1e-4),
                ("phase", (360 * turns + 180) % 360 - 180, 1e-3),
                ("delay", d / C, 1e-14),
                ("aod_el", 90, 1e-4),
                ("aod_az", np.degrees(np.arctan2(4, 3)), 1e-4),
                ("aoa_az", np.degrees(np.arctan2(-4, -3)), 1e-4),
                ("inter", 0, 0),
                ("doppler", -50 / C * 3.5e9, 1e-3),
            ):
                value = self.matrix(key, folder)
                self.assertEqual((value.shape, value.dtype), ((1, 1), np.float32), key)
                self.assertAlmostEqual(value[0, 0], wanted, delta=error, msg=key)
            np.testing.assert_allclose(self.matrix("tx_pos", folder), [[0, 0, 10]])
            np.testing.assert_allclose(self.matrix("rx_pos", folder), [[0.6 * d, 0.8 * d, 10]], rtol=1e-6)
            self.assertTrue(np.isnan(self.matrix("inter_pos", folder)).all())
            self.assertEqual(json.loads((self.out / folder / "objects.json").read_text()), [])
        params = json.loads((self.out / "params.json").read_text())
        self.assertEqual(params["scene"]["num_scenes"], 3)
        self.assertEqual(params["rt_params"]["frequency"], 3.5e9)
        self.assertEqual(params["greatx"]["times_s"], [0, 0.1, 0.2])
        self.assertTrue(
            params["txrx_sets"]["txrx_set_0"]["is_tx"] and not params["txrx_sets"]["txrx_set_1"]["is_tx"]
        )

    def test_ticks_as_users(self):
        ds = greatx.load(support.street())
        write_deepmimo(ds, self.out, layout="users")
        csi = ds["csi"]
        power, inter, position = (self.matrix(key) for key in ("power", "inter", "inter_pos"))
        self.assertEqual(power.shape[0], 8)
        self.assertEqual(position.shape, (*power.shape, 2, 3))
        self.assertTrue(np.all(np.diff(power, axis=1)[~np.isnan(power[:, 1:])] <= 0))  # strongest first
        self.assertEqual(
            json.loads((self.out / "params.json").read_text())["txrx_sets"]["txrx_set_1"]["num_points"], 8
        )
        for user in range(8):
            paths = csi.record(user // 2).paths(user % 2, 0)
            n = len(paths["delay"])
            self.assertEqual(np.count_nonzero(~np.isnan(power[user])), n)
            # Each path of the scenario is a path of the data set, with the same interactions and vertices.
            by_delay = np.argsort(paths["delay"])
            mine = np.argsort(self.matrix("delay")[user, :n])
            for p, q in zip(mine, by_delay):
                digits = "".join("0142 3"[k] if k < 4 else "3" for k in paths["interaction"][q] if k) or "0"
                self.assertEqual(str(int(inter[user, p])), digits)
                np.testing.assert_allclose(position[user, p], paths["vertex"][q], rtol=1e-6)
            self.assertTrue(np.isnan(inter[user, n:]).all() and np.isnan(position[user, n:]).all())

    def test_several_transmitters_and_links_without_paths(self):
        summary = write_deepmimo(greatx.load(support.two_transmitters()), self.out)
        self.assertEqual(
            summary,
            {
                "snapshots": 2,
                "transmitters": 2,
                "receivers": 3,
                "paths": 5,
                "paths of no vertical amplitude left out": 1,
            },
        )
        delay = self.matrix("delay", "snapshot_000000", tx=1)
        np.testing.assert_allclose(delay, [[3e-7, np.nan], [np.nan, np.nan], [6e-7, np.nan]], rtol=1e-6)
        # The strongest path comes first: the transfers of the paths are 1, 2, ...
        np.testing.assert_allclose(self.matrix("delay", "snapshot_000000")[2], [5e-7, 4e-7], rtol=1e-6)
        self.assertEqual(self.matrix("inter", "snapshot_000000")[0, 0], 14)  # reflection, transmission
        np.testing.assert_allclose(self.matrix("tx_pos", "snapshot_000000", tx=1), [[1, 0, 1]])
        self.assertTrue(np.isnan(self.matrix("power", "snapshot_000001")).all())
        sets = json.loads((self.out / "params.json").read_text())["txrx_sets"]
        self.assertEqual((sets["txrx_set_0"]["num_points"], sets["txrx_set_1"]["num_active_points"]), (2, 2))

    def test_errors(self):
        ds = greatx.load(support.space())
        with self.assertRaisesRegex(greatx.DatasetError, "2 sequences"):
            write_deepmimo(ds, self.out)
        with self.assertRaisesRegex(greatx.DatasetError, "no sequence 7; it has 0, 1"):
            write_deepmimo(ds, self.out, sequence=7)
        with self.assertRaisesRegex(greatx.DatasetError, "no channel 'down'; channels: csi"):
            write_deepmimo(ds, self.out, channel="down", sequence=0)
        with self.assertRaisesRegex(greatx.DatasetError, "lower-case"):
            write_deepmimo(ds, self.out.with_name("Scenario"), sequence=0)
        self.assertFalse(self.out.exists())
        self.out.mkdir()
        (self.out / "mine").touch()
        with self.assertRaisesRegex(FileExistsError, "no empty folder"):
            write_deepmimo(ds, self.out, sequence=0)

    def test_moving_transmitters_are_no_static_scenario(self):
        folder = support.copy_of(support.space())
        path = folder / "sequence_0000/poses/position.npy"
        position = np.load(path)
        position[2, 0, 0] += 0.1
        np.save(path, position)
        with self.assertRaisesRegex(greatx.DatasetError, "bs/antenna moves"):
            write_deepmimo(greatx.load(folder), self.out, sequence=0, layout="users")


class Sionna(Converted):
    def test_line_of_sight_in_closed_form(self):
        for i, record in enumerate(greatx.load(support.space()).sequences[0]["csi"]):
            d = 50.0 + 5 * i
            p = sionna_paths(record)
            self.assertEqual(p.a.shape, (1, 1, 1, 1, 1))
            # The passband coefficient does not include the carrier's phase over the delay.
            self.assertAlmostEqual(complex(p.a.item()), C / 3.5e9 / (4 * np.pi * d), delta=1e-9)
            self.assertAlmostEqual(p.tau.item(), d / C, delta=1e-18)
            np.testing.assert_allclose(
                [p.theta_t.item(), p.phi_t.item()], [np.pi / 2, np.arctan2(4, 3)], rtol=1e-6
            )
            np.testing.assert_allclose(
                [p.theta_r.item(), p.phi_r.item()], [np.pi / 2, np.arctan2(-4, -3)], rtol=1e-6
            )
            np.testing.assert_allclose(p.targets, [[0.6 * d, 0.8 * d, 10]])
            self.assertTrue(p.valid.all() and not p.interactions.any())

    def test_the_response_is_the_sum_over_paths(self):
        """The sum is that of Sionna's Paths.cfr, including ports and time samples."""
        csi = greatx.load(support.street())["csi"]
        for record in csi:
            p = sionna_paths(record)
            self.assertEqual(p.a.shape[:4], (2, 1, 2, 4))
            self.assertEqual(p.cir.shape, (*p.a.shape, 3))
            baseband = p.a.astype(complex) * np.exp(-2j * np.pi * p.frequency * p.tau)[:, None, :, None]
            np.testing.assert_allclose(p.cir[..., 0], baseband, atol=1e-6 * np.abs(baseband).max())
            over_f = np.exp(-2j * np.pi * p.frequencies * p.tau[:, None, :, None, :, None])
            h = np.einsum(
                "rustpn,rustpk->rustnk", p.cir, np.broadcast_to(over_f, (*p.a.shape, len(p.frequencies)))
            )
            np.testing.assert_allclose(p.cfr, h, atol=1e-5 * np.abs(h).max())
            self.assertTrue(np.all(p.a[np.broadcast_to(~p.valid[:, None, :, None], p.a.shape)] == 0))

    def test_padding_and_interactions(self):
        first, second = (sionna_paths(record) for record in greatx.load(support.two_transmitters())["csi"])
        self.assertEqual(first.valid.sum(axis=-1).tolist(), [[1, 2], [0, 0], [2, 1]])
        self.assertTrue(np.all(first.tau[~first.valid] == -1))
        self.assertEqual(first.interactions[:, 0, 1, 1].tolist(), [1, 4])  # specular, refraction
        self.assertEqual(first.objects[:, 0, 1, 1].tolist(), [0, 1])
        self.assertEqual(first.objects[:, 1, 0, 0].tolist(), [0xFFFFFFFF] * 2)
        self.assertEqual(first.vertices.shape, (2, 3, 2, 2, 3))
        self.assertEqual((second.a.shape, second.vertices.shape), ((3, 1, 2, 1, 0), (2, 3, 2, 0, 3)))

    def test_files(self):
        ds = greatx.load(support.space())
        self.assertEqual(write_sionna(ds, self.out), {"sequences": 2, "files": 6})
        with np.load(self.out / "sequence_0001/000002.npz") as stored:
            wanted = sionna_paths(ds.sequences[1]["csi"].record(2))
            for name, value in vars(wanted).items():
                np.testing.assert_array_equal(stored[name], value)
            self.assertEqual((int(stored["tick"]), float(stored["time_s"])), (2, 0.2))


class CommandLine(Converted):
    def run_main(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main([str(a) for a in arguments])
        return code, out.getvalue(), err.getvalue()

    def test_both(self):
        code, out, _ = self.run_main("deepmimo", support.street(), self.out, "--layout", "users")
        self.assertEqual(code, 0)
        self.assertIn("8 receivers", out)
        code, out, _ = self.run_main(
            "sionna", support.street(), self.out.with_name("arrays"), "--channel", "csi"
        )
        self.assertEqual(code, 0)
        self.assertIn("4 files", out)

    def test_faulty_input(self):
        code, _, err = self.run_main("deepmimo", self.out / "none", self.out)
        self.assertEqual(code, 1)
        self.assertIn("no dataset.json", err)

    def test_what_is_missing_or_mistyped_is_named(self):
        for arguments, words in (
            (("deepmimo", support.truth()), "expected a channel, found none; the scenario needs a channel"),
            (("sionna", support.street(), "--channel", "cis"), "has no channel 'cis' (did you mean 'csi'?)"),
            (("deepmimo", support.street(), "--sequence", "3"), "has no sequence 3; it has 0"),
        ):
            code, out, err = self.run_main(*arguments[:2], self.out, *arguments[2:])
            self.assertEqual((code, out, err.count("\n")), (1, "", 1), err)
            self.assertIn(words, err)
            self.assertFalse(self.out.exists())
        error = io.StringIO()
        with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(error):
            main(["deepmimoo", str(support.street()), str(self.out)])
        self.assertEqual(end.exception.code, 1)
        self.assertIn("(did you mean 'deepmimo'?)", error.getvalue())

    def test_a_limit_on_the_size_of_files_ends_like_a_full_disk(self):
        command = f"ulimit -f 1; exec {sys.executable} -m greatx.convert sionna {support.street()} {self.out}"
        done = subprocess.run(["bash", "-c", command], stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(
            done.stderr,
            f"error: {self.out}: cannot be written: File too large; nothing of it is left\n",
        )
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()
