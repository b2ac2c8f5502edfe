"""What every law must do, whatever its representation: a new one is a line in examples.py."""

import copy
import dataclasses
import itertools
import json
import pickle
from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from tests.laws.examples import EXAMPLES

NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)
DENSE = np.linspace(0.0, 1.0, 20001)

every_law = pytest.mark.parametrize("law", EXAMPLES.values(), ids=EXAMPLES.keys())
every_order = pytest.mark.parametrize("nu", range(4))


def panels(law: MotionLaw, end: float = 1.0) -> list[tuple[np.ndarray, np.ndarray]]:
    """Points and weights of a quadrature over [0, end] on each of whose panels the law is smooth."""
    breaks = law.breaks if isinstance(law, PiecewiseLaw) else (0.0, 1.0)
    places = [*(k for k in breaks if k < end), end]
    pairs = [(0.5 * (low + high), 0.5 * (high - low)) for low, high in itertools.pairwise(places)]
    return [(middle + half * NODES, half * WEIGHTS) for middle, half in pairs]


def integral(law: MotionLaw, nu: int, end: float) -> float:
    return sum(float(weights @ law(k, nu)) for k, weights in panels(law, end))


def leaps(law: MotionLaw, nu: int, end: float = 1.0) -> float:
    """What the jumps of a derivative up to `end` add to it."""
    return sum(height for k, height in law.jumps(nu) if k <= end) if isinstance(law, PiecewiseLaw) else 0.0


def far_from_breaks(law: MotionLaw, k: float, reach: float) -> bool:
    return not isinstance(law, PiecewiseLaw) or min(abs(k - place) for place in law.breaks) > reach


def size(law: MotionLaw, nu: int) -> float:
    return float(np.abs(law(DENSE, nu)).max())


@every_law
@every_order
@pytest.mark.parametrize("end", [0.1, 0.5, 0.83, 1.0])
def test_each_derivative_integrates_the_next(law: MotionLaw, nu: int, end: float) -> None:
    change = integral(law, nu + 1, end) + leaps(law, nu, end)
    assert law(end, nu) - law(0.0, nu) == pytest.approx(change, abs=1e-12 * size(law, nu + 1))


@every_law
@pytest.mark.parametrize("k", [0.2, 0.5, 0.77])
def test_acceleration_integrated_twice_gives_the_displacement(law: MotionLaw, k: float) -> None:
    twice = sum(float(weights @ ((k - points) * law.c(points))) for points, weights in panels(law, k))
    assert law.a(k) == pytest.approx(law.a(0.0) + k * law.b(0.0) + twice, abs=1e-13 * (1 + size(law, 2)))


@every_law
@pytest.mark.parametrize("k", [0.21, 0.5, 0.87])
def test_derivatives_agree_with_differences_of_the_displacement(law: MotionLaw, k: float) -> None:
    step = 1e-3
    k += 0.0 if far_from_breaks(law, k, 4 * step) else 7 * step
    for nu in (1, 2, 3):
        difference = mpmath.diff(lambda t, nu=nu: law(float(t), nu - 1), k, h=step, direction=0)
        assert float(difference) == pytest.approx(law(k, nu), abs=step * size(law, nu + 1) + 1e-9)


@every_law
def test_named_derivatives_are_the_numbered_ones(law: MotionLaw) -> None:
    for nu, named in enumerate((law.a, law.b, law.c, law.j)):
        assert np.array_equal(named(DENSE), law(DENSE, nu))
    assert np.array_equal(law.d(DENSE), law.b(DENSE) * law.c(DENSE))


@every_law
def test_boundary_values_are_the_derivatives_at_the_ends(law: MotionLaw) -> None:
    start, end = law.boundary_values(5)
    assert start == tuple(law(0.0, nu) for nu in range(5))
    assert end == tuple(law(1.0, nu) for nu in range(5))
    assert law.boundary_values(0) == ((), ())


@every_law
@every_order
def test_peak_is_no_less_than_samples_and_no_more_than_their_spacing_allows(law: MotionLaw, nu: int) -> None:
    sampled = size(law, nu)
    allowance = law.peak(nu + 2).value * (DENSE[1] / 2) ** 2 / 2
    rounding = 1e-13 * sampled
    assert sampled - rounding <= law.peak(nu).value <= sampled + allowance + rounding


@every_law
def test_power_peak_is_no_less_than_samples_and_no_more_than_their_spacing_allows(law: MotionLaw) -> None:
    sampled = float(np.abs(law.d(DENSE)).max())
    b, c, j, s = (law.peak(nu).value for nu in (1, 2, 3, 4))
    allowance = (3 * c * j + b * s) * (DENSE[1] / 2) ** 2 / 2
    assert sampled * (1 - 1e-13) <= law.power_peak().value <= sampled * (1 + 1e-13) + allowance


