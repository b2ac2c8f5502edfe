"""The outputs of a machine over time: in the motion and the dwell after it, and over a cycle that repeats."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.extras import needed
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, Peak
from optlaws.laws.curve import Curve, Sides
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.mechanisms.forcing import RiseReturnCycle
from optlaws.mechanisms.machine import drives
from optlaws.mechanisms.machine.dynamics import RADIANS, DriveStretch, Dynamics, Panel
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.numbers import Array, Complex, real_times, whole
from optlaws.numerics import chebyshev
from optlaws.tolerances import EPSILON, RESONANCE, SHORTEST_STRETCH

_END_ROUNDING = 1e-14  # of a time: the end of a motion is a sum of lengths


class PanelCurve(Curve):
    """A curve by Chebyshev series on consecutive panels."""

    @property
    @abstractmethod
    def _grid(self) -> tuple[Array, Array]:
        """Starts and lengths of the panels."""

    @property
    @abstractmethod
    def _series(self) -> dict[int, list[Array]]:
        """The series of the derivatives that are known, by their orders, from 0 on; further ones are added."""

    def _of_order(self, nu: int) -> list[Array]:
        if nu not in self._series:
            lower = self._of_order(nu - 1)
            series = [
                chebyshev.derivative(panel_series) / length
                for panel_series, length in zip(lower, self._grid[1], strict=True)
            ]
            self._series[nu] = series
        return self._series[nu]

    def _derivative(self, k: Array, nu: int) -> Array:
        starts, lengths = self._grid
        places = np.clip(np.searchsorted(starts, k, side="right") - 1, 0, len(starts) - 1)
        values, series = np.empty(np.shape(k)), self._of_order(nu)
        for i in np.unique(places):
            here = places == i
            x = 2.0 * (k[here] - starts[i]) / lengths[i] - 1.0
            values[here] = chebyshev.value(series[i], np.clip(x, -1.0, 1.0))
        return values

    def _before_panels(self, nu: int) -> Array:
        """The derivative of order `nu` just before every panel but the first."""
        return np.array([float(series.sum()) for series in self._of_order(nu)[:-1]])

    def _sides(self, nu: int) -> Sides:
        return self._candidates(self._of_order(nu), self._of_order(nu + 1))

    def _power_sides(self) -> Sides:
        products = [chebyshev.product(b, c) for b, c in zip(self._of_order(1), self._of_order(2), strict=True)]
        return self._candidates(products, [chebyshev.derivative(product) for product in products])

    def _candidates(self, series: list[Array], slopes: list[Array]) -> Sides:
        places, values = [], []
        for start, length, column, slope in zip(*self._grid, series, slopes, strict=True):
            x = np.concatenate([[-1.0], np.sort(chebyshev.real_parts_of_roots(slope)), [1.0]])
            places.append(start + 0.5 * length * (x + 1.0))
            values.append(chebyshev.value(column, x))
        return np.concatenate(places), np.concatenate(values)

    def _mean_square(self, nu: int) -> float:
        squares = [chebyshev.mean_product(series, series) for series in self._of_order(nu)]
        lengths = self._grid[1]
        return float(lengths @ np.array(squares)) / float(lengths.sum())


@dataclass(frozen=True, eq=False, repr=False)
class OutputCurve(PanelCurve):
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
    def interval(self) -> tuple[float, float]:
        return float(self.starts[0]), float(self.starts[-1] + self.lengths[-1])

    @property
    def _breaks(self) -> tuple[float, ...]:
        return (*self.starts.tolist(), self.interval[1])

    def _plot(self, ax: Any, style: dict[str, Any]) -> list[Any]:
        from optlaws.plots.machine import draw_output

        return draw_output(self, ax, **style)

    def plus(self, offset: float) -> OutputCurve:
        """The curve plus a number in its units, such as the constant load of a weight.

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
        """Equally spaced times over the interval."""
        return np.linspace(*self.interval, whole(count, "count", 2))

    def __repr__(self) -> str:
        low, high = self.extrema(0)
        return f"OutputCurve({self.name!r}, from {low.value:g} to {high.value:g})"

    def _times(self, k: Any) -> Array:
        places, (low, high) = real_times(k), self.interval
        rounding = _END_ROUNDING * max(abs(low), abs(high))
        if places.size and not (low - rounding <= places.min() and places.max() <= high + rounding):
            raise InputError(f"k must be in {low:g} to {high:g}, of which the motion is known, got {shortened(k)}")
        return np.clip(places, low, high)

    @property
    def _grid(self) -> tuple[Array, Array]:
        return self.starts, self.lengths

    @kept_property
    def _series(self) -> dict[int, list[Array]]:
        return {0: list(self.parts)}

    def _before_breaks(self, nu: int) -> Array:
        return self._before_panels(nu)

    def _impulses(self, nu: int) -> Sides:
        places, values = self.impulses
        return (places, values) if nu == 0 else (places[:0], values[:0])


