"""What a span's law takes, as functionals of the law with their units in SI: derivatives, forces, powers, and sums.

Where a motion never turns back, dry friction is a constant force. Where it may, it is +-d with the sign of the velocity
v, and F = u + d sgn v with u = m v' + c v. The mean of F² is then that of u² and of what no law changes but by turning:

    the integral of F² is that of u², d² times the time in motion, 2 d m (|v| at the end - |v| at the start) and
    2 d c times the total travel, forwards and backwards, which is at least that between the given positions.

What a cycle takes in all is the sum of what its motions take. Energy is the integral of the power that is above 0, less
the share of the braking power that is fed back; heat is what the winding of a motor and its brake resistor burn.
Without losses in the gear and without viscous friction motoring and braking energy differ by what is known of the ends:
the work against the load and the gain of kinetic energy. Then the heat consists of the motoring energy, which is convex
in the phase plane.

Power is the rate at which kinetic energy and the work against springs, weight and friction grow. From rest they are,
after the share k of a move, no more than k times the greatest power; what is left of them before the end, no more than
1 - k times it. Both are convex in the law where a spring pulls back, and viscous friction only helps the first: a
convex bound beneath a problem that is not convex.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, reduce
from itertools import pairwise
from math import hypot, inf, sqrt
from typing import TYPE_CHECKING, Any, TypeAlias

from optlaws.cycles.optimisation.objectives import SUMS, CycleObjective, curve_lines
from optlaws.cycles.specification.limits import Side
from optlaws.cycles.specification.programme import LawSpan, Layout
from optlaws.cycles.specification.segments import Dwell
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.kept import kept_property
from optlaws.mechanisms.drives.peak_torque import least_peak_torque
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantities import Kind
from optlaws.synthesis.functionals.makers import integral, peak, rms
from optlaws.synthesis.problem.constants import FUNCTIONALS, Functional
from optlaws.synthesis.problem.expression import Maximum, maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import limit_beside, synthesize
from optlaws.synthesis.status import Status
from optlaws.tolerances import AGREEMENT

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.mechanisms.drives.effort import PieceEffort
    from optlaws.mechanisms.linkages.mechanism_formulas import LinearForce, StrokeTorque
    from optlaws.mechanisms.linkages.move_limit import MoveLimit
    from optlaws.synthesis.limits.plane_of_problem import DriveObjective

PEAKS = {Kind.VELOCITY: "B", Kind.ACCELERATION: "C", Kind.JERK: "J", Kind.SNAP: "snap"}
_MEANS = {Kind.ACCELERATION: "rms_c", Kind.JERK: "rms_j", Kind.SNAP: "rms_snap"}
_NEAR_END = 0.02  # share of a move next to its ends where energies are small and say nothing

#: of what is minimised: a lower bound below is rounding, and proves nothing
BOUND_ROUNDING = 1e-9

#: laws of spans in their places, with their solutions
Laws: TypeAlias = tuple[tuple[Piece, Solution], ...]


@dataclass(frozen=True)
class SpanValue:
    """A quantity of a span's law: `unit` in SI times the greatest of dimensionless constants of the law.

    A sum is an integral of `formula` in its unit and a `constant` more, of a mean square what dry friction adds at
    least. `beneath` are constants that are never greater, in whose phase planes bounds are proven; `least` is what it
    is at least, whatever the law. Where it is not `exact`, the constants are of more: bounds of them are not of it.
    """

    constants: tuple[Functional, ...]
    unit: float
    constant: float = 0.0
    formula: str = ""
    beneath: tuple[Functional, ...] = ()
    exact: bool = True
    least: float = 0.0
    summed: bool = False

    @property
    def objective(self) -> Functional | Maximum:
        """The greatest of the constants, to be minimised."""
        return self.constants[0] if len(self.constants) == 1 else maximum(*self.constants)

    def bound(self, problem: Problem, proven: float) -> float:
        """The lower bound in SI units, from one of the constants in a problem and from phase planes."""
        limits = (limit_beside(replace(problem, minimise=constant)) for constant in self.beneath)
        most = max([proven, *(limit.value for limit in limits if limit is not None)])
        if self.summed:
            return max(self.unit * most + self.constant, self.least)
        # neither a peak nor a mean is below 0, whether or not anything is proven
        return hypot(max(most, 0.0) * self.unit, sqrt(max(self.constant, 0.0)))


def span_value(span: LawSpan, drive: Drive | None, kind: Kind, *, mean: bool = False) -> SpanValue:
    """A peak or root mean square along a span, or a sum over it."""
    if kind.order:
        return SpanValue((FUNCTIONALS[(_MEANS if mean else PEAKS)[kind]],), span.unit(kind.order))
    driven = DrivenSpan(span, known_drive(drive))
    if mean:
        return driven.mean
    known = {Kind.CURVE: driven.curve, Kind.ENERGY: driven.energy, Kind.HEAT: driven.heat}
    return known[kind]() if kind in known else driven.peak(kind)


def limited_value(span: LawSpan, drive: Drive | None, key: Side) -> SpanValue:
    """The constants of a whole span's law that a limit bounds, with their unit in SI."""
    if not key.sign:
        return span_value(span, drive, key.kind)
    nu, sign = key.kind.order, key.sign * (1.0 if span.stroke > 0.0 else -1.0)
    one_sided = FUNCTIONALS["C_plus" if sign > 0.0 else "C_minus"] if nu == 2 else None
    return SpanValue((one_sided or peak("abcj"[nu], side="high" if sign > 0.0 else "low"),), span.unit(nu))


