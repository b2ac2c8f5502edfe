"""Formulas of a motion in balls: values along a stored law, and rows that bound them over the laws of a problem."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from operator import mul

import numpy as np
from flint import arb, arb_series, ctx, fmpq, fmpq_poly
from numpy.polynomial import legendre

from optlaws.formulas.arithmetic import Arithmetic, evaluate
from optlaws.formulas.convexity import affine, degree
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.slopes import added, derivative, multiplied, opposite
from optlaws.formulas.tree import ORDERS, Call, Exponentiation, Formula, Number, Table, number, product, rebuilt
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.functionals.formula_rows import (
    Branch,
    gauss_parts,
    integral_rows,
    rule_edges,
    rule_length,
    squared,
)
from optlaws.synthesis.spaces.of_basis import space_of
from optlaws.verification.enclosing.balls import (
    BALLS,
    POLYNOMIALS,
    Extremes,
    ball,
    composed,
    exact_pieces,
    rational,
    series_of,
    series_on_cell,
)
from optlaws.verification.enclosing.pieces import PolynomialPiece
from optlaws.verification.enclosing.space import ExactSpace
from optlaws.verification.enclosing.taylor_models import between, extremes, integrals, least_and_greatest

_KINKED = frozenset({"abs", "max", "min"})


def _whole_power(base: Fraction, exponent: Fraction) -> Fraction:
    if exponent.denominator != 1:
        raise ArithmeticError
    return Fraction(base**exponent.numerator)


_RATIONALS = Arithmetic(number=Fraction, functions={}, power=_whole_power)


def kinks(motion: MotionFormula) -> list[Fraction]:
    """The k of possible kinks of a function of k alone; exact for straight lines, else nearly.

    >>> from optlaws.formulas.of_motion import of_text
    >>> kinks(of_text("table(1 - k, 0:1, 0.25:2, 1:0)*c + abs(k - 0.5)*b"))
    [Fraction(1, 2), Fraction(3, 4)]
    """
    exact, inexact = [], []
    for part in motion.formula.different:
        for difference in _vanishing(part) if part.names() <= {"k"} else ():
            root = _root(difference)
            if root is None:
                inexact += list(map(Fraction, MotionFormula(Call("abs", (difference,))).kinks))
            else:
                exact.append(root)
    return sorted({k for k in (*exact, *inexact) if 0 < k < 1})


def _vanishing(part: Formula) -> Iterator[Formula]:
    """Functions that vanish where a part has a kink."""
    if isinstance(part, Table):
        yield from (added([part.of, opposite(number(place))]) for place in part.places)
    elif isinstance(part, Call) and part.function in _KINKED:
        first, *others = part.arguments
        yield from [added([first, opposite(term)]) for term in others] or [first]


def _line(formula: Formula) -> tuple[Fraction, Fraction] | None:
    """Slope and value at 0 of a formula that is affine in k; None where it is not, or not rational."""
    straight = affine(formula, ("k",))
    if straight is None:
        return None
    try:
        slope = evaluate(dict(straight.factors).get("k", Number(0.0)), {}, _RATIONALS)
        return slope, evaluate(straight.rest, {}, _RATIONALS)
    except (ArithmeticError, KeyError, TypeError):
        return None


def _root(formula: Formula) -> Fraction | None:
    line = _line(formula)
    return None if line is None or not line[0] else -line[1] / line[0]


def on_part(formula: Formula, low: Fraction, high: Fraction) -> Formula:
    """The formula between two k, without kinks of what is affine in k if none is between them.

    >>> from optlaws.formulas.reading import read
    >>> on_part(read("abs(k - 0.5)*c + max(k, 0.25, b)"), Fraction(1, 2), Fraction(1))
    (k - 0.5)*c + max(k, 0.25, b)
    """
    parts = [on_part(part, low, high) for part in formula.parts]
    changed = rebuilt(formula, parts) if parts else formula
    if not changed.names() <= {"k"}:
        return changed
    if isinstance(changed, Table):
        return _piece(changed, low, high)
    if isinstance(changed, Call) and changed.function == "abs":
        [of] = changed.arguments
        sign = _sign(of, low, high)
        return changed if sign is None else multiplied([number(sign), of])
    if isinstance(changed, Call) and changed.function in _KINKED:
        return _greatest(changed, low, high)
    return changed


def _sign(formula: Formula, low: Fraction, high: Fraction) -> float | None:
    """The sign of a formula that is affine in k; None where it is not, or where the sign changes."""
    line = _line(formula)
    ends = [] if line is None else [line[0] * k + line[1] for k in (low, high)]
    if not ends:
        return None
    if min(ends) >= 0:
        return 1.0
    return -1.0 if max(ends) <= 0 else None


def _greatest(call: Call, low: Fraction, high: Fraction) -> Formula:
    """The argument of a maximum or minimum that is one throughout."""
    forth = 1.0 if call.function == "max" else -1.0
    for argument in call.arguments:
        signs: Iterable[float | None] = (
            _sign(added([argument, opposite(other)]), low, high) for other in call.arguments
        )
        # equal ones differ by 0, of which the sign is 1
        if all(other is argument or sign == forth for other, sign in zip(call.arguments, signs, strict=True)):
            return argument
    return call


def _piece(table: Table, low: Fraction, high: Fraction) -> Formula:
    """The piece of a table that its argument is on throughout."""
    line = _line(table.of)
    if line is None:
        return table
    first, last = sorted(line[0] * k + line[1] for k in (low, high))
    for i, row in enumerate(exact_pieces(replace(table, order=0))):
        start, stop = Fraction(table.places[i]), Fraction(table.places[i + 1])
        if not ((i == 0 or start <= first) and (i + 2 == len(table.places) or last <= stop)):
            continue
        if not table.smooth:
            return replace(table, places=table.places[i : i + 2], values=table.values[i : i + 2])
        off = added([table.of, opposite(number(table.places[i]))])
        return _differentiated([float(Fraction(int(value.p), int(value.q))) for value in row], off, table.order)
    return table


def _differentiated(row: list[float], off: Formula, nu: int) -> Formula:
    """The derivative of a sum of powers; its coefficients are floats, and so are these times their small factors."""
    terms = []
    for power, value in enumerate(row):
        factors = [Number(float(i)) for i in range(power - nu + 1, power + 1)]
        if power >= nu:
            lower = [Exponentiation(off, Number(float(power - nu)))] if power > nu else []
            # a product that is not worked out: its floats are rounded nowhere
            terms.append(product([*factors, number(value), *lower]))
    return added(terms)


#: binary places of an integral that count: more than a float has, and no more than that, for each costs cells and terms
_BITS = 60
#: where on a stretch the formulas are compared, as shares of it
_WITHIN = (0.4, 0.5, 0.75)


def extremes_of(motion: MotionFormula, pieces: Sequence[PolynomialPiece]) -> Extremes:
    """Balls that hold the least and the greatest value of a formula on its part of the interval."""
    if motion.start == motion.stop:
        value = value_of(motion, pieces)
        return value, value
    if isinstance(motion.formula, Call) and motion.formula.function == "norm":
        # where a norm vanishes it has no derivative, but its square has
        least, greatest = extremes_of(squared(motion), pieces)
        return least.max(arb(0)).sqrt(), greatest.max(arb(0)).sqrt()
    return least_and_greatest([value for part in _parts(motion, pieces) for value in part.extremes()])


def integral_of(motion: MotionFormula, pieces: Sequence[PolynomialPiece]) -> arb:
    """A ball that holds the integral of a formula over its part: exact where it is a polynomial of k along the law."""
    total = arb(0)
    for part in _parts(motion, pieces):
        composed = part.polynomial()
        if composed is None:
            total += sum(integrals(part.series, [[fmpq_poly([1])]], (part.low, part.high), _BITS), arb(0))
        else:
            whole = composed.integral()
            total += arb((whole(fmpq(1)) - whole(fmpq(-1))) * rational((part.high - part.low) / 2))
    return total


def value_of(motion: MotionFormula, pieces: Sequence[PolynomialPiece]) -> arb:
    """A ball that holds the formula's value where its part begins."""
    k = Fraction(motion.start)
    piece = [started for started in pieces if started.start <= k][-1]
    names = {name: arb(piece.exact(nu, k)) for name, nu in ORDERS.items()}
    value: arb = evaluate(motion.formula, {**names, "k": ball(k)}, BALLS)
    return value


