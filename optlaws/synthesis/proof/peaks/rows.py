"""The rows of a problem under a claim, and what they say of a derivative at one place and around it."""

from __future__ import annotations

from dataclasses import replace
from math import factorial, inf

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.family import LinearFamily
from optlaws.synthesis.problem.constants import FUNCTIONALS, Peak
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.below_claim import greatest_values, moments
from optlaws.synthesis.proof.certificate import Contact, lines_of
from optlaws.synthesis.proof.duality import sum_of_rows
from optlaws.synthesis.spaces.bases import PolynomialBasis

Array = NDArray[np.float64]

CLAIM = "claim"
#: more than the rounding of the claim's own row, and of the curvature
_UPWARD, _AMPLE = 1.0 + 2.0**-50, 1.0 + 2.0**-20


def peak_of(problem: Problem, name: str) -> Peak | None:
    """The peak of that name, where a lower bound of it can be proven: for polynomial laws of convex problems."""
    constant, asked = FUNCTIONALS.get(name), problem.range(name)
    if not isinstance(constant, Peak) or asked is None or asked.low <= 0.0:
        return None
    return constant if problem.convex and isinstance(problem.basis, PolynomialBasis) else None


class PeakRows:
    """What laws below a claim can have as the values of a derivative.

    Parameters
    ----------
    problem
        The problem; laws of it are spoken of.
    peak
        A peak of the derivative that the problem bounds from below.
    claim
        Laws with an objective below it are spoken of.
    """

    def __init__(self, problem: Problem, peak: Peak, claim: float) -> None:
        self.problem, self.peak, self.claim = problem, peak, claim
        asked = problem.range(peak.name)
        self.low = inf if asked is None else asked.low
        self.model = model_of(problem)
        objective = np.append(self.model.program.objective, 0.0)[None, :]
        most = claim / self.model.unit * _UPWARD
        nothing = np.zeros(self.model.program.size)
        row = LinearFamily(CLAIM, nothing, most, (1.0,), (1.0, 1.0), unit=self.model.unit, series=objective)
        self._program = replace(self.model.program, families=(*self.model.program.families, row))
        self._moments = moments(self.model, greatest_values(self.model, claim))
        self._curvatures: dict[float, list[float]] = {}

    @property
    def half(self) -> bool:
        """Whether the first half says all: laws are symmetric, or their mirror images are laws too."""
        return self.problem.symmetric or self.problem.mirrored

    @property
    def stop(self) -> float:
        """The end of the places to look at."""
        return 0.5 if self.half else 1.0

    @property
    def ends(self) -> tuple[float, ...]:
        """Places at which a peak need not have slope 0."""
        return (0.0,) if self.half else (0.0, 1.0)

    @property
    def signs(self) -> tuple[float, ...]:
        """The signs with which the derivative may have its peak in these places."""
        return (1.0, -1.0) if self.half and self.peak.nu % 2 == 0 else self.peak.signs

    def at(self, k: float, sign: float) -> tuple[Model, float]:
        """The program that minimises -sign times the derivative at k, and the constant part of the derivative."""
        row = self.model.space.row(self.peak.nu, k)
        objective = np.zeros(self._program.size)
        objective[: self.model.space.terms] = -sign * row[:-1]
        program = replace(self._program, objective=objective, unit=1.0)
        return replace(self.model, program=program), sign * float(row[-1])

    def upper(self, k: float, sign: float, contacts: tuple[Contact, ...], equations: tuple[float, ...]) -> float:
        """Most that sign times the derivative at k can be in laws below the claim, by weak duality."""
        model, base = self.at(k, sign)
        program = model.program
        # as a row, the rounding of the objective is counted too
        lines = [*lines_of(program, contacts, equations), (1.0, program.objective, 0.0)]
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
