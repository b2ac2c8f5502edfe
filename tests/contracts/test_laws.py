"""What every law does, whatever its representation, and what every motion of a mass does that can be asked the same.

A new representation is a line in tests/laws/examples.py or below.
"""

import copy
import dataclasses
import itertools
import json
import pickle
from functools import cache
from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    BSplines,
    Follower,
    InputError,
    MotionLaw,
    PiecewiseLaw,
    PolynomialLaw,
    Response,
    catalogue,
    law_from_z,
    mirrored_law,
    reversed_law,
    smoothstep,
    with_end_velocity,
)
from tests.contracts.kinds import kinds
from tests.internals.balancing import LoaderLaw, PartSegment
from tests.internals.laws import Curve, FractionalSegment, PolynomialSegment, PowerSegment, SineSegment
from tests.internals.mechanisms import MassMotion
from tests.laws.examples import EXAMPLES, cut_sine, free_function_law
from tests.laws.many_digits import highest, stretches

NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)
DENSE = np.linspace(0.0, 1.0, 20001)
K = np.linspace(0.0, 1.0, 203)[1:-1] + 1e-3 / np.pi  # none of them a break

COSINE = PiecewiseLaw([0, 1], [SineSegment(amplitude=np.pi**2 / 2, frequency=np.pi, phase=np.pi / 2)])
#: one class each of what `laws` itself does not make
OTHERS: dict[str, MotionLaw] = {
    "loader of a cosine": LoaderLaw(COSINE),
    "loader of a cycloid": LoaderLaw(cut_sine()),
    "loader of S_2": LoaderLaw(smoothstep(2)),
    "loader of S_4": LoaderLaw(smoothstep(4)),
    "loader of an unsymmetric law": LoaderLaw(free_function_law(3, 4, 6)),
    "loader of a law between velocities": LoaderLaw(PolynomialLaw.from_powers([0.0, 0.5, 1.5, -1.0])),
    "splines": law_from_z(BoundaryConditions.rest(3), [1.0, -2.0, 3.0, 0.5, 1.0, -1.0], BSplines(3, 3)),
}
#: whose derivatives jump or grow without limit, inside or at the ends
ROUGH: dict[str, MotionLaw] = {
    "jumps of b": PiecewiseLaw([0, 0.25, 0.5, 1], [PolynomialSegment((), b0=b) for b in (0.5, 1.5, 1.0)]),
    "jumps of c": PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((4.0,)), PolynomialSegment((-4.0,), b0=2.0)]),
    "constant power from rest": PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)]),
    "infinite c inside": PiecewiseLaw([0, 0.5, 1], [PowerSegment(1.5, 0.0), PowerSegment(0.0, 1.5)]),
    "loader of jumps of c": LoaderLaw(catalogue["constant acceleration"].law),
    "parts of laws": PiecewiseLaw(
        [0, 0.3, 1], [PartSegment(smoothstep(4), 0.0, 0.5, 0.6), PartSegment(smoothstep(4), 0.5, 1.0, 1.4)]
    ),
    "roots of time": PiecewiseLaw([0, 1], [FractionalSegment(-0.5, 0.0, 1.0, (0.75,))]),
}
LAWS = EXAMPLES | OTHERS
KNOWN = {*LAWS.values(), *ROUGH.values()}
STANDARD = {f"{name}, catalogue": catalogue[name].law for name in catalogue if catalogue[name].law not in KNOWN}
ALL = LAWS | ROUGH | STANDARD
UNDAMPED, DAMPED = Follower(frequency=18.0), Follower(frequency=25.0, damping=0.03)
MASSES: dict[str, MassMotion] = {
    "response to a polynomial": DAMPED.response(smoothstep(4)),
    "response to sines": UNDAMPED.response(catalogue["modified sine"].law),
    "response to powers of time": DAMPED.response(EXAMPLES["fall like x^4.5"]),
    "response to jumps of c": DAMPED.response(ROUGH["jumps of c"]),
    "slow follower": Follower(frequency=2.5, damping=0.2).response(smoothstep(4)),
    "overdamped follower": Follower(frequency=30.0, damping=1.5).response(EXAMPLES["S-curve"]),
    "cycle": DAMPED.cycle(smoothstep(4), dwell=0.5, rest=1.0),
    "cycle of a sine and a polynomial": DAMPED.cycle(
        catalogue["cycloidal"].law, dwell=0.0, fall=smoothstep(4), fall_duration=2.0, rest=0.25
    ),
}