@every_law
@every_order
def test_extrema_bracket_the_samples_and_make_the_peak(law: MotionLaw, nu: int) -> None:
    low, high = law.extrema(nu)
    values = law(DENSE, nu)
    slack = 1e-13 * size(law, nu)
    assert low.value <= values.min() + slack
    assert high.value >= values.max() - slack
    assert law.peak(nu).value == max(abs(low.value), abs(high.value))


@every_law
def test_peaks_are_reached_where_they_are_said_to_be(law: MotionLaw) -> None:
    one = law.constants
    for nu, peak in ((1, one.B), (2, one.C), (3, one.J)):
        assert abs(law(peak.k, nu)) == pytest.approx(peak.value, rel=2e-10, abs=1e-300)
    assert abs(law.d(one.D.k)) == pytest.approx(one.D.value, rel=2e-10, abs=1e-300)


@every_law
def test_rms_of_acceleration_is_the_integral(law: MotionLaw) -> None:
    square = sum(float(weights @ law.c(points) ** 2) for points, weights in panels(law))
    assert law.constants.rms_c == pytest.approx(square**0.5, rel=1e-12)


@every_law
def test_constants_as_plain_data(law: MotionLaw) -> None:
    table = law.constants.to_dict()
    assert list(table) == ["B", "C", "D", "J"]
    assert table["C"] == {"value": law.peak(2).value, "k": law.peak(2).k}
    assert law.constants.to_dict(rms=True)["rms_c"] == law.constants.rms_c
    assert json.loads(json.dumps(table)) == table


@every_law
def test_dict_and_json_give_an_equal_law(law: MotionLaw) -> None:
    for back in (MotionLaw.from_dict(law.to_dict()), MotionLaw.from_json(law.to_json())):
        assert back == law
        assert hash(back) == hash(law)
        assert type(back) is type(law)
        assert np.array_equal(back(DENSE), law(DENSE))
    assert json.loads(law.to_json()) == law.to_dict()


@every_law
def test_copies_and_pickles_are_equal(law: MotionLaw) -> None:
    assert law.constants.B.value >= 0.0
    assert copy.deepcopy(law) == law
    assert pickle.loads(pickle.dumps(law)) == law  # noqa: S301


def test_laws_are_equal_to_themselves_only() -> None:
    assert len(set(EXAMPLES.values())) == len(EXAMPLES)


@every_law
def test_a_law_cannot_be_changed(law: MotionLaw) -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        law.a0 = 1.0  # type: ignore[attr-defined]
    with pytest.raises(dataclasses.FrozenInstanceError):
        law.constants.B.value = 1.0  # type: ignore[misc]
    before = law(DENSE, 2)
    values = law(DENSE, 2)
    values *= 2.0
    assert np.array_equal(law(DENSE, 2), before)


@every_law
def test_values_have_the_shape_of_k(law: MotionLaw) -> None:
    several: list[Any] = [DENSE[:6].reshape(2, 3), DENSE[:6].reshape(2, 3).tolist(), np.empty((0, 2)), [0, 1]]
    for k in several:
        assert law(k).shape == np.shape(k)
    single: list[Any] = [0.5, 1, np.float64(0.5), np.array(0.5), np.float32(0.5)]
    assert {type(law(k)) for k in single} == {float}
    assert law(0.3, 2) == law([0.3, 0.4], 2)[0]
    assert np.array_equal(law(DENSE[::-1], 1), law(DENSE, 1)[::-1])


@every_law
@pytest.mark.parametrize("k", [-1e-9, 1.0000001, np.nan, np.inf, "0.5", None, 0.5j, [0.2, 1.5], [[0.1], [0.1, 0.2]]])
def test_k_outside_the_interval_is_refused(law: MotionLaw, k: Any) -> None:  # noqa: ANN401
    for call in (law, law.a, law.b, law.c, law.j, law.d):
        with pytest.raises(InputError, match="k must be"):
            call(k)


@every_law
@pytest.mark.parametrize("nu", [-1, 1.0, "1", None, True])
def test_orders_of_derivatives_are_integers_from_0(law: MotionLaw, nu: Any) -> None:  # noqa: ANN401
    for call in (lambda: law(0.5, nu), lambda: law.peak(nu), lambda: law.extrema(nu)):
        with pytest.raises(InputError, match="nu must be an integer of at least 0"):
            call()
    with pytest.raises(InputError, match="count must be an integer"):
        law.boundary_values(nu)


@every_law
def test_repr_and_html_show_the_constants(law: MotionLaw) -> None:
    assert repr(law).startswith(f"{type(law).__name__}(")
    assert f"C={law.peak(2).value:g}" in repr(law)
    html = law._repr_html_()
    assert html.count("<svg") == html.count("</svg>") == 3
    assert f"{law.peak(2).value:.7g}" in html
    assert "nan" not in html
