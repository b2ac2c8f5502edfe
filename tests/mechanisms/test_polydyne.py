"""Polydyne cams: their mass does what it was meant to do, and back; the experiment's cams."""

from fractions import Fraction
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    Follower,
    InputError,
    MotionLaw,
    PiecewiseLaw,
    PolynomialLaw,
    catalogue,
    mass_law,
    polydyne,
    savin,
    smoothstep,
)
from tests.internals.laws import PolynomialSegment
from tests.internals.mechanisms import cam_powers
from tests.laws.examples import cut
from tests.sampling import examples
from tests.tables import rows

K = np.linspace(0.0, 1.0, 41)
ALPHAS = {"III": (-6.0, 12.0), "IV": (-5.5, 44 / 3)}


def spline() -> PiecewiseLaw:
    """The antiderivative of a B-spline of degree 4: four continuous derivatives, zero at both ends."""
    from scipy.interpolate import BSpline

    knots = np.linspace(0.0, 1.0, 6)
    a = BSpline.basis_element(knots, extrapolate=False).antiderivative()
    scale = float(a(1.0) - a(0.0))
    segments = []
    for low, high in pairwise(knots.tolist()):
        c = np.polynomial.Chebyshev.interpolate(lambda k: a(k, 2) / scale, 3, [low, high])
        segments.append(PolynomialSegment(tuple(c.coef.tolist()), float(a(low, 1) / scale)))
    return PiecewiseLaw(knots.tolist(), segments)


LAWS: dict[str, MotionLaw] = {
    "4-5-6-7": smoothstep(4),
    "degree 39": smoothstep(20),
    "III": savin("III", 7.2),
    "triple harmonic": catalogue["triple harmonic"].law,
    "in pieces": cut(smoothstep(5), 0.3, 0.6),
    "spline": spline(),
}


@pytest.mark.sample(6)
@pytest.mark.parametrize("damping", [0.0, 0.05, 0.6, 1.0, 1.3])
@pytest.mark.parametrize("nu", [4.0, 20.0, 90.0])
@pytest.mark.parametrize("name", LAWS)
def test_the_mass_does_what_it_was_meant_to(name: str, nu: float, damping: float) -> None:
    law = LAWS[name]
    cam = polydyne(law, nu, damping)
    follower = Follower(nu, damping).response(cam)
    size = cam.constants.C.value / nu  # what the cam asks of the integrals
    assert follower.a(K) == pytest.approx(law.a(K), abs=1e-13 * max(1.0, size))
    assert follower.c(K) == pytest.approx(law.c(K), abs=1e-12 * max(1.0, size) * max(nu, 8.0) ** 2)
    assert follower.residual_acceleration < 1e-11 * max(1.0, size) * max(nu, 8.0) ** 2
    assert [cam.a(0.0), cam.a(1.0), cam.b(0.0), cam.b(1.0)] == pytest.approx([0, 1, 0, 0], abs=1e-9)


@examples(40)
@given(st.sampled_from(["III", "IV"]), st.floats(0.0, 1.0), st.floats(2.0, 200.0), st.floats(0.0, 1.5))
def test_back_and_forth(family: str, part: float, nu: float, damping: float) -> None:
    low, high = ALPHAS[family]
    law = savin(family, low + part * (high - low))
    back = mass_law(polydyne(law, nu, damping), nu, damping)
    size = float(np.abs(law.to_powers()).max()) * max(1.0, 20.0 / nu) ** 9
    expected = [*law.to_powers(), *[0.0] * 12][:12]
    assert [*back.to_powers(), *[0.0] * 12][:12] == pytest.approx(expected, abs=1e-12 * size)


