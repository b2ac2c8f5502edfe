"""The least clearance of interlocks: proven bounds beside samples and closed forms; and their pictures."""

import json
import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.path import Path as Outline

from optlaws import (
    After,
    Axes,
    Clearance,
    ConstantVelocity,
    Cycle,
    Dwell,
    Forbidden,
    Free,
    InputError,
    Return,
    Rise,
    Synchronous,
)
from optlaws.results import Results
from tests.documents import ROOT
from tests.internals.cycles import SimplePolygon
from tests.internals.files import reading
from tests.internals.jobs import cycle_job
from tests.internals.jobs import read_of_cycle_entries as read

X = [Dwell("0.1 s"), Rise("300 mm", "0.3 s", law="cycloidal"), Dwell("0.2 s"), Return(duration="0.3 s"), Dwell()]
Z = [
    Rise("80 mm", "0.15 s", law="modified sine"),
    Dwell("0.2 s"),
    Return(duration="0.15 s", law="345"),
    Rise("80 mm", "0.15 s", law="cycloidal"),
    Dwell("0.1 s"),
    Return(duration="0.15 s", law="modified trapezoid"),
    Dwell(),
]
PAIR = Axes({"x": X, "z": Z}, period="1.2 s")
BOX = [("100 mm", "0 mm"), ("200 mm", "0 mm"), ("200 mm", "40 mm"), ("100 mm", "40 mm")]
DEEP = [("20 mm", "0 mm"), ("280 mm", "0 mm"), ("280 mm", "70 mm"), ("20 mm", "70 mm")]
CUP = [("80 mm", "-5 mm"), ("220 mm", "-5 mm"), ("220 mm", "60 mm"), ("150 mm", "10 mm"), ("80 mm", "60 mm")]
TIMES = np.linspace(0.0, 1.2, 24_001)


def least(rule: Any, axes: Axes = PAIR) -> Any:
    return Axes(dict(axes), interlocks=[rule]).clearances[0]


def distances(corners: Any) -> tuple[Any, Any]:
    """Distances of the sampled path from a polygon, and whether it is within, by other means than the library's."""
    points = np.array([[float(text.split()[0]) / 1e3 for text in corner] for corner in corners])
    path = np.column_stack([PAIR["x"](TIMES), PAIR["z"](TIMES)])
    far = np.full(len(path), np.inf)
    for start, stop in pairwise([*points, points[0]]):
        share = np.clip((path - start) @ (stop - start) / np.sum((stop - start) ** 2), 0.0, 1.0)
        far = np.minimum(far, np.linalg.norm(path - start - share[:, None] * (stop - start), axis=1))
    return far, Outline(points).contains_points(path)


@pytest.mark.sample(4)
@pytest.mark.parametrize("corners", [BOX, BOX[::-1], CUP, DEEP])
def test_a_path_keeps_away_from_a_polygon_as_far_as_samples_say(corners: Any) -> None:
    known, (far, within) = least(Forbidden("x", "z", corners)), distances(corners)
    if within.any():
        assert known.status == "broken"
        assert -known.clearance == pytest.approx(float(far[within].max()), rel=1e-3)
    else:
        assert known.status == "clear"
        assert known.bound <= known.clearance <= float(far.min()) + 1e-12
        assert known.bound == pytest.approx(float(far.min()), rel=1e-6)


def test_random_polygons_are_outside_where_their_function_is_positive() -> None:
    random = np.random.default_rng(27)
    for _ in range(40):
        angles = np.sort(random.uniform(0.0, 2.0 * np.pi, random.integers(5, 14)))
        if np.diff([*angles, angles[0] + 2.0 * np.pi]).max() > 3.0:
            continue
        corners = random.uniform(0.2, 1.0, (len(angles), 1)) * np.column_stack([np.cos(angles), np.sin(angles)])
        points = random.uniform(-1.0, 1.0, (400, 2))
        polygon = SimplePolygon.through([(float(x), float(y)) for x, y in corners])
        depth, far = polygon.outside(*points.T), np.sqrt(polygon.square(*points.T))
        assert np.array_equal(depth < 0.0, Outline(corners).contains_points(points))
        assert (np.abs(depth) <= 2.0 * far.max()).all()


