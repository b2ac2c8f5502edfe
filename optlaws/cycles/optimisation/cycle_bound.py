"""What no other laws of a whole cycle can beat, from the bounds of its spans and what given laws take."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial, reduce
from math import hypot, sqrt

from optlaws.cycles.drive.drive import read_drive
from optlaws.cycles.drive.effort import effort
from optlaws.cycles.optimisation.drive_formulas import driven_mean, driven_peak
from optlaws.cycles.optimisation.objectives import FORCE, LOADED, POWER, CycleObjective, kind_of
from optlaws.cycles.optimisation.power_bound import bound_by_energy
from optlaws.cycles.specification.joints import LawSpan, Layout
from optlaws.motion.piece import Piece, factor
from optlaws.synthesis.solution import Solution

Solved = Sequence[tuple[Piece, Solution]]


def bound_of(layout: Layout, solved: Solved, objective: CycleObjective, period: float) -> float | None:
    """What no other laws in the same times can beat: bounds of those looked for, and what the others take."""
    nu, mean = kind_of(objective.minimise)
    if nu == LOADED and not solved:
        return None
    if nu == LOADED:
        ((piece, solution),) = solved
        return solution.lower_bound * abs(piece.stroke)
    sizes = [
        (piece.duration, span_bound(layout.spans[i], *solved[i], objective)) for i, (piece, _) in enumerate(solved)
    ]
    sizes += [(piece.duration, _taken(piece, objective)) for piece in layout.pieces]
    if not mean:
        return max(size for _, size in sizes)
    return reduce(hypot, (size * sqrt(time / period) for time, size in sizes), 0.0)


def span_bound(span: LawSpan, piece: Piece, solution: Solution, objective: CycleObjective) -> float:
    """What no other law of a span can beat, in SI units."""
    nu, mean = kind_of(objective.minimise)
    least = bound_by_energy(span, objective, piece.stroke, solution)
    if nu not in {FORCE, POWER}:
        return least * abs(factor(piece.stroke, piece.duration, nu))
    driven = driven_mean if mean else partial(driven_peak, nu=nu)
    effort = driven(span, objective.drive, piece.stroke)
    # neither a peak nor a mean is below 0, whether or not anything is proven
    return hypot(max(least, 0.0) * effort.unit, sqrt(max(effort.friction, 0.0)))


def _taken(piece: Piece, objective: CycleObjective) -> float:
    """What a law that was given takes, in SI units."""
    nu, mean = kind_of(objective.minimise)
    if nu in {FORCE, POWER}:
        taken = effort(objective.drive or read_drive({}, "length"), [piece], piece.duration)
        return taken.peak_power if nu == POWER else taken.rms_force if mean else taken.peak_force
    constant = piece.law.rms(nu) if mean else piece.law.peak(nu).value
    return constant * abs(factor(piece.stroke, piece.duration, nu)) if piece.stroke else 0.0
