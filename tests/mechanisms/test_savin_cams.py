"""The experiment's two cams, at and off their design, against the digest's numbers."""

from fractions import Fraction
from functools import cache

import pytest

from optlaws import Follower, MotionLaw, catalogue, polydyne, savin
from tests.internals.mechanisms import cam_powers
from tests.tables import rows

COEFFICIENTS, PEAKS, OFF_DESIGN = rows("savin_cam_coeffs"), rows("savin_cam_peaks"), rows("savin_off_design")


ALPHA = {"III": 7.2, "IV": 11.0}


@cache
def reference(law: str) -> MotionLaw:
    """The law meant for the mass: of a family, or the simple harmonic one, K."""
    family = law.removesuffix("_rigid")
    return catalogue["simple harmonic"].law if family == "K" else savin(family, ALPHA[family])


@cache
def cam(law: str, n_design: str) -> MotionLaw:
    """What is cut on the cam: for nu = 20 and n_design, or the law itself where there is none."""
    return polydyne(reference(law), frequency=20, damping=float(n_design) / 20) if n_design else reference(law)


def name(row: dict[str, str]) -> str:
    return "-".join(row[key] for key in ("law", "family", "n_design", "n", "i", "variant", "pct") if row.get(key))


def test_the_tables_are_whole() -> None:
    assert (len(COEFFICIENTS), len(PEAKS), len(OFF_DESIGN)) == (44, 4, 85)


@pytest.mark.parametrize("row", COEFFICIENTS, ids=name)
def test_coefficients_of_mass_and_cam(row: dict[str, str]) -> None:
    i = int(row["i"])
    mass = savin(row["family"], float(row["alpha"])).to_powers()
    disc = cam(row["family"], row["n"]).to_powers()  # type: ignore[attr-defined]
    assert mass[i] == pytest.approx(float(Fraction(row["Q_exact"])), rel=1e-12, abs=1e-12)
    assert disc[i] == pytest.approx(float(Fraction(row["q_exact"])), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("n", ["0", "1"])
@pytest.mark.parametrize("family", ["III", "IV"])
def test_the_relation_is_exact_in_whole_numbers(family: str, n: str) -> None:
    mine = [row for row in COEFFICIENTS if (row["family"], row["n"]) == (family, n)]
    Q = tuple(Fraction(row["Q_exact"]) for row in mine)
    # zeta = 1/20 is no binary number, so the frequency is taken 20 times, where n/nu = 1/20 needs none
    found = cam_powers(Q, 20.0, 0.0)
    if n == "0":
        assert found == [Fraction(row["q_exact"]) for row in mine]
    else:
        damped = [2 * (i + 1) * Fraction(1, 400) * Q[i + 1] if i + 1 < len(Q) else Fraction(0) for i in range(len(Q))]
        exact = [Fraction(row["q_exact"]) for row in mine]
        assert [a + b for a, b in zip(found, damped, strict=True)] == exact


@pytest.mark.parametrize("row", PEAKS, ids=name)
def test_peaks_of_the_cams(row: dict[str, str]) -> None:
    law = cam(row["family"], row["n"])
    mass = reference(row["family"]).constants
    assert law.constants.B.value == pytest.approx(float(row["B_cam"]), rel=1e-9)
    assert law.constants.C.value == pytest.approx(float(row["C_cam"]), rel=1e-9)
    assert law.constants.B.k == pytest.approx(float(row["kB_cam"]), abs=1e-9)
    assert law.constants.C.k == pytest.approx(float(row["kC_cam"]), abs=1e-9)
    assert law.c([0.0, 1.0]).tolist() == pytest.approx([float(row["c_cam_0"]), float(row["c_cam_1"])], abs=1e-9)
    assert law.j(0.0) == pytest.approx(float(row["dc_cam_0"]), rel=1e-9)
    assert (mass.B.value, mass.C.value) == pytest.approx((float(row["B_mass"]), float(row["C_mass"])), rel=1e-9)
    assert law.extrema(1)[0].value == pytest.approx(0.0, abs=1e-12)  # monotone


@pytest.mark.sample(2)
@pytest.mark.parametrize("row", OFF_DESIGN, ids=name)
def test_off_design(row: dict[str, str]) -> None:
    law, nu = reference(row["law"]), float(row["nu_actual"])
    follower = Follower(nu, float(row["n_actual"]) / nu).response(cam(row["law"], row["n_design"]))
    peak = follower.peak(2)
    for key, value in {
        "C_designed": law.constants.C.value,
        "C_actual_rise": peak.value,
        "kd_rise": follower.dynamic_factor(law),
        "C_actual_dwell": follower.dwell_peak(2).value,
        "kd_all": follower.dynamic_factor(law, dwell=True),
        "res_disp_amp": follower.residual_displacement,
        "res_acc_amp": follower.residual_acceleration,
    }.items():
        assert value == pytest.approx(float(row[key]), rel=1e-9, abs=1e-11), key
    assert peak.k == pytest.approx(float(row["k_peak"]), abs=6e-7)
