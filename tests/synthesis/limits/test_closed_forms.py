"""The closed-form limits against independent programs, which approach them from above, and their laws."""

from itertools import pairwise
from math import nan, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from optlaws import Chebyshev, InputError, Problem, acceleration_limit, limit, limit_law, synthesize
from tests.internals.laws import PowerSegment
from tests.internals.synthesis import acceleration_limit_at_jerk, jerk_limit, power_limit, rms_limit
from tests.synthesis.limit_programs import least_by_steps, least_by_velocities


def least_acceleration(B: float, cells: int, *, monotone: bool, order: int) -> float:
    """Least max |c| of laws with constant c on each of `cells` equal cells: exact for those laws.

    Variables are the velocities at the nodes, between which b is linear, and C.
    """
    h = 1.0 / cells
    nodes = cells + 1
    rise = (np.eye(cells, nodes, 1) - np.eye(cells, nodes)) / h
    C = -np.ones((cells, 1))
    rows = np.block([[rise, C], [-rise, C]])
    stroke = np.full(nodes, h)
    stroke[[0, -1]] = h / 2
    middle = np.zeros(nodes)
    middle[cells // 2] = 1.0
    lowest = 0.0 if monotone else -np.inf
    bounds: list[tuple[float | None, float | None]] = [(lowest, B)] * nodes + [(0.0, None)]
    if order > 1:
        bounds[0] = bounds[-2] = (0.0, 0.0)
    answer = linprog(
        np.append(np.zeros(nodes), 1.0),
        A_ub=rows,
        b_ub=np.zeros(2 * cells),
        A_eq=np.column_stack([np.vstack([stroke, middle]), np.zeros(2)]),
        b_eq=[1.0, B],
        bounds=bounds,
        method="highs",
    )
    assert answer.status == 0, answer.message
    assert answer.fun is not None
    return float(answer.fun)


CASES = [
    (1.1, False, 2),
    (1.3, False, 2),
    (1.641, False, 4),
    (1.9, True, 3),
    (2.0, False, 2),
    (2.0, True, 2),
    (2.3, False, 2),
    (3.0, False, 5),
    (2.3, True, 2),
    (3.0, True, 2),
    (1.5, False, 1),
    (1.5, True, 1),
    (2.7, False, 1),
    (2.7, True, 1),
]


@pytest.mark.sample(9)
@pytest.mark.parametrize(("B", "monotone", "order"), CASES)
def test_piecewise_constant_accelerations_approach_the_limit_from_above(
    B: float,
    monotone: bool,  # noqa: FBT001
    order: int,
) -> None:
    limit = acceleration_limit(B, monotone=monotone, order=order)
    found = [least_acceleration(B, cells, monotone=monotone, order=order) for cells in (20, 60, 180, 540)]
    assert all(value >= limit * (1 - 1e-9) for value in found)
    # each grid contains the one before: C cannot rise
    assert all(fine <= coarse * (1 + 1e-9) for coarse, fine in pairwise(found))
    assert found[-1] <= limit * (1 + 3e-4)
    assert found[-1] - limit <= max(0.1 * (found[0] - limit), 1e-9 * limit)


@pytest.mark.sample(5)
@pytest.mark.parametrize("B", [1.2, 1.641, 2.0, 2.3, 3.0])
@pytest.mark.parametrize("monotone", [False, True])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_rich_law_comes_near_the_limit_and_not_below(B: float, order: int, monotone: bool) -> None:  # noqa: FBT001
    solution = synthesize(Problem(B=B, order=order, basis=Chebyshev(51), monotone=monotone))
    assert solution.best_possible == acceleration_limit(B, monotone=monotone, order=order)
    assert solution.best_possible < solution.lower_bound < solution.best_possible * 1.2


# --- limits of D, J, RMS and of C at a given J ---


def check_from_above(limit: float, found: list[float], near: float) -> None:
    assert all(value >= limit * (1 - 1e-7) for value in found), (limit, found)
    assert found[-1] <= limit * (1 + near), (limit, found)
    assert found[-1] <= found[0] * (1 + 1e-7), (limit, found)


JERKS = [
    *(
        (B, monotone, order)
        for order in (2, 3)
        for B, monotone in [(1.2, False), (1.7, False), (1.9, True), (2.6, False)]
    ),
    (1.4, True, 2),
    (2.0, False, 3),
    (2.5, True, 2),
    (2.5, True, 3),
    (4.0, False, 3),
    (4.0, False, 2),
]


@pytest.mark.sample(9)
@pytest.mark.parametrize(("B", "monotone", "order"), JERKS)
def test_steps_of_jerk_approach_the_limit_of_j(B: float, order: int, *, monotone: bool) -> None:
    found = [least_by_steps("J", B, cells, monotone=monotone, order=order) for cells in (40, 120, 240)]
    check_from_above(jerk_limit(B, monotone=monotone, order=order), found, 0.02)


@pytest.mark.sample(8)
@pytest.mark.parametrize(
    ("B", "monotone"), [(1.3, False), (1.7, True), (2.0, False), (2.05, False), (2.6, False), (2.6, True), (4.0, False)]
)
@pytest.mark.parametrize("share", [1.03, 1.3, 2.5, 12.0])
def test_trapezoids_are_the_least_accelerations_at_given_jerk(B: float, share: float, *, monotone: bool) -> None:
    J = share * jerk_limit(B, monotone=monotone)
    found = [least_by_steps("C", B, cells, monotone=monotone, J=J) for cells in (80, 240)]
    check_from_above(acceleration_limit_at_jerk(B, J, monotone=monotone), found, 0.015)


@pytest.mark.parametrize(
    ("B", "monotone"), [(1.1, False), (1.4, True), (1.5, False), (1.8, False), (2.9, True), (4.0, False), (4.0, True)]
)
def test_piecewise_linear_velocities_approach_the_limit_of_the_rms(B: float, *, monotone: bool) -> None:
    found = [
        least_by_velocities("RMS", B, cells, monotone=monotone, start=np.linspace(0, B, cells + 1)[1:-1])
        for cells in (10, 40)
    ]
    check_from_above(rms_limit(B, monotone=monotone), found, 3e-3)


@pytest.mark.parametrize(
    ("B", "monotone"), [(1.2, False), (1.4, True), (1.5, False), (1.7, False), (1.7, True), (2.4, False), (2.4, True)]
)
def test_piecewise_linear_velocities_approach_the_limit_of_d(B: float, *, monotone: bool) -> None:
    least = power_limit(B, monotone=monotone)
    excess = []
    for cells in (6, 12, 24):
        k = np.linspace(0.0, 0.5, cells + 1)[1:-1]
        # not convex: two starts, one of which goes back first
        starts = [B * np.sqrt(2 * k), B * (2 * k) ** 3 - 0.6 * np.sin(2 * np.pi * np.sqrt(2 * k))]
        found = [least_by_velocities("D", B, cells, monotone=monotone, start=start) for start in starts]
        excess.append(min(found) - least)
    # a straight line stands for the root b = sqrt(2Dk) of the first cell, so the excess falls as 1/cells
    assert 0.0 < excess[2] <= 0.58 * excess[1]
    assert excess[1] <= 0.62 * excess[0]
    assert excess[2] <= 0.25 * least


def test_the_least_of_all() -> None:
    grid = np.linspace(1.05, 4.0, 296).round(3).tolist()
    for constant, order, least, at in [
        ("C", 3, 4.0, 2.0), ("D", 3, 2.25, 1.5), ("J", 2, 12.0, 1.5), ("J", 3, 32.0, 2.0), ("RMS", 3, sqrt(12), 1.5),
    ]:  # fmt: skip
        assert limit(constant, order=order) == pytest.approx(least, rel=1e-15)
        values = [limit(constant, B, order=order) for B in grid]
        assert min(values) == pytest.approx(least, rel=1e-14)
        assert grid[int(np.argmin(values))] == at
    assert limit("C", J=100.0) == pytest.approx(min(limit("C", B, J=100.0) for B in grid if jerk_limit(B) <= 100.0))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("S", 2.0), "constant 'S' is unknown; known are C, D, J, RMS"),
        (("J", 2.0, {"order": 1}), "order must be an integer of at least 2"),
        (("C", 2.0, {"order": 0}), "order must be an integer of at least 1"),
        (("C", 2.0, {"order": 2, "J": 100.0}), "order must be an integer of at least 3"),
        (("D", 2.0, {"order": "3"}), "order must be an integer"),
        (("D", 2.0, {"J": 100.0}), "for the constant 'C' only"),
        (("C", 2.0, {"J": 31.9}), "J must be a finite number of at least 32.0"),
        (("C", 2.0, {"J": nan}), "J must be a finite number"),
        (("C", 2.0, {"J": "100"}), "J must be a finite number"),
        (("C", None, {"order": 1}), "B must be given at order 1"),
    ],
)
def test_a_limit_that_makes_no_sense_is_refused(arguments: tuple[Any, ...], message: str) -> None:
    constant, B, options = (*arguments, {})[:3]
    with pytest.raises(InputError, match=message):
        limit(constant, B, **options)


