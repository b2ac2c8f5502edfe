"""Problems whose optimum leaves nothing, leaves no freedom, or does not exist: each has a proof or says which it is."""

import numpy as np
import pytest

from optlaws import (
    FUNCTIONALS,
    Bernstein,
    BoundaryConditions,
    BSplines,
    Chebyshev,
    InfeasibleProblem,
    Machine,
    Pieces,
    Powers,
    Problem,
    SolverFailure,
    Window,
    at_least,
    at_most,
    between,
    maximum,
    peak,
    residual_vibration,
    rms,
    synthesize,
    value,
    via,
)
from optlaws.verification import verify
from tests.internals.synthesis import model_of, solve
from tests.synthesis.judge import Judged, broken

PIECES = Pieces(breaks=(0.0, 0.065, 0.2015, 0.4675, 0.5, 0.5325, 0.7985, 0.935, 1.0), degree=5, continuity=3)
HALVES = Pieces(breaks=(0.0, 0.5, 1.0), degree=4, continuity=3)
DAMPED = Machine.from_modes([(49.84, 0.1)], duration=1.0, outputs=["deflection"])
SHAKEN = Machine.from_modes([(48.1, 0.1)], duration=1.0, outputs=["acceleration"])
LIGHT = Machine.from_modes([(20.83, 0.01)], duration=1.0, outputs=["position"])
UNEVEN = BSplines(breaks=(0.0, 0.282, 0.307, 0.463, 1.0), degree=3, continuity=2)
SHORT = Pieces(breaks=(0.0, 0.038, 0.131, 0.169, 0.481, 0.5, 0.519, 0.831, 0.869, 0.962, 1.0), degree=8, continuity=3)
SLOW = Machine.from_modes([(5.95, 0.1)], duration=1.0, stroke=8.78e-10, outputs=["position"])
FAST = Machine.from_modes([(37.2, 0.01)], duration=1.0, stroke=1.0, outputs=["deflection"])

