"""Limits of drives against closed forms, passes of an integrator, laws at random and others' optima."""

from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from math import inf, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from optlaws import (
    BoundaryConditions,
    BSplines,
    C,
    Chebyshev,
    DriveLimit,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Powers,
    Problem,
    Solution,
    at_most,
    catalogue,
    drive_limit,
    drive_torque,
    integral,
    peak,
    rms,
    slider_crank,
    smoothstep,
    synthesize,
)
from optlaws.laws import MotionLaw
from optlaws.typing import PhasePlane
from optlaws.verification import verify
from tests.internals.synthesis import (
    Standing,
    TorqueLimit,
    VelocityLimit,
    limit_beside,
    limit_of_plane,
    optimum,
    phase_torque,
)
from tests.sampling import examples

LOADED = drive_torque(inertia="1 + 0.6*a^2", load="3*a")
FREE = "c"


def of_unit_mass() -> list[tuple[dict[str, object], float]]:
    """Closed forms of an inertia of 1 without a load: the law's own limits, and least times."""
    cases = [({"minimise": "peak torque", "B": B}, B**2 / (B - 1.0)) for B in (1.3, 1.8)]
    cases += [({"minimise": "peak torque"}, 4.0), ({"minimise": "rms torque"}, sqrt(12.0))]
    # b² at most 2 C a: the stroke takes 2/sqrt(C), or with a bound of b 1/B + B/C
    cases += [({"minimise": "time", "C": C}, 2.0 / sqrt(C)) for C in (0.5, 4.0, 30.0)]
    cases += [({"minimise": "time", "P": 9.0, "B": 1.5}, 1.0 / 1.5 + 1.5 / 9.0)]
    # parabolas with a straight part: least energy at the least greatest velocity
    B = 2.5 - sqrt(2.5**2 - 5.0)
    return [*cases, ({"minimise": "energy", "C": 5.0}, B**2 / 2.0)]


@pytest.mark.sample(3)
@pytest.mark.parametrize(("options", "known"), of_unit_mass(), ids=lambda value: str(value)[:60])
def test_an_inertia_without_a_load_has_closed_forms(options: dict[str, object], known: float) -> None:
    limit = drive_limit(FREE, **options)  # type: ignore[arg-type]
    assert known * (1.0 - 2e-6) <= limit.value <= known * (1.0 + 1e-12)
    assert abs(limit.attained - known) <= 2e-6 * known


def test_numbers_of_other_constructions() -> None:
    """By an envelope of passes, and by a series with BFGS, to the digits that they are known to."""
    assert drive_limit(LOADED, "peak torque", B=2.2, C=9.0).value == pytest.approx(4.00818, abs=5e-6)
    assert drive_limit("c + 3*a", "peak torque", B=2.2, C=9.0).value == pytest.approx(3.33321, abs=5e-6)
    assert drive_limit(LOADED, "rms torque", B=2.2).value == pytest.approx(3.40484, abs=6e-6)
    assert drive_limit("c + 3*a", "rms torque", B=2.2).value == pytest.approx(2.84121, abs=6e-6)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "options",
    [
        {"minimise": "peak torque", "B": 2.2, "C": 9.0},
        {"minimise": "rms torque", "B": 2.2, "C": 5.0},
        {"minimise": "rms torque", "B": 2.2, "P": 4.5},
        {"minimise": "energy", "B": 2.2, "C": 9.0},
        {"minimise": "energy", "B": 2.2, "C": 9.0, "recovered": 0.6},
        {"minimise": "time", "C": 9.0, "P": 5.0},
    ],
    ids=str,
)
def test_the_proven_value_is_the_optimum_to_1e_6_and_a_motion_attains_it(options: dict[str, object]) -> None:
    limit = drive_limit(LOADED, **options)  # type: ignore[arg-type]
    if limit.minimise != "time":
        least = optimum(Standing(limit.plane, limit.level)).objective
        least = limit.unit * (sqrt(least) if limit.minimise == "rms torque" else least)
        assert limit.value == pytest.approx(least, rel=2e-6)
    assert 0.0 <= limit.gap < 1e-6
    assert limit.bound == limit.value
    assert DriveLimit.from_json(limit.to_json()) == limit


