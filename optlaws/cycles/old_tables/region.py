"""The rows between two rests or lines, or round a turn: the moves in these, with standard laws, splines and corners."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import combinations, pairwise
from typing import TypeGuard

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from optlaws.cycles.old_tables.curve_fit import DEGREE, CurveFit, End, interpolation, parabola
from optlaws.cycles.old_tables.fitted_moves import FittedMove, Parts, is_at_corner, is_between_longer
from optlaws.cycles.old_tables.fitting import AS_LIKELY, EVIDENT, SIMPLE, UNRESOLVED, fits_of, likely, with_jumps
from optlaws.cycles.old_tables.peak_intervals import PeakInterval, least_peak, most_peak
from optlaws.cycles.old_tables.rests_and_lines import FEWEST, NOISE_ROOM, Line, joined_over_seam, lines_of
from optlaws.cycles.old_tables.samples import MEDIAN, Samples, gaps_of, off_both_sides, turning_points
from optlaws.cycles.old_tables.standard import ALIKE, JUMP, Chain, Outline, criterion, spline_of
from optlaws.numbers import Array
from optlaws.numerics.roots import bisect

#: steps within which a move is known to be, and no more of it
_FEWEST_MOVING = 4
#: by how much the variance about a standard law may exceed that about a spline whose ends were looked for: of F
_UNLIKELY = 1e-5
_UNCERTAIN = 3.0
#: of a peak of a standard law, by which places of its ends that are rounded may change it
_ROUNDED_LAW = 1e-3
#: of the length of a turn: what is shorter is no move of its own
SHORTEST = 1.0 / 3600.0
#: of a turn: within it the end of a line is where the table begins, if that is as likely
_ABOUT_SEAM = 0.01
#: times what the means of windows show of a derivative that a fit has not, for means are less than peaks
_MISSING = 1.5
#: times the greatest peak of models: rows that have more speak against all of them
_AT_ODDS = 1.02
#: rows within a move that tell its acceleration by the standard law that is nearest, at least
_FEWEST_OF_LAW = 6
#: rows farther off a standard law, in standard deviations, are far off it, if they are few of all
_FAR, _FEW = 6.0, 0.04
#: standard deviations of most rows about a spline that is no model of these
_NO_MODEL = 2.0
#: of its parameters: with fewer rows a spline that explains them not is farther off the motion than what meets them
_ROWS_OF_NO_MODEL = 2
#: rows that are looked at beside one, at least
_FEWEST_BESIDE = 4
#: of a row far off a spline, by which those beside it may be off
_ALONE = 0.5
#: steps over which the velocity may change where lines meet
_BLENDS = np.arange(2.0, 65.0, 2.0)
#: standard laws that are fitted together
_MOST_MOVES = 4
#: steps of a chord are so much less than the rows of a region; of the greatest slope: it stops where chords have less
_CHORDS, _STOPPED = 60, 0.05
#: how many lengths of a blend are compared
_LENGTHS = 400
#: of a turn: the moves of one without rest begin so far off it
_BEYOND_TURN = 0.1


class Region:
    """The rows between two rests, or a rest and an end of the table."""

    def __init__(
        self, samples: Samples, before: Line | None, after: Line | None, seam: float, advance: float, *, split: bool
    ) -> None:
        self.samples, self.before, self.after, self.split, self.seam = samples, before, after, split, seam
        self.advance = advance if split and before is None and after is None else None  # of a whole turn
        x, count = samples.places, len(samples.places)
        first = 0 if before is None else before.last
        last = count - 1 if after is None else after.first
        self.rows, self.first, self.last = last - first, first, last
        step, self.digit = samples.step, samples.digit
        low = first if before is None else (before.first + before.last) // 2
        high = last if after is None else (after.first + after.last + 1) // 2
        self.x, self.y, self.noise = (row[low : high + 1] for row in (x, samples.heights, samples.noise))
        # a rest ends at its middle at the earliest, and behind its last row at the latest
        self.ends = (
            End() if before is None else End(before.values, x[low], min(x[first] + 2.0 * step, x[last])),
            End() if after is None else End(after.values, max(x[last] - 2.0 * step, x[first]), x[high]),
        )
        self.far: list[float] = []  # places of rows that it leaves out
        self._known_fits: dict[tuple[int, int | None], tuple[CurveFit, ...]] = {}
        self._known_chains: dict[tuple[int, tuple[float, ...]], list[Chain]] = {}
        self._known: dict[object, Region] = {}
        self.about = float(x[first]), float(x[last])

    @property
    def moves_at_all(self) -> bool:
        """Whether rows are between its ends, or these at two levels or on lines that meet at a corner."""
        levels = {end.line[1] for end in self.ends if end.line is not None}
        return self.rows > 1 or self._corner is not None or (self.rows == 1 and len(levels) == 2)

    def _resting(self) -> float:
        """The sum of squares of the rows of the rests or lines beside it."""
        squares = 0.0
        for end, beside in zip(self.ends, (self.x <= self.about[0], self.x >= self.about[1]), strict=True):
            if end.line is not None:
                off = (end.value(self.x[beside]) - self.y[beside]) / self.noise[beside]
                squares += float(off @ off)
        return squares

    @property
    def _meeting(self) -> tuple[float, Array] | None:
        """Where the lines beside it meet, and how far its rows are off these, in deviations of noise."""
        if self.before is None or self.after is None or self.before.slope == self.after.slope:
            return None
        before, after = self.ends
        at = self.x[0] + float(after.value(self.x[0]) - before.value(self.x[0])) / (before.slope - after.slope)
        off = (np.where(self.x < at, before.value(self.x), after.value(self.x)) - self.y) / self.noise
        return (float(at), off) if self.x[0] < at < self.x[-1] else None

    @cached_property
    def _corner(self) -> tuple[float, float, float] | None:
        """Place and position of the corner at which the lines beside it meet, with the sum of squares; None if none."""
        if self.rows > _FEWEST_MOVING or self._meeting is None:
            return None
        at, off = self._meeting
        squares = float(off @ off)
        # parabolas of some length, in which the velocity changes, are far likelier than a corner that is none
        if not likely(squares, len(off)) or self._of_blends(_BLENDS).min() < squares - EVIDENT:
            return None
        return at, float(self.ends[0].value(np.array(at))), squares

    def _of_blends(self, steps: Array) -> Array:
        """The sums of squares about parabolas over so many steps, in which the velocity changes where lines meet."""
        at, off = self._meeting or (0.0, np.zeros(0))
        change, lengths = self.ends[1].slope - self.ends[0].slope, self.samples.step * steps
        inside = np.maximum(0.5 * lengths - np.abs(self.x - at)[:, None], 0.0)
        blends = change * inside**2 / (2.0 * lengths) / self.noise[:, None]
        return np.asarray(((off[:, None] + blends) ** 2).sum(axis=0))

    def _blend(self) -> tuple[CurveFit, ...]:
        """The parabola in which the velocity of one line changes to that of the other, the likeliest one; none if none.

        Ends of splines that go on as slowly are anywhere within several steps, and these have far more acceleration.
        """
        if self._meeting is None or self.rows > _BLENDS[-1]:
            return ()
        at, _ = self._meeting
        most = 2.0 * min(at - self.ends[0].low, self.ends[1].high - at) / self.samples.step
        if most <= 1.0:
            return ()
        steps = np.linspace(1.0, most, _LENGTHS)
        squares = self._of_blends(steps)
        half = 0.5 * float(steps[int(np.argmin(squares))]) * self.samples.step
        return (parabola(self.ends, at - half, at + half, float(squares.min()), len(self.x)),)

    @property
    def _has_few_rows(self) -> bool:
        """Whether no spline is fitted; lines that meet at no corner go on into each other within rows near them."""
        slopes = {0.0 if line is None else line.slope for line in (self.before, self.after)}
        between = self.before is not None and self.after is not None and len(slopes) > 1
        return self.rows <= _FEWEST_MOVING and (not between or self._corner is not None)

    @cached_property
    def parts(self) -> Parts:
        """The moves of the region."""
        if self._has_few_rows:
            return self._few_rows() if self.moves_at_all else Parts([], self._resting(), 0, [])
        lines, straight = self._lines() if self.split else [], None
        while True:  # rows that are left out may have looked like turning points, and bent the fits
            places, chains = self._staged()
            if chains and self._left_out(chains[0]):
                continue
            plain = bool(chains) and self._is_plain(chains[0])
            straight = None if plain or not lines else straight or self._straight_parts(lines)
            if self._needs_no_spline(straight):
                return straight
            if self._is_likely(straight) and not self._is_smoother(straight):
                return straight
            fits = self._fits(SIMPLE if plain else None)
            if plain or not fits or not self._left_out_beside(fits[0]):
                break
        if fits and self._tells_nothing(fits[0]):
            fits = ()
        if chains and (self._explains(chains[0], fits[0]) if fits else plain):
            return Parts(list(self._of_chain(chains, fits)), chains[0].squares, chains[0].free, self.far)
        if straight and not _is_simple(fits) and self._is_simpler(straight, fits):
            return straight
        near = [name for name in chains[0].names if name] if chains else [""] * (len(places) - 1)
        squares, free = (fits[0].squares, fits[0].free) if fits else (0.0, len(self.x))
        return Parts(list(self._of_fits(fits, places, near)), squares, free, self.far)

    def _tells_nothing(self, fit: CurveFit) -> bool:
        """Whether a fit is no model of its rows, which are few."""
        rows = int(((self.x > fit.start) & (self.x < fit.stop)).sum())
        unresolved = self.rows > _FEWEST_MOVING and fit.variance > UNRESOLVED
        return unresolved and rows < _ROWS_OF_NO_MODEL * fit.free

    def _lines(self) -> list[Line]:
        lines = lines_of(self.samples, self.first, self.last)
        return lines if self.advance is None else joined_over_seam(self.samples, lines, self.advance)

    def _fits(self, smooth: int | None = None) -> tuple[CurveFit, ...]:
        """Splines that explain its rows, maybe without joints and of so many pieces at most."""
        key = len(self.x), smooth
        if key not in self._known_fits:
            fits = tuple(fits_of(self.x, self.y, self.noise, self.ends, self.advance, smooth=smooth))
            if at_seam := self._ends_at_seam(fits, _ABOUT_SEAM):
                there = tuple(fits_of(self.x, self.y, self.noise, at_seam, self.advance, smooth=smooth))
                near = at_seam == self._ends_at_seam(fits, SHORTEST)
                if there and (near or there[0].squares <= fits[0].squares + AS_LIKELY):
                    self.ends, fits = at_seam, there
            blend = self._blend() if fits else ()
            if blend and self._criterion(blend[0]) < self._criterion(fits[0]):
                fits = (*blend, *fits)
            self._known_fits[key] = fits
        return self._known_fits[key]

    def _is_smoother(self, parts: Parts) -> bool:
        """Whether a spline without joints is simple, or explains the rows by less than moves between lines do."""
        if _is_simple(self._fits(SIMPLE)):
            return True
        return parts.free > SIMPLE and not self._is_simpler(parts, self._fits(parts.free))

    def _turns(self) -> list[float]:
        """Where the region begins, turns and ends; a single row makes no turn."""
        heights = self.y.copy()
        heights[1:-1] = np.median(sliding_window_view(self.y, 3), axis=1)
        room = 2.0 * NOISE_ROOM * float(self.noise.max()) + 2.0 * self.digit
        turns = min((turning_points(row, room) for row in (self.y, heights)), key=len)
        low, high = self.about
        return [low, *(float(self.x[i]) for i in turns if low < self.x[i] < high), high]

    def _staged(self) -> tuple[list[float], list[Chain]]:
        """Where it begins, turns and ends, or stops too, with standard laws between: of stages if these explain it."""
        turns = self._turns()
        chains = self._chains(turns)
        if self.split and not (chains and self._is_plain(chains[0])):
            stops = self._stops(turns)
            most = min(len(stops), _MOST_MOVES + 1 - len(turns)) if len(stops) <= _MOST_MOVES else 0
            for some in (some for count in range(1, most + 1) for some in combinations(stops, count)):
                staged = sorted([*turns, *some])
                of_stages = self._chains(staged)
                if of_stages and self._moves_in_stages(of_stages[0]) and self._is_plain(of_stages[0]):
                    return staged, of_stages
        return turns, chains

    def _moves_in_stages(self, chain: Chain) -> bool:
        """Whether each law of a chain moves by more than noise."""
        rises = np.abs(np.diff(chain.heights))[[bool(name) for name in chain.names]]
        return bool(rises.min() > NOISE_ROOM * float(self.noise.max()) + self.digit)

    def _stops(self, turns: Sequence[float]) -> list[float]:
        """About where the motion stops, and goes on the same way, not near where it turns."""
        wide = max(2, len(self.x) // _CHORDS)
        if len(self.x) <= 4 * wide:
            return []
        velocity = (self.y[2 * wide :] - self.y[: -2 * wide]) / (self.x[2 * wide :] - self.x[: -2 * wide])
        fast = np.flatnonzero(np.abs(velocity) > _STOPPED * np.abs(velocity).max())
        stops, far = list[float](), 2.0 * wide * float(np.median(np.diff(self.x)))
        for i, j in pairwise(fast.tolist()):
            stop = float(0.5 * (self.x[i + wide] + self.x[j + wide]))
            if j > i + 1 and velocity[i] * velocity[j] > 0.0 and min(abs(stop - at) for at in [*turns, *stops]) > far:
                stops.append(stop)
        return stops

    def _few_rows(self) -> Parts:
        """The corner of a region of few rows, or what goes through these."""
        if self._corner is None:
            return Parts(list(self._of_fits((), self.about, [""])), self._resting(), self.rows, [])
        place, height, squares = self._corner
        slopes = self.ends[0].slope, self.ends[1].slope
        corner = FittedMove(place, place, height, height, (), "", "", slopes=slopes, corners=(True, True))
        return Parts([corner], squares, 0, [])

    def _ends_at_seam(self, fits: Sequence[CurveFit], share: float) -> tuple[End, End] | None:
        """Its ends, of which one within a share of a turn of the seam is exactly there; None where there is none."""
        room, ends = share * float(np.ptp(self.samples.places)), list(self.ends)
        for side, end in enumerate(self.ends):
            at = (fits[0].start, fits[0].stop)[side] if fits else np.inf
            if end.slope and 0.0 < abs(at - self.seam) < room:
                ends[side] = end._replace(low=self.seam, high=self.seam)
        return (ends[0], ends[1]) if tuple(ends) != self.ends else None

    def _explained_parts(self, lines: Sequence[Line]) -> Parts | None:
        """Corners and standard laws between as many of the lines as leave nothing but noise; None where none do."""
        for count in range(len(lines), 0, -1):  # the middle of a law may look like a line
            for some in combinations(lines, count):
                if all(region.explained for region in self._regions(some)):
                    return self._parts_between(some)
        return None

    @cached_property
    def explained(self) -> Parts | None:
        """The sum of squares where noise alone is between its rows and rests, a corner or standard laws; else None."""
        if self._has_few_rows:
            if not self.moves_at_all:
                return Parts([], self._resting(), 0, [])
            return None if self._corner is None else self._few_rows()
        chains = self._chains(self._turns())
        return Parts([], chains[0].squares, chains[0].free, []) if chains and self._is_plain(chains[0]) else None

    def _regions(self, lines: Sequence[Line]) -> list[Region]:
        return regions(self.samples, [self.before, *lines, self.after], self.seam, 0.0, self._known, split=False)

    def _straight_parts(self, lines: Sequence[Line]) -> Parts | None:
        """Moves between lines, without those of which the rows make others likelier, the shortest ones first.

        None where a simple spline explains the rows.
        """
        explained = self._explained_parts([line for line in lines if not line.is_short])
        if explained:
            return explained
        smooth = self._fits(SIMPLE)
        if _is_simple(smooth) and likely(smooth[0].squares, len(self.x)):
            return None
        beside = zip(lines, pairwise(region.parts for region in self._regions(lines)), strict=True)
        # rows of a slow bend are on a short line as well, but not beside a corner
        likely_lines = [(line, moves) for line, moves in beside if not line.is_short or is_at_corner(*moves)]
        if not likely_lines:
            return None
        lines = [line for line, _ in likely_lines]
        parts = self._parts_between(lines)
        doubtful = [line for line, moves in likely_lines if line.is_short or is_between_longer(*moves)]
        for line in sorted(doubtful, key=lambda line: line.last - line.first):
            others = [each for each in lines if each is not line]
            fits = self._fits() if line.is_short and not others else ()
            without = self._parts_between(others) if others else fits[0] if fits else parts
            if self._criterion(without) < self._criterion(parts) + EVIDENT * line.is_short:
                if not isinstance(without, Parts):
                    return None
                lines, parts = others, without
        return parts

    def _is_likely(self, parts: Parts | None) -> TypeGuard[Parts]:
        """Whether moves between lines leave nothing but noise."""
        return parts is not None and likely(parts.squares, len(self.x))

    def _needs_no_spline(self, parts: Parts | None) -> TypeGuard[Parts]:
        """Whether no spline need be looked at beside likely moves: lines meet at a corner, or all have names."""
        if not self._is_likely(parts):
            return False
        named = all(move.name or move.is_corner for move in parts.moves)
        return named and self._is_simpler(parts, self._fits(SIMPLE))

    def _parts_between(self, lines: Sequence[Line]) -> Parts:
        """Moves between given lines."""
        return Parts.joined([region.parts for region in self._regions(lines)], 2 * len(lines))

    def _is_simpler(self, parts: Parts, fits: Sequence[CurveFit]) -> bool:
        return not fits or self._criterion(parts) < self._criterion(fits[0])

    def _criterion(self, model: Parts | Chain | CurveFit) -> float:
        """Schwarz's criterion for its rows."""
        return criterion(model.squares, model.free, len(self.x))

    def _left_out(self, chain: Chain) -> int:
        """Leave out rows far off standard laws that explain all others, and tell how many these are."""
        off = (chain(self.x) - self.y) / self.noise
        near = np.abs(off) <= _FAR
        count = len(off) - int(near.sum())
        if 0 < count <= _FEW * len(off) + 1 and likely(float((off[near] ** 2).sum()), len(off)):
            self.far += self.x[~near].tolist()
            self.x, self.y, self.noise = self.x[near], self.y[near], self.noise[near]
            return count
        return 0

    def _left_out_beside(self, fit: CurveFit) -> bool:
        """Leave out single rows far off a spline, whose neighbours are near it; whether there are such."""
        inside = np.flatnonzero((self.x > fit.start) & (self.x < fit.stop))
        off = np.abs(fit.values(self.x[inside]) - self.y[inside]) / self.noise[inside]
        size = max(float(np.median(off)) / MEDIAN, 1.0) if len(off) else np.inf
        if len(off) < 2 * fit.free or size > _NO_MODEL:
            return False
        off = np.pad(off / size, 1)
        beside = np.maximum(off[:-2], off[2:])
        far = inside[(off[1:-1] > _FAR) & (beside < _ALONE * off[1:-1])]
        far = far[[self._stands_out(int(row), self.y[row] - fit.height(self.x[row])) for row in far]]
        if not far.size or len(self.far) + len(far) > _FEW * len(self.x) + 1:
            return False
        self.far += self.x[far].tolist()
        self.x, self.y, self.noise = (np.delete(row, far) for row in (self.x, self.y, self.noise))
        return True

    def _stands_out(self, row: int, off: float) -> bool:
        """Whether a row is off where both sides of it go on, by most of what it is off a spline."""
        if not _FEWEST_BESIDE <= row < len(self.x) - _FEWEST_BESIDE:
            return True
        both = off_both_sides(self.x, self.y, row, float(np.sign(off)), float(self.noise[row]))
        return both > _ALONE * abs(off)

    def _is_plain(self, chain: Chain) -> bool:
        """Whether standard laws leave nothing but noise, and corners beside them are evident."""
        rows = len(self.x)
        if not likely(chain.squares, rows) or chain.is_bent:
            return False
        smooth = self._fits(SIMPLE) if any(change > JUMP for change in chain.changes) else ()
        if not smooth or not likely(smooth[0].squares, rows):
            return True
        return self._criterion(smooth[0]) > self._criterion(chain) + EVIDENT

    def _explains(self, chain: Chain, fit: CurveFit) -> bool:
        """Whether rows are as near standard laws as splines make likely, by the test of Fisher or the simpler model."""
        from scipy.special import fdtrc

        rows = len(self.x)
        if any(change > JUMP for change in chain.changes) and not self._is_plain(chain):
            return False
        left, best = max(rows - chain.free, 1), max(rows - fit.free, 1)
        more = fit.free - chain.free
        if more <= 0:
            return self._criterion(chain) <= self._criterion(fit)
        ratio = max(chain.squares - fit.squares, 0.0) / more / max(fit.squares / best, 1e-300)
        return bool(fdtrc(more, best, ratio) > _UNLIKELY) or chain.squares / left <= 1.0

    def _chains(self, places: Sequence[float]) -> list[Chain]:
        """The nearest standard laws between the turning points of the region, and those that are about as near."""
        key = len(self.x), tuple(places)
        if key not in self._known_chains:
            self._known_chains[key] = self._nearest_chains(places)
        return self._known_chains[key]

    def _nearest_chains(self, places: Sequence[float]) -> list[Chain]:
        if len(places) - 1 > _MOST_MOVES or len(self.x) < 2 * len(places) + 2 or not np.all(np.diff(places) > 0.0):
            return []
        heights, known = np.interp(places, self.x, self.y), np.zeros(len(places), dtype=bool)
        for side, end in ((0, self.ends[0]), (-1, self.ends[1])):
            if end.line is not None:
                heights[side], known[side] = end.value(np.array(places[side])), True
        if not np.all(np.abs(np.diff(heights)) > 0.0):
            return []
        bounds, turn = (float(self.x[0]), float(self.x[-1])), 0.0
        if self.advance is not None:
            turn = self.about[1] - self.about[0]
            bounds = bounds[0] - _BEYOND_TURN * turn, bounds[1] + _BEYOND_TURN * turn
        slopes = self.ends[0].slope, self.ends[1].slope
        outline = Outline(
            self.x, self.y, self.noise, np.array(places), heights, known, bounds, turn, self.advance or 0.0, slopes
        )
        chains = outline.chains()
        if len(places) > 2 and not likely(chains[0].squares, len(self.x)):
            # a rest so short that its rows look like a crest
            long = float(np.median(np.diff(self.x))) * FEWEST
            resting = outline.chains(min(long, 0.2 * float(np.diff(places).min())))
            if resting[0].squares < chains[0].squares - ALIKE:
                chains = resting
        nearest = chains[0]
        smooth = outline.smoothly(nearest)
        if smooth and self._criterion(smooth) <= self._criterion(nearest):
            nearest = smooth
        rounded = nearest.rounded(self.x, self.y, self.noise, self.digit, bounds)
        return [rounded, *(each for each in chains if each.squares <= chains[0].squares + ALIKE)]

    def _of_chain(self, chains: Sequence[Chain], fits: Sequence[CurveFit]) -> Iterator[FittedMove]:
        chain = chains[0]
        rows, variance = len(self.x), chain.squares / max(len(self.x) - chain.free, 1)
        good = variance * (1.0 + 3.0 * np.sqrt(2.0 / rows))
        near = [fit for fit in fits if _is_simple([fit]) and fit.variance <= good][:1]
        simple = with_jumps(self.x, self.y, self.noise, near) if near else []
        jumps = [chain.jumps(nu) for nu in (1, 2)]
        for i, name in enumerate(chain.names):
            if not name:
                continue
            low, high = map(float, chain.places[i : i + 2])
            at_ends = i == 0, i == len(chain.names) - 1
            slopes = at_ends[0] * chain.slopes[0], at_ends[1] * chain.slopes[1]
            corners = bool(slopes[0]) and not chain.smooth[0], bool(slopes[1]) and not chain.smooth[1]
            few = int(((self.x > low) & (self.x < high)).sum()) < _FEWEST_OF_LAW
            most = []
            for nu in (1, 2, 3):
                standard = (1.0 + _ROUNDED_LAW) * max(
                    each.peak(i, nu) * (1.0 + _UNCERTAIN * each.uncertainty(i, nu)) for each in chains
                )
                if any(each[i] for each in jumps[: nu - 1]) or (nu > 1 and (few or any(corners))):
                    standard = np.inf
                most.append(max(standard, most_peak(simple, nu, low, high) if simple else 0.0))
            at = self._seam_within(low, high)
            if at is not None:
                yield from self._parts((spline_of(chain, i),), [low, at, high], ["", ""], variance, most)
                continue
            first, last = map(float, chain.heights[i : i + 2])
            peaks = [self._interval(nu, low, high, most[nu - 1], variance) for nu in (1, 2, 3)]
            yield FittedMove(low, high, first, last, tuple(fits), name, name, tuple(peaks), slopes, corners)

    def _of_fits(self, fits: Sequence[CurveFit], places: Sequence[float], near: Sequence[str]) -> Iterator[FittedMove]:
        most = None
        if not fits:
            inside = (self.x >= self.about[0]) & (self.x <= self.about[1])
            fits = [interpolation(self.x[inside], self.y[inside], self.ends, self.advance)]
            most = [np.inf] * 3
        else:
            fits = with_jumps(self.x, self.y, self.noise, self._begun_at_turn(fits, places))
        best = fits[0]
        nodes, laws = [best.start, *(_turn(best, place) for place in places[1:-1]), best.stop], list(near)
        for i, (low, high) in enumerate(pairwise(nodes)):
            at = self._seam_within(low, high)
            if at is not None:
                nodes.insert(i + 1, at)
                laws[i : i + 1] = ["", ""]
                break
        yield from self._parts(fits, nodes, laws, best.variance, most)

    def _begun_at_turn(self, fits: Sequence[CurveFit], places: Sequence[float]) -> Sequence[CurveFit]:
        """Fits of a whole turn that does not advance, begun where the motion turns, and not at its lowest row."""
        if self.advance != 0.0 or len(places) < 3:
            return fits
        turn = places[-1] - places[0]
        at = _turn(fits[0].begun_at(places[1], 0.0), places[-1])
        near = min((self.seam - turn, self.seam), key=lambda seam: abs(seam - at))
        at = near if abs(near - at) < SHORTEST * turn else at
        if at >= places[-1]:
            return [fit.begun_at(at - turn, 0.0) for fit in fits]
        return [fit.begun_at(at, 0.0).moved(-turn, 0.0) for fit in fits]

    def _seam_within(self, low: float, high: float) -> float | None:
        """Where the table begins again within a move; None where it does not."""
        turn = float(np.ptp(self.samples.places))
        places = (at for at in (self.seam - turn, self.seam) if low + SHORTEST * turn < at < high - SHORTEST * turn)
        return next(places, None)

    def _parts(
        self,
        fits: Sequence[CurveFit],
        nodes: Sequence[float],
        near: Sequence[str],
        variance: float,
        most: Sequence[float] | None,
    ) -> Iterator[FittedMove]:
        """Parts of a fitted motion, with the nearest laws, and the most that their peaks are."""
        for (low, high), nearest in zip(pairwise(nodes), near, strict=True):
            first, last = (fits[0].height(place) for place in (low, high))
            if first == last or not low < high:
                continue
            bounds = most or [
                most_peak(fits, nu, low, high) + self._missing(fits[0], nu, low, high) for nu in (1, 2, 3)
            ]
            if any(start < high and stop > low for start, stop in self._gaps):
                bounds = [np.inf] * 3
            peaks = [self._interval(nu, low, high, bounds[nu - 1], variance) for nu in (1, 2, 3)]
            slopes, corners = (fits[0].ends[0].slope, fits[0].ends[1].slope), fits[0].corners
            corners = corners[0] and low == nodes[0], corners[1] and high == nodes[-1]
            yield FittedMove(low, high, first, last, tuple(fits), "", nearest, tuple(peaks), slopes, corners)

    @cached_property
    def _gaps(self) -> list[tuple[float, float]]:
        """From where to where no rows tell the motion."""
        x, y, noise = self.samples.places, self.samples.heights, self.samples.noise
        return gaps_of(x, y, NOISE_ROOM * float(noise.max()) + self.digit)

    def _missing(self, fit: CurveFit, nu: int, low: float, high: float) -> float:
        """What the rows show of a derivative that a fit has not: at joints that it smooths."""
        inside = (self.x >= low) & (self.x <= high)
        if int(inside.sum()) <= nu + 1:
            return 0.0
        off, noise = self.y[inside] - fit.values(self.x[inside]), self.noise[inside]
        if fit.variance <= UNRESOLVED:
            noise = noise * max(float(np.median(np.abs(off) / noise)) / MEDIAN, 1.0)
        return _MISSING * least_peak(self.x[inside], off, noise, self.digit, nu)

    def _interval(self, nu: int, low: float, high: float, most: float, variance: float = 1.0) -> PeakInterval:
        """The interval of a peak, for noise of the variance about the model where that is more than by differences."""
        inside = (self.x >= low) & (self.x <= high)
        x, y, noise = self.x[inside], self.y[inside], self.noise[inside] * np.sqrt(max(variance, 1.0))
        least = least_peak(x, y, noise, self.digit, nu) if len(x) > nu + 1 else 0.0
        # models with less than the rows have do not hold
        return PeakInterval(least, max(most, least) if least <= _AT_ODDS * most else np.inf)


