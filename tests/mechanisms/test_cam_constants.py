"""Mass laws chosen for the sake of their cam: below Savin's families, proven, and found again by a linear program."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    BoundaryConditions,
    BSplines,
    Chebyshev,
    InputError,
    Pieces,
    Problem,
    at_most,
    cam_constant,
    polydyne,
    savin,
    smoothstep,
    synthesize,
)
from tests.internals.mechanisms import gain
from tests.mechanisms.cam_programs import PLACES

CASES = [(*member, damping) for member in (("III", 7.2, 4), ("IV", 11.0, 5)) for damping in (0.0, 0.05)]


def problem(family: str, alpha: float, order: int, damping: float) -> Problem:
    """The least C of the cam at the B of a member of a family, over laws of its order."""
    C_cam = cam_constant("C", frequency=20, damping=damping)
    fixed = savin(family, alpha).constants.B.value
    return Problem(B=fixed, order=order, basis=Chebyshev(11), minimise=C_cam, symmetric=damping == 0.0)


@pytest.mark.parametrize(("family", "alpha", "order", "damping"), CASES)
def test_the_optimum_is_proven_and_clearly_below_the_family_at_the_same_B(
    family: str, alpha: float, order: int, damping: float
) -> None:
    asked = problem(family, alpha, order, damping)
    solution = synthesize(asked)
    known = cam_constant("C", frequency=20, damping=damping).value(savin(family, alpha))
    assert solution.status.value == "optimal"
    assert solution.gap < 1e-8
    assert solution.objective < 0.85 * known
    assert solution.constants.B.value == pytest.approx(asked.B, rel=1e-9)
    cam = polydyne(solution.law, frequency=20, damping=damping)
    assert np.abs(cam.c(PLACES)).max() <= solution.objective * (1 + 1e-9)
    assert np.abs(cam.c(PLACES)).max() == pytest.approx(solution.objective, rel=1e-5)


def test_slow_machines_need_no_correction_and_the_optimum_is_the_law_s_own() -> None:
    rigid = synthesize(Problem(B=1.8, order=4))
    stiff = synthesize(Problem(B=1.8, order=4, minimise="C_cam(frequency=100000)"))
    assert stiff.objective == pytest.approx(rigid.objective, rel=1e-5)


def test_the_power_of_the_cam_is_not_convex_and_bounded_from_below() -> None:
    for damping in (0.0, 0.05):
        solution = synthesize(
            Problem(order=4, basis=Chebyshev(11), minimise=cam_constant("D", frequency=20, damping=damping))
        )
        assert solution.status.value == "local"
        assert 2.25 - 1e-9 <= solution.lower_bound < solution.objective < 3.2
        d = polydyne(solution.law, frequency=20, damping=damping).d(PLACES)
        assert np.abs(d).max() == pytest.approx(solution.objective, rel=1e-5)


def test_a_constant_of_the_cam_can_be_bounded_or_fixed() -> None:
    C_cam, B_cam = (cam_constant(name, frequency=20) for name in ("C", "B"))
    free = synthesize(Problem(order=4, minimise=C_cam))
    slow = synthesize(Problem(order=4, minimise=C_cam, bounds={B_cam: at_most(1.5)}))
    assert slow.status.value == "optimal"
    assert B_cam.value(slow.law) == pytest.approx(1.5, rel=1e-8)
    assert slow.objective > free.objective
    fixed = synthesize(Problem(order=4, minimise=C_cam, bounds={B_cam: 1.9}))
    assert B_cam.value(fixed.law) == pytest.approx(1.9, rel=1e-8)
    assert fixed.status.value == "local"  # a peak that must be held up is not convex
    kept = synthesize(Problem(order=4, B=1.9, minimise="C", bounds={C_cam: at_most(5.0)}))
    assert kept.status.value == "optimal"
    assert C_cam.value(kept.law) == pytest.approx(5.0, rel=1e-8)


@pytest.mark.parametrize("basis", [Pieces(8, degree=6, continuity=3), BSplines(6, 4)], ids=repr)
def test_laws_of_pieces_take_constants_of_the_cam(basis: Pieces | BSplines) -> None:
    for symmetric in (True, False):
        C_cam = cam_constant("C", frequency=20, damping=0.05)
        solution = synthesize(Problem(order=4, basis=basis, minimise=C_cam, symmetric=symmetric))
        assert solution.status.value == "optimal"
        assert np.abs(polydyne(solution.law, 20, 0.05).c(PLACES)).max() <= solution.objective * (1 + 1e-9)


@given(st.floats(1.0, 200.0), st.floats(0.0, 1.5))
def test_a_mass_accelerates_in_the_mean_at_most_gain_times_as_much_as_its_cam(nu: float, damping: float) -> None:
    law = smoothstep(5)
    cam = polydyne(law, nu, damping)
    weights = np.gradient(PLACES)
    assert weights @ np.abs(law.c(PLACES)) <= gain(nu, damping) * (weights @ np.abs(cam.c(PLACES))) * (1 + 1e-4)


@pytest.mark.parametrize(
    ("given_", "says"),
    [
        ({"order": 3}, "order 4 at least"),
        ({"order": 4, "minimise": "J_cam(frequency=20)"}, "order 5 at least"),
        ({"order": 4, "bounds": {"J_cam(frequency=30)": at_most(500.0)}}, "order 5 at least"),
        ({"order": 4, "basis": Pieces(8, degree=5, continuity=2)}, "continuity of at least 3"),
        ({"boundary": BoundaryConditions((0, 1, 0, 0), (1, 1, 0, 0)), "symmetric": False}, "zero at both ends"),
    ],
)
def test_laws_that_no_cam_can_make_are_refused(given_: dict[str, object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        synthesize(Problem(**({"minimise": "C_cam(frequency=20)"} | given_)))  # type: ignore[arg-type] # entries of one case


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("C_cam", "needs its arguments"),
        ("C_cam()", "an argument of C_cam"),
        ("C_cam(frequency=20", r"expected , or \)"),
        ("C_cam(frequency=-20)", "frequency must be above 0, got -20"),
        ("C_cam(frequency=0)", "frequency must be above 0"),
        ("C_cam(frequency=20, frequency=21)", "frequency is given twice"),
        ("C_cam(speed=20)", "does not take the arguments speed"),
        ("C_cm(nu=20)", "C_cam"),
        ("2*C_cam(frequency=(18, 22))", "must be a finite real number"),
    ],
)
def test_text_that_names_no_constant_is_refused(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        Problem(order=4, minimise=text)


def test_an_unknown_constant_of_the_cam_is_refused() -> None:
    with pytest.raises(InputError, match="constant of the cam"):
        cam_constant("K", frequency=20)
