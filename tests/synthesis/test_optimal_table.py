"""All rows of the printed table: what the printed Z(k) gives, and the optimum of the same shape."""

from fractions import Fraction

import pytest

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    PolynomialLaw,
    Powers,
    Problem,
    Solution,
    law_from_z,
    synthesize,
)
from tests.documents import ROOT
from tests.tables import rows, table

PRINTED, EXACT = table(ROOT / "problems/data/optimal_table_printed.csv"), rows("optimal_table_exact")
ROWS = [
    pytest.param(one, other, id=one["B"]) for one, other in zip(PRINTED, EXACT, strict=True)
]  # fails at once if a row is missing in either
every_row = pytest.mark.parametrize(("printed", "exact"), ROWS)


def law_of(printed: dict[str, str]) -> PolynomialLaw:
    free = [Fraction(text) for text in printed["z"].split()]
    if printed["base"] == "S4":
        return law_from_z(BoundaryConditions.rest(4), free)
    # the law with B = 1.75 of Savin's family II, S_3 + k^3 (k-1)^3 8 (k-1/2), carries the rest: over l = 3, the
    # added k^4 (k-1)^4 Z is k^3 (k-1)^3 times (k² - k) Z
    whole = [Fraction(-4), Fraction(8), *[Fraction(0)] * len(free)]
    for i, value in enumerate(free):
        whole[i + 1] -= value
        whole[i + 2] += value
    return law_from_z(BoundaryConditions.rest(3), whole)


def rounded(value: float, digits: int) -> str:
    return f"{value:.{digits}f}"


def mirrored(k: float) -> float:
    return min(k, 1.0 - k)


@every_row
def test_the_printed_z_gives_the_exact_constants(printed: dict[str, str], exact: dict[str, str]) -> None:
    constants = law_of(printed).constants
    assert rounded(constants.C.value, 4) == exact["C"]
    assert rounded(constants.D.value, 4) == exact["D"]
    assert rounded(constants.J.value, 3) == exact["J"]


@every_row
def test_the_peaks_stand_at_the_exact_places(printed: dict[str, str], exact: dict[str, str]) -> None:
    law = law_of(printed)
    # a peak and its mirror image nearly tie in laws that are symmetric to four digits: either place will do
    assert rounded(mirrored(law.peak(2).k), 4) == exact["k_of_C"]
    assert mirrored(law.power_peak().k) == pytest.approx(float(exact["k_of_D"]), abs=6e-5)


@every_row
@pytest.mark.parametrize("basis", [Powers(3), Chebyshev(3)], ids=["powers", "chebyshev"])
def test_the_optimum_for_odd_cubic_z(printed: dict[str, str], exact: dict[str, str], basis: Powers | Chebyshev) -> None:
    solution = synthesize(Problem(B=float(printed["B"]), order=4, basis=basis))
    assert solution.objective == pytest.approx(float(exact["C_optimal"]), abs=1e-6)
    assert solution.lower_bound == pytest.approx(float(exact["C_optimal"]), abs=1e-6)
    assert solution.gap <= 1e-8


def optimum(printed: dict[str, str], degree: int) -> Solution:
    order = 3 if printed["base"] == "II" else 4
    return synthesize(Problem(B=float(printed["B"]), order=order, basis=Chebyshev(degree)))


@every_row
def test_no_printed_law_beats_the_proven_bound_of_its_own_shape(printed: dict[str, str], exact: dict[str, str]) -> None:
    degree = 5 if printed["base"] == "II" else len(printed["z"].split()) - 1
    # printed coefficients are rounded, and so is the B that they give
    assert float(exact["C"]) >= optimum(printed, degree).lower_bound - 1e-3
