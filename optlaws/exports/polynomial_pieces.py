"""Laws and motions as polynomials in machine units: exact for piecewise polynomial laws, else within a tolerance."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from math import inf
from typing import Any

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.interpolation import hermite_powers
from optlaws.laws.law import MotionLaw
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.motion.motion import Motion, motion_of_law
from optlaws.motion.piece import Piece
from optlaws.motion.polynomials import PiecewiseMotion, from_exact
from optlaws.numbers import Array, finite, positive
from optlaws.numerics import exact

_POSITION_ROUNDING = 2.0**-50  # of a stroke: positions whose differences make a higher derivative
_PIECES_OF_MOTION = 1e-9  # of the greatest value: what polynomial pieces of a motion are off

#: a stretch of a law: its first and its last k, and powers of k less the first
Stretch = tuple[Fraction, Fraction, Sequence[Fraction]]

_SHORTEST = Fraction(1, 4096)


@dataclass(frozen=True)
class LawSection:
    """A smooth part of a law between two k: with the powers of its own polynomial where that is of low degree."""

    law: MotionLaw
    ends: tuple[float, float]
    exact_powers: tuple[Fraction, ...] | None = None

    def values(self, k: Array, nu: int) -> Array:
        """The derivative of order nu; at the last k, its limit from this side."""
        return np.asarray(self.law(np.minimum(k, self._last), nu))

    def hermite(self, k: Array, orders: int) -> PiecewiseMotion:
        """Polynomials between places that have the law's first derivatives at each of them."""
        values = np.array([self.values(k, nu) for nu in range(orders)])
        if not np.isfinite(values).all():
            raise InputError(
                f"the law has infinite derivatives at k = {float(k[~np.isfinite(values).all(axis=0)][0]):.6g}, which "
                "no polynomial has: take a law of finite acceleration, or a format of points"
            )
        return PiecewiseMotion(k, hermite_powers(k, values))

    def off(self, run: PiecewiseMotion, nu: int) -> float:
        """The deviation of polynomials on this stretch from the law."""
        return run.deviation(self.values, nu).value

    @property
    def _last(self) -> float:
        high = self.ends[1]
        return high if high == 1.0 else float(np.nextafter(high, 0.0))


def is_polynomial(law: MotionLaw) -> bool:
    """Whether a law is piecewise polynomial, so that controllers can execute it without loss."""
    if isinstance(law, PiecewiseLaw):
        return all(isinstance(segment, PolynomialSegment) for segment in law.segments)
    return isinstance(law, PolynomialLaw)


def polynomials_of_law(
    law: MotionLaw, stroke: float = 1.0, time: float = 1.0, *, cancelled: float = inf
) -> PiecewiseMotion:
    """A law of polynomials with its stroke and duration: the same pieces, every coefficient rounded once.

    High powers cancel each other, and with them the digits of whoever evaluates them: pieces whose terms sum up to more
    than `cancelled` strokes are halved, which changes no value.

    >>> from optlaws import smoothstep
    >>> polynomials_of_law(smoothstep(2), stroke=0.5, time=2.0).coefficients
    ((0.0, 0.0, 0.375, -0.125),)
    """
    height, duration = Fraction(finite(stroke, "stroke")), Fraction(positive(time, "time"))
    tame = [part for stretch in stretches(law) for part in _tame(stretch, cancelled)]
    rows = [[height * a / duration**n for n, a in enumerate(powers)] for _, _, powers in tame]
    return from_exact([duration * k for k in (tame[0][0], *(last for _, last, _ in tame))], rows)


def _tame(stretch: Stretch, cancelled: float) -> Iterator[Stretch]:
    """The stretch in parts whose terms are no larger in sum."""
    low, high, powers = stretch
    length = high - low
    if high - low <= _SHORTEST or sum(abs(float(a * length**n)) for n, a in enumerate(powers)) <= cancelled:
        yield stretch
        return
    middle = (low + high) / 2
    yield from _tame((low, middle, powers), cancelled)
    yield from _tame((middle, high, exact.shifted(list(powers), middle - low)), cancelled)


