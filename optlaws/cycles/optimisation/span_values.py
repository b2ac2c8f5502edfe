"""What a span's law takes: force and power of its drive as formulas, with dry friction, and the sums of a cycle.

Where a motion never turns back, dry friction is a constant force. Where it may, it is +-d with the sign of the velocity
v, and F = u + d sgn v with u = m v' + c v. The mean of F² is then that of u² and of what no law changes but by turning:

    the integral of F² is that of u², d² times the time in motion, 2 d m (|v| at the end - |v| at the start) and
    2 d c times the total travel, forwards and backwards, which is at least that between the given positions.

What a cycle takes in all is the sum of what its motions take. Energy is the integral of the power that is above 0, less
the share of the braking power that is fed back; heat is what the winding of a motor and its brake resistor burn.
Without losses in the gear and without viscous friction motoring and braking energy differ by what is known of the ends:
the work against the load and the gain of kinetic energy. Then the heat consists of the motoring energy, which is convex
in the phase plane.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, sqrt
from typing import TYPE_CHECKING

from optlaws.cycles.optimisation.objectives import curve_lines
from optlaws.cycles.specification.joints import LawSpan
from optlaws.cycles.specification.segments import Dwell
from optlaws.errors import InputError
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantity_kinds import Kind
from optlaws.motion.smooth_parts import SmoothParts
from optlaws.synthesis.functionals.makers import integral, peak, rms
from optlaws.synthesis.problem.constants import FUNCTIONALS, Functional
from optlaws.synthesis.problem.expression import Maximum, maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.search import limit_beside
from optlaws.synthesis.solution import Solution

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


def driven_curve(span: LawSpan, drive: Drive | None, stroke: float) -> Driven:
    """The share of the motor's curve that a span's law uses: at most 1 where the motor can."""
    known = known_drive(drive)
    speed = known.ratio * abs(factor(stroke, span.duration, 1))
    torque, unit = driven_formula(span, known, stroke, Kind.FORCE)
    back = _branches(span, known, stroke)[-1] if known.train.loses else torque
    constants: list[Functional] = []
    for at_rest, slope in curve_lines(known.motor):
        share, falls = unit / at_rest, slope * speed / at_rest
        if not falls and not known.train.loses:
            constants.append(peak(f"{share!r}*({torque})"))
            continue
        for fall in (falls, -falls) if may_turn(span) else (falls,):
            constants.append(peak(f"{share!r}*({torque}) + {-fall!r}*b", side="high"))
            constants.append(peak(f"{share!r}*({back}) + {fall!r}*b", side="low"))
    return Driven(tuple(constants), 1.0, exact=not known.train.loses or known.brakes_as_it_drives)


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


@dataclass(frozen=True)
class SpanSum:
    """An integral over a span's law in SI units: `unit` times the integral of a formula, plus a constant.

    `beneath` are formulas whose integrals are never greater, in whose phase plane bounds are proven; `least` is what
    the sum is at least, whatever the law.
    """

    formula: str
    unit: float
    constant: float = 0.0
    beneath: tuple[str, ...] = ()
    least: float = -inf

    def bound(self, solution: Solution, *, exact: bool = True) -> float:
        """The lower bound of the laws of a problem, in SI units, from its solution and from phase planes.

        Where the problem is not exact, its solution proves nothing.
        """
        proven = max(solution.lower_bound if exact else -inf, self._of_planes(solution.problem))
        return max(self.unit * proven + self.constant, self.least)

    def _of_planes(self, problem: Problem) -> float:
        limits = (limit_beside(replace(problem, minimise=integral(formula))) for formula in self.beneath)
        return max((limit.value for limit in limits if limit is not None), default=-inf)


def span_sum(span: LawSpan, kind: Kind, drive: Drive | None, stroke: float) -> SpanSum:
    """The integrand over a span: the square of a derivative or of the force, energy or heat."""
    nu = kind.order
    if nu:
        return SpanSum(f"{'abcj'[nu]}^2", factor(stroke, span.duration, nu) ** 2 * span.duration)
    if kind is Kind.FORCE:
        driven = driven_mean(span, drive, stroke)
        # in the direction of the stroke, as phase planes have it
        force = (
            f"-({driven.formula})"
            if drive is not None and drive.linear is not None and stroke < 0.0
            else driven.formula
        )
        return SpanSum(f"({force})^2", driven.unit**2 * span.duration, driven.friction * span.duration)
    from optlaws.mechanisms.linkages.dimensionless import recovering

    known = known_drive(drive)
    # a span that may turn back is refused as it is for forces
    force, unit = driven_formula(span, known, stroke, Kind.FORCE)
    if kind is Kind.HEAT:
        return _heat(span, known, stroke)
    least = _least_energy(span, known, stroke)
    if known.linear is None:
        over = moved(span, known, stroke)
        branches = over.branches if known.train.loses else ()
        beneath = tuple(recovering([f"({branch})*b"], known.regeneration) for branch in branches)
        return SpanSum(over.energy, over.energy_unit, beneath=beneath, least=least)
    power = f"({force})*b" if stroke > 0.0 else f"(-({force}))*b"
    return SpanSum(recovering([power], known.regeneration), unit * known.ratio * abs(stroke), least=least)


def sum_of_piece(piece: Piece, kind: Kind, drive: Drive | None) -> float:
    """A piece's contribution to a sum, in SI units."""
    if kind.order:
        return piece.duration * piece.mean_square(kind.order)
    taken = along(drive, piece)
    if kind is Kind.FORCE:
        return taken.square
    return taken.energy if kind is Kind.ENERGY else taken.heat


