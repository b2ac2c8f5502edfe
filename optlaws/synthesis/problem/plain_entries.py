"""Entries of many problems, arrays and objects in them, as plain data that are read back as they were."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import bounded
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.spaces.bases import Basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

#: kinds of numpy's arrays of numbers
_NUMBERS = "fiub"


def plain_entries(entries: Mapping[str, Any]) -> dict[str, Any] | None:
    """Entries as plain data; None where one is of a kind that cannot be read back.

    >>> plain_entries({"B": np.array([1.5, 1.6]), "order": 4})
    {'B': {'array': [1.5, 1.6], 'shape': [2], 'type': 'float64'}, 'order': 4}
    """
    try:
        return {name: _plain(value) for name, value in entries.items()}
    except TypeError:
        return None


def read_entries(data: Mapping[str, Any]) -> dict[str, Any]:
    """The entries that `plain_entries` wrote."""
    return {name: _read(value) for name, value in data.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return _plain_array(value)
    if isinstance(value, Range):
        return [value.low, bounded(value.high)]
    if isinstance(value, Basis):
        return {"basis": dict(value.to_dict())}
    if isinstance(value, Mapping):
        return {"named": {_name(key): _plain(part) for key, part in value.items()}}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if value is None or type(value) in {bool, int, float, str}:
        return value
    raise TypeError(type(value).__name__)


def _plain_array(values: NDArray[Any]) -> dict[str, Any]:
    shape = list(values.shape)
    if values.dtype == object:
        return {"objects": [_plain_object(value) for value in values.reshape(-1).tolist()], "shape": shape}
    if values.dtype.kind not in _NUMBERS:
        raise TypeError(str(values.dtype))
    flat = [value if np.isfinite(value) else str(value) for value in values.reshape(-1).tolist()]
    return {"array": flat, "shape": shape, "type": str(values.dtype)}


def _plain_object(value: Any) -> Any:
    """An object at one place of an array, each read back as it was written."""
    if isinstance(value, Range):
        return {"range": [value.low, bounded(value.high)]}
    if isinstance(value, Window):
        return {"window": value.to_dict()}
    if isinstance(value, BoundaryConditions):
        return {"start": list(map(float, value.start)), "end": list(map(float, value.end))}
    if isinstance(value, float) and not isfinite(value):
        return {"number": str(value)}
    return _plain(value)


def _read_object(value: Any) -> Any:
    if not isinstance(value, dict):
        return _read(value)
    if "range" in value:
        low, high = value["range"]
        return Range(low, inf if high is None else high)
    if "window" in value:
        return Window.from_dict(value["window"])
    if "start" in value:
        return BoundaryConditions(value["start"], value["end"])
    return float(value["number"]) if "number" in value else _read(value)


def _name(key: object) -> str:
    if not isinstance(key, str):
        raise TypeError(type(key).__name__)
    return key


def _read(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(map(_read, value))
    if not isinstance(value, dict):
        return value
    if "array" in value:
        kind = np.dtype(str(value["type"]))
        if kind.kind not in _NUMBERS:
            raise InputError(f"an array of entries is one of numbers, got {shortened(value['type'])}")
        numbers = [float(number) if isinstance(number, str) else number for number in value["array"]]
        return np.array(numbers, dtype=kind).reshape(value["shape"])
    if "objects" in value:
        objects = np.empty(len(value["objects"]), dtype=object)
        for i, stored in enumerate(value["objects"]):
            objects[i] = _read_object(stored)
        return objects.reshape(value["shape"])
    if "basis" in value:
        return Basis.from_dict(value["basis"])
    return {name: _read(part) for name, part in value["named"].items()}
