"""Tables of whole cycles from old cams and controllers: their dwells, rises and returns, and the laws of these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.old_tables.better_laws import MoveGain, bettered, gain, peaks_of, without_corners
from optlaws.cycles.old_tables.frame import (
    period_of,
    whole_turn,
)
from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.cycles.old_tables.samples import gaps_of, unit_of_rounding
from optlaws.cycles.old_tables.stretches import Stretch, corners_of, law_of_move, position
from optlaws.cycles.specification.segments import CycleSegment, Dwell, Return, Rise
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.motion.quantities import QUANTITIES, Exact
from optlaws.numbers import Array, NumberOrQuantity, positive
from optlaws.sentences import Amount, Sentence, joined, sentence
from optlaws.tolerances import AGREEMENT

_TIMES = {"s", "ms"}
_USELESS = 10.0  # times the lower end of an interval: an upper end that is more tells nothing
_MOST_NAMED = 8  # places that a remark lists
_MOVING = 1e-3  # of the greatest velocity of a stretch: it begins with one that is more
#: of a turn: by how much rows that are one may be longer or shorter; one of 2π rad is rounded
_WHOLE_TURN, _WHOLE_TURN_IN_RAD = 1e-6, 1e-4
_ROUNDER = 9.0  # times the unit to which one length is rounded: another one is rounder


@dataclass(frozen=True, eq=False)
class OldTable:
    """A table of a whole cycle, divided into dwells, rises and returns.

    Attributes
    ----------
    stretches
        Its parts in order.
    room
        How far a law may be from the points: what was given, else the last digit or what the noise requires.
    scatter
        The standard deviation of the noise that the points show; 0 where none is seen.
    seam
        By how much the last position differs from the first one.
    unit, master
        The units of positions and of the master.
    places, heights
        The points, arrays of shape (n,).
    layout
        What the file is that it was read from.
    rate
        How many units of its master go by in a second, where the file says it.
    outliers
        Indices of points that are far off the motion, as a speck of dust puts them; they are left out.
    whole
        Whether its length is a turn of the cycle, whatever it is: 720 deg of a crank, or 1,500 mm of a web.
    waves
        Amplitudes of waves that the points show about the motion, with their numbers by the master in radians; the
        peaks count them.
    averaged
        Of how many points the noise is a moving mean, where a filter has smoothed it; the motion is that so smoothed.

    Examples
    --------
    >>> from optlaws import catalogue, split_table
    >>> table = split_table(
    ...     np.arange(361.0), [round(30 * float(catalogue["cycloidal"].law(min(x / 120, 1))), 3) for x in range(361)]
    ... )
    >>> [(part.kind, part.start, part.stop, part.law) for part in table.stretches]
    [('rise', 0.0, 120.0, 'cycloidal'), ('dwell', 120.0, 360.0, None)]
    """

    stretches: tuple[Stretch, ...]
    room: float
    scatter: float
    seam: float
    unit: str
    master: str
    places: Array
    heights: Array
    layout: str = ""
    rate: float | None = None
    outliers: tuple[int, ...] = ()
    whole: bool = False
    waves: tuple[tuple[float, float], ...] = ()
    averaged: int = 1

    def cycle(self, *, speed: NumberOrQuantity | None = None, period: NumberOrQuantity | None = None) -> Cycle:
        """The cycle of the table, at a speed or a period; at the speed of the file if neither is given.

        Raises
        ------
        InputError
            If both are given, or neither where the master is an angle whose speed the file does not say; if the
            velocity jumps at a corner.

        Examples
        --------
        >>> from optlaws import split_table
        >>> x = np.arange(0.0, 1500.0, 10.0)  # mm of a web, of which 1,500 are a turn
        >>> table = split_table(x, 5.0 - 5.0 * np.cos(2.0 * np.pi * x / 1500.0), master="mm", turn=1500.0)
        >>> round(table.cycle(speed="3 m/s").duration, 9)
        0.5
        """
        first, last = self.stretches[0], self.stretches[-1]
        turn, times = last.stop - first.start, self.master in _TIMES
        of_turn = whole_turn(None, self.master)
        near = _WHOLE_TURN_IN_RAD if self.master == "rad" else _WHOLE_TURN
        if not self.whole and of_turn and abs(turn - of_turn) > near * of_turn:
            raise InputError(
                f"the rows go over {turn:.9g} {self.master}, and a turn of the master is {of_turn:.9g}: say by turn "
                "how long it is, such as '720 deg', or by lobes how often the rows follow each other in it"
            )
        if speed is None and period is None:
            if times:
                period = Exact(turn, self.master)
            elif self.rate is None:
                raise InputError('speed: give the speed of the master, such as "200 rpm": the file has none')
            else:
                speed = Exact(self.rate, f"{self.master}/s")
        if speed is not None and period is None and self.whole and not times:
            period, speed = Exact(period_of(turn, self.master, speed), "s"), None
        if self.corners:
            left = {
                self.reason_in_words(part): None for part in self.moves if part.solution is not None and part.reason
            }
            remedy = "modernise it within a tolerance, which takes corners away"
            if any(part.solution is not None for part in self.moves):
                remedy = joined("; ", left) if left else "a greater tolerance may take corners away"
            raise InputError(
                f"the velocity jumps at {self._named(self.corners)}, and that of a cycle does not: {remedy}"
            )
        segments: list[CycleSegment] = []
        for part in self.stretches:
            length = part.stop - part.start
            as_given = times or (not self.whole and turn == of_turn)
            duration = Exact(length, self.master) if as_given else Exact(360.0 * length / turn, "deg")
            if part.law is None:
                segments.append(Dwell(duration))
            else:
                move = Rise if part.stroke > 0.0 else Return
                segments.append(move(Exact(abs(part.stroke), self.unit), duration, law=part.law))
        advance = Exact(last.high - first.low, self.unit) if last.high != first.low else None
        return Cycle(segments, speed=speed, period=period, start=Exact(first.low, self.unit), advance=advance)

    def modernised(
        self,
        tolerance: float,
        *,
        speed: NumberOrQuantity | None = None,
        period: NumberOrQuantity | None = None,
        order: int = 3,
        degree: int = 15,
    ) -> Cycle:
        """The cycle with the laws of least acceleration that stay within a tolerance of the old laws everywhere.

        The parameters are those of `bettered` and of `cycle`.
        """
        return self.bettered(tolerance, order=order, degree=degree).cycle(speed=speed, period=period)

    def bettered(self, tolerance: float, *, order: int = 3, degree: int = 15) -> OldTable:
        """The table with the laws of least acceleration that stay within a tolerance of the old laws everywhere.

        A new law begins and ends with the position, the velocity and, from order 3 on, the acceleration of the old one,
        so that moves meet as before, also where they turn or go on. A move keeps its law where no law of this order and
        degree within the tolerance has less acceleration, and where it has no acceleration or no jerk, as one at
        constant velocity: `reason` of its stretch says why, and `sufficient_tolerance` within what one has less.

        Where the velocity jumps between lines, at rest or not, it changes smoothly over as much of the master as the
        tolerance allows, in moves that know their `corner`; beside another move the new law begins or ends with the
        velocity of the line, or the corner stays and `reason` says so.

        Parameters
        ----------
        tolerance
            In units of the table, above 0.
        order, degree
            Of the new laws; their jerk is at most a fifth above the old one where that has a greatest value.

        Raises
        ------
        InputError
            If the tolerance is not above 0.

        Examples
        --------
        >>> from optlaws import catalogue, split_table
        >>> x = np.arange(361.0)
        >>> law = catalogue["cycloidal"].law
        >>> old = split_table(x, np.round(30 * (law(np.clip(x / 120, 0, 1)) - law(np.clip((x - 180) / 120, 0, 1))), 4))
        >>> [f"{gain.share(2):.1%} of {gain.kind}" for gain in old.bettered(0.1, degree=11).gains(old)]
        ['-10.9% of rise', '-10.9% of return']
        """
        room = positive(tolerance, "tolerance")
        smooth = without_corners(self.stretches, room, order)
        return replace(self, stretches=tuple(bettered(smooth, room, order, degree)))

    def gains(self, old: OldTable) -> tuple[MoveGain, ...]:
        """Gains of each move over the moves of an older table: peaks, and the deviation; lines have none.

        Raises
        ------
        InputError
            If the moves of the two that are no lines are not at the same places.

        Examples
        --------
        >>> from optlaws import catalogue, split_table
        >>> x = np.arange(361.0)
        >>> law = catalogue["cycloidal"].law
        >>> old = split_table(x, np.round(30 * (law(np.clip(x / 120, 0, 1)) - law(np.clip((x - 180) / 120, 0, 1))), 4))
        >>> [round(number, 9) for number in old.gains(old)[0].old]  # mm/deg, mm/deg², mm/deg³
        [0.5, 0.01308997, 0.000685389]
        """
        new, was = (
            [part for part in each.stretches if part.line is None and part.corner is None] for each in (self, old)
        )
        places = [[(part.start, part.stop, part.low, part.high) for part in each] for each in (new, was)]
        if places[0] != places[1]:
            raise InputError("gains need two tables with the same moves, one computed from the other")
        return tuple(map(gain, new, was))

    def gain_of_cycle(self, old: OldTable) -> MoveGain:
        """The gain of the whole cycle over that of an older table, whose corners have no greatest acceleration.

        Its deviation is the greatest one of `gains`, or at a corner that is taken away.

        Examples
        --------
        >>> from optlaws import split_table
        >>> x = np.arange(0.0, 361.0, 5.0)
        >>> old = split_table(x, np.clip(x, 30.0, 100.0) - np.clip(0.5 * x, 80.0, 150.0))
        >>> [round(number, 4) for number in old.bettered(1.0).gain_of_cycle(old).new]
        [1.0, 0.1406, 0.0527]
        """
        was, new = (tuple(max(order) for order in zip(*map(peaks_of, each.moves), strict=True)) for each in (old, self))
        if old.corners:
            was = was[0], inf, inf
        if self.corners:
            new = new[0], inf, inf
        corners = [part.corner for part in self.moves if part.corner is not None]
        at_corners = np.abs(self.at(corners) - old.at(corners)).max(initial=0.0)
        deviation = max([float(at_corners), *(each.deviation for each in self.gains(old))])
        first, last = old.stretches[0], old.stretches[-1]
        return MoveGain("whole cycle", first.start, last.stop, was, new, deviation, old.peaks)

    def plot(self, ax: Any = None, *, new: OldTable | None = None, **style: Any) -> list[Any]:
        """Draw the points and the laws over the master: positions, velocity, acceleration, jerk; return the artists.

        Parameters
        ----------
        ax
            Four axes of matplotlib, five with a new table; a new figure unless given.
        new
            A table with better laws, to be drawn beside it, and how far it is off.
        style
            As of `Axes.plot`, for the curves.

        Raises
        ------
        InputError
            If there are not as many axes.

        Examples
        --------
        >>> from optlaws import catalogue, split_table
        >>> law = catalogue["cycloidal"].law
        >>> table = split_table(np.arange(361.0), [30 * float(law(min(x / 120, 1))) for x in range(361)])
        >>> len({artist.axes for artist in table.plot()})
        4
        """
        from optlaws.plots.old_table import draw_old_table

        return draw_old_table(self, ax, new, **style)

    def at(self, places: Any) -> Array:
        """The positions of its laws at places of the master, an array of the same shape, in units of the table.

        Examples
        --------
        >>> from optlaws import catalogue, split_table
        >>> law = catalogue["cycloidal"].law
        >>> table = split_table(np.arange(361.0), [30 * float(law(min(x / 120, 1))) for x in range(361)])
        >>> table.at([0.0, 60.0, 200.0]).round(9).tolist()
        [0.0, 15.0, 30.0]
        """
        x = np.asarray(places, dtype=np.float64)
        y = np.full(x.shape, self.stretches[0].low)
        for part in self.stretches:
            inside = x >= part.start
            y[inside] = position(part, x[inside])
        return y

    def unit_of(self, nu: int) -> str:
        """The unit of the derivative of order nu by the master, up to 3."""
        return f"{self.unit}/{self.master}{('', '', '²', '³')[nu]}" if nu else self.unit

    @property
    def off(self) -> tuple[float, float]:
        """The greatest deviation of the laws from the points, in units of the table, and its place; recomputed."""
        apart = np.abs(self.at(self.places) - self.heights)
        apart[list(self.outliers)] = 0.0
        worst = int(np.argmax(apart))
        return float(apart[worst]), float(self.places[worst])

    @kept_property
    def corners(self) -> tuple[float, ...]:
        """The places at which the velocity of its laws jumps, that of its end too where this does not meet its start.

        Examples
        --------
        >>> from optlaws import split_table
        >>> x = np.arange(0.0, 361.0, 5.0)
        >>> split_table(x, np.clip(x, 30.0, 100.0) - np.clip(0.5 * x, 80.0, 150.0)).corners
        (30.0, 100.0, 160.0, 300.0)
        """
        return corners_of(self.stretches)

    @property
    def peaks(self) -> tuple[PeakInterval, ...]:
        """Between which values the peaks of velocity, acceleration and jerk by the master are, of all moves."""
        of_moves = [part.peaks for part in self.moves if part.peaks]
        return tuple(
            PeakInterval(max(each.low for each in order), max(each.high for each in order))
            for order in zip(*of_moves, strict=True)
        )

    @property
    def moves(self) -> tuple[Stretch, ...]:
        """The rises and returns of the table."""
        return tuple(part for part in self.stretches if part.law is not None)

    def __str__(self) -> str:
        lines = [
            f"{part.kind:<7}{part.start:g} to {part.stop:g} {self.master}"
            + ("" if part.law is None else f", {part.stroke:+g} {self.unit}: {self.law_in_words(part)}")
            for part in self.stretches
        ]
        return "\n".join([*lines, *self.remarks])

    @property
    def remarks(self) -> tuple[str, ...]:
        """How near the laws are to the points, what noise these show, and whether the end meets the beginning."""
        smoothed = f" as moving means of {self.averaged} do" if self.averaged > 1 else ""
        size = Amount(self.scatter, self.unit, 2)
        scatter = sentence(", which scatter by {}{}", size, smoothed) if self.scatter else ""
        remarks = [sentence("within {} of the points{}", Amount(self.room, self.unit, 3), scatter)]
        off, place = self.off
        if off > self.room * (1.0 + AGREEMENT):
            away, at = Amount(off, self.unit, 3), Amount(place, self.master)
            remarks.append(sentence("but {} off the point at {}", away, at))
        rests = [(part.stop - part.start, part) for part in self.stretches if part.law is None]
        if rests and self._moves_where_it_begins:
            _, rest = max(rests, key=lambda pair: pair[0])
            middle = Amount(0.5 * (rest.start + rest.stop), self.master, 3)
            remarks.append(
                sentence("it moves where it begins: its moves are whole where begin is {}, in a rest", middle)
            )
        lengths = [length := float(np.ptp(self.places)), length + float(np.diff(self.places)[-1])]
        units = [unit_of_rounding(np.array([each])) for each in lengths]
        if not self.whole and 0.0 < _ROUNDER * units[0] <= units[1]:
            of_rows, of_turn = (Amount(each, self.master, 6) for each in lengths)
            remarks.append(sentence("the rows are a turn of {}: say by turn if it is one of {}", of_rows, of_turn))
        if self.stretches[0].start:
            remarks.append(
                sentence("the cycle begins at {} of its master", Amount(self.stretches[0].start, self.master))
            )
        if self.peaks:
            remarks.append(sentence("greatest {}", joined(", ", map(self.peak_in_words, (1, 2, 3)))))
        remarks += self._waves_in_words()
        if self.corners:
            remarks.append(sentence("the velocity jumps at {}, as far as the points tell", self._named(self.corners)))
        if self.outliers:
            far = self._named(self.places[list(self.outliers)].tolist())
            remarks.append(sentence("far off the motion and left out: the points at {}", far))
        gaps = [f"{start:.6g} to {stop:.6g}" for start, stop in gaps_of(self.places, self.heights, self.room)]
        if gaps:
            remarks.append(
                sentence("no points are from {} {}: between them is what goes on best", joined(", ", gaps), self.master)
            )
        if self.seam:
            remarks.append(sentence("the last position is {} from the first one", Amount(self.seam, self.unit, 3)))
        return tuple(remarks)

    def _waves_in_words(self) -> list[Sentence]:
        if not self.waves or any(part.solution is not None for part in self.stretches):
            return []
        size, number = max(self.waves)
        count = round(number * float(np.ptp(self.places)) / (2.0 * np.pi))
        words = "the points show waves of {}, {} over the rows, and these values count them"
        return [sentence(words, Amount(size, self.unit, 2), count)]

    def _named(self, places: Sequence[float]) -> str:
        named, more = joined(", ", [Amount(x, self.master) for x in places[:_MOST_NAMED]]), len(places) - _MOST_NAMED
        return sentence("{} and {} others", named, more) if more > 0 else named

    @property
    def _moves_where_it_begins(self) -> bool:
        """Whether its first stretch begins with a velocity."""
        if self.stretches[0].law is None:
            return False
        law = law_of_move(self.stretches[0])
        return abs(float(law.b(0.0))) > _MOVING * law.peak(1).value

    def peak_in_words(self, nu: int) -> str:
        """Between which values the greatest derivative of order nu is, by the points."""
        low, high = self.peaks[nu - 1]
        if low == inf:
            return sentence("{} without bound", QUANTITIES[nu])
        if f"{low:.4g}" == f"{high:.4g}":
            return sentence("{} {}", QUANTITIES[nu], Amount(low, self.unit_of(nu), 4))
        least, most = (Amount(value, self.unit_of(nu), 4) for value in (low, high))
        if high > _USELESS * low:
            return sentence("{} above {}, how much cannot be known from this table", QUANTITIES[nu], least)
        return sentence("{} {} to {}", QUANTITIES[nu], f"{low:.4g}", most)

    def reason_in_words(self, part: Stretch) -> str:
        """Why a move keeps its law, with a tolerance within which one has less acceleration."""
        if not part.sufficient_tolerance:
            return part.reason
        enough = Amount(part.sufficient_tolerance, self.unit, 3)
        if part.solution is not None:
            return sentence("{}; within {} none stays", part.reason, enough)
        return sentence(
            "{}; within {} one has {} less acceleration", part.reason, enough, f"{part.sufficient_gain:.1%}"
        )

    def blend_in_words(self, part: Stretch) -> str:
        """From where to where a corner is taken away, with the acceleration there."""
        C = peaks_of(part)[1]
        ends = f"{part.start:.5g}", Amount(part.stop, self.master, 5)
        return sentence(
            "the corner at {} to {} is taken away, with an acceleration of {}", *ends, Amount(C, self.unit_of(2), 3)
        )

    def law_in_words(self, part: Stretch) -> str:
        """The standard law of a move, or the nearest standard law, with the deviation of the points from it."""
        if isinstance(part.law, str):
            return sentence("{} (within {})", part.law, Amount(part.distance, self.unit, 2))
        if not part.nearest:
            return "a law of its own, not from rest to rest"
        distance = Amount(part.distance, self.unit, 2)
        return sentence("a law of its own; the nearest standard law is {}, {} off", part.nearest, distance)
