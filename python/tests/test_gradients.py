# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests derivatives of channels: against differences, each direction against the other, and with torch."""

import contextlib
import io
import pathlib
import re
import subprocess
import sys
import unittest
import warnings

import numpy as np

import greatx
from greatx import gradients

try:
    import torch
except ImportError:
    torch = None

#: A room with thin walls. Two transmitters get antennas of two polarizations.
ROOM = {
    "greatx": 1,
    "name": "room",
    "ticks": 1,
    "scene": {"generate": {"kind": "room"}},
    "effects": {"roughness": "on", "scattering": "off", "target_echoes": "off"},
}


def room(**effects):
    sim = greatx.Simulation(ROOM, effects=effects)
    panel = greatx.Array(rows=1, columns=2, pattern="tr38901", polarization="slant")
    sim.place_transmitter("a", [-4.7, 2.9, 2.8], array=panel, look_at=[0, 0, 1])
    sim.place_transmitter("b", [4.1, -2.5, 2.1], array=panel, look_at=[0, 0.3, 1])
    sim.add_channel("csi", receivers=[], carrier_hz=3.5e9, bandwidth_hz=100e6, subcarriers=8, max_depth=2)
    return sim


POINTS = np.array([[0.7, -2.2, 1.5], [-1.3, 0.4, 1.1], [2.9, 1.7, 0.8]])


def solved(sim, points=POINTS):
    antenna = greatx.Array(pattern="short_dipole", polarization="vh", polarization_model=1)
    return sim.paths("csi", receivers=points, array=antenna, orientation_deg=[20, 35, -15])


def numeric(function, step):
    """Returns the derivative at 0 by central differences, extrapolated twice."""

    def central(h):
        return (function(h) - function(-h)) / (2 * h)

    wide, half, quarter = (central(step / 2**i) for i in range(3))
    return (16 * (4 * quarter - half) - (4 * half - wide)) / 45


def steps(name, value):
    if name == "carrier":
        return 1e5
    if name.startswith("material:"):
        return 2e-3 * value
    return 2e-4 if name.endswith("position") else 2e-3


