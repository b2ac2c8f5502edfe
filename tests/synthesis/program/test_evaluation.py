"""The value of a law for a problem, and classes of users whose methods contradict each other."""

from dataclasses import dataclass
from math import inf, sqrt
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import (
    B,
    Basis,
    BoundaryConditions,
    C,
    Functional,
    InputError,
    J,
    MotionLaw,
    PolynomialLaw,
    Problem,
    Window,
    at_least,
    at_most,
    between,
    catalogue,
    law_from_z,
    smoothstep,
    snap,
    synthesize,
    via,
)
from optlaws.synthesis import PolynomialBasis
from tests.internals.synthesis import ConstraintFamily, LawSpace, evaluate, shortfalls

CUBIC = smoothstep(2)
#: b = 7/4 T3(2k-1) - 1/4, from -2 at k = 0 and 3/4 up to 3/2 at k = 1/4 and 1; c(1/4) = 0
SWAYING = PolynomialLaw([7 / 4 * 2 * 3, 0.0, 7 / 4 * 2 * 6], a0=0.0, b0=-2.0)
ENDS = BoundaryConditions(start=(0.0,), end=(-0.25,))
#: the cubic turned round, and the cubic at 2/5 of its stroke
BACK = law_from_z(BoundaryConditions((0, 0), (-1, 0)))
SHORT = law_from_z(BoundaryConditions((0, 0), (0.4, 0)))


def cubic(**asked: Any) -> Problem:
    return Problem(order=2, **asked)


@pytest.mark.parametrize(
    ("minimise", "value"),
    [
        ("C", 6.0),
        ("0.5*C + 0.25*J", 6.0),
        ("max(C, J)", 12.0),
        ("max(C, J/3)", 6.0),
        ("B + 2*max(C, J/3) + 3*max(B, C/12)", 1.5 + 12.0 + 4.5),
        ("max(0.5*C + B, max(J/24, B))", 4.5),
        ("rms_c", sqrt(12.0)),
    ],
)
def test_the_objective_is_the_sum_of_its_terms(minimise: str, value: float) -> None:
    values = evaluate(cubic(minimise=minimise), CUBIC)
    assert values.objective == pytest.approx(value, rel=1e-14)
    assert values.excess == 0.0


@pytest.mark.parametrize(
    ("asked", "excess"),
    [
        ({"C": at_most(5.0)}, 0.2),
        ({"C": at_most(6.5), "J": at_most(11.0)}, 1.0 / 11.0),
        ({"C": at_most(5.0), "J": at_most(11.0)}, 0.2),
        ({"C": at_most(5.0), "minimise": "J"}, 0.2),
        ({"J": at_most(24.0)}, 0.0),
        ({"C": at_least(7.0)}, 0.0),
        ({"C": between(3.0, 4.0)}, 0.5),
        ({"bounds": {"rms_c": at_most(3.0)}}, sqrt(12.0) / 3.0 - 1.0),
        ({"B": at_most(1.2)}, 0.25),
        ({"B": at_most(1.6)}, 0.0),
        ({"B": at_least(2.0)}, 0.0),
        ({"B": at_least(2.0), "inflexion": 0.5}, 0.25),
        ({"B": 1.25}, 0.2),
        ({"B": 3.0}, 0.5),
        ({"monotone": True}, 0.0),
        ({"B": at_most(1.2), "C": at_most(4.0)}, 0.5),
        ({"windows": Window("a", high=0.4, stop=0.5)}, 0.1),
        ({"windows": Window("a", low=0.6, start=0.5)}, 0.1),
        ({"windows": Window("a", high=0.6, stop=0.5)}, 0.0),
        ({"windows": (Window("b", low=1.2, start=0.25, stop=0.5), Window("c", high=-1.0, start=0.5))}, 1.0),
        ({"windows": via("j", -10.0, at=0.3)}, 2.0),
        ({"windows": via("j", -13.0, at=0.3)}, 1.0),
        ({"windows": Window("a", high=0.4, stop=0.5), "C": at_most(5.0)}, 0.2),
        # of a formula in units of its scale, which is 8 here: 2c is between -12 and 12
        ({"windows": Window("2*c", high=8.0)}, 0.5),
        ({"windows": Window("2*c", low=-8.0)}, 0.5),
        ({"windows": Window("2*c", low=-10.0, high=11.0)}, 0.25),
        ({"windows": Window("2*c", low=-11.0, high=10.0)}, 0.25),
        ({"symmetric": False, "inflexion": 0.25}, 0.25),
        ({"symmetric": False, "inflexion": 0.5}, 0.0),
        ({"symmetric": False, "inflexion": 0.25, "B": at_least(2.25)}, 0.5),
        ({"symmetric": False, "inflexion": 0.25, "B": at_least(1.125)}, 0.25),
        ({"symmetric": False, "inflexion": 0.5, "B": at_most(1.2)}, 0.25),
    ],
    ids=str,
)
def test_the_excess_is_the_greatest_of_all_that_is_broken(asked: dict[str, Any], excess: float) -> None:
    assert evaluate(cubic(**asked), CUBIC).excess == pytest.approx(excess, rel=1e-12, abs=1e-15)


def test_a_law_is_sound_up_to_rounding_and_where_its_objective_is_a_number() -> None:
    assert evaluate(cubic(C=at_most(6.0)), CUBIC).sound
    assert evaluate(cubic(C=at_most(6.0 * (1.0 - 1e-12))), CUBIC).sound
    assert not evaluate(cubic(C=at_most(6.0 * (1.0 - 1e-4))), CUBIC).sound
    assert not evaluate(cubic(minimise="J"), catalogue["constant acceleration"].law).sound


