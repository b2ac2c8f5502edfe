"""Extremes and integrals of functions over whole intervals: Taylor's formula with its remainder bounds each cell.

In a cell of the half width h around m a function is f(m) + f'(m) t + F t²/2, where F is what f'' may be anywhere in the
cell. Cells that cannot hold more than what is reached somewhere are done; where the slope has one sign, so are all but
the ends between which the function is smooth; where f'' has one, Newton's method encloses the place at which the slope
vanishes. So nothing rests on samples: a function comes as a map from intervals to the intervals of its Taylor terms.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import SolverFailure
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval, exact
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import EQUAL_EXTREMES, ROUNDOFF, SMALLEST_SIZE, TIE

_SMALLEST_CELL = 2.0**-48  # of a place: cells are cut no further
_NEAR_TIE = 1e-7  # of the greatest magnitude: an extreme that is sampled to so little may be as high
_EXTREME_WIDTH = 1e-3  # of the whole: ties nearer to each other are one extreme
_CELL_END = 2.0**-10  # of a cell that is sloped: what stays of it at an edge
_EXTREME_POLISHED = 1e-11  # of the whole: a place of an extreme that moves by less is settled

#: of places, as intervals, and of an order: the Taylor terms of a function anywhere in each, up to that order
Function: TypeAlias = Callable[[Interval, int], Jet]

#: the same of several functions: of places, an order, and of which function each place is one
FunctionOfEach: TypeAlias = Callable[[Interval, int, NDArray[np.intp]], Jet]

#: a value and where it is
Valued: TypeAlias = tuple[float, float]

_Result = TypeVar("_Result")
#: what asks for terms of a function, at places and up to an order, until it has a result
_Asking: TypeAlias = Generator[tuple[Interval, int], Jet, _Result]

_ROUNDS = 80
_STEPS = 2
_MOST = 50_000
_NARROWED = 0.25
_BLUR = 4.0


class Extremes(NamedTuple):
    """Least and greatest value of a function: attained values, and proven bounds.

    At `least_at` it is at most `least`, at `most_at` at least `most`; nowhere is it below `low` or above `high`.
    """

    least: float
    least_at: float
    low: float
    most: float
    most_at: float
    high: float

    @property
    def peak(self) -> float:
        """The greatest magnitude that the function reaches."""
        return max(abs(self.least), abs(self.most))

    @property
    def bound(self) -> float:
        """A magnitude that it is proven not to pass."""
        return max(abs(self.low), abs(self.high))


def extremes(
    function: Function,
    edges: Any,
    *,
    share: float = 1e-9,
    parts: int = 1,
    order: int = 2,
    enough: float = np.inf,
    magnitude: bool = False,
) -> Extremes:
    """Least and greatest value of a function between edges, over the whole from the first to the last.

    Parameters
    ----------
    function
        Of an `Interval` of places, each within two neighbouring edges, and an order: a `Jet` of intervals that hold
        its Taylor terms everywhere there.
    edges
        Increasing, shape (n + 1,). At an inner edge the function may jump.
    share
        How near bounds come to values reached, relative to the greatest magnitude.
    parts
        Into how many cells each interval is cut at first.
    order
        Of Taylor's formula: more where low terms of a function cancel, as those of a small difference do.
    enough
        A magnitude: where the function reaches more, bounds need not come near.
    magnitude
        Whether only the greatest magnitude is sought: the other extreme then is bounded by no more than that, and
        the places are any where values come within rounding of it.

    Raises
    ------
    SolverFailure
        If the function is bounded nowhere.

    Examples
    --------
    >>> from optlaws.numerics.taylor import variable
    >>> enclosure = extremes(lambda x, order: variable(x, order).waves()[0], [0.0, 2.0, 7.0])
    >>> round(enclosure.most, 9), round(enclosure.most_at, 6), 0.0 <= enclosure.high - enclosure.most < 1e-8
    (1.0, 1.570796, True)
    """
    search = _enclosing(edges, share, parts, order, enough, magnitude=magnitude)
    request = next(search)
    while True:
        try:
            request = search.send(function(*request))
        except StopIteration as done:
            result: Extremes = done.value
            return result


def extremes_of_each(
    function: FunctionOfEach,
    edges: Sequence[Any],
    *,
    share: float | Sequence[float] = 1e-9,
    parts: Sequence[int] | None = None,
    magnitude: bool = False,
) -> list[Extremes]:
    """The extremes of several functions that are alike, each by its own cells, which are looked at in one go.

    What `extremes` finds of each function alone, to the last digit; `edges`, `parts` and `share`, where it is none of
    all, are those of each.

    Examples
    --------
    >>> from optlaws.numerics.taylor import variable
    >>> def waves(x, order, which):
    ...     return (variable(x, order) * np.array([1.0, 2.0])[which]).waves()[0]
    >>> [round(each.most_at, 6) for each in extremes_of_each(waves, [[0.0, 2.0], [0.0, 2.0]])]
    [1.570796, 0.785398]
    """
    shares = [share] * len(edges) if isinstance(share, int | float) else share
    searches = [
        _enclosing(each, near, count, magnitude=magnitude)
        for each, count, near in zip(edges, parts or [1] * len(edges), shares, strict=True)
    ]
    requests = {i: next(search) for i, search in enumerate(searches)}
    results: dict[int, Extremes] = {}
    while requests:
        counts = [len(places.middle) for places, _ in requests.values()]
        places = _joined([at for at, _ in requests.values()])
        terms = function(places, max(order for _, order in requests.values()), np.repeat(list(requests), counts)).terms
        known = [_as_interval(term, sum(counts)) for term in terms]
        stop = 0
        for (i, (_, order)), count in zip(list(requests.items()), counts, strict=True):
            start, stop = stop, stop + count
            try:
                requests[i] = searches[i].send(Jet(tuple(term[start:stop] for term in known[: order + 1])))
            except StopIteration as done:
                del requests[i]
                results[i] = done.value
    return [results[i] for i in range(len(edges))]


def _joined(several: Sequence[Interval]) -> Interval:
    return Interval(
        np.concatenate([each.middle.ravel() for each in several]),
        np.concatenate([each.radius.ravel() for each in several]),
    )


def _enclosing(
    edges: Any, share: float, parts: int, order: int = 2, enough: float = np.inf, *, magnitude: bool
) -> _Asking[Extremes]:
    search = _Search(np.asarray(edges, dtype=np.float64), order)
    low, high = search.first(parts)
    for _ in range(_ROUNDS):
        cells = yield from search.look(low, high)
        slack = max(share * max(_finite(search.least), _finite(search.most)), SMALLEST_SIZE) + cells.rounding
        least, most = search.least, search.most
        if magnitude:
            least, most = min(least, -most), max(most, -least)
        beyond = (cells.top > most + slack) | (cells.bottom < least - slack)
        beyond &= cells.half > _SMALLEST_CELL * (np.abs(cells.middle) + cells.half)
        search.take(cells, ~beyond)
        low, high = search.split(cells, beyond)
        if not 0 < len(low) <= _MOST or max(-search.least, search.most) > enough:
            break
    if len(low):
        cells = yield from search.look(low, high)
        search.take(cells, np.ones(len(low), dtype=bool))
    return (yield from search.result(polished=enough == np.inf, places=not magnitude))


@dataclass(frozen=True)
class _Cells:
    """Cells with bounds of the function and of its slope in each."""

    low: Array
    high: Array
    middle: Array
    half: Array
    bottom: Array
    top: Array
    slope: tuple[Array, Array]
    rounding: Array  # of values: smaller cells are not known better
    stationary: tuple[Array, Array]  # between these steps from the middle the slope vanishes, if anywhere


class _Search:
    """The state of a search: the extremes that are reached, and bounds from the cells that are done with."""

    def __init__(self, edges: Array, order: int) -> None:
        self.edges, self.order = edges, order
        self.least, self.most = np.inf, -np.inf
        self.bottom, self.top = np.inf, -np.inf
        self.lows: list[tuple[Array, Array]] = []
        self.highs: list[tuple[Array, Array]] = []

    def first(self, parts: int) -> tuple[Array, Array]:
        shares = np.arange(parts + 1) / parts
        places = self.edges[:-1, None] + np.diff(self.edges)[:, None] * shares
        places[:, -1] = self.edges[1:]
        low, high = places[:, :-1].ravel(), places[:, 1:].ravel()
        return low[high > low], high[high > low]

    def look(self, low: Array, high: Array) -> _Asking[_Cells]:
        """The bounds of the function in cells; extremes that it reaches in them are stored."""
        count, (middle, half, places) = len(low), _middles_and_cells(low, high)
        terms = [_as_interval(term, 2 * count) for term in (yield places, self.order).terms]
        value, rate, at, slope = terms[0], terms[1], terms[0][:count], terms[1][:count]
        bend, swing = _bends([term[:count] for term in terms[2:-1]] + [terms[-1][count:]], half)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            turn = middle - 0.5 * slope.middle / terms[2].middle[:count]
        inside = np.array([np.where((low < turn) & (turn < high), turn, middle), low, high])
        moved = _moved(at, slope, bend, middle, inside)
        self._reached(np.concatenate([middle, inside.ravel()]), _joined([at, moved]))
        with np.errstate(invalid="ignore", over="ignore"):
            turn = 2.0 * half * np.maximum(np.abs(swing.low), np.abs(swing.high))
            turn = turn + ROUNDOFF * (8.0 * turn + 4.0 * np.abs(slope.middle))
            slopes = np.fmax(slope.low - turn, rate.low[count:]), np.fmin(slope.high + turn, rate.high[count:])
            reach = half * np.maximum(np.abs(slopes[0]), np.abs(slopes[1]))
            reach = reach + ROUNDOFF * (8.0 * reach + 4.0 * np.abs(at.middle))
            tops = [at.high + reach, _highest(at.high, slope, bend.high, half)]
            bottoms = [at.low - reach, -_highest(-at.low, -slope, -bend.low, half)]
        top, bottom = np.fmin.reduce([value.high[count:], *tops]), np.fmax.reduce([value.low[count:], *bottoms])
        # where the slope has one sign, what is greatest is at an end, and there the next cell has it as well
        rises, falls = slopes[0] > 0.0, slopes[1] < 0.0
        starts, ends = self._on_edges(low), self._on_edges(high)
        top = np.where((rises & ~ends) | (falls & ~starts), -np.inf, np.where(np.isnan(top), np.inf, top))
        bottom = np.where((rises & ~starts) | (falls & ~ends), np.inf, np.where(np.isnan(bottom), -np.inf, bottom))
        rounding = np.where(np.isfinite(at.radius), _BLUR * at.radius, 0.0)
        return _Cells(
            low,
            high,
            middle,
            half,
            bottom,
            top,
            slopes,
            rounding,
            _stationary(slope, swing, 4.0 * (_SMALLEST_CELL * half + ROUNDOFF * np.abs(middle))),
        )

    def _on_edges(self, places: Array) -> NDArray[np.bool_]:
        """Which of some places between the first edge and the last are edges."""
        return np.asarray(self.edges[np.searchsorted(self.edges, places)] == places)

    def _reached(self, places: Array, values: Interval) -> None:
        low, high = values.low, values.high
        sizes = (np.abs(end[np.isfinite(end)]).max(initial=0.0) for end in (low, high))
        size = max(*sizes, _finite(self.least), _finite(self.most))
        self.least, self.lows = _with_ties(self.least, self.lows, high, places, _NEAR_TIE * size)
        negative, self.highs = _with_ties(-self.most, self.highs, -low, places, _NEAR_TIE * size)
        self.most = -negative

    def take(self, cells: _Cells, done: NDArray[np.bool_]) -> None:
        """Count cells among those that are done with."""
        self.bottom = min(self.bottom, float(cells.bottom[done].min(initial=np.inf)))
        self.top = max(self.top, float(cells.top[done].max(initial=-np.inf)))

    def split(self, cells: _Cells, beyond: NDArray[np.bool_]) -> tuple[Array, Array]:
        """Cells anew: of some what may still hold an extreme, in smaller pieces."""
        low, high, middle = cells.low[beyond], cells.high[beyond], cells.middle[beyond]
        width = high - low
        first, last = (np.clip(middle + step[beyond], low, high) for step in cells.stationary)
        sloped = (cells.slope[0][beyond] > 0.0) | (cells.slope[1][beyond] < 0.0) | (first >= last)
        narrowed = ~sloped & (last - first < _NARROWED * width)
        plain = ~sloped & ~narrowed
        ends = sloped | narrowed
        starts, stops = ends & self._on_edges(low), ends & self._on_edges(high)
        lows = [first[narrowed], low[plain], middle[plain], low[starts], high[stops] - _CELL_END * width[stops]]
        highs = [last[narrowed], middle[plain], high[plain], low[starts] + _CELL_END * width[starts], high[stops]]
        some, others = np.concatenate(lows), np.concatenate(highs)
        real = others > some
        return some[real], others[real]

    def result(self, *, polished: bool, places: bool) -> _Asking[Extremes]:
        """The extremes and their bounds when the search ends; the first places of them and nearer ones, if sought."""
        if not np.isfinite([self.least, self.most]).all():
            raise SolverFailure(
                "a function has no finite value at a place where it was evaluated: its extremes cannot be enclosed"
            )
        known = yield from self._lowest(TIE, edges=places)
        least, most = (yield from self._first_of_equals(known)) if polished and places else known
        return Extremes(*least, min(self.bottom, least[0]), -most[0], most[1], max(self.top, -most[0]))

    def _first_of_equals(self, known: tuple[Valued, Valued]) -> _Asking[tuple[Valued, Valued]]:
        """The extremes by Newton's steps; of those as good as one another the first, however near a sample came."""
        early = yield from self._lowest(_NEAR_TIE)
        late = yield from self._polished(known)
        if early == known:
            return late
        allowed = EQUAL_EXTREMES * max(abs(self.least), abs(self.most))
        pairs = zip((yield from self._polished(early)), late, strict=True)
        least, most = (first if first[0] <= best[0] + allowed else best for first, best in pairs)
        return least, most

    def _lowest(self, tie: float, *, edges: bool = True) -> _Asking[tuple[Valued, Valued]]:
        """The first of the least values, and of the greatest with the opposite sign, and where they are."""
        whole, tie = float(self.edges[-1] - self.edges[0]), tie * max(abs(self.least), abs(self.most))
        lowest = _first(self.lows, self.least + tie, whole), _first(self.highs, -self.most + tie, whole)
        if not edges:
            return lowest
        least = yield from self._on_edge(lowest[0], 1.0)
        return least, (yield from self._on_edge(lowest[1], -1.0))

    def _on_edge(self, lowest: Valued, sign: float) -> _Asking[Valued]:
        """The first edge beside a lowest value that is as good: from there on a function may be flat."""
        edges = self.edges[np.abs(self.edges - lowest[1]) <= _EXTREME_WIDTH * float(self.edges[-1] - self.edges[0])]
        if not edges.size:
            return lowest
        terms = (yield Interval(edges, np.zeros(edges.shape)), 0).terms
        value = _as_interval(terms[0], len(edges)) * sign
        good = np.flatnonzero(value.high <= lowest[0] + EQUAL_EXTREMES * max(abs(self.least), abs(self.most)))
        return (float(value.high[good[0]]), float(edges[good[0]])) if good.size else lowest

    def _polished(self, known: tuple[Valued, Valued]) -> _Asking[tuple[Valued, Valued]]:
        """A place nearer to where the slope vanishes, where the value is no worse there."""
        least, most = known
        for _ in range(_STEPS):
            places = np.array([least[1], most[1]])
            terms = (yield Interval(places, np.zeros(2)), 2).terms
            slope, bend = (_as_interval(term, 2).middle for term in terms[1:3])
            with np.errstate(divide="ignore", invalid="ignore"):
                moved = places - 0.5 * slope / bend
            part = np.searchsorted(self.edges[1:-1], places)
            inside = (self.edges[part] < moved) & (moved < self.edges[part + 1]) & ~np.isin(places, self.edges)
            inside &= np.abs(moved - places) > _EXTREME_POLISHED * np.abs(self.edges[-1] - self.edges[0])
            if not inside.any():
                break
            places = np.where(inside, moved, 0.5 * (self.edges[part] + self.edges[part + 1]))
            value = _as_interval((yield Interval(places, np.zeros(2)), 0).terms[0], 2)
            if inside[0] and value.high[0] <= least[0]:
                least = float(value.high[0]), float(places[0])
            if inside[1] and -value.low[1] <= most[0]:
                most = float(-value.low[1]), float(places[1])
        return least, most


