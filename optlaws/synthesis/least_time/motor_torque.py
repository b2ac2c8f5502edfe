"""Limits of the torque at a motor in a move whose time is sought: formulas of the law, which depend on the time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from math import inf
from typing import Any

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Listed, Number, ReadBy, Together
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import constant
from optlaws.laws import smoothstep
from optlaws.synthesis.functionals.makers import drive_torque, peak, rms
from optlaws.synthesis.least_time.move_limits import SpanLimit
from optlaws.synthesis.limits.drive_limits import limit_of_plane, phase_torque
from optlaws.synthesis.limits.phase_plane import PhasePlane, TorqueLimit
from optlaws.synthesis.problem.constants import Functional
from optlaws.tolerances import AGREEMENT

#: the name of the limit of a motor's curve
CURVE_LIMIT = "motor's curve"
#: a law that passes every position, in which a load over the position is as great as it ever is
_PASSING = smoothstep(2)
_MOST_LINES = 100

_NOT_NEGATIVE = Number(least=0.0)


@declared
class LossyGear(Declared, title="a gear with losses"):
    """A gear with losses, with the load J c + g b + Q on its motor side, and the load X behind it.

    The torque at the motor is J c + g b + Q + max(X/eta_1, X eta_2), in the units of the load behind the gear. A torque
    behind the gear is 1/eta_1 times as great before it, or eta_2 times, by the way of the power.
    """

    writes_defaults = True

    to_load: float = entry(Number(least=1.0), "1/eta_1.")
    back: float = entry(Number(above=0.0, most=1.0), "eta_2.")
    inertia: float = entry(_NOT_NEGATIVE, "J.", default=0.0)
    friction: float = entry(_NOT_NEGATIVE, "g.", default=0.0)
    load: float = entry(_NOT_NEGATIVE, "Q.", default=0.0)

    def text(self, load: str, duration: float) -> str:
        """T² times the torque at the motor, from T² times the load behind the gear."""
        return " + ".join([*self._motor(duration), f"max({', '.join(self._through(load))})"])

    def branches(self, load: str, duration: float) -> tuple[str, ...]:
        """The torque for power that flows to the load, and for power that flows back: the greater of both."""
        return tuple(" + ".join([*self._motor(duration), through]) for through in self._through(load))

    def _through(self, load: str) -> list[str]:
        return [f"{share!r}*({load})" for share in (self.to_load, self.back)]

    def _motor(self, duration: float) -> list[str]:
        sizes = self.inertia, self.friction * duration, self.load * duration * duration
        return [f"{size!r}{name}" for size, name in zip(sizes, ("*c", "*b", ""), strict=True) if size]


def _formula(value: Any) -> str:
    if not isinstance(value, str):
        raise InputError(f"it must be the text of a formula of a, got {shortened(value)}")
    read(value, ("a",))
    return value


_FORMULA = ReadBy(_formula, "a formula of a", json={"type": "string"})
_LINE = Together(Number(above=0.0), Number(), names=("torque", "fall"))


@declared
class MotorTorque(Declared, title="the torque of a move"):
    """The torque I(a) c + I'(a) b²/2 + f b + L(a) at the motor of a move that takes 1 s, and its limits.

    In the time T the inertia's part is that over T², the friction's that over T, and the load stays. Friction that does
    not depend on the speed is part of the load: laws never turn back. Behind a gear with losses it is the load alone.

    Raises
    ------
    InputError
        If a formula or a number is wrong, there is no limit, or the load alone is above it.

    >>> MotorTorque("1 + 0.3*a", 0.0, "0.2", unit=2.0, peak=3.0).along()[0].at(0.5)
    TimedLimit(name='torque', constant=peak((1 + 0.3*a)*c + 0.15*b^2 + 0.25*0.2), bound=0.375)
    """

    writes_defaults = True
    newer = ("gear", "curve")

    inertia: str = entry(_FORMULA, "I.")
    friction: float = entry(_NOT_NEGATIVE, "f, of the viscous friction.")
    load: str = entry(_FORMULA, "L.")
    unit: float = entry(Number(above=0.0), "Of the torque, N m.")
    peak: float | None = entry(Number(above=0.0), "The limit of its greatest magnitude, N m.", default=None)
    rms: float | None = entry(Number(above=0.0), "That of its root mean square over the move, N m.", default=None)
    gear: LossyGear | None = entry(ValueOf(LossyGear), "With losses, and the motor before it.", default=None)
    curve: tuple[tuple[float, float], ...] = entry(
        Listed(_LINE, most=_MOST_LINES),
        "Lines of the motor's curve: its torque is at most the first number less the second times b, N m.",
        default=(),
    )

    def _check(self) -> None:
        if not self.lines and self.rms is None:
            raise InputError("the torque of a move needs a limit: of its peak or its root mean square")
        most = min((torque for torque, _ in self.lines), default=inf)
        load = self.load if self.gear is None else replace(self.gear, inertia=0.0, friction=0.0).text(self.load, 1.0)
        known = constant(read(load, ("a",)))
        # in an infinitely slow motion
        static = self.unit * (abs(known) if known is not None else peak(load).value(_PASSING))
        if static >= most:
            raise InputError(
                f"the static torque at the motor reaches {static:.6g} N m, and the limit of the torque is "
                f"{most:.6g} N m: no time keeps it"
            )

    @property
    def lines(self) -> tuple[tuple[float, float], ...]:
        """The limit of the peak and the lines of the motor's curve: a torque at rest, and its decrease with b."""
        return (*(() if self.peak is None else ((self.peak, 0.0),)), *self.curve)

    def check_mean(self) -> None:
        """Refuse a limit of the root mean square that the mean alone exceeds, in however long a time."""
        load = constant(read(self.load, ("a",)))
        # a lower bound of the mean over a move
        mean = 0.0 if load is None or self._inertia is None or self.gear is not None else self.unit * max(load, 0.0)
        if self.rms is not None and mean >= self.rms:
            raise InputError(
                f"the torque at the motor is {mean:.6g} N m in the mean, and the limit of the RMS torque is "
                f"{self.rms:.6g} N m: no time keeps it"
            )

    @property
    def _inertia(self) -> float | None:
        return constant(read(self.inertia, ("a",)))

    @property
    def grows_possible(self) -> bool:
        """Whether a law that keeps the limits in a time keeps them in every longer time: docs/how-to/least-time.md."""
        load = constant(read(self.load, ("a",)))
        speedy = bool(self.friction or self.curve or (self.gear is not None and self.gear.friction))
        of_peak = not self.lines or not speedy or load is not None
        of_rms = self.rms is None or (self.gear is None and load is not None and (self.friction == 0.0 or load >= 0.0))
        return of_peak and of_rms and self._inertia is not None

    def brakes_with_load(self, greatest: float) -> bool:
        """Whether power flows back wherever the motor brakes as much as it may, up to a greatest velocity.

        So it is where the motor would take less to brake itself as the load X = 0 runs out. Limits of the torque of
        power that flows back are then those of the torque itself: docs/how-to/least-time.md.
        """
        if self.gear is None:
            return True
        load, inertia, gear = constant(read(self.load, ("a",))), self._inertia, self.gear
        if load is None or not inertia:
            return False
        at_rest, steep = (
            gear.inertia * of_load / inertia - of_motor
            for of_load, of_motor in ((load, gear.load), (self.friction, gear.friction))
        )
        speeds = [0.0] if greatest == inf else [0.0, greatest]
        return all(
            self.unit * (at_rest + steep * speed) < (most - fall * speed) * (1.0 - AGREEMENT)
            for most, fall in self.lines
            for speed in speeds
        ) and (greatest < inf or all(self.unit * steep + fall <= 0.0 for _, fall in self.lines))

    def text(self, duration: float) -> str:
        """T² times the torque in the time T, in its unit: so the inertia's part does not depend on T."""
        load = self._behind(duration)
        return load if self.gear is None else self.gear.text(load, duration)

    def _behind(self, duration: float) -> str:
        # the torque of the load behind a gear with losses, or of the whole drive without one
        load = read(self.load, ("a",))
        weighed = "0" if constant(load) == 0.0 else f"{duration * duration!r}*({self.load})"
        return drive_torque(inertia=self.inertia, friction=repr(self.friction * duration), load=weighed)

    def along(self) -> tuple[SpanLimit, ...]:
        """The limits over the time: bounds of T² times the torque, and of its share of the curve.

        Braking behind a gear with losses is limited as if power always flowed back, which is no less.
        """

        def limit(name: str, most: float, highest: Callable[[float], Functional]) -> SpanLimit:
            return SpanLimit(name, most, lambda time: (highest(time), most * (time * time / self.unit)))

        def of_peak(time: float) -> Functional:
            return peak(self.text(time)) if self.gear is None else self._greatest([(1.0, 0.0)], time)

        limits = [] if self.peak is None else [limit("torque", self.peak, of_peak)]
        if self.curve:
            limits.append(limit(CURVE_LIMIT, 1.0, lambda time: self._greatest(self.curve, time)))
        if self.rms is not None:
            limits.append(limit("rms torque", self.rms, lambda time: rms(self.text(time))))
        return tuple(limits)

    def _greatest(self, lines: Sequence[tuple[float, float]], duration: float) -> Functional:
        behind = self._behind(duration)
        driving = (behind,) if self.gear is None else self.gear.branches(behind, duration)
        shares = [
            f"{sign / most!r}*({torque})" + (f" + {fall * duration / (most * self.unit)!r}*b" if fall else "")
            for most, fall in lines
            for sign, torque in (*((1.0, each) for each in driving), (-1.0, driving[-1]))
        ]
        return peak(f"max({', '.join(shares)})", side="high")

    def limit(self, velocity: float, acceleration: float) -> float | None:
        """The time in the phase plane that no law which never turns back is faster than; None where nothing is known.

        The velocity and the acceleration of a law with the stroke 1 are at most these, of both ways.
        """
        # of a line that rises the greatest torque alone is left
        lines = tuple((most / self.unit, fall / self.unit) for most, fall in self.lines if fall >= 0.0)
        return _in_phase_plane(self.text(1.0), velocity, acceleration, lines) if lines else None


@lru_cache(maxsize=64)
def _in_phase_plane(
    torque: str, velocity: float, acceleration: float, lines: tuple[tuple[float, float], ...]
) -> float | None:
    try:
        form = phase_torque(torque)
        limits = tuple(
            TorqueLimit(form.scaled(1.0 / form.size), most / form.size, fall / form.size) for most, fall in lines
        )
        return limit_of_plane(PhasePlane(limits=limits, B=velocity, C=acceleration), "time", form.size).value
    except (InputError, InfeasibleProblem, SolverFailure):
        return None
