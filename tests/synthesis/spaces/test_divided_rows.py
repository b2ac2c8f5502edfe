"""Rows divided by what they vanish like: equal to their definition, and sharper than the plain ones."""

import numpy as np
import pytest
from scipy.optimize import linprog

from optlaws import BoundaryConditions, Chebyshev, Pieces, Problem, synthesize
from tests.internals.synthesis import PieceSpace, piece_space, polynomial_space
from tests.internals.verification import prove
from tests.synthesis.judge import judge


@pytest.mark.parametrize("order", [1, 2, 4])
@pytest.mark.parametrize("degree", [2, 3, 8, 15])
def test_the_chord_of_unsymmetric_laws_is_what_it_says(order: int, degree: int) -> None:
    space = polynomial_space(BoundaryConditions.rest(order), degree, symmetric=False)
    bend = space.row(2, 0.5)
    x = np.random.default_rng(degree).normal(size=space.terms)
    # the nearest law with c(1/2) = 0
    x -= bend[:-1] * (bend @ np.append(x, 1.0)) / (bend[:-1] @ bend[:-1])
    law = space.law(x)
    k = np.array([0.0, 0.1, 0.3, 0.45, 0.6, 0.9, 1.0])
    expected = -(law.b(0.5) - law.b(k)) / (1 - 2 * k) ** 2
    family = space.below(np.zeros(space.terms))
    assert family.value(x, 1 - 2 * k) == pytest.approx(expected, rel=1e-9, abs=1e-9)
    # at the middle b'' / 8 is left
    assert family.value(x, np.zeros(1))[0] == pytest.approx(law.j(0.5) / 8, rel=1e-9)


@pytest.mark.sample(4)
@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("symmetric", [True, False], ids=["symmetric", "unsymmetric"])
def test_the_forward_rows_of_pieces_are_what_they_say(order: int, symmetric: bool) -> None:  # noqa: FBT001
    solution = synthesize(
        Problem(B=2.1, order=order, basis=Pieces(6, 6, 4), minimise="J", monotone=True, symmetric=symmetric)
    )
    judge(solution)
    space = piece_space(BoundaryConditions.rest(order), tuple(i / 6 for i in range(7)), 6, 4, symmetric=symmetric)
    assert solution.active_set is not None
    x = solution.active_set.x[: space.terms]
    k = np.array([1e-3, 0.05, 0.15, 0.2, 0.4, 0.5] if symmetric else [1e-3, 0.1, 0.2, 0.5, 0.8, 0.9, 0.999])
    share = np.minimum(1.0, 6 * np.minimum(k, 1 - k)) ** (order - 1)
    value = space.forward(np.zeros(space.terms)).value(x, 1 - 2 * k)
    assert value == pytest.approx(-solution.law.b(k) / share, rel=1e-8, abs=1e-9)
    assert isinstance(space, PieceSpace)


@pytest.mark.sample(4)
@pytest.mark.parametrize("minimise", ["C", "J"])
@pytest.mark.parametrize("B", [2.1548, 2.6])
def test_pieces_that_never_move_back_agree_with_highs(minimise: str, B: float) -> None:
    # rows on many points, each by itself divided by what it vanishes like
    problem = Problem(B=B, order=3, basis=Pieces(6, 6, 4), minimise=minimise, monotone=True)
    solution = synthesize(problem)
    judge(solution)
    value = prove(solution.certificate).value
    assert value is not None
    assert float(value) == pytest.approx(solution.objective, rel=1e-9)
    assert solution.objective == pytest.approx(_by_highs(B, 2 if minimise == "C" else 3), rel=3e-5)


