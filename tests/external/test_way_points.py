"""Motions of others through given points: splines of least jerk and snap, and tables of an open run time."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from optlaws import law_through, split_table
from tests.cycles.optimisation.test_joined import between_rests, motions, rms, spline
from tests.external.published import REFERENCE, numbers

#: of the published curve of least jerk, for each axis
LEAST_JERK = {1: 16.48077106217057, 2: 55.54054040806039}


@pytest.mark.parametrize("nu", [3, 4])
@pytest.mark.parametrize("axis", [1, 2])
def test_least_rms_through_published_points_is_the_spline_of_scipy(axis: int, nu: int) -> None:
    """Both axes of a published trajectory of least jerk, which prints the jerk at its start; and of least snap."""
    table = np.loadtxt(REFERENCE / "waypoints.csv", delimiter=",", skiprows=3)
    times, places = table[:, 0], table[:, axis]
    cycle = between_rests(motions(times, places, {1, 2, 3}), float(times[-1]), nu)
    curve = spline(times, places, nu, periodic=False)
    (solution,) = cycle.solutions
    stroke = next(piece.stroke for piece in cycle.pieces if piece.law is solution.law)
    objective = solution.objective * abs(stroke) / times[-1] ** nu
    assert objective == pytest.approx(rms(curve, nu, times), rel=1e-12 if nu == 3 else 1e-10)
    between = np.linspace(0.0, times[-1], 101)[1:-1]
    assert cycle(1.0 + between) == pytest.approx(curve(between), abs=1e-10 * np.abs(curve(between)).max())
    if nu == 3:
        assert objective == pytest.approx(LEAST_JERK[axis], rel=1e-12)
    if (nu, axis) == (3, 1):
        assert cycle(1.0 + 1e-9, 3) == pytest.approx(108.853, abs=1e-3)


@pytest.mark.parametrize("tolerance", [0.0, 0.001, 0.02])
def test_the_rise_of_an_open_run_time_has_a_law_within_every_tolerance(tolerance: float) -> None:
    y = np.array(numbers()["rtmotion"]["y"])[:8]
    x = 0.05 * np.arange(8)
    law = law_through(x, y, tolerance=tolerance)
    assert np.abs(y[-1] * law(x / x[-1]) - y).max() <= max(tolerance, 1e-12)
    assert np.abs(np.array(law.boundary_values(3)) - [[0.0] * 3, [1.0, 0.0, 0.0]]).max() <= 1e-9


def test_the_whole_table_of_an_open_run_time_is_a_rise_and_a_return() -> None:
    """Its crest is between two rows, as a spline through them has it, and it goes on at its seam as it began."""
    y = np.array(numbers()["rtmotion"]["y"])
    x = np.linspace(0.0, 360.0, len(y))
    split = split_table(x, y)
    crest = next(root for root in CubicSpline(x, y, bc_type="periodic").derivative().roots() if 108.0 < root < 126.0)
    assert [(part.kind, part.start, part.stop) for part in split.stretches] == [
        ("rise", 0.0, pytest.approx(crest, abs=0.5)),
        ("return", pytest.approx(crest, abs=0.5), 360.0),
    ]
    cycle = split.cycle(speed="60 rpm")
    assert 1e3 * np.asarray(cycle.at_angle(18.0 * np.arange(20))) == pytest.approx(y[:-1], abs=1e-6)
    for nu in (1, 2):
        before, behind = (float(cycle.at_angle(angle, nu)) for angle in (360.0 - 1e-7, 1e-7))
        assert before == pytest.approx(behind, rel=1e-5)
