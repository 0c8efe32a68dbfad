# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Names the inputs of a network: which arrays of which sensor, and what is made of them (docs/python.md).

greatx.batches and greatx.stream take a dict of modalities. A modality knows the arrays that it needs. Bound
to a source, which is a data set or a run in memory, it gives a function that turns the arrays of a tick into
an array for a network, by the functions of greatx.inputs. A class with `arrays` and `bind` is a modality.
"""
from __future__ import annotations

import dataclasses
from fractions import Fraction
from typing import Any, Callable, Dict, Mapping, Optional, Tuple

import numpy as np

from . import inputs
from .errors import Error
from .events import Events
from .sizes import Size, result

#: Makes the input of an item, a dict of arrays by "SENSOR/ARRAY" with "tick"; in `out`, if that is given.
Make = Callable[[Mapping[str, Any], Optional[np.ndarray]], np.ndarray]

#: Signed types that hold the values of unsigned types. torch computes with no unsigned integers except uint8.
_SIGNED = {"uint16": np.dtype(np.int32), "uint32": np.dtype(np.int64)}


def signed(value: Any) -> Tuple[np.ndarray, np.dtype]:
    """Returns an array, and the type in which torch computes with its values: uint16 becomes int32, uint32
    becomes int64, and uint64 becomes int64 with the same bits. Other types stay.
    """
    array = np.asarray(value)
    if array.dtype == np.uint64:
        array = array.view(np.int64)
    return array, _SIGNED.get(array.dtype.name, array.dtype)


@dataclasses.dataclass(frozen=True)
class SensorFacts:
    """What a source says about a sensor."""

    metadata: Mapping[str, Any]
    rate_hz: Optional[Fraction]
    tick_rate_hz: Fraction

    def time_ns(self, tick: int) -> int:
        """Returns the time of a tick, rounded to nanoseconds."""
        return round(Fraction(tick) * 10**9 / self.tick_rate_hz)

    def tick_before(self, tick: int) -> int:
        """Returns the tick of the sensor's record before the one at `tick`: sample k is at tick
        floor(k tick_rate / rate + 1/2) (docs/dataset.md). Of the first record, it is negative.
        """
        if self.rate_hz is None:
            raise Error("expected a sensor with a rate")
        steps = self.tick_rate_hz / self.rate_hz
        sample = -((Fraction(1, 2) - tick) // steps)  # the least k with k steps >= tick - 1/2
        return int(((sample - 1) * steps + Fraction(1, 2)) // 1)


class Source:
    """The sensors of a data set or of a run in memory."""

    def __init__(self, sensors: Mapping[str, Any], tick_rate_hz: Fraction, where: str):
        self._sensors, self._tick_rate_hz, self._where = sensors, tick_rate_hz, where

    @classmethod
    def of(cls, data: Any) -> "Source":
        """Returns the sensors of a greatx.Dataset or of a greatx.Run."""
        return cls(data.sensors, data.tick_rate_hz, str(getattr(data, "path", "the run")))

    def __getitem__(self, name: str) -> SensorFacts:
        if name not in self._sensors:
            raise Error(f"{self._where}: has no sensor {name!r}; it has {', '.join(self._sensors)}")
        sensor = self._sensors[name]
        if isinstance(sensor, Mapping):  # of a run: as in dataset.json
            rate = Fraction(sensor["rate_hz"]) if sensor["rate_hz"] else None
            return SensorFacts(sensor["metadata"], rate, self._tick_rate_hz)
        return SensorFacts(sensor.metadata, sensor.rate_hz, self._tick_rate_hz)


@dataclasses.dataclass(frozen=True)
class Picture:
    """A camera's picture, uint8 [3, rows, columns] (inputs.picture)."""

    sensor: str
    size: Size = 224

    @property
    def arrays(self) -> Tuple[str, ...]:
        return (f"{self.sensor}/rgb",)

    def bind(self, source: Source) -> Make:
        (rgb,) = self.arrays
        return lambda item, out: inputs.picture(item[rgb], self.size, out)


@dataclasses.dataclass(frozen=True)
class Depth:
    """A camera's depth over max_m, float32 [1, rows, columns] (inputs.depth_map)."""

    sensor: str
    size: Size = 224
    max_m: float = 200.0

    @property
    def arrays(self) -> Tuple[str, ...]:
        return (f"{self.sensor}/depth",)

    def bind(self, source: Source) -> Make:
        (depth,) = self.arrays
        return lambda item, out: inputs.depth_map(item[depth], self.size, self.max_m, out)


@dataclasses.dataclass(frozen=True)
class RangeImage:
    """A LiDAR's range and intensity, float32 [2, rows, columns] (inputs.lidar_map). `size` None: a row for
    each channel, and 256 columns.
    """

    sensor: str
    size: Optional[Size] = None

    @property
    def arrays(self) -> Tuple[str, ...]:
        return (f"{self.sensor}/points",)

    def bind(self, source: Source) -> Make:
        (points,) = self.arrays
        metadata = source[self.sensor].metadata
        size = (len(metadata.get("elevations_deg", range(64))), 256) if self.size is None else self.size
        return lambda item, out: inputs.lidar_map(item[points], metadata, size, out)


