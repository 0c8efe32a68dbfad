# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads measured channels of the DICHASUS data sets (F. Euchner, M. Gauger, S. Dörner, S. ten Brink, "A
distributed massive MIMO channel sounder for 'big CSI data'-driven machine learning", WSA 2021).

A folder has spec.json, its .tfrecords (in it or in its folder tfrecords/), and, if there are any, the
offsets of the antennas, reftx-offsets-NAME.json for NAME.tfrecords. Read of spec.json: "bandwidth" and
"frequency" in Hz, "name", and of each of "antennas" its "assignments", the numbers of its antennas by row and
column. Read of each record (a tf.train.Example):

csi         TensorProto float32 [antenna, subcarrier, 2]: real and imaginary part; subcarriers in the order of
            an FFT, so that those below the carrier follow those above it
pos-tachy   TensorProto float64 [3]: x, y, z of the transmitter, m (another "pos-..." of spec.json's "format"
            if there is no such one; a missing z counts as 0)

snr, time, cfo, gt-interp-age-tachy and others are passed over.

Offsets have "sto" (in samples) and "cpo" (in radians) of each antenna: a channel is multiplied by e^{j (2 pi
k sto / N + cpo)}, where k counts the subcarriers from the lowest one on.

The delays of a file are relative to a clock of its own. The window of 32 bins is therefore put where most of
the power of the file's first records arrives, the same for all of its records. The ports of a panel are taken
to angles by a transform over its rows and its columns.
"""
from __future__ import annotations

import json
import pathlib
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np

from greatx.errors import Error

from .sets import ChannelSet
from .tfrecord import RecordError, example, records, tensor
from .transforms import angle_matrix

PORTS = DELAYS = 32
#: Records of a file that tell where its power arrives.
LOOKED_AT = 64


class Files:
    """Holds what a folder has."""

    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        path = folder / "spec.json"
        try:
            self.spec: Dict[str, Any] = json.loads(path.read_text())
        except OSError as error:
            raise Error(f"{path}: {error.strerror}: expected DICHASUS's description") from None
        except ValueError as error:
            raise Error(f"{path}: is no JSON: {error}") from None
        for name, kind in (("bandwidth", (int, float)), ("frequency", (int, float)), ("antennas", list)):
            if not isinstance(self.spec.get(name), kind):
                raise Error(f"{path}: {name}: expected it, found {self.spec.get(name)!r}")
        self.records = sorted([*folder.glob("*.tfrecords"), *folder.glob("tfrecords/*.tfrecords")])
        if not self.records:
            raise Error(f"{folder}: expected files *.tfrecords in it or in its folder tfrecords, found none")
        names = [n for n in self.spec.get("format", {}) if n.startswith("pos-")]
        self.position = "pos-tachy" if "pos-tachy" in names or not names else names[0]

    def panel(self, number: int) -> np.ndarray:
        """Returns the antennas of an array, int64 [row, column]."""
        path, antennas = self.folder / "spec.json", self.spec["antennas"]
        if not 0 <= number < len(antennas):
            raise Error(f"{path}: antennas: expected one of number {number}, found {len(antennas)}")
        panel = np.array(antennas[number].get("assignments"))
        if panel.ndim != 2 or panel.dtype.kind != "i" or panel.size != PORTS:
            raise Error(
                f"{path}: antennas[{number}].assignments: expected {PORTS} antennas in rows of equal length, "
                f"found {panel.size if panel.dtype.kind == 'i' else antennas[number].get('assignments')!r}"
            )
        return panel

    def offsets(self, path: pathlib.Path) -> Optional[Tuple[np.ndarray, np.ndarray]]:
        """Returns sto and cpo of a file's antennas, or None if there is no file of offsets."""
        for folder in (path.parent, self.folder):
            file = folder / f"reftx-offsets-{path.stem}.json"
            if file.is_file():
                break
        else:
            return None
        try:
            found = json.loads(file.read_text())
            return np.array(found["sto"], np.float64), np.array(found["cpo"], np.float64)
        except (ValueError, KeyError, TypeError) as error:
            raise Error(f"{file}: expected lists sto and cpo: {error!r}") from None


def _tensor(path: pathlib.Path, number: int, features: Dict[str, Any], name: str) -> np.ndarray:
    where = f"{path}: record {number}: {name}"
    value = features.get(name)
    if not isinstance(value, list) or len(value) != 1:
        known = ", ".join(sorted(features)) or "none"
        raise RecordError(f"{where}: expected a tensor, found {'none' if value is None else 'another type'}; "
                          f"the record has {known}")  # fmt: skip
    try:
        return tensor(value[0])
    except ValueError as error:
        raise RecordError(f"{where}: expected a tensor, found {error}") from None