@dataclass(frozen=True, eq=False, repr=False)
class MachineMotion(ABC):
    """The outputs of a machine over time, by their names: each a curve, or an `InputError` where it is undefined."""

    machine: StateSpace

    def __getitem__(self, output: str) -> OutputCurve:
        """The curve of an output."""
        self.machine.place(output)
        if output not in self._curves:
            self._curves[output] = self._curve(output)
        return self._curves[output]

    def peak(self, output: str) -> Peak:
        """The greatest magnitude of an output, with its place."""
        return self[output].peak(0)

    def extrema(self, output: str) -> tuple[Peak, Peak]:
        """Minimum and maximum of an output, signed."""
        return self[output].extrema(0)

    def rms(self, output: str) -> float:
        """Root mean square of an output."""
        return self[output].rms(0)

    def to_pandas(self, count: int = 201) -> Any:
        """Samples of all outputs as a data frame over `count` equally spaced times; needs the extra `optlaws[studies]`.

        Examples
        --------
        >>> from optlaws import Machine, smoothstep
        >>> mass = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
        >>> mass.response(smoothstep(4), dwell=0.5).to_pandas(4).round(6)["position"].tolist()
        [0.0, 0.489570, 1.00..., 1.00...]
        """
        pd = needed("pandas", "to_pandas")
        return pd.concat([self[name].to_pandas(count) for name in self.machine.outputs], axis=1)

    @kept_property
    def _curves(self) -> dict[str, OutputCurve]:
        return {}

    def _curve(self, output: str) -> OutputCurve:
        states, direct = self.machine.output_rows(output)
        panels = self._panels
        parts = tuple(trimmed(panel.output(states, direct)[:, 0]) for panel in panels)
        starts, lengths = grid(panels)
        jumps = self._velocity_jumps if direct[2] else []
        impulses = np.array([k for k, _ in jumps]), np.array([np.copysign(np.inf, direct[2] * b) for _, b in jumps])
        return OutputCurve(output, starts, lengths, parts, impulses)

    @kept_property
    def _panels(self) -> list[Panel]:
        return steady(self.machine.dynamics, self._drives)

    @property
    @abstractmethod
    def _drives(self) -> Sequence[DriveStretch]:
        """The motion of the drive, from rest or repeated."""

    @property
    @abstractmethod
    def _velocity_jumps(self) -> Sequence[tuple[float, float]]:
        """The places where the law's velocity jumps inside, so that its acceleration is an impulse there."""


@dataclass(frozen=True, eq=False, repr=False)
class MachineResponse(MachineMotion):
    """The outputs of a machine during a rise, 0 <= k <= 1, and the dwell after it; computed by `Machine.response`.

    Attributes
    ----------
    law
        The law that drives it, from rest.
    dwell
        Duration of the dwell, in durations of the rise.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> mass = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> response = mass.response(smoothstep(4), dwell=0.5)
    >>> response["position"](0.5), response.rise_peak("position"), response.dwell_peak("position")
    (0.489570, Peak(value=1.003509, k=0.886102), Peak(value=1.003445, k=1.179061))
    """

    law: MotionLaw
    dwell: float

    def rise_peak(self, output: str) -> Peak:
        """The greatest magnitude of an output during the rise."""
        return self._greatest(output, (0.0, 1.0))

    def dwell_peak(self, output: str) -> Peak:
        """The greatest magnitude of an output during the dwell.

        Raises
        ------
        InputError
            If the response has no dwell.
        """
        if self.dwell <= SHORTEST_STRETCH:
            raise InputError("this response has no dwell: request one, machine.response(law, dwell=1.0)")
        return self._greatest(output, (1.0, self[output].interval[1]))

    def _greatest(self, output: str, within: tuple[float, float]) -> Peak:
        low, high = self[output].extrema(0, within)
        return high if high.value >= -low.value else Peak(-low.value, low.k)

    @property
    def _drives(self) -> list[DriveStretch]:
        pause = [drives.rest(1.0, self.dwell, float(self.law.a(1.0)))] if self.dwell > SHORTEST_STRETCH else []
        return drives.of_law(self.law) + pause

    @kept_property
    def _panels(self) -> list[Panel]:
        begun = self.machine.settled(np.array([float(self.law.a(0.0))]))
        return self.machine.dynamics.moved(self._drives, begun)[0]

    @property
    def _velocity_jumps(self) -> list[tuple[float, float]]:
        return jumps(self.law)

    def __repr__(self) -> str:
        return f"MachineResponse({self.machine!r}, {self.law!r}, dwell={self.dwell:g})"


