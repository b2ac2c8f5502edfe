"""Between Python's numbers and python-flint's, exact one way, rounded outward the other; and formulas in balls."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from math import ceil, inf
from operator import methodcaller, mul
from typing import Any

from flint import arb, arb_poly, arb_series, ctx, fmpq, fmpq_poly

from optlaws.formulas.arithmetic import Arithmetic, evaluate, horner, pieces, step_value
from optlaws.formulas.tree import Call, Formula, Table
from optlaws.numerics.exact import rounded_down, rounded_up

#: balls that hold the least and the greatest value of something
Extremes = tuple[arb, arb]

_PLACES, _EXACT = 128, 4096


def rational(value: float | Fraction) -> fmpq:
    """The exact value of a float or Fraction."""
    exact = Fraction(value)
    return fmpq(exact.numerator, exact.denominator)


def ball(value: float | Fraction | fmpq) -> arb:
    """A ball around the value, at the precision at work."""
    return arb(value if isinstance(value, fmpq) else rational(value))


def upper(value: arb) -> Fraction:
    """An upper bound of the ball, with 128 bits."""
    with ctx.workprec(_EXACT):  # every operation on a ball rounds to the precision at work, this one too
        mantissa, exponent = (int(part) for part in value.upper().man_exp())
    return Fraction(ceil(Fraction(mantissa) * Fraction(2) ** (exponent + _PLACES)), 2**_PLACES)


def lower(value: arb) -> Fraction:
    """A lower bound of the ball, with 128 bits."""
    with ctx.workprec(_EXACT):
        return -upper(-value)


def enclosed(value: arb) -> tuple[float, float]:
    """The two doubles that enclose a ball, which may be infinite."""
    if value.is_finite():
        return rounded_down(lower(value)), rounded_up(upper(value))
    return (inf, inf) if value == arb.pos_inf() else (-inf, inf)


def at(polynomial: fmpq_poly, x: arb) -> arb:
    """The value of a polynomial at a ball."""
    value: arb = polynomial.numer()(x) / arb(polynomial.denom())
    return value


def root(square: arb) -> arb:
    """The root of what is not negative, though its ball may reach below 0."""
    return square.sqrt() if square > 0 else arb(0).union(square.upper().max(arb(0)).sqrt())


@contextmanager
def series_length(count: int) -> Iterator[None]:
    """Set the number of terms of Taylor series for the time of a `with` block."""
    before: Any = ctx.cap
    ctx.cap = count
    try:
        yield
    finally:
        ctx.cap = before


def _tanh(x: Any) -> Any:
    grown = (x + x).exp()
    return (grown - 1) / (grown + 1)


def _power(base: Any, exponent: Any) -> Any:
    """The power of a ball; a whole exponent means repeated multiplication, so that the base may be negative."""
    plain = _plain(exponent)
    if plain.is_integer():
        whole = int(str(plain.unique_fmpz()))
        power = reduce(mul, [base] * abs(whole)) if whole else base * 0 + 1
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


#: the first terms of a series that are enclosed by the slopes of their own
_ENCLOSED = 2
#: of half a cell: what is narrower is a place in it
_PLACE = 2.0**-8


def series_on_cell(
    formula: Formula, names: Callable[[arb_series], Mapping[str, arb_series]], k: arb_series
) -> arb_series:
    """The Taylor series of a formula around all k of a ball; `names` are what its names stand for there.

    What a part is on a cell is at most its slope there away from what it is in the middle, and so is each of its first
    terms; this is narrower by far than what comes of balls in which the same k stands many times.

    >>> from optlaws.formulas.reading import read
    >>> k = arb_series([arb(0.5, 2.0**-10), arb(2.0**-10)])
    >>> wide, narrow = (
    ...     series_of(read("(k - k^2)^4"), {"k": k}),
    ...     series_on_cell(read("(k - k^2)^4"), lambda k: {"k": k}, k),
    ... )
    >>> wide[0].contains(narrow[0]), float(narrow[0].rad()) < 0.01 * float(wide[0].rad())
    (True, True)
    """
    middle, half = k[0].mid(), k[1]
    if not half > 0 or k[0].rad() < _PLACE * half:
        return series_of(formula, names(k))
    reach = (abs(k[0] - middle) / half).upper()
    around = names(k)
    with series_length(_ENCLOSED + 1):
        about = names(arb_series([middle, half]))
    abouts, arounds = list[Any](), list[Any]()
    try:
        for part, places, done in formula.steps:
            near, wide = [abouts[place] for place in places], [arounds[place] for place in places]
            with series_length(_ENCLOSED + 1):
                there = step_value(part, near, about, BALLS)
            if isinstance(part, Call) and part.function in {"max", "min"} and len(places) == 2:
                # what two have in common leaves their difference, which tells the greater one
                with series_length(_ENCLOSED + 1):
                    apart = near[0] - near[1]
                sign = 1 if part.function == "max" else -1
                value = wide[1] + sign * _max(sign * _narrowed(wide[0] - wide[1], apart, reach), arb(0))
            else:
                value = step_value(part, wide, around, BALLS)
            abouts.append(there)
            arounds.append(_narrowed(value, there, reach))
            for place in done:
                abouts[place] = arounds[place] = None
    except ValueError:
        return arb_series([arb.nan()] * ctx.cap)
    series: arb_series = arounds[-1] + arb_series([arb(0)])
    return series


def _narrowed(around: Any, about: Any, reach: arb) -> Any:
    """A series around a cell whose first terms are also within their slopes of those in its middle."""
    if not isinstance(around, arb_series):
        return around
    terms = [around[i] for i in range(around.length())]
    for i in reversed(range(min(_ENCLOSED, len(terms) - 1))):
        if about[i].is_finite() and terms[i].is_finite() and terms[i + 1].is_finite():
            away = (reach * (i + 1) * abs(terms[i + 1])).upper()
            terms[i] = terms[i].intersection(about[i] + arb(0, away))
    return arb_series(terms)


def composed(polynomial: fmpq_poly, x: arb_series) -> arb_series:
    """The Taylor series of a polynomial of what is affine; about the middle of a ball first, which hardly widens it.

    >>> float(composed(fmpq_poly([0, -1, 1]), arb_series([arb(1, 2.0**-20), arb(1)]))[0].rad()) < 1.01 * 2.0**-20
    True
    """
    middle = x[0].mid()
    about = arb_poly(polynomial)(arb_poly([middle, x[1]]))
    return arb_series(about(arb_poly([(x[0] - middle) / x[1], arb(1)])).coeffs())
