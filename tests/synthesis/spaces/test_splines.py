"""Pieces and Z in B-splines: splines of scipy, laws found again by HiGHS, and everything else on them."""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from optlaws import (
    Basis,
    Bernstein,
    BoundaryConditions,
    BSplines,
    Chebyshev,
    InputError,
    Pieces,
    PiecewiseLaw,
    Problem,
    Status,
    Window,
    at_most,
    between,
    law_from_z,
    limit,
    limit_law,
    synthesize,
    via,
)
from optlaws.synthesis import PiecewiseBasis
from tests.internals.synthesis import space_of
from tests.sampling import sampled
from tests.synthesis.judge import Judged

K = np.linspace(0.0, 1.0, 301)
UNEVEN = (0.0, 0.2, 0.5, 0.8, 1.0)
bases = st.builds(
    lambda inner, degree, lower: BSplines((0.0, *sorted(inner), 1.0), degree, max(degree - lower, 1)),
    st.sets(st.integers(1, 15).map(lambda n: n / 16), max_size=4),
    st.integers(2, 5),
    st.integers(1, 3),
)


@given(bases, st.integers(0, 1000))
def test_z_is_the_spline_of_scipy(basis: BSplines, seed: int) -> None:
    z = np.random.default_rng(seed).normal(size=basis.size)
    expected = BSpline(basis.knots, z, basis.degree)
    for (low, high), powers in zip(pairwise(basis.breaks), basis.pieces(z.tolist()), strict=True):
        s = np.linspace(0.05, 0.95, 7)
        assert np.polyval(np.array(powers, dtype=float)[::-1], s) == pytest.approx(
            expected(low + (high - low) * s), abs=1e-11
        )
    assert basis.coefficients(basis.series(z.tolist())) == pytest.approx(z, abs=1e-11)


def test_splines_are_positive_and_add_up_to_1() -> None:
    basis = BSplines(UNEVEN, 4, 2)
    for powers in basis.pieces([1] * basis.size):
        assert powers == [Fraction(1), 0, 0, 0, 0]
    for one in np.eye(basis.size).tolist():
        assert all(
            float(sum(p * Fraction(i, 8) ** n for n, p in enumerate(powers))) >= 0.0
            for powers in basis.pieces(one)
            for i in range(9)
        )


def test_one_piece_is_bernstein() -> None:
    z = [1.5, -2.0, 0.25, 3.0]
    law, same = (law_from_z(BoundaryConditions.rest(3), z, basis) for basis in (BSplines(1, 3), Bernstein(3)))
    assert isinstance(law, PiecewiseLaw)
    assert law.c(K) == pytest.approx(same.c(K), abs=1e-12)
    found, other = (synthesize(Problem(B=1.9, order=3, basis=basis)) for basis in (BSplines(1, 5), Bernstein(5)))
    assert found.objective == pytest.approx(other.objective, rel=1e-11)
    assert found.z == pytest.approx(other.z, rel=1e-8, abs=1e-8)


PROBLEMS = [
    Problem(B=1.859, order=3, basis=BSplines(6, 3)),
    Problem(B=1.859, order=3, basis=BSplines(6, 3), symmetric=False),
    Problem(order=4, basis=BSplines(5, 4, 2), minimise="J"),
    Problem(B=1.7, order=2, basis=BSplines(UNEVEN, 3, 1)),
    Problem(B=between(1.5, 1.8), order=3, basis=BSplines(4, 5, 3), minimise="rms_c", J=at_most(60)),
    Problem(B=2.5, order=3, basis=BSplines(7, 3), monotone=True),
    Problem(B=1.8, order=3, basis=BSplines(8, 3), windows=(Window("b", high=1.2, start=0.2, stop=0.3),)),
    Problem(order=3, basis=BSplines((0.0, 0.3, 0.6, 1.0), 4, 3), symmetric=False, windows=(via("a", 0.3, at=0.4),)),
    Problem(B=1.8, order=3, basis=BSplines(6, 3), symmetric=False, inflexion=0.4),
    Problem(boundary=BoundaryConditions((0, 0, 0), (1, 0.5, 0)), symmetric=False, basis=BSplines(6, 3)),
    Problem(B=1.8, order=1, basis=BSplines(4, 3)),
    Problem(order=3, basis=BSplines(6, 4), minimise="max(C/4, J/32)", bounds={"snap": at_most(5000)}),
]


