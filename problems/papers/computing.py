"""Computations by name: what the product says of a printed number, formula or claim.

Each is a function of one of the modules beside this one and gets the item's arguments by their names; one that
has a parameter `problems` gets the folder of the problem files.
"""

from __future__ import annotations

import inspect
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from math import isfinite
from pathlib import Path
from typing import Any, Literal

import numpy as np

from optlaws import InputError
from optlaws.results import unknown_key

from .items import Item


@dataclass(frozen=True)
class Number:
    """A number as the product computes it: exact, and where the paper has it from a grid, as seen there.

    Examples
    --------
    >>> Number(5.9195846, on_grid=5.9131398)
    Number(exact=5.9195846, on_grid=5.9131398)
    """

    exact: float
    on_grid: float | None = None


@dataclass(frozen=True)
class Claim:
    """A claim as a number and the bound that it must keep.

    Examples
    --------
    >>> Claim(0.9, "<=", 1.0).holds, Claim(0.9, ">=", 1.0).holds
    (True, False)
    """

    value: float
    sense: Literal["<=", ">="]
    bound: float

    @property
    def holds(self) -> bool:
        """Whether the number keeps the bound."""
        return self.value <= self.bound if self.sense == "<=" else self.value >= self.bound


#: values of a formula's names, as the product computes them for data that are drawn at random
Quantities = Mapping[str, float]
Computation = Callable[..., Any]

PAPERS = ("dwell", "lever", "loader", "optimal", "published", "savin")
COMPUTATIONS: dict[str, Computation] = {}


def computation(name: str) -> Callable[[Computation], Computation]:
    """Register a function under a name that items use: the paper, a point, and what is computed."""

    def register(function: Computation) -> Computation:
        COMPUTATIONS[name] = function
        return function

    return register


@cache
def entries(file: Path) -> Mapping[str, Any]:
    """The entries of a problem file."""
    return tomllib.loads(file.read_text("utf-8"))


def number(item: Item, problems: Path) -> Number:
    """The number that an item prints, computed.

    Raises
    ------
    InputError
        If the computation is not known, does not take the arguments, or gives something else.
    """
    value = _called(item, problems)
    if isinstance(value, Number):
        return value
    if not isinstance(value, (int, float, np.floating)):
        raise InputError(f"{item.id}: {item.compute} computes no number")
    return Number(float(value))


def claim(item: Item, problems: Path) -> Claim:
    """The claim of an item, computed; errors as those of `number`."""
    value = _called(item, problems)
    if not isinstance(value, Claim):
        raise InputError(f"{item.id}: {item.compute} computes no claim")
    return value


def samples(item: Item, problems: Path) -> Sequence[Quantities]:
    """Values of the names in an item's formula, for data drawn at random several times; errors as those of `number`."""
    key = (item.compute, tuple(sorted((name, str(value)) for name, value in item.arguments.items())), problems)
    if key not in _SAMPLES:
        draw = np.random.default_rng(1)
        _SAMPLES[key] = [_quantities(item, problems, draw) for _ in range(_POINTS)]
    return _SAMPLES[key]


_POINTS = 7
_SAMPLES: dict[object, Sequence[Quantities]] = {}


def _quantities(item: Item, problems: Path, draw: np.random.Generator) -> Quantities:
    values = _called(item, problems, draw=draw)
    if not isinstance(values, Mapping) or not all(isfinite(value) for value in values.values()):
        raise InputError(f"{item.id}: {item.compute} computes no finite values by name")
    return values


def _called(item: Item, problems: Path, **given: object) -> object:
    _load(item.compute)
    if item.compute not in COMPUTATIONS:
        raise InputError(f"{item.id}: {unknown_key(item.compute, COMPUTATIONS, 'computation')}")
    function = COMPUTATIONS[item.compute]
    known = inspect.signature(function).parameters
    if "problems" in known:
        given["problems"] = problems
    arguments: dict[str, Any] = {**item.arguments, **given}
    for name in arguments:
        if name not in known:
            raise InputError(f"{item.id}: {item.compute} has no argument {name}; it takes {', '.join(known)}")
    for name, parameter in known.items():
        if parameter.default is inspect.Parameter.empty and name not in arguments:
            raise InputError(f"{item.id}: {item.compute} needs the argument {name}")
    return function(**arguments)


def _load(name: str) -> None:
    """Import the module of the paper that a computation belongs to."""
    paper = name.partition(".")[0]
    if paper in PAPERS:
        import_module(f".{paper}", __package__)
