"""An elastic follower as a machine has it: frequency, speed and stroke with their units, answers in machine units."""

from __future__ import annotations

from dataclasses import dataclass
from math import tau
from typing import Any

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine.follower import Follower
from optlaws.mechanisms.machine.response import Response
from optlaws.motion.piece import factor, unit_of
from optlaws.motion.quantities import quantity, read_stroke
from optlaws.numbers import Quantity, positive

_WAYS = "give natural_frequency, such as '16.7 Hz', or natural_period, such as '60 ms', and not both"
_DURATIONS = "give duration, such as '0.1 s', or speed and rise, such as '105 rpm' and '120 deg'"


@dataclass(frozen=True)
class MachineFollower:
    """An elastic follower with the stroke and the duration of its rise, built by `machine_follower`.

    Attributes
    ----------
    follower
        The follower, dimensionless.
    stroke
        Stroke of the cam, in m or rad.
    duration
        Duration of the rise, s.
    unit
        That of the stroke, "m" or "rad".

    Examples
    --------
    >>> from optlaws import catalogue
    >>> press = machine_follower(
    ...     natural_frequency="16.7 Hz", speed="105 rpm", rise="120 deg", stroke="35 mm", damping=0.05
    ... )
    >>> press.follower
    Follower(frequency=19.986513, damping=0.05)
    >>> answer = press.response(catalogue["modified sine"])
    >>> round(answer.peak_acceleration, 3), round(1e3 * answer.residual_displacement, 3)  # m/s², mm
    (9.07, 0.51)
    """

    follower: Follower
    stroke: float
    duration: float
    unit: str = "m"

    def response(self, law: MotionLaw) -> MachineAnswer:
        """The response of the mass to a cam that moves by a law and rests afterwards, in machine units."""
        return MachineAnswer(self, self.follower.response(motion_law(law)))


@dataclass(frozen=True, repr=False)
class MachineAnswer:
    """The response of a machine's follower, in units of metres (or radians) and seconds.

    Attributes
    ----------
    machine
        The follower with its stroke and time.
    response
        The same, dimensionless: curves over k, and everything else.
    """

    machine: MachineFollower
    response: Response

    @property
    def dynamic_factor(self) -> float:
        """Greatest acceleration of the mass divided by the greatest acceleration of the cam."""
        return self.response.dynamic_factor()

    @property
    def peak_velocity(self) -> float:
        """Greatest speed of the mass in the rise."""
        return self._sized(self.response.peak(1).value, 1)

    @property
    def peak_acceleration(self) -> float:
        """Greatest acceleration of the mass in the rise."""
        return self._sized(self.response.peak(2).value, 2)

    @property
    def dwell_acceleration(self) -> float:
        """Greatest acceleration of the mass in the dwell."""
        return self._sized(self.response.dwell_peak(2).value, 2)

    @property
    def residual_displacement(self) -> float:
        """Amplitude of the vibration that is left in the dwell."""
        return self._sized(self.response.residual_displacement, 0)

    @property
    def residual_acceleration(self) -> float:
        """Amplitude of the residual vibration's acceleration."""
        return self._sized(self.response.residual_acceleration, 2)

    def results(self) -> dict[str, Any]:
        """Plain JSON-able dict, the units in the names.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> machine = machine_follower(natural_period="60 ms", duration="0.2 s", stroke="35 mm")
        >>> list(machine.response(smoothstep(4)).results())[:3]
        ['stroke, m', 'time, s', 'dynamic factor']
        """
        unit = self.machine.unit
        return {
            f"stroke, {unit}": self.machine.stroke,
            "time, s": self.machine.duration,
            "dynamic factor": self.dynamic_factor,
            f"peak velocity, {unit}/s": self.peak_velocity,
            f"peak acceleration, {unit}/s²": self.peak_acceleration,
            f"acceleration in the dwell, {unit}/s²": self.dwell_acceleration,
            f"residual displacement, {unit}": self.residual_displacement,
            f"residual acceleration, {unit}/s²": self.residual_acceleration,
        }

    def __repr__(self) -> str:
        unit = self.machine.unit
        return (
            f"MachineAnswer(frequency={self.response.frequency:g}, dynamic factor={self.dynamic_factor:g}, "
            f"peak acceleration={self.peak_acceleration:g} {unit}/s², "
            f"residual displacement={self.residual_displacement:g} {unit})"
        )

    def _sized(self, value: float, nu: int) -> float:
        return value * factor(self.machine.stroke, self.machine.duration, nu)


def machine_follower(
    *,
    stroke: Quantity,
    natural_frequency: Quantity | None = None,
    natural_period: Quantity | None = None,
    duration: Quantity | None = None,
    speed: Quantity | None = None,
    rise: Quantity | None = None,
    damping: float = 0.0,
) -> MachineFollower:
    """The elastic follower of a machine, from quantities with their units.

    Parameters
    ----------
    stroke
        Stroke of the cam, such as "35 mm" or "20 deg".
    natural_frequency, natural_period
        Of the undamped free vibration of the mass on its cam: "16.7 Hz", or "60 ms"; one of them.
    duration
        Duration of the rise, such as "0.1 s".
    speed, rise
        In place of it: speed of the cam, such as "105 rpm", and its angle during the rise, such as "120 deg".
    damping
        Ratio zeta of the damping to the critical one (dimensionless), between the mass and the ground.

    Raises
    ------
    InputError
        If a quantity is missing, given twice, out of range, or of another dimension.

    Examples
    --------
    >>> machine_follower(natural_frequency="16.7 Hz", speed="105 rpm", rise="120 deg", stroke="35 mm").duration
    0.190476
    >>> machine_follower(natural_frequency="16.7", duration="0.1 s", stroke="35 mm")
    Traceback (most recent call last):
    optlaws.errors.InputError: natural_frequency must be a frequency such as '16.7 Hz', got '16.7' without a unit: ...
    """
    kind, height = read_stroke(stroke)
    seconds = _duration(duration, speed, rise)
    frequency = tau * seconds * _natural_frequency(natural_frequency, natural_period)
    return MachineFollower(Follower(frequency, damping), height, seconds, unit_of(kind))


def _natural_frequency(frequency: Quantity | None, period: Quantity | None) -> float:
    if (frequency is None) == (period is None):
        raise InputError(_WAYS)
    if frequency is not None:
        return positive(quantity(frequency, "frequency", "natural_frequency"), "natural_frequency")
    return 1.0 / positive(quantity(period, "time", "natural_period"), "natural_period")


def _duration(duration: Quantity | None, speed: Quantity | None, rise: Quantity | None) -> float:
    if duration is not None and speed is None and rise is None:
        return positive(quantity(duration, "time", "duration"), "duration")
    if duration is not None or speed is None or rise is None:
        raise InputError(_DURATIONS)
    turning = positive(quantity(speed, "angular velocity", "speed"), "speed")
    return positive(quantity(rise, "angle", "rise"), "rise") / turning
