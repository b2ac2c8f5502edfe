"""Lower bounds of peaks: rows hold a peak down everywhere, but it is held up at one extremum, which moves.

The optimum without the lower bound is continued: one extremum of the constant is held as an equation, first at the
value that it has and then, step by step, at the bound. Each extremum leads to a candidate; the best one counts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.active_set import ActiveSet
from optlaws.synthesis.exchange import polished
from optlaws.synthesis.functionals import FUNCTIONALS
from optlaws.synthesis.programs import Model
from optlaws.synthesis.rows import Family, Program

Array = NDArray[np.float64]

_FIRST_STEP = 0.25
_LEAST_STEP = 1e-3
_WORTHY = 0.2


def held_up(found: Model, plain: ActiveSet, name: str, low: float, holds: Callable[[Array], bool]) -> list[ActiveSet]:
    """Optima in which the constant `name` is held at `low` at one of its extrema, from the optimum without that."""
    (family,) = FUNCTIONALS[name].families(found.space, np.zeros(found.program.size), 0.0)
    held = replace(family, name=f"{name} at least", held=True)
    u, s, height = family.extremes(plain.x)
    inside = (u > family.domain[0]) & (u < family.domain[1]) & ~family.pinned(u)
    led = []
    for j in np.flatnonzero(height > _WORTHY * height.max()):
        start = plain.joined(len(found.program.families), float(u[j]), float(s[j]), free=bool(inside[j]))
        led.append(_continued(found.program, held, start, (float(height[j]), low), holds))
    return [one for one in led if one is not None]


def _continued(
    program: Program, held: Family, state: ActiveSet, heights: tuple[float, float], holds: Callable[[Array], bool]
) -> ActiveSet | None:
    height, low = heights
    done, step = 0.0, _FIRST_STEP
    while done < 1.0:
        target = min(done + step, 1.0)
        bound = height + target * (low - height)
        pinned = replace(program, families=(*program.families, replace(held, bound=bound)))
        moved = polished(pinned, state, holds)
        if moved is None:
            step /= 2.0
            if step < _LEAST_STEP:
                return None
            continue
        state, done = moved, target
        step *= 1.5
    return state
