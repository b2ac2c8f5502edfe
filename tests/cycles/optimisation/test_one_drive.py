"""A drive said as constants, as a mechanism or as motor, gear and mechanism: objectives, bounds, refusals are equal."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    ConstantVelocity,
    Cycle,
    Drive,
    Dwell,
    Free,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    Return,
    Rise,
)
from tests.sampling import examples

LIMITS = {"acceleration": "60 m/s^2"}
CAM = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()]
SHEAR = [ConstantVelocity("1.5 m/s", "80 ms"), Return()]
SWINGS = [Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")]
#: of a low degree: that two are equal is no matter of how near they are to the optimum
TIMES: dict[str, dict[str, Any]] = {
    "cam": {"speed": "200 rpm", "degree": 3},
    "shear": {"period": "400 ms", "degree": 7},
    "swings": {"period": "0.5 s", "degree": 3},
}
MOTIONS = {"cam": CAM, "shear": SHEAR, "swings": SWINGS}

ENTRIES: dict[str, dict[str, str]] = {
    "mass": {"mass": "2 kg"},
    "weight": {"mass": "2 kg", "gravity": "19.6 N"},
    "rubbed weight": {"mass": "2 kg", "gravity": "19.6 N", "dry": "5 N"},
    "lifted": {"mass": "2 kg", "gravity": "-19.6 N", "viscous": "3 N s/m"},
    "spring": {"mass": "0.5 kg", "stiffness": "2 N/mm", "preload": "20 N", "viscous": "8 N s/m"},
    "damper": {"viscous": "30 N s/m", "dry": "2 N"},
}
#: the same mechanisms, in other words
WRITTEN: dict[str, tuple[str, Any, dict[str, Any]]] = {
    "mass": ("2 kg", 0.0, {}),
    "weight": ("1 + 1", "2*9.8", {}),
    "rubbed weight": ("2 kg", "19.6 N", {"coulomb": "5 N"}),
    "lifted": ("2", "x - 19.6 - x*4/4", {"viscous": "3 N s/m"}),
    "spring": ("0.5 kg", "2000*(x + 0.01)", {"viscous": "8 N s/m"}),
    "damper": ("0 kg", "0 N", {"coulomb": "2 N", "viscous": "30 N s/m"}),
}


def outcome(motion: str, drive: Any, motions: Any = MOTIONS, **entries: Any) -> tuple[Any, ...]:
    """Status, objective, bound and efforts; of a refusal what it says."""
    try:
        cycle = Cycle(motions[motion], **{**TIMES[motion], **entries}, drive=drive)
        effort = cycle.effort
    except (InputError, InfeasibleProblem) as error:
        return type(error).__name__, error.args[0]
    return cycle.status, cycle.objective, cycle.lower_bound, effort.peak_force, effort.rms_force, effort.energy


TURNS = {
    "cam": [Rise("35 deg", "120 deg"), Dwell("90 deg"), Return("35 deg", "100 deg"), Dwell()],
    "shear": [ConstantVelocity("1.5 rad/s", "80 ms"), Return()],
    "swings": [Dwell("0.1 s"), Free("30 deg", "0.2 s"), Free("-30 deg")],
}
#: what is least, within limits at the motor, and whether it counts with the speed of the motor
AT_MOTOR: list[tuple[str, dict[str, str], bool]] = [
    ("torque", {}, False),
    ("rms torque", {}, False),
    ("acceleration", {"torque": "70 N m"}, False),
    ("rms torque", {"velocity": "3.2 rad/s", "acceleration": "800 rad/s^2"}, False),
    ("torque", {"rms torque": "40 N m"}, False),
    ("power", {}, True),
    ("energy", {"acceleration": "800 rad/s^2"}, True),
]
_SIZE = st.floats(0.01, 1.0)
_OR_NONE = st.just(0.0) | _SIZE


@given(st.data(), st.sampled_from(AT_MOTOR), st.sampled_from(sorted(TURNS)))
@examples(14)
def test_one_drive_by_constants_mechanism_and_gear_has_one_answer(
    data: st.DataObject, asked: tuple[str, dict[str, str], bool], motion: str
) -> None:
    minimise, limits, by_speed = asked
    if by_speed and motion != "cam":
        motion = "cam"  # a product of many pieces takes minutes, however it is said
    ratio, share = data.draw(st.sampled_from([1.0, 0.5, 20.0]), "ratio"), data.draw(st.floats(0.0, 1.0), "of the motor")
    inertia, viscous, dry = data.draw(_SIZE, "inertia"), data.draw(_OR_NONE, "viscous"), data.draw(_OR_NONE, "dry")
    stiffness, gravity = data.draw(_OR_NONE, "stiffness"), data.draw(_OR_NONE, "gravity")
    load, back = (f"{gravity * ratio!r} + {stiffness * ratio!r}*x", data.draw(st.sampled_from([0.0, 0.5, 1.0]), "fed"))
    rest = (1.0 - share) * ratio
    geared = Drive(
        Mechanism(inertia * rest, load, viscous=viscous * rest, coulomb=dry * rest),
        Motor(inertia * share / ratio, viscous=viscous * share / ratio, coulomb=dry * share),
        ratio,
        regeneration=back,
    )
    constants = {
        "inertia": f"{inertia!r} kg m^2",
        "viscous": f"{viscous!r} N m s/rad",
        "dry": f"{dry!r} N m",
        "stiffness": f"{stiffness!r} N m/rad",
        "gravity": f"{gravity!r} N m",
        "regeneration": back,
    }
    said: list[Any] = [constants, geared]
    if not back or minimise != "energy":
        said.append(Mechanism(inertia, f"{gravity!r} + {stiffness!r}*x", viscous=viscous, coulomb=dry))
    first, second, *third = (outcome(motion, drive, TURNS, minimise=minimise, limits=limits) for drive in said)
    if len(first) > 2:
        speed = ratio if by_speed else 1.0
        second = (second[0], *(None if value is None else value / speed for value in second[1:3]), *second[3:5])
        first, third = first[:5], [other[:5] for other in third]
    for other in (second, *third):
        agree(first, other, rel=1e-6)


def test_a_motor_turns_back_within_its_curve() -> None:
    curve = [("0 rad/s", "18 N m"), ("40 rad/s", "2 N m")]
    drive = Drive(Mechanism("0.5 kg m^2"), Motor("0.01 kg m^2", curve=curve), ratio=10)
    back = TURNS["swings"][2:]
    partly = [Dwell("0.1 s"), Free("30 deg", "0.2 s", limits={"acceleration": "90 rad/s^2"}), *back]
    limited, also = (
        Cycle(ways, **TIMES["swings"], drive=drive, limits={"motor": True}) for ways in (TURNS["swings"], partly)
    )
    (solution,) = limited.solutions
    assert also.objective == pytest.approx(limited.objective, rel=1e-9)
    assert solution.status.value == "optimal"
    assert limited.sheet.fits
    free = Cycle(TURNS["swings"], **TIMES["swings"], drive=drive)
    assert not free.sheet.fits
    assert limited.objective > free.objective


def agree(first: tuple[Any, ...], second: tuple[Any, ...], rel: float = 1e-9) -> None:
    assert len(first) == len(second)
    assert first[0] == second[0], (first, second)
    for one, other in zip(first[1:], second[1:], strict=True):
        assert one == (other if isinstance(other, str) or other is None else pytest.approx(other, rel=rel, abs=rel))


def mechanism(name: str) -> Mechanism:
    inertia, load, friction = WRITTEN[name]
    return Mechanism(inertia, load, axis="length", **friction)


@pytest.mark.sample(16)
@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("name", ENTRIES)
@pytest.mark.parametrize("what", ["force", "rms force", "power", "energy", "acceleration"])
def test_one_drive_in_two_words_has_one_answer(motion: str, name: str, what: str) -> None:
    if (motion, what) in {("swings", "power"), ("swings", "energy"), ("shear", "energy")}:
        pytest.skip("a product of many pieces takes minutes, either way it is said")
    limits = LIMITS if what == "energy" else {}
    both = [outcome(motion, drive, minimise=what, limits=limits) for drive in (ENTRIES[name], mechanism(name))]
    agree(both[0], both[1])


@pytest.mark.sample(12)
@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("name", ["mass", "spring", "damper"])
@pytest.mark.parametrize(
    ("minimise", "limits"),
    [
        ("acceleration", {"force": "90 N"}),
        ("rms force", {"velocity": "3 m/s"}),
        ("force", {"rms force": "45 N"}),
        ("rms acceleration", {"force": "1 N"}),
    ],
)
def test_limits_of_one_drive_in_two_words_are_one(
    motion: str, name: str, minimise: str, limits: dict[str, str]
) -> None:
    both = [outcome(motion, drive, minimise=minimise, limits=limits) for drive in (ENTRIES[name], mechanism(name))]
    agree(both[0], both[1])


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", ["rubbed weight", "spring"])
def test_the_fastest_cycle_is_one(name: str) -> None:
    def fastest(drive: Any) -> Any:
        return Cycle(CAM, speed="60 rpm", drive=drive, limits={"force": "120 N"}).fastest()

    first, second = fastest(ENTRIES[name]), fastest(mechanism(name))
    assert first.status == second.status
    assert first.cycle.duration == pytest.approx(second.cycle.duration, rel=1e-9)


def test_a_process_acts_on_constants_too() -> None:
    pushed = {"force": {"0 deg": "0 N", "180 deg": "-30 N", "360 deg": "0 N"}, "over": "master"}
    first, second = (
        Cycle(CAM, **TIMES["cam"], minimise="rms force", drive=drive, load=pushed)
        for drive in (ENTRIES["spring"], mechanism("spring"))
    )
    assert first.objective == pytest.approx(second.objective, rel=1e-12)


def test_a_range_of_the_mechanism_is_kept() -> None:
    ranged = Mechanism("2 kg", "19.6 N", over=("0 mm", "35 mm"))
    ways: dict[str, Any] = TIMES["cam"] | {"minimise": "rms force"}
    cycle, known = (Cycle(CAM, **ways, drive=drive) for drive in (ranged, ENTRIES["weight"]))
    assert cycle.lower_bound == pytest.approx(known.lower_bound, rel=1e-9)
    with pytest.raises(InputError, match=r"may turn back and leave the range of the mechanism: .* leave out its over="):
        Cycle(SWINGS, period="0.5 s", minimise="force", drive=ranged).objective  # noqa: B018 - solved when it is read


def test_tables_on_a_line_are_lines() -> None:
    table = Mechanism({"0 mm": "2 kg", "10 mm": "2 kg", "20 mm": "2 kg", "40 mm": "2 kg"},
        {"0 mm": "10 N", "20 mm": "30 N", "40 mm": "50 N"}, axis="length")  # fmt: skip
    known = {"mass": "2 kg", "stiffness": "1 N/mm", "preload": "10 N"}
    agree(outcome("cam", table, minimise="rms force"), outcome("cam", known, minimise="rms force"))


@pytest.mark.sample(3)
@pytest.mark.parametrize("what", ["force", "rms force", "power"])
def test_a_constant_force_is_a_weight_and_one_over_the_way_a_spring(what: str) -> None:
    motion, spring = "cam" if what == "power" else "swings", "300 N/m"
    held = {"mass": "2 kg", "gravity": "19.6 N", "stiffness": spring}
    pushed = Cycle(MOTIONS[motion], **TIMES[motion], minimise=what, drive={"mass": "2 kg"},
        load={"force": "-19.6 - 300*x", "over": "input"})  # fmt: skip
    weighed = Cycle(MOTIONS[motion], **TIMES[motion], minimise=what, drive={"mass": "2 kg", "stiffness": spring},
        load={"force": "-19.6 N"})  # fmt: skip
    known = outcome(motion, held, minimise=what)
    for cycle in (pushed, weighed):
        agree((cycle.status, cycle.objective, cycle.lower_bound), known[:3])


@pytest.mark.parametrize("rests", [True, pytest.param(False, marks=pytest.mark.long)])
def test_the_limits_of_a_motor_make_one_fastest_cycle(rests: bool) -> None:  # noqa: FBT001 - a case
    ratio, rubs = 5.0, 0.08 if rests else 0.0
    table = Mechanism("0.5 kg m^2", 3.0 if rests else 0.0, coulomb=ratio * rubs)
    drive = Drive(table, Motor("0.01 kg m^2", peak_torque="3 N m", greatest_speed="30 rad/s"), ratio)
    known = {"inertia": "0.15 kg m^2", "gravity": f"{0.6 if rests else 0.0} N m", "dry": f"{rubs} N m"}
    moves = TURNS["cam"] if rests else [Free("35 deg", "120 deg"), Free("-35 deg", "120 deg"), Dwell()]
    first, second = (
        Cycle(moves, speed="60 rpm", drive=said, limits=limits, degree=5 if rests else 3).fastest()
        for said, limits in ((drive, {"motor": True}), (known, {"torque": "3 N m", "velocity": "6 rad/s"}))
    )
    assert (first.status, first.binding) == (second.status, second.binding)
    assert first.period == pytest.approx(second.period, rel=1e-9)


@pytest.mark.parametrize("regeneration", [0.0, 1.0])
def test_motions_that_turn_back_burn_no_more_heat_than_those_of_the_least_rms_torque(regeneration: float) -> None:
    """The copper heat is that of the root mean square: where all braking is fed back both have the same laws."""
    motor = Motor("0.01 kg m^2", constant=0.3)
    drive = Drive(Mechanism("0.5 kg m^2", "1.5 N m"), motor, ratio=5, regeneration=regeneration)
    heat, rms = (
        Cycle(TURNS["swings"], **TIMES["swings"], drive=drive, minimise=what) for what in ("heat", "rms torque")
    )
    known = rms.value("heat")
    assert heat.objective == pytest.approx(known, rel=1e-8) if regeneration else heat.objective < known
    assert heat.lower_bound is not None
    assert heat.lower_bound <= heat.objective * (1.0 + 1e-9)
    copper = rms.effort.rms_force**2 * rms.duration / 0.3**2
    assert known == pytest.approx(copper + (1.0 - regeneration) * rms.effort.braking_energy)