@lru_cache(maxsize=1)
def monotone_laws() -> list[MotionLaw]:
    """Standard laws that begin and end at rest and never turn back."""
    k = np.linspace(0.0, 1.0, 1001)
    laws = [catalogue[name].law for name in ("345", "modified sine", "modified trapezoid", "cycloidal", "harmonic")]
    return [law for law in laws if law.b(k).min() > -1e-12]


@given(
    st.floats(0.0, 3.0),
    st.floats(-4.0, 4.0),
    st.floats(0.0, 2.0),
    st.sampled_from(["peak torque", "rms torque", "energy"]),
    st.sampled_from(monotone_laws()),
)
@examples(14)
def test_no_standard_law_beats_the_limit(
    bulge: float, load: float, friction: float, minimise: str, law: MotionLaw
) -> None:
    torque = drive_torque(inertia=f"1 + {bulge!r}*a^2", friction=repr(friction), load=f"{load!r}*a")
    k = np.linspace(0.0, 1.0, 4001)
    a, b, c = law.a(k), law.b(k), law.c(k)
    values = (1 + bulge * a**2) * c + bulge * a * b**2 + friction * b + load * a
    B, C = float(b.max()) * 1.000001, float(np.abs(c).max()) * 1.000001
    limit = drive_limit(torque, minimise, B=B, C=C)  # type: ignore[arg-type]
    own = {
        "peak torque": float(np.abs(values).max()),
        "rms torque": sqrt(float(np.trapezoid(values**2, k))),
        "energy": float(np.trapezoid(np.maximum(values * b, 0.0), k)),
    }[minimise]
    assert limit.value <= own * (1.0 + 1e-6) + 1e-9


@pytest.mark.parametrize(("B", "C"), [(2.0, 5.78), (1.875, 5.774)])
def test_a_limit_that_the_solver_of_cones_leaves_inaccurate_is_solved_again(B: float, C: float) -> None:
    torque = drive_torque(inertia="1 + 0.5*a^2", friction="1.0", load="4*a")
    assert drive_limit(torque, "peak torque", B=B, C=C).gap < 1e-6


@pytest.mark.sample(3)
@pytest.mark.parametrize("minimise", ["peak torque", "rms torque", "energy"])
@pytest.mark.parametrize("unit", [1e-12, 1e-5, 1e9])
def test_limits_have_the_unit_of_the_torque(unit: float, minimise: str) -> None:
    plain = drive_limit(LOADED, minimise, B=2.2, C=9.0)  # type: ignore[arg-type]
    other = drive_limit(f"{unit!r}*({LOADED})", minimise, B=2.2, C=9.0)  # type: ignore[arg-type]
    assert other.value == pytest.approx(unit * plain.value, rel=2e-6)
    assert other.gap < 1e-6


@pytest.mark.sample(2)
@pytest.mark.parametrize(("C", "cap"), [(9.0, 2.2), (5.0, 1.6)])
def test_the_velocities_of_a_limit_are_those_of_its_motion(C: float, cap: float) -> None:
    """Time and energy of the loaded inertia along the velocities of the file, on a grid."""
    limit = drive_limit(LOADED, "energy", B=cap, C=C)
    s, b = np.array([0.0, *limit.s, 1.0]), np.array([0.0, *limit.b, 0.0])
    shape = PchipInterpolator(s, b)
    turn = np.unique(np.concatenate([s, np.linspace(0.0, 1.0, 2001)]))
    a, w = np.sin(0.5 * np.pi * turn) ** 2, shape(turn) ** 2
    c, middle, mean = 0.5 * np.diff(w) / np.diff(a), 0.5 * (a[1:] + a[:-1]), 0.5 * (w[1:] + w[:-1])
    torque = (1.0 + 0.6 * middle**2) * c + 0.6 * middle * mean + 3.0 * middle
    assert float(np.maximum(torque, 0.0) @ np.diff(a)) == pytest.approx(limit.attained, rel=3e-3)
    assert float(2.0 * np.diff(a) @ (1.0 / (np.sqrt(w[1:]) + np.sqrt(w[:-1])))) == pytest.approx(1.0, rel=1e-4)


