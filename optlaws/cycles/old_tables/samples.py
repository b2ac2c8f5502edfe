"""Tables as samples of a motion: even places behind rounded ones, rounding, noise, and points far off the others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.interpolate import make_lsq_spline
from scipy.ndimage import maximum_filter, median_filter

from optlaws.numbers import Array

Mask = NDArray[np.bool_]

#: orders of the differences that show noise: smooth motions vanish in them, joints and coarse steps do less in the last
_ORDERS = range(4, 9)
#: fewer windows of differences do not tell noise from the motion
_FEWEST = 12
#: the median of the sizes of normal deviates
MEDIAN = 0.674490
#: of the greatest position: no noise is taken to be less, as numbers of 16 digits are computed
LEAST_NOISE = 1e-9
#: the order of the differences in which a single point far off stands out, and from how many deviations on it may
_FAR_ORDER, _SUSPECT = 6, 6.0
#: times the noise: the standard deviation of what the filter gives; and rounds of noise and points far off
_FILTERED, _MOST_ROUNDS = 1.78, 4
#: points beside each other that may be far off, at most; so many are looked at with what the others are off, and no
#: more in a table of fewer rows
_BURST, _PAIR, _ROWS_OF_BURST = 4, 2, 100
#: degrees of polynomials of the rows on a side of a point, the next one where rows are off by more deviations of noise
_DEGREES_BESIDE, _FITTING = (2, 3, 4), 2.0
#: degrees of polynomials of rows on each side of a seam, and by how many standard deviations they may miss each other
_DEGREES_OVER_SEAM, _STEP = (3, 5, 7), 5.0
#: in fewer rows, in orders of the differences, these tell the motion itself from noise nowhere
_ROWS_TO_STAND_OUT = 6
#: rows on each side of a point that are equal, where too few rows tell noise from the motion
_EQUAL = 3
#: a point far off is so from where either side goes on, by so much of the size that the filter gives it; in a longer
#: burst by nearly all of it
_BOTH, _ALL = 0.35, 0.75
#: and by no more of it than noise explains, where no polynomial is near the rows beside: then they tell nothing
_TOO_FAR = 3.0
#: noise that is less, in standard deviations of rounding, may be rounding alone
_BEYOND_ROUNDING = 1.3
#: differences whose size is by so much less than that of the order below are no noise
_STILL_FALLING = 0.5
#: degree and rows of each piece of a spline that goes through any motion
_DEGREE, _ROWS_OF_PIECE = 5, 4
#: rows in which noise of their own is seen, a quarter of those that move at most, times that of most rows; by how much
#: its size may change with the order
_REGION, _NOISIER, _WHITE = 40, 2.5, 1.6
#: of the greatest noise: rows with less rest exactly; and deviations from which on a row is no noise of the others
_NOISY, _FAR_OFF = 0.5, 4.0
#: of half a window: places in it that are even have no more from where they are
_EVEN = 1e-11
#: median steps, and of a turn: between rows that are farther apart some are missing
_GAP, _GAP_OF_TURN = 5.0, 0.02
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
    averaged
        How many rows the noise is a moving mean of, where it was smoothed: it is as uncertain as independent noise of
        `noise`, and each row scatters by as much over the root of these.
    """

    places: Array
    heights: Array
    digit: float
    noise: Array
    suspects: Mask
    averaged: int = 1

    def without(self, rows: Mask) -> Samples:
        """The samples less some rows."""
        others = ~rows
        places, heights, noise = (column[others] for column in (self.places, self.heights, self.noise))
        return replace(self, places=places, heights=heights, noise=noise, suspects=self.suspects[others])

    @property
    def rounded(self) -> bool:
        """Whether its heights are rounded to less than all digits."""
        return self.digit > LEAST_NOISE * float(np.ptp(self.heights))

    def with_noise(self, share: float) -> Samples:
        """The samples with a share of their noise, but no less than rounding leaves."""
        return replace(self, noise=np.maximum(share * self.noise, LEAST_NOISE * float(np.ptp(self.heights))))

    def begun_at(self, row: int, advance: float) -> Samples:
        """The samples of the turn that begins at a row: those before it follow, and it closes the turn."""
        last = len(self.places) - 1
        rows = np.concatenate([np.arange(row, last), np.arange(row + 1)])
        behind = np.arange(len(rows)) >= last - row
        places = self.places[rows] + behind * np.ptp(self.places)
        heights = self.heights[rows] + behind * advance
        return Samples(places, heights, self.digit, self.noise[rows], self.suspects[rows], self.averaged)

    @property
    def scatter(self) -> float:
        """The standard deviation of the noise where the motion shows it; 0 where rounding explains it."""
        noise, rounding = self.noise / np.sqrt(self.averaged), self.digit / np.sqrt(12.0)
        size, greatest = float(np.median(noise[~self.suspects])), float(noise.max())
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
    if x is places and np.ptp(np.diff(x)) > 1e-6 * np.median(np.diff(x)):
        least = np.hypot(least, _scattered_by_places(x, heights))
    heights = _closed_without_speck(x, heights, max(noise_of(x, heights, computed=not unit), float(least.min())))
    rests = rests_exactly(heights)
    noise = np.full(len(x), noise_of(x, heights, rests, computed=not unit))
    suspects = _far_points(x, heights, np.maximum(noise, least.min()))
    for _ in range(_MOST_ROUNDS):
        others, before = ~suspects, noise
        size = noise_of(x[others], heights[others], rests[others], computed=not unit)
        noise = np.interp(x, x[others], _noise_by_region(x[others], heights[others], rests[others], size))
        if np.array_equal(noise, before):
            break
        suspects = _far_points(x, heights, np.maximum(noise, least.min()))
    if not _tell_noise(rests):
        suspects = suspects & _is_between_equal(heights)
    return Samples(x, heights, unit, np.where(rests, least, np.maximum(noise, least)), suspects)


