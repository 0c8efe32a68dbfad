# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes messages of Foxglove's protobuf schemas, and JSON, to an MCAP file.

The optional packages are held by `Foxglove`, which only this converter makes. The bytes of a file depend on
the data set and on the versions of mcap, protobuf and zstandard alone: the times of messages are those of the
data, and no time of day is written.
"""

from __future__ import annotations

import importlib
import json
from typing import Any, Dict, List, Tuple

import numpy as np

from ..files import need

EXTRA = "mcap"
COMPRESSIONS = ("zstd", "lz4", "none")
SECOND = 10**9


class Foxglove:
    """Gives the classes of Foxglove's messages as attributes: fox.PointCloud(...)."""

    def __init__(self) -> None:
        self.writer, self.schema, self.timestamp, self.duration, _ = need(
            EXTRA,
            "mcap.writer",
            "mcap_protobuf.schema",
            "google.protobuf.timestamp_pb2",
            "google.protobuf.duration_pb2",
            "foxglove_schemas_protobuf.PointCloud_pb2",
        )

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or not name[:1].isupper():
            raise AttributeError(name)
        module = importlib.import_module(f"foxglove_schemas_protobuf.{name}_pb2")
        made = getattr(module, name)
        setattr(self, name, made)
        return made

    def time(self, time_ns: int) -> Any:
        """Returns a timestamp of whole nanoseconds."""
        return self.timestamp.Timestamp(seconds=time_ns // SECOND, nanos=time_ns % SECOND)

    def vector(self, values: Any) -> Any:
        x, y, z = (float(v) for v in values)
        return self.Vector3(x=x, y=y, z=z)

    def point(self, values: Any) -> Any:
        x, y, z = (float(v) for v in values)
        return self.Point3(x=x, y=y, z=z)

    def quaternion(self, wxyz: Any) -> Any:
        w, x, y, z = (float(v) for v in wxyz)
        return self.Quaternion(x=x, y=y, z=z, w=w)

    def pose(self, pose: Any) -> Any:
        """Returns a Pose of poses.Pose."""
        return self.Pose(position=self.vector(pose.position), orientation=self.quaternion(pose.quaternion))


class Output:
    """Writes messages in order of time, and counts them by topic."""

    def __init__(self, fox: Foxglove, path: Any, compression: str):
        self.fox = fox
        kinds = fox.writer.CompressionType
        chosen = {"zstd": kinds.ZSTD, "lz4": kinds.LZ4, "none": kinds.NONE}[compression]
        self._file = open(path, "wb")
        self._writer = fox.writer.Writer(self._file, compression=chosen)
        self._writer.start(profile="", library="greatx")
        self._schemas: Dict[str, int] = {}
        self._channels: Dict[str, Tuple[int, str]] = {}
        self.counts: Dict[str, int] = {}

    def write(self, topic: str, time_ns: int, message: Any) -> None:
        """Writes a protobuf message."""
        kind = type(message).DESCRIPTOR.full_name
        if kind not in self._schemas:
            self._schemas[kind] = self.fox.schema.register_schema(self._writer, type(message))
        self._add(topic, kind, "protobuf", time_ns, message.SerializeToString(deterministic=True))

    def write_json(self, topic: str, time_ns: int, name: str, schema: Dict[str, Any], value: Any) -> None:
        """Writes a JSON message of the schema `name`. NaN and infinities become null."""
        if name not in self._schemas:
            self._schemas[name] = self._writer.register_schema(
                name, "jsonschema", json.dumps(schema).encode()
            )
        self._add(topic, name, "json", time_ns, json.dumps(value, allow_nan=False).encode())

    def _add(self, topic: str, kind: str, encoding: str, time_ns: int, data: bytes) -> None:
        if topic not in self._channels:
            self._channels[topic] = (
                self._writer.register_channel(topic, encoding, self._schemas[kind]),
                kind,
            )
        channel, known = self._channels[topic]
        if known != kind:
            raise ValueError(f"topic {topic}: has messages of {known}, found one of {kind}")
        number = self.counts.get(topic, 0)
        self._writer.add_message(channel, time_ns, data, time_ns, number)
        self.counts[topic] = number + 1

    def metadata(self, name: str, values: Dict[str, str]) -> None:
        self._writer.add_metadata(name, values)

    def attach(self, name: str, media_type: str, data: bytes, time_ns: int) -> None:
        self._writer.add_attachment(time_ns, time_ns, name, media_type, data)

    def finish(self) -> None:
        self._writer.finish()
        self._file.close()

    def close(self) -> None:
        """Closes the file after a failure."""
        try:
            self._file.close()
        except OSError:
            pass  # a full disk has been reported already


def plain(value: Any) -> Any:
    """Returns a number for JSON, or None for NaN and infinities."""
    number = float(value)
    if not np.isfinite(number):
        return None
    return int(number) if isinstance(value, (int, np.integer, np.bool_)) else number


def table(names: List[str], kinds: Dict[str, str], what: str) -> Dict[str, Any]:
    """Returns the JSON schema of {"links": [{name: number or null, ...}]}."""
    properties = {
        n: {"type": kinds[n]} if kinds[n] == "string" else {"type": ["number", "null"]} for n in names
    }
    return {
        "type": "object",
        "title": what,
        "properties": {
            "links": {"type": "array", "items": {"type": "object", "properties": properties}},
        },
    }