def shape(curve: Any) -> Any:
    """What a curve is made of."""
    return type(curve), frozenset(map(type, getattr(curve, "segments", ())))


every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
every_order = pytest.mark.parametrize("nu", range(4))
any_law = pytest.mark.parametrize("law", ALL.values(), ids=ALL.keys())
everything = pytest.mark.parametrize("curve", (ALL | MASSES).values(), ids=(ALL | MASSES).keys())


def panels(law: Curve, end: float = 1.0) -> list[tuple[np.ndarray, np.ndarray]]:
    """Points and weights of a quadrature over [0, end] on each of whose panels the law is smooth."""
    places = [*(k for k in law.breaks if k < end), end]
    pairs = [(0.5 * (low + high), 0.5 * (high - low)) for low, high in itertools.pairwise(places)]
    return [(middle + half * NODES, half * WEIGHTS) for middle, half in pairs]


def integral(law: MotionLaw, nu: int, end: float) -> float:
    return sum(float(weights @ law(k, nu)) for k, weights in panels(law, end))


def jumps(law: MotionLaw, nu: int, end: float = 1.0) -> float:
    """What the jumps of a derivative up to `end` add to it."""
    return sum(height for k, height in law.jumps(nu) if k <= end)


@cache
def dense(law: MotionLaw, nu: int) -> np.ndarray:
    values = law(DENSE, nu)
    values.setflags(write=False)
    return values


def size(law: MotionLaw, nu: int) -> float:
    return float(np.abs(dense(law, nu)).max())


@pytest.mark.sample(2, kind=shape)
@every_law
@every_order
def test_each_derivative_integrates_the_next(law: MotionLaw, nu: int) -> None:
    room = 1e-12 * size(law, nu + 1)
    for end in (0.1, 0.5, 0.83, 1.0):
        change = integral(law, nu + 1, end) + jumps(law, nu, end)
        assert law(end, nu) - law(0.0, nu) == pytest.approx(change, abs=room)


@every_law
def test_boundary_values_are_the_derivatives_at_the_ends(law: MotionLaw) -> None:
    start, end = law.boundary_values(5)
    assert start == tuple(law(0.0, nu) for nu in range(5))
    assert end == tuple(law(1.0, nu) for nu in range(5))
    assert law.boundary_values(0) == ((), ())


@pytest.mark.sample(2, kind=shape)
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
def test_peaks_are_reached_where_they_are_said_to_be(law: MotionLaw) -> None:
    constants = law.constants
    for nu, peak in ((1, constants.B), (2, constants.C), (3, constants.J)):
        assert abs(law(peak.k, nu)) == pytest.approx(peak.value, rel=2e-10, abs=1e-300)
    assert abs(law.d(constants.D.k)) == pytest.approx(constants.D.value, rel=2e-10, abs=1e-300)


@every_law
def test_rms_of_acceleration_is_the_integral(law: MotionLaw) -> None:
    square = sum(float(weights @ law.c(points) ** 2) for points, weights in panels(law))
    assert law.constants.rms_c == pytest.approx(square**0.5, rel=1e-12)


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
def test_k_outside_the_interval_is_refused(law: MotionLaw) -> None:
    wrong: list[Any] = [-1e-9, 1.0000001, np.nan, np.inf, "0.5", None, 0.5j, [0.2, 1.5], [[0.1], [0.1, 0.2]]]
    calls: list[Any] = [law, law.a, law.b, law.c, law.j, law.d]
    for k, call in itertools.product(wrong, calls):
        with pytest.raises(InputError, match="k must be"):
            call(k)


