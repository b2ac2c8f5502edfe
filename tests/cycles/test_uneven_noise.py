"""Tables whose noise, digits or points are not alike all over: worn flanks, joined tables, bursts of wrong points."""

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import OldTable, catalogue, split_table

Array = NDArray[np.float64]

DWELLS = [(0.0, 62.0), (155.0, 218.0), (301.0, 360.0)]
STROKE = 24.0
LAW = catalogue["3-4-5 polynomial"].law


def motion(x: Array) -> Array:
    return np.asarray(STROKE * (LAW(np.clip((x - 62.0) / 93.0, 0.0, 1.0)) - LAW(np.clip((x - 218.0) / 83.0, 0.0, 1.0))))


def is_read(table: OldTable, room: float) -> None:
    dwells = [(each.start, each.stop) for each in table.stretches if each.kind == "dwell"]
    np.testing.assert_allclose(dwells, DWELLS, atol=room)
    for peak, nu, length in zip(table.peaks, (1, 2), (93.0, 83.0), strict=False):
        greatest = STROKE * max(LAW.peak(nu).value / length**nu for length in (93.0, 83.0))
        assert peak.low <= greatest <= peak.high <= 1.3 * greatest


@pytest.mark.sample(3)
@pytest.mark.parametrize("worn", [25.0, 120.0, 250.0])
def test_a_worn_flank_has_noise_of_its_own(worn: float) -> None:
    x = np.linspace(0.0, 360.0, 721)
    noise = np.random.default_rng(int(worn)).normal(0.0, np.where(np.abs(x - worn - 30.0) < 30.0, 15e-3, 2e-3))
    table = split_table(x, np.round(motion(x) + noise, 4))
    assert table.outliers == ()
    is_read(table, 4.0)


def test_rows_of_fewer_decimals_have_more_noise() -> None:
    x = np.concatenate([np.arange(0.0, 180.0, 1.0), np.arange(180.0, 360.2, 0.5)])
    table = split_table(x, np.where(x < 180.0, np.round(motion(x), 2), np.round(motion(x), 3)), digit=1e-3)
    assert table.outliers == ()
    is_read(table, 3.0)


@pytest.mark.sample(6)
@pytest.mark.parametrize("rows", [2, 3, 4])
@pytest.mark.parametrize("first", [70, 250, 330, 520])
def test_wrong_points_beside_each_other_are_left_out(rows: int, first: int) -> None:
    x, generator = np.linspace(0.0, 360.0, 721), np.random.default_rng(rows + first)
    y = motion(x) + generator.normal(0.0, 2e-3, 721)
    y[first : first + rows] += 0.2 * generator.uniform(0.6, 1.0, rows)
    table = split_table(x, np.round(y, 4))
    assert table.outliers == tuple(range(first, first + rows))
    is_read(table, 4.0)


def test_many_moves_in_a_turn_without_rest_are_met() -> None:
    x = np.linspace(0.0, 360.0, 721)
    y = np.round(6.0 * (1.0 - np.cos(np.radians(8.0 * x))) + 0.5 * np.cos(np.radians(24.0 * x)), 3)
    table = split_table(x, y)
    dense = np.linspace(0.0, 360.0, 7201)
    exact = 6.0 * (1.0 - np.cos(np.radians(8.0 * dense))) + 0.5 * np.cos(np.radians(24.0 * dense))
    assert np.abs(table.at(dense) - exact).max() < 2e-3


def test_wrong_points_where_ramps_begin_and_end_are_left_out() -> None:
    """A parabola between lines was compared with the rows that were there before two of them were left out."""
    x = np.linspace(0.0, 360.0, 721)
    turns, speeds = [30.0, 50.0, 160.0, 180.0, 200.0, 310.0, 330.0], [0.0, 0.05, 0.05, 0.0, -0.05, -0.05, 0.0]
    exact = 0.5 * np.cumsum(np.interp(x, turns, speeds))
    y = exact + np.random.default_rng(0).normal(0.0, 1e-4, 721)
    y[[86, 622]] += [-1.4e-3, 1e-3]
    table = split_table(x, np.round(y, 4))
    assert set(table.outliers) <= {86, 622}
    assert np.abs(table.at(x) - exact).max() < 5e-4