@pytest.mark.parametrize(
    ("asked", "excess"),
    [
        ({"monotone": True}, 2.0),
        ({"B": at_most(1.6)}, 0.25),
        ({"B": at_most(2.5)}, 0.0),
        ({"inflexion": 0.25}, 0.0),
        ({"inflexion": 0.25, "B": at_least(1.5)}, 0.25),
        ({"inflexion": 0.75}, 1.75),
        ({"inflexion": 0.25, "B": 1.5}, 1.0 / 3.0),
        ({"inflexion": 0.25, "monotone": True}, 2.0),
    ],
    ids=str,
)
def test_a_law_that_goes_back_is_judged_by_its_speed(asked: dict[str, Any], excess: float) -> None:
    problem = Problem(boundary=ENDS, symmetric=False, **asked)
    assert evaluate(problem, SWAYING).excess == pytest.approx(excess, rel=1e-12, abs=1e-15)


def test_laws_of_other_strokes() -> None:
    back = BoundaryConditions((0, 0), (-1, 0))
    assert evaluate(Problem(boundary=back, symmetric=False, B=at_most(1.2)), BACK).excess == pytest.approx(0.25)
    assert evaluate(Problem(boundary=back, symmetric=False, monotone=True), BACK).excess == pytest.approx(1.5)
    short = BoundaryConditions((0, 0), (0.4, 0))
    # speeds below the mean velocity of a rise are measured by that
    slow = Problem(boundary=short, symmetric=False, inflexion=0.25)
    assert evaluate(slow, SHORT).excess == pytest.approx(0.6 - 0.45)


@pytest.mark.parametrize(
    ("asked", "short"),
    [
        ({}, {}),
        ({"C": at_least(7.0)}, {C: 7.0}),
        ({"C": at_least(6.0)}, {}),
        ({"C": at_least(6.0 * (1.0 + 5e-10))}, {}),
        ({"C": at_least(6.0 * (1.0 + 5e-9))}, {C: 6.0 * (1.0 + 5e-9)}),
        ({"C": between(7.0, 8.0), "J": at_least(13.0)}, {C: 7.0, J: 13.0}),
        ({"C": at_most(5.0), "J": at_least(11.0)}, {}),
        ({"bounds": {"snap": at_least(1.0)}}, {snap: 1.0}),
        ({"B": at_most(1.6)}, {}),
        ({"B": 1.6}, {}),
        ({"symmetric": False, "B": at_least(1.6)}, {B: 1.6}),
        ({"symmetric": False, "B": at_least(1.6), "inflexion": 0.5}, {}),
    ],
    ids=str,
)
def test_constants_that_are_too_small_are_named_with_their_bound(
    asked: dict[str, Any], short: dict[Any, float]
) -> None:
    assert shortfalls(cubic(**asked), CUBIC) == short


def test_a_velocity_is_too_small_only_where_its_place_is_not_asked() -> None:
    ends = BoundaryConditions(start=(0, 0), end=(1, 0.5))
    law = law_from_z(ends)  # b = 5k - 9k²/2, at most 25/18
    for asked, short in ((at_least(1.5), {B: 1.5}), (at_least(1.25), {}), (at_most(2.0), {})):
        assert shortfalls(Problem(boundary=ends, symmetric=False, B=asked), law) == short
    assert shortfalls(Problem(boundary=ends, symmetric=False, B=at_least(1.5), inflexion=5 / 9), law) == {}


def test_a_range_without_an_end_asks_nothing() -> None:
    assert evaluate(cubic(B=at_most(inf), C=at_most(inf)), CUBIC).excess == 0.0
    assert np.isfinite(evaluate(cubic(), CUBIC).objective)


# --- classes that contradict themselves ---


Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Jump(Functional):
    """The peak of the snap, whose rows are those of a derivative times a factor."""

    of_rows: int = 4
    factor: float = 1.0

    def value(self, law: MotionLaw) -> float:
        return self.factor * law.peak(4).value

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        return (space.derivative(self.of_rows, self.name, slack, bound),)

    def curbs(self) -> tuple[tuple[int, float], ...]:
        return ((4, 1.0),)


@pytest.mark.parametrize(("of_rows", "factor"), [(5, 1.0), (3, 1.0), (4, 2.0), (4, 0.5)])
@pytest.mark.parametrize("bounded", [False, True])
def test_rows_and_values_that_contradict_each_other_are_refused(of_rows: int, factor: float, *, bounded: bool) -> None:
    jump = Jump("jump", float("nan"), convex=True, of_rows=of_rows, factor=factor)
    problem = Problem(order=5, bounds={jump: (None, 9e9)}) if bounded else Problem(order=5, minimise=jump)
    with pytest.raises(
        InputError, match=r"Jump\.families and Jump\.value contradict each other: of a law the rows ask"
    ):
        synthesize(problem)


def test_those_that_agree_are_taken() -> None:
    assert synthesize(Problem(order=5, minimise=Jump("jump", float("nan"), convex=True))).status == "optimal"


@pytest.mark.parametrize("factor", [1.0, 2.0])
def test_a_basis_whose_conversions_do_not_lead_back_is_refused(factor: float) -> None:
    class Stretched(PolynomialBasis):
        name = "stretched"

        def coefficients(self, series: Array) -> tuple[float, ...]:
            return tuple((factor * series).tolist())

        def series(self, z: object) -> Array:
            return np.asarray(z, dtype=np.float64)

    try:
        problem = Problem(B=1.8, order=4, basis=Stretched(9))
        if factor == 1.0:
            assert synthesize(problem).objective == pytest.approx(synthesize(Problem(B=1.8, order=4)).objective)
            return
        with pytest.raises(InputError, match=r"Stretched\.coefficients and \.series contradict each other at degree 6"):
            synthesize(problem)
    finally:
        del Basis.kinds["stretched"]