def _middles_and_cells(low: Array, high: Array) -> tuple[Array, Array, Interval]:
    """Middles and half widths of cells; and as intervals first the middles, then the cells."""
    middle = 0.5 * (low + high)
    half = np.maximum(high - middle, middle - low) * (1.0 + 4.0 * ROUNDOFF)
    return middle, half, Interval(np.concatenate([middle, middle]), np.concatenate([np.zeros(len(low)), half]))


def _as_interval(term: Any, count: int) -> Interval:
    interval = term if isinstance(term, Interval) else exact(term)
    if interval.middle.shape == (count,):
        return interval
    return Interval(np.broadcast_to(interval.middle, (count,)), np.broadcast_to(interval.radius, (count,)))


def _bends(terms: list[Interval], half: Array) -> tuple[Interval, Interval]:
    """F and G such that f = f(m) + f'(m) t + F t² and f' = f'(m) + 2 G t in cells, from the Taylor terms from t² on."""
    reach, bend, swing = Interval(np.zeros(half.shape), half), terms[-1], terms[-1] * (0.5 * (len(terms) + 1))
    for i in range(len(terms) - 2, -1, -1):
        bend, swing = terms[i] + bend * reach, terms[i] * (0.5 * (i + 2)) + swing * reach
    return bend, swing


