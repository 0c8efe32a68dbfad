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
    Optional,
    Union,
)

import numpy as np

from .errors import DatasetError, nearest
from .files import MOST_SEQUENCES, MOST_TICKS, Field, inside
from .frames import load_npy
from .layout import SensorInfo, parse_sensors, read_info
from .opened import OpenArrays
from .sensor import Record, Sensor
from .ticks import TickRecords
from .unfinished import JOURNAL, OpenSequence, open_sequence, read_journal

if TYPE_CHECKING:
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
