# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads what an unfinished data set has committed, also while a run writes to it.

A run commits a tick by one line of journal.txt, after all files of the tick are in place (docs/dataset.md).
The stacks of the open sequence are NAME.part until the sequence ends, and their headers state no rows.
Data flow: journal.txt -> packets -> index of the open sequence -> the first rows of each stack. The journal
is read first, so every row that the index knows is in the files, whatever is appended or renamed later.
"""

from __future__ import annotations

import json
import math
import os
import pathlib
import zlib
from typing import TYPE_CHECKING, Callable, List, NamedTuple, Optional, Tuple, TypeVar

import numpy as np

from .arrays import Ragged
from .errors import DatasetError
from .files import MOST_SEQUENCES, MOST_TICKS, Field, check_plain, inside, read_bytes, reading
from .layout import PACKED, SUFFIX, ArrayInfo, OutputInfo, SensorInfo
from .packed import PLACE_NUMBERS, PackedFile, count_columns

if TYPE_CHECKING:
    from .dataset import Dataset

JOURNAL = "journal.txt"
#: Bytes of the header of every .npy file of a data set.
NPY_HEADER = 256
_CHECKSUM = 9  # a tab and eight hexadecimal digits
_LARGEST_JOURNAL = 2 << 30
_MOST_ENTRIES = 1 << 20
T = TypeVar("T")


class Packet(NamedTuple):
    """A committed tick of a sequence."""

    sequence: int
    tick: int
    time_ns: int
    records: List[Tuple[int, int]]  #: sensor, sample
    sizes: List[int]  #: bytes of each file of one frame, in the order of records and outputs


class OpenSequence(NamedTuple):
    """The sequence that a run is writing."""

    number: int
    index: np.ndarray  #: int64 [records, 5], like index.npy


def read_journal(folder: pathlib.Path) -> Optional[List[Packet]]:
    """Returns the packets of journal.txt, or None if there is no journal. Stops at the first line that is
    incomplete or has a wrong checksum. Raises DatasetError for a line that no run has written.
    """
    path = inside(folder, JOURNAL)
    if not path.is_file():
        return None
    packets: List[Packet] = []
    for number, line in enumerate(read_bytes(path, _LARGEST_JOURNAL).split(b"\n")[:-1], 1):
        body, checksum = line[:-_CHECKSUM], line[-_CHECKSUM:]
        if checksum != b"\t%08x" % zlib.crc32(body):
            break
        try:
            entry = Field(f"{path}:{number}", json.loads(body))
        except (ValueError, RecursionError) as error:
            raise DatasetError(f"{path}:{number}: is no JSON: {error}") from error
        if "end" not in entry:
            packets.append(_packet(entry))
    return packets


def _packet(entry: Field) -> Packet:
    head = entry["packet"].items(3)
    if len(head) != 3:
        raise entry["packet"].fail("a sequence, a tick and a time")
    records = [_pair(record, 1 << 31, MOST_TICKS) for record in entry["records"].items(_MOST_ENTRIES)]
    sizes = []
    for file in entry["files"].items(_MOST_ENTRIES):
        pair = file.items(2)
        if len(pair) != 2:
            raise file.fail("a size and a hash")
        sizes.append(pair[0].integer(0, 1 << 60))
    return Packet(
        head[0].integer(0, MOST_SEQUENCES - 1),
        head[1].integer(0, MOST_TICKS),
        head[2].integer(0, 2**62),
        records,
        sizes,
    )


def _pair(field: Field, first: int, second: int) -> Tuple[int, int]:
    numbers = field.items(2)
    if len(numbers) != 2:
        raise field.fail("two numbers")
    return numbers[0].integer(0, first), numbers[1].integer(0, second)


def open_sequence(dataset: "Dataset", packets: List[Packet], whole: List[int]) -> Optional[OpenSequence]:
    """Returns the sequence that is being written, with the packets whose files are all there; None if the
    last committed packet is of a whole sequence. A packet without its files, and all after it, do not count.
    """
    number = packets[-1].sequence if packets else 0
    if number in whole:
        return None
    folder = f"sequence_{number:04d}"
    sensors = list(dataset.sensors.values())
    counts = [_whole_records(dataset.path, folder, sensor) for sensor in sensors]
    rows: List[Tuple[int, int, int, int, int]] = []
    used = [0] * len(sensors)
    journal = dataset.path / JOURNAL
    for packet in packets:
        if packet.sequence != number:
            continue
        if any(sensor >= len(sensors) for sensor, _ in packet.records):
            raise DatasetError(f"{journal}: expected sensors below {len(sensors)} at tick {packet.tick}")
        fits = all(used[sensor] < counts[sensor] for sensor, _ in packet.records)
        if not fits or not _frames_are_there(dataset.path, folder, sensors, packet):
            break
        for sensor, sample in packet.records:
            rows.append((packet.tick, packet.time_ns, sensor, sample, used[sensor]))
            used[sensor] += 1
    return OpenSequence(number, np.array(rows, np.int64).reshape(-1, 5))


def _frames_are_there(root: pathlib.Path, folder: str, sensors: List[SensorInfo], packet: Packet) -> bool:
    names = [
        f"{folder}/{sensors[sensor].name}/{output.name}/{sample:06d}{SUFFIX[output.format]}"
        for sensor, sample in packet.records
        for output in sensors[sensor].outputs.values()
        if output.format in SUFFIX
    ]
    if len(names) != len(packet.sizes):
        raise DatasetError(
            f"{root / JOURNAL}: expected {len(names)} files at tick {packet.tick}, found {len(packet.sizes)}"
        )
    return all(_size(inside(root, name)) == size for name, size in zip(names, packet.sizes))


def _size(path: pathlib.Path) -> int:
    try:
        return os.lstat(path).st_size
    except FileNotFoundError:
        return -1


def _whole_records(root: pathlib.Path, folder: str, sensor: SensorInfo) -> int:
    """Returns the number of records that the stacks of a sensor hold, by the sizes of their files."""
    count = 1 << 62
    for output in sensor.outputs.values():
        base = f"{folder}/{sensor.name}/{output.name}"
        if output.format == "npy_stack":
            row = math.prod(output.arrays[0].shape) * output.arrays[0].dtype.itemsize
            count = min(count, _rows(root, f"{base}.npy", row))
        elif output.format == "npy_ragged":
            count = min(count, _rows(root, f"{base}_offsets.npy", 8) - 1)
        elif output.format == PACKED:
            row = count_columns(output) * PLACE_NUMBERS * 8
            count = min(count, max(_rows(root, f"{base}.chunks.npy", row), _rows(root, f"{base}.npy", row)))
    return max(count, 0)


def _rows(root: pathlib.Path, name: str, row_bytes: int) -> int:
    size = max(_size(inside(root, name + ".part")), _size(inside(root, name)))
    return max(size - NPY_HEADER, 0) // row_bytes if row_bytes else 1 << 62


def either(path: pathlib.Path, make: Callable[[pathlib.Path], T]) -> T:
    """Returns make() of PATH.part, or of PATH if the run has renamed the file in the meantime. Raises
    DatasetError if there is neither.
    """
    part = path.with_name(path.name + ".part")
    for candidate in (part, path, part):
        try:
            if os.path.lexists(candidate):
                return make(candidate)
        except FileNotFoundError:
            continue
        except DatasetError as error:
            if not isinstance(error.__cause__, FileNotFoundError):
                raise
    raise DatasetError(f"{part}: is missing")


def _map(path: pathlib.Path, dtype: np.dtype, shape: Tuple[int, ...]) -> np.ndarray:
    """Maps the first rows of a .npy file, whose header may state fewer."""
    needed = NPY_HEADER + int(np.prod(shape, dtype=object)) * dtype.itemsize
    check_plain(path, 1 << 62)
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        if size < needed:
            raise DatasetError(f"{path}: expected {needed} bytes or more (journal.txt), found {size}")
        with reading(path):
            return np.memmap(file, dtype, "r", NPY_HEADER, shape)


def map_rows(path: pathlib.Path, dtype: np.dtype, shape: Tuple[int, ...]) -> np.ndarray:
    """Returns a read-only memory map of the first shape[0] rows of PATH.part or PATH."""
    if 0 in shape:  # the file may not exist yet
        return np.empty(shape, dtype)
    return either(path, lambda found: _map(found, dtype, shape))


def open_ragged(base: pathlib.Path, array: ArrayInfo, records: int) -> Ragged:
    """Returns the first records of a ragged stack whose sequence is open."""
    path = base.with_name(base.name + "_offsets.npy")
    offsets = np.array(map_rows(path, np.dtype("<i8"), (records + 1,))) if records else np.zeros(1, np.int64)
    if offsets[0] != 0 or np.any(np.diff(offsets) < 0):
        raise DatasetError(f"{path}.part: expected offsets that grow from 0")
    values = map_rows(base.with_name(base.name + ".npy"), array.dtype, (int(offsets[-1]), *array.shape[1:]))
    return Ragged(values, offsets)


def open_packed(base: pathlib.Path, output: OutputInfo, records: int) -> PackedFile:
    """Returns the first records of a packed output whose sequence is open. Their bytes are in a stream until
    the end of the sequence makes an HDF5 file of it, with another table.
    """
    stream = base.with_name(base.name + ".chunks.part")
    table = base.with_name(base.name + ".chunks.npy.part")
    columns = count_columns(output)
    if records == 0:  # the files may not exist yet
        empty = np.empty((0, columns, PLACE_NUMBERS), np.int64)
        return PackedFile(base, output, 0, stream=(stream, os.open(os.devnull, os.O_RDONLY), empty))
    try:
        file = os.open(stream, os.O_RDONLY | os.O_NOFOLLOW)
    except FileNotFoundError:
        return PackedFile(base, output, records, first_records=True)
    try:
        check_plain(stream, 1 << 62)
        places = np.array(_map(table, np.dtype("<i8"), (records, columns, PLACE_NUMBERS)))
    except (DatasetError, FileNotFoundError):
        os.close(file)
        if os.path.lexists(table) or os.path.lexists(stream):
            raise
        return PackedFile(base, output, records, first_records=True)
    return PackedFile(base, output, records, stream=(stream, file, places))
