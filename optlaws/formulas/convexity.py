"""Formulas judged by rules: between which values they stay, whether they are affine or quadratic, and their convexity.

Interval arithmetic of many boxes at once says between which values a formula stays while its names stay between theirs.
Intervals are known by their ends, since boxes may have no bound on one side; functions in narrow cells have the
middles and radii of `optlaws.numerics.interval`. Every operation is rounded outward by itself: terms that cancel each
other would else leave less than what they are rounded by.

Convexity follows by the rules of disciplined convex programming, with the reason: sums of convex parts are convex, a
convex function that rises takes convex parts, one that falls takes concave ones (Grant, Boyd, Ye 2006). Beyond that,
quadratic forms are looked at as a whole.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from math import pi

import numpy as np

from optlaws.formulas.arithmetic import pieces
from optlaws.formulas.slopes import added, constant, multiplied, opposite
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
    Sum,
    Table,
)
from optlaws.numbers import Array
from optlaws.tolerances import OPERATIONS_ROUNDING

_MOST_ANGLE = 2.0**24


@dataclass(frozen=True, eq=False)
class Endpoints:
    """Least and greatest values, an array of each."""

    low: Array
    high: Array

    def __neg__(self) -> Endpoints:
        return Endpoints(-self.high, -self.low)

    def __add__(self, other: Endpoints) -> Endpoints:
        return Endpoints(self.low + other.low, self.high + other.high).outward()

    def __mul__(self, other: Endpoints) -> Endpoints:
        with np.errstate(invalid="ignore"):
            ends = [low * two for low in (self.low, self.high) for two in (other.low, other.high)]
        # nothing times whatever is nothing
        ends = [np.where(np.isnan(end), 0.0, end) for end in ends]
        return Endpoints(np.minimum.reduce(ends), np.maximum.reduce(ends)).outward()

    def outward(self) -> Endpoints:
        """A little wider, for the rounding of an operation; a sum or a product that is 0 is exact, and stays."""
        less, more = 1.0 - OPERATIONS_ROUNDING, 1.0 + OPERATIONS_ROUNDING
        below, above = np.where(self.low > 0.0, less, more), np.where(self.high > 0.0, more, less)
        return Endpoints(self.low * below, self.high * above)

    def through(self, function: Callable[[Array], Array]) -> Endpoints:
        """The image under a rising function."""
        with np.errstate(all="ignore"):
            return Endpoints(np.asarray(function(self.low)), np.asarray(function(self.high)))


def between(value: Array | float) -> Endpoints:
    """The intervals that hold a single number each."""
    return Endpoints(np.array(value), np.array(value))


def enclosed(formula: Formula, names: Mapping[str, Endpoints]) -> Endpoints:
    """Bounds of a formula over boxes; NaN where it has no value in a part of one.

    >>> from optlaws.formulas.reading import read
    >>> values = enclosed(read("(1 + k)^2"), {"k": Endpoints(np.array(0.0), np.array(1.0))})
    >>> round(float(values.low), 9), round(float(values.high), 9)
    (1.0, 4.0)
    """
    known: list[Endpoints] = []
    for part, places, _ in formula.steps:
        known.append(_enclosed(part, [known[place] for place in places], names))
    return known[-1]


def _enclosed(formula: Formula, parts: list[Endpoints], names: Mapping[str, Endpoints]) -> Endpoints:
    if isinstance(formula, Number):
        return between(formula.value)
    if isinstance(formula, Name):
        return between(pi).outward() if formula.name == "pi" and "pi" not in names else names[formula.name]
    if isinstance(formula, Negative):
        return -parts[0]
    if isinstance(formula, Sum):
        return reduce(lambda total, other: total + other, parts)
    if isinstance(formula, Product):
        return reduce(lambda product, other: product * other, parts)
    if isinstance(formula, Reciprocal):
        return _reciprocal(parts[0])
    if isinstance(formula, Exponentiation):
        return _power(parts[0], parts[1], constant(formula.exponent)).outward()
    if isinstance(formula, Table):
        return _table(formula, parts[0]).outward()
    assert isinstance(formula, Call)  # noqa: S101 - there are no others
    return _call(formula.function, parts).outward()


def _reciprocal(of: Endpoints) -> Endpoints:
    crossing = (of.low < 0.0) & (of.high > 0.0)
    with np.errstate(divide="ignore"):
        low = np.where(of.high == 0.0, -np.inf, 1.0 / of.high)
        high = np.where(of.low == 0.0, np.inf, 1.0 / of.low)
    return Endpoints(np.where(crossing, -np.inf, low), np.where(crossing, np.inf, high)).outward()


def _power(base: Endpoints, exponent: Endpoints, known: float | None) -> Endpoints:
    if known is not None and known == int(known):
        whole = int(known)
        with np.errstate(all="ignore"):
            ends = [base.low ** float(abs(whole)), base.high ** float(abs(whole))]
        low, high = np.minimum(*ends), np.maximum(*ends)
        if whole % 2 == 0:
            low = np.where((base.low <= 0.0) & (base.high >= 0.0), 0.0, low)
        interval = Endpoints(low, high)
        return interval if whole >= 0 else _reciprocal(interval)
    with np.errstate(all="ignore"):
        ends = [np.power(x, y) for x in (base.low, base.high) for y in (exponent.low, exponent.high)]
    return Endpoints(np.minimum.reduce(ends), np.maximum.reduce(ends))


def _table(table: Table, at: Endpoints) -> Endpoints:
    """The bounds of a table: the bounds of each piece over the part of the argument's range in it."""
    places, rows = np.array(table.places), pieces(table)
    # the first and the last piece go on beyond the table
    starts, stops = np.array([-np.inf, *places[1:-1]]), np.array([*places[1:-1], np.inf])
    first, last = np.searchsorted(stops[:-1], at.low), np.searchsorted(starts[1:], at.high, side="right")
    lows, highs = np.full(np.shape(at.low), np.inf), np.full(np.shape(at.low), -np.inf)
    # narrow ranges lie in few pieces: the next one of each, until all are through
    for further in range(int(np.max(last - first, initial=-1)) + 1):
        met = first + further <= last
        i = (first + further)[met]
        s = Endpoints(np.maximum(at.low[met], starts[i]), np.minimum(at.high[met], stops[i])) + between(-places[i])
        total = reduce(lambda sum_, column: between(column) + sum_ * s, rows[i].T[::-1], between(0.0))
        lows[met], highs[met] = np.minimum(lows[met], total.low), np.maximum(highs[met], total.high)
    return Endpoints(lows, highs)


