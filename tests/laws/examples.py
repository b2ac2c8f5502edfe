"""Example laws of every representation; the contract suite holds each of them to what a law must do."""

import numpy as np

from optlaws.laws import MotionLaw, PolynomialLaw, smoothstep


def random_law(seed: int, count: int, decay: float = 1.0, b0: float = 0.0) -> PolynomialLaw:
    """A law with `count` random Chebyshev coefficients of c, the n-th scaled by decay^n."""
    numbers = np.random.default_rng(seed).normal(size=count)
    return PolynomialLaw(numbers * decay ** np.arange(count), b0=b0)


def free_function_law(seed: int, order: int, terms: int) -> PolynomialLaw:
    """Eq. 8 with random Z of integer powers: S_l + k^l (k-1)^l Z(k), formed from exact integers."""
    z = np.random.default_rng(seed).integers(-20, 20, size=terms).tolist()
    powers = [0] * (2 * order + terms)
    edge = [1]
    for _ in range(order):
        edge = [low - high for low, high in zip([0, *edge], [*edge, 0], strict=True)]
    for i, value in enumerate(edge):
        for n, factor in enumerate(z):
            powers[order + i + n] += value * factor
    base = smoothstep(order).exact_powers()
    return PolynomialLaw.from_powers(
        [one + (base[n] if n < len(base) else 0) for n, one in enumerate(powers)],
    )


EXAMPLES: dict[str, MotionLaw] = {
    "uniform velocity": smoothstep(1),
    "rest": PolynomialLaw([]),
    "uniform acceleration": PolynomialLaw.from_powers([0, 0, 1]),
    "S_2": smoothstep(2),
    "S_4": smoothstep(4),
    "S_12": smoothstep(12),
    "from moving to moving": PolynomialLaw.from_powers([0.25, 1.5, -3, 2]),
    "random, degree 9": random_law(1, 8, b0=0.5),
    "random, degree 61": random_law(2, 60, 0.9),
    "Z of degree 5": free_function_law(3, 4, 6),
}
