"""Starts for problems that are not convex: a few laws, the same at every run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import inf, isfinite
from typing import TYPE_CHECKING

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.functionals.formula_rows import columns_of
from optlaws.synthesis.method.exchange import Method, solve
from optlaws.synthesis.problem.constants import PowerConstant
from optlaws.synthesis.program.writer import Model, model_of

if TYPE_CHECKING:
    from optlaws.synthesis.limits.drive_limits import DriveLimit

_AMPLE = 1.2


def points(model: Model, method: Method = "auto") -> Iterator[Array]:
    """Coordinates of the laws of least RMS of c and of least C; D follows from the law."""
    problem = model.problem
    bounds = {name: limits for name, limits in problem.bounds.items() if name.convex}
    for constant in ("rms_c", "C"):
        smooth = model_of(replace(problem, minimise=constant, D=None, bounds=bounds))
        optimum = solve(smooth.program, method=method).optimum
        if optimum is not None:
            yield _completed(model, model.coordinates(optimum.x))


def in_phase_plane(model: Model, limit: DriveLimit) -> Array:
    """The variables of the law whose velocity is nearest to the motion that is a drive's limit."""
    # it takes as long to import as all of optlaws that a law needs
    from scipy.linalg import null_space

    k, a, b = limit.motion()
    space = model.space
    share = np.sqrt(np.gradient(k))[:, None]
    rows = np.vstack([share * columns_of(space, 1, k), share * columns_of(space, 0, k)])
    right = np.concatenate([share[:, 0] * b, share[:, 0] * a]) - rows[:, -1]
    equations = space.equations()
    fixed = np.array([equation.row for equation in equations]).reshape(-1, space.terms)
    to = np.array([equation.right for equation in equations])
    least = np.linalg.lstsq(fixed, to, rcond=None)[0]
    free = null_space(fixed) if len(fixed) else np.eye(space.terms)
    moved = np.linalg.lstsq(rows[:, :-1] @ free, right - rows[:, :-1] @ least, rcond=None)[0]
    return _completed(model, least + free @ moved)


def _completed(model: Model, coordinates: Array) -> Array:
    """The start completed with values of the variables beyond the coordinates that leave slack."""
    x = np.zeros(model.program.size)
    x[: model.space.terms] = coordinates
    law = model.space.law(coordinates)
    constants = {
        constant.name: constant
        for constant in model.problem.constants
        if not (constant.convex or isinstance(constant, PowerConstant))
    }
    for name, place in model.places.items():
        value = constants[name].value(law) if name in constants else inf
        if isfinite(value):
            x[place] = _AMPLE * value / model.scales.get(name, 1.0)
        else:
            x[place] = law.peak(1).value if name == "B" else 2.0 * law.power_peak().value
    return x
