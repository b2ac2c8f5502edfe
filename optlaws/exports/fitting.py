"""Motions as few polynomials of a degree that a target takes: exact where they can be, else near, and how near."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from heapq import heapify, heappop, heappush
from itertools import pairwise
from math import ceil

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.polynomial_pieces import LawSection, is_polynomial, stretches
from optlaws.motion.motion import Motion
from optlaws.motion.piece import Piece
from optlaws.motion.polynomials import PiecewiseMotion, from_exact
from optlaws.numerics import exact

_ACCELERATION_HIGHER = 1e-3  # of the peak: how far a run's may be above the motion's

#: how far the run's peak of the acceleration may be above the motion's, and its acceleration off it, as shares
OFF = 1e-2
_SHORT = 10


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
        """How many polynomials there are."""
        return len(self.run.coefficients)

    def in_words(self, unit: str) -> str:
        """The accuracy of the polynomials, in the words of headings."""
        if self.exact:
            return "exact: the polynomials are the law's own, every number rounded once"
        return f"approximated: position within {self.deviation:.3g} {unit} of the law, over the whole motion"


@dataclass(order=True)
class _FittedSection:
    """A stretch with its polynomials; stretches with the greatest deviation come first."""

    rank: float
    place: int
    piece: Piece = field(compare=False)
    stretch: LawSection = field(compare=False)
    run: PiecewiseMotion | None = field(compare=False, default=None)

    def split(self, orders: int, peak: float, near: float) -> None:
        """Lay one polynomial more through the stretch of a motion whose acceleration has a peak."""
        count = 1 if self.run is None else len(self.run.coefficients) + 1
        self.run = self.stretch.hermite(np.linspace(*self.stretch.ends, count + 1), orders)
        height = abs(self.piece.stroke) / self.piece.duration**2 * self.run.peak(2).value
        self.rank = -max(height / ((1.0 + _ACCELERATION_HIGHER) * peak), self.off(2) / (near * peak))

    def off(self, nu: int) -> float:
        """The deviation of its derivative of order nu from the motion's derivative."""
        if self.run is None:
            return 0.0
        return abs(self.piece.stroke) / self.piece.duration**nu * self.stretch.off(self.run, nu)

    @property
    def count(self) -> int:
        return 1 if self.run is None else len(self.run.coefficients)


def fitted(motion: Motion, degree: int, most: int, count: int | None = None, *, near: float = OFF) -> Fitted:
    """Polynomials of a degree from 3 to 9 for a motion: its own where they are low enough, else Hermite's.

    Where laws are polynomials of at most the degree they are taken as they are. Elsewhere polynomials of the greatest
    odd degree have the law's derivatives at both ends, and one more is laid where the acceleration is furthest from the
    law's, until its peak is within a thousandth of the motion's and it is nowhere off by more than a share `near` of
    that, or until there are as many as `count`; the target takes at most `most`.

    >>> from optlaws.motion.motion import motion_of_law
    >>> from optlaws import smoothstep
    >>> motion = motion_of_law(smoothstep(5), stroke="35 mm", duration="0.1 s")
    >>> fit = fitted(motion, degree=7, most=50)
    >>> fit.count, fit.exact, f"{fit.deviation:.1e}", fitted(motion, degree=9, most=50).exact
    (4, False, '4.9e-04', True)
    """
    orders = (degree + 1) // 2
    pairs = [(piece, own_stretch) for piece in motion.pieces for own_stretch in _of(piece, degree)]
    parts = [_FittedSection(0.0, i, piece, stretch) for i, (piece, stretch) in enumerate(pairs)]
    if len(parts) > (most if count is None else count):
        raise InputError(f"the motion has {len(parts)} pieces of its own, {_requested(most, count)}: export its parts")
    open_parts = [part for part in parts if part.stretch.exact_powers is None]
    peak = motion.peak(2) if open_parts else 0.0
    if not np.isfinite(peak):
        raise InputError("the acceleration of the motion has no bound, as where the velocity jumps: smooth it first")
    for part in open_parts:
        part.split(orders, peak, near)
    left = (most if count is None else count) - len(parts)
    _divide(open_parts, left, count, lambda part: part.split(orders, peak, near))
    joined = _joined(motion, parts)
    if joined.count > most:
        raise InputError(f"{joined.count} pieces are needed, and the target holds {most}: export the motion in parts")
    return joined


