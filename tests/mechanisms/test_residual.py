"""Laws whose residual vibration is small over a whole interval of frequencies."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    BSplines,
    Certificate,
    Chebyshev,
    Follower,
    InfeasibleProblem,
    InputError,
    MotionLaw,
    Pieces,
    Problem,
    at_most,
    catalogue,
    polydyne,
    residual_phasor,
    residual_vibration,
    savin,
    synthesize,
)
from optlaws.verification import verify
from tests.mechanisms.cam_programs import integrated, least_acceleration, residuals
from tests.sampling import examples

NU = np.linspace(18.0, 22.0, 2001)
LAWS = [savin("III", 7.2), savin("IV", 11.0), catalogue["modified sine"].law, catalogue["cycloidal"].law]


@pytest.mark.sample(2)
@pytest.mark.parametrize("law", LAWS, ids=["III", "IV", "modified sine", "cycloidal"])
@pytest.mark.parametrize("damping", [0.0, 0.05, 0.7])
def test_the_greatest_residual_is_that_of_a_fine_grid_and_of_the_response(law: MotionLaw, damping: float) -> None:
    constant = residual_vibration(frequency=(18, 22), damping=damping)
    peak = constant.peak(law)
    grid = residuals(law.b, NU, damping)
    assert grid.max() <= peak.value * (1 + 1e-10)
    assert grid.max() == pytest.approx(peak.value, rel=1e-6)
    assert Follower(peak.k, damping).response(law).residual_acceleration == pytest.approx(peak.value, rel=1e-9)


@given(st.floats(2.0, 60.0), st.floats(0.0, 40.0), st.floats(0.0, 0.9))
@examples(25)
def test_the_greatest_residual_of_any_interval(low: float, length: float, damping: float) -> None:
    law = savin("III", 7.2)
    vibration = residual_vibration(frequency=(low, low + length), damping=damping).value(law)
    grid = residuals(law.b, np.linspace(low, low + length, 1001), damping)
    assert grid.max() <= vibration * (1 + 1e-9) + 1e-12
    assert grid.max() >= vibration * (1 - 1e-2 - length * 1e-3)


@given(st.floats(2.0, 60.0), st.floats(0.0, 40.0), st.floats(0.0, 0.9))
@examples(25)
def test_the_residual_displacement_is_that_of_responses(low: float, length: float, damping: float) -> None:
    law = savin("III", 7.2)
    peak = residual_vibration(frequency=(low, low + length), damping=damping, of="displacement").peak(law)
    assert low <= peak.k <= low + length
    displacement = Follower(peak.k, damping).response(law).residual_displacement
    assert peak.value == pytest.approx(displacement, rel=1e-9, abs=1e-12)
    nu = np.linspace(low, low + length, 301)
    assert np.abs(residual_phasor(law, nu, damping)).max() <= peak.value * (1 + 1e-9) + 1e-12


def test_a_law_of_little_residual_displacement_is_proven() -> None:
    sway = residual_vibration(frequency=(6, 7), of="displacement")
    solution = synthesize(Problem(order=3, basis=Chebyshev(11), bounds={sway: at_most(0.002)}))
    assert solution.status.value == "optimal"
    assert verify(solution.to_dict()).proven
    assert sway.value(solution.law) == pytest.approx(0.002, rel=1e-7)
    assert residual_vibration(frequency=6.0).value(solution.law) <= 0.002 * 36 * (1 + 1e-9)


@pytest.mark.parametrize("dampings", [(0.0, 0.0), (0.05, 0.05), (0.05, 0.0), (0.02, 0.08)])
def test_of_a_mass_law_it_is_the_residual_of_its_cam(dampings: tuple[float, float]) -> None:
    damping, made = dampings
    law = savin("IV", 11.0)
    vibration = residual_vibration(frequency=(18, 22), damping=damping, design=20, design_damping=made).value(law)
    assert vibration == pytest.approx(
        residual_vibration(frequency=(18, 22), damping=damping).value(polydyne(law, 20, made)), rel=1e-9
    )


CASES = [
    Problem(order=3, basis=Chebyshev(11), bounds={residual_vibration(frequency=(18, 22)): at_most(0.1)}),
    Problem(order=3, basis=Chebyshev(11), bounds={residual_vibration(frequency=(18, 22)): at_most(0.01)}, B=2.1),
    Problem(
        order=3,
        basis=Chebyshev(11),
        bounds={residual_vibration(frequency=(18, 22), damping=0.05): at_most(0.01)},
        symmetric=False,
    ),
    Problem(order=3, basis=BSplines(8, 4), bounds={residual_vibration(frequency=(18, 22)): at_most(0.05)}),
    Problem(
        order=3,
        basis=Pieces(12, degree=5, continuity=3),
        bounds={residual_vibration(frequency=(18, 22), damping=0.02): at_most(0.1)},
    ),
    Problem(order=3, basis=Chebyshev(11), minimise="J", bounds={residual_vibration(frequency=(18, 22)): at_most(0.1)}),
]


@pytest.mark.sample(2)
@pytest.mark.parametrize("problem", CASES, ids=range(len(CASES)))
def test_the_residual_of_a_robust_law_is_below_the_bound_everywhere(problem: Problem) -> None:
    ((constant, asked),) = problem.bounds.items()
    damping = float(getattr(constant, "damping", np.nan))
    solution = synthesize(problem)
    assert solution.status.value == "optimal"
    assert residuals(solution.law.b, NU, damping).max() <= asked.high * (1 + 1e-8)
    for nu in (18.0, 19.3, 22.0):
        assert integrated(solution.law.a, nu, damping).residual <= asked.high * (1 + 1e-6)


@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_a_robust_polydyne_law_has_no_residual_at_its_design_and_little_around_it(damping: float) -> None:
    bound = residual_vibration(frequency=(18, 22), damping=damping, design=20)
    asked = Problem(
        order=4,
        basis=Chebyshev(11),
        minimise=f"C_cam(frequency=20, damping={damping})",
        bounds={bound: at_most(0.1)},
        symmetric=damping == 0.0,
    )
    solution = synthesize(asked)
    cam = polydyne(solution.law, 20, damping)
    assert solution.status.value == "optimal"
    grid = residuals(cam.b, NU, damping)
    assert grid.max() <= 0.1 * (1 + 1e-8)
    assert grid[1000] < 1e-8
    # Savin's family III has ten times the residual, and its cam accelerates more
    known = polydyne(savin("III", 7.2), 20, damping)
    assert residuals(known.b, NU, damping).max() > 10 * grid.max()
    assert solution.objective < known.constants.C.value


def test_a_linear_program_over_all_laws_brackets_the_optimum() -> None:
    asked = Problem(
        order=3,
        basis=Chebyshev(9),
        bounds={residual_vibration(frequency=(18, 22), damping=0.05): at_most(0.05)},
        symmetric=False,
    )
    solution = synthesize(asked)
    assert solution.status.value == "optimal"
    frequencies = np.linspace(18.0, 22.0, 41)
    # a polygon outside the circle, and one inside
    low = least_acceleration(3, 9, frequencies, 0.05, 0.05)
    high = least_acceleration(3, 9, frequencies, 0.05, 0.05 * np.cos(np.pi / 64))
    assert low * (1 - 1e-5) <= solution.objective <= high * (1 + 1e-4)
    assert high - low < 0.01


def test_the_least_residual_that_an_acceleration_allows() -> None:
    wide = residual_vibration(frequency=(18, 22), damping=0.05)
    asked = Problem(order=3, C=at_most(6.0), minimise=wide, symmetric=False)
    solution = synthesize(asked)
    assert solution.status.value == "optimal"
    assert solution.constants.C.value == pytest.approx(6.0, rel=1e-8)
    assert residuals(solution.law.b, NU, 0.05).max() == pytest.approx(solution.objective, rel=1e-6)
    # the other way round the same law is found
    back = synthesize(Problem(order=3, bounds={wide: at_most(solution.objective)}, symmetric=False))
    assert back.objective == pytest.approx(6.0, rel=1e-6)


def test_less_residual_costs_acceleration_and_a_higher_degree_helps() -> None:
    def least(degree: int, most: float) -> float:
        bounds = {residual_vibration(frequency=(18, 22)): at_most(most)}
        return synthesize(Problem(order=3, basis=Chebyshev(degree), bounds=bounds)).objective

    by_most = [least(9, most) for most in (1.0, 0.3, 0.1, 0.03)]
    assert by_most == sorted(by_most)
    by_degree = [least(degree, 0.1) for degree in (7, 9, 11, 13, 15)]
    assert by_degree == sorted(by_degree, reverse=True)


def test_a_single_frequency_is_an_interval_too() -> None:
    solution = synthesize(Problem(order=3, bounds={"residual(frequency=20)": at_most(0.01)}))
    assert solution.status.value == "optimal"
    assert residuals(solution.law.b, np.array([20.0]), 0.0)[0] <= 0.01 * (1 + 1e-8)


def test_a_residual_out_of_reach_is_refused_with_proof() -> None:
    for asked in (
        Problem(
            order=3, B=1.859375, basis=Chebyshev(9), bounds={residual_vibration(frequency=(18, 22)): at_most(1e-3)}
        ),
        Problem(
            order=3, C=at_most(6), basis=Chebyshev(9), bounds={residual_vibration(frequency=(18, 22)): at_most(1e-2)}
        ),
    ):
        with pytest.raises(InfeasibleProblem, match=r"residual\(frequency=\(18.0, 22.0\)\)") as caught:
            synthesize(asked)
        proof = caught.value.proof
        assert isinstance(proof, Certificate)
        assert proof.proves_infeasible or proof.bound > asked.bounds["residual(frequency=(18.0, 22.0))"].high
        assert "frequency = 18" in str(caught.value) or "below" in str(caught.value)


def test_problem_and_certificate_are_stored_as_text() -> None:
    asked = CASES[2]
    assert Problem.from_dict(json.loads(json.dumps(asked.to_dict()))) == asked
    proof = synthesize(asked).certificate
    read = Certificate.from_dict(json.loads(json.dumps(proof.to_dict())))
    assert read == proof
    assert read.bound == proof.bound == pytest.approx(synthesize(asked).objective, rel=1e-8)


def test_a_spoilt_certificate_proves_less() -> None:
    proof = synthesize(CASES[0]).certificate
    data = proof.to_dict()
    for contact in data["contacts"]:
        if contact["direction"]:
            contact["direction"] = [-one for one in contact["direction"]]
    assert not Certificate.from_dict(data).bound > proof.bound * 0.9


@pytest.mark.parametrize(
    ("given_", "says"),
    [
        ({"frequency": (22, 18)}, "frequency must be an interval"),
        ({"frequency": (1, 2, 3)}, "a frequency or two"),
        ({"frequency": (0, 3)}, "frequency must be above 0"),
        ({"frequency": (1, 3000)}, "no longer than 1000"),
        ({"frequency": 20, "damping": 1.0}, "damping must be below 1"),
        ({"frequency": 20, "design_damping": 0.1}, "give design too"),
    ],
)
def test_nonsense_is_refused(given_: dict[str, object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        residual_vibration(**given_)  # type: ignore[arg-type] # that is what is refused


def test_a_law_that_no_cam_can_make_is_refused() -> None:
    with pytest.raises(InputError, match="order 4 at least"):
        synthesize(Problem(order=3, bounds={residual_vibration(frequency=(18, 22), design=20): at_most(0.1)}))
    with pytest.raises(InputError, match="rest to rest"):
        synthesize(Problem(order=1, bounds={residual_vibration(frequency=(18, 22)): at_most(0.1)}))
