# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the reader of TFRecords and of DICHASUS data sets on small files of their schema, and on damage."""
import json
import pathlib
import struct
import tempfile
import unittest

import numpy as np

from greatx.errors import Error
from tasks.csi_feedback import dichasus, tfrecord


# The next functions write what tfrecord.py reads, from the formats' descriptions and with a check of their
# own, bit by bit.


def slow_crc32c(data):
    state = 0xFFFFFFFF
    for byte in data:
        state ^= byte
        for _ in range(8):
            state = (state >> 1) ^ (0x82F63B78 if state & 1 else 0)
    return state ^ 0xFFFFFFFF


def check(data):
    crc = slow_crc32c(data)
    return struct.pack("<I", (((crc >> 15) | (crc << 17)) + 0xA282EAD8) % (1 << 32))


def framed(data):
    length = struct.pack("<Q", len(data))
    return length + check(length) + data + check(data)


def varint(value):
    out = b""
    while value > 127:
        out, value = out + bytes([value & 127 | 128]), value >> 7
    return out + bytes([value])


def field(number, data):
    return varint(number << 3 | 2) + varint(len(data)) + data


def tensor_proto(array):
    kind = {"float32": 1, "float64": 2, "int32": 3, "int64": 9}[array.dtype.name]
    shape = b"".join(field(2, b"\x08" + varint(n)) for n in array.shape)
    return b"\x08" + varint(kind) + field(2, shape) + field(4, array.tobytes())


def example(features):
    """Returns a tf.train.Example of bytes, floats (packed) and lists of integers."""
    entries = b""
    for name, value in features.items():
        if isinstance(value, bytes):
            feature = field(1, field(1, value))
        elif isinstance(value, float):
            feature = field(2, field(1, struct.pack("<f", value)))
        else:
            feature = field(3, field(1, b"".join(varint(v % (1 << 64)) for v in value)))
        entries += field(1, field(1, name.encode()) + field(2, feature))
    return field(1, entries)


ANTENNAS, SUBCARRIERS = 64, 48
PANEL = np.random.default_rng(0).permutation(ANTENNAS)[:32].reshape(4, 8)
SPEC = {
    "name": "test",
    "bandwidth": 50e6,
    "frequency": 3438000000,
    "antennas": [{"assignments": PANEL.tolist()}],
    "format": {"csi": {"type": "tensor"}, "pos-tachy": {"type": "tensor64"}, "time": {"type": "float32"}},
}


def record(row, column, delay, position, sto=None, cpo=None):
    """Returns a record with one path of a phase of 2 pi row/4 from row to row and 2 pi column/8 from
    column to column, in the order that files have."""
    k = np.arange(SUBCARRIERS) - SUBCARRIERS // 2
    response = np.zeros((ANTENNAS, SUBCARRIERS), complex)
    rows, columns = np.indices(PANEL.shape)
    panel = np.exp(2j * np.pi * (rows * row / 4 + columns * column / 8))
    response[PANEL] = panel[..., None] * np.exp(-2j * np.pi * k * delay / SUBCARRIERS)
    if sto is not None:
        ramp = 2 * np.pi * np.arange(SUBCARRIERS) / SUBCARRIERS
        response *= np.exp(-1j * (sto[:, None] * ramp + cpo[:, None]))
    stored = np.fft.ifftshift(response, axes=1)
    csi = np.stack([stored.real, stored.imag], axis=-1).astype(np.float32)
    return {
        "csi": tensor_proto(csi),
        "pos-tachy": tensor_proto(np.array(position, np.float64)),
        "snr": tensor_proto(np.ones(ANTENNAS, np.float32)),
        "time": 1.5,
    }


class Folder(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name)
        (self.folder / "tfrecords").mkdir()
        self.file = self.folder / "tfrecords" / "dichasus-test.tfrecords"
        self.spec(SPEC)

    def spec(self, value):
        (self.folder / "spec.json").write_text(json.dumps(value))

    def write(self, *records):
        self.file.write_bytes(b"".join(framed(example(r)) for r in records))


