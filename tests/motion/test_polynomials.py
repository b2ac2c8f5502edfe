"""Piecewise polynomial motions: extremes, jumps, differences and exact conversions, against scipy and fractions."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, seed
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline, PPoly

from optlaws import InputError, Pieces, PiecewiseMotion, Problem, catalogue, smoothstep, synthesize
from tests.exports.motions import random_motion
from tests.internals.numerics import bernstein
from tests.sampling import examples


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
