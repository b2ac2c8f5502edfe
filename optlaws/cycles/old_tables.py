"""Tables of whole cycles from old cams and controllers: their dwells, rises and returns, and what laws these are."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from struct import pack, unpack
from typing import Literal, TypeAlias

import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.segments import CycleSegment, Dwell, Return, Rise
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.catalogue.reading import points_of
from optlaws.laws.making.through_points import law_through, noise
from optlaws.numbers import Array, Quantity, not_negative, positive
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import at_most
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Chebyshev
from optlaws.tolerances import MODERNISED_JERK, NOISE_ROOM, STANDARD_LAW_ROOM

StretchKind: TypeAlias = Literal["dwell", "rise", "return"]

#: a dwell has as many points at least
_FEWEST = 3
#: and in the middle of one of as many points the motion rests indeed
_LONG = 12
#: how many places of an old spline stand for it
_SPLINE_PLACES = 721
#: places at which the old law and the new one are compared
_COMPARED = 41
#: steps to which the ends of moves are rounded where the points allow it, in parts of the master's turn
_ROUND = (1.0 / 36.0, 1.0 / 72.0, 1.0 / 360.0, 1.0 / 720.0, 1.0 / 3600.0)


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
    """

    kind: StretchKind
    start: float
    stop: float
    low: float
    high: float
    law: str | MotionLaw | None = None
    nearest: str = ""
    distance: float = 0.0

    @property
    def stroke(self) -> float:
        """The displacement from its start to its end."""
        return self.high - self.low


