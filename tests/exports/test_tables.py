"""Every table is read back by a reader of its own and is the motion that the export says, in either decimal sign."""

import json
import locale
import re
from collections.abc import Callable
from dataclasses import replace
from math import isinf

import numpy as np
import pytest
from hypothesis import given, seed
from hypothesis import strategies as st
from numpy.typing import NDArray

from optlaws import (
    BoundaryConditions,
    Cycle,
    Dwell,
    InputError,
    PiecewiseMotion,
    PolynomialLaw,
    Return,
    Rise,
    catalogue,
    law_from_z,
    reversed_law,
    smoothstep,
)
from tests.exports import readers
from tests.exports.interpolations import cubic_spline
from tests.exports.samples import GOLDEN, SAID, one_shot, optimal, press, repeating, shearing, turning
from tests.internals.exports import (
    FORMATS,
    Export,
    NumberFormat,
    export_motion,
    plain_column,
    point_table,
    profile_rows,
)
from tests.internals.motion import Motion, Piece, Units, motion_of_law
from tests.sampling import examples

Array = NDArray[np.float64]
CLAMPED = ((1, 0.0), (1, 0.0))
READ = {
    "codesys-xyva": readers.codesys_xyva,
    "codesys-xy": readers.codesys_xy,
    "rockwell-cam": readers.rockwell_cam,
    "rockwell-cam-extended": readers.rockwell_cam,
    "rockwell-cam-profile": readers.rockwell_profile,
    "twincat-table": readers.twincat_table,
}
SPLINED = {
    "csv": lambda text: readers.separated(text)[1][:2],
    "lenze": readers.lenze,
    "kas": readers.kas,
    "plcopen": readers.plcopen,
}


def derivatives(made: Export, table: Array, orders: int) -> Array:
    """A table's positions with velocities and more where it holds none: those of the law."""
    return np.array([*table[1:], *(made.motion(table[0], nu) for nu in range(len(table) - 1, orders))])


def curve(made: Export) -> tuple[Array, readers.Curve]:
    """The points and the curve that the file of an export says."""
    name, text = made.format.name, made.text
    return READ[name](text) if name in READ else _table(made)


def _table(made: Export) -> tuple[Array, readers.Curve]:
    name, text = made.format.name, made.text
    if name == "ros2":
        _, seconds, values = readers.ros2(text)
        rate = made.motion.units.rate or 1.0
        scaled = np.array([1e3 * row / rate**nu for nu, row in enumerate(values)])
        return seconds * rate, readers.osculating(seconds * rate, scaled)
    if name == "sew":
        table = readers.sew(text)
        return table[0], readers.osculating(table[0], derivatives(made, table, 2))
    if name in {"isg", "technosoft"}:
        x, y = readers.isg(text) if name == "isg" else readers.technosoft(text, made.motion.stop, made.motion.stroke)
        return x, readers.broken(x, y)
    x, y = SPLINED[name](text)
    ends = "natural" if y[0] != y[-1] else "periodic"
    return x, readers.spline(x, y, ends if name == "plcopen" else CLAMPED)


PROGRAMS = {"br-acp10", "c99", "codesys-cambuilder", "iec-st", "iec-st-real", "siemens-elements", "siemens-points"}
TABLES = sorted(set(FORMATS) - PROGRAMS - {"siemens-polynomials", "twincat-mc3", "twincat-nc2"})