@dataclass(frozen=True)
class _FormulaPart:
    """A formula along a piece of a law, between two k without kinks of what depends on k alone."""

    formula: Formula
    piece: PolynomialPiece
    low: Fraction
    high: Fraction

    def polynomial(self) -> fmpq_poly | None:
        """The formula as a polynomial of what runs from -1 to 1 between the two k; None where it is none."""
        if _bent(self.formula) or degree(self.formula, {"k": 1, **dict.fromkeys(ORDERS, 1)}) is None:
            return None
        k = fmpq_poly([rational((self.low + self.high) / 2), rational((self.high - self.low) / 2)])
        y = self.piece.rate * (k - rational(self.piece.start)) - 1
        names = {name: self.piece.derivative(nu)(y) for name, nu in ORDERS.items() if name in self.formula.names()}
        polynomial: fmpq_poly = evaluate(self.formula, {**names, "k": k}, POLYNOMIALS)
        return polynomial

    def extremes(self) -> Extremes:
        """Balls that hold the least and the greatest value between the two k."""
        composed = self.polynomial()
        if composed is not None:
            return between(composed, fmpq(-1), fmpq(1))
        return extremes(lambda k: self.series(k)[0], self.low, self.high)

    def series(self, k: arb_series) -> tuple[arb_series]:
        """Its Taylor series, to as many terms as series have."""
        used = self.formula.names() & ORDERS.keys()

        def names(k: arb_series) -> dict[str, arb_series]:
            y = (k - ball(self.piece.start)) * arb(self.piece.rate) - 1
            return {"k": k, **{name: composed(self.piece.derivative(ORDERS[name]), y) for name in used}}

        return (series_on_cell(self.formula, names, k),)


