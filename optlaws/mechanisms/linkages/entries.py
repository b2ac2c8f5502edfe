"""Formulas of a mechanism from what people give: numbers, quantities, texts in x, and tables of places and values."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import pairwise
from typing import Any, Literal

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.formulas.reading import read
from optlaws.formulas.tree import Formula, Name, Table, number
from optlaws.motion.quantities import quantity, si_number
from optlaws.numbers import finite, real

TableKind = Literal["spline", "lines"]
FEWEST = {"spline": 4, "lines": 2}
#: a number with a unit behind it; in formulas a number is followed by a sign
_WITH_UNIT = re.compile(r"\s*[+-]?[\d./]*\d(?:[eE][+-]?\d+)?+\s*[^\W\d_]")


def formula_of(
    given: Any,  # noqa: ANN401 - it is checked here
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
        Of tables: "spline", which is smooth, or straight "lines".

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
        return read(given, (variable,))
    return number(finite(si_number(given, (dimensions[1],), name), name))


def _table(
    pairs: list[Any], dimensions: tuple[str, str], name: str, variable: str, interpolation: TableKind
) -> Formula:
    numbers = table_numbers(pairs, dimensions, name, interpolation)
    for (place, _), (following, _) in pairwise(numbers):
        if place >= following:
            raise InputError(f"{name}: the places of a table must ascend, got {place:g} before {following:g}")
    places, values = zip(*numbers, strict=True)
    return Table(Name(variable), places, values, interpolation == "spline")


def table_numbers(
    pairs: list[Any], dimensions: tuple[str, str], name: str, interpolation: TableKind
) -> list[tuple[float, float]]:
    """Places and values of a table in SI units, whether they ascend or not.

    >>> table_numbers([("0 deg", "1 kN"), ("90 deg", "0 N")], ("angle", "force"), "force", "lines")
    [(0.0, 1000.0), (1.5707963267948966, 0.0)]
    """
    fewest = FEWEST[interpolation]
    if len(pairs) < fewest or any(not isinstance(pair, list | tuple) or len(pair) != 2 for pair in pairs):
        raise InputError(
            f"{name}: a table of {interpolation} needs {fewest} pairs of a place and a value at least, got "
            f"{shortened(pairs)}"
        )
    return [
        (
            _number(place, dimensions[0], f"{name}: place {n}"),
            _number(value, dimensions[1], f"{name}: value {n}"),
        )
        for n, (place, value) in enumerate(pairs, 1)
    ]


def _number(value: Any, dimension: str, name: str) -> float:  # noqa: ANN401
    plain = real(value)
    return quantity(value, dimension, name) if plain is None else finite(plain, name)