@pytest.mark.sample(2)
@pytest.mark.parametrize("motion", [one_shot, repeating], ids=["law", "cycle"])
@pytest.mark.parametrize("name", TABLES)
def test_a_table_read_back_is_what_is_run(name: str, motion: object) -> None:
    made = export_motion(motion(), name, points=61)  # type: ignore[operator]
    x, read = curve(made)
    assert len(x) == made.points == 61
    inside = np.linspace(x[0], x[-1], 800)[1:-1]
    for nu in range(3):
        mine = made.run(inside, nu)
        size = np.abs(mine).max()
        tolerance = 1e-12 if nu == 0 else 1e-11 * (120.0 / np.diff(x).min()) ** nu / 100.0
        np.testing.assert_allclose(read(inside, nu), mine, rtol=0.0, atol=max(tolerance, 1e-12) * size)
    dense = np.linspace(x[0], x[-1], 6001)
    for nu in (0, 1, 2):
        rate = made.report.rate**nu
        top = max(abs(made.report.run.least[nu].value), abs(made.report.run.greatest[nu].value))
        assert np.abs(read(dense, nu)).max() * rate == pytest.approx(top, rel=2e-3)
    apart = np.abs(read(dense, 0) - made.motion(np.clip(dense, made.motion.start, made.motion.stop))).max()
    assert apart <= made.report.deviation[0].value * (1 + 1e-9) + 1e-12
    assert apart >= 0.95 * made.report.deviation[0].value - 1e-12


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", TABLES)
def test_the_best_number_of_points_is_chosen(name: str) -> None:
    made = export_motion(one_shot(), name)
    assert made.points >= 5
    ratio = made.report.ratio(2)
    assert isinf(ratio) or ratio == pytest.approx(1.0, abs=3e-3)
    assert json.loads(json.dumps(made.results(), allow_nan=False))["points"] == made.points
    assert "made by optlaws" in made.text or name in {"sew", "kas", "technosoft"}


def test_the_golden_rows_of_rockwell() -> None:
    """A captured CAM_PROFILE: points (0, 0), (40, 20), (100, 25) with the slopes 1 and 0."""
    spline = cubic_spline(np.array([0.0, 40.0, 100.0]), np.array([0.0, 20.0, 25.0]), slopes=(1.0, 0.0))
    stored = json.loads(f"[{GOLDEN}]")
    rows = readers.profile_numbers(stored)
    read = PiecewiseMotion([row[0] for row in rows], [[row[1] + row[2], *row[3:]] for row in rows[:-1]])
    assert read.breaks == spline.breaks
    np.testing.assert_allclose(read.coefficients, spline.coefficients, rtol=1e-14, atol=0.0)
    assert profile_rows(read) == stored


def test_the_default_cam_of_codesys() -> None:
    """Three polynomials of degree 5 through (0, 0, 0, 0), (120, 120, 1, 0), (240, 240, 1, 0), (360, 360, 0, 0)."""
    points = "dX := 0.0, dY := 0.0, dV := 0.0, dA := 0.0|dX := 120.0, dY := 120.0, dV := 1.0, dA := 0.0|"
    points += "dX := 240.0, dY := 240.0, dV := 1.0, dA := 0.0|dX := 360.0, dY := 360.0, dV := 0.0, dA := 0.0"
    head = "ARRAY[0..3] OF SMC_CAMXYVA nElements := 4 xStart := 0.0 xEnd := 360.0 "
    _, read = readers.codesys_xyva(head + points)
    x = np.linspace(0.0, 360.0, 100)
    u = x[x < 120.0] / 120.0
    expected = 120.0 * (6.0 * u**3 - 8.0 * u**4 + 3.0 * u**5)
    np.testing.assert_allclose(read(x, 0)[: len(u)], expected, atol=1e-11)
    rise = PolynomialLaw.from_powers([0, 0, 0, 6, -8, 3])
    laws = (rise, smoothstep(1), reversed_law(rise))
    pieces = tuple(Piece(120.0 * i, 120.0, 120.0 * i, 120.0, law) for i, law in enumerate(laws))
    made = export_motion(Motion(pieces, Units("deg", "deg", None), repeats=True), "codesys-xyva", points=4)
    assert re.findall("dX := .*(?=\\))", made.text) == points.split("|")
    assert made.report.deviation[0].value < 1e-12
    np.testing.assert_allclose(made.run(x), read(x, 0), atol=1e-11)


def test_counts_make_many_points_worse() -> None:
    """A quarter of a thousandth of a stroke of 65,536 counts: 361 points run with 2.76 times the peak."""
    many = export_motion(one_shot(), "csv", points=361, counts=65536)
    assert many.report.ratio(2) == pytest.approx(2.761, abs=1e-3)
    assert many.written.resolution == pytest.approx(35.0 / 65536)
    assert many.report.bound / many.report.law.peak(2) == pytest.approx(6 * 360**2 / 65536 / 4.647776, rel=2e-2)
    best = export_motion(one_shot(), "csv", points="best", counts=65536)
    each = [point_table(one_shot(), count, NumberFormat(65536), "cubic").run.peak(2).value for count in range(6, 120)]
    assert best.report.ratio(2) <= 1.001 * min(each) / one_shot().peak(2)
    assert best.points < 60


