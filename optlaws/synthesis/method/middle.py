"""A peak velocity bounded from below, asked in the middle: there it is convex, and one of the candidates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.problem.constants import B, Functional
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model

Array = NDArray[np.float64]

_MIDDLE = 0.5


def asked_in_the_middle(
    problem: Problem, found: Model, plain: ActiveSet, constant: Functional
) -> tuple[Problem, Model, ActiveSet] | None:
    """The problem with its peak velocity at k = 1/2, with its optimum; None where it is not B that is bounded.

    The optimum without the lower bound is where a problem that is not convex begins.
    """
    if constant != B or problem.boundary is not None or problem.inflexion is not None:
        return None
    placed = replace(problem, inflexion=_MIDDLE)
    asked = model(placed)
    optimum = solve(asked.program, start=_begun(found, asked, plain) if not problem.convex else None).optimum
    return None if optimum is None else (placed, asked, optimum)


def _begun(found: Model, asked: Model, plain: ActiveSet) -> Array:
    coordinates = plain.x[: found.space.terms]
    start = np.full(asked.program.size, B.value(found.space.law(coordinates)))
    start[: found.space.terms] = coordinates
    for name, place in found.places.items():
        start[asked.places[name]] = plain.x[place]
    return start
