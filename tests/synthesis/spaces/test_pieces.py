"""Free piecewise laws: near the limits with few pieces, and the same engine, proofs and refusals as with a Z."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.optimize import linprog

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    InputError,
    Pieces,
    PiecewiseLaw,
    Problem,
    Status,
    Window,
    limit,
    limit_law,
    synthesize,
)
from tests.sampling import sampled

LIMIT_C = limit_law("C", 1.859).breaks


def test_eight_pieces_come_within_half_a_per_cent_of_the_limit() -> None:
    problem = Problem(B=1.859, order=3, basis=Pieces.around(LIMIT_C, 0.001, degree=3, continuity=2))
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert len(problem.basis.to_dict()["breaks"]) == 9
    assert limit("C", 1.859) < solution.objective <= 1.005 * limit("C", 1.859)
    assert solution.z is None


def test_the_excess_over_the_limit_falls_with_the_width() -> None:
    widths = np.array([0.008, 0.004, 0.002, 0.001])
    excess = [
        synthesize(Problem(B=1.859, order=3, basis=Pieces.around(LIMIT_C, w, 3, 2))).objective / limit("C", 1.859) - 1.0
        for w in widths
    ]
    slope = np.polyfit(np.log(widths), np.log(excess), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.05)


def test_jerk_in_four_equal_steps_is_found_exactly() -> None:
    solution = synthesize(Problem(order=3, minimise="J", basis=Pieces(8, degree=3, continuity=2)))
    assert solution.objective == pytest.approx(32.0, rel=1e-12)
    assert solution.law.constants.C.value == pytest.approx(8.0, rel=1e-9)
    assert solution.lower_bound == pytest.approx(32.0, rel=1e-9)


@pytest.mark.parametrize(("degree", "continuity"), [(2, 1), (3, 2), (4, 2), (5, 4), (6, 3)])
@pytest.mark.parametrize("symmetric", [True, False])
def test_laws_keep_their_end_conditions_and_continuity(degree: int, continuity: int, *, symmetric: bool) -> None:
    order = min(3, continuity + 1)
    basis = Pieces(6, degree=degree, continuity=continuity)
    law = synthesize(Problem(order=order, minimise="rms_c", basis=basis, symmetric=symmetric)).law
    assert isinstance(law, PiecewiseLaw)
    assert law.continuity >= continuity
    start, end = law.boundary_values(order)
    assert start == pytest.approx([0.0] * order, abs=1e-10)
    assert end == pytest.approx([1.0, *[0.0] * (order - 1)], abs=1e-10)


def test_end_velocities_are_kept() -> None:
    ends = BoundaryConditions((0, 0, 0), (1, 0.5, 0))
    law = synthesize(Problem(boundary=ends, symmetric=False, basis=Pieces(10, degree=3, continuity=2))).law
    start, end = law.boundary_values(3)
    assert start == pytest.approx((0, 0, 0), abs=1e-10)
    assert end == pytest.approx((1, 0.5, 0), abs=1e-9)


@pytest.mark.sample(3)
@pytest.mark.parametrize("B", [1.4, 1.7, 2.0])
def test_piecewise_linear_accelerations_agree_with_a_linear_program(B: float) -> None:
    count = 20
    objective = synthesize(Problem(B=B, order=3, basis=Pieces(count, degree=3, continuity=2))).objective
    half = count // 2
    h = 0.5 / half
    # c linear between its values at the breaks of the first half; b and a by the trapezoidal rule, exact here
    steps = np.zeros((half + 1, half + 1))
    for i in range(1, half + 1):
        steps[i] = steps[i - 1]
        steps[i, i - 1] += h / 2
        steps[i, i] += h / 2
    stroke = np.zeros(half + 1)
    for i in range(half):
        stroke += h * steps[i]
        stroke[i] += h * h / 3
        stroke[i + 1] += h * h / 6
    fine = np.linspace(0.0, 0.5, 40 * half + 1)
    piece = np.minimum((fine / h).astype(int), half - 1)
    s = fine - piece * h
    velocity = steps[piece].copy()
    velocity[np.arange(len(fine)), piece] += s - s**2 / (2 * h)
    velocity[np.arange(len(fine)), piece + 1] += s**2 / (2 * h)
    rows = np.vstack([np.eye(half + 1), -np.eye(half + 1)])
    upper = np.hstack([rows, -np.ones((len(rows), 1))])
    below = np.hstack([velocity, np.zeros((len(fine), 1))])
    ends = np.zeros((4, half + 2))
    ends[0, 0] = ends[1, half] = 1.0
    ends[2, : half + 1], ends[3, : half + 1] = steps[half], stroke
    answer = linprog(
        np.append(np.zeros(half + 1), 1.0),
        A_ub=np.vstack([upper, below]),
        b_ub=np.concatenate([np.zeros(len(rows)), np.full(len(fine), B)]),
        A_eq=ends,
        b_eq=[0.0, 0.0, B, 0.5],
        bounds=(None, None),
    )
    assert answer.success
    least = float(np.asarray(answer.fun))
    assert objective == pytest.approx(least, rel=1e-6)
    assert objective >= least * (1 - 1e-9)


@pytest.mark.long
def test_power_comes_near_its_limit() -> None:
    basis = Pieces(20, degree=5, continuity=3)
    solution = synthesize(Problem(order=3, minimise="D", B=1.6, basis=basis, monotone=True))
    assert limit("D", 1.6, monotone=True) <= solution.objective <= 1.04 * limit("D", 1.6, monotone=True)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (((0.0, 0.5, 0.4, 1.0),), "increase"),
        (((0.1, 0.5, 1.0),), "from 0 to 1"),
        ((4, 1), "at least 2"),
        ((4, 3, 3), "below the degree"),
        ((0,), "number of pieces"),
    ],
)
def test_pieces_that_make_no_sense_are_refused(arguments: tuple[object, ...], text: str) -> None:
    with pytest.raises(InputError, match=text):
        Pieces(*arguments)  # type: ignore[arg-type] # that is the point


def test_symmetric_laws_need_symmetric_breaks() -> None:
    with pytest.raises(InputError, match="symmetric about 1/2"):
        Problem(B=1.7, order=3, basis=Pieces((0.0, 0.3, 0.5, 1.0)))
    assert Problem(B=1.7, order=3, symmetric=False, basis=Pieces((0.0, 0.3, 0.5, 1.0))).basis.name == "pieces"


def test_pieces_of_order_1_are_free_to_start_moving() -> None:
    # Z of degree 9 makes a law of degree 11, which is one piece of that degree
    expected = Problem(B=1.75, order=1, basis=Chebyshev(9), symmetric=False)
    polynomial = synthesize(expected)
    whole = synthesize(replace(expected, basis=Pieces(1, 11, 10)))
    assert whole.status is Status.OPTIMAL
    assert whole.objective == pytest.approx(polynomial.objective, rel=1e-8)
    assert synthesize(replace(expected, basis=Pieces(8, 5, 3))).objective < polynomial.objective


@pytest.mark.parametrize(("B", "count"), sampled([(1.859, 28), (1.859, 32), (1.859, 64), (2.1, 28), (2.1, 30)], 5))
def test_many_pieces_are_proven(B: float, count: int) -> None:
    coarse, fine = (synthesize(Problem(B=B, order=3, basis=Pieces(n))) for n in (count, 2 * count))
    assert (coarse.status, fine.status) == ("optimal", "optimal")
    # twice as many pieces hold every law of these
    assert fine.lower_bound < coarse.objective


@pytest.mark.long
@pytest.mark.sample(2)
@pytest.mark.parametrize(("order", "minimise"), sampled(product([2, 6], ["J", "snap", "max(C/4, J/32)"]), 4))
def test_sixty_pieces_are_proven_for_every_linear_objective(order: int, minimise: str) -> None:
    solution = synthesize(Problem(B=1.8, order=order, minimise=minimise, basis=Pieces(60, 7, 5)))
    assert solution.status == "optimal"


@pytest.mark.parametrize(("B", "order"), sampled([(1.8, 3), (None, 3), (None, 5), (1.8, 5)], 4))
def test_an_rms_beside_a_peak_is_proven_with_many_pieces(B: float | None, order: int) -> None:
    problem = Problem(B=B, order=order, minimise="0.3*rms_c/3.5 + 0.7*C/4", basis=Pieces(40, 6, 4))
    solution = synthesize(problem)
    assert solution.status == "optimal"
    constants = solution.law.constants
    assert solution.objective == pytest.approx(0.3 * constants.rms_c / 3.5 + 0.7 * constants.C.value / 4.0, rel=1e-12)


def test_a_window_between_the_nodes_is_kept() -> None:
    window = Window("b", low=0.6, start=0.282, stop=0.312)
    problem = Problem(order=3, basis=Pieces(2, 7, 3), minimise="max(rms_c/8, rms_j/40)", windows=(window,))
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.law.b([0.282, 0.297, 0.312]).min() >= 0.6 - 1e-9


def test_pieces_of_order_1_may_move_uniformly_whatever_is_minimised() -> None:
    solution = synthesize(Problem(order=1, basis=Pieces(10, 7, 5), minimise="D"))
    assert solution.status == "optimal"
    assert solution.objective < 1e-12
