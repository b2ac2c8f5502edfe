"""Windows that exclude a value which all laws have are refused at once, with a proof that exact arithmetic confirms."""

import pytest

from optlaws import (
    Basis,
    BSplines,
    Certificate,
    Chebyshev,
    InfeasibleProblem,
    Pieces,
    Powers,
    Problem,
    Window,
    synthesize,
)
from optlaws.verification import exact_bound

WINDOWS = [
    Window("a", low=0.3, high=0.3),
    Window("a", low=-20.0, high=0.0, start=0.5),
    Window("a", high=0.9, start=0.5),
    Window("b", low=0.1),
    Window("c", high=-1.0, stop=0.2),
]


@pytest.mark.parametrize("basis", [Chebyshev(9), Chebyshev(1), Powers(3), Pieces(4, 7, 3), BSplines(4, 5)], ids=repr)
@pytest.mark.parametrize("window", WINDOWS, ids=repr)
def test_a_window_without_the_value_of_all_laws_is_refused_with_a_proof(window: Window, basis: Basis) -> None:
    with pytest.raises(InfeasibleProblem) as raised:
        synthesize(Problem(order=3, basis=basis, windows=(window,)))
    assert isinstance(raised.value.proof, Certificate)
    assert (exact_bound(raised.value.proof) or 0) > 0


@pytest.mark.parametrize(("start", "stop", "at"), [(0.0, 0.1, "0"), (0.9, 1.0, "1")])
def test_the_place_is_in_the_window_also_of_symmetric_laws(start: float, stop: float, at: str) -> None:
    window = Window("a", low=0.3, high=0.6, start=start, stop=stop)
    with pytest.raises(InfeasibleProblem, match=rf"the value that every law of the problem has at k = {at}\. "):
        synthesize(Problem(order=4, windows=(window,)))
