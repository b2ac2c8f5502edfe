"""The least clearance of interlocks: proven bounds beside samples, closed forms, other units, and what is refused."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from matplotlib.path import Path

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
from tests.internals.cycles import SimplePolygon

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
    return far, Path(points).contains_points(path)


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
        assert np.array_equal(depth < 0.0, Path(corners).contains_points(points))
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
        (lambda: Synchronous("x", "z", during=("1 s",), within="1 mm/s"), "during must be a list of an angle"),  # type: ignore[arg-type]
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
