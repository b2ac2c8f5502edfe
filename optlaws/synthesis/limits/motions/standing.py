"""What the whole time says of a torque: its mean, and what holds the load while a motion stands still.

Along every motion from rest to rest d(I b) = (I c + I' b²) dt adds up to 0, also while it stands. So the mean of a
torque I c + S b² + R b + T is the integral over the position of

    T/b + R + (S - I') b,

and a mean square is that of tau - m plus 2 m times the mean, less m²; a peak is at least the mean. While a motion
stands its torque is the one that holds the load: where this is nowhere below |m|, standing costs at least what is
taken off, and the time that is given is needed in full.

Behind a gear with losses the torque is the greater of two forms. A mean above 0 is at least that of the first form. Of
one below 0 both forms have their own share of m, such that share times inertia is the same.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import fsum, inf, nextafter
from typing import Any, NamedTuple

import numpy as np

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.tree import Formula, Number, Product, Reciprocal
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval, between, exact
from optlaws.numerics.taylor import variable
from optlaws.synthesis.limits.formula_jets import formula_jet
from optlaws.synthesis.limits.phase_plane import PhasePlane
from optlaws.synthesis.limits.phase_torque import AnyTorque, GearTorque, PhaseTorque
from optlaws.tolerances import ROUNDOFF

_HOLDING_ENCLOSED = 1e-9  # of the torque that holds a load nearest to 0: how narrow its enclosure is

_CELLS, _MOST_CELLS, _HALVINGS, _ORDER = 64, 1024, 24, 2
_PLACES = np.linspace(0.0, 1.0, 1025)


class MeanTerms(NamedTuple):
    """What the mean of a torque adds to the integrand: factors of 1, b and 1/b, as intervals or jets."""

    A: Any
    B1: Any
    L: Any
    slope: Interval  #: that of b is less by this times the derivative of an inertia by a
    inertia: Formula


@dataclass(frozen=True)
class Standing:
    """The mean torque of a plane's motions as a part of a certificate.

    Attributes
    ----------
    plane
        In which a torque is squared, or has a peak that is minimised.
    level
        m: no torque that holds the load is nearer to 0.
    price
        Of the mean torque, where a peak is minimised; of the sign of the torque.
    """

    plane: PhasePlane
    level: float = 0.0
    price: float = 0.0

    @property
    def torque(self) -> AnyTorque | None:
        """The torque whose mean counts; None where none does."""
        if self.plane.kind == "peak":
            return self.plane.peak if self.price else None
        return self.plane.squared if self.level else None

    @property
    def sign(self) -> int:
        """That of the mean torque."""
        return -1 if self.level < 0.0 or self.price < 0.0 else 1

    @kept_property
    def shifted(self) -> PhasePlane:
        """The plane whose squared torque is less by the level."""
        squared = self.plane.squared
        if squared is None or not self.level:
            return self.plane
        off = PhaseTorque(Number(0.0), load=Number(-self.level))
        less = replace(squared, motor=squared.motor.plus(off)) if isinstance(squared, GearTorque) else squared.plus(off)
        return replace(self.plane, squared=less)

    def branch(self, side: int) -> PhasePlane:
        """The plane of one direction of the power, its squared torque less by that direction's share of the level."""
        share = self._share(side)
        if share is None:
            return self.shifted.branches[side]
        plane = self.plane.branches[side]
        if plane.squared is None:
            return plane
        load = Product((Number(-self.level), share))
        return replace(plane, squared=plane.squared.branches[0].plus(PhaseTorque(Number(0.0), load=load)))

    @property
    def same(self) -> bool:
        """Whether both directions of the power have the same terms."""
        torque = self.torque
        return torque is None or self.sign > 0 or len(torque.branches) == 1

    def _share(self, side: int) -> Formula | None:
        """The share of the level in a direction of the power; None where it is the whole."""
        torque = self.torque
        if torque is None or self.same or side:
            return None
        first, last = torque.branches
        return Product((last.inertia, Reciprocal(first.inertia)))

    def _form(self, side: int) -> PhaseTorque:
        torque = self.torque
        assert torque is not None  # noqa: S101 - there are terms of a torque alone
        return torque.branches[0] if self.sign > 0 else torque.branches[min(side, len(torque.branches) - 1)]

    def terms(self, side: int, of: Callable[[Formula], Any]) -> MeanTerms:
        """The terms of the mean torque in a direction of the power, from the values of formulas of a."""
        torque, form, share = self.torque, self._form(side), self._share(side)
        assert torque is not None  # noqa: S101 - there are terms of a torque alone
        # the inertia whose product with the price is that of all directions
        common = form.inertia if self.same else torque.branches[-1].inertia
        S, R, T = (of(factor) for factor in form.factors[1:])
        part: Any = 1.0 if share is None else of(share)
        if self.plane.kind == "peak":
            price, L = exact(np.array(self.price)), T * part - self.level
            return MeanTerms(R * part * price, S * part * price, L * price, price, common)
        heat = exact(np.array(self.plane.heat)) * self.level
        price, L = heat * 2.0, T * part * 2.0 - part * part * self.level - self.level
        return MeanTerms(R * part * price, S * part * price, L * heat, price, common)

    def values(self, side: int, a: Array) -> tuple[Array, Array, Array]:
        """The terms at positions, in doubles: factors of 1, b and 1/b."""
        if self.torque is None:
            return np.zeros_like(a), np.zeros_like(a), np.zeros_like(a)

        def of(formula: Formula) -> Interval:
            return exact(np.broadcast_to(np.asarray(evaluate(formula, {"a": a}, NUMPY), dtype=np.float64), a.shape))

        terms = self.terms(side, of)
        slope = terms.slope.middle * PhaseTorque(terms.inertia).inertia_slope(a)
        return terms.A.middle, terms.B1.middle - slope, terms.L.middle

    @property
    def offset(self) -> Interval:
        """What the integral of the terms is above the mean torque's part, without the price of a peak."""
        level = exact(np.array(self.level))
        return level * self.price if self.plane.kind == "peak" else level * level * self.plane.heat

    @property
    def holds(self) -> bool:
        """Whether no torque that holds the load is nearer to 0 than the level, proven by enclosures."""
        return not self.level or abs(self.level) <= abs(least_holding(self.plane, self.sign))


