"""A given inflexion: the peak velocity stands there, whatever is minimised; HiGHS finds the same."""

from typing import Any

import pytest

from optlaws import (
    BoundaryConditions,
    BSplines,
    C_minus,
    C_plus,
    Chebyshev,
    InputError,
    Pieces,
    Problem,
    between,
    sweep,
    synthesize,
)
from tests.synthesis.grids import polynomials

CASES: list[dict[str, Any]] = [
    {"B": 1.8},
    {"B": 1.8, "monotone": True, "order": 4},
    {"B": between(1.6, 1.9)},
    {"B": 1.7, "minimise": "J"},
    {"B": 1.7, "minimise": "rms_c"},
    {"minimise": "C"},
    {"minimise": "max(C_plus, C_minus/2)"},
    {"boundary": BoundaryConditions((0, 0, 0), (1, 0.5, 0)), "B": 1.7},
    {"B": 1.8, "basis": BSplines(8, 3)},
    {"B": 1.8, "basis": Pieces(10, 5, 3)},
    {"B": 1.8, "basis": Pieces((0.0, 0.1, 0.2, 0.35, 0.6, 0.8, 1.0), 5, 3)},
]


def problem(**given: Any) -> Problem:
    order = {} if "boundary" in given else {"order": 3}
    return Problem(**{"basis": Chebyshev(11), "symmetric": False, "inflexion": 0.4, **order, **given})


@pytest.mark.sample(9)
@pytest.mark.parametrize("given", CASES, ids=str)
def test_the_peak_velocity_stands_at_the_inflexion(given: dict[str, Any]) -> None:
    asked = problem(**given)
    solution = synthesize(asked)
    law = solution.law
    assert solution.status == "optimal"
    assert law.c(0.4) == pytest.approx(0.0, abs=1e-9)
    highest = law.extrema(1)[1]
    assert highest.k == pytest.approx(0.4, abs=1e-6)
    assert law.b(0.4) >= highest.value * (1 - 1e-12)
    if isinstance(asked.B, float):
        assert law.b(0.4) == pytest.approx(asked.B, rel=1e-11)
    if asked.boundary is None:
        mirror = synthesize(problem(**{**given, "inflexion": 0.6, **_mirrored(given)}))
        assert mirror.objective == pytest.approx(solution.objective, rel=1e-9)
    assert solution.best_possible is None or solution.best_possible <= solution.objective
    assert Problem.from_dict(asked.to_dict()) == asked


def _mirrored(given: dict[str, Any]) -> dict[str, Any]:
    if "C_minus" in str(given.get("minimise")):
        return {"minimise": "max(C_minus, C_plus/2)"}
    basis = given.get("basis")
    if isinstance(basis, Pieces):
        return {"basis": Pieces([1.0 - k for k in reversed(basis.breaks)], basis.degree, basis.continuity)}
    return {}


@pytest.mark.sample(6)
@pytest.mark.parametrize("k", [0.25, 0.4, 0.5, 0.7])
@pytest.mark.parametrize("B", [1.6, 2.1])
def test_highs_agrees(B: float, k: float) -> None:
    motion = polynomials(3, 9)
    c, b = motion.rows(2), motion.rows(1)
    expected = motion.least([(c, None), (-c, None), (b, B), (-b, B)], [(motion.row(1, k), B), (motion.row(2, k), 0.0)])
    solution = synthesize(problem(B=B, basis=Chebyshev(9), inflexion=k))
    assert expected is not None
    assert solution.objective == pytest.approx(expected, rel=1e-4)
    assert solution.objective >= expected * (1 - 1e-6)


def test_in_the_middle_it_is_the_law_without_it() -> None:
    plain = synthesize(Problem(B=1.8, order=3))
    same = synthesize(Problem(B=1.8, order=3, symmetric=False, inflexion=0.5))
    assert same.objective == pytest.approx(plain.objective, rel=1e-10)
    assert same.best_possible == plain.best_possible
    assert Problem(B=1.8, order=3, inflexion=0.5) == Problem(B=1.8, order=3)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("k", "B"), [(0.1, 1.5), (0.2, 1.8), (0.4, 1.7), (0.35, 2.4)])
def test_the_limit_of_uneven_laws_is_not_that_of_even_ones_and_holds(k: float, B: float) -> None:
    solution = synthesize(problem(B=B, inflexion=k, basis=Chebyshev(25)))
    assert solution.best_possible is not None
    assert solution.best_possible >= B / k * (1 - 1e-12)
    assert solution.best_possible <= solution.objective <= 1.25 * solution.best_possible


def test_a_ratio_and_an_inflexion_together() -> None:
    solution = synthesize(problem(minimise="max(C_plus, C_minus/1.5)"))
    assert C_minus.value(solution.law) / C_plus.value(solution.law) == pytest.approx(1.5, rel=1e-9)
    assert solution.law.c(0.4) == pytest.approx(0.0, abs=1e-9)


def test_neighbours_are_continued() -> None:
    first = [problem(B=B) for B in (1.7, 1.72, 1.74)]
    for solution, asked in zip(sweep(first), first, strict=True):
        assert solution.objective == pytest.approx(synthesize(asked).objective, rel=1e-10)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"inflexion": 1.4}, "between 0 and 1"),
        ({"inflexion": 0.0}, "between 0 and 1"),
        ({"inflexion": "0.4"}, "between 0 and 1"),
        ({"inflexion": True}, "between 0 and 1"),
        ({"symmetric": True}, "give symmetric=False"),
    ],
)
def test_inflexions_that_make_no_sense_are_refused(given: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        problem(B=1.7, **given)
