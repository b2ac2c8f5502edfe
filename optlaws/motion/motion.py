"""An exact motion y(x) of a slave over its master in machine units, and the forms in which it leaves what has one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf
from operator import itemgetter
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from optlaws.echo import keywords_of
from optlaws.errors import InputError, OptlawsError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.law import ExportOptions
from optlaws.motion.piece import Piece, factor, of_stroke_one, values_of_pieces
from optlaws.motion.quantities import Given, check_scale, given_quantity, quantity
from optlaws.numbers import Quantity, derivative, number_or_array, real_times
from optlaws.tolerances import JUMP

if TYPE_CHECKING:
    from optlaws.shown.report import Report
    from optlaws.shown.summary import Summary

Place = tuple[float, float]

SLAVES = ("length", "angle")
MASTERS = ("angle", "length")


@dataclass(frozen=True)
class Units:
    """Units of master and slave as texts; `rate` is how many of the master's pass in a second, None if not known.

    A master that is time itself has the unit "s" and the rate 1.
    """

    master: str
    slave: str
    rate: float | None


@dataclass(frozen=True)
class Motion:
    """A motion y(x) in machine units: x of the master from `start` to `stop`, y of the slave.

    Derivatives are by the master: V = dy/dx, A = d²y/dx², J = d³y/dx³, as cam tables take them; with a master that
    is time they are velocity, acceleration and jerk. A master at a constant rate w makes of them V w, A w², J w³.

    Parameters
    ----------
    pieces
        Laws in their places, one after another, in the units of master and slave.
    units
        Units of both.
    repeats
        Whether the end goes on with the start (`advance` further), or rest comes before and after.
    proof
        What is proven of its laws, for files to say.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> motion = motion_of_law(smoothstep(3), stroke="35 mm", master="120 deg", duration="0.1 s")
    >>> motion.units
    Units(master='deg', slave='mm', rate=1200.0)
    >>> motion(60.0), round(motion(60.0, 1), 9), motion.start, motion.stop
    (17.5, 0.546875, 0.0, 120.0)
    """

    pieces: tuple[Piece, ...]
    units: Units
    repeats: bool
    proof: tuple[str, ...] = ()

    @property
    def start(self) -> float:
        return self.pieces[0].start

    @property
    def stop(self) -> float:
        return self.pieces[-1].stop

    @property
    def length(self) -> float:
        return self.stop - self.start

    @kept_property
    def breaks(self) -> tuple[float, ...]:
        """The places where the function is put together, within laws as well, both ends included."""
        inner = (
            piece.start + k * piece.duration
            for piece in self.pieces
            for k in piece.law.breaks[:-1]
            if k == 0.0 or piece.stroke != 0.0  # at rest breaks of the law are none of the motion
        )
        return (*inner, self.stop)

    @kept_property
    def stroke(self) -> float:
        (low, _), (high, _) = self.extremes(0)
        return high - low

    @property
    def advance(self) -> float:
        """The net displacement of the motion, its end value less its start value."""
        return self.pieces[-1].end(0, 1) - self.pieces[0].end(0, 0)

    def __call__(self, x: Any, nu: int = 0) -> Any:
        """The derivative of order nu at x; at a break just after it, at the end just before it."""
        places, nu = real_times(x), derivative(nu)
        beyond = (places < self.start) | (places > self.stop)
        if beyond.any():
            wrong = float(places[beyond].flat[0])
            raise InputError(f"x must be from {self.start:g} to {self.stop:g} {self.units.master}, got {wrong!r}")
        return number_or_array(values_of_pieces(self.pieces, places, nu))

    def ends(self, nu: int) -> tuple[float, float]:
        """The derivative of order nu at the start and at the end."""
        return self.pieces[0].end(nu, 0), self.pieces[-1].end(nu, 1)

    def extremes(self, nu: int) -> tuple[Place, Place]:
        """Least and greatest value of the derivative of order nu, each with its x, over the whole motion."""
        if nu not in self._extremes:
            lows, highs = zip(*(piece.extremes(nu, piece.start, piece.stop) for piece in self.pieces), strict=True)
            self._extremes[nu] = min(lows, key=itemgetter(0)), max(highs, key=itemgetter(0))
        return self._extremes[nu]

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu; inf where a lower one jumps, joints included."""
        jumps = max((self.jump(lower)[0] for lower in range(1, nu)), default=0.0)
        return inf if jumps else self._size(nu)

    def jump(self, nu: int) -> Place:
        """The greatest jump of the derivative of order nu inside, and its x; what is rounding beside its peak is 0."""
        jumps = [(abs(after.end(nu, 0) - before.end(nu, 1)), after.start) for before, after in pairwise(self.pieces)]
        for piece in self.pieces:
            size = abs(factor(piece.stroke, piece.duration, nu))
            within = piece.law.jumps(nu) if piece.stroke else ()
            jumps += ((size * abs(jump), piece.start + k * piece.duration) for k, jump in within)
        worst = max(jumps, default=(0.0, self.start), key=itemgetter(0))
        return worst if worst[0] > JUMP * self._size(nu) else (0.0, self.start)

    def rms(self, nu: int) -> float:
        """Root mean square of the derivative of order nu over the motion."""
        squares = sum(piece.duration * piece.mean_square(nu) for piece in self.pieces)
        return float(np.sqrt(squares / self.length))

    def over_time(self) -> Motion:
        """The same motion as a function of time in seconds; it must be known how fast the master goes."""
        if self.units.rate is None:
            raise InputError("how fast the master goes is not known: say how long the motion takes, duration='0.1 s'")
        if self.units.master == "s":
            return self
        share = 1.0 / self.units.rate
        pieces = [replace(piece, start=share * piece.start, duration=share * piece.duration) for piece in self.pieces]
        return replace(self, pieces=tuple(pieces), units=Units("s", self.units.slave, 1.0))

    @kept_property
    def _extremes(self) -> dict[int, tuple[Place, Place]]:
        return {}

    def _size(self, nu: int) -> float:
        return max(abs(value) for value, _ in self.extremes(nu))