def stretches(law: MotionLaw) -> Iterator[Stretch]:
    """The polynomials of a law in exact arithmetic."""
    if not is_polynomial(law):
        raise InputError("the law is not piecewise polynomial: approximate it by pieces within a stated deviation")
    if isinstance(law, PolynomialLaw):
        yield Fraction(0), Fraction(1), law.exact_powers()
    if isinstance(law, PiecewiseLaw):
        height = Fraction(law.a0)
        for segment, ends in zip(law.segments, pairwise(map(Fraction, law.breaks)), strict=True):
            assert isinstance(segment, PolynomialSegment)  # noqa: S101 - said above
            powers = _powers(segment, ends[1] - ends[0], height)
            yield *ends, powers
            height = sum((a * (ends[1] - ends[0]) ** n for n, a in enumerate(powers)), Fraction(0))


def _powers(segment: PolynomialSegment, length: Fraction, height: Fraction) -> list[Fraction]:
    """Powers of k less the segment's start, of the displacement."""
    acceleration = exact.exact_powers([Fraction(coefficient) for coefficient in segment.acceleration])
    steps = [power / (length**n * (n + 1) * (n + 2)) for n, power in enumerate(acceleration)]
    return [height, Fraction(segment.b0), *steps]


_ORDERS = 4  # derivatives at both ends, so that pieces have the degree 7
_MOST = 4096
_LEAST = 16.0  # terms that sum up to so many strokes are no cause to halve pieces


def pieces_of_motion(motion: Motion, tolerance: float = _PIECES_OF_MOTION) -> PiecewiseMotion:
    """The polynomials of a motion between breaks, in units of its master and slave.

    Where laws do not consist of polynomials, the position is within `tolerance`, a share of the stroke, over the whole
    interval. Polynomials whose powers lose more digits than that are halved, which changes no value.
    """
    share = positive(tolerance, "tolerance")
    parts = [_of_piece(piece, share * motion.stroke) for piece in motion.pieces]
    breaks = [x for part in parts for x in part.breaks[:-1]]
    return PiecewiseMotion([*breaks, motion.stop], [row for part in parts for row in part.coefficients])


def pieces_of_law(law: MotionLaw, tolerance: float = _PIECES_OF_MOTION, **placement: Any) -> PiecewiseMotion:
    """The polynomials of a law with its stroke, time and master, as `motion_of_law` takes them."""
    return pieces_of_motion(motion_of_law(law, **placement), tolerance)


def _of_piece(piece: Piece, tolerance: float) -> PiecewiseMotion:
    if piece.stroke == 0.0:
        return PiecewiseMotion([piece.start, piece.stop], [[piece.offset]])
    if is_polynomial(piece.law):
        cancelled = max(tolerance / (_POSITION_ROUNDING * abs(piece.stroke)), _LEAST)
        return _at_its_place(polynomials_of_law(piece.law, piece.stroke, piece.duration, cancelled=cancelled), piece)
    stretches = [LawSection(piece.law, ends) for ends in pairwise(piece.law.breaks)]
    near = reduce(PiecewiseMotion.then, (_near(stretch, tolerance / abs(piece.stroke)) for stretch in stretches))
    return _at_its_place(near.in_units(piece.duration, piece.stroke), piece)


def _at_its_place(motion: PiecewiseMotion, piece: Piece) -> PiecewiseMotion:
    """The motion where its piece lies: laws begin at 0 and with their own displacement."""
    height = piece.offset - piece.stroke * float(piece.law.a(0.0))
    rows = [(row[0] + height, *row[1:]) for row in motion.coefficients]
    return PiecewiseMotion([piece.start + x for x in motion.breaks], rows)


def _near(stretch: LawSection, tolerance: float) -> PiecewiseMotion:
    """Hermite's polynomials of degree 7 on a stretch; their number is doubled until they are near enough."""
    count = 1
    while count <= _MOST:
        run = stretch.hermite(np.linspace(*stretch.ends, count + 1), _ORDERS)
        if stretch.off(run, 0) <= tolerance:
            return run
        count *= 2
    raise InputError(
        f"{_MOST} polynomials do not come within {tolerance:.3g} of the law near k = {stretch.ends[0]:.6g}: take a "
        "greater tolerance, a law of polynomials, or a format of points"
    )
