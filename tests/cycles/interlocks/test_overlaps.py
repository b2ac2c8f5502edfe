"""Moves that overlap as far as interlocks let them, with given laws and with laws that are sought."""

from dataclasses import replace
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from matplotlib.path import Path

from optlaws import (
    After,
    Axes,
    Clearance,
    Cycle,
    Dwell,
    Forbidden,
    Free,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Return,
    Rise,
    Synchronous,
    catalogue,
)
from tests.sampling import examples

CYCLOID: Any = catalogue["cycloidal"].law
LAW: Any = {"law": "cycloidal"}


def die_and_table(period: str = "1 s") -> Axes:
    """A table of 24 stations and its die as they are drawn without overlap; the stroke is 20 + 31 - 1 mm."""
    table = [Dwell("105 deg", least="0 deg"), Rise("100 mm", "150 deg", **LAW), Dwell()]
    die = [
        Dwell("50 deg"),
        Rise("50 mm", "55 deg", name="open", **LAW),
        Dwell(),
        Return("50 mm", "55 deg", name="close", **LAW),
        Dwell("50 deg"),
    ]
    rules = [
        After("table", "0.65 mm", of="die", above="31 mm"),
        After("die", "31 mm", of="table", above="99.35 mm", way="down"),
    ]
    return Axes({"table": {"segments": table, "advance": "100 mm"}, "die": die}, period=period, interlocks=rules)


def test_the_published_diagram_of_a_die_and_a_table() -> None:
    """In a tenth of its time a cycloid goes 0.65 % of its way; a die that overlaps so far is 5 times gentler."""
    assert round(100.0 * CYCLOID(0.1), 2) == 0.65
    machine = die_and_table()
    assert [least.status for least in machine.clearances] == ["clear", "clear"]
    best = machine.least_acceleration("die")
    # the die may close from when the table is at a tenth of its move, and it is 31 mm up by then
    early = 105.0 + 150.0 * CYCLOID.where(0.0065)[0] - 50.0
    duration = early / CYCLOID.where(31.0 / 50.0)[0]
    assert best.status == "optimal"
    assert 1.0 / best.objective == pytest.approx((duration / 55.0) ** 2, rel=1e-7)
    assert best.gain == pytest.approx(5.16, abs=0.01)
    opened, closed = (best.axes["die"].durations[i] for i in (1, -2))
    assert [360.0 * opened, 360.0 * closed] == pytest.approx([duration, duration], rel=1e-7)
    assert best.axes["die"].peak(2) == pytest.approx(machine["die"].peak(2) * best.objective, rel=1e-9)
    assert best.axes["table"].peak(2) == pytest.approx(machine["table"].peak(2), rel=1e-9)
    assert any("table passes 0.65 mm" in name for name in best.binding)


@pytest.mark.parametrize("period", ["1 us", "1 s", "1000000 s"])
def test_the_least_period_of_the_die_and_its_table(period: str) -> None:
    """Angles of the master stay: dwells and moves without limits turn with it; the die has limits, and takes less."""
    machine = die_and_table(period)
    duration = machine.duration
    limit = 2.0 * pi * 0.05 / (duration * 25.0 / 360.0) ** 2
    die: Any = {"segments": machine["die"].segments, "limits": {"acceleration": f"{limit!r} m/s^2"}}
    table: Any = {"segments": machine["table"].segments, "advance": "100 mm"}
    best = Axes({"table": table, "die": die}, period=period, interlocks=machine.interlocks).fastest()
    assert best.status == "optimal"
    # dwell, die up to 31 mm, table from a tenth of its move to its end less that, die down: all else overlaps
    pass_die, pass_table = CYCLOID.where(31.0 / 50.0)[0], CYCLOID.where(0.0065)[0]
    fixed = 2.0 * pass_die * 25.0 / 360.0 * duration
    shares = (100.0 + 150.0 * (1.0 - 2.0 * pass_table)) / 360.0
    assert best.objective == pytest.approx(fixed / (1.0 - shares), rel=1e-7)
    assert best.lower_bound <= best.objective <= best.lower_bound * (1.0 + 1e-7)
    assert best.axes["die"].peak(2) <= limit


LIMIT = {"acceleration": "20 m/s^2"}
HILL = [
    ("1 mm", "0 mm"),
    ("299 mm", "0 mm"),
    ("299 mm", "5 mm"),
    ("250 mm", "60 mm"),
    ("50 mm", "40 mm"),
    ("1 mm", "5 mm"),
]


