"""Tables of motions whose acceleration jumps, exact and of few rows, or noisy: parabolas, lines, circular arcs."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import split_table
from tests.cycles.simulated_cams import simulated_cam

Array = NDArray[np.float64]


def parabolas_and_lines(share: float, skew: float) -> Callable[[Array], Array]:
    """One rise and two returns between dwells: a parabola, a line and a parabola, which take a share of the move."""

    def law(k: Array, skew: float) -> Array:
        first, last = share * skew, share * (1.0 - skew)
        velocity, k = 1.0 / (1.0 - share / 2.0), np.clip(k, 0.0, 1.0)
        line = velocity * (k - first / 2.0)
        ends = velocity * k**2 / (2.0 * first), 1.0 - velocity * (1.0 - k) ** 2 / (2.0 * last)
        return np.where(k < first, ends[0], np.where(k > 1.0 - last, ends[1], line))

    moves = [(67.0, 71.0, 27.7, skew), (171.0, 73.0, -19.39, 1.0 - skew), (284.0, 75.0, -8.31, skew)]
    return lambda x: sum((size * law((x - start) / long, at) for start, long, size, at in moves), np.zeros_like(x))


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("step", "share", "skew"),
    [
        (3.6, 0.4, 0.4),
        (3.6, 0.4, 0.5),
        (2.0, 2.0 / 3.0, 0.4),
        (1.0, 1.0, 0.4),
    ],
)
def test_few_exact_rows_are_all_of_the_motion_and_it_goes_through_them(step: float, share: float, skew: float) -> None:
    """Up to eight rows were left out, and splines of nearly as many pieces as rows swung between these by 0.1 to 8 mm.

    What a motion is off between rows of a jump of acceleration is of the size of that times the step squared.
    """
    motion = parabolas_and_lines(share, skew)
    x, fine = np.arange(0.0, 360.0 + step / 2.0, step), np.linspace(0.0, 360.0, 7201)
    table = split_table(x, np.round(motion(x), 4))
    assert table.outliers == ()
    assert table.corners == ()
    bends = np.diff(motion(fine), 2) / (fine[1] - fine[0]) ** 2
    assert np.abs(table.at(fine) - motion(fine)).max() < 2e-4 + 0.05 * np.abs(bends).max() * step**2


@pytest.mark.sample(3)
@pytest.mark.parametrize(("rows", "noise"), [(361, 1e-3), (361, 1e-2), (1441, 5e-3)])
def test_the_velocity_of_circular_arcs_is_within_its_interval(rows: int, noise: float) -> None:
    """A flat follower on arcs of 18, 64 and 3 mm about it is quickest where the flank meets the nose, at a kink.

    Splines of pieces smooth the kink, and the upper end was 1 to 4 % below.
    """
    base, nose, lift, half = 18.0, 3.0, 8.0, np.radians(60.0)
    away = base + lift - nose
    flank = (base**2 - nose**2 + away**2 - 2.0 * base * away * np.cos(half)) / 2.0 / (base - nose - away * np.cos(half))
    meeting = np.arcsin(away * np.sin(half) / (flank - nose))
    x = np.linspace(0.0, 360.0, rows)
    left = half - np.abs(np.radians(x - 90.0))  # of the angle from where the flank begins
    on_nose = away * np.cos(half - left) + nose - base
    y = np.select([left <= 0.0, left < meeting], [0.0, (flank - base) * (1.0 - np.cos(left))], on_nose)
    y += np.random.default_rng(3).normal(0.0, noise, rows)
    velocity = (flank - base) * np.sin(meeting) * np.pi / 180.0
    table = split_table(x, np.round(y, 4), digit=1e-4)
    assert table.peaks[0].holds(velocity)
    assert table.peaks[0].high < 1.15 * velocity


@pytest.mark.sample(2)
@pytest.mark.parametrize("row", [66, 176])
def test_rows_that_are_swapped_do_not_bend_the_motion(row: int) -> None:
    """Two true rows beside them were left out, and joints between others bent the motion by 0.6 and 1.05 mm."""
    motion = parabolas_and_lines(2.0 / 3.0, 0.4)
    x, fine = np.arange(0.0, 361.0, 2.0), np.linspace(0.0, 360.0, 7201)
    y = np.round(motion(x) + np.random.default_rng(1).normal(0.0, 5e-3, len(x)), 4)
    y[[row, row + 1]] = y[[row + 1, row]]
    assert np.abs(split_table(x, y, digit=1e-4).at(fine) - motion(fine)).max() < 0.3


def test_lines_that_end_in_one_row_without_a_corner_are_read() -> None:
    """No spline goes through one row between lines; one was looked for, and scipy raised an IndexError."""
    cam = simulated_cam(419)
    assert not split_table(cam.places, cam.heights, digit=cam.digit if cam.digit > 1e-9 else 0.0).peaks[1].is_known


def test_corners_are_none_where_a_fit_goes_through_all_of_few_rows() -> None:
    """Blends of six rows between lines and rests had five corners."""
    motion = parabolas_and_lines(0.4, 0.4)
    x, fine = np.arange(0.0, 361.5, 3.0), np.linspace(0.0, 360.0, 7201)
    table = split_table(x, np.round(motion(x), 4))
    assert table.corners == ()
    assert np.abs(table.at(fine) - motion(fine)).max() < 2e-3