CASES = {
    # a root mean square that is 0 has no direction of its own
    "norm at its apex": (
        Problem(order=1, basis=PIECES, minimise="0.24*C_plus + 0.96*rms_snap", monotone=True, symmetric=False),
        -0.48,
    ),
    "amplitude that vanishes": (
        Problem(order=5, basis=Chebyshev(7), minimise="residual(frequency=27.8)", symmetric=False),
        0.0,
    ),
    "value that vanishes": (
        Problem(order=1, basis=Chebyshev(12), minimise="value(abs(c), at=0.3)", symmetric=False),
        0.0,
    ),
    "one law alone": (Problem(order=3, basis=HALVES, minimise="peak(0.006*(1 + k)*c)", J=at_most(69.0)), None),
    "B at least, beside J": (
        Problem(
            B=at_least(1.59375), order=3, basis=HALVES, minimise="integral(c^2) + J", symmetric=False, inflexion=0.5
        ),
        None,
    ),
    "root that vanishes": (
        Problem(
            order=1,
            basis=Chebyshev(9),
            minimise="rms(norm(2e6*c, 1e6*b))",
            symmetric=False,
            boundary=BoundaryConditions(start=(0.0,), end=(0.0,)),
        ),
        0.0,
    ),
    "integral over short pieces": (
        Problem(
            order=6,
            basis=SHORT,
            minimise="max(1.16e-06*integral(30200*b^2 + 16000*c^2), 0.0708*C_plus_cam(frequency=8.79, damping=0.2))",
        ),
        None,
    ),
    "integral bounded, beside a flat snap": (
        Problem(
            order=5,
            basis=Pieces(
                breaks=(0.0, 0.024, 0.184, 0.208, 0.488, 0.5, 0.512, 0.792, 0.816, 0.976, 1.0), degree=7, continuity=3
            ),
            minimise="snap",
            symmetric=False,
            bounds={"integral(0.0046*b^2 + 0.00504*c^2)": at_most(0.213875)},
        ),
        None,
    ),
    "small amplitude of a fast mode": (
        Problem(order=5, basis=Chebyshev(1), minimise="snap", bounds={FAST.residual(): at_most(1e-8)}),
        None,
    ),
    "breaks on one side": (
        Problem(
            B=2.183117744230822,
            order=4,
            basis=UNEVEN,
            minimise="value(abs(c), at=0.3)",
            monotone=True,
            symmetric=False,
            bounds={"peak(b*c)": at_most(11.8)},
        ),
        None,
    ),
    # an amplitude that vanishes beside a peak that does not
    "cone at its apex": (
        Problem(
            B=at_most(2.655),
            order=4,
            basis=Powers(8),
            minimise=65.0 * DAMPED.residual() + peak("0.05*c - 0.027*b", side="high"),
            bounds={value("c^2 + 1.3*b", at=0.3): at_most(73.4)},
        ),
        None,
    ),
    "cone at its apex, on pieces": (
        Problem(
            B=at_most(3.28),
            order=5,
            basis=Pieces(10, 5, 4),
            minimise=1e5 * LIGHT.residual()
            + maximum(0.22 * residual_vibration(frequency=21.95, damping=0.1), rms("norm(c, b)") / 4.0),
            symmetric=False,
            inflexion=0.5,
        ),
        None,
    ),
    # no contacts show the optimum, or interior points end without one
    "curvature of both sides beside a power": (
        Problem(
            order=2,
            basis=Pieces(breaks=(0.0, 0.073, 0.421, 0.5, 0.579, 0.927, 1.0), degree=4, continuity=2),
            minimise="C_minus",
            monotone=True,
            D=at_most(3.983716857408418),
            bounds={"peak(552*c^2 + 560*c, side=high)": at_most(34848.0)},
        ),
        None,
    ),
    "root mean square beside a power": (
        Problem(
            order=1,
            basis=Pieces(breaks=(0.0, 0.063, 0.339, 0.373, 0.486, 1.0), degree=4, continuity=3),
            minimise="0.81*rms_snap + 0.26*D",
            monotone=True,
            symmetric=False,
            boundary=BoundaryConditions(start=(0.0,), end=(0.4,)),
            bounds={"peak(6.06e-12*(c^2 + 3*b^2))": at_most(4.3632e-12)},
            inflexion=0.237,
        ),
        None,
    ),
    "uniform motion": (
        Problem(
            B=at_most(1.1663),
            order=1,
            basis=BSplines(breaks=(0.0, 0.179, 0.5, 0.821, 1.0), degree=5, continuity=3),
            minimise="max(0.2487*D, max(2.906e-09*rms(361000000*(1 + k)*c), 0.01246*J))",
            bounds={"rms_snap": at_most(278.79)},
        ),
        0.0,
    ),
    "snap that jumps at a break": (
        Problem(
            order=5,
            basis=Pieces(
                breaks=(0.0, 0.042, 0.205, 0.247, 0.479, 0.5, 0.521, 0.753, 0.795, 0.958, 1.0), degree=7, continuity=3
            ),
            minimise="max(0.11264*rms_c, 0.0014478*rms_snap)",
            symmetric=False,
            boundary=BoundaryConditions(start=(0.0, 0.236, 0.0, 0.0, 0.0), end=(1.0, 0.3, 0.0, 0.0, 0.0)),
            bounds={"snap": at_most(685.431173080242)},
        ),
        None,
    ),
    # nothing bounds the value from below, or all laws that have less of it
    "value beside a peak": (
        Problem(order=4, basis=BSplines(4, 5, 3), minimise="0.012*value(c^2 + 1.5*b, at=0.3) + 0.093*C"),
        None,
    ),
    "value beside an integral": (
        Problem(order=4, basis=Chebyshev(9), minimise="value(c^2 + 1.5*b, at=0.3) + 0.02*integral(c^2)"),
        None,
    ),
    "value beside a peak of one side": (
        Problem(
            order=2,
            basis=Bernstein(10),
            minimise="0.003*value(c^2 + 3.3*b, at=0.3) + 0.001*peak(c^2 + 1.4*c, side=high)",
            monotone=True,
            bounds={"peak(c^2 + 3*b^2)": at_most(282.0)},
        ),
        None,
    ),
}


@pytest.mark.sample(5)
@pytest.mark.parametrize("name", CASES)
def test_a_degenerate_optimum_is_proven(name: str) -> None:
    problem, least = CASES[name]
    solution = synthesize(problem)
    assert solution.status.value in ({"optimal"} if problem.convex else {"optimal", "local"})
    assert solution.lower_bound <= solution.objective + 1e-12
    assert broken(problem, solution.law) == []
    if least is not None:
        assert solution.objective == pytest.approx(least, abs=1e-9)
    if problem.convex:
        assert verify(solution.to_dict()).proven