def pick_and_place() -> Axes:
    there, back = Rise("300 mm", "0.3 s", **LAW), Return(None, "0.3 s", **LAW)
    x = [Dwell("0.3 s", least="0 s"), there, Dwell("0.5 s", least="0 s"), back, Dwell()]
    up, down = Rise("80 mm", "0.2 s", **LAW), Return("80 mm", "0.2 s", **LAW)
    z = [up, Dwell("0.4 s", least="0 s"), down, Dwell("50 ms"), up, Dwell("0.4 s", least="0 s"), down, Dwell("50 ms")]
    axes: Any = {"x": {"segments": x, "limits": LIMIT}, "z": {"segments": z, "limits": LIMIT}}
    return Axes(axes, period="1.7 s", interlocks=[Forbidden("x", "z", HILL, name="hill")])


def path_is_clear(start: float, wait: float, times: tuple[float, float]) -> bool:
    """Whether x, that starts at a time after z, is clear of the hill where z waits on top for so long; by samples."""
    for_x, for_z = times
    t = np.linspace(0.0, 2.0 * for_z + wait, 501)
    x = 300.0 * CYCLOID(np.clip((t - start) / for_x, 0.0, 1.0))
    z = 80.0 * (CYCLOID(np.clip(t / for_z, 0.0, 1.0)) - CYCLOID(np.clip((t - for_z - wait) / for_z, 0.0, 1.0)))
    across, up = [1.0, 50.0, 250.0, 299.0], [5.0, 40.0, 60.0, 5.0]
    within = (x > 1.0) & (x < 299.0)
    return bool((z[within] >= np.interp(x[within], across, up) - 1e-9).all() and x[-1] >= 299.0)


@pytest.mark.long
def test_a_pick_and_place_beside_a_grid_of_instants() -> None:
    """Both ways are one another backwards: of one the least wait of z is looked for over the instants of x."""
    times = sqrt(2.0 * pi * 0.3 / 20.0), sqrt(2.0 * pi * 0.08 / 20.0)
    waits = []
    for start in [*np.linspace(0.0, 0.03, 61), *np.linspace(0.035, 0.12, 18)]:
        low, high = 0.0, 0.5
        while high - low > 1e-4:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if path_is_clear(float(start), middle, times) else (middle, high)
        waits.append(high)
    known = 2.0 * (min(waits) + 2.0 * times[1] + 0.05)
    best = pick_and_place().fastest()
    assert best.status == "optimal"
    assert best.axes.clearances[0].status == "clear"
    assert known - 2e-3 <= best.objective <= known + 1e-4
    assert "hill" in best.binding


def test_a_bound_that_is_a_function_holds_at_every_position() -> None:
    there, back = Rise("0.1 m", "0.2 s", **LAW), Return("0.1 m", "0.2 s", **LAW)
    slide: Any = {"segments": [there, Dwell("0.4 s", least="0 s"), back, Dwell()], "limits": LIMIT}
    tool = [
        Dwell("0.2 s", least="0 s"),
        Rise("50 mm", "0.1 s", **LAW),
        Dwell("0.1 s"),
        Return("50 mm", "0.1 s", **LAW),
        Dwell(),
    ]
    rule = Clearance("tool", over="slide", most="5 + 8000*max(x - 0.09, 0)^2*100", units=("m", "mm"), name="door")
    best = Axes({"slide": slide, "tool": tool}, period="1 s", interlocks=[rule]).fastest()
    times = np.linspace(0.0, best.objective, 200_001)
    slide_at, tool_at = best.axes["slide"](times), best.axes["tool"](times)
    room = 5e-3 + 800.0 * np.maximum(slide_at - 0.09, 0.0) ** 2 - tool_at
    assert best.status == "optimal"
    assert 0.0 <= room.min() + 1e-9 <= 1e-6
    assert "door" in best.binding