@everything
def test_orders_of_derivatives_are_integers_from_0(curve: Curve) -> None:
    wrong: list[Any] = [-1, 1.0, "1", None, True]
    for nu in wrong:
        for call in (
            lambda nu=nu: curve(0.5, nu),
            lambda nu=nu: curve.peak(nu),
            lambda nu=nu: curve.extrema(nu),
            lambda nu=nu: curve.rms(nu),
            lambda nu=nu: curve.samples(9, nu),
        ):
            with pytest.raises(InputError, match="nu must be an integer of at least 0"):
                call()
        if isinstance(curve, MotionLaw):
            with pytest.raises(InputError, match="count must be an integer"):
                curve.boundary_values(nu)


@pytest.mark.parametrize("motion", MASSES.values(), ids=MASSES.keys())
def test_times_of_a_mass_are_finite_and_none_before_its_motion(motion: MassMotion) -> None:
    wrong: list[Any] = [np.nan, np.inf, "0.5", None, 0.5j, [[0.1], [0.1, 0.2]]]
    for k in [*wrong, *([-1e-9] if isinstance(motion, Response) else [])]:
        with pytest.raises(InputError, match="k must be"):
            motion(k)
    assert np.isfinite(motion(motion.interval[1] + np.linspace(0.0, 2.0, 9), 2)).all()


@every_law
def test_repr_and_html_show_the_constants(law: MotionLaw) -> None:
    assert repr(law).startswith(f"{type(law).__name__}(")
    assert f"C={law.peak(2).value:g}" in repr(law)
    html = law._repr_html_()
    assert html.count("<svg") == html.count("</svg>") == len(law.report().panels)
    assert f"{law.peak(2).value:.7g}" in html
    assert "nan" not in html


def test_every_kind_of_law_has_an_example() -> None:
    assert kinds(MotionLaw) <= {type(law) for law in ALL.values()}
    assert kinds(MassMotion) <= {type(motion) for motion in MASSES.values()}


@pytest.mark.parametrize("kind", sorted(kinds(Curve), key=str))
def test_a_representation_supplies_hooks_and_overrides_nothing_that_users_call(kind: type[Curve]) -> None:
    faces = {MotionLaw, Curve, MassMotion}
    given = {
        name
        for face in faces
        for name, member in vars(face).items()
        if not getattr(member, "__isabstractmethod__", False)
    }
    public = {name for name in given if not name.startswith("_") or name in {"__call__", "_repr_html_", "_whole"}}
    own = {name for base in kind.__mro__ if base not in faces and issubclass(base, Curve) for name in vars(base)}
    # contents of a law and the interval are data, not what is computed from them
    assert own & public <= {"breaks", "interval"}


def ends(curve: Curve) -> np.ndarray:
    """Both ends of every piece."""
    return np.array(curve.breaks)


def inside(curve: Curve, count: int = 15) -> np.ndarray:
    """Places within every piece, shape (pieces, count), none near its ends."""
    places = ends(curve)
    return places[:-1, None] + np.diff(places)[:, None] * np.linspace(0.08, 0.92, count)


@pytest.mark.sample(2, kind=shape)
@everything
def test_each_derivative_is_the_limit_of_differences(curve: Curve) -> None:
    k = inside(curve)
    lengths = np.diff(ends(curve))[:, None]
    step = 1e-3 * lengths
    for nu in (1, 2, 3):
        # the error of the central difference of order 4 is step^4/30 of the fifth derivative above
        moved = [np.asarray(curve(k + i * step, nu - 1)) for i in (-2, -1, 1, 2)]
        difference = (moved[0] - 8 * moved[1] + 8 * moved[2] - moved[3]) / (12 * step)
        above = np.abs(np.stack([np.asarray(curve(k + i * step, nu + 4)) for i in (-2, 0, 2)])).max(axis=0)
        rounding = 1e-14 * np.abs(np.stack(moved)).max() / step
        assert (np.abs(difference - curve(k, nu)) <= 0.1 * step**4 * above + 20 * rounding).all()


@everything
def test_named_derivatives_and_power(curve: Curve) -> None:
    k = inside(curve)
    for nu, named in enumerate((curve.a, curve.b, curve.c, curve.j)):
        assert np.array_equal(named(k), curve(k, nu))
    assert np.array_equal(curve(k), curve.a(k))
    assert curve.d(k) == pytest.approx(curve.b(k) * curve.c(k), rel=1e-12)


