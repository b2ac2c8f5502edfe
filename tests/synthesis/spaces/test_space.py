"""What every set of laws has: what it keeps, and rows for more variables than its coordinates."""

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import BoundaryConditions, Chebyshev, Pieces, Problem
from tests.internals.synthesis import LawSpace, model_of, widened


def space_of(**entries: object) -> LawSpace:
    return model_of(Problem(B=1.8, order=3, **entries)).space  # type: ignore[arg-type]


def test_the_last_32_that_were_made_are_kept() -> None:
    space = space_of(basis=Chebyshev(5))
    made: list[int] = []

    def make(key: int) -> NDArray[np.float64]:
        def anew() -> NDArray[np.float64]:
            made.append(key)
            return np.full(1, float(key))

        return space.cached(("mine", key), anew)

    space._cache.clear()
    for key in range(32):
        assert make(key) == float(key)
    assert [make(key)[0] for key in range(32)] == list(range(32))
    assert made == list(range(32))
    assert make(32) == 32.0
    assert len(space._cache) == 32
    # the first one had to go, and no other
    assert [make(key)[0] for key in range(1, 33)] == list(range(1, 33))
    assert made == list(range(33))
    make(0)
    assert made == [*range(33), 0]
    assert make(0) is make(0)


def test_columns_for_more_variables_are_0_but_for_the_base_law() -> None:
    space = space_of(basis=Chebyshev(5))
    columns = space.columns(2, np.array([0.2, -0.4, 0.6]))
    assert columns.shape == (3, space.terms + 1)
    wide = widened(columns, space.terms + 3)
    assert wide.shape == (3, space.terms + 4)
    assert wide[:, : space.terms] == pytest.approx(columns[:, :-1])
    assert (wide[:, space.terms : -1] == 0.0).all()
    assert wide[:, -1] == pytest.approx(columns[:, -1])


@pytest.mark.parametrize("basis", [Chebyshev(5), Pieces(4, 5, 3)], ids=["polynomials", "pieces"])
def test_rows_are_those_of_the_law(basis: Chebyshev | Pieces) -> None:
    space = space_of(basis=basis, symmetric=False)
    assert space.boundary == BoundaryConditions.rest(3)
    assert not space.jumps(2)
    # what holds arrays is one with itself alone
    assert len({*space.equations(), space.quadrature(2)}) == len(space.equations()) + 1
    assert (space.edges[0], space.edges[-1]) == (1.0, -1.0)
    assert sorted(space.edges, reverse=True) == list(space.edges)
    x = np.linspace(-0.02, 0.03, space.terms)
    law, slack = space.law(x), np.zeros(space.terms)
    u = np.array([0.9, 0.3, -0.55])
    backward = space.backward(slack, 0.25)
    assert backward.signs == (-1.0,)
    for place in u:
        found = backward.jet(x, np.array([place]), np.array([-1.0])).value[0]
        assert found == pytest.approx(-law.b((1.0 - place) / 2.0) - 0.25, abs=1e-9)
    both = space.derivative(2, "C", slack, 5.0)
    assert both.signs == (1.0, -1.0)
    for sign in both.signs:
        values = both.jet(x, u, np.full(3, sign)).value
        assert values == pytest.approx(sign * law.c((1.0 - u) / 2.0) - 5.0, abs=1e-8)
    assert space.combination(1, (1.0,), "B", slack).signs == (1.0, -1.0)
    for turned, k in ((False, np.array([0.05, 0.35])), (True, np.array([0.95, 0.65]))):
        rooted = space.from_rest("from rest", slack, backward=turned)
        assert (rooted.signs, rooted.bound) == ((1.0, -1.0), 0.0)
        expected = law.b(k) / np.sqrt(2.0 * np.minimum(k, 1.0 - k))
        assert rooted.jet(x, 1.0 - 2.0 * np.minimum(k, 1.0 - k), np.ones(2)).value == pytest.approx(expected)
    forward = LawSpace.forward(space, slack)
    assert forward.jet(x, u, np.full(3, -1.0)).value == pytest.approx(-law.b((1.0 - u) / 2.0), abs=1e-9)
    power = space.power("D", slack, 2.0)
    assert power.value(x, u) == pytest.approx(law.b((1.0 - u) / 2.0) * law.c((1.0 - u) / 2.0), abs=1e-8)
    assert (power.signs, power.domain, power.bound, space.power("D", slack).bound) == (
        (1.0, -1.0),
        (-1.0, 1.0),
        2.0,
        0.0,
    )
    norm = space.norm(2, "rms_c", slack)
    assert float(np.linalg.norm(norm.matrix @ np.append(x, 1.0))) == pytest.approx(law.rms(2), abs=1e-9)
    assert (norm.bound, space.norm(2, "rms_c", slack, 3.0).bound) == (0.0, 3.0)
