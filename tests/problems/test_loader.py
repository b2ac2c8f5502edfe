"""What results/ holds of inertial loaders: their table with verdicts and their nomogram."""

import pytest

from tests.documents import ROOT
from tests.mechanisms.reference import rows
from tests.problems.written import table

RESULTS = ROOT / "results"


def test_the_table_is_judged() -> None:
    verdicts = {(row["row"], row["quantity"]): row for row in table(RESULTS / "loader_table" / "verdicts.csv")}
    assert verdicts["K", "B"]["verdict"] == verdicts["0050", "C"]["verdict"] == "reproduced to its digits"
    assert verdicts["KC00", "D"]["verdict"] == "off by -21 %"
    assert "Y = 1.1467 instead of 1.2879" in verdicts["KC00", "D"]["reason"]
    assert "outside its domain" in verdicts["KC00", "B"]["reason"]
    energies = {row["law"]: float(row["Y"]) for row in table(RESULTS / "loader_table" / "table.csv")}
    assert energies["KC00"] == pytest.approx(1.28785371, rel=1e-7)


def test_results_hold_the_reference_table() -> None:
    found = {row["law"]: row for row in table(RESULTS / "loader_table" / "table.csv")}
    for row in rows("loader_table12"):
        own = found[row["code"]]
        for name, exact in (("Y", "Y_exact"), ("B", "Bbcm_exact"), ("C", "Cbcm_exact_max"), ("D", "Dbcm_exact")):
            assert float(own[name]) == pytest.approx(float(row[exact]), rel=6e-8), (row["code"], name)
    energy = {row["law"]: row for row in table(RESULTS / "loader_table" / "energy.csv")}
    for row in rows("loader_table12"):
        by_formula = float(energy[row["code"]]["Y by eq. 25"]) * float(row["B"])
        assert by_formula == pytest.approx(float(row["Bbcm_by_formula25"]), rel=1e-6)
        assert float(energy[row["code"]]["Y from B printed"]) == pytest.approx(float(row["Y_from_printed_B"]), rel=1e-7)


def test_results_hold_the_reference_nomogram() -> None:
    found = {
        (float(row["e13"]), float(row["gamma_w"])): row for row in table(RESULTS / "loader_nomogram" / "nomogram.csv")
    }
    reference = rows("loader_nomogram")
    assert len(found) == len(reference)
    for row in reference:
        own = found[float(row["e13"]), float(row["gamma_w"])]
        assert float(own["Y by eq. 25"]) == pytest.approx(float(row["Y_formula25"]), rel=5.1e-6)
        assert float(own["Y"]) == pytest.approx(float(row["Y_formula25"]), rel=1.5e-5)
        assert float(own["D"]) == pytest.approx(float(row["D"]), rel=5.1e-6)