def _call(function: str, parts: list[Endpoints]) -> Endpoints:
    first = parts[0]
    if function == "max":
        return reduce(lambda p, q: Endpoints(np.maximum(p.low, q.low), np.maximum(p.high, q.high)), parts)
    if function == "min":
        return reduce(lambda p, q: Endpoints(np.minimum(p.low, q.low), np.minimum(p.high, q.high)), parts)
    if function == "norm":
        squares = [_power(part, part, 2.0) for part in parts]
        return reduce(lambda total, other: total + other, squares).through(np.sqrt)
    if function == "abs":
        return Endpoints(np.maximum(np.maximum(first.low, -first.high), 0.0), np.maximum(-first.low, first.high))
    known = SMOOTH_FUNCTIONS[function]
    if known.rising:
        # where it has no value it says nothing
        return first.through(lambda x: known.numpy(np.maximum(x, 0.0) if known.from_zero else x))
    if function == "tan":
        # a pole lies where the half turns differ
        same = np.floor(first.low / pi + 0.5) == np.floor(first.high / pi + 0.5)
        tangents = first.through(np.tan)
        return Endpoints(np.where(same, tangents.low, -np.inf), np.where(same, tangents.high, np.inf))
    return _cosine(first + -between(pi / 2.0).outward() if function == "sin" else first)


def _cosine(turn: Endpoints) -> Endpoints:
    """The range of a cosine; of so large an angle that its turns are rounded nothing is known."""
    with np.errstate(invalid="ignore"):
        ends = [np.cos(turn.low), np.cos(turn.high)]
    top = np.floor(turn.high / (2 * pi)) * 2 * pi >= turn.low
    bottom = np.floor((turn.high - pi) / (2 * pi)) * 2 * pi + pi >= turn.low
    large = np.maximum(np.abs(turn.low), np.abs(turn.high)) > _MOST_ANGLE
    return Endpoints(np.where(bottom | large, -1.0, np.minimum(*ends)), np.where(top | large, 1.0, np.maximum(*ends)))


#: factors of products of names: none, one or two of them, sorted
Terms = dict[tuple[str, ...], Formula]
_MOST = 2


