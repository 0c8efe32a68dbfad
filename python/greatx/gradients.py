# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Computes channels at other values of their parameters, and exact derivatives by them (docs/gradients.md).

The engine differentiates; this module checks names and shapes, and connects the engine with PyTorch, which it
imports only if a value is a tensor."""

from __future__ import annotations

import functools
import json
import sys
import warnings
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .errors import Error, nearest
from .tables import Arrays

#: What jacobian() differentiates: quantities of the response, of paths and of links.
QUANTITIES = ("cfr", "power", "delay", "path_gain", "mean_delay", "delay_spread")

#: Subcarrier spacing, subcarriers, time samples, time spacing, selection.
Request = Tuple[Optional[float], Optional[int], Optional[int], Optional[float], str]


class Jacobian(NamedTuple):
    """Holds derivatives with their columns."""

    values: np.ndarray  #: [..., column]
    columns: List[str]  #: name of the parameter of each column, with ".x" for a component
    units: List[str]  #: unit of the parameter of each column


class Changes(NamedTuple):
    """Counts paths that were born or died between two sets, int64 [rx, tx]."""

    born: np.ndarray
    died: np.ndarray
    kept: np.ndarray


def is_complex(name: str) -> bool:
    return name.endswith(".gain")


def parameters_of(native: Any) -> Arrays:
    """Returns the present values of all parameters; those of gains are complex."""
    return Arrays(
        (name, unit, text, values.view(np.complex128)[..., 0] if is_complex(name) else values)
        for name, unit, text, values in native.parameters()
    )


def is_tensor(value: Any) -> bool:
    torch = sys.modules.get("torch")
    return torch is not None and isinstance(value, torch.Tensor)


def _callers_level() -> int:
    """Returns the stack level of the first frame outside this package and torch, for warnings.warn() of the
    caller."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").split(".")[0] in ("greatx", "torch"):
        level, frame = level + 1, frame.f_back
    return level


class Variation:
    """Holds the paths of a Paths at other values of its parameters. The set of paths stays the same: each
    sequence of interactions is solved again, exactly.

    facts       `paths`, their number, and how many of them are not paths of the scene at these values:
                `beyond` (a point lies beyond its facet or edge; the field goes on smoothly), `blocked` (a
                surface stands in the way, or other walls), `lost` (no such path; it is left out)
    """

    def __init__(self, native: Any, values: Mapping[str, np.ndarray], channel: str):
        self._native = native
        self._varied = native.vary([(name, _doubles(value)) for name, value in values.items()])
        self.facts: Dict[str, int] = json.loads(self._varied.facts())
        gone = {what: self.facts[what] for what in ("beyond", "blocked", "lost") if self.facts[what]}
        if gone:
            warnings.warn(
                f"{channel}: of {self.facts['paths']} paths, "
                + ", ".join(f"{count} are {what}" for what, count in gone.items())
                + " at these values of the parameters: Simulation.paths() there finds those that exist",
                stacklevel=_callers_level(),
            )

    def response(self, request: Request) -> np.ndarray:
        """Returns H, complex128 [rx, rx_ant, tx, tx_ant, time, subcarrier]."""
        return self._varied.response(request).view(np.complex128)[..., 0]

    def quantities(self) -> Arrays:
        """Returns `power` and `delay` [path], and `path_gain`, `mean_delay` and `delay_spread` [rx, tx]: the
        quantities that Paths.jacobian() differentiates."""
        return Arrays(self._varied.quantities())

    def gradient(self, request: Request, names: Sequence[str], cotangent: np.ndarray) -> List[np.ndarray]:
        """Returns the gradient of a real loss L by each parameter, in its shape. `cotangent` is dL/d Re H + j
        dL/d Im H in the shape of the response."""
        named = self._varied.gradient(request, list(names), _doubles(np.asarray(cotangent, np.complex128)))
        return [a.view(np.complex128)[..., 0] if is_complex(name) else a for name, _, _, a in named]

    def jacobian(self, request: Request, names: Sequence[str], of: str) -> Jacobian:
        if of not in QUANTITIES:
            raise Error(f"of: expected one of {', '.join(QUANTITIES)}, found {of!r}{nearest(of, QUANTITIES)}")
        names = [names] if isinstance(names, str) else list(names)
        columns = self._native.columns(names)
        if of == "cfr":
            values = self._varied.jacobian(request, names).view(np.complex128)[..., 0]
        else:
            values = Arrays(self._varied.quantity_slopes(names))[of]
        return Jacobian(values, [name for name, _ in columns], [unit for _, unit in columns])


