# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests scenes, paths, channels, maps and runs that are computed from Python."""
import gc
import logging
import os
import signal
import threading
import unittest
import weakref

import numpy as np
import support

import greatx
from greatx import precoding

logging.getLogger("greatx").setLevel(logging.ERROR)
C = support.C
EMPTY = {"greatx": 1, "name": "empty", "ticks": 1}
LAMBDA = C / 3.5e9


def in_space(**fields):
    """Returns a simulation of a transmitter and a receiver in free space, 50 m apart."""
    sim = greatx.Simulation(EMPTY, validation=True)
    sim.place_transmitter("bs", [0, 0, 10])
    sim.place_receiver("ue", [30, 40, 10])
    sim.add_channel("csi", carrier_hz=3.5e9, bandwidth_hz=20e6, subcarriers=8, **fields)
    return sim


def street(**options):
    return greatx.Simulation(support.scenario_file("street", support.STREET), validation=True, **options)


class ClosedForms(unittest.TestCase):
    def test_friis(self):
        paths = in_space().paths()
        self.assertEqual((len(paths), paths.shape, paths.receivers), (1, (1, 1), ["ue/array"]))
        self.assertAlmostEqual(paths.delay[0], 50 / C, delta=1e-20)
        self.assertAlmostEqual(abs(paths.amplitude[0, 0, 0]), LAMBDA / (4 * np.pi * 50), delta=1e-9)
        self.assertAlmostEqual(paths.departure[0, 1], np.arctan2(40, 30), places=14)
        self.assertEqual(paths.distance[0, 0], 50)
        k = np.arange(8) - 4
        turns = np.mod((3.5e9 + k * 20e6 / 8) * (50 / C), 1)
        expected = LAMBDA / (4 * np.pi * 50) * np.exp(-2j * np.pi * turns)
        np.testing.assert_allclose(paths.cfr()[0, 0, 0, 0, 0], expected, rtol=3e-7)

    def test_a_dft_beam_has_the_gain_of_the_array_in_its_direction(self):
        # Far away: at 500 m the wave over a panel of 0.3 m is plane within 0.2 degrees.
        for row_beam, beam in ((0, 0), (1, 3), (2, 6), (0, 5)):
            left, up = precoding.beam_cosine(beam, 8), precoding.beam_cosine(row_beam, 3, 1, 0.7)
            ahead = np.sqrt(1 - left**2 - up**2)
            sim = greatx.Simulation(EMPTY, validation=True)
            sim.place_transmitter("bs", [0, 0, 10], array=greatx.Array(rows=3, columns=8, row_spacing_wl=0.7))
            sim.place_receiver("ue", [500 * ahead, 500 * left, 10 + 500 * up])
            sim.add_channel("csi", carrier_hz=3.5e9, bandwidth_hz=1e6, subcarriers=1)
            paths = sim.paths()
            labels = precoding.best_beams(paths.cfr(), precoding.dft_panel(3, 8))
            self.assertEqual(labels.beam[0, 0], row_beam * 8 + beam)
            one_port = np.mean(np.abs(paths.cfr()) ** 2)
            self.assertAlmostEqual(labels.gain[0, 0] / one_port, 24, delta=1e-3)

    def test_two_ray_ground(self):
        sim = greatx.Simulation({**EMPTY, "scene": {"generate": {"kind": "room"}}}, validation=True)
        sim.place_transmitter("a", [-0.5, 0.3, 1.2])
        sim.place_receiver("b", [0.7, -0.2, 1.6])
        sim.add_channel("csi", max_depth=1)
        paths = sim.paths()
        self.assertEqual(len(paths), 7)  # the line of sight and six walls
        self.assertEqual(sorted(paths.interaction[:, 0]), [0] + [1] * 6)

    def test_quantities_of_one_path(self):
        paths = in_space().paths()
        gain = (LAMBDA / (4 * np.pi * 50)) ** 2
        stats = paths.statistics()
        self.assertAlmostEqual(stats.path_gain[0, 0] / gain, 1, places=12)
        self.assertEqual(
            (stats.k_factor[0, 0], stats.delay_spread[0, 0], stats.line_of_sight[0, 0]), (np.inf, 0, 1)
        )
        self.assertEqual(stats.unit("delay_spread"), "s")
        received = paths.received(2.0, resistance_ohm=50)
        self.assertAlmostEqual(received.power_w[0, 0] / (2 * gain), 1, places=12)
        self.assertAlmostEqual(abs(received.open_circuit_v[0, 0]) ** 2 / 200 / (2 * gain), 1, places=12)
        field = np.linalg.norm(received.field_v_per_m[0, 0])
        self.assertAlmostEqual(field, np.sqrt(376.730 * 2 / (4 * np.pi)) / 50, places=6)
        self.assertEqual(paths.coherence().bandwidth[0, 0], np.inf)
        taps = paths.taps(C / 50, 4)  # the delay is one sample
        h = np.abs(taps.taps[0, 0, 0, 0, 0])
        self.assertAlmostEqual(h[1] / np.sqrt(gain), 1, places=6)
        self.assertLess(h[[0, 2, 3]].max(), 1e-15 * h[1])
        self.assertEqual(taps.paths_outside[0, 0], 0)

    def test_parts_add_up(self):
        paths = street().paths()
        h, los, others = (paths.cfr(select=part) for part in ("all", "line_of_sight", "others"))
        np.testing.assert_allclose(los + others, h, atol=1e-10)
        self.assertGreater(np.abs(others).max(), 0)

    def test_impulse_response_gives_the_frequency_response(self):
        paths = street().paths()
        a, tau = paths.cir()
        f = (np.arange(16) - 8) * 1e6
        turn = np.exp(-2j * np.pi * f * tau[..., None])
        h = np.einsum("uavbp,uvpf->uavbf", a.astype(complex), turn)
        mine = paths.cfr(subcarriers=16, subcarrier_spacing_hz=1e6)[..., 0, :]
        np.testing.assert_allclose(mine, h, atol=1e-5 * np.abs(h).max())

    def test_normalized_delays_are_asked_for(self):
        paths = street().paths()
        a, tau = paths.cir(normalize_delays=True)
        valid = np.abs(a).max((1, 3)) > 0
        first = np.where(valid, tau, np.inf).min(-1)
        np.testing.assert_array_equal(first[valid.any(-1)], 0)
        f = (np.arange(16) - 8) * 1e6
        h = np.einsum("uavbp,uvpf->uavbf", a.astype(complex), np.exp(-2j * np.pi * f * tau[..., None]))
        mine = paths.cfr(subcarriers=16, subcarrier_spacing_hz=1e6, normalize_delays=True)[..., 0, :]
        np.testing.assert_allclose(mine, h, atol=1e-5 * np.abs(h).max())
        plain = paths.cfr(subcarriers=16, subcarrier_spacing_hz=1e6)[..., 0, :]
        self.assertGreater(np.abs(plain - h).max(), 0.1 * np.abs(h).max())

    def test_power_is_above_0(self):
        paths = street().paths()
        for power in (0.0, -1.0, float("nan"), float("inf")):
            with self.assertRaisesRegex(greatx.Error, "power_w"):
                paths.received(power)

    def test_points_are_receivers(self):
        sim = street()
        names = sim.channels["csi"]["receivers"]
        own = sim.paths(tick=2)
        for rx, name in enumerate(names):
            points = np.array([[0.1, -3, 1.5], own.receiver_position[rx]])
            there = sim.paths(tick=2, receivers=points)
            if name.startswith("car"):
                continue  # a car's own body does not hide its antenna, but would hide a point
            for tx in range(2):
                mine, other = own.link(rx, tx), there.link(1, tx)
                for array in ("delay", "transfer", "amplitude", "id", "vertex", "departure"):
                    self.assertEqual(mine[array].tobytes(), other[array].tobytes(), (name, tx, array))

    def test_array_at_points(self):
        sim = in_space()
        array = greatx.Array(rows=2, columns=2, polarization="vh", pattern="tr38901")
        at = sim.paths(receivers=[[30, 40, 10.0]], array=array, orientation_deg=[-126.8698976458440, 0, 0])
        self.assertEqual(at.amplitude.shape, (1, 8, 1))
        gain = np.abs(at.amplitude[0, :, 0]) / (LAMBDA / (4 * np.pi * 50))
        np.testing.assert_allclose(gain[0::2], 10 ** (8 / 20), rtol=1e-6)
        np.testing.assert_allclose(gain[1::2], 0, atol=1e-6)
        placed = in_space()
        placed.place_receiver("panel", [30, 40, 10.0], array=array, look_at=[0, 0, 10])
        placed.add_channel("panel_csi", receivers=["panel/array"])
        np.testing.assert_allclose(placed.paths("panel_csi").amplitude, at.amplitude, rtol=1e-6, atol=1e-12)


