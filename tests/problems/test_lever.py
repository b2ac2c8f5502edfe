"""What results/ holds of the torsion lever: tables with verdicts, the parametric study, the nomogram, the drawing."""

import pytest

from optlaws import TorsionLever, deg
from tests.balancing.levers.cases import rows
from tests.documents import ROOT
from tests.problems.written import table

RESULTS = ROOT / "results"


def test_results_hold_all_printed_tables() -> None:
    found = {(r["coefficient"], float(r["beta"]), r["lambda"]): r for r in table(RESULTS / "lever_tables/verdicts.csv")}
    expected = rows("lever_tables")
    assert len(found) == len(expected) == 140
    for row in expected:
        line = found[row["coef"], float(row["beta"]), row["lambda"]]
        assert float(line["exact"]) == pytest.approx(float(row["computed"]), abs=5.1e-7)
        assert float(line["printed"]) == float(row["printed(OCR)"])
    misprints = [key for key, line in found.items() if line["verdict"] == "misprint"]
    assert misprints == [("P", 0.25, ""), ("P", 1.75, "")]


def test_results_hold_the_parametric_study() -> None:
    found = {(float(r["beta"]), float(r["swing, deg"])): r for r in table(RESULTS / "lever_parametric/parametric.csv")}
    expected = rows("lever_parametric")
    assert len(found) == len(expected)
    for row in expected:
        line = found[float(row["beta"]), float(row["swing_deg"])]
        assert int(line["levers"]) == int(row["n_cases"])
        for name, of in (("B1", "B1"), ("B3", "B3"), ("C1", "C1"), ("|C3|", "C3abs"), ("T/T0", "T/T0")):
            for end, kind in (("least", "min"), ("greatest", "max")):
                assert float(line[f"{name} {end}"]) == pytest.approx(float(row[f"{of}_{kind}"]), abs=5.1e-6)
        for name in ("B1", "B3", "C1"):
            spread = float(row[f"spread_{name}_pct"])
            assert float(line[f"spread of {name}, %"]) == pytest.approx(spread, abs=1.1e-3)


def test_a_study_counts_the_levers_whose_exact_motion_is_within_the_limits() -> None:
    found = {(row["beta"], row["swing, deg"]): row for row in table(RESULTS / "lever_parametric/parametric.csv")}
    most = found["0.5", "100"]
    assert int(most["levers"]) > int(most["within the limits in the exact motion"]) > 0
    lever = TorsionLever(0.5, 1, 0.15, 0.15, deg(60))
    low, high = (float(found["0.5", "60"][f"B3 {end}, exact"]) for end in ("least", "greatest"))
    assert low <= lever.exact.B3 * (1 + 1e-7)
    assert high >= lever.exact.B3 * (1 - 1e-7)


def test_the_nomogram_is_the_sizing() -> None:
    found = {(row["beta"], row["swing, deg"]): row for row in table(RESULTS / "lever_nomogram/nomogram.csv")}
    lever = TorsionLever(0.5, 3, 0.15, 0.15, deg(60))
    line = found["0.5", "60"]
    assert deg(float(line["gamma01, deg"])) == pytest.approx(lever.gamma01, rel=1e-7)
    assert float(line["xi"]) == pytest.approx(lever.xi, rel=1e-7)
    assert float(line["exact T"]) == pytest.approx(lever.exact.period, rel=1e-7)


def test_the_nomogram_has_a_row_for_each_pre_twist() -> None:
    drawn = (RESULTS / "lever_nomogram/nomogram.svg").read_text("utf-8")
    assert all(f"<!-- Rocker at its extreme, rho = {rho} -->" in drawn for rho in ("0.05", "0.15", "0.3"))


def test_the_drawing_tells_the_exact_motion() -> None:
    lever = TorsionLever(0.5, 1.5, 0.15, 0.15, deg(90))
    assert f"{lever.exact.period:.7g}" in (RESULTS / "lever_drawing/drawing.md").read_text("utf-8")
