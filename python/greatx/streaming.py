# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Gives what networks take straight from the engine, sequence after sequence, without files (docs/python.md).

Data flow: Simulation.run(sequence) -> the arrays of a tick at which all wanted sensors have a record -> their
modalities -> the buffer that mixes items -> the user. The engine works in a thread of its own, so that it
computes the next items while a network trains; `prefetch` bounds how far it runs ahead.

The place of an item, (sequence, tick), says all about it: the engine gives the same arrays whenever it
computes it again. The state of a stream is therefore a few numbers.
"""
from __future__ import annotations

import atexit
import contextlib
import os
import queue
import threading
from typing import Any, Dict, Iterable, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .errors import Error
from .modalities import Source, arrays_of

#: Sequences that a stream may have; what a scenario says about its number of sequences does not end a stream.
MOST_SEQUENCES = 1_000_000
STATE_VERSION = 1

Item = Dict[str, Any]
Place = Tuple[int, int]  #: sequence, tick


class Position(NamedTuple):
    """Where the engine is."""

    round: int  #: sequences that are done
    tick: int  #: the next one of the sequence


class State(NamedTuple):
    """Where a stream is after an item."""

    position: Position
    given: int  #: items that the user has
    held: Tuple[Place, ...]  #: items in the buffer, by place in it


class _Engine:
    """Computes items from a position on. Owns a Simulation, so it is made where it is used."""

    def __init__(self, stream: "Stream"):
        from . import Simulation  # says how to get the compiled module, if it is not here

        self._stream = stream
        self._simulation = Simulation(
            stream.scenario, seed=stream.seed, sequences=MOST_SEQUENCES, **stream.options
        )
        self.ticks = self._simulation.ticks
        self._run: Any = None  #: the last one, which begins the next sequence sooner than a new one would
        #: by name: sensor and array; known when a run has begun
        self._names: Dict[str, Tuple[str, str]] = {}
        self._makes: Dict[str, Any] = {}

    def items(self, position: Position) -> Iterator[Tuple[Item, Position]]:
        """Gives each item with the position after it."""
        while True:
            found, sequence = False, self._stream.sequence_of(position.round)
            for item in self._of_sequence(sequence, position.tick):
                found = True
                yield item, Position(position.round, item["tick"] + 1)
            if not found and position.tick == 0:
                raise Error(
                    f"{self._simulation.name}: sequence {sequence} has no tick at which "
                    f"{', '.join(self._sensors())} all have a record"
                )
            position = Position(position.round + 1, 0)

    def again(self, places: Sequence[Place]) -> Dict[Place, Item]:
        """Computes items once more."""
        wanted: Dict[int, List[int]] = {}
        for sequence, tick in places:
            wanted.setdefault(sequence, []).append(tick)
        out: Dict[Place, Item] = {}
        for sequence, ticks in wanted.items():
            for item in self._of_sequence(sequence, min(ticks)):
                if item["tick"] in ticks:
                    out[(sequence, item["tick"])] = item
                if item["tick"] >= max(ticks):
                    break
        lost = [place for place in places if place not in out]
        if lost:
            raise Error(f"{self._simulation.name}: has no item at sequence {lost[0][0]}, tick {lost[0][1]}")
        return out

    def _of_sequence(self, sequence: int, first_tick: int) -> Iterator[Item]:
        if first_tick >= self.ticks:
            return
        if self._run is None:
            run = self._simulation.run(sequence, first_tick)
        else:
            run, self._run = self._run, None  # a run that ends with an error is not kept
            run.restart(sequence, first_tick)
        if not self._names:
            self._names = {name: _find(run, name) for name in self._stream.names}
            source = Source.of(run)
            self._makes = {name: m.bind(source) for name, m in self._stream.modalities.items()}
        sensors = self._sensors()
        try:
            for tick in run:
                if all(sensor in tick for sensor in sensors):
                    yield self._item(sequence, tick)
        except GeneratorExit:  # the rest of the sequence is not wanted
            self._run = run
            raise
        self._run = run

    def _sensors(self) -> List[str]:
        return sorted({sensor for sensor, _ in self._names.values()})

    def _item(self, sequence: int, tick: Any) -> Item:
        item: Item = {"sequence": sequence, "tick": tick.tick, "time_s": tick.time_s}
        recorded = {name: tick[sensor][array] for name, (sensor, array) in self._names.items()}
        if not self._makes:
            return {**item, **recorded}
        recorded.update(item)
        item.update((name, make(recorded, None)) for name, make in self._makes.items())
        return item


def _find(run: Any, name: str) -> Tuple[str, str]:
    """Returns the sensor and the array of "SENSOR/ARRAY". As in data sets, paths/delay is delay."""
    known = []
    for sensor, facts in run.sensors.items():
        arrays = [array["name"] for array in facts["arrays"]]
        known += [f"{sensor}/{array}" for array in arrays]
        if name.startswith(sensor + "/") and name.rsplit("/", 1)[1] in arrays:
            return sensor, name.rsplit("/", 1)[1]
    raise Error(f"modalities: expected arrays of the run, {', '.join(known)}; found {name!r}")


class Stream:
    """Iterates over items without end; see greatx.stream. An iteration goes on where the last one ended."""

    def __init__(
        self,
        scenario: Any,
        modalities: Union[Mapping[str, Any], Iterable[str]],
        seed: int,
        buffer: int,
        prefetch: int,
        part: Tuple[int, int],
        options: Dict[str, Any],
    ):
        for name, value, least in (("seed", seed, 0), ("buffer", buffer, 1), ("prefetch", prefetch, 0)):
            if value < least:
                raise Error(f"{name}: expected {least} or more, found {value}")
        if not 0 <= part[0] < part[1]:
            raise Error(f"part: expected (i, n) with 0 <= i < n, found {part}")
        self.scenario = scenario if isinstance(scenario, Mapping) else os.fspath(scenario)
        self.seed, self.buffer, self.prefetch, self.part, self.options = seed, buffer, prefetch, part, options
        #: empty if arrays are given as they are recorded
        self.modalities: Dict[str, Any] = dict(modalities) if isinstance(modalities, Mapping) else {}
        wanted = arrays_of(modalities) if isinstance(modalities, Mapping) else tuple(modalities)
        if not wanted or any("/" not in name for name in wanted):
            raise Error(
                f"modalities: expected names SENSOR/ARRAY or a dict of modalities, found {modalities!r}"
            )
        self.names = wanted
        self._engine: Optional[Tuple[int, "_Engine"]] = None  #: with the process that made it
        self._state = State(Position(0, 0), 0, ())

    def sequence_of(self, round_: int) -> int:
        """Returns the number of a sequence of this part."""
        return self.part[0] + round_ * self.part[1]

    # The state.

    def state_dict(self) -> Dict[str, Any]:
        """Returns where the stream is after the item that it gave last, as numbers and lists that JSON and
        torch.save keep. The items in the buffer are kept as places, and computed again when a stream goes on.
        """
        position, given, held = self._state
        return {
            "version": STATE_VERSION,
            "seed": self.seed,
            "buffer": self.buffer,
            "part": list(self.part),
            "round": position.round,
            "tick": position.tick,
            "given": given,
            "held": [list(place) for place in held],
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Goes on where another stream of the same scenario, seed, buffer and part was: the items that follow
        are those of that stream. Raises Error if one of these differs, except for the scenario, which the
        state does not know.
        """
        same = {
            "version": STATE_VERSION,
            "seed": self.seed,
            "buffer": self.buffer,
            "part": list(self.part),
        }
        for name, value in same.items():
            if state.get(name) != value:
                raise Error(f"state: expected {name} {value!r}, found {state.get(name)!r}")
        held = tuple((int(sequence), int(tick)) for sequence, tick in state["held"])
        self._state = State(Position(int(state["round"]), int(state["tick"])), int(state["given"]), held)

    # The items.

    def __iter__(self) -> Iterator[Item]:
        produced = self._mixed()
        if self.prefetch:
            produced = _ahead(produced, self.prefetch)
        with contextlib.closing(produced):
            for item, state in produced:
                self._state = state
                yield item

    def _own_engine(self) -> "_Engine":
        """Returns the engine of this process: that of the last iteration, if there was one."""
        if self._engine is None or self._engine[0] != os.getpid():
            self._engine = (os.getpid(), _Engine(self))
        return self._engine[1]

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_engine": None}

    def _mixed(self) -> Iterator[Tuple[Item, State]]:
        """Draws items from a buffer through which they go. With a buffer of 1, they stay in order."""
        engine = self._own_engine()
        (round_, tick), given, places = self._state
        again = engine.again(places) if places else {}
        held: List[Item] = [again[place] for place in places]
        for item, position in engine.items(Position(round_, tick)):
            if len(held) < self.buffer - 1:
                held.append(item)
                continue
            # A draw depends on its number alone, so that the state needs no generator.
            at = int(np.random.default_rng([self.seed, *self.part, given]).integers(self.buffer))
            if at < len(held):
                held[at], item = item, held[at]
            given += 1
            places = tuple((other["sequence"], other["tick"]) for other in held)
            yield item, State(position, given, places)

    def torch(self, transform: Any = None) -> Any:
        """Returns a torch.utils.data.IterableDataset of the items with tensors for arrays, which has
        state_dict() and load_state_dict() too. Use it in a DataLoader without workers: the engine has its
        thread already. With workers, each computes sequences of its own, and there is no state.
        """
        try:
            from .torch_stream import TorchStream
        except ImportError as error:
            raise ImportError(
                f"Stream.torch needs PyTorch (`pip install torch`): {error}. "
                "The stream itself gives the same as NumPy arrays"
            ) from error
        return TorchStream(self, transform)

    def parted(self, place: int, places: int) -> "Stream":
        """Returns a new stream of the place-th of `places` parts of this stream's sequences."""
        part = (self.part[0] + self.part[1] * place, self.part[1] * places)
        wanted = self.modalities or self.names
        return Stream(self.scenario, wanted, self.seed, self.buffer, self.prefetch, part, self.options)

    def __repr__(self) -> str:
        what = self.scenario if isinstance(self.scenario, str) else "a scenario"
        return f"<greatx.Stream of {what}, seed {self.seed}, {self._state.given} items given>"


