# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a data set as WebDataset's shards: tar files in which all files of one tick have one basename
(docs/exports.md, "WebDataset").

Data flow: a sequence's ticks, in order -> the members of a tick (a picture as its PNG, a cloud as its PLY or
PCD on request, every other array as .npy, and one .json) -> the open shard, which is closed when the next
tick would make it too large -> index.json, which wids reads, and index.csv with the offset of every member.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import hashlib
import io
import json
import os
import pathlib
import tarfile
from typing import Any, Dict, Iterable, List, Optional, Tuple, Union

import numpy as np

from ..arrays import Frames
from ..dataset import Dataset, Sequence, Tick
from ..errors import DatasetError
from ..files import interpreting, read_bytes
from ..layout import CLOUDS
from .common import Command
from .files import pick_sensors, selection_arguments
from .folders import Progress, new_folder
from .rig import sequences_of

BLOCK = 512  # bytes, of tar
Members = List[Tuple[str, bytes]]


class _Plan:
    """Knows which members each sensor has: (extension, output or array, whether the file is copied)."""

    def __init__(self, dataset: Dataset, sensors: List[str], arrays: Optional[List[str]], clouds: bool):
        self.members: Dict[str, List[Tuple[str, str, bool]]] = {}
        left = set(arrays or [])
        for name in sensors:
            info = dataset.sensors[name]
            wanted = [a for a in info.arrays if arrays is None or f"{name}/{a}" in left]
            left -= {f"{name}/{a}" for a in wanted}
            members: List[Tuple[str, str, bool]] = []
            if clouds:
                for output in info.outputs.values():
                    inside = [a.name for a in output.arrays]
                    if output.format in CLOUDS and set(inside) & set(wanted):
                        members.append((output.format, output.name, True))
                        wanted = [a for a in wanted if a not in inside]
            for array in wanted:
                located = info.locate(array)
                assert located is not None
                picture = located[0].format == "png"
                members.append((f"{array}.{'png' if picture else 'npy'}", array, picture))
            if members or arrays is None:
                self.members[name] = members
        if left:
            known = ", ".join(f"{s}/{a}" for s in sensors for a in dataset.sensors[s].arrays)
            raise DatasetError(f"{dataset.path}: has no array {sorted(left)[0]!r}; it has {known}")
        names = [f"{extension(s)}.{e}" for s, members in self.members.items() for e, _, _ in members]
        for name in names:
            if names.count(name) > 1:
                raise DatasetError(f"{dataset.path}: two arrays would be members of one name, {name}")

    def of(self, tick: Tick) -> Members:
        """Returns the members of a tick without their basename."""
        sequence = tick.sequence
        fired = [name for name in self.members if name in tick]
        about = {
            "sequence": sequence.number,
            "tick": tick.tick,
            "time_ns": tick.time_ns,
            "time_s": tick.time_s,
            "samples": {name: tick[name].sample for name in fired},
        }
        members: Members = [("json", json.dumps(about).encode())]
        for name in fired:
            record = tick[name]
            for ending, what, copied in self.members[name]:
                with interpreting(sequence.path / name):
                    opened = record.sensor[what]
                    if copied and isinstance(opened, Frames):
                        data = read_bytes(opened.path(record.row))
                    else:
                        data = npy(np.asarray(opened[record.row]))
                members.append((f"{extension(name)}.{ending}", data))
        return members


def extension(sensor: str) -> str:
    """Returns the beginning of the extension of a sensor's members: basenames end at the first dot."""
    return sensor.replace("/", ".")


def npy(array: np.ndarray) -> bytes:
    """Returns a .npy file of version 1.0."""
    out = io.BytesIO()
    np.lib.format.write_array(out, np.asarray(array, order="C"), version=(1, 0), allow_pickle=False)
    return out.getvalue()


