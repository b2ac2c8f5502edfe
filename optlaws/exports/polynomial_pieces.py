"""Motions as polynomials in machine units: the laws' own, else Hermite's as near as a tolerance or a target asks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass, replace
from fractions import Fraction
from heapq import heapify, heapreplace
from itertools import pairwise
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.error_bounds import SINGLE, error_bounds
from optlaws.exports.format import BEST, Request
from optlaws.exports.text import Labels, iec_comment, program_heading, rounded_column, rounded_up
from optlaws.files.writing import MARK
from optlaws.laws.law import MotionLaw
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.motion.motion import Motion, motion_of_law
from optlaws.motion.piece import Piece
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numbers import Array, positive
from optlaws.numerics import exact
from optlaws.numerics.splines import hermite_powers

_POSITION_ROUNDING = 2.0**-50  # of a stroke: positions whose differences make a higher derivative
_PIECES_OF_MOTION = 1e-9  # of the greatest value: what polynomial pieces of a motion are off
_ACCELERATION_HIGHER = 1e-3  # of the peak: how far a run's may be above the motion's

_POLYNOMIAL_ROUNDING = 1e-9  # of a derivative: where polynomials of a controller meet

#: how far the run's peak of the acceleration may be above the motion's, and its acceleration off it, as shares
OFF = 1e-2
_SHORT = 10
_SHORTEST = Fraction(1, 4096)
_ORDERS = 4  # derivatives at both ends, so that pieces have the degree 7
_MOST = 4096
_LEAST = 16.0  # terms that sum up to so many strokes are no cause to halve pieces

#: a stretch of a law: its first and its last k, and powers of k less the first
Stretch = tuple[Fraction, Fraction, Sequence[Fraction]]


def stretches(law: MotionLaw) -> Iterator[Stretch]:
    """The polynomials of a law in exact arithmetic; none of a law that is not piecewise polynomial."""
    if isinstance(law, PolynomialLaw):
        yield Fraction(0), Fraction(1), law.exact_powers()
    if isinstance(law, PiecewiseLaw) and all(isinstance(segment, PolynomialSegment) for segment in law.segments):
        height = Fraction(law.a0)
        for segment, ends in zip(law.segments, pairwise(map(Fraction, law.breaks)), strict=True):
            assert isinstance(segment, PolynomialSegment)  # noqa: S101 - said above
            length = ends[1] - ends[0]
            acceleration = exact.exact_powers([Fraction(coefficient) for coefficient in segment.acceleration])
            steps = (power / (length**n * (n + 1) * (n + 2)) for n, power in enumerate(acceleration))
            powers = [height, Fraction(segment.b0), *steps]
            yield *ends, powers
            height = sum((a * length**n for n, a in enumerate(powers)), Fraction(0))


@dataclass
class _Section:
    """A smooth part of a piece of a motion: powers of k less its first where they are taken, else near polynomials."""

    piece: Piece
    ends: tuple[float, float]
    powers: Sequence[Fraction] | None
    run: PiecewiseMotion | None = None

    def values(self, k: Array, nu: int) -> Array:
        """The derivative of the law; at the last k, its limit from this side."""
        high = self.ends[1]
        return np.asarray(self.piece.law(np.minimum(k, high if high == 1.0 else np.nextafter(high, 0.0)), nu))

    def interpolate(self, count: int, orders: int) -> None:
        """Lay polynomials between equal steps, which have the law's first derivatives at each of them."""
        k = np.linspace(*self.ends, count + 1)
        values = np.array([self.values(k, nu) for nu in range(orders)])
        if not np.isfinite(values).all():
            raise InputError(
                f"the law has infinite derivatives at k = {float(k[~np.isfinite(values).all(axis=0)][0]):.6g}, which "
                "no polynomial has: take a law of finite acceleration, or a format of points"
            )
        self.run = PiecewiseMotion(k, hermite_powers(k, values))

    def off(self, nu: int) -> float:
        """The deviation of the derivative of order nu from the motion's."""
        if self.run is None:
            return 0.0
        return abs(self.piece.stroke) / self.piece.duration**nu * self.run.deviation(self.values, nu).value

    def polynomials(self) -> Iterator[tuple[Fraction, list[Fraction]]]:
        """Where each polynomial begins, and its powers, in units of the motion."""
        piece, rows = self.piece, [(Fraction(self.ends[0]), self.powers or [Fraction(0)])]
        if self.run is not None:
            rows = [
                (Fraction(low), list(map(Fraction, row)))
                for low, row in zip(self.run.breaks, self.run.coefficients, strict=False)
            ]
        stroke, duration = Fraction(piece.stroke), Fraction(piece.duration)
        height = Fraction(piece.offset) - stroke * Fraction(float(piece.law.a(0.0)))
        for low, powers in rows:
            first, *others = (stroke * c / duration**n for n, c in enumerate(powers))
            yield Fraction(piece.start) + duration * low, [first + height, *others]


