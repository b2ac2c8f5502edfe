"""Constants of users that say of which derivatives they are the peak are proven in exact arithmetic, and no others."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import (
    FUNCTIONALS,
    C,
    Certificate,
    Chebyshev,
    Functional,
    InputError,
    MotionLaw,
    Pieces,
    Problem,
    at_most,
    peak,
    synthesize,
)
from optlaws.verification import exact_bound, verify
from tests.internals.synthesis import ConstraintFamily, LawSpace

Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Crackle(Functional):
    """The peak of the fifth derivative, in units of `unit`."""

    unit: float = 1.0
    bounded: float = 1.0  #: times what it says that it bounds
    stated: tuple[tuple[int, float], ...] = ((5, 1.0),)

    def value(self, law: MotionLaw) -> float:
        return law.peak(5).value / self.unit

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        return (space.combination(5, (1.0 / self.unit,), self.name, slack, bound),)

    def curbs(self) -> tuple[tuple[int, float], ...]:
        return ((5, self.bounded * self.unit),)

    def derivatives(self) -> tuple[tuple[int, float], ...]:
        return self.stated


@dataclass(frozen=True, repr=False)
class Pull(Functional):
    """The peak of j + 12 c, of a mass on a damper."""

    def value(self, law: MotionLaw) -> float:
        return peak("j + 12*c").value(law)

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        return (space.combination(2, (12.0, 1.0), self.name, slack, bound),)

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """From c = 0 on, c is an average of the pull over 12."""
        return ((2, 1.0 / 12.0),)

    def derivatives(self) -> tuple[tuple[int, float], ...]:
        return ((3, 1.0), (2, 12.0))


NAN = float("nan")
CONSTANTS: dict[str, Functional] = {
    "crackle": Crackle("crackle", NAN, convex=True),
    "units_of_crackle": Crackle("units_of_crackle", NAN, convex=True, unit=8.0, stated=((5, 0.125),)),
    "bold_crackle": Crackle("bold_crackle", NAN, convex=True, bounded=1e-9),
    "double_crackle": Crackle("double_crackle", NAN, convex=True, stated=((5, 2.0),)),
    "pull": Pull("pull", NAN, convex=True),
}


@pytest.fixture(autouse=True)
def named() -> Iterator[None]:
    before = dict(FUNCTIONALS)
    FUNCTIONALS.update(CONSTANTS)
    yield
    for name in FUNCTIONALS.keys() - before.keys():
        del FUNCTIONALS[name]


def plain(problem: Problem) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(json.dumps(synthesize(problem).to_dict()))
    return data


@pytest.mark.parametrize(
    "problem",
    [
        Problem(B=1.8, order=5, minimise=CONSTANTS["crackle"]),
        Problem(order=5, minimise=CONSTANTS["units_of_crackle"]),
        Problem(order=5, basis=Chebyshev(5), bounds={CONSTANTS["crackle"]: at_most(12_000)}, symmetric=False),
        Problem(order=5, basis=Chebyshev(7), minimise="J", bounds={CONSTANTS["units_of_crackle"]: at_most(1125)}),
        Problem(order=3, minimise=CONSTANTS["pull"], symmetric=False, J=at_most(100)),
        Problem(order=5, basis=Pieces(degree=7, breaks=6, continuity=5), minimise=CONSTANTS["crackle"] + 0.001 * C),
    ],
    ids=str,
)
def test_optima_of_own_peaks_are_proven(problem: Problem) -> None:
    verification = verify(plain(problem))
    assert [str(claim) for claim in verification.claims if not claim.proven] == []
    assert verification.gap is not None
    assert abs(verification.gap) < 1e-8


def test_what_a_constant_says_that_it_bounds_is_not_taken_for_granted() -> None:
    bounds = []
    for name in ("crackle", "bold_crackle"):
        solution = synthesize(Problem(B=1.8, order=5, basis=Chebyshev(3), minimise=CONSTANTS[name]))
        contacts = [
            replace(contact, multiplier=contact.multiplier * (1.0 + 1e-4 * i))
            for i, contact in enumerate(solution.certificate.contacts)
        ]
        bounds.append(exact_bound(solution.certificate.with_leaf(contacts=contacts)) or 0)
        assert 0 < bounds[-1] < solution.objective
    assert bounds[0] == bounds[1]


def test_a_value_that_is_not_the_peak_of_these_derivatives_is_found() -> None:
    verification = verify(plain(Problem(B=1.8, order=5, basis=Chebyshev(3), minimise=CONSTANTS["double_crackle"])))
    assert "the objective" in {claim.name for claim in verification.claims if not claim.proven}


@pytest.mark.parametrize(
    "stated", [((0, 1.0),), ((5, 0.0),), ((5, inf),), ((5.0, 1.0),), ((5, 1.0), (5, 1.0))], ids=str
)
def test_pairs_that_are_no_derivatives_are_refused(stated: Any) -> None:
    constant = Crackle("odd_crackle", NAN, convex=True, stated=stated)
    with pytest.raises(InputError, match="derivatives of odd_crackle must be pairs of a whole number"):
        exact_bound(Certificate.of_leaf(Problem(order=5, bounds={constant: at_most(9e4)})))
