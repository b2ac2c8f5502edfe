"""What modes of machines are left with, in complex balls, against eigenvectors and integrals by mpmath."""

from fractions import Fraction

import mpmath  # type: ignore[import-untyped] # ships no types
import pytest
from flint import ctx

from optlaws import InputError, Link, Machine, smoothstep
from tests.internals.verification import ExactLaw, ExactModeResidual, enclosed, lower, upper

ORDER = 3
CHAIN = Machine.from_masses(
    {"drive": 1.0, "first": 0.5, "last": 0.3},
    [Link("drive", "first", 300.0, 0.4), Link("first", "last", 900.0, 0.2)],
    drive="drive",
    outputs=["force drive-first", "acceleration last"],
)
#: two equal vibrations beside each other: one mode
TWIN = Machine(
    [[0, 1, 0, 0], [-400, -2, 0, 0], [0, 0, 0, 1], [0, 0, -400, -2]], [[0], [400], [0], [100]], [[1, 0, 2, 1]]
)


def velocity(k: mpmath.mpf) -> mpmath.mpf:
    return 30 * k**2 * (1 - k) ** 2


def amplitude(machine: Machine, output: str, root: mpmath.mpc, place: mpmath.mpc) -> mpmath.mpf:
    """By eigenvectors of the matrix; the share at the machine's own root, the integral at another place."""
    roots, left, right = mpmath.eig(mpmath.matrix(machine.A), left=True, right=True)
    own = min(range(len(roots)), key=lambda i: abs(roots[i] - root))
    w = roots[own]
    driven = mpmath.matrix(machine.B) * mpmath.matrix([w ** ("abc".index(one) - 1) for one in machine.inputs])
    row, column = left[own, :], right[:, own]
    seen = (mpmath.matrix([list(machine.C[machine.place(output)])]) * column)[0]
    share = seen * (row * driven)[0] / (row * column)[0]
    integral = mpmath.quad(lambda k: mpmath.exp(place * (1 - k)) * velocity(k), [0, 0.5, 1])
    return abs(2 * share * integral)


@pytest.mark.parametrize(("mode", "output"), [(1, "force drive-first"), (2, "acceleration last")])
def test_an_amplitude_is_that_of_eigenvectors(mode: int, output: str) -> None:
    root = mpmath.mpc(CHAIN.modes[mode - 1].root)
    with mpmath.workdps(40):
        own = min(mpmath.eig(mpmath.matrix(CHAIN.A))[0], key=lambda one: abs(one - root))
        expected = amplitude(CHAIN, output, own, own)
        found = ExactLaw(smoothstep(ORDER)).term(CHAIN.residual(mode, output))
        off = expected * mpmath.mpf("1e-30")
        assert lower(found) <= Fraction(str(expected + off))
        assert upper(found) >= Fraction(str(expected - off))
        assert float(found.rad()) < 1e-30


@pytest.mark.parametrize("box", [{"spread": 0.1}, {"damping": (0.0, 0.05)}, {"spread": 0.1, "damping": (0.0, 0.05)}])
def test_the_greatest_over_a_box_is_that_of_doubles(box: dict[str, float | tuple[float, float]]) -> None:
    constant = CHAIN.residual(1, "acceleration last", **box)  # type: ignore[arg-type]
    low, high = enclosed(ExactLaw(smoothstep(ORDER)).term(constant))
    assert constant.value(smoothstep(ORDER)) == pytest.approx(low, rel=1e-11)
    assert high - low < 1e-13 * high


def test_equal_vibrations_beside_each_other_are_one_mode() -> None:
    residual = ExactModeResidual(TWIN.residual())
    with ctx.workprec(300):
        assert [count for _, count in residual.mode] == [2]
        assert float(residual.share.mid()) == pytest.approx(TWIN.residual().share, rel=1e-12)


def test_modes_that_no_number_tells_apart_are_refused() -> None:
    two = Machine(
        [[0, 1, 0, 0], [-400, -2, 0, 0], [0, 0, 0, 1], [0, 0, -400, -4]], [[0], [400], [0], [100]], [[1, 0, 2, 1]]
    )
    with ctx.workprec(300), pytest.raises(InputError, match="same frequency"):
        _ = ExactModeResidual(two.residual()).mode
