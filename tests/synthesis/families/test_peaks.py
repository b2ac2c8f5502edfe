"""Peaks of many series at once, where a grid shows none of them."""

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from tests.internals.synthesis import peaks


@pytest.mark.parametrize("count", [4, 12, 40])
def test_a_peak_beside_an_end_is_found_however_near_it_is(count: int) -> None:
    away = np.concatenate([10.0 ** -np.arange(1.0, 9.0, 0.25), [0.3, 0.5]])
    # 8 - (u - place)² about places near both ends
    places = np.concatenate([1.0 - away, away - 1.0])
    series = np.zeros((len(places), count))
    series[:, :3] = np.array([chebyshev.poly2cheb([8.0 - one**2, 2.0 * one, -1.0]) for one in places.tolist()])
    for sign in (1.0, -1.0):
        np.testing.assert_allclose(peaks(sign * series), 8.0 * np.ones(len(places)), rtol=1e-12)


def test_peaks_of_random_series_are_those_at_their_stationary_points() -> None:
    rng = np.random.default_rng(11)
    series = rng.normal(size=(300, 9)) * 0.7 ** np.arange(9)
    for one, found in zip(series, peaks(series).tolist(), strict=True):
        roots = chebyshev.chebroots(chebyshev.chebder(one))
        inside = roots[np.abs(roots.imag) < 1e-7].real
        places = np.concatenate([[-1.0, 1.0], inside[np.abs(inside) <= 1.0]])
        assert found == pytest.approx(np.abs(chebyshev.chebval(places, one)).max(), rel=1e-10)
