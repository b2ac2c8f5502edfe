"""The paper's own search for the least C, from its starts, beside the proven optimum."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import LinearConstraint, minimize

from optlaws import BoundaryConditions, PolynomialLaw, Powers, Problem, law_from_z, sweep
from optlaws.results import Cell, Entries, Results

Array = NDArray[np.float64]
HEADINGS = ("B", "start", "search", "C found", "least C", "above it, %")
STEPS = 100  # c is taken at the points of so many


class Start(msgspec.Struct):
    """Where a search starts: a name and the coefficients of Z."""

    name: str
    z: list[float]


class Searches(Entries):
    """The problem file."""

    order: int
    B: list[float]
    start: list[Start]


def run(results: Results) -> None:
    """Search from every start at every B, and solve the same problems with proof."""
    spec = results.read(Searches)
    count = max(len(start.z) for start in spec.start)
    proven = sweep([Problem(B=B, order=spec.order, basis=Powers(count - 1)) for B in spec.B])
    table = [
        _row(B, start.name, *search(B, start.z, spec.order), solution.objective)
        for B, solution in zip(spec.B, proven, strict=True)
        for start in spec.start
    ]
    results.table("searches", HEADINGS, table)
    results.page("searches").text(spec.text).table(HEADINGS, table)
    least = {row[0]: row[4] for row in table}
    assert abs(float(least[1.859] or 0.0) - 5.917851) < 1e-6, least
    assert all(float(row[3] or 0.0) >= float(row[4] or 0.0) - 0.005 for row in table), "a search is below the optimum"


def search(B: float, z: Sequence[float], order: int) -> tuple[PolynomialLaw, str]:
    """Where a minimiser of the greatest |c| on the grid ends for b(1/2) = B and c(1/2) = 0, and how it ended."""
    places, middle = np.linspace(0.0, 1.0, STEPS + 1), np.array([0.5])
    offset, columns = _affine(order, len(z), places, 2)
    ends = [_affine(order, len(z), middle, nu) for nu in (1, 2)]
    target = np.array([B, 0.0]) - np.concatenate([plain for plain, _ in ends])
    constraint = LinearConstraint(np.vstack([share for _, share in ends]), target, target)

    def greatest(z: Array) -> float:
        return float(np.abs(offset + columns @ z).max())

    answer = minimize(greatest, np.array(z), method="SLSQP", constraints=[constraint], options={"maxiter": 500})
    law = law_from_z(BoundaryConditions.rest(order), answer.x.tolist())
    return law, "converged" if answer.success else "gave up"


def _affine(order: int, count: int, k: Array, nu: int) -> tuple[Array, Array]:
    """A derivative of the law at places, as what Z = 0 gives and the share of each coefficient of Z."""
    rest = BoundaryConditions.rest(order)
    plain = law_from_z(rest, [0.0])(k, nu)
    shares = [law_from_z(rest, [0.0] * i + [1.0])(k, nu) - plain for i in range(count)]
    return plain, np.column_stack(shares)


def _row(B: float, start: str, law: PolynomialLaw, ended: str, least: float) -> list[Cell]:
    # where such a search stops hangs on rounding: more digits would not be the same on another machine
    C = law.constants.C.value
    return [B, start, ended, round(C, 2), least, round(100.0 * (C / least - 1.0), 1)]


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