def sum_along(span: LawSpan, drive: Drive | None, kind: Kind) -> SpanValue:
    """The integral over a span of the square of a derivative or of the force, of energy or of heat."""
    if kind in SUMS:
        return span_value(span, drive, kind)
    if kind.order:
        squared = factor(span.stroke, span.duration, kind.order) ** 2
        return SpanValue((), squared * span.duration, formula=f"{'abcj'[kind.order]}^2")
    mean = span_value(span, drive, kind, mean=True)
    # in the direction of the stroke, as phase planes have it
    backwards = drive is not None and drive.linear is not None and span.stroke < 0.0
    force = f"-({mean.formula})" if backwards else mean.formula
    return SpanValue((), mean.unit**2 * span.duration, mean.constant * span.duration, f"({force})^2")


def total(pieces: Sequence[Piece], kind: Kind, drive: Drive | None) -> float:
    """A sum over pieces, in SI units: of squares, of energy or of heat."""
    if kind.order:
        return sum(piece.duration * piece.mean_square(kind.order) for piece in pieces)
    of = {Kind.FORCE: "square", Kind.ENERGY: "energy", Kind.HEAT: "heat"}[kind]
    return sum(float(getattr(along(drive, piece), of)) for piece in pieces)


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


def along(drive: Drive | None, piece: Piece, ends: tuple[float, float] | None = None) -> PieceEffort:
    """Force and power of the drive of a cycle along a law in its place, or between two times in it."""
    from optlaws.mechanisms.drives.effort import PieceEffort

    return PieceEffort(known_drive(drive), piece, ends)


def known_drive(drive: Drive | None) -> Drive:
    """The drive of the cycle; without one, the error explains how to give it."""
    if drive is None:
        raise InputError("force, torque and power are of a drive: give one, such as drive={'mass': '2 kg'}")
    return drive


