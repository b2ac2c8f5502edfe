"""Integrals of formulas with kinks: found and proven, against linear programs on grids and descents of scipy."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import linprog, minimize

from optlaws import (
    Chebyshev,
    Problem,
    Status,
    at_most,
    drive_torque,
    integral,
    rms,
    synthesize,
)
from tests.synthesis.numpy_laws import grid, laws_of

Array = NDArray[np.float64]

#: straight formulas by the orders of derivatives, each within a size
Sizes = list[tuple[float, dict[int, float]]]

_POINTS = 401
_SEEDS = [0, 1, *(pytest.param(seed, marks=pytest.mark.long) for seed in (2, 3))]


def drawn(numbers: np.random.Generator) -> Sizes:
    """One to three sizes of sums of b, c and j."""
    return [
        (
            round(float(numbers.uniform(0.2, 2.0)), 2),
            {
                int(nu): round(float(numbers.uniform(-3.0, 3.0)), 2)
                for nu in numbers.choice([1, 2, 3], 2, replace=False)
            },
        )
        for _ in range(int(numbers.integers(1, 4)))
    ]


def text_of(sizes: Sizes) -> str:
    """The integral of their sum."""
    sums = [" + ".join(f"({factor})*{'abcj'[nu]}" for nu, factor in inner.items()) for _, inner in sizes]
    return f"integral({' + '.join(f'{weight}*abs({one})' for (weight, _), one in zip(sizes, sums, strict=True))})"


def least_on_grid(problem: Problem, sizes: Sizes) -> float:
    """The least sum of the sizes at places that are dense at the ends, by weights of the trapezium rule."""
    laws, k = laws_of(problem), grid(0.0, 1.0, _POINTS)
    weights = np.gradient(k)
    free = laws.free
    cost, table, right = [np.zeros(free)], [], []
    for i, (weight, inner) in enumerate(sizes):
        rows = np.sum([factor * laws.rows(laws.derivative(nu), 0, k) for nu, factor in inner.items()], axis=0)
        own = np.zeros((_POINTS, len(sizes) * _POINTS))
        own[:, i * _POINTS : (i + 1) * _POINTS] = -np.eye(_POINTS)
        for sign in (1.0, -1.0):
            table.append(np.hstack([sign * rows[:, :-1], own]))
            right.append(-sign * rows[:, -1])
        cost.append(weight * weights)
    bounds = [(None, None)] * free + [(0.0, None)] * (len(sizes) * _POINTS)
    answer = linprog(np.concatenate(cost), np.vstack(table), np.concatenate(right), bounds=bounds, method="highs-ipm")
    return float(np.asarray(answer.fun))


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", _SEEDS)
def test_sums_of_sizes_are_proven_and_what_a_grid_says(seed: int) -> None:
    numbers = np.random.default_rng(seed)
    order, degree, sizes = int(numbers.integers(2, 5)), int(numbers.choice([3, 5, 9])), drawn(numbers)
    solution = synthesize(Problem(order=order, basis=Chebyshev(degree), symmetric=False, minimise=text_of(sizes)))
    assert solution.status is Status.OPTIMAL
    assert solution.lower_bound <= solution.objective * (1.0 + 1e-12)
    assert solution.objective == pytest.approx(least_on_grid(solution.problem, sizes), rel=2e-3)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("order", "weight", "velocity"), [(4, 1.3, 1.7), (3, 0.5, 1.7), (5, 1.3, 1.7), (3, 1.3, 1.7), (4, 0.5, 1.7)]
)
def test_kinks_that_crowd_are_all_found(order: int, weight: float, velocity: float) -> None:
    """A formula that nearly vanishes along a stretch changes its sign four times within a few hundredths there."""
    solution = synthesize(Problem(B=velocity, order=order, minimise=f"integral(abs(c - {weight}*b))"))
    assert solution.status is Status.OPTIMAL
    assert solution.objective == pytest.approx(least_with_velocity(order, 9, weight, velocity), rel=1e-6)


def least_with_velocity(order: int, free: int, weight: float, velocity: float) -> float:
    """The least integral of |c - weight b| with b at most b(1/2), by Gauss's rule on many short parts."""
    terms, rest = free + 2, order - 1

    def rows(k: Array) -> tuple[Array, Array]:
        basis, hill = np.polynomial.chebyshev.chebvander(2.0 * k - 1.0, terms - 1), (4.0 * k * (1.0 - k)) ** rest
        slope = 4.0 * rest * (4.0 * k * (1.0 - k)) ** (rest - 1) * (1.0 - 2.0 * k)
        turned = 2.0 * np.polynomial.chebyshev.chebder(np.eye(terms))
        of_basis = np.polynomial.chebyshev.chebvander(2.0 * k - 1.0, terms - 2) @ turned
        return hill[:, None] * basis, slope[:, None] * basis + hill[:, None] * of_basis

    x, share = np.polynomial.legendre.leggauss(4)
    edges = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 401))
    width = np.diff(edges)[:, None]
    k, weights = (edges[:-1, None] + width * (x + 1.0) / 2.0).ravel(), (width * share / 2.0).ravel()
    b, c = rows(k)
    middle = rows(np.array([0.5]))
    most = rows(edges)[0]
    size = np.eye(len(k))
    answer = linprog(
        np.concatenate([np.zeros(terms), weights, weights]),
        A_ub=np.hstack([most, np.zeros((len(most), 2 * len(k)))]),
        b_ub=np.full(len(most), velocity),
        A_eq=np.vstack(
            [
                np.hstack([c - weight * b, -size, size]),
                np.hstack([np.vstack([weights @ b, middle[0][0], middle[1][0]]), np.zeros((3, 2 * len(k)))]),
            ]
        ),
        b_eq=np.concatenate([np.zeros(len(k)), [1.0, velocity, 0.0]]),
        bounds=[(None, None)] * terms + [(0.0, None)] * (2 * len(k)),
        method="highs-ipm",
    )
    return float(np.asarray(answer.fun))


