"""Where a table rests or moves at constant velocity, as far as its noise tells."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from optlaws.cycles.old_tables.samples import Samples, window_polynomials
from optlaws.numbers import Array

#: standard deviations by which rows are off a motion at most
NOISE_ROOM = 4.0
#: rows of a rest at least, and of one whose rows are all equal
FEWEST, _EXACT = 8, 4
#: rows of a run at one level that show the noise, and the degree of the polynomial about which they do
_LONG, _RUN_DEGREE = 40, 4
#: of all rows: in noise, fewer do not tell a rest from the slow beginning of a move
_SHORTEST_REST = 1.0 / 200.0
#: sum of squares that a polynomial of degree 4 takes off noise by chance
_BENT = 14.0
#: rows of a window in which a motion is looked at for constant velocity, and the share of rows that one has at least
_WINDOW, _SHARE = 12, 0.06
#: rows of a line that few rows show, and times what noise may bend windows about its ends at least
_SHORT, _ABRUPT = 8, 15.0
#: where a rest begins and ends within its run from -1 to 1, of which it has a quarter at least
_TAILED = np.array(
    [(low, high) for low in np.linspace(-1.0, -0.1, 7) for high in np.linspace(1.0, 0.1, 7) if high - low >= 0.5]
)


@dataclass(frozen=True)
class Line:
    """Rows of constant velocity or at rest, from the first to the last one, with a position and its place."""

    first: int
    last: int
    level: float
    place: float = 0.0
    slope: float = 0.0

    @property
    def values(self) -> tuple[float, float, float]:
        """What an end of a curve takes."""
        return self.place, self.level, self.slope

    @property
    def is_short(self) -> bool:
        """Whether so few rows are on it that those of a slow bend may be."""
        return self.last - self.first < _WINDOW


def rests_of(samples: Samples) -> list[Line]:
    """Runs of rows that rest as far as the noise tells, the longest ones first taken, in order."""
    x, y = samples.places, samples.heights
    size = float(samples.noise.max())
    room = NOISE_ROOM * size + 0.5 * samples.digit
    runs = sorted(_level_runs(y, 2.0 * room), key=lambda run: run[0] - run[1])
    taken, fewest = np.zeros(len(y), dtype=bool), max(FEWEST, round(_SHORTEST_REST * len(y)))
    lines = []
    for run in runs:
        few = run[1] - run[0] + 1 < FEWEST  # no crest has most of so few rows at one position
        first, last = run
        if few:
            equal = max(_level_runs(y[first : last + 1], 0.0), key=lambda each: each[1] - each[0])
            first, last = first + equal[0], first + equal[1]
        exact = last - first + 1 >= _EXACT and np.ptp(y[first : last + 1]) == 0.0
        if (last - first + 1 < fewest and not exact) or taken[first : last + 1].any():
            continue
        taken[first : last + 1] = True
        if _is_rest(
            x[first : last + 1], y[first : last + 1], float(samples.noise[first : last + 1].max()), samples.digit
        ):
            quarter = (last - first + 1) // 4
            inner = y[first + quarter : last + 1 - quarter]
            lines.append(Line(first, last, float(np.mean(inner))))
    return _levelled(sorted(lines, key=lambda rest: rest.first), size)


def variance_of_level_rows(samples: Samples) -> float:
    """The variance of the longest run at one level about a polynomial, over that of the noise; 0 where it is short."""
    room = NOISE_ROOM * float(samples.noise.max()) + 0.5 * samples.digit
    first, last = max(_level_runs(samples.heights, 2.0 * room), key=lambda run: run[1] - run[0])
    if last - first + 1 < _LONG:
        return 0.0
    x, y, noise = (row[first : last + 1] for row in (samples.places, samples.heights, samples.noise))
    off = np.polynomial.Polynomial.fit(x, y, _RUN_DEGREE)(x) - y
    return float(((off / noise) ** 2).sum() / (len(x) - _RUN_DEGREE - 1))


def _level_runs(y: Array, most: float) -> Iterator[tuple[int, int]]:
    """For each row the longest run from it on whose positions differ by no more."""
    greatest: deque[int] = deque()
    least: deque[int] = deque()
    first, before = 0, -1
    for last in range(len(y)):
        while greatest and y[greatest[-1]] <= y[last]:
            greatest.pop()
        while least and y[least[-1]] >= y[last]:
            least.pop()
        greatest.append(last)
        least.append(last)
        while y[greatest[0]] - y[least[0]] > most:
            if last - 1 > before:
                yield first, last - 1
                before = last - 1
            first += 1
            while greatest[0] < first:
                greatest.popleft()
            while least[0] < first:
                least.popleft()
    yield first, len(y) - 1


def _is_rest(x: Array, y: Array, noise: float, digit: float) -> bool:
    """Whether a run rests, and is no crest of a motion: crests are bent all over."""
    count = len(x)
    if np.ptp(y) == 0.0:
        return True
    u = 2.0 * (x - 0.5 * (x[0] + x[-1])) / (x[-1] - x[0])
    size = max(noise, digit / np.sqrt(12.0))

    ones = np.ones((count, 1))
    polynomials = u[:, None] ** np.arange(5)
    flat, bent = (_squares_left(columns, y, size) for columns in (ones, polynomials))
    if flat - bent <= _BENT:
        return True
    sides = np.maximum(_TAILED[:, :1] - u, 0.0), np.maximum(u - _TAILED[:, 1:], 0.0)
    tails = (np.stack([np.ones_like(sides[0]), *(side**power for side in sides)], axis=-1) for power in (2, 3))
    return bool(min(_squares_left(columns, y, size).min() for columns in tails) < bent + 3.0)


def _squares_left(columns: Array, y: Array, size: float) -> Array:
    """The sum of squares, in so many of a size, that columns leave of rows, or each of several matrices."""
    normal, side = np.swapaxes(columns, -1, -2) @ columns, (y - y.mean()) @ columns
    solved = (np.linalg.pinv(normal, rcond=1e-12, hermitian=True) @ side[..., None])[..., 0]
    return np.asarray((((columns @ solved[..., None])[..., 0] - (y - y.mean())) ** 2).sum(axis=-1) / size**2)


def _levelled(rests: Sequence[Line], noise: float) -> list[Line]:
    """Rests at levels that the noise does not tell apart, at their common mean."""
    groups: list[list[Line]] = []
    for rest in sorted(rests, key=lambda rest: rest.level):
        last = groups[-1][-1] if groups else None
        if last is not None:
            counts = [max((each.last - each.first) // 2, 1) for each in (last, rest)]
            if rest.level - last.level <= NOISE_ROOM * noise * np.sqrt(sum(1.0 / count for count in counts)):
                groups[-1].append(rest)
                continue
        groups.append([rest])
    levels = {}
    for group in groups:
        weights = [rest.last - rest.first + 1 for rest in group]
        level = float(np.average([rest.level for rest in group], weights=weights))
        for rest in group:
            levels[rest] = level
    return [Line(rest.first, rest.last, levels[rest]) for rest in rests]


def lines_of(samples: Samples, first: int, last: int) -> list[Line]:
    """Long runs of rows of constant velocity between two rows."""
    x, y, noise = (row[first : last + 1] for row in (samples.places, samples.heights, samples.noise))
    count = len(x)
    rows = max(_WINDOW, count // 25)
    if count < 2 * rows:
        return []
    size = float(np.maximum(noise, samples.digit / np.sqrt(12.0)).max())
    lines = list[Line]()
    windows = np.flatnonzero(_bends(x, y, noise, rows, samples.digit) <= _BENT)
    # noise alone makes few windows beside each other bent
    runs = np.split(windows, np.flatnonzero(np.diff(windows) > rows // 2) + 1) if windows.size else []
    left = deque((int(run[0]), int(run[-1]) + rows - 1) for run in runs)
    while left:
        begin, end = low, high = left.popleft()
        trim = max(1, (high - low) // 20)
        while high - low + 1 >= max(_WINDOW, count * _SHARE):
            if _is_straight(x[low : high + 1], y[low : high + 1], size):
                line, low, high = _line(x, y, NOISE_ROOM * noise + 0.5 * samples.digit, low, high)
                lines.append(Line(first + low, first + high, *line))
                # in windows that are short beside noise a corner is not seen: others may be on its sides
                left.extend([(begin, low), (high, end)])
                break
            low, high = low + trim, high - trim
    lines += _short_lines(samples, first, last, lines)
    return _apart(samples.places, sorted(lines, key=lambda line: line.first), NOISE_ROOM * size)


def _bends(x: Array, y: Array, noise: Array, rows: int, digit: float) -> Array:
    """What polynomials of degrees 2 and 3 take off each window of rows, in variances of its noise."""
    size = np.maximum(sliding_window_view(noise, rows), digit / np.sqrt(12.0)).max(axis=1)
    bent = window_polynomials(sliding_window_view(x, rows), 3)[:, :, 2:]
    return np.asarray((np.einsum("ijk,ij->ik", bent, sliding_window_view(y, rows)) ** 2).sum(axis=1) / size**2)


def _short_lines(samples: Samples, first: int, last: int, lines: Sequence[Line]) -> Iterator[Line]:
    """Lines of few rows, beside others, at either end of which rows bend abruptly."""
    low, high = max(first - _SHORT, 0), min(last + _SHORT, len(samples.places) - 1)
    x, y, noise = (row[low : high + 1] for row in (samples.places, samples.heights, samples.noise))
    if len(x) < 2 * _SHORT:
        return
    bends = _bends(x, y, noise, _SHORT, samples.digit)
    straight = np.flatnonzero(bends <= _BENT)
    for run in np.split(straight, np.flatnonzero(np.diff(straight) > 1) + 1) if straight.size else []:
        begin, end = int(run[0]), int(run[-1]) + _SHORT - 1
        about = np.clip(np.array([begin, end]) - _SHORT // 2, 0, len(bends) - 1)
        begin, end = max(begin, first - low), min(end, last - low)
        few = end - begin + 1 < max(_SHORT, (last - first + 1) * _SHARE)
        if few or np.all(bends[about] < _ABRUPT * _BENT):
            continue
        if all(line.last <= low + begin or low + end <= line.first for line in lines):
            (level, place, slope), begin, end = _line(x, y, NOISE_ROOM * noise + 0.5 * samples.digit, begin, end)
            yield Line(max(low + begin, first), min(low + end, last), level, place, slope)


def joined_over_seam(samples: Samples, lines: Sequence[Line], advance: float) -> list[Line]:
    """Lines of a whole turn, of which the last one and the first one of the next turn are one where rows say so."""
    last = len(samples.places) - 1
    if len(lines) < 2 or lines[0].first > 0 or lines[-1].last < last:
        return list(lines)
    turn, begun = float(np.ptp(samples.places)), samples.begun_at(lines[-1].first, advance)
    rows = slice(0, last - lines[-1].first + lines[0].last + 1)
    x, y = begun.places[rows] - turn, begun.heights[rows] - advance
    inner = slice(len(x) // 8, len(x) - len(x) // 8)
    size = max(float(samples.noise.max()), samples.digit / np.sqrt(12.0))
    if not _is_straight(x[inner], y[inner], size):
        return list(lines)
    place = float(x[inner].mean())
    slope, level = map(float, np.polyfit(x[inner] - place, y[inner], 1))
    first = replace(lines[0], level=level, place=place, slope=slope)
    return [first, *lines[1:-1], replace(lines[-1], level=level + advance, place=place + turn, slope=slope)]


def _apart(x: Array, lines: Sequence[Line], room: float) -> list[Line]:
    """Lines with no rows in common but that of a corner, which is on both; noise puts further ones there."""
    apart = list[Line]()
    for line in lines:
        if not apart or apart[-1].last < line.first:
            apart.append(line)
        elif _are_at_a_corner(x, apart[-1], line, room):
            apart.append(replace(line, first=apart[-1].last))
    return apart


def _are_at_a_corner(x: Array, before: Line, after: Line, room: float) -> bool:
    """Whether two lines with rows in common have different slopes, and each enough rows of its own."""
    lengths = x[before.last] - x[before.first], x[after.last] - x[before.last]
    return after.last - before.last >= _WINDOW and abs(after.slope - before.slope) * min(lengths) > room


def _is_straight(x: Array, y: Array, noise: float) -> bool:
    """Whether rows are on a line as far as the noise tells."""
    u = 2.0 * (x - x[0]) / (x[-1] - x[0]) - 1.0
    left = []
    for degree in (1, 4):
        fit = np.polynomial.Polynomial.fit(u, y, degree, domain=[-1.0, 1.0])
        left.append(float(((y - fit(u)) ** 2).sum()))
    return left[0] - left[1] <= 1.5 * _BENT * noise**2


def _line(x: Array, y: Array, room: Array, low: int, high: int) -> tuple[tuple[float, float, float], int, int]:
    """The line of straight rows, with its level at a place and its slope, and the rows from and to which it goes on."""
    for parts in (4, 8):  # the moves beside it may reach into its ends
        inner = slice(low + (high - low) // parts, high + 1 - (high - low) // parts)
        place = float(x[inner].mean())
        slope, level = map(float, np.polyfit(x[inner] - place, y[inner], 1))
        # what rises by no more than noise is at rest as far as anybody can tell
        slope = 0.0 if 2.0 * abs(slope * (x[high] - x[low])) <= float(room[inner].max()) else slope
        apart = np.abs(y - level - slope * (x - place)) > room
        beyond = np.flatnonzero(apart[:-1] & apart[1:])  # noise alone puts single rows there
        low = int(beyond[beyond < inner.start].max(initial=-2)) + 2
        high = int(beyond[beyond >= inner.stop].min(initial=len(x))) - 1
    return (level, place, slope), low, high
