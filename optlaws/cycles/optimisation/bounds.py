"""Lower bounds of a cycle: of its spans by proofs or by energy, and of the whole with the given laws.

Power is the rate at which kinetic energy and the work against springs, weight and friction grow. From rest they are,
after the share k of a move, no more than k times the greatest power; what is left of them before the end, no more than
1 - k times it. Both are convex in the law where a spring pulls back, and viscous friction only helps the first: a
convex bound beneath a problem that is not convex.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import reduce
from math import hypot, inf, sqrt
from typing import TYPE_CHECKING, Any

from optlaws.cycles.optimisation.objectives import SUMS, CycleObjective
from optlaws.cycles.optimisation.span_values import known_drive, size_of, span_value, total
from optlaws.cycles.specification.joints import LawSpan, Layout
from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantities import Kind
from optlaws.synthesis.functionals.makers import peak
from optlaws.synthesis.problem.expression import maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize

if TYPE_CHECKING:
    from optlaws.mechanisms.linkages.dimensionless import LinearForce

_NEAR_END = 0.02  # share of a move next to its ends where energies are small and say nothing

Solved = Sequence[tuple[Piece, Solution]]


def bound_by_energy(span: LawSpan, objective: CycleObjective, solution: Solution) -> float:
    """The lower bound of a span, dimensionless: the bound of its solution, or a better bound by energy."""
    least, (_, most) = objective.kind is Kind.POWER, objective.limits.get(Kind.POWER, (0.0, 0.0))
    drive, resting = objective.drive, span.first.velocity == 0.0 == span.last.velocity
    linear = None if drive is None or span.may_turn or not resting else drive.linear
    # one move from rest to rest, with an inertia and no spring that pushes away
    plain = linear is not None and linear.inertia > 0.0 and linear.stiffness >= 0.0
    if solution.problem.convex or not (least or most) or not plain or drive is None or linear is None:
        return solution.lower_bound
    unit = span_value(span, drive, Kind.POWER).unit
    ceiling = min(solution.objective if least else inf, most / unit if most else inf)
    try:
        relaxed = synthesize(_relaxed(span, linear, solution.problem, unit / drive.ratio, ceiling, least=least))
    except (InfeasibleProblem, SolverFailure):
        return solution.lower_bound
    # laws that are faster than the relaxed ones may be take more power than the one found
    return max(solution.lower_bound, min(relaxed.lower_bound, solution.objective))


def _relaxed(
    span: LawSpan, drive: LinearForce, problem: Problem, unit: float, ceiling: float, *, least: bool
) -> Problem:
    """The problem with energies in place of the power, among laws no faster than the power permits."""
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
    energies = peak(gained, side="high", start=_NEAR_END), peak(lost, side="high", stop=1.0 - _NEAR_END)
    known = problem.range("B")
    convex = {constant: allowed for constant, allowed in problem.bounds.items() if constant.convex}
    bounds: dict[Any, Range] = convex if least else convex | dict.fromkeys(energies, Range(0.0, ceiling))
    most = Range(0.0, fastest if known is None else min(fastest, known.high))
    minimise = maximum(*energies) if least else problem.minimise
    return replace(problem, minimise=minimise, bounds=bounds, B=most, D=None)


def bound_of(layout: Layout, solved: Solved, objective: CycleObjective, period: float) -> float | None:
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
    """The lower bound of a span in SI units."""
    exact = is_exact(span, objective)
    value = span_value(span, objective.drive, objective.kind, mean=objective.mean)
    if value.summed:
        return value.bound(solution.problem, solution.lower_bound if exact else -inf)
    return value.bound(solution.problem, bound_by_energy(span, objective, solution) if exact else 0.0)


def is_exact(span: LawSpan, objective: CycleObjective) -> bool:
    """Whether objective and limits are exact, not upper estimates: only then their bounds hold.

    Peaks behind a gear with losses are counted as if power flowed back wherever the motor brakes.
    """
    drive = objective.drive
    if drive is None or not drive.train.loses or drive.brakes_as_it_drives:
        return True
    limited = (key.kind for limits in span.sides(objective.limits) for key in limits or ())
    return not any(kind.is_driven for kind in limited) and (objective.mean or not objective.kind.is_driven)