def _moved(at: Interval, slope: Interval, bend: Interval, middle: Array, place: Array) -> Interval:
    """Values at places of cells, by Taylor's formula from their middles."""
    step = Interval(place - middle, 4.0 * ROUNDOFF * np.abs(place - middle))
    return at + slope * step + bend * (step * step)


def _highest(start: Array, rate: Interval, bend: Array, half: Array) -> Array:
    """An upper bound of start + rate t + bend t² for |t| <= half; not a number where nothing is known."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        steep = np.abs(rate.middle)
        top = np.where(bend < 0.0, np.clip(-0.5 * steep / bend, 0.0, half), half)
        risen = steep * top + bend * top * top
        sizes = 2.0 * steep * top + 2.0 * np.abs(bend) * top * top
        apart = rate.radius * half * (1.0 + 16.0 * ROUNDOFF)
        return np.asarray(start + risen + apart + ROUNDOFF * (16.0 * sizes + 8.0 * np.abs(start)))


def _stationary(slope: Interval, bend: Interval, slack: Array) -> tuple[Array, Array]:
    """Between which steps from the middle the slope may vanish, by Newton's method; the whole cell where f'' may."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        steps = slope / (bend * -2.0)
        low, high = steps.low - slack, steps.high + slack
    return np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)


def _finite(value: float) -> float:
    return abs(value) if np.isfinite(value) else 0.0