# --- laws that attain them ---


K = np.linspace(0.0, 1.0, 401)


@pytest.mark.parametrize("ulps", [1, 2, 5, 40, 1000, 10**6])
def test_a_law_of_constant_power_loses_no_stretch_in_rounding(ulps: int) -> None:
    B = 1.5 + ulps * np.spacing(1.5)
    law = limit_law("D", B)
    assert law.constants.D.value == pytest.approx(limit("D", B), rel=1e-12)
    assert [law.b(0.5), law.constants.B.value] == pytest.approx([B, B], rel=1e-12)
    assert np.abs(law.a(K) + law.a(1.0 - K) - 1.0).max() <= 1e-13


@pytest.mark.parametrize("B", [1.2, 1.6, 2.5])
def test_at_the_least_jerk_the_trapezoid_is_the_law_of_steps(B: float) -> None:
    steps, trapezoid = limit_law("J", B), limit_law("C", B, J=jerk_limit(B))
    assert trapezoid.b(K) == pytest.approx(steps.b(K), abs=1e-6)


@pytest.mark.parametrize(
    ("constant", "order", "continuity"),
    [("C", 1, 1), ("C", 3, 1), ("D", 3, 1), ("J", 2, 2), ("J", 3, 2), ("RMS", 3, 1)],
)
@pytest.mark.parametrize("monotone", [False, True])
@pytest.mark.parametrize("B", [1.6, 2.4, 3.5])
def test_continuity_is_that_of_the_optimal_control(
    constant: str, order: int, continuity: int, B: float, *, monotone: bool
) -> None:
    law = limit_law(constant, B, order=order, monotone=monotone)
    assert law.continuity == continuity
    assert np.abs(law.c([0.0, 1.0])).max() <= 1e-9 or (constant, order) != ("J", 3)