def size_of(piece: Piece, kind: Kind, drive: Drive | None, *, mean: bool = False) -> float:
    """The peak or RMS of a derivative, or of the force or power of a drive, in a piece, in SI units."""
    nu = kind.order
    if nu or drive is None:
        if not piece.stroke:
            return 0.0
        constant = piece.law.rms(nu) if mean else piece.law.peak(nu).value
        return constant * abs(factor(piece.stroke, piece.duration, nu))
    taken = along(drive, piece)
    if kind is Kind.POWER:
        return max(taken.powers)
    return sqrt(taken.square / piece.duration) if mean else taken.peak_force.value


def total(pieces: Sequence[Piece], kind: Kind, drive: Drive | None) -> float:
    """A sum over pieces, in SI units."""
    return sum(sum_of_piece(piece, kind, drive) for piece in pieces)


def _least_energy(span: LawSpan, drive: Drive, stroke: float) -> float:
    """What the energy of a span is at least, J: the work along its stroke, of which no more than a share comes back."""
    if drive.mechanism.varies:
        return -inf
    work = _work(span, drive, stroke)
    return max(work, drive.regeneration * work)


def _heat(span: LawSpan, drive: Drive, stroke: float) -> SpanSum:
    """The copper heat of a motor and the braking energy that is not fed back."""
    train, over = drive.train, moved(span, drive, stroke)
    if not train.copper:
        raise InputError(
            "minimise: heat is that of a motor's winding and of its brake resistor: give drive=Drive(...) with a motor "
            "that has a motor constant, such as Motor('3e-4 kg m^2', constant=0.3), in N m/√W"
        )
    squared = [f"{over.copper!r}*({torque})^2" for torque in (over.torque, over.branches[-1])]
    burnt, beneath = 1.0 - drive.regeneration, tuple(squared[1:]) if drive.brakes_as_it_drives else ()
    if not burnt:
        return SpanSum(squared[0], over.energy_unit, beneath=beneath, least=0.0)
    if drive.mechanism.varies or train.loses or drive.mechanism.viscous or train.viscous:
        return SpanSum(over.heat, over.energy_unit, beneath=beneath, least=0.0)
    formula = f"{squared[0]} + {burnt!r}*max({over.power}, 0)"
    return SpanSum(formula, over.energy_unit, -burnt * _work(span, drive, stroke), least=0.0)


def _work(span: LawSpan, drive: Drive, stroke: float) -> float:
    """The work along a span's stroke without viscous friction, J: whatever the law."""
    mechanism, train, ends = drive.mechanism, drive.train, (span.origin, span.origin + stroke)
    load = SmoothParts.between(*sorted(ends)).integral(mechanism.load) * (1.0 if stroke > 0.0 else -1.0)
    kinetic = [
        0.5 * (mechanism.inertia(x) + train.ratio**2 * train.inertia) * state.velocity**2
        for x, state in zip(ends, (span.first, span.last), strict=True)
    ]
    rubbed = (mechanism.coulomb + train.ratio * train.coulomb) * abs(stroke)
    return float(load + rubbed + kinetic[1] - kinetic[0])