def gaps_of(places: Array, heights: Array, room: float) -> list[tuple[float, float]]:
    """From where to where rows are missing between positions that differ by more than a room.

    Examples
    --------
    >>> x = np.array([0.0, 1.0, 2.0, 3.0, 40.0, 41.0, 42.0, 100.0])
    >>> gaps_of(x, np.minimum(x, 42.0), 1e-3)
    [(3.0, 40.0)]
    """
    steps = np.diff(places)
    missing = (steps > _GAP * np.median(steps)) & (steps > _GAP_OF_TURN * np.ptp(places))
    rows = np.flatnonzero(missing & (np.abs(np.diff(heights)) > room))
    return [(float(places[row]), float(places[row + 1])) for row in rows]


def turning_points(y: Array, room: float) -> list[int]:
    """Rows where the motion turns back by more than a room.

    Examples
    --------
    >>> turning_points(np.array([0.0, 2.0, 3.0, 2.9, 3.0, 1.0, 0.0, 0.5]), 0.2)
    [2, 6]
    """
    turns: list[int] = []
    low = high = 0
    rising = 0
    for i in range(1, len(y)):
        if y[i] > y[high]:
            high = i
        if y[i] < y[low]:
            low = i
        if rising >= 0 and y[high] - y[i] > room:
            if rising > 0:
                turns.append(high)
            rising, low = -1, i
            high = i
        elif rising <= 0 and y[i] - y[low] > room:
            if rising < 0:
                turns.append(low)
            rising, high = 1, i
            low = i
    return turns


