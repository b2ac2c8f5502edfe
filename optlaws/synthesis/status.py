"""The status of a solution: how far it can be trusted, or why there is none; and the scale of its gap."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from math import isfinite
from typing import overload

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InfeasibleProblem, InputError, OptlawsError
from optlaws.tolerances import NO_OBJECTIVE, OPTIMALITY_GAP

_GAP_ROUNDING = 1e-12  # of an objective: a gap below it is rounding
_PERCENT = 100.0


@overload
def measure(objective: float, scale: float) -> float: ...
@overload
def measure(objective: NDArray[np.float64], scale: float | NDArray[np.float64]) -> NDArray[np.float64]: ...
def measure(objective: float | NDArray[np.float64], scale: float | NDArray[np.float64]) -> float | NDArray[np.float64]:
    """The measure of gaps: the objective itself or, where it is 0 up to rounding, its scale.

    Examples
    --------
    >>> measure(5.0, 1.0), measure(1e-9, 1.0), measure(np.array([5e-12, 1e-20]), 1e-12).tolist()
    (5.0, 1.0, [5e-12, 1e-12])
    """
    if isinstance(objective, float):
        return objective if objective > NO_OBJECTIVE * float(scale) else float(scale)
    return np.where(objective > NO_OBJECTIVE * scale, objective, scale)


class Status(StrEnum):
    """How far a solution can be trusted, or why there is none; `advice` says what to do about it.

    Solutions are optimal, local or inaccurate. Places of arrays, rows of tables and points of studies without a law are
    infeasible, failed or invalid, as the error of the problem says; points of studies may also exceed a limit of time.

    Examples
    --------
    >>> Status.OPTIMAL.advice
    'The lower bound meets the objective: no law of this problem is better.'
    >>> Status.of(InputError("order must be at least 1")).value, Status("not found").value
    ('invalid', 'failed')
    """

    OPTIMAL = "optimal"
    LOCAL = "local"
    INACCURATE = "inaccurate"
    INFEASIBLE = "infeasible"
    FAILED = "failed"
    INVALID = "invalid"
    TIME_LIMIT = "time limit"
    DIED = "worker died"
    ERROR = "error"

    @classmethod
    def of(cls, error: OptlawsError) -> Status:
        """The status of a problem that ended in an error."""
        if isinstance(error, InfeasibleProblem):
            return cls.INFEASIBLE
        return cls.INVALID if isinstance(error, InputError) else cls.FAILED

    @classmethod
    def _missing_(cls, value: object) -> Status | None:
        # what files of older versions say
        return {"not found": cls.FAILED, "wrong input": cls.INVALID}.get(str(value))

    @classmethod
    def worst(cls, statuses: Iterable[Status]) -> Status:
        """The worst of several statuses, in the order in which they stand here; optimal where there is none.

        >>> Status.worst([Status.LOCAL, Status.OPTIMAL]), Status.worst([])
        ('local', 'optimal')
        """
        return max(statuses, key=list(cls).index, default=cls.OPTIMAL)

    def __repr__(self) -> str:
        # as the text that it is: lists of statuses are read by people
        return repr(self.value)

    @property
    def advice(self) -> str:
        """Meaning of the status and a remedy, for the user."""
        return {
            Status.OPTIMAL: "The lower bound meets the objective: no law of this problem is better.",
            Status.LOCAL: "No better law was found from any start; the gap says how much better one could be.",
            Status.INACCURATE: "The law is sound but the bound does not meet it; change the degree a little.",
            Status.INFEASIBLE: "No law of this problem exists, and a proof shows it; loosen a bound.",
            Status.FAILED: "No law was found, and no proof that none exists; change the degree, or loosen a bound.",
            Status.INVALID: "The entries make no problem; the error states which and why.",
            Status.TIME_LIMIT: "The point took longer than the study's time limit; raise it, or lower the degree.",
            Status.DIED: "The process ended, mostly for want of memory; solve the point by itself.",
            Status.ERROR: "An error of the library itself, which its developers would like to see.",
        }[self]


def gap_text(gap: float) -> str:
    """The gap in words, in per cent; what is below 1e-10 % is rounding, and 1 is the gap of the bound 0.

    >>> gap_text(0.161), gap_text(4.8e-14), gap_text(1.0)
    ('gap 16 %', 'no gap but rounding', 'no bound above 0 is known')
    """
    if not isfinite(gap):
        return "no bound is known"
    if gap == 1.0:
        return "no bound above 0 is known"
    return f"gap {_PERCENT * gap:.2g} %" if gap > _GAP_ROUNDING else "no gap but rounding"


def status_of(objective: float, bound: float, scale: float, *, proven: bool) -> Status:
    """The status by the gap; `scale` is the objective's, `proven` states a bound that meets it up to rounding."""
    if abs(objective - bound) <= OPTIMALITY_GAP * measure(objective, scale):
        return Status.OPTIMAL
    return Status.INACCURATE if proven else Status.LOCAL