@pytest.mark.sample(4)
@pytest.mark.parametrize("corners", [3, 4, 7])
def test_no_random_instants_are_better_than_the_bound(corners: int) -> None:
    """A polygon whose sides are upright but for rounding, and paths at random that keep clear of it."""
    random = np.random.default_rng(corners)
    angles = np.linspace(0.0, 2.0 * pi, corners, endpoint=False)
    points = np.column_stack([9.0 + 5.0 * np.cos(angles), 11.0 + 5.0 * np.sin(angles)])
    rule = Forbidden("a", "b", [(f"{x!r} mm", f"{y!r} mm") for x, y in points.tolist()])
    strokes = {"a": 40.0, "b": 39.0}
    axes: Any = {
        name: {"segments": [Dwell("0.2 s", least="0 s"), Rise(f"{stroke} mm", "0.2 s", **LAW), Dwell("10 ms"),
                            Return(None, "0.2 s", **LAW), Dwell()], "limits": LIMIT}
        for name, stroke in strokes.items()
    }  # fmt: skip
    best = Axes(axes, period="1 s", interlocks=[rule]).fastest()
    assert best.status == "optimal"
    longest = 2.0 * sqrt(2.0 * pi * 0.04 / 20.0) + 0.01
    assert best.objective > 1.02 * longest
    shares, paths = np.linspace(0.0, 1.0, 801), 0
    for _ in range(100):
        period = random.uniform(longest, 1.1 * best.lower_bound)
        path = []
        for stroke in strokes.values():
            move = sqrt(2.0 * pi * 1e-3 * stroke / 20.0)
            early, wait, _ = random.dirichlet([0.5, 0.5, 0.5]) * (period - 2.0 * move - 0.01)
            up, down = ((shares * period - start) / move for start in (early, early + move + wait + 0.01))
            path.append(stroke * (CYCLOID(np.clip(up, 0.0, 1.0)) - CYCLOID(np.clip(down, 0.0, 1.0))))
        if not Path(points).contains_points(np.column_stack(path)).any():
            paths += 1
            # a corner may lie between samples
            assert period >= best.lower_bound * (1.0 - 1e-3)
    assert paths > 5


def test_with_no_interlock_the_longest_axis_rules() -> None:
    machine = die_and_table()
    best = Axes(dict(machine)).least_acceleration()
    assert best.status == "optimal"
    # the table moves all the time; the die has two moves beside its dwell
    shares = {"table": (150.0 / 360.0) ** 2, "die": (55.0 / 130.0) ** 2}
    assert best.objective == pytest.approx(max(shares.values()), rel=1e-7)
    assert "status='optimal'" in repr(best)


SYNCHRONOUS = Synchronous("die", "table", during=("0 s", "1 s"), within="9 m/s")


def contradicting() -> Axes:
    machine = die_and_table()
    rule = After("die", "31 mm", of="table", below="50 mm", way="down", name="early")
    return Axes(dict(machine), interlocks=[*machine.rules, rule])


@pytest.mark.parametrize(
    ("make", "error", "says"),
    [
        (
            lambda: contradicting().least_acceleration("die"),
            InfeasibleProblem,
            "no instants of these laws keep all.*early",
        ),
        (lambda: die_and_table().least_acceleration("dye"), InputError, "unknown axis 'dye'; did you mean 'die'"),
        (lambda: Axes({"x": [Free("1 mm", "0.5 s"), Free("-1 mm")]}, period="1 s").fastest(), InputError, "only moves"),
        (lambda: Axes({"x": {"segments": [Rise("1 m", law="constant velocity")], "advance": "1 m"}}, period="1 s")
         .least_acceleration(), InputError, "only moves from rest to rest"),
        (lambda: Axes(dict(die_and_table()), interlocks=[SYNCHRONOUS]).fastest(), InputError, "only After, Clearance"),
    ],
)  # fmt: skip
def test_what_cannot_overlap_is_named(make: Any, error: type[Exception], says: str) -> None:
    with pytest.raises(error, match=says):
        make()


def test_an_overlap_answers_what_its_axes_answer() -> None:
    machine = die_and_table()
    best = machine.least_acceleration("die")
    assert best.solve() is best.axes
    assert list(best) == list(best.axes) == ["table", "die"]
    assert best["die"] is best.axes["die"]
    assert best(0.3, 1) == best.axes(0.3, 1)
    assert best.at_angle(90.0) == best.axes.at_angle(90.0)
    exported = best.export("csv", points=37)
    assert {name: each.text for name, each in exported.items()} == {
        name: cycle.export("csv", points=37, name=name).text for name, cycle in best.axes.items()
    }
    assert best.to_toml("Press") == best.axes.to_toml("Press")
    report, names = best.report(), [row.name for row in best.report().facts]
    assert names[: len(list(best.summary()))] == [row.name for row in best.summary()]
    assert names[len(list(best.summary())) :] == [row.name for row in best.axes.report().facts]
    assert report.data["overlap"]["objective"] == best.objective
    assert report.data["interlocks"] == best.axes.report().data["interlocks"]
    with pytest.raises(InputError, match="unknown axis 'dye'; did you mean 'die'"):
        best["dye"]