def test_a_load_by_a_table_is_cut_at_its_places() -> None:
    limit = drive_limit("c + 0.5*b + table(a, 0:0, 0.5:0, 0.7:3, 0.9:0, 1:0)", "rms torque")
    assert limit.gap < 1e-6


@pytest.mark.sample(4)
@pytest.mark.parametrize("key", ["value", "weight", "unit", "potential", "edges", "s", "b", "attained", "plane"])
def test_what_a_certificate_does_not_prove_is_refused(key: str) -> None:
    limit = drive_limit(LOADED, "rms torque", B=2.2)
    data = limit.to_dict()
    for factor in (1.01, 0.9, -1.0):
        changed = deepcopy(data)
        if key == "plane":
            changed["plane"]["B"] = 2.2 * factor if factor > 0.5 else 0.5
        elif key == "potential":
            changed["potential"][3][2] *= factor
        elif isinstance(data[key], list):
            changed[key][2] *= factor
        else:
            changed[key] *= factor
        try:
            read = DriveLimit.from_dict(changed)
        except InputError:
            continue
        # what is read proves its value of the plane that it states
        assert read.value <= read.bound * (1.0 + 1e-9)
        assert key != "value" or factor < 1.0


@pytest.mark.parametrize(
    ("torque", "options", "says"),
    [
        ("c*k", {}, "factors of a alone"),
        ("c + j", {}, "j"),
        ("c^2", {}, "I*c + S*b^2"),
        ("(a - 0.5)*c", {}, "at least 0 at every position"),
        ("a*c", {}, "vanishes at a = 0"),
        ("c", {"minimise": "energy"}, "bound C or a torque"),
        ("c", {"minimise": "power"}, "peak torque"),
        ("c", {"B": 0.9}, "above 1"),
        ("c", {"C": -1.0}, "C must be above 0"),
        ("c", {"minimise": "energy", "C": 9.0, "recovered": 1.5}, "from 0 to 1"),
    ],
)
def test_wrong_input_is_named_with_its_remedy(torque: str, options: dict[str, object], says: str) -> None:
    with pytest.raises(InputError) as error:
        drive_limit(torque, **options)  # type: ignore[arg-type]
    assert says in str(error.value)


def test_bounds_that_leave_no_motion_are_answered_by_the_least_time() -> None:
    with pytest.raises(InfeasibleProblem, match=r"the least time within them is 1\.0126") as error:
        drive_limit(LOADED, "rms torque", B=2.2, C=9.0, P=3.9)
    proof = error.value.proof
    assert isinstance(proof, DriveLimit)
    assert proof.value > 1.0


def test_velocities_of_the_motion_that_was_found() -> None:
    limit = drive_limit(FREE, "rms torque")
    a = np.linspace(0.0, 1.0, 11)
    k = np.array([brentq(lambda k, at=at: 3 * k**2 - 2 * k**3 - at, 0.0, 1.0) for at in a])
    assert np.allclose(limit.velocity(a), 6 * k * (1 - k), atol=2e-3)
    assert inf == limit.plane.B


# --- laws beside the limit ---


PRESS = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
MOVE = PRESS.dimensionless("0 deg", "180 deg", "0.3 s")
BASE: dict[str, Any] = {"order": 3, "basis": Powers(9), "symmetric": False, "monotone": True}


def solved(**entries: object) -> Solution:
    given: dict[str, Any] = {**BASE, "minimise": rms(MOVE.torque), **entries}
    return synthesize(Problem(**given))


def test_the_gap_to_the_limit_is_what_the_degree_costs() -> None:
    """Of a slider-crank, 180 deg in 0.3 s: torques in N m, least at degrees 9 and 13 by BFGS."""
    for degree, least in ((9, 3.989601), (13, 3.960253)):
        solution = solved(basis=Powers(degree))
        assert solution.objective * MOVE.unit == pytest.approx(least, abs=2e-6)
        assert solution.lower_bound * MOVE.unit == pytest.approx(3.924086, abs=2e-6)
        assert solution.drive_limit is not None
        assert solution.lower_bound == solution.drive_limit.value


