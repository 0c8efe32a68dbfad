# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a generated data set by memory maps, and gives access by sequence, by sensor and by tick
(docs/python.md).
"""

from __future__ import annotations

import functools
import os
import pathlib
import warnings
from typing import (
    TYPE_CHECKING,
    Any,
    Dict,
    Iterable,
    Iterator,
    List,
    Mapping,
    Optional,
    Sequence as SequenceOf,
    Union,
)

import numpy as np

from .arrays import Frames, Ragged, open_stack
from .errors import DatasetError, nearest
from .files import MOST_SEQUENCES, MOST_TICKS, Field, inside
from .frames import load_npy
from .layout import EXPORT_SUFFIX, PACKED, ArrayInfo, OutputInfo, SensorInfo, parse_sensors, read_info
from .opened import OpenArrays
from .packed import PackedFile, PackedRagged, PackedStack, PackedTable
from .ticks import TickRecords
from .unfinished import JOURNAL, OpenSequence, map_rows, open_packed, open_ragged, open_sequence, read_journal

if TYPE_CHECKING:
    from .events import Events
    from .samples import Samples

#: The output of a scenario's sensor that makes an array.
OUTPUT_OF = {
    "cfr": "cfr",
    "delay": "paths",
    "rgb": "rgb",
    "depth": "depth",
    "instance": "ids",
    "semantic": "ids",
    "flow": "flow",
    "box_amodal": "boxes",
}
INDEX_COLUMNS = ("tick", "time_ns", "sensor", "sample", "row")


class Dataset:
    """Provides a data set; returned by `load`. Pickling stores only the folder, so that the workers of a
    DataLoader open the files themselves.
    """

    def __init__(
        self,
        folder: Union[str, "os.PathLike[str]"],
        incomplete: bool = False,
        files: Optional[OpenArrays] = None,
    ):
        """Reads dataset.json and the indices. With `files`, which several data sets may share, reads an index
        when it is first used. See `load` for the rest.
        """
        self.path = pathlib.Path(os.path.abspath(folder))
        self._incomplete = incomplete
        #: the arrays that are open
        self.files = OpenArrays() if files is None else files
        fields = read_info(self.path)
        #: contents of dataset.json
        self.info: Dict[str, Any] = fields.value
        fields["run"].object()
        #: descriptions of the sensors by name, in the order of their numbers in the index
        self.sensors: Dict[str, SensorInfo] = parse_sensors(fields)
        self.complete = inside(self.path, "manifest.json").is_file()
        self.tick_rate_hz = fields["tick_rate_hz"].rate()
        self._ticks = (
            fields["ticks_per_sequence"].integer(0, MOST_TICKS)
            if "ticks_per_sequence" in fields
            else MOST_TICKS
        )
        count = fields["sequences"].integer(1, MOST_SEQUENCES)
        # The journal is read before the indices are looked for: a sequence that ends in between then has an
        # index.
        packets = None if self.complete else read_journal(self.path)
        whole = self._whole(count)
        opened = None if packets is None else open_sequence(self, packets, whole)
        if opened is not None and opened.number >= count:
            raise DatasetError(
                f"{self.path / JOURNAL}: expected sequences below {count}, found {opened.number}"
            )
        if not self.complete:
            self._warn(count, len(whole), opened)
        elif len(whole) < count:
            missing = next(n for n, i in enumerate([*whole, -1]) if n != i)
            raise DatasetError(f"{self.path / f'sequence_{missing:04d}' / 'index.npy'}: is missing")
        #: the opened sequences, one per run of the scenario
        self.sequences: List[Sequence] = [Sequence(self, i) for i in whole]
        if opened is not None:
            self.sequences.append(Sequence(self, opened.number, opened.index))
        if files is None:
            for sequence in self.sequences:
                sequence.sensors

    def _whole(self, count: int) -> List[int]:
        """Returns the numbers of the sequences that have ended."""
        there = {entry.name for entry in os.scandir(self.path) if entry.name.startswith("sequence_")}
        return [
            i
            for i in range(count)
            if f"sequence_{i:04d}" in there and inside(self.path, f"sequence_{i:04d}/index.npy").is_file()
        ]

    def _warn(self, count: int, whole: int, opened: Optional[OpenSequence]) -> None:
        """Warns that the data set is incomplete, or raises DatasetError if it was not asked for."""
        state = f"{self.path}: is incomplete (no manifest.json): {whole} of {count} sequences are whole"
        if opened is not None:
            ticks = len(np.unique(opened.index[:, 0]))
            state += f", and {ticks} ticks of sequence {opened.number} are written"
        if not self._incomplete or (not whole and opened is None):
            raise DatasetError(
                state
                + "; finish it with `greatx generate --resume`"
                + (", or load what is there with incomplete=True" if whole or opened is not None else "")
            )
        warnings.warn(state, stacklevel=5)

    def __reduce__(self):
        return _reopen, (str(self.path), self._incomplete)

    @property
    def run(self) -> Dict[str, Any]:
        """Returns the description of the run: scenario, seed, effects, device, `materials`, `instances`,
        `semantic_classes`, ..."""
        return self.info["run"]

    @property
    def georeference(self) -> Optional[Dict[str, Any]]:
        """Returns the place of x = y = z = 0 on the Earth: latitude_deg, longitude_deg, height_m (above the
        ellipsoid), undulation_m and vertical_datum. None if the scene has none.
        geodesy.LocalFrame.of(dataset) converts positions."""
        if "georeference" not in self.run:
            return None
        field = Field(self.path / "dataset.json", self.run, "run")["georeference"]
        return {
            "latitude_deg": field["latitude_deg"].number(-90.0, 90.0),
            "longitude_deg": field["longitude_deg"].number(-180.0, 180.0),
            "height_m": field["height_m"].number(-1e6, 1e6),
            "undulation_m": field["undulation_m"].number(-1e4, 1e4),
            "vertical_datum": field["vertical_datum"].text(),
        }

    @property
    def materials(self) -> List[str]:
        """Returns the names of the materials. The id k in `material` and `object_material` arrays stands for
        materials[k - 1], and 0 for none."""
        return self._names("materials")

    @property
    def instances(self) -> List[Dict[str, str]]:
        """Returns the name and class of each instance. The id k in `instance` and `object` arrays stands for
        instances[k - 1], and 0 for none."""
        return self._run_list("instances", dict)

    @property
    def semantic_classes(self) -> List[str]:
        """Returns the names of the semantic classes; the values of `semantic` arrays are indices into this
        list.
        """
        return self._names("semantic_classes")

    def _names(self, key: str) -> List[str]:
        return self._run_list(key, str)

    def _run_list(self, key: str, kind: type) -> List[Any]:
        field = Field(self.path / "dataset.json", self.run, "run")[key]
        for entry in field.items(1 << 22):
            if not isinstance(entry.value, kind):
                raise entry.fail("an object" if kind is dict else "a string")
        return field.value

    def single(self) -> "Sequence":
        """Returns the only sequence. Raises DatasetError if there are several."""
        if len(self.sequences) != 1:
            raise DatasetError(
                f"{self.path}: has {len(self.sequences)} sequences: say which one, as in ds.sequences[0]"
            )
        return self.sequences[0]

    def __getitem__(self, sensor: str) -> "Sensor":
        """Returns the sensor of this name in the only sequence."""
        return self.single()[sensor]

    def at(self, tick: int) -> "Tick":
        """Returns the records of all sensors at a tick of the only sequence."""
        return self.single().at(tick)

    def samples(
        self, arrays: Union[str, Iterable[str]], sequences: Optional[Iterable[int]] = None, pad: bool = False
    ) -> "Samples":
        """Returns one dict of NumPy arrays per tick (see greatx.samples.Samples). Needs no torch."""
        from .samples import Samples

        return Samples(self, arrays, sequences, pad)

    def torch(
        self,
        arrays: Union[str, Iterable[str]],
        sequences: Optional[Iterable[int]] = None,
        pad: bool = False,
        transform: Any = None,
    ) -> Any:
        """Returns a map-style torch.utils.data.Dataset with one dict of tensors per tick. The arguments are
        those of greatx.samples.Samples; `transform` is applied to each dict. Raises ImportError without
        torch.
        """
        from .samples import as_torch

        return as_torch(self.samples(arrays, sequences, pad), transform, "Dataset")

    def __repr__(self) -> str:
        return (
            f"<greatx.Dataset {str(self.path)!r}: {len(self.sequences)} sequences, "
            f"tick rate {self.tick_rate_hz} Hz, sensors {', '.join(self.sensors)}>"
        )


def _reopen(folder: str, incomplete: bool) -> Dataset:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the first one has warned
        return Dataset(folder, incomplete)


class Sequence:
    """Holds one run of the scenario."""

    def __init__(self, dataset: Dataset, number: int, index: Optional[np.ndarray] = None):
        """`index` is that of a sequence that is still being written."""
        self.dataset = dataset
        self.number = number
        self.path = dataset.path / f"sequence_{number:04d}"
        #: whether all of its records are there; otherwise it holds those of the time when it was opened
        self.whole = index is None
        if index is not None:
            self._check_index(dataset.path / JOURNAL, index)
            self.__dict__["index"] = index

    @functools.cached_property
    def index(self) -> np.ndarray:
        """int64 [records, 5]: tick, time_ns, sensor, sample, row (docs/dataset.md), sorted by tick, then by
        sensor."""
        path = inside(self.dataset.path, f"{self.path.name}/index.npy")
        return self._check_index(path, load_npy(path))

    @functools.cached_property
    def ticks(self) -> np.ndarray:
        """int64 [ticks]: the ticks that have records, ascending."""
        return np.unique(self.index[:, 0])

    @functools.cached_property
    def sensors(self) -> Dict[str, "Sensor"]:
        """The sensors by name, in the order of their numbers in the index."""
        return {name: Sensor(self, i, info) for i, (name, info) in enumerate(self.dataset.sensors.items())}

    def _check_index(self, path: pathlib.Path, index: np.ndarray) -> np.ndarray:
        if index.ndim != 2 or index.shape[1] != len(INDEX_COLUMNS) or index.dtype != np.int64:
            raise DatasetError(
                f"{path}: expected int64 [records, {len(INDEX_COLUMNS)}], found {index.dtype.name} "
                f"{list(index.shape)}"
            )
        most = (self.dataset._ticks - 1, 2**62, len(self.dataset.sensors) - 1, MOST_TICKS, MOST_TICKS)
        for column, (name, limit) in enumerate(zip(INDEX_COLUMNS, most)):
            bad = np.flatnonzero((index[:, column] < 0) | (index[:, column] > limit))
            if len(bad):
                raise DatasetError(
                    f"{path}: row {bad[0]}: expected a {name} from 0 to {limit}, "
                    f"found {index[bad[0], column]}"
                )
        ticks, sensors = index[:, 0], index[:, 2]
        back = np.flatnonzero((np.diff(ticks) < 0) | ((np.diff(ticks) == 0) & (np.diff(sensors) <= 0)))
        if len(back):
            raise DatasetError(f"{path}: row {back[0] + 1} is not in order of tick and sensor")
        return index

    def __getitem__(self, sensor: str) -> "Sensor":
        try:
            return self.sensors[sensor]
        except KeyError:
            raise KeyError(
                f"{self.dataset.path}: has no sensor {sensor!r}{nearest(sensor, self.sensors)}; it has "
                f"{', '.join(self.sensors)}"
            ) from None

    def first(self, kind: str, arrays: Iterable[str] = ()) -> "Sensor":
        """Returns the first sensor of a kind ("csi", "camera", "lidar", ...) that has records and all of the
        given arrays. Raises DatasetError if there is none.
        """
        wanted = list(arrays)
        for sensor in self.sensors.values():
            if sensor.kind == kind and len(sensor) and all(name in sensor for name in wanted):
                return sensor
        has = ", ".join(f"{s.name} ({s.kind}, {len(s)} records)" for s in self.sensors.values()) or "none"
        raise DatasetError(
            f"{self.path}: expected a sensor of kind {kind!r} with records"
            + (f" of {', '.join(wanted)}" if wanted else "")
            + f", found {has}; "
            + self._needs(kind, wanted)
        )

    def _needs(self, kind: str, wanted: List[str]) -> str:
        """Says what a scenario needs for a sensor of a kind with arrays."""
        outputs = list(dict.fromkeys(OUTPUT_OF[name] for name in wanted if name in OUTPUT_OF))
        what = "a channel" if kind == "csi" else f"a sensor of type {kind}"
        text = f"the scenario needs {what}" + (f" with outputs: [{', '.join(outputs)}]" if outputs else "")
        for sensor in self.sensors.values():
            lacks = [name for name in wanted if name not in sensor]
            if sensor.kind == kind and lacks:
                return f"{text}; {sensor.name} has no {', '.join(lacks)}"
        return text

    @property
    def poses(self) -> "Sensor":
        """Returns the sensor with the poses of all nodes. Its arrays are `position` [records, nodes, 3] m,
        `orientation` [records, nodes, 4] (w, x, y, z), `velocity`, ..., and for a scene with a georeference
        `geodetic` [records, nodes, 3] (latitude and longitude in degrees, height in m above the ellipsoid);
        its metadata `nodes` holds the names.
        """
        for sensor in self.sensors.values():
            if sensor.kind == "pose":
                return sensor
        raise DatasetError(f"{self.dataset.path}: has no poses")

    def at(self, tick: int) -> "Tick":
        """Returns the records of all sensors at a tick. Raises KeyError if the tick has no record."""
        first, last = np.searchsorted(self.index[:, 0], [tick, tick + 1])
        if first == last:
            raise KeyError(
                f"{self.path}: nothing was recorded at tick {tick}; ticks are {self.ticks[0]} to "
                f"{self.ticks[-1]}, {len(self.ticks)} of them"
                if len(self.ticks)
                else f"{self.path}: is empty"
            )
        names = list(self.sensors)
        return Tick(
            int(tick),
            int(self.index[first, 1]),
            self,
            {
                names[s]: Record(self.sensors[names[s]], int(row))
                for s, row in self.index[first:last][:, [2, 4]]
            },
        )

    def __iter__(self) -> Iterator["Tick"]:
        return (self.at(int(tick)) for tick in self.ticks)

    def __len__(self) -> int:
        """Returns the number of ticks that have records."""
        return len(self.ticks)

    def __repr__(self) -> str:
        return f"<greatx.Sequence {self.number}: {len(self.ticks)} ticks, sensors {', '.join(self.sensors)}>"


class Tick(TickRecords["Record"]):
    """Maps the names of the sensors that fired at one tick to their records."""

    def __init__(self, tick: int, time_ns: int, sequence: Sequence, records: Dict[str, "Record"]):
        super().__init__(tick, time_ns, records, where=f"{sequence.path}: ")
        self.sequence = sequence

    @property
    def time_s(self) -> float:
        return float(self.tick / self.sequence.dataset.tick_rate_hz)


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
