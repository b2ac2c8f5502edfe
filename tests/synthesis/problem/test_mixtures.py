"""What a constant counts in a mixture: its least value for laws of the problem's order."""

import warnings

import pytest

from optlaws import FUNCTIONALS, C, Chebyshev, D, J, NotNormalised, Problem, limit, rms_c, synthesize
from tests.internals.synthesis import warn_of_mixture


@pytest.mark.parametrize("order", [2, 3, 4, 6])
def test_the_least_values_are_the_limits_of_the_order(order: int) -> None:
    for constant, name in ((C, "C"), (D, "D"), (J, "J"), (rms_c, "RMS")):
        assert constant.least(order) == pytest.approx(limit(name, order=order), rel=1e-12)
    assert all(one.reference == one.least(2) or one.reference != one.reference for one in FUNCTIONALS.values())


def test_a_mixture_is_judged_by_the_order() -> None:
    mixture = C / 4 + 0.31 * J  # C counts 1, J 3.7 with order 2 and 9.9 from order 3 on
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_of_mixture(mixture, 2)
    with pytest.warns(NotNormalised, match=r"J 9\.92"):
        warn_of_mixture(mixture, 3)
    with pytest.warns(NotNormalised, match=r"C 1, J 9\.95"):
        synthesize(Problem(order=3, basis=Chebyshev(3), minimise=C / 4 + 0.311 * J))