@pytest.mark.sample(3, kind=shape)
@everything
def test_extrema_hold_on_both_sides_of_every_break_and_are_reached(curve: Curve) -> None:
    for nu in range(4):
        check_extrema(curve, nu)


def check_extrema(curve: Curve, nu: int) -> None:
    low, high = curve.extrema(nu)
    k, values = curve.samples(1001, nu)
    size = float(np.abs(values[np.isfinite(values)]).max())
    assert low.value <= values.min() + 1e-13 * size
    assert high.value >= values.max() - 1e-13 * size
    assert curve.peak(nu).value == max(abs(low.value), abs(high.value))
    for extreme in (low, high):
        if np.isfinite(extreme.value):
            both = [float(curve(extreme.k, nu)), *values[k == extreme.k]]
            assert min(abs(value - extreme.value) for value in both) <= 1e-9 * size
            nearest = np.abs(values - extreme.value).min()
            assert nearest <= 1e-3 * size  # no sample is far from what is said to be reached


@pytest.mark.sample(3, kind=shape)
@everything
def test_the_power_is_within_its_peak(curve: Curve) -> None:
    k = np.concatenate([inside(curve, 101).ravel(), ends(curve)])
    peak = curve.power_peak()
    power = np.abs(curve.d(k))
    assert not np.isnan(power).any()
    assert power.max() <= peak.value * (1 + 1e-12)
    low, high = curve.power_extrema()
    assert peak.value == max(abs(low.value), abs(high.value))
    assert low.value <= curve.d(k).min() + 1e-12 * power.max()
    assert curve.d(k).max() <= high.value + 1e-12 * power.max()
    first, last = curve.interval
    part = first + 0.2 * (last - first), first + 0.45 * (last - first)
    least, greatest = curve.power_extrema(part)
    inner = curve.d(np.linspace(*part, 301))
    assert least.value <= inner.min() + 1e-12 * power.max()
    assert greatest.value >= inner.max() - 1e-12 * power.max()
    assert part[0] <= min(least.k, greatest.k) <= max(least.k, greatest.k) <= part[1]
    if np.isfinite(peak.value):
        before = np.nextafter(peak.k, 0.0)
        assert peak.value == pytest.approx(max(abs(curve.d(peak.k)), abs(curve.d(before))), rel=1e-6, abs=1e-300)


@everything
def test_root_mean_squares_are_the_integrals(curve: Curve) -> None:
    places = ends(curve)
    cells = np.concatenate([np.linspace(low, high, 9)[:-1] for low, high in itertools.pairwise(places)] + [places[-1:]])
    middles, halves = 0.5 * (cells[1:] + cells[:-1]), 0.5 * np.diff(cells)
    for nu in range(4):
        rms = curve.rms(nu)
        square = float((np.asarray(curve(middles[:, None] + halves[:, None] * NODES, nu)) ** 2 @ WEIGHTS) @ halves)
        mean = square / (places[-1] - places[0])
        # a square that grows without limit at an end is missed by a quadrature
        assert rms == np.inf or rms**2 == pytest.approx(mean, rel=1e-6, abs=1e-14)
        assert rms < np.inf or not np.isfinite(curve.peak(nu).value)


@everything
def test_samples_are_the_values_with_both_sides_of_breaks(curve: Curve) -> None:
    k, values = curve.samples(33, 2)
    frame = curve.to_pandas(33)
    assert frame.index.tolist() == k.tolist()
    assert frame.c.tolist() == values.tolist()
    assert not frame.isna().any(axis=None)
    assert (np.diff(k) >= 0.0).all()
    assert (k[0], k[-1]) == curve.interval == (curve.breaks[0], curve.breaks[-1])
    assert len(k) == 33 + 2 * (len(curve.breaks) - 2)
    for place in curve.breaks[1:-1]:
        before, *after = values[k == place].tolist()
        assert set(after) == {curve.c(place)}
        near = curve.c(place - 1e-9)
        assert before == near or abs(before - near) <= 1e-5 * max(1.0, abs(near)) or not np.isfinite(before)
    many, displacements = curve.samples()
    assert len(many) == len(curve.to_pandas()) == 201 + 2 * (len(curve.breaks) - 2)
    assert np.array_equal(displacements, curve.samples(201, 0)[1])


