"""The optimal laws of a cycle with given durations: a problem for each span, with its status and its proof.

Where durations are fixed and spans are parted by joints that are known, the cycle decouples: the greatest of the least
peaks is the least of the greatest ones, and the least sum of squares is the sum of the least ones.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from math import inf, sqrt
from operator import itemgetter
from typing import Any

from optlaws.cycles.optimisation.objectives import SUMS, CycleObjective, kind_of
from optlaws.cycles.optimisation.search_spaces import (
    halved,
    joined_basis,
    joint_windows,
    minimised_rms,
    place,
    search_space,
    splines_of_least_rms,
)
from optlaws.cycles.optimisation.span_values import (
    Driven,
    driven_curve,
    driven_formula,
    driven_mean,
    driven_peak,
    may_turn,
    span_sum,
)
from optlaws.cycles.specification.joints import LawSpan, State
from optlaws.cycles.specification.limits import Side, Sides, along_motion, greatest, in_units
from optlaws.cycles.specification.load import load_output
from optlaws.cycles.specification.programme import is_optimal
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantities import in_small_units
from optlaws.motion.quantity_kinds import Kind
from optlaws.sentences import sentence
from optlaws.synthesis.functionals.makers import integral, peak
from optlaws.synthesis.problem.constants import FUNCTIONALS, Functional
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.search import limit_beside
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Chebyshev, Pieces
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.status import Status
from optlaws.tolerances import AGREEMENT

_PEAKS = {Kind.VELOCITY: "B", Kind.ACCELERATION: "C", Kind.JERK: "J", Kind.SNAP: "snap"}
_SNAP = Side(Kind.SNAP)
_ROUGH = 15  # degree of Z where points on the way or velocities bend the law


def solve(span: LawSpan, objective: CycleObjective, axis: str, share: float = inf) -> tuple[Piece, Solution]:
    """The best law of a span, in its place, with its proof; it takes no more than its share of a limit of the cycle."""
    stroke = scale(span)
    problem = span_problem(span, objective, axis, stroke)
    if share < inf:
        problem = with_share(problem, span, objective, stroke, share)
    solution = _unhindered(problem, span, objective, stroke)
    if solution is None:
        solution = solved(problem, span)
        if isinstance(problem.basis, Pieces) and (solution.status == Status.INACCURATE or objective.of_load):
            finer = _with_more_pieces(problem, problem.basis, span)
            if finer is not None and (solution.status == Status.INACCURATE or finer.objective < solution.objective):
                solution = finer
    return Piece(span.start, span.duration, span.offset, stroke, solution.law), solution


def _unhindered(problem: Problem, span: LawSpan, objective: CycleObjective, stroke: float) -> Solution | None:
    """The solution with the least RMS of all motions, where it is known in what space that lies and limits allow it."""
    nu = minimised_rms(problem) if isinstance(problem.basis, Pieces) else None
    splines = None if nu is None else splines_of_least_rms(span, objective.order, nu)
    if splines is None:
        return None
    limited = replace(problem, basis=splines)
    windows = tuple(joint_windows(span, objective.order, stroke))
    free = replace(limited, windows=windows, bounds={}, B=None, C=None, D=None, J=None)
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
    if finer is None:
        return None
    try:
        solution = solved(replace(problem, basis=finer), span)
    except SolverFailure:
        return None
    return solution if solution.status == Status.OPTIMAL else None


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


def with_least_limit(
    error: InfeasibleProblem, span: LawSpan, objective: CycleObjective, axis: str
) -> InfeasibleProblem:
    """The error of a span without a law, saying in units of the machine what one limit would have to allow at least."""
    stroke = scale(span)
    problem = span_problem(span, objective, axis, stroke)
    for key, most in span.stretches[0].sides(objective.limits).items():
        if key.kind is Kind.VELOCITY_ALONG:
            continue
        limited = limited_by(span, objective, stroke, key)
        limit = problem.range(limited.constants[0].name)
        others = {other: best for other, best in problem.bounded if other not in limited.constants}
        free = replace(problem, minimise=limited.objective, bounds={}, B=None, C=None, D=None, J=None)
        try:
            least = synthesize(replace(free, bounds=others)).lower_bound
        except (InfeasibleProblem, SolverFailure):
            continue
        if limit is not None and least > limit.high:
            allowed, needed = (in_units(key, value, axis) for value in (most, least / limit.high * most))
            space = search_space(problem, span, objective.order)
            proven = (
                _whatever_degree(replace(problem, minimise=limited.objective), limited) if key.kind.is_driven else None
            )
            beyond = ""
            if proven is not None and proven > limit.high:
                greater = in_units(key, proven / limit.high * most, axis)
                beyond = sentence("; no law that never turns back, of whatever degree, takes less than {}", greater)
            return InfeasibleProblem(
                sentence(
                    "{}: no law keeps its limits in {} s: among {} the least is {}, but its limit is {}{}: give it "
                    "more time, a wider limit or a higher degree",
                    span.where,
                    f"{span.duration:.9g}",
                    space,
                    needed,
                    allowed,
                    beyond,
                ),
                problem=problem,
                tried=error.tried,
                proof=error.proof,
            )
    return error


def _whatever_degree(problem: Problem, driven: Driven) -> float | None:
    """The infimum of a drive's peak over all laws that never turn back; None where it is not known."""
    free = replace(problem, bounds={}, B=None, C=None, D=None, J=None)
    peaks: list[Any] = [peak(formula) for formula in driven.beneath] or [problem.minimise]
    limits = (limit_beside(replace(free, minimise=each, symmetric=False, monotone=True)) for each in peaks)
    return max((limit.value for limit in limits if limit is not None), default=None)


