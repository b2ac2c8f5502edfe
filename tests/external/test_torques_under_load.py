"""Torques under a load: least values that others computed, over all monotone laws or of one of their own."""

import pytest

from optlaws import Chebyshev, Functional, Problem, at_most, drive_torque, peak, rms, synthesize
from tests.external.published import numbers


@pytest.mark.parametrize("name", ["peak", "rms"])
def test_torque_under_a_load_is_above_its_infimum(name: str) -> None:
    """The least over all monotone laws with B and C bounded is convex in b² over a, and was computed so."""
    case = numbers()["loads"]
    torque = drive_torque(inertia="1", load="3*a")
    functional: Functional = {"peak": peak, "rms": rms}[name](torque)
    B, C = at_most(case["B"]), at_most(case["C"])
    problem = Problem(order=3, basis=Chebyshev(11), symmetric=False, monotone=True, minimise=functional, B=B, C=C)
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert case[name] <= solution.objective < 1.06 * case[name]
