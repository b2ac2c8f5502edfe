"""Classes of users whose methods contradict each other are refused, and said to be."""

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import Basis, Functional, InputError, MotionLaw, Problem, synthesize
from optlaws.synthesis import PolynomialBasis
from tests.internals.synthesis import ConstraintFamily, LawSpace

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