@pytest.mark.sample(6)
@pytest.mark.parametrize("problem", PROBLEMS, ids=range(len(PROBLEMS)))
def test_laws_are_proven_and_their_z_makes_them(problem: Problem) -> None:
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.lower_bound <= solution.objective * (1 + 1e-11)
    basis = problem.basis
    assert isinstance(basis, BSplines)
    assert solution.z is not None
    law = law_from_z(problem.conditions, solution.z, basis)
    assert law.c(K) == pytest.approx(solution.law.c(K), abs=1e-9 * solution.constants.C.value)
    assert law.a(K) == pytest.approx(solution.law.a(K), abs=1e-12)
    if problem.symmetric:
        assert solution.law.a(K) + solution.law.a(1.0 - K) == pytest.approx(1.0, abs=1e-12)
    if problem.monotone:
        assert solution.law.extrema(1)[0].value >= -1e-10
    for window in problem.windows:
        values = solution.law(np.linspace(window.start, window.stop, 1001), window.nu)
        assert window.low - 1e-9 <= values.min() <= values.max() <= window.high + 1e-9


def test_peaks_are_seen_from_both_sides_of_a_break() -> None:
    # the jerk of these laws jumps, and its peaks stand beside the breaks
    solution = synthesize(Problem(order=3, minimise="J", basis=BSplines(8, 3)))
    assert solution.status == "optimal"
    assert len(solution.law.jumps(3)) > 0
    rough = synthesize(Problem(B=1.7, order=2, basis=BSplines(8, 3, 1)))
    law = rough.law
    assert isinstance(law, PiecewiseLaw)
    assert law.continuity == 1
    assert rough.objective == law.peak(2).value


def test_more_pieces_come_nearer_to_the_limit() -> None:
    excess = [
        synthesize(Problem(B=1.859, order=3, basis=BSplines(n, 3))).objective / limit("C", 1.859) - 1.0
        for n in (4, 8, 16, 32)
    ]
    rates = -np.diff(np.log(excess)) / np.log(2.0)
    assert (rates > 0.45).all()
    assert excess[-1] < 0.04


@pytest.mark.parametrize("minimise", ["J", "rms_j", "snap"])
def test_impulses_are_refused(minimise: str) -> None:
    with pytest.raises(InputError, match="continuity of at least"):
        synthesize(Problem(order=2, minimise=minimise, basis=BSplines(4, 3, 1)))


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ((4, 1), "at least 2"),
        ((4, 3, 3), "below the degree"),
        ((4, 3, 0), "at least 1"),
        ((0,), "number of pieces"),
        ((True,), "number of pieces"),
        (((0.0, 0.5, 0.5, 1.0),), "increase"),
        (((0.0, 0.5, 0.4, 1.0),), "increase"),
        (((0.1, 0.5, 1.0),), "from 0 to 1"),
        (("0 1",), "breaks"),
    ],
)
@pytest.mark.parametrize("kind", [BSplines, Pieces])
def test_breaks_that_make_no_sense_are_refused(kind: type, arguments: tuple[object, ...], text: str) -> None:
    with pytest.raises(InputError, match=text):
        kind(*arguments)


def test_symmetric_laws_need_symmetric_breaks_but_no_break_in_the_middle() -> None:
    with pytest.raises(InputError, match="symmetric about 1/2"):
        Problem(B=1.7, order=3, basis=BSplines((0.0, 0.3, 1.0)))
    assert len(synthesize(Problem(B=1.7, order=3, basis=BSplines(5))).law.breaks) == 6
    with pytest.raises(InputError, match="takes 7 coefficients"):
        law_from_z(BoundaryConditions.rest(3), [1.0], BSplines(4))