def _sections(motion: Motion, degree: float) -> list[_Section]:
    """The smooth parts of a motion's pieces, with the laws' own polynomials to a degree."""
    sections = []
    for piece in motion.pieces:
        polynomials = list(stretches(piece.law)) if piece.stroke else [(Fraction(0), Fraction(1), [Fraction(0)])]
        sections += [
            _Section(piece, (float(low), float(high)), powers if len(powers) <= degree + 1 else None)
            for low, high, powers in polynomials
        ] or [_Section(piece, ends, None) for ends in pairwise(piece.law.breaks)]
    return sections


def _cut(section: _Section, count: int) -> Iterator[_Section]:
    """Equal parts of a section whose powers are taken, which changes no value."""
    powers = list(section.powers or ())
    for low, high in pairwise(np.linspace(*section.ends, count + 1).tolist()):
        by = Fraction(low) - Fraction(section.ends[0])
        yield _Section(section.piece, (low, high), exact.shifted(powers, by))


def _joined(motion: Motion, sections: Sequence[_Section]) -> PiecewiseMotion:
    pairs = [pair for section in sections for pair in section.polynomials()]
    rows = [[float(c) for c in row] for _, row in pairs]  # every number is rounded once
    return PiecewiseMotion([*(float(low) for low, _ in pairs), motion.stop], rows)


def pieces_of_motion(motion: Motion, tolerance: float = _PIECES_OF_MOTION) -> PiecewiseMotion:
    """The polynomials of a motion between breaks, in units of its master and slave, every number rounded once.

    Where laws do not consist of polynomials, the position is within `tolerance`, a share of the stroke, over the whole
    interval. Polynomials whose powers lose more digits than that are halved, which changes no value.
    """
    allowed = positive(tolerance, "tolerance") * motion.stroke
    return _joined(motion, [part for section in _sections(motion, np.inf) for part in _near(section, allowed)])


def pieces_of_law(law: MotionLaw, tolerance: float = _PIECES_OF_MOTION, **placement: Any) -> PiecewiseMotion:
    """The polynomials of a law with its stroke, time and master, as `motion_of_law` takes them."""
    return pieces_of_motion(motion_of_law(law, **placement), tolerance)


def _near(section: _Section, allowed: float) -> Iterator[_Section]:
    """A section in parts whose powers are no larger in sum, or with polynomials that are near enough."""
    if section.powers is not None:
        length = Fraction(section.ends[1]) - Fraction(section.ends[0])
        terms = sum(abs(float(a * length**n)) for n, a in enumerate(section.powers))
        stroke = abs(section.piece.stroke)
        if stroke and length > _SHORTEST and terms > max(allowed / (_POSITION_ROUNDING * stroke), _LEAST):
            for part in _cut(section, 2):
                yield from _near(part, allowed)
        else:
            yield section
        return
    for halvings in range(_MOST.bit_length()):
        section.interpolate(2**halvings, _ORDERS)
        if section.off(0) <= allowed:
            yield section
            return
    raise InputError(
        f"{_MOST} polynomials do not come within {allowed / abs(section.piece.stroke):.3g} of the law near "
        f"k = {section.ends[0]:.6g}: take a greater tolerance, a law of polynomials, or a format of points"
    )


@dataclass(frozen=True)
class Fitted:
    """Polynomials of a motion over its master: the laws' own, each number rounded once, where `exact`.

    `deviation` and `acceleration` are how far position and acceleration are off at most, in units of the motion.
    """

    run: PiecewiseMotion
    exact: bool
    deviation: float
    acceleration: float

    @property
    def count(self) -> int:
        return len(self.run.coefficients)

    def in_words(self, unit: str) -> str:
        """The accuracy of the polynomials, in the words of headings."""
        if self.exact:
            return "exact: the polynomials are the law's own, every number rounded once"
        return f"approximated: position within {self.deviation:.3g} {unit} of the law, over the whole motion"