@pytest.mark.parametrize(
    ("minimise", "known", "limit"),
    [
        (peak(MOVE.torque), 5.1057, 4.7308),
        pytest.param(integral(f"max(({MOVE.torque})*b, 0)"), 1.1960, 1.0140, marks=pytest.mark.long),
    ],
    ids=["peak", "energy"],
)
def test_peaks_and_energies_have_limits_too(minimise: object, known: float, limit: float) -> None:
    solution = solved(minimise=minimise, C=(0, 12))
    assert solution.objective * MOVE.unit <= known * 1.0002
    assert solution.lower_bound * MOVE.unit == pytest.approx(limit, abs=2e-4)
    assert solution.gap > 0.0


def test_the_file_holds_the_certificate_and_verify_checks_it() -> None:
    solution = solved()
    assert Solution.from_json(solution.to_json()) == solution
    checked = verify(solution.to_dict())
    claims = {claim.name: claim for claim in checked.claims}
    assert claims["the lower bound"].proven
    assert "phase plane" in claims["the lower bound"].detail
    assert claims["the drive's limit"].proven
    assert [claim.name for claim in checked.claims if not claim.proven] == []


def test_the_limit_of_another_problem_is_refused() -> None:
    solution = solved()
    other = solved(minimise=rms("(2 + a)*c + 0.5*b^2"))
    data = deepcopy(solution.to_dict())
    data["drive_limit"] = other.to_dict()["drive_limit"]
    with pytest.raises(InputError, match="of another problem"):
        Solution.from_dict(data)
    assert not all(claim.proven for claim in verify(data).claims)
    raised = deepcopy(solution.to_dict())
    raised["drive_limit"]["value"] *= 1.001
    with pytest.raises(InputError, match="above what its certificate proves"):
        Solution.from_dict(raised)


@pytest.mark.parametrize("changes", [{"monotone": False}, {"minimise": rms(MOVE.torque) + C}], ids=str)
def test_without_a_limit_nothing_is_claimed(changes: dict[str, object]) -> None:
    assert solved(basis=Powers(5), **changes).drive_limit is None


WITHIN: dict[str, Any] = {"B": (0, 2.2), "C": (0, 9)}


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("formula", "options"),
    [
        (f"({LOADED})^2", {"minimise": "rms torque"}),
        (f"max(({LOADED})*b, 0)", {"minimise": "energy"}),
        (f"max(({LOADED})*b, 0.6*({LOADED})*b)", {"minimise": "energy", "recovered": 0.6}),
    ],
)
def test_integrals_are_read_as_heat_and_energy(formula: str, options: dict[str, Any]) -> None:
    known = drive_limit(LOADED, B=2.2, C=9.0, **options).value
    known = known**2 if options["minimise"] == "rms torque" else known
    for factor in (1.0, 0.05):
        problem = Problem(**BASE, **WITHIN, minimise=integral(f"{factor}*{formula}"))
        limit = limit_beside(problem)
        assert limit is not None
        assert limit.value == pytest.approx(factor * known, rel=1e-6)


def test_energy_and_heat_together_are_above_their_limits_alone() -> None:
    power, heat = f"max(({LOADED})*b, 0)", f"0.05*({LOADED})^2"
    values = []
    for formula in (power, heat, f"{power} + {heat}"):
        limit = limit_beside(Problem(**BASE, **WITHIN, minimise=integral(formula)))
        assert limit is not None
        assert limit.gap < 1e-6
        values.append(limit.value)
    assert values[0] + values[1] < values[2] < 1.1 * (values[0] + values[1])


def test_a_bound_of_the_torque_counts() -> None:
    bounded = Problem(**BASE, minimise=rms(LOADED), bounds={peak(LOADED): (0, 4.5)}, B=at_most(2.2))
    limit = limit_beside(bounded)
    assert limit is not None
    assert limit.value == pytest.approx(drive_limit(LOADED, "rms torque", B=2.2, P=4.5).value, rel=1e-6)


