"""Formulas in balls, and in polynomials with rational coefficients."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from itertools import pairwise
from typing import Any

from flint import arb, arb_series, fmpq, fmpq_poly

from optlaws.formulas.arithmetic import Arithmetic, horner, pieces
from optlaws.formulas.tree import Table
from optlaws.verification.enclosing.balls import ball, rational

_NAMES = ("sin", "cos", "tan", "exp", "log", "sqrt", "atan")


def _method(name: str) -> Any:  # noqa: ANN401 - a function of whatever has the method
    return lambda x: getattr(x, name)()


def _tanh(x: Any) -> Any:  # noqa: ANN401 - a ball or a series
    grown = (x + x).exp()
    return (grown - 1) / (grown + 1)


def _power(base: Any, exponent: Any) -> Any:  # noqa: ANN401 - balls or series
    """A whole exponent is one of repeated multiplication, so that the base may be negative."""
    plain = exponent[0] if isinstance(exponent, arb_series) else exponent
    if plain.is_integer():
        whole = int(str(plain.unique_fmpz()))
        found = reduce(lambda one, _: one * base, range(abs(whole)), base * 0 + 1)
        return found if whole >= 0 else 1 / found
    return (base.log() * exponent).exp()


def _norm(x: Any, y: Any) -> Any:  # noqa: ANN401 - balls or series
    return (x * x + y * y).sqrt()


def _exactly(value: float) -> arb:
    return ball(float(value))


def _on_pieces(table: Table, at: arb) -> arb:
    """The values of all pieces that the ball may be on."""
    places = [ball(place) for place in table.places]
    found = []
    for i, row in enumerate(exact_pieces(table)):
        if (i and at < places[i]) or (i + 2 < len(places) and at > places[i + 1]):
            continue
        found.append(horner([arb(value) for value in row], at - places[i]))
    whole: arb = reduce(lambda one, other: one.union(other), found)
    return whole


def exact_pieces(table: Table) -> list[list[fmpq]]:
    """On each piece of a table powers of (x - start); straight lines exactly, a spline as its rounded coefficients say.

    Examples
    --------
    >>> from optlaws.formulas.tree import Name
    >>> exact_pieces(Table(Name("k"), (0.0, 0.5, 1.0), (0.0, 1.0, 0.0)))
    [[0, 2], [1, -2]]
    """
    if table.smooth:
        rows = [[rational(float(value)) for value in row] for row in pieces(replace(table, order=0))]
        return [_differentiated(row, table.order) for row in rows]
    points = [(rational(x), rational(y)) for x, y in zip(table.places, table.values, strict=True)]
    return [_differentiated([y, (z - y) / (w - x)], table.order) for (x, y), (w, z) in pairwise(points)]


def _differentiated(row: list[fmpq], order: int) -> list[fmpq]:
    for _ in range(order):
        row = [i * value for i, value in enumerate(row)][1:] or [fmpq(0)]
    return row


BALLS = Arithmetic(
    number=_exactly,
    functions={
        **{name: _method(name) for name in _NAMES},
        "tanh": _tanh,
        "abs": abs,
        "max": lambda x, y: x.max(y),
        "min": lambda x, y: x.min(y),
        "norm": _norm,
    },
    power=_power,
    table=_on_pieces,
)


def _polynomial_power(base: fmpq_poly, exponent: fmpq_poly) -> fmpq_poly:
    return base ** int(exponent(fmpq(0)).p)


def _polynomial_table(table: Table, at: fmpq_poly) -> fmpq_poly:
    """The piece that the place of 0 is on: no other is met between -1 and 1."""
    here = at(fmpq(0))
    piece = max((i for i, x in enumerate(table.places[:-1]) if rational(x) <= here), default=0)
    s = at - rational(table.places[piece])
    found: fmpq_poly = horner([fmpq_poly([value]) for value in exact_pieces(table)[piece]], s)
    return found


#: of a variable that runs from -1 to 1 where no table changes its piece
POLYNOMIALS = Arithmetic(
    number=lambda value: fmpq_poly([rational(float(value))]),
    functions={},
    power=_polynomial_power,
    table=_polynomial_table,
)