@pytest.mark.parametrize(
    ("band", "limits"),
    [
        (
            (32.72611819232943, 37.76090560653395),
            (2.003278260968781, 8.026247581740208, 6.420998065392166, 128.63045838122724),
        ),
        ((33.48937768726719, 38.64158963915445), (2.05, 8.405, 6.723999999999998, 137.84199999999996)),
    ],
)
def test_the_last_points_of_a_front_of_residuals_over_a_band_are_proven(
    band: tuple[float, float], limits: tuple[float, float, float, float]
) -> None:
    # of results/fastest_pick: tangents alone leave gaps of 1e-8 and 3e-8
    B, positive, negative, J = map(at_most, limits)
    minimise = residual_vibration(frequency=band, damping=0.02)
    bounds = {"C_plus": positive, "C_minus": negative}
    problem = Problem(order=3, basis=Chebyshev(11), minimise=minimise, symmetric=False, B=B, J=J, bounds=bounds)
    solution = synthesize(problem)
    assert solution.status.value == "optimal"
    assert 0.0 <= solution.gap <= 1e-9
    assert broken(problem, solution.law) == []
    assert verify(solution.to_dict()).proven


@pytest.mark.parametrize("at", [0.27, 0.3, 0.33])
def test_a_value_beside_an_integral_is_proven_whatever_rounding_makes_of_its_sizes(at: float) -> None:
    minimise = f"value(c^2 + 1.5*b, at={at}) + 0.02*integral(c^2)"
    solution = synthesize(Problem(order=4, basis=Chebyshev(9), minimise=minimise))
    assert solution.status.value == "optimal"
    assert 0.0 <= solution.gap <= 1e-9


@pytest.mark.long
def test_an_amplitude_of_a_spread_that_nearly_vanishes_is_proven() -> None:
    problem = Problem(order=5, basis=BSplines(10, 3, 2), minimise=SLOW.residual(spread=0.05), symmetric=False)
    solution = synthesize(problem)
    assert solution.status.value == "optimal"
    assert solution.objective < 1e-7 * problem.objective.scale
    assert broken(problem, solution.law) == []


HELD_UP = {
    "alone, at the end of its range": Problem(
        order=2,
        basis=BSplines(breaks=(0.0, 0.072, 0.147, 0.5, 0.853, 0.928, 1.0), degree=3, continuity=2),
        minimise="C_minus",
        bounds={"rms(norm(1.38*c, 1.27*b))": at_most(5.309516405966585), "C_minus": at_least(8.193930447124316)},
    ),
    "two from both sides": Problem(
        B=1.6408161316522039,
        order=2,
        basis=Chebyshev(17),
        minimise="peak(6.67e-08*c + 2.57e-07*b)",
        symmetric=False,
        boundary=BoundaryConditions(start=(0.0, -0.541), end=(-1.0, 0.587)),
        windows=(via("0.013*c + 0.00336*b", 0.04749509124864584, at=0.651),),
        bounds={
            "C_plus": between(7.672721695552059, 7.672721695552059),
            "peak(2.44e-06*(c^2 + 3*b^2))": at_most(0.0001459461563287671),
        },
    ),
}


@pytest.mark.parametrize("name", [next(iter(HELD_UP)), pytest.param("two from both sides", marks=pytest.mark.long)])
def test_constants_are_held_up_where_hardly_a_law_has_them(name: str) -> None:
    solution = synthesize(HELD_UP[name])
    assert solution.status.value in {"optimal", "local"}
    # what rounding may leave: the bound is exact, the objective a rounded one
    assert solution.lower_bound <= solution.objective * (1.0 + 1e-13)
    assert broken(solution.problem, solution.law) == []


@pytest.mark.sample(3)
@pytest.mark.parametrize("unit", [1e-11, 1.0, 1e6])
@pytest.mark.parametrize("basis", [Powers(1), Chebyshev(5), HALVES])
def test_an_objective_without_a_least_value_is_told_apart(unit: float, basis: Powers | Chebyshev | Pieces) -> None:
    ends = BoundaryConditions(start=(0.25, -0.514), end=(0.25, -0.392))
    problem = Problem(
        order=2, basis=basis, minimise=f"value({unit!r}*(c^2 + b), at=0.3)", symmetric=False, boundary=ends
    )
    with pytest.raises(SolverFailure, match="has no least value"):
        synthesize(problem)