@pytest.mark.parametrize("minimise", [rms, pytest.param(peak, marks=pytest.mark.long)])
def test_a_bound_of_the_jerk_counts(minimise: Callable[[str], Any]) -> None:
    """Laws of order 3 begin without acceleration: what they are slower by at their ends costs torque."""
    free = Problem(order=3, basis=Powers(11), symmetric=False, monotone=True, minimise=minimise(LOADED))
    solution, plain = synthesize(replace(free, J=at_most(55.0))), limit_beside(free)
    limit = solution.drive_limit
    assert limit is not None
    assert plain is not None
    assert 1.1 * plain.value < limit.value < solution.objective
    assert solution.lower_bound == limit.value
    assert limit.is_of(solution.problem)
    assert plain.is_of(solution.problem)  # as of files written before
    assert not limit.is_of(free)
    assert not limit.is_of(replace(solution.problem, J=at_most(56.0)))
    assert verify(solution.to_dict()).proven
    # that of order 2 may begin with any acceleration
    lower = limit_beside(replace(solution.problem, order=2))
    assert lower is not None
    assert lower.value == pytest.approx(plain.value, rel=1e-6)
    [row] = [row for row in solution.summary() if row.name == "best possible"]
    assert "within this jerk" in row.note


def test_a_crank_without_inertia_has_a_bound_within_a_jerk() -> None:
    """At its dead centres no torque keeps the acceleration finite: the jerk does."""
    press = slider_crank("0.1 m", "0.4 m", bodies={"slider": "12 kg"})
    torque = press.dimensionless("0 deg", "360 deg", "0.5 s").torque
    free = Problem(order=3, basis=Powers(11), symmetric=False, monotone=True, minimise=rms(torque))
    assert limit_beside(free) is None
    within = replace(free, J=at_most(70.0))
    limit, law = limit_beside(within), synthesize(within)
    assert limit is not None
    assert limit.plane.within_jerk
    assert limit.contradiction() == ""
    assert 0.6 * law.objective < limit.value < law.objective


@pytest.mark.parametrize("name", ["cycloidal", "modified sine", "4567", "modified trapezoid"])
def test_no_law_accelerates_more_than_its_jerk_lets_its_velocity(name: str) -> None:
    law = catalogue[name].law
    problem = Problem(order=3, monotone=True, symmetric=False, minimise=rms(LOADED), J=at_most(law.peak(3).value))
    limit = limit_beside(problem)
    assert limit is not None
    assert limit.plane.within_jerk
    k = np.linspace(0.0, 1.0, 20001)
    b, c = law.b(k), law.c(k)
    for bound in limit.plane.limits:
        assert np.all(np.abs(c) <= bound.at_rest - bound.fall * b)
    # and near the ends the bounds are no wider than those of the jerk's own ramp need to be
    ramp = np.sqrt(2.0 * law.peak(3).value * b)
    widest = np.min([bound.at_rest - bound.fall * b for bound in limit.plane.limits], axis=0)
    assert np.all(widest[(b > 0.02) & (b < 1.0)] < 1.25 * ramp[(b > 0.02) & (b < 1.0)])


# --- published motions ---


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


# --- bounds over parts of the stroke ---


FREE_TORQUE, LOADED_TORQUE = phase_torque("c"), phase_torque("0.5*c + 0.5*a")


def time_of(square: Callable[[float], float], *breaks: float) -> float:
    """The time of a motion whose squared velocity is known over the position."""
    total, ends = 0.0, [0.0, *breaks, 1.0]
    for low, high in pairwise(ends):
        # a = low + (high - low) sin² x takes the roots away
        def pace(x: float, low: float = low, high: float = high) -> float:
            a = low + (high - low) * np.sin(x) ** 2
            return float((high - low) * np.sin(2.0 * x) / sqrt(square(a)))

        total += quad(pace, 0.0, np.pi / 2, epsabs=1e-10, epsrel=1e-10)[0]
    return total


