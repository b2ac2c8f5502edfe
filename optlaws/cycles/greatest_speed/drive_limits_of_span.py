"""Limits of force, torque and power of a span as shares of what is allowed, at any scale of its time.

Run `scale` times slower, a motion takes what it takes at rest in its positions, the static force F_0, and the rest of
its force divided by the square of the scale. With u = 1/scale² that is (1 - u) F_0 + u F: between two forces that keep
the limit, where the static one does. With viscous friction, below a motor's curve and of power this follows between
rests where inertia and static force are constant: docs/theory/cycles.md.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import exp, inf, log

from optlaws.cycles.greatest_speed.scaling import slower
from optlaws.cycles.optimisation.drive_formulas import Driven, driven_peak
from optlaws.cycles.optimisation.motion_limits import CURVE, FORCE, POWER, in_units
from optlaws.cycles.optimisation.motor_limits import driven_curve, torque_at_rest
from optlaws.cycles.specification.joints import LawSpan
from optlaws.errors import InfeasibleProblem
from optlaws.formulas.tree import Number
from optlaws.laws import MotionLaw
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.quantities import in_small_units
from optlaws.sentences import sentence
from optlaws.synthesis.problem.constants import Functional
from optlaws.tolerances import AGREEMENT, DURATION_STEP, LEAST_SHARE, SAME_TIME

_PLACES = 65  # at which the static torque of a mechanism is looked at
_SLOWEST = 2.0**40


@dataclass(frozen=True)
class DrivenLimit:
    """A limit of force or torque (-1), of power (-3) or of the share of a motor's curve (-6) along a span's law.

    Where several constants make it, as behind a gear with losses, `part` says which is meant.
    """

    key: int
    most: float
    span: LawSpan
    drive: Drive
    stroke: float
    part: int = 0

    @property
    def scales(self) -> bool:
        """Whether the limit is the original one, so that a law which keeps it keeps it at every lower speed."""
        resting = not any((self.span.first.velocity, self.span.last.velocity))
        drive = self.drive.linear
        if drive is None or self.key == CURVE:
            return self.driven(1.0).exact and _torque_scales(self.drive, self.key, resting=resting)
        plain = resting and drive.stiffness == 0.0
        if self.key == FORCE:
            return drive.viscous == 0.0 or plain
        static = drive.dry + (drive.constant if self.span.displacement > 0.0 else -drive.constant)
        if drive.stiffness == drive.constant == drive.dry == 0.0:
            return drive.viscous == 0.0 or plain
        # dry friction is of laws that never turn back
        return plain and drive.dry > 0.0 and (drive.viscous == 0.0 or static >= 0.0)

    def driven(self, scale: float) -> Driven:
        """The limited quantity of the drive as a formula of the law, at a scale of the time."""
        span = slower(self.span, scale)
        if self.key == CURVE:
            return driven_curve(span, self.drive, self.stroke)
        return driven_peak(span, self.drive, self.stroke, self.key)

    def term(self, scale: float) -> tuple[Functional, float]:
        """The peak force or power of the law at a scale of the time, and the use of the limit per unit of the peak."""
        driven = self.driven(scale)
        return driven.constants[self.part], driven.unit / self.most

    def share(self, law: MotionLaw, scale: float) -> float:
        """The share of the limit that a law uses, at a scale of the time."""
        constant, weight = self.term(scale)
        return constant.value(law) * weight

    def slope(self, law: MotionLaw, scale: float) -> float:
        """The exponent with which the share of a law falls with the scale, by differences."""
        before, after = (
            max(self.share(law, scale * (1.0 + sign * DURATION_STEP)), LEAST_SHARE) for sign in (-1.0, 1.0)
        )
        return max(0.0, log(before / after) / log((1.0 + DURATION_STEP) / (1.0 - DURATION_STEP)))

    def least_scale(self, law: MotionLaw) -> float:
        """The least scale from which on a law satisfies the limit; infinite if no scale does, 0 if all do."""
        from scipy.optimize import brentq

        high = 1.0
        while self.share(law, high) > 1.0:
            high *= 2.0
            if high > _SLOWEST:
                return inf
        low = 0.5 * high
        while self.share(law, low) <= 1.0:
            low, high = 0.5 * low, low
            if low < 1.0 / _SLOWEST:
                return 0.0
        root = brentq(
            lambda place: log(max(self.share(law, exp(place)), LEAST_SHARE)),
            log(low),
            log(high),
            xtol=SAME_TIME,
            rtol=SAME_TIME,
        )
        return exp(float(root))


def driven_limits(key: int, most: float, span: LawSpan, drive: Drive, stroke: float, axis: str) -> list[DrivenLimit]:
    """A drive limit along a span, as one limit for each constant that it involves.

    Raises
    ------
    InfeasibleProblem
        If the static force is beyond it, so that no speed keeps it.
    """
    if key in {FORCE, CURVE}:
        position, force = static_force(span, drive)
        allowed_at_rest = most * (torque_at_rest(drive) if key == CURVE else 1.0)
        if force > allowed_at_rest * (1.0 + AGREEMENT):
            taken, allowed = (in_units(FORCE, value, axis) for value in (force, allowed_at_rest))
            raise InfeasibleProblem(
                sentence(
                    "{}: at {} the static load needs {}, so that no speed keeps {}: allow more, or change the drive's "
                    "spring, preload, gravity or friction",
                    span.where, in_small_units(position, axis), taken, allowed,
                )
            )  # fmt: skip
    first = DrivenLimit(key, most, span, drive, stroke)
    return [replace(first, part=part) for part in range(len(first.driven(1.0).constants))]


def _torque_scales(drive: Drive, key: int, *, resting: bool) -> bool:
    """Whether a torque that keeps its limit keeps it at every lower speed: where the static one does, which is one."""
    mechanism = drive.mechanism
    if key == POWER or not isinstance(mechanism.load_formula, Number):
        return False
    plain = key == FORCE and not mechanism.viscous and not drive.train.viscous
    return plain or (resting and isinstance(mechanism.inertia_formula, Number))


def static_force(span: LawSpan, drive: Drive) -> tuple[float, float]:
    """The greatest static force of a motion, and its position: spring, weight and dry friction."""
    direction = -1.0 if span.displacement < 0.0 else 1.0
    ends = [span.offset, *(position for _, position in span.via), span.offset + span.displacement]
    if drive.linear is None:
        ends = [span.offset + span.displacement * i / (_PLACES - 1) for i in range(_PLACES)]
    torques = ((drive.torque(place, 0.0, 0.0, direction=direction, time=span.start), place) for place in ends)
    force, position = max((abs(float(torque)), place) for torque, place in torques)
    return position, force
