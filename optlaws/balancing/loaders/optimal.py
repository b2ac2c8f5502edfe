"""Executive laws that are optimal for an inertial loader: least C, B or D of the loader, or a mixture with C."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from optlaws.balancing.loaders.constants import objective
from optlaws.balancing.loaders.limits import loader_velocity_limit
from optlaws.balancing.loaders.loader import Loader, inertial_loader
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of
from optlaws.laws import MotionLaw
from optlaws.numbers import bounded, positive
from optlaws.spelling import either_spelling
from optlaws.synthesis.problem.expression import Expression, Term
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import at_most
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import Bound, synthesize
from optlaws.synthesis.spaces.bases import Basis, Chebyshev, PolynomialBasis
from optlaws.synthesis.status import Status

_LEAST_DEGREE, _AT_REST = 3, 2


@dataclass(frozen=True, repr=False)
class BalancedLaw(JsonText):
    """An executive law with its loader and its proven bounds; all numbers are recomputed from the law.

    Attributes
    ----------
    law
        The executive law.
    loader
        The loader that balances it.
    minimise
        What was minimised.
    objective
        Its value.
    lower_bound
        What no symmetric law with this B, order, degree and b >= 0 is below.
    status
        `optimal` where the bound meets the objective, else `local`.
    starts
        The objectives that the starts led to, ascending; those that lost their way are left out.
    solution
        Law and proof as `synthesize` returned them.

    Examples
    --------
    >>> slow = balanced_law(1.8, order=2, basis=Chebyshev(5), minimise="B_loader")
    >>> slow.status.value, slow.gap < 1e-8, slow.objective == slow.loader.B
    ('optimal', True, True)
    """

    _json_name = "a balanced law"

    law: MotionLaw
    loader: Loader
    minimise: Expression
    objective: float
    lower_bound: float
    status: Status
    starts: tuple[float, ...] = field(default=())
    solution: Solution | None = field(default=None, compare=False)

    @property
    def gap(self) -> float:
        """(objective - lower bound) / objective."""
        return (self.objective - self.lower_bound) / self.objective

    def to_dict(self) -> dict[str, Any]:
        """The result as a plain dict for JSON."""
        return {
            "status": self.status.value,
            "minimise": repr(self.minimise),
            "objective": self.objective,
            "lower_bound": bounded(self.lower_bound),
            "executive": {"B": self.law.constants.B.value, "C": self.law.constants.C.value},
            "loader": self.loader.to_dict(),
            "law": self.law.to_dict(),
            "starts": list(self.starts),
            "solution": None if self.solution is None else self.solution.to_dict(),
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> BalancedLaw:
        """The result that `to_dict` described; its `solution` and all numbers are checked against problem and proofs.

        Raises
        ------
        InputError
            If there is no solution, or it is wrong.
        """
        return _balanced(Solution.from_dict(entries_of(data, ("solution",), cls._json_name)["solution"]))

    def __repr__(self) -> str:
        return (
            f"BalancedLaw(status={self.status.value!r}, {self.minimise!r}={self.objective:.9g}, "
            f"lower_bound={self.lower_bound:.9g}, law={self.law!r}, loader={self.loader!r})"
        )


@either_spelling
def balanced_law(
    B: float,
    *,
    order: int,
    basis: Basis | None = None,
    minimise: str | Term | Expression = "C_loader",
    most_C: float | None = None,
    bound: Bound = "quick",
) -> BalancedLaw:
    """The symmetric executive law of a peak velocity whose inertial loader is gentlest.

    The executive link does not go back (b >= 0) and passes its peak velocity once.

    Parameters
    ----------
    B
        Peak velocity of the executive law, above 1 (dimensionless).
    order
        Number of end conditions, at least 2: at rest, without acceleration from 3 on.
    basis
        Basis of Z, one of polynomials; `Chebyshev(9)` unless given.
    minimise
        "C_loader", "B_loader", "D_loader", or a sum of these and "C": "0.5*C/4 + 0.5*C_loader/4".
    most_C
        Greatest peak acceleration that the executive law may have.
    bound
        As of `synthesize`: "tight" proves that no law is better, which takes from half a second to some seconds.

    Raises
    ------
    InputError
        If an argument is out of range or the objective names something else.
    InfeasibleProblem
        If no law has these constants; proven.
    SolverFailure
        If no start led to a law that keeps its constraints.

    Examples
    --------
    >>> balanced = balanced_law(1.875, order=3, basis=Chebyshev(9))
    >>> balanced.status.value, round(balanced.loader.C, 6), round(balanced.lower_bound, 6)
    ('local', 4.632673, 4.459318)
    >>> proven = balanced_law(1.875, order=3, basis=Chebyshev(9), bound="tight")
    >>> proven.status.value, proven.gap < 1e-8
    ('optimal', True)
    >>> from optlaws import smoothstep
    >>> from optlaws.balancing.loaders.constants import C_loader
    >>> round(C_loader.value(smoothstep(3)), 6)  # also of order 3 and with B = 1.875
    5.65925
    """
    goal, given = objective(minimise), Chebyshev(9) if basis is None else basis
    _check_degree(given)
    loader_velocity_limit(B)
    limit = None if most_C is None else at_most(positive(most_C, "most_C"))
    problem = Problem(B=B, order=order, basis=given, minimise=goal, monotone=True, C=limit)
    if problem.order < _AT_REST:
        raise InputError("order must be at least 2: the executive link starts at rest")
    return _balanced(synthesize(problem, bound=bound))


def _balanced(solution: Solution) -> BalancedLaw:
    return BalancedLaw(
        solution.law,
        inertial_loader(solution.law),
        solution.problem.objective,
        solution.objective,
        solution.lower_bound,
        solution.status,
        solution.starts,
        solution,
    )


def _check_degree(basis: Basis) -> None:
    if not isinstance(basis, PolynomialBasis):
        raise InputError(f"basis must be one of polynomials such as Chebyshev(9), got {shortened(basis)}")
    if basis.degree < _LEAST_DEGREE:
        raise InputError(f"degree of Z must be at least {_LEAST_DEGREE}, or B leaves no freedom; got {basis.degree}")
