"""The least of a quadratic function within cones, by Clarabel."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from optlaws.numbers import Array

SOLVED, NEARLY_SOLVED = "Solved", "AlmostSolved"
_USABLE = (SOLVED, NEARLY_SOLVED)
INFEASIBLE = "PrimalInfeasible"
_ENDED = (SOLVED, INFEASIBLE, "DualInfeasible")


class SparseColumns(NamedTuple):
    """A matrix by its columns without their zeros: what Clarabel reads of a csc_matrix, without importing scipy.

    >>> SparseColumns.of(np.array([[2.0, 0.0], [0.5, 1.0]]))[:3]
    ([2.0, 0.5, 1.0], [0, 1, 1], [0, 2, 3])
    """

    data: list[float]
    indices: list[int]
    indptr: list[int]
    shape: tuple[int, int]
    nnz: int
    has_canonical_format: bool = True  #: no place twice, and the rows of each column in their order

    @classmethod
    def of(cls, matrix: Array) -> SparseColumns:
        """The columns of an array."""
        columns, rows = matrix.T.nonzero()
        starts = np.searchsorted(columns, np.arange(matrix.shape[1] + 1)).tolist()
        return cls(matrix[rows, columns].tolist(), rows.tolist(), starts, matrix.shape, len(rows))


def conic_optimum(
    curvature: Array | None,
    cost: Array,
    rows: Any,
    right: Array,
    cones: list[Any],
    *,
    tolerance: float,
    alike: bool = False,
) -> Any:
    """The least x . curvature . x / 2 + cost . x with right - rows . x in cones, by Clarabel.

    The rows are `SparseColumns`, or what these are in place of. Those that are `alike` are not scaled again: those of
    short pieces would end far from the accuracy that is set.
    Where rows are nearly dependent Clarabel ends as far from it for what it adds to the diagonal of its systems: an
    answer that is short of the accuracy is computed without that too, and the better one is taken.
    """
    import clarabel

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    settings.tol_infeas_abs = settings.tol_infeas_rel = tolerance
    size = len(cost)
    straight = SparseColumns([], [], [0] * (size + 1), (size, size), 0)
    bent = straight if curvature is None else SparseColumns.of(np.triu(curvature))
    settings.equilibrate_enable = not alike
    answers = []
    for settings.static_regularization_enable in (True, False):
        answers.append(clarabel.DefaultSolver(bent, cost, rows, right, cones, settings).solve())
        if str(answers[-1].status) in _ENDED:
            return answers[-1]
    return min(answers, key=_error)


def _error(optimum: Any) -> float:
    """What an answer of Clarabel leaves of feasibility and, as a share of the cost, of the gap."""
    if not usable(optimum):
        return np.inf
    gap = abs(optimum.obj_val - optimum.obj_val_dual)
    share = gap / max(1.0, min(abs(optimum.obj_val), abs(optimum.obj_val_dual)))
    return float(max(optimum.r_prim, optimum.r_dual, share))


def usable(optimum: Any) -> bool:
    """Whether Clarabel found an optimum, to its accuracy or nearly so."""
    return str(optimum.status) in _USABLE
