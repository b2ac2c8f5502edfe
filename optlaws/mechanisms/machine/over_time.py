"""The outputs of a machine over time: in the motion and the dwell after it, and over a cycle that repeats."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError, needed
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, Peak
from optlaws.laws.curve import Curve, Sides
from optlaws.laws.law import motion_law
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.mechanisms.machine import drives
from optlaws.mechanisms.machine.state_space import RADIANS, DriveStretch, Dynamics, OutputRows, Panel, StateSpace
from optlaws.numbers import Array, Complex, not_negative, positive, real_times, whole
from optlaws.numerics import chebyshev
from optlaws.tolerances import CLOSURE, EPSILON, RESONANCE, SHORTEST_STRETCH

_END_ROUNDING = 1e-14  # of a time: the end of a motion is a sum of lengths


class PanelCurve(Curve):
    """A curve by Chebyshev series on consecutive panels."""

    @property
    @abstractmethod
    def _motion(self) -> MachineMotion:
        """The motion whose panels they are."""

    @property
    @abstractmethod
    def _series(self) -> dict[int, list[Array]]:
        """The series of the derivatives that are known, by their orders, from 0 on; further ones are added."""

    def _of_order(self, nu: int) -> list[Array]:
        if nu not in self._series:
            lower = zip(self._of_order(nu - 1), self._motion.grid[1], strict=True)
            self._series[nu] = [chebyshev.derivative(series) / length for series, length in lower]
        return self._series[nu]

    def _derivative(self, k: Array, nu: int) -> Array:
        starts, lengths = self._motion.grid
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
        for start, length, column, slope in zip(*self._motion.grid, series, slopes, strict=True):
            x = np.concatenate([[-1.0], np.sort(chebyshev.real_parts_of_roots(slope)), [1.0]])
            places.append(start + 0.5 * length * (x + 1.0))
            values.append(chebyshev.value(column, x))
        return np.concatenate(places), np.concatenate(values)

    def _mean_square(self, nu: int) -> float:
        squares = [chebyshev.mean_product(series, series) for series in self._of_order(nu)]
        lengths = self._motion.grid[1]
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

    motion: MachineMotion
    name: str
    offset: float = 0.0

    @property
    def _motion(self) -> MachineMotion:
        return self.motion

    @kept_property
    def interval(self) -> tuple[float, float]:
        starts, lengths = self.motion.grid
        return float(starts[0]), float(starts[-1] + lengths[-1])

    @property
    def _breaks(self) -> tuple[float, ...]:
        return (*self.motion.grid[0].tolist(), self.interval[1])

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
        return replace(self, offset=self.offset + offset) if offset else self

    def _sampled(self, count: int) -> tuple[Array, dict[str, Array]]:
        times = np.linspace(*self.interval, whole(count, "count", 2))
        return times, {self.name: self(times)}

    def __repr__(self) -> str:
        low, high = self.extrema(0)
        return f"OutputCurve({self.name!r}, from {low.value:g} to {high.value:g})"

    def _times(self, k: Any) -> Array:
        places, (low, high) = real_times(k), self.interval
        rounding = _END_ROUNDING * max(abs(low), abs(high))
        if places.size and not (low - rounding <= places.min() and places.max() <= high + rounding):
            raise InputError(f"k must be in {low:g} to {high:g}, of which the motion is known, got {shortened(k)}")
        return np.clip(places, low, high)

    @kept_property
    def _series(self) -> dict[int, list[Array]]:
        series = self.motion.series(self.name)
        return {0: [np.append(part[0] + self.offset, part[1:]) for part in series] if self.offset else series}

    def _before_breaks(self, nu: int) -> Array:
        return self._before_panels(nu)

    def _impulses(self, nu: int) -> Sides:
        direct = self.motion.outputs[self.name][1][2]
        jumps = self.motion.jumps if direct and nu == 0 else []
        return np.array([k for k, _ in jumps]), np.array([np.copysign(np.inf, direct * b) for _, b in jumps])


@dataclass(frozen=True)
class RiseReturnCycle:
    """A repeated motion: laws of rise and return, durations of what follows the rise, in durations of the rise."""

    rise: MotionLaw
    fall: MotionLaw
    dwell: float
    fall_duration: float
    rest: float

    def __post_init__(self) -> None:
        for name, checked in _CHECKS.items():
            object.__setattr__(self, name, checked(getattr(self, name), name))
        strokes = [float(law.a(1.0)) - float(law.a(0.0)) for law in (self.rise, self.fall)]
        if abs(strokes[1] - strokes[0]) > CLOSURE * max(1.0, abs(strokes[0])):
            raise InputError(f"fall must lead back over the rise's stroke {strokes[0]:g}, but has {strokes[1]:g}")

    @property
    def period(self) -> float:
        """Duration of the cycle, in durations of the rise."""
        return 1.0 + self.dwell + self.fall_duration + self.rest


_CHECKS: dict[str, Callable[[Any, str], Any]] = {
    "rise": motion_law,
    "fall": motion_law,
    "dwell": not_negative,
    "fall_duration": positive,
    "rest": not_negative,
}


def around(
    rise: list[DriveStretch],
    fall: list[DriveStretch],
    levels: tuple[Array | float, Array | float],
    durations: tuple[float, float, float],
) -> list[DriveStretch]:
    """A cycle: rise, dwell at the upper level, return, rest at the lower one; `durations` are those after the rise."""
    (high, low), (dwell, fall_duration, pause) = levels, durations
    above = [drives.rest(1.0, dwell, high)] if dwell > SHORTEST_STRETCH else []
    below = [drives.rest(1.0 + dwell + fall_duration, pause, low)] if pause > SHORTEST_STRETCH else []
    return [*rise, *above, *fall, *below]


@dataclass(frozen=True, eq=False, repr=False)
class MachineMotion:
    """The outputs of a machine over time, by their names, each a curve; of `Machine.response`, `Machine.cycle`, cycles.

    Time is in durations of the rise, of a whole cycle in seconds.

    Attributes
    ----------
    dynamics
        The equation of the machine.
    outputs
        Rows that take its states to each output, and those that take a, b and c of the drive to it.
    drives
        The motion of the drive, stretch by stretch.
    initial
        The states at its beginning; the drive repeats, and the motion is the steady one, where there are none.
    jumps
        Where the velocity of the drive jumps inside, and by how much: its acceleration is an impulse there.
    radians
        How much of the fastest vibration is in a panel.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> mass = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> response = mass.response(smoothstep(4), dwell=0.5)
    >>> response["position"](0.5), response.rise_peak("position"), response.dwell_peak("position")
    (0.489570, Peak(value=1.003509, k=0.886102), Peak(value=1.003445, k=1.179061))
    >>> cycle = mass.cycle(smoothstep(4), dwell=0.5, rest=1.0)
    >>> cycle, cycle.period, round(cycle["position"](0.0) - cycle["position"](3.5), 12) + 0.0
    (MachineMotion(outputs=['position'], from 0 to 3.5), 3.5, 0.0)
    """

    dynamics: Dynamics
    outputs: Mapping[str, OutputRows]
    drives: Sequence[DriveStretch]
    initial: Complex | None = None
    jumps: Sequence[tuple[float, float]] = ()
    radians: float = RADIANS

    @classmethod
    def of_law(cls, machine: StateSpace, law: MotionLaw, dwell: float = 0.0) -> Self:
        """The motion under a law and in the dwell after it, from rest."""
        pause = [drives.rest(1.0, dwell, float(law.a(1.0)))] if dwell > SHORTEST_STRETCH else []
        begun = machine.settled(np.array([float(law.a(0.0))]))
        return cls(machine.dynamics, machine.rows, drives.of_law(law) + pause, begun, jumps(law))

    @classmethod
    def of_cycle(
        cls, dynamics: Dynamics, outputs: Mapping[str, OutputRows], cycle: RiseReturnCycle, radians: float = RADIANS
    ) -> Self:
        """The steady motion over a cycle, which is refused at once where it is in resonance."""
        low, high, back = float(cycle.rise.a(0.0)), float(cycle.rise.a(1.0)), 1.0 + cycle.dwell
        fall = drives.of_law(cycle.fall, back, cycle.fall_duration, high, -1.0)
        pauses = cycle.dwell, cycle.fall_duration, cycle.rest
        course = around(drives.of_law(cycle.rise), fall, (high, low), pauses)
        falling = [(back + cycle.fall_duration * k, -b / cycle.fall_duration) for k, b in jumps(cycle.fall)]
        motion = cls(dynamics, outputs, course, jumps=[*jumps(cycle.rise), *falling], radians=radians)
        motion.panels  # noqa: B018 - what is in resonance is refused at once
        return motion

    @property
    def period(self) -> float:
        """The duration of the motion."""
        return self.drives[-1].start + self.drives[-1].length - self.drives[0].start

    def __getitem__(self, output: str) -> OutputCurve:
        """The curve of an output."""
        check_names([output], self.outputs, "output of the machine")
        return self._curves.setdefault(output, OutputCurve(self, output))

    def peak(self, output: str) -> Peak:
        """The greatest magnitude of an output, with its place."""
        return self[output].peak(0)

    def rise_peak(self, output: str) -> Peak:
        """The greatest magnitude of an output during the rise."""
        return self._greatest(output, (0.0, 1.0))

    def dwell_peak(self, output: str) -> Peak:
        """The greatest magnitude of an output after the rise.

        Raises
        ------
        InputError
            If the motion has no dwell.
        """
        if self.period <= 1.0 + SHORTEST_STRETCH:
            raise InputError("this response has no dwell: request one, machine.response(law, dwell=1.0)")
        return self._greatest(output, (1.0, self[output].interval[1]))

    def _greatest(self, output: str, within: tuple[float, float]) -> Peak:
        low, high = self[output].extrema(0, within)
        return high if high.value >= -low.value else Peak(-low.value, low.k)

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
        return pd.concat([self[name].to_pandas(count) for name in self.outputs], axis=1)

    def __repr__(self) -> str:
        start = self.drives[0].start
        return f"MachineMotion(outputs={list(self.outputs)}, from {start:g} to {start + self.period:g})"

    @kept_property
    def _curves(self) -> dict[str, OutputCurve]:
        return {}

    def series(self, output: str) -> list[Array]:
        """The series of an output on each panel."""
        return [trimmed(panel.output(*self.outputs[output])[:, 0]) for panel in self.panels]

    @kept_property
    def grid(self) -> tuple[Array, Array]:
        """Starts and lengths of the panels."""
        return np.array([panel.start for panel in self.panels]), np.array([panel.length for panel in self.panels])

    @kept_property
    def panels(self) -> list[Panel]:
        """The states of the machine, a column for each of the drives'."""
        if self.initial is not None:
            return self.dynamics.moved(self.drives, self.initial, radians=self.radians)[0]
        columns, size = self.drives[0].series.shape[2], len(self.dynamics.roots)
        before = self.drives[-1].ends[1][1]
        nothing = np.zeros((size, columns), dtype=np.complex128)
        still = [drives.rest(0.0, self.period, np.zeros(size))]
        forced = self.dynamics.moved(self.drives, nothing, radians=self.radians, before=before)[1]
        free = self.dynamics.moved(still, np.eye(size, dtype=np.complex128), radians=self.radians)[1]
        returned = np.eye(size) - free
        if np.linalg.svd(returned, compute_uv=False)[-1] < RESONANCE:
            raise InputError(
                "there is no steady motion: a vibration without damping is in resonance with a cycle of "
                f"{self.period:g} durations of the rise, or a state drifts; give damping or change the cycle"
            )
        initial: Complex = np.linalg.solve(returned, forced).astype(np.complex128)
        return self.dynamics.moved(self.drives, initial, radians=self.radians, before=before)[0]


def jumps(law: MotionLaw) -> list[tuple[float, float]]:
    """The places and sizes of jumps of a law's velocity inside its interval."""
    return list(law.jumps(1)) if isinstance(law, PiecewiseLaw) else []


def trimmed(series: Array) -> Array:
    """A series without the coefficients at its end that are rounding."""
    size = np.abs(series)
    counted = np.flatnonzero(size > EPSILON * size.max())
    return series[: counted[-1] + 1] if len(counted) else np.zeros(1)
