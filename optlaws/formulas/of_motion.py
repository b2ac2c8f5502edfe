"""Formulas of a motion: of the law a, its derivatives b, c, j, its power d = b c, and the dimensionless time k."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache, partial, reduce
from itertools import combinations
from math import prod
from typing import Any

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, Together, evaluate, step_value
from optlaws.formulas.branches import branches
from optlaws.formulas.convexity import Affine, Curvature, Judge, Verdict, affine, degree
from optlaws.formulas.reading import read, refused
from optlaws.formulas.slopes import added, constant, opposite, scaled
from optlaws.formulas.tree import (
    ORDERS,
    VOCABULARY,
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
    substituted,
)
from optlaws.kept import kept_property
from optlaws.numbers import Array, power_of_two
from optlaws.numerics.chebyshev import interpolated, real_parts_of_roots

#: second derivatives of a product grow with the square of their number
_FACTORS = 24

_POWER = Product((Name("b"), Name("c")))
_LATER = added([Number(1.0), opposite(Name("k"))])
_MIRRORED: dict[str, Formula] = {"k": _LATER, "a": added([Number(1.0), opposite(Name("a"))]), "c": opposite(Name("c"))}


@dataclass(frozen=True)
class MotionFormula:
    """A formula of a motion, over a part of the interval of k.

    >>> motion = of_text("c + 0.2*b")
    >>> motion.curvature.value, {nu: str(weight) for nu, weight in motion.weights.items()}
    ('affine', {2: '1', 1: '0.2'})
    """

    formula: Formula  #: in a, b, c, j and k
    start: float = 0.0
    stop: float = 1.0

    @kept_property
    def affine(self) -> Affine | None:
        """The formula as an affine function of the law and its derivatives; None where it is not affine."""
        return affine(self.formula, ORDERS)

    @property
    def weights(self) -> dict[int, Formula]:
        """The factors of an affine formula by order of derivative; empty where it is not affine."""
        return {} if self.affine is None else {ORDERS[name]: factor for name, factor in self.affine.factors}

    @property
    def rest(self) -> Formula:
        """The part of an affine formula without the law; 0 where it is not affine."""
        return Number(0.0) if self.affine is None else self.affine.rest

    @property
    def orders(self) -> tuple[int, ...]:
        """The orders of the derivatives in it, ascending."""
        return tuple(sorted(ORDERS[name] for name in self.formula.names() if name in ORDERS))

    @kept_property
    def verdict(self) -> Verdict:
        """The verdict on its convexity at every k of its part, with the rule that shows it."""
        return _verdict(self.formula, self.start, self.stop)

    @property
    def curvature(self) -> Curvature:
        return self.verdict.curvature

    def branches(self, sign: float) -> list[Formula] | None:
        """Smooth formulas of which it, times the sign, is the greatest; None where it is no such maximum."""
        judge = Judge(frozenset(ORDERS), self.start, self.stop)
        return branches(self.formula if sign > 0.0 else Negative(self.formula), ORDERS, judge.sign)

    def mirrored(self) -> MotionFormula:
        """The formula for a symmetric law on the other side: a(1-k) = 1 - a(k), b and j even, c odd about 1/2."""
        return MotionFormula(substituted(self.formula, _MIRRORED), 1.0 - self.stop, 1.0 - self.start)

    def halves(self) -> tuple[MotionFormula, ...]:
        """The formulas on k <= 1/2 alone that mean the same for a symmetric law."""
        if self.stop <= 0.5:
            return (self,)
        if self.start >= 0.5:
            return (self.mirrored(),)
        return replace(self, stop=0.5), replace(self, start=0.5).mirrored()

    def values(self, names: Mapping[str, Any]) -> Array:
        """Its values where a, b, c, j and k have theirs."""
        with np.errstate(all="ignore"):
            return np.asarray(evaluate(self.formula, names, NUMPY), dtype=np.float64)

    def constant_weights(self) -> tuple[dict[int, float], float] | None:
        """The factors and the rest of an affine formula as numbers; None where one depends on k."""
        constants = {nu: constant(weight) for nu, weight in self.weights.items()}
        rest = constant(self.rest)
        if rest is None or None in constants.values():
            return None
        return {nu: value for nu, value in constants.items() if value is not None}, rest

    def degree(self, orders: Mapping[str, int], *, between_kinks: bool = False) -> int | None:
        """The degree in k where a, b, c, j have these, everywhere or between kinks; None where it is no polynomial."""
        return degree(self.formula, {**orders, "k": 1}, between_kinks=between_kinks)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The kinks strictly within the part."""
        return tuple(k for k in self.kinks if self.start < k < self.stop)

    @kept_property
    def scale(self) -> float:
        """The size of the formula in smooth laws: a power of 2 near its parts there, never 0.

        >>> of_text("c").scale, of_text("2^-40*c").scale * 2.0**40, of_text("c - j").scale
        (4.0, 4.0, 64.0)
        """
        k = np.linspace(self.start, self.stop, _LOOKS)
        moved = {
            "a": k,
            "b": 30.0 * (k * (1 - k)) ** 2,
            "c": 60.0 * k * (1 - k) * (1 - 2 * k),
            "j": 60.0 - 360.0 * k * (1 - k),
        }
        with np.errstate(all="ignore"):
            sizes = _magnitudes(self.formula, {**_REACHED, "k": k}, {**moved, "k": k})
        return power_of_two(float(np.max(sizes, where=np.isfinite(sizes), initial=0.0)))

    def scaled(self, factor: float) -> MotionFormula:
        """A factor above 0 times the formula."""
        return replace(self, formula=scaled(self.formula, factor))

    @kept_property
    def kinks(self) -> tuple[float, ...]:
        """The k strictly between 0 and 1 at which a factor is not smooth, ascending."""
        places: set[float] = set()
        for part in self.formula.different:
            if isinstance(part, Table) and not part.names() & ORDERS.keys():
                places.update(self._knots(part))
            if isinstance(part, Call) and part.function in {"abs", "max", "min"} and not part.names() & ORDERS.keys():
                places.update(self._kinks(part))
        return tuple(sorted(k for k in places if 0.0 < k < 1.0))

    def _knots(self, table: Table) -> list[float]:
        of = affine(table.of, ("k",))
        slope = None if of is None else constant(dict(of.factors).get("k", Number(0.0)))
        rest = None if of is None else constant(of.rest)
        if not slope or rest is None:
            raise InputError(f"a table over k must be of k itself or of a multiple and a shift of it, got {table.of}")
        return [(place - rest) / slope for place in table.places]

    def _kinks(self, call: Call) -> list[float]:
        pairs = combinations(call.arguments, 2)
        parts = (
            call.arguments if call.function == "abs" else [added([first, opposite(second)]) for first, second in pairs]
        )
        places: list[float] = []
        for part in parts:
            if not part.names():
                continue
            series = interpolated(partial(_along, MotionFormula(part)), str(part))
            places += ((1.0 + real_parts_of_roots(series)) / 2.0).tolist()
        return places