class Maps(unittest.TestCase):
    AREA = {"min_m": [-15, -30], "max_m": [15, 30], "cell_m": 6}

    def test_a_cell_is_a_receiver(self):
        sim = street()
        made = sim.radio_map(**self.AREA, power_dbm=[30, 27])
        self.assertEqual(made.rss.shape, (2, 10, 5))
        self.assertEqual((made.x[0], made.y[-1], made.extent), (-12, 27, (-15, 15, -30, 30)))
        rows, columns = np.nonzero(made.placement != 2)
        points = np.stack([made.x[columns], made.y[rows], made.z[rows, columns]], axis=1)
        stats = sim.paths(receivers=points).statistics()
        solved = made.placement[rows, columns] != 1
        for mine, other in (
            ("path_gain", "path_gain"),
            ("delay_spread", "delay_spread"),
            ("paths", "path_count"),
            ("arrival_azimuth_spread", "arrival_azimuth_spread"),
        ):
            np.testing.assert_array_equal(made[mine][:, rows, columns].T[solved], stats[other][solved], mine)
        np.testing.assert_allclose(
            made.rss[:, rows, columns].T[solved],
            10 * np.log10(stats.path_gain[solved]) + np.array([30, 27]),
            rtol=1e-12,
        )
        served = made.best_server[rows, columns][solved]
        self.assertEqual(served.tolist(), np.argmax(made.rss[:, rows, columns].T[solved], axis=1).tolist())

    def test_beams_are_those_of_the_python_codebook(self):
        sim = street()
        codebook = precoding.cross_polarized(precoding.dft_panel(1, 2, (1, 4)))  # of the street's two panels
        best = sim.radio_map(**self.AREA, precoder="best_beam", oversampling=(1, 4))
        self.assertEqual(best.facts["precoder"], "best_beam")
        rows, columns = np.nonzero(best.placement == 0)
        points = np.stack([best.x[columns], best.y[rows], best.z[rows, columns]], axis=1)
        paths = sim.paths(receivers=points)
        powers = np.abs(np.einsum("prt,bt->prb", paths.amplitude.astype(complex), codebook)) ** 2
        gains = np.zeros((*paths.shape, len(codebook)))
        np.add.at(gains, (paths.rx, paths.tx), powers.mean(axis=1))
        there = gains.max(axis=-1) > 0
        np.testing.assert_allclose(best.beam_gain[:, rows, columns].T, gains.max(axis=-1), rtol=1e-5)
        chosen = np.take_along_axis(gains, np.maximum(best.best_beam[:, rows, columns].T, 0)[..., None], -1)
        np.testing.assert_allclose(chosen[..., 0], gains.max(axis=-1), rtol=1e-5)
        np.testing.assert_array_equal(best.best_beam[:, rows, columns].T >= 0, there)
        self.assertGreater(len(np.unique(best.best_beam[best.best_beam >= 0])), 5)

        one = sim.radio_map(**self.AREA, precoder="beam", beam=9, oversampling=(1, 4))
        np.testing.assert_allclose(one.beam_gain[:, rows, columns].T, gains[..., 9], rtol=1e-5)
        ratio = sim.radio_map(**self.AREA, precoder="maximum_ratio")
        np.testing.assert_array_equal(ratio.beam_gain, 4 * ratio.path_gain)
        with np.errstate(divide="ignore"):
            np.testing.assert_allclose(ratio.rss, 30 + 10 * np.log10(ratio.beam_gain), rtol=1e-12)
        self.assertNotIn("beam_gain", sim.radio_map(**self.AREA))

    def test_friis_over_a_plane(self):
        sim = in_space()
        made = sim.radio_map(
            1.0,
            min_m=[20, 0],
            max_m=[24, 2],
            z_m=10.0,
            beyond_scene=True,
            array=greatx.Array(polarization="vh"),
        )
        distance = np.hypot(*np.meshgrid(made.x, made.y))
        np.testing.assert_allclose(made.path_gain[0], (LAMBDA / (4 * np.pi * distance)) ** 2 / 2, rtol=1e-12)
        self.assertTrue((made.line_of_sight == 1).all())

    def test_bad_input(self):
        sim = street()
        for words, fields in (
            (("cell_m", "above 0"), {"cell_m": 0}),
            (("min_m, max_m", "meets the scene"), {"max_m": [-900, -900], "min_m": [-950, -950]}),
            (("z_m", "within the scene"), {"z_m": 5000.0}),
            (("power_dbm", "1 number, or 2"), {"power_dbm": [1, 2, 3]}),
            (("bandwidth_hz",), {"bandwidth_hz": 0.0}),
            (("noise_figure_db",), {"noise_figure_db": -1.0}),
            (("over", "roofs"), {"over": "clouds"}),
            (("min_m", "[x, y]"), {"min_m": [1, 2, 3]}),
            (("array.rows",), {"array": greatx.Array(rows=0)}),
            (("height_m",), {"height_m": 0.0}),
            (("precoder: expected one of mean, beam",), {"precoder": "zf"}),
            (("beam: expected the index", "precoder beam"), {"precoder": "beam"}),
            (("beam: expected 0 to 7", "'bs/panel'"), {"precoder": "beam", "beam": 8}),
            (("oversampling: expected precoder beam or",), {"oversampling": (1, 1)}),
        ):
            with self.assertRaises(greatx.Error) as caught:
                sim.radio_map(**{**self.AREA, **fields})
            for word in words:
                self.assertIn(word, str(caught.exception))
            self.assertNotIn("--", str(caught.exception))