@everything
def test_a_part_that_begins_or_ends_at_a_break_has_both_its_sides(curve: Curve) -> None:
    first, last = curve.interval
    for nu in (1, 2):
        k, values = curve.samples(2, nu)
        for place in curve.breaks[1:-1]:
            sides = values[k == place]
            for part in ((first, place), (place, last)):
                low, high = curve.extrema(nu, part)
                room = 1e-13 * curve.peak(nu).value if np.isfinite(curve.peak(nu).value) else 0.0
                assert low.value <= sides.min() + room
                assert high.value >= sides.max() - room


@pytest.mark.sample(3, kind=shape)
@everything
def test_extrema_of_a_part_are_those_of_its_samples(curve: Curve) -> None:
    first, last = curve.interval
    part = first + 0.31 * (last - first), first + 0.64 * (last - first)
    for nu in (0, 1, 2):
        low, high = curve.extrema(nu, part)
        values = curve(np.linspace(*part, 401), nu)
        size = max(1.0, float(np.abs(values[np.isfinite(values)]).max()))
        assert part[0] <= low.k <= part[1]
        assert low.value <= values.min() + 1e-12 * size
        assert high.value >= values.max() - 1e-12 * size
        whole = curve.extrema(nu)
        assert whole[0].value <= low.value <= high.value <= whole[1].value


@everything
def test_places_of_a_value_have_it_and_none_between_samples_is_missed(curve: Curve) -> None:
    for nu in (0, 1, 2):
        low, high = curve.extrema(nu)
        if not np.isfinite([low.value, high.value]).all():
            continue
        size = max(abs(low.value), abs(high.value))
        value = 0.37 * low.value + 0.63 * high.value
        places = curve.where(value, nu)
        assert (np.diff(places) > 0.0).all()
        sides = np.array([curve(places, nu), curve(np.maximum(places - 1e-12, curve.interval[0]), nu)])
        assert (np.abs(sides - value).min(axis=0) <= 1e-9 * size).all()
        for first, last in itertools.pairwise(curve.breaks):
            k = np.linspace(first, last, 203)[1:-1]
            passed = np.flatnonzero(np.diff(np.sign(curve(k, nu) - value)))
            assert all(((places >= k[i]) & (places <= k[i + 1])).any() for i in passed)
        assert any(np.abs(curve.where(high.value, nu) - high.k) < 1e-5)


@everything
def test_parts_and_numbers_of_samples_that_are_none_are_refused(curve: Curve) -> None:
    parts: list[Any] = [(0.5, 0.2), (-0.1, 0.5), (0.5, 99.0), (0.1, 0.2, 0.3), (0.1, np.nan), "01", 0.5]
    for part in parts:
        with pytest.raises(InputError, match=r"within must be two k|k must be"):
            curve.extrema(1, part)
    counts: list[Any] = [1, 0, 2.5, "9", None, True]
    for count in counts:
        with pytest.raises(InputError, match="count must be an integer of at least 2"):
            curve.samples(count)


@any_law
def test_jumps_are_the_differences_of_both_sides(law: MotionLaw) -> None:
    for nu in range(1, 4):
        k, values = law.samples(2, nu)
        jumps = dict(law.jumps(nu))
        for place in law.breaks[1:-1]:
            before, after = values[k == place].tolist()
            if np.isfinite([before, after]).all():
                assert jumps.get(place, 0.0) == pytest.approx(after - before, abs=1e-8 * max(1.0, abs(after)))
    assert set(law.breaks[1:-1]) >= {place for nu in range(1, 6) for place, _ in law.jumps(nu)}


