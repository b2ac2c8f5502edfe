"""Tables as samples of a motion: even places behind rounded ones, rounding, noise, and points far off the others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from optlaws.numbers import Array

Mask = NDArray[np.bool_]

#: orders of the differences that show noise: smooth motions vanish in them, joints and coarse steps do less in the last
_ORDERS = range(4, 9)
#: fewer windows of differences do not tell noise from the motion
_FEWEST = 12
#: the median of the sizes of normal deviates
_MEDIAN = 0.674490
#: of the greatest position: no noise is taken to be less, as numbers of 16 digits are computed
LEAST_NOISE = 1e-9
#: the order of the differences in which a single point far off stands out, and from how many deviations on it may
_FAR_ORDER, _SUSPECT = 6, 6.0
#: in fewer rows, in orders of the differences, these tell the motion itself from noise nowhere
_ROWS_TO_STAND_OUT = 6
#: a point far off is so from where either side goes on, by so much of the size that the filter gives it
_BOTH = 0.35
#: noise that is less, in standard deviations of rounding, may be rounding alone
_BEYOND_ROUNDING = 1.3
#: decimals that a rounded number has at most
_DECIMALS = 9


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples of a motion.

    Attributes
    ----------
    places, heights
        Arrays of shape (n,); places are even where rounding explains why they are not.
    digit
        The unit to which the heights are rounded; 0 where none is seen.
    noise
        The standard deviation of noise and rounding of each height, shape (n,).
    suspects
        Whether a point may be far off the motion, shape (n,).
    """

    places: Array
    heights: Array
    digit: float
    noise: Array
    suspects: Mask

    def without(self, rows: Mask) -> Samples:
        """The samples less some rows."""
        others = ~rows
        return Samples(self.places[others], self.heights[others], self.digit, self.noise[others], self.suspects[others])

    @property
    def scatter(self) -> float:
        """The standard deviation of the noise where the motion shows it; 0 where rounding explains it."""
        size, rounding = float(np.median(self.noise[~self.suspects])), self.digit / np.sqrt(12.0)
        greatest = float(self.noise.max())
        size = max(size, greatest if greatest > _BEYOND_ROUNDING * rounding else 0.0)
        return 0.0 if size <= max(_BEYOND_ROUNDING * rounding, 2.0 * LEAST_NOISE * np.ptp(self.heights)) else size

    @property
    def step(self) -> float:
        """The median distance of the places."""
        return float(np.median(np.diff(self.places)))


def samples_of(places: Array, heights: Array, digit: float = 0.0) -> Samples:
    """The samples in the columns of a table.

    Parameters
    ----------
    places, heights
        Arrays of shape (n,), of increasing places.
    digit
        The unit of the last digit of the heights, if it is known; else it is seen from them.

    Examples
    --------
    >>> x = np.linspace(0.0, 360.0, 721)
    >>> y = np.sin(np.radians(x)) + np.random.default_rng(1).normal(0.0, 2e-3, 721)
    >>> samples = samples_of(np.round(x, 1), np.round(y, 4))
    >>> samples.digit, round(float(samples.noise.max()), 4), int(samples.suspects.sum())
    (0.0001, 0.0019, 0)
    """
    x = even_places(places)
    unit = max(digit, unit_of_rounding(heights))
    least = np.full(len(x), max(unit / np.sqrt(12.0), LEAST_NOISE * float(np.ptp(heights))))
    if np.ptp(np.diff(x)) > 1e-6 * np.median(np.diff(x)):
        # uneven places that are rounded scatter the heights where the motion is fast
        shift = np.abs(np.gradient(heights, x)) * unit_of_rounding(places) / np.sqrt(12.0)
        least = np.hypot(least, np.where(x == places, shift, 0.0))
    rests = _rests_exactly(heights)
    size = noise_of(x, heights, rests)
    suspects = _far_points(x, heights, max(size, float(least.min())))
    if suspects.any():
        others = ~suspects
        size = noise_of(x[others], heights[others], rests[others])
        suspects = _far_points(x, heights, max(size, float(least.min())))
    return Samples(x, heights, unit, np.where(rests, least, np.maximum(size, least)), suspects)


def even_places(places: Array) -> Array:
    """The even places that rounded ones were, if rounding explains all differences; else the places.

    Examples
    --------
    >>> exact = np.arange(200) * 7200 / 1999
    >>> float(np.abs(even_places(np.round(exact, 1)) - exact)[:-1].max()) < 0.01
    True
    """
    unit = unit_of_rounding(places)
    steps = np.diff(places)
    if not unit or len(places) < _FEWEST or np.ptp(steps) <= 1e-9 * steps.max():
        return places
    for rows in (len(places), len(places) - 1):  # a row that closes the turn may follow
        count = np.arange(rows)
        line = np.polynomial.Polynomial.fit(count, places[:rows], 1)(count)
        if np.abs(line - places[:rows]).max() <= 0.55 * unit and (rows == len(places) or line[-1] < places[-1]):
            line[0] = places[0]
            line[-1] = line[-1] if rows < len(places) else places[-1]
            return np.append(line, places[rows:])
    return places


