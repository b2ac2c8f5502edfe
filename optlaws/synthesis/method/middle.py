"""A peak velocity bounded from below, asked in the middle: there it is convex, and one of the candidates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.problem.constants import B, Functional
from optlaws.synthesis.program.writer import Model, model_of

Array = NDArray[np.float64]

_MIDDLE = 0.5


def asked_in_the_middle(model: Model, plain: ActiveSet, constant: Functional) -> tuple[Model, ActiveSet] | None:
    """The problem with its peak velocity at k = 1/2, with its optimum; None where it is not B that is bounded.

    The optimum without the lower bound is where a problem that is not convex begins.
    """
    problem = model.problem
    if constant != B or problem.boundary is not None or problem.inflexion is not None:
        return None
    placed = model_of(replace(problem, inflexion=_MIDDLE))
    optimum = solve(placed.program, start=None if problem.convex else _begun(model, placed, plain)).optimum
    return None if optimum is None else (placed, optimum)


def _begun(model: Model, placed: Model, plain: ActiveSet) -> Array:
    start = np.full(placed.program.size, B.value(model.law(plain.x)))
    start[: model.space.terms] = model.coordinates(plain.x)
    for name, place in model.places.items():
        start[placed.places[name]] = plain.x[place]
    return start