@pytest.mark.sample(2)
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_bounds_that_are_functions_agree_with_samples(size: float) -> None:
    axes = Axes(
        {
            "x": [Rise(f"{0.3 * size} m", "0.5 s", law="cycloidal"), Return(law="cycloidal")],
            "z": [Dwell("0.1 s"), Rise(f"{0.08 * size} m", "0.3 s", law="345"), Dwell("0.1 s"), Return(law="345")],
        },
        period="1 s",
    )
    places, heights = np.array([0.05, 0.15, 0.3]) * size, np.array([-0.01, 0.02, 0.05]) * size
    pairs = [(f"{x!r} m", f"{y!r} m") for x, y in zip(places.tolist(), heights.tolist(), strict=True)]
    x, z = axes["x"](TIMES / 1.2), axes["z"](TIMES / 1.2)
    rooms = {
        "pairs": (Clearance("z", over="x", least=pairs), z - np.interp(x, places, heights)),
        "most": (Clearance("z", over="x", most=f"{size} * (0.09 + x^2 / {size}^2)", units=("m", "m")),
                 size * (0.09 + (x / size) ** 2) - z),
    }  # fmt: skip
    for rule, room in rooms.values():
        known = least(rule, axes)
        assert known.bound <= known.clearance <= room.min() + 1e-12 * size
        assert known.clearance == pytest.approx(room.min(), abs=1e-8 * size)
        assert known.clearance - known.bound <= 1e-9 * size
        assert known.status == ("clear" if room.min() > 0.0 else "broken")


def test_an_axis_that_comes_after_another_by_closed_forms() -> None:
    """A cycloid is at 1/2 in the middle and at 1/4 - 1/(2 pi) after a quarter of its time."""
    quarter = 100.0 * (0.25 - 0.5 / np.pi)
    x = [Rise("200 mm", "0.5 s", law="cycloidal"), Return(law="cycloidal")]
    z = [Rise("100 mm", "0.5 s", law="cycloidal"), Return(law="cycloidal")]
    axes = Axes({"x": x, "z": z}, period="1 s")
    rising = least(After("x", "100 mm", of="z", above=f"{quarter!r} mm", way="up"), axes)
    assert (rising.status, rising.margin) == ("clear", pytest.approx(0.125))
    assert rising.clearance == pytest.approx(0.05 - 1e-3 * quarter)
    assert (rising.time, rising.angle) == (pytest.approx(0.25), pytest.approx(90.0))
    late = least(After("x", "100 mm", of="z", above=f"{100.0 - quarter!r} mm", way="up"), axes)
    assert (late.status, late.margin) == ("broken", pytest.approx(-0.125))
    assert late.clearance == pytest.approx(1e-3 * quarter - 0.05)
    falling = least(After("x", "100 mm", of="z", below=f"{100.0 - quarter!r} mm", way="down"), axes)
    assert (falling.status, falling.margin) == ("clear", pytest.approx(0.125))
    both = least(After("x", "100 mm", of="z", above="50 mm"), axes)
    assert both.status == "clear"
    assert both.clearance == pytest.approx(0.0, abs=1e-12)


def test_every_pass_of_a_free_motion_counts() -> None:
    """A motion through points goes up and down within one segment: the worst of its passes is told."""
    wave = [Free("0 mm", "1 s", via=[("0.25 s", "50 mm"), ("0.75 s", "-50 mm")])]
    ramp = [Rise("50 mm", "0.5 s", law="345"), Return(law="345")]
    axes = Axes({"wave": wave, "ramp": ramp}, period="1 s")
    known = least(After("wave", "-20 mm", of="ramp", above="35 mm"), axes)
    times = np.linspace(0.0, 1.0, 200_001)
    values = axes["wave"](times) + 0.02
    crossings = times[:-1][np.sign(values[1:]) != np.sign(values[:-1])]
    worst = min(axes["ramp"](crossings) - 0.035)
    assert known.clearance == pytest.approx(float(worst), abs=1e-6)
    assert known.clearance - known.bound < 1e-12


def test_velocities_are_compared_over_a_window() -> None:
    belt, shear = [ConstantVelocity("1 m/s")], [Free("1 m", "1 s", via=[("0.3 s", "0.3 m"), ("0.6 s", "0.61 m")])]
    axes = Axes({"belt": {"segments": belt, "advance": "1 m"}, "shear": {"segments": shear, "advance": "1 m"}},
                period="1 s")  # fmt: skip
    times = np.linspace(0.3, 0.6, 20_001)
    off = float(np.abs(axes["shear"](times, 1) - 1.0).max())
    for tolerance, status in ((2.0 * off, "clear"), (0.5 * off, "broken")):
        rule = Synchronous("shear", "belt", during=("0.3 s", "0.6 s"), within=f"{tolerance!r} m/s")
        known = least(rule, axes)
        assert known.status == status
        assert known.clearance == pytest.approx(tolerance - off, abs=1e-7)


