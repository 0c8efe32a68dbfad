# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests precoders, combiners and codebooks against closed forms, and on the channels of a data set."""
import unittest

import numpy as np
import support

import greatx
from greatx import precoding as pre


def channels(seed, *shape):
    """Returns complex Gaussian numbers of unit power."""
    random = np.random.default_rng(seed)
    return (random.standard_normal(shape) + 1j * random.standard_normal(shape)) / np.sqrt(2)


def line(elements, cosine, spacing_wl=0.5):
    """Returns the channel [1, element] of a plane wave from a line of elements."""
    return np.exp(2j * np.pi * spacing_wl * np.arange(elements) * cosine)[None]


def hermitian(a):
    return np.conj(np.swapaxes(a, -1, -2))


class Codebooks(unittest.TestCase):
    def test_dft_beams_are_orthogonal_and_have_gain_n(self):
        for n in (1, 2, 5, 8):
            book = pre.dft(n)
            np.testing.assert_allclose(book @ hermitian(book), np.eye(n), atol=1e-14)
            for beam in range(n):
                for spacing in (0.5, 0.7):
                    h = line(n, pre.beam_cosine(beam, n, 1, spacing), spacing)
                    gains = pre.beam_gains(h, book)
                    expected = np.where(np.arange(n) == beam, n, 0)
                    np.testing.assert_allclose(gains, expected, atol=1e-12)

    def test_oversampled_beams_point_where_they_say(self):
        for beam in range(32):
            cosine = pre.beam_cosine(beam, 8, 4)
            self.assertTrue(-1 < cosine <= 1)
            gains = pre.beam_gains(line(8, cosine), pre.dft(8, 4))
            self.assertEqual(np.argmax(gains), beam)
            self.assertAlmostEqual(gains[beam], 8)
        np.testing.assert_allclose(np.linalg.norm(pre.dft(8, 4), axis=1), 1)

    def test_panel_beam_is_the_product_of_rows_and_columns(self):
        book = pre.dft_panel(3, 4, (2, 1))
        self.assertEqual(book.shape, (24, 12))
        for row_beam in range(6):
            for beam in range(4):
                up, left = pre.beam_cosine(row_beam, 3, 2), pre.beam_cosine(beam, 4)
                h = np.kron(line(3, up), line(4, left))  # element = row * columns + column
                gains = pre.beam_gains(h, book)
                self.assertEqual(np.argmax(gains), row_beam * 4 + beam)
                self.assertAlmostEqual(gains.max(), 12)

    def test_type1_of_four_ports_is_the_standards(self):
        book = pre.type1(2, 1)
        self.assertEqual(book.precoders.shape, (8 * 4, 4, 1))
        self.assertEqual(book.names, ("i11", "i12", "i2"))
        entry = int(np.flatnonzero((book.indices == (3, 0, 2)).all(1))[0])
        v = np.array([1, np.exp(2j * np.pi * 3 / 8)])  # TS 38.214: u_m = 1, v = [u, e^{j 2 pi l/(O1 N1)} u]
        standard = np.concatenate([v, -v]) / 2  # 1/sqrt(P) [v; phi_2 v], P = 4
        np.testing.assert_allclose(book.precoders[entry, [0, 2, 1, 3], 0], standard, atol=1e-15)

    def test_type1_of_two_layers_is_the_standards(self):
        n1, n2 = 4, 2
        book = pre.type1(n1, n2, 2)
        self.assertEqual(len(book.precoders), 16 * 8 * 4 * 2)
        # The standard's order of ports: polarization, then N1, then N2.
        order = [(row * n1 + column) * 2 + p for p in range(2) for column in range(n1) for row in range(n2)]
        for l, m, i13, n in ((5, 3, 0, 1), (14, 7, 1, 0), (2, 6, 2, 1), (9, 0, 3, 1)):
            k1, k2 = ((0, 0), (4, 0), (0, 4), (8, 0))[i13]  # N1 > N2 > 1
            beams = []
            for a, b in ((l, m), (l + k1, m + k2)):
                u = np.exp(2j * np.pi * b * np.arange(n2) / (4 * n2))
                beams.append(np.concatenate([np.exp(2j * np.pi * a * c / (4 * n1)) * u for c in range(n1)]))
            phi = np.exp(1j * np.pi * n / 2)
            standard = np.block(
                [[beams[0][:, None], beams[1][:, None]], [phi * beams[0][:, None], -phi * beams[1][:, None]]]
            ) / np.sqrt(2 * 16)
            entry = int(np.flatnonzero((book.indices == (l, m, i13, n)).all(1))[0])
            np.testing.assert_allclose(book.precoders[entry][order], standard, atol=1e-14)

    def test_type1_entries_have_unit_power_and_orthogonal_layers(self):
        for n1, n2 in ((1, 1), *pre.TYPE1_PANELS[:8]):
            one, two = pre.type1(n1, n2), pre.type1(n1, n2, 2)
            np.testing.assert_allclose(np.linalg.norm(one.precoders, axis=1), 1)
            gram = hermitian(two.precoders) @ two.precoders
            np.testing.assert_allclose(gram, np.broadcast_to(np.eye(2) / 2, gram.shape), atol=1e-14)
            for book in (one, two):
                self.assertEqual(len(np.unique(book.indices, axis=0)), len(book.indices))

    def test_type1_reaches_the_gain_of_all_ports_on_its_grid(self):
        # A plane wave and a receiver that hears both polarizations a quarter of a turn apart.
        cosine = pre.beam_cosine(5, 4, 4)
        h = np.stack([line(4, cosine), 1j * line(4, cosine)], -1).reshape(1, 8)
        book = pre.type1(4, 1)
        entry, rate = pre.best_entry(h, book, 2.0, 0.1)
        self.assertEqual(tuple(book.indices[entry]), (5, 0, 3))  # phi_3 = -j
        self.assertAlmostEqual(rate, np.log2(1 + 8 * 2.0 / 0.1))

    def test_cross_polarized_beams_are_those_of_type1(self):
        ours = pre.cross_polarized(pre.dft_panel(2, 4, (4, 4)))
        self.assertEqual(ours.shape, (8 * 16 * 4, 16))
        book = pre.type1(4, 2)
        for (l, m, n), w in zip(book.indices, book.precoders[..., 0]):
            np.testing.assert_allclose(ours[(m * 16 + l) * 4 + n], w, atol=1e-15)

    def test_bad_codebooks(self):
        for call, word in (
            (lambda: pre.type1(5), "one of"),
            (lambda: pre.type1(4, 1, 3), "1 or 2 layers, found 3"),
            (lambda: pre.dft(0), "1 or more elements"),
            (lambda: pre.beam_gains(np.ones((1, 4)), pre.dft(5)), r"codebook: expected \[beam, 4\]"),
            (lambda: pre.beam_gains(np.ones((2, 4)), pre.dft(4), pre.dft(3)), r"receive_codebook"),
            (lambda: pre.beam_gains([], pre.dft(4)), "h: expected numbers"),
        ):
            with self.assertRaisesRegex(greatx.Error, word):
                call()


