"""What drives a machine, stretch by stretch in time: laws, dwells and returns, exact, a column for each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Protocol

from flint import fmpq, fmpq_poly

from optlaws.verification.enclosing.balls import rational
from optlaws.verification.enclosing.pieces import PolynomialPiece

Columns = list[fmpq_poly]
_HALF = Fraction(1, 2)


@dataclass(frozen=True)
class DrivenStretch:
    """Displacements on one stretch of time, as polynomials of the time since it began."""

    #: start, length: where it begins and how long it is, in durations of the rise
    start: Fraction
    length: Fraction
    columns: Columns  #: one polynomial for each law

    @property
    def stop(self) -> Fraction:
        """The time at which the stretch ends."""
        return self.start + self.length

    @property
    def first(self) -> list[fmpq]:
        """The displacements where the stretch begins."""
        return [column(fmpq(0)) for column in self.columns]

    @property
    def last(self) -> list[fmpq]:
        """The displacements where the stretch ends."""
        return [column(rational(self.length)) for column in self.columns]


class Space(Protocol):
    """The laws of a problem in exact numbers, as `optlaws.verification.exact` has them."""

    breaks: list[Fraction]

    def derivative(self, nu: int) -> list[Columns]:
        """Derivatives of order nu by k, as polynomials in x = 2k - 1 on each piece."""


def of_pieces(pieces: Sequence[PolynomialPiece]) -> list[DrivenStretch]:
    """A stored law: one column."""
    drives = []
    for piece in pieces:
        local = fmpq_poly([fmpq(-1), piece.rate])
        drives.append(DrivenStretch(piece.start, piece.stop - piece.start, [piece.derivative(0)(local)]))
    return drives


def of_space(space: Space) -> list[DrivenStretch]:
    """All laws of a space: free functions, then the base law; of symmetric laws the second half mirrors the first."""
    drives = []
    for part, (low, high) in zip(space.derivative(0), pairwise(space.breaks), strict=True):
        local = fmpq_poly([rational(2 * low - 1), fmpq(2)])
        drives.append(DrivenStretch(low, high - low, [function(local) for function in part]))
    if space.breaks[-1] == _HALF:
        middle = drives[-1].last
        drives += [_mirrored(drive, middle) for drive in reversed(drives)]
    return drives


def _mirrored(drive: DrivenStretch, middle: list[fmpq]) -> DrivenStretch:
    back = fmpq_poly([rational(drive.length), fmpq(-1)])
    columns = [2 * height - column(back) for column, height in zip(drive.columns, middle, strict=True)]
    return DrivenStretch(1 - drive.stop, drive.length, columns)


def rest(start: Fraction, length: Fraction, levels: Sequence[fmpq]) -> DrivenStretch:
    """A stretch on which nothing moves."""
    return DrivenStretch(start, length, [fmpq_poly([level]) for level in levels])


def followed(rise: Sequence[DrivenStretch], last: Fraction) -> list[DrivenStretch]:
    """A rise with the dwell after it, up to a time."""
    dwell = [rest(rise[-1].stop, last - rise[-1].stop, rise[-1].last)] if last > rise[-1].stop else []
    return [*rise, *dwell]


def cycle(rise: Sequence[DrivenStretch], dwell: Fraction, pause: Fraction) -> list[DrivenStretch]:
    """Rise, dwell, the same law back, and a rest."""
    low, high = rise[0].first, rise[-1].last
    back = 1 + dwell
    both = [low_part + other for low_part, other in zip(low, high, strict=True)]
    fall = [
        DrivenStretch(
            back + drive.start,
            drive.length,
            [total - column for total, column in zip(both, drive.columns, strict=True)],
        )
        for drive in rise
    ]
    around = [*rise, *([rest(Fraction(1), dwell, high)] if dwell else []), *fall]
    return [*around, *([rest(back + 1, pause, low)] if pause else [])]


def with_column(rise: Sequence[DrivenStretch], other: Sequence[DrivenStretch]) -> list[DrivenStretch]:
    """One more law, given on stretches of its own, each continued over the stretch whose middle it covers."""
    drives = []
    for drive in rise:
        middle = drive.start + drive.length / 2
        covering = [part for part in other if part.start <= middle][-1]
        later = fmpq_poly([rational(drive.start - covering.start), fmpq(1)])
        drives.append(DrivenStretch(drive.start, drive.length, [*drive.columns, covering.columns[0](later)]))
    return drives
