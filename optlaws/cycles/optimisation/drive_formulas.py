"""The load of a drive along a span: force and power as formulas of the law, and dry friction's part of mean squares.

Where a motion never turns back, dry friction is a constant force. Where it may, it is +-d with the sign of the velocity
v, and F = u + d sgn v with u = m v' + c v. The mean of F² is then that of u² and of what no law changes but by turning:

    the integral of F² is that of u², d² times the time in motion, 2 d m (|v| at the end - |v| at the start) and
    2 d c times the total travel, forwards and backwards, which is at least that between the given positions.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from optlaws.cycles.specification.joints import LawSpan
from optlaws.cycles.specification.segments import Dwell
from optlaws.errors import InputError
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantity_kinds import Kind
from optlaws.synthesis.functionals.makers import peak, rms
from optlaws.synthesis.problem.constants import FUNCTIONALS, Functional
from optlaws.synthesis.problem.expression import Maximum, maximum

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.mechanisms.drives.effort import PieceEffort
    from optlaws.mechanisms.linkages.dimensionless import LinearForce, StrokeTorque


@dataclass(frozen=True)
class Driven:
    """Dimensionless constants of a span's law of which the greatest is what its drive takes, with their unit in SI.

    Of a mean square, `friction` is what dry friction adds at least, in SI units, and `formula` the force in its unit.
    `beneath` are forces in the unit whose magnitude is never greater, in whose phase plane bounds are proven. Where it
    is not `exact`, the constants are of more than the force: bounds of them are not of it.
    """

    constants: tuple[Functional, ...]
    unit: float
    friction: float = 0.0
    formula: str = ""
    beneath: tuple[str, ...] = ()
    exact: bool = True

    @property
    def objective(self) -> Functional | Maximum:
        """The greatest of the constants, to be minimised."""
        return self.constants[0] if len(self.constants) == 1 else maximum(*self.constants)


def may_turn(span: LawSpan) -> bool:
    """Whether a span's law may go back on its way."""
    if span.turns or len(span.stretches) > 1 or span.via or not span.displacement:
        return True
    return any(state.velocity * span.displacement < 0.0 for state in (span.first, span.last))


def driven_peak(span: LawSpan, drive: Drive | None, stroke: float, kind: Kind) -> Driven:
    """Peak of the force or the power along a span's law."""
    known = known_drive(drive)
    if kind is Kind.POWER and known.linear is not None and known.linear.inertia > 0.0 and not any(known.linear[1:]):
        return Driven((FUNCTIONALS["D"],), known.ratio * known.linear.inertia * stroke**2 / span.duration**3)
    formula, unit = driven_formula(span, drive, stroke, kind)
    if not known.train.loses:
        return Driven((peak(formula),), unit)
    to_load, back = _branches(span, known, stroke)
    braked = f"({back})*b" if kind is Kind.POWER else back
    formula = f"max(({to_load})*b, {braked})" if kind is Kind.POWER else formula
    exact = known.brakes_as_it_drives
    beneath = (back,) if exact and kind is Kind.FORCE else ()
    return Driven((peak(formula, side="high"), peak(braked, side="low")), unit, beneath=beneath, exact=exact)


def driven_formula(span: LawSpan, drive: Drive | None, stroke: float, kind: Kind) -> tuple[str, float]:
    """Force or power along a span's law as a formula, and its unit."""
    known = known_drive(drive)
    if known.dry > 0.0 and may_turn(span):
        raise InputError(
            f"drive: dry: {span.where} may turn back, where dry friction jumps and a peak of force or power is not "
            "proven: leave it out of what is minimised or bounded, take moves between rests, or minimise or bound the "
            "rms force"
        )
    unit = _unit(span, known, stroke)
    formula = _formula(span, known, stroke, unit)
    if kind is Kind.POWER:
        return f"({formula})*b", unit * known.ratio * abs(factor(stroke, span.duration, 1))
    return formula, unit


