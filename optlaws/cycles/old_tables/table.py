"""Tables of whole cycles from old cams and controllers: their dwells, rises and returns, and the laws of these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.old_tables.better_laws import MoveGain, bettered, gain, peaks_of, without_corners
from optlaws.cycles.old_tables.frame import (
    begun,
    closed,
    in_order,
    in_unit,
    of_lobe,
    period_of,
    unwound,
    whole_turn,
    with_rests,
)
from optlaws.cycles.old_tables.motion import motion_of
from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.cycles.old_tables.reading import points_in
from optlaws.cycles.old_tables.rests_and_lines import NOISE_ROOM
from optlaws.cycles.old_tables.samples import gaps_of, samples_of, unit_of_rounding
from optlaws.cycles.old_tables.stated_functions import stretches_of_pieces
from optlaws.cycles.old_tables.stretches import Stretch, corners_of, law_of_move, position, seam_of, stretches_of
from optlaws.cycles.specification.segments import CycleSegment, Dwell, Return, Rise
from optlaws.errors import InputError, located
from optlaws.files import reading
from optlaws.kept import kept_property
from optlaws.laws.catalogue.tables.columns import LARGEST_TABLE
from optlaws.laws.catalogue.tables.controller_files import FEWEST_POINTS
from optlaws.laws.catalogue.tables.curve_pieces import APART, CurvePiece
from optlaws.laws.catalogue.tables.table_points import TablePoints, TableUnits
from optlaws.motion.quantities import QUANTITIES, Exact, either
from optlaws.numbers import Array, NumberOrQuantity, Quantity, not_negative, numbers, positive
from optlaws.sentences import Amount, joined, sentence
from optlaws.tolerances import AGREEMENT

_TIMES = {"s", "ms"}
_USELESS = 10.0  # times the lower end of an interval: an upper end that is more tells nothing
_MOST_NAMED = 8  # places that a remark lists
_MOVING = 1e-3  # of the greatest velocity of a stretch: it begins with one that is more
_WHOLE_TURN = 1e-6  # of a turn: by how much rows that are one may be longer or shorter
_ROUNDER = 9.0  # times the unit to which one length is rounded: another one is rounder
_LESS_NOISE = 0.5  # of the noise by differences: where rows are nearer to the fitted motion that is the noise
_STANDARD_LAW_ROOM = 1e-7  # of the stroke of a table with all digits: by how much a standard law may be off its points


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

    Examples
    --------
    >>> from optlaws import catalogue
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

    def cycle(self, *, speed: NumberOrQuantity | None = None, period: NumberOrQuantity | None = None) -> Cycle:
        """The cycle of the table, at a speed or a period; at the speed of the file if neither is given.

        Raises
        ------
        InputError
            If both are given, or neither where the master is an angle whose speed the file does not say; if the
            velocity jumps at a corner.

        Examples
        --------
        >>> x = np.arange(0.0, 1500.0, 10.0)  # mm of a web, of which 1,500 are a turn
        >>> table = split_table(x, 5.0 - 5.0 * np.cos(2.0 * np.pi * x / 1500.0), master="mm", turn=1500.0)
        >>> round(table.cycle(speed="3 m/s").duration, 9)
        0.5
        """
        first, last = self.stretches[0], self.stretches[-1]
        turn, times = last.stop - first.start, self.master in _TIMES
        of_turn = whole_turn(None, self.master)
        if not self.whole and of_turn and abs(turn - of_turn) > _WHOLE_TURN * of_turn:
            raise InputError(
                f"the rows go over {turn:.9g} {self.master}, and a turn of the master is {of_turn:.9g}: say by turn "
                "how long it is, such as turn='720 deg', or by lobes how often the rows follow each other in it"
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
            remedy = joined("; ", left) if left else "modernise it within a tolerance, which takes corners away"
            raise InputError(
                f"the velocity jumps at {self._named(self.corners)}, and that of a cycle does not: {remedy}"
            )
        segments: list[CycleSegment] = []
        for part in self.stretches:
            length = part.stop - part.start
            duration = Exact(length, self.master) if times or not self.whole else Exact(360.0 * length / turn, "deg")
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
        >>> from optlaws import catalogue
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
        >>> from optlaws import catalogue
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

        Its deviation is the greatest one of `gains`, beside corners that are taken away.

        Examples
        --------
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
        deviation = max((each.deviation for each in self.gains(old)), default=0.0)
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
        >>> from optlaws import catalogue
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
        >>> from optlaws import catalogue
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
        scatter = sentence(", which scatter by {}", Amount(self.scatter, self.unit, 2)) if self.scatter else ""
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


def read_cycle_table(
    file: str | Path,
    *,
    tolerance: float | None = None,
    columns: Sequence[int | str] | None = None,
    unit: str | None = None,
    master: str | None = None,
    cam: str | None = None,
    turn: Quantity | None = None,
    advance: Quantity | None = None,
    rows: int | None = None,
    lobes: int = 1,
    begin: Quantity | None = None,
) -> OldTable:
    r"""A table of a whole cycle from a file, divided into dwells, rises and returns.

    Parameters
    ----------
    file
        Points in columns, as `read_law` takes them, with derivatives in further ones, or what a controller has: every
        format that optlaws writes, Structured Text with the structures of CODESYS, TwinCAT, Siemens, ABB, B&R or
        Rockwell, XML of PLCopen, a project of Logix Designer (.L5X), a trajectory of ROS. Its content decides the
        layout, not its name.
    tolerance
        How far laws may be off the points, in units of the table; the last digit, or what the noise requires, unless
        given.
    columns
        Columns that hold the master and the position, by headings or numbers from 1; behind these the derivatives of
        the position by the master, or, of 12 points or more, by the second.
    unit, master
        The units of the positions and of the master: "mm", "deg", "s" and the like, or "0.01 mm" where numbers count
        these. What the file says unless given, else "mm", and "deg", "turn" or "rad" by the master's length. A master
        may be an angle, a time or a length.
    cam
        Which cam of a file with several: a tag of Logix Designer, a joint of ROS, a heading of a column.
    turn
        How much of the master is a turn, such as "720 deg" of a crank or "1500 mm" of a web, where the row of its end
        is missing or it is none of 360 deg; from the first to the last row unless given.
    advance
        What the position advances by in a turn, of an endless motion whose last row is missing.
    rows
        How many rows count, from the first one on, where spare ones follow.
    lobes
        How often the rows follow each other in a turn, where they are one lobe of several; each advances by as much.
    begin
        Where the cycle begins on the master, such as "220 deg" in a rest of a table that moves where it begins.

    Raises
    ------
    InputError
        If the file cannot be read or is damaged, or its points make no cycle of dwells and moves from rest to rest.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> law = catalogue["3-4-5 polynomial"].law
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "index.txt"
    ...     _ = file.write_text("\n".join(f"{x} {45 * law(min(x / 180, 1)):.4f}" for x in range(361)))
    ...     table = read_cycle_table(file, unit="deg")
    >>> table.stretches[0].law, table.seam
    ('3-4-5 polynomial', 45.0)
    """
    path = Path(file)
    content = reading.text(path, LARGEST_TABLE, legacy=True)
    points = points_in(content, path, columns, unit=unit, master=master, cam=cam)
    return table_of(points, path, tolerance, turn=turn, advance=advance, rows=rows, lobes=lobes, begin=begin)


def table_of(
    points: TablePoints,
    path: Path,
    tolerance: float | None = None,
    *,
    turn: Quantity | None = None,
    advance: Quantity | None = None,
    rows: int | None = None,
    lobes: int = 1,
    begin: Quantity | None = None,
) -> OldTable:
    """The table of points with units, divided as by `read_cycle_table`; errors call the table `path`."""
    units, fewest = points.units, 2 if points.pieces else FEWEST_POINTS
    with located(str(path)):
        if rows is not None and not fewest <= rows <= len(points.places):
            raise InputError(f"rows must be from {fewest} to the {len(points.places)} points that it has, got {rows}")
        places, heights = points.places[:rows], points.heights[:rows]
        length = in_unit(turn, units.master, ("angle", "time", "length"), "turn")
        step = in_unit(advance, units.slave, ("length", "angle"), "advance")
        first = in_unit(begin, units.master, ("angle", "time", "length"), "begin")
        if points.pieces:
            if first is not None:
                raise InputError(
                    "begin is of a table of positions alone: leave it out, what runs between these is known"
                )
            pieces = points.pieces[: len(places) - 1]
            table = _of_pieces(pieces, places, heights, units, length, step, tolerance, lobes)
        else:
            places, heights = in_order(places, heights, whole_turn(length, units.master), points.lines[:rows])
            table = split_table(
                places, heights, turn=length, advance=step, lobes=lobes, begin=first, tolerance=tolerance,
                unit=units.slave, master=units.master, digit=points.digit,
            )  # fmt: skip
    return replace(table, layout=points.layout, rate=points.rate)


def _of_pieces(
    pieces: Sequence[CurvePiece],
    places: Array,
    heights: Array,
    units: TableUnits,
    turn: float | None,
    advance: float | None,
    tolerance: float | None,
    lobes: int,
) -> OldTable:
    """The table of functions that are stated between points."""
    if len(closed(places, heights, *of_lobe(lobes, turn, advance, units.master))[0]) > len(places):
        raise InputError(
            f"what runs from the last point, at {places[-1]:.9g}, to the end of the turn is not stated: add the point "
            "of its end, or leave turn out"
        )
    room = max(not_negative(tolerance or 0.0, "tolerance"), APART * float(np.ptp(heights)))
    whole = turn is not None or either(f"1 {units.master}", ("angle", "time", "length"), "master")[0] == "length"
    stretches, seam = stretches_of_pieces(pieces, room), seam_of(heights, room)
    table = OldTable(stretches, room, 0.0, seam, units.slave, units.master, places, heights, whole=whole)
    return _repeated(table, lobes)


def _repeated(table: OldTable, count: int) -> OldTable:
    """A table whose rows follow each other so many times."""
    length, rise = float(np.ptp(table.places)), table.stretches[-1].high - table.stretches[0].low if table.seam else 0.0
    stretches = list(table.stretches)
    for i in range(1, count):
        for part in table.stretches:
            shifted = replace(
                part, start=part.start + i * length, stop=part.stop + i * length, low=part.low + i * rise,
                high=part.high + i * rise,
            )  # fmt: skip
            before = stretches[-1]
            if shifted.law is None and before.law is None:
                stretches[-1] = replace(before, stop=shifted.stop)
            else:
                stretches.append(shifted)
    rows, turns = len(table.places) - 1, np.arange(count)[:, None]
    places = np.append((table.places[:-1] + turns * length).ravel(), table.places[-1] + (count - 1) * length)
    heights = np.append((table.heights[:-1] + turns * rise).ravel(), table.heights[-1] + (count - 1) * rise)
    outliers = tuple(i * rows + each for i in range(count) for each in table.outliers)
    return replace(
        table, stretches=tuple(stretches), seam=count * table.seam, places=places, heights=heights, outliers=outliers
    )


def split_table(
    x: Sequence[float] | Array,
    y: Sequence[float] | Array,
    *,
    tolerance: float | None = None,
    unit: str = "mm",
    master: str = "deg",
    digit: float = 0.0,
    turn: float | None = None,
    advance: float | None = None,
    lobes: int = 1,
    begin: float | None = None,
) -> OldTable:
    """The dwells, rises and returns of a table of a whole cycle.

    Parameters
    ----------
    x, y
        Increasing places of the master and positions there, as many, at least 12.
    tolerance
        The tolerance of the laws about the points; by default, the noise of the points.
    unit, master
        The units of positions and places.
    digit
        The unit of the last digit of the positions, where they are rounded.
    turn, advance
        The length of a turn of the master, and what the positions advance by in it, where the row of its end is missing
        or it is none of 360 deg; what the rows have unless given.
    lobes
        How often the points follow each other in a turn, where they are one lobe of several.
    begin
        Where the cycle begins on the master; at the first point unless given.

    Raises
    ------
    InputError
        If the points are too few, do not increase, never move, or turn without rest in a way that no law fits.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> x = np.linspace(0.0, 360.0, 181)
    >>> rise, back = np.clip(x / 100.0, 0.0, 1.0), np.clip((x - 160.0) / 100.0, 0.0, 1.0)
    >>> law = catalogue["modified trapezoid"].law
    >>> print(split_table(x, np.round(20.0 * (law(rise) - law(back)), 4), digit=1e-4))
    rise   0 to 100 deg, +20 mm: modified trapezoid (within 4.2e-05 mm)
    dwell  100 to 160 deg
    return 160 to 260 deg, -20 mm: modified trapezoid (within 4.2e-05 mm)
    dwell  260 to 360 deg
    within 0.0001 mm of the points
    greatest velocity 0.3992 to 0.4004 mm/deg, acceleration 0.009775 to 0.009786 mm/deg², jerk 0.00119 to 0.00123 ...
    """
    places, heights = np.array(numbers(x, "x")), np.array(numbers(y, "y"))
    if places.shape != heights.shape or places.ndim != 1 or len(places) < FEWEST_POINTS:
        positions = "" if heights.size == places.size else f" and {heights.size} positions"
        raise InputError(
            f"a cycle's table has at least {FEWEST_POINTS} points, as many places as positions, got {places.size}"
            f"{positions and ' places'}{positions}: a file of fewer has to state what runs between them, by functions "
            "or derivatives"
        )
    if not np.all(np.isfinite(places)) or not np.all(np.isfinite(heights)):
        raise InputError("the places and positions of a table must be finite numbers")
    whole = turn is not None or either(f"1 {master}", ("angle", "time", "length"), "master")[0] == "length"
    of_one = of_lobe(lobes, turn, advance, master)
    ordered = in_order(places, heights, whole_turn(turn, master))
    places, heights = closed(ordered[0], unwound(ordered[1], unit), *of_one, angle=master == "deg" and lobes == 1)
    places, heights = begun(places, heights, begin, of_one[1])
    stroke = float(np.ptp(heights))
    if stroke == 0.0:
        raise InputError("the table never moves: all its positions are the same")
    all_places, all_heights, given = with_rests(places, heights)
    samples = samples_of(all_places, all_heights, digit)
    least = max(samples.digit if digit else 0.0, _STANDARD_LAW_ROOM * stroke)
    room = least if tolerance is None else max(not_negative(tolerance, "tolerance"), _STANDARD_LAW_ROOM * stroke)
    scatter = samples.scatter
    if tolerance is not None:
        samples = replace(samples, noise=np.maximum(samples.noise, room / NOISE_ROOM))
    motion = motion_of(samples)
    if tolerance is None and not samples.rounded and scatter and motion.variance < _LESS_NOISE**2:
        # of few rows with all digits, differences show the motion itself
        samples = samples.with_noise(float(np.sqrt(motion.variance)))
        motion, scatter = motion_of(samples), samples.scatter
    if not motion.moves:
        raise InputError("the table never moves as far as its noise tells: its positions scatter about one level")
    if tolerance is None:
        room = max(room, NOISE_ROOM * scatter)
    table = OldTable(
        tuple(stretches_of(motion)), room, scatter, seam_of(heights, room), unit, master, samples.places[given],
        heights, whole=whole,
    )  # fmt: skip
    far = motion.samples.suspects[given] & (np.abs(table.at(table.places) - heights) > room)
    table = replace(table, outliers=tuple(np.flatnonzero(far).tolist()))
    return _repeated(table, lobes)