class SameBytes(unittest.TestCase):
    def test_as_the_data_set(self):
        ds = greatx.load(support.street())
        sim = street()
        for record in ds["csi"]:
            paths = sim.paths(tick=record.tick)
            self.assertEqual(paths.cfr().tobytes(), np.ascontiguousarray(record.cfr).tobytes())
            for name, array in record.paths().items():
                self.assertEqual(array.tobytes(), paths[name].tobytes(), name)
                self.assertEqual((array.dtype, array.shape), (paths[name].dtype, paths[name].shape), name)
            stats = paths.statistics()
            for name in ("path_count", "path_gain", "delay_spread", "k_factor", "line_of_sight"):
                self.assertEqual(stats[name].tobytes(), np.ascontiguousarray(record[name]).tobytes(), name)

    def test_sequences_as_the_data_set(self):
        ds = greatx.load(support.space())
        sim = greatx.Simulation(support.scenario_file("space", support.SPACE), sequences=2, validation=True)
        for sequence in (1, 0):
            for record in reversed(list(ds.sequences[sequence]["csi"])):
                paths = sim.paths(tick=record.tick, sequence=sequence)
                self.assertEqual(paths.cfr().tobytes(), np.ascontiguousarray(record.cfr).tobytes())
                self.assertEqual(paths.facts["counters"]["paths"], 1)

    def test_another_tick_is_as_made_for_it(self):
        everywhere = "max_depth: 2}"
        for change, effects in (
            ({}, {}),
            ({everywhere: "max_depth: 2, search: every_tick}"}, {}),
            ({everywhere: "max_depth: 2, rays: 4096}"}, {}),
            ({}, {"moving_reflectors": "on"}),
            (
                {
                    "tx: [bs/panel, corner/panel], rx: [car/antenna, walker/antenna]": (
                        "tx: [walker/antenna, car/antenna], rx: [bs/panel]"
                    )
                },
                {},
            ),
            ({}, {"dispersion": "on", "moving_reflectors": "on"}),
        ):
            text = support.STREET
            for old, new in change.items():
                self.assertIn(old, text)
                text = text.replace(old, new)
            path = support.scenario_file("changed", text)
            kept = greatx.Simulation(path, effects=effects, validation=True)
            kept.paths(tick=0), kept.paths(tick=3)
            for fresh_too in (kept.paths(tick=2), kept.paths(tick=2)):
                fresh = greatx.Simulation(path, effects=effects, validation=True).paths(tick=2)
                for name in fresh.arrays:
                    self.assertEqual(
                        fresh[name].tobytes(), fresh_too[name].tobytes(), (change, effects, name)
                    )
                self.assertEqual(fresh.cfr().tobytes(), fresh_too.cfr().tobytes(), (change, effects))

    def test_run_as_the_data_set(self):
        ds = greatx.load(support.street())
        ticks = list(street().run())
        self.assertEqual([t.tick for t in ticks], ds.sequences[0].ticks.tolist())
        for tick in ticks:
            kept = ds.at(tick.tick)
            self.assertEqual(list(tick), list(kept))
            self.assertEqual((tick.time_ns, tick.time_s), (kept.time_ns, kept.time_s))
            for sensor, arrays in (
                ("csi", ("cfr", "delay", "vertex")),
                ("poses", ("position",)),
                ("car/front", ("rgb", "depth")),
            ):
                for array in arrays if sensor in kept else ():
                    self.assertEqual(
                        tick[sensor][array].tobytes(), np.ascontiguousarray(kept[sensor][array]).tobytes()
                    )

    def test_twice_and_two_at_once(self):
        a, b = street(), street()
        first = a.paths(tick=1)
        second = b.paths(tick=1)
        a.paths(tick=3)
        for other in (second, a.paths(tick=1)):
            self.assertEqual(first.cfr().tobytes(), other.cfr().tobytes())
        runs = [a.run(), b.run()]
        for x, y in zip(*runs):
            self.assertEqual(x["csi"].cfr.tobytes(), y["csi"].cfr.tobytes())

    def test_threads_share_a_simulation(self):
        sim = street()
        expected = [sim.paths(tick=t).cfr().tobytes() for t in range(4)]
        found = [None] * 4

        def work(t):
            found[t] = sim.paths(tick=t).cfr().tobytes()

        threads = [threading.Thread(target=work, args=(t,)) for t in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, expected)


