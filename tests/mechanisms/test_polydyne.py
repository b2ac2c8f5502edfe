"""Polydyne cams: their mass does what it was meant to do, and back."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    Chebyshev,
    Follower,
    InputError,
    MotionLaw,
    PiecewiseLaw,
    PolynomialLaw,
    Problem,
    catalogue,
    mass_law,
    polydyne,
    savin,
    smoothstep,
    synthesize,
)
from tests.internals.laws import PolynomialSegment, PowerSegment, SineSegment
from tests.laws.examples import cut
from tests.mechanisms.response_cases import Case, integrated
from tests.sampling import examples

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


def sine_on_a_parabola() -> PiecewiseLaw:
    """One sine segment with powers, smooth at the ends as far as it goes."""
    return PiecewiseLaw([0, 1], [SineSegment(2.0, 3.0, 0.4, 0.1, (0.3, -0.2, 0.5))])


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


@pytest.mark.parametrize("name", LAWS)
def test_the_cam_is_the_sum_of_derivatives(name: str) -> None:
    law, nu, damping = LAWS[name], 13.0, 0.2
    cam = polydyne(law, nu, damping)
    inside = K[1:-1] + 1e-4
    for order in range(3):
        sum_of_three = law(inside, order) + 2 * damping / nu * law(inside, order + 1) + law(inside, order + 2) / nu**2
        size = 1 + np.abs(sum_of_three).max()
        assert cam(inside, order) == pytest.approx(sum_of_three, abs=1e-10 * size)


def test_an_integrator_agrees() -> None:
    law = LAWS["triple harmonic"]
    cam = polydyne(law, 15.0, 0.1)
    k = [0.2, 0.5, 0.8, 1.0, 1.2]
    case = Case(cam, lambda t: float(cam.a(t)), 15.0, 0.1, (0.0, 0.0))
    expected = [*law.a(k[:4]).tolist(), 1.0]
    assert integrated(case, k)[:, 0] == pytest.approx(expected, abs=1e-10)


def test_a_sine_with_powers_keeps_its_form() -> None:
    (segment,) = sine_on_a_parabola().segments
    once, twice = 0.3, 0.07
    made = segment.plus_derivatives(0.8, once, twice)
    assert isinstance(made, SineSegment)
    u = np.linspace(0.0, 1.0, 7)
    for order in (1, 2, 3):
        expected = sum(f * segment.derivative(u, 0.8, order + i) for i, f in enumerate((1.0, once, twice)))
        assert made.derivative(u, 0.8, order) == pytest.approx(expected, abs=1e-12)


def test_a_kind_of_segment_that_is_unknown_becomes_a_polynomial() -> None:
    segment = PowerSegment(1.0, 1.5)
    made = segment.plus_derivatives(0.5, 0.3, 0.07)
    u = np.linspace(0.0, 1.0, 7)
    expected = sum(f * segment.derivative(u, 0.5, 2 + i) for i, f in enumerate((1.0, 0.3, 0.07)))
    assert made.derivative(u, 0.5, 2) == pytest.approx(expected, abs=1e-11)


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


def test_a_cam_of_an_optimal_law() -> None:
    law = synthesize(Problem(B=1.859, order=4, basis=Chebyshev(9))).law
    cam = polydyne(law, 20.0, 0.05)
    follower = Follower(20.0, 0.05).response(cam)
    assert follower.dynamic_factor(law) == pytest.approx(1.0, abs=1e-9)
    assert isinstance(cam, PolynomialLaw)
    assert cam.constants.B.value < 2.2


@pytest.mark.parametrize(
    ("law", "says"),
    [
        (savin("I", 0.0), r"acceleration c\(0\) = 6, so the displacement of the cam would jump there.*order 4"),
        (savin("I", -10.0), r"jerk j\(0\) = 60, so the velocity of the cam would jump"),
        (
            savin("II", 7.0),
            r"jerk j\(0\) = 120, so the velocity of the cam would jump there; use a law",
        ),
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