class Framing(Folder):
    def test_the_check_is_that_of_rfc_3720(self):
        for data, crc in (
            (b"", 0),
            (b"123456789", 0xE3069283),
            (bytes(32), 0x8A9136AA),
            (b"\xff" * 32, 0x62A8AB43),
            (bytes(range(32)), 0x46DD794E),
        ):
            self.assertEqual(tfrecord.crc32c(data), crc)

    def test_long_data_has_the_same_check(self):
        rng = np.random.default_rng(1)
        for length in (4095, 4096, 4097, 9001, 70000):
            data = rng.bytes(length)
            self.assertEqual(tfrecord.crc32c(data), slow_crc32c(data), length)

    def test_records_come_in_order(self):
        data = [b"", b"first", bytes(5000), b"last"]
        self.file.write_bytes(b"".join(map(framed, data)))
        self.assertEqual(list(tfrecord.records(self.file)), list(enumerate(data)))
        self.assertEqual([n for n, _ in tfrecord.records(self.file, every=2)], [0, 2])

    def test_damage_is_named(self):
        whole = framed(b"some data") + framed(b"more data")

        def flipped(at):
            return whole[:at] + bytes([whole[at] ^ 4]) + whole[at + 1 :]

        for data, text in (
            (whole[:30], "record 1: expected 12 bytes of length and check, found 5"),
            (whole[:-3], r"record 1: expected 13 bytes, found 10: the file is cut off"),
            (flipped(2), "record 0: expected the check of its length"),
            (flipped(14), "record 0: expected the check of its data"),
            (flipped(len(whole) - 1), "record 1: expected the check of its data"),
            (b"no records, but a text", "record 0: expected the check of its length"),
        ):
            self.file.write_bytes(data)
            with self.subTest(text), self.assertRaisesRegex(tfrecord.RecordError, text):
                list(tfrecord.records(self.file))


class Messages(unittest.TestCase):
    def test_features_of_all_types(self):
        found = tfrecord.example(example({"a": b"bytes", "b": 2.5, "c": [1, -2, 1 << 40]}))
        self.assertEqual(found["a"], [b"bytes"])
        np.testing.assert_array_equal(found["b"], [2.5])
        np.testing.assert_array_equal(found["c"], [1, -2, 1 << 40])

    def test_floats_that_are_not_packed_and_fields_that_are_unknown(self):
        single = b"\x0d" + struct.pack("<f", 1.5) + b"\x0d" + struct.pack("<f", -2.0)
        feature = field(2, single) + b"\x38\x05"  # and a field of number 7
        data = field(1, field(1, field(1, b"x") + field(2, feature))) + field(9, b"unknown")
        np.testing.assert_array_equal(tfrecord.example(data)["x"], [1.5, -2.0])

    def test_tensors(self):
        for array in (
            np.arange(6, dtype=np.float32).reshape(1, 2, 3),
            np.array([1.5, -2, 3e300]),
            np.zeros((0, 2), np.float32),
            np.array(7, np.int64),
        ):
            found = tfrecord.tensor(tensor_proto(array))
            np.testing.assert_array_equal(found, array)
            self.assertEqual(found.dtype, array.dtype)

    def test_damaged_messages(self):
        good = tensor_proto(np.arange(4, dtype=np.float32))
        for data, text in (
            (good[:-2], "where .* are left"),
            (b"\x08\x07" + good[2:], "type 7"),
            (good[:2] + field(2, field(2, b"\x08\x05")) + good[8:], "bytes of content"),
            (b"\x08\xff", "does not end"),
            (b"\x0b", "wire type 3"),
        ):
            with self.subTest(text), self.assertRaisesRegex(ValueError, text):
                tfrecord.tensor(data)