def test_a_law_whose_constants_are_great_keeps_its_ends() -> None:
    breaks = (0.0, 0.047, 0.1385, 0.1855, 0.4765, 0.5, 0.5235, 0.8145, 0.8615, 0.953, 1.0)
    problem = Problem(
        order=6,
        basis=Pieces(breaks=breaks, degree=8, continuity=3),
        minimise="0.0151183970856102*rms_j + 0.5*max(1.8255578093306288e-05*peak(4700*c - 2500*b, side=high), "
        "0.0008844765342960289*rms_snap + 1.2723214285714284e-09*rms(43600000*(1 + k)*c))",
        symmetric=True,
        windows=(
            Window("1.32*b - 0.61*a", high=3.097535802690766, start=0.277, stop=0.4),
            Window("336000000*b - 1760000000*a", low=-47926439.34790318, start=0.384, stop=0.508),
            Window(
                "6.24e-11*b - 6.14e-11*a", low=1.355394343371221e-11, high=1.5664652719433e-10, start=0.234, stop=0.463
            ),
        ),
        bounds={"integral(0.0146*b^2 + 0.0113*c^2)": at_most(0.8266488211478923)},
    )
    assert broken(problem, synthesize(problem).law) == []


def test_equations_that_leave_no_freedom_are_proven_to_contradict_a_bound() -> None:
    problem = Problem(
        order=4,
        basis=Pieces(breaks=(0.0, 0.332, 0.487, 1.0), degree=5, continuity=4),
        minimise="rms(norm(0.318*c, 0.529*b))",
        symmetric=False,
        boundary=BoundaryConditions(start=(0.0, -0.663, 0.0, 0.0), end=(-1.0, -0.372, 0.0, 0.0)),
        bounds={"rms_c": at_most(2.508)},
    )
    with pytest.raises(InfeasibleProblem):
        synthesize(problem)


def test_one_law_is_measured_where_no_freedom_is_left() -> None:
    solution = synthesize(CASES["one law alone"][0])
    k = np.linspace(0.0, 1.0, 4001)
    assert solution.objective == pytest.approx(np.abs(0.006 * (1.0 + k) * solution.law.c(k)).max(), rel=1e-4)


def test_an_objective_that_an_interior_point_runs_away_from_is_found() -> None:
    tenths = BSplines(breaks=tuple(k / 10.0 for k in range(11)), degree=4, continuity=3)
    solution = synthesize(Problem(order=5, basis=tenths, minimise="rms(norm(121000*c, 203000*b))"))
    assert solution.status.value == "optimal"


@pytest.mark.long
def test_the_middle_of_a_flat_optimum_is_taken_where_vertices_stick_out() -> None:
    breaks = (0.0, 0.035, 0.1745, 0.2095, 0.4825, 0.5, 0.5175, 0.7905, 0.8255, 0.965, 1.0)
    problem = Problem(
        order=2,
        basis=Pieces(breaks=breaks, degree=5, continuity=3),
        minimise="C",
        monotone=True,
        symmetric=False,
        windows=(
            Window("c", high=-2.965, start=0.803),
            Window("b", high=1.52786288, start=0.4, stop=0.474),
            via("a", 0.4655, at=0.477),
        ),
    )
    solution = synthesize(problem)
    assert solution.status.value == "optimal"
    assert solution.objective == pytest.approx(4.5329, rel=1e-2)


def test_an_amplitude_that_is_next_to_nothing_is_resolved() -> None:
    problem = Problem(
        B=2.2059,
        order=4,
        basis=Chebyshev(12),
        minimise=1.208e-4 * SHAKEN.residual(spread=0.05) + 9.79e-8 * FUNCTIONALS["C_minus"],
        monotone=True,
        symmetric=False,
        bounds={"peak(b*c + 4.85*c)": at_most(52.8)},
    )
    model = model_of(problem)
    optimum = solve(model.program).optimum
    assert optimum is not None
    law = model.law(optimum.x)
    assert broken(problem, law) == []
    claimed = model.unit * model.program.objective_at(optimum.x)
    assert Judged(law).worth(problem.objective) == pytest.approx(claimed, rel=1e-6)
