"""Laws given as formulas: beside closed forms, mpmath's derivatives and what is refused."""

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from optlaws import InputError, PiecewiseLaw, catalogue, formula_law, read_law

K = np.linspace(0.0, 1.0, 41)


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("k - sin(2*pi*k)/(2*pi)", "cycloidal"),
        ("(1 - cos(pi*k))/2", "simple harmonic"),
        ("k^3*(10 - 15*k + 6*k^2)", "3-4-5 polynomial"),
        ("k + sin(pi*k)/pi", "C2"),
        ("2*k^2 - max(0, 2*k - 1)^2", None),
        ("k", "constant velocity"),
    ],
)
def test_formulas_of_standard_laws_are_these_laws(text: str, name: str | None) -> None:
    law = formula_law(text)
    known = catalogue[name or "constant acceleration"].law
    for nu in range(4 if name else 3):
        assert law(K, nu) == pytest.approx(known(K, nu), abs=1e-11 * 10**nu)
    for constant in "BCD":
        exact = getattr(known.constants, constant).value
        assert getattr(law.constants, constant).value == pytest.approx(exact, rel=1e-12)


def test_derivatives_are_those_of_mpmath() -> None:
    law = formula_law("(exp(2*k) - 1 + atan(3*k)*k^3)/(exp(2) - 1 + atan(3))")

    def exact(k: mpmath.mpf) -> mpmath.mpf:
        top = mpmath.exp(2 * k) - 1 + mpmath.atan(3 * k) * k**3
        return top / (mpmath.exp(2) - 1 + mpmath.atan(3))

    with mpmath.workdps(40):
        for k in (0.0, 0.3, 0.77, 1.0):
            for nu in range(4):
                value = float(mpmath.diff(exact, mpmath.mpf(k), nu))
                assert law(k, nu) == pytest.approx(value, rel=1e-11, abs=1e-11)


def test_kinks_are_where_parts_meet_whichever_they_are() -> None:
    law = formula_law("max(0, k - 0.3, 2*k - 0.8, 3*k - 1.6)")
    assert law(K) == pytest.approx(np.max([0 * K, K - 0.3, 2 * K - 0.8, 3 * K - 1.6], axis=0), abs=1e-15)
    assert np.array(law.jumps(1)) == pytest.approx(np.array([(0.3, 1.0), (0.5, 1.0), (0.8, 1.0)]))
    swing = formula_law("abs(sin(3*pi*k))")
    assert [place for place, _ in swing.jumps(1)] == pytest.approx([1 / 3, 2 / 3])
    table = formula_law("table(k, 0:0, 0.5:0.25, 1:1)")
    assert table.jumps(1) == ((0.5, 1.0),)


@pytest.mark.parametrize(
    "shape", ["spline(k, 0:0, 0.2:0.1, 0.6:0.7, 0.8:0.9, 1:1)", "spline(2*k, 0:0, 1:0.4, 1.5:1, 2:1)"]
)
def test_splines_are_cubics_between_their_places(shape: str) -> None:
    law = formula_law(shape)
    assert isinstance(law, PiecewiseLaw)
    assert law.jumps(1) == law.jumps(2) == ()
    assert law(K, 4) == pytest.approx(0.0, abs=1e-7)
    assert PiecewiseLaw.from_dict(law.to_dict()) == law


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("k +", "expected a number"),
        ("k + b", "unknown name 'b'"),
        ("1/(k - 0.5)", "is divided by"),
        ("sqrt(k)", "acceleration of the law"),
        ("k^1.5", "acceleration of the law"),
        ("abs(k - 0.4)^1.5", "acceleration of the law"),
        ("log(k)", "no finite value"),
        ("", "expected a number"),
        (3, "must be a text"),
    ],
)
def test_what_is_no_law_is_refused(text: str, named: str) -> None:
    with pytest.raises(InputError, match=named):
        formula_law(text)


def test_a_formula_is_named_wherever_a_law_is() -> None:
    assert read_law("formula: k^2*(3 - 2*k)") == formula_law("k^2*(3 - 2*k)")
    with pytest.raises(InputError, match="a tolerance and columns are of a table"):
        read_law("formula: k", tolerance=0.1)
