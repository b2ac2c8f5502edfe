"""Lower bounds of a cycle: of its spans by proofs or by energy, and of the whole with the given laws.

Power is the rate at which kinetic energy and the work against springs, weight and friction grow. From rest they are,
after the share k of a move, no more than k times the greatest power; what is left of them before the end, no more than
1 - k times it. Both are convex in the law where a spring pulls back, and viscous friction only helps the first: a
convex bound beneath a problem that is not convex.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from math import hypot, inf, sqrt
from typing import TYPE_CHECKING, Any

from optlaws.cycles.optimisation.objectives import SUMS, CycleObjective, kind_of
from optlaws.cycles.optimisation.span_values import (
    Driven,
    driven_mean,
    driven_peak,
    known_drive,
    may_turn,
    size_of,
    span_sum,
    total,
)
from optlaws.cycles.specification.joints import LawSpan, Layout
from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantity_kinds import Kind
from optlaws.synthesis.functionals.makers import peak, rms
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.expression import maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.search import limit_beside
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize

if TYPE_CHECKING:
    from optlaws.mechanisms.linkages.dimensionless import LinearForce

_NEAR_END = 0.02  # share of a move next to its ends where energies are small and say nothing


@dataclass(frozen=True)
class _Powers:
    """The terms of the power of a move in a unit: inertia b c + viscous b² + spring a b + constant b."""

    inertia: float
    viscous: float
    spring: float
    constant: float

    def fastest(self, most: float) -> float:
        """An upper bound of the velocity b of every law within this power over the whole move."""
        return (abs(self.constant) + sqrt(self.constant**2 + 2.0 * self.inertia * most)) / self.inertia

    def energies(self, fastest: float, *, forth: bool) -> tuple[Functional, Functional]:
        """Constants that are bounded by the peak power, for laws no faster than a given velocity."""
        kinetic, half = f"({0.5 * self.inertia!r})*b^2", 0.5 * self.spring
        gained = f"({kinetic} + ({self.constant!r})*a + ({half!r})*a^2)/k"
        # what is braked by friction needs no power: at most so much
        damped = f" - ({self.viscous * fastest!r})*(1 - a)" if forth else ""
        spared = "" if forth else f" - ({self.viscous * fastest**2!r})"
        lost = f"({kinetic} - ({self.constant!r})*(1 - a) - ({half!r})*(1 - a^2){damped})/(1 - k){spared}"
        return peak(gained, side="high", start=_NEAR_END), peak(lost, side="high", stop=1.0 - _NEAR_END)


def bound_by_energy(span: LawSpan, objective: CycleObjective, stroke: float, solution: Solution) -> float:
    """The lower bound of a span, dimensionless: the bound of its solution, or a better bound by energy."""
    least, (_, most) = kind_of(objective.minimise)[0] is Kind.POWER, objective.limits.get(Kind.POWER, (0.0, 0.0))
    if (
        solution.problem.convex
        or not (least or most)
        or objective.drive is None
        or objective.drive.linear is None
        or not _is_plain(span, objective.drive.linear)
    ):
        return solution.lower_bound
    unit = driven_peak(span, objective.drive, stroke, Kind.POWER).unit
    ceiling = min(solution.objective if least else inf, most / unit if most else inf)
    powers = _powers(span, objective.drive.linear, stroke, unit / objective.drive.ratio)
    try:
        relaxed = synthesize(_relaxed(solution.problem, powers, ceiling, least=least))
    except (InfeasibleProblem, SolverFailure):
        return solution.lower_bound
    # laws that are faster than the relaxed ones may be take more power than the one found
    return max(solution.lower_bound, min(relaxed.lower_bound, solution.objective))


def _relaxed(problem: Problem, powers: _Powers, ceiling: float, *, least: bool) -> Problem:
    """The problem with energies in place of the power, among laws no faster than the power permits."""
    fastest, known = powers.fastest(ceiling), problem.range("B")
    energies = powers.energies(fastest, forth=problem.monotone)
    convex = {
        constant: bounds_of_constant for constant, bounds_of_constant in problem.bounds.items() if constant.convex
    }
    bounds: dict[Any, Range] = convex if least else convex | dict.fromkeys(energies, Range(0.0, ceiling))
    most = Range(0.0, fastest if known is None else min(fastest, known.high))
    minimise = maximum(*energies) if least else problem.minimise
    return replace(problem, minimise=minimise, bounds=bounds, B=most, D=None)


def _powers(span: LawSpan, drive: LinearForce, stroke: float, unit: float) -> _Powers:
    way = factor(stroke, span.duration, 1)
    direction = 1.0 if span.displacement > 0.0 else -1.0
    constant = drive.constant + drive.stiffness * span.origin + drive.dry * direction
    inertia = drive.inertia * factor(stroke, span.duration, 2) * way
    parts = (inertia, drive.viscous * way**2, drive.stiffness * stroke * way, constant * way)
    return _Powers(*(part / unit for part in parts))


def _is_plain(span: LawSpan, drive: LinearForce) -> bool:
    """Whether a span is one move from rest to rest, with an inertia and no spring that pushes away."""
    resting = span.first.velocity == 0.0 == span.last.velocity
    return not may_turn(span) and resting and drive.inertia > 0.0 and drive.stiffness >= 0.0


Solved = Sequence[tuple[Piece, Solution]]


def bound_of(layout: Layout, solved: Solved, objective: CycleObjective, period: float) -> float | None:
    """The lower bound of a cycle in the same times, from bounds of optimised laws and values of the others."""
    kind, mean = kind_of(objective.minimise)
    if kind is Kind.LOAD and not solved:
        return None
    if kind is Kind.LOAD:
        ((piece, solution),) = solved
        return solution.lower_bound * abs(piece.stroke)
    sizes = [
        (piece.duration, span_bound(layout.spans[i], *solved[i], objective)) for i, (piece, _) in enumerate(solved)
    ]
    if kind in SUMS:
        return sum(bound for _, bound in sizes) + total(layout.pieces, kind, objective.drive)
    drive = None if kind.order else known_drive(objective.drive)
    sizes += [(piece.duration, size_of(piece, kind, drive, mean=mean)) for piece in layout.pieces]
    if not mean:
        return max(size for _, size in sizes)
    return reduce(hypot, (size * sqrt(time / period) for time, size in sizes), 0.0)


def span_bound(span: LawSpan, piece: Piece, solution: Solution, objective: CycleObjective) -> float:
    """The lower bound of a span in SI units."""
    kind, mean = kind_of(objective.minimise)
    if kind in SUMS:
        return span_sum(span, kind, objective.drive, piece.stroke).bound(solution, exact=is_exact(span, objective))
    least = bound_by_energy(span, objective, piece.stroke, solution) if is_exact(span, objective) else 0.0
    if kind.order:
        return least * abs(factor(piece.stroke, piece.duration, kind.order))
    effort = _driven(span, objective, piece.stroke)
    makers = rms if mean else peak
    limits = (limit_beside(replace(solution.problem, minimise=makers(formula))) for formula in effort.beneath)
    proven = [limit.value for limit in limits if limit is not None]
    # neither a peak nor a mean is below 0, whether or not anything is proven
    return hypot(max(least, 0.0, *proven) * effort.unit, sqrt(max(effort.friction, 0.0)))


def _driven(span: LawSpan, objective: CycleObjective, stroke: float) -> Driven:
    kind, mean = kind_of(objective.minimise)
    if mean:
        return driven_mean(span, objective.drive, stroke)
    return driven_peak(span, objective.drive, stroke, kind)


def is_exact(span: LawSpan, objective: CycleObjective) -> bool:
    """Whether objective and limits are exact, not upper estimates: only then their bounds hold.

    Peaks behind a gear with losses are counted as if power flowed back wherever the motor brakes.
    """
    drive, (kind, mean) = objective.drive, kind_of(objective.minimise)
    if drive is None or not drive.train.loses or drive.brakes_as_it_drives:
        return True
    limited = (key.kind for stretch in span.stretches for key in stretch.sides(objective.limits))
    return not any(each.is_driven for each in limited) and (mean or not kind.is_driven)
