# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Computes scenes, paths and channels by the compiled module (docs/python.md)."""

from __future__ import annotations

import json
import logging
import os
import re
from fractions import Fraction
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _native
from .antenna import Array, look_from_to
from .errors import Error, nearest
from .paths import Paths
from .process import Owned
from .radio_map import RadioMap
from .run import Run

#: Receives the log of the engine.
logger = logging.getLogger("greatx")

PathLike = Union[str, "os.PathLike[str]"]
Position = Union[Sequence[float], np.ndarray]

#: Replaces the places that the scenario's parser and `greatx map` name in messages by the names of our
#: arguments.
_PLACES = [
    (r"^(\w+):1: ", r"\1: "),
    (r"nodes\[0\]\.sensors\[0\]\.mount\.rotation_deg", "orientation_deg"),
    (r"nodes\[0\]\.sensors\[0\]\.", "array."),
    (r"nodes\[0\]\.(trajectory\.)?", ""),
    (r"channels\[0\]\.tx", "transmitters"),
    (r"channels\[0\]\.rx", "receivers"),
    (r"channels\[0\]\.", ""),
    # The options of `greatx map`.
    (r"--cell", "cell_m"),
    (r"--min", "min_m"),
    (r"--max", "max_m"),
    (r"--plane Z", "z_m"),
    (r"--plane", "z_m"),
    (r"--height", "height_m"),
    (r"--power", "power_dbm"),
    (r"--bandwidth", "bandwidth_hz"),
    (r"--noise-figure", "noise_figure_db"),
    (r"--precoder (\w+)", r"precoder \1"),
    (r"--precoder", "precoder"),
    (r"--beam", "beam"),
    (r"--oversampling", "oversampling"),
    (r"--beyond-scene", "beyond_scene=True"),
]


def _call(function: Callable[..., Any], *arguments: Any) -> Any:
    """Calls a function of the engine. Passes the engine's log on to the logger "greatx", and replaces the
    places in error messages by names of arguments.
    """
    try:
        return function(*arguments)
    except Error as error:
        message = str(error)
        for place, argument in _PLACES:
            message = re.sub(place, argument, message)
        raise Error(message) from None
    finally:
        for level, text in _native.take_log():
            logger.log(level, text)


def _text(value: Any) -> str:
    """Returns a value as JSON, which is also YAML. Accepts NumPy's numbers and arrays."""
    return json.dumps(
        value, default=lambda other: other.tolist() if hasattr(other, "tolist") else os.fspath(other)
    )


class Effect(NamedTuple):
    """Describes the decision on one effect and its reason."""

    on: bool
    reason: str
    bound: str  #: largest change if the effect is off, or its cost if it is on; may be empty
    switchable: bool


def _turn(name: str, position_m: Position, orientation_deg: Any, look_at: Optional[Position]) -> Any:
    """Returns orientation_deg, or the orientation towards look_at if that is given."""
    if look_at is None:
        return orientation_deg
    if orientation_deg is not None:
        raise Error(f"{name}: expected one of orientation_deg and look_at, found both")
    return look_from_to(position_m, look_at)