def quadratic(formula: Formula, names: Collection[str], most: int = _MOST) -> Terms | None:
    """The factors of products of up to `most` names; None where the formula has others, or is no polynomial of them.

    >>> from optlaws.formulas.reading import read
    >>> quadratic(read("(c + k*b)*b - 3"), "bc")
    {('b', 'c'): 1, ('b', 'b'): k, (): -3}
    """
    if not formula.names() & set(names):
        return {(): formula}
    if isinstance(formula, Name):
        return {(formula.name,): Number(1.0)}
    if isinstance(formula, Negative):
        form = quadratic(formula.of, names, most)
        return None if form is None else {key: opposite(coefficient) for key, coefficient in form.items()}
    if isinstance(formula, Sum):
        return _sum([quadratic(term, names, most) for term in formula.terms])
    if isinstance(formula, Product):
        return _product(formula, names, most)
    if isinstance(formula, Exponentiation) and most > 1:
        exponent = constant(formula.exponent)
        if exponent is None or not 0.0 <= exponent <= most or exponent % 1.0:
            return None
        return _multiplied([{(): Number(1.0)}, *[quadratic(formula.base, names, most)] * int(exponent)], most)
    return None


def semidefinite(formula: Formula, names: Collection[str], within: Mapping[str, Endpoints], sign: int) -> bool:
    """Whether the formula, times the sign, is a quadratic form that is nonnegative at every k.

    >>> from optlaws.formulas.reading import read
    >>> semidefinite(read("c^2 + 2*b*c + b^2"), "bc", {}, 1), semidefinite(read("c^2 + 3*b*c + b^2"), "bc", {}, 1)
    (True, False)
    """
    form = quadratic(formula, names)
    if form is None:
        return False
    variables = sorted({name for key in form if len(key) == _MOST for name in key})
    entries = {
        (i, j): form.get((first, other), Number(0.0))
        for i, first in enumerate(variables)
        for j, other in enumerate(variables)
        if i <= j
    }
    values = {place: constant(entry) for place, entry in entries.items()}
    if None not in values.values():
        return _exactly({place: sign * Fraction(value or 0.0) for place, value in values.items()}, len(variables))
    return _widely({place: enclosed(entry, within) for place, entry in entries.items()}, len(variables), sign)


def _exactly(entries: Mapping[tuple[int, int], Fraction], size: int) -> bool:
    """The test by elimination in exact arithmetic; off-diagonal entries combine both sides."""
    matrix = [[entries[min(i, j), max(i, j)] / (1 if i == j else 2) for j in range(size)] for i in range(size)]
    for i in range(size):
        if matrix[i][i] < 0 or (matrix[i][i] == 0 and any(matrix[i][j] for j in range(i + 1, size))):
            return False
        for j in range(i + 1, size if matrix[i][i] else 0):
            share = matrix[j][i] / matrix[i][i]
            for column in range(i, size):
                matrix[j][column] -= share * matrix[i][column]
    return True


def _widely(entries: Mapping[tuple[int, int], Endpoints], size: int, sign: int) -> bool:
    """The test by eigenvalues at the midpoints of many parts, less the variation of the entries."""
    count = max(np.size(entry.low) for entry in entries.values())
    middles, reach = np.zeros((count, size, size)), np.zeros((count, size, size))
    for (i, j), entry in entries.items():
        half = 1.0 if i == j else 0.5
        with np.errstate(invalid="ignore"):  # of an entry without bounds
            middles[:, i, j] = middles[:, j, i] = sign * half * (entry.low + entry.high) / 2.0
        reach[:, i, j] = reach[:, j, i] = half * (entry.high - entry.low) / 2.0
    if not np.isfinite(middles).all() or not np.isfinite(reach).all():
        return False
    sizes = np.linalg.norm(middles, axis=(1, 2)) + np.linalg.norm(reach, axis=(1, 2))
    least = np.linalg.eigvalsh(middles)[:, 0] - np.linalg.norm(reach, axis=(1, 2)) - OPERATIONS_ROUNDING * sizes
    return bool(least.min() > 0.0)


def _sum(terms: list[Terms | None]) -> Terms | None:
    gathered: dict[tuple[str, ...], list[Formula]] = {}
    for term in terms:
        if term is None:
            return None
        for key, factor in term.items():
            gathered.setdefault(key, []).append(factor)
    return {key: added(factors) for key, factors in gathered.items()}


def _product(formula: Product, names: Collection[str], most: int) -> Terms | None:
    """The factors without names times the product of the others."""
    moving = [factor for factor in formula.factors if factor.names() & set(names)]
    still = multiplied([factor for factor in formula.factors if factor not in moving])
    form = _multiplied([quadratic(factor, names, most) for factor in moving], most)
    return None if form is None else {key: multiplied([still, factor]) for key, factor in form.items()}


