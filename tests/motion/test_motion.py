"""The motion that is exported: the law's and the cycle's own values, and piecewise polynomial motions."""

from fractions import Fraction
from math import inf, isinf

import numpy as np
import pytest
from hypothesis import given, seed
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline, PPoly

from optlaws import (
    Cycle,
    Dwell,
    InputError,
    Pieces,
    PiecewiseMotion,
    Problem,
    Return,
    Rise,
    catalogue,
    smoothstep,
    synthesize,
)
from tests.exports.motions import random_motion
from tests.internals.exports import iec_name
from tests.internals.motion import Motion, motion_of_law
from tests.internals.numerics import bernstein
from tests.sampling import examples


def press(law: str = "cycloidal") -> Cycle:
    return Cycle(
        [Rise("35 mm", "120 deg", law=law), Dwell("90 deg"), Return(duration="100 deg", law=law), Dwell()],
        speed="200 rpm",
    )


@pytest.fixture
def cycle() -> Motion:
    return press().motion()


def test_a_law_has_the_values_of_its_formula() -> None:
    law = catalogue["modified sine"].law
    motion = motion_of_law(law, stroke="-20 deg", master="120 deg", duration="0.1 s", start="50 deg")
    x = np.linspace(0.0, 120.0, 50)
    for nu in range(4):
        expected = -20.0 / 120.0**nu * law(x / 120.0, nu) + (50.0 if nu == 0 else 0.0)
        np.testing.assert_allclose(motion(x, nu), expected, rtol=1e-13, atol=1e-13 * np.abs(expected).max())
        assert motion.peak(nu) == pytest.approx(np.abs(expected).max(), rel=0.02)


def test_a_cycle_has_its_own_values_by_the_angle(cycle: Motion) -> None:
    own, x = press(), np.linspace(0.0, 360.0, 200)
    for nu in range(3):
        expected = 1e3 * own.at_angle(x, nu) / 1200.0**nu
        np.testing.assert_allclose(cycle(x, nu)[:-1], expected[:-1], rtol=1e-9, atol=1e-12 * np.abs(expected).max())
        assert cycle.peak(nu) == pytest.approx(1e3 * own.peak(nu) / 1200.0**nu, rel=1e-12)
    starts = [*(piece.start for piece in cycle.pieces), cycle.stop]
    assert starts == pytest.approx([0.0, 120.0, 210.0, 310.0, 360.0], rel=1e-12)
    assert cycle.repeats
    assert cycle.advance == pytest.approx(0.0, abs=1e-12)
    assert cycle.rms(2) == pytest.approx(cycle.over_time().rms(2) / 1200.0**2, rel=1e-12)


def test_time_is_a_master_too(cycle: Motion) -> None:
    seconds = cycle.over_time()
    assert (seconds.units.master, seconds.units.rate, round(seconds.stop, 12)) == ("s", 1.0, 0.3)
    assert seconds.peak(2) == pytest.approx(1e3 * press().peak(2), rel=1e-12)
    assert seconds.over_time() is seconds


def test_jumps_are_told_at_joints_and_within_laws() -> None:
    motion = press("parabolic").motion()
    assert motion.jump(2) == pytest.approx((8.0 * 35.0 / 100.0**2, 260.0))
    at_joint = Motion(motion.pieces[:2], motion.units, repeats=False)
    assert at_joint.jump(2) == pytest.approx((8.0 * 35.0 / 120.0**2, 60.0))
    cubic = press("cubic").motion()
    assert cubic.jump(2) == pytest.approx((6.0 * 35.0 / 100.0**2, 210.0))
    assert motion.jump(1) == (0.0, 0.0)
    assert isinf(motion.peak(3))
    uniform = motion_of_law(smoothstep(1), stroke="1 m", duration="1 s")
    assert (uniform.jump(1)[0], uniform.peak(1), uniform.peak(2)) == (0.0, 1.0, 0.0)