def motion_of_law(
    law: MotionLaw,
    *,
    stroke: Quantity | None = None,
    duration: Quantity | None = None,
    master: Quantity | None = None,
    start: Quantity | None = None,
) -> Motion:
    """The motion of a law with the stroke 1, a single stroke from rest to rest.

    Parameters
    ----------
    stroke
        How far the slave moves, such as "35 mm", "-20 deg": positions are in its unit.
    duration
        How long it takes, such as "0.1 s".
    master
        How far the master goes meanwhile, such as "120 deg"; without it the master is time in seconds.
    start
        Position of the slave at the start; 0 unless given.

    >>> from optlaws import smoothstep
    >>> motion_of_law(smoothstep(3), stroke="90 deg", duration="400 ms").peak(1)
    421.875
    """
    if stroke is None:
        raise InputError("say how far the slave moves: give a stroke such as '35 mm' or '45 deg'")
    moved = given_quantity(stroke, SLAVES, "stroke")
    if moved.number == 0.0:
        raise InputError("stroke must not be 0: give how far the slave moves, such as '35 mm'")
    check_scale(moved.number, moved.unit, "stroke", stroke)
    if duration is None and master is None:
        raise InputError(
            "say how long the motion takes, duration='0.1 s', or how far its master goes, master='120 deg'"
        )
    seconds = None if duration is None else quantity(duration, "time", "duration", above=0.0)
    span = _span(master, seconds)
    rate = None if seconds is None else span.number / seconds
    offset = 0.0 if start is None else moved.same_unit(start, "start")
    piece = Piece(0.0, span.number, offset, moved.number, of_stroke_one(law, "the law", "stroke"))
    return Motion((piece,), Units(span.unit, moved.unit, rate), repeats=False)


def motion_of_pieces(
    pieces: Sequence[Piece],
    duration: float,
    axis: str,
    *,
    master: Quantity | None = "360 deg",
    unit: str | None = None,
    proof: tuple[str, ...] = (),
) -> Motion:
    """The motion of laws in SI units over time, which repeats with a duration, in units of master and slave.

    The master goes so far in a cycle, such as "360 deg", or is time in seconds where it is None; positions are in "mm"
    or "deg" unless a unit is given; `proof` is what is proven of the laws.

    >>> from optlaws import smoothstep
    >>> motion = motion_of_pieces([Piece(0.0, 0.1, 0.0, 0.035, smoothstep(3))], 0.1, "length", master="120 deg")
    >>> motion.units, motion(60.0)
    (Units(master='deg', slave='mm', rate=1200.0), 17.5)
    """
    span = _span(master, duration)
    chosen = {"length": "mm", "angle": "deg"}[axis] if unit is None else unit
    size = 1.0 / quantity(f"1 {chosen}", axis, "unit")
    share = span.number / duration
    # without the roundings of the way to seconds and back: 120 in place of 119.99...
    starts = [*(float(f"{share * piece.start:.13g}") for piece in pieces), span.number]
    scaled = tuple(
        replace(piece, start=low, duration=high - low, offset=size * piece.offset, stroke=size * piece.stroke)
        for piece, (low, high) in zip(pieces, pairwise(starts), strict=True)
    )
    return Motion(scaled, Units(span.unit, chosen, share), repeats=True, proof=proof)