def _links(
    files: Files, path: pathlib.Path, panel: np.ndarray, every: int
) -> Iterator[Tuple[np.ndarray, np.ndarray]]:
    """Yields H of a panel, complex64 [row, column, subcarrier], and the position, of each record."""
    offsets = files.offsets(path)
    for number, data in records(path, every):
        try:
            features = example(data)
        except (ValueError, UnicodeDecodeError) as error:
            raise RecordError(
                f"{path}: record {number}: expected a tf.train.Example, found {error}"
            ) from None
        csi = _tensor(path, number, features, "csi")
        if csi.ndim != 3 or csi.shape[2] != 2 or csi.shape[0] <= panel.max() or csi.shape[1] < DELAYS:
            raise RecordError(
                f"{path}: record {number}: csi: expected [more than {panel.max()} antennas, {DELAYS} or more "
                f"subcarriers, 2], found {list(csi.shape)}"
            )
        response = np.fft.fftshift(csi[..., 0] + 1j * csi[..., 1], axes=1)
        if offsets is not None:
            sto, cpo = offsets
            if len(sto) != len(response) or len(cpo) != len(response):
                raise Error(f"{path}: expected offsets of {len(response)} antennas, found {len(sto)}")
            ramp = 2 * np.pi * np.arange(response.shape[1]) / response.shape[1]
            response = response * np.exp(1j * (sto[:, None] * ramp + cpo[:, None]))
        position = np.zeros(3)
        found = _tensor(path, number, features, files.position).ravel()[:3]
        position[: len(found)] = found
        yield response[panel].astype(np.complex64), position


def _delays(response: np.ndarray) -> np.ndarray:
    """Returns the channel over all bins of delay, unitary, in the last axis."""
    turned = np.fft.ifft(np.fft.ifftshift(response, axes=-1), axis=-1, norm="ortho")
    return turned.astype(np.complex64)


def first_bin(power: np.ndarray) -> int:
    """Returns where the cyclic window of DELAYS bins begins that holds the most power, the first of equal
    ones."""
    wrapped = np.concatenate([power, power[: DELAYS - 1]])
    held = np.convolve(wrapped, np.ones(DELAYS), "valid")
    return int(np.argmax(held >= (1 - 1e-6) * held.max()))


def read_folder(folder: pathlib.Path, array: int = 0, every: int = 1) -> ChannelSet:
    """Returns the channels between the transmitter and one of the arrays as a set.

    array  number of the array in spec.json
    every  takes every `every`-th record of each file only
    """
    files = Files(folder)
    panel = files.panel(array)
    rows, columns = panel.shape
    matrices: List[np.ndarray] = []
    positions: List[np.ndarray] = []
    outside: List[float] = []
    subcarriers, calibrated = 0, []
    for path in files.records:
        power = 0.0
        for count, (response, _) in enumerate(_links(files, path, panel, every)):
            if count == LOOKED_AT:
                break
            power = power + np.square(np.abs(_delays(response))).sum((0, 1))
        if np.ndim(power) == 0:
            continue  # the file has no records
        window = (first_bin(power) + np.arange(DELAYS)) % len(power)
        calibrated.append(files.offsets(path) is not None)
        for response, position in _links(files, path, panel, every):
            over_delay = _delays(response)
            total = float(np.square(np.abs(over_delay), dtype=np.float64).sum())
            if not total > 0 or not np.isfinite(total):
                continue
            kept = over_delay[..., window]
            angles = np.einsum("ra,cb,rcd->abd", angle_matrix(rows), angle_matrix(columns), kept)
            matrices.append(angles.reshape(PORTS, DELAYS).astype(np.complex64))
            outside.append(1 - float(np.square(np.abs(kept), dtype=np.float64).sum()) / total)
            positions.append(position)
            subcarriers = response.shape[2]
    if not matrices:
        raise Error(f"{folder}: expected records with power, found none")
    facts = {
        "name": f"DICHASUS, {files.spec.get('name', folder.name)} (measured)",
        "carrier_hz": files.spec["frequency"],
        "bandwidth_hz": files.spec["bandwidth"],
        "subcarriers": subcarriers,
        "array": f"panel of {rows} x {columns}, number {array} of spec.json",
        "calibrated": all(calibrated),
        "users": {"every": every, "kept": len(matrices)},
        "power_outside": {"mean": float(np.mean(outside)), "p95": float(np.percentile(outside, 95))},
    }
    return ChannelSet(np.array(matrices), np.array(positions), np.array(outside, np.float32), facts)
