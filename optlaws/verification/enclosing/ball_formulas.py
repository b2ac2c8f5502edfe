"""Formulas in balls, and in polynomials with rational coefficients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import reduce
from itertools import pairwise
from operator import methodcaller
from typing import Any

from flint import arb, arb_poly, arb_series, ctx, fmpq, fmpq_poly

from optlaws.formulas.arithmetic import Arithmetic, evaluate, horner, pieces
from optlaws.formulas.tree import Formula, Table
from optlaws.verification.enclosing.balls import ball, rational


def _tanh(x: Any) -> Any:
    grown = (x + x).exp()
    return (grown - 1) / (grown + 1)


def _power(base: Any, exponent: Any) -> Any:
    """The power of a ball; a whole exponent means repeated multiplication, so that the base may be negative."""
    plain = _plain(exponent)
    if plain.is_integer():
        whole = int(str(plain.unique_fmpz()))
        power = reduce(lambda product, _: product * base, range(abs(whole)), base * 0 + 1)
        return power if whole >= 0 else 1 / power
    if plain > 0 and _may_vanish(_plain(base)):
        most = _plain(base).upper()
        return _kinked(base, [arb(0).union((most.log() * plain).exp()) if most > 0 else arb(0)])
    return (base.log() * exponent).exp()


def _sqrt(x: Any) -> Any:
    """The square root; where its argument may be 0 and is not below, a value without a slope."""
    if _may_vanish(_plain(x)):
        return _kinked(x, [arb(0).union(_plain(x).upper().sqrt())])
    return x.sqrt()


def _abs(x: Any) -> Any:
    plain = _plain(x)
    if plain >= 0 or plain <= 0:
        return x if plain >= 0 else -x
    return _kinked(x, [abs(plain), *[term.union(-term) for term in _coefficients(x)[1:2]]])


def _max(x: Any, y: Any) -> Any:
    first, other = _plain(x), _plain(y)
    if first >= other or first <= other:
        # one of them is a number perhaps, where the other is a series
        return x + y * 0 if first >= other else y + x * 0
    slopes = [p.union(q) for p, q in zip(_coefficients(x + y * 0)[1:2], _coefficients(y + x * 0)[1:2], strict=True)]
    return _kinked(x + y, [first.max(other), *slopes])


def _may_vanish(x: arb) -> bool:
    return not x > 0 and not x < 0


def _plain(x: Any) -> arb:
    """The value of a series, without its higher terms."""
    return x[0] if isinstance(x, arb_series) else x


def _coefficients(x: Any) -> list[arb]:
    return [x[i] for i in range(ctx.cap)] if isinstance(x, arb_series) else [x]


def _kinked(like: Any, known: list[arb]) -> Any:
    """A value with the slopes that are known; a series has no others."""
    if not isinstance(like, arb_series):
        return known[0]
    return arb_series([*known, *[arb.nan()] * (ctx.cap - len(known))])


def _on_pieces(table: Table, at: Any) -> Any:
    """The values of all pieces that the ball may be on, and of a series those slopes that they bound together."""
    places, plain = [ball(place) for place in table.places], _plain(at)
    values = []
    for i, row in enumerate(exact_pieces(table)):
        if (i and plain < places[i]) or (i + 2 < len(places) and plain > places[i + 1]):
            continue
        values.append(horner([arb(value) for value in row], at - places[i]) + 0 * at)
    if len(values) == 1:
        return values[0]
    # a slope that jumps is between those on both sides, one that is an impulse has no bounds
    smooth = max((3 if table.smooth else 1) - table.order, 0) + 1
    united = (reduce(arb.union, several) for several in zip(*map(_coefficients, values), strict=True))
    return _kinked(at, list(united)[:smooth])


def exact_pieces(table: Table) -> list[list[fmpq]]:
    """On each piece of a table powers of (x - start); exact for straight lines, rounded coefficients for a spline.

    >>> from optlaws.formulas.tree import Name
    >>> exact_pieces(Table(Name("k"), (0.0, 0.5, 1.0), (0.0, 1.0, 0.0)))
    [[0, 2], [1, -2]]
    """
    if table.smooth:
        rows = [[rational(float(value)) for value in row] for row in pieces(replace(table, order=0))]
        return [_differentiated(row, table.order) for row in rows]
    points = [(rational(x), rational(y)) for x, y in zip(table.places, table.values, strict=True)]
    return [_differentiated([y, (z - y) / (w - x)], table.order) for (x, y), (w, z) in pairwise(points)]


def _differentiated(row: list[fmpq], nu: int) -> list[fmpq]:
    for _ in range(nu):
        row = [i * value for i, value in enumerate(row)][1:] or [fmpq(0)]
    return row


BALLS = Arithmetic(
    number=lambda value: ball(float(value)),
    functions={
        **{name: methodcaller(name) for name in ("sin", "cos", "tan", "exp", "log", "atan")},
        "tanh": _tanh,
        "sqrt": _sqrt,
        "abs": _abs,
        "max": _max,
        "min": lambda x, y: -_max(-x, -y),
        "norm": lambda x, y: _sqrt(x * x + y * y),
    },
    power=_power,
    table=_on_pieces,
)


def _polynomial_table(table: Table, at: fmpq_poly) -> fmpq_poly:
    """The piece that the place of 0 is on: no other is met between -1 and 1."""
    here = at(fmpq(0))
    piece = max((i for i, x in enumerate(table.places[:-1]) if rational(x) <= here), default=0)
    s = at - rational(table.places[piece])
    polynomial: fmpq_poly = horner([fmpq_poly([value]) for value in exact_pieces(table)[piece]], s)
    return polynomial


#: of a variable that runs from -1 to 1 where no table changes its piece
POLYNOMIALS = Arithmetic(
    number=lambda value: fmpq_poly([rational(float(value))]),
    functions={},
    power=lambda base, exponent: base ** int(exponent(fmpq(0)).p),
    table=_polynomial_table,
)


def series_of(formula: Formula, names: Mapping[str, arb_series]) -> arb_series:
    """The Taylor series of a formula where its names have theirs; of no number where a divisor may be 0.

    >>> from optlaws.formulas.tree import Name, Number, Exponentiation
    >>> series = series_of(Exponentiation(Name("k"), Number(2.0)), {"k": arb_series([arb(3), arb(1)])})
    >>> [float(series[i]) for i in range(3)]
    [9.0, 6.0, 1.0]
    """
    try:
        series: arb_series = evaluate(formula, names, BALLS) + arb_series([arb(0)])
    except ValueError:
        return arb_series([arb.nan()] * ctx.cap)
    return series


def composed(polynomial: fmpq_poly, x: arb_series) -> arb_series:
    """The Taylor series of a polynomial of what is affine; about the middle of a ball first, which hardly widens it.

    >>> float(composed(fmpq_poly([0, -1, 1]), arb_series([arb(1, 2.0**-20), arb(1)]))[0].rad()) < 1.01 * 2.0**-20
    True
    """
    middle = x[0].mid()
    about = arb_poly(polynomial)(arb_poly([middle, x[1]]))
    return arb_series(about(arb_poly([(x[0] - middle) / x[1], arb(1)])).coeffs())