@dataclass(frozen=True)
class DrivenSpan:
    """The load of a drive along a span."""

    span: LawSpan
    drive: Drive

    @kept_property
    def over(self) -> StrokeTorque:
        """Torque, power and energy as formulas of a law that never turns back."""
        span = self.span
        return self.drive.dimensionless(span.origin, span.stroke, span.duration, begins=span.start)

    @kept_property
    def unit(self) -> float:
        """The order of magnitude of the force, as its unit."""
        if self.drive.linear is None:
            return 4.0 * self.over.unit
        unit = self.drive.linear.size(self.span.stroke, self.span.duration, self.span.origin)
        if unit == 0.0:
            raise InputError("drive: nothing resists the motion: give it a mass, an inertia, a spring or friction")
        return unit

    def _affine(self, direction: float) -> str:
        """The force of constant inertia and an affine load in its unit; within the range of the mechanism."""
        span, linear = self.span, self.drive.linear
        assert linear is not None  # noqa: S101 - as whoever asks has seen
        if self.drive.mechanism.has_end and span.may_turn:
            raise InputError(
                f"drive: {span.where} may turn back and leave the range of the {self.drive.mechanism.name}: take moves "
                "between rests, or leave out its over="
            )
        return linear.formula(span.stroke, span.duration, span.origin, direction, self.unit)

    @kept_property
    def force(self) -> str:
        """The force in its unit, where dry friction does not jump."""
        span = self.span
        if self.drive.dry > 0.0 and span.may_turn:
            raise InputError(
                f"drive: dry: {span.where} may turn back, where dry friction jumps and a peak of force or power is not "
                "proven: leave it out of what is minimised or bounded, take moves between rests, or minimise or bound "
                "the RMS force"
            )
        if self.drive.linear is not None:
            return self._affine(1.0 if span.displacement > 0.0 else -1.0)
        if span.may_turn:
            raise InputError(
                f"drive: {span.where} may turn back, and its torque is that of laws that do not: take moves between "
                "rests"
            )
        return f"{self.over.unit / self.unit!r}*({self.over.torque})"

    @property
    def branches(self) -> tuple[str, str]:
        """The torques of power that flows to the load and back through the gear, in the unit of the force."""
        if not self.drive.train.loses:
            return self.force, self.force
        share = self.over.unit / self.unit
        to_load, back = (f"{share!r}*({branch})" for branch in self.over.branches)
        return to_load, back

    def along(self, kind: Kind) -> tuple[str, float]:
        """Force or power as a formula, and its unit."""
        if kind is Kind.FORCE:
            return self.force, self.unit
        return f"({self.force})*b", self.unit * self.drive.ratio * self.span.unit(1)

    def peak(self, kind: Kind) -> SpanValue:
        """The peak of the force or the power."""
        drive, span, power = self.drive, self.span, kind is Kind.POWER
        if power and drive.linear is not None and drive.linear.inertia > 0.0 and not any(drive.linear[1:]):
            unit = drive.ratio * drive.linear.inertia * span.stroke**2 / span.duration**3
            return SpanValue((FUNCTIONALS["D"],), unit)
        formula, unit = self.along(kind)
        if not drive.train.loses:
            return SpanValue((peak(formula),), unit)
        to_load, back = self.branches
        exact, braked = drive.brakes_as_it_drives, f"({back})*b" if power else back
        constants = peak(f"max(({to_load})*b, {braked})" if power else formula, side="high"), peak(braked, side="low")
        return SpanValue(constants, unit, beneath=(peak(back),) if exact and not power else (), exact=exact)

    @property
    def mean(self) -> SpanValue:
        """The root mean square of the force."""
        span, drive, linear = self.span, self.drive, self.drive.linear
        if drive.dry == 0.0 or not span.may_turn:
            below = drive.train.loses and drive.brakes_as_it_drives
            beneath = (rms(self.branches[1]),) if below else ()
            return SpanValue((rms(self.force),), self.unit, formula=self.force, beneath=beneath)
        if linear is None:
            raise InputError(
                f"drive: {span.where} may turn back, where friction of a mechanism jumps: take moves between rests"
            )
        if linear.stiffness or linear.constant or not (linear.inertia or linear.viscous):
            raise InputError(
                f"drive: dry: {span.where} may turn back: with dry friction the RMS force of such a motion is convex "
                "only without stiffness, preload and gravity: leave these out, or take moves between rests"
            )
        formula = self._affine(0.0)
        return SpanValue((rms(formula),), self.unit, self._friction, formula)

    @property
    def _friction(self) -> float:
        """The least addition of dry friction to the mean square of the force of a motion that may turn back."""
        span, linear = self.span, self.drive.linear
        assert linear is not None  # noqa: S101 - others are refused
        moving = sum(stop - start for segment, start, stop in span.timed if not isinstance(segment.given, Dwell))
        gained = 0.0 if span.turns else abs(span.last.velocity) - abs(span.first.velocity)
        positions = [span.offset, *(position for _, position in span.via), span.offset + span.displacement]
        way = sum(abs(after - before) for before, after in pairwise(positions))
        added = linear.dry * moving + 2.0 * (linear.inertia * gained + linear.viscous * way)
        return linear.dry * added / span.duration

    def curve(self) -> SpanValue:
        """The share of the motor's curve: at most 1 where the motor can."""
        drive, (torque, back), unit = self.drive, (self.force, self.branches[1]), self.unit
        speed = drive.ratio * self.span.unit(1)
        constants: list[Functional] = []
        for at_rest, slope in curve_lines(drive.motor):
            share, falls = unit / at_rest, slope * speed / at_rest
            if not falls and not drive.train.loses:
                constants.append(peak(f"{share!r}*({torque})"))
                continue
            for fall in (falls, -falls) if self.span.may_turn else (falls,):
                constants.append(peak(f"{share!r}*({torque}) + {-fall!r}*b", side="high"))
                constants.append(peak(f"{share!r}*({back}) + {fall!r}*b", side="low"))
        return SpanValue(tuple(constants), 1.0, exact=not drive.train.loses or drive.brakes_as_it_drives)

    def energy(self) -> SpanValue:
        """The energy: at least the work along the stroke, of which no more than a share comes back."""
        from optlaws.mechanisms.linkages.mechanism_formulas import recovering

        drive, stroke = self.drive, self.span.stroke
        force = self.force  # a span that may turn back is refused as it is for forces
        beneath: tuple[str, ...] = ()
        if drive.linear is None:
            formula, unit = self.over.energy, self.over.energy_unit
            branches = self.over.branches if drive.train.loses else ()
            beneath = tuple(recovering([f"({branch})*b"], drive.regeneration) for branch in branches)
        else:
            power = f"({force})*b" if stroke > 0.0 else f"(-({force}))*b"
            formula, unit = recovering([power], drive.regeneration), self.unit * drive.ratio * abs(stroke)
        least = -inf if drive.mechanism.varies else max(self.work, drive.regeneration * self.work)
        return _sum(formula, unit, beneath=beneath, least=least)

    def heat(self) -> SpanValue:
        """The copper heat of a motor and the braking energy that is not fed back."""
        _ = self.force
        drive, train, over = self.drive, self.drive.train, self.over
        if not train.copper:
            raise InputError(
                "minimise: heat is that of a motor's winding and of its brake resistor: give drive=Drive(...) with a "
                "motor that has a motor constant, such as Motor('3e-4 kg m^2', constant=0.3), in N m/√W"
            )
        squared = [f"{over.copper!r}*({torque})^2" for torque in (over.torque, over.branches[-1])]
        burnt, beneath = 1.0 - drive.regeneration, squared[1:] if drive.brakes_as_it_drives else ()
        if not burnt:
            return _sum(squared[0], over.energy_unit, beneath=beneath)
        if drive.mechanism.varies or train.loses or drive.mechanism.viscous or train.viscous:
            return _sum(over.heat, over.energy_unit, beneath=beneath)
        formula = f"{squared[0]} + {burnt!r}*max({over.power}, 0)"
        return _sum(formula, over.energy_unit, -burnt * self.work)

    @kept_property
    def work(self) -> float:
        """The work along the stroke without viscous friction, J: whatever the law."""
        mechanism, train, span = self.drive.mechanism, self.drive.train, self.span
        ends = (span.origin, span.origin + span.stroke)
        from optlaws.motion.smooth_parts import SmoothParts

        load = SmoothParts.between(*sorted(ends)).integral(mechanism.load) * (1.0 if span.stroke > 0.0 else -1.0)
        kinetic = [
            0.5 * (mechanism.inertia(x) + train.ratio**2 * train.inertia) * state.velocity**2
            for x, state in zip(ends, (span.first, span.last), strict=True)
        ]
        rubbed = (mechanism.coulomb + train.ratio * train.coulomb) * abs(span.stroke)
        return float(load + rubbed + kinetic[1] - kinetic[0])