@any_law
def test_above_the_first_jump_derivatives_are_impulses(law: MotionLaw) -> None:
    nu = law.continuity + 1
    if nu > 4 or not law.jumps(nu):
        return
    place, height = law.jumps(nu)[0]
    peak = law.peak(nu + 1)
    assert peak.value == np.inf
    assert peak.k <= place
    assert law.rms(nu + 1) == np.inf
    assert (law.extrema(nu + 1)[1].value == np.inf) or height < 0.0
    assert law.extrema(nu + 2)[0].value == -np.inf


@pytest.mark.sample(2, kind=shape)
@any_law
def test_rough_laws_are_stored_copied_and_shown_as_all_are(law: MotionLaw) -> None:
    for again in (MotionLaw.from_dict(law.to_dict()), MotionLaw.from_json(law.to_json())):
        assert again == law
        assert (type(again), hash(again)) == (type(law), hash(law))
        assert np.array_equal(again(K), law(K))
    assert json.loads(law.to_json()) == law.to_dict()
    assert pickle.loads(pickle.dumps(law)) == copy.deepcopy(law) == law  # noqa: S301
    assert "nan" not in law._repr_html_()
    for data, message in (
        ({**law.to_dict(), "extra": 1}, "'extra' is unknown"),
        (dict(list(law.to_dict().items())[:-1]), "is missing"),
        ({**law.to_dict(), "kind": "novelty"}, "kind of law 'novelty' is unknown"),
        ({**law.to_dict(), "format": 2}, "format of a law must be 1"),
    ):
        with pytest.raises(InputError, match=message):
            MotionLaw.from_dict(data)


def can_be_changed(law: MotionLaw) -> bool:
    """Whether it is made of what keeps a closed form, or is smooth enough for a polynomial."""
    return not isinstance(law, LoaderLaw) and law is not ROUGH["parts of laws"]


@pytest.mark.sample(3, kind=shape)
@any_law
def test_mirrored_reversed_and_scaled_laws_are_what_their_definitions_say(law: MotionLaw) -> None:
    if not can_be_changed(law):
        return
    drifting, mirrored, turned = with_end_velocity(law, 0.3), mirrored_law(law), reversed_law(law)
    sizes = [max(1.0, float(np.abs(law(K, nu)).max())) for nu in range(5)]
    for nu in range(5):
        room = (1e-12, 1e-10, 1e-12, 1e-11, 1e-9)[nu] * sizes[nu]
        drift = 0.3 * K if nu == 0 else 0.3 * (nu == 1)
        assert drifting(K, nu) == pytest.approx(0.7 * law(K, nu) + drift, abs=room)
        back = (-1) ** nu * law(1.0 - K, nu)
        assert mirrored(K, nu) == pytest.approx(back, abs=room)
        assert turned(K, nu) == pytest.approx((law.a(0.0) + law.a(1.0) if nu == 0 else 0.0) - back, abs=room)
    for change, changed in ((mirrored_law, mirrored), (reversed_law, turned)):
        assert change(changed).a(K) == pytest.approx(law.a(K), abs=1e-12 * sizes[0])
        assert changed.power_peak().value == pytest.approx(law.power_peak().value, rel=1e-9, abs=1e-12)
        for nu in (1, 2, 3):
            assert changed.peak(nu).value == pytest.approx(law.peak(nu).value, rel=1e-9, abs=1e-12)
    assert drifting.peak(2).value == pytest.approx(0.7 * law.peak(2).value, rel=1e-9)
    if law in EXAMPLES.values():
        assert {type(drifting), type(mirrored), type(turned)} == {type(law)}


@pytest.mark.sample(9, kind=shape)
@pytest.mark.parametrize("name", [name for name, law in LAWS.items() if isinstance(law, PiecewiseLaw)])
@pytest.mark.parametrize("nu", [2, 3])
def test_peaks_are_those_of_many_digits(name: str, nu: int) -> None:
    law = LAWS[name]
    assert isinstance(law, PiecewiseLaw)
    with mpmath.workdps(30):
        # differences of mpmath need room at either end
        best = highest(stretches(law, nu, 0 if nu == 2 else mpmath.mpf(10) ** -14))
    assert law.peak(nu).value == pytest.approx(float(best), rel=1e-11)