class Dichasus(Folder):
    def test_a_path_lies_where_it_should(self):
        self.write(record(1, 3, 5, (1, 2, 3)), record(2, 0, 7, (4, 5, 6)))
        found = dichasus.read_folder(self.folder)
        np.testing.assert_array_equal(found.position_m, [[1, 2, 3], [4, 5, 6]])
        power = np.square(np.abs(found.channels))
        np.testing.assert_allclose(power.sum((1, 2)), 32 * SUBCARRIERS, rtol=1e-4)
        angles = [divmod(int(p.sum(1).argmax()), 8) for p in power]
        self.assertEqual(angles, [(1, 3), (2, 0)])
        delays = [int(p.sum(0).argmax()) for p in power]
        self.assertEqual(delays[1] - delays[0], 2)  # one window for both
        self.assertLess(found.outside.max(), 1e-5)
        self.assertEqual((found.facts["subcarriers"], found.facts["carrier_hz"]), (SUBCARRIERS, 3438000000))
        self.assertFalse(found.facts["calibrated"])

    def test_offsets_are_taken_out(self):
        rng = np.random.default_rng(1)
        sto, cpo = rng.uniform(-3, 3, ANTENNAS), rng.uniform(-3, 3, ANTENNAS)
        self.write(record(1, 3, 5, (1, 2, 3)))
        clean = dichasus.read_folder(self.folder).channels
        self.write(record(1, 3, 5, (1, 2, 3), sto, cpo))
        offsets = self.folder / "tfrecords" / "reftx-offsets-dichasus-test.json"
        offsets.write_text(json.dumps({"sto": sto.tolist(), "cpo": cpo.tolist()}))
        found = dichasus.read_folder(self.folder)
        np.testing.assert_allclose(found.channels, clean, atol=1e-4)
        self.assertTrue(found.facts["calibrated"])
        offsets.write_text(json.dumps({"sto": [1, 2]}))
        with self.assertRaisesRegex(Error, "expected lists sto and cpo"):
            dichasus.read_folder(self.folder)

    def test_the_window_wraps_around(self):
        power = np.zeros(100)
        power[[95, 3]] = 1
        first = dichasus.first_bin(power)
        self.assertTrue({95, 3} <= {(first + i) % 100 for i in range(32)})

    def test_faults_are_named(self):
        good = record(1, 3, 5, (1, 2, 3))
        small = tensor_proto(np.zeros((32, SUBCARRIERS, 2), np.float32))
        for broken, text in (
            ({k: v for k, v in good.items() if k != "csi"}, "record 1: csi: expected a tensor, found none"),
            ({**good, "csi": 1.0}, "record 1: csi: expected a tensor, found another type"),
            ({**good, "csi": b"\x08\x01\x22"}, "record 1: csi: expected a tensor, found a number"),
            ({**good, "csi": small}, r"csi: expected \[more than .* found \[32, 48, 2\]"),
            (
                {k: v for k, v in good.items() if k != "pos-tachy"},
                "record 1: pos-tachy: .*the record has csi",
            ),
        ):
            self.write(good, broken)
            with self.subTest(text), self.assertRaisesRegex(Error, text):
                dichasus.read_folder(self.folder)

    def test_faults_of_the_folder(self):
        self.write(record(1, 3, 5, (1, 2, 3)))
        with self.assertRaisesRegex(Error, "antennas: expected one of number 2, found 1"):
            dichasus.read_folder(self.folder, array=2)
        for change, text in (
            ({"bandwidth": None}, "bandwidth: expected it"),
            ({"antennas": [{"assignments": [[1, 2]]}]}, "expected 32 antennas in rows"),
        ):
            self.spec({**SPEC, **change})
            with self.subTest(text), self.assertRaisesRegex(Error, text):
                dichasus.read_folder(self.folder)
        self.spec(SPEC)
        self.file.unlink()
        with self.assertRaisesRegex(Error, "expected files .*tfrecords"):
            dichasus.read_folder(self.folder)
        (self.folder / "spec.json").unlink()
        with self.assertRaisesRegex(Error, "expected DICHASUS's description"):
            dichasus.read_folder(self.folder)


if __name__ == "__main__":
    unittest.main()