class Memory(unittest.TestCase):
    def test_arrays_are_the_engines_own(self):
        paths = in_space().paths()
        for name, array in paths.arrays.items():
            self.assertFalse(array.flags.owndata, name)
            self.assertIs(paths[name], array)
            self.assertEqual(type(array.base.obj).__name__, "Buffer")
            self.assertTrue(np.shares_memory(array, np.asarray(array.base.obj)))
        self.assertTrue(np.shares_memory(paths.link(0)["delay"], paths.delay))
        self.assertFalse(paths.cfr().flags.owndata)

    def test_they_outlive_everything_else(self):
        paths = in_space().paths()
        delay, watch = paths.delay, weakref.ref(paths.arrays)
        del paths
        gc.collect()
        self.assertIsNone(watch())
        self.assertAlmostEqual(delay[0], 50 / C, delta=1e-20)

    def test_memory_is_given_back(self):
        paths = in_space().paths()

        def resident():
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

        paths.cfr(subcarriers=1 << 20, subcarrier_spacing_hz=100)
        before = resident()
        for _ in range(40):  # 8 MiB each
            paths.cfr(subcarriers=1 << 20, subcarrier_spacing_hz=100)
        self.assertLess(resident() - before, 64 << 20)

    def test_dlpack(self):
        paths = in_space().paths()
        for array in (paths.delay, paths.amplitude, paths.cfr(), paths.interaction):
            taken = np.from_dlpack(array)
            self.assertEqual(taken.ctypes.data, array.ctypes.data)
            self.assertEqual(taken.dtype, array.dtype)
        try:
            import torch
        except ImportError:
            return
        h = paths.cfr()
        self.assertEqual(torch.from_dlpack(h).data_ptr(), h.ctypes.data)
        self.assertEqual(torch.from_dlpack(h).dtype, torch.complex64)

    def test_no_paths(self):
        paths = in_space().paths(receivers=np.zeros((0, 3)))
        self.assertEqual((len(paths), paths.shape, paths.cfr().shape), (0, (0, 1), (0, 1, 1, 1, 1, 8)))
        self.assertEqual(paths.cir()[0].shape, (0, 1, 1, 1, 0))
        self.assertEqual(paths.vertex.shape[0], 0)


