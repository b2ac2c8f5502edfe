"""Quantities and durations that no machine has, wherever they are given: an InputError that names the entry."""

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest

from optlaws import (
    Axes,
    ConstantVelocity,
    Cycle,
    DiscCam,
    Drive,
    Dwell,
    Follower,
    Free,
    InputError,
    Loads,
    Machine,
    Mechanism,
    Motor,
    OptlawsError,
    Problem,
    Return,
    Rise,
    TranslatingRoller,
    advise,
    compare_laws,
    fastest,
    residual_vibration,
    smoothstep,
    time_front,
)

EXTREMES = (
    "5e-324",
    "1e-320",
    "1e-300",
    "1e-160",
    "1e-31",
    "1e-29",
    "1e29",
    "1e31",
    "1e160",
    "1e300",
    "1.7e308",
    "0",
    "-1",
    "-1e300",
    "nan",
    "inf",
)
LAW: dict[str, Any] = {"law": "cycloidal"}
ORDER_3 = Problem(order=3)


def rise_and_return(by: str = "35 mm", duration: str = "120 deg", **entries: Any) -> Cycle:
    clock: dict[str, Any] = {} if "speed" in entries or "period" in entries else {"period": "1 s"}
    return Cycle([Rise(by, duration, **LAW), Return(**LAW)], **clock, **entries)


def sought(by: str = "35 mm", duration: str = "120 deg", **entries: Any) -> Cycle:
    return Cycle([Rise(by, duration), Return()], **{"period": "1 s", **entries})


def smooth() -> Cycle:
    return Cycle([Rise("3 mm", "120 deg", law="III(7.2)"), Return(law="III(7.2)")], period="1 s")


def geared(inertia: str = "0.8 kg m^2", rotor: str = "3e-4 kg m^2", ratio: float = 20.0) -> Drive:
    return Drive(Mechanism(inertia), Motor(rotor, peak_torque="4 N m"), ratio=ratio)


def sheet(drive: Drive, stroke: Any = "45 deg") -> Any:
    return drive.sheet("cycloidal", 0.0, stroke, "0.2 s", period="1 s")


DOORS: dict[str, Callable[[str], Any]] = {
    "speed": lambda x: rise_and_return(speed=f"{x} rpm").peaks,
    "duration, angle": lambda x: rise_and_return(duration=f"{x} deg").peaks,
    "displacement": lambda x: rise_and_return(f"{x} mm").peaks,
    "start": lambda x: rise_and_return(start=f"{x} mm").peaks,
    "advance": lambda x: Cycle([Rise(f"{x} mm", **LAW), Dwell("9 deg")], period="1 s", advance=f"{x} mm").peaks,
    "constant velocity": lambda x: Cycle([ConstantVelocity(f"{x} m/s", "80 ms"), Return()], period="400 ms").objective,
    "limit of a given law": lambda x: rise_and_return(limits={"acceleration": f"{x} m/s^2"}).objective,
    "limit of optimal laws": lambda x: sought(limits={"velocity": f"{x} m/s"}).objective,
    "limit of the jerk": lambda x: sought(limits={"jerk": f"{x} m/s^3"}).objective,
    "mass": lambda x: rise_and_return(drive={"mass": f"{x} kg"}).effort,
    "stiffness": lambda x: rise_and_return(drive={"mass": "1 kg", "stiffness": f"{x} N/m"}).effort,
    "limit of the force": lambda x: rise_and_return(drive={"mass": "1 kg"}, limits={"force": f"{x} N"}).status,
    "limit of the rms force": lambda x: rise_and_return(drive={"mass": "1 kg"}, limits={"rms force": f"{x} N"}).status,
    "limit of the energy": lambda x: rise_and_return(drive={"mass": "1 kg"}, limits={"energy": f"{x} J"}).status,
    "period of a load": lambda x: rise_and_return(load={"period": f"{x} s"}).load_motion.peak("acceleration"),
    "another speed": lambda x: rise_and_return().at(f"{x} rpm").peaks,
    "greatest speed": lambda x: rise_and_return(limits={"jerk": f"{x} m/s^3"}).fastest(),
    "cam of a follower": lambda x: smooth().cam(f"{x} s"),
    "polynomials": lambda x: rise_and_return(period=f"{x} s").polynomials(),
    "axes": lambda x: Axes({"slide": [Rise("3 mm", "120 deg", **LAW), Return(**LAW)]}, period=f"{x} s")["slide"].peaks,
    "stroke of a move": lambda x: fastest(ORDER_3, stroke=f"{x} mm", limits={"jerk": "300 m/s^3"}),
    "limit of a move": lambda x: fastest(ORDER_3, stroke="9 mm", limits={"jerk": f"{x} m/s^3"}),
    "limits of a move": lambda x: fastest(ORDER_3, stroke="9 mm", limits={"velocity": "1 m/s", "jerk": f"{x} m/s^3"}),
    "velocity of a move": lambda x: fastest(
        ORDER_3, stroke="9 mm", start_velocity=f"{x} m/s", limits={"velocity": "1 m/s", "acceleration": "8 m/s^2"}
    ),
    "stroke of an export": lambda x: smoothstep(3).export("csv", stroke=f"{x} mm", duration="1 s"),
    "master of an export": lambda x: smoothstep(3).export("csv", stroke="35 mm", duration="1 s", master=f"{x} deg"),
    "master of a cycle": lambda x: rise_and_return().export("csv", master=f"{x} deg"),
    "stroke of a comparison": lambda x: compare_laws("cycloidal", stroke=f"{x} mm", duration="1 s").rows,
    "stroke of a sheet": lambda x: sheet(geared(), f"{x} deg"),
    "inertia": lambda x: sheet(geared(f"{x} kg m^2")),
    "inertia of a rotor": lambda x: sheet(geared(rotor=f"{x} kg m^2")),
    "ratio": lambda x: sheet(geared(ratio=float(x))),
    "loads": lambda x: Loads([("0 deg", "0 N"), ("90 deg", f"{x} N")], over="input"),
    "follower": lambda x: Follower(frequency=float(x)).response(smoothstep(4)),
    "prime circle": lambda x: DiscCam(rise_and_return(), f"{x} mm", TranslatingRoller("12 mm")).extremes,
    "roller": lambda x: DiscCam(rise_and_return(), "60 mm", TranslatingRoller(f"{x} mm")).extremes,
}  # fmt: skip


