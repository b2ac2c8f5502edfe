"""Quantities with units: what they are in SI, and what errors say of those that are wrong."""

import re
from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from math import inf, pi
from pathlib import Path
from typing import Any

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st
from pint import UnitRegistry

from optlaws import (
    Cycle,
    DiscCam,
    Dwell,
    Follower,
    Free,
    InputError,
    Link,
    Machine,
    Return,
    Rise,
    TorsionLever,
    TranslatingRoller,
    catalogue,
    compare_dwell_mechanisms,
    deg,
    dwell_mechanism,
    inertial_loader,
    smoothstep,
)
from tests.internals.files import reading
from tests.internals.jobs import read_of_cycle_entries as read
from tests.internals.motion import DIMENSIONS, TURN, either, quantity, written

PINT: UnitRegistry[Any] = UnitRegistry()


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("35 mm", "length", 0.035),
        ("1 in", "length", 0.0254),
        ("45 deg", "angle", pi / 4),
        ("0.5 turn", "angle", pi),
        ("1/12 turn", "angle", pi / 6),
        ("-3/4 in", "length", -0.01905),
        ("500 W", "power", 500.0),
        ("400 ms", "time", 0.4),
        ("616 mm/s", "velocity", 0.616),
        ("200 rpm", "angular velocity", 200 * 2 * pi / 60),
        ("30deg/s", "angular velocity", pi / 6),
        ("12 m/s^2", "acceleration", 12.0),
        ("12 m/s**2", "acceleration", 12.0),
        ("1 g_n", "acceleration", 9.80665),
        ("1e4 mm/s2", "acceleration", 10.0),
        ("5 in/s2", "acceleration", 0.127),
        ("900 m/s3", "jerk", 900.0),
        ("2.5 kg m2", "moment of inertia", 2.5),
        ("100 ft/min", "velocity", 0.508),
        ("5 thou", "length", 0.000127),
        ("5 mil", "length", 0.000127),
        ("2 g", "acceleration", 19.6133),
        ("2g", "acceleration", 19.6133),
        ("0.5 g0", "acceleration", 4.903325),
        ("3 g/s", "jerk", 29.41995),
        ("2 g", "mass", 0.002),
        ("3 N/g", "acceleration", 3000.0),
        ("120 cpm", "angular velocity", 4.0 * pi),
        ("120 cpm", "frequency", 2.0),
        ("2.5 kg cm^2", "moment of inertia", 2.5e-4),
        ("0.4 N m", "torque", 0.4),
        ("0.4 N*m", "torque", 0.4),
        ("3 N/mm", "stiffness", 3000.0),
        ("30 lbf/in", "stiffness", 30.0 * 0.45359237 * 9.80665 / 0.0254),
        ("30 lb in^2", "moment of inertia", 30.0 * 0.45359237 * 0.0254**2),
        ("0.01 N m s/rad", "rotary viscous friction", 0.01),
    ],
)
def test_quantities_in_si_units(text: str, dimension: str, value: float) -> None:
    assert quantity(text, dimension, "it") == pytest.approx(value, rel=1e-14)


PREFIXES = ["", "n", "u", "µ", "m", "c", "k", "milli", "kilo"]
#: of grams and newtons alone, beside these
GREAT_PREFIXES = ["M", "G"]
#: names of units, prefixed ones before others, and the names of pint where it has others
UNITS = {
    "L": (["m", "meter", "metre"], ["in", "inches", "ft", "foot", "feet", "thou"]),
    "M": (["g", "gram"], ["lb", "lbs", "oz", "pound"]),
    "T": (["s", "sec", "second"], ["min", "minute", "h", "hour"]),
    "A": (["rad", "radian"], ["deg", "°", "degrees", "turn", "rev", "U"]),
    "F": (["N", "newton"], ["lbf"]),
}
OF_PINT = {"rev": "turn", "U": "turn", "µ": "u"}
SHAPES = {
    "length": "L",
    "velocity": "L/T",
    "jerk": "L/T^3",
    "angular acceleration": "A/T^2",
    "moment of inertia": "M L^2",
    "pressure": "F/L^2",
    "power": "F*L/T",
    "force": "M L/T^2",
    "rotary viscous friction": "F L T/A",
}