class Errors(unittest.TestCase):
    def check(self, words, function, *arguments, **fields):
        with self.assertRaises(greatx.Error) as caught:
            function(*arguments, **fields)
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)

    def test_bad_input(self):
        sim = in_space()
        paths = sim.paths()
        self.check(["no such scenario", "city"], greatx.Simulation, "nowhere.yaml")
        self.check(["(did you mean 'room'?)"], greatx.Simulation, "rom")
        for seed in (-1, 1.5, 1 << 64):
            self.check(
                ["seed: expected an integer from 0 to 2^64 - 1, found"], greatx.Simulation, EMPTY, seed=seed
            )
        self.check(["ticks", "expected"], greatx.Simulation, {"greatx": 1, "name": "x"})
        self.check(
            ["Simulation: effects", "one of auto, on, off", "'maybe'"],
            greatx.Simulation,
            EMPTY,
            effects={"gas": "maybe"},
        )
        self.check(
            ["place_transmitter: array.rows", "from 1", "'0'"],
            sim.place_transmitter,
            "x",
            [0, 0, 0],
            array=greatx.Array(rows=0),
        )
        self.check(
            ["array.row_spacing_wl", "greater than 0"],
            sim.place_receiver,
            "x",
            [0, 0, 0],
            array=greatx.Array(rows=2, row_spacing_wl=-1),
        )
        self.check(["place_receiver: position_m", "finite"], sim.place_receiver, "x", [0, 0, float("nan")])
        self.check(["name", "free", "'bs'"], sim.place_receiver, "bs", [0, 0, 0])
        self.check(["bandwidth_hz", "greater than 0"], sim.add_channel, "y", bandwidth_hz=0)
        self.check(["'nobody/array'", "bs/array"], sim.add_channel, "y", receivers=["nobody/array"])
        self.check(["no channel 'z'", "csi"], sim.paths, "z")
        self.check(["tick", "0 to 0"], sim.paths, tick=1)
        self.check(["sequence"], sim.paths, sequence=1)
        self.check(["receivers", "[N, 3]"], sim.paths, receivers=[[1, 2]])
        self.check(["receivers[1, 2]", "finite"], sim.paths, receivers=[[1, 2, 3], [1, 2, np.nan]])
        self.check(["receivers=points"], sim.paths, array=greatx.Array())
        self.check(["subcarrier_spacing_hz", "greater than 0"], paths.cfr, bandwidth_hz=-1.0)
        self.check(["subcarriers"], paths.cfr, subcarriers=0)
        self.check(["above 0 Hz"], paths.cfr, 8e9, 4)
        self.check(["select", "line_of_sight"], paths.cfr, select="some")
        self.check(["bandwidth_hz"], paths.taps, 0.0, 4)
        self.check(["taps"], paths.taps, 1e6, 0)
        self.check(["receive_port", "0 to 0"], paths.received, receive_port=1)
        self.check(["level"], paths.coherence, 1.0)
        self.check(["no such"], greatx.Simulation, EMPTY["name"])

    def test_a_fault_changes_nothing(self):
        sim = in_space()
        before = sim.paths().cfr().tobytes()
        with self.assertRaises(greatx.Error):
            sim.place_receiver("x", [0, 0, 0], array=greatx.Array(columns=-1))
        self.assertEqual(sim.nodes, {"bs": {"array": "antenna"}, "ue": {"array": "antenna"}})
        self.assertEqual(sim.paths().cfr().tobytes(), before)

    def test_device(self):
        sim = greatx.Simulation(EMPTY, device="no such device")
        sim.place_transmitter("a", [0, 0, 1])
        sim.add_channel("csi")
        with self.assertRaises(greatx.Error) as caught:
            sim.paths(receivers=[[0, 0, 2.0]])
        self.assertIn("no such device", str(caught.exception))

    def test_points_only(self):
        sim = greatx.Simulation(EMPTY, validation=True)
        sim.place_transmitter("a", [0, 0, 1])
        sim.add_channel("csi")
        self.assertEqual(sim.channels["csi"]["receivers"], [])
        self.assertEqual(len(sim.paths(receivers=[[0, 0, 2.0], [0, 0, 3.0]])), 2)
        self.check(["no receivers", "points"], sim.paths)
        self.check(["no receivers"], sim.run)

    def test_the_air_between_far_points(self):
        """The effects that are on depend on the points of each call and not on earlier calls."""
        far, near = np.array([[1000.0, 0, 20]]), np.array([[0.2, 0, 20]])
        for carrier_hz, environment in ((60e9, {}), (28e9, {"rain_mm_h": 25})):
            sim = greatx.Simulation(EMPTY, environment=environment, validation=True)
            sim.place_transmitter("bs", [0, 0, 20])
            sim.add_channel("csi", carrier_hz=carrier_hz, subcarriers=4, max_depth=0)
            alone = sim.paths(receivers=near).transfer
            self.assertFalse(sim.effects["gas"].on)
            points = sim.paths(receivers=far)
            again = sim.paths(receivers=near).transfer
            level = sim.radio_map(10.0, min_m=[995, -5], max_m=[1005, 5], z_m=20, beyond_scene=True)
            sim.place_receiver("ue", far[0])
            sim.add_channel("node", carrier_hz=carrier_hz, subcarriers=4, max_depth=0)
            node = sim.paths("node")
            self.assertEqual(points.transfer.tobytes(), node.transfer.tobytes())
            self.assertEqual(points.delay[0], node.delay[0])
            self.assertEqual(alone.tobytes(), again.tobytes())
            gain = float(node.statistics()["path_gain"].ravel()[0])
            self.assertAlmostEqual(float(level["path_gain"].ravel()[0]) / gain, 1, places=6)
            dry = greatx.Simulation(
                EMPTY, environment=environment, effects={"gas": "off", "rain": "off"}, validation=True
            )
            dry.place_transmitter("bs", [0, 0, 20])
            dry.add_channel("csi", carrier_hz=carrier_hz, subcarriers=4, max_depth=0)
            ratio = abs(points.transfer[0, 0, 0] / dry.paths(receivers=far).transfer[0, 0, 0])
            self.assertLess(20 * np.log10(ratio), -3)

    def test_interrupt_within_a_search(self):
        """The search would take minutes if it were not interrupted."""
        sim = greatx.Simulation(
            {**EMPTY, "ticks": 2, "scene": {"generate": {"kind": "city", "seed": 9, "size_m": 200}}},
            validation=True,
        )
        sim.place_transmitter("bs", [6.3, -21.7, 30])
        sim.place_receiver("ue", [2.4, 20, 1.5])
        sim.add_channel("csi", max_depth=8, max_transmissions=2)
        sim.add_channel("quick", max_depth=0)
        for work in (
            sim.paths,
            lambda name: sim.paths(name, receivers=[[2.4, 20, 1.5]]),
            lambda name: sim.radio_map(50.0, name),
            lambda name: list(sim.run()),
        ):
            threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
            with self.assertRaises(KeyboardInterrupt):
                work("csi")
        self.assertEqual(sim.paths("quick").shape, (1, 1))
        sim = greatx.Simulation(
            {**EMPTY, "ticks": 2, "scene": {"generate": {"kind": "city", "seed": 9, "size_m": 200}}},
            validation=True,
        )
        sim.place_transmitter("bs", [6.3, -21.7, 30])
        sim.place_receiver("ue", [2.4, 20, 1.5])
        sim.add_channel("csi", max_depth=8, max_transmissions=2, search="every_tick")
        run = sim.run()
        threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            next(run)
        with self.assertRaisesRegex(greatx.Error, "interrupted"):
            next(run)

    def test_interrupt(self):
        sim = street()
        points = np.tile([[0.1, -3, 1.5]], (200_000, 1))
        calls = []

        def progress(done):
            calls.append(done)
            os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            sim.paths(receivers=points, progress=progress)
        self.assertTrue(calls)
        with self.assertRaises(ZeroDivisionError):
            sim.paths(receivers=points, progress=lambda done: 1 // 0)
        self.assertEqual(sim.paths(tick=1).tick, 1)


class Facts(unittest.TestCase):
    def test_overrides(self):
        sim = street(
            seed=5,
            ticks=2,
            effects={"reflection": "off"},
            environment={"rain_mm_h": 200, "sun": {"elevation_deg": 5}},
        )
        self.assertEqual((sim.seed, sim.ticks, sim.name), (5, 2, "street"))
        self.assertFalse(sim.effects["reflection"].on)
        self.assertTrue((sim.paths().interaction[:, 0] != 1).all())
        self.assertIn("reflection", sim.explain())

    def test_what_there_is(self):
        sim = street()
        self.assertEqual(sim.channels["csi"]["receivers"], ["car/antenna", "walker/antenna"])
        self.assertIn("bs/panel", sim.antennas)
        self.assertGreater(sim.scene["triangles"], 100)
        self.assertEqual(len(sim.scene["bounds_m"]), 2)
        self.assertIn("name", sim.device)
        self.assertIn("greatx.Simulation street", repr(sim))

    def test_near_field_is_warned_of(self):
        sim = greatx.Simulation(EMPTY, validation=True)
        sim.place_transmitter("bs", [0, 0, 10], array=greatx.Array(rows=16, columns=16))
        sim.place_receiver("ue", [3, 0, 10])
        sim.add_channel("csi", subcarriers=4)
        with self.assertWarnsRegex(UserWarning, "far field"):
            sim.paths().cfr()

    def test_every_element_is_as_in_runs(self):
        for asked, distance_m, near in ("auto", 3, 1), ("auto", 300, 0), ("on", 300, 1), ("off", 3, 0):
            sim = greatx.Simulation({**EMPTY, "effects": {"every_element": asked}}, validation=True)
            sim.place_transmitter("bs", [0, 0, 10], array=greatx.Array(rows=16, columns=16))
            sim.place_receiver("ue", [distance_m, 0, 10])
            sim.add_channel("csi", subcarriers=4)
            paths = sim.paths()
            self.assertEqual(paths.facts["near_links"], near, (asked, distance_m))
            self.assertEqual(paths.facts["every_element"], asked)
            if asked == "on":
                with self.assertWarnsRegex(UserWarning, "every_element is on"):
                    paths.cfr()
            self.assertEqual(next(iter(sim.run()))["csi"].every_element.item(), near, (asked, distance_m))

    def test_nodes_of_any_kind(self):
        sim = greatx.Simulation({**EMPTY, "ticks": 3, "tick_rate_hz": 10}, validation=True)
        sim.add_node(
            {
                "name": "uav",
                "trajectory": {
                    "type": "waypoints",
                    "points": [{"t_s": 0, "position_m": [30, 0, 10]}, {"t_s": 1, "position_m": [40, 0, 10]}],
                },
                "sensors": [{"name": "antenna", "type": "antenna"}],
            }
        )
        sim.place_transmitter("bs", [0, 0, 10])
        sim.add_channel("csi", receivers=["uav/antenna"], subcarriers=4)
        ticks = list(sim.run())
        self.assertEqual([t["csi"].delay[0] for t in ticks], [sim.paths(tick=t).delay[0] for t in range(3)])
        self.assertAlmostEqual(ticks[2]["csi"].delay[0], 32 / C, delta=1e-20)
        self.assertLess(ticks[2]["csi"].doppler[0], 0)


if __name__ == "__main__":
    unittest.main()