class Derivatives(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sim = room(diffraction="on")
        cls.paths = solved(cls.sim)
        cls.known = cls.paths.parameters()
        rng = np.random.default_rng(1)
        # No value is at an end of its range, and all of them differ from the scenario's.
        cls.point = {}
        for name, value in cls.known.items():
            if name == "carrier":
                continue
            shift = rng.uniform(0.5, 1, value.shape)
            if name.startswith("material:"):
                least = {"conductivity": 0.01, "roughness": 0.003}.get(name.split(".")[-1], 0.1)
                cls.point[name] = np.maximum(value, min(least, 0.1)) * (1 + 0.05 * shift)
            elif name.endswith("gain"):
                cls.point[name] = value + 0.3j * shift
            else:
                cls.point[name] = value + 0.02 * shift
        cls.grid = dict(subcarriers=5, bandwidth_hz=80e6, time_samples=2, time_spacing_s=1e-3)

    def cfr(self, changes):
        return self.paths.cfr(parameters={**self.point, **changes}, **self.grid)

    def test_every_parameter_against_differences(self):
        names = list(self.point)
        found = self.paths.jacobian(names, parameters=self.point, **self.grid)
        self.assertEqual(found.values.shape[:-1], self.cfr({}).shape)
        self.assertEqual(found.values.shape[-1], len(found.columns))
        for column, name in enumerate(found.columns):
            parameter, _, axis = name.rpartition(".") if name[-2:] in (".x", ".y", ".z") else (name, "", "")
            value = self.point[parameter]
            with self.subTest(name):
                direction = np.ones(value.shape)
                if axis:
                    direction *= np.eye(3)["xyz".index(axis)]
                expected = numeric(
                    lambda by: self.cfr({parameter: value + by * direction}),
                    steps(parameter, np.abs(value).max()),
                )
                error = np.abs(found.values[..., column] - expected).max()
                self.assertLessEqual(error, 1e-7 * np.abs(expected).max() + 1e-16)

    def test_carrier_against_differences(self):
        point = {n: v for n, v in self.point.items() if not n.startswith("material:")}
        found = self.paths.jacobian("carrier", parameters=point, **self.grid).values[..., 0]
        carrier = self.known["carrier"]
        expected = numeric(
            lambda by: self.paths.cfr(parameters={**point, "carrier": carrier + by}, **self.grid), 1e5
        )
        self.assertLess(np.abs(found - expected).max(), 1e-7 * np.abs(expected).max())

    def test_quantities_against_differences(self):
        names = ["material:concrete.permittivity", "receiver.position", "transmitter.gain", "receiver.slant"]
        names += ["transmitter.attitude", "transmitter.position"]
        for of in gradients.QUANTITIES[1:]:
            found = self.paths.jacobian(names, of, parameters=self.point)
            for column, name in enumerate(found.columns):
                parameter, _, axis = (
                    name.rpartition(".") if name[-2:] in (".x", ".y", ".z") else (name, "", "")
                )
                value = self.point[parameter]
                direction = np.eye(3)["xyz".index(axis)] if axis else np.ones(value.shape)

                def quantity(by):
                    return self.paths.vary({**self.point, parameter: value + by * direction}).quantities()[of]

                with self.subTest(of=of, name=name):
                    expected = numeric(quantity, steps(parameter, np.abs(value).max()))
                    error = np.abs(found.values[..., column] - expected).max()
                    # Differences of a quantity that does not change are its roundings.
                    least = 1e-11 * np.abs(quantity(0)).max()
                    self.assertLessEqual(error, 1e-7 * np.abs(expected).max() + least)

    def test_delays_and_quantities_are_those_of_the_paths(self):
        towards = self.paths["arrival"]
        zenith, azimuth = towards[:, 0], towards[:, 1]
        direction = [np.sin(zenith) * np.cos(azimuth), np.sin(zenith) * np.sin(azimuth), np.cos(zenith)]
        delays = self.paths.jacobian(["receiver.position"], "delay").values
        np.testing.assert_allclose(delays, -np.stack(direction, axis=1) / 299792458.0, atol=1e-22)
        values, statistics = self.paths.vary().quantities(), self.paths.statistics()
        np.testing.assert_array_equal(values.delay, self.paths.delay)
        for name in ("path_gain", "mean_delay", "delay_spread"):
            np.testing.assert_allclose(values[name], statistics[name], rtol=1e-12)

    def test_gradient_is_the_jacobian_contracted(self):
        rng = np.random.default_rng(2)
        h = self.cfr({})
        loss = rng.standard_normal(h.shape) + 1j * rng.standard_normal(h.shape)
        names = list(self.point)
        found = self.paths.gradient(names, loss, parameters=self.point, **self.grid)
        columns = self.paths.jacobian(names, parameters=self.point, **self.grid)
        for name in names:
            own = [i for i, of in enumerate(columns.columns) if of in (name, *(f"{name}.{x}" for x in "xyz"))]
            parts = np.conj(loss)[..., None] * columns.values[..., own]  # [rx, u, tx, s, t, f, column]
            end = "rutsmfc->"
            if name.endswith("gain"):
                expected = np.conj(np.einsum(end + ("ru" if name[0] == "r" else "ts"), parts))
            elif name.endswith("slant"):
                # [rx, element, polarization, tx, element, polarization, ...]
                parts = parts.reshape(3, 1, 2, 2, 2, 2, *parts.shape[4:])
                expected = np.einsum("reptEPmfc->" + ("rp" if name[0] == "r" else "tP"), parts).real
            elif name.startswith("material:"):
                expected = parts.real.sum()
            else:
                expected = np.einsum(end + ("rc" if name[0] == "r" else "tc"), parts).real
            with self.subTest(name):
                size = np.abs(parts).sum()
                self.assertEqual(found[name].shape, self.known[name].shape)
                self.assertLessEqual(np.abs(found[name] - expected).max(), 1e-12 * size)

    def test_values_of_the_scenario_give_its_response(self):
        exact = self.paths.cfr(parameters={})
        rounded = self.paths.cfr()
        self.assertEqual(exact.dtype, np.complex128)
        np.testing.assert_array_equal(exact.astype(np.complex64), rounded)
        again = self.paths.cfr(parameters={name: value for name, value in self.known.items()})
        np.testing.assert_array_equal(again, exact)

    def test_continued_paths_are_those_that_are_solved_there(self):
        moved = POINTS + [[0.004, -0.003, 0.002]]
        there = solved(self.sim, moved)
        changes = there.changes_since(self.paths)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            h = self.paths.cfr(parameters={"receiver.position": moved})
        for rx, tx in np.ndindex(self.paths.shape):
            if changes.born[rx, tx] or changes.died[rx, tx]:
                continue
            expected = there.cfr(parameters={})[rx, :, tx]
            np.testing.assert_allclose(h[rx, :, tx], expected, rtol=0, atol=1e-11 * np.abs(expected).max())
        self.assertTrue(np.any((changes.born == 0) & (changes.died == 0)))

    def test_what_is_gone_is_counted(self):
        with self.assertWarnsRegex(
            UserWarning, "of [0-9]+ paths, .* are (beyond|blocked|lost).*Simulation.paths"
        ):
            variation = self.paths.vary({"receiver.position": [20.0, 9.0, 1.0]})
        facts = variation.facts
        self.assertEqual(facts["paths"], len(self.paths))
        self.assertGreater(facts["beyond"] + facts["blocked"] + facts["lost"], 0.5 * len(self.paths))
        self.assertEqual(self.paths.vary({}).facts, dict(facts, beyond=0, blocked=0, lost=0))

    def test_blocked_paths_are_counted(self):
        sim = greatx.Simulation("room")
        paths = sim.paths("csi", receivers=[[0.0, 0.0, 1.5]])
        rng = np.random.default_rng(3)
        for _ in range(5):
            place = rng.uniform([-4, -2.5, 0.5], [4, 2.5, 2.5])
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                facts = paths.vary({"receiver.position": place}).facts
            there = sim.paths("csi", receivers=[place])
            kept = int(there.changes_since(paths).kept.sum())
            self.assertEqual(facts["paths"] - facts["beyond"] - facts["blocked"] - facts["lost"], kept)

    def test_no_path_and_one_path(self):
        sim = (
            greatx.Simulation.from_scene("plane.glb")
            if False
            else greatx.Simulation(
                {"greatx": 1, "name": "empty", "ticks": 1, "scene": {"generate": {"kind": "room"}}}
            )
        )
        sim.place_transmitter("a", [0.0, 0.0, 1.0])
        sim.add_channel("csi", receivers=[], carrier_hz=3.5e9, bandwidth_hz=20e6, subcarriers=4, max_depth=0)
        outside = sim.paths(receivers=[[500.0, 0.0, 1.0]])
        self.assertEqual(len(outside), 0)
        gradient = outside.gradient(["receiver.position", "transmitter.gain"], np.ones((1, 1, 1, 1, 1, 4)))
        np.testing.assert_array_equal(gradient["receiver.position"], np.zeros((1, 3)))
        self.assertEqual(outside.jacobian(["carrier"]).values.shape, (1, 1, 1, 1, 1, 4, 1))
        one = sim.paths(receivers=[[1.0, 0.5, 1.2]])
        self.assertEqual(len(one), 1)
        # dH/dx = -(1/L + j 2 pi f/c) H dL/dx, with a vertical polarization of the isotropic elements.
        h = one.cfr(parameters={})[0, 0, 0, 0, 0]
        away = np.array([1.0, 0.5, 0.2])
        length = np.linalg.norm(away)
        f = 3.5e9 + (np.arange(4) - 2) * 5e6
        found = one.jacobian(["receiver.position"]).values[0, 0, 0, 0, 0]
        expected = -(1 / length + 2j * np.pi * f / 299792458.0)[:, None] * h[:, None] * away / length
        np.testing.assert_allclose(found, expected, rtol=1e-12)

    def test_bad_input(self):
        paths = self.paths
        h = paths.cfr()
        for call, words in (
            (lambda: paths.jacobian(["material:concret.permittivity"]), "material:concrete.permittivity"),
            (lambda: paths.cfr(parameters={"receiver.positon": 0}), "did you mean 'receiver.position'"),
            (
                lambda: paths.cfr(parameters={"receiver.position": [1, 2]}),
                r"broadcast to \[3, 3\], found \[2\]",
            ),
            (lambda: paths.cfr(parameters={"carrier": "high"}), "carrier: expected numbers"),
            (lambda: paths.cfr(parameters={"carrier": -1.0}), "carrier: expected a frequency above 0"),
            (lambda: paths.cfr(parameters={"receiver.position": np.nan}), "expected finite numbers"),
            (
                lambda: paths.cfr(parameters={"material:concrete.conductivity": -0.1}),
                "material:concrete.conductivity: expected a finite number from 0 up, found -0.1",
            ),
            (
                lambda: paths.cfr(parameters={"material:concrete.permittivity": 5.0, "carrier": 3e9}),
                "carrier: expected materials with their own",
            ),
            (  # above 0 Hz at the scenario's carrier, but not at this one
                lambda: paths.cfr(bandwidth_hz=3e9, subcarriers=4, parameters={"carrier": 1.2e9}),
                "subcarriers: expected every one above 0 Hz",
            ),
            (lambda: paths.cfr(parameters={}, normalize_delays=True), "normalize_delays: expected False"),
            (lambda: paths.jacobian(["carrier"], "pwer"), "of: expected one of .*did you mean 'power'"),
            (lambda: paths.gradient(["carrier"], h[..., :3]), "cotangent: expected [0-9]+ complex numbers"),
        ):
            with self.subTest(words), self.assertRaisesRegex(greatx.Error, words):
                call()
        with self.assertRaisesRegex(greatx.Error, "dispersion is on"):
            solved(room(dispersion="on")).jacobian(["receiver.position"])


class Street(unittest.TestCase):
    def test_every_effect_against_differences(self):
        effects = (
            "diffraction",
            "corner_diffraction",
            "scattering",
            "roughness",
            "wave_curvature",
            "beam_squint",
        )
        street = {"greatx": 1, "name": "street", "ticks": 1}
        street["scene"] = {"generate": {"kind": "canyon", "seed": 9, "size_m": 60}}
        sim = greatx.Simulation(street, effects=dict.fromkeys(effects, "on"))
        panel = greatx.Array(rows=1, columns=2, polarization="slant")
        sim.place_transmitter("mast", [6.3, -21.7, 9.4], array=panel)
        sim.add_channel(
            "csi", receivers=[], bandwidth_hz=100e6, subcarriers=4, max_depth=2, scattering_patch_m=8
        )
        paths = sim.paths(receivers=[[2.4, -12, 1.6], [-3.1, 5.2, 1.3]], array=greatx.Array(rows=2))
        kinds = paths["interaction"]
        for kind in (1, 3, 4):
            self.assertTrue(np.any(kinds == kind))
        known = paths.parameters()
        names = ["receiver.position", "transmitter.attitude", "material:asphalt.scattering", "carrier"]
        found = paths.jacobian(names, subcarriers=2)
        for column, name in enumerate(found.columns):
            parameter, _, axis = name.rpartition(".") if name[-2:] in (".x", ".y", ".z") else (name, "", "")
            value = known[parameter]
            direction = np.eye(3)["xyz".index(axis)] if axis else 1.0
            expected = numeric(
                lambda by: paths.cfr(parameters={parameter: value + by * direction}, subcarriers=2),
                steps(parameter, np.abs(value).max()),
            )
            with self.subTest(name):
                error = np.abs(found.values[..., column] - expected).max()
                self.assertLess(error, 1e-8 * np.abs(expected).max() + 1e-15)

    def test_the_same_bytes_again(self):
        sim = room()
        paths = solved(sim)
        loss = paths.cfr() * (1 + 2j)
        names = list(paths.parameters())
        first, second = paths.gradient(names, loss), paths.gradient(names, loss)
        for name in names:
            self.assertEqual(first[name].tobytes(), second[name].tobytes(), name)


@unittest.skipIf(torch is None, "no torch")
class Torch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.paths = solved(room())

    def test_gradcheck(self):
        names = [
            "material:concrete.permittivity",
            "receiver.position",
            "transmitter.gain",
            "receiver.attitude",
        ]
        known = self.paths.parameters()
        values = [torch.tensor(known[name], requires_grad=True) for name in names]
        function = lambda *tensors: self.paths.cfr(parameters=dict(zip(names, tensors)), subcarriers=2)
        # A step of 1e-6 m turns phases by 1e-4 rad.
        self.assertTrue(torch.autograd.gradcheck(function, values, eps=1e-6, atol=1e-8, rtol=1e-5))

    def test_the_gradient_of_a_real_loss_is_that_of_pytorch(self):
        place = torch.tensor(POINTS, requires_grad=True)
        h = self.paths.cfr(parameters={"receiver.position": place})
        self.assertEqual(h.dtype, torch.complex128)
        loss = (h.real * 3 + h.imag**2).sum()
        (of_h,) = torch.autograd.grad(loss, h, retain_graph=True)
        # PyTorch's convention: dL/d Re H + j dL/d Im H.
        torch.testing.assert_close(of_h, torch.complex(torch.full_like(h.real, 3.0), 2 * h.imag))
        loss.backward()
        expected = self.paths.gradient(["receiver.position"], of_h.detach().numpy())["receiver.position"]
        np.testing.assert_array_equal(place.grad.numpy(), expected)

    def test_one_value_for_all_ends_gets_the_sum(self):
        turn = torch.zeros(3, dtype=torch.float64, requires_grad=True)
        h = self.paths.cfr(parameters={"receiver.attitude": turn})
        h.abs().square().sum().backward()
        full = torch.zeros(3, 3, dtype=torch.float64, requires_grad=True)
        self.paths.cfr(parameters={"receiver.attitude": full}).abs().square().sum().backward()
        torch.testing.assert_close(turn.grad, full.grad.sum(0))

    def test_single_precision_stays_single(self):
        eta = torch.tensor(5.0, requires_grad=True)
        h = self.paths.cfr(parameters={"material:concrete.permittivity": eta, "carrier": 3.5e9})
        self.assertEqual(h.dtype, torch.complex64)
        h.abs().sum().backward()
        self.assertEqual(eta.grad.dtype, torch.float32)
        self.assertNotEqual(eta.grad.item(), 0)

    def test_bad_tensors(self):
        with self.assertRaisesRegex(greatx.Error, "receiver.position: expected a tensor that broadcasts"):
            self.paths.cfr(parameters={"receiver.position": torch.zeros(7)})
        with self.assertRaisesRegex(greatx.Error, "expected a real tensor"):
            self.paths.cfr(parameters={"carrier": torch.tensor(1j)})


class Page(unittest.TestCase):
    def test_the_code_of_the_page_works(self):
        page = pathlib.Path(__file__).resolve().parents[2] / "docs/gradients.md"
        blocks = re.findall(r"```python\n(.*?)```", page.read_text(), re.DOTALL)
        self.assertEqual(len(blocks), 3)
        scope, printed = {}, io.StringIO()
        with contextlib.redirect_stdout(printed):
            for block in blocks:
                if torch is not None or "import torch" not in block:
                    exec(compile(block, str(page), "exec"), scope)
        self.assertEqual(scope["slopes"].values.shape, (2, 1, 1, 2, 1, 256, 4))
        gain = scope["gain"]  # with diffraction: the table of the page
        np.testing.assert_allclose(gain, [-79.59, -78.32, -78.30, -77.08], atol=0.01)
        self.assertRegex(printed.getvalue(), r"off \[-600.   -600.    -73.16  -73.14\]")


class WithoutTorch(unittest.TestCase):
    def test_torch_is_imported_for_tensors_only(self):
        code = "import sys, greatx; assert 'torch' not in sys.modules"
        subprocess.run([sys.executable, "-c", code], check=True)
        self.assertFalse(gradients.is_tensor(np.zeros(3)))


if __name__ == "__main__":
    unittest.main()
