"""What every segment does: derivatives, exact integrals, closed forms of what is made from it, storage.

A new kind is a line in EXAMPLES; that it needs no more than its class is shown by one that is made here.
"""

import copy
import json
import pickle
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import (
    Follower,
    InputError,
    MotionLaw,
    PiecewiseLaw,
    mirrored_law,
    multiplied_law,
    polydyne,
    residual_phasor,
    reversed_law,
    smoothstep,
    with_end_velocity,
)
from tests.contracts.kinds import kinds
from tests.internals.balancing import LoaderSegment, PartSegment
from tests.internals.laws import (
    FractionalSegment,
    HarmonicSegment,
    PolynomialSegment,
    PowerSegment,
    Segment,
    SineSegment,
    from_half,
)

Array = NDArray[np.float64]
Example = tuple[Segment, float]

#: with their lengths
EXAMPLES: dict[str, Example] = {
    "uniform velocity": (PolynomialSegment((), 0.7), 0.4),
    "polynomial": (PolynomialSegment((1.0, -2.0, 0.5, 3.0), -0.3), 0.8),
    "rising power": (PowerSegment(0.3, 1.4), 0.6),
    "falling power backwards": (PowerSegment(-1.6, -0.5), 0.25),
    "power at one velocity": (PowerSegment(1.2, 1.2), 0.5),
    "sine": (SineSegment(6.0, 9.0, 0.4, b0=0.2), 0.7),
    "fast sine": (SineSegment(-2.0, 120.0, 2.0), 0.5),
    "sine on a parabola": (SineSegment(2.0, 5.0, -1.0, 0.5, (1.0, -3.0, 2.0)), 0.3),
    "parabola without a sine": (SineSegment(0.0, 5.0, 0.0, 0.5, (1.0, -3.0, 2.0)), 0.3),
    "slight sine on a slope": (SineSegment(1.0, 5.0, 0.3, 0.5, (0.5, 6.0)), 0.7),
    "harmonics": (HarmonicSegment((6.0, 1.0, -0.5), (6.0, 18.0, 31.0), (0.0, 0.3, 1.0), 0.4), 0.9),
    "power of time": (FractionalSegment(4.5, 0.2, 1.1, (1.0, -2.0), -0.1), 0.5),
    "falling power of time": (FractionalSegment(3.3, 0.9, 0.0, (2.0,), 0.3), 0.35),
    "whole powers of time": (FractionalSegment(1.0, 0.0, 0.8, (2.0, -1.0, 3.0), 0.3), 0.35),
    "rise of a loader": (LoaderSegment(smoothstep(3), 0.1, 0.5, 1.1, "end"), 0.4),
    "return of a loader": (LoaderSegment(smoothstep(3), 0.5, 0.8, -1.1, "start"), 0.3),
    "part of a law": (PartSegment(smoothstep(4), 0.2, 0.7, -1.5), 0.9),
}
#: c or its derivatives grow without limit at an end
ROUGH: dict[str, Example] = {
    "power from rest": (PowerSegment(0.0, 1.5), 0.5),
    "power to rest": (PowerSegment(-1.5, 0.0), 0.5),
    "root of time": (FractionalSegment(-0.5, 0.0, 2.0, (0.75, 1.0), 0.5), 0.6),
    "weak power of time": (FractionalSegment(-0.25, 0.0, 2.0, (0.75, 1.0), 0.5), 0.6),
    "strong power of time": (FractionalSegment(-0.75, 1.5, 0.0, (0.75, 1.0), 0.5), 0.6),
    "power of time to zero": (FractionalSegment(1.5, 1.0, 0.0, (4.0,), 2.0), 0.5),
}
SMOOTH, ANY = EXAMPLES, EXAMPLES | ROUGH
U = np.linspace(0.0, 1.0, 41)
INNER = np.linspace(0.05, 0.95, 31)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)
START, END = np.zeros(1), np.ones(1)

each = pytest.mark.parametrize(("segment", "length"), ANY.values(), ids=ANY.keys())
each_smooth = pytest.mark.parametrize(("segment", "length"), SMOOTH.values(), ids=SMOOTH.keys())


