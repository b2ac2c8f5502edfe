"""The torsion lever against numbers computed independently: tables, worked cases, 564 integrations, the study."""

from itertools import product
from math import degrees

import numpy as np
import pytest

from optlaws import InputError, TorsionLever, deg
from tests.balancing.levers.cases import Row, apart, lever, truncated
from tests.internals.balancing import FourBar
from tests.tables import rows

CASES = rows("lever_asym_vs_ode")
STUDY = rows("lever_parametric")
EXAMPLES = rows("lever_examples")
CONSTANTS = ("B1", "B3", "C1", "C3", "T", "chi01")
# the one case whose exact motion leaves the limits: 151.2 degrees between coupler and driven link
BEYOND = {"beta": "0.5", "lambda": "1", "rho": "0.3", "nu": "0.05", "swing_deg": "100"}


def is_beyond(row: Row) -> bool:
    return all(float(row[name]) == float(value) for name, value in BEYOND.items())


@pytest.mark.parametrize("row", rows("lever_tables"), ids=lambda row: f"{row['coef']}-{row['beta']}-{row['lambda']}")
def test_coefficients_are_the_closed_forms(row: Row) -> None:
    found = getattr(FourBar(float(row["beta"]), float(row["lambda"] or 1.0)), row["coef"])
    assert found == pytest.approx(float(row["computed"]), abs=5.1e-7)


@pytest.mark.parametrize("number", ["example1", "example2", "example3", "example4"])
def test_worked_examples(number: str) -> None:
    expected = {row["quantity"]: row[number] for row in EXAMPLES}
    one = lever(expected, "lam", least_transmission=deg(28))  # the exact motion of example 2 has 28.7 degrees
    linkage, cut = one.linkage, truncated(one)
    assert expected["within_limits"] == "True"
    found = {
        "alpha": linkage.alpha,
        "psi0_deg": degrees(linkage.psi0),
        **{name: getattr(linkage, name) for name in "QPSR"},
        **{name: getattr(one, name) for name in ("gamma01", "xi", "n", "q", "p", "T0")},
        "Gamma": one.twists[0],
        "swing_eq9_minus_eq10": one.asymptotic.swing,
        "z": np.cos(2 * np.pi * one.asymptotic.zeta),
        "T": one.asymptotic.period,
        "T_ode": one.exact.period,
        "T_eq6": cut.period,
        "max_abs_a_diff": apart(one.asymptotic, one.exact),
        "max_abs_a_diff_eq6": apart(one.asymptotic, cut),
        "gamma01_exact_geometry": float(linkage.rocker(one.chi01)),
        "gamma_swing_deg": degrees(float(np.diff(linkage.rocker(np.array([one.asymptotic.chi02, one.chi01])))[0])),
    }
    for name in ("chi01", "chi02", "zeta", "B1", "B3", "C1", "C3"):
        for suffix, motion in (("", one.asymptotic), ("_ode", one.exact), ("_eq6", cut)):
            found[name + suffix] = getattr(motion, name)
    tested = {name: value for name, value in found.items() if name in expected}
    assert len(tested) == len(expected) - 6  # the five inputs and within_limits
    for name, value in tested.items():
        assert value == pytest.approx(float(expected[name]), rel=1e-6), name


def agrees(row: Row) -> None:
    one = lever(row, least_transmission=deg(28.8 if is_beyond(row) else 30.0))
    for name in CONSTANTS:
        of = "period" if name == "T" else name
        assert getattr(one.asymptotic, of) == pytest.approx(float(row[name]), rel=1e-6)
        assert getattr(one.exact, of) == pytest.approx(float(row[f"{name}_ode"]), rel=1e-6)
    assert apart(one.asymptotic, one.exact) == pytest.approx(float(row["max_da"]), rel=1e-6, abs=1e-11)


@pytest.mark.parametrize("row", [*CASES[::12], *(row for row in CASES if is_beyond(row))])
def test_asymptotic_and_exact_motion(row: Row) -> None:
    agrees(row)


@pytest.mark.long
def test_all_cases() -> None:
    assert len(CASES) == 564
    for row in CASES:
        agrees(row)


def test_the_exact_motion_of_one_case_names_its_limit() -> None:
    with pytest.raises(InputError, match=r"coupler and driven link is 151\.19.*in the exact motion.*150 deg"):
        _ = lever(BEYOND).exact


def studied(row: Row) -> None:
    swing = deg(float(row["swing_deg"]))
    levers = []
    for lam, rho, nu in product((0.5, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10), (0.05, 0.15, 0.3), (0.05, 0.15, 0.3)):
        try:
            levers.append(TorsionLever(float(row["beta"]), lam, rho, nu, swing))
        except InputError as error:
            assert "the limit is" in str(error)  # noqa: PT017 - those within the limits are counted below
    assert len(levers) == int(row["n_cases"])
    found = {name: [abs(getattr(one.asymptotic, name)) for one in levers] for name in ("B1", "B3", "C1", "C3")}
    found["C3abs"] = found.pop("C3")
    found["T/T0"] = [one.asymptotic.period / one.T0 for one in levers]
    for name, values in found.items():
        assert min(values) == pytest.approx(float(row[f"{name}_min"]), abs=5.1e-6)
        assert max(values) == pytest.approx(float(row[f"{name}_max"]), abs=5.1e-6)
    worst = 0.0
    for one in levers:
        chi = np.linspace(one.asymptotic.chi02, one.chi01, 401)
        moment = one.moment(chi)
        worst = max(worst, float(np.abs(one.taylor_moment(chi) - moment).max() / np.abs(moment).max()))
    assert 100 * worst == pytest.approx(float(row["max_taylor_err_pct_of_Mmax"]), rel=1e-3, abs=1e-3)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "row", [STUDY[8], STUDY[17], STUDY[24], STUDY[31]], ids=lambda r: f"{r['beta']}-{r['swing_deg']}"
)
def test_parametric_study(row: Row) -> None:
    studied(row)


@pytest.mark.long
def test_whole_parametric_study() -> None:
    assert len(STUDY) == 40
    for row in STUDY:
        studied(row)
