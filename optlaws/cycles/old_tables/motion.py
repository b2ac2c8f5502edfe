"""The motion of which a table has samples: its rests, found with the noise, and the moves between these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from optlaws.cycles.old_tables.fitted_moves import FittedMove, Parts
from optlaws.cycles.old_tables.region import Region, regions
from optlaws.cycles.old_tables.rests_and_lines import (
    FEWEST,
    NOISE_ROOM,
    Line,
    lines_of,
    rests_of,
    variance_of_level_rows,
)
from optlaws.cycles.old_tables.samples import Samples, goes_on, variance_about_spline

#: rows between two rests at one level that are so few are far off it, and no motion
_FEW_BETWEEN = 3
#: of the length of a turn: places that are nearer are the same
_SAME = 1e-9
#: rows from which on a spline shows the noise; and variance over that by differences that may be noise and no motion
_MANY, _MORE_NOISE, _MORE_NOISE_AT_REST = 100, 1.5, 4.0
#: of a turn: rests that are shorter are looked at as crests too, or for standard laws alone
_SHORT, _NOT_LONG = 0.05, 0.1
#: times what noise leaves open: an advance is rounded to what is more, 10, 1, 0.1 and so on
_ROUND_ADVANCE = 10.0


@dataclass(frozen=True, eq=False)
class FittedMotion:
    """The moves of a table with the rests between them."""

    samples: Samples  #: whose suspects are the points far off the motion
    moves: tuple[FittedMove, ...]
    variance: float  #: about it, over that of the noise by differences


def motion_of(samples: Samples) -> FittedMotion:
    """The motion of samples: rests as they are found, and between these moves with the models that rows allow."""
    clean = samples.without(samples.suspects)
    if len(clean.places) <= _MANY:
        return _motion_of(samples, clean, 1.0)
    if (about := variance_about_spline(clean)) > _MORE_NOISE:  # of moves of few rows
        about = variance_of_level_rows(clean)
    if 1.0 < about <= _MORE_NOISE_AT_REST:
        return _motion_of(samples, clean, about)
    motion = _motion_of(samples, clean, 1.0)
    certain = 1.0 + 3.0 * np.sqrt(2.0 / len(clean.places))
    return _motion_of(samples, clean, motion.variance) if certain < motion.variance <= _MORE_NOISE else motion


def _motion_of(samples: Samples, clean: Samples, share: float) -> FittedMotion:
    """The motion for noise of a variance that is a share of that by differences."""
    clean = replace(clean, noise=np.sqrt(share) * clean.noise)
    rests = rests_of(clean)
    far: list[float] = []
    # rows beside a level with the same rest before and behind them
    rows = [
        row
        for before, after in pairwise(rests)
        if before.level == after.level and after.first - before.last <= _FEW_BETWEEN + 1
        for row in range(before.last + 1, after.first)
    ]
    if rows:
        far = clean.places[rows].tolist()
        clean = clean.without(np.isin(clean.places, far))
        rests = rests_of(clean)
    advance = _advance(clean)
    turn, crests, tried, known = float(np.ptp(clean.places)), list[float](), list[float](), dict[object, Region]()
    doubtful = _doubtful(clean, rests)
    plain = doubtful if len(doubtful) == len(rests) else _explaining_crests(clean, rests, advance, known)
    begun, rests, divided = _divided(clean, plain, advance, known)
    if not divided.moves or not all(move.name or move.is_corner for move in divided.moves):
        other = _divided(clean, crests, advance, known)
        all_crests = bool(plain and divided.moves)
        if all_crests and divided.criterion(len(clean.places)) < other[2].criterion(len(clean.places)):
            crests = plain
        else:
            begun, rests, divided = other
        while untried := [middle for middle in _doubtful(begun, rests, divided.moves) if middle not in tried]:
            tried.append(untried[0])
            other = _divided(clean, [*crests, untried[0]], advance, known)
            if other[2].criterion(len(clean.places)) < divided.criterion(len(clean.places)):
                crests, (begun, rests, divided) = [*crests, untried[0]], other
    moves, far = divided.moves, far + divided.far
    turns = [int((0.5 * (move.start + move.stop) - clean.places[0]) // turn) for move in moves]
    moves = [move.moved(-k * turn, -k * advance) if k else move for k, move in zip(turns, moves, strict=True)]
    apart = np.abs(samples.places[:, None] - np.array(far)), np.abs(samples.places[:, None] + turn - np.array(far))
    suspects = samples.suspects | (np.minimum(*apart) < _SAME * turn).any(axis=1)
    moves.sort(key=lambda move: move.start)
    variance = share * divided.squares / max(len(clean.places) - divided.free, 1)
    return FittedMotion(replace(samples, suspects=suspects), tuple(moves), variance)


def _divided(
    samples: Samples, crests: list[float], advance: float, known: dict[object, Region]
) -> tuple[Samples, list[Line], Parts]:
    """The turn as it is begun, its rests and its moves; further rests that are none join the crests."""
    while True:
        begun, rests = _begun(samples, crests, advance)
        parts = [region.parts for region in _regions(samples, begun, rests, advance, known)]
        divided = Parts.joined(parts, len(rests))
        more = _crests(begun, rests, divided.moves)
        if not more:
            return begun, rests, divided
        crests += more


def _regions(
    samples: Samples, begun: Samples, rests: Sequence[Line], advance: float, known: dict[object, Region]
) -> list[Region]:
    """The regions between rests of a turn as it is begun; those that are `known` are these."""
    return regions(begun, [None, *rests, None], float(samples.places[-1]), advance, known, split=True)


def _explaining_crests(
    samples: Samples, rests: Sequence[Line], advance: float, known: dict[object, Region]
) -> list[float]:
    """The middles of rests, not long ones, that are crests where standard laws explain the rows far better then."""
    doubtful = _doubtful(samples, rests, short=_NOT_LONG)
    if not doubtful:
        return []
    tried = list[tuple[float, list[float]]]()
    for crests in ([], doubtful, *([middle] for middle in doubtful if len(doubtful) > 1)):
        begun, others = _begun(samples, crests, advance)
        explained = [region.explained for region in _regions(samples, begun, others, advance, known)]
        parts = [each for each in explained if each is not None]
        if len(parts) == len(explained):
            tried.append((Parts.joined(parts, len(others)).criterion(len(samples.places)), crests))
    return min(tried, key=lambda each: each[0], default=(0.0, list[float]()))[1]


def _doubtful(
    samples: Samples, rests: Sequence[Line], moves: Sequence[FittedMove] = (), short: float = _SHORT
) -> list[float]:
    """The middles of rests in noise, also over the end of a turn, which may be the crest of one motion.

    These are the short ones, and one over the end into which moves reach as far as they may from both sides.
    """
    x, y = samples.places, samples.heights
    over_end, reached, ends = 0.0, False, [at for move in moves for at in move.ends_at_bounds]
    if rests and rests[0].first == 0 and rests[-1].last == len(x) - 1:
        over_end = float(x[rests[0].last] - x[0] + x[-1] - x[rests[-1].first])
        reached = all(any(x[half.first] <= at <= x[half.last] for at in ends) for half in (rests[0], rests[-1]))
    middles, most = list[float](), short * float(np.ptp(x))
    for rest in rests:
        at_end = over_end > 0.0 and rest in (rests[0], rests[-1])
        length = over_end if at_end else x[rest.last] - x[rest.first]
        if (length < most or (at_end and reached)) and np.ptp(y[rest.first : rest.last + 1]) > 0.0:
            middles.append(float(0.5 * (x[rest.first] + x[rest.last])))
    return middles


def _crests(samples: Samples, rests: Sequence[Line], moves: Sequence[FittedMove]) -> list[float]:
    """The middles of rests of which the moves beside them leave nothing: their rows are the crest of one motion."""
    x, crests = samples.places, []
    for rest in rests:
        middle = 0.5 * (x[rest.first] + x[rest.last])
        stop = max((move.stop for move in moves if move.start + move.stop < 2.0 * middle), default=x[0])
        start = min((move.start for move in moves if move.start + move.stop > 2.0 * middle), default=x[-1])
        at_ends = rest.first == 0 or rest.last == len(x) - 1
        if moves and at_ends:
            start, stop = moves[0].start + x[-1] - x[0], moves[-1].stop
        if start - stop < _FEW_BETWEEN * samples.step:
            crests.append(float(x[0] if at_ends else middle))
    return crests


def _advance(samples: Samples) -> float:
    """What the motion advances by in a turn, as round as the noise of two rows allows; 0 where this tells it from none.

    The advance of an indexing table or of a feed is a number of whole steps.
    """
    advance = float(samples.heights[-1] - samples.heights[0])
    room = NOISE_ROOM * float(samples.noise.max()) + samples.digit
    if abs(advance) <= room:
        return 0.0
    unit = 10.0 ** np.floor(np.log10(abs(advance)))
    while unit >= _ROUND_ADVANCE * room:
        nearest = round(advance / unit) * unit
        if abs(nearest - advance) <= room:
            return float(nearest)
        unit *= 0.1
    return advance


def _begun(samples: Samples, crests: Sequence[float], advance: float) -> tuple[Samples, list[Line]]:
    """The turn begun where it rests, else where its velocity is constant, else at its lowest row, and its rests."""
    last = len(samples.heights) - 1

    def rests_in(turn: Samples) -> list[Line]:
        lines = []
        for rest in rests_of(turn):
            low, high = turn.places[[rest.first, rest.last]] + samples.step * np.array([-1.0, 1.0])
            at = low + np.mod(np.array(crests) - low, np.ptp(samples.places))
            if not np.any(at < high):
                lines.append(rest)
        if advance and len(lines) > 1 and lines[0].first == 0 and lines[-1].last == len(turn.heights) - 1:
            counts = [rest.last - rest.first + 1 for rest in (lines[0], lines[-1])]
            level = float(np.average([lines[0].level, lines[-1].level - advance], weights=counts))
            lines[0], lines[-1] = replace(lines[0], level=level), replace(lines[-1], level=level + advance)
        return lines

    rests = rests_in(samples)
    # a short one at an end of the table may be the slow begin of a move, or go on at the other end
    whole = rests and rests[0].first == 0 and rests[-1].last == last
    long = whole and min(rests[0].last, last - rests[-1].first) >= 2 * FEWEST
    if long or not goes_on(samples.places, samples.heights, samples.noise):
        return samples, rests
    lines = rests or [line for line in (lines_of(samples, 0, last) if advance else []) if not line.is_short]
    if not lines:
        row = 0 if advance else int(np.argmin(samples.heights)) % last
        turn = samples.begun_at(row, advance) if row else samples
        return turn, rests_in(turn)
    longest = max(lines, key=lambda line: line.last - line.first)
    row = (longest.first + longest.last) // 2
    # rows of a rest are a line as well, and maybe more of them
    longest = next((rest for rest in rests if rest.first <= row <= rest.last), longest)
    turn = samples.begun_at(row, advance) if row else samples
    inner = rests_in(turn)
    if longest not in rests:
        return turn, inner
    # of few rows, the halves of a rest are hardly rests each
    halves = Line(0, longest.last - row, longest.level), Line(last - row + longest.first, last, longest.level + advance)
    between = [rest for rest in inner if rest.first > halves[0].last and rest.last < halves[1].first]
    # a rest over the end of the table is one
    last_of_first = max([halves[0].last, *(rest.last for rest in inner if rest.first <= halves[0].last < rest.last)])
    first_of_last = min([halves[1].first, *(rest.first for rest in inner if rest.first < halves[1].first <= rest.last)])
    return turn, [replace(halves[0], last=last_of_first), *between, replace(halves[1], first=first_of_last)]