def _multiplied(factors: list[Terms | None], most: int) -> Terms | None:
    terms: Terms = {(): Number(1.0)}
    for factor in factors:
        if factor is None:
            return None
        products: list[Terms | None] = [
            {tuple(sorted((*name, *other))): multiplied([first, second])}
            for name, first in terms.items()
            for other, second in factor.items()
        ]
        together = _sum(products)
        if together is None or any(len(key) > most for key in together):
            return None
        terms = together
    return terms


@dataclass(frozen=True)
class Affine:
    """The sum of factors times names, plus what is left; neither has any of the names."""

    factors: tuple[tuple[str, Formula], ...]  #: by name, those that are not 0
    rest: Formula


def affine(formula: Formula, names: Collection[str]) -> Affine | None:
    """The formula as an affine function of these names; None where it is not affine.

    >>> from optlaws.formulas.reading import read
    >>> affine(read("2*(c + k*b) - c + k^2"), "bc")
    Affine(factors=(('c', 2 - 1), ('b', 2*k)), rest=k^2)
    >>> affine(read("b*c"), "bc") is None
    True
    """
    form = quadratic(formula, names, most=1)
    if form is None:
        return None
    return Affine(tuple((key[0], factor) for key, factor in form.items() if key), form.get((), Number(0.0)))


def degree(formula: Formula, names: Mapping[str, int], *, between_kinks: bool = False) -> int | None:
    """The greatest degree that a formula can have where its names are polynomials of these degrees.

    Tables, and sizes and maxima of what depends on k alone, count as what they are on each of their pieces; between
    kinks those of all names. None where the formula is no polynomial.

    >>> from optlaws.formulas.reading import read
    >>> degree(read("k^2*c + b"), {"k": 1, "c": 5, "b": 6}), degree(read("sin(k)"), {"k": 1})
    (7, None)
    >>> degree(read("max(b^2, c) + abs(k)"), {"k": 1, "c": 5, "b": 6}, between_kinks=True)
    12
    """
    in_pieces = {*names, "pi"} if between_kinks else {"k"}
    degrees: list[int | None] = []
    for part, places, _ in formula.steps:
        degrees.append(_degree(part, [degrees[place] for place in places], names, in_pieces))
    return degrees[-1]


def _degree(formula: Formula, parts: list[int | None], names: Mapping[str, int], in_pieces: set[str]) -> int | None:
    if not formula.names() & names.keys():
        return 0
    if isinstance(formula, Name):
        return names[formula.name]
    if isinstance(formula, Exponentiation):
        base, exponent = parts[0], constant(formula.exponent)
        whole = exponent is not None and exponent >= 0.0 and exponent % 1.0 == 0.0
        return int(exponent) * base if whole and exponent is not None and base is not None else None
    known = [part for part in parts if part is not None]
    if len(known) < len(parts):
        return None
    if isinstance(formula, Negative | Sum):
        return max(known)
    if isinstance(formula, Product):
        return sum(known)
    if not formula.names() <= in_pieces:
        return None
    if isinstance(formula, Table):
        return known[0] * max((3 if formula.smooth else 1) - formula.order, 0)
    return max(known) if isinstance(formula, Call) and formula.function in {"abs", "max", "min"} else None


_PARTS = 256


class Curvature(Enum):
    """The curvature of a formula in its names.

    >>> Curvature.CONVEX.opposite
    <Curvature.CONCAVE: 'concave'>
    """

    CONSTANT = "constant"
    AFFINE = "affine"
    CONVEX = "convex"
    CONCAVE = "concave"
    UNKNOWN = "not known to be convex"

    @property
    def opposite(self) -> Curvature:
        """The curvature of the formula with its sign turned."""
        return {Curvature.CONVEX: Curvature.CONCAVE, Curvature.CONCAVE: Curvature.CONVEX}.get(self, self)

    @property
    def convex(self) -> bool:
        """Whether the formula is convex, affine and constant included."""
        return self in {Curvature.CONSTANT, Curvature.AFFINE, Curvature.CONVEX}

    @property
    def concave(self) -> bool:
        """Whether the formula is concave, affine and constant included."""
        return self.opposite.convex


@dataclass(frozen=True)
class Verdict:
    """The curvature of a formula, the rule that shows it, and the part to which the rule applies.

    >>> from optlaws.formulas.reading import read
    >>> verdict = Judge(frozenset("bc")).verdict(read("c^2 + b*c"))
    >>> verdict.curvature.value, verdict.why, verdict.part
    ('not known to be convex', 'b*c is a product of parts that both vary', b*c)
    """

    curvature: Curvature
    why: str
    part: Formula