@pytest.mark.parametrize(
    ("constant", "order", "B"), [("C", 3, 2.0), ("D", 3, 1.5), ("J", 2, 1.5), ("J", 3, 2.0), ("RMS", 2, 1.5)]
)
def test_without_b_the_law_is_the_best_of_all(constant: str, order: int, B: float) -> None:
    assert limit_law(constant, order=order) == limit_law(constant, B, order=order)


def test_known_laws() -> None:
    parabola = limit_law("J", 1.5, order=2)
    assert parabola.a(K) == pytest.approx(3 * K**2 - 2 * K**3, abs=1e-15)
    assert limit_law("RMS").a(K) == pytest.approx(3 * K**2 - 2 * K**3, abs=1e-15)
    power = limit_law("D")
    assert power.b(K[:201]) == pytest.approx(1.5 * np.sqrt(2 * K[:201]), abs=1e-15)
    assert limit_law("C", 2.0).a(K[:201]) == pytest.approx(2 * K[:201] ** 2, abs=1e-15)
    back = limit_law("D", 2.5)
    assert [type(segment) for segment in back.segments] == [PowerSegment] * 6
    assert [round(one.C.value, 9) for one in (limit_law("J").constants,)] == [8.0]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"constant": "B"}, "constant 'B' is unknown"),
        ({"constant": "C", "B": 1.0}, "B must be a finite number above 1"),
        ({"constant": "C", "order": 1}, "B must be given"),
        ({"constant": "J", "B": 2.0, "order": 1}, "order must be an integer of at least 2"),
        ({"constant": "C", "B": 2.0, "J": 10.0}, "J must be a finite number of at least 32"),
    ],
)
def test_a_law_that_makes_no_sense_is_refused(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        limit_law(**arguments)