def test_what_touches_is_clear_and_what_is_broken_is_named() -> None:
    touching = least(Clearance("z", over="x", least=[("0 mm", "0 mm"), ("300 mm", "0 mm")]))
    assert touching.status == "clear"
    assert touching.clearance == pytest.approx(0.0, abs=1e-12)
    rules = [Forbidden("x", "z", DEEP, name="workpiece"), Forbidden("x", "z", BOX)]
    axes = Axes(dict(PAIR), interlocks=rules)
    assert [known.interlock.label for known in axes.broken] == ["workpiece"]
    assert "mm at" in axes.broken[0].text


AFTER = {"axis": "x", "position": "100 mm", "of": "z", "above": "30 mm"}


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: After("x", "1 mm", of="z"), "above='31 mm', or below="),
        (lambda: After("x", "1 mm", of="z", above="1 mm", below="2 mm"), "one of them"),
        (lambda: After("x", "1 mm", of="z", above="1 mm", way="left"),  # type: ignore[arg-type]
         "unknown way 'left'; known are down, up"),
        (lambda: After("", "1 mm", of="z", above="1 mm"), "axis must be a text, got ''"),
        (lambda: least(After("y", "1 mm", of="z", above="1 mm")), "unknown axis 'y'"),
        (lambda: least(After("x", "1 mm", of="x", above="1 mm")), "both are x"),
        (lambda: least(After("x", "400 mm", of="z", above="1 mm")), "0 mm to 300 mm and never passes 400 mm"),
        (lambda: least(After("x", "300 mm", of="z", above="1 mm")), "x rests at 300 mm"),
        (lambda: least(After("x", "100 mm", of="z", above="90 mm")), "0 mm to 80 mm and never passes 90 mm"),
        (lambda: least(After("x", "10 deg", of="z", above="9 mm")), "position of x must be a length"),
        (lambda: Clearance("x", over="z"), "give the least position"),
        (lambda: Clearance("x", over="z", least=[("1 mm", "1 mm")]), "least must be a list of 2 at least, each"),
        (lambda: Clearance("x", over="z", least="2*x"), "needs the units of x"),
        (lambda: Clearance("x", over="z", least="2*y", units=("mm", "mm")), "unknown name 'y'"),
        (lambda: Clearance("x", over="z", least="table(x, 0:1, 1:2)", units=("mm", "mm")), "give a table as pairs"),
        (lambda: Clearance("x", over="z", least=[("0 m", "1 m"), ("1 m", "1 m")], units=("m", "m")), "leave `units`"),
        (lambda: least(Clearance("x", over="z", least=[("2 mm", "1 mm"), ("1 mm", "1 mm")])), "must increase"),
        (lambda: least(Clearance("x", over="z", least=[("2 deg", "1 mm"), ("3 deg", "1 mm")])), "must be a length"),
        (lambda: Forbidden("x", "z", BOX[:2]), "corners must be a list of 3 at least, each a list"),
        (lambda: least(Forbidden("x", "z", [("0 mm", "0 mm"), ("1 mm", "1 mm"), ("2 mm", "2 mm")])), "lie on a line"),
        (lambda: least(Forbidden("x", "z", [BOX[0], BOX[2], BOX[1], BOX[3]])), "sides 1 and 3 cross"),
        (lambda: Synchronous("x", "z", during=("1 s",), within="1 mm/s"), "during must be a list of two"),  # type: ignore[arg-type]
        (lambda: least(Synchronous("x", "z", during=("0.2 s", "0.1 s"), within="1 mm/s")), "the earlier one first"),
        (lambda: least(Synchronous("x", "z", during=("0.1 s", "0.2 s"), within="0 mm/s")), "within must be above 0"),
        (lambda: Axes(dict(PAIR), interlocks=[{"kind": "afer"}]), "interlock 1: unknown kind .*; did you mean 'after'"),
        (lambda: Axes(dict(PAIR), interlocks=[AFTER | {"kind": "after", "abov": ""}]), "interlock 1: .*; did you mean"),
        (lambda: Axes(dict(PAIR), interlocks=[{"kind": "after", "axis": "x"}]), "interlock 1: .* needs its position"),
        (lambda: Axes(dict(PAIR), interlocks=3), "interlocks must be a list, each an interlock"),  # type: ignore[arg-type]
    ],
)  # fmt: skip
def test_what_is_wrong_is_refused(make: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()


@pytest.mark.parametrize(
    "rule",
    [
        After("x", "100 mm", of="z", above="30 mm", way="up", name="gripper"),
        Clearance("z", over="x", least=[("0 mm", "0 mm"), ("300 mm", "-1 mm")]),
        Clearance("z", over="x", most="90 + x", units=("mm", "mm")),
        Forbidden("x", "z", BOX),
        Synchronous("x", "z", during=("0.1 s", "0.2 s"), within="1 mm/s", ratio=0.5),
    ],
)
def test_interlocks_are_stored_with_their_axes(rule: Any) -> None:
    assert type(rule).from_json(rule.to_json()) == rule
    machine = Axes({"x": Cycle(X, period="1.2 s"), "z": Cycle(Z, period="1.2 s")}, interlocks=[rule.to_dict()])
    again = Axes.from_json(machine.to_json())
    assert again.interlocks == (rule,)
    assert again.clearances == machine.clearances
    assert machine.at("25 rpm").interlocks == (rule,)


def test_a_joint_that_an_axis_passes_at_speed_is_no_rest() -> None:
    """Free motions meet at speed: the position of their joint is passed, and the motion may go beyond its joints."""
    swing = [Free("10 mm", "0.5 s", via=[("0.2 s", "-4 mm")]), Free("20 mm", "0.5 s"), Return(None, "1 s", law="345")]
    ramp = [Rise("50 mm", "1 s", law="345"), Return(law="345")]
    axes = Axes({"swing": swing, "ramp": ramp}, period="2 s")
    known = least(After("swing", "10 mm", of="ramp", below="40 mm", way="up"), axes)
    assert known.time == pytest.approx(0.5, abs=1e-9)
    assert known.clearance == pytest.approx(0.04 - float(axes["ramp"](0.5)), abs=1e-9)
    assert least(After("swing", "-2 mm", of="ramp", below="40 mm"), axes).status == "clear"
    with pytest.raises(InputError, match="never passes 80 mm"):
        _ = least(After("swing", "80 mm", of="ramp", below="40 mm"), axes)


# --- pictures and files ---


NAMED_X = [
    Dwell("0.1 s"),
    Rise("300 mm", "0.3 s", law="cycloidal"),
    Dwell("0.2 s"),
    Return(None, "0.3 s", law="345"),
    Dwell(),
]
NAMED_Z = [Rise("80 mm", "0.15 s", law="345", name="lift"), Dwell("0.35 s"), Return(None, "0.15 s", law="345"), Dwell()]
RULES = [
    After("x", "100 mm", of="z", above="40 mm", way="up"),
    After("x", "100 mm", of="z", above="40 mm", way="down", name="back"),
    Forbidden("x", "z", BOX),
    Clearance("z", over="x", least=[("90 mm", "0 mm"), ("120 mm", "40 mm")]),
    Synchronous("x", "z", during=("0.9 s", "1.1 s"), within="1 m/s"),
]
NAMED_PAIR = Axes({"x": NAMED_X, "z": NAMED_Z}, period="1.2 s", interlocks=RULES)


def test_a_timing_diagram_has_a_bar_for_each_move_and_an_arrow_for_each_pass() -> None:
    panel = NAMED_PAIR.plot(what="timing")[0].axes
    assert [label.get_text() for label in panel.get_yticklabels()] == ["x", "z"]
    bars = [(round(bar.get_x(), 6), round(bar.get_width(), 6)) for bar in panel.patches]
    assert bars == [(30.0, 90.0), (180.0, 90.0), (0.0, 45.0), (150.0, 45.0)]
    arrows = [text for text in panel.texts if getattr(text, "arrow_patch", None) is not None]
    assert len(arrows) == 2
    texts = {text.get_text() for text in panel.texts}
    assert {"lift 45°", "90°"} <= texts


def test_a_plane_shows_the_path_and_what_is_forbidden() -> None:
    artists = NAMED_PAIR.plot(what="plane", interlock=2)
    panel = artists[0].axes
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("x, mm", "z, mm")
    across, up = artists[0].get_data()
    times = NAMED_PAIR.report().panels[0].series[0].at
    assert np.allclose(across, 1e3 * NAMED_PAIR["x"](times))
    assert np.allclose(up, 1e3 * NAMED_PAIR["z"](times))
    corners = next(artist.get_xy() for artist in artists if hasattr(artist, "get_xy") and len(artist.get_xy()) == 5)
    assert {tuple(map(round, corner)) for corner in corners} == {(100, 0), (200, 0), (200, 40), (100, 40)}
    turned = Axes(dict(NAMED_PAIR), interlocks=[Clearance("x", over="z", most="400 + x", units=("mm", "mm"))])
    assert turned.plot(Figure().subplots(), what="plane")[0].axes.get_xlabel() == "z, mm"


def test_clearances_are_drawn_over_the_master() -> None:
    artists = NAMED_PAIR.plot(what="clearance")
    panels = artists[0].figure.axes
    assert len(panels) == len(RULES)
    assert panels[1].get_title() == "back: how far z is beyond its position"
    for panel, least in zip(panels[2:], NAMED_PAIR.clearances[2:], strict=True):
        drawn = panel.lines[0].get_ydata()
        assert np.nanmin(drawn) == pytest.approx(1e3 * least.clearance, abs=1e-2 * np.nanmax(np.abs(drawn)))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: NAMED_PAIR.plot(what="timeing"), "unknown picture 'timeing'; did you mean 'timing'"),  # type: ignore[arg-type]
        (lambda: NAMED_PAIR.plot(what="plane", interlock="bak"), "unknown interlock 'bak'; did you mean 'back'"),
        (lambda: NAMED_PAIR.plot(what="plane", interlock=9), "interlock must be from 0 to 4"),
        (lambda: Axes(dict(NAMED_PAIR), interlocks=RULES[4:]).plot(what="plane"), "velocities, which have no plane"),
        (lambda: NAMED_PAIR.plot([1], what="clearance"), "5 interlocks are drawn into as many axes, got 1"),
        (lambda: Axes(dict(NAMED_PAIR)).plot(what="plane"), "axes without interlocks have no picture of the plane"),
    ],
)
def test_pictures_that_are_none_are_refused(make: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()


FILE = ROOT / "problems" / "cycle_die_and_table.toml"


def test_a_problem_file_overlaps_its_axes_and_says_what_is_clear() -> None:
    answer = cycle_job.answer(reading.toml(FILE), FILE)
    assert answer["overlap"]["status"] == "optimal"
    assert answer["overlap"]["gain"] == pytest.approx(5.157464, rel=1e-6)
    assert [row["status"] for row in answer["interlocks"]] == ["clear", "clear"]
    stored = json.loads((ROOT / "results" / "cycle_die_and_table" / "cycle.json").read_text("utf-8"))
    assert stored["overlap"]["objective"] == pytest.approx(answer["overlap"]["objective"], rel=1e-9)


def test_axes_with_interlocks_are_a_problem_file(tmp_path: Path) -> None:
    file = tmp_path / "machine.toml"
    file.write_text(NAMED_PAIR.to_toml("Pair"), "utf-8")
    _, axes = read(reading.toml(file), file)
    assert axes.rules == NAMED_PAIR.rules
    file.write_text(NAMED_PAIR.to_toml("Pair").replace("40 mm", "40 deg"), "utf-8")
    with pytest.raises(InputError, match=r"machine\.toml: interlock .*must be a length"):
        read(reading.toml(file), file)


@pytest.mark.sample(3)
@pytest.mark.parametrize("without", [["overlap"], [], ["overlap", "interlocks"]])
def test_a_page_names_the_pictures_that_are_drawn(tmp_path: Path, without: list[str]) -> None:
    results = Results(FILE)
    for name in without:
        del results.entries[name]
    cycle_job.run(results)
    results.write(tmp_path)
    page = (tmp_path / "cycle.md").read_text("utf-8")
    assert set(re.findall(r"\]\((.*?)\)", page)) == {file.name for file in tmp_path.glob("*.svg")}


def test_the_report_of_axes_says_which_limits_they_break() -> None:
    slow = Cycle(NAMED_X, period="1.2 s", limits={"velocity": "1 m/s", "acceleration": "90 m/s^2"})
    machine = Axes({"x": slow.unchecked(), "z": Cycle(NAMED_Z, period="1.2 s")}, interlocks=RULES[2:4])
    (row,) = (row for row in machine.report().facts if "limit exceeded" in row.name)
    (broken,) = (taken for taken in machine["x"].limits_taken if not taken.is_kept)
    assert (row.name, row.value) == ("x: limit exceeded", str(broken))
    assert not any("limit exceeded" in row.name for row in NAMED_PAIR.report().facts)