def standing_level(plane: PhasePlane) -> float:
    """The level of a plane's torque, with the sign of the mean torque; 0 where the load changes its sign, or is 0."""
    sign = standing_sign(plane)
    torque = plane.squared or plane.peak
    if not sign or torque is None:
        return 0.0
    moving = sign * np.asarray(evaluate(torque.branches[0 if sign > 0 else -1].load, {"a": _PLACES}, NUMPY))
    if np.min(moving) <= 0.0:
        return 0.0
    moved = _least([torque.branches[0 if sign > 0 else -1].load], sign)
    return sign * max(min(moved, sign * least_holding(plane, sign)), 0.0)


def standing_sign(plane: PhasePlane) -> int:
    """The sign of the torque of slow motions of a plane; 0 where it changes, or nothing counts one."""
    torque = plane.squared or plane.peak
    if torque is None:
        return 0
    for sign, form in ((1, torque.branches[0]), (-1, torque.branches[-1])):
        if np.min(sign * np.asarray(evaluate(form.load, {"a": _PLACES}, NUMPY))) >= 0.0:
            return sign
    return 0


def least_holding(plane: PhasePlane, sign: int) -> float:
    """The torque nearest to 0 that holds the load at rest, rounded towards 0; 0 where its sign is not the given one."""
    torque = plane.squared or plane.peak
    if torque is None:
        return 0.0
    if plane.holding is not None:
        return sign * max(_least([plane.holding], sign), 0.0)
    return sign * max(_least([branch.load for branch in torque.branches], sign), 0.0)