def _sum(
    formula: str, unit: float, constant: float = 0.0, *, beneath: Sequence[str] = (), least: float = 0.0
) -> SpanValue:
    planes = tuple(map(integral, beneath))
    return SpanValue((integral(formula),), unit, constant, formula, planes, least=least, summed=True)


def bound_by_energy(span: LawSpan, objective: CycleObjective, solution: Solution, *, exact: bool = True) -> float:
    """The lower bound of a span, dimensionless: the bound of its solution, or a better bound by energy.

    Where the constants of the solution are not `exact`, its bound is none; of power the one by energy is, for a gear
    that loses power takes at no time less of it than one that loses none.
    """
    least, (_, most) = objective.kind is Kind.POWER, objective.limits.get(Kind.POWER, (0.0, 0.0))
    drive, resting = objective.drive, span.first.velocity == 0.0 == span.last.velocity
    if not exact and (not least or drive is None):
        return 0.0
    linear = None if drive is None or span.may_turn or not resting else replace(drive, efficiency=1.0).linear
    # one move from rest to rest, with an inertia and no spring that pushes away
    plain = linear is not None and linear.inertia > 0.0 and linear.stiffness >= 0.0
    known = solution.lower_bound if exact else 0.0
    proven = exact and (solution.problem.convex or solution.status is Status.OPTIMAL)
    if proven or not (least or most) or not plain or drive is None or linear is None:
        return known
    unit = span_value(span, drive, Kind.POWER).unit
    ceiling = min(solution.objective if least else inf, most / unit if most else inf)
    relaxed = _relaxed(span, linear, solution.problem, unit / drive.ratio, ceiling, least=least, loses=not exact)
    bound = _least_of_relaxed(relaxed)
    # laws that are faster than the relaxed ones may be take more power than the one found
    return known if bound is None else max(known, min(bound, solution.objective))