def _bent(formula: Formula) -> bool:
    """Whether functions of what varies are in it, or tables over what moves with the law."""
    calls = any(isinstance(part, Call) and part.names() for part in formula.different)
    return calls or any(isinstance(part, Table) and not part.names() <= {"k"} for part in formula.different)


def _parts(motion: MotionFormula, pieces: Sequence[PolynomialPiece]) -> Iterator[_FormulaPart]:
    """The pieces of the law within the formula's part, cut where what depends on k alone has kinks."""
    places = kinks(motion)
    for piece in pieces:
        low, high = max(piece.start, Fraction(motion.start)), min(piece.stop, Fraction(motion.stop))
        edges = sorted({low, high, *(k for k in places if low < k < high)}) if low < high else []
        for ends in pairwise(edges):
            yield _FormulaPart(on_part(motion.formula, *ends), piece, *ends)


def formula_columns(space: ExactSpace, motion: MotionFormula, k: Fraction) -> list[arb]:
    """An affine formula at k: of the free functions, then of the base law with what is left."""
    return _columns(space, motion, ball(k), space.piece(k))


def _columns(space: ExactSpace, motion: MotionFormula, k: arb, piece: int) -> list[arb]:
    columns = [arb(0)] * (space.terms + 1)
    for nu, factor in motion.weights.items():
        weight, values = evaluate(factor, {"k": k}, BALLS), space.on_piece(nu, piece, 2 * k - 1)
        columns = [total + weight * value for total, value in zip(columns, values, strict=True)]
    columns[-1] += evaluate(motion.rest, {"k": k}, BALLS)
    return columns


def tangent_columns(space: ExactSpace, branch: Branch, point: Sequence[float], k: Fraction) -> list[arb]:
    """The affine function that touches a convex formula at given derivatives; nowhere above it.

    LookupError unless the point gives each of them.
    """
    formula = branch.motion.formula
    used = sorted(formula.names() & ORDERS.keys())
    if len(point) != len(used):
        raise LookupError
    at = {name: ball(value) for name, value in zip(used, point, strict=True)} | {"k": ball(k)}
    columns = [arb(0)] * (space.terms + 1)
    columns[-1] = evaluate(formula, at, BALLS)
    for name in used:
        slope = evaluate(derivative(formula, name), at, BALLS)
        values = space.values(ORDERS[name], k)
        columns = [total + slope * value for total, value in zip(columns, values, strict=True)]
        columns[-1] -= slope * at[name]
    return [branch.sign * value for value in columns]


