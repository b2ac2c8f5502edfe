"""Least squares of splines: their rows, their ends between lines, and where joints lower the sum of squares most."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BPoly, BSpline
from scipy.linalg.lapack import dgeqrf

from optlaws.cycles.old_tables.curve_fit import CANDIDATES, DEGREE, CurveFit, End, Joint, basis
from optlaws.numbers import Array

#: rows more than coefficients at least: a spline through all of them may be anything between
_LEFT = 2
#: numbers in a matrix that is factored at most: from some 9,000 on OpenBLAS takes several threads, which cost more here
_DENSE = 8_000
#: where each piece of a spline is looked at, and by how many times the stroke it goes where no rows tell it
_LOOKED_AT, _SWINGING = np.arange(0.125, 1.0, 0.25), 2.0
#: rows in searches for joints, which need not be all
_SEARCHED = 160
#: a smoother joint is preferred if it lowers the sum of squares by so much of what the best one does
_AS_GOOD = 0.8
#: of sums of squares, where there are too few rows for a fit
_MOST = 1e300
#: steps about a joint, and of a step, within which and how nearly it is placed together with ends
_JOINT_ROOM, _TOGETHER = 8.0, 0.01
#: of a step: about a joint it is looked for within less and less
_WIDTHS = (2.0, 0.5, 0.12, 0.03, 0.008, 0.002)
#: where the end of a rest is looked for first, from its move on, as shares of where it may be
_LOOKS = np.array([0.0, *2.0 ** np.arange(-8.0, 1.0)])
#: of a step: how near the ends of rests are looked for, in the end and in searches
_FINE, ROUGH = 0.02, 0.2
#: of a step: ends of rests beside one polynomial are no nearer; and how often they are moved at most
_EXACT, _ENDS_MOVED = 1e-9, 40
#: of a sum of squares: what is gained in the last step of a search among degrees
_AS_NEAR = 1e-4


def _nearly_orthogonal(u: Array, contact: int, degree: int) -> Array:
    """Polynomials with so many zeros at -1 and at 1 whose products at dense places sum up to about 0.

    These are (1 - u^2)^m times Gegenbauer's, of alpha = 2 m + 1/2.
    """
    alpha, columns = 2.0 * contact + 0.5, [(1.0 - u * u) ** contact]
    columns.append(2.0 * alpha * u * columns[0])
    for n in range(2, degree + 1):
        ahead = 2.0 * (n + alpha - 1.0) * u * columns[-1] - (n + 2.0 * alpha - 2.0) * columns[-2]
        columns.append(ahead / n)
    rows = np.column_stack(columns)
    return np.asarray(rows / np.sqrt((rows**2).sum(axis=0)))


def _local_basis(knots: Array, places: Array, degree: int) -> tuple[NDArray[np.intp], Array]:
    """The first B-spline that is not 0 at each place, and the values of it and the next ones, shape (degree + 1, n).

    By the recurrence of Cox and de Boor; a sparse matrix of scipy takes more than twice as long to make.
    """
    last = np.clip(knots.searchsorted(places, side="right") - 1, degree, len(knots) - degree - 2)
    before = [places - knots[last - i] for i in range(degree)]
    behind = [knots[last + 1 + i] - places for i in range(degree)]
    values: list[Array] = [np.ones(len(places))]
    for order in range(1, degree + 1):
        shares = [values[i] / (behind[i] + before[order - 1 - i]) for i in range(order)]
        inner = (before[order - i] * shares[i - 1] + behind[i] * shares[i] for i in range(1, order))
        values = [behind[0] * shares[0], *inner, before[0] * shares[-1]]
    return last - degree, np.array(values)


def _condensed(knots: Array, places: Array, heights: Array, weights: Array, degree: int) -> Array:
    """Few equations for the coefficients of a spline, with right sides, whose squares sum up as those of all rows do.

    The rows of a piece have a column for each of its B-splines and one for the heights: the triangular factors of not
    too many of them do.
    """
    width, count = degree + 1, len(knots) - degree - 1
    first, values = _local_basis(knots, places, degree)
    at = np.arange(len(places))
    begun = np.flatnonzero(np.diff(first, prepend=-1))
    since = at - np.repeat(begun, np.diff(begun, append=len(places)))
    starts = np.flatnonzero(since % (_DENSE // (width + 1)) == 0)
    counts, firsts = np.diff(starts, append=len(places)), first[starts]
    block = np.repeat(np.arange(len(starts)), counts)
    blocks = np.zeros((len(starts), max(counts.max(initial=0), width + 1), width + 1))
    blocks[block, at - starts[block]] = (np.vstack([values, heights]) * weights).T
    factors: Array = np.asarray(np.linalg.qr(blocks, mode="r"))
    few = np.zeros((len(firsts), width + 1, count + 1))
    columns = np.column_stack([firsts[:, None] + np.arange(width), np.full(len(firsts), count)])
    np.put_along_axis(few, np.broadcast_to(columns[:, None, :], factors.shape), factors, axis=2)
    return few.reshape(-1, count + 1)


def _knots(start: float, stop: float, joints: Sequence[Joint], pieces: int, degree: int = DEGREE) -> Array:
    """Knots of about as many pieces, even between joints."""
    ends = [start, *(joint.place for joint in joints), stop]
    inner: list[float] = []
    for i, (low, high) in enumerate(pairwise(ends)):
        count = max(1, round(pieces * (high - low) / (stop - start)))
        inner += np.linspace(low, high, count + 1)[1:-1].tolist()
        if i < len(joints):
            inner += [high] * (degree - joints[i].continuity)
    return np.array([*[start] * (degree + 1), *inner, *[stop] * (degree + 1)])


@cache
def _between(count: int, before: int, behind: int) -> Array:
    """The columns of the unit matrix without so many of the first and of the last ones."""
    return np.eye(count)[:, before : count - behind]


@dataclass(frozen=True, eq=False)
class LeastSquares:
    """Fits splines to rows between two ends, or round a turn in which they advance."""

    x: Array
    y: Array
    noise: Array
    ends: tuple[End, End]
    advance: float | None  #: of the turn
    continuity: int = 2  #: at the seam of the turn
    fine: float = _FINE  #: of a step: how near the ends of rests are looked for
    degree: int = DEGREE
    contact: int = 2  #: how many derivatives, with the position, are those of a rest or a line where it ends
    corners: tuple[bool, bool] = (False, False)  #: whether only the position is, where it starts and where it ends

    def thinned(self) -> LeastSquares:
        """The same with fewer rows, for searches."""
        some = slice(None, None, max(1, len(self.x) // _SEARCHED))
        return replace(self, x=self.x[some], y=self.y[some], noise=self.noise[some], fine=ROUGH)

    def solved(
        self, start: float, stop: float, joints: Sequence[Joint], pieces: int, *, whole: bool = False
    ) -> tuple[float, int, CurveFit | None]:
        """The sum of squares, the number of parameters, and with `whole` the fit."""
        joints = tuple(joint for joint in joints if start < joint.place < stop)
        knots = _knots(start, stop, joints, pieces, self.degree)
        low, high = int(self.x.searchsorted(start)), int(self.x.searchsorted(stop, side="right"))
        outside = float(self._about_lines[0][low] + self._about_lines[1][high])
        free = len(knots) - self.degree - 1 - self.fixed
        parameters = free + len(joints) + sum(end.line is not None for end in self.ends)
        if high - low < free + _LEFT:
            return np.inf, parameters, None
        few = self._equations(knots, slice(low, high))
        turned, coefficients = self._known(knots)
        matrix = np.empty((len(few), free + 1), order="F")
        matrix[:, :free] = few[:, :-1] @ turned
        matrix[:, free] = few[:, -1] - few[:, :-1] @ coefficients
        r = dgeqrf(matrix, overwrite_a=True)[0]
        size = np.abs(r.diagonal()[:free])
        if len(r) < free or (free and size.min() <= 1e-10 * size.max()):
            return np.inf, parameters, None
        squares = outside + (float(r[free, free]) ** 2 if len(r) > free else 0.0)
        if not whole:
            return squares, parameters, None
        factor = turned @ np.linalg.inv(np.triu(r[:free, :free]))
        spline = BSpline(knots, coefficients + factor @ r[:free, free], self.degree)
        if np.ptp(spline(knots[:-1, None] + np.diff(knots)[:, None] * _LOOKED_AT)) > _SWINGING * np.ptp(self.y):
            return np.inf, parameters, None
        if self.advance is not None and self.continuity < 2:
            joints = (Joint(start, self.continuity), *joints, Joint(stop, self.continuity))
        first, last = ((Joint(at, 0),) * corner for at, corner in zip((start, stop), self.corners, strict=True))
        joints = (*first, *joints, *last)
        return (
            squares,
            parameters,
            CurveFit(spline, factor, joints, squares, parameters, len(self.x), self.ends, pieces, self.contact),
        )

    def squares(self, start: float, stop: float, joints: Sequence[Joint], pieces: int) -> float:
        """The sum of squares, computed once where a search comes back."""
        key = (start, stop, tuple(joints), pieces)
        if key not in self._squares:
            self._squares[key] = self.solved(start, stop, joints, pieces)[0]
        return self._squares[key]

    @cached_property
    def _squares(self) -> dict[tuple[float, float, tuple[Joint, ...], int], float]:
        return {}

    @cached_property
    def _about_lines(self) -> tuple[Array, Array]:
        """The sums of squares of the rows before each one about the line before, and of those from it on behind."""
        before, behind = (
            np.zeros(len(self.x)) if end.line is None else ((self.y - end.value(self.x)) / self.noise) ** 2
            for end in self.ends
        )
        return np.append(0.0, np.cumsum(before)), np.append(np.cumsum(behind[::-1])[::-1], 0.0)

    def _equations(self, knots: Array, rows: slice) -> Array:
        """Equations for the coefficients of a spline with right sides: of each row, or few that stand for many rows."""
        x, y, weights = self.x[rows], self.y[rows], 1.0 / self.noise[rows]
        if len(x) * len(knots) > _DENSE:
            return _condensed(knots, x, y, weights, self.degree)
        return np.column_stack([basis(knots, x, self.degree), y]) * weights[:, None]

    def ends_of(
        self, start: float, stop: float, joints: Sequence[Joint], pieces: int, width: float | None = None
    ) -> tuple[float, float]:
        """Where the rests end by the least sum of squares, within a width about a start and a stop."""
        places = [start, stop]
        step = float(np.median(np.diff(self.x)))
        sides = [side for side, end in enumerate(self.ends) if end.line is not None]
        if width is None:
            # a coarse look over all of the rests' ends first, the nearer to the move the closer
            width = 0.0
            for side in sides:
                end = self.ends[side]
                near, far = (end.low, end.high) if side == 1 else (end.high, end.low)
                tried = near + (far - near) * _LOOKS
                squares = [self._with(places, side, float(at), joints, pieces) for at in tried]
                least = int(np.argmin(squares))
                places[side] = float(tried[least])
                beside = tried[[max(least - 1, 0), min(least + 1, len(tried) - 1)]]
                width = max(width, 0.5 * float(np.ptp(beside)))
        wide = width
        middle = self.squares(places[0], places[1], joints, pieces)
        while sides and wide > self.fine * step:
            moved = False
            for side in sides:
                end, at = self.ends[side], places[side]
                around = [min(max(at + sign * wide, end.low), end.high) for sign in (-1.0, 1.0)]
                low, high = (self._with(places, side, place, joints, pieces) for place in around)
                best = min((low, around[0]), (middle, at), (high, around[1]))
                bent = low - 2.0 * middle + high
                if best[1] == at and bent > 0.0 and np.isfinite(bent) and around[1] - at == at - around[0]:
                    place = at + 0.5 * wide * (low - high) / bent
                    best = min(best, (self._with(places, side, place, joints, pieces), place))
                else:
                    moved = moved or best[1] != at
                middle, places[side] = best
            wide *= 1.0 if moved else 0.25
        return places[0], places[1]

    def _with(self, places: Sequence[float], side: int, place: float, joints: Sequence[Joint], pieces: int) -> float:
        """The sum of squares with one end elsewhere."""
        start, stop = (place, places[1]) if side == 0 else (places[0], place)
        return self.squares(start, stop, joints, pieces) if start < stop else np.inf

    def polynomial_ends(self, at: tuple[float, float]) -> tuple[float, float]:
        """Where the rests beside one polynomial end by the least sum of squares, from places near these on."""
        from scipy.optimize import least_squares

        low, high = np.array([end.low for end in self.ends]), np.array([end.high for end in self.ends])
        if not np.all(low < high):
            return at
        step = float(np.median(np.diff(self.x)))
        start, stop = least_squares(
            self._missed, np.clip(np.array(at), low, high), bounds=(low, high), x_scale=step,
            ftol=_AS_NEAR if self.fine == ROUGH else None, xtol=_EXACT, gtol=None, max_nfev=_ENDS_MOVED,
        ).x  # fmt: skip
        return float(start), float(stop)

    def polynomial_squares(self, at: tuple[float, float]) -> float:
        """The sum of squares about the best polynomial between two rests that end there."""
        off = self._missed(np.array(at))
        return float(off @ off)

    def _missed(self, at: Array) -> Array:
        """How far the best polynomial between two rests that end there misses each row, in deviations of its noise."""
        x, (start, stop), (first, last) = self.x, at, self.ends
        off = np.where(x < start, self.y - first.value(x), self.y - last.value(x)) / self.noise
        inside = (x >= start) & (x <= stop)
        known = [[float(end.value(np.array(place))), end.slope, 0.0] for end, place in ((first, start), (last, stop))]
        between = BPoly.from_derivatives([start, stop], [each[: self.contact] for each in known])(x[inside])
        u, noise = (2.0 * x[inside] - start - stop) / (stop - start), self.noise[inside]
        rows = _nearly_orthogonal(u, self.contact, self.degree - 2 * self.contact) / noise[:, None]
        left = (self.y[inside] - between) / noise
        off[inside] = left - rows @ np.linalg.lstsq(rows.T @ rows, rows.T @ left, rcond=None)[0]
        return np.asarray(off)

    def joint(self, start: float, stop: float, joints: Sequence[Joint], pieces: int) -> Joint | None:
        """The joint that lowers the sum of squares most, the smoothest one of those that do it nearly as much."""
        knots = _knots(start, stop, joints, pieces)
        inside = (self.x >= start) & (self.x <= stop)
        x, weights = self.x[inside], 1.0 / self.noise[inside]
        rows = basis(knots, x)
        count = rows.shape[1]
        turned, coefficients = self._known(knots)
        if len(x) < count + 2:
            return None
        q, _ = np.linalg.qr((rows @ turned) * weights[:, None])
        left = (self.y[inside] - rows @ coefficients) * weights
        left = left - q @ (q.T @ left)
        margin = 2.0 * float(np.median(np.diff(x)))
        grid = np.linspace(start + margin, stop - margin, CANDIDATES)
        grid = grid[[all(abs(place - other.place) > margin for other in joints) for place in grid]]
        if not grid.size:
            return None
        candidates: list[tuple[float, Joint]] = []
        for continuity in (2, 1, 0):
            places = grid
            for _ in range(2):
                columns = np.maximum(x[:, None] - places, 0.0) ** (continuity + 1) * weights[:, None]
                size = (columns**2).sum(axis=0)
                columns = columns - q @ (q.T @ columns)
                rest = (columns**2).sum(axis=0)
                gains = np.where(rest > 1e-8 * size, (left @ columns) ** 2 / np.maximum(rest, 1e-300), 0.0)
                at = int(np.argmax(gains))
                width = (stop - start) / CANDIDATES
                last = float(gains[at]), Joint(float(places[at]), continuity)
                places = np.clip(np.linspace(places[at] - width, places[at] + width, 9), grid[0], grid[-1])
            candidates.append(last)
        most = max(gain for gain, _ in candidates)
        return next(joint for gain, joint in candidates if gain >= _AS_GOOD * most)

    @property
    def _contacts(self) -> tuple[int, int]:
        first, last = self.corners
        return 1 if first else self.contact, 1 if last else self.contact

    @property
    def fixed(self) -> int:
        """The number of coefficients that lines at its ends, or its seam, tell."""
        if self.advance is not None:
            return self.continuity + 1
        return sum(n for end, n in zip(self.ends, self._contacts, strict=True) if end.line is not None)

    def _known(self, knots: Array) -> tuple[Array, Array]:
        """A matrix and a vector that make all coefficients of a spline out of those that its ends leave free."""
        count, degree = len(knots) - self.degree - 1, self.degree
        coefficients = np.zeros(count)
        if self.advance is not None:
            turned = np.eye(count)
            for nu in range(self.continuity + 1):
                first, last = (basis(knots, knots[[at]], degree, nu)[0] for at in (0, -1))
                differs = (first - last) / last[-1 - nu]
                differs[-1 - nu] = 0.0
                turned[-1 - nu] = differs @ turned
                coefficients[-1 - nu] = differs @ coefficients + (self.advance if nu == 0 else 0.0)
            return turned[:, : count - self.fixed], coefficients
        known = [0 if end.line is None else n for end, n in zip(self.ends, self._contacts, strict=True)]
        for end, first, contact in zip(self.ends, (0, count - known[1]), known, strict=True):
            # the coefficients of a straight line are its positions at the means of knots
            means = [sum(knots[i + 1 : i + 1 + degree].tolist()) / degree for i in range(first, first + contact)]
            coefficients[first : first + contact] = end.value(np.array(means))
        return _between(count, *known), coefficients

    def placed(self, fit: tuple[float, float], joints: Sequence[Joint], pieces: int) -> tuple[Joint, ...]:
        """Joints moved to where the sum of squares is least."""
        moved = list(joints)
        step = float(np.median(np.diff(self.x)))
        for width in _WIDTHS:
            for i, joint in enumerate(moved):
                tried = joint.place + width * step * np.linspace(-1.0, 1.0, 7)
                squares = []
                for place in tried:
                    others = sorted([*moved[:i], Joint(float(place), joint.continuity), *moved[i + 1 :]])
                    squares.append(self.squares(*fit, others, pieces))
                moved[i] = Joint(float(tried[int(np.argmin(squares))]), joint.continuity)
        return tuple(sorted(moved))

    def placed_together(
        self, fit: tuple[float, float], joints: Sequence[Joint], pieces: int
    ) -> tuple[tuple[float, float], tuple[Joint, ...]]:
        """Ends and joints moved to where the sum of squares is least, all at once, for corners hide joints."""
        from scipy.optimize import minimize

        step = float(np.median(np.diff(self.x)))
        begun = np.array([*fit, *(joint.place for joint in joints)])
        low = np.array([*(end.low for end in self.ends), *(begun[2:] - _JOINT_ROOM * step)])
        high = np.array([*(end.high for end in self.ends), *(begun[2:] + _JOINT_ROOM * step)])

        def at(places: Array) -> tuple[Joint, ...]:
            moved = zip(places[2:].tolist(), joints, strict=True)
            return tuple(sorted(Joint(place, joint.continuity) for place, joint in moved))

        def squares(places: Array) -> float:
            return min(self.solved(float(places[0]), float(places[1]), at(places), pieces)[0], _MOST)

        begun = np.clip(begun, low, high)
        simplex = np.clip(begun + step * np.vstack([np.zeros_like(begun), np.eye(len(begun))]), low, high)
        start, stop, *_ = best = minimize(
            squares, begun, method="Nelder-Mead", bounds=list(zip(low, high, strict=True)),
            options={"initial_simplex": simplex, "xatol": _TOGETHER * step, "fatol": 0.1, "maxfev": 400},
        ).x  # fmt: skip
        return (float(start), float(stop)), at(best)
