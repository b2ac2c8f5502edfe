"""Random motions of polynomials, for exports to carry."""

import numpy as np

from optlaws import PiecewiseMotion


def random_motion(number: int, pieces: int = 5, degree: int = 7) -> PiecewiseMotion:
    rng = np.random.default_rng(number)
    breaks = np.cumsum(rng.uniform(0.1, 2.0, pieces + 1)) - 3.0
    return PiecewiseMotion(breaks, rng.normal(size=(pieces, degree + 1)) * 10.0 ** rng.integers(-3, 3))