@hypothesis.given(st.data())
def test_units_are_what_pint_says(data: st.DataObject) -> None:
    """Products of powers of units with prefixes, read by the library's table and by another's."""
    dimension = data.draw(st.sampled_from(sorted(SHAPES)))
    ours, theirs = SHAPES[dimension], SHAPES[dimension].replace(" ", "*").replace("^", "**")
    for letter, (prefixed, others) in UNITS.items():
        prefixes = [*PREFIXES, *(GREAT_PREFIXES if letter in "MF" else [])]
        prefix, name = data.draw(st.one_of(
            st.tuples(st.sampled_from(prefixes), st.sampled_from(prefixed)),
            *([st.tuples(st.just(""), st.sampled_from(others))] if others else []),
        ))  # fmt: skip
        ours = re.sub(rf"\b{letter}\b", f"{prefix}{name}", ours)
        theirs = re.sub(rf"\b{letter}\b", OF_PINT.get(prefix, prefix) + OF_PINT.get(name, name), theirs)
    expected = PINT.Quantity(1.0, theirs).to_base_units()
    assert quantity(f"1 {ours}", dimension, "it") == pytest.approx(float(expected.magnitude), rel=1e-13)


@pytest.mark.parametrize(
    ("text", "dimension", "near"),
    [
        ("40 Mm", "length", "mm"),
        ("40 MM", "length", "mm"),
        ("40 Mm/s", "velocity", "mm/s"),
        ("3 Ms", "time", "ms"),
        ("3 RPM", "angular velocity", "rpm"),
        ("3 DEG", "angle", "deg"),
        ("3 KG", "mass", "kg"),
    ],
)
def test_a_unit_in_other_letters_is_asked_for_by_its_name(text: str, dimension: str, near: str) -> None:
    """A megametre is no length of a machine, but a slip of the hand for a millimetre."""
    with pytest.raises(InputError, match=rf"the unit of '{text}' is not known; did you mean {near}\?$"):
        quantity(text, dimension, "it")
    assert quantity("5 MN", "force", "it") == 5e6
    assert quantity(PINT.Quantity(4.0, "Mm"), "length", "it") == 4e6


def test_a_unit_of_a_table_is_rounded_once() -> None:
    for text, dimension, size in (("1 rpm", "angular velocity", 2 * pi / 60), ("1 mm/s^2", "acceleration", 0.001),
                                  ("1 °", "angle", pi / 180), ("1 N/mm", "stiffness", 1000.0),
                                  ("1 nm", "length", 1e-9), ("1 um", "length", 1e-6)):  # fmt: skip
        assert quantity(text, dimension, "it") == size


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_an_unknown_unit_is_answered_by_those_that_are_known(dimension: str) -> None:
    """Each of the list is one of the dimension."""
    with pytest.raises(InputError, match="the unit of '3 parsec' is not known") as refused:
        quantity("3 parsec", dimension, "it")
    for unit in re.split(", | or ", str(refused.value).partition(f" {dimension} in ")[2]):
        assert either(f"2 {unit}", (dimension,), "it")[0] == dimension


def test_of_several_dimensions_a_unit_that_is_not_known_is_answered_for_all() -> None:
    with pytest.raises(InputError, match=r"not known: write an angle in rad, .* or a time in s, ms or min$"):
        either("3 parsec", ("angle", "time"), "duration")
    with pytest.raises(InputError, match=r"must be an angle such as '45 deg' or a time such as '0.3 s', got 'np"):
        either("np.float64(0.0131) s", ("angle", "time"), "duration")


def test_a_gram_of_pint_is_no_acceleration() -> None:
    units: UnitRegistry[Any] = UnitRegistry()
    with pytest.raises(InputError, match="is a mass"):
        quantity(2 * units.g, "acceleration", "it")
    assert quantity(2 * units.g_0, "acceleration", "it") == pytest.approx(19.6133, rel=1e-14)


