"""Overlaps of moves whose laws are sought: each by its own fastest or gentlest law, beside other searches for them."""

from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from optlaws import (
    After,
    Axes,
    Cycle,
    Dwell,
    Forbidden,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Return,
    Rise,
    catalogue,
)

CYCLOID: Any = catalogue["cycloidal"].law
LIMITS = {"acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}


def least_time(stroke: str, limits: dict[str, Any], **given: Any) -> float:
    """Of a single move, by the search for the fastest cycle."""
    alone = Cycle([Rise(stroke, "180 deg"), Dwell()], advance=stroke, period="1 s", limits=limits, **given)
    return float(alone.fastest().segments[0].least)


@settings(max_examples=12)
@given(
    size=st.sampled_from([1e-12, 1e-6, 1.0, 1e9]),
    times=st.tuples(*[st.floats(1e-3, 1e3)] * 2),
    dwell=st.just(0.0) | st.floats(1e-9, 2.0),
    limited=st.sampled_from([("acceleration", "jerk"), ("velocity", "jerk"), ("jerk",), ("acceleration",)]),
)
@example(size=1e-12, times=(191.0, 1000.0), dwell=1.2e-7, limited=("acceleration", "jerk"))
def test_an_axis_without_interlocks_takes_its_own_least_times(
    size: float, times: tuple[float, float], dwell: float, limited: tuple[str, ...]
) -> None:
    """Whatever the size of its stroke, the times that it had, and which limits it has."""
    unit = {"velocity": ("m/s", 3.0), "acceleration": ("m/s^2", 20.0), "jerk": ("m/s^3", 400.0)}
    limits = {name: f"{unit[name][1] * size!r} {unit[name][0]}" for name in limited}
    there, back = Rise(f"{size!r} m", f"{times[0]!r} s"), Return(None, f"{times[1]!r} s")
    waits = Dwell(f"{dwell + 1.0!r} s", least=f"{dwell!r} s")
    # limits that the times of the given diagram may break: it is to be faster, or as slow as it has to be
    alone: Any = {"slide": {"segments": [there, waits, back, Dwell("0.1 s")], "limits": limits}}
    best = Axes(alone, period=f"{sum(times) + dwell + 1.1!r} s").fastest()
    known = 2.0 * least_time(f"{size!r} m", limits) + dwell + 0.1
    assert best.status == "optimal"
    assert best.objective == pytest.approx(known, rel=1e-7)
    assert best.lower_bound <= known * (1.0 + 1e-9)
    assert best.axes["slide"].duration == pytest.approx(best.objective, rel=1e-12)
    for name, nu in (("velocity", 1), ("acceleration", 2), ("jerk", 3)):
        if name in limited:
            assert best.axes["slide"].peak(nu) <= unit[name][1] * size


def pick_and_place(degree: int = 9) -> Axes:
    """Two axes around a hill, with limits of acceleration and jerk and no laws."""
    hill = [("1 mm", "0 mm"), ("299 mm", "0 mm"), ("299 mm", "5 mm"), ("250 mm", "60 mm"), ("50 mm", "40 mm"),
            ("1 mm", "5 mm")]  # fmt: skip
    wait: Any = Dwell("0.4 s", least="0 s")
    up, down, off = Rise("80 mm", "0.2 s"), Return("80 mm", "0.2 s"), Dwell("50 ms")
    x = [wait, Rise("300 mm", "0.3 s"), wait, Return("300 mm", "0.3 s"), Dwell()]
    z = [up, wait, down, off, up, wait, down, off]
    axes: Any = {name: {"segments": each, "limits": LIMITS, "degree": degree} for name, each in (("x", x), ("z", z))}
    return Axes(axes, period="1.7 s", interlocks=[Forbidden("x", "z", hill, name="hill")])


@pytest.mark.parametrize(("degree", "period"), [(9, 0.6717), (21, 0.6642)])
def test_two_axes_around_a_hill_overlap(degree: int, period: float) -> None:
    best = pick_and_place(degree).fastest()
    times = [least_time(stroke, LIMITS, degree=degree) for stroke in ("300 mm", "80 mm")]
    assert (best.status, best.axes.broken) == ("optimal", ())
    assert best.objective == pytest.approx(period, abs=5e-5)
    # beside each axis alone, and one move after the other
    assert 4.0 * times[1] + 0.1 < best.objective < 2.0 * times[0] + 4.0 * times[1] + 0.1
    for axis in best.axes.values():
        assert axis.peak(2) <= 20.0
        assert axis.peak(3) <= 2000.0
    assert best.axes["x"].durations[1] == pytest.approx(times[0], rel=1e-7)


@settings(max_examples=10)
@given(
    strokes=st.tuples(*[st.floats(10.0, 90.0)] * 2),
    shares=st.tuples(*[st.floats(0.05, 0.95)] * 2),
    jerk=st.floats(100.0, 1e4),
)
def test_what_can_move_in_turn_is_never_refused(
    strokes: tuple[float, float], shares: tuple[float, float], jerk: float
) -> None:
    """A die that is open before its table moves, and closes after it, keeps interlocks of any two positions."""
    die, table = (f"{stroke!r} mm" for stroke in strokes)
    above, early = (f"{stroke * share!r} mm" for stroke, share in zip(strokes, shares, strict=True))
    rules = [After("table", early, of="die", above=above), After("die", above, of="table", above=early, way="down")]
    limits = {"acceleration": "9 m/s^2", "jerk": f"{jerk!r} m/s^3"}
    waits = Dwell("0.4 s", least="0 s")
    axes: Any = {
        "table": {"segments": [waits, Rise(table, "0.3 s"), Dwell()], "advance": table, "limits": limits},
        "die": {"segments": [Rise(die, "0.2 s"), waits, Return(None, "0.2 s"), Dwell()], "limits": limits},
    }
    best = Axes(axes, period="1.2 s", interlocks=rules).fastest()
    in_turn = 2.0 * least_time(die, limits) + least_time(table, limits)
    assert (best.status, best.axes.broken) == ("optimal", ())
    assert 2.0 * least_time(die, limits) * (1.0 - 1e-9) <= best.objective <= in_turn * (1.0 + 1e-7)


BOX = [("0 mm", "50 mm"), ("40 mm", "50 mm"), ("40 mm", "250 mm"), ("0 mm", "250 mm")]
DWELL = 0.1


def gripper(**limits: str) -> Axes:
    """A gripper that goes up and down twice by a cycloid, and a slide that passes over a box as gently as can be."""
    up, down = Rise("80 mm", "0.2 s", law="cycloidal"), Return("80 mm", "0.2 s", law="cycloidal")
    z = [up, Dwell("0.15 s"), down, Dwell("0.1 s"), up, Dwell("0.15 s"), down, Dwell("0.1 s")]
    wait = Dwell("0.2 s", least="0 s")
    x = [wait, Rise("300 mm", "0.3 s"), Dwell("0.2 s", least=f"{DWELL} s"), Return("300 mm", "0.3 s"), Dwell()]
    axes: Any = {"z": z, "x": {"segments": x, "limits": limits}}
    return Axes(axes, period="1.3 s", interlocks=[Forbidden("z", "x", BOX, name="box")])


def least_acceleration(instant: float) -> float:
    """Of a slide that begins to rest at an instant: a linear program in accelerations that are constant over parts."""
    period, parts = 1.3, 130
    step = period / parts
    times = step * np.arange(parts + 1)
    # position and velocity at knots as sums of accelerations
    since = times[:, None] - times[None, :-1]
    velocity = np.where(since > 0.0, step, 0.0)
    position = np.where(since > 0.0, step * (since - 0.5 * step), 0.0)
    lift = 0.2 * CYCLOID.where(0.5)[0]
    left = (times <= lift + 1e-9) | (times >= 1.2 - lift - 1e-9)
    right = (times >= 0.55 - lift - 1e-9) & (times <= 0.65 + lift + 1e-9)
    rest = (times >= instant - 1e-9) & (times <= instant + DWELL + 1e-9)
    rows, sides = [], []
    for row, side in ((position[left], 0.05), (-position[right], -0.25), (-position, 0.0), (position, 0.3)):
        rows.append(np.column_stack([row, np.zeros(len(row))]))
        sides.append(np.full(len(row), side))
    for sign in (1.0, -1.0):
        rows.append(np.column_stack([sign * np.eye(parts), -np.ones(parts)]))
        sides.append(np.zeros(parts))
    same = np.vstack([position[rest], velocity[rest], position[-1:], velocity[-1:]])
    equal = np.concatenate([np.full(rest.sum(), 0.3), np.zeros(rest.sum() + 2)])
    solve: Any = linprog
    answer = solve(
        np.eye(parts + 1)[-1],
        A_ub=np.vstack(rows),
        b_ub=np.concatenate(sides),
        A_eq=np.column_stack([same, np.zeros(len(same))]),
        b_eq=equal,
        bounds=[(None, None)] * parts + [(0.0, None)],
    )
    return float(answer.fun) if answer.status == 0 else np.inf


@pytest.mark.parametrize("limits", [{}, {"jerk": "400 m/s^3"}, {"jerk": "450 m/s^3", "velocity": "1.8 m/s"}])
def test_the_gentlest_laws_keep_limits_and_interlocks(limits: dict[str, str]) -> None:
    before = gripper(**limits)
    best = before.gentlest("x")
    slide = best.axes["x"]
    assert [least.status for least in best.axes.clearances] == ["clear"]
    assert slide.peak(2) == pytest.approx(best.objective * before["x"].peak(2), rel=1e-9)
    for nu, name in ((1, "velocity"), (3, "jerk")):
        assert slide.peak(nu) <= float(limits.get(name, "inf").split()[0]) * (1.0 + 1e-9)
    assert best.axes["z"].peak(2) == pytest.approx(before["z"].peak(2), rel=1e-9)
    assert slide.durations[2 if len(slide.segments) == 5 else 1] >= DWELL * (1.0 - 1e-9)
    times = np.linspace(0.0, 1.3, 40_001)[:-1]
    x, z = slide(times), best.axes["z"](times)
    assert not ((x > 0.05 + 1e-9) & (x < 0.25 - 1e-9) & (z < 0.04 - 1e-9)).any()
    # laws of these shapes in these times; no law has less than one that bends for the interlock
    assert best.status == "optimal"
    assert best.gain > 1.5


@pytest.mark.long
def test_a_law_that_bends_for_the_interlock_has_less_acceleration() -> None:
    """Beside linear programs over a grid of instants: own laws cost what they cost, and are never below."""
    grid = [least_acceleration(instant) for instant in np.arange(0.5, 0.651, 0.05)]
    found = gripper(jerk="400 m/s^3").gentlest("x").axes["x"].peak(2)
    assert min(grid) * (1.0 - 1e-3) <= found <= 1.5 * min(grid)


def test_the_acceleration_of_given_laws_with_limits_is_that_of_their_cycle() -> None:
    law: Any = {"law": "cycloidal"}
    move = [
        Dwell("0.3 s", least="0 s"),
        Rise("50 mm", "0.1 s", **law),
        Dwell("0.1 s", least="0 s"),
        Return(None, "0.1 s", **law),
    ]
    slide: Any = {"segments": [*move, Dwell()], "limits": {"jerk": "1000 m/s^3"}}
    machine = Axes({"slide": slide}, period="1 s")
    best = machine.gentlest()
    # both have half of the period
    assert best.objective == pytest.approx((0.1 / 0.5) ** 2, rel=1e-7)
    assert best.axes["slide"].peak(2) == pytest.approx(best.objective * machine["slide"].unchecked().peak(2), rel=1e-9)


@pytest.mark.sample(4)
@pytest.mark.parametrize("law", ["optimal", "cycloidal"])
@pytest.mark.parametrize("drive", [{"mass": "2 kg", "gravity": "19.6 N"}, Mechanism("2 kg", "19.6 N", axis="length")])
def test_the_fastest_moves_keep_what_their_drive_may_take(law: str, drive: Any) -> None:
    move = {"segments": [Rise("100 mm", "0.4 s", law=law), Dwell("0.1 s"), Return(None, "0.4 s", law=law), Dwell()]}
    alone: Any = {"lift": move | {"drive": drive, "limits": {"force": "50 N"}}}
    best = Axes(alone, period="1.5 s").fastest()
    assert best.axes["lift"].effort.peak_force == pytest.approx(50.0, rel=1e-6)
    assert best.objective < 0.6


def rule(**given: Any) -> Axes:
    x: Any = {"segments": [Rise("0.1 m", "0.3 s"), Dwell("0.1 s"), Return("0.1 m", "0.3 s"), Dwell()]} | given
    y = [Dwell("0.1 s"), Rise("0.1 m", "0.3 s", law="cycloidal"), Dwell("0.2 s"), Return(law="cycloidal")]
    rules = [
        After("y", "0.05 m", of="x", above="0.06 m", way="up", name="wait"),
        After("y", "0.05 m", of="x", below="0.04 m", way="up", name="early"),
    ]
    return Axes({"x": x, "y": y}, period="1 s", interlocks=rules)


def test_what_no_laws_can_do_is_named() -> None:
    refused = r"no instants of these laws keep all interlocks: wait; early: at least one move"
    with pytest.raises(InfeasibleProblem, match=refused):
        rule().gentlest("x")
    rated = {"drive": {"mass": "2 kg"}, "limits": {"acceleration": "9 m/s^2", "rms force": "9 N"}}
    with pytest.raises(InputError, match=r"axis x: a limit of its whole cycle cannot be kept .* leave out"):
        rule(**rated).fastest()
    jumps = Rise("0.1 m", "0.3 s", law="constant acceleration")
    with pytest.raises(InfeasibleProblem, match=r"axis x: segment 1 \(Rise\): its law has no finite jerk"):
        Axes(
            {"x": {"segments": [jumps, Dwell("0.1 s"), Return(), Dwell("0.2 s")], "limits": LIMITS}}, period="1 s"
        ).fastest()
