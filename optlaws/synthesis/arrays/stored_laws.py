"""Many laws of one linear space as plain data at once, as each law would write itself."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.spaces.polynomials.space import PolynomialSpace
from optlaws.synthesis.spaces.space import LawSpace

Array = NDArray[np.float64]


def stored_laws(space: LawSpace, coordinates: Array) -> list[dict[str, Any]]:
    """What `law.to_dict()` of each law is; coordinates have a row for each law.

    Examples
    --------
    >>> from optlaws.synthesis import Problem, synthesize
    >>> from optlaws.synthesis.program.writer import model_of
    >>> solution = synthesize(Problem(B=1.7, order=4))
    >>> model = model_of(solution.problem)
    >>> stored_laws(model.space, model.coordinates(solution.active_set.x)[None]) == [solution.law.to_dict()]
    True
    """
    if not isinstance(space, PolynomialSpace) or not len(coordinates):
        return [space.law(row).to_dict() for row in coordinates]
    first = space.law(coordinates[0]).to_dict()
    accelerations, starts = space.laws(coordinates)
    return [
        {**first, "acceleration": _kept(row), "b0": start}
        for row, start in zip(accelerations.tolist(), starts.tolist(), strict=True)
    ]


def _kept(row: list[float]) -> list[float]:
    while row and row[-1] == 0.0:
        row.pop()
    return row