def test_every_example_of_an_error_is_of_its_dimension() -> None:
    for dimension, (_, example) in DIMENSIONS.items():
        assert either(example, (dimension,), "it")[0] == dimension


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("35 mm", "speed must be an angular velocity such as '200 rpm', but '35 mm' is a length"),
        ("3 Hz", "speed must be an angular velocity such as '200 rpm', but '3 Hz' is a frequency"),
        ("3 Hz^2", r"speed must be an angular velocity such as '200 rpm', but '3 Hz\^2' is of dimension 1 / \[time\]"),
        ("200", "speed must be an angular velocity such as '200 rpm', got '200' without a unit"),
        (inf, "speed must be a finite real number, got inf"),
        (True, "speed must be an angular velocity such as '200 rpm', got True"),
        ("200 rmp", "the unit of '200 rmp' is not known"),
        ("9**9**9 rpm", "not known"),
        ("1 rpm*9**9**9", "not known"),
        ("1e400 rpm", "finite"),
        ("nan rpm", "got 'nan rpm'"),
        ("fast", "got 'fast'"),
        (None, "got None"),
        ("1 " + "rpm*" * 50 + "rpm", "speed must be"),
    ],
)
def test_what_is_wrong_is_said(given: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        quantity(given, "angular velocity", "speed")


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_a_number_of_one_dimension_is_in_si_units_and_is_kept_with_them(dimension: str) -> None:
    assert quantity(2.5, dimension, "it") == 2.5
    kept = written(np.float64(2.5), (dimension,))
    assert quantity(str(kept), dimension, "it") == 2.5
    assert PINT.Quantity(kept.removeprefix("2.5 ")).to_base_units().magnitude == 1.0
    with pytest.raises(InputError, match="it must be above 0, got -1"):
        quantity(-1, dimension, "it", above=0.0)


def test_the_same_cycle_is_made_of_texts_and_of_numbers_and_tells_its_clock_either_way() -> None:
    def moves(**limits: Any) -> list[Any]:
        return [Rise("35 mm", "120 deg", limits=limits), Dwell("60 deg"), Return("25 mm")]

    first: dict[str, Any] = {"start": "5 mm", "advance": "10 mm", "limits": {"jerk": ("-9 km/s^3", "8 km/s^3")}}
    text = Cycle(moves(velocity="900 mm/s"), period="0.3 s", drive={"mass": "2 kg"}, **first)
    first = {"start": 0.005, "advance": 0.01, "limits": {"jerk": (-9000.0, 8000)}}
    bare = Cycle(moves(velocity=0.9), period=0.3, drive={"mass": 2}, **first)
    assert (bare.objective, bare.peak(3), bare.effort.energy) == (text.objective, text.peak(3), text.effort.energy)
    assert Cycle.from_json(bare.to_json()) == bare
    assert (bare.period, bare.speed, text.period) == ("0.3 s", "200 rpm", "0.3 s")
    turned = replace(text, period=None, speed=TURN / 0.3)
    assert turned.period == "0.3 s"
    assert replace(turned, speed="100 rpm").period == "0.6 s"
    assert replace(turned, speed=None, period="1 s").speed == "60 rpm"


def test_of_several_dimensions_the_error_names_all() -> None:
    with pytest.raises(InputError, match=r"duration must be an angle such as '45 deg' or a time such as '0\.3 s', but"):
        either("3 mm", ("angle", "time"), "duration")


def test_quantities_of_pint_are_taken_as_their_texts() -> None:
    units: UnitRegistry[Any] = UnitRegistry()
    for given, dimension, expected in (
        (35 * units.mm, "length", 0.035),
        (2 * units.ft, "length", 0.6096),
        (200 * units.rpm, "angular velocity", 200.0 * pi / 30.0),
        (3 * units.N / units.mm, "stiffness", 3000.0),
        (9 * units.lbf, "force", 9 * 4.4482216152605),
        (0.4 * units.N * units.m, "torque", 0.4),
    ):
        assert quantity(given, dimension, "it") == pytest.approx(expected, rel=1e-12)
    for wrong, complaint in (
        (35 * units.mm / units.s, "'35.0 mm/s' is a velocity"),
        (3 * units.K, "'3.0 K' is not known"),
    ):
        with pytest.raises(InputError, match=complaint):
            quantity(wrong, "length", "it")
    asked = [("35 mm", "0.1 s"), (35 * units.mm, 0.1 * units.s)]
    texts, foreign = (
        Cycle([Rise(by=by, duration=time), Dwell(time), Return(duration=time)], period=3 * time if i else "0.3 s")
        for i, (by, time) in enumerate(asked)
    )
    assert Cycle.from_json(foreign.to_json()) == foreign
    assert [peaks.piece for peaks in foreign.peaks] == [peaks.piece for peaks in texts.peaks]


@pytest.mark.parametrize(
    "text", ["200 1/min", "200/min", "200 min^-1", "200 min⁻¹", "200 r/min", "200 U/min", "200 rev/min"]
)
def test_turns_a_minute_are_a_speed_wherever_one_is_asked_for(text: str) -> None:
    assert quantity(text, "angular velocity", "speed") == pytest.approx(200 * 2 * pi / 60, rel=1e-14)
    assert either(text, ("velocity", "angular velocity"), "velocity")[0] == "angular velocity"
    assert Cycle([Rise("35 mm", "120 deg"), Return()], speed=text).duration == pytest.approx(0.3, rel=1e-14)
    assert Follower.from_vibration("0.1 s", speed=text, rise="120 deg").frequency == pytest.approx(2 * pi, rel=1e-14)


def test_frequencies_that_may_count_radians_are_refused_as_speeds() -> None:
    for text in ("3 Hz", "3 1/s"):
        with pytest.raises(InputError, match="is a frequency: write rev/s or rad/s"):
            quantity(text, "angular velocity", "speed")
    assert quantity("200 1/min", "frequency", "frequency") == pytest.approx(200 / 60)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("12 m/s²", "acceleration", 12.0),
        ("900 m·s⁻³", "jerk", 900.0),
        ("0.02 kg·m²", "moment of inertia", 0.02),
        ("5 Nm", "torque", 5.0),
        ("5 kNm", "torque", 5000.0),
        ("5 nm", "length", 5e-9),
        ("5 μm", "length", 5e-6),
        ("−5 mm", "length", -5e-3),
        ("5 rps", "angular velocity", 10 * pi),
    ],
)
def test_signs_of_print_are_read_as_those_of_keyboards(text: str, dimension: str, value: float) -> None:
    assert quantity(text, dimension, "it") == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("35,5 mm", "decimals are behind a point, not a comma: write '35.5 mm'"),
        ("-0,25 mm", "write '-0.25 mm'"),
        ("1,000 mm", "write thousands with no sign between them, and decimals behind a point"),
        ("1.000,5 mm", "write thousands with no sign"),
        ("1'000 mm", "write thousands with no sign"),
        ("35", "write it as text with its unit, as in '35 mm'"),
    ],
)
def test_numbers_that_are_written_otherwise_are_refused_with_the_remedy(text: str, remedy: str) -> None:
    with pytest.raises(InputError, match=f"it must be a length such as '35 mm', got .*{remedy}"):
        quantity(text, "length", "it")


