"""The rows of a problem under a claim, and their consequences for a derivative at a place and around it.

The place of a peak with a lower bound is not known, and the problem is not convex. But for each place k the greatest
value of laws below the claim is a convex problem, and contacts bound it. At a peak inside the interval the
slope is 0, so the value beside it is less by the curvature at most, which the claim bounds too: places around k can
have no peak if the bound at k and that remainder do not reach its lower bound.
"""

from __future__ import annotations

from dataclasses import replace
from math import factorial, inf

import numpy as np

from optlaws.synthesis.families.family import LinearFamily
from optlaws.synthesis.problem.constants import FUNCTIONALS, PeakConstant
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.duality import Sublevel, lines_of, moments, sum_of_rows
from optlaws.synthesis.proof.nodes import Leaf, Node, PlaceRange
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.tolerances import VALUE_ROUNDING

CLAIM = "claim"
#: more than the rounding of the claim's own row, and of the curvature
_UPWARD, _AMPLE = 1.0 + 2.0**-50, 1.0 + 2.0**-20


def peak_of(problem: Problem, name: str) -> PeakConstant | None:
    """The peak of that name, where a lower bound of it can be proven: for polynomial laws of convex problems."""
    constant, limits = FUNCTIONALS.get(name), problem.range(name)
    if not isinstance(constant, PeakConstant) or limits is None or limits.low <= 0.0:
        return None
    return constant if problem.convex and isinstance(problem.basis, PolynomialBasis) else None


def roots_of(problem: Problem, name: str) -> list[PlaceRange]:
    """The places of possible peaks, the last ones first; an end, where the slope may be nonzero, is separate.

    The first half says all if laws are symmetric, or if their mirror images are laws too.
    """
    peak = peak_of(problem, name)
    if peak is None:
        return []
    half = problem.symmetric or problem.mirrored
    ranges = ((0.0, 0.5), (0.0, 0.0)) if half else ((0.0, 1.0), (0.0, 0.0), (1.0, 1.0))
    signs = (1.0, -1.0) if half and peak.nu % 2 == 0 else peak.signs
    return [PlaceRange(sign, *ends) for sign in reversed(signs) for ends in ranges]


class PeakRows:
    """Rows for the values of a derivative in laws below a claim."""

    def __init__(self, problem: Problem, peak: PeakConstant, claim: float) -> None:
        self.problem, self.peak, self.claim = problem, peak, claim
        limits = problem.range(peak.name)
        self.low = inf if limits is None else limits.low
        self.model = model_of(problem)
        unit = self.model.unit
        row = LinearFamily.of_row(CLAIM, unit * self.model.program.objective, claim * _UPWARD, unit=unit)
        self._program = replace(self.model.program, families=(*self.model.program.families, row))
        self._moments = moments(self.model, Sublevel.of(self.model).greatest_values(claim))
        self._curvatures: dict[float, list[float]] = {}

    def roots(self) -> list[PlaceRange]:
        """The places at which laws may have the peak."""
        return roots_of(self.problem, self.peak.name)

    def after(self, here: PlaceRange, node: Node) -> list[PlaceRange] | None:
        """The ranges that remain of a range after a node; None if it is no node of places."""
        if type(node) is Leaf:
            return [] if self.excluded(here, node) else [here]
        return here.after(node)

    def excluded(self, here: PlaceRange, leaf: Leaf) -> bool:
        """Whether a leaf shows that no law below the claim has the peak within a range."""
        most = self.upper(here.k, here.sign, leaf) + self.remainder(here.k, here.reach)
        return most < self.low * (1.0 - VALUE_ROUNDING)

    def at(self, k: float, sign: float) -> tuple[Model, float]:
        """The program that minimises -sign times the derivative at k, and the constant part of the derivative."""
        row = self.model.space.row(self.peak.nu, k)
        objective = np.zeros(self._program.size)
        objective[: self.model.space.terms] = -sign * row[:-1]
        program = replace(self._program, objective=objective, unit=1.0)
        return replace(self.model, program=program), sign * float(row[-1])

    def upper(self, k: float, sign: float, leaf: Leaf) -> float:
        """Most that sign times the derivative at k can be in laws below the claim, by weak duality."""
        model, base = self.at(k, sign)
        program = model.program
        # as a row, the rounding of the objective is counted too
        lines = [*lines_of(program, leaf), (1.0, program.objective, 0.0)]
        nothing = replace(model, program=replace(program, objective=np.zeros(program.size)))
        with np.errstate(over="ignore", invalid="ignore"):
            least = sum_of_rows(nothing, lines, self.claim)
        return base - least if np.isfinite(least) else inf

    def remainder(self, k: float, reach: float) -> float:
        """Most by which a peak within reach of k can be above the value at k."""
        if reach == 0.0:
            return 0.0
        curvature = sum(coefficient * reach**i for i, coefficient in enumerate(self._curvature(k)))
        return reach * reach / 2.0 * curvature * _AMPLE

    def _curvature(self, k: float) -> list[float]:
        """Coefficients of a polynomial in the reach that bounds the second derivative within it, by Taylor at k."""
        if k not in self._curvatures:
            highest = self.model.space.quadrature(0).moments.shape[1]
            orders = range(self.peak.nu + 2, max(highest, self.peak.nu + 2) + 1)
            self._curvatures[k] = [self._magnitude(nu, k) / factorial(i) for i, nu in enumerate(orders)]
        return self._curvatures[k]

    def _magnitude(self, nu: int, k: float) -> float:
        row = self.model.space.row(nu, k)
        reaches = (float(np.abs(extension @ row[:-1]) @ most) for most, extension in self._moments)
        return abs(float(row[-1])) + min(reaches, default=inf)
