"""Sizing of a torsion lever: limits of its linkage, and the asymptotic formulas, eq. (3), (9), (12), (13)."""

from __future__ import annotations

from math import degrees, pi
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from optlaws.balancing.levers.linkage import FourBar
from optlaws.errors import InputError
from optlaws.numerics.peaks import polished

_REAL_ROOT = 1e-7  # of a swing: roots with a smaller imaginary part are real

#: least transmission angle that is allowed unless another is given, radians
LEAST_TRANSMISSION = pi / 6.0
#: greatest swing of the rocker that is allowed unless another is given, radians
MOST_ROCKER_SWING = pi / 3.0

LEAST_SHARE, GREATEST_SHARE = 0.2, 0.8  # of the swing, between which chi01 is looked for


class Sizing(NamedTuple):
    """The solution of (3), (12) and (13): chi01 and gamma01 in radians, xi = c2/c1 dimensionless."""

    chi01: float
    gamma01: float
    xi: float


def sized(linkage: FourBar, rho: float, nu: float, swing: float) -> Sizing:
    """The solution of (3), (12) and (13) at a given nominal swing, radians; the root chi01 nearest to half of it.

    Examples
    --------
    >>> from math import pi
    >>> [round(value, 8) for value in sized(FourBar(0.75, 1.0), 0.15, 0.15, pi / 3)]
    [0.51694089, 0.38015108, 0.53768926]
    """
    beta = linkage.beta
    chi01, chi02 = Polynomial([0.0, 1.0]), Polynomial([swing, -1.0])
    gamma01 = Polynomial([0.0, beta, 0.0, linkage.S])
    # (13) multiplied by |chi02|, which makes it a quartic; n stands for |chi02| n / c1
    n = beta * (1.0 + rho) / (1.0 + nu) * gamma01 + beta**2 * chi02
    q = linkage.Q * (1.0 + rho) * gamma01 * chi02
    p = (linkage.P - linkage.R * (1.0 + rho) * gamma01) * chi02
    quartic = 1536.0 * n * chi01 - swing * (768.0 * n - 64.0 * swing * q + swing**2 * p)
    roots = quartic.roots()
    real = roots.real[np.abs(roots.imag) <= _REAL_ROOT * swing] / swing
    inside = real[(real > LEAST_SHARE) & (real < GREATEST_SHARE)]
    if not len(inside):
        raise InputError(
            f"eq. (13) has no root chi01 between {LEAST_SHARE} and {GREATEST_SHARE} of the swing, {degrees(swing):.6g} "
            f"deg, with {linkage!r}: the asymptotic formulas do not reach so far; reduce swing"
        )
    share = polished(
        inside[[np.argmin(np.abs(inside - 0.5))]], lambda x: (quartic(swing * x), swing * quartic.deriv()(swing * x))
    )
    angle = swing * float(share[0])
    rocker = float(gamma01(angle))
    return Sizing(angle, rocker, beta * rocker * (1.0 + rho) / ((swing - angle) * (1.0 + nu)))