@pytest.mark.parametrize("magnitude", [2j, 10**400, 10**6000, [1, 2], [5], float("nan"), float("inf")], ids=range(7))
def test_quantities_of_pint_that_are_no_real_number_are_input_errors_at_every_door(magnitude: Any) -> None:
    """Segments, limits, drives, loads, cams, exports, machines."""
    units: UnitRegistry[Any] = UnitRegistry()
    quantities: list[Any] = [units.Quantity(magnitude, unit) for unit in ("mm", "mm/s", "kg", "s", "Hz")]
    length, velocity, mass, time, frequency = quantities
    moves = [Rise("35 mm", "0.1 s"), Return()]
    doors: list[Callable[[], Any]] = [
        lambda: Cycle([Rise(length, "0.1 s"), Return()], period="1 s"),
        lambda: Cycle([Rise("35 mm", time), Return()], period="1 s"),
        lambda: Cycle([Free("35 mm", "0.1 s", via=[("0.05 s", length)]), Return()], period="1 s"),
        lambda: Cycle([Rise("35 mm", "0.1 s", limits={"velocity": velocity}), Return()], period="1 s"),
        lambda: Cycle(moves, period=time),
        lambda: Cycle(moves, period="1 s", start=length),
        lambda: Cycle(moves, period="1 s", drive={"mass": mass}),
        lambda: Cycle(moves, period="1 s", load={"period": time}).load_motion,
        lambda: DiscCam(Cycle(moves, period="1 s"), prime_radius=length, follower=TranslatingRoller("12 mm")),
        lambda: DiscCam(Cycle(moves, period="1 s"), prime_radius="80 mm", follower=TranslatingRoller(length)),
        lambda: smoothstep(3).export("csv", stroke=length, duration="0.1 s"),
        lambda: Follower.from_vibration(time, duration="0.1 s"),
        lambda: Machine.from_modes([(frequency, 0.02)], duration=1.0),
        lambda: Machine.from_modes([(8.5, 0.02)], duration=time),
    ]
    for door in doors:
        with pytest.raises(InputError):
            door()


