"""The optimal laws of a cycle with given durations: a problem for each span, with its status and its proof.

Where durations are fixed and spans are parted by joints that are known, the cycle decouples: the greatest of the least
peaks is the least of the greatest ones, and the least sum of squares is the sum of the least ones.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby, pairwise
from math import ceil, inf, sqrt
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from optlaws.cycles.optimisation.objectives import SUMS, CycleObjective, torque_at_rest
from optlaws.cycles.optimisation.span_values import (
    PEAKS,
    DrivenSpan,
    has_torque_limit,
    known_drive,
    limited_value,
    size_of,
    span_value,
    torque_limit,
)
from optlaws.cycles.specification.limits import (
    FORCE_UNITS,
    FORCES,
    LoadOutput,
    Side,
    Sides,
    along_motion,
    greatest,
    in_units,
    load_output,
)
from optlaws.cycles.specification.programme import LawSpan, State, is_optimal
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantities import TURN_DEG, Kind, in_small_units
from optlaws.numbers import MOST_PIECES
from optlaws.sentences import Amount, sentence
from optlaws.synthesis.problem.constants import FUNCTIONALS, Functional, RootMeanSquare
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window, via
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Chebyshev, Pieces, PolynomialBasis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.spaces.free_pieces import PeriodicPieces
from optlaws.synthesis.status import Status
from optlaws.tolerances import AGREEMENT

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.drive_train import Drive

_MOST, _LEAST = 600, 3  # pieces of a law, and of a motion even so: fewer may not bend as its ends require
#: pieces of a stretch where what is minimised has its peaks inside of pieces: the velocity, what a load does, power
_FEW = {Kind.VELOCITY: 6, Kind.LOAD: 4, Kind.POWER: 4}
_ALL_MOTIONS = "all motions through the joints"
_SNAP = Side(Kind.SNAP)
_HIGHER_DEGREE = "more time, a wider limit or a higher degree"
_ROUGH = 15  # degree of Z where points on the way or velocities bend the law


def joined_basis(span: LawSpan, order: int, degree: int, minimised: Kind) -> Pieces:
    """Splines with twice as many pieces in a stretch as a law with Z of a degree has coefficients and end conditions.

    Their acceleration is linear between breaks where the order is 3, so that its peaks, and those of the jerk, are at
    breaks: a linear program on known places.

    >>> from optlaws import Cycle, Dwell, Free
    >>> motions = [Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")]
    >>> (solution,) = Cycle(motions, period="0.5 s").solutions
    >>> len(solution.problem.basis.breaks), solution.problem.basis.degree
    (49, 3)
    """
    curved = sum(len(points) - 1 for bends, points in _points(span) if bends)
    most = min(2 * (degree + order), max(_LEAST, _MOST // curved))
    if _LEAST * curved > MOST_PIECES:
        raise InputError(
            f"{len(span.stretches)} motions through {len(span.via)} points are one law, of at most {MOST_PIECES} "
            "pieces: put a dwell or a move between them, where velocity and acceleration are known"
        )
    each = most if minimised not in _FEW else max(1, min(most, _FEW[minimised] * (degree + order) // 12))
    fastest = _least_velocity(span)
    breaks, straight = [0.0], list[int]()
    for bends, points in _points(span):
        if not bends:
            straight.append(len(breaks) - 1)
            breaks.append(span.place(points[-1][0]))
            continue
        for (low, y), (high, z) in pairwise(points):
            parts = ceil(each / (len(points) - 1))
            if minimised is Kind.VELOCITY:
                turning = _pieces_to_turn(abs(z - y) / (high - low), fastest, order)
                parts = max(parts, min(turning, ceil(most / (len(points) - 1))))
            begin, end = span.place(low), span.place(high)
            breaks += [begin + (end - begin) * i / parts for i in range(1, parts)] + [end]
    smoothness = max(order - 1, minimised.order - 1, 1)
    power = max(3, minimised.order, 2 * order - 1 if minimised is Kind.LOAD else order)
    return PeriodicPieces(breaks, power, smoothness, straight) if span.turns else Pieces(breaks, power, smoothness)


def _least_velocity(span: LawSpan) -> float:
    """A lower bound of the peak velocity of a span: the greatest mean between two points, or a known value."""
    steps = [(low, y, high, z) for _, points in _points(span) for (low, y), (high, z) in pairwise(points)]
    means = [abs(z - y) / (high - low) for low, y, high, z in steps if high > low]
    known = (abs(state.velocity) for state in (span.first, span.last, *span.states) if state is not None)
    return max(0.0, *means, *known)


def _points(span: LawSpan) -> Iterator[tuple[bool, list[tuple[float, float]]]]:
    """Of each stretch whether it bends, and the times and positions that it passes, its ends among them."""
    position = span.offset
    for stretch, start, stop in span.timed:
        passed = [(start, position), *(point for point in span.via if start < point[0] < stop)]
        position += stretch.displacement
        yield is_optimal(stretch.given), [*passed, (stop, position)]


def _pieces_to_turn(mean: float, fastest: float, order: int) -> int:
    """How many pieces let a velocity have a mean, whatever it is at both ends, and never be above the `fastest`.

    Splines with order - 2 continuous derivatives of b go from one constant velocity to another in order - 1 pieces of
    equal length, and have the mean of both there. With n pieces, between ends at the fastest, a mean of
    -(1 - 2 (order - 1) / n) times it is left. A mean that is the fastest itself needs none, for b is constant.
    """
    left = 1.0 - mean / fastest
    return 1 if left <= AGREEMENT else ceil(2 * (order - 1) / left)


def halved(basis: Pieces) -> Pieces | None:
    """Splines with every piece but straight ones cut in two; None if the pieces become too many.

    >>> halved(Pieces((0.0, 0.5, 1.0), 3, 1)).breaks
    (0.0, 0.25, 0.5, 0.75, 1.0)
    """
    if 2 * len(basis.breaks) > _MOST:
        return None
    stiff = set(basis.straight) if isinstance(basis, PeriodicPieces) else set[int]()
    breaks, straight = [0.0], list[int]()
    for i, (low, high) in enumerate(pairwise(basis.breaks)):
        if i in stiff:
            straight.append(len(breaks) - 1)
        else:
            breaks.append(0.5 * (low + high))
        breaks.append(high)
    if isinstance(basis, PeriodicPieces):
        return replace(basis, breaks=tuple(breaks), straight=tuple(straight))
    return replace(basis, breaks=tuple(breaks))


def joint_windows(span: LawSpan, order: int) -> Iterator[Window]:
    """Positions at joints and on the way, and what is known of velocities and accelerations at joints of a cycle."""
    for time, position in span.via:
        yield via("a", (position - span.origin) / span.stroke, at=span.place(time))
    bends = [is_optimal(stretch.given) for stretch in span.stretches]
    for i, state in enumerate(span.states):
        for nu, value in enumerate([*state, 0.0][: order - 1] if state is not None else (), start=1):
            # after a straight stretch the velocity is that of its start; beside one there is no acceleration
            if bends[i - 1] and (nu == 1 or bends[i]):
                yield via("abcj"[nu], value / factor(span.stroke, span.duration, nu), at=span.place(span.starts[i]))


def minimised_rms(problem: Problem) -> int | None:
    """The order of the derivative whose root mean square a problem minimises; None if it minimises something else."""
    constant = FUNCTIONALS.get(problem.minimise) if isinstance(problem.minimise, str) else None
    return constant.nu if isinstance(constant, RootMeanSquare) else None


def search_space(problem: Problem, span: LawSpan, order: int, fastest: float = inf) -> str:
    """The laws, in words, among which the solution of a span's problem is the best; `fastest` is its greatest velocity.

    No motion has a greatest velocity below its greatest mean. A polynomial of degree 2 nu - 1 between two joints has
    the least root mean square of the derivative of order nu, if its ends have no more than nu conditions each.
    """
    nu, basis = minimised_rms(problem), problem.basis
    if problem.minimise == "B" and fastest <= _least_velocity(span) * (1.0 + AGREEMENT):
        return _ALL_MOTIONS
    if isinstance(basis, Pieces):
        if nu is not None and basis == splines_of_least_rms(span, order, nu):
            return _ALL_MOTIONS
        return f"splines of degree {basis.degree} in {len(basis.breaks) - 1} pieces"
    degree = basis.degree if isinstance(basis, PolynomialBasis) else 0
    rich = nu is not None and problem.order <= nu and 2 * nu <= 2 * problem.order + degree + 1
    if rich and not (problem.bounded or problem.windows or problem.monotone):
        return _ALL_MOTIONS
    return f"laws of order {problem.order} with Z of degree {degree}"


def remark_on_degrees(problems: Sequence[tuple[LawSpan, Problem]], degree: int) -> tuple[str, ...]:
    """The remarks on spans whose Z has another degree than the requested degree."""
    return tuple(
        f"{span.where}: Z has the degree {basis.degree}, not {degree}, for the velocities at its ends"
        for span, basis in ((span, problem.basis) for span, problem in problems)
        if isinstance(basis, PolynomialBasis) and basis.degree != degree
    )


def splines_of_least_rms(span: LawSpan, order: int, nu: int) -> Pieces | None:
    """The splines that hold the motion of least root mean square of the derivative of order nu, of all motions.

    They are of degree 2 nu - 1 with breaks at the joints alone, and as smooth as can be but where more than the
    position is known. None where such a motion would violate the end conditions of the order: then none is the best.

    >>> from optlaws import Cycle, Dwell, Free
    >>> motions = [Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")]
    >>> (solution,) = Cycle(motions, period="0.5 s", minimise="rms jerk").solutions
    >>> solution.problem.basis
    Pieces(breaks=(0.0, 0.5, 1.0), degree=5, continuity=4)
    """
    known = not span.turns or any(state is not None for state in span.states)
    if order > (nu if known else 2 * nu - 1):
        return None
    times = sorted({*span.starts, *(time for time, _ in span.via), span.stop})
    breaks = [span.place(time) for time in times]
    if not span.turns:
        return Pieces(breaks, 2 * nu - 1, 2 * nu - 2)
    straight = [times.index(start) for stretch, start, _ in span.timed if not is_optimal(stretch.given)]
    return PeriodicPieces(breaks, 2 * nu - 1, nu - 1 if known else 2 * nu - 2, straight)


def solve(span: LawSpan, objective: CycleObjective, share: float = inf) -> tuple[Piece, Solution]:
    """The best law of a span, in its place, with its proof; it takes no more than its share of a limit of the cycle."""
    problem = span_problem(span, objective)
    if share < inf:
        problem = with_share(problem, span, objective, share)
    solution = _unhindered(problem, span, objective)
    if solution is None:
        solution = solved(problem, span)
        if isinstance(problem.basis, Pieces) and (solution.status == Status.INACCURATE or objective.of_load):
            finer = _with_more_pieces(problem, problem.basis, span)
            if finer is not None and (solution.status == Status.INACCURATE or finer.objective < solution.objective):
                solution = finer
    return span.by(solution.law), solution


def _unhindered(problem: Problem, span: LawSpan, objective: CycleObjective) -> Solution | None:
    """The solution with the least RMS of all motions, where it is known in what space that lies and limits allow it."""
    nu = minimised_rms(problem) if isinstance(problem.basis, Pieces) else None
    splines = None if nu is None else splines_of_least_rms(span, objective.order, nu)
    if splines is None:
        return None
    limited = replace(problem, basis=splines)
    free = replace(unlimited(limited), windows=tuple(joint_windows(span, objective.order)))
    try:
        least = synthesize(free)
        best = least if limited == free else synthesize(limited)
    except (InfeasibleProblem, SolverFailure):
        return None
    return best if best.objective <= least.objective * (1.0 + AGREEMENT) else None


def _with_more_pieces(problem: Problem, basis: Pieces, span: LawSpan) -> Solution | None:
    """The solution among splines with every piece but straight ones halved, if it is proven: few pieces fit badly.

    Peaks inside of pieces, as velocities have them, may lie so near each other that no more digits can be had. What a
    load does follows its own period, for which few pieces may be too long.
    """
    finer = halved(basis)
    try:
        solution = None if finer is None else solved(replace(problem, basis=finer), span)
    except SolverFailure:
        return None
    return solution if solution is not None and solution.status == Status.OPTIMAL else None


def solved(problem: Problem, span: LawSpan) -> Solution:
    """The solution of a span's problem."""
    try:
        return synthesize(problem)
    except InfeasibleProblem as error:
        # of many pieces no one would read each
        why = "" if isinstance(problem.basis, Pieces) else f" {error.args[0]}"
        raise InfeasibleProblem(
            f"{span.where}: no law keeps its limits in {span.duration:.9g} s: give it more time or wider limits.{why}",
            problem=problem,
            tried=error.tried,
            proof=error.proof,
        ) from None


def unlimited(problem: Problem) -> Problem:
    """The problem without bounds of its constants."""
    return replace(problem, bounds={}, B=None, C=None, D=None, J=None)


def refuse_too_weak(span: LawSpan, objective: CycleObjective) -> None:
    """Refuse a span whose torque is limited to less than any law takes, before laws are looked for.

    Raises
    ------
    InfeasibleProblem
        If the limit of all laws is above that of the torque; the limit is its `proof`.
    """
    from optlaws.laws.catalogue.catalogue import USUAL, catalogue

    drive = objective.drive
    if drive is None or not limit_of_drive_holds(span, objective):
        return
    sides = span.stretches[0].sides(objective.limits)
    curve = torque_at_rest(drive) if Side(Kind.CURVE) in sides else inf
    allowed = min(greatest(sides, Kind.FORCE), curve)
    if allowed == inf or size_of(span.by(catalogue[USUAL].law), Kind.FORCE, drive) <= allowed:
        return
    least = torque_limit(span, objective, "peak torque")
    if least is None or least.value <= allowed:
        return
    force, unit = FORCES[objective.axis], FORCE_UNITS[objective.axis]
    at = f" with a ratio of {drive.ratio:g}" if drive.has_motor else ""
    raise InfeasibleProblem(
        sentence(
            "{}: too little {}{}: no law, of whatever degree, that never turns back takes {} in {} with a peak below "
            "{}, and {} are allowed: give it more time{} or a wider limit",
            span.where, force, at, in_small_units(abs(span.stroke), objective.axis), Amount(span.duration, "s"),
            Amount(least.value, unit), Amount(allowed, unit), _stronger(span, drive),
        ),
        proof=least,
    )  # fmt: skip


def limit_of_drive_holds(span: LawSpan, objective: CycleObjective) -> bool:
    """Whether the limit of the torque, of laws that never turn back, is one of all that a span may have.

    A spring that swings may take less of a law that does; an inertia alone does not.
    """
    drive = objective.drive
    if drive is None or not has_torque_limit(span, drive):
        return False
    inert = drive.linear is not None and not any(drive.linear[1:])
    return inert or _never_back(span, objective) or span_problem(span, objective).monotone


def _stronger(span: LawSpan, drive: Drive) -> str:
    """Remedies by the drive: another ratio, where the motor can turn the usual law with it, or another motor."""
    from optlaws.laws.catalogue.catalogue import USUAL

    if not drive.has_motor:
        return ""
    try:
        best = drive.best_ratio(USUAL, span.origin, span.stroke, span.duration).ratio
    except InfeasibleProblem:
        return ", a stronger motor"
    return f", a ratio such as {best:.3g}, a stronger motor"


def with_least_limit(error: InfeasibleProblem, span: LawSpan, objective: CycleObjective) -> InfeasibleProblem:
    """The error of a span without a law, saying in units of the machine what one limit would have to allow at least."""
    problem = span_problem(span, objective)
    for key, most in span.stretches[0].sides(objective.limits).items():
        if key.kind is Kind.VELOCITY_ALONG:
            continue
        limited = limited_value(span, objective.drive, key)
        limit = problem.range(limited.constants[0].name)
        others = {other: best for other, best in problem.bounded if other not in limited.constants}
        minimised = replace(unlimited(problem), minimise=limited.objective)
        try:
            gentlest = synthesize(replace(minimised, bounds=others))
        except (InfeasibleProblem, SolverFailure):
            continue
        least, of_any_degree = gentlest.lower_bound, gentlest.best_possible or -inf
        if limit is None or least <= limit.high:
            continue
        remedy = "more time or a wider limit" if of_any_degree > limit.high else _HIGHER_DEGREE
        allowed, needed = (in_units(key, value, objective.axis) for value in (most, least / limit.high * most))
        return InfeasibleProblem(
            sentence(
                "{}: no law keeps its limits in {} s: among {} the least is {}, but its limit is {}: give it {}",
                span.where, f"{span.duration:.9g}", search_space(problem, span, objective.order), needed, allowed,
                remedy,
            ),
            problem=problem,
            tried=error.tried,
            proof=error.proof,
        )  # fmt: skip
    return error


def with_places(tried: str, start: float, stop: float, period: float) -> str:
    """What was tried of a motion from one time to another in seconds, saying where in a cycle its places k are."""
    if "k = " not in tried:
        return tried
    ends = (sentence("{} ({})", Amount(time, "s"), Amount(TURN_DEG * time / period, "deg")) for time in (start, stop))
    return str(sentence("{}; k = 0 is at {}, k = 1 at {}", tried, *ends))


def with_share(problem: Problem, span: LawSpan, objective: CycleObjective, share: float) -> Problem:
    """The problem of a span of which the squared force, or the energy, is at most a share, in SI units."""
    of_energy = objective.mean_force is None
    kind, most = (Kind.ENERGY, share) if of_energy else (Kind.FORCE, share / span.duration)
    value = span_value(span, objective.drive, kind, mean=not of_energy)
    if not of_energy and most <= value.constant:
        raise InfeasibleProblem(
            f"{span.where}: dry friction alone takes an RMS force of {sqrt(value.constant):.9g}, more than what is "
            f"left for it, {sqrt(max(most, 0.0)):.9g}: allow more, or give the cycle more time"
        )
    left = most - value.constant
    allowed = Range(0.0, (left if of_energy else sqrt(left)) / value.unit)
    bounds = {**problem.bounds, value.constants[0]: allowed}
    monotone = problem.monotone or _never_back(span, objective)
    return replace(problem, bounds=bounds, monotone=monotone, symmetric=False)


def _never_back(span: LawSpan, objective: CycleObjective) -> bool:
    """Whether a span's law is never to go back, so that dry friction is a constant force and limits of drives hold."""
    drive = objective.drive
    if drive is None or span.may_turn:
        return False
    summed = objective.kind in SUMS or objective.energy is not None
    return drive.linear is None or drive.mechanism.has_end or drive.dry > 0.0 or summed


def span_problem(span: LawSpan, objective: CycleObjective) -> Problem:
    """The dimensionless problem of a span."""
    if span.stroke == 0.0:
        raise InputError(f"{span.where} has nothing to move: take a Dwell")
    of_each = span.sides(objective.limits)
    _check_mean(span, of_each, objective.axis)
    bounds, windows = _limits(span, objective, of_each)
    minimised, ends = objective.kind, BoundaryConditions(*_ends(span, objective.order))
    if span.turns or len(span.stretches) > 1 or span.via:
        if objective.of_load:
            minimised = Kind.LOAD
        elif Kind.POWER in objective.limits or minimised is Kind.ENERGY:
            minimised = Kind.POWER
        else:
            # peaks of the jerk and the snap are to be at breaks
            orders = (key.kind for limits in of_each for key in limits or () if key.kind.order > 2)
            minimised = max([minimised, *orders], key=lambda kind: kind.order)
        bounds |= {
            _of_load(objective, output, span): Range(0.0, most / abs(span.stroke))
            for output, most in objective.loaded.items()
        }
        joints, forward = joint_windows(span, objective.order), forward_windows(span, of_each)
        return Problem(
            order=1 if span.turns else objective.order,
            basis=joined_basis(span, objective.order, objective.degree, minimised),
            minimise=_minimised(span, objective),
            symmetric=False,
            boundary=ends,
            windows=(*joints, *forward, *windows),
            bounds=bounds,
        )
    limits = of_each[0] or {}
    if minimised is Kind.ENERGY and all(key.sign or key.kind is Kind.VELOCITY for key in limits):
        raise InputError(
            f"{span.where}: its energy falls without end as accelerations grow, so there is no least "
            f"one: give a limit of "
            "the acceleration, or of the force or torque"
        )
    plain = not any(any(end[1:]) for end in (ends.start, ends.end))
    forced = minimised.is_driven or minimised in SUMS or any(key.kind.is_driven for key in limits)
    sided = any(key.sign and key.kind is not Kind.VELOCITY_ALONG for key in limits)
    # a motor's curve falls with a speed of one sign
    curved = Side(Kind.CURVE) in limits and not span.may_turn
    return Problem(
        order=objective.order,
        basis=Chebyshev(objective.degree if plain else max(objective.degree, _ROUGH)),
        minimise=_minimised(span, objective),
        monotone=(forced and _never_back(span, objective)) or along_motion(limits) or curved,
        symmetric=plain and not forced and not sided and not windows,
        boundary=ends,
        windows=windows,
        bounds=bounds,
    )


def _minimised(span: LawSpan, objective: CycleObjective) -> Any:
    kind, mean = objective.kind, objective.mean
    output = load_output(objective.minimise, objective.load) if kind is Kind.LOAD else None
    if output is not None:
        return _of_load(objective, output, span)
    value = span_value(span, objective.drive, kind, mean=mean)
    return value.constants[0].name if kind.order else value.objective


def _of_load(objective: CycleObjective, output: LoadOutput, span: LawSpan) -> Functional:
    if objective.load is None:
        raise AssertionError  # what is asked of a load is read with it
    return objective.load.constant(output.output, span.duration, mean=output.mean)


def _ends(span: LawSpan, order: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    if span.turns:
        first = (span.offset - span.origin) / span.stroke
        return (first,), (first + span.displacement / span.stroke,)

    def rates(state: State) -> tuple[float, ...]:
        values = [value / factor(span.stroke, span.duration, nu) + 0.0 for nu, value in enumerate(state, start=1)]
        return tuple((values + [0.0] * order)[: order - 1])

    return (0.0, *rates(span.first)), (span.displacement / span.stroke, *rates(span.last))


def _limits(  # noqa: C901 - kinds of limits, one after another
    span: LawSpan, objective: CycleObjective, of_each: Sequence[Sides | None]
) -> tuple[dict[Any, Range], tuple[Window, ...]]:
    """Limits of the whole span as bounds of its constants, limits of parts of it as windows."""
    first, *others = sought = [limits for limits in of_each if limits is not None]
    bounds, windows = dict[Any, Range](), list[Window]()
    if all(limits == first for limits in others) and _straight_within(span, first):
        for key, most in first.items():
            if key.kind is not Kind.VELOCITY_ALONG:
                value = limited_value(span, objective.drive, key)
                bounds |= dict.fromkeys(value.constants, Range(0.0, most / value.unit))
        return bounds, ()
    for limits, of_part in groupby(zip(of_each, span.timed, strict=True), key=itemgetter(0)):
        times = [time for _, (_, *ends) in of_part for time in ends]
        for key, most in (limits or {}).items():
            if key.kind is Kind.CURVE:
                value = span_value(span, objective.drive, key.kind)
                bounds |= dict.fromkeys(value.constants, Range(0.0, most / value.unit))
            elif key == _SNAP:
                if len({each.get(_SNAP, inf) for each in sought}) > 1:
                    raise InputError(f"{span.where} are one law: give the snap of all of them the same limit")
                bounds[FUNCTIONALS[PEAKS[Kind.SNAP]]] = Range(0.0, most / span.unit(4))
            elif key.kind is not Kind.VELOCITY_ALONG:
                name, unit = "abcj"[key.kind.order], span.unit(key.kind.order)
                if key.kind.is_driven:
                    name, unit = DrivenSpan(span, known_drive(objective.drive)).along(key.kind)
                low, high = -most / unit, most / unit
                if key.sign:
                    low, high = (-inf, high) if key.sign * span.stroke > 0.0 else (low, inf)
                windows.append(Window(name, low, high, span.place(times[0]), span.place(times[-1])))
    return bounds, tuple(windows)


def forward_windows(span: LawSpan, of_each: Sequence[Sides | None]) -> Iterator[Window]:
    """Windows in which motions that must not turn back go on."""
    for limits, (_, start, stop) in zip(of_each, span.timed, strict=True):
        for key in limits or ():
            if key.kind is Kind.VELOCITY_ALONG:
                low, high = (0.0, inf) if key.sign * span.stroke < 0.0 else (-inf, 0.0)
                yield Window("b", low, high, span.place(start), span.place(stop))


def _straight_within(span: LawSpan, limits: Sides) -> bool:
    """Whether uniform motions keep the limits of the velocity."""
    return all(
        is_optimal(stretch.given)
        or abs(stretch.displacement) <= _fastest(limits, stretch.displacement) * (stop - start)
        for stretch, start, stop in span.timed
    )


def _fastest(limits: Sides, displacement: float) -> float:
    return greatest(limits, Kind.VELOCITY, -1.0 if displacement < 0.0 else 1.0)


def _check_mean(span: LawSpan, of_each: Sequence[Sides | None], axis: str) -> None:
    """Refuse a velocity limit that is no more than the mean velocity: such a law cannot start from rest."""
    for limits, (stretch, start, stop) in zip(of_each, span.timed, strict=True):
        most, mean = _fastest(limits or {}, stretch.displacement), abs(stretch.displacement) / (stop - start)
        if mean >= most:
            raise InfeasibleProblem(
                sentence(
                    "{}: {} in {} s are {} on average, but its velocity is to be at most {}: give it more time or a "
                    "wider limit",
                    stretch.where, in_small_units(abs(stretch.displacement), axis), f"{stop - start:.9g}",
                    in_small_units(mean, axis, "/s"), in_small_units(most, axis, "/s"),
                )
            )  # fmt: skip
