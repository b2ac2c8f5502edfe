"""What no other laws of a whole cycle can beat, from the bounds of its spans and what given laws take."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from math import hypot, sqrt

from optlaws.cycles.asked.conversion import Piece, factor
from optlaws.cycles.asked.joints import Layout
from optlaws.cycles.best.aims import FORCE, LOADED, Wanted, kind_of
from optlaws.cycles.best.optimal import force_unit
from optlaws.cycles.driven.effort import effort
from optlaws.synthesis.solution import Solution

Solved = Sequence[tuple[Piece, Solution]]


def bound_of(layout: Layout, solved: Solved, wanted: Wanted, period: float) -> float | None:
    """What no other laws in the same times can beat: bounds of those looked for, and what the others take."""
    nu, mean = kind_of(wanted.minimise)
    if nu == LOADED:
        ((piece, solution),) = solved
        return solution.lower_bound * abs(piece.stroke)
    if nu == FORCE and wanted.drive is None:
        return 0.0
    sizes = [(piece.duration, _bound(layout, i, solved[i], wanted)) for i, (piece, _) in enumerate(solved)]
    sizes += [(piece.duration, _taken(piece, wanted)) for piece in layout.pieces]
    if not mean:
        return max(size for _, size in sizes)
    return reduce(hypot, (size * sqrt(time / period) for time, size in sizes), 0.0)


def _bound(layout: Layout, i: int, solved: tuple[Piece, Solution], wanted: Wanted) -> float:
    """What no other law of a span can beat, in SI units."""
    piece, solution = solved
    nu, _ = kind_of(wanted.minimise)
    if nu == FORCE and wanted.drive is not None:
        return solution.lower_bound * force_unit(layout.spans[i], wanted.drive, piece.stroke)
    return solution.lower_bound * abs(factor(piece.stroke, piece.duration, nu))


def _taken(piece: Piece, wanted: Wanted) -> float:
    """What a law that was given takes, in SI units."""
    nu, mean = kind_of(wanted.minimise)
    if nu == FORCE and wanted.drive is not None:
        taken = effort(wanted.drive, [piece], piece.duration)
        return taken.rms_force if mean else taken.peak_force
    constant = piece.law.rms(nu) if mean else piece.law.peak(nu).value
    return constant * abs(factor(piece.stroke, piece.duration, nu)) if piece.stroke else 0.0