@dataclass(frozen=True)
class Judge:
    """The rules for formulas in some names, the other name `k` being between two values.

    >>> from optlaws.formulas.reading import read
    >>> Judge(frozenset("bc")).verdict(read("c^2 + b*c + b^2")).why
    'c^2 + b*c + b^2 is a convex quadratic form at every k'
    """

    names: frozenset[str]  #: in which the curvature is asked
    #: start, stop: between which values k is
    start: float = 0.0
    stop: float = 1.0

    def verdict(self, formula: Formula) -> Verdict:
        """The verdict on a formula, by the rules first, then as a quadratic form."""
        verdict = self.by_rules(formula)
        if verdict.curvature is not Curvature.UNKNOWN:
            return verdict
        for sign in (1, -1):
            if semidefinite(formula, self.names, self._interval, sign):
                kind = Curvature.CONVEX if sign > 0 else Curvature.CONCAVE
                return Verdict(kind, f"{formula} is a {kind.value} quadratic form at every k", formula)
        return verdict

    def by_rules(self, formula: Formula) -> Verdict:
        """The verdict of the rules alone, part by part."""
        if not formula.names() & self.names:
            return Verdict(Curvature.CONSTANT, f"{formula} does not depend on the law", formula)
        if affine(formula, self.names) is not None:
            return Verdict(Curvature.AFFINE, f"{formula} is affine in the law", formula)
        if isinstance(formula, Negative):
            verdict = self.by_rules(formula.of)
            return replace(verdict, curvature=verdict.curvature.opposite)
        if isinstance(formula, Sum):
            return self._sum(formula)
        if isinstance(formula, Product):
            return self._product(formula)
        if isinstance(formula, Reciprocal):
            return self._power(formula, formula.of, -1.0)
        if isinstance(formula, Exponentiation):
            return self._of_power(formula)
        if isinstance(formula, Table):
            return self._table(formula)
        assert isinstance(formula, Call)  # noqa: S101 - there are no others
        return self._call(formula)

    @property
    def _interval(self) -> dict[str, Endpoints]:
        edges = np.linspace(self.start, self.stop, _PARTS + 1)
        whole = Endpoints(np.array(-np.inf), np.array(np.inf))
        return {**dict.fromkeys(self.names, whole), "k": Endpoints(edges[:-1], edges[1:])}

    def sign(self, formula: Formula) -> int:
        """1 where the value is nowhere negative, -1 where nowhere positive, 0 where neither is known."""
        interval = enclosed(formula, self._interval)
        if float(np.min(interval.low)) >= 0.0:
            return 1
        return -1 if float(np.max(interval.high)) <= 0.0 else 0

    def _sum(self, formula: Sum) -> Verdict:
        verdicts = [self.by_rules(term) for term in formula.terms]
        for kind, fits in ((Curvature.CONVEX, "convex"), (Curvature.CONCAVE, "concave")):
            if all(getattr(verdict.curvature, fits) for verdict in verdicts):
                return Verdict(kind, f"every term of {formula} is {fits}", formula)
        unknown = [verdict for verdict in verdicts if verdict.curvature is Curvature.UNKNOWN]
        return unknown[0] if unknown else _unknown(f"{formula} adds convex and concave terms", formula)

    def _product(self, formula: Product) -> Verdict:
        moving = [factor for factor in formula.factors if factor.names() & self.names]
        if len(moving) > 1:
            return _unknown(f"{formula} is a product of parts that both vary", formula)
        verdict = self.by_rules(moving[0])
        others = [factor for factor in formula.factors if factor is not moving[0]]
        sign = 1
        for factor in others:
            sign *= self.sign(factor)
        if sign == 0 and verdict.curvature is not Curvature.AFFINE:
            return _unknown(f"the factor of {moving[0]} in {formula} changes its sign", formula)
        kind = verdict.curvature if sign > 0 else verdict.curvature.opposite
        return Verdict(kind, f"{formula} is {moving[0]} times what does not change its sign; {verdict.why}", formula)

    def _of_power(self, formula: Exponentiation) -> Verdict:
        exponent = constant(formula.exponent)
        if exponent is not None:
            return self._power(formula, formula.base, exponent)
        base = constant(formula.base)
        if base is None or not base > 0.0:
            return _unknown(f"both parts of {formula} vary", formula)
        inner = self.by_rules(formula.exponent).curvature
        return _when(inner.convex if base >= 1.0 else inner.concave, Curvature.CONVEX, formula, "an exponential")

    def _power(self, formula: Formula, of: Formula, exponent: float) -> Verdict:
        inner, sign = self.by_rules(of), self.sign(of)
        even = exponent > 0.0 and exponent % 2.0 == 0.0
        kind = inner.curvature
        if exponent == 1.0:
            return inner
        if even and (kind in {Curvature.AFFINE, Curvature.CONSTANT} or (kind.concave and sign < 0)):
            return Verdict(Curvature.CONVEX, f"{formula} is an even power of what is affine", formula)
        if exponent > 1.0 and kind.convex and sign > 0:
            return Verdict(Curvature.CONVEX, f"{formula} rises with {of}, which is convex and not negative", formula)
        if exponent > 1.0 and exponent % 2.0 == 1.0 and kind.concave and sign < 0:
            return Verdict(Curvature.CONCAVE, f"{formula} rises with {of}, which is concave and not positive", formula)
        if 0.0 < exponent < 1.0:
            return _when(kind.concave, Curvature.CONCAVE, formula, f"a root of {of}")
        if exponent < 0.0 and kind.concave and sign > 0:
            return Verdict(Curvature.CONVEX, f"{formula} falls with {of}, which is concave and positive", formula)
        if exponent == -1.0 and kind.convex and sign < 0:
            return Verdict(Curvature.CONCAVE, f"{formula} falls with {of}, which is convex and negative", formula)
        return _unknown(f"no rule says what the power {formula} of a part that is {kind.value} is", formula)

    def _table(self, formula: Table) -> Verdict:
        inner = self.by_rules(formula.of).curvature
        bend = _bend(formula)
        if inner is not Curvature.AFFINE or not bend:
            return _unknown(f"{formula} bends both ways, or is of a part that is not affine", formula)
        kind = Curvature.CONVEX if bend > 0 else Curvature.CONCAVE
        return Verdict(kind, f"{formula} bends one way and is of an affine part", formula)

    def _call(self, formula: Call) -> Verdict:
        name, kinds = formula.function, [self.by_rules(argument).curvature for argument in formula.arguments]
        function = SMOOTH_FUNCTIONS.get(name)
        rising = function.curvature if function is not None and function.rising else None
        if name == "max" or rising == "convex":
            return _when(
                all(kind.convex for kind in kinds), Curvature.CONVEX, formula, f"{name}, which rises, of parts"
            )
        if name == "min" or rising == "concave":
            return _when(
                all(kind.concave for kind in kinds), Curvature.CONCAVE, formula, f"{name}, which rises, of parts"
            )
        if name in {"abs", "norm"}:
            fits = all(self._size_is_convex(argument) for argument in formula.arguments)
            return _when(fits, Curvature.CONVEX, formula, f"{name} of parts")
        return _unknown(f"{name} bends both ways: {formula} is not convex", formula)

    def _size_is_convex(self, part: Formula) -> bool:
        kind, sign = self.by_rules(part).curvature, self.sign(part)
        plain = kind in {Curvature.AFFINE, Curvature.CONSTANT}
        return plain or (kind.convex and sign > 0) or (kind.concave and sign < 0)


def _unknown(why: str, part: Formula) -> Verdict:
    return Verdict(Curvature.UNKNOWN, why, part)


def _when(fits: bool, kind: Curvature, formula: Formula, what: str) -> Verdict:  # noqa: FBT001 - the rule's answer
    if fits:
        return Verdict(kind, f"{formula} is {what} that keep it {kind.value}", formula)
    return _unknown(f"{formula} is {what} that do not keep it {kind.value}", formula)


def _bend(table: Table) -> int:
    """1 where a table is convex everywhere, -1 where it is concave, else 0."""
    rows = pieces(table)
    if not table.smooth:
        steps = [after - before for before, after in pairwise(rows[:, 1].tolist())]
    elif table.order or rows.shape[1] < 4:
        return 0
    else:
        lengths = np.diff(table.places)
        ends = [*(2.0 * rows[:, 2]).tolist(), float(2.0 * rows[-1, 2] + 6.0 * rows[-1, 3] * lengths[-1])]
        steps = [*ends, -float(rows[0, 3]), float(rows[-1, 3])]
    if all(step >= 0.0 for step in steps):
        return 1
    return -1 if all(step <= 0.0 for step in steps) else 0
