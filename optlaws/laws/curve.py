"""Base class of laws of motion and motions of a mass: values, derivatives, peaks with places, samples."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from math import inf
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError, needed
from optlaws.kept import kept_property
from optlaws.numbers import MOST_VALUES, Array, derivative, finite, number_or_array, whole
from optlaws.numerics import peaks
from optlaws.numerics.peaks import Peak
from optlaws.numerics.roots import crossings

Many = NDArray[Any] | Sequence[Any]
Sides = tuple[Array, Array]


class Curve(ABC):
    """Displacement a(k) with its derivatives, dimensionless; velocity b, acceleration c, jerk j, kinetic power d = b c.

    Peaks, root mean squares and samples are those of its `interval`; values there may be beyond it too.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> isinstance(smoothstep(3), Curve), smoothstep(3).interval
    (True, (0.0, 1.0))
    """

    #: what draws the curve, and what its samples run over; an output of a machine has its own
    _over = "k"

    @property
    def interval(self) -> tuple[float, float]:
        """The first and the last k of what peaks, root mean squares and samples look at."""
        return 0.0, 1.0

    @property
    def breaks(self) -> tuple[float, ...]:
        """The places where the curve is put together from pieces, both ends of the interval included."""
        return self._breaks

    @overload
    def __call__(self, k: float, nu: int = 0) -> float: ...
    @overload
    def __call__(self, k: Many, nu: int = 0) -> Array: ...
    def __call__(self, k: float | Many, nu: int = 0) -> float | Array:
        """Derivative of order `nu` of a at `k`.

        Parameters
        ----------
        k
            Dimensionless time; a number or an array of any shape.
        nu
            Order of the derivative, at least 0.

        Returns
        -------
        A float for a number (or an array of shape ()), else an array of the shape of `k`.

        Raises
        ------
        InputError
            If there is no value at `k`, or it is no number, or `nu` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(3)([0.0, 0.5, 1.0], nu=1).tolist()
        [0.0, 1.875, 0.0]
        """
        return number_or_array(self._derivative(self._times(k), derivative(nu)))

    @overload
    def a(self, k: float) -> float: ...
    @overload
    def a(self, k: Many) -> Array: ...
    def a(self, k: float | Many) -> float | Array:
        """The displacement a at k."""
        return number_or_array(self._derivative(self._times(k), 0))

    @overload
    def b(self, k: float) -> float: ...
    @overload
    def b(self, k: Many) -> Array: ...
    def b(self, k: float | Many) -> float | Array:
        """The velocity a' at k, dimensionless."""
        return number_or_array(self._derivative(self._times(k), 1))

    @overload
    def c(self, k: float) -> float: ...
    @overload
    def c(self, k: Many) -> Array: ...
    def c(self, k: float | Many) -> float | Array:
        """The acceleration a'' at k, dimensionless."""
        return number_or_array(self._derivative(self._times(k), 2))

    @overload
    def j(self, k: float) -> float: ...
    @overload
    def j(self, k: Many) -> Array: ...
    def j(self, k: float | Many) -> float | Array:
        """The jerk a''' at k, dimensionless."""
        return number_or_array(self._derivative(self._times(k), 3))

    @overload
    def d(self, k: float) -> float: ...
    @overload
    def d(self, k: Many) -> Array: ...
    def d(self, k: float | Many) -> float | Array:
        """Kinetic power b c at k; finite where c grows without limit and b is zero."""
        return number_or_array(self._power(self._times(k)))

    def peak(self, nu: int) -> Peak:
        """Peak of |derivative of order nu| over the whole interval, at the smallest k where several tie.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(2).peak(2)
        Peak(value=6.0, k=0.0)
        """
        return peaks.peak(*self._whole(derivative(nu)))

    def extrema(self, nu: int, within: tuple[float, float] | None = None) -> tuple[Peak, Peak]:
        """Minimum and maximum, signed, of the derivative of order nu over the whole interval or a part of it.

        Parameters
        ----------
        nu
            Order of the derivative.
        within
            The part: its first and its last k.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0, or the part is not in the interval.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(2).extrema(2)
        (Peak(value=-6.0, k=1.0), Peak(value=6.0, k=0.0))
        """
        nu = derivative(nu)
        return self._extremes(lambda: self._whole(nu), lambda k: self._derivative(k, nu), within)

    def where(self, value: float, nu: int = 0) -> Array:
        """Every k of the interval, ascending, where the derivative of order nu has a value; of a rest there, both ends.

        Parameters
        ----------
        value
            The value, dimensionless. A jump over it is no place that has it.
        nu
            Order of the derivative.

        Raises
        ------
        InputError
            If `value` is no finite number, or `nu` not an integer of at least 0.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(3).where(0.8).round(6).tolist()  # four fifths of the stroke are done
        [0.673402]
        >>> smoothstep(3).where(0.0, nu=2).tolist()
        [0.0, 0.5, 1.0]
        """
        nu, height = derivative(nu), finite(value, "value")
        turns, _ = self._sides(nu)
        places = np.unique(np.concatenate([turns, self.breaks]))
        after = self._derivative(places, nu)
        before = after.copy()
        before[np.searchsorted(places, self.breaks[1:-1])] = self._before_breaks(nu)
        return crossings(lambda k: float(self._derivative(np.array(k), nu)), places, after, before, height)

    def power_peak(self) -> Peak:
        """Peak of |d| over the whole interval, d = b c.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> round(smoothstep(2).power_peak().value, 6)
        3.464102
        """
        return peaks.peak(*self._whole_power())

    def power_extrema(self, within: tuple[float, float] | None = None) -> tuple[Peak, Peak]:
        """Minimum and maximum, signed, of d over the whole interval or a part of it.

        Parameters
        ----------
        within
            The part: its first and its last k.

        Raises
        ------
        InputError
            If the part is not in the interval.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> [round(extreme.value, 6) for extreme in smoothstep(2).power_extrema()]
        [-3.464102, 3.464102]
        """
        return self._extremes(self._whole_power, self._power, within)

    def rms(self, nu: int) -> float:
        """Root mean square of the derivative of order nu over the interval.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> round(smoothstep(2).rms(2) ** 2, 12)
        12.0
        """
        nu = derivative(nu)
        return inf if self._impulses(nu)[0].size else float(np.sqrt(self._mean_square(nu)))

    def samples(self, count: int = 201, nu: int = 0) -> tuple[Array, Array]:
        """Equally spaced k over the interval with the derivative of order nu there, to draw or to write down.

        Every break inside comes twice more, with the values on its two sides, so that a jump is drawn upright.

        Parameters
        ----------
        count
            Number of equally spaced k, at least 2.
        nu
            Order of the derivative.

        Raises
        ------
        InputError
            If `count` is not an integer of at least 2, or `nu` not one of at least 0.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> [column.tolist() for column in smoothstep(2).samples(3, nu=1)]
        [[0.0, 0.5, 1.0], [0.0, 1.5, 0.0]]
        """
        nu = derivative(nu)
        even = np.linspace(*self.interval, whole(count, "count", least=2, most=MOST_VALUES))
        inner = np.array(self.breaks[1:-1])
        k = np.concatenate([inner, even, inner])
        values = np.concatenate([self._before_breaks(nu), self._derivative(k[len(inner) :], nu)])
        after = np.arange(len(k)) >= len(inner)
        ordered = np.lexsort((after, k))
        return k[ordered], values[ordered]

    def to_pandas(self, count: int = 201) -> Any:
        """The samples of a, b, c, d and j as a data frame over k, of an output of a machine its own over time.

        Needs the extra `optlaws[studies]`.

        Parameters
        ----------
        count
            Number of equally spaced k, at least 2; a break inside comes twice more, with the values on its two sides.

        Raises
        ------
        InputError
            If `count` is not an integer of at least 2, or pandas is missing.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(3).to_pandas(3).loc[0.5].round(6).to_dict()
        {'a': 0.5, 'b': 1.875, 'c': 0.0, 'd': 0.0, 'j': -30.0}
        """
        pd = needed("pandas", "to_pandas")
        places, columns = self._sampled(count)
        return pd.DataFrame(columns, index=pd.Index(places, name=self._over))

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw a, b, c and j with their peaks, dimensionless over k, by matplotlib; jumps break the line.

        An output of a machine is one line over time, in one pair of axes.

        Parameters
        ----------
        ax
            Four axes for a, b, c and j, or one for all four, each divided by its peak; a new figure unless given.
        style
            What `Axes.plot` takes, for the curves.

        Returns
        -------
        The artists; `[0].figure` is the figure.

        Raises
        ------
        InputError
            If there are neither one nor four axes.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> [panel.get_title(loc="left") for panel in smoothstep(3).plot()[0].figure.axes][1:3]
        ['B = 1.875 at k = 0.5', 'C = 5.773503 at k = 0.211325']
        """
        return self._plot(ax, style)

    def _plot(self, ax: Any, style: dict[str, Any]) -> list[Any]:
        from optlaws.plots.law import draw_curve

        return draw_curve(self, ax, **style)

    def _sampled(self, count: int) -> tuple[Array, dict[str, Array]]:
        """Places, and the values of a table there."""
        (k, a), (_, b), (_, c), (_, j) = (self.samples(count, nu) for nu in range(4))
        with np.errstate(invalid="ignore"):
            d = np.where(np.isfinite(c), b * c, self.d(k))
        return k, {"a": a, "b": b, "c": c, "d": d, "j": j}

    def _whole(self, nu: int) -> Sides:
        """Places and values that contain the extremes of the derivative of order nu, infinite values included."""
        if nu not in self._known_sides:
            (k, values), (places, heights) = self._sides(nu), self._impulses(nu)
            joined = (np.append(k, places), np.append(values, heights)) if places.size else (k, values)
            self._known_sides[nu] = joined
        return self._known_sides[nu]

    def _whole_power(self) -> Sides:
        """Places and values that contain the extremes of d, infinite values included."""
        return self._power_sides()

    def _extremes(
        self, whole: Callable[[], Sides], at: Callable[[Array], Array], within: tuple[float, float] | None
    ) -> tuple[Peak, Peak]:
        if within is None or within == self.interval:
            return peaks.extremes(*whole())
        ends = self._part(within)
        k, values = whole()
        inside = (k >= ends[0]) & (k <= ends[1])
        return peaks.extremes(np.concatenate([ends, k[inside]]), np.concatenate([at(ends), values[inside]]))

    def _part(self, within: tuple[float, float]) -> Array:
        ends = self._times(within)
        low, high = self.interval
        if ends.shape != (2,) or not low <= ends[0] <= ends[1] <= high:
            raise InputError(f"within must be two k, {low:g} <= first <= last <= {high:g}, got {shortened(within)}")
        return ends

    @kept_property
    def _known_sides(self) -> dict[int, Sides]:
        return {}

    @property
    def _breaks(self) -> tuple[float, ...]:
        return self.interval

    def _before_breaks(self, nu: int) -> Array:
        """The derivative of order nu just before every break inside the interval; after it, it has its value there."""
        return self._derivative(np.array(self.breaks[1:-1]), nu)

    def _impulses(self, nu: int) -> Sides:  # noqa: ARG002 - none unless an heir has jumps
        """Places where the derivative of order nu is an impulse, each with the infinite value of its sign."""
        return np.empty(0), np.empty(0)

    def _power(self, k: Array) -> Array:
        """Kinetic power d at valid `k` of any shape."""
        return self._derivative(k, 1) * self._derivative(k, 2)

    @abstractmethod
    def _times(self, k: Any) -> Array:
        """The requested k, as floats; InputError where there are none."""

    @abstractmethod
    def _derivative(self, k: Array, nu: int) -> Array:
        """Derivative of order `nu` at valid `k` of any shape; at a break inside, just after it."""

    @abstractmethod
    def _sides(self, nu: int) -> Sides:
        """Places with values among which the finite extremes of the derivative of order `nu` are.

        Stationary points, both ends, and every break twice, with the value on either side of it.
        """

    @abstractmethod
    def _power_sides(self) -> Sides:
        """Places with values among which the finite extremes of d are, breaks twice."""

    @abstractmethod
    def _mean_square(self, nu: int) -> float:
        """Mean over the interval of the square of the derivative of order `nu`, which has no impulse."""
