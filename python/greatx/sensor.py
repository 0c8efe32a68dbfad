# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""A sensor of a sequence and its records (docs/python.md). Arrays are opened when they are asked for, through
the OpenArrays of the data set.
"""

from __future__ import annotations

import pathlib
from typing import TYPE_CHECKING, Any, Dict, Iterator, Optional, Sequence as SequenceOf

import numpy as np

from .arrays import Frames, Ragged, open_stack
from .errors import DatasetError, nearest
from .files import inside
from .layout import EXPORT_SUFFIX, PACKED, ArrayInfo, OutputInfo, SensorInfo
from .packed import PackedFile, PackedRagged, PackedStack, PackedTable
from .unfinished import map_rows, open_packed, open_ragged

if TYPE_CHECKING:
    from .dataset import Sequence
    from .events import Events


class Sensor:
    """Holds the records of one sensor in one sequence, in order of time.

    The type of sensor["NAME"] or sensor.NAME depends on the format of the output that holds the array:
      npy_stack   a read-only memory map [records, ...];
      npy_ragged  a Ragged, whose item [i] is a view [rows of record i, ...];
      hdf5_records  a PackedStack or a PackedRagged, whose item [i] reads and unpacks record i;
      one file per record  Frames, whose item [i] reads and decodes the file of record i;
      hdf5_events, text_events  the path of the sequence's file, for h5py and other readers.
    NAME is an array ("delay") or an output ("paths/delay"; "cloud", whose records are dicts of arrays). An
    attribute that is neither is looked up in `metadata`, e.g. csi.carrier_hz.
    """

    def __init__(self, sequence: Sequence, number: int, info: SensorInfo):
        self.sequence = sequence
        self.info = info
        self.name = info.name
        self.kind = info.kind
        self.metadata: Dict[str, Any] = info.metadata
        #: int64 [records, 5]: rows of the index that belong to this sensor
        self.index: np.ndarray = sequence.index[sequence.index[:, 2] == number]
        if not np.array_equal(self.index[:, 4], np.arange(len(self.index))):
            raise DatasetError(f"{sequence.path / 'index.npy'}: the rows of {info.name} are not 0, 1, 2, ...")
        self._token = object()  # tells this sensor's arrays from those of others

    @property
    def arrays(self) -> Dict[str, ArrayInfo]:
        """Returns the type, the shape of a record, the unit and the axes of each array, by name."""
        return self.info.arrays

    @property
    def ticks(self) -> np.ndarray:
        """Returns the ticks of the records, int64 [records]."""
        return self.index[:, 0]

    @property
    def times_s(self) -> np.ndarray:
        """Returns the times of the records, float64 [records] in seconds, computed from the ticks."""
        rate = self.sequence.dataset.tick_rate_hz
        return self.ticks * rate.denominator / rate.numerator

    def __len__(self) -> int:
        """Returns the number of records."""
        return len(self.index)

    def record(self, i: int) -> "Record":
        """Returns the i-th record. A negative i counts from the end."""
        if not -len(self) <= i < len(self):
            raise IndexError(f"{self.name} has {len(self)} records, not one of number {i}")
        return Record(self, i % len(self))

    def at(self, tick: int) -> "Record":
        """Returns the record at a tick."""
        return self.sequence.at(tick)[self.name]

    def events(self, first: int = 0, last: Optional[int] = None) -> "Events":
        """Returns the events of an event camera from the records first to last - 1, by default from all
        records. The arrays are views of the files.
        """
        from .events import Events

        return Events.of(self, first, len(self) if last is None else last)

    def __iter__(self) -> Iterator["Record"]:
        return (Record(self, i) for i in range(len(self)))

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and self.info.locate(name) is not None

    def __getitem__(self, name: str) -> Any:
        located = self.info.locate(name)
        if located is None:
            raise KeyError(
                f"{self.name} has no array {name!r}{nearest(name, self.arrays)}; it has "
                f"{', '.join(self.arrays)}"
            )
        output, array = located
        key = (self._token, output.name, array.name if array else None)
        return self.sequence.dataset.files.get(key, lambda: self._open(output, array))

    def _open(self, output: OutputInfo, array: Optional[ArrayInfo]) -> Any:
        base = inside(self.sequence.dataset.path, f"{self.sequence.path.name}/{self.name}/{output.name}")
        whole = self.sequence.whole
        if output.format == "npy_stack":
            path = base.with_name(base.name + ".npy")
            if not whole:
                return map_rows(path, array.dtype, (len(self), *array.shape))
            return open_stack(path, array, len(self))
        if output.format == "npy_ragged":
            return (Ragged.open if whole else open_ragged)(base, array, len(self))
        if output.format == PACKED:
            return self._packed(base, output, array)
        if output.format in EXPORT_SUFFIX:
            path = base.with_name(base.name + EXPORT_SUFFIX[output.format])
            if not whole:
                raise DatasetError(f"{path}: is made when the sequence ends, which it has not")
            return path
        return Frames(base, output, array, self.index[:, 3])

    def _packed(self, base: pathlib.Path, output: OutputInfo, array: Optional[ArrayInfo]) -> Any:
        """Returns a packed array, or all arrays of the output if `array` is None."""
        if array is None:
            return PackedTable({a.name: self._packed(base, output, a) for a in output.arrays}, len(self))
        open_file = PackedFile if self.sequence.whole else open_packed
        file = self.sequence.dataset.files.get(
            (self._token, output.name, ""), lambda: open_file(base, output, len(self))
        )
        kind = PackedRagged if array.shape[:1] == (-1,) else PackedStack
        return kind(file, array)

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_") and "info" in self.__dict__:  # `info` is missing during unpickling
            if name in self:
                return self[name]
            if name in self.metadata:
                return self.metadata[name]
        raise AttributeError(
            f"{self.__dict__.get('name', 'a sensor')} has neither an array nor metadata {name!r}"
        )

    def __dir__(self) -> SequenceOf[str]:
        return sorted({*super().__dir__(), *self.arrays, *self.metadata})

    def __getstate__(self) -> Dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_token"}

    def __setstate__(self, state: Dict[str, Any]) -> None:
        self.__dict__.update(state, _token=object())

    def __repr__(self) -> str:
        return f"<greatx.Sensor {self.name} ({self.kind}): {len(self)} records of {', '.join(self.arrays)}>"


class Record:
    """Holds the measurement of one sensor at one tick. record["NAME"] or record.NAME is this record's part of
    sensor["NAME"]."""

    def __init__(self, sensor: Sensor, row: int):
        self.sensor = sensor
        self.row = row  #: row in the sensor's stacked arrays

    @property
    def tick(self) -> int:
        return int(self.sensor.index[self.row, 0])

    @property
    def time_ns(self) -> int:
        return int(self.sensor.index[self.row, 1])

    @property
    def time_s(self) -> float:
        return float(self.tick / self.sensor.sequence.dataset.tick_rate_hz)

    @property
    def sample(self) -> int:
        """Returns the number of the sensor's sample, which is also the number of the record's files."""
        return int(self.sensor.index[self.row, 3])

    def __getitem__(self, name: str) -> Any:
        return self.sensor[name][self.row]

    def __getattr__(self, name: str) -> Any:
        sensor = self.__dict__.get("sensor")  # None during unpickling
        if sensor is not None and not name.startswith("_") and name in sensor:
            return self[name]
        raise AttributeError(
            f"a record of {sensor.name if sensor is not None else 'a sensor'} has no array {name!r}"
        )

    def paths(self, rx: Optional[int] = None, tx: Optional[int] = None) -> Dict[str, np.ndarray]:
        """Returns all arrays of a channel's paths by name, [path, ...], for the whole record or for one link
        (see greatx.links).
        """
        from .links import paths_of

        return paths_of(self, rx, tx)

    def events(self) -> "Events":
        """Returns the events of an event camera since its previous record (see greatx.Events)."""
        from .events import Events

        return Events.of(self.sensor, self.row, self.row + 1)

    def __repr__(self) -> str:
        return f"<greatx.Record {self.row} of {self.sensor.name}, tick {self.tick}>"
