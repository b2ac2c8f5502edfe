"""The slider-crank against published numbers of its least torque and energy."""

import pytest

from optlaws import Chebyshev, Mechanism, Problem, at_most, integral, peak, rms, slider_crank, smoothstep, synthesize
from optlaws.typing import StrokeTorque


def press(crank_inertia: float) -> Mechanism:
    return slider_crank("0.1 m", "0.4 m", bodies={"slider": "5 kg", "crank": crank_inertia})


@pytest.fixture(scope="module")
def moved() -> StrokeTorque:
    return press(0.02).dimensionless("0 deg", "180 deg", "0.3 s")


@pytest.mark.parametrize(("crank_inertia", "expected"), [(0.0, 5.992776), (0.02, 7.979021)])
def test_rms_torque_of_the_quintic(crank_inertia: float, expected: float) -> None:
    stroke = press(crank_inertia).dimensionless("0 deg", "180 deg", "0.3 s")
    assert rms(stroke.torque).value(smoothstep(3)) * stroke.unit == pytest.approx(expected, abs=6e-7)


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("degree", "symmetric", "expected"),
    [(5, False, 4.032923), (9, False, 3.989601), (13, False, 3.960253), (9, True, 4.126803)],
)
def test_least_rms_torque(moved: StrokeTorque, degree: int, symmetric: bool, expected: float) -> None:  # noqa: FBT001
    problem = Problem(order=3, basis=Chebyshev(degree), minimise=rms(moved.torque), symmetric=symmetric)
    assert synthesize(problem).objective * moved.unit == pytest.approx(expected, abs=1e-6)


def test_least_peak_torque(moved: StrokeTorque) -> None:
    problem = Problem(order=3, basis=Chebyshev(9), minimise=peak(moved.torque), C=at_most(12))
    assert synthesize(problem).objective * moved.unit == pytest.approx(5.1057, abs=1e-4)


@pytest.mark.long
def test_least_energy_without_regeneration(moved: StrokeTorque) -> None:
    energy = integral(f"max(({moved.torque})*b, 0)")
    assert energy.value(smoothstep(3)) * moved.unit == pytest.approx(4.416, abs=5e-4)
    problem = Problem(order=3, basis=Chebyshev(9), minimise=energy, C=at_most(12))
    assert synthesize(problem).objective * moved.unit <= 1.196


def test_inertia_that_vanishes_at_the_dead_centres() -> None:
    # without inertia of the crank the torque there is that of friction alone
    without = press(0.0).with_friction(coulomb="0.4 N m")
    assert without.inertia(0.0) == 0.0
    assert without.torque(0.0, 3.0, 500.0) == pytest.approx(0.4, abs=1e-12)
    stroke = press(0.0).dimensionless("0 deg", "180 deg", "0.3 s")
    problem = Problem(order=3, basis=Chebyshev(9), minimise=rms(stroke.torque), symmetric=False)
    assert synthesize(problem).objective * stroke.unit == pytest.approx(1.263272, abs=1e-6)


def test_a_stroke_backwards_takes_the_torque_of_its_mirror() -> None:
    # the slider-crank looks the same from both sides, so that the way back takes what the way forth takes
    forth = press(0.02).with_friction(coulomb="1 N m", viscous="0.1 N m s/rad").dimensionless("0 deg", "120 deg", 0.2)
    back = press(0.02).with_friction(coulomb="1 N m", viscous="0.1 N m s/rad").dimensionless("360 deg", "-120 deg", 0.2)
    for law in (smoothstep(3), smoothstep(5)):
        assert rms(back.torque).value(law) * back.unit == pytest.approx(rms(forth.torque).value(law) * forth.unit)