@dataclass(frozen=True, eq=False)
class OldTable:
    """A table of a whole cycle, divided into dwells, rises and returns.

    Attributes
    ----------
    stretches
        Its parts in order.
    room
        How far a law may be from the points: what was given, else the last digit or what the noise asks for.
    scatter
        The standard deviation of the noise that the points show; 0 where none is seen.
    seam
        By how much the last position differs from the first one.
    unit, master
        The units of positions and of the master.

    Examples
    --------
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

    def cycle(self, *, speed: Quantity | None = None, period: Quantity | None = None) -> Cycle:
        """The cycle of the table, at a speed of the master or of a period.

        Raises
        ------
        InputError
            If both or neither is given where the master is an angle.
        """
        return self._cycle([part.law for part in self.stretches], speed, period)

    def modernised(
        self,
        tolerance: float,
        *,
        speed: Quantity | None = None,
        period: Quantity | None = None,
        order: int = 3,
        degree: int = 15,
    ) -> Cycle:
        """The cycle with the laws of least acceleration that stay within a tolerance of the old ones everywhere.

        Parameters
        ----------
        tolerance
            In units of the table, above 0.
        speed, period
            As of `cycle`.
        order, degree
            Of the new laws; their jerk is at most a fifth above the old one where that has a greatest value.
        """
        room = positive(tolerance, "tolerance")
        laws = [self._better(part, room, order, degree) for part in self.stretches]
        return self._cycle(laws, speed, period)

    def _better(self, part: Stretch, room: float, order: int, degree: int) -> MotionLaw | None:
        if part.law is None:
            return None
        old = catalogue[part.law].law if isinstance(part.law, str) else part.law
        k = np.linspace(0.0, 1.0, _COMPARED)
        points = ", ".join(f"{place:.9g}:{height:.9g}" for place, height in zip(k, old(k), strict=True))
        share = room / abs(part.stroke)
        near = Window(f"a - spline(k, {points})", low=-share, high=share)
        jerk = MODERNISED_JERK * old.constants.J.value
        problem = Problem(
            order=order, basis=Chebyshev(degree), symmetric=False, windows=(near,),
            J=at_most(jerk) if np.isfinite(jerk) else None,
        )  # fmt: skip
        return synthesize(problem).law

    def _cycle(self, laws: Sequence[str | MotionLaw | None], speed: Quantity | None, period: Quantity | None) -> Cycle:
        segments: list[CycleSegment] = []
        for part, law in zip(self.stretches, laws, strict=True):
            duration = f"{part.stop - part.start!r} {self.master}"
            if law is None:
                segments.append(Dwell(duration))
            else:
                move = Rise if part.stroke > 0.0 else Return
                segments.append(move(f"{abs(part.stroke)!r} {self.unit}", duration, law=law))
        start = f"{self.stretches[0].low!r} {self.unit}"
        ahead = self.stretches[-1].high - self.stretches[0].low
        if self.master in {"s", "ms"} and speed is None and period is None:
            period = f"{self.stretches[-1].stop - self.stretches[0].start!r} {self.master}"
        advance = f"{ahead!r} {self.unit}" if ahead else None
        return Cycle(segments, speed=speed, period=period, start=start, advance=advance)

    def __str__(self) -> str:
        lines = [
            f"{part.kind:<7}{part.start:g} to {part.stop:g} {self.master}"
            + ("" if part.law is None else f", {part.stroke:+g} {self.unit}: {self._law_in_words(part)}")
            for part in self.stretches
        ]
        lines.append(
            f"within {self.room:.3g} {self.unit} of the points"
            + (f", which scatter by {self.scatter:.2g}" if self.scatter else "")
        )
        if self.seam:
            lines.append(f"the last position is {self.seam:+.3g} {self.unit} from the first one")
        return "\n".join(lines)

    def _law_in_words(self, part: Stretch) -> str:
        if isinstance(part.law, str):
            return f"{part.law} (within {part.distance:.2g} {self.unit})"
        return f"a law of its own; the nearest standard law is {part.nearest}, {part.distance:.2g} {self.unit} off"


def read_cycle_table(
    file: str | Path,
    *,
    tolerance: float | None = None,
    columns: Sequence[int | str] | None = None,
    unit: str = "mm",
    master: str = "deg",
) -> OldTable:
    r"""A table of a whole cycle from a file, divided into dwells, rises and returns.

    Parameters
    ----------
    file
        Points in columns (.csv, .txt, .tsv, .tab, .dat), as `read_law` takes them, or a project of Rockwell's Logix
        Designer (.L5X) with a cam profile.
    tolerance
        How far laws may be off the points, in units of the table; the last digit, or what the noise asks for, unless
        given.
    columns
        Which hold the master and the position, by headings or numbers from 1.
    unit, master
        The units of the positions and of the master: "mm", "deg", "s" and the like.

    Raises
    ------
    InputError
        If the file cannot be read, or its points make no cycle of dwells and moves from rest to rest.

    Examples
    --------
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
    if path.suffix.lower() == ".l5x":
        x, y = _spline_of_l5x(reading.text(path, legacy=True), str(path))
        return split_table(x, y, tolerance=tolerance, unit=unit, master=master)
    points = points_of(path, columns)
    try:
        return split_table(
            points.places, points.heights, tolerance=tolerance, unit=unit, master=master, digit=points.digit
        )
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def split_table(
    x: Sequence[float] | Array,
    y: Sequence[float] | Array,
    *,
    tolerance: float | None = None,
    unit: str = "mm",
    master: str = "deg",
    digit: float = 0.0,
) -> OldTable:
    """The dwells, rises and returns of a table of a whole cycle.

    Parameters
    ----------
    x, y
        Increasing places of the master and positions there, as many, at least 12.
    tolerance
        How far laws may be off the points; what the noise asks for unless given.
    unit, master
        The units of positions and places.
    digit
        The unit of the last digit of the positions, where they are rounded.

    Raises
    ------
    InputError
        If the points are too few, do not increase, never move, or turn without rest in a way that no law fits.

    Examples
    --------
    >>> x = np.linspace(0.0, 360.0, 181)
    >>> rise, back = np.clip(x / 100.0, 0.0, 1.0), np.clip((x - 160.0) / 100.0, 0.0, 1.0)
    >>> law = catalogue["modified trapezoid"].law
    >>> print(split_table(x, np.round(20.0 * (law(rise) - law(back)), 4), digit=1e-4))
    rise   0 to 100 deg, +20 mm: modified trapezoid (within 4.2e-05 mm)
    dwell  100 to 160 deg
    return 160 to 260 deg, -20 mm: modified trapezoid (within 4.2e-05 mm)
    dwell  260 to 360 deg
    within 0.0001 mm of the points
    """
    places, heights = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    if places.shape != heights.shape or places.ndim != 1 or len(places) < 12:
        raise InputError(f"a cycle's table has at least 12 points, as many places as positions, got {shortened(x)}")
    if not np.all(np.diff(places) > 0.0) or not np.all(np.isfinite(heights)):
        raise InputError("the places of a table must increase, and its positions be finite numbers")
    stroke = float(np.ptp(heights))
    if stroke == 0.0:
        raise InputError("the table never moves: all its positions are the same")
    scatter = noise((places - places[0]) / np.ptp(places), heights / stroke) * stroke
    least = max(digit, STANDARD_LAW_ROOM * stroke)
    if tolerance is not None:
        room = max(not_negative(tolerance, "tolerance"), STANDARD_LAW_ROOM * stroke)
    else:
        room = max(least, NOISE_ROOM * scatter)
        # joints of a standard law may look like noise
        if room > least and (split := _of_standard_laws(places, heights, least)):
            return OldTable(split, least, 0.0, _seam(heights, least), unit, master)
    stretches = tuple(_stretches(places, heights, room))
    return OldTable(stretches, room, scatter, _seam(heights, room), unit, master)