def with_share(problem: Problem, span: LawSpan, objective: CycleObjective, stroke: float, share: float) -> Problem:
    """The problem of a span of which the squared force, or the energy, is at most a share, in SI units."""
    monotone = problem.monotone or never_back(span, objective)
    if objective.mean_force is None:
        energy = span_sum(span, Kind.ENERGY, objective.drive, stroke)
        bounds = {**problem.bounds, integral(energy.formula): Range(0.0, (share - energy.constant) / energy.unit)}
        return replace(problem, bounds=bounds, monotone=monotone, symmetric=False)
    driven, most = driven_mean(span, objective.drive, stroke), share / span.duration
    if most <= driven.friction:
        raise InfeasibleProblem(
            f"{span.where}: dry friction alone takes an rms force of {sqrt(driven.friction):.9g}, more than what is "
            f"left for it, {sqrt(max(most, 0.0)):.9g}: allow more, or give the cycle more time"
        )
    bounds = {**problem.bounds, driven.constants[0]: Range(0.0, sqrt(most - driven.friction) / driven.unit)}
    return replace(problem, bounds=bounds, monotone=monotone, symmetric=False)


def never_back(span: LawSpan, objective: CycleObjective) -> bool:
    """Whether a span's law is never to go back, so that dry friction is a constant force and limits of drives hold."""
    drive = objective.drive
    if drive is None or may_turn(span):
        return False
    summed = kind_of(objective.minimise)[0] in SUMS or objective.energy is not None
    return drive.linear is None or drive.mechanism.has_end or drive.dry > 0.0 or summed


def scale(span: LawSpan) -> float:
    """The scale of a span's law: its displacement or, if that is zero, the greatest distance on the way."""
    if span.displacement:
        return span.displacement
    ways = [abs(position - span.offset) for _, position in span.via]
    known = (edge_state for edge_state in (span.first, span.last, *span.states) if edge_state is not None)
    ways += [abs(state.velocity) * span.duration for state in known]
    return max(ways)


def span_problem(span: LawSpan, objective: CycleObjective, axis: str, stroke: float) -> Problem:
    """The dimensionless problem of a span."""
    if stroke == 0.0:
        raise InputError(f"{span.where} has nothing to move: take a Dwell")
    if span.turns or len(span.stretches) > 1 or span.via:
        return _problem_of_several(span, objective, axis, stroke)
    ends = _ends(span, stroke, objective.order)
    plain = not any(any(end[1:]) for end in (ends.start, ends.end))
    bounds, parts = _limits(span, objective, axis, stroke)
    limits = span.stretches[0].sides(objective.limits)
    _check_energy(span, objective, limits)
    minimised = kind_of(objective.minimise)[0]
    forced = minimised.is_driven or minimised in SUMS or any(key.kind.is_driven for key in limits)
    sided = any(key.sign and key.kind is not Kind.VELOCITY_ALONG for key in limits)
    return Problem(
        order=objective.order,
        basis=Chebyshev(objective.degree if plain else max(objective.degree, _ROUGH)),
        minimise=_objective(span, objective, stroke),
        monotone=(forced and never_back(span, objective)) or along_motion(limits) or _follows_curve(span, limits),
        symmetric=plain and not forced and not sided and not parts,
        boundary=ends,
        windows=parts,
        bounds=bounds,
    )


def _follows_curve(span: LawSpan, limits: Sides) -> bool:
    """Whether a motor's curve limits a motion between rests, which falls with a speed of one sign."""
    return Side(Kind.CURVE) in limits and not may_turn(span)


def _check_energy(span: LawSpan, objective: CycleObjective, limits: Sides) -> None:
    """Refuse a least energy without a bound on the acceleration: the energy falls as accelerations grow."""
    if kind_of(objective.minimise)[0] is Kind.ENERGY and not any(_holds_acceleration(key) for key in limits):
        raise InputError(
            f"{span.where}: its energy falls with ever greater accelerations, so that none is least: give a limit of "
            "the acceleration, or of the force or torque"
        )