@dataclasses.dataclass(frozen=True)
class CsiMap:
    """A link's channel by angle and delay, float32 [4, beams, delays] (inputs.csi_map).

    delays         columns that are kept; None: all
    panel          whether rows, columns and polarizations of the array are transformed apart (the receiver's
                   array, if the transmitter has one port). Otherwise the ports are one line
    reference      amplitude that the map is divided by; None: its own largest magnitude
    rx, tx, time   places of the link in the channel's lists, and the time sample

    Of ends with several ports each, the maps of the receiver's ports follow each other in the rows.
    """

    sensor: str
    delays: Optional[int] = 64
    panel: bool = True
    floor_db: float = 60.0
    reference: Optional[float] = None
    rx: int = 0
    tx: int = 0
    time: int = 0

    @property
    def arrays(self) -> Tuple[str, ...]:
        return (f"{self.sensor}/cfr",)

    def bind(self, source: Source) -> Make:
        (cfr,) = self.arrays
        metadata = source[self.sensor].metadata
        transmitter, receiver = metadata["transmitters"][self.tx], metadata["receivers"][self.rx]
        by_receiver = transmitter["ports"] == 1
        panel = inputs.panel_of(receiver if by_receiver else transmitter) if self.panel else None

        def make(item: Mapping[str, Any], out: Optional[np.ndarray]) -> np.ndarray:
            h = inputs.link_cfr(item[cfr], self.rx, self.tx, self.time)
            if not by_receiver:
                h = h.reshape(receiver["ports"], transmitter["ports"], h.shape[-1])
            value = inputs.angle_delay(h, self.delays, panel=panel)
            value = value.reshape(-1, value.shape[-1])
            return inputs.csi_channels(value, self.floor_db, self.reference, out)

        return make


@dataclasses.dataclass(frozen=True)
class RadarMap:
    """A radar's map over its noise, float32 [1, rows, columns] (inputs.radar_map). `size` None: as it is
    recorded.
    """

    sensor: str
    array: str = "range_azimuth"
    size: Optional[Size] = None
    span_db: float = 60.0

    @property
    def arrays(self) -> Tuple[str, ...]:
        return (f"{self.sensor}/{self.array}",)

    def bind(self, source: Source) -> Make:
        (power,) = self.arrays
        return lambda item, out: inputs.radar_map(item[power], self.size, self.span_db, out=out)


@dataclasses.dataclass(frozen=True)
class EventVoxels:
    """The events since the sensor's record before, float32 [bins, rows, columns] (inputs.event_voxels). The
    first bin is at the time of the record before, the last one at that of this record.
    """

    sensor: str
    bins: int = 5
    size: Optional[Size] = None

    @property
    def arrays(self) -> Tuple[str, ...]:
        return tuple(f"{self.sensor}/{name}" for name in "txyp")

    def bind(self, source: Source) -> Make:
        facts, names = source[self.sensor], self.arrays
        width, height = (int(facts.metadata[side]) for side in ("width", "height"))

        def make(item: Mapping[str, Any], out: Optional[np.ndarray]) -> np.ndarray:
            events = Events(*(item[name] for name in names), width, height)
            if len(events) and (events.x.max() >= width or events.y.max() >= height):
                raise Error(f"{self.sensor}: expected events within {width} x {height} pixels")
            tick = item["tick"]
            span = (facts.time_ns(facts.tick_before(tick)), facts.time_ns(tick))
            return inputs.event_voxels(events, self.bins, self.size, span, out)

        return make


@dataclasses.dataclass(frozen=True)
class Values:
    """An array of fixed shape as it is recorded, "SENSOR/ARRAY". Of the unsigned integers, uint16 becomes
    int32, and uint32 and uint64 become int64 (uint64 of the same bits), as in Dataset.torch.
    """

    array: str

    @property
    def arrays(self) -> Tuple[str, ...]:
        return (self.array,)

    def bind(self, source: Source) -> Make:
        def make(item: Mapping[str, Any], out: Optional[np.ndarray]) -> np.ndarray:
            value, dtype = signed(item[self.array])
            out = result(out, value.shape, dtype)
            np.copyto(out, value)
            return out

        return make


@dataclasses.dataclass(frozen=True)
class Computed:
    """What `function` makes of one or several arrays, in this order. It returns an array whose shape and type
    are those of all items. To pass it to workers by spawn, give a function of a module.
    """

    names: Tuple[str, ...]
    function: Callable[..., Any]

    @property
    def arrays(self) -> Tuple[str, ...]:
        return self.names

    def bind(self, source: Source) -> Make:
        def make(item: Mapping[str, Any], out: Optional[np.ndarray]) -> np.ndarray:
            value = np.asarray(self.function(*(item[name] for name in self.names)))
            if out is None:
                return value
            np.copyto(result(out, value.shape, value.dtype), value)
            return out

        return make


def arrays_of(modalities: Mapping[str, Any]) -> Tuple[str, ...]:
    """Returns the arrays that modalities need, each once. Raises Error if one is none."""
    names: Dict[str, None] = {}
    if not modalities:
        raise Error("modalities: expected one or more, found none")
    for name, modality in modalities.items():
        if not (hasattr(modality, "arrays") and hasattr(modality, "bind")):
            raise Error(
                f"modalities: {name!r}: expected one of greatx.modalities, such as Picture('uav/front'), "
                f"found {modality!r}"
            )
        if name in ("sequence", "tick", "time_s", "cell"):
            raise Error(f"modalities: expected another name than {name!r}, which every batch has")
        names.update(dict.fromkeys(modality.arrays))
    return tuple(names)
