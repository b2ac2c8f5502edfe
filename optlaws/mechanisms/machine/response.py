"""Response of a follower's mass: after one rise with its dwell, and over a cycle that repeats."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, Peak
from optlaws.laws.law import motion_law
from optlaws.mechanisms.forcing import RiseReturnCycle
from optlaws.mechanisms.machine import drives
from optlaws.mechanisms.machine.dynamics import DriveStretch, Panel
from optlaws.mechanisms.machine.over_time import PanelCurve, grid, steady, trimmed
from optlaws.mechanisms.machine.vibration import Oscillator
from optlaws.motion.piece import factor, unit_of
from optlaws.motion.quantities import quantity, read_stroke
from optlaws.numbers import Array, Complex, Quantity, derivative, positive, real_times

_RADIANS = 40.0  # of a vibration in a panel: roots of a few long series take less time than those of many short ones


def duration_of_rise(duration: Quantity | None, speed: Quantity | None, rise: Quantity | None) -> float:
    """The duration of a rise in s, from itself or from the speed of the cam and its angle during the rise."""
    if duration is not None and speed is None and rise is None:
        return positive(quantity(duration, "time", "duration"), "duration")
    if duration is not None or speed is None or rise is None:
        raise InputError("give duration, such as '0.1 s', or speed and rise, such as '105 rpm' and '120 deg'")
    turning = positive(quantity(speed, "angular velocity", "speed"), "speed")
    return positive(quantity(rise, "angle", "rise"), "rise") / turning


class MassMotion(PanelCurve):
    """Displacement a_m of the mass with its derivatives, dimensionless like a law; k in durations of the rise.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> from optlaws import Follower
    >>> motion = Follower(frequency=20, damping=0.05).cycle(smoothstep(4), dwell=0.5, rest=1.0)
    >>> isinstance(motion, MassMotion), motion.interval
    (True, (0.0, 3.5))
    """

    @property
    @abstractmethod
    def _oscillator(self) -> Oscillator:
        """The equation of the mass."""

    @property
    @abstractmethod
    def _cam(self) -> list[DriveStretch]:
        """The motion of the cam over the interval."""

    @property
    @abstractmethod
    def _panels(self) -> list[Panel]:
        """The states of the mass on its cam."""

    @kept_property
    def _grid(self) -> tuple[Array, Array]:
        return grid(self._panels)

    @kept_property
    def _series(self) -> dict[int, list[Array]]:
        oscillator = self._oscillator
        rows = [(row[:2] @ oscillator.on_cam.out_of, row[2:]) for row in oscillator.orders]
        return {
            nu: [trimmed(panel.output(states, direct)[:, 0]) for panel in self._panels]
            for nu, (states, direct) in enumerate(rows)
        }

    @property
    def _breaks(self) -> tuple[float, ...]:
        return (*(stretch.start for stretch in self._cam), self.interval[1])

    def _before_breaks(self, nu: int) -> Array:
        return self._before_panels(nu)[np.searchsorted(self._grid[0], self._breaks[1:-1]) - 1]

    def _repr_html_(self) -> str:
        from optlaws.laws.report import law_panels
        from optlaws.shown.report import panel_drawing
        from optlaws.shown.showing import page

        return page(repr(self), *map(panel_drawing, law_panels(self)))

    def _times(self, k: Any) -> Array:
        return real_times(k)


@dataclass(frozen=True, repr=False)
class Response(MassMotion):
    """Motion of the mass during the rise, 0 <= k <= 1, and in the dwell after it, k > 1; computed by a `Follower`.

    Call it like a law: ``response(k, nu=2)``, ``response.c(k)``. Its interval is the rise: `peak`, `extrema`,
    `power_peak`, `rms` and `samples` look at its whole length, `dwell_peak` at all that follows.

    Parameters
    ----------
    frequency, damping
        The follower's frequency and damping ratio.
    law
        Motion of the cam.
    initial
        Displacement and velocity of the mass at k = 0.

    Examples
    --------
    >>> from optlaws import savin
    >>> from optlaws import Follower
    >>> response = Follower(frequency=18).response(savin("III", 7.2))
    >>> response.dynamic_factor(), response.residual_acceleration
    (2.035976, 7.204401)
    """

    frequency: float
    damping: float
    law: MotionLaw
    initial: tuple[float, float]

    def dynamic_factor(self, reference: MotionLaw | None = None, *, dwell: bool = False) -> float:
        """Greatest acceleration of the mass over a law's peak acceleration, max |a_m''| / C.

        Parameters
        ----------
        reference
            The law whose C counts: that of the mass; the cam's own unless given.
        dwell
            Look at the dwell as well as at the rise.

        Raises
        ------
        InputError
            If C of the reference is zero or infinite.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> from optlaws import Follower
        >>> Follower(frequency=200).response(smoothstep(4)).dynamic_factor()
        1.003417
        """
        law = self.law if reference is None else motion_law(reference, "reference")
        C = law.constants.C.value
        if not 0.0 < C < inf:
            raise InputError(
                f"reference must have a finite C above 0 to compare with, got {shortened(law)}; name another law"
            )
        highest = self.peak(2).value
        return (max(highest, self.dwell_peak(2).value) if dwell else highest) / C

    def in_units(
        self,
        stroke: Quantity,
        *,
        duration: Quantity | None = None,
        speed: Quantity | None = None,
        rise: Quantity | None = None,
    ) -> dict[str, float]:
        """Peaks and vibration in m or rad and seconds, by names with their units.

        Parameters
        ----------
        stroke
            Stroke of the cam, such as "35 mm" or "20 deg".
        duration
            Duration of the rise, such as "0.1 s".
        speed, rise
            In place of it: speed of the cam, such as "105 rpm", and its angle during the rise, such as "120 deg".

        Raises
        ------
        InputError
            If a quantity is missing, given twice, out of range, or of another dimension.

        Examples
        --------
        >>> from optlaws import Follower, catalogue
        >>> times = {"speed": "105 rpm", "rise": "120 deg"}
        >>> press = Follower.from_vibration("16.7 Hz", **times, damping=0.05)
        >>> answers = press.response(catalogue["modified sine"]).in_units("35 mm", **times)
        >>> answers["peak acceleration, m/s²"], answers["residual displacement, m"]
        (9.070342, 0.000510)
        """
        axis, height = read_stroke(stroke)
        time = duration_of_rise(duration, speed, rise)
        sizes: dict[str, tuple[float, int]] = {
            "peak velocity": (self.peak(1).value, 1),
            "peak acceleration": (self.peak(2).value, 2),
            "acceleration in the dwell": (self.dwell_peak(2).value, 2),
            "residual displacement": (self.residual_displacement, 0),
            "residual acceleration": (self.residual_acceleration, 2),
        }
        return {f"stroke, {unit_of(axis)}": height, "time, s": time, "dynamic factor": self.dynamic_factor()} | {
            f"{name}, {unit_of(axis, nu)}": value * factor(height, time, nu) for name, (value, nu) in sizes.items()
        }

    @property
    def residual_displacement(self) -> float:
        """Amplitude of the free vibration at k = 1, its envelope if damped (1.21).

        At and above critical damping nothing vibrates, and this is the greatest deviation from rest in the dwell.
        """
        return self._oscillator.amplitude(*self._off)

    @property
    def residual_acceleration(self) -> float:
        """nu² times the residual displacement: without damping, the amplitude of a_m'' in the dwell."""
        return self.frequency**2 * self.residual_displacement

    @property
    def final(self) -> tuple[float, float]:
        """Displacement and velocity of the mass at k = 1."""
        return float(self.a(1.0)), float(self.b(1.0))

    def dwell_peak(self, nu: int) -> Peak:
        """Greatest magnitude from k = 1 on of the derivative of order `nu`, for nu = 0 of the deviation from rest.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> from optlaws import Follower
        >>> Follower(frequency=20, damping=0.05).response(smoothstep(4)).dwell_peak(2)
        Peak(value=1.620669, k=1.016776)
        """
        peak = self._oscillator.peak(*self._off, derivative(nu))
        return Peak(peak.value, 1.0 + peak.k)

    def __repr__(self) -> str:
        return (
            f"Response(frequency={self.frequency:g}, damping={self.damping:g}, "
            f"peak acceleration={self.peak(2).value:g}, residual acceleration={self.residual_acceleration:g})"
        )

    @kept_property
    def _oscillator(self) -> Oscillator:
        return Oscillator(self.frequency, self.damping)

    @kept_property
    def _cam(self) -> list[DriveStretch]:
        return drives.of_law(self.law)

    @kept_property
    def _moved(self) -> tuple[list[Panel], Complex]:
        dynamics = self._oscillator.on_cam
        off = np.array([[self.initial[0] - float(self.law.a(0.0))], [self.initial[1]]])
        return dynamics.moved(self._cam, dynamics.into @ off, radians=_RADIANS)

    @property
    def _panels(self) -> list[Panel]:
        return self._moved[0]

    @kept_property
    def _off(self) -> tuple[float, float]:
        """Displacement and velocity at k = 1 relative to the dwell, where the cam stands still."""
        oscillator = self._oscillator
        (end,) = (oscillator.on_cam.out_of @ self._moved[1]).real.T
        velocity = float(self._cam[-1].ends[1][1, 0])
        return float(end[0]) - oscillator.lag * velocity, float(end[1]) + velocity

    def _times(self, k: Any) -> Array:
        times = super()._times(k)
        if (times < 0.0).any():
            raise InputError(f"k must be at least 0, got {float(times.min())!r}")
        return times

    def _derivative(self, k: Array, nu: int) -> Array:
        values = super()._derivative(np.minimum(k, 1.0), nu)
        after = k > 1.0
        if after.any():
            free = self._oscillator.motion(*self._off, k[after] - 1.0, nu)
            values[after] = free + (float(self.law.a(1.0)) if nu == 0 else 0.0)
        return values


@dataclass(frozen=True, repr=False)
class CycleResponse(RiseReturnCycle, MassMotion):
    """Periodic motion of the mass under a periodic cam; computed by `Follower.cycle`.

    Call it like a law, at any k; time is in durations of the rise. Peaks, extrema, root mean squares and samples are
    those of the whole cycle.

    Parameters
    ----------
    frequency, damping
        The follower's frequency and damping ratio.
    rise, fall
        Laws of the rise and of the return.
    dwell, fall_duration, rest
        Durations of what follows the rise, in durations of the rise.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> from optlaws import Follower
    >>> Follower(frequency=20, damping=0.05).cycle(smoothstep(4), dwell=0.5, rest=1.0)
    CycleResponse(frequency=20, damping=0.05, period=3.5, peak acceleration=11.018)
    """

    frequency: float
    damping: float
    rise: MotionLaw
    fall: MotionLaw
    dwell: float
    fall_duration: float
    rest: float

    def __post_init__(self) -> None:
        super().__post_init__()
        self._panels  # noqa: B018 - a cycle in resonance is refused at once

    @property
    def interval(self) -> tuple[float, float]:
        """The times at which the cycle begins and ends."""
        return 0.0, self.period

    def __repr__(self) -> str:
        return (
            f"CycleResponse(frequency={self.frequency:g}, damping={self.damping:g}, period={self.period:g}, "
            f"peak acceleration={self.peak(2).value:g})"
        )

    @kept_property
    def _oscillator(self) -> Oscillator:
        return Oscillator(self.frequency, self.damping)

    @kept_property
    def _cam(self) -> list[DriveStretch]:
        return self._course(drives.of_law, drives.rest)

    @kept_property
    def _panels(self) -> list[Panel]:
        return steady(self._oscillator.on_cam, self._cam, _RADIANS)

    def _derivative(self, k: Array, nu: int) -> Array:
        return super()._derivative(np.mod(k, self.period), nu)