def test_breaks_are_those_of_joints_and_laws() -> None:
    law = catalogue["parabolic"].law
    motion = motion_of_law(law, stroke="1 m", duration="2 s")
    assert motion.breaks == tuple(2.0 * k for k in law.breaks)
    assert motion.peak(3) == inf


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, ["stroke", "35 mm"]),
        ({"stroke": 35.0, "duration": "0.1 s"}, ["stroke", "without a unit"]),
        ({"stroke": "0 mm", "duration": "0.1 s"}, ["stroke", "give how far the slave moves"]),
        ({"stroke": "35 mm"}, ["duration='0.1 s'", "master='120 deg'"]),
        ({"stroke": "35 mm", "duration": "-1 s"}, ["duration", "above 0"]),
        ({"stroke": "35 mm", "master": "0.1 s"}, ["master", "angle", "length"]),
        ({"stroke": "35 mm", "master": "0 deg"}, ["master", "above 0"]),
        ({"stroke": "35 mm", "duration": "1 s", "start": "3 deg"}, ["start", "length"]),
    ],
)
def test_what_is_missing_or_wrong_is_named(arguments: dict[str, object], words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        motion_of_law(smoothstep(3), **arguments)  # type: ignore[arg-type]
    assert all(word in str(caught.value) for word in words)


def test_beyond_the_motion_there_are_no_values(cycle: Motion) -> None:
    with pytest.raises(InputError, match="from 0 to 360 deg"):
        cycle([0.0, 361.0])
    with pytest.raises(InputError, match=r"how fast the master goes is not known.*duration="):
        motion_of_law(smoothstep(3), stroke="1 mm", master="90 deg").over_time()
    with pytest.raises(InputError, match="unit must be a length"):
        press().motion(unit="deg")


@pytest.mark.parametrize("name", ["press 1", "1st", "a__b", "end_if", "IF", "x_", "", "ä", None, 5, "x" * 41])
def test_a_refused_name_comes_with_one_that_is_taken(name: object) -> None:
    with pytest.raises(InputError) as caught:
        iec_name(name, "CODESYS")
    proposed = str(caught.value).rpartition("take ")[2].strip("'")
    assert iec_name(proposed, "CODESYS") == proposed


# --- piecewise polynomials ---


def as_ppoly(motion: PiecewiseMotion) -> PPoly:
    return PPoly(motion.powers()[:, ::-1].T, np.array(motion.breaks))


@seed(16)
@examples(40)
@given(st.integers(0, 10**6), st.integers(1, 9), st.integers(0, 3))
def test_extremes_are_those_of_all_critical_points(number: int, degree: int, nu: int) -> None:
    motion = random_motion(number, degree=degree)
    pp = as_ppoly(motion).derivative(nu) if nu else as_ppoly(motion)
    inner = np.concatenate([motion.breaks, pp.derivative().roots(extrapolate=False)])
    inner = inner[np.isfinite(inner)]
    values = np.concatenate([pp(inner), *motion.ends(nu)])
    low, high = motion.extremes(nu)
    size = np.abs(motion.powers(nu) * motion.lengths[:, None] ** np.arange(motion.powers(nu).shape[1])).sum(1).max()
    assert [low.value, high.value] == pytest.approx([values.min(), values.max()], rel=0, abs=1e-13 * size)
    for one in (low, high):
        sides = np.array([motion(one.x, nu), *motion.ends(nu)[1]])
        assert np.abs(sides - one.value).min() <= 1e-13 * size
    assert motion.peak(nu).value == max(-low.value, high.value)


def test_the_first_of_equal_places_is_told() -> None:
    swings = np.tile([0.0, 4.0, -4.0, 0.0], (50, 1))
    highest = bernstein.top(bernstein.from_powers(swings))
    assert (highest.row, highest.u, highest.value) == (0, 0.5, 1.0)
    motion = PiecewiseMotion(range(51), swings)
    assert motion.extremes(0) == ((0.0, 0.0), (1.0, 0.5))
    assert motion.extremes(4) == ((0.0, 0.0), (0.0, 0.0))


def test_values_jumps_and_the_seam_are_those_of_the_pieces() -> None:
    motion = random_motion(3)
    x = np.linspace(motion.start, motion.stop, 401)
    for nu in range(9):
        assert motion(x, nu) == pytest.approx(as_ppoly(motion)(x, nu), rel=1e-12, abs=1e-9)
        first, last = motion.ends(nu)
        assert motion.jumps(nu) == pytest.approx(first[1:] - last[:-1], abs=0)
        assert motion.seam(nu) == first[0] - last[-1]
    spline = CubicSpline([0, 1, 3, 4], [0, 2, 1, 0], bc_type="clamped")
    run = PiecewiseMotion(spline.x, spline.c[::-1].T)
    assert np.abs([run.jumps(nu) for nu in range(3)]).max() < 1e-14
    assert np.abs(run.jumps(3)).min() > 0.1


def test_the_mean_of_squares_is_exact() -> None:
    motion = random_motion(4, degree=4)
    exact = Fraction(0)
    for row, length in zip(motion.coefficients, np.diff([Fraction(x) for x in motion.breaks]), strict=True):
        square = np.polynomial.polynomial.polymul(*2 * ([Fraction(c) for c in row],))
        exact += sum(c * length ** (n + 1) / (n + 1) for n, c in enumerate(square))
    whole = Fraction(motion.stop) - Fraction(motion.start)
    assert motion.rms(0) ** 2 == pytest.approx(float(exact / whole), rel=1e-12)


def test_a_law_of_polynomials_is_converted_without_loss() -> None:
    pieces = synthesize(Problem(B=1.859, order=3, basis=Pieces(6, degree=5, continuity=3))).law
    stroke, time = 0.035, 0.12
    k = np.linspace(0.0, 1.0, 301)
    for law in (smoothstep(4), pieces, catalogue["constant acceleration"].law):
        motion = law.pieces(f"{stroke} m", f"{time} s")
        places = np.minimum(k * time, motion.stop)
        for nu in range(3 if law.continuity < 2 else 4):
            factor = stroke / time**nu
            near = np.abs(k[:, None] - np.array(law.breaks)[1:-1]).min(axis=1, initial=1.0) > 1e-9
            assert motion(places, nu)[near] == pytest.approx(factor * law(k, nu)[near], rel=0, abs=2e-12 * factor)
            assert motion.peak(nu).value == pytest.approx(factor * law.peak(nu).value, rel=1e-11)


def test_deviations_from_functions_and_motions_are_greatest_over_the_whole_interval() -> None:
    motion = random_motion(7)
    finer = motion.minus(PiecewiseMotion([motion.start, -1.0, motion.stop], [[0.0], [0.0]]))
    assert motion.deviation(finer, 2).value <= 1e-12 * motion.peak(2).value
    narrow = PiecewiseMotion([0, 1], [[0.0]])
    found = narrow.deviation(lambda x, _: 1e-6 / (1.0 + ((x - 0.337) / 1e-3) ** 2) + x * 0.0)
    assert found.value == pytest.approx(1e-6, rel=1e-9)
    assert found.x == pytest.approx(0.337, abs=1e-6)
    cubic = PiecewiseMotion([0, 1], [[0, 1, 0, -1 / 6]])
    assert cubic.deviation(lambda x, nu: np.sin(x + nu * np.pi / 2)).value == pytest.approx(
        np.sin(1) - 5 / 6, rel=1e-12
    )
    with pytest.raises(InputError, match="name its breaks"):
        narrow.deviation(lambda x, _: np.where(x > 0.3, 1.0, 0.0))
    assert narrow.deviation(lambda x, _: np.abs(x - 0.3), breaks=[0.3]).value == pytest.approx(0.7, abs=1e-12)
    with pytest.raises(InputError, match="same interval"):
        narrow.deviation(PiecewiseMotion([0, 2], [[1.0]]))


def test_rounding_to_real32_units_and_joining() -> None:
    motion = random_motion(8)
    single = motion.in_single()
    assert all(float(np.float32(c)) == c for row in single.coefficients for c in row)
    assert single.coefficients[0][0] == float(np.float32(motion.coefficients[0][0]))
    assert PiecewiseMotion([0, 1], [[1, 2, 3]]).in_units(2.0, 8.0) == PiecewiseMotion([0, 2], [[8, 8, 6]])
    joined = PiecewiseMotion([0, 1], [[0, 1]]).then(PiecewiseMotion([1, 2], [[1]]))
    assert joined == PiecewiseMotion([0, 1, 2], [[0, 1], [1]])
    assert "2 pieces of degree 1 from 0 to 2" in repr(joined)


@pytest.mark.parametrize(
    ("breaks", "rows", "message"),
    [
        ([0, 0], [[1]], "increasing"),
        ([0], [], "at least two increasing"),
        ([0, 1], [[1], [2]], "1 rows, one between breaks, got|may have"),
        ([0, 1], [[np.nan]], r"coefficients\[0\]"),
        ([0, np.inf], [[1]], r"breaks\[1\]"),
        ("01", [[1]], "breaks must be a sequence"),
        ([0, 1], 3, "coefficients must be a sequence"),
    ],
)
def test_what_is_no_motion_is_refused(breaks: object, rows: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        PiecewiseMotion(breaks, rows)


def test_wrong_places_and_numbers_beyond_real32_are_refused() -> None:
    motion = PiecewiseMotion([0, 1], [[0, 1]])
    with pytest.raises(InputError, match=r"x must be from 0.0 to 1.0, got 1.5"):
        motion([0.5, 1.5])
    with pytest.raises(InputError, match="REAL32"):
        PiecewiseMotion([0, 1], [[1e39]]).in_single()
    with pytest.raises(InputError, match="same in REAL32"):
        PiecewiseMotion([1000, 1000.00001], [[1]]).in_single()
    with pytest.raises(InputError, match=r"begin at 1\.0"):
        motion.then(motion)