@lru_cache(maxsize=64)
def _verdict(formula: Formula, start: float, stop: float) -> Verdict:
    return Judge(frozenset(ORDERS), start, stop).verdict(formula)


#: what a, b, c and j reach in a smooth law from rest to rest, and at how many k a formula is looked at
_REACHED = {"a": 1.0, "b": 2.0, "c": 6.0, "j": 60.0}
_LOOKS = 33


def _magnitudes(formula: Formula, names: Mapping[str, Any], at: Mapping[str, Any]) -> Array:
    """The size of a formula's parts at some places, without regard to signs; in another unit it is that times as much.

    `names` are what the derivatives reach anywhere, `at` what they are there.
    """
    sizes, values = list[Array](), list[Any]()
    for part, places, _ in formula.steps:
        values.append(step_value(part, [values[place] for place in places], at, NUMPY))
        if isinstance(part, Name | Number):
            sizes.append(np.asarray(np.abs(evaluate(part, names, NUMPY))))
        else:
            sizes.append(
                _magnitude(part, [sizes[place] for place in places], [values[place] for place in [*places, -1]])
            )
    return sizes[-1]


def _magnitude(formula: Formula, parts: list[Array], values: list[Any]) -> Array:
    """The size of a formula from those of its parts, and from their values, of which the last is its own."""
    if isinstance(formula, Negative):
        return parts[0]
    if isinstance(formula, Sum):
        return np.asarray(sum(parts))
    if isinstance(formula, Product):
        return np.asarray(prod(parts))
    if isinstance(formula, Reciprocal):
        return 1.0 / parts[0]
    if isinstance(formula, Exponentiation):
        return np.asarray(parts[0] ** values[1])
    if isinstance(formula, Call) and formula.function in {"abs", "norm"}:
        return np.asarray(reduce(np.maximum, parts))
    there = np.asarray(np.abs(values[-1]))
    # at rest a formula may be 0 that is not elsewhere
    return there if np.any(there) or not parts else np.asarray(reduce(np.maximum, parts))