@pytest.mark.parametrize("goal", ["fastest", "least_acceleration"])
def test_an_axis_with_a_process_keeps_what_it_minimises(goal: str) -> None:
    """Of known laws nothing is looked for but what a load vibrates with."""
    ways = [Rise("45 deg", "0.2 s", **LAW), Dwell("0.1 s", least="0 s"), Return("45 deg", "0.2 s", **LAW), Dwell()]
    load = {"torque": {"0 deg": "0 N m", "360 deg": "-4 N m"}, "over": "master"}
    cycle = Cycle(ways, period="0.8 s", minimise="rms torque", drive=Mechanism("0.8 kg m^2"), load=load)
    best = getattr(Axes({"table": cycle}), goal)()
    assert best["table"].minimise == "rms torque"
    assert best["table"].objective == pytest.approx(best["table"].effort.rms_force, rel=1e-12)
    assert type(best).from_json(best.to_json()).status == best.status == "optimal"


# --- laws that are sought ---


LIMITS = {"acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}


def least_time(stroke: str, limits: dict[str, Any], **given: Any) -> float:
    """Of a single move, by the search for the fastest cycle."""
    alone = Cycle([Rise(stroke, "180 deg"), Dwell()], advance=stroke, period="1 s", limits=limits, **given)
    return float(alone.fastest().segments[0].least)


@examples(40)
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


def free_pick_and_place(degree: int = 9) -> Axes:
    """Two axes around a hill, with limits of acceleration and jerk and no laws."""
    hill = [("1 mm", "0 mm"), ("299 mm", "0 mm"), ("299 mm", "5 mm"), ("250 mm", "60 mm"), ("50 mm", "40 mm"),
            ("1 mm", "5 mm")]  # fmt: skip
    wait: Any = Dwell("0.4 s", least="0 s")
    up, down, off = Rise("80 mm", "0.2 s"), Return("80 mm", "0.2 s"), Dwell("50 ms")
    x = [wait, Rise("300 mm", "0.3 s"), wait, Return("300 mm", "0.3 s"), Dwell()]
    z = [up, wait, down, off, up, wait, down, off]
    axes: Any = {name: {"segments": each, "limits": LIMITS, "degree": degree} for name, each in (("x", x), ("z", z))}
    return Axes(axes, period="1.7 s", interlocks=[Forbidden("x", "z", hill, name="hill")])


@pytest.mark.parametrize(("degree", "period"), [(9, 0.6717), pytest.param(21, 0.6642, marks=pytest.mark.long)])
def test_two_axes_around_a_hill_overlap(degree: int, period: float) -> None:
    best = free_pick_and_place(degree).fastest()
    times = [least_time(stroke, LIMITS, degree=degree) for stroke in ("300 mm", "80 mm")]
    assert (best.status, best.axes.broken) == ("optimal", ())
    assert best.objective == pytest.approx(period, abs=5e-5)
    # beside each axis alone, and one move after the other
    assert 4.0 * times[1] + 0.1 < best.objective < 2.0 * times[0] + 4.0 * times[1] + 0.1
    for axis in best.axes.values():
        assert axis.peak(2) <= 20.0
        assert axis.peak(3) <= 2000.0
    assert best.axes["x"].durations[1] == pytest.approx(times[0], rel=1e-7)


@examples(40)
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


@pytest.mark.parametrize("limits", [{}, {"jerk": "400 m/s^3"}, {"jerk": "450 m/s^3", "velocity": "1.8 m/s"}])
def test_laws_of_least_acceleration_keep_limits_and_interlocks(limits: dict[str, str]) -> None:
    before = gripper(**limits)
    best = before.least_acceleration("x")
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
    assert best.gain is not None
    assert best.gain > 1.5


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
    best = machine.least_acceleration()
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
        rule().least_acceleration("x")
    rated = {"drive": {"mass": "2 kg"}, "limits": {"acceleration": "9 m/s^2", "rms force": "9 N"}}
    with pytest.raises(InputError, match=r"axis x: a limit of its whole cycle cannot be kept .* leave out"):
        rule(**rated).fastest()
    jumps = Rise("0.1 m", "0.3 s", law="constant acceleration")
    with pytest.raises(InfeasibleProblem, match=r"axis x: segment 1 \(Rise\): its law has no finite jerk"):
        Axes(
            {"x": {"segments": [jumps, Dwell("0.1 s"), Return(), Dwell("0.2 s")], "limits": LIMITS}}, period="1 s"
        ).fastest()


def test_a_least_period_needs_no_period_to_begin_from() -> None:
    slide: list[Any] = [Rise("60 mm", law="cycloidal"), Dwell("0.1 s"), Return(law="cycloidal"), Dwell()]
    timed = [replace(slide[0], duration="0.5 s"), slide[1], replace(slide[2], duration="0.5 s"), Dwell(least="0 s")]
    limits = {"acceleration": "20 m/s^2"}
    known = Axes({"slide": {"segments": timed, "limits": limits}}, period="3 s").fastest()
    begun = Axes({"slide": {"segments": slide, "limits": limits}}).fastest()
    assert begun.objective == pytest.approx(known.objective)
    compared = "speed, as a multiple of that before the overlap"
    assert [compared in [row.name for row in each.summary()] for each in (known, begun)] == [True, False]
    unlimited = {"slide": slide}
    with pytest.raises(
        InputError, match=r"axis slide: segment 1 \(Rise\): nothing bounds its time: give it a duration"
    ):
        _ = Axes(unlimited).duration
    angles = [replace(part, duration="90 deg") for part in slide]
    with pytest.raises(InputError, match=r"all durations are angles, which leave the period open: leave out"):
        Axes({"slide": {"segments": angles, "limits": limits}}).fastest()


def test_a_least_period_stands_beside_that_of_modified_sine() -> None:
    slide = {"segments": [Rise("60 mm"), Dwell("0.1 s"), Return(), Dwell(least="0 s")], "limits": LIMITS}
    best = Axes({"slide": slide}).fastest()
    [beside] = [row for row in best.summary() if row.name == "least period with modified sine"]
    sine = catalogue["modified sine"].law.constants
    times = (sine.C.value * 0.06 / 20.0) ** 0.5, (sine.J.value * 0.06 / 2000.0) ** (1.0 / 3.0)
    assert beside.value == pytest.approx(2.0 * max(times) + 0.1, rel=1e-7)
    assert beside.note == f"the least period is {100.0 * (1.0 - best.objective / beside.value):.1f} % less"


def test_a_dwell_of_no_time_is_refused_with_what_to_write_of_one_that_only_waits() -> None:
    with pytest.raises(InputError, match=r"above 0, got '0 s': leave .* waits for another axis has least = \"0 s\""):
        Dwell("0 s")
    limits = {"acceleration": "20 m/s^2"}

    def machine(wait: list[Dwell], **interlocked: Any) -> Axes:
        slide = {"segments": [Rise("10 mm"), *wait, Return(), Dwell()], "limits": limits}
        die = {"segments": [Rise("30 mm"), Return(), Dwell("50 ms")], "limits": limits}
        return Axes({"slide": slide, "die": die}, **interlocked)

    waits, without = [Dwell(least="0 s")], machine([]).fastest()
    alone = machine(waits).fastest()
    assert alone.objective == pytest.approx(without.objective, rel=1e-9)
    down = After("slide", "5 mm", of="die", below="15 mm", way="down")
    up = After("die", "15 mm", of="slide", above="8 mm", way="down")
    waiting = machine(waits, interlocks=[down, up]).fastest()
    assert [segment.label for segment in waiting["slide"].segments][:3] == ["Rise", "Dwell", "Return"]


def test_all_limits_that_bind_a_move_are_named() -> None:
    """More of any of them alone takes less time."""

    def shortest(jerk: float, acceleration: float, velocity: float) -> Any:
        limits = {"jerk": f"{jerk} m/s^3", "acceleration": f"{acceleration} m/s^2", "velocity": f"{velocity} m/s"}
        slide = {
            "segments": [Dwell("40 ms"), Rise("50 mm", "0.3 s"), Dwell("10 ms"), Return("50 mm", "0.3 s"), Dwell()],
            "limits": limits,
        }
        return Axes({"slide": slide}, period="1 s").fastest()

    best = shortest(1500.0, 20.0, 0.8)
    moves = [name for name in best.binding if "slide" in name and "dwell" not in name]
    assert [name.partition(" of axis")[0] for name in moves] == ["velocity, acceleration and jerk"] * 2
    for more in ((1800.0, 20.0, 0.8), (1500.0, 24.0, 0.8), (1500.0, 20.0, 0.96)):
        assert shortest(*more).objective < best.objective * (1.0 - 1e-3)
