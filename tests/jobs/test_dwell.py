"""The jobs "dwell types" and "dwell drawing", their errors, and what results/ holds."""

from pathlib import Path

import pytest

from optlaws.jobs import job
from tests.documents import ROOT
from tests.jobs.examples import DWELL_DRAWING, DWELL_TYPES
from tests.jobs.written import table
from tests.mechanisms.reference import rows

RESULTS = ROOT / "results" / "dwell_types"


def run(folder: Path, text: str) -> Path:
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    job.run(file, folder / "out")
    return folder / "out"


def test_a_small_study(tmp_path: Path) -> None:
    out = run(tmp_path, DWELL_TYPES)
    short, long = table(out / "criteria.csv")
    assert (short["a II"], short["b III"]) == ("", "")
    assert float(long["b II"]) == pytest.approx(1.9826981, rel=1e-7)
    assert [(row["type"], row["nearest p"], row["N"]) for row in table(out / "teeth.csv")] == [
        ("II", "9", "103"),
        ("III", "2", "95"),
    ]
    for name in ("map", "nomograms", "size_of_type_I"):
        assert (out / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        assert f"{name}.svg" in (out / "dwell_types.md").read_text("utf-8")


def test_the_drawing(tmp_path: Path) -> None:
    out = run(tmp_path, DWELL_DRAWING)
    text = (out / "drawing.md").read_text("utf-8")
    assert text.count("| reverse ") == 2
    for name in ("mechanism", "motion"):
        assert (out / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_results_hold_the_reference_grid() -> None:
    scenarios = {"half a turn": "A", "rise of 90 degrees": "B"}
    reference = {
        (row["scenario"][0], *(float(row[name]) for name in ("gamma_sum", "phi_sp", "phi_dwell"))): row
        for row in rows("types_grid")
    }
    seen = 0
    for own in table(RESULTS / "criteria.csv"):
        key = (scenarios[own["scenario"]], *(float(own[name]) for name in ("swing", "clutch angle", "dwell")))
        row = reference.get(key)
        if row is None:
            continue
        seen += 1
        for name in ("a I", "a II", "a III", "b II", "b III"):
            expected = row[name.replace(" ", "_")]
            assert bool(own[name]) == bool(expected)
            if expected:
                assert float(own[name]) == pytest.approx(float(expected), rel=5.1e-6)
    assert seen > 90
