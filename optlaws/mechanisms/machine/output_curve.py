"""An output of a machine over time: a curve of Chebyshev series on short panels."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws.curve import Curve, Sides
from optlaws.numbers import Array, real_times, whole
from optlaws.numerics import chebyshev
from optlaws.numerics.tolerances import END_ROUNDING


@dataclass(frozen=True, eq=False, repr=False)
class OutputCurve(Curve):
    """An output of a machine over time, in its own units, with values, peaks, RMS and samples like a law.

    Its derivative of order 0 is the output itself: `curve(k)`, `curve.peak(0)`, `curve.extrema(0)`, `curve.rms(0)`.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> slow = Machine([[-2.0]], [[2.0]], [[1.0]], outputs=["temperature"])
    >>> curve = slow.response(smoothstep(3), dwell=1.0)["temperature"]
    >>> curve(1.0), curve.peak(0), curve.interval
    (0.605102, Peak(value=0.946556, k=2.0), (0.0, 2.0))
    >>> curve.to_pandas(3).loc[1.0].round(6).to_dict()
    {'temperature': 0.605102}
    """

    _over = "time"

    name: str
    starts: Array
    lengths: Array
    parts: tuple[Array, ...]
    impulses: Sides

    @property
    def interval(self) -> tuple[float, float]:  # noqa: D102
        return float(self.starts[0]), float(self.starts[-1] + self.lengths[-1])

    @property
    def _breaks(self) -> tuple[float, ...]:
        return (*self.starts.tolist(), self.interval[1])

    def _plot(self, ax: Any, style: dict[str, Any]) -> list[Any]:  # noqa: ANN401 - matplotlib's
        from optlaws.plots.machine import draw_output

        return draw_output(self, ax, **style)

    def plus(self, offset: float) -> OutputCurve:
        """The curve with a number added to it, in its units: a constant load, such as a weight that is held.

        Examples
        --------
        >>> from optlaws import Machine, smoothstep
        >>> curve = Machine([[-2.0]], [[2.0]], [[1.0]]).response(smoothstep(3))["output 1"]
        >>> curve(1.0), curve.plus(-1.0)(1.0)
        (0.605102, -0.394898)
        """
        added = [np.concatenate([part[:1] + offset, part[1:]]) for part in self.parts]
        return replace(self, parts=tuple(added)) if offset else self

    def _sampled(self, count: int) -> tuple[Array, dict[str, Array]]:
        times = self.times(count)
        return times, {self.name: self(times)}

    def times(self, count: int) -> Array:
        """Equally spaced times over the interval.

        Raises
        ------
        InputError
            If `count` is not an integer of at least 2.
        """
        return np.linspace(*self.interval, whole(count, "count", 2))

    def __repr__(self) -> str:
        low, high = self.extrema(0)
        return f"OutputCurve({self.name!r}, from {low.value:g} to {high.value:g})"

    def _times(self, k: Any) -> Array:  # noqa: ANN401 - whatever users give
        places, (low, high) = real_times(k), self.interval
        rounding = END_ROUNDING * max(abs(low), abs(high))
        if places.size and not (low - rounding <= places.min() and places.max() <= high + rounding):
            raise InputError(f"k must be in {low:g} to {high:g}, of which the motion is known, got {shortened(k)}")
        return np.clip(places, low, high)

    @kept_property
    def _series(self) -> dict[int, list[Array]]:
        return {0: list(self.parts)}

    def _of_order(self, nu: int) -> list[Array]:
        if nu not in self._series:
            lower = self._of_order(nu - 1)
            series = [
                chebyshev.derivative(panel_series) / length
                for panel_series, length in zip(lower, self.lengths, strict=True)
            ]
            self._series[nu] = series
        return self._series[nu]

    def _derivative(self, k: Array, nu: int) -> Array:
        places = np.clip(np.searchsorted(self.starts, k, side="right") - 1, 0, len(self.starts) - 1)
        values, series = np.empty(np.shape(k)), self._of_order(nu)
        for i in np.unique(places):
            here = places == i
            x = 2.0 * (k[here] - self.starts[i]) / self.lengths[i] - 1.0
            values[here] = chebyshev.value(series[i], np.clip(x, -1.0, 1.0))
        return values

    def _before_breaks(self, nu: int) -> Array:
        return np.array([float(series.sum()) for series in self._of_order(nu)[:-1]])

    def _impulses(self, nu: int) -> Sides:
        places, values = self.impulses
        return (places, values) if nu == 0 else (places[:0], values[:0])

    def _sides(self, nu: int) -> Sides:
        return self._candidates(self._of_order(nu), self._of_order(nu + 1))

    def _power_sides(self) -> Sides:
        products = [chebyshev.product(b, c) for b, c in zip(self._of_order(1), self._of_order(2), strict=True)]
        return self._candidates(products, [chebyshev.derivative(product) for product in products])

    def _candidates(self, series: list[Array], slopes: list[Array]) -> Sides:
        places, values = [], []
        for start, length, column, slope in zip(self.starts, self.lengths, series, slopes, strict=True):
            x = np.concatenate([[-1.0], np.sort(chebyshev.real_parts_of_roots(slope)), [1.0]])
            places.append(start + 0.5 * length * (x + 1.0))
            values.append(chebyshev.value(column, x))
        return np.concatenate(places), np.concatenate(values)

    def _mean_square(self, nu: int) -> float:
        squares = [chebyshev.mean_product(series, series) for series in self._of_order(nu)]
        return float(self.lengths @ np.array(squares)) / float(self.lengths.sum())
