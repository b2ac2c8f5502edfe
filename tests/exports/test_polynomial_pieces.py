"""Times and coefficients in machine units: the law's own polynomials, or polynomials near it."""

import numpy as np
import pytest

from optlaws import InputError, MotionLaw, PiecewiseLaw, catalogue, limit_law, scca, smoothstep
from tests.exports.samples import optimal, press, shearing
from tests.internals.exports import fitted
from tests.internals.laws import PowerSegment
from tests.internals.motion import motion_of_law


@pytest.mark.parametrize("law", [optimal(), smoothstep(20), smoothstep(30), catalogue["constant acceleration"].law])
def test_polynomials_stay_what_they_are(law: MotionLaw) -> None:
    """High powers cancel each other: pieces are halved before that costs digits, and keep their degree."""
    run = law.pieces("-35 mm", "0.1 s", start="5 mm", tolerance=1e-10)
    x = np.linspace(0.0, 0.1, 2000)
    for nu in range(3):
        expected = -35.0 * law(np.clip(x / 0.1, 0.0, 1.0), nu) / 0.1**nu + (5.0 if nu == 0 else 0.0)
        np.testing.assert_allclose(run(x, nu)[1:-1], expected[1:-1], rtol=0.0, atol=1e-8 * np.abs(expected).max())
    assert np.abs(run(x) - 5.0 + 35.0 * law(np.clip(x / 0.1, 0.0, 1.0))).max() <= 35.0 * 1e-10
    assert len(run.coefficients) <= 6


@pytest.mark.parametrize("name", ["cycloidal", "modified sine", "double harmonic"])
@pytest.mark.parametrize("tolerance", [1e-4, 1e-9])
def test_other_laws_are_as_near_as_asked(name: str, tolerance: float) -> None:
    law = catalogue[name].law
    run = law.pieces("35 mm", master="120 deg", tolerance=tolerance)
    x = np.linspace(0.0, 120.0, 5000)
    assert np.abs(run(x) - 35.0 * law(np.clip(x / 120.0, 0.0, 1.0))).max() <= 35.0 * tolerance
    assert run.degree == 7


def test_a_cycle_has_its_polynomials() -> None:
    for cycle in (press(), shearing()):
        run, times = cycle.polynomials(unit="m"), np.linspace(0.0, cycle.duration, 700)[:-1]
        assert (run.start, run.stop) == pytest.approx((0.0, cycle.duration))
        np.testing.assert_allclose(run(times), cycle(times), atol=1e-9 * cycle.peak(0))
        by_angle = cycle.polynomials(master="360 deg", unit="m")
        np.testing.assert_allclose(by_angle(times * 360.0 / cycle.duration), run(times), atol=1e-12)


def test_what_cannot_be_is_said() -> None:
    grows = PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)])
    with pytest.raises(InputError, match=r"infinite|greater tolerance"):
        grows.pieces(f"{1.0 / grows(1.0)} m", "1 s")
    with pytest.raises(InputError, match="tolerance"):
        smoothstep(3).pieces("1 m", "1 s", tolerance=0.0)
    with pytest.raises(InputError, match="stroke"):
        smoothstep(3).pieces(35.0, "1 s")  # type: ignore[arg-type]


# --- laws of no low degree ---


SAID = {"stroke": "35 mm", "duration": "0.1 s"}


@pytest.mark.parametrize("name", ["cycloidal", "modified sine", "modified trapezoid"])
@pytest.mark.parametrize("degree", [5, 7])
def test_deviations_that_are_stated_are_the_greatest(name: str, degree: int) -> None:
    motion = motion_of_law(catalogue[name].law, **SAID)
    made = fitted(motion, degree, 50)
    x = np.linspace(0.0, 0.1, 20001)
    for nu, stated in ((0, made.deviation), (2, made.acceleration)):
        seen = np.abs(made.run(x, nu) - motion(x, nu)).max()
        assert 0.99 * stated <= seen <= stated * (1.0 + 1e-6) + 1e-12 * motion.peak(nu)
    assert made.acceleration <= 1e-2 * motion.peak(2)
    assert made.run.peak(2).value <= (1.0 + 1.001e-3) * motion.peak(2)
    assert np.abs(made.run.jumps(1)).max(initial=0.0) <= 1e-10 * motion.peak(1)


def test_each_side_of_a_jump_keeps_its_own_derivatives() -> None:
    motion = motion_of_law(scca(0.25, 0.5, 0.25), **SAID)
    made = fitted(motion, 7, 50)
    assert made.run.peak(3).value == pytest.approx(motion.peak(3), rel=1e-3)
    pieces = catalogue["modified trapezoid"].law.pieces("35 mm", "0.1 s")
    whole = motion_of_law(catalogue["modified trapezoid"].law, **SAID)
    off = pieces.deviation(lambda x, nu: whole(np.clip(x, 0.0, 0.1), nu), 0, whole.breaks)
    assert off.value <= 1e-9 * 35.0


def test_what_no_polynomial_is_near_to_is_refused() -> None:
    with pytest.raises(InputError, match="acceleration of the motion has no bound"):
        fitted(motion_of_law(limit_law("D", None), **SAID), 7, 50)
    with pytest.raises(InputError, match="pieces of its own, and the target holds 2: export its parts"):
        fitted(motion_of_law(catalogue["modified trapezoid"].law, **SAID), 5, 2)
    with pytest.raises(InputError, match=r"do not bring the acceleration within .*points=\.\.\."):
        fitted(motion_of_law(smoothstep(12), **SAID), 5, 3)