def test_a_basis_of_ones_own_is_one_class() -> None:
    class Hinges(PiecewiseBasis):
        """1, k, ..., k^n and (k - break)^n beyond each break."""

        name = "hinges"

        @property
        def size(self) -> int:
            return self.degree + len(self.breaks) - 1

        def pieces(self, z: object) -> list[list[float]]:
            z = list(map(float, z))  # type: ignore[call-overload]
            found = []
            for low, high in pairwise(self.breaks):
                total = np.polynomial.Polynomial(z[: self.degree + 1])
                for place, weight in zip(self.breaks[1:-1], z[self.degree + 1 :], strict=True):
                    if place <= low:
                        total += weight * np.polynomial.Polynomial([-place, 1.0]) ** self.degree
                local = total(np.polynomial.Polynomial([low, high - low]))
                found.append(local.coef.tolist())
            return found

    try:
        for symmetric in (True, False):
            problem = Problem(B=1.8, order=3, basis=Hinges(4, 3), symmetric=symmetric)
            solution, other = (synthesize(one) for one in (problem, Problem(B=1.8, order=3, basis=BSplines(4, 3))))
            assert solution.objective == pytest.approx(other.objective, rel=1e-9)
            assert solution.z is not None
            assert Problem.from_dict(problem.to_dict()) == problem
    finally:
        del Basis.kinds["hinges"]


@pytest.mark.sample(4)
@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("order", [1, 4, 5, 6])
def test_a_law_of_great_coordinates_ends_where_its_accelerations_lead(order: int, *, symmetric: bool) -> None:
    space = space_of(BSplines(10, 5, 3), BoundaryConditions.rest(order), symmetric=symmetric)
    law = space.law(3e3 * np.random.default_rng(order).normal(size=space.terms))
    judged = Judged(law)
    assert abs(judged.derivatives[0](1.0) - 1.0) < 5e-14 * judged.peak(1)
    if order > 2:
        # what leads to the right velocity leaves the rest at the ends
        assert np.abs(law.c([0.0, 1.0])).max() < 5e-15 * judged.peak(2)


def test_velocities_at_the_ends_are_free_where_positions_alone_are_asked() -> None:
    breaks = (0, 0.203, 0.257, 0.5, 0.743, 0.797, 1)
    through = (via("c", -0.8162050508415326, at=0.329), via("j", -45.85483286747821, at=0.202))
    problem = Problem(
        order=1,
        basis=BSplines(breaks, 5),
        minimise="snap",
        symmetric=False,
        boundary=BoundaryConditions(start=(0.25,), end=(0.25,)),
        windows=through,
    )
    solution = synthesize(problem)
    # a cubic law keeps all of it without any snap
    assert solution.status == "optimal"
    assert solution.objective < 1e-8
    assert solution.law.a([0.0, 1.0]) == pytest.approx([0.25, 0.25], abs=1e-12)
    assert [solution.law.c(0.329), solution.law.j(0.202)] == pytest.approx([one.low for one in through], rel=1e-9)


# --- free pieces ---


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


@pytest.mark.long
def test_power_comes_near_its_limit() -> None:
    basis = Pieces(20, degree=5, continuity=3)
    solution = synthesize(Problem(order=3, minimise="D", B=1.6, basis=basis, monotone=True))
    assert limit("D", 1.6, monotone=True) <= solution.objective <= 1.04 * limit("D", 1.6, monotone=True)


def test_pieces_of_order_1_are_free_to_start_moving() -> None:
    # Z of degree 9 makes a law of degree 11, which is one piece of that degree
    expected = Problem(B=1.75, order=1, basis=Chebyshev(9), symmetric=False)
    polynomial = synthesize(expected)
    whole = synthesize(replace(expected, basis=Pieces(1, 11, 10)))
    assert whole.status is Status.OPTIMAL
    assert whole.objective == pytest.approx(polynomial.objective, rel=1e-8)
    assert synthesize(replace(expected, basis=Pieces(8, 5, 3))).objective < polynomial.objective


@pytest.mark.parametrize(("B", "count"), sampled([(2.1, 20), (1.859, 32), (1.859, 64), (2.1, 30)], 4))
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
