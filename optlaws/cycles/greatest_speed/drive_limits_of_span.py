"""Limits of force, torque and power of a span as shares of what is allowed, at any scale of its time.

Run `scale` times slower, a motion takes what it takes at rest in its positions, the static force F_0, and the rest of
its force divided by the square of the scale. With u = 1/scale² that is (1 - u) F_0 + u F: between two forces that keep
the limit, where the static one does. With viscous friction, and of power beside a static force, this does not follow.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, inf, log

from optlaws.cycles.greatest_speed.scaling import slower
from optlaws.cycles.optimisation.drive_formulas import driven_peak
from optlaws.cycles.optimisation.motion_limits import FORCE, in_units
from optlaws.cycles.specification.drive import CycleDrive
from optlaws.cycles.specification.joints import LawSpan
from optlaws.cycles.specification.position_drive import PositionDrive
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.laws import MotionLaw
from optlaws.motion.quantities import in_small_units
from optlaws.synthesis.problem.constants import Functional
from optlaws.tolerances import AGREEMENT, DURATION_STEP, SAME_TIME

_PLACES = 65  # at which the static torque of a mechanism is looked at
_SLOWEST = 2.0**40


@dataclass(frozen=True)
class DrivenLimit:
    """A limit of force or torque (-1) or of power (-3) along a span's law."""

    key: int
    most: float
    span: LawSpan
    drive: CycleDrive | PositionDrive
    stroke: float

    @property
    def scales(self) -> bool:
        """Whether a law that keeps it keeps it at every lower speed."""
        if isinstance(self.drive, PositionDrive):
            return False
        static = any((self.drive.stiffness, self.drive.constant, self.drive.dry))
        return self.drive.viscous == 0.0 and (self.key == FORCE or not static)

    def term(self, scale: float) -> tuple[Functional, float]:
        """The peak of the force or power of the law at a scale of the time, and the share that one of it is."""
        driven = driven_peak(slower(self.span, scale), self.drive, self.stroke, self.key)
        return driven.constants[0], driven.unit / self.most

    def share(self, law: MotionLaw, scale: float) -> float:
        """What a law takes of the limit at a scale of the time."""
        constant, weight = self.term(scale)
        return constant.value(law) * weight

    def slope(self, law: MotionLaw, scale: float) -> float:
        """By which power of the scale the share of a law falls, by differences."""
        before, after = (self.share(law, scale * (1.0 + sign * DURATION_STEP)) for sign in (-1.0, 1.0))
        return max(0.0, log(before / after) / log((1.0 + DURATION_STEP) / (1.0 - DURATION_STEP)))

    def least_scale(self, law: MotionLaw) -> float:
        """The least scale from which on a law keeps it; infinite where it keeps it at none."""
        from scipy.optimize import brentq

        high = 1.0
        while self.share(law, high) > 1.0:
            high *= 2.0
            if high > _SLOWEST:
                return inf
        low = 0.5 * high
        while self.share(law, low) <= 1.0:
            low, high = 0.5 * low, low
        root = brentq(
            lambda place: log(self.share(law, exp(place))), log(low), log(high), xtol=SAME_TIME, rtol=SAME_TIME
        )
        return exp(float(root))


def driven_limit(
    key: int, most: float, span: LawSpan, drive: CycleDrive | PositionDrive, stroke: float, axis: str
) -> DrivenLimit:
    """A limit of the drive along a span.

    Raises
    ------
    InputError
        If a gear loses power, so that the torque is the greater of two.
    InfeasibleProblem
        If the static force is beyond it, so that no speed keeps it.
    """
    if isinstance(drive, PositionDrive) and drive.loses:
        raise InputError(
            f"{span.where}: the greatest speed behind a gear with losses is not sought: give an efficiency of 1 and "
            "limits that leave room for what the gear loses"
        )
    if key == FORCE:
        position, force = static_force(span, drive)
        if force > most * (1.0 + AGREEMENT):
            taken, allowed = (in_units(FORCE, value, axis) for value in (force, most))
            raise InfeasibleProblem(
                f"{span.where}: at {in_small_units(position, axis)} what is static takes {taken}, so that no speed "
                f"keeps {allowed}: allow more, or change the drive's spring, preload, gravity or friction"
            )
    return DrivenLimit(key, most, span, drive, stroke)


def static_force(span: LawSpan, drive: CycleDrive | PositionDrive) -> tuple[float, float]:
    """Where a motion takes most force at the slowest speed, and how much: of spring, weight and dry friction."""
    direction = -1.0 if span.displacement < 0.0 else 1.0
    ends = [span.offset, *(position for _, position in span.via), span.offset + span.displacement]
    if isinstance(drive, PositionDrive):
        ends = [span.offset + span.displacement * i / (_PLACES - 1) for i in range(_PLACES)]
    forces = [(abs(drive.at_joint((position, 0.0, 0.0), direction, span.start)), position) for position in ends]
    force, position = max(forces)
    return position, force