def _with_ties(
    best: float, known: list[tuple[Array, Array]], values: Array, places: Array, tie: float
) -> tuple[float, list[Any]]:
    """The least value with further candidates, and all values that are equal to it up to rounding."""
    values = np.where(np.isfinite(values), values, np.inf)
    least = float(values.min(initial=np.inf))
    best = min(best, least)
    if not np.isfinite(least) or least > best + tie:
        return best, known
    near = values <= best + tie
    return best, [*known, (values[near], places[near])]


def _first(known: list[tuple[Array, Array]], most: float, whole: float) -> Valued:
    """The first place among the lowest values, and the value there."""
    values, places = (np.concatenate(parts) for parts in zip(*known, strict=True))
    values, places = values[values <= most], places[values <= most]
    same = places <= places.min() + _EXTREME_WIDTH * whole
    lowest = int(np.argmin(np.where(same, values, np.inf)))
    return float(values[lowest]), float(places[lowest])


_INTEGRAL_ORDER, _DEEPEST, _MOST_PARTS = 6, 60, 200_000


def integral(function: Function, edges: Any, *, share: float = 1e-9) -> tuple[float, float]:
    """Between which values the integral of a function is, from the first of some edges to the last.

    Parameters
    ----------
    function
        As for `extremes`: Taylor terms in intervals of places.
    edges
        Increasing, shape (n + 1,); at inner ones it may jump.
    share
        By how much cells may be off, relative to the mean magnitude.

    Examples
    --------
    >>> from optlaws.numerics.taylor import variable
    >>> low, high = integral(lambda x, order: variable(x, order).magnitude(), [-1.0, 2.0])
    >>> low <= 2.5 <= high, high - low < 1e-7
    (True, True)
    """
    places = np.asarray(edges, dtype=np.float64)
    low, high, whole = places[:-1], places[1:], float(places[-1] - places[0])
    total, size = Interval(np.zeros(1), np.zeros(1)), 0.0
    for _ in range(_DEEPEST):
        part, rounding = _of_cells(function, low, high)
        sizes = np.abs(part.middle)
        size += float(sizes[np.isfinite(part.radius)].sum())
        with np.errstate(invalid="ignore"):
            near = np.maximum(0.5 * share * max(size / whole, SMALLEST_SIZE), _BLUR * rounding)
            open_ones = ~(part.radius <= near * (high - low))
        total = total + Interval(*(np.array([values[~open_ones].sum()]) for values in (part.middle, part.radius)))
        total = total + Interval(np.zeros(1), len(low) * ROUNDOFF * sizes[~open_ones].sum(keepdims=True))
        if not open_ones.any():
            return float(total.low[0]), float(total.high[0])
        size -= float(sizes[open_ones & np.isfinite(part.radius)].sum())
        low, high = low[open_ones], high[open_ones]
        middle = 0.5 * (low + high)
        low, high = np.append(low, middle), np.append(middle, high)
        if len(low) > _MOST_PARTS:
            break
    raise SolverFailure("a function to be integrated has no bound between the places where it may jump")