def integral(f: Callable[[Array], Array], length: float) -> float:
    """Of a function of u over the segment, in 64 cells."""
    cells = np.linspace(0.0, 1.0, 65)
    u = 0.5 * (cells[1:] + cells[:-1])[:, None] + NODES / 128.0
    return float((f(u) @ WEIGHTS).sum() * length / 128.0)


def squared(segment: Segment, length: float, nu: int) -> float:
    return integral(lambda u: segment.derivative(u, length, nu) ** 2, length)


def size(segment: Segment, length: float, nu: int) -> float:
    return max(1.0, float(np.abs(segment.derivative(INNER, length, nu)).max()))


def test_every_kind_has_an_example() -> None:
    assert kinds(Segment) <= {type(segment) for segment, _ in ANY.values()}


@each
def test_derivatives_are_the_limits_of_differences(segment: Segment, length: float) -> None:
    h = 1e-3
    for nu in (1, 2, 3, 4):
        moved = [segment.derivative(INNER + i * h, length, nu - 1) for i in (-2, -1, 1, 2)]
        difference = (moved[0] - 8 * moved[1] + 8 * moved[2] - moved[3]) / (12 * h * length)
        above = np.abs([segment.derivative(INNER + i * h, length, nu + 4) for i in (-2, 0, 2)]).max(axis=0)
        rounding = 1e-13 * np.abs(moved).max() / (h * length)
        expected = segment.derivative(INNER, length, nu)
        assert (np.abs(difference - expected) <= 0.1 * (h * length) ** 4 * above + rounding).all()


@each
def test_displacement_is_counted_from_the_start(segment: Segment, length: float) -> None:
    assert abs(segment.derivative(START, length, 0)[0]) <= 1e-15
    way = integral(lambda u: segment.derivative(u, length, 1), length)
    assert segment.derivative(END, length, 0)[0] == pytest.approx(way, rel=1e-6, abs=1e-12)
    assert segment.velocity(length) == segment.derivative(START, length, 1)[0]
    assert segment.velocity(length, last=True) == segment.derivative(END, length, 1)[0]


@each_smooth
def test_squares_are_integrated_exactly(segment: Segment, length: float) -> None:
    for nu in (1, 2, 3, 4):
        expected = squared(segment, length, nu)
        assert segment.square(length, nu) == pytest.approx(expected, rel=1e-10, abs=1e-20)


@pytest.mark.parametrize(("segment", "length"), ROUGH.values(), ids=ROUGH.keys())
def test_squares_are_infinite_where_a_derivative_grows_like_a_root_or_faster(segment: Segment, length: float) -> None:
    for nu in (1, 2, 3, 4):
        near, nearer = (segment.derivative(np.array([x, 1.0 - x]), length, nu) for x in (1e-6, 1e-8))
        growth = np.log(np.abs(nearer / near)).max() / np.log(100.0)
        square = segment.square(length, nu)
        assert np.isinf(square) == (growth > 0.499)
        if growth < 0.01:
            assert square == pytest.approx(squared(segment, length, nu), rel=1e-6)


@pytest.mark.parametrize(("ends", "q"), [((0.0, 2.0), 3.0), ((0.5, 0.0), -3.0)])
def test_the_square_of_an_integrable_growth_has_its_closed_form(ends: tuple[float, float], q: float) -> None:
    # c = q v^-1/4, and v is straight from one end to the other
    square = FractionalSegment(-0.25, *ends, (q,)).square(0.6, 2)
    assert square == pytest.approx(q * q * 2.0 * max(ends) ** 0.5 * 0.6 / max(ends), rel=1e-14)


def test_where_the_rest_outweighs_the_sine_nothing_is_extreme_inside() -> None:
    assert SineSegment(1.0, 5.0, 0.3, 0.0, (2.0,)).candidates(0.7, 1).size == 0
    assert SineSegment(1.0, 5.0, 0.3, 0.0, (0.0, 6.0)).candidates(0.7, 2).size == 0


