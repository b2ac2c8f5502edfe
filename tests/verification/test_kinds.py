"""Whatever kind of problem optlaws solves, its file is proven, and fast; own constants have a bound by numpy."""

import json
import time
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from optlaws import (
    BoundaryConditions,
    Functional,
    InputError,
    MotionLaw,
    Problem,
    Solution,
    at_least,
    between,
    law_from_z,
    synthesize,
)
from optlaws.verification import exact_bound, verify
from tests.internals.synthesis import ConstraintFamily, LawSpace
from tests.sampling import examples
from tests.verification.problems import (
    ALONE,
    BOUNDED_FORMULAS,
    CONVEX,
    DEGREE_9,
    FORMULAS,
    KINDS,
    LOCAL,
    OF_CAMS,
    ONCE_REFUSED,
    PIECES,
    RESIDUALS,
)
from tests.verification.tampering import data_of

OF_FORMULAS = [*FORMULAS, *BOUNDED_FORMULAS, *ALONE]
NAMED = [*ONCE_REFUSED.values(), *OF_CAMS.values(), *RESIDUALS.values()]
EVERY = [*CONVEX, *LOCAL, *PIECES, *KINDS, *NAMED, *OF_FORMULAS]


@pytest.mark.sample(9)
@pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")
@pytest.mark.parametrize("problem", EVERY, ids=repr)
def test_every_kind_is_read_again_and_proven(problem: Problem) -> None:
    data = data_of(problem)
    again = Solution.from_dict(data)
    assert again.problem == problem
    assert hash(again.problem) == hash(problem)
    assert json.loads(json.dumps(again.to_dict())) == data
    verification = verify(data)
    assert [str(claim) for claim in verification.claims if not claim.proven] == []
    assert verification.gap is not None
    assert verification.objective is not None
    assert verification.bound is not None
    scale = max(abs(verification.objective[1]), 1e-9 * problem.objective.scale)
    assert verification.bound <= verification.objective[1] + 1e-11 * scale
    assert verification.bound >= data["certificate"]["bound"] - 1e-9 * scale
    if data["status"] == "optimal":
        assert abs(verification.gap) < 1e-8
    else:
        assert problem in LOCAL or not problem.convex


def test_a_law_of_degree_9_is_checked_in_less_than_a_second() -> None:
    data = data_of(Problem(B=1.859, order=4, basis=DEGREE_9))
    start = time.process_time()
    assert verify(data).proven
    assert time.process_time() - start < 1.0


@dataclass(frozen=True, repr=False)
class Heating(Functional):
    """RMS of c + r b from rest to rest."""

    friction: float

    def value(self, law: MotionLaw) -> float:
        """By the two RMS."""
        return float(np.hypot(law.rms(2), self.friction * law.rms(1)))

    def families(self, space: LawSpace, slack: NDArray[np.float64], bound: float) -> tuple[ConstraintFamily, ...]:
        """A norm of the coordinates."""
        inertia, drag = (space.norm(nu, self.name, slack, bound) for nu in (2, 1))
        return (replace(inertia, matrix=np.vstack([inertia.matrix, self.friction * drag.matrix])),)

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """The RMS of c is no greater."""
        return ((2, 1.0),)


@dataclass(frozen=True, repr=False)
class Silent(Heating):
    """The same, which does not tell what it bounds."""

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """Nothing."""
        return ()


HEATING, SILENT = (kind("heating", 12**0.5, convex=True, friction=3.0) for kind in (Heating, Silent))


@pytest.mark.parametrize("B", [None, at_least(1.2), between(1.2, 2.0), 1.8])
@pytest.mark.parametrize("symmetric", [True, False])
def test_an_own_constant_is_proven_like_the_others(B: float | None, symmetric: bool) -> None:  # noqa: FBT001
    solution = synthesize(Problem(B=B, order=4, basis=DEGREE_9, minimise=HEATING, symmetric=symmetric))
    assert solution.status.value == "optimal"
    assert abs(solution.certificate.bound / solution.objective - 1.0) < 1e-9


@examples(40)
@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 10.0))
def test_no_law_beats_the_bound_of_an_own_constant(seed: int, size: float) -> None:
    solution = synthesize(Problem(order=4, basis=DEGREE_9, minimise=HEATING))
    assert solution.z is not None
    z = np.array(solution.z) + np.random.default_rng(seed).normal(size=10) * size
    law = law_from_z(BoundaryConditions.rest(4), z, DEGREE_9)
    assert HEATING.value(law) >= solution.certificate.bound


def test_without_a_word_of_what_it_bounds_nothing_is_proven_where_B_is_free() -> None:
    solution = synthesize(Problem(order=4, basis=DEGREE_9, minimise=SILENT))
    assert solution.status.value == "inaccurate"
    assert solution.certificate.bound == 0.0  # which a constant is not below


def test_an_own_constant_is_not_taken_for_exact() -> None:
    solution = synthesize(Problem(order=4, basis=DEGREE_9, minimise=HEATING))
    with pytest.raises(InputError, match="as optlaws defines them, not heating"):
        exact_bound(solution.certificate)
    with pytest.raises(InputError, match="heating"):
        verify(solution.to_dict())
