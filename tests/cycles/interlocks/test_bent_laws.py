"""Laws that bend for interlocks: beside linear programs over a grid of instants, and beside closed forms."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from optlaws import After, Axes, Dwell, Forbidden, InfeasibleProblem, InputError, Return, Rise, catalogue

CYCLOID: Any = catalogue["cycloidal"].law
BOX = [("0 mm", "50 mm"), ("40 mm", "50 mm"), ("40 mm", "250 mm"), ("0 mm", "250 mm")]
DWELL = 0.1


def pick_and_place() -> Axes:
    """A gripper that goes up and down twice by a cycloid, and a slide that passes over a box as gently as can be."""
    up, down = Rise("80 mm", "0.2 s", law="cycloidal"), Return("80 mm", "0.2 s", law="cycloidal")
    z = [up, Dwell("0.15 s"), down, Dwell("0.1 s"), up, Dwell("0.15 s"), down, Dwell("0.1 s")]
    wait = Dwell("0.2 s", least="0 s")
    x = [wait, Rise("300 mm", "0.3 s"), Dwell("0.2 s", least=f"{DWELL} s"), Return("300 mm", "0.3 s"), Dwell()]
    axes: Any = {"z": z, "x": {"segments": x, "limits": {"jerk": "400 m/s^3"}}}
    return Axes(axes, period="1.3 s", interlocks=[Forbidden("z", "x", BOX, name="box")])


@pytest.fixture(scope="module")
def gentle() -> Any:  # noqa: ANN401 - an overlap
    return pick_and_place().gentlest("x")


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


@pytest.mark.long
def test_a_pick_and_place_beside_linear_programs_over_a_grid_of_instants(gentle: Any) -> None:  # noqa: ANN401
    grid = [least_acceleration(instant) for instant in np.arange(0.5, 0.651, 0.05)]
    known = min(grid) / pick_and_place()["x"].peak(2)
    assert known < np.inf
    # the programs know no limit of the jerk, and a grid of instants: the bound is below them, the law near by
    assert gentle.lower_bound <= known * (1.0 + 1e-3)
    assert gentle.objective <= known * 1.04
    assert gentle.gap < 0.03
    assert gentle.status == "local"


@pytest.mark.long
def test_laws_that_bend_keep_their_limits_and_interlocks(gentle: Any) -> None:  # noqa: ANN401
    given = pick_and_place()
    slide = gentle.axes["x"]
    assert [least.status for least in gentle.axes.clearances] == ["clear"]
    assert slide.peak(3) <= 400.0 * (1.0 + 1e-8)
    assert slide.peak(2) == pytest.approx(gentle.objective * given["x"].peak(2), rel=1e-12)
    assert gentle.axes["z"].to_dict() == given["z"].to_dict()
    dwell = slide.durations[[segment.label for segment in slide.segments].index("Return") - 1]
    assert dwell >= DWELL * (1.0 - 1e-9)
    times = np.linspace(0.0, 1.3, 40_001)[:-1]
    x, z = slide(times), gentle.axes["z"](times)
    assert not ((x > 0.05 + 1e-9) & (x < 0.25 - 1e-9) & (z < 0.04 - 1e-9)).any()


LONG = pytest.mark.long


@pytest.mark.long
@pytest.mark.parametrize(
    ("moves", "size"), [(1, 1e-6), pytest.param(2, 1e-6, marks=LONG), pytest.param(2, 1e6, marks=LONG)]
)
def test_the_least_time_of_one_axis_is_that_of_seven_segments(moves: int, size: float) -> None:
    """In machines of all sizes, at times of seconds: a move of jerk, acceleration, jerk that goes on, or comes back."""
    limits = {"acceleration": f"{size!r} m/s^2", "jerk": f"{2.0 * size!r} m/s^3"}
    there, back, wait = Rise(f"{size!r} m", "4 s"), Return(None, "4 s"), Dwell("1 s")
    slide = (
        {"advance": f"{size!r} m", "segments": [there, wait]} if moves == 1 else {"segments": [there, wait, back, wait]}
    )
    alone: Any = {"slide": slide | {"limits": limits}}
    best = Axes(alone, period=f"{5 * moves} s").fastest()
    # u (u / a + a / j) = h
    speed = 0.5 * (-0.5 + np.sqrt(0.25 + 4.0))
    known = moves * (2.0 * (speed + 0.5) + 1.0)
    assert best.lower_bound <= known * (1.0 + 1e-9)
    assert known * (1.0 - 1e-9) <= best.objective <= known * 1.003
    assert best.gap < 6e-3
    assert best.axes["slide"].peak(2) <= size
    assert best.axes["slide"].peak(3) <= 2.0 * size


def rule(**given: Any) -> Axes:
    x: Any = {"segments": [Rise("0.1 m", "0.3 s"), Dwell("0.1 s"), Return("0.1 m", "0.3 s"), Dwell()]} | given
    y = [Dwell("0.1 s"), Rise("0.1 m", "0.3 s", law="cycloidal"), Dwell("0.2 s"), Return(law="cycloidal")]
    rules = [
        After("y", "0.05 m", of="x", above="0.06 m", way="up", name="wait"),
        After("y", "0.05 m", of="x", below="0.04 m", way="up", name="early"),
    ]
    return Axes({"x": x, "y": y}, period="1 s", interlocks=rules)


def test_interlocks_that_contradict_each_other_are_named() -> None:
    with pytest.raises(InfeasibleProblem, match=r"no laws keep all interlocks: wait; early: change a position"):
        rule().gentlest("x")


def test_limits_of_another_kind_are_refused() -> None:
    with pytest.raises(InputError, match=r"axis x: segment 1.*limits must be those of velocity, acceleration and jerk"):
        rule(limits={"snap": "1e6 m/s^4"}).gentlest("x")
    alone: Any = {"x": [Rise("0.1 m", "0.3 s"), Dwell("0.1 s"), Return("0.1 m", "0.3 s"), Dwell()]}
    with pytest.raises(InputError, match="axis x: segment 1 needs a limit of its acceleration or its jerk"):
        Axes(alone, period="1 s").fastest()