def _doubles(values: np.ndarray) -> np.ndarray:
    """Returns contiguous float64; complex values get a last axis of (re, im)."""
    if np.iscomplexobj(values):
        values = np.asarray(values, np.complex128)
        return np.stack([values.real, values.imag], axis=-1)
    return np.ascontiguousarray(values, np.float64)


def _as_numbers(name: str, value: Any, shape: Tuple[int, ...]) -> np.ndarray:
    """Checks a value that is no tensor, and broadcasts it to the parameter's shape."""
    try:
        numbers = np.asarray(value, np.complex128 if is_complex(name) else np.float64)
        return np.broadcast_to(numbers, shape)
    except (TypeError, ValueError):
        found = list(np.shape(value)) if not isinstance(value, str) else repr(value)
        raise Error(f"{name}: expected numbers that broadcast to {list(shape)}, found {found}") from None


def _shapes(native: Any, parameters: Mapping[str, Any]) -> Dict[str, Tuple[int, ...]]:
    known = parameters_of(native)
    for name in parameters:
        if name not in known:
            raise Error(
                f"parameters: expected a parameter of the paths, found {name!r}{nearest(name, known)}"
            )
    return {name: known[name].shape for name in parameters}


def vary(native: Any, channel: str, parameters: Optional[Mapping[str, Any]]) -> Variation:
    """Returns the paths of the engine's set `native` at these values."""
    parameters = parameters or {}
    shapes = _shapes(native, parameters)
    values = {
        name: _as_numbers(name, value.detach().cpu().numpy() if is_tensor(value) else value, shapes[name])
        for name, value in parameters.items()
    }
    return Variation(native, values, channel)


def response(native: Any, channel: str, request: Request, parameters: Mapping[str, Any]) -> Any:
    """Returns H at these values: a torch tensor if a value is one, else complex128."""
    if not any(is_tensor(value) for value in parameters.values()):
        return vary(native, channel, parameters).response(request)
    return _torch_response(native, channel, request, parameters)


def _torch_response(native: Any, channel: str, request: Request, parameters: Mapping[str, Any]) -> Any:
    import torch

    shapes = _shapes(native, parameters)
    constants: Dict[str, np.ndarray] = {}
    tensors = {}
    for name, value in parameters.items():
        if not is_tensor(value):
            constants[name] = _as_numbers(name, value, shapes[name])
            continue
        if value.is_complex() and not is_complex(name):
            raise Error(f"{name}: expected a real tensor, found {value.dtype}")
        try:
            # Gradients of a value that stands for several ends are added up by broadcasting.
            tensors[name] = torch.broadcast_to(value, shapes[name])
        except RuntimeError:
            raise Error(
                f"{name}: expected a tensor that broadcasts to {list(shapes[name])}, "
                f"found {list(value.shape)}"
            ) from None
    single = all(t.dtype in (torch.float32, torch.complex64) for t in tensors.values())
    dtype = torch.complex64 if single else torch.complex128
    call = (native, channel, request, constants, list(tensors), dtype)
    return _response_function().apply(call, *tensors.values())


@functools.lru_cache(maxsize=None)
def _response_function() -> Any:
    """Returns the torch.autograd.Function. It is made when a tensor comes, because torch is optional."""
    import torch

    class Response(torch.autograd.Function):
        @staticmethod
        def forward(ctx: Any, call: Any, *tensors: Any) -> Any:
            native, channel, request, constants, names, dtype = call
            values = {name: t.detach().resolve_conj().cpu().numpy() for name, t in zip(names, tensors)}
            ctx.variation = Variation(native, {**constants, **values}, channel)
            ctx.call = call
            ctx.kinds = [(t.dtype, t.device) for t in tensors]
            return torch.from_numpy(np.ascontiguousarray(ctx.variation.response(request))).to(dtype)

        @staticmethod
        @torch.autograd.function.once_differentiable
        def backward(ctx: Any, gradient: Any) -> Any:
            _, _, request, _, names, _ = ctx.call
            wanted = [i for i in range(len(names)) if ctx.needs_input_grad[1 + i]]
            cotangent = gradient.detach().resolve_conj().cpu().numpy()
            found = ctx.variation.gradient(request, [names[i] for i in wanted], cotangent)
            out: List[Any] = [None] * (1 + len(names))
            for i, values in zip(wanted, found):
                dtype, device = ctx.kinds[i]
                out[1 + i] = torch.from_numpy(np.ascontiguousarray(values)).to(dtype=dtype, device=device)
            return tuple(out)

    return Response