def exactly(motion: Motion, degree: int) -> Fitted | None:
    """The own polynomials of laws to a degree, cut where their powers would lose digits; None where laws are none.

    A polynomial of degree n in powers of k has terms far above its values; on a part of the interval, in powers of x
    less its start, they are as small as these.

    >>> from optlaws.motion.motion import motion_of_law
    >>> from optlaws import smoothstep
    >>> fit = exactly(motion_of_law(smoothstep(9), stroke="35 mm", duration="0.1 s"), 40)
    >>> fit.exact, fit.count, fit.run.degree
    (True, 6, 17)
    """
    pairs = [(piece, stretch) for piece in motion.pieces for stretch in _of(piece, degree)]
    if any(stretch.exact_powers is None for _, stretch in pairs):
        return None
    cut = ((piece, part) for piece, stretch in pairs for part in _cut(stretch))
    return _joined(motion, [_FittedSection(0.0, i, piece, part) for i, (piece, part) in enumerate(cut)])


def _cut(stretch: LawSection) -> Iterator[LawSection]:
    """Parts of a stretch, about one for three powers where there are more than nine."""
    exact_powers = list(stretch.exact_powers or ())
    count = 1 if len(exact_powers) <= _SHORT else ceil(len(exact_powers) / 3)
    places = np.linspace(*stretch.ends, count + 1).tolist()
    for low, high in pairwise(places):
        by = Fraction(low) - Fraction(stretch.ends[0])
        yield LawSection(stretch.law, (low, high), tuple(exact.shifted(exact_powers, by)))


def _requested(most: int, count: int | None) -> str:
    return f"and the target holds {most}" if count is None else f"more than the {count} that were asked for"


def _divide(
    open_parts: list[_FittedSection], left: int, count: int | None, split: Callable[[_FittedSection], None]
) -> None:
    """Add polynomials where the deviation is greatest, until the number is reached or the tolerance is satisfied."""
    heapify(open_parts)
    while open_parts and left and (count is not None or open_parts[0].rank < -1.0):
        worst = heappop(open_parts)
        split(worst)
        heappush(open_parts, worst)
        left -= 1
    if open_parts and count is None and open_parts[0].rank < -1.0:
        raise InputError(
            "the pieces that the target holds do not bring the acceleration within a thousandth of its peak: say how "
            "many to take all the same (points=...), or export parts"
        )


def _joined(motion: Motion, parts: Sequence[_FittedSection]) -> Fitted:
    breaks: list[Fraction] = []
    rows: list[list[Fraction]] = []
    height = Fraction(0)
    for part in parts:
        piece = part.piece
        if part.stretch.ends[0] == 0.0:
            height = Fraction(piece.offset) - Fraction(piece.stroke) * Fraction(float(piece.law.a(0.0)))
        for low, powers in _pieces(part):
            breaks.append(Fraction(piece.start) + Fraction(piece.duration) * low)
            rows.append([Fraction(piece.stroke) * c / Fraction(piece.duration) ** n for n, c in enumerate(powers)])
            rows[-1][0] += height
    run = from_exact([*breaks, Fraction(motion.stop)], rows)
    is_exact = all(stretch.run is None for stretch in parts)
    position, acceleration = (max(stretch.off(nu) for stretch in parts) for nu in (0, 2))
    return Fitted(run, is_exact, position, acceleration)


def _pieces(part: _FittedSection) -> Iterator[tuple[Fraction, Sequence[Fraction]]]:
    """First k and powers of every polynomial of a part; the powers of a dwell are zero."""
    if part.run is None:
        yield Fraction(part.stretch.ends[0]), part.stretch.exact_powers or (Fraction(0),)
        return
    for low, row in zip(part.run.breaks, part.run.coefficients, strict=False):
        yield Fraction(low), [Fraction(c) for c in row]


def _of(piece: Piece, degree: int) -> list[LawSection]:
    """The smooth stretches of a piece's law."""
    if piece.stroke == 0.0:
        return [LawSection(piece.law, (0.0, 1.0), (Fraction(0),))]
    law = piece.law
    if not is_polynomial(law):
        return [LawSection(law, ends) for ends in pairwise(law.breaks)]
    return [
        LawSection(law, (float(low), float(high)), tuple(powers) if len(powers) <= degree + 1 else None)
        for low, high, powers in stretches(law)
    ]