#: kinds of integrals, by two numbers
_INTEGRALS: list[Callable[[float, float], str]] = [
    lambda weight, _: f"integral(abs(c - {weight:.4f}*b))",
    lambda weight, _: f"integral(abs(j - {10.0 * weight:.4f}*b))",
    lambda weight, beside: f"integral(abs(c - {weight:.4f}*b + {beside:.4f}))",
    lambda weight, _: f"integral(abs(c)) + {weight:.4f}*integral(abs(j))/20",
]


@pytest.mark.sample(45)
@pytest.mark.parametrize("seed", range(90))
def test_random_integrals_of_sizes_are_optimal(seed: int) -> None:
    """Pairs of kinks are often within 1e-4 of each other at the optimum, or come and go at the middle of a law."""
    numbers = np.random.default_rng(seed)
    order, degree = int(numbers.integers(3, 7)), int(numbers.integers(5, 16))
    velocity, weight, beside = numbers.uniform(1.4, 2.0), numbers.uniform(0.1, 2.5), numbers.uniform(-1.0, 1.0)
    formula = _INTEGRALS[seed % len(_INTEGRALS)](weight, beside)
    solution = synthesize(Problem(B=float(velocity), order=order, basis=Chebyshev(degree), minimise=formula))
    assert solution.status is Status.OPTIMAL
    assert solution.lower_bound <= solution.objective * (1.0 + 1e-12)
    assert solution.gap <= 1e-8


@pytest.mark.parametrize(
    ("order", "degree", "velocity", "formula", "least"),
    [
        # by Newton's method on the law and the kinks together, and linear programs on 2,560 places within 1e-6
        (4, 10, 1.6993918713842089, "integral(abs(c - 1.1187*b + 0.1514))", 3.2002308564),
        (6, 6, 1.8321270671959693, "integral(abs(c)) + 1.0467*integral(abs(j))/20", 5.0958326742),
    ],
)
def test_kinks_that_nearly_vanish_in_pairs_are_found(
    order: int, degree: int, velocity: float, formula: str, least: float
) -> None:
    solution = synthesize(Problem(B=velocity, order=order, basis=Chebyshev(degree), minimise=formula))
    assert solution.status is Status.OPTIMAL
    assert solution.objective == pytest.approx(least, rel=1e-8)