def _least(formulas: list[Formula], sign: int) -> float:
    """A lower bound of a sign times the greatest of several formulas, over all positions."""
    low = np.linspace(0.0, 1.0, _CELLS + 1)[:-1]
    high, done, top = np.append(low[1:], 1.0), inf, inf
    for halving in range(_HALVINGS):
        below, above = zip(*(_range(formula, sign, low, high) for formula in formulas), strict=True)
        pick = np.max if sign > 0 else np.min  # minus the greatest is the least of those below 0
        least, top = pick(below, axis=0), min(top, float(np.min(pick(above, axis=0))))
        near = least < top - _HOLDING_ENCLOSED * abs(top)
        if halving + 1 == _HALVINGS or 2 * np.count_nonzero(near) > _MOST_CELLS:
            near = np.zeros_like(near)
        done = min(done, float(np.min(least[~near], initial=inf)))
        if not near.any():
            break
        middle = 0.5 * (low[near] + high[near])
        low, high = np.concatenate([low[near], middle]), np.concatenate([middle, high[near]])
    return done


def _range(formula: Formula, sign: int, low: Array, high: Array) -> tuple[Array, Array]:
    """The least of a formula times a sign in cells, and its value in their middles, both from outside."""
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    over = formula_jet(formula, "a", variable(between(low, high), _ORDER)) * float(sign)
    at = formula_jet(formula, "a", variable(exact(middle), 1)) * float(sign)
    with np.errstate(invalid="ignore", over="ignore"):
        steep = (exact(np.maximum(np.abs(at.terms[1].low), np.abs(at.terms[1].high))) * half).high
        bent = (exact(np.maximum(np.abs(over.terms[2].low), np.abs(over.terms[2].high))) * half * half).high
        by_slope = (at.terms[0] - steep * (1.0 + _HOLDING_ENCLOSED) - bent * (1.0 + _HOLDING_ENCLOSED)).low
    return np.fmax(over.terms[0].low, np.where(np.isnan(by_slope), -inf, by_slope)), at.terms[0].high


_WORK_CELLS = 1024
_ROUNDING = 8.0 * ROUNDOFF  # cells are a little wider than they are


def least_energy(plane: PhasePlane) -> float:
    """A lower bound of what is minimised, from the work of every power alone; at least 0 where there is none.

    >>> from optlaws.formulas.reading import read
    >>> lifting = PhaseTorque.of(read("(1 + a)*c + 0.5*b^2 + 3*a^2"))
    >>> round(least_energy(PhasePlane(maxima=((lifting, lifting.scaled(0.5)),), C=9.0)), 8)
    1.0
    """
    works = [
        max(_least_work(plane, branch) for torque in torques for branch in torque.branches) for torques in plane.maxima
    ]
    return fsum(works) if len(works) < 2 or -inf in works else nextafter(fsum(works), -inf)


def _least_work(plane: PhasePlane, torque: PhaseTorque) -> float:
    """A lower bound of the integral of a torque over the position, by Taylor's formula in cells."""
    if torque == PhaseTorque(Number(0.0)):
        return 0.0
    ends = np.unique(np.concatenate([np.linspace(0.0, 1.0, _WORK_CELLS + 1), plane.kinks]))
    low, high = ends[:-1], ends[1:]
    middle, half = 0.5 * (low + high), exact(0.5 * (high - low) * (1.0 + _ROUNDING))
    cells, most = variable(between(low, high), 2), plane.greatest_velocity
    at, over = formula_jet(torque.load, "a", variable(exact(middle), 1)), formula_jet(torque.load, "a", cells)
    inertia, square, drag = (formula_jet(factor, "a", cells) for factor in torque.factors[:3])
    rest = (square.terms[0] - inertia.terms[1] * 0.5).low
    rubs = float(np.min(drag.terms[0].low))
    with np.errstate(invalid="ignore", over="ignore"):
        by_taylor = (at.terms[0] + over.terms[2] * half * half * (1.0 / 3.0)).low
        load = np.fmax(np.where(np.isfinite(by_taylor), by_taylor, -inf), over.terms[0].low)
        of_square = np.where(rest < 0.0, rest * most * most * (1.0 + _ROUNDING), 0.0)
        parts = ((exact(load) + of_square) * half * 2.0).low
    if not np.isfinite(parts).all():
        return -inf
    rounding = _ROUNDING * fsum(np.abs(parts).tolist())
    return nextafter(fsum(parts.tolist()) - rounding + (rubs if rubs >= 0.0 else rubs * most), -inf)
