"""Limits of force, torque and power of a span as shares of what is allowed, at any scale of its time.

Run `scale` times slower, a motion takes what it takes at rest in its positions, the static force F_0, and the rest of
its force divided by the square of the scale. With u = 1/scale² that is (1 - u) F_0 + u F: between two forces that keep
the limit, where the static one does. With viscous friction, below a motor's curve and of power this follows between
rests where inertia and static force are constant: docs/theory/cycles.md.
"""

from __future__ import annotations

from functools import partial

from optlaws.cycles.greatest_speed.scaling import SpanLimit, slower
from optlaws.cycles.optimisation.drive_formulas import Driven, driven_peak
from optlaws.cycles.optimisation.motion_limits import Side, in_units
from optlaws.cycles.optimisation.motor_limits import driven_curve, torque_at_rest
from optlaws.cycles.specification.joints import LawSpan
from optlaws.errors import InfeasibleProblem
from optlaws.formulas.tree import Number
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.quantities import in_small_units
from optlaws.motion.quantity_kinds import Kind
from optlaws.sentences import sentence
from optlaws.synthesis.problem.constants import Functional
from optlaws.tolerances import AGREEMENT

_PLACES = 65  # at which the static torque of a mechanism is looked at


def driven_limits(key: Side, most: float, span: LawSpan, drive: Drive, stroke: float, axis: str) -> list[SpanLimit]:
    """A drive limit along a span, as one limit for each constant that it involves.

    Raises
    ------
    InfeasibleProblem
        If the static force is beyond it, so that no speed keeps it.
    """
    if key.kind in {Kind.FORCE, Kind.CURVE}:
        position, force = static_force(span, drive)
        allowed_at_rest = most * (torque_at_rest(drive) if key.kind is Kind.CURVE else 1.0)
        if force > allowed_at_rest * (1.0 + AGREEMENT):
            taken, allowed = (in_units(Side(Kind.FORCE), value, axis) for value in (force, allowed_at_rest))
            raise InfeasibleProblem(
                sentence(
                    "{}: at {} the static load needs {}, so that no speed keeps {}: allow more, or change the drive's "
                    "spring, preload, gravity or friction",
                    span.where, in_small_units(position, axis), taken, allowed,
                )
            )  # fmt: skip
    of = _driven(key.kind, span, drive, stroke)
    return [
        SpanLimit(
            key, most, partial(_term, key.kind, most, (span, drive, stroke), part), _scales(key.kind, span, drive, of)
        )
        for part in range(len(of.constants))
    ]


def _driven(kind: Kind, span: LawSpan, drive: Drive, stroke: float) -> Driven:
    """The limited quantity of the drive as a formula of the law."""
    return driven_curve(span, drive, stroke) if kind is Kind.CURVE else driven_peak(span, drive, stroke, kind)


def _term(
    kind: Kind, most: float, moved: tuple[LawSpan, Drive, float], part: int, scale: float
) -> tuple[Functional, float]:
    """One of the constants that make a limit, at a scale of the time, and the use of the limit per unit of it."""
    span, drive, stroke = moved
    driven = _driven(kind, slower(span, scale), drive, stroke)
    return driven.constants[part], driven.unit / most


def _scales(kind: Kind, span: LawSpan, drive: Drive, driven: Driven) -> bool:
    """Whether the limit is the original one, so that a law which keeps it keeps it at every lower speed."""
    resting = not any((span.first.velocity, span.last.velocity))
    force = drive.linear
    if force is None or kind is Kind.CURVE:
        return driven.exact and _torque_scales(drive, kind, resting=resting)
    plain = resting and force.stiffness == 0.0
    if kind is Kind.FORCE:
        return force.viscous == 0.0 or plain
    static = force.dry + (force.constant if span.displacement > 0.0 else -force.constant)
    if force.stiffness == force.constant == force.dry == 0.0:
        return force.viscous == 0.0 or plain
    # dry friction is of laws that never turn back
    return plain and force.dry > 0.0 and (force.viscous == 0.0 or static >= 0.0)


def _torque_scales(drive: Drive, kind: Kind, *, resting: bool) -> bool:
    """Whether a torque that keeps its limit keeps it at every lower speed: where the static one does, which is one."""
    mechanism = drive.mechanism
    if kind is Kind.POWER or not isinstance(mechanism.load_formula, Number):
        return False
    plain = kind is Kind.FORCE and not mechanism.viscous and not drive.train.viscous
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