@each
def test_extremes_are_among_the_candidates(segment: Segment, length: float) -> None:
    for nu in range(5):
        places = np.concatenate([START, segment.candidates(length, nu), END])
        assert ((places >= 0.0) & (places <= 1.0)).all()
        values = segment.derivative(places, length, nu)
        dense = segment.derivative(np.linspace(0.001, 0.999, 2001), length, nu)
        room = 1e-12 * float(np.abs(dense).max())
        assert values.min() <= dense.min() + room
        assert values.max() >= dense.max() - room


@each
def test_power_is_bc_and_its_extremes_are_among_the_candidates(segment: Segment, length: float) -> None:
    dense = np.linspace(0.001, 0.999, 2001)
    power = segment.power(dense, length)
    bc = segment.derivative(dense, length, 1) * segment.derivative(dense, length, 2)
    assert power == pytest.approx(bc, rel=1e-9, abs=1e-12)
    places = np.concatenate([START, segment.power_candidates(length), END])
    values = segment.power(places, length)
    room = 1e-12 * float(np.abs(power).max())
    assert not np.isnan(values).any()
    assert values.min() <= power.min() + room
    assert values.max() >= power.max() - room


@each_smooth
@pytest.mark.parametrize(("scale", "drift"), [(2.0, 0.0), (-0.5, 0.3), (1.0, -2.0), (0.0, 1.0)])
def test_scaled_is_what_it_says(segment: Segment, length: float, scale: float, drift: float) -> None:
    made = segment.scaled(length, scale, drift)
    for nu in range(4):
        more = (drift * U * length, drift * np.ones_like(U))[nu] if nu < 2 else 0.0 * U
        expected = scale * segment.derivative(U, length, nu) + more
        room = (1e-13, 1e-13, 1e-12, 1e-9)[nu] * size(segment, length, nu)
        assert made.derivative(U, length, nu) == pytest.approx(expected, abs=room, rel=1e-9)


@each_smooth
def test_backwards_is_what_it_says_and_its_own_inverse(segment: Segment, length: float) -> None:
    made = segment.backwards(length)
    again = made.backwards(length)
    for nu in (1, 2, 3):
        room = (0.0, 1e-12, 1e-11, 1e-8)[nu] * size(segment, length, nu)
        expected = segment.derivative(U, length, nu)
        assert (-1) ** (nu - 1) * made.derivative(1.0 - U, length, nu) == pytest.approx(expected, abs=room)
        assert again.derivative(U, length, nu) == pytest.approx(expected, abs=room)


@each_smooth
def test_times_multiplies_the_acceleration(segment: Segment, length: float) -> None:
    y = np.array([1.5, -0.5, 0.25])
    made = segment.times(length, y)
    expected = segment.derivative(U, length, 2) * np.polynomial.chebyshev.chebval(2.0 * U - 1.0, y)
    assert made.derivative(U, length, 2) == pytest.approx(expected, abs=1e-11 * size(segment, length, 2))
    if not isinstance(made, FractionalSegment):  # powers of v are integrated from v = 0
        assert made.velocity(length) == pytest.approx(segment.velocity(length), abs=1e-13)


@each_smooth
def test_plus_derivatives_adds_them(segment: Segment, length: float) -> None:
    once, twice = 0.03, 0.0007
    made = segment.plus_derivatives(length, once, twice)
    for nu in (1, 2, 3):
        parts = [segment.derivative(U, length, nu + i) for i in range(3)]
        room = (0.0, 1e-11, 1e-10, 1e-7)[nu] * sum(
            f * size(segment, length, nu + i) for i, f in enumerate((1, once, twice))
        )
        assert made.derivative(U, length, nu) == pytest.approx(parts[0] + once * parts[1] + twice * parts[2], abs=room)


