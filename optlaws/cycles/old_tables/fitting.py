"""Splines through samples of a motion between two rests or ends: their joints, and which of them the noise allows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from math import log
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BPoly, BSpline, make_interp_spline

from optlaws.numbers import Array

DEGREE = 5
#: pieces of a spline that is simple enough to stand beside standard laws, at most
SIMPLE = 6
#: variance about a spline, over that of the noise: it is no model
UNRESOLVED = 9.0
#: numbers of pieces that are tried
_PIECES = (1, 2, 3, 4, 5, 6, 8, 10, 13, 17, 22, 29, 38, 50)
#: rows for each coefficient at least
_ROWS_EACH = 1.6
#: rows more than coefficients at least: a spline through all of them may be anything between
_LEFT = 2
#: rows in searches for joints, which need not be all
_SEARCHED = 160
#: numbers of pieces between which a joint is looked for
_COARSE = (1, 2, 4)
#: a smoother joint is preferred if it lowers the sum of squares by so much of what the best one does
_AS_GOOD = 0.8
_MOST_JOINTS = 8
#: of the greatest velocity: what is slower may turn by chance
_SLOW = 0.01
#: pieces from which on corners are looked for where a spline begins and ends
_CORNERED = 8
#: of the greatest velocity, and in standard deviations: by so much it changes at a corner
_CORNER, _CERTAIN = 0.02, 5.0
#: steps within which a corner is where the rows of a line end
_NEAR_CORNER = 4.0
#: how many numbers of pieces are tried without a jump of the acceleration at rests
_MORE = 6
#: of a step: about a joint it is looked for within less and less
_WIDTHS = (2.0, 0.5, 0.12, 0.03, 0.008, 0.002)
#: places within a piece at which a joint is tried that is to be smoother
_MOVED = 19
#: how often joints and ends are placed by each other
_SETTLED = 2
#: how many models with more pieces than the best one are looked at beside it
_FINER = 2
#: by how much the criterion of Schwarz must fall for a joint to be there
_EVIDENT = 12.0
#: places at which a joint is looked for
_CANDIDATES = 160
#: with as few pieces no joint is looked for: the motion is smooth
_SIMPLE = 4
#: where the end of a rest is looked for first, from its move on, as shares of where it may be
_LOOKS = np.array([0.0, *2.0 ** np.arange(-8.0, 1.0)])
#: of a step: how near the ends of rests are looked for, in the end and in searches
_FINE, _ROUGH = 0.02, 0.2
#: a polynomial of more degrees is looked at beside joints
_FEW_DEGREES = 15
#: degrees of one polynomial for a whole move, and how many derivatives it may have in common with the rests beside it
_DEGREES, _CONTACTS = range(7, 34, 2), (3, 2)
#: of a step: ends of rests beside one polynomial are no nearer; and how often they are moved at most
_EXACT, _ENDS_MOVED = 1e-9, 40
#: of a sum of squares: what is gained in the last step of a search among degrees
_AS_NEAR = 1e-4
#: steps to which places are rounded where the rows allow it, in parts of a turn
_ROUND = (1.0 / 36.0, 1.0 / 72.0, 1.0 / 360.0, 1.0 / 720.0, 1.0 / 3600.0)
#: a master that is longer is no turn in radians or turns
_RADIANS = 12.0
#: by how much the sum of squares may grow for each place that is rounded
AS_LIKELY = 4.0
#: with more pieces the ends of rests are no longer looked for: the pieces begin to take part in the rests
_ENDS_BY = 6


class Joint(NamedTuple):
    """A place where derivatives above the order `continuity` jump: 0 at a corner, 1 where the acceleration jumps."""

    place: float
    continuity: int


class End(NamedTuple):
    """An end of a curve: the line from which it starts with its value and slope, a rest for one; or none."""

    line: tuple[float, float, float] | None = None  #: a place, and the value and the slope there
    low: float = 0.0  #: where the line ends at the earliest
    high: float = 0.0  #: and at the latest

    def value(self, places: Array) -> Array:
        """The positions on the line."""
        place, value, slope = self.line or (0.0, 0.0, 0.0)
        return value + slope * (places - place)

    @property
    def slope(self) -> float:
        """The velocity on the line."""
        return self.line[2] if self.line else 0.0

    def moved(self, along: float, up: float) -> End:
        """The end, moved along the master and up."""
        line = None if self.line is None else (self.line[0] + along, self.line[1] + up, self.line[2])
        return End(line, self.low + along, self.high + along)


@dataclass(frozen=True, eq=False)
class CurveFit:
    """A spline fitted to samples by least squares.

    Attributes
    ----------
    spline
        The motion from its start to its stop.
    covariance
        Root of the covariance of its coefficients: a factor F with F Fᵀ as the covariance.
    joints
        Where it has jumps inside.
    squares, free, rows
        The sum of squares over the variance of the noise, the number of parameters, and that of rows.
    ends, contact
        The lines or rests beside it, and how many derivatives, with the position, it has in common with these.
    pieces
        About how many polynomials it has.
    jumps
        Whether its acceleration jumps at a rest, where that of no other model as likely does not.
    """

    spline: BSpline
    factor: Array
    joints: tuple[Joint, ...]
    squares: float
    free: int
    rows: int
    ends: tuple[End, End]
    pieces: int = 1
    contact: int = 2
    jumps: bool = False

    @property
    def corners(self) -> tuple[bool, bool]:
        """Whether it leaves the lines or rests beside it with another velocity."""
        places = [joint.place for joint in self.joints if joint.continuity == 0]
        return (
            self.ends[0].line is not None and self.start in places,
            self.ends[1].line is not None and self.stop in places,
        )

    def changes(self) -> tuple[bool, bool]:
        """Whether it leaves the lines beside it with velocities that differ as at a corner."""
        at = np.array([self.start, self.stop])
        off = np.abs(self.values(at, 1) - [end.slope for end in self.ends])
        greatest = float(np.abs(self.values(np.linspace(self.start, self.stop, _CANDIDATES), 1)).max())
        first, last = (off > np.maximum(_CORNER * greatest, _CERTAIN * self.deviation(at, 1))).tolist()
        return bool(self.ends[0].line and first), bool(self.ends[1].line and last)

    @property
    def degree(self) -> int:
        """The degree of its polynomials."""
        return int(self.spline.k)

    @property
    def start(self) -> float:
        """The place where it begins."""
        return float(self.spline.t[self.degree])

    @property
    def stop(self) -> float:
        """The place where it ends."""
        return float(self.spline.t[-self.degree - 1])

    @property
    def breaks(self) -> Array:
        """Where its polynomials meet."""
        return np.unique(self.spline.t[self.degree : len(self.spline.t) - self.degree])

    def moved(self, along: float, up: float) -> CurveFit:
        """The fit, moved along the master and up."""
        spline = BSpline(self.spline.t + along, self.spline.c + up, self.degree)
        joints = tuple(joint._replace(place=joint.place + along) for joint in self.joints)
        return replace(
            self, spline=spline, joints=joints, ends=(self.ends[0].moved(along, up), self.ends[1].moved(along, up))
        )

    def begun_at(self, place: float, advance: float) -> CurveFit:
        """The fit of a turn in which it advances, begun at a place within: what is before it follows."""
        if not self.start < place < self.stop:
            return self
        degree, turn = self.degree, self.stop - self.start
        columns = BSpline(self.spline.t, np.column_stack([self.spline.c, self.factor]), degree)
        divided = columns.insert_knot(place, degree - int(np.count_nonzero(self.spline.t == place)))
        first = int(np.searchsorted(divided.t, place))
        before, behind = divided.c[:first], divided.c[first - 1 :].copy()
        before[:, 0] += advance
        later = np.append(divided.t[first : -degree - 1], np.repeat(self.stop, degree))
        knots = np.concatenate([[place], later, divided.t[degree + 1 : first + degree] + turn, [place + turn]])
        joints = [joint._replace(place=joint.place + turn * (joint.place <= place)) for joint in self.joints]
        c = np.vstack([behind, before[1:]])
        spline = BSpline(knots, c[:, 0], degree)
        return replace(self, spline=spline, factor=c[:, 1:], joints=tuple(sorted(set(joints))))

    @property
    def variance(self) -> float:
        """The variance of the rows about it, over that of the noise."""
        return self.squares / max(self.rows - self.free, 1)

    def criterion(self, price: float) -> float:
        """The criterion of Akaike (price 2) or Schwarz (price log of the rows), which is least for the best model."""
        return self.rows * log(max(self.squares, 1e-300) / self.rows) + price * self.free

    def values(self, places: Array, nu: int = 0) -> Array:
        """A derivative at places, by the master."""
        return np.asarray(_basis(self.spline.t, places, self.degree, nu) @ self.spline.c)

    def height(self, place: float) -> float:
        """The position at a place; where it leaves a line, that of the line to the last digit."""
        for end, at in zip(self.ends, (self.start, self.stop), strict=True):
            if end.line is not None and place == at:
                return float(end.value(np.array(place)))
        return float(self.values(np.array([place]))[0])

    def deviation(self, places: Array, nu: int) -> Array:
        """Standard deviations of a derivative at places, for noise of the variance about it."""
        rows = _basis(self.spline.t, places, self.degree, nu) @ self.factor
        return np.asarray(np.sqrt(max(self.variance, 1.0) * (rows**2).sum(axis=1)))


def _basis(knots: Array, places: Array, degree: int = DEGREE, nu: int = 0) -> Array:
    """B-splines or their derivatives at places, a row for each; of the right-hand side at a jump."""
    inner, turned = knots, np.eye(len(knots) - degree - 1)
    for _ in range(nu):
        spans = (inner[degree + 1 : -1] - inner[1 : -degree - 1])[:, None]
        turned = np.divide(degree * np.diff(turned, axis=0), spans, out=np.zeros_like(turned[1:]), where=spans > 0.0)
        inner, degree = inner[1:-1], degree - 1
    x = np.clip(places, inner[0], inner[-1])
    # all of them evaluated at once: a sparse matrix of as few columns takes longer to make
    rows: Array = BSpline.construct_fast(inner, np.eye(len(inner) - degree - 1), degree)(x)
    return np.asarray(rows @ turned, dtype=np.float64) if nu else rows


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


def _condensed(knots: Array, places: Array, heights: Array, weights: Array, degree: int) -> Array:
    """Few equations for the coefficients of a spline, with right sides, whose squares sum up as those of all rows do.

    The rows of a piece have a column for each of its B-splines and one for the heights: their triangular factor does.
    """
    width, count = degree + 1, len(knots) - degree - 1
    matrix = BSpline.design_matrix(places, knots, degree)
    firsts, starts, counts = np.unique(matrix.indices[::width], return_index=True, return_counts=True)
    piece = np.repeat(np.arange(len(firsts)), counts)
    blocks = np.zeros((len(firsts), max(counts.max(initial=0), width + 1), width + 1))
    rows = np.column_stack([matrix.data.reshape(-1, width), heights]) * weights[:, None]
    blocks[piece, np.arange(len(places)) - starts[piece]] = rows
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


@dataclass(frozen=True, eq=False)
class _Fitter:
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

    def thinned(self) -> _Fitter:
        """The same with fewer rows, for searches."""
        some = slice(None, None, max(1, len(self.x) // _SEARCHED))
        return replace(self, x=self.x[some], y=self.y[some], noise=self.noise[some], fine=_ROUGH)

    def solved(
        self, start: float, stop: float, joints: Sequence[Joint], pieces: int, *, whole: bool = False
    ) -> tuple[float, int, CurveFit | None]:
        """The sum of squares, the number of parameters, and with `whole` the fit."""
        joints = tuple(joint for joint in joints if start < joint.place < stop)
        knots = _knots(start, stop, joints, pieces, self.degree)
        inside = (self.x >= start) & (self.x <= stop)
        outside = 0.0
        for end, away in ((self.ends[0], self.x < start), (self.ends[1], self.x > stop)):
            if end.line is not None:
                outside += float((((self.y[away] - end.value(self.x[away])) / self.noise[away]) ** 2).sum())
        turned, coefficients = self._known(knots)
        free = turned.shape[1]
        parameters = free + len(joints) + sum(end.line is not None for end in self.ends)
        if int(inside.sum()) < free + _LEFT:
            return np.inf, parameters, None
        few = _condensed(knots, self.x[inside], self.y[inside], 1.0 / self.noise[inside], self.degree)
        left = few[:, -1:] - few[:, :-1] @ coefficients[:, None]
        r: Array = np.asarray(np.linalg.qr(np.hstack([few[:, :-1] @ turned, left]), mode="r"))
        size = np.abs(np.diag(r)[:free])
        if len(r) < free or (free and size.min() <= 1e-10 * size.max()):
            return np.inf, parameters, None
        squares = outside + (float(r[free, free]) ** 2 if len(r) > free else 0.0)
        if not whole:
            return squares, parameters, None
        factor = turned @ np.linalg.inv(r[:free, :free])
        spline = BSpline(knots, coefficients + factor @ r[:free, free], self.degree)
        if self.advance is not None and self.continuity < 2:
            joints = (Joint(start, self.continuity), *joints, Joint(stop, self.continuity))
        first, last = ((Joint(at, 0),) * corner for at, corner in zip((start, stop), self.corners, strict=True))
        joints = (*first, *joints, *last)
        return (
            squares,
            parameters,
            CurveFit(spline, factor, joints, squares, parameters, len(self.x), self.ends, pieces, self.contact),
        )

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
        middle = self.solved(places[0], places[1], joints, pieces)[0]
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
        return self.solved(start, stop, joints, pieces)[0] if start < stop else np.inf

    def polynomial_ends(self, at: tuple[float, float]) -> tuple[float, float]:
        """Where the rests beside one polynomial end by the least sum of squares, from places near these on."""
        from scipy.optimize import least_squares

        low, high = np.array([end.low for end in self.ends]), np.array([end.high for end in self.ends])
        if not np.all(low < high):
            return at
        step = float(np.median(np.diff(self.x)))
        start, stop = least_squares(
            self._missed, np.clip(np.array(at), low, high), bounds=(low, high), x_scale=step,
            ftol=_AS_NEAR if self.fine == _ROUGH else None, xtol=_EXACT, gtol=None, max_nfev=_ENDS_MOVED,
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
        rows = _basis(knots, x)
        count = rows.shape[1]
        turned, coefficients = self._known(knots)
        if len(x) < count + 2:
            return None
        q, _ = np.linalg.qr((rows @ turned) * weights[:, None])
        left = (self.y[inside] - rows @ coefficients) * weights
        left = left - q @ (q.T @ left)
        margin = 2.0 * float(np.median(np.diff(x)))
        grid = np.linspace(start + margin, stop - margin, _CANDIDATES)
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
                width = (stop - start) / _CANDIDATES
                last = float(gains[at]), Joint(float(places[at]), continuity)
                places = np.clip(np.linspace(places[at] - width, places[at] + width, 9), grid[0], grid[-1])
            candidates.append(last)
        most = max(gain for gain, _ in candidates)
        return next(joint for gain, joint in candidates if gain >= _AS_GOOD * most)

    def _known(self, knots: Array) -> tuple[Array, Array]:
        """A matrix and a vector that make all coefficients of a spline out of those that its ends leave free."""
        count, degree = len(knots) - self.degree - 1, self.degree
        turned, coefficients = np.eye(count), np.zeros(count)
        fixed = np.zeros(count, dtype=bool)
        contacts = [1 if corner else self.contact for corner in self.corners]
        for end, first, contact in zip(self.ends, (0, count - contacts[1]), contacts, strict=True):
            if end.line is not None:
                # the coefficients of a straight line are its positions at the means of knots
                for i in range(first, first + contact):
                    fixed[i], coefficients[i] = True, end.value(knots[i + 1 : i + 1 + degree].mean())
        if self.advance is not None:
            for nu in range(self.continuity + 1):
                first, last = (_basis(knots, knots[[at]], degree, nu)[0] for at in (0, -1))
                differs = (first - last) / last[-1 - nu]
                differs[-1 - nu] = 0.0
                turned[-1 - nu] = differs @ turned
                coefficients[-1 - nu] = differs @ coefficients + (self.advance if nu == 0 else 0.0)
                fixed[-1 - nu] = True
        return turned[:, ~fixed], coefficients

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
                    squares.append(self.solved(*fit, others, pieces)[0])
                moved[i] = Joint(float(tried[int(np.argmin(squares))]), joint.continuity)
        return tuple(sorted(moved))


def _ladder(rows: int, joints: int) -> Iterator[int]:
    for pieces in _PIECES:
        if pieces == 1 or (pieces + DEGREE + (DEGREE - 1) * joints) * _ROWS_EACH <= rows:
            yield pieces


def fits_of(
    places: Array,
    heights: Array,
    noise: Array,
    ends: tuple[End, End],
    advance: float | None = None,
    *,
    smooth: int | None = None,
) -> list[CurveFit]:
    """Splines that explain rows as well as any, the simplest one first; none where the rows are too few.

    Parameters
    ----------
    places, heights, noise
        Rows, arrays of shape (n,).
    ends
        What is before the first and behind the last row of the motion.
    advance
        Of a whole turn, at whose end the motion goes on as at its start: what it advances by.
    smooth
        If given, splines without joints alone are of interest, of so many pieces at most.
    """
    fitter = _Fitter(places, heights, noise, ends, advance)
    rough = _Search(fitter.thinned(), _PIECES[-1] if smooth is None else smooth)
    middle = [
        (end.low + end.high) / 2.0 if end.line is not None else float(places[0 if side == 0 else -1])
        for side, end in enumerate(ends)
    ]
    fits = rough.climbed((), (middle[0], middle[1]), None)
    if not fits:
        return []
    for continuity in (1, 0) if advance is not None and rough.best(fits).pieces > _SIMPLE else ():
        other = _Search(replace(rough.fitter, continuity=continuity), rough.most)
        family = other.climbed((), (middle[0], middle[1]), None)
        if family and other.criterion(other.best(family)) < rough.criterion(rough.best(fits)) - _EVIDENT:
            rough, fits, fitter = other, family, replace(fitter, continuity=continuity)
    best = rough.best(fits)
    polynomials = rough.polynomials((best.start, best.stop)) if best.pieces > _SIMPLE else []
    plain = [fit for fit in polynomials if rough.criterion(fit) < rough.criterion(best)]
    explaining = plain if plain and likely(rough.best(plain).squares, rough.rows) else []
    few = bool(explaining) and rough.best(plain).degree <= _FEW_DEGREES
    joints: tuple[Joint, ...] = ()
    if smooth is None and not few:
        joints, fits = rough.jointed(fits)
        rough, joints, fits = rough.with_corners(joints, fits)
        fitter = replace(fitter, corners=rough.fitter.corners, ends=rough.fitter.ends)
    best = rough.best(fits)
    if explaining and rough.criterion(rough.best(plain)) < rough.criterion(best):
        refined = [_refined(fitter, fit) for fit in rough.accepted(polynomials)]
        if likely(min(fit.squares for fit in refined), len(places)):
            return rough.with_jumps(refined)
    at = best.start, best.stop
    if joints:
        joints = rough.fitter.placed(at, joints, best.pieces)
    whole = _Search(fitter, rough.most)
    starts = {fit.pieces: (fit.start, fit.stop) for fit in fits}
    near = float(np.median(np.diff(places)))
    accepted = whole.accepted(whole.climbed(joints, at, near, starts, fewest=best.pieces))
    return whole.with_jumps(accepted)


def likely(squares: float, rows: int) -> bool:
    """Whether noise alone makes a sum of squares of rows as great."""
    return bool(squares <= rows + 3.0 * np.sqrt(2.0 * rows))


def rounded_places(places: Array, master: Array) -> Iterator[Array]:
    """Places rounded to parts of a turn, whole tens of degrees first, in the units of a master."""
    turn = 360.0 if np.ptp(master) > _RADIANS else 1.0
    for share in _ROUND:
        yield np.round(places / (share * turn)) * share * turn


def _refined(rows: _Fitter, fit: CurveFit) -> CurveFit:
    """A polynomial, fitted to all rows; its ends are as round as these allow."""
    fitter = replace(rows, degree=fit.degree, contact=fit.contact)
    at = fitter.polynomial_ends((fit.start, fit.stop))
    most = fitter.polynomial_squares(at) + len(at) * AS_LIKELY
    for start, stop in map(tuple, rounded_places(np.array(at), rows.x)):
        inside = all(end.low <= place <= end.high for end, place in zip(rows.ends, (start, stop), strict=True))
        if inside and start < stop and fitter.polynomial_squares((start, stop)) <= most:
            at = start, stop
            break
    return fitter.solved(*at, (), 1, whole=True)[2] or fit


def interpolation(places: Array, heights: Array, ends: tuple[End, End], advance: float | None = None) -> CurveFit:
    """The spline through all rows, of which nothing tells how far it is from the motion between them."""
    levels = heights.astype(np.float64)
    for side, end in ((0, ends[0]), (-1, ends[1])):
        if end.line is not None:
            levels[side] = end.value(places[side])
    if advance is not None and len(places) > 2 * DEGREE:
        slope = advance / (places[-1] - places[0])
        levels = levels - slope * (places - places[0])
        levels[-1] = levels[0]
        spline = make_interp_spline(places, levels, DEGREE, bc_type="periodic")
        # the coefficients of a straight line are its positions at the means of knots
        means = np.array([spline.t[i + 1 : i + 1 + DEGREE].mean() for i in range(len(spline.c))])
        spline = BSpline(spline.t, spline.c + slope * (means - places[0]), DEGREE)
    else:
        sides = [[(1, end.slope), (2, 0.0)] if end.line is not None else [(3, 0.0), (4, 0.0)] for end in ends]
        spline = make_interp_spline(places, levels, DEGREE, bc_type=tuple(sides))  # type: ignore[arg-type]  # its stubs know no derivatives
    count = len(places)
    return CurveFit(spline, np.zeros((len(spline.c), 1)), (), 0.0, count, count, ends, count - 1)


class _Search:
    """Models of rows: with more and more pieces, and with joints."""

    def __init__(self, fitter: _Fitter, most: int) -> None:
        self.fitter, self.most = fitter, most
        self.rows, self.price = len(fitter.x), log(len(fitter.x))

    def criterion(self, fit: CurveFit) -> float:
        """Schwarz's criterion for these rows."""
        return fit.criterion(self.price)

    def best(self, fits: Sequence[CurveFit]) -> CurveFit:
        """The likeliest one of several fits."""
        return min(fits, key=self.criterion)

    def climbed(
        self,
        joints: Sequence[Joint],
        at: tuple[float, float],
        near: float | None,
        starts: Mapping[int, tuple[float, float]] = MappingProxyType({}),
        *,
        fewest: int = 1,
    ) -> list[CurveFit]:
        """Fits with more and more pieces, until these serve no more; ends are looked for everywhere, or near.

        Near means within a length of where fits with so many pieces start, else of where the last one does.
        """
        fits: list[CurveFit] = []
        ladder = list(_ladder(self.rows, len(joints)))
        for i, pieces in enumerate(ladder):
            if ladder[min(i + 1, len(ladder) - 1)] < fewest:
                continue
            if pieces > self.most:
                break
            if pieces <= _ENDS_BY:
                at = min({at, starts.get(pieces, at)}, key=partial(self._squares, joints, pieces))
                at = self.fitter.ends_of(*at, joints, pieces, near)
            elif fits:
                at = self.best(fits).start, self.best(fits).stop
            fit = self.fitter.solved(*at, joints, pieces, whole=True)[2]
            if fit is None:
                continue
            fits.append(fit)
            least = min(fit.criterion(2.0) for fit in fits)
            resolved = any(fit.variance <= UNRESOLVED for fit in fits)
            if resolved and len(fits) > 3 and all(fit.criterion(2.0) > least + 2.0 for fit in fits[-2:]):
                break
        return fits

    def _squares(self, joints: Sequence[Joint], pieces: int, at: tuple[float, float]) -> float:
        return self.fitter.solved(*at, joints, pieces)[0]

    def polynomials(self, at: tuple[float, float]) -> list[CurveFit]:
        """Fits of one polynomial between two rests, of more and more degrees."""
        families = []
        at_rests = None not in (end.line for end in self.fitter.ends) and not any(self.fitter.corners)
        for contact in _CONTACTS if at_rests else ():
            fits = []
            for degree in _DEGREES:
                if degree * _ROWS_EACH > self.rows or degree > self.most + DEGREE:
                    break
                fitter = replace(self.fitter, degree=degree, contact=contact)
                at = fitter.polynomial_ends(at)
                fit = fitter.solved(*at, (), 1, whole=True)[2]
                fits += [] if fit is None else [fit]
                best = self.best(fits) if fits else None
                if len(fits) > 3 and all(other is not best for other in fits[-3:]):
                    break
            families += [fits] if fits else []
        return min(families, key=lambda fits: self.criterion(self.best(fits)), default=[])

    def with_corners(
        self, joints: tuple[Joint, ...], fits: list[CurveFit]
    ) -> tuple[_Search, tuple[Joint, ...], list[CurveFit]]:
        """The search, joints and fits that leave lines or rests with other velocities where these are far likelier."""
        best, (before, after) = self.best(fits), self.fitter.ends
        near, corners = _NEAR_CORNER * float(np.median(np.diff(self.fitter.x))), (bool(before.line), bool(after.line))
        # the rows of a line end at a corner
        first, last = max(before.low, before.high - near), min(after.high, after.low + near)
        at_corners = before._replace(low=first), after._replace(high=last)
        while best.pieces > _CORNERED and self.fitter.advance is None and any(corners):
            ends = at_corners[0] if corners[0] else before, at_corners[1] if corners[1] else after
            search = _Search(replace(self.fitter, corners=corners, ends=ends), self.most)
            middles = [0.5 * (end.low + end.high) for end in ends]
            at = middles[0] if corners[0] else best.start, middles[1] if corners[1] else best.stop
            family = search.climbed((), at, 0.0)
            if not family or search.criterion(search.best(family)) > self.criterion(best) - _EVIDENT:
                break
            evident = search.best(family).changes()
            if evident == corners:
                return search, *search.jointed(family)
            corners = corners[0] and evident[0], corners[1] and evident[1]
        return self, joints, fits

    def jointed(self, fits: list[CurveFit]) -> tuple[tuple[Joint, ...], list[CurveFit]]:
        """Joints, as smooth as may be, and fits with these, as long as they make the rows far likelier."""
        joints: tuple[Joint, ...] = ()
        while len(joints) < _MOST_JOINTS and self.best(fits).pieces > _SIMPLE:
            tried = [self.joined(fits, joints, pieces) for pieces in _COARSE]
            families = [each for each in (*tried, self.joined_where_it_turns(fits, joints)) if each]
            if not families:
                break
            more, family = min(families, key=lambda each: self.criterion(self.best(each[1])))
            if self.criterion(self.best(family)) > self.criterion(self.best(fits)) - _EVIDENT:
                break
            joints, fits = more, family
        return self.smoothed(joints, fits)

    def with_jumps(self, fits: Sequence[CurveFit]) -> list[CurveFit]:
        """Fits that know whether the acceleration jumps at a rest: whether the first one without is far less likely."""
        fit = fits[0]
        places = np.array([fit.start, fit.stop])[[end.line is not None for end in self.fitter.ends]]
        if fit.contact > 2 or not np.any(np.abs(fit.values(places, 2)) > 3.0 * fit.deviation(places, 2)):
            return list(fits)
        fitter = replace(self.fitter, degree=fit.degree, contact=3, fine=_ROUGH)
        near = 4.0 * float(np.median(np.diff(fitter.x)))
        for pieces in range(fit.pieces, fit.pieces + _MORE):
            at = fitter.ends_of(fit.start, fit.stop, fit.joints, pieces, near)
            smooth = fitter.solved(*at, fit.joints, pieces, whole=True)[2]
            if smooth is not None and self.criterion(smooth) <= self.criterion(fit) + _EVIDENT:
                return list(fits)
        return [replace(each, jumps=True) for each in fits]

    def joined(
        self, fits: Sequence[CurveFit], joints: tuple[Joint, ...], pieces: int
    ) -> tuple[tuple[Joint, ...], list[CurveFit]] | None:
        """Fits with a joint more, which a model of so many pieces shows; None where it shows none."""
        base = next((fit for fit in fits if fit.pieces == pieces), None)
        joint = None if base is None else self.fitter.joint(base.start, base.stop, joints, pieces)
        return None if base is None or joint is None else self._with(base, (*joints, joint))

    def joined_where_it_turns(
        self, fits: Sequence[CurveFit], joints: tuple[Joint, ...]
    ) -> tuple[tuple[Joint, ...], list[CurveFit]] | None:
        """Fits with a joint where they turn, as two laws often meet; None where they do not turn once alone."""
        best = self.best(fits)
        at = np.linspace(best.start, best.stop, 2 * _CANDIDATES + 1)
        velocity = best.values(at, 1)
        fast = np.abs(velocity) > _SLOW * np.abs(velocity).max()
        signs = np.sign(velocity[fast])
        turns = at[fast][np.flatnonzero(signs[:-1] != signs[1:])]
        near = 2.0 * float(np.median(np.diff(self.fitter.x)))
        if len(turns) != 1 or any(abs(joint.place - turns[0]) < near for joint in joints):
            return None
        return self._with(best, (*joints, Joint(float(turns[0]), 2)))

    def _with(self, base: CurveFit, joints: tuple[Joint, ...]) -> tuple[tuple[Joint, ...], list[CurveFit]] | None:
        """Fits with joints about given places, whose ends are near those of another fit; None where there are none."""
        at = base.start, base.stop
        placed = self.fitter.placed(at, sorted(joints), base.pieces)
        more = tuple(joint for joint in placed if at[0] < joint.place < at[1])
        family = self.climbed(more, at, 2.0 * float(np.median(np.diff(self.fitter.x))))
        return (more, family) if family else None

    def smoothed(self, joints: tuple[Joint, ...], fits: list[CurveFit]) -> tuple[tuple[Joint, ...], list[CurveFit]]:
        """Joints as smooth as fits are about as likely, which models of too few pieces showed as jumps."""
        for i in range(len(joints)):
            most = self.criterion(self.best(fits)) + _EVIDENT
            for continuity in range(joints[i].continuity + 1, 3):
                tried, family = self._settled(self._moved(joints, i, continuity, self.best(fits)), fits)
                if family and self.criterion(self.best(family)) <= most:
                    joints, fits = tried, family
        return joints, fits

    def _moved(self, joints: tuple[Joint, ...], i: int, continuity: int, fit: CurveFit) -> tuple[Joint, ...]:
        """Joints of which one has another continuity, where this is likeliest within the length of a piece."""
        at, length = joints[i].place, (fit.stop - fit.start) / fit.pieces
        low, high = max(at - length, fit.start), min(at + length, fit.stop)
        others = [*joints[:i], *joints[i + 1 :]]
        tried = [
            tuple(sorted([*others, Joint(float(place), continuity)]))
            for place in np.append(np.linspace(low, high, _MOVED)[1:-1], at)
        ]
        return min(tried, key=lambda each: self.fitter.solved(fit.start, fit.stop, each, fit.pieces)[0])

    def _settled(self, joints: tuple[Joint, ...], fits: list[CurveFit]) -> tuple[tuple[Joint, ...], list[CurveFit]]:
        """Joints and fits with these, which move each other's places."""
        near = 2.0 * float(np.median(np.diff(self.fitter.x)))
        for _ in range(_SETTLED):
            best = self.best(fits)
            joints = self.fitter.placed((best.start, best.stop), joints, best.pieces)
            fits = self.climbed(joints, (best.start, best.stop), near)
            if not fits:
                break
        return joints, fits

    def accepted(self, family: Sequence[CurveFit]) -> list[CurveFit]:
        """The likeliest model, and those with more pieces that are looked at beside it."""
        if not family:
            return []
        place = family.index(self.best(family))
        return list(family[place : place + 1 + _FINER])
