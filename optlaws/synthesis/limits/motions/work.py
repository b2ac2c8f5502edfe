"""What an energy is at least, whatever the motion: the work of its torques, of which the inertia's adds up to 0.

From rest to rest the integral of I c + I' b²/2 over the position is 0, so that the integral of a torque
I c + S b² + R b + T is that of T + R b + (S - I'/2) b². The integral of b is at least 1, as the stroke and the time
are. The greater of two torques takes at least the work of each of them.
"""

from __future__ import annotations

from math import fsum, inf, nextafter

import numpy as np

from optlaws.formulas.tree import Number
from optlaws.numerics.interval import between, exact
from optlaws.numerics.taylor import variable
from optlaws.synthesis.limits.formula_jets import formula_jet
from optlaws.synthesis.limits.phase_plane import PhasePlane
from optlaws.synthesis.limits.phase_torque import PhaseTorque
from optlaws.tolerances import ROUNDOFF

_CELLS = 1024
_ROUNDING = 8.0 * ROUNDOFF  # cells are a little wider than they are


def least_energy(plane: PhasePlane) -> float:
    """A lower bound of what is minimised, from the work of every power alone; at least 0 where there is none.

    >>> from optlaws.formulas.reading import read
    >>> lifting = PhaseTorque.of(read("(1 + a)*c + 0.5*b^2 + 3*a^2"))
    >>> round(least_energy(PhasePlane(maxima=((lifting, lifting.scaled(0.5)),), C=9.0)), 8)
    1.0
    """
    works = [
        max(_least_work(plane, branch) for torque in torques for branch in torque.branches) for torques in plane.maxima
    ]
    return fsum(works) if len(works) < 2 or -inf in works else nextafter(fsum(works), -inf)


def _least_work(plane: PhasePlane, torque: PhaseTorque) -> float:
    """A lower bound of the integral of a torque over the position, by Taylor's formula in cells."""
    if torque == PhaseTorque(Number(0.0)):
        return 0.0
    ends = np.unique(np.concatenate([np.linspace(0.0, 1.0, _CELLS + 1), plane.kinks]))
    low, high = ends[:-1], ends[1:]
    middle, half = 0.5 * (low + high), exact(0.5 * (high - low) * (1.0 + _ROUNDING))
    cells, most = variable(between(low, high), 2), plane.greatest_velocity
    at, over = formula_jet(torque.load, "a", variable(exact(middle), 1)), formula_jet(torque.load, "a", cells)
    inertia, square, drag = (formula_jet(factor, "a", cells) for factor in torque.factors[:3])
    rest = (square.terms[0] - inertia.terms[1] * 0.5).low
    rubs = float(np.min(drag.terms[0].low))
    with np.errstate(invalid="ignore", over="ignore"):
        by_taylor = (at.terms[0] + over.terms[2] * half * half * (1.0 / 3.0)).low
        load = np.fmax(np.where(np.isfinite(by_taylor), by_taylor, -inf), over.terms[0].low)
        of_square = np.where(rest < 0.0, rest * most * most * (1.0 + _ROUNDING), 0.0)
        parts = ((exact(load) + of_square) * half * 2.0).low
    if not np.isfinite(parts).all():
        return -inf
    rounding = _ROUNDING * fsum(np.abs(parts).tolist())
    return nextafter(fsum(parts.tolist()) - rounding + (rubs if rubs >= 0.0 else rubs * most), -inf)