def driven_mean(span: LawSpan, drive: Drive | None, stroke: float) -> Driven:
    """Root mean square of the force along a span's law."""
    known = known_drive(drive)
    unit = _unit(span, known, stroke)
    if known.dry == 0.0 or not may_turn(span):
        formula = _formula(span, known, stroke, unit)
        below = known.train.loses and known.brakes_as_it_drives
        beneath = _branches(span, known, stroke)[1:] if below else ()
        return Driven((rms(formula),), unit, formula=formula, beneath=beneath)
    linear = known.linear
    if linear is None:
        raise InputError(
            f"drive: {span.where} may turn back, where friction of a mechanism jumps: take moves between rests"
        )
    if linear.stiffness or linear.constant or not (linear.inertia or linear.viscous):
        raise InputError(
            f"drive: dry: {span.where} may turn back: with dry friction the rms force of such a motion is convex only "
            "without stiffness, preload and gravity: leave these out, or take moves between rests"
        )
    _check_range(span, known)
    formula = linear.formula(stroke, span.duration, span.origin, 0.0, unit)
    return Driven((rms(formula),), unit, _friction(span, linear), formula)


def moved(span: LawSpan, drive: Drive, stroke: float) -> StrokeTorque:
    """Torque, power and energy over a span as formulas of a law that never turns back."""
    return drive.dimensionless(span.origin, stroke, span.duration, begins=span.start)


def _unit(span: LawSpan, drive: Drive, stroke: float) -> float:
    """The order of magnitude of the force along a span, as its unit."""
    if drive.linear is None:
        return 4.0 * moved(span, drive, stroke).unit
    unit = drive.linear.size(stroke, span.duration, span.origin)
    if unit == 0.0:
        raise InputError("drive: nothing resists the motion: give it a mass, an inertia, a spring or friction")
    return unit


def known_drive(drive: Drive | None) -> Drive:
    """The drive of the cycle; without one, the error explains how to give it."""
    if drive is None:
        raise InputError("force, torque and power are of a drive: give one, such as drive={'mass': '2 kg'}")
    return drive


def along(drive: Drive | None, piece: Piece, ends: tuple[float, float] | None = None) -> PieceEffort:
    """Force and power of the drive of a cycle along a law in its place, or between two times in it."""
    from optlaws.mechanisms.drives.effort import PieceEffort

    return PieceEffort(known_drive(drive), piece, ends)


def _formula(span: LawSpan, drive: Drive, stroke: float, unit: float) -> str:
    """The force along a span's law, in a unit."""
    if drive.linear is not None:
        _check_range(span, drive)
        direction = 1.0 if span.displacement > 0.0 else -1.0
        return drive.linear.formula(stroke, span.duration, span.origin, direction, unit)
    if may_turn(span):
        raise InputError(
            f"drive: {span.where} may turn back, and its torque is that of laws that do not: take moves between rests"
        )
    over = moved(span, drive, stroke)
    return f"{over.unit / unit!r}*({over.torque})"


def _check_range(span: LawSpan, drive: Drive) -> None:
    """Refuse motions that may turn back beyond the range of a mechanism."""
    if drive.mechanism.has_end and may_turn(span):
        raise InputError(
            f"drive: {span.where} may turn back and leave the range of the {drive.mechanism.name}: take moves between "
            "rests, or leave out its over="
        )


def branches_of(span: LawSpan, drive: Drive, stroke: float) -> tuple[str, str, float]:
    """The torque at the motor, the torque of power that flows back through the gear, and their unit."""
    formula, unit = driven_formula(span, drive, stroke, Kind.FORCE)
    return formula, _branches(span, drive, stroke)[-1] if drive.train.loses else formula, unit


def _branches(span: LawSpan, drive: Drive, stroke: float) -> tuple[str, ...]:
    """The torques at the motor of power that flows to the load and back, in the unit of the span's force."""
    over = moved(span, drive, stroke)
    share = over.unit / _unit(span, drive, stroke)
    return tuple(f"{share!r}*({branch})" for branch in over.branches)


def _friction(span: LawSpan, drive: LinearForce) -> float:
    """The least addition of dry friction to the mean square of the force of a motion that may turn back."""
    moving = sum(stop - start for segment, start, stop in span.timed if not isinstance(segment.given, Dwell))
    gained = 0.0 if span.turns else abs(span.last.velocity) - abs(span.first.velocity)
    positions = [span.offset, *(position for _, position in span.via), span.offset + span.displacement]
    way = sum(abs(after - before) for before, after in pairwise(positions))
    added = drive.dry * moving + 2.0 * (drive.inertia * gained + drive.viscous * way)
    return drive.dry * added / span.duration
