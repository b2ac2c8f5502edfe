"""What results/ holds of the table of optimal laws: its verdicts, its laws and their proofs."""

import csv
import json
from pathlib import Path

import pytest

from optlaws import Certificate, MotionLaw, Problem
from tests.documents import ROOT

RESULTS = ROOT / "results" / "optimal_table"
DIGITS, GRID = "reproduced to its digits", "reproduced to its digits on the paper's grid"
# row: verdict on B, C, D
VERDICTS = {
    "1.53": (DIGITS, GRID, "misprint"),
    "1.641": (DIGITS, GRID, GRID),
    "1.75": (DIGITS, GRID, GRID),
    "1.859": (DIGITS, GRID, DIGITS),
    "1.969": (DIGITS, GRID, DIGITS),
    "2.078": (DIGITS, GRID, DIGITS),
    "2.187": (DIGITS, GRID, GRID),
    "2.297": (DIGITS, GRID, DIGITS),
    "2.406": (DIGITS, GRID, DIGITS),
    "2.461": (DIGITS, GRID, DIGITS),
    "2.5": (DIGITS, DIGITS, GRID),
    "2.6": (DIGITS, "misprint", GRID),
    "2.7": (DIGITS, GRID, GRID),
}


def table(file: Path) -> list[list[str]]:
    lines = file.read_text("utf-8").splitlines()
    assert lines[0].startswith("# ")
    return list(csv.reader(lines[1:]))


def test_every_verdict() -> None:
    found: dict[str, dict[str, str]] = {}
    for row, quantity, *_, verdict, _reason in table(RESULTS / "verdicts.csv")[1:]:
        found.setdefault(row, {})[quantity] = verdict
    assert {row: tuple(verdicts[name] for name in "BCD") for row, verdicts in found.items()} == VERDICTS
    assert {row: set(verdicts) - set("BCD") for row, verdicts in found.items() if len(verdicts) > 3} == {
        "2.406": {"z1"}
    }


def test_misprints_are_named_with_what_is_meant() -> None:
    misprints = [line for line in table(RESULTS / "verdicts.csv") if line[5] == "misprint"]
    assert [line[:2] for line in misprints] == [["1.53", "D"], ["2.406", "z1"], ["2.6", "C"]]
    assert misprints[1][2:4] == ["-296.8323", "-296.3323"]
    assert "-296.3323 gives the printed B, C and D" in misprints[1][6]
    assert misprints[2][2] == "10.52"
    assert misprints[2][6].startswith("likely 10.34:")


def test_the_ledger_and_the_table_call_the_same_numbers_misprints() -> None:
    kept = table(ROOT / "results" / "ledger" / "ledger.csv")[1:]
    of_paper = {line[1] for line in kept if line[0] == "optimal" and line[5] == "misprint"}
    assert of_paper == {" ".join(line[:2]) for line in table(RESULTS / "verdicts.csv") if line[5] == "misprint"}


def test_a_peak_that_the_paper_leaves_out_is_a_deceleration() -> None:
    left_out = [line for line in table(RESULTS / "verdicts.csv")[1:] if "deceleration" in line[6]]
    assert [line[:2] for line in left_out] == [["2.078", "C"], ["2.461", "C"]]
    rows = json.loads((RESULTS / "laws.json").read_text())["rows"]
    for line in left_out:
        (law,) = (MotionLaw.from_dict(row["printed"]["law"]) for row in rows if row["B"] == line[0])
        lowest, highest = law.extrema(2)
        assert -lowest.value == pytest.approx(float(line[3]), rel=1e-6)
        assert -lowest.value > highest.value * 1.0005


def test_verdicts_agree_with_their_own_numbers() -> None:
    for _, quantity, printed, exact, on_grid, verdict, _ in table(RESULTS / "verdicts.csv")[1:]:
        places = len(printed.partition(".")[2])
        if verdict == DIGITS:
            assert float(printed) == pytest.approx(float(exact), abs=0.5001 * 10.0**-places)
        elif verdict == GRID:
            assert abs(float(on_grid) - float(printed)) < 10.0**-places
            assert float(on_grid) <= float(exact)
        elif verdict != "misprint":
            assert float(printed) == pytest.approx(float(exact), rel=7e-3)
        assert quantity in {"B", "C", "D", "z1"}


def test_laws_in_the_repository_stand_their_own_proof() -> None:
    content = json.loads((RESULTS / "laws.json").read_text("utf-8"))
    assert [row["B"] for row in content["rows"]] == list(VERDICTS)
    for row in content["rows"]:
        assert len(row["richer"]) == 6
        for found in (row["same shape"], *row["richer"].values()):
            problem = Problem.from_dict(found["problem"])
            certificate = Certificate.from_dict(found["certificate"])
            law = MotionLaw.from_dict(found["law"])
            assert certificate.problem == problem
            assert float(row["B"]) == problem.B
            assert found["status"] == "optimal"
            # what is charged for rounding rests on singular values, which machines round otherwise
            assert certificate.bound == pytest.approx(found["lower_bound"], rel=1e-12)
            assert law.peak(2).value == pytest.approx(found["objective"], rel=1e-13)
            assert certificate.bound * (1 - 1e-14) <= found["objective"] <= certificate.bound * (1 + 1e-8)


def test_the_table_has_what_each_row_promises() -> None:
    headings, *lines = table(RESULTS / "table.csv")
    assert len(lines) == 13
    for line in lines:
        cells = dict(zip(headings, line, strict=True))
        richer = [float(cells[name]) for name in headings if name.startswith("C optimal, l=4")]
        assert richer == sorted(richer, reverse=True)
        assert float(cells["best possible"]) < richer[-1]
        assert float(cells["C exact"]) >= float(cells["lower bound"]) - 1e-3
        assert float(cells["C optimal"]) == pytest.approx(float(cells["lower bound"]), rel=1e-8)
        assert abs(float(cells["B exact"]) - float(cells["B"])) < 5e-4


def test_the_figure_names_its_curves() -> None:
    text = (RESULTS / "figure.svg").read_text("utf-8")
    for label in ("peak velocity B", "Savin", "best possible"):
        assert label in text