@lru_cache(maxsize=64)
def _least_of_relaxed(problem: Problem) -> float | None:
    try:
        return synthesize(problem).lower_bound
    except (InfeasibleProblem, SolverFailure):
        return None


def _bound_of_drive(span: LawSpan, objective: CycleObjective) -> float:
    """The greatest proven bound of a span's torque or copper heat, in SI units, of any law that never turns back.

    Of the motor no limit counts but those that the cycle keeps. Minus infinity where none is known: of a span that does
    not go from rest to rest, of a load over the time, and of other objectives, as an energy may be below 0.
    """
    kind, drive = objective.kind, objective.drive
    if drive is None or kind not in {Kind.FORCE, Kind.HEAT} or not has_torque_limit(span, drive):
        return -inf
    known = torque_limit(span, objective, "peak torque" if kind is Kind.FORCE and not objective.mean else "rms torque")
    least = 0.0 if known is None else max(known.value, 0.0)
    if least == 0.0 and kind is Kind.FORCE and not objective.mean:
        # loads that drive the machine leave the search without a potential
        least = least_peak_torque(known_drive(drive), span.origin, span.stroke, span.duration)
    return least if kind is Kind.FORCE else drive.train.copper * span.duration * least**2


def has_torque_limit(span: LawSpan, drive: Drive) -> bool:
    """Whether the torque of a span has a limit for all laws: from rest to rest, with a load that no time changes."""
    return span.first.velocity == 0.0 == span.last.velocity and not span.may_turn and not drive.mechanism.varies


def torque_limit(span: LawSpan, objective: CycleObjective, minimised: DriveObjective) -> MoveLimit | None:
    """The limit of a span's torque, of any law that never turns back, by a motor without limits of its own."""
    known = {Kind.VELOCITY: "velocity", Kind.ACCELERATION: "acceleration"}
    sides = span.stretches[0].sides(objective.limits)
    limits = tuple((known[key.kind], most) for key, most in sides.items() if key.kind in known and not key.sign)
    return _torque_limit(known_drive(objective.drive), minimised, (span.origin, span.stroke, span.duration), limits)


@lru_cache(maxsize=64)
def _torque_limit(
    drive: Drive, minimised: DriveObjective, move: tuple[float, float, float], limits: tuple[tuple[str, float], ...]
) -> MoveLimit | None:
    free = replace(drive.motor, rated_torque=None, peak_torque=None, greatest_speed=None, curve=(), continuous=())
    try:
        return replace(drive, motor=free).limit(minimised, *move, limits=dict(limits))
    except (InfeasibleProblem, InputError, SolverFailure):
        return None


def _relaxed(
    span: LawSpan, drive: LinearForce, problem: Problem, unit: float, ceiling: float, *, least: bool, loses: bool
) -> Problem:
    """The problem with energies in place of the power, among laws no faster than the power permits.

    Of a gear that loses power it is not known how much of what is left comes back to the motor.
    """
    way = factor(span.stroke, span.duration, 1)
    direction = 1.0 if span.displacement > 0.0 else -1.0
    force = drive.constant + drive.stiffness * span.origin + drive.dry * direction
    inertia = drive.inertia * factor(span.stroke, span.duration, 2) * way
    # of the power inertia b c + viscous b² + spring a b + constant b in a unit
    sizes = (inertia, drive.viscous * way**2, drive.stiffness * span.stroke * way, force * way)
    inertia, viscous, spring, constant = (size / unit for size in sizes)
    fastest = (abs(constant) + sqrt(constant**2 + 2.0 * inertia * ceiling)) / inertia
    kinetic, half = f"({0.5 * inertia!r})*b^2", 0.5 * spring
    gained = f"({kinetic} + ({constant!r})*a + ({half!r})*a^2)/k"
    # what is braked by friction needs no power: at most so much
    damped = f" - ({viscous * fastest!r})*(1 - a)" if problem.monotone else ""
    spared = "" if problem.monotone else f" - ({viscous * fastest**2!r})"
    lost = f"({kinetic} - ({constant!r})*(1 - a) - ({half!r})*(1 - a^2){damped})/(1 - k){spared}"
    energies = [peak(gained, side="high", start=_NEAR_END)]
    energies += [] if loses else [peak(lost, side="high", stop=1.0 - _NEAR_END)]
    known = problem.range("B")
    bounded = {} if loses else problem.bounds
    convex = {constant: allowed for constant, allowed in bounded.items() if constant.convex}
    bounds: dict[Any, Range] = convex if least else convex | dict.fromkeys(energies, Range(0.0, ceiling))
    most = Range(0.0, fastest if known is None else min(fastest, known.high))
    minimise = (maximum(*energies) if len(energies) > 1 else energies[0]) if least else problem.minimise
    return replace(problem, minimise=minimise, bounds=bounds, B=most, D=None)


