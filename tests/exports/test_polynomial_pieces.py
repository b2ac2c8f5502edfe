"""Times and coefficients in machine units: the law's own polynomials, or ones within the tolerance that is asked."""

import numpy as np
import pytest

from optlaws import InputError, MotionLaw, PiecewiseLaw, catalogue, smoothstep
from tests.exports.samples import optimal, press, shearing
from tests.internals.laws import PowerSegment


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
