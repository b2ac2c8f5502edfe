"""What a synthesis returns."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache, cached_property
from importlib.metadata import version
from typing import Any

import numpy as np

from optlaws.laws import Constants, PolynomialLaw
from optlaws.synthesis.active_set import ActiveSet
from optlaws.synthesis.bases import Powers
from optlaws.synthesis.certificate import Certificate
from optlaws.synthesis.problem import Problem


class Status(StrEnum):
    """How far a solution can be trusted; `advice` says what to do about it.

    Examples
    --------
    >>> Status.OPTIMAL.advice
    'The lower bound meets the objective: no law of this problem is better.'
    """

    OPTIMAL = "optimal"
    LOCAL = "local"
    INACCURATE = "inaccurate"

    @property
    def advice(self) -> str:
        """What the status means for the user."""
        return {
            Status.OPTIMAL: "The lower bound meets the objective: no law of this problem is better.",
            Status.LOCAL: "No better law was found nearby; the gap says how much better one could be.",
            Status.INACCURATE: "The law is sound but the bound does not meet it; change the degree a little.",
        }[self]


@dataclass(frozen=True, eq=False)
class Solution:
    """An optimal law with its proof. Every number is recomputed from the law on the whole interval.

    Attributes
    ----------
    problem
        What was solved.
    law
        The motion law.
    z_series
        Chebyshev coefficients of Z in 2k - 1, whatever the problem's basis.
    objective
        The minimised constant, recomputed from `law`.
    certificate
        Contacts and multipliers; `certificate.bound` is the lower bound, by numpy alone.
    limit
        What no law of any degree can beat.
    status, iterations, seconds
        How it went: IPOPT's iterations (0 where a neighbour was continued) and the wall time.
    active_set
        Contacts and multipliers in the solver's own terms, from which a neighbouring problem is continued.
    versions
        Versions of optlaws and of the libraries that took part.

    Examples
    --------
    >>> import optlaws
    >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=optlaws.Powers(3)))
    >>> solution.status.value, round(solution.objective, 6), solution.gap < 1e-8
    ('optimal', 5.917851, True)
    """

    problem: Problem
    law: PolynomialLaw
    z_series: tuple[float, ...]
    objective: float
    certificate: Certificate
    limit: float
    status: Status
    iterations: int
    seconds: float
    active_set: ActiveSet = field(repr=False)

    @property
    def constants(self) -> Constants:
        """B, C, D, J of the law, each with its k, and the RMS of c."""
        return self.law.constants

    @cached_property
    def z(self) -> tuple[float, ...]:
        """Coefficients of Z in the problem's basis."""
        return self.problem.basis.coefficients(np.array(self.z_series))

    @cached_property
    def z_powers(self) -> tuple[float, ...]:
        """Coefficients of Z in ascending powers of k, whatever the problem's basis."""
        return Powers(self.problem.basis.degree).coefficients(np.array(self.z_series))

    @property
    def lower_bound(self) -> float:
        """The proven lower bound of the objective over all laws of the problem."""
        return self.certificate.bound

    @property
    def gap(self) -> float:
        """(objective - lower bound) / objective."""
        return (self.objective - self.lower_bound) / self.objective

    @property
    def versions(self) -> dict[str, str]:
        """Versions of the libraries that took part."""
        return dict(_versions())

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict: the command line's `--json`, with the problem and the certificate beside it."""
        return {
            "status": self.status.value,
            "objective": self.objective,
            "lower_bound": self.lower_bound,
            "gap": self.gap,
            "limit": self.limit,
            "constants": self.constants.to_dict(),
            "z": list(self.z_powers),
            "law": self.law.to_dict(),
            "iterations": self.iterations,
            "seconds": self.seconds,
            "problem": self.problem.to_dict(),
            "certificate": self.certificate.to_dict(),
            "versions": self.versions,
        }

    def __repr__(self) -> str:
        return (
            f"Solution(status={self.status.value!r}, {self.problem.minimise}={self.objective:.9g}, "
            f"lower_bound={self.lower_bound:.9g}, gap={self.gap:.1e}, limit={self.limit:.9g}, problem={self.problem!r})"
        )


@cache
def _versions() -> tuple[tuple[str, str], ...]:
    return tuple((name, version(name)) for name in ("optlaws", "casadi", "numpy"))