def _fit(motion: Motion, sections: Sequence[_Section]) -> Fitted:
    off = (max(section.off(nu) for section in sections) for nu in (0, 2))
    return Fitted(_joined(motion, sections), all(section.run is None for section in sections), *off)


def fitted(motion: Motion, degree: int, most: int, count: int | None = None, *, near: float = OFF) -> Fitted:
    """Polynomials of a degree from 3 to 9 for a motion: its own where they are low enough, else Hermite's.

    Where laws are polynomials of at most the degree they are taken as they are. Elsewhere polynomials of the greatest
    odd degree have the law's derivatives at both ends, and one more is laid where the acceleration is furthest from the
    law's, until its peak is within a thousandth of the motion's and it is nowhere off by more than a share `near` of
    that, or until there are as many as `count`; the target takes at most `most`.
    """
    sections = _sections(motion, degree)
    if len(sections) > (most if count is None else count):
        request = f"and the target holds {most}" if count is None else f"more than the {count} that were requested"
        raise InputError(f"the motion has {len(sections)} pieces of its own, {request}: export its parts")
    approximated = [section for section in sections if section.powers is None]
    peak = motion.peak(2) if approximated else 0.0
    if not np.isfinite(peak):
        raise InputError("the acceleration of the motion has no bound, as where the velocity jumps: smooth it first")

    def rank(place: int) -> tuple[float, int]:
        """A section's place behind its accuracy, below -1 where that is too little, with one polynomial more."""
        section = approximated[place]
        section.interpolate(1 if section.run is None else len(section.run.coefficients) + 1, (degree + 1) // 2)
        assert section.run is not None  # noqa: S101 - it was laid
        height = abs(section.piece.stroke) / section.piece.duration**2 * section.run.peak(2).value
        return -max(height / ((1.0 + _ACCELERATION_HIGHER) * peak), section.off(2) / (near * peak)), place

    worst = [rank(place) for place in range(len(approximated))]
    heapify(worst)
    for _ in range((most if count is None else count) - len(sections)):
        if not worst or (count is None and worst[0][0] >= -1.0):
            break
        heapreplace(worst, rank(worst[0][1]))
    if worst and count is None and worst[0][0] < -1.0:
        raise InputError(
            "the pieces that the target holds do not bring the acceleration within a thousandth of its peak: say how "
            "many to use in any case (points=...), or export parts"
        )
    joined = _fit(motion, sections)
    if joined.count > most:
        raise InputError(f"{joined.count} pieces are needed, and the target holds {most}: export the motion in parts")
    return replace(joined, run=_as_printed(joined.run))


def _as_printed(run: PiecewiseMotion) -> PiecewiseMotion:
    """Polynomials with the breaks and powers that files have: with 15 digits, beyond which doubles are rounded.

    A power is 0 that is no more than rounding beside the others of its order, and in the positions of its piece.
    """
    size, position = max(map(len, run.coefficients)), run.peak(0).value
    greatest = [max(abs(row[n]) for row in run.coefficients if n < len(row)) for n in range(size)]
    rows = [
        [
            0.0 if abs(power) <= _POSITION_ROUNDING * min(greatest[n], position / length**n) else float(f"{power:.15g}")
            for n, power in enumerate(row)
        ]
        for row, length in zip(run.coefficients, run.lengths.tolist(), strict=True)
    ]
    return PiecewiseMotion(rounded_column(np.array(run.breaks)), rows)


def exactly(motion: Motion, degree: int) -> Fitted | None:
    """The own polynomials of laws to a degree, cut where their powers would lose digits; None where laws are none.

    A polynomial of degree n in powers of k has terms far above its values; on a part of the interval, in powers of x
    less its start, they are as small as these.
    """
    parts: list[_Section] = []
    for section in _sections(motion, degree):
        if section.powers is None:
            return None
        size = len(section.powers)
        parts += _cut(section, 1 if size <= _SHORT else ceil(size / 3))
    return _fit(motion, parts)


def polynomials_for(
    motion: Motion, request: Request, degree: int, most: int, *, points: bool = False, near: float = OFF
) -> Fitted:
    """Polynomials up to a degree: a given number, or as few as the accuracy `near` of the acceleration needs.

    The request's `points` are segments, or points, of which there is one more, where `points` says so.
    """
    if request.points is None:
        return fitted(motion, degree, most, near=near)
    if request.points == BEST:
        # said for one version more, in which scripts may still have it
        raise InputError(
            "points: 'best' is of tables of points: leave points out for the fewest polynomials that keep the "
            "acceleration within a thousandth of its peak, or give their number"
        )
    count = int(request.points) - points
    if count > most:
        raise InputError(f"points must be at most {most + points}, which the target holds, got {request.points}")
    return fitted(motion, degree, most, count)


def labels_of(motion: Motion, notes: Sequence[str] = ()) -> Labels:
    """Units of a motion, and notes, for comments."""
    master, slave, rate = astuple(motion.units)
    speed = [] if rate is None or master == "s" else [f"the master goes {rate:.9g} {master}/s"]
    return Labels(master, slave, (*speed, *motion.proof, *notes))


def iec_heading(title: str, motion: Motion, run: PiecewiseMotion, notes: Sequence[str]) -> str:
    """The comment at the head of a program in a language of IEC 61131-3."""
    return iec_comment((title, *program_heading(run, labels_of(motion, notes), []), MARK))


def jumps_of_single(motion: Motion, run: PiecewiseMotion) -> tuple[tuple[float, ...], str]:
    """The greatest jumps of velocity, acceleration and jerk that REAL32 makes where polynomials meet, and in words."""
    jumps, units = tuple(2.0 * bound for bound in error_bounds(run, SINGLE)[1:]), labels_of(motion)
    words = ", ".join(f"{rounded_up(jump)} {units.unit(nu)}" for nu, jump in enumerate(jumps, start=1))
    return jumps, f"jumps at joints by at most {words} come from the rounding to REAL32"


class Ends(NamedTuple):
    """A piece by its ends: places of the master, and y, V, A, ... just inside each."""

    x: tuple[float, float]
    first: tuple[float, ...]
    last: tuple[float, ...]


def ends_of(motion: Motion, run: PiecewiseMotion, orders: int) -> list[Ends]:
    """Pieces by their ends; where nothing but rounding jumps both sides of a joint have the same values.

    Positions that powers end at miss by their roundings; what the next piece begins with, and the motion's own end,
    do not.
    """
    firsts, lasts = [], []
    for nu in range(orders):
        first, ends_here = run.ends(nu)
        known = np.append(first[1:], motion.ends(nu)[1])
        last = np.where(np.abs(known - ends_here) <= rounding(run, nu), known, ends_here)
        begins, ends = rounded_column(np.array([first, last])).tolist()
        firsts.append(begins)
        lasts.append(ends)
    places = zip(run.breaks, run.breaks[1:], strict=False)
    return [Ends(*joint) for joint in zip(places, zip(*firsts, strict=True), zip(*lasts, strict=True), strict=True)]


def rounding(run: PiecewiseMotion, nu: int) -> float:
    """The greatest jump of the derivative of order nu that is no more than rounding."""
    size = max(abs(extreme.value) for extreme in run.extremes(nu))
    # positions are rounded, and what is left of that in a derivative grows as pieces get shorter
    return float(max(_POLYNOMIAL_ROUNDING * size, 2.0**-44 * run.peak(0).value / float(run.lengths.min()) ** nu))


def jumping(run: PiecewiseMotion, nu: int) -> float | None:
    """The first break where the derivative of order nu jumps by more than rounding; None without such a break."""
    jumps = np.flatnonzero(np.abs(run.jumps(nu)) > rounding(run, nu))
    return run.breaks[1 + int(jumps[0])] if jumps.size else None


def refuse_jumps(motion: Motion, run: PiecewiseMotion, holder: str, remedy: str) -> None:
    """Refuse polynomials whose velocity or acceleration jumps, for what holds one value of each at a point."""
    for nu, quantity in ((1, "velocity"), (2, "acceleration")):
        x = jumping(run, nu)
        if x is not None:
            place = f"x = {x:.9g} {motion.units.master}"
            raise InputError(f"the {quantity} jumps at {place}, and {holder} holds one value of it: {remedy}")