def _of_standard_laws(places: Array, heights: Array, room: float) -> tuple[Stretch, ...] | None:
    """The parts of a table whose moves are all standard laws; None where one is not."""
    stretches = []
    try:
        for part in _stretches(places, heights, room):
            if isinstance(part.law, MotionLaw):
                return None
            stretches.append(part)
    except InputError:
        return None
    return tuple(stretches)


def _seam(heights: Array, room: float) -> float:
    """By how much the last position differs from the first one; 0 within the room."""
    seam = float(heights[-1] - heights[0])
    return seam if abs(seam) > room else 0.0


@dataclass(frozen=True)
class _Rest:
    """A run of points at one level."""

    first: int
    last: int
    level: float


def _rests(heights: Array, room: float) -> Iterator[_Rest]:
    """Runs of points that keep within the room of a level, and single points at which the motion turns."""
    count, i = len(heights), 0
    while i < count:
        low = high = heights[i]
        j = i
        while j + 1 < count and max(high, heights[j + 1]) - min(low, heights[j + 1]) <= 2.0 * room:
            j += 1
            low, high = min(low, heights[j]), max(high, heights[j])
        turns = i > 0 and j + 1 < count and (heights[i - 1] - heights[i]) * (heights[j + 1] - heights[j]) > 0.0
        if j - i + 1 >= _FEWEST or turns or i == 0 or j == count - 1:
            yield _Rest(i, j, _level(heights, i, j))
            i = j + 1
        else:
            i += 1


def _level(heights: Array, first: int, last: int) -> float:
    """The level of a run: the median of the middle of a long one, of a short one what is farthest from the moves."""
    quarter = (last - first) // 4
    if last - first + 1 >= _LONG:
        return float(np.median(heights[first + quarter : last - quarter + 1]))
    beside = [float(heights[i]) for i in (first - 1, last + 1) if 0 <= i < len(heights)]
    run = heights[first : last + 1]
    return float(run.max() if np.mean(beside) < np.mean(run) else run.min())


def _joined(rests: Sequence[_Rest], room: float) -> list[_Rest]:
    """Runs at one level that follow each other as one, and levels that differ by no more than the room as one level."""
    joined: list[_Rest] = []
    longest = sorted(rests, key=lambda rest: rest.first - rest.last)
    for rest in rests:
        level = next(other.level for other in longest if abs(other.level - rest.level) <= 2.0 * room)
        first = joined.pop().first if joined and joined[-1].level == level else rest.first
        joined.append(_Rest(first, rest.last, level))
    return joined


def _stretches(places: Array, heights: Array, room: float) -> Iterator[Stretch]:
    rests = _joined(list(_rests(heights, room)), room)
    # what rises or falls through a short run does not rest there
    apart = [rests[0]]
    for rest, after in pairwise(rests[1:]):
        passes = (rest.level - apart[-1].level) * (after.level - rest.level) > 0.0
        if not passes or rest.last - rest.first + 1 >= _LONG:
            apart.append(rest)
    apart.append(rests[-1])
    moves = (_move(places, heights, first, last, room) for first, last in pairwise(apart))
    turn = float(np.ptp(places))
    at = float(places[0])
    for move, rest in zip(moves, apart, strict=False):
        if move.start - at > _ROUND[-1] * turn:
            yield Stretch("dwell", at, move.start, rest.level, rest.level)
        yield move
        at = move.stop
    if places[-1] - at > _ROUND[-1] * turn:
        yield Stretch("dwell", at, float(places[-1]), apart[-1].level, apart[-1].level)