def bound_of(layout: Layout, solved: Laws, objective: CycleObjective, period: float) -> float | None:
    """The lower bound of a cycle in the same times, from bounds of optimised laws and values of the others."""
    kind, mean = objective.kind, objective.mean
    if kind is Kind.LOAD:
        return next((solution.lower_bound * abs(piece.stroke) for piece, solution in solved), None)
    spans = zip(layout.spans, solved, strict=False)
    sizes = [(piece.duration, span_bound(span, solution, objective)) for span, (piece, solution) in spans]
    if kind in SUMS:
        return sum(bound for _, bound in sizes) + total(layout.pieces, kind, objective.drive)
    drive = None if kind.order else known_drive(objective.drive)
    sizes += [(piece.duration, size_of(piece, kind, drive, mean=mean)) for piece in layout.pieces]
    if not mean:
        return max(size for _, size in sizes)
    return reduce(hypot, (size * sqrt(time / period) for time, size in sizes), 0.0)


def span_bound(span: LawSpan, solution: Solution, objective: CycleObjective) -> float:
    """The lower bound of a span in SI units; without its law where that has the least of something else."""
    exact = is_exact(span, objective)
    value = span_value(span, objective.drive, objective.kind, mean=objective.mean)
    if solution.problem.objective != value.objective.expression():
        return max(_bound_of_drive(span, objective), -inf if value.summed else 0.0)
    if value.summed:
        proven = value.bound(solution.problem, solution.lower_bound if exact else -inf)
    else:
        proven = value.bound(solution.problem, bound_by_energy(span, objective, solution, exact=exact))
    known = exact and proven > BOUND_ROUNDING * value.unit * solution.objective
    return proven if known else max(proven, _bound_of_drive(span, objective))


def is_certified(layout: Layout, solved: Laws, objective: CycleObjective) -> bool:
    """Whether the bounds of the solutions alone give the `bound_of` a cycle: no energy, no limit of a drive is higher.

    These alone are what a verification of a plan proves with every rounding enclosed.
    """
    kind, drive = objective.kind, objective.drive
    if kind is Kind.LOAD or kind.order:
        return kind is not Kind.LOAD
    most = 0.0
    for span, (_, solution) in zip(layout.spans, solved, strict=False):
        value = span_value(span, drive, kind, mean=objective.mean)
        minimised = solution.problem.objective == value.objective.expression()
        shared = len(value.constants) > 1 or (value.constant and not value.summed)
        if shared or not is_exact(span, objective) or not (minimised or not value.summed):
            return False
        proven = value.unit * solution.lower_bound + value.constant if minimised else 0.0
        if span_bound(span, solution, objective) > proven * (1.0 + AGREEMENT):
            return False
        most = max(most, proven)
    if kind is Kind.FORCE:
        whole = known_drive(drive)
        # of a piece whose force is no line as little is proven as nothing
        enough = most * (AGREEMENT if objective.mean else 1.0)
        return all(
            (whole.linear is not None and not piece.stroke)
            or size_of(piece, kind, whole, mean=objective.mean) <= enough
            for piece in layout.pieces
        )
    return all(kind in {Kind.POWER, Kind.ENERGY} and not piece.stroke for piece in layout.pieces)


def is_exact(span: LawSpan, objective: CycleObjective) -> bool:
    """Whether objective and limits are exact, not upper estimates: only then their bounds hold.

    Peaks behind a gear with losses are counted as if power flowed back wherever the motor brakes.
    """
    drive = objective.drive
    if drive is None or not drive.train.loses or drive.brakes_as_it_drives:
        return True
    limited = (key.kind for limits in span.sides(objective.limits) for key in limits or ())
    return not any(kind.is_driven for kind in limited) and (objective.mean or not objective.kind.is_driven)
