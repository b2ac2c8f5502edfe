"""Where to begin when a problem is not convex: a few starts, the same at every run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.exchange import solve
from optlaws.synthesis.problem import Problem
from optlaws.synthesis.programs import Model, model

Array = NDArray[np.float64]

_SEED = 20010
_RANDOM = 2
_SPREAD = 0.3


def points(problem: Problem, found: Model) -> list[Array]:
    """Coordinates of the laws of least C, of least RMS of c, and some around them; D follows from the law."""
    convex = []
    for constant in ("C", "rms_c"):
        near = model(replace(problem, minimise=constant, D=None))
        optimum = solve(near.program).optimum
        if optimum is not None:
            convex.append(optimum.x[: found.space.terms])
    if not convex:
        return []
    generator = np.random.default_rng(_SEED)
    size = max(float(np.abs(convex[0]).max()), 1.0)
    around = [
        convex[i % len(convex)] + _SPREAD * size * generator.normal(size=found.space.terms) for i in range(_RANDOM)
    ]
    return [_completed(found, coordinates) for coordinates in (*convex, *around)]


def _completed(found: Model, coordinates: Array) -> Array:
    """With room enough for the variables beyond the coordinates."""
    x = np.zeros(found.program.size)
    x[: found.space.terms] = coordinates
    law = found.space.law(coordinates)
    for name, place in found.places.items():
        x[place] = law.peak(1).value if name == "B" else 2.0 * law.power_peak().value
    return x