def test_bare_numbers_of_problem_files_and_units_of_bare_numbers_are_refused_with_the_remedy(tmp_path: Path) -> None:
    file = tmp_path / "slide.toml"
    file.write_text('job = "cycle"\ntitle = "S"\nspeed = "200 rpm"\n[[axis]]\nname = "x"\n[[axis.segment]]\n'
                    'kind = "rise"\nby = 35\n', "utf-8")  # fmt: skip
    with pytest.raises(InputError, match=r"segment 1: by .* got 35 without a unit: write it as text .* as in '35 mm'"):
        read(reading.toml(file), file)
    with pytest.raises(InputError, match="mode 1 must be a finite real number, got '2 Hz': give the number alone"):
        Machine.from_modes([("12 Hz", "2 Hz")], duration=1.0)


def machine_of(unit: UnitRegistry[Any] | None) -> list[Any]:
    """What takes bare numbers too: with units as text, as quantities of pint, or in SI."""

    def given(text: str, si: float) -> Any:
        return si if unit is None else text

    def united(text: str, si: float) -> Any:
        return si if unit is None else unit.Quantity(text)

    K = catalogue["K"].law
    mechanism = {
        "dwell": given("90 deg", deg(90)),
        "rise": united("90 deg", deg(90)),
        "swing": given("20 deg", deg(20)),
    }
    clutch = {"clutch_angle": united("15 deg", deg(15)), "radius_ratio": 1.0, "inertia_ratio": 0.1}
    loader_mass = {"executive_mass": given("2.5 kg", 2.5), "executive_stroke": united("40 mm", 0.04)}
    return [
        Machine.from_masses(
            {"motor": given("1500 g", 1.5), "load": united("2 kg", 2.0)},
            [Link("motor", "load", given("0.8 N/mm", 800.0), united("2 N*s/m", 2.0))],
            drive="motor",
            duration=given("200 ms", 0.2),
            stroke=united("35 mm", 0.035),
        ),
        Machine.from_modes(
            [(given("200 1/min", 200 / 60), 0.02), (given("12 Hz", 12.0), 0.02), (given("40 rad/s", 20 / pi), 0.01)],
            duration=united("0.4 s", 0.4),
            stroke=given("20 deg", deg(20)),
        ),
        Machine.from_units([[-40.0]], [[40.0]], [[1.0]], duration=given("0.1 s", 0.1), stroke=united("2 m", 2.0)),
        TorsionLever(0.75, 1.0, 0.15, 0.15, given("60 deg", deg(60)), united("30 deg", deg(30)), given("1 rad", 1.0)),
        dwell_mechanism("III", law=K, **mechanism, **clutch),
        compare_dwell_mechanisms(law=K, most_torque=0.5, **mechanism, **clutch).mechanisms["II"],
        inertial_loader(K).mass(**loader_mass, stroke=given("2 cm", 0.02)),
        inertial_loader(K).stroke(**loader_mass, mass=united("10 kg", 10.0)),
    ]


def test_machines_take_quantities_and_bare_numbers_alike() -> None:
    for bare, united in zip(machine_of(None), machine_of(UnitRegistry()), strict=True):
        numbers = [value for value in flat(bare) if isinstance(value, float)]
        others = [value for value in flat(united) if isinstance(value, float)]
        assert type(bare) is type(united)
        assert numbers
        assert others == pytest.approx(numbers, rel=1e-14)


def flat(value: Any) -> list[Any]:
    """All numbers in a value and its fields."""
    if is_dataclass(value):
        return [part for entry in fields(value) for part in flat(getattr(value, entry.name))]
    return [part for entry in value for part in flat(entry)] if isinstance(value, tuple) else [value]


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        (lambda: Link("motor", "load", "3 mm"), "stiffness must be a stiffness such as '3 N/mm' or a torsional"),
        (lambda: Machine.from_modes([("12", 0.02)], duration=1.0), "the frequency of mode 1 must .* without a unit"),
        (lambda: Machine.from_modes([(12.0, 0.02)], duration="1 m"), "duration must be a time"),
        (lambda: TorsionLever(0.75, 1.0, 0.15, 0.15, "60 mm"), "swing must be an angle such as '45 deg', but"),
        (
            lambda: inertial_loader(smoothstep(3)).mass(executive_mass="1 m", executive_stroke=1, stroke=1),
            "executive_mass must",
        ),
    ],
)
def test_a_quantity_of_another_dimension_is_refused(wrong: Callable[[], object], reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        wrong()
