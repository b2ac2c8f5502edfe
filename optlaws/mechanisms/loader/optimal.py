"""Executive laws made for the sake of their inertial loaders: least C or B of the loader, or a mixture with C."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError, SolverFailure
from optlaws.laws import PolynomialLaw
from optlaws.mechanisms.loader.constants import objective
from optlaws.mechanisms.loader.limits import loader_acceleration_limit, loader_velocity_limit
from optlaws.mechanisms.loader.loader import Loader, loader
from optlaws.mechanisms.loader.search import Task, search, tangent_bound
from optlaws.mechanisms.loader.space import LoaderSpace
from optlaws.numbers import bounded, positive
from optlaws.synthesis.problem.expression import Expression, Term
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import at_most
from optlaws.synthesis.solution import Status
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Basis, Chebyshev, PolynomialBasis

Array = NDArray[np.float64]

STARTS = ("C", "rms_c", "J")
_PROVEN = _KEPT = 1e-7  # relative gap of a proof: no less than what a constraint may be broken by
_LEAST_DEGREE, _AT_REST = 3, 2


@dataclass(frozen=True, repr=False)
class BalancedLaw:
    """An executive law with its loader, and what is proven of it; all numbers are recomputed from the law.

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
        `optimal` where the bound meets the objective to 1e-7, else `local`.
    starts
        The objectives that the starts led to, ascending; those that lost their way are left out.

    Examples
    --------
    >>> slow = balanced_law(1.8, order=2, basis=Chebyshev(5), minimise="B_loader")
    >>> slow.status.value, slow.gap < 1e-8, slow.objective == slow.loader.B
    ('optimal', True, True)
    """

    law: PolynomialLaw
    loader: Loader
    minimise: Expression
    objective: float
    lower_bound: float
    status: Status
    starts: tuple[float, ...] = field(default=())

    @property
    def gap(self) -> float:
        """(objective - lower bound) / objective."""
        return (self.objective - self.lower_bound) / self.objective

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict."""
        return {
            "status": self.status.value,
            "minimise": repr(self.minimise),
            "objective": self.objective,
            "lower_bound": bounded(self.lower_bound),
            "executive": {"B": self.law.constants.B.value, "C": self.law.constants.C.value},
            "loader": self.loader.to_dict(),
            "law": self.law.to_dict(),
            "starts": list(self.starts),
        }

    def __repr__(self) -> str:
        return (
            f"BalancedLaw(status={self.status.value!r}, {self.minimise!r}={self.objective:.9g}, "
            f"lower_bound={self.lower_bound:.9g}, law={self.law!r}, loader={self.loader!r})"
        )


def balanced_law(
    B: float,
    *,
    order: int,
    basis: Basis | None = None,
    minimise: str | Term | Expression = "C_loader",
    most_C: float | None = None,
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
        "C_loader", "B_loader", or a sum of these and "C": "0.5*C/4 + 0.5*C_loader/4".
    most_C
        Greatest peak acceleration that the executive law may have.

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
    >>> found = balanced_law(1.875, order=3, basis=Chebyshev(9))
    >>> found.status.value, round(found.loader.C, 6), round(found.lower_bound, 6)
    ('local', 4.632673, 4.459318)
    >>> from optlaws.laws import smoothstep
    >>> from optlaws.mechanisms.loader.constants import C_loader
    >>> round(C_loader.value(smoothstep(3)), 6)  # also of order 3 and with B = 1.875
    5.65925
    """
    wanted, found = objective(minimise), Chebyshev(9) if basis is None else basis
    weights = {repr(term): weight for weight, term in wanted.terms}
    degree = _degree(found)
    problem = _problem(B, order, found, most_C)
    space = LoaderSpace(float(B), order, degree)
    task = Task(space, weights, inf if most_C is None else float(most_C))
    first = [synthesize(replace(problem, minimise=name)) for name in STARTS]
    ends = [search(task, task.space.projected(one.law)) for one in first]
    tried = [_measured(task, y) for y, broken in ends if broken <= _KEPT]
    if not tried:
        raise SolverFailure(
            f"no start led to a law with B = {problem.B:g} that keeps its constraints; change the degree a little"
        )
    value, y = min(tried, key=lambda one: one[0])
    least = _bound(task, y, first[0].lower_bound)
    status = Status.OPTIMAL if value - least <= _PROVEN * value else Status.LOCAL
    law = task.space.law(y)
    return BalancedLaw(law, loader(law), wanted, value, least, status, tuple(sorted(value for value, _ in tried)))


def _degree(basis: Basis) -> int:
    if not isinstance(basis, PolynomialBasis):
        raise InputError(f"basis must be one of polynomials such as Chebyshev(9), got {shortened(basis)}")
    if basis.degree < _LEAST_DEGREE:
        raise InputError(f"degree of Z must be at least {_LEAST_DEGREE}, or B leaves no freedom; got {basis.degree}")
    return basis.degree


def _problem(B: float, order: int, basis: Basis, most_C: float | None) -> Problem:
    loader_velocity_limit(B)
    asked = None if most_C is None else at_most(positive(most_C, "most_C"))
    problem = Problem(B=B, order=order, basis=basis, monotone=True, C=asked)
    if problem.order < _AT_REST:
        raise InputError("order must be at least 2: the executive link starts at rest")
    return problem


def _measured(task: Task, y: Array) -> tuple[float, Array]:
    law = task.space.law(y)
    one = loader(law)
    peaks = {"C": law.constants.C.value, "C_loader": one.C, "B_loader": one.B}
    return sum(weight * peaks[name] for name, weight in task.weights.items()), y


def _bound(task: Task, y: Array, least_C: float) -> float:
    """The greatest of what is proven: the limits, each constant by itself, and tangents where all is convex."""
    B = task.space.B
    least = {"C": least_C, "C_loader": loader_acceleration_limit(B), "B_loader": loader_velocity_limit(B)}
    found = sum(weight * least[name] for name, weight in task.weights.items())
    return found if "C_loader" in task.weights else max(found, tangent_bound(task, y))