@each_smooth
def test_an_interpolant_and_waves_are_the_segment(segment: Segment, length: float) -> None:
    expected = segment.derivative(U, length, 2)
    polynomial = segment.interpolated(length)
    assert isinstance(polynomial, PolynomialSegment)
    assert polynomial.derivative(U, length, 2) == pytest.approx(expected, abs=1e-12 * size(segment, length, 2))
    waves = segment.waves(length)
    if waves is not None:
        c = np.polynomial.chebyshev.chebval(2.0 * U - 1.0, waves.acceleration)
        c = c + sum(sine.amplitude * np.sin(sine.frequency * U * length + sine.phase) for sine in waves.sines)
        assert c == pytest.approx(expected, abs=1e-13 * size(segment, length, 2))
        assert waves.b0 == pytest.approx(segment.velocity(length), abs=1e-14)


@each
def test_rest_is_rest_only_below_the_share_asked(segment: Segment, length: float) -> None:
    made = segment.at_rest(length, 1e-12)
    assert made == segment
    if isinstance(segment, FractionalSegment) and segment.exponent < 0.0:
        nearly = replace(segment, steady=1e-15)
        assert nearly.at_rest(length, 1e-12) == replace(segment, steady=0.0)
        assert nearly.at_rest(length, 1e-18) == nearly


def test_rest_matters_where_c_is_infinite_alone() -> None:
    slow = FractionalSegment(1.5, 1.0, 0.0, (4.0,), 1e-15)
    assert slow.at_rest(0.5, 1e-12) == slow


def test_powers_of_time_plus_their_derivatives_are_no_more_powers_than_there_are() -> None:
    # x^4.5 and x^5.5, and each lowered twice
    made = FractionalSegment(4.5, 0.2, 1.1, (1.0, -2.0), -0.1).plus_derivatives(0.5, 0.03, 0.0007)
    assert isinstance(made, FractionalSegment)
    assert (made.exponent, len(made.coefficients)) == (2.5, 4)


@each
def test_stored_copied_and_pickled_segments_are_equal(segment: Segment, length: float) -> None:
    data = json.loads(json.dumps(segment.to_dict(), allow_nan=False))
    assert Segment.from_dict(data) == segment
    assert data["kind"] == segment.kind
    segment.candidates(length, 2)  # what is kept of it is no part of it
    assert copy.deepcopy(segment) == pickle.loads(pickle.dumps(segment)) == segment  # noqa: S301
    assert hash(Segment.from_dict(data)) == hash(segment)


@each
def test_what_is_no_segment_is_refused_with_its_name(segment: Segment, length: float) -> None:
    assert length > 0.0
    data = segment.to_dict()
    name = fields(segment)[0].name  # type: ignore[arg-type] # a dataclass
    for wrong, message in (
        ({**data, "extra": 1}, f"a {segment.kind} segment has the keys .*'extra' is unknown"),
        ({key: data[key] for key in data if key != name}, f"'{name}' is missing"),
        ({**data, "kind": "novelty"}, "kind of segment 'novelty' is unknown; known are .*polynomial"),
        ({**data, "kind": None}, "kind of segment None is unknown"),
    ):
        with pytest.raises(InputError, match=message):
            Segment.from_dict(wrong)
    numbers = [key for key, value in data.items() if isinstance(value, float) and key not in {"start", "end", "scale"}]
    for key in numbers:
        with pytest.raises(InputError, match=key):
            Segment.from_dict({**data, key: float("nan")})


@pytest.fixture
def exponential() -> Iterator[type]:
    """A kind that nothing else knows."""

    @dataclass(frozen=True)
    class Exponential(Segment, kind="exponential of the contract"):
        rate: float
        factor: float = 1.0

        def __post_init__(self) -> None:
            self._check()

        def derivative(self, u: Array, length: float, nu: int) -> Array:
            return np.asarray(self.factor * self.rate**nu * (np.exp(self.rate * u * length) - (nu == 0)))

        def candidates(self, length: float, nu: int) -> Array:  # noqa: ARG002 - all derivatives are monotone
            return np.empty(0)

        def power_candidates(self, length: float) -> Array:  # noqa: ARG002
            return np.empty(0)

        def square(self, length: float, nu: int) -> float:
            return float(self.factor**2 * self.rate ** (2 * nu - 1) * np.expm1(2 * self.rate * length) / 2)

    yield Exponential
    del Segment.kinds[Exponential.kind]