def _ahead(produced: Iterator[Any], most: int) -> Iterator[Any]:
    """Iterates in a thread, at most `most` items ahead of the caller."""
    ready: "queue.Queue[Tuple[bool, Any]]" = queue.Queue(most)
    left = threading.Event()

    def put(entry: Tuple[bool, Any]) -> bool:
        while not left.is_set():
            try:
                ready.put(entry, timeout=0.1)
                return True
            except queue.Full:
                continue
        return False

    def work() -> None:
        try:
            with contextlib.closing(produced):
                for entry in produced:
                    if not put((True, entry)):
                        return
        except BaseException as error:  # the caller raises it
            put((False, error))

    thread = threading.Thread(target=work, name="greatx.stream", daemon=True)

    def stop() -> None:
        left.set()
        thread.join()

    # The thread must not be within the engine when the interpreter ends.
    atexit.register(stop)
    thread.start()
    try:
        while True:
            good, entry = ready.get()
            if not good:
                raise entry
            yield entry
    finally:
        stop()
        atexit.unregister(stop)


def stream(
    scenario: Any,
    modalities: Union[Mapping[str, Any], Iterable[str]],
    *,
    seed: int = 0,
    buffer: int = 1,
    prefetch: int = 8,
    part: Tuple[int, int] = (0, 1),
    **options: Any,
) -> Stream:
    """Returns an endless training set that the engine computes while it is used.

        stream = greatx.stream("city", {"rgb": Picture("uav/front", 224), "csi": CsiMap("csi")}, seed=1)
        for item in stream: item["rgb"], item["csi"], item["sequence"], item["tick"]
        loader = torch.utils.data.DataLoader(stream.torch(), batch_size=64)

    scenario    as for greatx.Simulation: a name, a file, or a dict
    modalities  what an item has, by name: objects of greatx.modalities. Or names "SENSOR/ARRAY", whose arrays
                come as they are recorded
    seed        the scenario's seed, and that of the order of items
    buffer      items that are mixed: each item is drawn from so many. 1: in order
    prefetch    items that the engine may be ahead; 0: it computes an item when it is asked for
    part        (i, n): sequences i, i + n, i + 2 n, ..., for processes that train together
    options     of greatx.Simulation: assets, ticks, effects, environment, device, ...

    An item is a tick at which all sensors that modalities need have a record; those of sequence 0 come first,
    then those of sequence 1, and so on. Their arrays are those of the data set that `greatx generate` writes
    with this seed. The scenario's own number of sequences does not matter. Items also have "sequence", "tick"
    and "time_s".

    The stream is resumable: state_dict() after an item, load_state_dict() in another process, and the items
    that follow are the same as without the interruption. A sequence that it resumes in the middle is computed
    from that tick on, except for event cameras, which the engine takes through the ticks before. With a
    buffer, the items in it are computed again, too.
    """
    return Stream(scenario, modalities, seed, buffer, prefetch, part, options)
