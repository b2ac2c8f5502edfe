"""Durations that cannot be, wherever one is given: an InputError that names the entry, and no error from inside."""

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest

from optlaws import (
    ConstantVelocity,
    Cycle,
    Drive,
    Dwell,
    Follower,
    Free,
    InputError,
    Machine,
    Mechanism,
    Motor,
    OptlawsError,
    Problem,
    Return,
    Rise,
    compare_laws,
    fastest,
    residual_vibration,
    smoothstep,
    time_front,
)

LAW = smoothstep(3)
TABLE = Mechanism("0.8 kg m^2")
DRIVE = Drive(TABLE, Motor("3e-4 kg m^2", peak_torque="6 N m"), ratio=20)
MOVE = ("0 deg", "45 deg")
SPRING: Any = ([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]])
LIMITS = {"acceleration": "10 m/s^2"}


def cycle(*segments: Any, **given: Any) -> str:
    known = Cycle([*segments, Return(law="cycloidal")], **given)
    return f"{known} {known.peaks}"


def rise(duration: Any) -> Rise:
    return Rise("35 mm", duration, law="cycloidal")


DOORS: dict[str, Callable[[Any], object]] = {
    "period of a cycle": lambda time: cycle(rise("120 deg"), period=time),
    "load of a cycle": lambda time: Cycle([rise("120 deg"), Return()], period=time, drive={"mass": "2 kg"}).effort,
    "rise": lambda time: cycle(rise(time), period="1 s"),
    "optimal rise": lambda time: cycle(Rise("35 mm", time), period="1 s"),
    "dwell": lambda time: cycle(rise("0.1 s"), Dwell(time), period="1 s"),
    "constant velocity": lambda time: cycle(rise("0.1 s"), ConstantVelocity("10 mm/s", time), period="1 s"),
    "free": lambda time: cycle(rise("0.1 s"), Free("10 mm", time), rise("0.1 s"), period="1 s"),
    "sheet": lambda time: DRIVE.sheet(LAW, *MOVE, time),
    "period of a sheet": lambda time: DRIVE.sheet(LAW, *MOVE, "0.25 s", period=time),
    "best ratio": lambda time: DRIVE.best_ratio(LAW, *MOVE, time),
    "formulas": lambda time: DRIVE.dimensionless(*MOVE, time),
    "limit of a drive": lambda time: DRIVE.limit("peak torque", *MOVE, time),
    "limit of a mechanism": lambda time: TABLE.limit("energy", *MOVE, time),
    "follower": lambda time: Follower.from_units(mass=2.0, stiffness=1e4, duration=time),
    "follower of a vibration": lambda time: Follower.from_vibration("10 Hz", duration=time),
    "period of a vibration": lambda time: Follower.from_vibration(time, duration="0.1 s"),
    "follower in units": lambda time: Follower(20).response(LAW).in_units("35 mm", duration=time),
    "machine": lambda time: Machine.from_units(*SPRING, duration=time, outputs=["x"]).residual().value(LAW),
    "export": lambda time: LAW.export("csv", stroke="35 mm", duration=time),
    "pieces": lambda time: LAW.pieces("35 mm", time),
    "comparison": lambda time: str(compare_laws("cycloidal", LAW, stroke="35 mm", duration=time)),
    "spectrum": lambda time: residual_vibration(spectrum=[(10, 1), (20, 1)], duration=time).value(LAW),
    "longest time": lambda time: time_front(
        fastest(Problem(order=3), stroke="0.3 m", limits=LIMITS), "jerk", longest=time, points=2
    ),
    "law in a time": lambda time: fastest(Problem(order=3), stroke="0.3 m", limits=LIMITS).within(time),
}
IMPOSSIBLE = ["1e-300 s", "1e-320 s", "1e300 s", "0 s", "-1 s", "nan s", "inf s", "1e-300 ms", 1e-300, 1e300, 0.0, -1.0]


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("time", [*IMPOSSIBLE, float("nan")])
def test_an_impossible_duration_is_refused_by_its_name(door: str, time: Any) -> None:
    with pytest.raises(InputError, match=r"duration|period|longest|vibration|^time"):
        DOORS[door](time)


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("time", ["1e-29 s", "1e29 s"])
def test_an_extreme_duration_is_taken_or_refused_in_words(door: str, time: str) -> None:
    with suppress(OptlawsError):
        DOORS[door](time)