def test_they_are_bounds_and_parts_of_mixtures_too() -> None:
    problem = Problem(B=1.8, order=4, symmetric=False)
    wander = integral("abs(j)")
    least = synthesize(Problem(B=1.8, order=4, symmetric=False, minimise=wander)).objective
    bounded = synthesize(Problem(B=1.8, order=4, symmetric=False, bounds={wander: at_most(1.05 * least)}))
    mixed = synthesize(Problem(B=1.8, order=4, symmetric=False, minimise="C + 0.2*integral(abs(j))"))
    assert (bounded.status, mixed.status) == (Status.OPTIMAL, Status.OPTIMAL)
    assert wander.value(bounded.law) <= 1.05 * least * (1.0 + 1e-9)
    assert synthesize(problem).objective <= bounded.objective * (1.0 + 1e-9)


def test_where_a_formula_vanishes_along_the_law_its_corner_is_proven() -> None:
    # of order 1 the law a = k has no acceleration at all: the integral has a corner there
    solution = synthesize(Problem(order=1, minimise="C + 0.25*integral(2*abs(a + b) + 4*abs(c))"))
    assert solution.status is Status.OPTIMAL
    assert solution.objective == pytest.approx(0.75, rel=1e-9)


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", _SEEDS)
def test_no_descent_of_scipy_finds_a_law_of_less_heat(seed: int) -> None:
    numbers = np.random.default_rng(seed)
    share, waves, drag = numbers.uniform(0.2, 3.0), int(numbers.integers(1, 3)), numbers.uniform(0.0, 1.0)
    torque = drive_torque(inertia=f"1 + {share:.3f}*sin({waves}*pi*a)^2", friction=f"{drag:.3f}")
    heat = rms(torque)
    solution, k = synthesize(Problem(order=3, basis=Chebyshev(5), symmetric=False, minimise=heat)), grid(0.0, 1.0, 201)
    laws = laws_of(solution.problem)
    motion = [laws.rows(laws.derivative(nu), 0, k) for nu in range(3)]

    def on_grid(z: Array) -> float:
        a, b, c = (rows @ np.append(z, 1.0) for rows in motion)
        bend = share * waves * np.pi * np.sin(2 * waves * np.pi * a)
        force = (1.0 + share * np.sin(waves * np.pi * a) ** 2) * c + 0.5 * bend * b**2 + drag * b
        return float(np.trapezoid(force**2, k))

    starts = [np.zeros(laws.free), *numbers.normal(size=(4, laws.free)) * 3.0]
    least = min(minimize(on_grid, start, method="BFGS").fun for start in starts)
    assert solution.objective <= float(np.sqrt(least)) * (1.0 + 2e-3)


def test_what_is_symmetric_and_not_convex_descends_from_the_law_it_begins_at() -> None:
    heat = rms(drive_torque(inertia="1 + 3*sin(pi*a)^2"))
    problem = Problem(order=3, basis=Chebyshev(9), minimise=heat)
    assert problem.symmetric
    assert synthesize(problem).objective == pytest.approx(6.082473, abs=1e-6)


@pytest.mark.parametrize(
    ("minimise", "symmetric"),
    [
        ("rms(c + 4*a)", False),
        ("rms(c)", True),
        ("peak(b*c)", True),
        ("peak(b*c, side=high)", False),
        ("integral(abs(c), stop=0.4)", False),
        ("C + 0.1*integral(max(b*c, 0))", False),
        ("C", True),
    ],
)
def test_unless_asked_laws_are_symmetric_where_all_that_is_asked_is(minimise: str, symmetric: bool) -> None:  # noqa: FBT001
    problem = Problem(order=3, minimise=minimise)
    assert problem.symmetric is symmetric
    assert Problem(order=3, minimise=minimise, symmetric=True).symmetric
    bounded = Problem(order=3, bounds={name: at_most(9.0) for name in [minimise] if minimise[0] != "C"})
    assert bounded.symmetric is (symmetric or minimise[0] == "C")
