"""The total travel of runs and laws, beside the extremes of positions between roots of the velocity."""

import numpy as np
import pytest

from optlaws import PiecewiseMotion
from tests.exports.motions import random_motion
from tests.exports.samples import one_shot, press, shearing
from tests.internals.exports import export_motion, travel_of_run
from tests.internals.motion import Motion


def by_roots(motion: PiecewiseMotion) -> float:
    total = 0.0
    for low, high, row in zip(motion.breaks, motion.breaks[1:], motion.coefficients, strict=False):
        length, piece = high - low, np.polynomial.Polynomial(list(row))
        roots = [complex(root) for root in piece.deriv().roots().tolist()]
        inside = sorted(root.real for root in roots if abs(root.imag) < 1e-9 and 0.0 < root.real < length)
        total += float(np.abs(np.diff(piece(np.array([0.0, *inside, length])))).sum())
    return total


@pytest.mark.parametrize("number", range(12))
def test_a_run_travels_from_turn_to_turn(number: int) -> None:
    motion = random_motion(number, pieces=1 + number, degree=1 + number % 9)
    assert travel_of_run(motion) == pytest.approx(by_roots(motion), rel=1e-12)


@pytest.mark.parametrize("motion", [one_shot(), press().motion(), shearing().motion()])
def test_a_law_travels_as_far_as_a_run_that_is_near_it(motion: Motion) -> None:
    report = export_motion(motion, "csv", interpolation="quintic", points=400).report
    assert report.law.mean_absolute_velocity == pytest.approx(report.run.mean_absolute_velocity, rel=1e-7)
