"""Looking a law up in the atlas: the nearest point that keeps what is asked, and the best law that does."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.files import reading
from optlaws.jobs.laws.atlas import COLUMNS, CONSTANTS
from optlaws.suggest import unknown_key
from optlaws.synthesis import Chebyshev, Problem, Solution, Status, at_most, synthesize


@dataclass(frozen=True)
class AtlasPoint:
    """A point of the atlas: what was asked there, and the constants of its law; J is missing where c jumps."""

    minimise: str
    order: int
    degree: int
    B: float
    constants: Mapping[str, float]


def look_up(
    file: Path, *, minimise: str, order: int, B: float | None = None, most: Mapping[str, float] | None = None
) -> AtlasPoint:
    """The point with the nearest B or, where B is free, the best one; among equals the one with the least objective.

    Laws that were made for another objective count too: with a limit they may be the better ones.

    Parameters
    ----------
    file
        The atlas, `atlas.csv`.
    minimise, order
        What is minimised, and l, as in the atlas.
    B
        Peak velocity.
    most
        Greatest values of constants.
    """
    limits = dict(most or {})
    for name in limits:
        if name not in CONSTANTS:
            raise InputError(unknown_key(name, CONSTANTS, "constant"))
    points = read(file)
    for name, value in (("minimise", minimise), ("order", order)):
        known = sorted({getattr(point, name) for point in points})
        if value not in known:
            raise InputError(f"the atlas has {name} = {', '.join(map(str, known))}, not {value}")
    some = [point for point in points if point.order == order and minimise in point.constants]
    if B is not None:
        low, high = min(point.B for point in some), max(point.B for point in some)
        if not low <= B <= high:
            raise InputError(f"the atlas has B from {low:g} to {high:g}, not {B:g}")
    candidates = [
        p for p in some if all(p.constants.get(name, float("inf")) <= value for name, value in limits.items())
    ]
    if not candidates:
        least = {name: min(p.constants.get(name, float("inf")) for p in some) for name in limits}
        in_words = ", ".join(
            f"{name} <= {value:g} (the least there is {least[name]:g})" for name, value in limits.items()
        )
        raise InputError(f"no law of order {order} in the atlas keeps {in_words}; optlaws solve may find one between")
    return min(candidates, key=lambda p: (0.0 if B is None else abs(p.B - B), p.constants[minimise]))


def best_law(
    file: Path, *, minimise: str, order: int, B: float | None = None, most: Mapping[str, float] | None = None
) -> Solution:
    """The best law as asked, of whichever degree the atlas has; the arguments are those of `look_up`.

    A point of the atlas says nothing of the best degree under a limit: its law keeps to it by chance. So every degree
    is asked, but where the greatest, among whose laws are those of all others, has answered for them with proof.
    """
    degrees = sorted({point.degree for point in read(file) if point.order == order}, reverse=True)
    solutions: list[Solution] = []
    failed: list[SolverFailure] = []
    for degree in degrees:
        try:
            solutions.append(synthesize(_problem(degree, minimise, order, B, most or {})))
        except InfeasibleProblem:
            if not solutions and not failed:
                raise
        except SolverFailure as error:
            failed.append(error)
        if solutions and solutions[0].status is Status.OPTIMAL:
            break
    if not solutions:
        raise failed[0]
    return min(solutions, key=lambda solution: solution.objective)


def _problem(degree: int, minimise: str, order: int, B: float | None, most: Mapping[str, float]) -> Problem:
    bounds: dict[str, Any] = {name: at_most(value) for name, value in most.items()}
    if B is not None:
        bounds.pop("B", None)
    return Problem(B=B, order=order, basis=Chebyshev(degree), minimise=minimise, bounds=bounds)


def read(file: Path) -> list[AtlasPoint]:
    """The points of an atlas that have a law."""
    if not file.exists():
        raise InputError(f"there is no atlas {file}; `optlaws run problems/atlas.toml` makes one")
    lines = [line for line in reading.text(file).splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    if not rows or tuple(rows[0]) != COLUMNS:
        raise InputError(f"{file} is no atlas: its columns are not {', '.join(COLUMNS)}")
    return [
        AtlasPoint(
            minimise=row["minimise"],
            order=int(row["order"]),
            degree=int(row["degree"]),
            B=float(row["B asked"]),
            constants={name: float(row[name]) for name in CONSTANTS if row[name]},
        )
        for row in rows
        if row["C"]
    ]