def test_a_jump_at_the_dwell_is_told() -> None:
    few = export_motion(one_shot(), "csv", points=13).report
    assert few.law.jumps_at_ends[1] == 0.0
    assert few.run.jumps_at_ends[1] == pytest.approx(max(abs(few.run.start[2]), abs(few.run.end[2])))
    assert few.run.jumps_at_ends[1] > 0.01 * few.law.peak(2)
    cubic = export_motion(one_shot(), "sew", points=25).report
    assert cubic.run.jumps[1].value / cubic.law.peak(2) == pytest.approx(0.0493, abs=1e-3)


def test_a_law_whose_acceleration_jumps_keeps_its_jumps() -> None:
    made = motion_of_law(catalogue["parabolic"].law, **SAID)
    report = export_motion(made, "csv", points=241).report
    assert report.law.jumps[1].value == pytest.approx(2.0 * report.law.peak(2))
    assert report.law.jumps_at_ends[1] == pytest.approx(report.law.peak(2))
    assert report.results()["law"]["PointAtMaxSlaveJerk"]["SlaveJerk"] == 0.0
    assert export_motion(made, "csv", points=241).rows()[2][2] is None


@pytest.mark.parametrize(
    ("to", "asked", "words"),
    [
        ("codesys", {}, ["to:", "did you mean"]),
        (5, {}, ["to:", "known are"]),
        ("codesys-xyva", {"counts": 5}, ["codesys-xyva takes no counts", "points"]),
        ("codesys-xyva", {"pionts": 5}, ["pionts", "did you mean 'points'"]),
        ("codesys-xyva", {"points": 40_000}, ["2", "32767", "40000"]),
        ("codesys-xyva", {"points": 2.5}, ["points"]),
        ("codesys-xy", {"points": 361}, ["256", "361"]),
        ("codesys-xy", {"name": "press 1"}, ["press 1", "press_1"]),
        ("codesys-xy", {"interpolation": "quintic"}, ["linear, cubic", "quintic"]),
        ("rockwell-cam", {"interpolation": "akima"}, ["linear, cubic", "akima"]),
        ("rockwell-cam", {"points": 65536, "counts": 1}, ["counts"]),
        ("twincat-table", {"interpolation": "4POINT"}, ["linear, spline"]),
        ("csv", {"decimal": ":"}, ["decimal", "'.' or ','"]),
        ("csv", {"digits": -1}, ["digits"]),
        ("csv", {"digits": 0, "points": 361}, ["361 points", "more digits"]),
        ("csv", {"digits": 0, "points": 361, "interpolation": "quintic"}, ["361 points", "more digits"]),
        ("sew", {"digits": 0, "points": 361}, ["361 points", "more digits"]),
        ("isg", {"points": 361}, ["360", "361"]),
        ("technosoft", {"points": 8193}, ["8192"]),
        ("kas", {"points": 4}, ["5"]),
        ("ros2", {"name": 'joint"1'}, ["ROS", "letters"]),
    ],
)
def test_what_a_target_cannot_hold_is_said_with_a_remedy(
    to: object, asked: dict[str, object], words: list[str]
) -> None:
    with pytest.raises(InputError) as caught:
        export_motion(one_shot(), to, **asked)  # type: ignore[arg-type]
    assert all(word in str(caught.value) for word in words)


def test_a_motion_that_does_not_fit_is_refused() -> None:
    over_time = motion_of_law(smoothstep(3), stroke="35 mm", duration="0.1 s")
    with pytest.raises(InputError, match="master must be in deg"):
        export_motion(over_time, "isg")
    with pytest.raises(InputError, match="how fast the master goes"):
        export_motion(motion_of_law(smoothstep(3), stroke="35 mm", master="120 deg"), "ros2")
    with pytest.raises(InputError, match="points must be from 5 "):
        export_motion(press("cycloidal").motion(), "csv", points=4)
    infinite = motion_of_law(catalogue["0050"].law, **SAID)
    sized = replace(infinite, pieces=tuple(infinite.pieces))
    assert export_motion(sized, "csv", points=20).points == 20


