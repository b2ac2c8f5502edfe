"""Rows divided by what they vanish like: equal to their definition, and sharper than the plain ones."""

from typing import Any

import numpy as np
import pytest

from optlaws import BoundaryConditions, Chebyshev, Pieces, Problem, synthesize
from tests.internals.synthesis import PieceSpace, space_of
from tests.internals.verification import prove
from tests.synthesis.judge import judge


@pytest.mark.parametrize("order", [1, 2, 4])
@pytest.mark.parametrize("degree", [2, 3, 8, 15])
def test_the_chord_of_unsymmetric_laws_is_what_it_says(order: int, degree: int) -> None:
    space = space_of(Chebyshev(degree), BoundaryConditions.rest(order), symmetric=False)
    bend = space.row(2, 0.5)
    x = np.random.default_rng(degree).normal(size=space.terms)
    # the nearest law with c(1/2) = 0
    x -= bend[:-1] * (bend @ np.append(x, 1.0)) / (bend[:-1] @ bend[:-1])
    law = space.law(x)
    k = np.array([0.0, 0.1, 0.3, 0.45, 0.6, 0.9, 1.0])
    expected = -(law.b(0.5) - law.b(k)) / (1 - 2 * k) ** 2
    family = space.below(np.zeros(space.terms))
    assert family.value(x, 1 - 2 * k) == pytest.approx(expected, rel=1e-9, abs=1e-9)
    # at the middle b'' / 8 is left
    assert family.value(x, np.zeros(1))[0] == pytest.approx(law.j(0.5) / 8, rel=1e-9)


@pytest.mark.sample(4)
@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("symmetric", [True, False], ids=["symmetric", "unsymmetric"])
def test_the_forward_rows_of_pieces_are_what_they_say(order: int, symmetric: bool) -> None:  # noqa: FBT001
    solution = synthesize(
        Problem(B=2.1, order=order, basis=Pieces(6, 6, 4), minimise="J", monotone=True, symmetric=symmetric)
    )
    judge(solution)
    space = space_of(Pieces(6, 6, 4), BoundaryConditions.rest(order), symmetric=symmetric)
    assert solution.active_set is not None
    x = solution.active_set.x[: space.terms]
    k = np.array([1e-3, 0.05, 0.15, 0.2, 0.4, 0.5] if symmetric else [1e-3, 0.1, 0.2, 0.5, 0.8, 0.9, 0.999])
    share = np.minimum(1.0, 6 * np.minimum(k, 1 - k)) ** (order - 1)
    value = space.forward(np.zeros(space.terms)).value(x, 1 - 2 * k)
    assert value == pytest.approx(-solution.law.b(k) / share, rel=1e-8, abs=1e-9)
    assert isinstance(space, PieceSpace)


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "given",
    [
        *({"B": B, "basis": Chebyshev(9), "minimise": "C_plus", "symmetric": False} for B in (1.7, 2.5)),
        *({"B": B, "basis": Pieces(6, 6, 4), "minimise": "J", "monotone": True} for B in (2.1548, 2.6)),
        *({"B": 1.9, "basis": Pieces((0.0, 0.3, at, 1.0), 5, 1), "symmetric": False} for at in (0.5, 0.55)),
    ],
    ids=str,
)
def test_their_proofs_hold_in_exact_arithmetic(given: dict[str, Any]) -> None:
    solution = synthesize(Problem(order=3, **given))
    proof = prove(solution.certificate)
    assert proof.unknown == 0
    assert proof.value is not None
    assert float(proof.value) == pytest.approx(solution.objective, rel=1e-9)
