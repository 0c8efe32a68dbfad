# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Goes through the ticks of a sequence and writes the messages of all records."""

from __future__ import annotations

import argparse
import contextlib
import os
import pathlib
from typing import Any, Dict, Iterable, Iterator, Optional, Union

from ...dataset import Dataset, Record, Sequence
from ...errors import DatasetError
from ...files import interpreting, read_bytes
from ..common import Command, pick_sequence
from ..files import Records, new_file, pick_sensors, record_rows, selection_arguments
from ..folders import Progress, new_folder
from ..rig import sequences_of
from .messages import (
    Mounts,
    Named,
    camera_messages,
    event_messages,
    lidar_messages,
    node_messages,
    radar_messages,
    trajectories,
)
from .output import COMPRESSIONS, Foxglove, Output
from .scene import box_messages, path_messages, statistics

MOST_PATHS = 200


def write_mcap(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    sequence: Optional[int] = None,
    sensors: Optional[Iterable[str]] = None,
    most_paths: int = MOST_PATHS,
    compression: str = "zstd",
    start_ns: int = 0,
) -> Dict[str, Any]:
    """Writes one sequence to the file OUT if its name ends in .mcap, and otherwise OUT/sequence_0000.mcap,
    ... for all sequences or the one that is named.

    sensors      those to write, all if None; the poses are always written
    most_paths   radio paths of a record at most: the strongest ones
    compression  of the file's chunks: "zstd", "lz4" or "none"
    start_ns     time of tick 0

    Returns counts of the written objects. Raises DatasetError, FileExistsError, or ImportError without mcap.
    """
    if compression not in COMPRESSIONS:
        raise DatasetError(f"compression: expected one of {', '.join(COMPRESSIONS)}, found {compression!r}")
    if start_ns < 0 or most_paths < 0:
        raise DatasetError(f"expected start_ns and most_paths of 0 or more, found {start_ns}, {most_paths}")
    fox = Foxglove()
    names = set(pick_sensors(dataset, sensors))
    single = pathlib.Path(out).suffix == ".mcap"
    sequences = [pick_sequence(dataset, sequence)] if single else sequences_of(dataset, sequence)
    counts: Dict[str, Any] = {"files": 0, "topics": 0, "messages": 0}
    left_out: Dict[str, int] = {}
    with contextlib.ExitStack() as stack:
        root = stack.enter_context(new_file(out) if single else new_folder(out))
        for each in sequences:
            path = root if single else root / f"{each.path.name}.mcap"
            output = Output(fox, path, compression)
            try:
                _Run(fox, output, each, names, most_paths, start_ns, left_out).write()
                output.finish()
            except BaseException:
                output.close()
                raise
            counts["files"] += 1
            counts["topics"] = max(counts["topics"], len(output.counts))
            counts["messages"] += sum(output.counts.values())
    for name, number in left_out.items():
        counts[f"of {name} left out"] = number
    return counts


class _Run:
    def __init__(
        self,
        fox: Foxglove,
        output: Output,
        sequence: Sequence,
        names: Iterable[str],
        most_paths: int,
        start_ns: int,
        left_out: Dict[str, int],
    ):
        self._fox, self._output, self._sequence = fox, output, sequence
        self._names = {*names, sequence.poses.name}
        self._most_paths, self._start_ns, self._left_out = most_paths, start_ns, left_out
        self._mounts = Mounts(fox, sequence)
        self._records = {
            name: Records(sequence[name])
            for name in self._names
            if sequence[name].kind in ("lidar",) and len(sequence[name])
        }

    def write(self) -> None:
        dataset = self._sequence.dataset
        run = {
            key: str(dataset.run[key])
            for key in ("scenario", "seed", "greatx", "commit")
            if key in dataset.run
        }
        self._output.metadata("greatx", {"sequence": str(self._sequence.number), **run})
        data = read_bytes(dataset.path / "dataset.json")
        self._output.attach("dataset.json", "application/json", data, self._start_ns)
        if len(self._sequence) == 0:
            return
        time_ns = int(self._sequence.index[0, 1]) + self._start_ns
        for topic, message in trajectories(self._fox, self._sequence, self._fox.time(time_ns)):
            self._output.write(topic, time_ns, message)
        rows = list(record_rows(self._sequence, self._names))
        progress = Progress(len(rows), "records")
        for name, row in rows:
            record = self._sequence[name].record(row)
            with interpreting(self._sequence.path / name):
                self._write_record(record, record.time_ns + self._start_ns)
            progress.step()
        progress.end()

    def _write_record(self, record: Record, time_ns: int) -> None:
        for topic, message in self._messages(record, self._fox.time(time_ns)):
            self._output.write(topic, time_ns, message)
        if record.sensor.kind == "csi":
            schema, value = statistics(record)
            name = f"greatx.{record.sensor.name}.statistics"
            self._output.write_json(f"/{record.sensor.name}/statistics", time_ns, name, schema, value)

    def _messages(self, record: Record, time: Any) -> Iterator[Named]:
        kind, fox = record.sensor.kind, self._fox
        if kind == "pose":
            yield from node_messages(fox, record, time, self._mounts)
        elif kind == "camera":
            yield from camera_messages(fox, record, time, self._left_out)
            yield from box_messages(fox, record, time)
        elif kind == "event_camera":
            yield from event_messages(fox, record, time, self._left_out)
        elif kind == "lidar":
            yield from lidar_messages(fox, record, time, self._records[record.sensor.name])
        elif kind == "radar":
            yield from radar_messages(fox, record, time, self._left_out)
        elif kind == "csi":
            yield from path_messages(fox, record, time, self._most_paths, self._left_out)
            if "cfr" in record.sensor.arrays:
                key = f"{record.sensor.name}/cfr"
                self._left_out[key] = self._left_out.get(key, 0) + 1


def _arguments(parser: argparse.ArgumentParser) -> None:
    selection_arguments(parser)
    parser.add_argument(
        "--most-paths",
        type=int,
        default=MOST_PATHS,
        help="radio paths of a record at most, the strongest ones; default: 200",
    )
    parser.add_argument("--compression", choices=COMPRESSIONS, default="zstd", help="default: zstd")
    parser.add_argument("--start-ns", type=int, default=0, help="time of tick 0, ns; default: 0")


COMMAND = Command(
    "mcap",
    "MCAP files with Foxglove's schemas",
    lambda dataset, given: write_mcap(
        dataset,
        given.OUT,
        given.sequence,
        given.sensor,
        given.most_paths,
        given.compression,
        given.start_ns,
    ),
    _arguments,
    "file NAME.mcap to make, for one sequence, or folder for several",
)
