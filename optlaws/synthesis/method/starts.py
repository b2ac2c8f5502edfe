"""Where to begin when a problem is not convex: a few starts, the same at every run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model
from optlaws.synthesis.spaces.polynomials.space import PolynomialSpace

Array = NDArray[np.float64]

_SEED = 20010
_RANDOM = 2
_SPREAD = 0.3


def points(problem: Problem, found: Model) -> Iterator[Array]:
    """Coordinates of the laws of least RMS of c, of least C, and some around them; D follows from the law."""
    convex: list[Array] = []
    for constant in ("rms_c", "C"):
        near = model(replace(problem, minimise=constant, D=None))
        optimum = solve(near.program).optimum
        if optimum is not None:
            convex.append(optimum.x[: found.space.terms])
            yield _completed(found, convex[-1])
    if not problem.symmetric and problem.boundary is None and problem.inflexion is None:
        for lifted in _from_symmetric(problem, found):
            convex.append(lifted)
            yield _completed(found, lifted)
    if not convex:
        return
    generator = np.random.default_rng(_SEED)
    size = max(float(np.abs(convex[-1]).max()), 1.0)
    for i in range(_RANDOM):
        away = _SPREAD * size * generator.normal(size=found.space.terms)
        yield _completed(found, convex[i % len(convex)] + away)


def _from_symmetric(problem: Problem, found: Model) -> list[Array]:
    """Coordinates of the best symmetric law that the default start leads to: it belongs to the problem too."""
    half = model(replace(problem, symmetric=True))
    optimum = solve(half.program).optimum
    if optimum is None or not isinstance(half.space, PolynomialSpace) or not isinstance(found.space, PolynomialSpace):
        return []
    lifted = np.zeros(found.space.terms)
    lifted[np.isin(found.space.index, half.space.index)] = optimum.x[: half.space.terms]
    return [lifted]


def _completed(found: Model, coordinates: Array) -> Array:
    """With room enough for the variables beyond the coordinates."""
    x = np.zeros(found.program.size)
    x[: found.space.terms] = coordinates
    law = found.space.law(coordinates)
    for name, place in found.places.items():
        x[place] = law.peak(1).value if name == "B" else 2.0 * law.power_peak().value
    return x
