"""Formulas of a mechanism from what people give: numbers, quantities, texts in x, and tables of places and values."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from numbers import Real
from typing import Any, Literal

import numpy as np

from optlaws.echo import shortened
from optlaws.entries.value_types import ReadBy, ValueType
from optlaws.errors import InputError
from optlaws.formulas.arithmetic import horner, pieces
from optlaws.formulas.reading import read
from optlaws.formulas.tree import Formula, Name, Table, TableJoin, number
from optlaws.motion.quantities import quantity, si_number, written
from optlaws.numbers import finite, real
from optlaws.tolerances import VALUE_ROUNDING

TableKind = Literal["spline", "lines"]
#: how tables of values are joined: a spline of values keeps their shape
JOINED: dict[str, TableJoin] = {"spline": "monotone", "lines": "table"}
_FEWEST = 2
#: a number with a unit behind it; in formulas a number is followed by a sign
_WITH_UNIT = re.compile(r"\s*[+-]?[\d./]*\d(?:[eE][+-]?\d+)?+\s*[^\W\d_]")


@dataclass(frozen=True)
class OverPlace(ValueType):
    """What `formula_of` reads, kept as it is given: its dimension is that of what it acts on.

    >>> OverPlace("x").read(True, "load")
    Traceback (most recent call last):
    optlaws.errors.InputError: load must be a number, a quantity, a formula of x, or a table of places and values, ...
    """

    of: str  #: the variables of formulas, in words

    def read(self, value: Any, name: str) -> Any:
        if isinstance(value, Formula | str | Mapping | list | tuple) or hasattr(value, "units"):
            return written(value)
        if isinstance(value, bool) or not isinstance(value, Real):
            raise InputError(f"{name} must be {self.words}, got {shortened(value)}")
        return finite(value, name)

    def plain(self, value: Any) -> Any:
        return str(value) if isinstance(value, Formula) else value

    @property
    def words(self) -> str:
        return f"a number, a quantity, a formula of {self.of}, or a table of places and values"

    def schema(self) -> dict[str, Any]:
        return {"type": ["number", "string", "array", "object"]}


#: a formula of x, as a text
FORMULA = ReadBy(lambda value: value if isinstance(value, Formula) else read(value, ("x",)), "a formula of x", str)


def formula_of(
    given: Any,
    dimensions: tuple[str, str],
    name: str,
    *,
    variable: str = "x",
    interpolation: TableKind = "spline",
) -> Formula:
    """The formula of a number, a quantity, a text, a formula or a table; errors call it `name`.

    Parameters
    ----------
    given
        A number in SI units, a quantity such as "0.02 kg m^2", a text such as "0.02 + 0.01*sin(x)^2" in SI units, a
        formula, or a table: pairs of a place and a value, or a mapping of places to values.
    dimensions
        Of the variable and of the value.
    name
        What an error calls it.
    variable
        The name of the variable in texts.
    interpolation
        Of tables: "spline", a smooth curve that rises and falls as the values do and is nowhere beyond its two
        neighbours, or straight "lines".

    Raises
    ------
    InputError
        If it is none of these.

    Examples
    --------
    >>> formula_of("0.02 kg m^2", ("angle", "moment of inertia"), "inertia")
    0.02
    >>> formula_of({"0 deg": "0 N m", "180 deg": "3 N m"}, ("angle", "torque"), "load", interpolation="lines")
    table(x, 0:0, 3.141592653589793:3)
    """
    if isinstance(given, Formula):
        return given
    if isinstance(given, Mapping):
        return _table(list(given.items()), dimensions, name, variable, interpolation)
    if isinstance(given, list | tuple):
        return _table(list(given), dimensions, name, variable, interpolation)
    if isinstance(given, str) and _WITH_UNIT.match(given) is None:
        formula = read(given, (variable,))
        for part in formula.walk():
            if isinstance(part, Table) and part.kind == "spline":
                _check_shape(part, name)
        return formula
    return number(finite(si_number(given, (dimensions[1],), name), name))


def _table(
    pairs: list[Any], dimensions: tuple[str, str], name: str, variable: str, interpolation: TableKind
) -> Formula:
    numbers = table_numbers(pairs, dimensions, name)
    for (place, _), (following, _) in pairwise(numbers):
        if place >= following:
            raise InputError(f"{name}: the places of a table must ascend, got {place:g} before {following:g}")
    places, values = zip(*numbers, strict=True)
    return Table(Name(variable), places, values, JOINED[interpolation])


def _check_shape(table: Table, name: str) -> None:
    """Refuse a cubic spline that leaves the range of two neighbours: there it would be what nobody measured."""
    rows, rounding = pieces(replace(table, order=0)), VALUE_ROUNDING * max(map(abs, table.values))
    for i, (start, slope, bend, twist) in enumerate(rows.tolist()):
        length = table.places[i + 1] - table.places[i]
        turns = [
            at.real for at in np.roots([3.0 * twist, 2.0 * bend, slope]) if at.imag == 0.0 and 0.0 < at.real < length
        ]
        low, high = sorted((table.values[i], table.values[i + 1]))
        reached = (horner((start, slope, bend, twist), at) for at in turns)
        beyond = max((max(low - at, at - high) for at in reached), default=0.0)
        if beyond > rounding:
            raise InputError(
                f"{name}: between {table.places[i]:g} and {table.places[i + 1]:g} the spline is {beyond:.3g} beyond "
                "the values beside it: monotone(...) in its place never is, nor is a table of places and values"
            )


def table_numbers(pairs: list[Any], dimensions: tuple[str, str], name: str) -> list[tuple[float, float]]:
    """Places and values of a table in SI units, whether they ascend or not.

    >>> table_numbers([("0 deg", "1 kN"), ("90 deg", "0 N")], ("angle", "force"), "force")
    [(0.0, 1000.0), (1.5707963267948966, 0.0)]
    """
    if len(pairs) < _FEWEST or any(not isinstance(pair, list | tuple) or len(pair) != 2 for pair in pairs):
        raise InputError(
            f"{name}: a table needs {_FEWEST} pairs of a place and a value at least, got {shortened(pairs)}"
        )
    return [
        (
            _number(place, dimensions[0], f"{name}: place {n}"),
            _number(value, dimensions[1], f"{name}: value {n}"),
        )
        for n, (place, value) in enumerate(pairs, 1)
    ]


def _number(value: Any, dimension: str, name: str) -> float:
    plain = real(value)
    return quantity(value, dimension, name) if plain is None else finite(plain, name)