def test_the_mass_of_any_polynomial_cam_swings_about_its_mass_law() -> None:
    cam = smoothstep(3)
    steady, found = mass_law(cam, 30.0, 0.1), Follower(30.0, 0.1).response(cam)
    free = Follower(30.0, 0.1).response(PolynomialLaw([]), initial=(-steady.a(0.0), -steady.b(0.0)))
    assert found.a(K) == pytest.approx(steady.a(K) + free.a(K), abs=1e-14)
    forced = Follower(30.0, 0.1).response(cam, initial=(steady.a(0.0), steady.b(0.0)))
    assert forced.a(K) == pytest.approx(steady.a(K), abs=1e-14)


@pytest.mark.parametrize(
    ("law", "says"),
    [
        (savin("I", 0.0), r"acceleration c\(0\) = 6, so the displacement of the cam would jump there.*order 4"),
        (savin("I", -10.0), r"jerk j\(0\) = 60, so the velocity of the cam would jump"),
        (savin("II", 7.0), r"jerk j\(0\) = 120, so the velocity of the cam would jump there; use a law"),
        (smoothstep(1), r"velocity b\(0\) = 1, so the displacement"),
        (smoothstep(3), r"jerk j\(0\) = 60"),
        (catalogue["modified trapezoid"].law, r"jerk j\(0\) = 61\.4"),
        (catalogue["double harmonic"].law, r"acceleration c\(1\) = -9\.8696"),
        (PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((4.0,)), PolynomialSegment((-4.0,), 2.0)]), r"c\(0\) = 4"),
        (PolynomialLaw.from_powers([0, 0, 0, 0, 1]), r"velocity b\(1\) = 4"),
        (None, "law must be a motion law"),
    ],
)
def test_a_law_that_is_not_smooth_enough_is_refused(law: MotionLaw, says: str) -> None:
    with pytest.raises(InputError, match=says):
        polydyne(law, 20.0)


