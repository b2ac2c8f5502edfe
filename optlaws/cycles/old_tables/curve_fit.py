"""Splines through samples of a motion between two rests, lines or ends, with their joints and their uncertainty."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import log
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BPoly, BSpline, make_interp_spline

from optlaws.numbers import Array

DEGREE = 5
#: of the greatest velocity, and in standard deviations: by so much it changes at a corner
_CORNER, _CERTAIN = 0.02, 5.0
#: places at which a joint is looked for
CANDIDATES = 160


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
        greatest = float(np.abs(self.values(np.linspace(self.start, self.stop, CANDIDATES), 1)).max())
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
        return np.asarray(basis(self.spline.t, places, self.degree, nu) @ self.spline.c)

    def height(self, place: float) -> float:
        """The position at a place; where it leaves a line, that of the line to the last digit."""
        for end, at in zip(self.ends, (self.start, self.stop), strict=True):
            if end.line is not None and place == at:
                return float(end.value(np.array(place)))
        return float(self.values(np.array([place]))[0])

    def deviation(self, places: Array, nu: int) -> Array:
        """Standard deviations of a derivative at places, for noise of the variance about it."""
        rows = basis(self.spline.t, places, self.degree, nu) @ self.factor
        return np.asarray(np.sqrt(max(self.variance, 1.0) * (rows**2).sum(axis=1)))


def parabola(ends: tuple[End, End], start: float, stop: float, squares: float, rows: int) -> CurveFit:
    """The motion of constant acceleration from one line to another, in which its length alone is free."""
    known = [[float(end.value(np.array(at))), end.slope] for end, at in zip(ends, (start, stop), strict=True)]
    acceleration = (ends[1].slope - ends[0].slope) / (stop - start)
    law = BPoly.from_derivatives([start, stop], [[*each, acceleration] for each in known])
    spline = BSpline(np.repeat([start, stop], DEGREE + 1), law.c[:, 0], DEGREE)
    return CurveFit(spline, np.zeros((DEGREE + 1, 1)), (), squares, 1, rows, ends)


def basis(knots: Array, places: Array, degree: int = DEGREE, nu: int = 0) -> Array:
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