class Precoders(unittest.TestCase):
    def test_maximum_ratio_has_the_norm_of_the_channel(self):
        h = channels(1, 5, 3, 8)  # [..., stream, tx_ant]
        w = pre.maximum_ratio(h)
        gains = np.abs(np.einsum("ckt,ctk->ck", h, w)) ** 2
        np.testing.assert_allclose(gains, np.sum(np.abs(h) ** 2, -1))
        np.testing.assert_allclose(np.linalg.norm(w, axis=-2), 1)
        self.assertTrue((pre.maximum_ratio(np.zeros((2, 4))) == 0).all())

    def test_orthogonal_users_need_nothing_but_maximum_ratio(self):
        h = np.array([3.0, 2.0, 1.0])[:, None] * pre.dft(8)[[1, 4, 6]]
        for w in (pre.maximum_ratio(h), pre.zero_forcing(h), pre.regularized(h, 0.1, 1.0)):
            np.testing.assert_allclose(np.abs(h @ w), np.diag([3.0, 2.0, 1.0]), atol=1e-14)
        got = pre.sinr(h[:, None, :], pre.scaled(pre.zero_forcing(h), 6.0), 0.5)
        np.testing.assert_allclose(got, np.array([9.0, 4.0, 1.0]) * 2.0 / 0.5)

    def test_zero_forcing_leaves_no_interference(self):
        h = channels(2, 4, 6, 8)
        through = np.abs(h @ pre.zero_forcing(h))
        own = np.eye(6, dtype=bool)
        self.assertLess(through[:, ~own].max(), 1e-13)
        # Its gain is 1/[(H H^H)^-1]_kk.
        inverse = np.linalg.inv(h @ hermitian(h))
        np.testing.assert_allclose(through[:, own] ** 2, 1 / np.real(np.einsum("ckk->ck", inverse)))

    def test_zero_forcing_refuses_dependent_users(self):
        h = channels(3, 2, 3, 8)
        h[1, 2] = h[1, 0] * 2j
        with self.assertRaisesRegex(greatx.Error, "found 1 dependent"):
            pre.zero_forcing(h)
        with self.assertRaisesRegex(greatx.Error, "at most as many streams as antennas, found 9 and 8"):
            pre.zero_forcing(channels(3, 9, 8))
        with self.assertRaisesRegex(greatx.Error, "noise and power above 0"):
            pre.regularized(h, 0.0, 1.0)

    def test_regularized_lies_between_zero_forcing_and_maximum_ratio(self):
        h = channels(4, 4, 8)
        for noise, limit in ((1e-12, pre.zero_forcing(h)), (1e12, pre.maximum_ratio(h))):
            overlap = np.abs(np.sum(np.conj(limit) * pre.regularized(h, noise, 1.0), axis=0))
            np.testing.assert_allclose(overlap, 1, atol=1e-9)
        # The sum of rates beats both where neither limit holds.
        noise = 2.0

        def sum_rate(w):
            return pre.spectral_efficiency(pre.sinr(h[:, None, :], pre.scaled(w, 8.0), noise)).sum()

        best = sum_rate(pre.regularized(h, noise, 8.0))
        self.assertGreater(best, sum_rate(pre.zero_forcing(h)))
        self.assertGreater(best, sum_rate(pre.maximum_ratio(h)))

    def test_scaled_precoders_have_their_power(self):
        w = pre.zero_forcing(channels(5, 7, 3, 4))
        np.testing.assert_allclose(np.sum(np.abs(pre.scaled(w, 6.0)) ** 2, axis=(-2, -1)), 6.0)
        power = np.array([1.0, 0.0, 4.0])
        np.testing.assert_allclose(
            np.sum(np.abs(pre.scaled(w, power)) ** 2, axis=-2), np.broadcast_to(power, (7, 3))
        )
        with self.assertRaisesRegex(greatx.Error, "0 W or more"):
            pre.scaled(w, -1.0)

    def test_combined_streams_are_the_strongest(self):
        h = channels(6, 5, 3, 4, 8)  # [..., user, rx_ant, tx_ant]
        rows, u = pre.combined(h)
        np.testing.assert_allclose(np.linalg.norm(u, axis=-1), 1)
        np.testing.assert_allclose(np.linalg.norm(rows, axis=-1), np.linalg.norm(h, 2, axis=(-2, -1)))
        np.testing.assert_allclose(rows, np.einsum("ckr,ckrt->ckt", np.conj(u), h))