@dataclass(frozen=True, eq=False, repr=False)
class MachineCycle(RiseReturnCycle, MachineMotion):
    """The steady outputs of a machine over a repeated cycle; computed by `Machine.cycle`. Time is in rises' durations.

    Attributes
    ----------
    rise, fall
        Laws of the rise and of the return.
    dwell, fall_duration, rest
        Durations of what follows the rise, in durations of the rise.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> mass = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> cycle = mass.cycle(smoothstep(4), dwell=0.5, rest=1.0)
    >>> cycle.period, round(cycle["position"](0.0) - cycle["position"](3.5), 12) + 0.0
    (3.5, 0.0)
    """

    rise: MotionLaw
    fall: MotionLaw
    dwell: float
    fall_duration: float
    rest: float

    def __post_init__(self) -> None:
        super().__post_init__()
        self._panels  # noqa: B018 - a cycle in resonance is refused at once

    @property
    def _drives(self) -> list[DriveStretch]:
        return self._course(drives.of_law, drives.rest)

    @property
    def _velocity_jumps(self) -> list[tuple[float, float]]:
        back = 1.0 + self.dwell
        falling = [(back + self.fall_duration * k, -b / self.fall_duration) for k, b in jumps(self.fall)]
        return [*jumps(self.rise), *falling]

    def __repr__(self) -> str:
        return f"MachineCycle({self.machine!r}, period={self.period:g})"


@dataclass(frozen=True, eq=False, repr=False)
class RepeatedMotion(MachineMotion):
    """The steady outputs of a machine under any repeated motion; computed by a whole cycle.

    `drives` are its stretches in the machine's unit of time, `jumps` where the velocity jumps inside, and by how much.

    >>> from optlaws import Machine, smoothstep
    >>> mass = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> there, back = drives.of_law(smoothstep(4)), drives.of_law(smoothstep(4), 1.0, 1.0, 1.0, -1.0)
    >>> repeated, cycle = RepeatedMotion(mass, (*there, *back), ()), mass.cycle(smoothstep(4), dwell=0, rest=0)
    >>> bool(abs(repeated.peak("position").value - cycle.peak("position").value) < 1e-12)
    True
    """

    drives: tuple[DriveStretch, ...]
    jumps: tuple[tuple[float, float], ...]

    @property
    def _drives(self) -> Sequence[DriveStretch]:
        return self.drives

    @property
    def _velocity_jumps(self) -> Sequence[tuple[float, float]]:
        return self.jumps

    def __repr__(self) -> str:
        last = self.drives[-1]
        return f"RepeatedMotion({self.machine!r}, period={last.start + last.length - self.drives[0].start:g})"


def steady(dynamics: Dynamics, cycle: Sequence[DriveStretch], radians: float = RADIANS) -> list[Panel]:
    """The motion that comes back after a cycle, a column for each of the cycle's."""
    columns, size = cycle[0].series.shape[2], len(dynamics.roots)
    last = cycle[-1]
    period, before = last.start + last.length - cycle[0].start, last.ends[1][1]
    nothing = np.zeros((size, columns), dtype=np.complex128)
    still = [drives.rest(0.0, period, np.zeros(size))]
    forced = dynamics.moved(cycle, nothing, radians=radians, before=before)[1]
    free = dynamics.moved(still, np.eye(size, dtype=np.complex128), radians=radians)[1]
    returned = np.eye(size) - free
    if np.linalg.svd(returned, compute_uv=False)[-1] < RESONANCE:
        raise InputError(
            f"there is no steady motion: a vibration without damping is in resonance with a cycle of {period:g} "
            "durations of the rise, or a state drifts; give damping or change the cycle"
        )
    initial: Complex = np.linalg.solve(returned, forced).astype(np.complex128)
    return dynamics.moved(cycle, initial, radians=radians, before=before)[0]


def jumps(law: MotionLaw) -> list[tuple[float, float]]:
    """The places and sizes of jumps of a law's velocity inside its interval."""
    return list(law.jumps(1)) if isinstance(law, PiecewiseLaw) else []


def grid(panels: Sequence[Panel]) -> tuple[Array, Array]:
    """Starts and lengths of panels."""
    return np.array([panel.start for panel in panels]), np.array([panel.length for panel in panels])


def trimmed(series: Array) -> Array:
    """A series without the coefficients at its end that are rounding."""
    size = np.abs(series)
    counted = np.flatnonzero(size > EPSILON * size.max())
    return series[: counted[-1] + 1] if len(counted) else np.zeros(1)