def even_places(places: Array) -> Array:
    """The even places that rounded ones were, if rounding and rows left out explain all differences; else the places.

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
    best, least = places, 0.55 * unit
    # one row left out is hardly told from longer steps: the nearer of both
    for count in (np.append(0, np.cumsum(np.round(steps / np.median(steps)))), np.arange(len(places))):
        for rows in (len(places), len(places) - 1):  # a row that closes the turn may follow
            line = np.polynomial.Polynomial.fit(count[:rows], places[:rows], 1)(count[:rows])
            off = float(np.abs(line - places[:rows]).max())
            if off <= least and (rows == len(places) or line[-1] < places[-1]):
                line[0] = places[0]
                line[-1] = line[-1] if rows < len(places) else places[-1]
                best, least = np.append(line, places[rows:]), 0.99 * off
                break
    return best


def _scattered_by_places(places: Array, heights: Array) -> Array:
    """By how much rounded places may scatter the heights where the motion is fast, as far as differences show it."""
    before, after = (np.clip(np.arange(len(places)) + away, 0, len(places) - 1) for away in (-3, 3))
    slopes = np.abs((heights[after] - heights[before]) / (places[after] - places[before]))
    unit: float | Array = unit_of_rounding(places)
    if unit and unit == _single_precision(places):
        unit = np.spacing(np.abs(places).astype(np.float32)).astype(np.float64)
    shift, shares = slopes * unit / np.sqrt(12.0), [1.0]
    for order in _ORDERS if shift.any() else ():
        if len(places) - order < _FEWEST:
            break
        weights = difference_weights(places, order)
        supposed = np.sqrt(((weights * sliding_window_view(shift, order + 1)) ** 2).sum(axis=1))
        sizes = np.abs(_differences(weights, heights)) / MEDIAN
        least = float(np.median(supposed[supposed > 0.0]))
        fast, slow = supposed >= least, supposed < 0.5 * least
        of_slow = float(np.median(sizes[slow])) if slow.any() else 0.0
        shares.append(float(np.sqrt(max(np.median((sizes[fast] ** 2 - of_slow**2) / supposed[fast] ** 2), 0.0))))
    return np.asarray(min(shares) * shift)


def unit_of_rounding(values: Array) -> float:
    """The coarsest of 1, 0.5, 0.2, 0.1, 0.05, ... of which all values are multiples; 0 where they have more digits.

    Of values in single precision it is the last digit of the greatest one, unless they are multiples of more.

    Examples
    --------
    >>> unit_of_rounding(np.array([0.25, 1.5, 2.0])), unit_of_rounding(np.array([1.0 / 3.0]))
    (0.05, 0.0)
    >>> unit_of_rounding(np.array([0.33333334, 1.6666666])) == 2.0**-23
    True
    """
    size = float(np.abs(values).max())
    for decimals in range(_DECIMALS + 1):
        for parts in (1, 2, 5):
            scale = float(parts * 10**decimals)
            if np.abs(np.round(values * scale) / scale - values).max() <= 4e-16 * size:
                return max(1.0 / scale, _single_precision(values))
    return _single_precision(values)


def _single_precision(values: Array) -> float:
    """The last digit of the greatest value, where all are numbers in single precision; else 0."""
    nearest = values.astype(np.float32)
    written = (float(str(each)) == value or float(each) == value for each, value in zip(nearest, values, strict=True))
    return float(np.spacing(np.abs(nearest).max())) if all(written) else 0.0


def noise_of(places: Array, heights: Array, rests: Mask | None = None, *, computed: bool = False) -> float:
    """The standard deviation of white noise whose higher differences are as large as those of the heights.

    Rows at rest exactly are no sign of noise or of none: a machine may be exact where it rests, and noisy elsewhere.
    Of heights with all digits, which are `computed`, differences that still fall with the order are the motion's own.
    """
    sizes = []
    for order in _ORDERS:
        if len(places) <= order:
            break
        differences = _differences(difference_weights(places, order), heights)
        if rests is not None:
            differences = differences[~sliding_window_view(rests, order + 1).any(axis=1)]
        if len(differences) >= _FEWEST:
            sizes.append(float(np.median(np.abs(differences))) / MEDIAN)
    if computed and len(sizes) > 1 and sizes[-1] < _STILL_FALLING * sizes[-2]:
        return 0.0
    return min(sizes, default=0.0)


def _noise_by_region(places: Array, heights: Array, rests: Mask, size: float) -> Array:
    """The noise of each row: a size, and more in regions of many rows whose differences are larger in each order."""
    noise, sizes = np.full(len(places), size), list[Array]()
    for order in _ORDERS[1:]:
        moving = np.asarray(~sliding_window_view(rests, order + 1).any(axis=1))
        if int(moving.sum()) < 4 * _REGION:
            return noise
        differences = np.abs(_differences(difference_weights(places, order), heights))[moving] / MEDIAN
        middles = np.arange(len(moving))[moving] + 0.5 * order
        sizes.append(np.interp(np.arange(len(places)), middles, median_filter(differences, _REGION, mode="nearest")))
    least, greatest = np.min(sizes, axis=0), np.max(sizes, axis=0)
    # differences of the motion itself fall with the order
    noise = np.where((least > _NOISIER * size) & (greatest < _WHITE * least), least, noise)
    return np.asarray(maximum_filter(noise, _REGION, mode="nearest"))  # medians do not tell where a region ends


def variance_about_spline(samples: Samples) -> float:
    """The variance about a spline of so many pieces that it goes through any motion, over that of the noise.

    It is nearer the truth than what differences show, of which the least order is taken, unless steps are coarse.

    Examples
    --------
    >>> x = np.linspace(0.0, 360.0, 721)
    >>> y = np.sin(np.radians(x)) + np.random.default_rng(1).normal(0.0, 2e-3, 721)
    >>> samples = samples_of(x, y)
    >>> share = variance_about_spline(samples)
    >>> round(float(samples.noise[0]), 5), round(float(samples.noise[0]) * share**0.5, 5)
    (0.0019, 0.002)
    """
    x, y, noise = samples.places, samples.heights, samples.noise
    pieces = len(x) // _ROWS_OF_PIECE
    inner = x[np.linspace(0, len(x) - 1, pieces + 1).round().astype(np.intp)][1:-1]
    knots = np.concatenate([np.repeat(x[0], _DEGREE + 1), inner, np.repeat(x[-1], _DEGREE + 1)])
    off = (y - make_lsq_spline(x, y, knots, _DEGREE, w=1.0 / noise)(x)) / noise
    size = np.abs(off[noise > _NOISY * float(noise.max())]) / np.sqrt(1.0 - (pieces + _DEGREE) / len(x))
    return float((size[size <= _FAR_OFF * float(np.median(size)) / MEDIAN] ** 2).mean())


def difference_weights(places: Array, order: int) -> Array:
    """What divided differences multiply rows of windows by, divided by what they would be for noise of the size 1."""
    k = sliding_window_view(places / np.median(np.diff(places)), order + 1)
    apart = k[:, :, None] - k[:, None, :] + np.eye(order + 1)
    weights = 1.0 / apart.prod(axis=2)
    return np.asarray(weights / np.sqrt((weights**2).sum(axis=1))[:, None])


def window_polynomials(places: Array, degree: int) -> Array:
    """Orthonormal polynomials up to a degree in windows of places, shape (windows, rows, degree + 1).

    The windows have shape (windows, rows). All even ones have the same polynomials, which are computed once.

    Examples
    --------
    >>> x = sliding_window_view(np.linspace(0.0, 360.0, 721), 9)
    >>> q = window_polynomials(x, 3)
    >>> bool(np.abs(q[5].T @ q[5] - np.eye(4)).max() < 1e-12), bool(np.abs(q[5, :, 2:].T @ x[5]).max() < 1e-9)
    (True, True)
    """
    middle, half = 0.5 * (places[:, -1:] + places[:, :1]), 0.5 * (places[:, -1:] - places[:, :1])
    u, even = (places - middle) / half, np.linspace(-1.0, 1.0, places.shape[1])
    uneven = np.abs(u - even).max(axis=1) > _EVEN
    distinct = np.vstack([even, u[uneven]])
    polynomials = np.linalg.qr(distinct[:, :, None] ** np.arange(degree + 1))[0]
    return np.asarray(polynomials[np.where(uneven, np.cumsum(uneven), 0)])


def goes_on(places: Array, heights: Array, noise: Array) -> bool:
    """Whether a motion goes on over the seam of its turn: polynomials of rows on its sides meet there, but for noise.

    Examples
    --------
    >>> x = np.linspace(0.0, 360.0, 181)
    >>> [goes_on(x, y, np.full(181, 1e-9)) for y in (np.sin(np.radians(x)), np.sin(np.radians(x) / 4))]
    [True, True]
    >>> goes_on(x, np.append(np.sin(np.radians(x[:-1]) / 4), 0.0), np.full(181, 1e-9))
    False
    """
    for degree in _DEGREES_OVER_SEAM:
        wide, ends, variances = min(2 * degree + 3, len(places) - 1), [], []
        for side, seam in ((slice(0, wide), 0), (slice(-1 - wide, -1), -1)):
            end, squares, share = _beyond(places[side], heights[side], places[seam], degree)
            ends.append(heights[seam] - end)
            variances.append(max(squares, float(noise[side].max()) ** 2) * share)
        # the row that closes the turn is that of its beginning, or is measured
        closing = abs(ends[1]) <= _STEP * np.sqrt(variances[1] + float(noise[-1]) ** 2)
        if closing or abs(ends[1] - ends[0]) <= _STEP * np.sqrt(sum(variances)):
            return True
    return False


def rests_exactly(heights: Array) -> Mask:
    """Rows within windows of equal heights, as many as no rounding of a motion leaves equal beside unequal ones."""
    width = _FAR_ORDER + 1
    rests = np.zeros(len(heights), dtype=bool)
    if len(heights) >= width:
        for first in np.flatnonzero(np.ptp(sliding_window_view(heights, width), axis=1) == 0.0):
            rests[first : first + width] = True
    return rests


def _closed_without_speck(places: Array, heights: Array, noise: float) -> Array:
    """Heights of a turn whose first or last row is as the other one if it is far off where both sides go on."""
    apart, turn = abs(heights[-1] - heights[0]), places[-1] - places[0]
    for degree in _DEGREES_BESIDE if apart > _SUSPECT * noise and len(places) > _ROWS_TO_STAND_OUT * _FAR_ORDER else ():
        wide = 2 * degree + 1
        before = _beyond(places[-1 - wide : -1] - turn, heights[-1 - wide : -1], places[0], degree)
        behind = _beyond(places[1 : 1 + wide], heights[1 : 1 + wide], places[0], degree)
        if max(before[1], behind[1]) <= (_FITTING * noise) ** 2:
            near = _STEP * noise * np.sqrt(1.0 + max(before[2], behind[2]))
            off = [max(abs(heights[row] - end) for end in (before[0], behind[0])) for row in (0, -1)]
            if min(off) <= near < apart:
                closed = heights.copy()
                closed[[0, -1]] = heights[0 if off[0] < off[1] else -1]
                return closed
            break
    return heights


def _tell_noise(rests: Mask) -> bool:
    """Whether rows beside those at rest are as many as differences need that tell noise from the motion."""
    width = _ORDERS[0] + 1
    return len(rests) >= width and int((~sliding_window_view(rests, width).any(axis=1)).sum()) >= _FEWEST


def _is_between_equal(heights: Array) -> Mask:
    """Which rows have a few equal ones before them, and the same behind them."""
    beside = sliding_window_view(np.pad(heights, _EQUAL, constant_values=np.nan), 2 * _EQUAL + 1)
    return np.asarray(np.ptp(np.delete(beside, _EQUAL, axis=1), axis=1) == 0.0)


def _far_points(places: Array, heights: Array, noise: Array) -> Mask:
    """Points that stand out of the motion by the filter that is matched to single points far off in differences.

    Each is taken out with its size by least squares, of all of them together: points close together hide each other.
    """
    order, count = _FAR_ORDER, len(heights)
    if count <= _ROWS_TO_STAND_OUT * order:
        return np.zeros(count, dtype=bool)
    over_seam = goes_on(places, heights, noise)
    beside, turn, advance = 2 * order if over_seam else 0, np.ptp(places), heights[-1] - heights[0]
    x = np.concatenate([places[-1 - beside : -1] - turn, places, places[1 : beside + 1] + turn])
    y = np.concatenate([heights[-1 - beside : -1] - advance, heights, heights[1 : beside + 1] + advance])
    noise = np.concatenate([noise[-1 - beside : -1], noise, noise[1 : beside + 1]])
    weights = difference_weights(x, order)
    spread, differences = _spread_back(weights, weights), _differences(weights, y)
    sizes, seen = np.zeros(len(y)), np.zeros(len(y), dtype=bool)
    seen[[beside, beside + count - 1]] = True  # the row of the seam, which is there twice
    taken: list[int] = []
    for _ in range(2 * (count // 20 + 1)):
        filtered = _spread_back(weights, (differences - _differences(weights, sizes))[:, None]) / spread
        least = np.maximum(_FILTERED * noise, float(np.median(np.abs(filtered))) / MEDIAN)
        outside = np.abs(filtered) * ~seen / least
        outside[:order], outside[-order:] = 0.0, 0.0
        worst = int(np.argmax(outside))
        if outside[worst] <= _SUSPECT:
            break
        seen[worst] = True
        likely = _nearest_rows(weights, differences - _differences(weights, sizes), worst)
        rows = next((rows for rows in likely if _are_off(x, y - sizes, rows, noise)), None)
        if rows is not None:
            taken += [row for row in rows if row not in taken]
            # what they hid beside them is seen now
            seen[max(worst - 2 * order, 0) : worst + 2 * order + 1] = False
            seen[[beside, beside + count - 1, *taken]] = True
            sizes[taken] = np.linalg.lstsq(_spread_columns(weights, taken), differences, rcond=None)[0]
    far = np.zeros(count, dtype=bool)
    far[[(row - beside) % (count - 1) for row in taken]] = True
    return far


def _nearest_rows(weights: Array, differences: Array, worst: int) -> list[dict[int, float]]:
    """The row that stands out most in differences, or a burst at or beside it, with their sizes, the likeliest first.

    In high differences points that are off by about the same stand out less than the rows beside them.
    """
    order = weights.shape[1] - 1
    near = slice(max(worst - 2 * order, 0), worst + order + 1)
    most = _BURST if len(differences) > _ROWS_OF_BURST else _PAIR
    bursts = (range(worst + i, worst + i + rows) for rows in range(2, most + 1) for i in range(-rows, 2))
    tried = []
    for rows in ([worst], *bursts):
        if order <= rows[0] and rows[-1] <= len(differences) - 1:
            columns = _spread_columns(weights, rows)[near]
            sizes = np.linalg.lstsq(columns, differences[near], rcond=None)[0]
            left = differences[near] - columns @ sizes
            tried.append((float(left @ left) * len(rows) ** 2, dict(zip(rows, sizes.tolist(), strict=True))))
    return [rows for _, rows in sorted(tried, key=lambda each: each[0])]


def _are_off(x: Array, y: Array, sizes: Mapping[int, float], noise: Array) -> bool:
    """Whether each of few rows is off where both of its sides go on, by enough of its size, without the others'."""
    if len(sizes) > _PAIR:
        return _is_burst(x, y, sizes, noise)
    for row, size in sizes.items():
        others = y.copy()
        others[[other for other in sizes if other != row]] -= [sizes[other] for other in sizes if other != row]
        off = off_both_sides(x, others, row, float(np.sign(size)), float(noise[row]))
        if not _BOTH * abs(size) < off < _TOO_FAR * abs(size):
            return False
    return True


