"""A cycle or a move whose strokes and limits are multiplied alike is the same problem, as its status and numbers say.

All objectives and limits that the library's own tables name are tried, alone and together.
"""

from collections.abc import Mapping
from typing import Any

import pytest

from optlaws import Cycle, Drive, Dwell, InfeasibleProblem, Mechanism, Motor, Problem, Return, Rise, fastest, time_front
from tests.internals.cycles import LIMITS_OF_CYCLE, LIMITS_OF_MOVE, OBJECTIVES, OBJECTIVES_OF_MOVES
from tests.sampling import sampled

SCALES = (1.1, 1.0001, 1e-12, 1e-6, 1e9)
MOTOR = Motor("3e-4 kg m^2", constant=0.3)

#: limits of strokes of 35 mm or deg, and the power of the strokes with which each grows
LIMITS: dict[str, tuple[float, str, str, int]] = {
    "velocity": (650.0, "mm/s", "deg/s", 1),
    "acceleration": (26.0, "m/s^2", "rad/s^2", 1),
    "deceleration": (26.0, "m/s^2", "rad/s^2", 1),
    "jerk": (2500.0, "m/s^3", "rad/s^3", 1),
    "snap": (6e5, "m/s^4", "rad/s^4", 1),
    "force": (52.0, "N", "", 1),
    "torque": (0.5, "", "N m", 1),
    "power": (25.0, "W", "W", 2),
    "rms force": (25.0, "N", "", 1),
    "rms torque": (0.25, "", "N m", 1),
    "energy": (20.0, "J", "J", 2),
}
#: what has no limit of its own that is multiplied: a motor has torques, speeds and an inertia
NOT_SCALED = {"motor"}
#: with what an objective has a least value
NEEDS = {"energy": ("acceleration",)}


def entries_of(names: tuple[str, ...], scale: float, *, turns: bool) -> dict[str, str]:
    read = ((name, LIMITS[name]) for name in names)
    return {
        name: f"{value * scale**grows!r} {angle if turns else length}" for name, (value, length, angle, grows) in read
    }


def cycle(minimise: str, names: tuple[str, ...], scale: float) -> Cycle:
    turns = any("torque" in name or name == "heat" for name in (minimise, *names))
    stroke = f"{35.0 * scale!r} {'deg' if turns else 'mm'}"
    segments: list[Any] = [Rise(stroke, "120 deg"), Dwell("90 deg"), Return(stroke, "100 deg"), Dwell()]
    drive: Any = {"inertia": "0.005 kg m^2"} if turns else {"mass": "2 kg"}
    if minimise == "heat":
        drive = Drive(Mechanism("0.005 kg m^2"), MOTOR, ratio=20, regeneration=0.5)
    limits = entries_of((*NEEDS.get(minimise, ()), *names), scale, turns=turns)
    return Cycle(segments, speed="200 rpm", minimise=minimise, limits=limits, drive=drive)


def outcome(minimise: str, names: tuple[str, ...], scale: float) -> tuple[str, float, float]:
    """The status, the objective and its bound; of a cycle without laws nothing but that."""
    try:
        best = cycle(minimise, names, scale)
        unit = scale ** (2 if minimise in {"power", "energy", "heat"} else 1)
        bound = best.lower_bound
        return str(best.status), best.objective / unit, 0.0 if bound is None else bound / unit
    except InfeasibleProblem:
        return "infeasible", 0.0, 0.0


CASES: list[tuple[str, tuple[str, ...]]] = [
    *((name, ()) for name in OBJECTIVES),
    *(("jerk", (name,)) for name in LIMITS_OF_CYCLE.entries if name not in NOT_SCALED),
    *((name, ("velocity",)) for name in ("acceleration", "rms acceleration", "rms jerk", "power", "energy")),
    *((name, ("jerk",)) for name in ("acceleration", "rms acceleration", "force", "rms torque")),
]


def test_every_limit_is_tried() -> None:
    assert {*LIMITS, *NOT_SCALED} == {*LIMITS_OF_CYCLE.entries}


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize(("minimise", "names"), sampled(CASES, 15))
def test_strokes_in_another_scale_change_no_status(minimise: str, names: tuple[str, ...], scale: float) -> None:
    (status, objective, bound), other = outcome(minimise, names, 1.0), outcome(minimise, names, scale)
    assert other[0] == status
    assert other[1] == pytest.approx(objective, rel=1e-9)
    # of what is not convex the bound is the best that a search over multipliers met: that of an energy ends at 1.4e-8
    assert other[2] == pytest.approx(bound, rel=1e-8 if status == "optimal" else 1e-7)


#: limits of a stroke of 100 mm
MOVES: list[Mapping[str, tuple[float, str]]] = [
    {"velocity": (1000.0, "mm/s"), "acceleration": (12.0, "m/s^2"), "jerk": (300.0, "m/s^3")},
    {"velocity": (700.0, "mm/s"), "acceleration": (8.0, "m/s^2"), "deceleration": (5.0, "m/s^2")},
    {"jerk": (300.0, "m/s^3")},
    {"acceleration": (8.0, "m/s^2"), "snap": (9000.0, "m/s^4")},
]


def least_time(limits: Mapping[str, tuple[float, str]], scale: float) -> Any:
    read = {key: f"{value * scale!r} {unit}" for key, (value, unit) in limits.items()}
    return fastest(Problem(order=3), stroke=f"{100.0 * scale!r} mm", limits=read)


def test_every_limit_of_a_move_is_tried() -> None:
    assert {name for move in MOVES for name in move} == {*LIMITS_OF_MOVE.entries} - {
        "torque",
        "rms torque",
        "residual acceleration",
        "residual displacement",
    }


@pytest.mark.sample(4)
@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("limits", MOVES)
def test_the_least_time_is_of_no_scale(limits: Mapping[str, tuple[float, str]], scale: float) -> None:
    one, other = least_time(limits, 1.0), least_time(limits, scale)
    assert other.binding == one.binding
    assert other.duration == pytest.approx(one.duration, rel=1e-9)
    assert other.best_possible == pytest.approx(one.best_possible, rel=1e-8)


@pytest.mark.long
@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("minimise", [name for name in OBJECTIVES_OF_MOVES if name != "velocity"])
def test_fronts_over_time_are_of_no_scale(minimise: str, scale: float) -> None:
    fronts = [time_front(least_time(MOVES[0], times), minimise, points=5) for times in (1.0, scale)]
    assert fronts[1].status == fronts[0].status
    for one, other in zip(*(front.points for front in fronts), strict=True):
        assert other.duration == pytest.approx(one.duration, rel=1e-9)
        assert other.value / scale == pytest.approx(one.value, rel=1e-9)