def unit_of_rounding(values: Array) -> float:
    """The coarsest of 1, 0.5, 0.2, 0.1, 0.05, ... of which all values are multiples; 0 where they have more digits.

    Examples
    --------
    >>> unit_of_rounding(np.array([0.25, 1.5, 2.0])), unit_of_rounding(np.array([1.0 / 3.0]))
    (0.05, 0.0)
    """
    size = float(np.abs(values).max())
    for decimals in range(_DECIMALS + 1):
        for parts in (1, 2, 5):
            scale = float(parts * 10**decimals)
            if np.abs(np.round(values * scale) / scale - values).max() <= 4e-16 * size:
                return 1.0 / scale
    return 0.0


def noise_of(places: Array, heights: Array, rests: Mask | None = None) -> float:
    """The standard deviation of white noise whose higher differences are as large as those of the heights.

    Rows at rest exactly are no sign of noise or of none: a machine may be exact where it rests, and noisy elsewhere.
    """
    sizes = []
    for order in _ORDERS:
        if len(places) <= order:
            break
        differences = normal_differences(places, heights, order)
        if rests is not None:
            differences = differences[~sliding_window_view(rests, order + 1).any(axis=1)]
        if len(differences) >= _FEWEST:
            sizes.append(float(np.median(np.abs(differences))) / _MEDIAN)
    return min(sizes, default=0.0)


def normal_differences(places: Array, heights: Array, order: int) -> Array:
    """Divided differences of an order, divided by what they would be for noise of the size 1."""
    k = sliding_window_view(places / np.median(np.diff(places)), order + 1)
    apart = k[:, :, None] - k[:, None, :] + np.eye(order + 1)
    weights = 1.0 / apart.prod(axis=2)
    values: Array = (weights * sliding_window_view(heights, order + 1)).sum(axis=1)
    return np.asarray(values / np.sqrt((weights**2).sum(axis=1)))


def _rests_exactly(heights: Array) -> Mask:
    """Rows within windows of equal heights, as many as no rounding of a motion leaves equal beside unequal ones."""
    width = _FAR_ORDER + 1
    rests = np.zeros(len(heights), dtype=bool)
    if len(heights) >= width:
        for first in np.flatnonzero(np.ptp(sliding_window_view(heights, width), axis=1) == 0.0):
            rests[first : first + width] = True
    return rests


def _far_points(places: Array, heights: Array, noise: float) -> Mask:
    """Points that stand out of the motion by the filter that is matched to one point far off in differences."""
    order, count = _FAR_ORDER, len(heights)
    far, seen = np.zeros((2, count), dtype=bool)
    if count <= _ROWS_TO_STAND_OUT * order:
        return far
    pattern = np.array([float(term) for term in np.poly(np.ones(order))])
    rest = heights.astype(np.float64).copy()
    for _ in range(count // 20 + 1):
        differences = normal_differences(places, rest, order) * np.sqrt((pattern**2).sum())
        filtered = np.convolve(differences, pattern, mode="full") / (pattern**2).sum()
        if order % 2:
            filtered = -filtered
        sizes = np.abs(filtered)
        sizes[:order], sizes[count - order :] = 0.0, 0.0
        spread = max(noise * 1.78, float(np.median(sizes)) / _MEDIAN)
        sizes[seen] = 0.0
        worst = int(np.argmax(sizes))
        if sizes[worst] <= _SUSPECT * spread:
            break
        seen[worst] = True
        # at a joint or a corner a point is where one side goes on; one that is far off is so for both sides
        sign = np.sign(filtered[worst])
        off = [
            min(
                sign * (rest[worst] - _beyond(places[rows], rest[rows], places[worst])) for rows in _beside(worst, wide)
            )
            for wide in (4, 7)
        ]
        if max(off) > _BOTH * sizes[worst]:
            far[worst] = True
            rest[worst] -= filtered[worst]
            # what it hid beside it is seen now
            seen[max(worst - 2 * order, 0) : worst + 2 * order + 1] = False
            seen |= far
    return far


def _beside(row: int, wide: int) -> tuple[slice, slice]:
    return slice(max(row - wide, 0), row), slice(row + 1, row + 1 + wide)


def _beyond(places: Array, heights: Array, place: float) -> float:
    """Where points go on to by their parabola."""
    step = np.ptp(places)
    return float(np.polynomial.Polynomial.fit((places - place) / step, heights, 2)(0.0))