def test_a_slow_part_takes_the_time_that_it_takes() -> None:
    C, B, low, high = 9.0, 0.8, 0.35, 0.6

    def square(a: float) -> float:
        away = max(low - a, a - high, 0.0)
        return min(2.0 * C * a, 2.0 * C * (1.0 - a), B**2 + 2.0 * C * away)

    rise, fall = (B**2 / (2.0 * C) + low) / 2.0, 1.0 - (B**2 / (2.0 * C) + 1.0 - high) / 2.0
    limit = limit_of_plane(PhasePlane(C=C, velocities=(VelocityLimit(low, high, B),)), "time")
    known = time_of(square, rise, low, high, fall)
    assert known * (1.0 - 1e-4) <= limit.value <= known * (1.0 + 1e-9)
    assert limit.from_json(limit.to_json()) == limit


def test_a_part_of_little_torque_costs_what_the_passes_say() -> None:
    P, weak, low, high = 9.0, 2.0, 0.1, 0.3

    def square(a: float) -> float:
        rising = 2.0 * (P * min(a, low) + weak * min(max(a - low, 0.0), high - low) + P * max(a - high, 0.0))
        return min(rising, 2.0 * P * (1.0 - a))

    meet = 0.5 * (1.0 - (low * P + (high - low) * weak - high * P) / P)
    plane = PhasePlane(limits=(TorqueLimit(FREE_TORQUE, P), TorqueLimit(FREE_TORQUE, weak, start=low, stop=high)))
    limit = limit_of_plane(plane, "time")
    known = time_of(square, low, high, meet)
    assert known * (1.0 - 2e-6) <= limit.value <= known * (1.0 + 1e-9)


@pytest.mark.long
@pytest.mark.parametrize("kind", ["rms torque", pytest.param("peak torque", marks=pytest.mark.long)])
def test_a_bound_over_a_part_is_between_none_and_one_everywhere(kind: str) -> None:
    objective = {"squared": LOADED_TORQUE} if kind == "rms torque" else {"peak": LOADED_TORQUE}
    planes = [
        PhasePlane(**objective, C=9.0, **bounds)  # type: ignore[arg-type]
        for bounds in ({}, {"velocities": (VelocityLimit(0.4, 0.7, 1.3),)}, {"B": 1.3})
    ]
    limits = [limit_of_plane(plane, kind) for plane in planes]  # type: ignore[arg-type]
    assert limits[0].value < 0.999 * limits[1].value
    assert limits[1].value < 0.999 * limits[2].value
    assert max(limit.gap for limit in limits) < 5e-4
    everywhere = PhasePlane(**objective, C=9.0, velocities=(VelocityLimit(0.0, 1.0, 1.3),))  # type: ignore[arg-type]
    known = limits[2].value
    assert 0.999 * known < limit_of_plane(everywhere, kind).value < 1.0001 * known  # type: ignore[arg-type]


@pytest.mark.long
def test_parts_of_the_way_of_a_mechanism_are_positions_of_its_input() -> None:
    table = Mechanism("0.8 kg m^2")
    slow = {"velocity": [("20 deg", "30 deg", "2 rad/s")], "acceleration": "150 rad/s^2"}
    forth = table.limit("rms torque", "0 deg", "45 deg", "0.25 s", limits=slow)
    back = table.limit("rms torque", "50 deg", "-45 deg", "0.25 s", limits=slow)
    assert forth.value == pytest.approx(back.value, rel=1e-5)
    assert forth.value > table.limit("rms torque", "0 deg", "45 deg", "0.25 s").value * 1.1
    with pytest.raises(InputError, match="within the stroke"):
        table.limit("rms torque", "0 deg", "25 deg", "0.25 s", limits=slow)
    with pytest.raises(InputError, match="velocity 1 must be a list of an angle, an angle and an angular"):
        table.limit("rms torque", "0 deg", "45 deg", "0.25 s", limits={"velocity": [("20 deg", "2 rad/s")]})
    with pytest.raises(InputError, match="ascend"):
        VelocityLimit(0.4, 0.2, 1.0)