def _holds_acceleration(key: Side) -> bool:
    """Whether a limit bounds the acceleration: any limit except a limit of the velocity or of one side alone."""
    return not key.sign and key.kind is not Kind.VELOCITY


def _problem_of_several(span: LawSpan, objective: CycleObjective, axis: str, stroke: float) -> Problem:
    """The problem of a single law over several stretches, or through points on the way."""
    bounds, parts = _limits(span, objective, axis, stroke)
    minimised, highest = kind_of(objective.minimise)[0], _highest_limited(span, objective)
    if objective.of_load:
        minimised = Kind.LOAD
    elif Kind.POWER in objective.limits or minimised is Kind.ENERGY:
        minimised = Kind.POWER
    elif highest > minimised.order:
        minimised = Kind(highest)
    bounds |= {
        _of_load(objective, *output, span): Range(0.0, most / abs(stroke)) for output, most in objective.loaded.items()
    }
    first = (span.offset - span.origin) / stroke
    plain = BoundaryConditions((first,), (first + span.displacement / stroke,))
    return Problem(
        order=1 if span.turns else objective.order,
        basis=joined_basis(span, objective.order, objective.degree, minimised),
        minimise=_objective(span, objective, stroke),
        symmetric=False,
        boundary=plain if span.turns else _ends(span, stroke, objective.order),
        windows=(
            *joint_windows(span, objective.order, stroke),
            *forward_windows(span, objective, stroke),
            *parts,
        ),
        bounds=bounds,
    )


def _highest_limited(span: LawSpan, objective: CycleObjective) -> int:
    """The order of the highest limited derivative from the jerk on, whose peaks are to be at breaks; else 0."""
    keys = (key for stretch in span.stretches for key in stretch.sides(objective.limits))
    return max((key.kind.order for key in keys if key.kind.order > 2), default=0)


def _ends(span: LawSpan, stroke: float, order: int) -> BoundaryConditions:
    first, last = (_end(state, span.duration, stroke, order) for state in (span.first, span.last))
    return BoundaryConditions((0.0, *first), (span.displacement / stroke, *last))


def _end(state: State, duration: float, stroke: float, order: int) -> tuple[float, ...]:
    values = [value / factor(stroke, duration, nu) + 0.0 for nu, value in enumerate(state, start=1)]
    return tuple((values + [0.0] * order)[: order - 1])


def _limits(
    span: LawSpan, objective: CycleObjective, axis: str, stroke: float
) -> tuple[dict[Any, Range], tuple[Window, ...]]:
    """Limits of the whole span as bounds of its constants, limits of parts of it as windows."""
    _check_mean(span, objective, axis)
    of_each = [stretch.sides(objective.limits) if is_optimal(stretch.given) else None for stretch in span.stretches]
    sought = [limits for limits in of_each if limits is not None]
    if all(limits == sought[0] for limits in sought) and _straight_within(span, sought[0]):
        bounded = ((key, most) for key, most in sought[0].items() if key.kind is not Kind.VELOCITY_ALONG)
        of_limits = ((limited_by(span, objective, stroke, key), most) for key, most in bounded)
        ranges = ((known.constants, Range(0.0, most / known.unit)) for known, most in of_limits)
        return {constant: allowed for constants, allowed in ranges for constant in constants}, ()
    bounds, windows = dict[Any, Range](), list[Window]()
    for limits, start, stop in _alike(of_each, (*span.starts, span.stop)):
        for key, most in limits.items():
            if key.kind is Kind.CURVE:
                known = driven_curve(span, objective.drive, stroke)
                bounds |= dict.fromkeys(known.constants, Range(0.0, most / known.unit))
            elif key == _SNAP:
                bounds[FUNCTIONALS[_PEAKS[Kind.SNAP]]] = Range(0.0, _snap_of_all(span, sought) / _unit(span, stroke, 4))
            elif key.kind is not Kind.VELOCITY_ALONG:
                windows.append(_window(span, objective, stroke, key, most, (place(span, start), place(span, stop))))
    return bounds, tuple(windows)


def limited_by(span: LawSpan, objective: CycleObjective, stroke: float, key: Side) -> Driven:
    """The constants of a whole span's law that a limit bounds, with their unit in SI."""
    nu = key.kind.order
    if key.sign:
        sign = key.sign * (1.0 if stroke > 0.0 else -1.0)
        one_sided = FUNCTIONALS["C_plus" if sign > 0.0 else "C_minus"] if nu == 2 else None
        constant = one_sided or peak("abcj"[nu], side="high" if sign > 0.0 else "low")
        return Driven((constant,), _unit(span, stroke, nu))
    if key.kind is Kind.CURVE:
        return driven_curve(span, objective.drive, stroke)
    if key.kind.is_driven:
        return driven_peak(span, objective.drive, stroke, key.kind)
    return Driven((FUNCTIONALS[_PEAKS[key.kind]],), _unit(span, stroke, nu))


