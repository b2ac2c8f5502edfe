"""What results/ holds of cams for an elastic follower, at and off their design."""

import pytest

from tests.documents import ROOT
from tests.mechanisms.savin_cases import rows
from tests.problems.written import table

RESULTS = ROOT / "results" / "savin_follower"
FILES = {"coefficients.csv", "cams.csv", "off_design.csv", "follower.md", "curves.svg", "spectrum.svg"}


def test_every_file_is_there() -> None:
    assert {file.name for file in RESULTS.iterdir()} == FILES


def test_the_rows_are_the_runs() -> None:
    lines = {
        (line["cam"], line["damping"], line["change"], float(line["deviation of nu, %"])): line
        for line in table(RESULTS / "off_design.csv")
    }
    assert len(lines) == 16 * 5
    designed = lines["III, n = 1", "0.05", "speed", 0.0]
    assert float(designed["dynamic factor"]) == 1.0
    assert float(designed["residual acceleration"]) == 0.0
    assert float(lines["III, n = 1", "0.05", "stiffness", -5.0]["n"]) == pytest.approx(1.0)
    page = (RESULTS / "follower.md").read_text("utf-8")
    assert "## Dynamic factor off design" in page
    assert "curves.svg" in page


def test_results_in_the_repository_are_the_digests_numbers() -> None:
    names = {"III_rigid": "III direct", "IV_rigid": "IV direct", "K": "K direct"}
    found = {
        (one["cam"], one["change"] if float(one["damping"]) else "undamped", float(one["deviation of nu, %"])): one
        for one in table(RESULTS / "off_design.csv")
    }
    compared = 0
    for row in rows("off_design"):
        cam = names.get(row["law"], f"{row['law']}, n = {row['n_design']}")
        change = {"undamped": "undamped", "zeta_const": "speed", "n_const": "stiffness"}[row["variant"]]
        line = found.get((cam, change, float(row["pct"])))
        if line is not None:
            assert float(line["dynamic factor"]) == pytest.approx(float(row["kd_rise"]), rel=1e-7)
            assert float(line["residual acceleration"]) == pytest.approx(float(row["res_acc_amp"]), rel=1e-7, abs=1e-8)
            compared += 1
    assert compared == len(found) == 80


def test_the_coefficients_in_the_repository_are_whole_fractions() -> None:
    found = {(one["cam"], int(one["i"])): one for one in table(RESULTS / "coefficients.csv")}
    for row in rows("cam_coeffs"):
        line = found[f"{row['family']}, n = {row['n']}", int(row["i"])]
        assert float(line["Q_i of the mass"]) == pytest.approx(float(row["Q"]), rel=1e-7)
        assert float(line["q_i of the cam"]) == pytest.approx(float(row["q"]), rel=1e-7)