def rise(kind: Any) -> PiecewiseLaw:
    """Exponential to the middle and back from there."""
    half = kind(3.0, 0.4)
    return from_half([(0.5, half)])


def test_a_new_kind_makes_laws_that_are_stored(exponential: Any) -> None:
    law = PiecewiseLaw([0, 0.5, 1], [exponential(1.0), PolynomialSegment((), float(np.exp(0.5)))])
    assert MotionLaw.from_json(law.to_json()) == law
    assert pickle.dumps(law.to_dict())
    [(place, height)] = law.jumps(2)
    assert place == 0.5
    assert height == pytest.approx(-np.exp(0.5))
    assert (law.continuity, law.constants.J.value) == (1, np.inf)
    assert law.constants.C.value == pytest.approx(np.exp(0.5), rel=1e-15)
    assert law.rms(1) ** 2 == pytest.approx(np.expm1(1.0) / 2 + 0.5 * np.exp(1.0), rel=1e-14)
    with pytest.raises(InputError, match="rate must be a finite real number"):
        exponential(float("inf"))


def test_a_new_kind_is_transformed(exponential: Any) -> None:
    law = PiecewiseLaw([0, 1], [exponential(np.log(2.0))])
    k = np.linspace(0.0, 1.0, 101)
    drifting, mirrored = with_end_velocity(law, 0.25), mirrored_law(law)
    assert drifting.a(k) == pytest.approx(0.75 * law.a(k) + 0.25 * k, abs=1e-14)
    assert mirrored.a(k) == pytest.approx(law.a(1.0 - k), abs=1e-14)
    assert {segment.kind for one in (drifting, mirrored) for segment in one.segments} == {"polynomial"}  # type: ignore[attr-defined] # laws of pieces
    assert reversed_law(law).c(k) == pytest.approx(-law.c(1.0 - k), abs=1e-13)
    symmetric = rise(exponential)
    assert symmetric.a(1.0) == pytest.approx(1.0, abs=1e-14)
    assert symmetric.b(k) == pytest.approx(symmetric.b(1.0 - k), abs=1e-13)
    y = multiplied_law(symmetric, [2, -6, 6])
    ratio = y.c(k[1:50]) / (symmetric.c(k[1:50]) * (2 - 6 * k[1:50] + 6 * k[1:50] ** 2))
    assert ratio == pytest.approx(np.full(49, ratio[0]), rel=1e-11)


def test_a_new_kind_drives_a_follower_and_is_driven_by_a_cam(exponential: Any) -> None:
    law = rise(exponential)
    same = PiecewiseLaw(law.breaks, [segment.interpolated(0.5) for segment in law.segments])
    k = np.linspace(0.0, 1.5, 151)
    for follower in (Follower(15.0), Follower(40.0, 0.05)):
        assert follower.response(law).c(k) == pytest.approx(follower.response(same).c(k), abs=1e-9)
    assert residual_phasor(law, 20.0) == pytest.approx(residual_phasor(same, 20.0), abs=1e-12)
    # between stretches at rest, and without the ends where its acceleration starts: what a cam can make is continuous
    joined = PiecewiseLaw([0, 1], [exponential(0.5)])
    with pytest.raises(InputError, match="the mass law has velocity"):
        polydyne(joined, frequency=20)


def test_a_new_kind_goes_through_a_cam(exponential: Any) -> None:
    def smooth(segment: Any, u: Array, length: float) -> Any:
        return segment.plus_derivatives(length, 0.01, 0.0025).derivative(u, length, 2)

    segment, u = exponential(2.0, 0.5), np.linspace(0.0, 1.0, 21)
    expected = (1 + 0.01 * 2.0 + 0.0025 * 4.0) * segment.derivative(u, 0.5, 2)
    assert smooth(segment, u, 0.5) == pytest.approx(expected, rel=1e-13)
