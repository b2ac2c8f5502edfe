"""Random laws and followers, and their responses by means that share nothing with optlaws."""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from optlaws import MotionLaw, PiecewiseLaw, PolynomialLaw
from tests.internals.laws import PolynomialSegment, Segment, SineSegment

Array = NDArray[np.float64]
CRITICAL = (1.0, 1.0 - 1e-12, 1.0 + 1e-12, 1.0 - 1e-6, 1.0 + 1e-6)


@dataclass(frozen=True)
class Case:
    """A law with its displacement as a plain function, a follower and a state at k = 0."""

    law: MotionLaw
    displacement: Callable[[float], float]
    nu: float
    damping: float
    initial: tuple[float, float]


def random_case(seed: int) -> Case:
    """Nu from 2 to 200 on a logarithmic scale, damping from 0 to 1.5 with some at and near critical."""
    rng = np.random.default_rng(seed)
    nu = float(np.exp(rng.uniform(np.log(2.0), np.log(200.0))))
    damping = float(rng.choice([0.0, rng.uniform(0.0, 0.3), rng.uniform(0.3, 1.5), rng.choice(CRITICAL)]))
    initial = (float(rng.normal()), float(nu * rng.normal())) if seed % 3 == 0 else (0.0, 0.0)
    law, displacement = _polynomial(rng) if seed % 2 else _pieces(rng)
    return Case(law, displacement, nu, damping, initial)


def _polynomial(rng: np.random.Generator) -> tuple[MotionLaw, Callable[[float], float]]:
    count = int(rng.integers(1, 25))
    c = rng.normal(size=count) * rng.uniform(0.6, 1.0) ** np.arange(count)
    b0 = float(rng.normal())
    a = np.polynomial.Chebyshev(c, domain=[0, 1]).integ(lbnd=0, k=b0).integ(lbnd=0)
    return PolynomialLaw(c, b0=b0), lambda k: float(a(k))


def _pieces(rng: np.random.Generator) -> tuple[MotionLaw, Callable[[float], float]]:
    """Sines, sines on parabolas and polynomials, with jumps of acceleration and velocity between them."""
    breaks = [0.0, *np.sort(rng.uniform(0.05, 0.95, size=int(rng.integers(0, 4)))).tolist(), 1.0]
    segments: list[Segment] = []
    functions: list[Callable[[float], float]] = []
    reached = 0.0
    for low, high in itertools.pairwise(breaks):
        b0 = float(rng.normal())
        if rng.random() < 0.4:
            c = rng.normal(size=5)
            segment: Segment = PolynomialSegment(tuple(c.tolist()), b0)
            part = np.polynomial.Chebyshev(c, domain=[0, high - low]).integ(lbnd=0, k=b0).integ(lbnd=0)
            functions.append(lambda s, part=part, reached=reached: reached + float(part(s)))  # type: ignore[misc]
        else:
            amplitude, frequency, phase = float(rng.normal()), float(rng.uniform(1.0, 40.0)), float(rng.uniform(0, 6))
            p = rng.normal(size=3) * (rng.random() < 0.5)
            segment = SineSegment(amplitude, frequency, phase, b0, tuple(p.tolist()))

            def wave(
                s: float,
                p: Array = p,
                wave: tuple[float, float, float] = (amplitude, frequency, phase),
                start: tuple[float, float] = (reached, b0),
            ) -> float:
                A, w, phi = wave
                steady = p[0] * s**2 / 2 + p[1] * s**3 / 6 + p[2] * s**4 / 12
                swing = A / w**2 * (np.sin(phi) + w * s * np.cos(phi) - np.sin(w * s + phi))
                return float(start[0] + start[1] * s + steady + swing)

            functions.append(wave)
        segments.append(segment)
        reached = functions[-1](high - low)

    def displacement(k: float) -> float:
        place = min(int(np.searchsorted(breaks, k, side="right")) - 1, len(functions) - 1)
        return functions[place](k - breaks[place])

    return PiecewiseLaw(breaks, segments), displacement


