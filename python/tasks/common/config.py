# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a task's configuration: YAML files, one over the other, and changes on the command line.

A configuration is a dataclass. Its fields are numbers, texts, truth values, lists of these, or dataclasses.
Every field must have a value in one of the files, and the files have no other fields. An error names the
file, the line and the field.
"""
from __future__ import annotations

import dataclasses
import pathlib
import typing
from typing import Any, Dict, List, Optional, Sequence, Tuple, Type, TypeVar, Union

import yaml

from greatx.errors import Error, nearest

T = TypeVar("T")


class ConfigError(Error):
    """Reports a fault of a configuration: FILE:LINE: FIELD: what was expected, and what was found."""


@dataclasses.dataclass
class _Value:
    """A value of YAML and the place where it stands. The value is a text, a list or a dict of _Value, or a
    scalar."""

    value: Any
    where: str


def load_config(cls: Type[T], folder: pathlib.Path, preset: Optional[str], sets: Sequence[str] = ()) -> T:
    """Returns the configuration of FOLDER/config.yaml, changed by FOLDER/PRESET.yaml if a preset is named,
    and then by each of `sets`, "FIELD.FIELD=VALUE" with a value in YAML. Raises ConfigError.
    """
    merged = _read(folder / "config.yaml")
    if preset is not None:
        merged = _over(merged, _read(folder / f"{preset}.yaml"))
    for text in sets:
        merged = _over(merged, _assignment(text))
    return _build(cls, merged, "")


def to_dict(config: Any) -> Dict[str, Any]:
    """Returns a configuration as plain dicts, lists and scalars."""
    return dataclasses.asdict(config)


def _read(path: pathlib.Path) -> _Value:
    try:
        node = yaml.compose(path.read_text(), yaml.SafeLoader)
    except OSError as error:
        raise ConfigError(f"{path}: {error.strerror}: expected a configuration") from None
    except yaml.YAMLError as error:
        raise ConfigError(f"{path}: is no YAML: {error}") from None
    if node is None:
        return _Value({}, f"{path}:1")
    return _values(node, str(path))


def _values(node: yaml.Node, path: str) -> _Value:
    where = f"{path}:{node.start_mark.line + 1}"
    if isinstance(node, yaml.MappingNode):
        fields: Dict[str, _Value] = {}
        for key, value in node.value:
            if key.value in fields:
                line = f"{path}:{key.start_mark.line + 1}"
                raise ConfigError(f"{line}: {key.value}: expected one value, found a second")
            fields[key.value] = _values(value, path)
        return _Value(fields, where)
    if isinstance(node, yaml.SequenceNode):
        return _Value([_values(value, path) for value in node.value], where)
    return _Value(yaml.SafeLoader("").construct_object(node), where)


def _assignment(text: str) -> _Value:
    where = f"--set {text}"
    name, equals, value = text.partition("=")
    if not equals or not all(name.split(".")):
        raise ConfigError(f"{where}: expected FIELD=VALUE or FIELD.FIELD=VALUE")
    try:
        node = yaml.compose(value, yaml.SafeLoader)
    except yaml.YAMLError:
        raise ConfigError(f"{where}: expected a value in YAML") from None
    out = _Value(None, where) if node is None else _values(node, where)
    out = _located(out, where)
    for part in reversed(name.split(".")):
        out = _Value({part: out}, where)
    return out


def _located(value: _Value, where: str) -> _Value:
    """Returns the value with one place for all of its parts, because the command line has no lines."""
    if isinstance(value.value, dict):
        return _Value({k: _located(v, where) for k, v in value.value.items()}, where)
    if isinstance(value.value, list):
        return _Value([_located(v, where) for v in value.value], where)
    return _Value(value.value, where)


def _over(below: _Value, above: _Value) -> _Value:
    """Returns `below` with the fields of `above` in place of its own. Lists are replaced as a whole."""
    if not isinstance(below.value, dict) or not isinstance(above.value, dict):
        return above
    fields = dict(below.value)
    for name, value in above.value.items():
        fields[name] = _over(fields[name], value) if name in fields else value
    return _Value(fields, below.where)


def _build(kind: Any, given: _Value, name: str) -> Any:
    if dataclasses.is_dataclass(kind):
        return _build_fields(kind, given, name)
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    if origin is Union and type(None) in inner:
        rest = [k for k in inner if k is not type(None)]
        return None if given.value is None else _build(rest[0], given, name)
    if origin in (list, tuple):
        if not isinstance(given.value, list):
            raise _wrong(given, name, "a list")
        if origin is tuple and inner[1:] != (Ellipsis,) and len(inner) != len(given.value):
            raise _wrong(given, name, f"{len(inner)} values")
        kinds = list(inner) if origin is tuple and inner[1:] != (Ellipsis,) else [inner[0]] * len(given.value)
        return origin(_build(k, v, f"{name}[{i}]") for i, (k, v) in enumerate(zip(kinds, given.value)))
    if origin is dict:
        if not isinstance(given.value, dict):
            raise _wrong(given, name, "a map")
        return {key: _build(inner[1], value, f"{name}.{key}") for key, value in given.value.items()}
    return _scalar(kind, given, name)


def _build_fields(kind: Any, given: _Value, name: str) -> Any:
    if not isinstance(given.value, dict):
        raise _wrong(given, name, "a map of fields")
    kinds = typing.get_type_hints(kind)
    names = [field.name for field in dataclasses.fields(kind)]
    prefix = name + "." if name else ""
    for field, value in given.value.items():
        if field not in names:
            known = nearest(field, names) or f": expected one of {', '.join(names)}"
            raise ConfigError(f"{value.where}: {prefix}{field}: is not known{known}")
    lacking = [field for field in names if field not in given.value]
    if lacking:
        raise ConfigError(f"{given.where}: {prefix}{lacking[0]}: expected a value, found none")
    try:
        return kind(**{f: _build(kinds[f], given.value[f], prefix + f) for f in names})
    except ConfigError:
        raise
    except ValueError as error:  # of the dataclass's own checks
        raise ConfigError(f"{given.where}: {prefix}{error}") from None


#: The texts of expected scalars.
_EXPECTED = {int: "a whole number", float: "a number", bool: "true or false", str: "a text"}


def _scalar(kind: Any, given: _Value, name: str) -> Any:
    value = given.value
    if kind is float and isinstance(value, str):
        try:
            value = float(value)  # YAML 1.1 takes 1e-3 for a text
        except ValueError:
            pass
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        value = float(value)
    if kind not in _EXPECTED:
        raise TypeError(f"{name}: a configuration cannot have fields of type {kind}")
    if type(value) is not kind:
        raise _wrong(given, name, _EXPECTED[kind])
    return value


def _wrong(given: _Value, name: str, expected: str) -> ConfigError:
    value = given.value
    found = "a list" if isinstance(value, list) else "a map" if isinstance(value, dict) else repr(value)
    return ConfigError(f"{given.where}: {name or 'file'}: expected {expected}, found {found}")


def positive(**values: float) -> None:
    """For the checks of a dataclass: raises ValueError for a value that is not greater than zero."""
    for name, value in values.items():
        if not value > 0:
            raise ValueError(f"{name}: expected more than 0, found {value}")


def shares(values: Dict[str, float]) -> None:
    """For the checks of a dataclass with a field `shares`: raises ValueError unless it has train, validation
    and test, whose shares are positive and sum to 1."""
    if sorted(values) != ["test", "train", "validation"]:
        raise ValueError(f"shares: expected train, validation and test, found {list(values)}")
    if min(values.values()) <= 0 or abs(sum(values.values()) - 1) > 1e-9:
        raise ValueError(f"shares: expected positive shares that sum to 1, found {values}")


def changed(now: Any, then: Any, name: str = "") -> Optional[Tuple[str, Any, Any]]:
    """Returns the first field in which two results of to_dict differ, and both values; None if they agree."""
    if isinstance(now, dict) and isinstance(then, dict):
        keys: List[str] = sorted({*now, *then})
        for key in keys:
            found = changed(now.get(key), then.get(key), f"{name}.{key}" if name else key)
            if found is not None:
                return found
        return None
    return None if now == then else (name, now, then)