def _is_burst(x: Array, y: Array, sizes: Mapping[int, float], noise: Array) -> bool:
    """Whether each of several rows is off where the rows beside all of them go on, by nearly all of its size."""
    first, wider = min(sizes), 2 * (len(sizes) - 1)
    for row, size in sizes.items():
        places, heights = (np.delete(values, [other for other in sizes if other != row]) for values in (x, y))
        off = off_both_sides(places, heights, first, float(np.sign(size)), float(noise[row]), wider)
        if not max(_ALL * abs(size), _SUSPECT * float(noise[row])) < off < _TOO_FAR * abs(size):
            return False
    return True


def _spread_columns(weights: Array, rows: Sequence[int]) -> Array:
    """What a unit at each row is in the differences, a column for each."""
    order = weights.shape[1] - 1
    columns = np.zeros((len(weights), len(rows)))
    for column, row in enumerate(rows):
        windows = np.arange(max(row - order, 0), min(row + 1, len(weights)))
        columns[windows, column] = weights[windows, row - windows]
    return columns


def off_both_sides(places: Array, heights: Array, row: int, sign: float, noise: float, wider: int = 0) -> float:
    """By how much a point is above where both sides of it go on, or below with the sign -1.

    At a joint or a corner a point is where one side goes on; one that is far off is so for both sides. Where the rows
    of a side are near no polynomial of these degrees, they tell nothing less than they are off the last one.
    """
    off = 0.0
    for degree in _DEGREES_BESIDE:
        beside = _beside(row, 2 * degree + 1 + wider)
        sides = [_beyond(places[rows], heights[rows], places[row], degree) for rows in beside]
        off = min(sign * (heights[row] - end) for end, *_ in sides)
        if max(left for _, left, _ in sides) <= (_FITTING * noise) ** 2:
            return float(off)
    unknown = max(float(np.sqrt(left * (1.0 + share))) for _, left, share in sides)
    return float(off) if off > unknown else 0.0


