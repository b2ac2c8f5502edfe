"""The follower's motion as a function of the cam's angle: smooth stretches of laws, with derivatives by the angle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, Self

import numpy as np

from optlaws.cycles.cycle import Cycle, Plan
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.motion.piece import Piece, named_law
from optlaws.motion.quantities import TURN, in_small_units, quantity, read_stroke
from optlaws.motion.smooth_stretches import EnclosedStretch, jet_of_parts, smooth_parts
from optlaws.numbers import Array, Quantity, derivative, number_or_array, real_times
from optlaws.numerics.interval import Interval, hull
from optlaws.numerics.taylor import Jet
from optlaws.sentences import sentence
from optlaws.tolerances import CLOSURE, ROUNDOFF, VALUE_ROUNDING

Direction = Literal["rise", "return"]
DIRECTIONS: dict[Direction, float] = {"rise": 1.0, "return": -1.0}


class CamStretch(EnclosedStretch):
    """A smooth part of a motion over a range of the cam's angle, rad: `start`, `stop` and `duration` are angles."""


@dataclass(frozen=True, repr=False)
class CamMotion:
    """The displacement of a follower over the cam's angle; call it for derivatives by the angle, in m or rad.

    Parameters
    ----------
    stretches
        Smooth parts, one after the other.
    axis
        "length" for followers that slide, "angle" for ones that swing.
    closed
        Whether it goes on from its end to its start, as whole turns do.

    Examples
    --------
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> round(float(rise(np.pi / 3)), 9), round(float(rise(np.pi / 3, nu=1)), 9)
    (0.02, 0.038197186)
    >>> rise
    CamMotion(1 stretch over 120 deg, axis='length')
    """

    stretches: tuple[CamStretch, ...]
    axis: str
    closed: bool

    def __repr__(self) -> str:
        count, (first, last) = len(self.stretches), self.interval
        some = "1 stretch" if count == 1 else f"{count} stretches"
        return f"CamMotion({some} over {np.degrees(last - first):.6g} deg, axis={self.axis!r})"

    @classmethod
    def of_cycle(cls, cycle: Cycle | Plan) -> Self:
        """The motion of a whole cycle, which is one turn of the cam.

        Raises
        ------
        InputError
            If the cycle continues from its end, as no cam can.
        """
        pieces = cycle.pieces
        moved = sum(stretch.displacement for stretch in cycle.programme.stretches)
        size = max(abs(piece.stroke) for piece in pieces)
        if abs(moved) > CLOSURE * size:
            raise InputError(
                sentence(
                    "motion: the cycle ends {} from where it starts, and a cam comes back with every turn: end the "
                    "cycle with a Return(), and give it no advance",
                    in_small_units(moved, cycle.axis),
                )
            )
        return cls.of_pieces(pieces, cycle.duration, cycle.axis)

    @classmethod
    def of_pieces(cls, pieces: Sequence[Piece], period: float, axis: str) -> Self:
        """The motion of laws in their places, in time, which together are one turn of the cam in a period."""
        scale = TURN / period
        turns = [replace(piece, start=piece.start * scale, duration=piece.duration * scale) for piece in pieces]
        return cls(tuple(part for piece in turns for part in smooth_parts(piece, CamStretch)), axis, closed=True)

    @classmethod
    def of_law(cls, law: str | MotionLaw, stroke: Quantity, angle: Quantity, direction: Direction = "rise") -> Self:
        """The motion of one law, over a part of the turn.

        Parameters
        ----------
        law
            A law, a name of the catalogue, or a JSON file.
        stroke
            Such as "40 mm" for a follower that slides, "25 deg" for one that swings.
        angle
            Of the cam while the follower moves, such as "120 deg".
        direction
            "rise", or "return" for the way back, which begins at the stroke.

        Raises
        ------
        InputError
            If the stroke or the angle is no such quantity, not above 0, or the angle is more than a turn.
        """
        axis, height = read_stroke(stroke, "direction='return' is the way back")
        turn = quantity(angle, "angle", "angle")
        if not 0.0 < turn <= TURN * (1.0 + CLOSURE):
            raise InputError(f"angle must be above 0 and at most 360 deg, got {shortened(angle)}")
        check_names([direction], DIRECTIONS, "direction")
        sign = DIRECTIONS[direction]
        piece = Piece(0.0, turn, 0.0 if sign > 0.0 else height, sign * height, named_law(law, "motion"))
        return cls(smooth_parts(piece, CamStretch), axis, closed=False)

    @property
    def interval(self) -> tuple[float, float]:
        """The first and the last angle, rad."""
        return self.stretches[0].start, self.stretches[-1].stop

    @property
    def breaks(self) -> tuple[float, ...]:
        """Angles between which the motion is smooth, both ends included, rad."""
        return (*(stretch.start for stretch in self.stretches), self.stretches[-1].stop)

    @kept_property
    def monotone_edges(self) -> Array:
        """Angles between which the motion is smooth and goes one way: its breaks, and where it turns back, rad."""
        places = [np.array(self.breaks)]
        for stretch in self.stretches:
            inner = stretch.segment.candidates(stretch.length, 0) if stretch.stroke else np.empty(0)
            if inner.size:
                turns = stretch.start + (stretch.stop - stretch.start) * inner
                ends = np.array([[stretch.start], [stretch.stop]])
                way = np.abs(self(turns) - self(ends))
                # roots of the velocity beside an end that is at rest are rounding
                places.append(turns[(way > VALUE_ROUNDING * abs(stretch.stroke)).all(axis=0)])
        return np.unique(np.concatenate(places))

    @kept_property
    def range(self) -> tuple[float, float]:
        """The least and the greatest displacement."""
        return self.extremes(0)

    @kept_property
    def slopes(self) -> tuple[float, float]:
        """The least and the greatest derivative by the angle."""
        return self.extremes(1)

    def __call__(self, angle: Any, nu: int = 0) -> Any:
        """The derivative of order nu by the angle in rad; at a break that just after it."""
        nu = derivative(nu)
        return number_or_array(self.jet(real_times(angle), nu).derivative(nu))

    def jet(self, angle: Array | Interval, nu: int, *, before: bool = False) -> Jet:
        """The displacement with its derivatives up to order nu; at a break those just after it, or just before it.

        In an interval of angles they are those of the stretch in which its middle lies, which it must not leave.
        """
        at = angle if isinstance(angle, Interval) else self.within(angle)
        return jet_of_parts(self.stretches, lambda stretch, some: stretch.jet(some, nu), at, before=before)

    def power(self, angle: Interval, nu: int) -> Jet:
        """The velocity times the acceleration by the angle, in intervals each within a stretch."""
        return jet_of_parts(self.stretches, lambda stretch, some: stretch.power(some, nu), angle)

    def along(self, angle: Jet) -> Jet:
        """The displacement where the cam's angle is itself a function, up to its second Taylor term.

        Intervals of angles may hold breaks, as their acceleration may jump there: then all that it is on both sides.
        """
        s = self._over(angle.terms[0], angle.order).terms
        if angle.order == 0:
            return Jet(s)
        first, *rest = (angle.terms[1], *angle.terms[2:3])
        return Jet((s[0], s[1] * first, *(s[1] * term + s[2] * (first * first) for term in rest)))

    def _over(self, angle: Array | Interval, nu: int) -> Jet:
        if not isinstance(angle, Interval):
            return self.jet(angle, nu)
        start, stop = self.interval
        known_at = np.isfinite(angle.radius)
        turns = np.floor((angle.middle - start) / (stop - start)) if self.closed else 0.0 * angle.middle
        at = angle - turns * Interval(np.array(stop - start), np.array(2.0 * ROUNDOFF * (stop - start)))
        known = self.jet(at, nu)
        for way in (-1.0, 1.0):
            # what an interval has beyond an end of its stretch belongs to the next one
            known = self._with_next(known, at, nu, way)
        return Jet(tuple(Interval(term.middle, np.where(known_at, term.radius, np.inf)) for term in known.terms))

    def _with_next(self, known: Jet, at: Interval, nu: int, way: float) -> Jet:
        which = np.searchsorted(self.breaks[1:-1], at.middle, side="right")
        ends, (start, stop) = np.array(self.breaks)[which + (way > 0.0)], self.interval
        beyond = np.flatnonzero(at.high > ends if way > 0.0 else at.low < ends)
        terms = [Interval(term.middle.copy(), term.radius.copy()) for term in known.terms]
        for i in np.unique(which[beyond]):
            here, wrapped = beyond[which[beyond] == i], (i + int(way)) // len(self.stretches)
            stretch = self.stretches[(i + int(way)) % len(self.stretches)]
            moved = at[here] - wrapped * (stop - start)
            wide = moved.radius > 0.5 * (stretch.stop - stretch.start)
            for term, more in zip(terms, stretch.jet(moved, nu).terms, strict=True):
                both = hull(term[here], more)
                term.middle[here], term.radius[here] = both.middle, np.where(wide, np.inf, both.radius)
        return Jet(tuple(terms))

    def within(self, angle: Array) -> Array:
        """Angles of the interval that mean the same."""
        first, last = self.interval
        if self.closed:
            beyond = (angle < first) | (angle > last)
            return np.where(beyond, first + np.mod(angle - first, last - first), angle)
        slack = CLOSURE * (last - first)
        if np.any((angle < first - slack) | (angle > last + slack)):
            raise InputError(
                f"angles of this motion are {first:g} to {last:g} rad, got {shortened(np.asarray(angle).tolist())}:"
                " a law moves a follower over a part of the turn; take a Cycle for the whole of it"
            )
        return np.clip(angle, first, last)

    def extremes(self, nu: int) -> tuple[float, float]:
        """The least and the greatest derivative of order nu by the angle."""
        lows, highs = zip(*(stretch.extremes(nu) for stretch in self.stretches), strict=True)
        return min(lows), max(highs)

    def reversed(self) -> Self:
        """The motion in the opposite direction, as the second follower of a pair moves."""
        turned = tuple(replace(stretch, offset=-stretch.offset, stroke=-stretch.stroke) for stretch in self.stretches)
        return replace(self, stretches=turned)


def as_motion(given: Any, axis: str) -> CamMotion:
    """A cycle or a motion by angle as a `CamMotion`, which must be a length or an angle as the follower requires."""
    if isinstance(given, Cycle | Plan):
        motion = CamMotion.of_cycle(given)
    elif isinstance(given, CamMotion):
        motion = given
    else:
        raise InputError(
            "motion must be a Cycle, or a CamMotion such as CamMotion.of_law('cycloidal', '40 mm', '120 deg'), got "
            f"{shortened(given)}"
        )
    if motion.axis != axis:
        kinds = {"length": "slides, and the displacements of the motion are angles", "angle": "swings, and the "
                 "displacements of the motion are lengths"}  # fmt: skip
        other = {"length": "an oscillating", "angle": "a translating"}[axis]
        raise InputError(f"motion: the follower {kinds[axis]}: take {other} follower, or displacements of its kind")
    return motion
