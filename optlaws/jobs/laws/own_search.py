"""The job "own search": the paper's own search for the least C, from given starts, beside the proven optimum."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from optlaws.files import tables, writing
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.pages.page import Page
from optlaws.laws import PolynomialLaw
from optlaws.synthesis import BoundaryConditions, Powers, Problem, construct, sweep

Array = NDArray[np.float64]
Count = Annotated[int, msgspec.Meta(ge=1, le=20)]
HEADINGS = ("B", "start", "search", "C found", "least C", "above it, %")


class Start(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Where a search starts: a name and the coefficients of Z."""

    name: Text
    z: Annotated[list[float], msgspec.Meta(min_length=2, max_length=20)]


class Searches(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    order: Count
    B: Annotated[list[Annotated[float, msgspec.Meta(gt=1.0, le=100.0)]], msgspec.Meta(min_length=1, max_length=50)]
    start: Annotated[list[Start], msgspec.Meta(min_length=1, max_length=20)]
    grid: Annotated[int, msgspec.Meta(ge=10, le=10000)] = 100
    text: str = ""


@dataclass(frozen=True)
class Ended:
    """Where one search ended."""

    B: float
    start: str
    law: PolynomialLaw
    said: str


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Searches, file)
    ended = [search(B, start, order=spec.order, grid=spec.grid) for B in spec.B for start in spec.start]
    count = max(len(start.z) for start in spec.start)
    problems = [Problem(B=B, order=spec.order, basis=Powers(count - 1)) for B in sorted(set(spec.B))]
    least = {solution.problem.B: solution.objective for solution in sweep(problems)}
    rows = [_row(attempt, least[attempt.B]) for attempt in ended]
    page = Page(spec.title).text(spec.text).table(HEADINGS, rows)
    return [
        writing.write(out / "searches.csv", tables.to_csv(HEADINGS, rows, about=f"{spec.title}; from {file.name}")),
        writing.write(out / "searches.md", str(page)),
    ]


def search(B: float, start: Start, *, order: int, grid: int) -> Ended:
    """Minimise the greatest |c| on the paper's grid subject to b(1/2) = B and c(1/2) = 0, from one start."""
    from scipy.optimize import LinearConstraint, minimize

    places, middle = np.linspace(0.0, 1.0, grid + 1), np.array([0.5])
    offset, columns = _affine(order, len(start.z), places, 2)
    ends = [_affine(order, len(start.z), middle, nu) for nu in (1, 2)]
    wanted = np.array([B, 0.0]) - np.concatenate([plain for plain, _ in ends])
    kept = LinearConstraint(np.vstack([share for _, share in ends]), wanted, wanted)

    def greatest(z: Array) -> float:
        return float(np.abs(offset + columns @ z).max())

    answer = minimize(greatest, np.array(start.z), method="SLSQP", constraints=[kept], options={"maxiter": 500})
    law = construct(BoundaryConditions.rest(order), answer.x.tolist())
    return Ended(B, start.name, law, "converged" if answer.success else "gave up")


def _affine(order: int, count: int, k: Array, nu: int) -> tuple[Array, Array]:
    """A derivative of the law at places, as what Z = 0 gives and the share of each coefficient of Z."""
    rest = BoundaryConditions.rest(order)
    plain = construct(rest, [0.0])(k, nu)
    shares = [construct(rest, [0.0] * i + [1.0])(k, nu) - plain for i in range(count)]
    return plain, np.column_stack(shares)


def _row(search: Ended, least: float) -> Sequence[tables.Cell]:
    # where such a search stops hangs on rounding: more digits would not be the same on another machine
    C = search.law.constants.C.value
    return [search.B, search.start, search.said, round(C, 2), least, round(100.0 * (C / least - 1.0), 1)]