def _move(places: Array, heights: Array, first: _Rest, last: _Rest, room: float) -> Stretch:
    """The move between two rests: by the standard law that is nearest, or by one through its points."""
    low = first.first if first.last - first.first < _LONG else (first.first + first.last) // 2
    high = last.last if last.last - last.first < _LONG else (last.first + last.last + 1) // 2
    x, y = places[low : high + 1], (heights[low : high + 1] - first.level) / (last.level - first.level)
    share = room / abs(last.level - first.level)
    fits = [(*_fitted(x, y, catalogue[name].law), name) for name in catalogue]
    distance, start, stop, name = min(fits)
    law = catalogue[name].law
    kind: StretchKind = "rise" if last.level > first.level else "return"
    if distance <= 1.5 * share:
        start, stop = _rounded(x, y, law, (start, stop), share)
        distance = _distance(x, y, law, start, stop)
    if distance <= share * (1.0 + 1e-9):
        return Stretch(kind, start, stop, first.level, last.level, name, name, distance * abs(last.level - first.level))
    inner = np.flatnonzero((y > share) & (y < 1.0 - share))
    begin, end = max(int(inner[0]) - 1, 0), min(int(inner[-1]) + 1, len(x) - 1)
    begin = min(begin, int(np.searchsorted(x, start, side="right")) - 1) if start > x[0] else 0
    end = max(end, int(np.searchsorted(x, stop))) if stop < x[-1] else len(x) - 1
    through = law_through(x[begin : end + 1], np.clip(y[begin : end + 1], 0.0, 1.0), tolerance=share)
    size = distance * abs(last.level - first.level)
    return Stretch(kind, float(x[begin]), float(x[end]), first.level, last.level, through, name, size)


def _distance(x: Array, y: Array, law: MotionLaw, start: float, stop: float) -> float:
    return float(np.abs(law(np.clip((x - start) / (stop - start), 0.0, 1.0)) - y).max())


def _fitted(x: Array, y: Array, law: MotionLaw) -> tuple[float, float, float]:
    """How far the points are from a law at most, and where it begins and ends then, by least squares."""
    from scipy.optimize import least_squares

    k = np.linspace(0.0, 1.0, 401)
    tenth, ninth = (float(np.interp(share, law(k), k)) for share in (0.1, 0.9))
    rising = np.maximum.accumulate(y)
    first, last = (float(np.interp(share, rising, x)) for share in (0.1, 0.9))
    length = max((last - first) / (ninth - tenth), float(np.diff(x).min()))
    guess = first - tenth * length

    def missed(ends: Array) -> Array:
        start, stop = ends
        return np.asarray(law(np.clip((x - start) / max(stop - start, 1e-9 * length), 0.0, 1.0)) - y)

    solution = least_squares(missed, [guess, guess + length], x_scale=length, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    start, stop = map(float, solution.x)
    return float(np.abs(missed(solution.x)).max()), start, stop


def _rounded(x: Array, y: Array, law: MotionLaw, ends: tuple[float, float], room: float) -> tuple[float, float]:
    """The ends of a move rounded as much as the points allow, and within them."""
    turn = 360.0 if float(np.ptp(x)) > 12.0 else 1.0
    for share in _ROUND:
        step = share * turn
        start, stop = (max(min(round(end / step) * step, float(x[-1])), float(x[0])) for end in ends)
        if start < stop and _distance(x, y, law, start, stop) <= room:
            return start, stop
    return max(ends[0], float(x[0])), min(ends[1], float(x[-1]))


#: an element of a cam profile: its status, halves of two doubles, its kind, halves of four coefficients
_ELEMENT = re.compile(r"\[((?:\s*-?\d+\s*,){13}\s*-?\d+\s*)\]")


def _spline_of_l5x(text: str, name: str) -> tuple[Array, Array]:
    """Places of the cubic spline of the first cam profile in a project of Logix Designer, and its positions there."""
    elements = [[int(part) for part in match[1].split(",")] for match in _ELEMENT.finditer(text)]
    if len(elements) < 2:
        raise InputError(f"{name} holds no cam profile: elements of 14 whole numbers in brackets")
    rows = [[_double(row[i], row[i + 1]) for i in (1, 3, 6, 8, 10, 12)] for row in elements]
    count = next((i for i in range(1, len(rows)) if rows[i][0] <= rows[i - 1][0]), len(rows))
    knots = np.array([row[0] for row in rows[:count]])
    if count < 2:
        raise InputError(f"{name}: the places of its cam profile do not increase")
    x = np.unique(np.concatenate([np.linspace(knots[0], knots[-1], _SPLINE_PLACES), knots]))
    piece = np.clip(np.searchsorted(knots, x, side="right") - 1, 0, count - 2)
    table = np.array(rows[:count])[piece]
    d = x - table[:, 0]
    return x, table[:, 1] + d * (table[:, 3] + d * (table[:, 4] + d * table[:, 5]))


def _double(high: int, low: int) -> float:
    """The double whose halves are two whole numbers of 32 bits."""
    (value,) = unpack(">d", pack(">ii", high, low))
    return float(value)