def test_the_report_says_it_all() -> None:
    message = str(optimal().export("rockwell-cam", points=20, counts=65536, **SAID))
    for word in (
        "20 points",
        "clamped",
        "StartSlope",
        "peak of acceleration, mm/s²",
        "at the ends",
        "rounding adds at most",
    ):
        assert word in message
    over_angle = str(smoothstep(3).export("csv", stroke="1 mm", master="90 deg", points=19))
    assert "peak of jerk, mm/deg³" in over_angle


def test_what_a_file_does_not_tell_is_not_rounded() -> None:
    """SEW's file holds positions alone: their digits say nothing of the slopes."""
    made = export_motion(one_shot(), "sew", points=31, digits=2)
    table = readers.sew(made.text)
    read = readers.osculating(table[0], derivatives(made, table, 2))
    inside = np.linspace(0.0, 120.0, 500)
    np.testing.assert_allclose(made.run(inside, 1), read(inside, 1), atol=1e-12)


@pytest.mark.parametrize(
    ("interpolation", "columns"), [("linear", 2), ("akima", 2), ("c1", 3), ("quintic", 4), ("septic", 5)]
)
def test_csv_holds_what_its_interpolation_takes(interpolation: str, columns: int) -> None:
    made = export_motion(one_shot(), "csv", points=25, interpolation=interpolation)
    heading, table = readers.separated(made.text)
    assert heading == ["x deg", "y mm", "V mm/deg", "A mm/deg^2", "J mm/deg^3"][:columns]
    by_name = {"linear": readers.broken, "akima": readers.akima}
    read = by_name[interpolation](*table) if interpolation in by_name else readers.osculating(table[0], table[1:])
    inside = np.linspace(0.0, 120.0, 700)[1:-1]
    np.testing.assert_allclose(read(inside, 0), made.run(inside), atol=35e-12)


def test_decimal_commas() -> None:
    made = export_motion(one_shot(), "csv", points=31, decimal=",", digits=6)
    heading, columns = readers.separated(made.text, ";", ",")
    assert heading == ["x deg", "y mm"]
    np.testing.assert_array_equal(columns[1], made.run(columns[0]).round(6))
    for name, reader in (("sew", readers.sew), ("lenze", readers.lenze), ("kas", readers.kas)):
        _, y = reader(export_motion(one_shot(), name, points=31, decimal=",", digits=6).text, ",")
        np.testing.assert_allclose(y, columns[1], atol=1.1e-6)


@pytest.mark.parametrize(("name", "made"), [("twincat-table", press), ("isg", turning), ("twincat-table", shearing)])
def test_the_best_run_of_a_cycle_is_the_motion(name: str, made: Callable[[], Cycle]) -> None:
    """A spline of five points would have a low peak, and three symmetric lines cross the law halfway."""
    best = made().export(name)
    assert best.report.deviation[0].value <= 1.6e-4 * best.motion.stroke
    assert best.points > 50
    assert name == "isg" or best.report.ratio(2) == pytest.approx(1.0, abs=5e-3)


def test_a_velocity_that_rounding_left_at_an_end_is_written_as_none() -> None:
    almost = law_from_z(BoundaryConditions(start=(0, -1e-16, 0), end=(1, -1e-16, 0)))
    text = almost.export("rockwell-cam", points=9, stroke="35 mm", master="120 deg", duration="0.1 s").text
    assert "StartSlope = 0.0, EndSlope = 0.0" in text
    true = law_from_z(BoundaryConditions(start=(0, 0.5, 0), end=(1, 1e-9, 0)))
    text = true.export("rockwell-cam", points=9, stroke="30 mm", master="60 deg", duration="0.1 s").text
    assert "StartSlope = 0.25, EndSlope = 5.0E-10" in text


def test_septic_tables_say_where_one_value_of_a_jumping_jerk_makes_the_run_overshoot() -> None:
    """Into a dwell of a modified trapezoidal rise by millimetres; not for a law whose jerk is continuous."""
    trapezoidal = press("modified trapezoidal")
    septic, quintic = (trapezoidal.export("csv", interpolation=kind, points=25) for kind in ("septic", "quintic"))
    off = septic.report.deviation[0]
    assert off.value > 2.0
    assert any("jerk jumps at" in note and "interpolation='quintic'" in note for note in septic.written.notes)
    assert quintic.report.deviation[0].value < 1e-3
    assert (
        quintic.written.notes == press("4-5-6-7 polynomial").export("csv", interpolation="septic").written.notes == ()
    )