def _along(motion: MotionFormula, x: Array) -> Array:
    """Values at k = (1 + x)/2."""
    return np.broadcast_to(motion.values({"k": (1.0 + x) / 2.0}), np.shape(x))


@lru_cache(maxsize=16)
def of_text(text: str, start: float = 0.0, stop: float = 1.0) -> MotionFormula:
    """The formula of a text, over a part of the interval.

    >>> of_text("d + 1/(k - 0.5)")
    Traceback (most recent call last):
    optlaws.formulas.reading.FormulaError: k - 0.5 is 0 within k = 0..1, and it is divided by
      d + 1/(k - 0.5)
           ^
    """
    return checked(MotionFormula(read(text, VOCABULARY), start, stop), text)


def checked(motion: MotionFormula, text: str) -> MotionFormula:
    """The formula with d written as b c, if it has a value for every k."""
    for part in motion.formula.different:
        if (
            isinstance(part, Product)
            and sum(bool(factor.names() & {*ORDERS, "d"}) for factor in part.factors) > _FACTORS
        ):
            raise refused(f"a product may have {_FACTORS} factors that depend on the law", text, part)
    k = np.linspace(motion.start, motion.stop, 1025)
    still = tuple(part for part in motion.formula.different if not part.names() & {*ORDERS, "d"})
    with np.errstate(all="ignore"):
        values = dict(zip(still, map(np.asarray, Together(still).values({"k": k}, NUMPY)), strict=True))
    for part in still:
        beneath = divisor(part)
        if beneath is None:
            continue
        below = values[beneath] if beneath in values else MotionFormula(beneath).values({"k": k})
        if not ((below == 0.0).any() or np.min(below) < 0.0 < np.max(below)):
            continue
        where = f" within k = {motion.start:g}..{motion.stop:g}" if "k" in part.names() else ""
        if isinstance(part, Reciprocal):
            raise refused(f"{part.of} is 0{where}, and it is divided by", text, part)
        raise refused(f"{part} has no finite value{where}", text, part)
    for part in still:
        finite = np.broadcast_to(np.isfinite(values[part]), k.shape)
        if not finite.all():
            raise refused(f"{part} has no finite value at k = {k[~finite][0]:.4g}", text, part)
    return replace(motion, formula=substituted(motion.formula, {"d": _POWER}))


def divisor(part: Formula) -> Formula | None:
    """What a part divides by, itself or in a tangent; None where it divides by nothing.

    >>> divisor(read("tan(a)")), divisor(Reciprocal(Name("b")))
    (cos(a), b)
    """
    if isinstance(part, Reciprocal):
        return part.of
    return Call("cos", part.arguments) if isinstance(part, Call) and part.function == "tan" else None
