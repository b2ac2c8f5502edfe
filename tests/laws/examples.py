"""Example laws of every representation; the contract suite holds each of them to what a law must do."""

import itertools

import numpy as np

from optlaws import (
    MotionLaw,
    PiecewiseLaw,
    PolynomialLaw,
    catalogue,
    mirrored_law,
    multiplied_law,
    reversed_law,
    savin,
    scca,
    smoothstep,
    trapezoid,
    with_end_velocity,
)
from tests.internals.laws import FractionalSegment, PolynomialSegment, PowerSegment, Segment, SineSegment


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
    return PolynomialLaw.from_powers([power + (base[n] if n < len(base) else 0) for n, power in enumerate(powers)])


def cut(law: PolynomialLaw, *breaks: float) -> PiecewiseLaw:
    """The same law in pieces: c interpolated exactly on each of them."""
    places = [0.0, *breaks, 1.0]
    segments: list[Segment] = []
    for start, end in itertools.pairwise(places):

        def c(x: np.ndarray, start: float = start, length: float = end - start) -> np.ndarray:
            return law.c(start + 0.5 * length * (x + 1.0))

        series = np.polynomial.Chebyshev.interpolate(c, max(law.degree - 2, 0), [-1, 1]).coef
        segments.append(PolynomialSegment(tuple(series.tolist()), law.b(start)))
    return PiecewiseLaw(places, segments, law.a0)


def cut_sine(*breaks: float, powers: tuple[float, float, float] = (0.0, 0.0, 0.0), turns: int = 1) -> PiecewiseLaw:
    """c = p0 + p1 k + p2 k² + 2 pi sin(2 pi turns k) in pieces; the cycloid by default."""
    w = 2 * np.pi * turns
    p0, p1, p2 = powers
    places = [0.0, *breaks, 1.0]
    segments = [
        SineSegment(
            amplitude=2 * np.pi,
            frequency=w,
            phase=w * k,
            b0=p0 * k + p1 * k**2 / 2 + p2 * k**3 / 3 + 4 * np.pi / w * np.sin(w * k / 2) ** 2,
            powers=(p0 + p1 * k + p2 * k * k, p1 + 2 * p2 * k, p2),
        )
        for k in places[:-1]
    ]
    return PiecewiseLaw(places, segments)


def cut_power(first: float, last: float, *breaks: float) -> PiecewiseLaw:
    """Constant power from one velocity to another, in pieces."""
    places = [0.0, *breaks, 1.0]
    b = [np.sign(first + last) * (first**2 + (last**2 - first**2) * k) ** 0.5 for k in places]
    return PiecewiseLaw(places, [PowerSegment(*pair) for pair in itertools.pairwise(b)], 0.25)


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
    "S_4 in three pieces": cut(smoothstep(4), 0.2, 0.55),
    "a random law in two pieces": cut(random_law(5, 7, b0=-1.0), 0.37),
    "a piece of uniform velocity": PiecewiseLaw([0, 1], [PolynomialSegment((), 1.0)]),
    "cycloid": cut_sine(),
    "cycloid in two pieces": cut_sine(0.3),
    "sine on a parabola, three pieces": cut_sine(0.25, 0.625, powers=(1.0, -3.0, 2.0), turns=3),
    "rising power": cut_power(0.8, 1.6, 0.4),
    "falling power backwards": cut_power(-1.6, -1.1),
    "Savin III, alpha = 7.2": savin("III", 7.2),
    "Savin, u = 6": savin(6, -2.0),
    "S_3 with an end velocity": with_end_velocity(smoothstep(3), 0.3),
    "unsymmetric law reversed": reversed_law(random_law(7, 6, b0=0.5)),
    "cycloid in pieces, mirrored": mirrored_law(cut_sine(0.3)),
    "rising power, faster": with_end_velocity(cut_power(0.8, 1.6, 0.4), -0.5),
    "sine on a parabola, reversed": reversed_law(cut_sine(0.25, 0.625, powers=(1.0, -3.0, 2.0), turns=3)),
    "S_3 times y": multiplied_law(smoothstep(3), [2, -7, 10, -6, 3]),
    "modified sine times exp": multiplied_law(scca(0.25, 0.0, 0.75), lambda k: float(np.exp(4.0 * (k - 0.5) ** 2))),
    "modified trapezoid": scca(0.25, 0.5, 0.25),
    "sine and coast": scca(0.2, 0.1, 0.3),
    "S-curve": trapezoid(0.1, 0.15, 0.2),
    "cubic fall": trapezoid(0.05, 0.1, exponent=3),
    "double harmonic": catalogue["double harmonic"].law,
    "Freudenstein 1-3-5": catalogue["Freudenstein 1-3-5"].law,
    "KC05": catalogue["KC05"].law,
    "power of time": PiecewiseLaw([0, 1], [FractionalSegment(4.5, 0.2, 1.1, (1.0, -2.0), -0.1)]),
    "fall like x^4.5": with_end_velocity(trapezoid(0.05, 0.1, exponent=4.5), 0.2),
}