class OneUser(unittest.TestCase):
    def test_svd_streams_do_not_meet(self):
        h = channels(7, 6, 3, 5)
        streams = pre.svd(h)
        diagonal = hermitian(streams.combiner) @ h @ streams.precoder
        np.testing.assert_allclose(diagonal, np.sqrt(streams.gain)[..., None] * np.eye(3), atol=1e-13)
        np.testing.assert_allclose(streams.gain.sum(-1), np.sum(np.abs(h) ** 2, axis=(-2, -1)))

    def test_water_filling_meets_its_conditions(self):
        """Karush, Kuhn and Tucker: the derivative of the rate, 1/(ground + p), is the same where p > 0 and
        not larger where p = 0, and the powers add up."""
        random = np.random.default_rng(8)
        gain = random.exponential(size=(200, 6)) * 10.0 ** random.uniform(-3, 3, (200, 6))
        gain[:20, 2] = 0.0
        power = 10.0 ** random.uniform(-3, 3, 200)
        p = pre.water_filling(gain, power, 0.7)
        np.testing.assert_allclose(p.sum(-1), power)
        self.assertTrue((p >= 0).all() and (p[:20, 2] == 0).all())
        with np.errstate(divide="ignore"):
            slope = 1 / (0.7 / gain + p)
        wet = p > 0
        level = np.max(slope, axis=-1, keepdims=True)
        np.testing.assert_allclose(slope[wet], np.broadcast_to(level, p.shape)[wet], rtol=1e-9)
        self.assertTrue((slope <= level * (1 + 1e-12)).all())
        self.assertGreater((wet.sum(-1) == 1).sum(), 0)
        self.assertGreater((wet.sum(-1) == 6).sum(), 0)

    def test_water_filling_by_hand(self):
        # Grounds 1, 2 and 4, three units of power: level 3, two streams under water.
        np.testing.assert_allclose(pre.water_filling([1.0, 0.25, 0.5], 3.0, 1.0), [2.0, 0.0, 1.0])
        np.testing.assert_array_equal(pre.water_filling(np.zeros(3), 3.0, 1.0), np.zeros(3))
        np.testing.assert_array_equal(pre.water_filling([4.0, 1.0], 0.0, 1.0), np.zeros(2))
        with self.assertRaisesRegex(greatx.Error, "noise above 0"):
            pre.water_filling([1.0], 1.0, 0.0)

    def test_capacity_is_at_least_that_of_equal_powers(self):
        h = channels(9, 50, 4, 4)
        full = pre.capacity(h, 4.0, 0.5)
        equal = pre.rate(h, np.eye(4), 0.5)
        self.assertTrue((full >= equal - 1e-12).all())
        # At low power all goes into the strongest stream.
        low = pre.capacity(h, 1e-6, 0.5)
        np.testing.assert_allclose(low, np.log2(1 + 1e-6 * pre.svd(h).gain[..., 0] / 0.5))
        # One antenna at each end is Shannon's.
        np.testing.assert_allclose(pre.capacity([[2.0]], 3.0, 0.5), np.log2(1 + 4 * 3 / 0.5))

    def test_rate_of_the_svd_precoder_is_the_capacity(self):
        h = channels(10, 20, 3, 6)
        streams = pre.svd(h)
        w = pre.scaled(streams.precoder, pre.water_filling(streams.gain, 2.0, 0.3))
        np.testing.assert_allclose(pre.rate(h, w, 0.3), pre.capacity(h, 2.0, 0.3))

    def test_one_entry_over_axes(self):
        h = channels(11, 3, 5, 2, 4)
        book = pre.type1(2, 1)
        entry, rate = pre.best_entry(h, book, 1.0, 0.1, over=(0, 1))
        rates = [pre.rate(h, w, 0.1).mean() for w in book.precoders]
        self.assertEqual((entry, rate), (np.argmax(rates), np.max(rates)))
        with self.assertRaisesRegex(greatx.Error, "axes from 0 to 1"):
            pre.best_entry(h, book, 1.0, 0.1, over=(2,))


