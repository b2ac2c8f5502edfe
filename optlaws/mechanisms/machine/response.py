"""Response of a follower's mass: after one rise with its dwell, and over a cycle that repeats."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, atanh, hypot, inf, pi, sqrt
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, Peak
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine import drives
from optlaws.mechanisms.machine.over_time import MachineMotion, PanelCurve, RiseReturnCycle
from optlaws.mechanisms.machine.state_space import Dynamics, OutputRows
from optlaws.motion.piece import factor, unit_of
from optlaws.motion.quantities import quantity, read_stroke
from optlaws.numbers import Array, NumberOrQuantity, Quantity, derivative, positive, real_times

_STIFF = 8.0  # radians in the rise: slower vibrations are slower than most laws
_RADIANS = 40.0  # of a vibration in a panel: roots of a few long series take less time than those of many short ones


@dataclass(frozen=True)
class Oscillator:
    """The equation of a follower: frequency nu in radians in the rise's duration, ratio zeta = n/nu.

    >>> Oscillator(5.0, 0.6).damped, Oscillator(5.0, 1.25).damped
    (4.0, 0.0)
    """

    frequency: float
    damping: float

    @property
    def n(self) -> float:
        return self.damping * self.frequency

    @kept_property
    def damped(self) -> float:
        """lambda = nu sqrt(1 - zeta²) below critical damping, else 0."""
        return self.frequency * sqrt(max(0.0, (1.0 - self.damping) * (1.0 + self.damping)))

    @kept_property
    def _spread(self) -> float:
        return self.frequency * sqrt(max(0.0, (self.damping - 1.0) * (1.0 + self.damping)))

    def even_odd(self, s: Array) -> tuple[Array, Array]:
        """exp(-n s) cos(lambda s) and exp(-n s) sin(lambda s) / lambda, or what becomes of them past critical."""
        if self.damping <= 1.0:
            decay, phase = np.exp(-self.n * s), self.damped * s
            return decay * np.cos(phase), decay * s * np.sinc(phase / pi)
        twice = 2.0 * self._spread * s
        slow = np.exp(-(self.frequency**2) / (self.n + self._spread) * s)
        safe = np.where(twice == 0.0, 1.0, twice)
        ratio = np.where(twice == 0.0, 1.0, -np.expm1(-safe) / safe)
        return 0.5 * slow * (1.0 + np.exp(-twice)), slow * s * ratio

    def motion(self, h0: float, v0: float, s: Array, nu: int) -> Array:
        """Derivative of order `nu` at s of the vibration with displacement h0 and velocity v0 at s = 0."""
        h0, v0 = self._derived(h0, v0, nu)
        even, odd = self.even_odd(s)
        return h0 * even + (v0 + self.n * h0) * odd

    def _derived(self, h0: float, v0: float, nu: int) -> tuple[float, float]:
        for _ in range(nu):
            h0, v0 = v0, -2.0 * self.n * v0 - self.frequency**2 * h0
        return h0, v0

    def amplitude(self, h0: float, v0: float) -> float:
        """Amplitude of the envelope at s = 0 below critical damping (1.21); else the greatest |h| from s = 0 on."""
        if self.damped > 0.0:
            return hypot(h0, (v0 + self.n * h0) / self.damped)
        return self.peak(h0, v0, 0).value

    def peak(self, h0: float, v0: float, nu: int) -> Peak:
        """Greatest magnitude of the derivative of order `nu` from s = 0 on, and its place s."""
        h0, v0 = self._derived(h0, v0, nu)
        places = np.array([0.0, self._first_stop(h0, v0)])
        size = np.abs(self.motion(h0, v0, places, 0))
        best = int(np.argmax(size))
        return Peak(float(size[best]), float(places[best]))

    def _first_stop(self, h0: float, v0: float) -> float:
        """The first s > 0 of zero velocity; 0 without such an s."""
        pull = self.n * v0 + self.frequency**2 * h0
        if self.damped > 0.0:
            angle = atan2(self.damped * v0, pull) if pull else 0.5 * pi
            return (angle % pi) / self.damped
        if pull == 0.0 or v0 / pull <= 0.0:
            return 0.0
        if self._spread == 0.0:
            return v0 / pull
        ratio = self._spread * v0 / pull
        return atanh(ratio) / self._spread if ratio < 1.0 else 0.0

    @kept_property
    def lag(self) -> float:
        """The time by which damping makes a stiff mass lag its cam, 2 n/nu²; 0 of a soft one, which hardly follows."""
        return 2.0 * self.n / self.frequency**2 if self.frequency > _STIFF else 0.0

    @kept_property
    def on_cam(self) -> Dynamics:
        """The motion on a cam, by the states a_m - (a - lag b) and a_m' - b.

        They are as small as the acceleration of the mass, whatever the damping: displacements of cam and mass would
        cancel nu² times their rounding, and a_m - a and b n times theirs.
        """
        left = 0.0 if self.lag else -2.0 * self.n
        matrix = np.array([[0.0, 1.0], [-(self.frequency**2), -2.0 * self.n]])
        return Dynamics(matrix, np.array([[0.0, 0.0, self.lag], [0.0, left, -1.0]]))

    @property
    def rows(self) -> dict[str, OutputRows]:
        """Rows that take the states on a cam, and a, b and c, to a_m, its velocity, acceleration and jerk."""
        square, twice = self.frequency**2, 2.0 * self.n
        left = 0.0 if self.lag else -twice
        acceleration = np.array([-square, -twice, 0.0, left, 0.0])
        jerk = np.array([0.0, -square, 0.0, 0.0, 0.0]) - twice * acceleration
        displacement, velocity = np.array([[1.0, 0.0, 1.0, -self.lag, 0.0], [0.0, 1.0, 0.0, 1.0, 0.0]])
        rows = {"a": displacement, "b": velocity, "c": acceleration, "j": jerk}
        return {letter: (row[:2] @ self.on_cam.out_of, row[2:]) for letter, row in rows.items()}


def duration_of_rise(duration: Quantity | None, speed: NumberOrQuantity | None, rise: NumberOrQuantity | None) -> float:
    """The duration of a rise in s, from itself or from the speed of the cam and its angle during the rise."""
    if duration is not None and speed is None and rise is None:
        return positive(quantity(duration, "time", "duration"), "duration")
    if duration is not None or speed is None or rise is None:
        raise InputError("give duration, such as '0.1 s', or speed and rise, such as '105 rpm' and '120 deg'")
    turning = positive(quantity(speed, "angular velocity", "speed"), "speed")
    return positive(quantity(rise, "angle", "rise"), "rise") / turning


@dataclass(frozen=True, repr=False)
class MassMotion(PanelCurve):
    """Displacement a_m of the mass with its derivatives, dimensionless like a law; k in durations of the rise.

    `frequency` and `damping` are those of the follower.
    """

    frequency: float
    damping: float

    @kept_property
    def _oscillator(self) -> Oscillator:
        return Oscillator(self.frequency, self.damping)

    @kept_property
    def _series(self) -> dict[int, list[Array]]:
        return {nu: self._motion.series(letter) for nu, letter in enumerate(self._motion.outputs)}

    @property
    def _breaks(self) -> tuple[float, ...]:
        return (*(stretch.start for stretch in self._motion.drives), self.interval[1])

    def _before_breaks(self, nu: int) -> Array:
        return self._before_panels(nu)[np.searchsorted(self._motion.grid[0], self._breaks[1:-1]) - 1]

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
    law
        Motion of the cam.
    initial
        Displacement and velocity of the mass at k = 0.

    Examples
    --------
    >>> from optlaws import Follower, savin
    >>> response = Follower(frequency=18).response(savin("III", 7.2))
    >>> response.dynamic_factor(), response.residual_acceleration
    (2.035976, 7.204401)
    """

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
        >>> from optlaws import Follower, smoothstep
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
        speed: NumberOrQuantity | None = None,
        rise: NumberOrQuantity | None = None,
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
        >>> from optlaws import Follower, smoothstep
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
    def _motion(self) -> MachineMotion:
        oscillator, cam = self._oscillator, drives.of_law(self.law)
        off = np.array([[self.initial[0] - float(self.law.a(0.0))], [self.initial[1]]])
        dynamics = oscillator.on_cam
        return MachineMotion(dynamics, oscillator.rows, cam, dynamics.into @ off, radians=_RADIANS)

    @kept_property
    def _off(self) -> tuple[float, float]:
        """Displacement and velocity at k = 1 relative to the dwell, where the cam stands still."""
        oscillator, motion = self._oscillator, self._motion
        (end,) = (oscillator.on_cam.out_of @ motion.panels[-1].states.sum(axis=0)).real.T
        velocity = float(motion.drives[-1].ends[1][1, 0])
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
    those of the whole cycle. `rise` and `fall` are its laws; `dwell`, `fall_duration` and `rest` follow the rise.

    Examples
    --------
    >>> from optlaws import Follower, smoothstep
    >>> Follower(frequency=20, damping=0.05).cycle(smoothstep(4), dwell=0.5, rest=1.0)
    CycleResponse(frequency=20, damping=0.05, period=3.5, peak acceleration=11.018)
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        self._motion  # noqa: B018 - a cycle in resonance is refused at once

    @property
    def interval(self) -> tuple[float, float]:
        return 0.0, self.period

    def __repr__(self) -> str:
        return (
            f"CycleResponse(frequency={self.frequency:g}, damping={self.damping:g}, period={self.period:g}, "
            f"peak acceleration={self.peak(2).value:g})"
        )

    @kept_property
    def _motion(self) -> MachineMotion:
        return MachineMotion.of_cycle(self._oscillator.on_cam, self._oscillator.rows, self, _RADIANS)

    def _derivative(self, k: Array, nu: int) -> Array:
        return super()._derivative(np.mod(k, self.period), nu)
