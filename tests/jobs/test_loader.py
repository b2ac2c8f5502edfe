"""The jobs "loader table", "loader nomogram" and "loader drawing", their errors, and what results/ holds."""

from pathlib import Path

import pytest

from optlaws import InputError
from optlaws.jobs import job
from tests.documents import ROOT
from tests.jobs.written import table
from tests.mechanisms.reference import rows

RESULTS = ROOT / "results"
PRINTED = """# printed
code,law,B,C,D
K,K,1.571,4.94,3.876
0050,0050,1.274,inf,3.248
KC00,KC00,1.632,4.734,4.897
"""
TABLE = 'job = "loader table"\ntitle = "Three"\nprinted = "printed.csv"\ngrid = 20\n'
NOMOGRAM = 'job = "loader nomogram"\ntitle = "Few"\ngamma_w = [0.25, 0.3]\n[e13]\nfrom = 0.6\nto = 0.66\nstep = 0.03\n'
DRAWING = 'job = "loader drawing"\ntitle = "One"\nlaw = "3-4-5 polynomial"\nshown = 40\nradius_ratio = 1.0\n'


def run(folder: Path, text: str, printed: str = PRINTED) -> Path:
    (folder / "printed.csv").write_text(printed, "utf-8")
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    job.run(file, folder / "out")
    return folder / "out"


def test_a_small_table_is_judged(tmp_path: Path) -> None:
    out = run(tmp_path, TABLE)
    verdicts = {(row["row"], row["quantity"]): row for row in table(out / "verdicts.csv")}
    assert verdicts["K", "B"]["verdict"] == verdicts["0050", "C"]["verdict"] == "reproduced to its digits"
    assert verdicts["KC00", "D"]["verdict"] == "off by -21 %"
    assert "Y = 1.1467 instead of 1.2879" in verdicts["KC00", "D"]["reason"]
    assert "outside its domain" in verdicts["KC00", "B"]["reason"]
    assert float(table(out / "table.csv")[2]["Y"]) == pytest.approx(1.28785371, rel=1e-7)


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


def test_the_figures_are_pictures(tmp_path: Path) -> None:
    for text, names in ((NOMOGRAM, ["nomogram"]), (DRAWING, ["mechanism", "exchange"])):
        out = run(tmp_path, text)
        for name in names:
            assert (out / f"{name}.png").read_bytes().startswith(b"\x89PNG")
            assert "made by optlaws" in (out / f"{name}.svg").read_text("utf-8")


@pytest.mark.parametrize(
    ("text", "printed", "match"),
    [
        (TABLE.replace("grid", "gird"), PRINTED, "gird.*grid"),
        (TABLE.replace("grid = 20", "grid = 1"), PRINTED, "grid"),
        (TABLE, PRINTED.replace("1.571", "1,571"), "5 cells"),
        (TABLE, PRINTED.replace("1.571", "1.5x"), "row K, B.*not a number"),
        (TABLE, PRINTED.replace("K,K", "K,Kq"), "no law is called 'Kq'"),
        (NOMOGRAM.replace("0.25, 0.3", "0.2"), PRINTED, "no trapezium"),
        (NOMOGRAM.replace("step = 0.03", "step = 0"), PRINTED, "step"),
        (DRAWING.replace("shown = 40", "shown = 400"), PRINTED, "shown"),
    ],
)
def test_errors_name_the_file_and_the_entry(tmp_path: Path, text: str, printed: str, match: str) -> None:
    with pytest.raises(InputError, match=rf"(?s)small\.toml.*{match}|{match}"):
        run(tmp_path, text, printed)
