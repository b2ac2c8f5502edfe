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
from functools import reduce
from math import fsum, inf, nextafter
from typing import Any, NamedTuple

import numpy as np

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.jets import formula_jet
from optlaws.formulas.tree import Formula, Number, Product, Reciprocal
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.branch_and_bound import extremes, integral
from optlaws.numerics.interval import Interval, exact
from optlaws.numerics.taylor import Jet, variable
from optlaws.synthesis.limits.phase_plane import AnyTorque, GearTorque, PhasePlane, PhaseTorque
from optlaws.tolerances import ROUNDOFF

_ENCLOSED = 1e-12  # of a load's greatest magnitude: how near bounds of its least and of its work come

_CELLS = 64
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

    def greatest(a: Interval, order: int) -> Jet:
        return reduce(Jet.maximum, [formula_jet(formula, "a", variable(a, order)) for formula in formulas])

    known = extremes(greatest, [0.0, 1.0], parts=_CELLS, share=_ENCLOSED)
    return known.low if sign > 0 else -known.high


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
    """A lower bound of the integral of a torque over the position: of its load, and of what b² and b may take off."""
    if torque == PhaseTorque(Number(0.0)):
        return 0.0
    edges, most = [0.0, *plane.kinks, 1.0], plane.greatest_velocity

    def load(a: Interval, order: int) -> Jet:
        return formula_jet(torque.load, "a", variable(a, order))

    def square(a: Interval, order: int) -> Jet:
        return formula_jet(torque.square, "a", variable(a, order))

    def rest(a: Interval, order: int) -> Jet:
        return square(a, order) - formula_jet(torque.inertia, "a", variable(a, order + 1)).slope() * 0.5

    rubs = extremes(lambda a, order: formula_jet(torque.drag, "a", variable(a, order)), edges).low
    least = integral(load, edges, share=_ENCLOSED)[0]
    # where b² takes off what the inertia gives, what is left is rounding, whose sign no cells settle
    taken_off, most_square = min(extremes(rest, edges).low, 0.0), extremes(square, edges, magnitude=True).peak
    if taken_off < -_ENCLOSED * most_square:
        taken_off = integral(lambda a, order: -(-rest(a, order)).maximum(0.0), edges, share=_ENCLOSED)[0]
    parts = [least, rubs if rubs >= 0.0 else rubs * most, taken_off * most * most if taken_off else 0.0]
    if not np.isfinite(parts).all():
        return -inf
    return nextafter(fsum(parts) - 4.0 * ROUNDOFF * fsum(map(abs, parts[1:])), -inf)
