"""Response spectra: closed forms against quadrature, single responses and each other, and how long they take."""

import time
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from optlaws import (
    Follower,
    InputError,
    PolynomialLaw,
    catalogue,
    off_design,
    polydyne,
    residual_functional,
    residual_phasor,
    response_spectrum,
    savin,
    smoothstep,
)
from tests.internals.mechanisms import moments
from tests.laws.examples import EXAMPLES, cut_power, random_law
from tests.mechanisms.response_cases import random_case
from tests.sampling import examples, sampled

NUS = [2.0, 2 * np.pi, 20.0, 63.0, 200.0]


@pytest.mark.parametrize("sigma", [-1e-9 + 1e-3j, 1j * np.pi, 5j, 4.493409457909064j, 100j, -3 + 100j, -60.0, -1e4])
def test_moments_of_legendre_polynomials(sigma: complex) -> None:
    """Against Gauss-Legendre quadrature on short panels."""
    moment_values = moments(np.array([complex(sigma)]), 41)[0]
    nodes, weights = np.polynomial.legendre.leggauss(40)
    panels = np.linspace(1.0, -1.0, 61)
    if sigma == -1e4:
        panels = 1.0 - 2.0 * np.concatenate([[0.0], np.geomspace(1e-6, 1.0, 400)])
    total = np.zeros(41, dtype=complex)
    for high, low in pairwise(panels.tolist()):
        x = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        values = np.exp(complex(sigma) * (1 - x)) * weights * 0.25 * (high - low)
        total += values @ np.polynomial.legendre.legvander(x, 40)
    assert moment_values == pytest.approx(total, abs=3e-14)


@pytest.mark.sample(4)
@pytest.mark.parametrize("damping", sampled([0.03, 0.0, 0.999]))
@pytest.mark.parametrize("name", [*EXAMPLES, "modified sine", "0317(1,5)", "triple harmonic", "simple harmonic"])
def test_the_residual_is_that_of_a_response(name: str, damping: float) -> None:
    law = EXAMPLES[name] if name in EXAMPLES else catalogue[name].law
    found = residual_phasor(law, NUS, damping)
    for nu, phasor in zip(NUS, found, strict=True):
        response = Follower(nu, damping).response(law)
        size = max(1.0, float(np.abs(law.b(np.linspace(0, 1, 9))).max())) / nu / (1 - damping**2) ** 0.5
        assert abs(phasor) == pytest.approx(response.residual_displacement, abs=1e-12 * size)
        w = complex(-damping * nu, nu * (1 - damping**2) ** 0.5)
        later = law.a(1.0) + (phasor * np.exp(w * 0.37)).real
        assert response.a(1.37) == pytest.approx(later, abs=1e-12 * max(1.0, size, abs(law.a(1.0))))


@pytest.mark.parametrize("nu", NUS[:4])
def test_the_residual_is_the_fourier_integral_of_the_acceleration(nu: float) -> None:
    law = savin("IV", 11.0)
    real = quad(lambda k: law.c(k) * np.cos(nu * k), 0, 1, epsabs=1e-13, limit=400)[0]
    imaginary = quad(lambda k: law.c(k) * np.sin(nu * k), 0, 1, epsabs=1e-13, limit=400)[0]
    spectrum = response_spectrum(law, [nu])
    assert spectrum.residual_acceleration[0] == pytest.approx(nu * np.hypot(real, imaginary), abs=1e-11)


@examples(40)
@given(st.integers(0, 400), st.floats(2.0, 200.0), st.floats(0.0, 0.95))
def test_the_functional_is_the_phasor(seed: int, nu: float, damping: float) -> None:
    law = random_case(2 * seed + 1).law
    assert isinstance(law, PolynomialLaw)
    rows, start = residual_functional(len(law.acceleration), [nu], damping)
    found = rows @ np.array(law.acceleration) + start * law.b0
    assert found == pytest.approx(nu**2 * residual_phasor(law, nu, damping), abs=1e-12 * nu**2)