def _span(master: Quantity | None, seconds: float | None) -> Given:
    """The distance that the master covers, in its unit."""
    if master is None:
        return Given("time", seconds or 0.0, seconds or 0.0, "s")
    span = given_quantity(master, MASTERS, "master")
    if span.number <= 0.0:
        raise InputError(f"master must be above 0, got {master!r}")
    check_scale(span.number, span.unit, "master", master)
    return span


class Exportable:
    """The forms in which an exact motion leaves: files for controllers, polynomials, a report, a page."""

    def motion(self, master: Quantity | None = "360 deg", unit: str | None = None) -> Motion:
        """The exact motion over its master in machine units; laws are optimised at this call.

        Parameters
        ----------
        master
            How far the master goes in a cycle, such as "360 deg"; None for a master that is time in seconds.
        unit
            Of positions; "mm" for lengths and "deg" for angles unless given.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> motion = cycle.motion()
        >>> round(float(motion(120.0)), 12), motion.units, round(motion.peak(1), 9)
        (35.0, Units(master='deg', slave='mm', rate=1200.0), 0.583333333)
        """
        raise NotImplementedError

    def report(self) -> Report:
        """The facts, the table of the segments and the curves, as tables, pictures and pages show them.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> report = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s").report()
        >>> [(panel.title, round(panel.peak, 3)) for panel in report.panels[:2]]
        [('position, mm', 35.0), ('velocity, mm/s', 700.0)]
        """
        raise NotImplementedError

    def summary(self) -> Summary:
        """The facts of the report: proofs, peaks and what is taken of drives and limits, as rows in SI units."""
        return self.report().facts

    @keywords_of(ExportOptions)
    def export(
        self, to: str, *, master: Quantity | None = "360 deg", unit: str | None = None, **options: Unpack[ExportOptions]
    ) -> Any:
        """The motion in the format of a controller, with a report of the executed motion: an `Export`.

        Parameters
        ----------
        to
            The format: `optlaws export --list` names them.
        master, unit
            As of `motion`; the master of a transition begins at 0.
        points, counts, digits, decimal, interpolation, task, name
            As `ExportOptions` has them: how many points, of which numbers, for which task of the drive.

        Raises
        ------
        InputError
            If there is no such format, it takes no such option, or it cannot hold the motion.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> export = cycle.export("rockwell-cam", points=61)
        >>> export.points, round(export.report.ratio(2), 3)
        (61, 1.008)
        """
        from optlaws.exports.export import export_cycle

        return export_cycle(self, to, {"master": master, "unit": unit}, **options)

    def polynomials(self, *, master: Quantity | None = None, unit: str | None = None, tolerance: float = 1e-9) -> Any:
        """Times and polynomial coefficients of the motion, as a `PiecewiseMotion`: `breaks` and `coefficients`.

        Over time in seconds unless a master is given; exact where laws are made of polynomials, else within
        `tolerance`, a share of the greatest stroke, over the whole motion.

        Raises
        ------
        InputError
            If a quantity is wrong, or a law's derivatives grow without limit.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("1 m", "1 s", law="cubic"), Return(law="cubic")], period="3 s")
        >>> pieces = cycle.polynomials(unit="m")
        >>> pieces.breaks, [[round(coefficient, 9) for coefficient in row] for row in pieces.coefficients]
        ((0.0, 1.0, 3.0), [[0.0, 0.0, 3.0, -2.0], [1.0, 0.0, -0.75, 0.25]])
        """
        from optlaws.exports.polynomial_pieces import pieces_of_motion

        return pieces_of_motion(self.motion(master, unit), tolerance)

    def _repr_html_(self) -> str:
        """The report as HTML; where laws cannot be had, the error in its place."""
        from optlaws.shown.report import report_page
        from optlaws.shown.showing import facts, page

        try:
            return report_page(type(self).__name__, self.report())
        except OptlawsError as error:
            return page(type(self).__name__, facts({"error": error}))
