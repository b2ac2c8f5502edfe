"""The slider-crank against published numbers, Lagrange's equations and programs of another kind."""

import pytest

from optlaws import Chebyshev, Mechanism, Problem, rms, slider_crank, smoothstep, synthesize

DURATION = 0.3


def press(crank_inertia: float) -> Mechanism:
    return slider_crank("0.1 m", "0.4 m", bodies={"slider": "5 kg", "crank": crank_inertia})


@pytest.mark.parametrize(("crank_inertia", "expected"), [(0.0, 5.992776), (0.02, 7.979021)])
def test_rms_torque_of_the_quintic(crank_inertia: float, expected: float) -> None:
    moved = press(crank_inertia).dimensionless("0 deg", "180 deg", "0.3 s")
    assert rms(moved.torque).value(smoothstep(3)) * moved.unit == pytest.approx(expected, abs=6e-7)


@pytest.mark.parametrize(
    ("degree", "symmetric", "expected"),
    [(5, False, 4.032923), (9, False, 3.989601), (13, False, 3.960253), (9, True, 4.126803)],
)
def test_least_rms_torque(degree: int, symmetric: bool, expected: float) -> None:  # noqa: FBT001
    moved = press(0.02).dimensionless("0 deg", "180 deg", "0.3 s")
    problem = Problem(order=3, basis=Chebyshev(degree), minimise=rms(moved.torque), symmetric=symmetric)
    assert synthesize(problem).objective * moved.unit == pytest.approx(expected, abs=1e-6)
