"""The dwells and moves of a table of points, and the standard laws nearest to these."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Literal, TypeAlias

import numpy as np

from optlaws.cycles.old_tables.fitted_moves import FittedMove
from optlaws.cycles.old_tables.motion import FittedMotion
from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.cycles.old_tables.region import SHORTEST
from optlaws.cycles.old_tables.standard import JUMP
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.catalogue.tables.curve_pieces import law_of_curve
from optlaws.numbers import Array
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import VALUE_ROUNDING

StretchKind: TypeAlias = Literal["dwell", "rise", "return"]

#: standard deviations by which a velocity of a line may be off
_SLOPE_DEVIATIONS = 3.0
#: of a move: breaks that are nearer to its ends are these
_APART = 1e-9


@dataclass(frozen=True)
class Stretch:
    """A part of an old table.

    Attributes
    ----------
    kind
        "dwell", "rise" or "return".
    start, stop
        Where it is, in units of the table's master.
    low, high
        The positions at its start and its end, in units of the table.
    law
        Of a move: a name of the catalogue where a standard law keeps within the room, else a law through the points.
    nearest
        The standard law that is nearest.
    distance
        How far the points are from that at most, in units of the table.
    solution
        Of a better law: the solution that it is from, with its certificate.
    reason, sufficient_tolerance, sufficient_gain
        Of a move that keeps its law or a corner where better was sought: why, a tolerance that is enough, and by which
        share the acceleration of a law within it is less; 0 where none was found.
    corner
        Of a move in which the velocity changes smoothly from line to line: where its corner was.
    peaks
        Between which values the peaks of velocity, acceleration and jerk are by the table; empty for a dwell, and for a
        law in place of that of the table.
    """

    kind: StretchKind
    start: float
    stop: float
    low: float
    high: float
    law: str | MotionLaw | None = None
    nearest: str = ""
    distance: float = 0.0
    solution: Solution | None = None
    reason: str = ""
    sufficient_tolerance: float = 0.0
    sufficient_gain: float = 0.0
    corner: float | None = None
    peaks: tuple[PeakInterval, ...] = ()

    @property
    def stroke(self) -> float:
        """The displacement from its start to its end."""
        return self.high - self.low

    @property
    def line(self) -> float | None:
        """The velocity of a dwell or of constant velocity; None of any other move."""
        if self.law is None:
            return 0.0
        return self.stroke / (self.stop - self.start) if self.law == "constant velocity" else None


def seam_of(heights: Array, room: float) -> float:
    """The difference between the last position and the first one; 0 within the tolerance."""
    seam = float(heights[-1] - heights[0])
    return seam if abs(seam) > room else 0.0


def stretches_of(motion: FittedMotion) -> Iterator[Stretch]:
    """The dwells and moves of a fitted motion, from its first place to its last one."""
    known = ~motion.samples.suspects
    x, y = motion.samples.places[known], motion.samples.heights[known]
    for part in _parts_of(motion):
        # of a law of its own, how far the nearest standard law is off
        law = part.law if isinstance(part.law, str) or not part.nearest else part.nearest
        inside = (x >= part.start) & (x <= part.stop)
        apart = np.abs(position(replace(part, law=law), x[inside]) - y[inside])
        yield part if law is None else replace(part, distance=float(apart.max(initial=0.0)))


def _parts_of(motion: FittedMotion) -> Iterator[Stretch]:
    x, y = motion.samples.places, motion.samples.heights
    least, least_rise = SHORTEST * float(np.ptp(x)), VALUE_ROUNDING * float(np.ptp(y))
    at, level, corner = float(x[0]), motion.moves[0].position_before(float(x[0])), False
    for move in motion.moves:
        start = move.start if move.start - at > least else at
        start = start if float(x[-1]) - start > least else float(x[-1])
        if start > at:
            yield _between(motion, at, start, level, move.low, least_rise, corner=corner or move.corners[0])
        corner = move.corners[1]
        if move.is_corner:
            at, level = start, move.low
            continue
        stop = move.stop if float(x[-1]) - move.stop > least else float(x[-1])
        if start < stop:
            kind: StretchKind = "rise" if move.high > move.low else "return"
            law = move.name or _law_of(move)
            yield Stretch(kind, start, stop, move.low, move.high, law, move.nearest, peaks=move.peaks)
        at, level = stop, move.high
    if float(x[-1]) > at:
        last = motion.moves[-1].position_behind(float(x[-1]))
        yield _between(motion, at, float(x[-1]), level, last, least_rise, corner=corner)


def _between(
    motion: FittedMotion, start: float, stop: float, low: float, high: float, least: float, *, corner: bool
) -> Stretch:
    """A dwell, or what runs at constant velocity and rises or falls by more than the least, maybe beside a corner."""
    if abs(high - low) <= least:
        return Stretch("dwell", start, stop, low, low)
    slope = abs((high - low) / (stop - start))
    most = inf if corner else 0.0
    x, noise = motion.samples.places, motion.samples.noise
    inside = (x >= start) & (x <= stop)
    # the deviation of a slope by so many even rows
    off = _SLOPE_DEVIATIONS * np.sqrt(12.0 / max(inside.sum(), 2)) * noise[inside].max(initial=0.0) / (stop - start)
    velocity = PeakInterval(max(slope - float(off), 0.0), slope + float(off))
    peaks = velocity, PeakInterval(0.0, most), PeakInterval(0.0, most)
    name = "constant velocity"
    return Stretch("rise" if high > low else "return", start, stop, low, high, name, name, peaks=peaks)


def _law_of(move: FittedMove) -> MotionLaw:
    """The law of a move that is no standard law, of its spline."""
    fit = move.fits[0]
    apart = _APART * (move.stop - move.start)
    inner = (fit.breaks > move.start + apart) & (fit.breaks < move.stop - apart)
    breaks = [move.start, *fit.breaks[inner].tolist(), move.stop]
    degrees = [fit.degree] * (len(breaks) - 1)
    return law_of_curve(breaks, move.high - move.low, degrees, lambda places, _, nu: fit.values(places, nu))


def position(part: Stretch, places: Array) -> Array:
    """The positions of a stretch at places within it."""
    k = np.clip((places - part.start) / (part.stop - part.start), 0.0, 1.0)
    return part.low + (0.0 * k if part.law is None else part.stroke * np.asarray(law_of_move(part)(k)))


def corners_of(stretches: Sequence[Stretch]) -> tuple[float, ...]:
    """The places at which the velocity jumps in a turn of stretches, also from its end to its beginning."""
    places, before, after, greatest = list[float](), list[float](), list[float](), 0.0
    for part in stretches:
        law = None if part.law is None else law_of_move(part)
        k = np.array([0.0, 1.0] if law is None else law.breaks)
        slope = part.stroke / (part.stop - part.start)
        greatest = max(greatest, 0.0 if law is None else abs(slope) * law.peak(1).value)
        sides = (np.nextafter(k[1:], 0.0), np.nextafter(k[:-1], 1.0))
        ends, begins = (0.0 * at if law is None else slope * np.asarray(law(at, 1)) for at in sides)
        places += (part.start + (part.stop - part.start) * k[:-1]).tolist()
        before, after = before + ends.tolist(), after + begins.tolist()
    jumps = np.abs(np.array(after) - np.roll(before, 1))
    return tuple(np.array(places)[jumps > JUMP * greatest].tolist())


def law_of_move(part: Stretch) -> MotionLaw:
    """The law of a move, which may be a name of the catalogue."""
    if isinstance(part.law, MotionLaw):
        return part.law
    return catalogue[str(part.law)].law