def _by_highs(B: float, nu: int, count: int = 1201) -> float:
    space = piece_space(BoundaryConditions.rest(3), tuple(i / 6 for i in range(7)), 6, 4, symmetric=True)
    k = np.linspace(0.0, 0.5, count)
    peak, b = (np.vstack([space.row(order, one) for one in k.tolist()]) for order in (nu, 1))
    ones, nothing = np.ones((count, 1)), np.zeros((count - 1, 1))
    rise, fall = b[1:] / k[1:, None] ** 2, b[:-1] / (1 - 2 * k[:-1, None]) ** 2
    rows = np.vstack(
        [
            np.hstack([peak[:, :-1], -ones]),
            np.hstack([-peak[:, :-1], -ones]),
            np.hstack([fall[:, :-1], nothing]),
            np.hstack([-rise[:, :-1], nothing]),
        ]
    )
    right = np.concatenate([-peak[:, -1], peak[:, -1], B / (1 - 2 * k[:-1]) ** 2 - fall[:, -1], rise[:, -1]])
    # what is left of them at k = 0 and k = 1/2
    ends = np.vstack([-space.row(3, 0.0), space.row(3, 0.5)])
    rows = np.vstack([rows, np.hstack([ends[:, :-1], np.zeros((2, 1))])])
    right = np.concatenate([right, -ends[:, -1]])
    middle = space.row(1, 0.5)
    equations = [(middle[:-1], B - middle[-1]), *((equation.row, equation.right) for equation in space.equations())]
    optimum = linprog(
        np.append(np.zeros(space.terms), 1.0),
        A_ub=rows,
        b_ub=right,
        A_eq=np.array([np.append(row, 0.0) for row, _ in equations]),
        b_eq=np.array([value for _, value in equations]),
        bounds=(None, None),
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    assert optimum.fun is not None
    return float(optimum.fun)


def test_the_proof_of_a_one_sided_peak_holds_in_exact_arithmetic() -> None:
    for B in (1.7, 2.1, 2.5):
        solution = synthesize(Problem(B=B, order=3, basis=Chebyshev(9), minimise="C_plus", symmetric=False))
        proof = prove(solution.certificate)
        assert proof.unknown == 0
        assert proof.value is not None
        assert float(proof.value) == pytest.approx(solution.objective, rel=1e-10)


@pytest.mark.sample(2)
@pytest.mark.parametrize("breaks", [(0.0, 0.3, 0.55, 1.0), (0.0, 0.3, 0.5, 1.0)], ids=["within a piece", "at a break"])
@pytest.mark.parametrize("continuity", [1, 2])
def test_a_peak_within_a_piece_or_at_a_break_is_where_highs_has_it(breaks: tuple[float, ...], continuity: int) -> None:
    problem = Problem(B=1.9, order=3, basis=Pieces(breaks, 5, continuity), symmetric=False)
    solution = synthesize(problem)
    judge(solution)
    value = prove(solution.certificate).value
    assert value is not None
    assert float(value) == pytest.approx(solution.objective, rel=1e-9)
    space = piece_space(BoundaryConditions.rest(3), breaks, 5, continuity, symmetric=False)
    # no place is a break, where rows of both sides count
    k = (np.arange(4000) + 0.5) / 4000
    b, c = (np.vstack([space.row(nu, place) for place in k.tolist()]) for nu in (1, 2))
    ones, nothing = np.ones((len(k), 1)), np.zeros((len(k), 1))
    rows = np.vstack([np.hstack([sign * c[:, :-1], -ones]) for sign in (1.0, -1.0)] + [np.hstack([b[:, :-1], nothing])])
    right = np.concatenate([-c[:, -1], c[:, -1], 1.9 - b[:, -1]])
    equal = [(equation.row, equation.right) for equation in space.equations()]
    equal += [(row[:-1], value - row[-1]) for row, value in ((space.row(1, 0.5), 1.9), (space.row(2, 0.5), 0.0))]
    found = linprog(
        np.append(np.zeros(space.terms), 1.0), rows, right, np.array([[*row, 0.0] for row, _ in equal]),
        [value for _, value in equal], bounds=(None, None),
    )  # fmt: skip
    assert solution.objective == pytest.approx(found.fun, rel=2e-3)