@pytest.mark.sample(4)
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("first", range(4))
@pytest.mark.parametrize("door", DOORS)
def test_a_quantity_of_no_machine_ends_in_an_error_of_ours_if_in_any(door: str, first: int) -> None:
    for value in EXTREMES[first::4]:
        try:
            DOORS[door](value)
        except OptlawsError as error:
            # what it names is the user's: no array, no number of an inner formula
            assert not any(word in str(error) for word in ("array(", "np.float64", "division", "NaN")), value  # noqa: PT017


# --- durations ---


SMOOTHSTEP = smoothstep(3)
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


DURATIONS: dict[str, Callable[[Any], object]] = {
    "period of a cycle": lambda time: cycle(rise("120 deg"), period=time),
    "load of a cycle": lambda time: Cycle([rise("120 deg"), Return()], period=time, drive={"mass": "2 kg"}).effort,
    "rise": lambda time: cycle(rise(time), period="1 s"),
    "optimal rise": lambda time: cycle(Rise("35 mm", time), period="1 s"),
    "dwell": lambda time: cycle(rise("0.1 s"), Dwell(time), period="1 s"),
    "constant velocity": lambda time: cycle(rise("0.1 s"), ConstantVelocity("10 mm/s", time), period="1 s"),
    "free": lambda time: cycle(rise("0.1 s"), Free("10 mm", time), rise("0.1 s"), period="1 s"),
    "sheet": lambda time: DRIVE.sheet(SMOOTHSTEP, *MOVE, time),
    "period of a sheet": lambda time: DRIVE.sheet(SMOOTHSTEP, *MOVE, "0.25 s", period=time),
    "best ratio": lambda time: DRIVE.best_ratio(SMOOTHSTEP, *MOVE, time),
    "formulas": lambda time: DRIVE.dimensionless(*MOVE, time),
    "limit of a drive": lambda time: DRIVE.limit("peak torque", *MOVE, time),
    "limit of a mechanism": lambda time: TABLE.limit("energy", *MOVE, time),
    "follower": lambda time: Follower.from_units(mass=2.0, stiffness=1e4, duration=time),
    "follower of a vibration": lambda time: Follower.from_vibration("10 Hz", duration=time),
    "period of a vibration": lambda time: Follower.from_vibration(time, duration="0.1 s"),
    "follower in units": lambda time: Follower(20).response(SMOOTHSTEP).in_units("35 mm", duration=time),
    "machine": lambda time: Machine.from_units(*SPRING, duration=time, outputs=["x"]).residual().value(SMOOTHSTEP),
    "export": lambda time: SMOOTHSTEP.export("csv", stroke="35 mm", duration=time),
    "pieces": lambda time: SMOOTHSTEP.pieces("35 mm", time),
    "comparison": lambda time: str(compare_laws("cycloidal", SMOOTHSTEP, stroke="35 mm", duration=time)),
    "spectrum": lambda time: residual_vibration(spectrum=[(10, 1), (20, 1)], duration=time).value(SMOOTHSTEP),
    "longest time": lambda time: time_front(
        fastest(Problem(order=3), stroke="0.3 m", limits=LIMITS), "jerk", longest=time, points=2
    ),
    "run-in": lambda time: rise_and_return().run_in("60 deg", rest="-2 mm", over=time),
    "advice": lambda time: advise(rise_and_return(period=time), laws=("cycloidal",), points=0),
    "law in a time": lambda time: fastest(Problem(order=3), stroke="0.3 m", limits=LIMITS).within(time),
}
IMPOSSIBLE = ["1e-300 s", "1e-320 s", "1e300 s", "0 s", "-1 s", "nan s", "inf s", "1e-300 ms", 1e-300, 1e300, 0.0, -1.0]


@pytest.mark.parametrize("door", DURATIONS)
def test_an_impossible_duration_is_refused_by_its_name(door: str) -> None:
    for time in (*IMPOSSIBLE, float("nan")):
        with pytest.raises(InputError, match=r"duration|period|longest|vibration|^time|over"):
            DURATIONS[door](time)
    for time in ("1e-29 s", "1e29 s"):
        with suppress(OptlawsError):  # taken, or refused in words
            DURATIONS[door](time)
