"""The rows of a printed table of optimal laws: what is printed, the law that its Z gives, and optima beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Annotated

import msgspec
import numpy as np

from optlaws.errors import InputError
from optlaws.jobs.pages import printed
from optlaws.laws import PolynomialLaw, smoothstep
from optlaws.suggest import unknown_key
from optlaws.synthesis import BoundaryConditions, Chebyshev, PolynomialBasis, Problem, Solution, construct, sweep

Curves = Mapping[int, Sequence[Solution]]

_LEAST, _MOST = 2, 100  # coefficients of Z

COLUMNS = ("B", "C", "D", "base", "z", "note")


Count = Annotated[int, msgspec.Meta(ge=1)]
Number = Annotated[float, msgspec.Meta(ge=-1e100, le=1e100)]
Above1 = Annotated[float, msgspec.Meta(gt=1.0, le=1e100)]


class Base(msgspec.Struct, forbid_unknown_fields=True):
    """The law that k^l (k-1)^l Z(k) is added to, and the degree of Z of the same laws over its own order."""

    order: Count
    z: list[Number] = []
    same: Count | None = None


class Misprint(msgspec.Struct, forbid_unknown_fields=True):
    """A printed number that is wrong, with the reason; what it means, where the printed Z does not tell."""

    row: str
    quantity: str
    printed: Number
    reason: str
    means: Number | None = None


class Shown(msgspec.Struct, forbid_unknown_fields=True, rename={"start": "from", "stop": "to"}):
    """What the figure shows: optima of these degrees over B."""

    degrees: Annotated[list[Count], msgspec.Meta(min_length=1, max_length=5)]
    start: Above1
    stop: Above1
    points: Annotated[int, msgspec.Meta(ge=2)]


class Table(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: str
    printed: str
    order: Count
    monotone: bool
    degrees: Annotated[list[Count], msgspec.Meta(min_length=1)]
    grid: Count
    bases: dict[str, Base]
    figure: Shown
    misprint: list[Misprint] = []


@dataclass(frozen=True)
class Row:
    """One row: what is printed, the law that the printed Z gives, and the optima by degree of Z."""

    cells: Mapping[str, str]
    law: PolynomialLaw
    same: Solution
    richer: Mapping[int, Solution]

    @property
    def B(self) -> float:
        """The printed peak velocity."""
        return float(self.cells["B"])


def check(spec: Table, lines: Sequence[Mapping[str, str]], where: str) -> None:
    """Refuse rows and misprints that are none; `where` is the file of the rows."""
    for line in lines:
        for name in ("B", "C", "D"):
            printed.number(line[name], f"{where}, {name}")
        if printed.number(line["B"], where) <= 1.0:
            raise InputError(f"{where}: B must be above 1, got {line['B']}")
        if line["base"] not in spec.bases:
            raise InputError(f"{where}: base {line['base']!r} is not among the bases {', '.join(spec.bases)}")
        coefficients = [printed.number(text, f"{where}, z of B = {line['B']}") for text in line["z"].split()]
        if len(coefficients) < _LEAST:
            raise InputError(f"{where}: z of B = {line['B']} needs at least {_LEAST} coefficients")
    rows = {line["B"] for line in lines}
    for misprint in spec.misprint:
        if misprint.row not in rows:
            raise InputError(f"misprint: row {misprint.row!r} is not a B of the printed table")
        known = ["B", "C", "D"] if misprint.means is None else [f"z{i}" for i in range(_MOST)]
        if misprint.quantity not in known:
            raise InputError(
                f"misprint: {unknown_key(misprint.quantity, known, 'quantity')} (B, C, D; a coefficient such as z1 "
                "takes the entry means)"
            )


def solved(spec: Table, lines: Sequence[Mapping[str, str]]) -> tuple[list[Row], Curves]:
    """The rows with their optima, and optima over B by degree of Z."""
    laws = [printed_law(spec, line) for line in lines]
    values = [float(line["B"]) for line in lines]
    solved = {degree: _by_velocity(spec, degree, values) for degree in {*spec.degrees, *spec.figure.degrees}}
    richer = [{degree: solved[degree][B] for degree in spec.degrees} for B in values]
    same = [_same_shape(spec, line, B, optima) for line, B, optima in zip(lines, values, richer, strict=True)]
    rows = [Row(*parts) for parts in zip(lines, laws, same, richer, strict=True)]
    return rows, {degree: list(solved[degree].values()) for degree in spec.figure.degrees}


def _by_velocity(spec: Table, degree: int, values: Sequence[float]) -> dict[float, Solution]:
    """Solutions by B, ascending: at the rows' values and, where the figure wants a curve, between them."""
    wanted = set(values)
    if degree in spec.figure.degrees:
        wanted |= set(np.linspace(spec.figure.start, spec.figure.stop, spec.figure.points).tolist())
    basis = Chebyshev(degree)
    ordered = sorted(wanted)
    problems = [Problem(B=B, order=spec.order, basis=basis, monotone=spec.monotone) for B in ordered]
    return dict(zip(ordered, sweep(problems), strict=True))


def _same_shape(spec: Table, line: Mapping[str, str], B: float, optima: Mapping[int, Solution]) -> Solution:
    base = spec.bases[line["base"]]
    degree = len(line["z"].split()) - 1 if base.same is None else base.same
    if base.order == spec.order and degree in optima:
        return optima[degree]
    (solution,) = sweep([Problem(B=B, order=base.order, basis=Chebyshev(degree), monotone=spec.monotone)])
    return solution


def printed_law(spec: Table, line: Mapping[str, str]) -> PolynomialLaw:
    """The law that the Z(k) of a printed row gives."""
    base = spec.bases[line["base"]]
    z = [Fraction(text) for text in line["z"].split()]
    powers = construct(BoundaryConditions.rest(base.order), base.z).exact_powers()
    whole = construct(BoundaryConditions.rest(spec.order), z).exact_powers()
    plain = smoothstep(spec.order).exact_powers()
    size = max(len(powers), len(whole), len(plain))
    return PolynomialLaw.from_powers(
        [p + w - s for p, w, s in zip(*(_filled(part, size) for part in (powers, whole, plain)), strict=True)]
    )


def _filled(powers: Sequence[Fraction], size: int) -> list[Fraction]:
    return [*powers, *[Fraction(0)] * (size - len(powers))]


def degree_of(solution: Solution) -> int:
    """The degree of its Z."""
    basis = solution.problem.basis
    return basis.degree if isinstance(basis, PolynomialBasis) else 0
