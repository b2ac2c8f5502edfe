"""The best offset of a slide: against brute force, in either sense of turning, in any unit."""

from math import degrees, sqrt

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from optlaws import (
    CamMotion,
    Cycle,
    DiscCam,
    Dwell,
    InputError,
    OscillatingRoller,
    Return,
    Rise,
    TranslatingRoller,
    best_offset,
)
from tests.cams.placed import cycle_of

ROLLER = TranslatingRoller("12 mm", offset="5 mm")
MOTIONS: dict[str, Cycle | CamMotion] = {
    "up and down": cycle_of("30 mm"),
    "raised": Cycle([Rise("20 mm", "60 deg", law="345"), Return(law="modified sine")], start="7 mm", period="1 s"),
    "a return": CamMotion.of_law("cycloidal", "40 mm", "120 deg", "return"),
    "a rise, parabolic": CamMotion.of_law("parabolic", "40 mm", "90 deg"),
}


@pytest.mark.parametrize("turning", ["counterclockwise", "clockwise"])
@pytest.mark.parametrize("name", MOTIONS)
def test_no_offset_has_a_smaller_greatest_pressure_angle(name: str, turning: str) -> None:
    motion = MOTIONS[name]
    best = best_offset(motion, "60 mm", ROLLER, turning=turning)  # type: ignore[arg-type]
    course = best.cam.displacement
    angles = np.linspace(*course.interval, 40001)
    s, slope = np.asarray(course(angles)) - course.range[0], np.asarray(course(angles, 1))
    sign = 1.0 if turning == "counterclockwise" else -1.0

    def greatest(offset: float) -> float:
        return float(np.abs((slope - sign * offset) / (sqrt(0.06**2 - offset**2) + s)).max())

    brute = minimize_scalar(greatest, bounds=(-0.0599, 0.0599), method="bounded", options={"xatol": 1e-12})
    assert best.proven
    assert best.offset == pytest.approx(brute.x, abs=1e-8)
    assert np.tan(best.pressure_angle) == pytest.approx(brute.fun, rel=1e-7)
    assert np.tan(best.lower_bound) <= brute.fun
    assert best.pressure_angle - best.lower_bound < 3e-8 * best.pressure_angle
    least, most = best.cam.extremes.pressure_angles
    assert most.value == pytest.approx(-least.value, rel=1e-9)
    at = np.degrees(np.abs(best.cam.pressure_angle(np.array(best.angles))))
    assert at == pytest.approx(degrees(best.pressure_angle), rel=1e-8)


def test_a_follower_that_rests_has_none() -> None:
    best = best_offset(Cycle([Rise("1e-9 mm", "90 deg"), Return()], period="1 s"), "60 mm", ROLLER)
    assert abs(best.offset) < 1e-12
    assert best.lower_bound <= best.pressure_angle < 1e-10


@pytest.mark.parametrize("unit", [1e-12, 1e9])
def test_other_units_of_lengths(unit: float) -> None:
    def of(size: float) -> tuple[float, float, bool]:
        moves = [Rise(f"{30 * size!r} mm", "120 deg", law="345"), Dwell("20 deg"), Return(duration="80 deg", law="345")]
        cycle = Cycle([*moves, Dwell()], period="1 s")
        best = best_offset(cycle, f"{61 * size!r} mm", TranslatingRoller(f"{12 * size!r} mm"))
        return best.offset / size, best.pressure_angle, best.proven

    assert of(unit) == pytest.approx(of(1.0), rel=1e-9)


def test_wrong_followers_say_why() -> None:
    with pytest.raises(InputError, match="must be a TranslatingRoller"):
        best_offset(MOTIONS["up and down"], "60 mm", OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm"))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="prime_radius"):
        best_offset(MOTIONS["up and down"], "-60 mm", ROLLER)
    with pytest.raises(InputError, match="not less than that of the prime circle"):
        best_offset(MOTIONS["up and down"], "9 mm", ROLLER)
    assert DiscCam(MOTIONS["up and down"], "60 mm", ROLLER).contact.roller == pytest.approx(0.012)
