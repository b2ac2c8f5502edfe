"""Polynomials for laws that are none of low degree: near them over the whole interval, and few with the best breaks."""

import numpy as np
import pytest

from optlaws import InputError, catalogue, limit_law, scca, smoothstep
from tests.internals.exports import fitted
from tests.internals.motion import motion_of_law

SAID = {"stroke": "35 mm", "duration": "0.1 s"}


@pytest.mark.parametrize("name", ["cycloidal", "modified sine", "modified trapezoid"])
@pytest.mark.parametrize("degree", [5, 7])
def test_deviations_that_are_stated_are_the_greatest(name: str, degree: int) -> None:
    motion = motion_of_law(catalogue[name].law, **SAID)
    made = fitted(motion, degree, 50)
    x = np.linspace(0.0, 0.1, 20001)
    for nu, stated in ((0, made.deviation), (2, made.acceleration)):
        seen = np.abs(made.run(x, nu) - motion(x, nu)).max()
        assert 0.99 * stated <= seen <= stated * (1.0 + 1e-6) + 1e-12 * motion.peak(nu)
    assert made.acceleration <= 1e-2 * motion.peak(2)
    assert made.run.peak(2).value <= (1.0 + 1.001e-3) * motion.peak(2)
    assert np.abs(made.run.jumps(1)).max(initial=0.0) <= 1e-10 * motion.peak(1)


def test_each_side_of_a_jump_keeps_its_own_derivatives() -> None:
    motion = motion_of_law(scca(0.25, 0.5, 0.25), **SAID)
    made = fitted(motion, 7, 50)
    assert made.run.peak(3).value == pytest.approx(motion.peak(3), rel=1e-3)
    pieces = catalogue["modified trapezoid"].law.pieces("35 mm", "0.1 s")
    whole = motion_of_law(catalogue["modified trapezoid"].law, **SAID)
    off = pieces.deviation(lambda x, nu: whole(np.clip(x, 0.0, 0.1), nu), 0, whole.breaks)
    assert off.value <= 1e-9 * 35.0


def test_what_no_polynomial_is_near_to_is_refused() -> None:
    with pytest.raises(InputError, match="acceleration of the motion has no bound"):
        fitted(motion_of_law(limit_law("D", None), **SAID), 7, 50)
    with pytest.raises(InputError, match="pieces of its own, and the target holds 2: export its parts"):
        fitted(motion_of_law(catalogue["modified trapezoid"].law, **SAID), 5, 2)
    with pytest.raises(InputError, match=r"do not bring the acceleration within .*points=\.\.\."):
        fitted(motion_of_law(smoothstep(12), **SAID), 5, 3)
