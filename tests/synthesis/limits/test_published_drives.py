"""Optimised motions of drives that others published with all their inputs, and what no law can beat there."""

from dataclasses import replace

import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    BSplines,
    Chebyshev,
    Mechanism,
    Problem,
    peak,
    rms,
    slider_crank,
    smoothstep,
    synthesize,
)

# N. Van Oosterwyck, github.com/NickVanOosterwyck/TrajectoryOptimisation: a pick-and-place unit, 0 to 3.0299 rad in
# 73.75 ms. Inertia and load are the polynomials of degree 4 and 5 in y = 2 x / 3.0299 - 1 that polyfit lays through
# its tables (input/Nedschroef.xlsx, sheets J and Tl), as examples/Ex1_Ned_CompTraj.m asks.
STROKE, TIME = 3.0299, 0.07375
INERTIA = (
    0.012438014347720832,
    6.0976203761850756e-05,
    -0.01757304837080832,
    6.302708402889232e-05,
    0.008885823771286298,
)
LOAD = (
    0.01895507904063284,
    -1.6964675567266643,
    0.002153549238750275,
    2.2275104227387312,
    -0.06372175051560976,
    -0.6760997032522278,
)
#: the root of the constant of its objective (fitFun.txt), which is that of the quintic
QUINTIC = 506.3825176015552**0.5
#: the root of the least value of that polynomial in two variables, by Nelder and Mead's method to 1e-13
DEGREE_7 = 13.787590794045
#: of torques every 0.25 ms (OptimisedTrajectoriesDiscrete.xlsx), by the trapezium rule
DEGREE_9 = 12.481424


def of_position(coefficients: tuple[float, ...]) -> str:
    return " + ".join(f"({value!r})*(2*x/{STROKE!r} - 1)^{i}" for i, value in enumerate(coefficients))


def test_a_pick_and_place_unit() -> None:
    """Laws of degree 7 and 9 have 2 and 4 coefficients; the published optimum is 3.7 % above the limit."""
    unit = Mechanism(of_position(INERTIA), load=of_position(LOAD), over=(0.0, STROKE))
    moved = unit.dimensionless(0.0, STROKE, TIME)
    torque = rms(moved.torque)
    assert torque.value(smoothstep(3)) * moved.unit == pytest.approx(QUINTIC, rel=1e-12)
    problem = Problem(order=3, symmetric=False, monotone=True, minimise=torque)
    solutions = [synthesize(replace(problem, basis=Chebyshev(degree))) for degree in (1, 3, 13)]
    least, limit = np.array([law.objective for law in solutions]) * moved.unit, solutions[0].lower_bound * moved.unit
    assert least[0] == pytest.approx(DEGREE_7, rel=1e-11)
    assert least[1] == pytest.approx(DEGREE_9, rel=3e-6)
    assert limit == pytest.approx(12.03746, abs=1e-5)
    assert limit < least[2] < 1.009 * limit


def test_a_turn_of_a_crank_that_need_not_run_evenly() -> None:
    """Four quintics, each a quarter of the time: a vendor's page has 4.07 N m at constant speed, about 1.5 with them.

    controleng.ca/servosoft, OptimizerExampleSliderCrank; it gives neither lengths nor masses nor loads, so that only
    the order of the ratio, 0.37, can be compared. Without a load constant kinetic energy needs no torque at all.
    """
    press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"}, over=("0 deg", "360 deg"))
    x = np.linspace(0.0, 2.0 * np.pi, 3601)
    even = float(np.abs(press.torque(x, 2.0 * np.pi, 0.0)).max())
    moved = press.dimensionless("0 deg", "360 deg", "1 s")
    ends = BoundaryConditions((0, 1, 0), (1, 1, 0))
    best = synthesize(Problem(boundary=ends, basis=BSplines(4, 5), symmetric=False, minimise=peak(moved.torque)))
    assert best.objective * moved.unit == pytest.approx(0.55495, abs=1e-5)
    assert 0.3 < best.objective * moved.unit / even < 0.5
    # b = constant / sqrt(J) keeps the kinetic energy: J x'' + J' x'^2 / 2 = 0
    speed = 2.0 * np.pi / np.sqrt(press.inertia(x) / press.inertia(0.0))
    slope = -0.5 * press.inertia(x, 1) / press.inertia(x) * speed**2
    assert np.abs(press.torque(x, speed, slope)).max() < 1e-12 * even
