"""Limits of drives against closed forms, passes of an integrator, laws at random and an integral by mpmath."""

from copy import deepcopy
from functools import lru_cache
from itertools import pairwise
from math import inf, sqrt

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from optlaws import DriveLimit, InfeasibleProblem, InputError, catalogue, drive_limit, drive_torque
from optlaws.laws import MotionLaw
from tests.internals.synthesis import Standing, optimum
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


def least_time(P: float, B: float, C: float, count: int = 200_001) -> float:
    """The time of the fastest motion of the loaded inertia, by passes forward and backward on a grid of sqrt(a)."""
    a = np.linspace(0.0, 1.0, count) ** 2
    inertia, slope, load = 1.0 + 0.6 * a**2, 1.2 * a, 3.0 * a

    def passes(sign: float, a: np.ndarray, parts: tuple[np.ndarray, ...]) -> np.ndarray:
        inertia, slope, load = parts
        w = np.zeros(count)
        for i in range(count - 1):
            c = sign * (sign * P - 0.5 * slope[i] * w[i] - load[i]) / inertia[i]
            w[i + 1] = min(w[i] + 2.0 * min(c, C) * abs(a[i + 1] - a[i]), B * B)
        return w

    forward = passes(1.0, a, (inertia, slope, load))
    back = 1.0 - a
    turned = passes(-1.0, back, tuple(np.interp(back, a, part) for part in (inertia, slope, load)))
    w = np.minimum(forward, np.interp(a, back[::-1], turned[::-1]))
    pace = 2.0 / (np.sqrt(w[1:]) + np.sqrt(w[:-1]))
    return float(pace @ np.diff(a))


@pytest.mark.long
def test_peak_torque_is_that_of_passes_whose_time_is_the_whole() -> None:
    P = brentq(lambda P: least_time(P, 2.2, 9.0, 20_001) - 1.0, 3.5, 5.0, xtol=1e-7)
    limit = drive_limit(LOADED, "peak torque", B=2.2, C=9.0)
    assert abs(limit.value - P) < 1e-3
    assert abs(drive_limit(LOADED, "time", B=2.2, C=9.0, P=5.0).value - least_time(5.0, 2.2, 9.0, 20_001)) < 1e-3


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


def test_the_bound_of_a_potential_is_the_integral_that_it_claims() -> None:
    """mpmath's quadrature of the inner minimum, of RMS torque alone: a root of a cubic at every place."""
    limit = drive_limit(LOADED, "rms torque", B=2.2)
    edges, rows = limit.edges, limit.potential

    def inner(s: mp.mpf) -> mp.mpf:
        i = next(i for i in range(len(rows)) if s <= edges[i + 1] or i == len(rows) - 1)
        degree, length = len(rows[i]) - 1, mp.mpf(edges[i + 1]) - edges[i]
        x = (s - edges[i]) / length
        shapes = [mp.binomial(degree, j) * x**j * (1 - x) ** (degree - j) for j in range(degree + 1)]
        rates = [
            mp.binomial(degree, j) * (j * x ** (j - 1) * (1 - x) ** (degree - j) if j else 0)
            - (mp.binomial(degree, j) * (degree - j) * x**j * (1 - x) ** (degree - j - 1) if j < degree else 0)
            for j in range(degree + 1)
        ]
        sine, a = mp.sin(mp.pi * s), mp.sin(mp.pi * s / 2) ** 2
        price = 2 * mp.fdot(rows[i], shapes) / sine
        price_by_s = (
            2 * (mp.fdot(rows[i], rates) / length - mp.pi * mp.cot(mp.pi * s) * mp.fdot(rows[i], shapes)) / sine
        )
        rate, unit = price_by_s / (mp.pi / 2 * sine), limit.unit
        inertia, load = (1 + mp.mpf("0.6") * a**2) / unit, 3 * a / unit
        square, linear = -rate * inertia / 2, -(price**2) / 4
        roots = mp.polyroots([-limit.weight, 0, linear, 2 * square], maxsteps=200, extraprec=200, asc=True)
        b = min(next(mp.re(root) for root in roots if abs(mp.im(root)) < 1e-12 and mp.re(root) > 0), mp.mpf("2.2"))
        value = price * load + linear * b + square * b**2 + limit.weight / b
        return value * mp.pi / 2 * sine

    with mp.workdps(20):
        total = mp.fsum(mp.quad(inner, pair, maxdegree=5) for pair in pairwise(edges))
        known = limit.unit * mp.sqrt(total - limit.weight)
    assert 0.0 <= float(known) - limit.value < 1e-6 * limit.value


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
)
@examples(6)
def test_no_standard_law_beats_the_limit(bulge: float, load: float, friction: float, minimise: str) -> None:
    torque = drive_torque(inertia=f"1 + {bulge!r}*a^2", friction=repr(friction), load=f"{load!r}*a")
    for law in monotone_laws():
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
