"""Objectives of a move of given time: a rate of its motion, its motor's effort, or its residual vibration."""

from __future__ import annotations

from dataclasses import replace

from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Choice, Number
from optlaws.errors import InputError
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import constant
from optlaws.synthesis.functionals.makers import integral, peak, rms
from optlaws.synthesis.least_time.follower_residual import RESIDUAL, FollowerResidual
from optlaws.synthesis.least_time.motor_torque import MotorTorque
from optlaws.synthesis.least_time.move_limits import TimedLimit, power
from optlaws.synthesis.least_time.timed_move import TimedMove
from optlaws.synthesis.problem.constants import B, C, Functional, J, rms_c, rms_j, rms_snap, snap
from optlaws.synthesis.problem.problem import Problem

#: of the motion: the order of the derivative, and the constant of the law
RATES: dict[str, tuple[int, Functional]] = {
    "velocity": (1, B),
    "acceleration": (2, C),
    "jerk": (3, J),
    "snap": (4, snap),
    "rms acceleration": (2, rms_c),
    "rms jerk": (3, rms_j),
    "rms snap": (4, rms_snap),
}
#: at a motor, with the unit
AT_MOTOR = {"torque": "N m", "rms torque": "N m", "energy": "J"}
#: what is left vibrating in a follower
OBJECTIVES = (*RATES, *AT_MOTOR, RESIDUAL)
_SMOOTH = 3


@declared
class MoveObjective(Declared, title="what is least in a move"):
    """An objective of a move of given time.

    Raises
    ------
    InputError
        If the name is unknown, or there is not what it needs and nothing else.

    >>> MoveObjective("acceleration").in_time(0.2, stroke=0.1)
    TimedLimit(name='acceleration', constant=C, bound=0.4)
    """

    writes_defaults = True

    name: str = entry(Choice(*OBJECTIVES), "What is least.")
    torque: MotorTorque | None = entry(
        ValueOf(MotorTorque), "At the motor; its limit is 1 N m and says nothing.", default=None
    )
    way: float | None = entry(Number(above=0.0), "Of an energy: how far the motor turns, rad.", default=None)
    regeneration: float = entry(
        Number(least=0.0, most=1.0), "Of an energy: the share of the braking energy that is fed back.", default=0.0
    )
    residual: FollowerResidual | None = entry(
        ValueOf(FollowerResidual), "What is left vibrating; its limit is 1 and says nothing.", default=None
    )

    def _check(self) -> None:
        needs = (self.name in AT_MOTOR, self.name == "energy", self.name == RESIDUAL)
        if needs != (self.torque is not None, self.way is not None, self.residual is not None):
            raise InputError(f"{self.named}: the {self.name} needs its motor or its follower, and nothing else")
        if self.torque is not None and (self.torque.peak, self.torque.rms) != (None, 1.0):
            raise InputError(f"{self.named}: its torque has the limit 1 N m of its root mean square alone")
        if self.residual is not None and self.residual.most != 1.0:
            raise InputError(f"{self.named}: its residual has the limit 1")
        if self.regeneration and self.way is None:
            raise InputError(f"{self.named}: regeneration is a share of an energy, got {self.regeneration!r}")

    def in_time(self, duration: float, stroke: float) -> TimedLimit:
        """The constant of the law that is minimised, and its unit in SI."""
        if self.name in RATES:
            nu, of = RATES[self.name]
            return TimedLimit(self.name, of, power(duration, nu) / stroke)
        if self.residual is not None:
            return self.residual.limit_in(duration, stroke)
        assert self.torque is not None  # noqa: S101 - as was checked
        text, unit = self.torque.text(duration), duration * duration / self.torque.unit
        if self.way is None:
            return TimedLimit(self.name, (rms if self.name == "rms torque" else peak)(text), unit)
        taken = f"({text})*b"
        braked = f"{self.regeneration!r}*{taken}" if self.regeneration else "0"
        energy = taken if self.regeneration == 1.0 else f"max({taken}, {braked})"
        return TimedLimit(self.name, integral(energy), unit / self.way)

    def problem(self, move: TimedMove, duration: float) -> Problem:
        """The problem of the laws that keep the limits of a move in a time, with what is least in it."""
        return replace(move.within(duration), minimise=self.in_time(duration, move.stroke).constant)

    @property
    def nu(self) -> int:
        """A law takes this power of s less where it is played s times as long, at least; 0 of torques and energy."""
        return RATES[self.name][0] if self.name in RATES else 0

    def falls(self, move: TimedMove) -> bool:
        """Whether a longer time never needs more: docs/theory/least-time.md."""
        if not move.at_rest or move.residual is not None or self.residual is not None:
            return False
        if move.torque is not None and not move.torque.grows_possible:
            return False
        if self.torque is None:
            return True
        inertia, load = (constant(read(text, ("a",))) for text in (self.torque.inertia, self.torque.load))
        if inertia is None or load is None or self.torque.gear is not None:
            return False
        if self.name == "torque":
            return self.torque.friction == 0.0 or load >= 0.0 or move.problem.order >= _SMOOTH
        return self.torque.friction == 0.0 or load >= 0.0