def _of_cells(function: Function, low: Array, high: Array) -> tuple[Interval, Array]:
    """The integral over each cell: by the Taylor polynomial, or the range of slope or value where that is less.

    With what values are rounded, beyond which smaller cells are known no better.
    """
    count, (middle, half, places) = len(low), _middles_and_cells(low, high)
    terms = [term + np.zeros(2 * count) for term in function(places, _INTEGRAL_ORDER).terms]
    width = Interval(high - low, 2.0 * ROUNDOFF * (high - low))
    # a middle is rounded, so that odd terms do not vanish in full
    askew = 4.0 * ROUNDOFF * np.abs(middle) * np.abs(terms[1].middle[:count])
    mean, power = terms[0][:count] + Interval(np.zeros(count), askew), Interval(np.ones(count), np.zeros(count))
    square = Interval(half * half, 16.0 * ROUNDOFF * half * half)
    polynomial = mean
    for i in range(2, _INTEGRAL_ORDER, 2):
        power = power * square
        polynomial = polynomial + terms[i][:count] * power / (i + 1)
    rest = terms[_INTEGRAL_ORDER][count:] * (power * square) / (_INTEGRAL_ORDER + 1)
    # the mean of f is f(m) but for half of what the slope varies
    slope = terms[1][count:]
    ways = [
        polynomial + rest,
        Interval(mean.middle, mean.radius + 0.5 * slope.radius * half * (1.0 + 8.0 * ROUNDOFF)),
        terms[0][count:],
    ]
    radii = np.array([np.where(np.isfinite(way.radius), way.radius, np.inf) for way in ways])
    best = np.argmin(radii, axis=0)[None]
    middles = np.take_along_axis(np.array([way.middle for way in ways]), best, 0)[0]
    rounding = np.where(np.isfinite(mean.radius), mean.radius, 0.0)
    return Interval(middles, np.take_along_axis(radii, best, 0)[0]) * width, rounding