def regions(
    samples: Samples, lines: Sequence[Line | None], seam: float, advance: float, known: dict[object, Region],
    *, split: bool,
) -> list[Region]:  # fmt: skip
    """The regions between rests or lines, None at an end of the table; those that are `known` are these."""
    keys = [(float(samples.places[0]), before, after) for before, after in pairwise(lines)]
    for key in keys:
        if key not in known:
            known[key] = Region(samples, *key[1:], seam, advance, split=split)
    return [known[key] for key in keys]


def _is_simple(fits: Sequence[CurveFit]) -> bool:
    """Whether a spline of few pieces, or a polynomial of few degrees, is near the rows."""
    if not fits or len(fits[0].joints) > sum(fits[0].corners) or fits[0].variance > UNRESOLVED:
        return False
    return max(fits[0].pieces, fits[0].degree - DEGREE) <= SIMPLE


def _turn(fit: CurveFit, place: float) -> float:
    """The place near another one where the velocity of a fit changes its sign; a corner there."""
    width = 0.02 * (fit.stop - fit.start)
    at = np.linspace(max(place - width, fit.start), min(place + width, fit.stop), 201)
    velocity = fit.values(at, 1)
    turns = np.flatnonzero(velocity[:-1] * velocity[1:] <= 0.0)
    if not turns.size:
        return place
    i = int(turns[np.argmin(np.abs(at[turns] - place))])
    ends = bisect(lambda x: float(fit.values(np.array([x]), 1)[0]) * velocity[i] > 0.0, float(at[i]), float(at[i + 1]))
    return 0.5 * sum(ends)