def _window(
    span: LawSpan, objective: CycleObjective, stroke: float, key: Side, most: float, ends: tuple[float, float]
) -> Window:
    """A limit of a part of a span as a window of its law."""
    nu = key.kind.order
    if key.sign:
        most /= _unit(span, stroke, nu)
        high = key.sign * stroke > 0.0
        return Window("abcj"[nu], -inf if high else -most, most if high else inf, *ends)
    if key.kind.is_driven:
        name, unit = driven_formula(span, objective.drive, stroke, key.kind)
    else:
        name, unit = "abcj"[nu], _unit(span, stroke, nu)
    return Window(name, -most / unit, most / unit, *ends)


def forward_windows(span: LawSpan, objective: CycleObjective, stroke: float) -> Iterator[Window]:
    """Windows in which motions that must not turn back go on."""
    for stretch, start, stop in span.timed:
        limits = stretch.sides(objective.limits) if is_optimal(stretch.given) else {}
        for key in (key for key in limits if key.kind is Kind.VELOCITY_ALONG):
            sides = (0.0, inf) if key.sign * stroke < 0.0 else (-inf, 0.0)
            yield Window("b", *sides, place(span, start), place(span, stop))


def _snap_of_all(span: LawSpan, sought: Sequence[Sides]) -> float:
    """The snap limit of a law over several stretches, which must be the same in each."""
    given = {limits.get(_SNAP, inf) for limits in sought}
    if len(given) > 1:
        raise InputError(f"{span.where} are one law: give the snap of all of them the same limit")
    return given.pop()


def _of_load(objective: CycleObjective, output: str, mean: bool, span: LawSpan) -> Functional:  # noqa: FBT001 - the second of a pair
    if objective.load is None:
        raise AssertionError  # what is asked of a load is read with it
    return objective.load.constant(output, span.duration, mean=mean)


def _straight_within(span: LawSpan, limits: Sides) -> bool:
    """Whether uniform motions keep the limits of the velocity."""
    return all(
        is_optimal(stretch.given)
        or abs(stretch.displacement) <= greatest(limits, Kind.VELOCITY, _sign(stretch.displacement)) * (stop - start)
        for stretch, start, stop in span.timed
    )


def _sign(displacement: float) -> float:
    return -1.0 if displacement < 0.0 else 1.0


def _alike(of_each: Sequence[Sides | None], times: Sequence[float]) -> Iterator[tuple[Sides, float, float]]:
    """Limits of stretches from where to where they are the same."""
    for limits, several in groupby(zip(of_each, times, times[1:], strict=False), key=itemgetter(0)):
        parts = list(several)
        if limits is not None:
            yield limits, parts[0][1], parts[-1][2]


def _check_mean(span: LawSpan, objective: CycleObjective, axis: str) -> None:
    """Refuse a velocity limit that is no more than the mean velocity: such a law cannot start from rest."""
    for stretch, start, stop in span.timed:
        limits = stretch.sides(objective.limits) if is_optimal(stretch.given) else {}
        most, mean = (
            greatest(limits, Kind.VELOCITY, _sign(stretch.displacement)),
            abs(stretch.displacement) / (stop - start),
        )
        if mean >= most:
            raise InfeasibleProblem(
                sentence(
                    "{}: {} in {} s are {} on average, but its velocity is to be at most {}: give it more time or a "
                    "wider limit",
                    stretch.where, in_small_units(abs(stretch.displacement), axis), f"{stop - start:.9g}",
                    in_small_units(mean, axis, "/s"), in_small_units(most, axis, "/s"),
                )
            )  # fmt: skip


def _unit(span: LawSpan, stroke: float, nu: int) -> float:
    """The unit of a derivative of a span's law."""
    return abs(factor(stroke, span.duration, nu))


def _objective(span: LawSpan, objective: CycleObjective, stroke: float) -> Any:
    kind, mean = kind_of(objective.minimise)
    if kind.order:
        return {2: "rms_c", 3: "rms_j", 4: "rms_snap"}[kind.order] if mean else _PEAKS[kind]
    output = load_output(objective.minimise, objective.load) if kind is Kind.LOAD else None
    if output is not None:
        return _of_load(objective, *output, span)
    if mean:
        return driven_mean(span, objective.drive, stroke).objective
    if kind in SUMS:
        return integral(span_sum(span, kind, objective.drive, stroke).formula)
    return driven_peak(span, objective.drive, stroke, kind).objective