class ManyUsers(unittest.TestCase):
    def test_sinr_by_hand(self):
        h = np.array([[[1.0, 0.0]], [[1.0, 2.0]]])  # [user, 1, tx_ant]
        w = np.array([[2.0, 0.0], [0.0, 3.0]])
        np.testing.assert_allclose(pre.sinr(h, w, 0.5), [4 / 0.5, 36 / (4 + 0.5)])
        np.testing.assert_allclose(pre.sinr(h, w, [0.5, 1.0]), [4 / 0.5, 36 / (4 + 1.0)])
        np.testing.assert_allclose(pre.spectral_efficiency([0.0, 1.0, 3.0]), [0.0, 1.0, 2.0])

    def test_mmse_is_the_best_combiner(self):
        h, w = channels(12, 4, 3, 2, 8), channels(13, 4, 8, 3)
        best = pre.sinr(h, w, 0.2)
        arriving = h @ w[:, None]
        for k in range(3):
            others = np.delete(arriving[:, k], k, axis=-1)
            r = others @ hermitian(others) + 0.2 * np.eye(2)
            u = np.zeros((4, 3, 2), complex)
            u[:, k] = np.linalg.solve(r, arriving[:, k, :, k, None])[..., 0]
            u[:, [j for j in range(3) if j != k]] = 1.0
            np.testing.assert_allclose(pre.sinr(h, w, 0.2, u)[:, k], best[:, k])
        for seed in range(20):
            other = pre.sinr(h, w, 0.2, channels(20 + seed, 4, 3, 2))
            self.assertTrue((other <= best * (1 + 1e-12)).all())

    def test_a_single_user_has_its_rate(self):
        h, w = channels(14, 9, 1, 3, 4), channels(15, 9, 4, 1)
        got = pre.spectral_efficiency(pre.sinr(h, w, 0.3))[:, 0]
        np.testing.assert_allclose(got, pre.rate(h[:, 0], w, 0.3))

    def test_two_transmitters_as_blocks(self):
        h = channels(16, 2, 1, 8)  # four antennas of each of two transmitters
        w = np.zeros((8, 2), complex)
        w[:4, 0], w[4:, 1] = channels(17, 4), channels(18, 4)
        expected = [abs(h[k, 0] @ w[:, k]) ** 2 / (abs(h[k, 0] @ w[:, 1 - k]) ** 2 + 0.1) for k in range(2)]
        np.testing.assert_allclose(pre.sinr(h, w, 0.1), expected)

    def test_bad_shapes(self):
        with self.assertRaisesRegex(greatx.Error, r"w: expected \[\.\.\., 4, 2\]"):
            pre.sinr(channels(1, 2, 1, 4), channels(1, 4, 3), 1.0)
        with self.assertRaisesRegex(greatx.Error, "noise_w: expected more than 0"):
            pre.sinr(channels(1, 2, 1, 4), channels(1, 4, 2), 0.0)
        with self.assertRaisesRegex(greatx.Error, "cfr: expected"):
            pre.matrices(np.ones((2, 2)))
        with self.assertRaisesRegex(IndexError, "tx: expected 0 to 0, found 1"):
            pre.matrices(np.ones((2, 1, 1, 4, 1, 3)), tx=1)


