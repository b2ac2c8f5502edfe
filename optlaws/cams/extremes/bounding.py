"""The least and the greatest value of a function of a motion over its whole interval, enclosed by cells that are split.

In a cell between two places a and b a function is at most f(a) + f'(a) t + F t²/2, where F bounds f'' in the cell from
above, and likewise seen from b; the less of the two counts. Cells that may hold more than what is reached somewhere
are split, where the slope changes its sign among others, until none is left. So nothing rests on a grid: places only
say where to look, and what is proven holds between them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.curves.jets import Jet
from optlaws.cams.curves.motion_by_angle import CamMotion, Stretch
from optlaws.cams.extremes.displacements import enclosed_jet
from optlaws.cams.extremes.enclosure import ROUNDING, Enclosure
from optlaws.errors import SolverFailure

Array = NDArray[np.float64]
#: of the displacement's jet; shorter than it by as many orders as the function takes derivatives
Function: TypeAlias = Callable[[Jet], Jet]

CELLS = 12
ROUNDS = 60
MOST_CELLS = 20_000
_NOTHING = 1e-200
TOLERANCE = 1e-10  # relative to the greatest magnitude


@dataclass(frozen=True)
class Extreme:
    """An extreme value, between `low` and `high`, and an angle in rad at which it is reached to within these.

    Examples
    --------
    >>> Extreme(0.999999, 1.000001, 0.5).value
    1.0
    """

    low: float
    high: float
    angle: float

    @property
    def value(self) -> float:
        """The middle of the enclosure."""
        return 0.5 * (self.low + self.high)

    def __neg__(self) -> Extreme:
        return Extreme(-self.high, -self.low, self.angle)


@dataclass(frozen=True)
class _Cells:
    """Neighbouring or single cells of a stretch: places of their ends as shares of it, and what bounds values there."""

    low: Array
    high: Array
    least: Array
    most: Array
    turns: Array  # where the slope may change its sign

    def where(self, kept: NDArray[np.bool_]) -> _Cells:
        """Some of them."""
        return _Cells(self.low[kept], self.high[kept], self.least[kept], self.most[kept], self.turns[kept])


def enclosed_extremes(
    motion: CamMotion, function: Function, lost: int, tolerance: float = TOLERANCE
) -> tuple[Extreme, Extreme]:
    """The least and the greatest value of a function of a motion.

    Parameters
    ----------
    motion
        The displacement.
    function
        Of its jet, such as that of the pressure angle's tangent.
    lost
        By how many orders the function's jet is shorter.
    tolerance
        Relative width of the enclosures that is aimed at.

    Raises
    ------
    SolverFailure
        If a value is not finite at any place looked at.

    Examples
    --------
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> least, greatest = enclosed_extremes(rise, lambda s: s.slope(), 1)
    >>> bool(greatest.low <= 0.04 / (2 * np.pi / 3) * 2 <= greatest.high), round(greatest.angle, 9)
    (True, 1.047197551)
    """
    looks = [_Look(stretch, function, lost) for stretch in motion.stretches]
    waiting = [look.cells(np.linspace(0.0, 1.0, CELLS + 1 if look.stretch.stroke else 2)) for look in looks]
    bounds = _Bounds()
    for _ in range(ROUNDS):
        (least, _), (greatest, _) = _best(looks)
        slack = max(tolerance * max(abs(least), abs(greatest)), _NOTHING)
        waiting = [bounds.open(cells, least - slack, greatest + slack) for cells in waiting]
        if not 0 < sum(len(cells.low) for cells in waiting) < MOST_CELLS:
            break
        waiting = [look.split(cells) if len(cells.low) else cells for look, cells in zip(looks, waiting, strict=True)]
    for cells in waiting:
        bounds.take(cells)
    (low, low_at), (high, high_at) = _best(looks)
    return Extreme(min(bounds.least, low), low, low_at), Extreme(high, max(bounds.most, high), high_at)


class _Bounds:
    """What the cells that are done with are known not to go beyond."""

    def __init__(self) -> None:
        self.least, self.most = np.inf, -np.inf

    def take(self, cells: _Cells) -> None:
        """Count cells among those that are done with."""
        self.least = min(self.least, float(cells.least.min(initial=np.inf)))
        self.most = max(self.most, float(cells.most.max(initial=-np.inf)))

    def open(self, cells: _Cells, least: float, most: float) -> _Cells:
        """Cells that may go beyond two values; the others are done with."""
        beyond = (cells.least < least) | (cells.most > most)
        self.take(cells.where(~beyond))
        return cells.where(beyond)


def _best(looks: Sequence[_Look]) -> tuple[tuple[float, float], tuple[float, float]]:
    """What is reached: an upper bound of the least value and a lower one of the greatest, with their angles."""
    least, most = min(look.lowest for look in looks), max(look.highest for look in looks)
    if not np.isfinite([least[0], most[0]]).all():
        raise SolverFailure("a cam's curvature or pressure angle is not finite: nothing can be said of its extremes")
    return least, most


class _Look:
    """A function along one stretch: what it is at places and in cells, and the extremes that it reached so far."""

    def __init__(self, stretch: Stretch, function: Function, lost: int) -> None:
        self.stretch, self.function, self.order = stretch, function, lost + 2
        self.lowest, self.highest = (np.inf, stretch.start), (-np.inf, stretch.start)

    def cells(self, places: Array) -> _Cells:
        """Cells between neighbouring places."""
        return self._between(places[:-1], places[1:])

    def split(self, cells: _Cells) -> _Cells:
        """Every cell cut in the middle, and where its slope changes sign."""
        middle = 0.5 * (cells.low + cells.high)
        turns = np.where(np.isfinite(cells.turns), cells.turns, middle)
        first, second = np.minimum(middle, turns), np.maximum(middle, turns)
        low = np.concatenate([cells.low, first, second])
        high = np.concatenate([first, second, cells.high])
        real = high > low
        return self._between(low[real], high[real])

    def _between(self, low: Array, high: Array) -> _Cells:
        places, where = np.unique(np.concatenate([low, high]), return_inverse=True)
        middles = np.concatenate([places, 0.5 * (low + high)])
        halves = np.concatenate([np.zeros(places.shape), _half(low, high)])
        value, slope, bend = self.function(enclosed_jet(self.stretch, middles, halves, self.order)).terms
        count = len(places)
        self._reached(places, value[:count])
        width = (high - low) * self.stretch.duration * self.stretch.length * (1.0 + 8.0 * ROUNDING)
        ends = where[: len(low)], where[len(low) :]
        whole, curved = value[count:], bend[count:] * 2.0
        seen = [(value[end], slope[end] * sign) for end, sign in zip(ends, (1.0, -1.0), strict=True)]
        most = [_most(reached.high, rate.high, curved.high, width) for reached, rate in seen]
        least = [-_most(-reached.low, -rate.low, -curved.low, width) for reached, rate in seen]
        turns = _turns(slope.middle[ends[0]], slope.middle[ends[1]], low, high)
        return _Cells(low, high, np.fmax.reduce([*least, whole.low]), np.fmin.reduce([*most, whole.high]), turns)

    def _reached(self, places: Array, value: Enclosure) -> None:
        angles = self.stretch.start + places * (self.stretch.stop - self.stretch.start)
        angles = np.where(places == 1.0, self.stretch.stop, angles)  # to the last bit, where sides may differ
        low, high = int(np.argmin(value.high)), int(np.argmax(value.low))
        self.lowest = min(self.lowest, (float(value.high[low]), float(angles[low])))
        self.highest = max(self.highest, (float(value.low[high]), float(angles[high])), key=lambda pair: pair[0])


def _half(low: Array, high: Array) -> Array:
    return np.asarray(0.5 * (high - low) * (1.0 + 8.0 * ROUNDING) + 2.0 * ROUNDING)


def _most(start: Array, rate: Array, bend: Array, width: Array) -> Array:
    """What a function is at most in cells, seen from one end; infinite where nothing is known."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        top = np.clip(np.where(bend < 0.0, -rate / bend, width), 0.0, width)
        risen = np.maximum(rate * top + 0.5 * bend * top * top, 0.0)
        roundings = 32.0 * np.abs(risen) + 4.0 * np.abs(start) + 8.0 * np.abs(rate) * width
        most = start + risen + ROUNDING * roundings
    return np.where(np.isnan(most), np.inf, most)


def _turns(first: Array, last: Array, low: Array, high: Array) -> Array:
    """Where a straight slope would change its sign; not a number where it does not."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = first / (first - last)
        return np.where(first * last < 0.0, low + share * (high - low), np.nan)
