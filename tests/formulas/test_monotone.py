"""Tables that keep their shape: within their neighbours, monotone where these are, exact at places, smooth between."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from optlaws import (
    CamForces,
    Cycle,
    DiscCam,
    Drive,
    Dwell,
    InputError,
    Loads,
    Mechanism,
    Motor,
    Return,
    Rise,
    TranslatingRoller,
    slider_crank,
    toggle,
)
from tests.internals.formulas import NUMPY, Name, Table, derivative, evaluate, pieces

NUMBERS = st.floats(-1e3, 1e3, allow_subnormal=False)


@st.composite
def tables(draw: st.DrawFn) -> Table:
    """Random tables in any unit, some values equal to those beside them."""
    count = draw(st.integers(2, 12))
    steps = draw(st.lists(st.floats(1e-2, 1e2), min_size=count, max_size=count))
    values = draw(st.lists(NUMBERS | st.sampled_from([0.0, 1.0]), min_size=count, max_size=count))
    width, height = draw(st.sampled_from([1e-12, 1.0, 1e9])), draw(st.sampled_from([1e-12, 1.0, 1e9]))
    places = tuple((width * np.cumsum(steps)).tolist())
    return Table(Name("x"), places, tuple(height * value for value in values), "monotone")


@given(tables())
def test_no_value_is_beyond_its_neighbours_and_none_turns_between_them(table: Table) -> None:
    size = max(map(abs, table.values)) or 1.0
    for (low, left), (high, right) in pairwise(zip(table.places, table.values, strict=True)):
        x = np.linspace(low, high, 301)
        values = np.broadcast_to(evaluate(table, {"x": x}, NUMPY), x.shape)
        assert min(left, right) - 1e-13 * size <= values.min()
        assert values.max() <= max(left, right) + 1e-13 * size
        assert values[0] == left
        assert values[-1] == pytest.approx(right, abs=1e-13 * size)
        assert (np.diff(values) * np.sign(right - left) >= -1e-13 * size).all()


@given(tables())
def test_the_slope_is_continuous_and_is_that_of_its_formula(table: Table) -> None:
    rows, lengths = pieces(table), np.diff(table.places)
    ends = rows[:, 1] + lengths * (2.0 * rows[:, 2] + 3.0 * lengths * rows[:, 3])
    size = np.abs(np.diff(table.values) / lengths).max()
    assert ends[:-1] == pytest.approx(rows[1:, 1], rel=1e-9, abs=1e-9 * size)
    slopes = evaluate(derivative(table, "x"), {"x": np.array(table.places[:-1])}, NUMPY)
    assert np.broadcast_to(slopes, lengths.shape) == pytest.approx(rows[:, 1], abs=1e-12 * size)


@given(tables(), st.sampled_from([-3.0, -1.0, 1e-9, 1e6]))
def test_it_is_the_same_curve_mirrored_and_in_other_units(table: Table, factor: float) -> None:
    if factor < 0.0:
        pairs = [(factor * x, y) for x, y in zip(table.places, table.values, strict=True)][::-1]
    else:
        pairs = [(x, factor * y) for x, y in zip(table.places, table.values, strict=True)]
    places, values = zip(*pairs, strict=True)
    other = Table(Name("x"), places, values, "monotone")
    x = np.linspace(table.places[0], table.places[-1], 101)
    before = np.broadcast_to(evaluate(table, {"x": x}, NUMPY), x.shape)
    changed = np.broadcast_to(evaluate(other, {"x": factor * x if factor < 0.0 else x}, NUMPY), x.shape)
    scale = 1.0 if factor < 0.0 else factor
    size = max(map(abs, table.values)) or 1.0
    assert changed == pytest.approx(scale * before, abs=1e-9 * scale * size)


def test_smooth_data_are_as_near_as_a_spline_between_their_tops() -> None:
    """Where data rise the curve is the cubic spline; next to a top it is level at the place of the greatest value."""
    places = np.linspace(0.0, 3.0, 61)
    values = np.sin(places)
    table = Table(Name("x"), tuple(places.tolist()), tuple(values.tolist()), "monotone")
    x = np.linspace(0.2, 1.4, 501)
    assert evaluate(table, {"x": x}, NUMPY) == pytest.approx(CubicSpline(places, values)(x), abs=1e-12)
    whole = np.linspace(0.0, 3.0, 3001)
    assert evaluate(table, {"x": whole}, NUMPY) == pytest.approx(np.sin(whole), abs=0.05**2 / 4)


KNEE = {"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "200 mm", "frame": "280 mm"}
PRESSING = {"0 deg": "0 N", "60 deg": "0 N", "90 deg": "-2 kN", "120 deg": "-2 kN", "150 deg": "0 N", "360 deg": "0 N"}


def test_a_press_has_no_force_where_its_table_has_none() -> None:
    knee = toggle(KNEE, bodies={"ram": "40 kg"}, loads=Loads(PRESSING, over="input", interpolation="spline"))
    lines = toggle(KNEE, bodies={"ram": "40 kg"}, loads=Loads(PRESSING, over="input"))
    x = np.radians(np.concatenate([np.linspace(0.0, 60.0, 301), np.linspace(150.0, 360.0, 901)]))
    assert np.abs(knee.load(x)).max() == 0.0
    pressed = np.radians(np.linspace(60.0, 150.0, 901))
    assert np.abs(knee.load(pressed)).max() <= 1.05 * np.abs(lines.load(pressed)).max()


def test_a_cam_lifts_off_by_no_force_that_nobody_gave() -> None:
    moves = [
        Rise("20 mm", "120 deg", law="modified sine"),
        Dwell("60 deg"),
        Return(None, "120 deg", law="modified sine"),
        Dwell(),
    ]
    cam = DiscCam(Cycle(moves, speed="60 rpm"), prime_radius="50 mm", follower=TranslatingRoller("12 mm"))
    force = [
        ("0 deg", "0 N"),
        ("40 deg", "0 N"),
        ("60 deg", "-500 N"),
        ("100 deg", "-500 N"),
        ("120 deg", "0 N"),
        ("360 deg", "0 N"),
    ]
    given_by: dict[str, object] = {"force": force, "over": "master"}
    moved = {"mass": "1 kg", "stiffness": "1 N/mm", "preload": "600 N"}
    least = [
        CamForces(cam, "60 rpm", moved, process={**given_by, "interpolation": how}).contact.least
        for how in ("lines", "spline")
    ]
    assert min(least) > 0.0
    assert least[1] == pytest.approx(least[0], rel=0.05)


@pytest.mark.parametrize("interpolation", ["lines", "spline"])
def test_a_punch_takes_the_torque_of_its_table(interpolation: str) -> None:
    press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
    strokes = [Rise("360 deg", "1 s", law="modified sine")]
    punch = [
        ("0 s", "0 N"),
        ("0.5 s", "0 N"),
        ("0.52 s", "-200 N"),
        ("0.56 s", "-200 N"),
        ("0.6 s", "0 N"),
        ("1 s", "0 N"),
    ]
    load = {"force": punch, "on": "slider", "interpolation": interpolation}
    cycle = Cycle(strokes, period="1 s", advance="360 deg", drive=press, load=load)
    free = Cycle(strokes, period="1 s", advance="360 deg", drive=press)
    assert cycle.effort.rms_force <= free.effort.rms_force + 200.0 * 0.14 * 0.1**0.5


def test_limits_of_a_motor_behind_a_lossy_gear_take_lines() -> None:
    press = slider_crank(
        "0.1 m",
        "0.4 m",
        bodies={"crank": "0.02 kg m^2"},
        loads=Loads({"0 deg": "0 N", "90 deg": "-20 N", "150 deg": "-50 N", "360 deg": "0 N"}, over="input"),
    )
    drive = Drive(
        press, Motor("3e-4 kg m^2", peak_torque="20 N m", greatest_speed="6000 rpm"), ratio=5, efficiency=0.92
    )
    cycle = Cycle(
        [Rise("180 deg", "0.5 s"), Return(law="modified sine")],
        period="1 s",
        drive=drive,
        limits={"motor": True},
        degree=5,
    )
    times = np.linspace(0.0, 1.0, 200001)[:-1]
    torque = np.abs(drive.torque(*(cycle(times, nu) for nu in range(3)))).max()
    assert cycle.sheet.peak_torque >= torque * (1.0 - 1e-12)
    assert cycle.sheet.peak_torque == pytest.approx(torque, rel=1e-6)
    assert cycle.sheet.fits


FLAT = "0:0, 1:0, 1.6:-2000, 2.1:-2000, 2.6:0, 6.3:0"


@pytest.mark.parametrize(
    "made",
    [
        lambda text: Mechanism("1 kg m^2", load=text),
        lambda text: Mechanism(f"3000 + {text}"),
        lambda text: Mechanism("1 kg m^2", load=f"2*{text} + sin(x)"),
        lambda text: slider_crank("0.1 m", "0.4 m", bodies={"slider": "5 kg"}, loads=Loads(text, over="input")).load,
    ],
)
def test_a_spline_that_swings_is_refused_wherever_a_formula_is_taken(made: Callable[[str], object]) -> None:
    with pytest.raises(InputError, match=r"between 0 and 1 the spline is .* beyond the values beside it: monotone"):
        made(f"spline(x, {FLAT})")
    made(f"monotone(x, {FLAT})")


@pytest.mark.parametrize("unit", [1e-12, 1.0, 1e9])
def test_a_spline_is_refused_at_a_top_as_well_and_monotone_never_leaves_its_neighbours(unit: float) -> None:
    places = np.linspace(0.0, 6.3, 30)
    waves = ", ".join(f"{x!r}:{unit * float(np.cos(x))!r}" for x in places.tolist())
    with pytest.raises(InputError, match=r"the spline is .* beyond the values beside it: monotone"):
        Mechanism("1 kg m^2", load=f"spline(x, {waves})")
    load = Mechanism("1 kg m^2", load=f"monotone(x, {waves})").load
    for first, last in pairwise(places.tolist()):
        between = np.asarray(load(np.linspace(first, last, 41)))
        ends = sorted(unit * np.cos([first, last]))
        assert ends[0] - 1e-15 * unit <= between.min()
        assert between.max() <= ends[1] + 1e-15 * unit


@pytest.mark.parametrize("swing", [0.5, 0.05, 1e-3])
def test_a_spline_that_falls_by_little_after_a_flat_is_refused(swing: float) -> None:
    with pytest.raises(InputError, match="the spline is"):
        Mechanism("1 kg m^2", load=f"spline(x, 0:1, 1:1, 2:1, 3:{1.0 - swing}, 4:-9, 6.3:-9.5)")
