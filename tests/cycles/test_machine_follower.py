"""Elastic followers with units: what they are asked in and answer in."""

import pytest

from optlaws import (
    Follower,
    InputError,
    Machine,
    catalogue,
    driving_law,
    dwell_mechanism,
    machine_follower,
    mass_law,
    off_design,
    polydyne,
)

OSCILLATOR = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
MACHINE = {"natural_frequency": "16.7 Hz", "speed": "105 rpm", "rise": "120 deg", "stroke": "35 mm"}


def test_answers_are_those_of_the_follower_in_units() -> None:
    machine = machine_follower(**MACHINE, damping=0.05)
    same = Follower.from_speed(speed_rpm=105, rise_angle_deg=120, natural_period=1 / 16.7, damping=0.05)
    assert machine.follower.frequency == pytest.approx(same.frequency, rel=1e-14)
    answer = machine.response(catalogue["modified sine"].law)
    response = machine.follower.response(catalogue["modified sine"].law)
    size = 0.035 / machine.duration**2
    assert answer.peak_acceleration == pytest.approx(size * response.peak(2).value, rel=1e-14)
    assert answer.dwell_acceleration == pytest.approx(size * response.dwell_peak(2).value, rel=1e-14)
    assert answer.residual_displacement == pytest.approx(0.035 * response.residual_displacement, rel=1e-14)
    assert answer.results()["residual acceleration, m/s²"] == answer.residual_acceleration
    assert answer.peak_velocity == pytest.approx(0.035 / machine.duration * response.peak(1).value, rel=1e-14)


def test_a_rotary_stroke_is_in_radians() -> None:
    machine = machine_follower(natural_period="60 ms", duration="0.2 s", stroke="20 deg")
    assert machine.unit == "rad"
    assert machine.stroke == pytest.approx(0.349065850)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"natural_frequency": "16.7"}, "without a unit"),
        ({"natural_frequency": "0 Hz"}, "frequency must be above 0"),
        ({"natural_period": "60 ms"}, "not both"),
        ({"natural_frequency": None}, "give natural_frequency"),
        ({"duration": "1 s"}, "give duration"),
        ({"rise": None}, "give duration"),
        ({"stroke": "35 kg"}, "stroke must be a length"),
        ({"speed": "3 Hz"}, "is a frequency"),
    ],
)
def test_what_is_wrong_is_said(changed: dict[str, str | None], message: str) -> None:
    with pytest.raises(InputError, match=message):
        machine_follower(**{**MACHINE, **changed})  # type: ignore[arg-type] # what is wrong


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
