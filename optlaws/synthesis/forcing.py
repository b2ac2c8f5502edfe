"""Lower bounds of peaks: rows can hold a peak down everywhere, but up only at a place, which has to be found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from optlaws.synthesis.functionals import FUNCTIONALS
from optlaws.synthesis.programs import Model
from optlaws.synthesis.rows import Family

_COARSE = 13
_WIDTH = 1e-9


def forced(found: Model, name: str, low: float, k: float, sign: float) -> Model:
    """The model with the further row: sign times b, c, d or j is at least `low` at k."""
    zero = np.zeros(found.program.size)
    (family,) = FUNCTIONALS[name].families(found.space, zero, 0.0)
    u = float(family.u(np.array([k]))[0])
    row: Family = replace(family, name=f"{name} at least", bound=-low, signs=(-sign,), domain=(u, u))
    return replace(found, program=replace(found.program, families=(*found.program.families, row)))


def best_place(worth: Callable[[float], float], ends: tuple[float, float]) -> float:
    """Where `worth` is least: a coarse look, then a bounded search around the best place."""
    from scipy.optimize import minimize_scalar

    places = np.linspace(*ends, _COARSE)
    values = [worth(float(k)) for k in places]
    best = int(np.argmin(values))
    around = (float(places[max(best - 1, 0)]), float(places[min(best + 1, _COARSE - 1)]))
    found = minimize_scalar(worth, bounds=around, method="bounded", options={"xatol": _WIDTH})
    return float(found.x) if found.fun < values[best] else float(places[best])
