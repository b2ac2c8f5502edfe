"""The jobs of the torsion lever: tables with verdicts, the parametric study, the nomogram, the drawing."""

import csv
from pathlib import Path

import pytest

from optlaws import TorsionLever, deg
from optlaws.jobs import job
from tests.documents import ROOT
from tests.jobs.examples import LEVER_DRAWING, LEVER_NOMOGRAM, LEVER_PARAMETRIC, LEVER_PRINTED, LEVER_TABLES
from tests.mechanisms.lever.cases import rows

RESULTS = ROOT / "results"


def read(file: Path) -> list[dict[str, str]]:
    lines = file.read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def done(folder: Path, text: str) -> Path:
    (folder / "few.csv").write_text(LEVER_PRINTED, encoding="utf-8")
    (folder / "job.toml").write_text(text, encoding="utf-8")
    job.run(folder / "job.toml", folder / "out")
    return folder / "out"


def test_every_printed_coefficient_has_its_verdict(tmp_path: Path) -> None:
    content = read(done(tmp_path, LEVER_TABLES) / "verdicts.csv")
    assert [row["verdict"] for row in content] == [
        "reproduced to its digits",
        "reproduced to its digits",
        "reproduced to 1.9 %",
        "misprint",
    ]


def test_results_hold_all_printed_tables() -> None:
    found = {(r["coefficient"], float(r["beta"]), r["lambda"]): r for r in read(RESULTS / "lever_tables/verdicts.csv")}
    wanted = rows("lever_tables")
    assert len(found) == len(wanted) == 140
    for row in wanted:
        line = found[row["coef"], float(row["beta"]), row["lambda"]]
        assert float(line["exact"]) == pytest.approx(float(row["computed"]), abs=5.1e-7)
        assert float(line["printed"]) == float(row["printed(OCR)"])
    misprints = [key for key, line in found.items() if line["verdict"] == "misprint"]
    assert misprints == [("P", 0.25, ""), ("P", 1.75, "")]


def test_results_hold_the_parametric_study() -> None:
    found = {(float(r["beta"]), float(r["swing, deg"])): r for r in read(RESULTS / "lever_parametric/parametric.csv")}
    wanted = rows("lever_parametric")
    assert len(found) == len(wanted)
    for row in wanted:
        line = found[float(row["beta"]), float(row["swing_deg"])]
        assert int(line["levers"]) == int(row["n_cases"])
        for name, of in (("B1", "B1"), ("B3", "B3"), ("C1", "C1"), ("|C3|", "C3abs"), ("T/T0", "T/T0")):
            for end, kind in (("least", "min"), ("greatest", "max")):
                assert float(line[f"{name} {end}"]) == pytest.approx(float(row[f"{of}_{kind}"]), abs=5.1e-6)
        for name in ("B1", "B3", "C1"):
            spread = float(row[f"spread_{name}_pct"])
            assert float(line[f"spread of {name}, %"]) == pytest.approx(spread, abs=1.1e-3)


def test_a_study_counts_the_levers_whose_exact_motion_is_within_the_limits(tmp_path: Path) -> None:
    out = done(tmp_path, LEVER_PARAMETRIC)
    found = {(row["beta"], row["swing, deg"]): row for row in read(out / "parametric.csv")}
    assert set(found) == {("0.5", "30"), ("0.5", "100"), ("1", "30"), ("1.5", "30")}
    most = found["0.5", "100"]
    assert (most["levers"], most["within the limits in the exact motion"]) == ("4", "2")
    lever = TorsionLever(0.5, 1, 0.15, 0.15, deg(30))
    low, high = (float(found["0.5", "30"][f"B3 {end}, exact"]) for end in ("least", "greatest"))
    assert low <= lever.exact.B3 * (1 + 1e-7)
    assert high >= lever.exact.B3 * (1 - 1e-7)
    assert {"constants.svg", "constants.png"} < {file.name for file in out.iterdir()}


def test_the_nomogram_is_the_sizing(tmp_path: Path) -> None:
    out = done(tmp_path, LEVER_NOMOGRAM)
    found = {(row["beta"], row["swing, deg"]): row for row in read(out / "nomogram.csv")}
    assert set(found) == {("0.5", "20"), ("0.5", "60"), ("1.5", "20")}
    lever = TorsionLever(0.5, 3, 0.15, 0.15, deg(60))
    line = found["0.5", "60"]
    assert deg(float(line["gamma01, deg"])) == pytest.approx(lever.gamma01, rel=1e-7)
    assert float(line["xi"]) == pytest.approx(lever.xi, rel=1e-7)
    assert float(line["exact T"]) == pytest.approx(lever.exact.period, rel=1e-7)
    assert (out / "nomogram.svg").exists()


def test_the_nomogram_has_a_row_for_each_pre_twist(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    (tmp_path / "three").mkdir()
    one, three = (
        done(tmp_path / "one", LEVER_NOMOGRAM),
        done(tmp_path / "three", f"{LEVER_NOMOGRAM}also = [0.05, 0.3]\n"),
    )
    drawn = (three / "nomogram.svg").read_text("utf-8")
    assert all(f"<!-- Rocker at its extreme, rho = {rho} -->" in drawn for rho in ("0.05", "0.3"))
    assert "rho = " not in (one / "nomogram.svg").read_text("utf-8")
    assert read(one / "nomogram.csv") == read(three / "nomogram.csv")


def test_the_drawing_is_the_same_each_time(tmp_path: Path) -> None:
    first = {file.name: file.read_bytes() for file in done(tmp_path, LEVER_DRAWING).iterdir()}
    assert set(first) == {"drawing.md", *(f"{n}.{k}" for n in ("mechanism", "motion") for k in ("svg", "png"))}
    assert {file.name: file.read_bytes() for file in done(tmp_path, LEVER_DRAWING).iterdir()} == first
    assert "6.100747" in first["drawing.md"].decode()