# --- decimal signs ---


READERS = {
    "csv": lambda text, sign: readers.separated(text, ";" if sign == "," else ",", sign)[1][:2],
    "sew": readers.sew,
    "lenze": readers.lenze,
    "kas": readers.kas,
}


@seed(7)
@examples(40)
@given(
    to=st.sampled_from(sorted(READERS)),
    sign=st.sampled_from([".", ","]),
    digits=st.none() | st.integers(3, 12),
    stroke=st.floats(0.01, 1e4),
    master=st.floats(1.0, 1e5),
    negative=st.booleans(),
    points=st.integers(5, 40),
)
def test_numbers_come_back(
    *, to: str, sign: str, digits: int | None, stroke: float, master: float, negative: bool, points: int
) -> None:
    stroke = -stroke if negative else stroke
    motion = motion_of_law(smoothstep(3), stroke=f"{stroke!r} mm", master=f"{master!r} deg")
    asked = {"digits": digits} if digits is not None else {}
    made = export_motion(motion, to, points=points, decimal=sign, **asked)  # type: ignore[arg-type]
    x, y = READERS[to](made.text, sign)
    np.testing.assert_array_equal(x, made.run.breaks)
    expected = [row[0] for row in made.run.coefficients]
    np.testing.assert_array_equal(y[:-1], expected)
    if digits is not None:
        off = np.abs(y - motion(np.clip(x, 0.0, motion.stop))).max()
        assert off <= 10.0**-digits * (1.0 + 3.0 * abs(stroke) / master)


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=-1e15, max_value=1e15), st.integers(0, 17))
@seed(8)
@examples(100)
def test_a_number_has_no_exponent_and_is_itself(value: float, digits: int) -> None:
    every, rounded, dialect = (plain_column([value], *form)[0] for form in ((), (digits,), (digits, ",")))
    assert float(every) == value
    assert float(rounded) == pytest.approx(value, abs=0.51 * 10.0**-digits + 1e-15 * abs(value))
    for text in (every, dialect):
        assert set(text) <= set("-0123456789.,")
        assert text not in {"-0", "-0,0"}


def test_no_locale_changes_a_byte() -> None:
    motion = motion_of_law(smoothstep(3), stroke="35 mm", master="120 deg")
    texts = {to: export_motion(motion, to, points=9).text for to in READERS}
    kept = locale.setlocale(locale.LC_ALL)
    try:
        for name in ("de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8", "ar_EG.UTF-8"):
            try:
                locale.setlocale(locale.LC_ALL, name)
            except locale.Error:
                continue
            assert {to: export_motion(motion, to, points=9).text for to in READERS} == texts
    finally:
        locale.setlocale(locale.LC_ALL, kept)


def test_an_executed_motion_far_off_the_law_is_warned_of() -> None:
    """Even points miss moves that take a thousandth of a turn: the file was written without a word."""
    moves = [Rise("40 mm", "0.2 s"), Dwell("0.1 s"), Return(duration="0.3 s"), Dwell()]
    slow = Cycle(moves, speed="1 rpm", limits={"jerk": "347 m/s^3"})
    far = slow.export("plcopen")
    (warning,) = far.warnings
    assert f"{far.report.deviation[0].value:.3g} mm off the law" in warning
    assert f"warning: {warning}" in str(far)
    assert warning in far.results()["notes"]
    assert ("warning", warning) in [(row.name, row.value) for row in far.summary()]
    (faster,) = slow.export("csv").warnings
    assert "times the acceleration of the law: take more points" in faster
    rounded = smoothstep(3).export("rockwell-cam", points=721, counts=4096, stroke="35 mm", master="120 deg")
    assert "take fewer points, whose rounding is less" in rounded.warnings[0]
    joined = slow.export("codesys-xyva")
    assert joined.warnings == ()
    assert "warning" not in str(joined)
