"""Which rows of boxes a problem has: those of its power, of a body that shares its energy, or of formulas."""

from __future__ import annotations

from collections.abc import Sequence

from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.power import formula_underestimators, rows, shared_energy
from optlaws.synthesis.proof.power.box import BoxRows

_KINDS = (
    (shared_energy.applies, shared_energy.EnergyRows),
    (rows.applies, rows.PowerRows),
    (formula_underestimators.applies, formula_underestimators.FormulaRows),
)


def rows_of(problem: Problem, claim: float, points: Sequence[float]) -> BoxRows | None:
    """The rows of a problem under a claim; None where nothing of it can be bounded by boxes."""
    return next((kind(problem, claim, points) for applies, kind in _KINDS if applies(problem)), None)
