"""Values of formulas, by whatever arithmetic: numpy's arrays, CasADi's symbols, balls."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, reduce
from math import pi
from operator import add, mul
from typing import Any

import numpy as np

from optlaws.formulas.tree import (
    SMOOTH_FUNCTIONS,
    Call,
    Exponentiation,
    Formula,
    Name,
    Negative,
    Number,
    Product,
    Reciprocal,
    Step,
    Sum,
    Table,
    shared_steps,
)
from optlaws.kept import kept_property
from optlaws.numbers import Array

_NORM_OFFSET = 1e-24  # keeps the slope of a norm finite where it vanishes


@dataclass(frozen=True)
class Arithmetic:
    """The operations on numbers of a kind: how they are built, and the functions that take them."""

    number: Callable[[float], Any]  #: from a float
    functions: Mapping[str, Callable[..., Any]]  #: by name: sin, cos, ..., of one number, and max, min, norm of two
    power: Callable[[Any, Any], Any]  #: of a base and an exponent
    table: Callable[[Table, Any], Any] | None = None  #: of a table and where it is evaluated; None where there are none


def evaluate(formula: Formula, names: Mapping[str, Any], arithmetic: Arithmetic) -> Any:
    """The value of a formula.

    Parameters
    ----------
    formula
        What is evaluated.
    names
        What its names stand for, in numbers of the arithmetic.
    arithmetic
        Whose numbers.

    Examples
    --------
    >>> from optlaws.formulas.reading import read
    >>> evaluate(read("c + 0.5*b"), {"b": np.array([2.0, 4.0]), "c": 1.0}, NUMPY)
    array([2., 3.])
    """
    return _computed(formula.steps, names, arithmetic)[-1]


@dataclass(frozen=True, eq=False)
class Together:
    """Formulas that are evaluated together: what several of them have in common is computed once.

    Examples
    --------
    >>> from optlaws.formulas.reading import read
    >>> [float(value) for value in Together((read("b*c"), read("b*c + c"))).values({"b": 2.0, "c": 3.0}, NUMPY)]
    [6.0, 9.0]
    """

    formulas: tuple[Formula, ...]

    @kept_property
    def _steps(self) -> tuple[tuple[Step, ...], tuple[int, ...]]:
        return shared_steps(self.formulas)

    def values(self, names: Mapping[str, Any], arithmetic: Arithmetic) -> list[Any]:
        """The values of all formulas, in their order."""
        steps, places = self._steps
        computed = _computed(steps, names, arithmetic)
        return [computed[place] for place in places]


def _computed(steps: Sequence[Step], names: Mapping[str, Any], arithmetic: Arithmetic) -> list[Any]:
    """The values of steps; None where they are done with."""
    values: list[Any] = []
    for part, places, done in steps:
        values.append(step_value(part, [values[place] for place in places], names, arithmetic))
        for place in done:
            values[place] = None
    return values


def step_value(
    formula: Formula,
    parts: list[Any],
    names: Mapping[str, Any],
    arithmetic: Arithmetic,
) -> Any:
    """The value of a formula from the values of its parts.

    >>> from optlaws.formulas.reading import read
    >>> float(step_value(read("sin(k) + b"), [1.0, 2.0], {}, NUMPY))
    3.0
    """
    return _OPERATIONS[type(formula)](formula, parts, names, arithmetic)


def _name(formula: Any, _: list[Any], names: Mapping[str, Any], arithmetic: Arithmetic) -> Any:
    is_constant = formula.name == "pi" and "pi" not in names
    return arithmetic.number(pi) if is_constant else names[formula.name]


def _lookup(formula: Any, parts: list[Any], _: Mapping[str, Any], arithmetic: Arithmetic) -> Any:
    if arithmetic.table is None:
        raise TypeError("this arithmetic has no tables")
    return arithmetic.table(formula, parts[0])


def _call(formula: Any, parts: list[Any], _: Mapping[str, Any], arithmetic: Arithmetic) -> Any:
    function = arithmetic.functions[formula.function]
    return function(parts[0]) if len(parts) == 1 else reduce(function, parts)


#: the value of a kind of formula from those of its parts
_OPERATIONS: dict[type[Formula], Callable[[Any, list[Any], Mapping[str, Any], Arithmetic], Any]] = {
    Number: lambda formula, _parts, _names, arithmetic: arithmetic.number(formula.value),
    Name: _name,
    Negative: lambda _formula, parts, _names, _arithmetic: -parts[0],
    Sum: lambda _formula, parts, _names, _arithmetic: reduce(add, parts),
    Product: lambda _formula, parts, _names, _arithmetic: reduce(mul, parts),
    Reciprocal: lambda _formula, parts, _names, arithmetic: arithmetic.number(1.0) / parts[0],
    Exponentiation: lambda _formula, parts, _names, arithmetic: arithmetic.power(*parts),
    Table: _lookup,
    Call: _call,
}


def _table(table: Table, at: Any) -> Any:
    coefficients, places = pieces(table), np.array(table.places)
    piece = np.clip(np.searchsorted(places, at, side="right") - 1, 0, len(places) - 2)
    return horner(list(coefficients.T[:, piece]), np.asarray(at) - places[piece])


def pieces(table: Table) -> Array:
    """On each piece of a table powers of (x - start), ascending, of the derivative that it stands for.

    Examples
    --------
    >>> pieces(Table(Name("k"), (0.0, 1.0, 3.0), (1.0, 2.0, 6.0))).tolist()
    [[1.0, 1.0], [2.0, 2.0]]
    """
    lines = np.column_stack([table.values[:-1], np.diff(table.values) / np.diff(table.places)])
    rows = _SMOOTH[table.kind](table.places, table.values) if table.smooth else lines
    for _ in range(table.order):
        rows = rows[:, 1:] * np.arange(1, rows.shape[1]) if rows.shape[1] > 1 else np.zeros((len(rows), 1))
    return rows


def horner(coefficients: Sequence[Any], x: Any) -> Any:
    """The sum of powers of x, ascending.

    Examples
    --------
    >>> horner([1.0, 2.0], 3.0)
    7.0
    """
    total = coefficients[-1]
    for value in coefficients[-2::-1]:
        total = value + total * x
    return total


@lru_cache(maxsize=64)
def spline(places: tuple[float, ...], values: tuple[float, ...]) -> Array:
    """The not-a-knot cubic spline: on each piece its powers of (x - start), ascending, one row a piece.

    Examples
    --------
    >>> spline((0.0, 1.0, 2.0, 3.0), (0.0, 1.0, 8.0, 27.0)).round(12)[1].tolist()
    [1.0, 3.0, 3.0, 1.0]
    """
    x, y = np.array(places), np.array(values)
    h, slopes = np.diff(x), np.diff(y) / np.diff(x)
    count = len(x)
    matrix, right = np.zeros((count, count)), np.zeros(count)
    for i in range(1, count - 1):
        # the slope is continuous at the place; unknown are the second derivatives
        matrix[i, i - 1 : i + 2] = h[i - 1], 2.0 * (h[i - 1] + h[i]), h[i]
        right[i] = 6.0 * (slopes[i] - slopes[i - 1])
    # and so is the third derivative at the places next to the ends
    matrix[0, :3] = h[1], -(h[0] + h[1]), h[0]
    matrix[-1, -3:] = h[-1], -(h[-2] + h[-1]), h[-2]
    bent = np.linalg.solve(matrix, right)
    rows = np.column_stack(
        [y[:-1], slopes - h * (2.0 * bent[:-1] + bent[1:]) / 6.0, bent[:-1] / 2.0, np.diff(bent) / (6.0 * h)]
    )
    rows.setflags(write=False)
    return rows


@lru_cache(maxsize=64)
def monotone(places: tuple[float, ...], values: tuple[float, ...]) -> Array:
    """Cubics that rise and fall as the values do, with a continuous slope: rows as those of `spline`.

    The slope at a place is that of the spline where this keeps the cubics beside it monotone, as smooth data allow;
    otherwise it is that of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5 (1984) 300), and 0 at a place whose
    value is as great or as small as those beside it. No value is beyond those of its two neighbours.

    Examples
    --------
    >>> monotone((0.0, 1.0, 2.0, 3.0), (0.0, 0.0, 3.0, 3.0))[1].tolist()
    [0.0, 0.0, 9.0, -6.0]
    """
    x, y = np.array(places), np.array(values)
    h, secants = np.diff(x), np.diff(y) / np.diff(x)
    beside = np.concatenate([secants[:1], secants, secants[-1:]])
    before, after = beside[:-1], beside[1:]
    slopes = _butland(h, secants)
    if len(x) >= 4:
        rows = spline(places, values)
        last = rows[-1, 1] + h[-1] * (2.0 * rows[-1, 2] + 3.0 * h[-1] * rows[-1, 3])
        smooth = np.append(rows[:, 1], last)
        size = np.minimum(np.abs(before), np.abs(after))
        ways = np.sign([before, after, smooth])
        fits = (ways[0] == ways[1]) & (ways[1] == ways[2]) & (ways[0] != 0.0) & (np.abs(smooth) <= 3.0 * size)
        slopes = np.where(fits, smooth, slopes)
    bend = (slopes[:-1] + slopes[1:] - 2.0 * secants) / h
    rows = np.column_stack([y[:-1], slopes[:-1], (secants - slopes[:-1]) / h - bend, bend / h])
    rows.setflags(write=False)
    return rows


def _butland(h: Array, secants: Array) -> Array:
    """Slopes at the places of which no cubic between two of them leaves the range of its ends."""
    slopes = np.zeros(len(h) + 1)
    first, other = secants[:-1], secants[1:]
    rising = np.sign(first) * np.sign(other) > 0.0
    wide, narrow = 2.0 * h[1:] + h[:-1], h[1:] + 2.0 * h[:-1]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        means = (wide + narrow) / (wide / first + narrow / other)
    slopes[1:-1] = np.where(rising, means, 0.0)
    slopes[0], slopes[-1] = _end_slope(h, secants), _end_slope(h[::-1], secants[::-1])
    return slopes


def _end_slope(h: Array, secants: Array) -> float:
    """The slope of the parabola through the first three places, as far as it keeps the first cubic monotone."""
    if len(h) == 1:
        return float(secants[0])
    slope = float(((2.0 * h[0] + h[1]) * secants[0] - h[0] * secants[1]) / (h[0] + h[1]))
    if np.sign(slope) * np.sign(secants[0]) <= 0.0:
        return 0.0
    return float(np.copysign(min(abs(slope), 3.0 * abs(secants[0])), slope))


_SMOOTH = {"spline": spline, "monotone": monotone}

NUMPY = Arithmetic(
    number=np.float64,
    functions={
        **{name: function.numpy for name, function in SMOOTH_FUNCTIONS.items()},
        "abs": np.abs,
        "max": np.maximum,
        "min": np.minimum,
        "norm": np.hypot,
    },
    power=lambda base, exponent: np.power(np.asarray(base, dtype=np.float64), exponent),
    table=_table,
)


@lru_cache(maxsize=1)
def casadi_arithmetic() -> Arithmetic:
    """The arithmetic of CasADi's symbols."""
    import casadi as ca

    def table(lookup: Table, at: Any) -> Any:
        """The pieces, chosen by their places."""
        rows = [horner(row, at - x) for x, row in zip(lookup.places[:-1], pieces(lookup).tolist(), strict=True)]
        value = rows[0]
        for x, row in zip(lookup.places[1:-1], rows[1:], strict=True):
            value = ca.if_else(at >= x, row, value)
        return value

    functions = {name: getattr(ca, name) for name in SMOOTH_FUNCTIONS}
    several = {
        "abs": ca.fabs,
        "max": ca.fmax,
        "min": ca.fmin,
        "norm": lambda x, y: ca.sqrt(x * x + y * y + _NORM_OFFSET),
    }
    return Arithmetic(float, functions | several, lambda base, exponent: base**exponent, table)
