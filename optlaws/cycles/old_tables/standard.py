"""Standard laws in the moves of samples: a chain of moves between places and heights that are found with them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import pairwise, product
from math import log
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BPoly, BSpline

from optlaws.cycles.old_tables.curve_fit import DEGREE, CurveFit, End, Joint
from optlaws.cycles.old_tables.fitting import AS_LIKELY, rounded_places
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.numbers import Array

#: steps of a fit at most, where laws are ranked and where the ends of moves are to have all digits
_ROUGH_STEPS, _CLOSE_STEPS = 8, 40
#: of the sum of squares: steps that lower it by less are the last ones
_LAST_STEP = 1e-12
#: of the diagonal of the normal equations: what a fit begins with, the least, and the most with which a step is of use
_DAMPING, _LEAST_DAMPING, _MOST_DAMPING = 1e-3, 1e-14, 1e9
#: rows by which laws are ranked, and how many of the best are compared, of a single move and of several
_RANKED_BY, _COMPARED, _COMBINED = 60, 4, 3
#: rows by which chains are compared, and how many of the best of these are fitted to all rows
_COMPARED_BY, _FITTED = 240, 6
#: standard laws whose sums of squares differ by less are told apart by no table; and with how many times the least sum,
#: of the rows by which they are compared, none can be nearest
ALIKE, _COMPARABLE = 16.0, 1.5
#: mean of squares from which on no chain is near the rows, and the best one alone is of interest
_FAR_OFF = 100.0
#: of the length of a chain: its moves are longer
_APART = 1e-9
#: even places between which laws are interpolated where they are compared
_INTERVALS = 2048
#: moves of a chain of which every combination of the best laws is tried
_MOST_COMBINED = 3
#: of the velocity of a line: a law that starts from it with one that differs by less may start with it, or by far less
_NEARLY, _CORNER = 0.2, 0.02
#: of the greatest velocity or acceleration: by so much it jumps where moves meet
JUMP = 1e-3
#: parts of each piece of a law, each as a polynomial
_PIECES_OF_LAW = 16
#: of the last digit: rows that are no farther off are the law's own
_ROUNDED = 0.5001


@dataclass(frozen=True, eq=False)
class Chain:
    """Standard laws one after another, from rest to rest each or as their law has it.

    Attributes
    ----------
    names
        Of the laws, n of them; "" of a rest between two moves.
    places, heights
        Where they meet, arrays of shape (n + 1,).
    squares
        The sum of squares of the rows about them, over the variance of the noise.
    free
        The number of parameters that were found.
    deviations
        The standard deviations of places, shape (n + 1,), and of heights behind these, for the noise of the rows.
    turn, advance
        Of a chain that goes on at its beginning where it ends: its length, and what it advances by; else 0.
    slopes
        The velocities of the lines from which it starts and in which it ends, of which its laws may know nothing.
    smooth
        Whether it starts and ends with these velocities.
    """

    names: tuple[str, ...]
    places: Array
    heights: Array
    squares: float
    free: int
    deviations: Array
    turn: float = 0.0
    advance: float = 0.0
    slopes: tuple[float, float] = (0.0, 0.0)
    smooth: tuple[bool, bool] = (False, False)

    def __call__(self, x: Array) -> Array:
        """The positions at places; those of the lines beside it beyond its ends."""
        turns = np.floor((x - self.places[0]) / self.turn) if self.turn else np.zeros(x.shape)
        x = x - turns * self.turn
        beyond = x - np.clip(x, self.places[0], self.places[-1])
        lines = np.where(beyond < 0.0, *self.slopes) * beyond
        return _positions(self.names, self.places, self.heights, x) + lines + turns * self.advance

    def rounded(self, x: Array, y: Array, noise: Array, digit: float, bounds: tuple[float, float]) -> Chain:
        """The chain with places as round, and heights, as the rows allow; it ends in the bounds."""
        count = len(self.places)
        for places in (*rounded_places(self.places, x), self.places):
            heights = self.heights.copy() if places is self.places or not digit else self._rounded_heights(digit)
            inside = np.clip(places, *bounds)
            heights[[0, -1]] += self.slopes * (inside - self.places)[[0, -1]]
            if self.turn:
                inside[-1], heights[-1] = inside[0] + self.turn, heights[0] + self.advance
            inside = _smoothed(self.names, inside, heights, self.slopes, self.smooth)
            if np.all(np.diff(inside) > 0.0):
                tried = replace(self, places=inside, heights=heights)
                off = tried(x) - y
                squares = float(((off / noise) ** 2).sum())
                rounded = 0.0 < float(np.abs(off).max()) <= _ROUNDED * digit
                if squares <= self.squares + AS_LIKELY * count or rounded or places is self.places:
                    return replace(tried, squares=squares)
        return self

    def _rounded_heights(self, digit: float) -> Array:
        """Its heights that are free, as numbers of so many digits."""
        free = self.deviations[len(self.places) :] > 0.0
        free[[0, -1]] &= [not slope for slope in self.slopes]
        heights = np.where(free, np.round(self.heights / digit) * digit, self.heights)
        for i, name in enumerate(self.names):
            if not name:
                heights[i + 1] = heights[i]
        return heights

    def peak(self, move: int, nu: int) -> float:
        """The greatest magnitude of a derivative in a move, by the master."""
        length = self.places[move + 1] - self.places[move]
        stroke = abs(self.heights[move + 1] - self.heights[move])
        return float(stroke / length**nu * catalogue[self.names[move]].law.peak(nu).value)

    @property
    def changes(self) -> tuple[float, float]:
        """By which shares of the velocities of the lines its laws start and end with others; 0 at rests."""
        changes = [0.0, 0.0]
        for side in (0, 1):
            if self.slopes[side] and not self.smooth[side]:
                stroke, length = np.diff(self.heights)[-side], np.diff(self.places)[-side]
                changes[side] = abs(float(stroke / length) * _velocity_at(self.names, side) / self.slopes[side] - 1.0)
        return changes[0], changes[1]

    @property
    def is_bent(self) -> bool:
        """Whether its velocity changes where it meets a line, by less than at a corner: it is not that of the rows."""
        return any(JUMP < change < _CORNER for change in self.changes)

    def jumps(self, nu: int) -> NDArray[np.bool_]:
        """Whether a derivative jumps at an end of each move; it rests beside its own, or goes on at the other."""
        ends, greatest = np.zeros((len(self.names), 2)), 0.0
        for i, name in enumerate(self.names):
            if name:
                scale = np.diff(self.heights)[i] / np.diff(self.places)[i] ** nu
                ends[i] = scale * np.array([catalogue[name].law(k, nu) for k in (0.0, 1.0)])
                greatest = max(greatest, self.peak(i, nu))
        before, after = np.roll(ends[:, 1], 1), np.roll(ends[:, 0], -1)
        lines = self.slopes if nu == 1 else (0.0, 0.0)
        before[0], after[-1] = (before[0], after[-1]) if self.turn else lines
        apart = np.maximum(np.abs(ends[:, 0] - before), np.abs(ends[:, 1] - after))
        return np.asarray(apart > JUMP * greatest)

    def uncertainty(self, move: int, nu: int) -> float:
        """The share of a peak by which it may be wrong, one standard deviation."""
        count = len(self.places)
        length = self.places[move + 1] - self.places[move]
        stroke = abs(self.heights[move + 1] - self.heights[move])
        ends = self.deviations[[move, move + 1]]
        levels = self.deviations[[count + move, count + move + 1]]
        return float(nu * np.hypot(*ends) / length + np.hypot(*levels) / stroke)


def _smoothed(
    names: Sequence[str], places: Array, heights: Array, slopes: tuple[float, float], smooth: tuple[bool, bool]
) -> Array:
    """Places of which those beside the first and the last one make laws meet lines with their velocities."""
    moved = places.copy()
    for side, (end, beside) in enumerate(((0, 1), (-1, -2))):
        if smooth[side]:
            strokes = (heights[..., beside] - heights[..., end]) / slopes[side]
            moved[..., beside] = places[..., end] + _velocity_at(names, side) * strokes
    return moved


def _velocity_at(names: Sequence[str], side: int) -> float:
    """The velocity with which the first law starts, or with which the last one stops, dimensionless."""
    return float(catalogue[names[-side]].law(float(side), 1))


def _positions(names: Sequence[str], places: Array, heights: Array, x: Array) -> Array:
    y = np.full(x.shape, heights[0], dtype=np.float64)
    y[x > places[-1]] = heights[-1]
    for i, name in enumerate(names):
        low, high = places[i], places[i + 1]
        inside = (x > low) & (x <= high)
        if not name:
            y[inside] = heights[i]
        elif inside.any():
            law = catalogue[name].law
            y[inside] = heights[i] + (heights[i + 1] - heights[i]) * np.asarray(law((x[inside] - low) / (high - low)))
    return y


#: positions and velocities of the laws of several moves, by their names, at places of shape (moves, rows); they
#: rest before 0 and behind 1
_Laws: TypeAlias = Callable[[Sequence[str], Array], tuple[Array, Array]]


def _exact(names: Sequence[str], u: Array) -> tuple[Array, Array]:
    a, b = (u >= 1.0).astype(np.float64), np.zeros(u.shape)
    for i, name in enumerate(names):
        if name:
            inside = (u[i] > 0.0) & (u[i] <= 1.0)
            law = catalogue[name].law
            a[i, inside], b[i, inside] = law(u[i, inside]), law(u[i, inside], 1)
    return a, b


@cache
def _sampled() -> tuple[dict[str, int], list[Array]]:
    """Which row is that of each law, and of rests, in positions and in velocities at even places."""
    even, laws = np.linspace(0.0, 1.0, _INTERVALS + 1), [law.law for law in catalogue.values()]
    rows = {name: i for i, name in enumerate([*catalogue, ""])}
    return rows, [np.array([*(law(even, nu) for law in laws), np.zeros_like(even)]) for nu in (0, 1)]


def _interpolated(names: Sequence[str], u: Array) -> tuple[Array, Array]:
    """Positions and velocities by cubics between even places, which cost little."""
    rows, sampled = _sampled()
    first = np.array([rows[name] for name in names], dtype=np.intp)[:, None] * (_INTERVALS + 1)
    inside = (u > 0.0) & (u <= 1.0)
    u = np.clip(u, 0.0, 1.0)
    at = np.minimum((u * _INTERVALS).astype(np.intp), _INTERVALS - 1)
    t = u * _INTERVALS - at
    a, b = (each.take(first + at + np.arange(2)[:, None, None]) for each in sampled)
    rise, before, after = a[1] - a[0], b[0] / _INTERVALS, b[1] / _INTERVALS
    second, third = 3.0 * rise - 2.0 * before - after, before + after - 2.0 * rise
    slope = before + t * (2.0 * second + 3.0 * t * third)
    return a[0] + t * (before + t * (second + t * third)), inside * slope * _INTERVALS


@dataclass(frozen=True, eq=False)
class Outline:
    """Rows with about where their moves meet.

    Attributes
    ----------
    x, y, noise
        Rows, arrays of shape (n,).
    places, heights
        About where the moves meet, arrays of shape (m,).
    known
        Which heights are known, as those of rests are.
    bounds
        Between which places the moves are.
    turn, advance
        Of rows of a whole turn, which the moves go round: its length, and what they advance by; else 0.
    slopes
        The velocities of the lines on which the first and the last place are, where their heights are known.
    smooth
        Whether laws meet these lines with their velocities.
    """

    x: Array
    y: Array
    noise: Array
    places: Array
    heights: Array
    known: NDArray[np.bool_]
    bounds: tuple[float, float]
    turn: float = 0.0
    advance: float = 0.0
    slopes: tuple[float, float] = (0.0, 0.0)
    smooth: tuple[bool, bool] = (False, False)

    def chains(self, resting: float = 0.0) -> list[Chain]:
        """Chains of standard laws near the rows, the nearest first; they rest about so long where they turn."""
        moves = len(self.places) - 1
        compared = _COMPARED if moves == 1 else _COMBINED if moves <= _MOST_COMBINED else 1
        best = [names[:compared] for names in self._ranks]
        outline = self._resting(resting) if resting else self
        tried = [tuple(_woven(names, [""] * (moves - 1) if resting else [])) for names in product(*best)]
        some = outline.of_rows(slice(None, None, max(1, len(self.x) // _COMPARED_BY)))
        rough = sorted(some.fitted(tried, _interpolated, _CLOSE_STEPS), key=_squares)
        least = rough[0].squares
        near = [chain for chain in rough[:_FITTED] if chain.squares <= _COMPARABLE * least + 2.0 * ALIKE]
        if least >= _FAR_OFF * len(some.x):
            near = near[:1]
        return sorted(map(outline.exactly, near), key=_squares)

    def of_rows(self, rows: slice | NDArray[np.intp]) -> Outline:
        """The outline with some of its rows."""
        return replace(self, x=self.x[rows], y=self.y[rows], noise=self.noise[rows])

    def exactly(self, rough: Chain, smooth: tuple[bool, bool] = (False, False)) -> Chain:
        """The chain of the same laws that is nearest the rows, of the laws themselves."""
        outline = replace(self, places=rough.places, heights=rough.heights, smooth=smooth)
        return outline.fitted([rough.names], _exact, _CLOSE_STEPS)[0]

    def smoothly(self, chain: Chain) -> Chain | None:
        """The chain that meets lines with their velocities where its laws nearly do; None where none does."""
        smooth = [0.0 < change < _NEARLY for change in chain.changes]
        if not any(smooth) or len(chain.places) != len(self.places) or (all(smooth) and len(self.places) == 2):
            return None
        return self.exactly(chain, (smooth[0], smooth[1]))

    def _resting(self, length: float) -> Outline:
        """The outline with rests of a length where the moves meet."""
        inner = np.repeat(np.arange(1, len(self.places) - 1), 2)
        each = np.array([0, *inner, len(self.places) - 1])
        apart = np.array([0.0, *np.tile([-0.5, 0.5], len(inner) // 2), 0.0]) * length
        return replace(self, places=self.places[each] + apart, heights=self.heights[each], known=self.known[each])

    @cached_property
    def _ranks(self) -> list[list[str]]:
        """The ranked laws of each move, whether it rests where it turns or not."""
        return [self._ranked(move) for move in range(len(self.places) - 1)]

    def _ranked(self, move: int) -> list[str]:
        """The names of laws by how near they come to the rows of a move, of which the ends are about known."""
        ends = self.places[move : move + 2]
        inside = np.flatnonzero((self.x >= ends[0]) & (self.x <= ends[1]))
        some = self.of_rows(inside[:: max(1, len(inside) // _RANKED_BY)])
        heights = self.heights[move : move + 2]
        last = move == len(self.places) - 2
        slopes = self.slopes[0] if move == 0 else 0.0, self.slopes[1] if last else 0.0
        wide = 0.4 * float(np.ptp(ends))
        single = replace(
            some, places=ends, heights=heights, known=np.ones(2, dtype=bool), bounds=(ends[0] - wide, ends[1] + wide),
            turn=0.0, advance=0.0, slopes=slopes,
        )  # fmt: skip
        # beside a line another one is no move, but would be two corners in place of a smooth change
        names = [(name,) for name in catalogue if name != "constant velocity" or not any(slopes)]
        chains = single.fitted(names, _interpolated, _ROUGH_STEPS)
        return [chain.names[0] for chain in sorted(chains, key=lambda chain: (chain.squares, chain.names))]

    def _freedom(self, names: Sequence[str]) -> tuple[NDArray[np.intp], Array]:
        """Which height each one is, and how all places and heights change with those that are free, as a matrix."""
        count = len(self.places)
        source = np.arange(count)  # a rest ends at the height of its start
        for i, name in enumerate(names):
            source[i + 1] = source[i + 1] if name else source[i]
        if self.turn:
            source[-1] = 0
        free = [i for i in range(count) if source[i] == i and not self.known[i]]
        spread = np.zeros((2 * count, count + len(free)))
        spread[:count, :count] = np.eye(count)
        for column, i in enumerate(free):
            spread[count + np.flatnonzero(source == i), count + column] = 1.0
        spread[[count, -1], [0, count - 1]] += self.slopes
        for at_end, (end, beside) in enumerate(((0, 1), (count - 1, count - 2))):
            if self.smooth[at_end]:
                velocity = _velocity_at(names, at_end) / self.slopes[at_end]
                spread[beside] = spread[end] + velocity * (spread[count + beside] - spread[count + end])
        if self.turn:
            spread[count - 1] = spread[0]
        return source, spread[:, [column for column in range(spread.shape[1]) if spread[:, column].any()]]

    def fitted(self, names: Sequence[tuple[str, ...]], laws: _Laws, steps: int) -> list[Chain]:
        """The chains of given laws, with rests in the same places, whose ends that are not known are nearest the rows.

        By the method of Levenberg and Marquardt, all chains at once.
        """
        source, spread = self._freedom(names[0])
        begun = np.concatenate([self.places, self.heights[source]])
        begun[-1] += self.advance
        fit = _Fit(self, names, laws, spread, np.tile(begun, (len(names), 1)))
        fit.improve(steps)
        return fit.chains()


class _Fit:
    """Chains that come nearer the rows, each in steps of its own.

    `normal` and `side` are the normal equations of the chains, by what is free in them.
    """

    def __init__(
        self, outline: Outline, names: Sequence[tuple[str, ...]], laws: _Laws, spread: Array, ends: Array
    ) -> None:
        self.outline, self.names, self.laws, self.spread = outline, names, laws, spread
        self.ends = self._inside(ends)
        self.squares, self.normal, self.side = self._equations(np.arange(len(names)), self.ends)
        self.damping = np.full(len(names), _DAMPING)

    def _missed(self, chains: NDArray[np.intp], ends: Array) -> tuple[Array, Array]:
        """How far chains miss the rows, in deviations of their noise, and the derivatives by places and heights.

        Arrays of shape (chains, rows), and (chains, rows, places and heights).
        """
        outline, count = self.outline, len(self.outline.places)
        places, heights = ends[:, :count, None], ends[:, count:, None]
        turns = np.floor((outline.x - places[:, 0]) / outline.turn) if outline.turn else 0.0
        x = outline.x - turns * outline.turn
        length, stroke = np.diff(places, axis=1), np.diff(heights, axis=1)
        u = (x[..., None, :] - places[:, :-1]) / length
        moves = [name for i in chains for name in self.names[i]]
        a, b = (each.reshape(u.shape) for each in self.laws(moves, u.reshape(len(moves), len(outline.x))))
        before, behind = x <= places[:, 0], x > places[:, -1]
        (first, last), pace = outline.slopes, stroke / length * b
        lines = first * before * (x - places[:, 0]) + last * behind * (x - places[:, -1])
        off = heights[:, 0] + (stroke * a).sum(axis=1) + lines - (outline.y - turns * outline.advance)
        slopes = np.zeros((len(ends), 2 * count, len(outline.x)))
        slopes[:, : count - 1] -= pace * (1.0 - u)
        slopes[:, 1:count] -= pace * u
        slopes[:, 0] -= first * before
        slopes[:, count - 1] -= last * behind
        slopes[:, count] = 1.0
        slopes[:, count:-1] -= a
        slopes[:, count + 1 :] += a
        return off / outline.noise, (slopes / outline.noise).transpose(0, 2, 1)

    def _inside(self, ends: Array) -> Array:
        """Ends with places in the bounds, on the lines beside the chains and round the turn."""
        outline, count = self.outline, len(self.outline.places)
        moved = ends.copy()
        places = np.clip(ends[:, :count], *outline.bounds)
        moved[:, [count, -1]] += outline.slopes * (places - ends[:, :count])[:, [0, -1]]
        moved[:, :count] = _smoothed(self.names[0], places, moved[:, count:], outline.slopes, outline.smooth)
        if outline.turn:
            moved[:, count - 1] = moved[:, 0] + outline.turn
        return moved

    def _equations(self, chains: NDArray[np.intp], ends: Array) -> tuple[Array, Array, Array]:
        """The sums of squares of chains, with their normal equations."""
        off, slopes = self._missed(chains, ends)
        matrix = slopes @ self.spread
        turned = matrix.transpose(0, 2, 1)
        return (off**2).sum(axis=1), turned @ matrix, (turned @ off[:, :, None])[:, :, 0]

    def improve(self, steps: int) -> None:
        """So many steps at most, of each chain until it is as near as it comes."""
        count = len(self.outline.places)
        active = np.arange(len(self.names))
        for _ in range(steps):
            step = self._step(active)
            tried = self._inside(self.ends[active] + step @ self.spread.T)
            apart = np.diff(tried[:, :count], axis=1)
            sound = np.flatnonzero(np.all(apart > _APART * np.ptp(self.outline.places), axis=1))
            before = self.squares[active]
            new = np.full(len(active), np.inf)
            new[sound], normal, side = self._equations(active[sound], tried[sound])
            nearer = new < before
            at, of_sound = active[nearer], nearer[sound]
            gained = -(self.side[active] * step).sum(axis=1)
            last = np.where(
                nearer, before - new <= _LAST_STEP * before,
                (self.damping[active] > _MOST_DAMPING) | (gained <= _LAST_STEP * before),
            )  # fmt: skip
            self.ends[at], self.squares[at] = tried[nearer], new[nearer]
            self.normal[at], self.side[at] = normal[of_sound], side[of_sound]
            self.damping[active] *= np.where(nearer, 0.1, 10.0)
            active = active[~last]
            if not active.size:
                break

    def _step(self, chains: NDArray[np.intp]) -> Array:
        """The damped step of each of some chains, of equations scaled by their diagonal."""
        normal, side = self.normal[chains], self.side[chains]
        size = np.sqrt(normal.diagonal(axis1=1, axis2=2))
        scale = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0.0)
        scaled = normal * scale[:, :, None] * scale[:, None, :]
        damping = np.maximum(self.damping[chains], _LEAST_DAMPING)
        scaled += damping[:, None, None] * np.eye(size.shape[1])
        return np.asarray(-scale * np.linalg.solve(scaled, (scale * side)[:, :, None])[:, :, 0])

    def chains(self) -> list[Chain]:
        """The chains with the deviations of their ends."""
        outline, free, count = self.outline, self.spread.shape[1], len(self.outline.places)
        variances = np.maximum(self.squares / max(len(outline.x) - free, 1), 1.0)
        covariances = self.spread @ np.linalg.pinv(self.normal, hermitian=True) @ self.spread.T
        deviations = np.sqrt(variances[:, None] * np.maximum(covariances.diagonal(axis1=1, axis2=2), 0.0))
        return [
            Chain(
                names, ends[:count], ends[count:], float(squares), free, deviation, outline.turn, outline.advance,
                outline.slopes, outline.smooth,
            )
            for names, ends, squares, deviation in zip(self.names, self.ends, self.squares, deviations, strict=True)
        ]  # fmt: skip


def _squares(chain: Chain) -> float:
    return chain.squares


def _woven(names: Sequence[str], rests: Sequence[str]) -> Iterator[str]:
    """The names of moves, with rests between them where there are such."""
    for i, name in enumerate(names):
        yield name
        if i < len(rests):
            yield rests[i]


def spline_of(chain: Chain, move: int) -> CurveFit:
    """A spline that is a law of a chain but for rounding."""
    law = catalogue[chain.names[move]].law
    (start, stop), (low, high) = chain.places[move : move + 2], chain.heights[move : move + 2]
    k = np.unique(np.concatenate([np.linspace(*piece, _PIECES_OF_LAW + 1) for piece in pairwise(law.breaks)]))
    ends = []
    for places in (k[:-1], np.nextafter(k[1:], 0.0)):
        scale = (high - low) / (stop - start) ** np.arange(3)
        ends.append(np.array([law(places, nu) for nu in range(3)]).T * scale)
    at = start + (stop - start) * k
    pieces = [BPoly.from_derivatives(at[i : i + 2], [ends[0][i], ends[1][i]]).c[:, 0] for i in range(len(k) - 1)]
    spline = BSpline(np.repeat(at, DEGREE + 1), low + np.concatenate(pieces), DEGREE)
    joints = tuple(Joint(float(place), 1) for place in start + (stop - start) * np.array(law.breaks[1:-1]))
    return CurveFit(spline, np.zeros((len(spline.c), 1)), joints, 0.0, 0, 1, (End(), End()))


def criterion(squares: float, free: int, rows: int) -> float:
    """Schwarz's criterion, least for the model that rows make likeliest."""
    return rows * log(max(squares, 1e-300) / rows) + log(rows) * free