class DataSet(unittest.TestCase):
    def test_matrices_are_the_arrays(self):
        csi = greatx.load(support.street())["csi"]
        h = pre.matrices(
            csi.cfr, tx=1
        )  # 2 receivers with 1 port, panels with 4 ports, 3 times, 64 subcarriers
        self.assertEqual(h.shape, (4, 3, 64, 2, 1, 4))
        self.assertEqual(h[2, 1, 7, 0, 0, 3], csi.cfr[2, 0, 0, 1, 3, 1, 7])

    def test_labels_are_the_strongest_beams(self):
        csi = greatx.load(support.street())["csi"]
        book = pre.type1(2, 1).precoders[..., 0]
        labels = pre.best_beams(csi.cfr, book, tx=0, k=3)
        self.assertEqual(labels.beam.shape, (4, 2, 3))
        for record in range(4):
            for rx in range(2):
                h = csi.cfr[record, rx, 0, 0].astype(complex)  # [tx_ant, time, subcarrier]
                gains = np.mean(np.abs(np.einsum("bt,tnf->bnf", book, h)) ** 2, axis=(1, 2))
                self.assertEqual(labels.beam[record, rx, 0], np.argmax(gains))
                np.testing.assert_allclose(labels.gain[record, rx], np.sort(gains)[::-1][:3])
        with self.assertRaisesRegex(greatx.Error, "1 to 32 beams"):
            pre.best_beams(csi.cfr, book, k=33)

    def test_a_receiver_without_power_has_no_beam(self):
        cfr = np.zeros((2, 1, 1, 4, 1, 3), np.complex64)
        cfr[1] = 1
        labels = pre.best_beams(cfr, pre.dft(4), k=2)
        np.testing.assert_array_equal(labels.beam[0], [-1, -1])
        self.assertEqual(labels.beam[1, 0], 0)
        np.testing.assert_allclose(labels.gain, [[0, 0], [4, 0]], atol=1e-30)

    def test_users_of_a_street(self):
        h = pre.matrices(greatx.load(support.street())["csi"].cfr)
        noise = pre.noise_w(100e6 / 64, 7.0)
        self.assertAlmostEqual(10 * np.log10(noise * 1e3), -173.98 + 10 * np.log10(100e6 / 64) + 7, places=2)
        rows, u = pre.combined(h)
        powers = {}
        for name, w in (
            ("mr", pre.maximum_ratio(rows)),
            ("zf", pre.zero_forcing(rows)),
            ("rzf", pre.regularized(rows, noise, 1e-3)),
        ):
            got = pre.sinr(h, pre.scaled(w, 1e-3), noise, u)
            self.assertEqual(got.shape, (4, 3, 64, 2))
            powers[name] = pre.spectral_efficiency(got).sum(-1).mean()
        # Without interference zero-forcing has the SNR of its gain.
        zf = pre.zero_forcing(rows)
        gain = np.abs(np.einsum("...kt,...tk->...k", rows, zf)) ** 2
        np.testing.assert_allclose(
            pre.sinr(h, pre.scaled(zf, 1e-3), noise, u), gain * 0.5e-3 / noise, rtol=1e-6
        )
        self.assertGreater(powers["rzf"], 0.999 * max(powers["mr"], powers["zf"]))


if __name__ == "__main__":
    unittest.main()