@pytest.mark.parametrize(
    ("bump", "says"),
    [((0.0, 1.0), r"jump of its acceleration c by .* at k = 0\.333"), ((0.0, -1.0, 0.0, 1.0), "jump of its jerk j by")],
)
def test_a_jump_within_the_motion_is_refused(bump: tuple[float, ...], says: str) -> None:
    """4-5-6-7 whose c has a bump in the middle third that leaves b, or b and c, continuous."""
    first, middle, last = cut(smoothstep(4), 1 / 3, 2 / 3).segments
    assert isinstance(middle, PolynomialSegment)
    raised = np.array(middle.acceleration)
    raised[: len(bump)] += bump
    law = PiecewiseLaw([0, 1 / 3, 2 / 3, 1], [first, PolynomialSegment(tuple(raised.tolist()), middle.b0), last])
    with pytest.raises(InputError, match=says):
        polydyne(law, 20.0)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: polydyne(smoothstep(4), 0.0), "frequency must be above 0"),
        (lambda: polydyne(smoothstep(4), 20.0, -1.0), "damping must be at least 0"),
        (lambda: mass_law(catalogue["cycloidal"].law, 20.0), "cam must be a PolynomialLaw; Follower"),
        (lambda: mass_law(smoothstep(4), -20.0), "frequency must be above 0"),
    ],
)
def test_nonsense_is_refused(call: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        call()  # type: ignore[operator]


# --- the experiment's cams ---


COEFFICIENTS, PEAKS, OFF_DESIGN = rows("savin_cam_coeffs"), rows("savin_cam_peaks"), rows("savin_off_design")
ALPHA = {"III": 7.2, "IV": 11.0}


@cache
def reference(law: str) -> MotionLaw:
    """The law meant for the mass: of a family, or the simple harmonic one, K."""
    family = law.removesuffix("_rigid")
    return catalogue["simple harmonic"].law if family == "K" else savin(family, ALPHA[family])


@cache
def cam(law: str, n_design: str) -> MotionLaw:
    """What is cut on the cam: for nu = 20 and n_design, or the law itself where there is none."""
    return polydyne(reference(law), frequency=20, damping=float(n_design) / 20) if n_design else reference(law)


def name(row: dict[str, str]) -> str:
    return "-".join(row[key] for key in ("law", "family", "n_design", "n", "i", "variant", "pct") if row.get(key))


def test_the_tables_are_whole() -> None:
    assert (len(COEFFICIENTS), len(PEAKS), len(OFF_DESIGN)) == (44, 4, 85)


@pytest.mark.parametrize("row", COEFFICIENTS, ids=name)
def test_coefficients_of_mass_and_cam(row: dict[str, str]) -> None:
    i = int(row["i"])
    mass = savin(row["family"], float(row["alpha"])).to_powers()
    disc = cam(row["family"], row["n"]).to_powers()  # type: ignore[attr-defined]
    assert mass[i] == pytest.approx(float(Fraction(row["Q_exact"])), rel=1e-12, abs=1e-12)
    assert disc[i] == pytest.approx(float(Fraction(row["q_exact"])), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("n", ["0", "1"])
@pytest.mark.parametrize("family", ["III", "IV"])
def test_the_relation_is_exact_in_whole_numbers(family: str, n: str) -> None:
    mine = [row for row in COEFFICIENTS if (row["family"], row["n"]) == (family, n)]
    Q = tuple(Fraction(row["Q_exact"]) for row in mine)
    # zeta = 1/20 is no binary number, so the frequency is taken 20 times, where n/nu = 1/20 needs none
    found = cam_powers(Q, 20.0, 0.0)
    if n == "0":
        assert found == [Fraction(row["q_exact"]) for row in mine]
    else:
        damped = [2 * (i + 1) * Fraction(1, 400) * Q[i + 1] if i + 1 < len(Q) else Fraction(0) for i in range(len(Q))]
        exact = [Fraction(row["q_exact"]) for row in mine]
        assert [a + b for a, b in zip(found, damped, strict=True)] == exact


@pytest.mark.parametrize("row", PEAKS, ids=name)
def test_peaks_of_the_cams(row: dict[str, str]) -> None:
    law = cam(row["family"], row["n"])
    mass = reference(row["family"]).constants
    assert law.constants.B.value == pytest.approx(float(row["B_cam"]), rel=1e-9)
    assert law.constants.C.value == pytest.approx(float(row["C_cam"]), rel=1e-9)
    assert law.constants.B.k == pytest.approx(float(row["kB_cam"]), abs=1e-9)
    assert law.constants.C.k == pytest.approx(float(row["kC_cam"]), abs=1e-9)
    assert law.c([0.0, 1.0]).tolist() == pytest.approx([float(row["c_cam_0"]), float(row["c_cam_1"])], abs=1e-9)
    assert law.j(0.0) == pytest.approx(float(row["dc_cam_0"]), rel=1e-9)
    assert (mass.B.value, mass.C.value) == pytest.approx((float(row["B_mass"]), float(row["C_mass"])), rel=1e-9)
    assert law.extrema(1)[0].value == pytest.approx(0.0, abs=1e-12)  # monotone


@pytest.mark.sample(2)
@pytest.mark.parametrize("row", OFF_DESIGN, ids=name)
def test_off_design(row: dict[str, str]) -> None:
    law, nu = reference(row["law"]), float(row["nu_actual"])
    follower = Follower(nu, float(row["n_actual"]) / nu).response(cam(row["law"], row["n_design"]))
    peak = follower.peak(2)
    for key, value in {
        "C_designed": law.constants.C.value,
        "C_actual_rise": peak.value,
        "kd_rise": follower.dynamic_factor(law),
        "C_actual_dwell": follower.dwell_peak(2).value,
        "kd_all": follower.dynamic_factor(law, dwell=True),
        "res_disp_amp": follower.residual_displacement,
        "res_acc_amp": follower.residual_acceleration,
    }.items():
        assert value == pytest.approx(float(row[key]), rel=1e-9, abs=1e-11), key
    assert peak.k == pytest.approx(float(row["k_peak"]), abs=6e-7)
