"""Least prime circles and greatest rollers: against bisection on another footing, and against what just breaks them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from optlaws import (
    DiscCam,
    InfeasibleProblem,
    InputError,
    OscillatingFlat,
    OscillatingRoller,
    TranslatingFlat,
    TranslatingRoller,
    greatest_roller,
    least_prime_circle,
)
from tests.cams.placed import cycle_of
from tests.internals.cams import CamFollower

ANGLES = np.linspace(0.0, 2.0 * np.pi, 2001)
CASES: list[tuple[CamFollower, str, float | None, float | None]] = [
    (TranslatingRoller("12 mm"), "30 mm", 30.0, None),
    (TranslatingRoller("12 mm", offset="9 mm"), "30 mm", 30.0, 5.0),
    (TranslatingRoller("4 mm"), "60 mm", 70.0, 9.0),
    (TranslatingFlat(), "12 mm", None, 5.0),
    (OscillatingRoller("12 mm", "90 mm", "120 mm"), "20 deg", 35.0, 5.0),
    (OscillatingFlat("150 mm", "6 mm"), "8 deg", None, 5.0),
]


def keeps(cam: DiscCam, pressure: float | None, radius: float | None) -> bool:
    """Whether a cam keeps its limits at 2,001 places, by its curves alone."""
    if pressure is not None and np.degrees(np.abs(cam.pressure_angle(ANGLES))).max() > pressure:
        return False
    curvature = cam.pitch_curve.curvature(ANGLES)
    sharpest = 1.0 / curvature[curvature > 0].max() - cam.contact.roller
    return radius is None or bool(1e3 * sharpest >= radius and curvature.min() > -np.inf)


@pytest.mark.sample(3)
@pytest.mark.parametrize(("follower", "stroke", "pressure", "radius"), CASES)
def test_the_least_prime_circle_is_that_of_a_bisection(
    follower: CamFollower, stroke: str, pressure: float | None, radius: float | None
) -> None:
    cycle = cycle_of(stroke)
    limits: dict[str, Any] = {} if pressure is None else {"pressure_angle": f"{pressure} deg"}
    limits |= {} if radius is None else {"radius_of_curvature": f"{radius} mm"}
    least = least_prime_circle(cycle, follower, **limits)
    assert least.proven
    assert least.radius * (1 - 2e-8) < least.too_small < least.radius
    low, high = 0.9 * least.radius, 1.1 * least.radius
    for _ in range(18):
        middle = 0.5 * (low + high)
        fine = keeps(DiscCam(cycle, f"{middle!r} m", follower), pressure, radius)
        low, high = (low, middle) if fine else (middle, high)
    assert high == pytest.approx(least.radius, rel=2e-5)
    smaller = DiscCam(cycle, f"{least.too_small!r} m", follower).extremes
    assert (pressure is not None and np.degrees(smaller.greatest_pressure_angle.low) > pressure) or (
        radius is not None and 1e3 * smaller.least_convex_radius.high < radius
    )
    extremes = least.cam.extremes
    assert pressure is None or np.degrees(extremes.greatest_pressure_angle.high) <= pressure
    assert radius is None or 1e3 * extremes.least_convex_radius.low >= radius


def test_a_flat_face_has_its_closed_form() -> None:
    # rho = r0 + s + s'' >= 5 mm
    cycle = cycle_of("12 mm")
    least = least_prime_circle(cycle, TranslatingFlat(), radius_of_curvature="5 mm")
    motion = least.cam.displacement
    lowest = min(float((motion(x) + motion(x, 2)).min()) for x in (np.linspace(0.0, 2 * np.pi, 400_001),))
    assert least.radius == pytest.approx(0.005 - lowest, rel=1e-9)


def test_a_mechanism_may_be_all_that_bounds_it() -> None:
    least = least_prime_circle(cycle_of("5 mm"), TranslatingRoller("12 mm"), pressure_angle="60 deg")
    assert least.limit == "mechanism"
    assert least.radius == pytest.approx(0.012, rel=1e-8)


@pytest.mark.parametrize("offset", ["0 mm", "9 mm", "-9 mm"])
def test_the_greatest_roller_keeps_the_radius_and_a_greater_one_breaks_it(offset: str) -> None:
    cam = DiscCam(cycle_of("60 mm"), "40 mm", TranslatingRoller("2 mm", offset))
    found = greatest_roller(cam, radius_of_curvature="4 mm")
    assert 0.0 < found.too_large - found.radius < 1e-9
    rollers = [TranslatingRoller(f"{found.radius + step!r} m", offset) for step in (-1e-8, 1e-8)]
    margins = [DiscCam(cycle_of("60 mm"), "40 mm", roller).extremes.least_convex_radius for roller in rollers]
    assert margins[0].low >= 0.004 > margins[1].high


def test_limits_that_are_missing_or_cannot_be_kept_say_the_remedy() -> None:
    cycle, arm = cycle_of("30 mm"), OscillatingRoller("12 mm", "90 mm", "120 mm")
    with pytest.raises(InputError, match="pressure_angle='30 deg'"):
        least_prime_circle(cycle, TranslatingRoller("12 mm"))
    with pytest.raises(InputError, match="below 90 deg"):
        least_prime_circle(cycle, TranslatingRoller("12 mm"), pressure_angle="90 deg")
    with pytest.raises(InputError, match="at least 0"):
        least_prime_circle(cycle, TranslatingFlat(), radius_of_curvature="-1 mm")
    with pytest.raises(InfeasibleProblem, match=r"no prime circle keeps a pressure angle of 5 deg.*spread the motion"):
        least_prime_circle(cycle_of("20 deg"), arm, pressure_angle="5 deg")
    with pytest.raises(InputError, match="a flat face has no roller"):
        greatest_roller(DiscCam(cycle, "60 mm", TranslatingFlat()))
    with pytest.raises(InputError, match="make the prime circle larger"):
        greatest_roller(DiscCam(cycle, "60 mm", TranslatingRoller("2 mm")), radius_of_curvature="90 mm")