class Simulation:
    """Holds a scenario, to which nodes and channels can be added, and computes its paths, channels, maps and
    records.

    scenario    name of an embedded scenario ("city"), a YAML file, or a dict with the contents of such a file
                (docs/scenario.md)
    assets      folder in which relative paths are looked up, in addition to the scenario's own folder (for a
                dict: the current folder)
    seed, ticks, sequences, tolerance_db, effects, environment
                values that replace those of the scenario. In effects and environment, only the named items
                are replaced, e.g. effects={"diffraction": "on"},
                environment={"time": "2026-12-21T08:30:00+01:00"}. If the scenario's place and time determine
                the sun, `azimuth_deg` and `elevation_deg` of `sun` replace them together; one angle alone is
                an error
    device      index of a Vulkan device, or part of its name; empty: $GREATX_DEVICE, else the best device
    tracer      how rays meet triangles: "auto" ($GREATX_TRACER, else the tree on a CPU and without ray
                queries), "driver" (ray queries) or "tree" (trees of greatx's own)
    validation  if true, runs under the Vulkan validation layer, whose messages raise a RuntimeError

    The scene is loaded and the device is opened when they are first needed. Faulty input raises a
    greatx.Error (a ValueError); a failure of the device raises a RuntimeError. Ctrl-C works between batches.
    A forked process cannot use its parent's Simulation (this raises greatx.Error) and must make its own.
    Positions are in metres in the world: x east, y north, z up. Orientations are yaw, pitch and roll in
    degrees; positive yaw is left, positive pitch is down.
    """

    def __init__(
        self,
        scenario: Union[PathLike, Mapping[str, Any]] = "city",
        *,
        assets: Optional[PathLike] = None,
        seed: Optional[int] = None,
        ticks: Optional[int] = None,
        sequences: Optional[int] = None,
        tolerance_db: Optional[float] = None,
        effects: Optional[Mapping[str, str]] = None,
        environment: Optional[Mapping[str, Any]] = None,
        device: str = "",
        tracer: str = "auto",
        validation: bool = False,
    ):
        options = ("" if assets is None else os.fspath(assets), device, validation, tracer)
        embedded = _native.embedded_scenarios()
        if isinstance(scenario, Mapping):
            session = _call(_native.Session.parse, _text(scenario), "scenario", *options)
        elif scenario in embedded:
            session = _call(_native.Session.parse, embedded[scenario], f"{scenario}.yaml", *options)
        elif os.path.isfile(scenario):
            session = _call(_native.Session.load, os.fspath(scenario), *options)
        else:
            raise Error(
                f"{os.fspath(scenario)}: no such scenario: expected a YAML file or one of "
                f"{', '.join(embedded)}{nearest(os.fspath(scenario), embedded)}"
            )
        self._native = Owned(session)
        self._placed: Dict[str, List[str]] = {"transmitters": [], "receivers": []}
        self._change(
            seed=seed,
            ticks=ticks,
            sequences=sequences,
            tolerance_db=tolerance_db,
            effects=effects,
            environment=environment,
        )

    @classmethod
    def from_scene(
        cls, file: PathLike, *, radio_materials: Optional[PathLike] = None, **options: Any
    ) -> "Simulation":
        """Makes a simulation of a glTF scene without nodes and channels. `radio_materials` is a YAML file
        with the radio properties of its materials. `options` are those of Simulation.
        """
        scene = {"file": os.path.abspath(file)}
        if radio_materials is not None:
            scene["radio_materials"] = os.path.abspath(radio_materials)
        return cls({"greatx": 1, "name": "scene", "ticks": 1, "scene": scene}, **options)

    # The next properties and functions describe the simulation.

    @property
    def _facts(self) -> Dict[str, Any]:
        return json.loads(self._native.facts())

    name = property(lambda self: self._facts["name"], doc="The scenario's.")
    seed = property(lambda self: self._facts["seed"])
    ticks = property(lambda self: self._facts["ticks"], doc="Of a sequence.")
    sequences = property(lambda self: self._facts["sequences"])
    tick_rate_hz = property(lambda self: Fraction(self._facts["tick_rate_hz"]))
    nodes = property(lambda self: self._facts["nodes"], doc="{node: {sensor: kind}}")
    antennas = property(lambda self: self._facts["antennas"], doc="[node/sensor]")
    place = property(
        lambda self: self._facts["place"],
        doc="{latitude_deg, longitude_deg, height_m, time}; None: sun and moon are where the scenario puts "
        "them.",
    )
    georeference = property(
        lambda self: self._facts["georeference"],
        doc="The place of x = y = z = 0 on the Earth: latitude_deg, longitude_deg, height_m (above the "
        "ellipsoid), undulation_m, vertical_datum; None: the scene has none. See geodesy.LocalFrame.",
    )
    channels = property(
        lambda self: self._facts["channels"],
        doc="{channel: its transmitters, receivers, carrier_hz, subcarriers, max_depth, ...}",
    )

    @property
    def scene(self) -> Dict[str, Any]:
        """Returns facts of the loaded scene: triangles, facets, bodies, bounds_m [[x, y, z], [x, y, z]],
        origin_m, materials, instances, sha256.
        """
        return json.loads(_call(self._native.scene_facts))

    @property
    def device(self) -> Dict[str, str]:
        """Returns the name, the type, the driver and the Vulkan version of the device, and the tracer."""
        return json.loads(_call(self._native.device_facts))

    @property
    def effects(self) -> Dict[str, Effect]:
        """Returns the decisions on all effects by name."""
        decided = json.loads(_call(self._native.explain))["effects"]
        return {e["name"]: Effect(e["on"], e["reason"], e["bound"], e["switchable"]) for e in decided}

    def explain(self) -> str:
        """Returns the text of `greatx explain`: which effects are on and why, and how each channel's paths
        will be found.
        """
        facts = json.loads(_call(self._native.explain))
        lines = [
            f"{'on' if e['on'] else 'off':<4} {e['name']:<24} "
            f"{e['reason']}{' — ' if e['bound'] else ''}{e['bound']}"
            for e in facts["effects"]
        ]
        for channel, notes in facts["channels"].items():
            lines += [
                f"channel {channel!r}, candidates:",
                *(f"  {name:<18} {text}" for name, text in notes.items()),
            ]
        return "\n".join(lines)

    # The next functions add to the scenario.

    def _parsed(self, function: Callable[..., Any], where: str, text: Mapping[str, Any], *more: Any) -> None:
        """Passes a part of a scenario to the parser."""
        whole = {"greatx": 1, "name": "change", "ticks": 1, "tick_rate_hz": str(self.tick_rate_hz), **text}
        _call(function, _text(whole), where, *more)

    def _beside(self, environment: Mapping[str, Any]) -> Mapping[str, Any]:
        """Returns a change of the environment, completed for the parser. Adds the scenario's place and time,
        unless the change replaces them by angles of the sun. Raises Error if only one angle is given.
        """
        place = self.place
        scene = self.georeference
        if place is None and scene is not None and "time" in environment and "place" not in environment:
            place = {
                "latitude_deg": scene["latitude_deg"],
                "longitude_deg": scene["longitude_deg"],
                "height_m": scene["height_m"] - scene["undulation_m"],
                "time": environment["time"],
            }
        sun = environment.get("sun")
        angles = {"azimuth_deg", "elevation_deg"} & set(sun if isinstance(sun, Mapping) else ())
        if place is None or not {"place", "time", "sun", "moon"} & set(environment):
            return environment
        if angles and not {"place", "time"} & set(environment):
            if len(angles) == 1:
                raise Error(
                    f"environment.sun.{angles.pop()}: expected azimuth_deg and elevation_deg both, in place "
                    "of the scenario's place and time, which say where the sun is "
                    "(environment.time moves it), found one"
                )
            return environment
        time = place.pop("time")
        given = environment.get("place", {})
        return {
            "time": time,
            **environment,
            "place": {**place, **given} if isinstance(given, Mapping) else given,
        }

    def _change(self, **fields: Any) -> None:
        given = {name: value for name, value in fields.items() if value is not None}
        keys: List[str] = []
        for name, value in given.items():
            if name != "environment":
                keys.append(name)
                continue
            for key, inner in value.items():
                keys += [f"environment.sun.{k}" for k in inner] if key == "sun" else [f"environment.{key}"]
        if "environment" in given:
            given["environment"] = self._beside(given["environment"])
        if given:
            self._parsed(self._native.change, "Simulation", given, keys)

    def add_node(self, node: Mapping[str, Any]) -> None:
        """Adds a node, given as an item of a scenario's `nodes`, with a trajectory, a mesh, cameras, LiDARs,
        antennas, ..."""
        self._parsed(self._native.add_nodes, "add_node", {"nodes": [node]})

    def _place(
        self, role: str, placed: Sequence[Tuple[str, Position, Any]], array: Optional[Array]
    ) -> List[str]:
        """Places antennas, each given by (name, position_m, orientation_deg). If one of them is faulty,
        places none.
        """
        nodes = [
            {
                "name": name,
                "trajectory": {"type": "static", "position_m": np.asarray(position).tolist()},
                "sensors": [(array or Array()).as_sensor("array", orientation)],
            }
            for name, position, orientation in placed
        ]
        self._parsed(self._native.add_nodes, "place_" + role, {"nodes": nodes})
        antennas = [f"{name}/array" for name, _, _ in placed]
        self._placed[role + "s"] += antennas
        return antennas

    def place_transmitter(
        self,
        name: str,
        position_m: Position,
        *,
        array: Optional[Array] = None,
        orientation_deg: Optional[Sequence[float]] = None,
        look_at: Optional[Position] = None,
    ) -> str:
        """Places an antenna at rest, by default one isotropic element of vertical polarization, and returns
        its name, "NAME/array".

        position_m is [x, y, z]. orientation_deg (yaw, pitch, roll) turns the boresight, which is +x;
        alternatively, look_at is a position to which the boresight points.
        """
        return self._place(
            "transmitter", [(name, position_m, _turn(name, position_m, orientation_deg, look_at))], array
        )[0]

    def place_receiver(
        self,
        name: str,
        position_m: Position,
        *,
        array: Optional[Array] = None,
        orientation_deg: Optional[Sequence[float]] = None,
        look_at: Optional[Position] = None,
    ) -> str:
        """Places a receiving antenna like place_transmitter()."""
        return self._place(
            "receiver", [(name, position_m, _turn(name, position_m, orientation_deg, look_at))], array
        )[0]

    def place_receivers(
        self,
        positions_m: np.ndarray,
        *,
        array: Optional[Array] = None,
        names: str = "rx{}",
        orientation_deg: Optional[Sequence[float]] = None,
    ) -> List[str]:
        """Places one receiver for every row of positions_m [N, 3]. For thousands of positions,
        paths(receivers=points) is faster."""
        return self._place(
            "receiver",
            [
                (names.format(i), position, orientation_deg)
                for i, position in enumerate(np.asarray(positions_m))
            ],
            array,
        )

    def add_channel(
        self,
        name: str,
        *,
        transmitters: Optional[Sequence[str]] = None,
        receivers: Optional[Sequence[str]] = None,
        carrier_hz: float = 3.5e9,
        **fields: Any,
    ) -> str:
        """Adds a channel between antennas ("node/sensor"), by default between all placed transmitters and all
        placed receivers. A channel without receivers can be used with paths(receivers=points) only. `fields`
        are those of a scenario's channel: bandwidth_hz or subcarrier_spacing_hz, subcarriers, time_samples,
        time_spacing_s, max_depth, max_transmissions, candidates, ...
        """
        tx = list(self._placed["transmitters"] if transmitters is None else transmitters)
        rx = list(self._placed["receivers"] if receivers is None else receivers)
        if not tx:
            raise Error(f"channel {name!r}: expected a transmitter, found none: place_transmitter() first")
        known = self.antennas
        for antenna in tx + rx:
            if antenna not in known:
                raise Error(
                    f"channel {name!r}: expected antennas of the scenario ({', '.join(known)}), "
                    f"found {antenna!r}"
                )
        # The parser requires that the antennas of a channel exist, so the text has stand-ins with their
        # names.
        sensors: Dict[str, List[str]] = {}
        for antenna in dict.fromkeys(tx + rx):
            node, sensor = antenna.rsplit("/", 1)
            sensors.setdefault(node, []).append(sensor)
        nodes = [
            {
                "name": node,
                "trajectory": {"type": "static", "position_m": [0, 0, 0]},
                "sensors": [{"name": sensor, "type": "antenna"} for sensor in names],
            }
            for node, names in sensors.items()
        ]
        channel = {
            "name": name,
            "tx": tx,
            "rx": rx or tx,
            "rate_hz": str(self.tick_rate_hz),
            "carrier_hz": carrier_hz,
            **fields,
        }
        self._parsed(
            self._native.add_channels, "add_channel", {"nodes": nodes, "channels": [channel]}, not rx
        )
        return name

    # The next functions compute results.

    def _channel(self, name: Optional[str]) -> str:
        channels = self.channels
        if name in channels:
            return name
        if name is None and len(channels) == 1:
            return next(iter(channels))
        what = (
            f"no channel {name!r}{nearest(name, channels)}"
            if name is not None
            else "several channels: say which" if channels else "no channel"
        )
        raise Error(
            f"{self.name}: has {what}; channels: {', '.join(channels) or 'none: add_channel() makes one'}"
        )

    @staticmethod
    def _antenna(array: Optional[Array], orientation_deg: Any) -> str:
        """Returns a scenario whose first antenna stands at receiving points."""
        return _text(
            {
                "greatx": 1,
                "name": "points",
                "ticks": 1,
                "nodes": [
                    {
                        "name": "points",
                        "trajectory": {"type": "static", "position_m": [0, 0, 0]},
                        "sensors": [(array or Array()).as_sensor("array", orientation_deg)],
                    }
                ],
            }
        )

    def paths(
        self,
        channel: Optional[str] = None,
        *,
        tick: int = 0,
        sequence: int = 0,
        receivers: Optional[np.ndarray] = None,
        array: Optional[Array] = None,
        orientation_deg: Optional[Sequence[float]] = None,
        progress: Optional[Callable[[int], None]] = None,
    ) -> Paths:
        """Computes all paths of a channel (None: the only one) at a tick, from all transmitters to all
        receivers.

        receivers         float64 [N, 3]: points at rest in the world, which replace the channel's receivers.
                          At each point stands `array` (by default one isotropic element of vertical
                          polarization), turned by orientation_deg. The paths equal those of placed antennas
                          bit by bit. Other points influence a path in one way only: the farthest point
                          decides which effects of the air are on (docs/paths.md). The search from the
                          transmitters is done once and kept for later calls.
        progress          function that is called from time to time with the number of finished receivers
        """
        name = self._channel(channel)
        points, antenna = None, ""
        if receivers is not None:
            points = np.ascontiguousarray(receivers, np.float64)
            if points.ndim != 2 or points.shape[1] != 3:
                raise Error(f"receivers: expected [N, 3] positions in metres, found {list(points.shape)}")
            antenna = self._antenna(array, orientation_deg)
        elif array is not None or orientation_deg is not None:
            raise Error(
                "array, orientation_deg: expected receivers=points with them; the channel's receivers have "
                "their own"
            )
        native = _call(self._native.solve, name, sequence, tick, points, antenna, progress)
        return Paths(native, None if points is not None else self.channels[name]["receivers"])

    def radio_map(
        self,
        cell_m: float,
        channel: Optional[str] = None,
        *,
        min_m: Optional[Position] = None,
        max_m: Optional[Position] = None,
        z_m: Optional[float] = None,
        height_m: float = 1.5,
        over: str = "ground",
        power_dbm: Optional[Union[float, Sequence[float]]] = None,
        bandwidth_hz: Optional[float] = None,
        noise_figure_db: float = 0.0,
        precoder: str = "mean",
        beam: Optional[int] = None,
        oversampling: Optional[Tuple[int, int]] = None,
        array: Optional[Array] = None,
        orientation_deg: Optional[Sequence[float]] = None,
        inside_solids: bool = False,
        beyond_scene: bool = False,
        tick: int = 0,
        sequence: int = 0,
        progress: Optional[Callable[[int], None]] = None,
    ) -> RadioMap:
        """Computes a map of a channel's transmitters like `greatx map`. Each cell has the values of a
        receiver at its centre.

        cell_m            side of the cells, metres
        min_m, max_m      [x, y] corners; by default the scene's bounds
        z_m               height of the plane; None: the map lies height_m above `over`, "ground" or "roofs"
        power_dbm         power of each transmitter, or of all; by default the channel's, else 30
        bandwidth_hz, noise_figure_db   bandwidth B and noise factor F (in dB) of the noise k 290 K B F; by
                          default the channel's bandwidth
        precoder          of the transmitters: "mean" over their ports, "beam", "best_beam", "maximum_ratio"
                          (docs/map.md)
        beam              of precoder "beam": index of a DFT beam, as in greatx.precoding.cross_polarized(
                          dft_panel(rows, columns, oversampling)), or in dft_panel() for one polarization
        oversampling      DFT beams per element along the rows and the columns; by default (1, 1)
        array, orientation_deg          the receiver's antenna; by default one isotropic element of vertical
                          polarization
        inside_solids     if true, cells inside solids have values, too
        beyond_scene      if true, a map that misses the scene is no error
        progress          function that is called from time to time with the number of finished cells
        """
        if over not in ("ground", "roofs"):
            raise Error(f"over: expected one of ground, roofs, found {over!r}")
        corner = [None if xy is None else [float(v) for v in xy] for xy in (min_m, max_m)]
        for name, xy in zip(("min_m", "max_m"), corner):
            if xy is not None and len(xy) != 2:
                raise Error(f"{name}: expected [x, y] in metres, found {xy}")
        return RadioMap(
            *_call(
                self._native.radio_map,
                self._channel(channel),
                sequence,
                tick,
                *corner,
                cell_m,
                z_m,
                height_m,
                over == "roofs",
                [] if power_dbm is None else [float(p) for p in np.atleast_1d(power_dbm)],
                bandwidth_hz,
                noise_figure_db,
                precoder,
                beam,
                None if oversampling is None else [int(o) for o in oversampling],
                inside_solids,
                beyond_scene,
                self._antenna(array, orientation_deg),
                progress,
            )
        )

    def run(self, sequence: int = 0, first_tick: int = 0) -> Run:
        """Runs the whole scenario in memory and returns an iterator over its ticks. A tick maps the names of
        the sensors that fired to their records, whose arrays are byte-identical to those of `greatx
        generate`:

            for tick in sim.run():
                tick["csi"].cfr, tick["uav/front"].rgb, tick["poses"].position
        """
        return Run(Owned(_call(self._native.stream, sequence, first_tick)), _call, self.tick_rate_hz)

    def __repr__(self) -> str:
        facts = self._facts
        return (
            f"<greatx.Simulation {facts['name']}: {len(facts['nodes'])} nodes, channels "
            f"{', '.join(facts['channels']) or 'none'}>"
        )
