"""Moves that overlap as far as interlocks let them: beside closed forms, a published diagram, and grids of instants."""

from math import pi, sqrt
from typing import Any

import numpy as np
import pytest
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
    best = machine.gentlest("die")
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
    best = Axes(dict(machine)).gentlest()
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
        (lambda: contradicting().gentlest("die"), InfeasibleProblem, "no instants of these laws keep all.*early"),
        (lambda: die_and_table().gentlest("dye"), InputError, "unknown axis 'dye'; did you mean 'die'"),
        (lambda: Axes({"x": [Free("1 mm", "0.5 s"), Free("-1 mm")]}, period="1 s").fastest(), InputError, "only moves"),
        (lambda: Axes({"x": {"segments": [Rise("1 m", law="constant velocity")], "advance": "1 m"}}, period="1 s")
         .gentlest(), InputError, "only moves from rest to rest"),
        (lambda: Axes(dict(die_and_table()), interlocks=[SYNCHRONOUS]).fastest(), InputError, "only After, Clearance"),
    ],
)  # fmt: skip
def test_what_cannot_overlap_is_named(make: Any, error: type[Exception], says: str) -> None:
    with pytest.raises(error, match=says):
        make()


def test_an_overlap_answers_what_its_axes_answer() -> None:
    machine = die_and_table()
    best = machine.gentlest("die")
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


@pytest.mark.parametrize("goal", ["fastest", "gentlest"])
def test_an_axis_with_a_process_keeps_what_it_minimises(goal: str) -> None:
    """Of known laws nothing is looked for but what a load vibrates with."""
    ways = [Rise("45 deg", "0.2 s", **LAW), Dwell("0.1 s", least="0 s"), Return("45 deg", "0.2 s", **LAW), Dwell()]
    load = {"torque": {"0 deg": "0 N m", "360 deg": "-4 N m"}, "over": "master"}
    cycle = Cycle(ways, period="0.8 s", minimise="rms torque", drive=Mechanism("0.8 kg m^2"), load=load)
    best = getattr(Axes({"table": cycle}), goal)()
    assert best["table"].minimise == "rms torque"
    assert best["table"].objective == pytest.approx(best["table"].effort.rms_force, rel=1e-12)
    assert type(best).from_json(best.to_json()).status == best.status == "optimal"
