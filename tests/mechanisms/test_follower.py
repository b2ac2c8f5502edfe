"""Elastic followers with units, and laws of the catalogue where laws are taken."""

from typing import Any

import pytest

from optlaws import (
    Follower,
    InputError,
    Machine,
    catalogue,
    driving_law,
    dwell_mechanism,
    mass_law,
    off_design,
    polydyne,
)

OSCILLATOR = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
TIMES = {"speed": "105 rpm", "rise": "120 deg"}


def test_answers_are_those_of_the_follower_in_units() -> None:
    follower = Follower.from_vibration("16.7 Hz", **TIMES, damping=0.05)
    assert follower == Follower.from_vibration(f"{1 / 16.7!r} s", **TIMES, damping=0.05)
    same = Follower.from_speed(speed_rpm=105, rise_angle_deg=120, natural_period=1 / 16.7, damping=0.05)
    assert follower.frequency == pytest.approx(same.frequency, rel=1e-14)
    response = follower.response(catalogue["modified sine"].law)
    answers = response.in_units("35 mm", **TIMES)
    time = answers["time, s"]
    assert time == pytest.approx(120 / 360 * 60 / 105, rel=1e-14)
    size = 0.035 / time**2
    assert answers == pytest.approx(
        {
            "stroke, m": 0.035,
            "time, s": time,
            "dynamic factor": response.dynamic_factor(),
            "peak velocity, m/s": 0.035 / time * response.peak(1).value,
            "peak acceleration, m/s²": size * response.peak(2).value,
            "acceleration in the dwell, m/s²": size * response.dwell_peak(2).value,
            "residual displacement, m": 0.035 * response.residual_displacement,
            "residual acceleration, m/s²": size * response.residual_acceleration,
        },
        rel=1e-14,
    )
    turning = response.in_units("20 deg", duration="0.2 s")
    assert (turning["stroke, rad"], turning["time, s"]) == pytest.approx((0.349065850, 0.2))


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"vibration": "16.7"}, "vibration must be a frequency such as .* without a unit"),
        ({"vibration": "0 Hz"}, "vibration must be above 0"),
        ({"vibration": "3 kg"}, "vibration must be a frequency"),
        ({"duration": "1 s"}, "give duration"),
        ({"rise": None}, "give duration"),
        ({"speed": "3 Hz"}, "is a frequency"),
    ],
)
def test_what_is_wrong_is_said(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Follower.from_vibration(**{"vibration": "16.7 Hz", **TIMES, **changed})


def test_a_stroke_is_a_length_or_an_angle() -> None:
    with pytest.raises(InputError, match="stroke must be a length"):
        Follower(20).response(catalogue["modified sine"].law).in_units("35 kg", duration="1 s")


def test_entries_of_the_catalogue_stand_for_their_laws() -> None:
    entry = catalogue["4-5-6-7"]
    assert Follower(20).response(entry) == Follower(20).response(entry.law)  # type: ignore[arg-type] # what people give
    cam = polydyne(entry, 20)  # type: ignore[arg-type]
    assert cam == polydyne(entry.law, 20)
    assert mass_law(entry, 20) == mass_law(entry.law, 20)  # type: ignore[arg-type]
    assert off_design(cam, entry, Follower(20))[0].dynamic_factor > 1  # type: ignore[arg-type]
    assert driving_law(OSCILLATOR, entry) == driving_law(OSCILLATOR, entry.law)  # type: ignore[arg-type]
    angles = {"dwell": 1.5, "rise": 1.5, "swing": 0.3, "radius_ratio": 1.0, "inertia_ratio": 0.1}
    assert dwell_mechanism("I", law=entry, **angles) == dwell_mechanism("I", law=entry.law, **angles)  # type: ignore[arg-type]


def test_the_dimensionless_frequency_refuses_hertz_with_the_remedy() -> None:
    wrong: Any = "20 Hz"
    with pytest.raises(InputError, match=r"frequency is dimensionless, .* got '20 Hz': .*Follower\.from_vibration"):
        Follower(wrong)
