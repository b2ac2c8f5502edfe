"""Which rows of boxes a problem has: those of its power, of a body that shares its energy, or of formulas."""

from __future__ import annotations

from collections.abc import Sequence

from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.power import beneath_formulas, rows, shared_energy
from optlaws.synthesis.proof.power.box import BoxRows


def rows_of(problem: Problem, claim: float, points: Sequence[float]) -> BoxRows | None:
    """The rows of a problem under a claim; None where nothing of it can be bounded by boxes."""
    if shared_energy.applies(problem):
        return shared_energy.EnergyRows(problem, claim, points)
    if rows.applies(problem):
        return rows.PowerRows(problem, claim, points)
    return beneath_formulas.FormulaRows(problem, claim, points) if beneath_formulas.applies(problem) else None
