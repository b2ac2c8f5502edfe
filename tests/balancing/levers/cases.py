"""Reference cases of the torsion lever, and the motion of the truncated equation."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from optlaws import TorsionLever, deg
from tests.internals.balancing import LeverMotion, swung, upper_extreme

Array = NDArray[np.float64]
Row = Mapping[str, str]


def lever(row: Row, lam: str = "lambda", **limits: float) -> TorsionLever:
    beta, length, rho, nu, swing = (float(row[name]) for name in ("beta", lam, "rho", "nu", "swing_deg"))
    return TorsionLever(beta=beta, lam=length, rho=rho, nu=nu, swing=deg(swing), **limits)


def truncated(one: TorsionLever) -> LeverMotion:
    """The motion of eq. (6), with the moment cut off after chi³."""

    def potential(chi: Array) -> Array:
        return np.asarray(chi**2 * (one.n / 2 + chi * (one.q / 6 + chi * one.p / 24)))

    def moment(chi: Array) -> tuple[Array, Array]:
        return one.taylor_moment(chi), np.asarray(one.n + chi * (one.q + chi * one.p / 2))

    chi01 = upper_extreme(potential, one.swing, (-2.0, 2.0), one.chi01)
    return swung(potential, moment, chi01, one.swing)


def apart(first: LeverMotion, second: LeverMotion, points: int = 201) -> float:
    k = np.linspace(0.0, 1.0, points)
    return float(np.abs(first.halves.a(k) - second.halves.a(k)).max())