def _differences(weights: Array, values: Array) -> Array:
    return np.asarray((weights * sliding_window_view(values, weights.shape[1])).sum(axis=1))


def _spread_back(weights: Array, values: Array) -> Array:
    """Values of windows, or of each of their rows, weighted and summed for each row."""
    spread = np.zeros(len(weights) + weights.shape[1] - 1)
    for i, column in enumerate((weights * values).T):
        spread[i : i + len(weights)] += column
    return spread


def _beside(row: int, wide: int) -> tuple[slice, slice]:
    return slice(max(row - wide, 0), row), slice(row + 1, row + 1 + wide)


def _beyond(places: Array, heights: Array, place: float, degree: int) -> tuple[float, float, float]:
    """Where points go on to by the polynomial of all but the one farthest off it.

    With the variance of the others about it, and what the variance of noise is multiplied by at the place.
    """
    u = (places - place) / np.ptp(places)
    # all but one of the points, in as many ways
    others = np.nonzero(~np.eye(len(u), dtype=bool))[1].reshape(len(u), -1)
    powers, known = u[others, None] ** np.arange(degree + 1), heights[others]
    inverses = np.linalg.pinv(powers)
    fits = np.einsum("irc,ic->ir", inverses, known)
    squares = ((known - np.einsum("icr,ir->ic", powers, fits)) ** 2).sum(axis=1)
    best = int(np.argmin(squares))
    weights = inverses[best, 0]
    return float(fits[best, 0]), float(squares[best]) / max(len(u) - degree - 2, 1), float(weights @ weights)