@pytest.mark.parametrize(("family", "alpha"), [("III", 7.2), ("IV", 11.0)])
@pytest.mark.parametrize(("design", "damping"), [(0.0, 0.0), (0.05, 0.05), (0.0, 0.05), (0.05, 0.0)])
def test_a_polydyne_cam_divides_the_residual(family: str, alpha: float, design: float, damping: float) -> None:
    """The cam made for (nu0, n0) leaves that of the law itself times |1 - nu²/nu0² + 2 (n0 - n) w/nu0²|."""
    law, nu = savin(family, alpha), np.linspace(5.0, 40.0, 200)
    cut, direct = (response_spectrum(one, nu, damping) for one in (polydyne(law, 20.0, design), law))
    n0, n = design * 20.0, damping * nu
    w = -n + 1j * nu * np.sqrt(1 - damping**2)
    factor = np.abs(1 - nu**2 / 400 + 2 * (n0 - n) * w / 400)
    assert cut.residual_acceleration == pytest.approx(factor * direct.residual_acceleration, rel=1e-9, abs=1e-10)


@settings(max_examples=20)
@given(st.integers(0, 400), st.floats(0.0, 0.95), st.lists(st.floats(2.0, 200.0), min_size=1, max_size=3))
@example(182, 0.3125, [42.0])  # the highest lobe has its last sample just before the end of a segment
def test_peaks_are_those_of_single_responses(seed: int, damping: float, nus: list[float]) -> None:
    law = random_case(seed).law
    peak_acceleration = response_spectrum(law, nus, damping).peak_acceleration
    expected = [Follower(nu, damping).response(law).peak(2).value for nu in nus]
    assert peak_acceleration == pytest.approx(expected, rel=3e-5)


def test_constant_power_has_a_spectrum() -> None:
    spectrum = response_spectrum(cut_power(0.0, 1.5), NUS)
    assert np.isfinite(spectrum.peak_acceleration).all()


def test_ten_thousand_points_take_less_than_a_second() -> None:
    nu = np.linspace(2.0, 200.0, 10_000)
    for law in (smoothstep(4), random_law(2, 60, 0.9), catalogue["modified trapezoid"].law):
        response_spectrum(law, nu[:10], 0.02)
        start = time.process_time()
        spectrum = response_spectrum(law, nu, 0.02).residual_acceleration
        assert time.process_time() - start < 1.0
        assert spectrum.shape == (10_000,)


def test_off_design_changes_speed_or_stiffness() -> None:
    law = savin("III", 7.2)
    cam = polydyne(law, 20.0, 0.05)
    speed, stiffness = (
        off_design(cam, law, Follower(20.0, 0.05), deviations=[-10, 0, 10], change=change)
        for change in ("speed", "stiffness")
    )
    assert [one.response.frequency for one in speed] == pytest.approx([18.0, 20.0, 22.0])
    assert [one.response.damping for one in speed] == [0.05] * 3
    assert [one.response.damping * one.response.frequency for one in stiffness] == pytest.approx([1.0] * 3)
    assert speed[1].dynamic_factor == pytest.approx(1.0, abs=1e-12)
    assert speed[0].peak.value == speed[0].response.peak(2).value


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: response_spectrum(smoothstep(4), [20.0, 0.0]), "frequency must be above 0, got 0.0"),
        (lambda: response_spectrum(smoothstep(4), [20.0, "x"]), "frequency"),
        (lambda: response_spectrum(smoothstep(4), 20.0, 1.0), "from the critical damping on nothing vibrates"),
        (lambda: residual_phasor(smoothstep(4), 20.0, -0.1), "damping must be at least 0"),
        (lambda: residual_functional(0, 20.0), "count must be an integer of at least 1"),
        (lambda: response_spectrum("IV", [20.0]), "law must be a motion law"),  # type: ignore[arg-type]
        (lambda: off_design(smoothstep(4), smoothstep(4), Follower(20), deviations=[-100]), "above -100"),
        (lambda: off_design(smoothstep(4), smoothstep(4), Follower(20), change="mass"), "change"),  # type: ignore[arg-type]
    ],
)
def test_nonsense_is_refused(call: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        call()  # type: ignore[operator]