class _Shards:
    """Writes samples to tar files, begins a new one when the open one is full, and keeps the index."""

    def __init__(self, folder: pathlib.Path, name: str, shard_bytes: int, shard_samples: int):
        self._folder, self._name = folder, name
        self._shard_bytes, self._shard_samples = shard_bytes, shard_samples
        self._file: Optional[io.BufferedWriter] = None
        self._tar: Optional[tarfile.TarFile] = None
        self._samples = 0
        self.shards: List[Dict[str, Any]] = []
        self._csv = open(folder / "index.csv", "w", newline="", encoding="utf-8")
        self._rows = csv.writer(self._csv, lineterminator="\n")
        self._rows.writerow(["shard", "sample", "member", "offset", "size"])

    def add(self, key: str, members: Members) -> None:
        size = sum(BLOCK + -(-len(data) // BLOCK) * BLOCK for _, data in members)
        full = self._tar is not None and (
            self._tar.offset + size > self._shard_bytes or self._samples >= self._shard_samples
        )
        if full:
            self.close_shard()
        if self._tar is None:
            self._path = self._folder / f"{self._name}-{len(self.shards):06d}.tar"
            self._file = open(self._path, "wb")
            self._tar = tarfile.open(fileobj=self._file, mode="w", format=tarfile.PAX_FORMAT)
            self._samples = 0
        for name, data in members:
            # TarInfo has owner 0, no names of owners, and time 0, so that the bytes depend on the data alone.
            info = tarfile.TarInfo(f"{key}.{name}")
            info.size, info.mode = len(data), 0o444
            self._tar.addfile(info, io.BytesIO(data))
            begin = self._tar.offset - -(-len(data) // BLOCK) * BLOCK
            self._rows.writerow([self._path.name, key, name, begin, len(data)])
        self._samples += 1

    def close_shard(self) -> None:
        if self._tar is None or self._file is None:
            return
        self._tar.close()
        self._file.close()
        digest = hashlib.md5()
        with open(self._path, "rb") as file:
            for piece in iter(lambda: file.read(1 << 22), b""):
                digest.update(piece)
        self.shards.append(
            {
                "url": self._path.name,
                "md5sum": digest.hexdigest(),
                "nsamples": self._samples,
                "filesize": self._path.stat().st_size,
            }
        )
        self._tar = self._file = None

    def close(self) -> None:
        """Closes the files after a failure, without finishing them."""
        for file in (self._file, self._csv):
            if file is not None:
                with contextlib.suppress(OSError):  # a full disk has been reported already
                    file.close()

    def finish(self, info: Dict[str, Any]) -> None:
        self.close_shard()
        self._csv.close()
        index = {
            "__kind__": "wids-shard-index-v1",
            "wids_version": 1,
            "name": self._name,
            "info": info,
            "shardlist": self.shards,
        }
        (self._folder / "index.json").write_text(json.dumps(index, indent=1) + "\n", encoding="utf-8")


def write_webdataset(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    sequence: Optional[int] = None,
    sensors: Optional[Iterable[str]] = None,
    arrays: Optional[Iterable[str]] = None,
    shard_mb: float = 256.0,
    shard_samples: int = 100_000,
    complete: bool = False,
    clouds: bool = False,
    name: str = "shard",
) -> Dict[str, int]:
    """Writes OUT/NAME-000000.tar, ..., index.json, index.csv and dataset.json. A sample is a tick, its
    basename sequence_SSSS_TTTTTTTTTTTT.

    sensors, arrays  those to write ("SENSOR/ARRAY"); all if None
    shard_mb         a shard is closed before it is larger (10^6 bytes); a sample is never divided
    complete         leave out ticks at which one of the sensors has no record
    clouds           copy PLY and PCD files instead of writing their arrays

    Returns counts of the written objects. Raises DatasetError, or FileExistsError if OUT is not empty.
    """
    if not shard_mb > 0 or shard_samples < 1:
        raise DatasetError(
            f"shards: expected more than 0 MB and 0 samples, found {shard_mb}, {shard_samples}"
        )
    if not name or "/" in name or name.startswith("."):
        raise DatasetError(f"name: expected the beginning of a file's name, found {name!r}")
    sequences = sequences_of(dataset, sequence)
    plan = _Plan(dataset, pick_sensors(dataset, sensors), None if arrays is None else list(arrays), clouds)
    progress = Progress(sum(len(s) for s in sequences), "ticks")
    counts = {"samples": 0, "members": 0, "ticks left out": 0}
    with new_folder(out) as folder:
        shards = _Shards(folder, name, int(shard_mb * 1e6), shard_samples)
        try:
            for each in sequences:
                _write_sequence(each, plan, shards, complete, counts, progress)
            shards.finish({"dataset": str(dataset.run.get("scenario", "")), "sensors": list(plan.members)})
        except BaseException:
            shards.close()
            raise
        (folder / "dataset.json").write_bytes(read_bytes(dataset.path / "dataset.json"))
    progress.end()
    return {"shards": len(shards.shards), **counts}


def _write_sequence(
    sequence: Sequence,
    plan: _Plan,
    shards: _Shards,
    complete: bool,
    counts: Dict[str, int],
    progress: Progress,
) -> None:
    for tick in sequence:
        progress.step()
        fired = [name for name in plan.members if name in tick]
        if not fired or (complete and len(fired) < len(plan.members)):
            counts["ticks left out"] += 1
            continue
        members = plan.of(tick)
        shards.add(f"sequence_{sequence.number:04d}_{tick.tick:012d}", members)
        counts["samples"] += 1
        counts["members"] += len(members)


def _arguments(parser: argparse.ArgumentParser) -> None:
    selection_arguments(parser)
    parser.add_argument(
        "--array",
        action="append",
        metavar="SENSOR/ARRAY",
        help="an array to write; may be repeated; default: all",
    )
    parser.add_argument("--shard-mb", type=float, default=256.0, help="size of a shard at most; default: 256")
    parser.add_argument(
        "--shard-samples", type=int, default=100_000, help="samples of a shard at most; default: 100000"
    )
    parser.add_argument(
        "--complete", action="store_true", help="leave out ticks at which one of the sensors has no record"
    )
    parser.add_argument("--clouds", action="store_true", help="copy PLY and PCD files instead of arrays")
    parser.add_argument("--name", default="shard", help="beginning of the shards' names; default: shard")


COMMAND = Command(
    "webdataset",
    "tar shards with an index, for webdataset and wids",
    lambda dataset, given: write_webdataset(
        dataset,
        given.OUT,
        given.sequence,
        given.sensor,
        given.array,
        given.shard_mb,
        given.shard_samples,
        given.complete,
        given.clouds,
        given.name,
    ),
    _arguments,
)