def integrated(case: Case, k: Sequence[float]) -> Array:
    """Displacement and velocity of the mass at increasing k > 0 by DOP853, restarted at breaks; shape (len(k), 2)."""
    n, square = case.damping * case.nu, case.nu**2
    stops = sorted({*getattr(case.law, "breaks", (0.0, 1.0)), max(1.0, k[-1])})
    state, found = np.array(case.initial), []
    for low, high in itertools.pairwise(stops):
        expected = [one for one in k if low < one <= high]

        def slope(t: float, y: Array, low: float = low, high: float = high) -> list[float]:
            inside = 1.0 if low >= 1.0 else min(max(t, low), np.nextafter(high, low))
            return [y[1], square * (case.displacement(inside) - y[0]) - 2 * n * y[1]]

        times = np.unique([*expected, high])
        done = solve_ivp(slope, (low, high), state, method="DOP853", rtol=1e-12, atol=1e-13, t_eval=times)
        state = done.y[:, -1]
        found += [done.y[:, i] for i in np.flatnonzero(np.isin(times, expected))]
    return np.array(found)


def exact_cycle(law: PolynomialLaw, nu: float, damping: float, pauses: tuple[float, float], k: float) -> list[float]:
    """A_m and its first two derivatives at k of a steady cycle by (1.25): rise, dwell, fall by the same law, rest."""
    import mpmath as mp  # type: ignore[import-untyped]

    with mp.workdps(120):
        frequency, n = mp.mpf(nu), mp.mpf(damping) * mp.mpf(nu)
        matrix = mp.matrix([[0, 1], [-(frequency**2), -2 * n]])
        q = [mp.mpf(one.numerator) / one.denominator for one in map(Fraction, law.exact_powers())]
        low, high = q[0], mp.fsum(q)
        fall = [low + high - q[0], *(-value for value in q[1:])]
        parts = [(q, 1.0), ([high], pauses[0]), (fall, 1.0), ([low], pauses[1])]

        def moved(state: mp.matrix, powers: list[mp.mpf], s: mp.mpf) -> mp.matrix:
            Q = [*powers, mp.mpf(0), mp.mpf(0)]
            for i in range(len(powers) - 1, -1, -1):
                Q[i] -= (i + 1) * (2 * n * Q[i + 1] + (i + 2) * Q[i + 2]) / frequency**2
            steady = mp.matrix([mp.fsum(value * s**i for i, value in enumerate(Q)),
                                mp.fsum(i * Q[i] * s ** (i - 1) for i in range(1, len(Q)))])  # fmt: skip
            return steady + mp.expm(matrix * s) * (state - mp.matrix([Q[0], Q[1]]))

        def period(state: mp.matrix) -> mp.matrix:
            for powers, length in parts:
                state = moved(state, powers, mp.mpf(length))
            return state

        forced = period(mp.matrix([0, 0]))
        columns = [period(mp.matrix(unit)) - forced for unit in ([1, 0], [0, 1])]
        returned = mp.eye(2) - mp.matrix([[columns[0][i], columns[1][i]] for i in range(2)])
        state, left = mp.lu_solve(returned, forced), mp.mpf(k)
        for powers, length in parts:
            if left <= length:
                a, b = moved(state, powers, left)
                cam = mp.fsum(value * left**i for i, value in enumerate(powers))
                return [float(a), float(b), float(frequency**2 * (cam - a) - 2 * n * b)]
            state, left = moved(state, powers, mp.mpf(length)), left - mp.mpf(length)
        raise ValueError(k)


def exact(law: PolynomialLaw, nu: float, damping: float, k: float) -> list[float]:
    """a_m and its first three derivatives at k, from rest, by (1.20) and (1.25) to 120 digits."""
    import mpmath as mp

    with mp.workdps(120):
        frequency, n = mp.mpf(nu), mp.mpf(damping) * mp.mpf(nu)
        q = [mp.mpf(one.numerator) / one.denominator for one in map(Fraction, law.exact_powers())]
        Q = [*q, mp.mpf(0), mp.mpf(0)]
        for i in range(len(q) - 1, -1, -1):
            Q[i] = q[i] - (i + 1) * (2 * n * Q[i + 1] + (i + 2) * Q[i + 2]) / frequency**2
        start = mp.matrix([q[0] - Q[0], -Q[1]])
        free = mp.expm(mp.matrix([[0, 1], [-(frequency**2), -2 * n]]) * mp.mpf(k)) * start
        orders = [free[0], free[1]]
        for _ in range(2):
            orders.append(-2 * n * orders[-1] - frequency**2 * orders[-2])
        values = []
        for order in range(4):
            steady = mp.fsum(mp.ff(i, order) * Q[i] * mp.mpf(k) ** (i - order) for i in range(order, len(Q)))
            values.append(float(steady + orders[order]))
        return values