def tangent_integral(space: ExactSpace, motion: MotionFormula, point: Sequence[float], *, root: bool) -> list[arb]:
    """An affine function that touches the integral of a convex formula, or its root, nearly; nowhere above it.

    The derivatives at the places of the product's rule say near which law. With `root` the formula is the square of one
    whose mean square is meant: that is at least the integral of its tangent times whatever has a square that integrates
    to 1. LookupError unless the point gives every derivative at every place.
    """
    used = sorted(motion.formula.names() & ORDERS.keys())
    laws = space_of(space.problem.basis, space.problem.conditions, symmetric=space.problem.symmetric)
    edges, count = rule_edges(laws, motion), rule_length(laws, motion)
    if len(point) != len(used) * count * (len(edges) - 1):
        raise LookupError
    values = np.array(point).reshape(len(used), -1, count)
    columns = [arb(0)] * (space.terms + 2)
    for ends, i in _within(space, motion, [Fraction(k) for k in edges]):
        degrees = [min(space.degree_of(ORDERS[name]), count - 1) for name in used]
        local = [
            fitted(value_before[i], degree)(_inner((Fraction(edges[i]), Fraction(edges[i + 1])), ends))
            for value_before, degree in zip(values, degrees, strict=True)
        ]
        tangent = _Tangent(on_part(motion.formula, *ends), dict(zip(used, local, strict=True)), ends, root=root)
        several = integrals(tangent.series, tangent.columns(space), ends, ctx.prec // 4, tangent.rough)
        columns = [entry + other for entry, other in zip(columns, several, strict=True)]
    *row, size = columns
    if root:
        return [value / size.sqrt() for value in row]
    return row


def convex_branches(motion: MotionFormula) -> list[MotionFormula] | None:
    """Smooth convex formulas of which a formula is the greatest; None where it is no such maximum."""
    several = [replace(motion, formula=formula) for formula in motion.branches(1.0) or []]
    return several if several and all(branch.curvature.convex for branch in several) else None


def kinked_integral(
    space: ExactSpace, motion: MotionFormula, branches: Sequence[MotionFormula], point: Sequence[float]
) -> list[arb]:
    """An affine lower bound of the integral of a formula that is the greatest of its smooth convex branches.

    On every stretch it is the integral of a tangent of that one which is the greatest there in a law, whose variables
    the point gives: whichever it is, the formula is nowhere below it. LookupError where the point belongs to no such
    row.
    """
    laws = space_of(space.problem.basis, space.problem.conditions, symmetric=space.problem.symmetric)
    if len(point) < laws.terms:
        raise LookupError
    family = integral_rows(laws, motion, "", np.zeros(laws.terms), 0.0, root=False, convex=True)
    if not isinstance(family, KinkedIntegralFamily):
        raise LookupError  # noqa: TRY004 - the point belongs to no such row
    law = np.append(np.array(point[: laws.terms]), 1.0)
    columns = [arb(0)] * (space.terms + 1)
    for stretch in family.split(law[:-1]).stretches:
        # at one of them formulas may be equal: in its middle a symmetric law touches what is a kink elsewhere
        places = stretch.low + (stretch.high - stretch.low) * np.array(_WITHIN)
        names = {**dict(zip(family.names, family.columns_at(places) @ law, strict=True)), "k": places}
        heights = [float(np.sum(branch.values(names))) for branch in branches]
        greatest = branches[heights.index(max(heights))]
        for ends, _ in _within(space, greatest, [Fraction(stretch.low), Fraction(stretch.high)]):
            if greatest.affine is not None:
                several = _weighted(space, greatest, fmpq_poly([1]), ends)
            else:
                tangent = _Tangent(on_part(greatest.formula, *ends), _along(space, family, law, ends), ends, root=False)
                *several, _ = integrals(tangent.series, tangent.columns(space), ends, ctx.prec // 4, tangent.rough)
            columns = [entry + other for entry, other in zip(columns, several, strict=True)]
    return columns


def _along(
    space: ExactSpace, family: KinkedIntegralFamily, law: Array, ends: tuple[Fraction, Fraction]
) -> dict[str, fmpq_poly]:
    """The derivatives of a law between two k, nearly, as polynomials of what runs from -1 to 1 between these."""
    degrees = [space.degree_of(ORDERS[name]) for name in family.names]
    x, _ = legendre.leggauss(max(degrees) + 1)
    low, high = map(float, ends)
    values = family.columns_at(low + (high - low) * (x + 1.0) / 2.0) @ law
    return {name: fitted(*each) for name, *each in zip(family.names, values, degrees, strict=True)}


@dataclass(frozen=True)
class _Tangent:
    """The tangent of a formula along derivatives that are polynomials of what runs from -1 to 1 between two k."""

    formula: Formula
    along: dict[str, fmpq_poly]
    ends: tuple[Fraction, Fraction]
    root: bool

    @kept_property
    def _slopes(self) -> list[Formula]:
        return [derivative(self.formula, name) for name in self.along]

    def columns(self, space: ExactSpace) -> list[list[fmpq_poly]]:
        """The factors of the slopes, the remainder and the formula for each function; the last is for its size."""
        nothing, unit = fmpq_poly([0]), fmpq_poly([1])
        several = [polynomials_between(space, ORDERS[name], self.ends) for name in self.along]
        columns = [[*column, nothing, nothing] for column in zip(*several, strict=True)]
        columns[-1][-2] = unit
        return [*columns, [*[nothing] * (len(several) + 1), unit]]

    def series(self, k: arb_series) -> list[arb_series]:
        """The slopes, the tangent's remainder, and the formula; half the slopes of a square."""
        low, high = self.ends
        local = (k - ball((low + high) / 2)) / ball((high - low) / 2)
        at = {name: composed(function, local) for name, function in self.along.items()}
        value = series_of(self.formula, {**at, "k": k})
        slopes = [series_of(slope, {**at, "k": k}) / (2 if self.root else 1) for slope in self._slopes]
        return [*slopes, value - sum(map(mul, slopes, at.values()), arb_series([0])), value]

    def rough(self, k: arb) -> list[arb]:
        """The row of a tangent that touches at another place; empty for a mean square."""
        if self.root:
            return [arb(0)] * (len(self.along) + 2)
        at = dict.fromkeys(self.along, arb(1))
        try:
            value = evaluate(self.formula, {**at, "k": k}, BALLS)
            slopes = [evaluate(slope, {**at, "k": k}, BALLS) for slope in self._slopes]
        except ValueError:
            return [arb.nan()] * (len(self.along) + 2)
        return [*slopes, value - sum(slopes, arb(0)), value]


def norm_columns(space: ExactSpace, parts: Sequence[MotionFormula], direction: Sequence[float]) -> list[arb]:
    """An affine lower bound of the root of the integrals of squares of affine formulas.

    It is the integral of the formulas times a function whose square integrates to 1: piece by piece the polynomial
    through the direction, which is given at the places of the product's rule, each with the root of its weight.
    LookupError unless the direction has as many components as there are places.
    """
    laws = space_of(space.problem.basis, space.problem.conditions, symmetric=space.problem.symmetric)
    rules = [gauss_parts(laws, motion) for motion in parts]
    if len(direction) != sum(count for rule in rules for _, count in rule):
        raise LookupError
    columns_there, size, left = [arb(0)] * (space.terms + 1), arb(0), list(direction)
    for motion, rule in zip(parts, rules, strict=True):
        inner = [(1 - Fraction(u)) / 2 for _, u in [ends for ends, _ in rule][:-1]]
        edges = [Fraction(motion.start), *inner, Fraction(motion.stop)]
        taken = [[left.pop(0) for _ in range(count)] for _, count in rule]
        factors = [_through(polynomial, edges[i + 1] - edges[i]) for i, polynomial in enumerate(taken)]
        for ends, i in _within(space, motion, edges):
            factor = factors[i](_inner((edges[i], edges[i + 1]), ends))
            square = (factor * factor).integral()
            size += arb((square(fmpq(1)) - square(fmpq(-1))) * rational((ends[1] - ends[0]) / 2))
            several = _weighted(space, motion, factor, ends)
            columns_there = [term + other for term, other in zip(columns_there, several, strict=True)]
    return [value / size.sqrt() for value in columns_there]


def _weighted(
    space: ExactSpace, motion: MotionFormula, factor: fmpq_poly, ends: tuple[Fraction, Fraction]
) -> list[arb]:
    """The integral over a part of an affine formula times a factor, for each function."""
    several = [polynomials_between(space, nu, ends) for nu in motion.weights]
    columns = [[*(factor * entry for entry in column), fmpq_poly([0])] for column in zip(*several, strict=True)]
    columns[-1][-1] = factor
    formulas = [on_part(weight, *ends) for weight in (*motion.weights.values(), motion.rest)]
    return integrals(lambda k: [series_of(formula, {"k": k}) for formula in formulas], columns, ends, ctx.prec // 4)


def _through(values: Sequence[float], length: Fraction) -> fmpq_poly:
    """The polynomial through values that are times the roots of their weights, of what runs from -1 to 1."""
    _, weights = legendre.leggauss(len(values))
    # the solver's places ascend in 1 - 2k
    plain = np.array(values) / np.sqrt(weights * float(length) / 2.0)
    return fitted(plain[::-1], len(values) - 1)


def fitted(values: Array, degree: int) -> fmpq_poly:
    """The polynomial of a degree nearest to values at the places of Gauss's rule, of what runs from -1 to 1.

    >>> [float(coefficient) for coefficient in fitted(np.array([1.0, 1.0, 1.0]), 0).coeffs()]
    [1.0]
    """
    x, weights = legendre.leggauss(len(values))
    factors = (np.arange(degree + 1) + 0.5) * (legendre.legvander(x, degree).T @ (weights * values))
    terms = (rational(float(value)) * fmpq_poly.legendre_p(m) for m, value in enumerate(factors))
    return sum(terms, fmpq_poly([0]))


def _within(
    space: ExactSpace, motion: MotionFormula, edges: Sequence[Fraction]
) -> Iterator[tuple[tuple[Fraction, Fraction], int]]:
    """The parts between edges cut where laws have breaks and what depends on k alone has kinks, with which part."""
    breaks = {*space.breaks, *(1 - k for k in space.breaks)} if space.problem.symmetric else set(space.breaks)
    for i, (low, high) in enumerate(pairwise(edges)):
        inner = {k for k in (*breaks, *kinks(motion)) if low < k < high}
        for ends in pairwise(sorted({low, high, *inner})):
            yield ends, i


def _inner(whole: tuple[Fraction, Fraction], ends: tuple[Fraction, Fraction]) -> fmpq_poly:
    """The local coordinate of the whole interval as a function of a part's local coordinate."""
    low, high = (2 * (k - whole[0]) / (whole[1] - whole[0]) - 1 for k in ends)
    return fmpq_poly([rational((low + high) / 2), rational((high - low) / 2)])


def polynomials_between(space: ExactSpace, nu: int, ends: tuple[Fraction, Fraction]) -> list[fmpq_poly]:
    """Derivatives of the functions as polynomials of what runs from -1 to 1 between two k without a break between them.

    Of symmetric laws the second half is the first one's mirror image.
    """
    low, high = ends
    later = space.problem.symmetric and low + high > 1
    x = fmpq_poly([rational(low + high - 1), rational(high - low)])
    functions = space.derivative(nu)[space.piece(1 - (low + high) / 2 if later else (low + high) / 2)]
    if not later:
        return [function(x) for function in functions]
    functions_mirrored = [function(-x) if nu % 2 else -function(-x) for function in functions]
    if nu == 0:
        functions_mirrored[-1] += 1
    return functions_mirrored
