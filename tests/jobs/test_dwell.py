"""The jobs "dwell types" and "dwell drawing", their errors, and what results/ holds."""

from pathlib import Path

import pytest

from optlaws import InputError
from optlaws.jobs import job
from tests.documents import ROOT
from tests.jobs.written import table
from tests.mechanisms.reference import rows

RESULTS = ROOT / "results" / "dwell_types"
TYPES = """
job = "dwell types"
title = "Few"
law = "K"
radius_over_length = 0.35
inertia_ratio = 0.1
swings = [20]
clutch_angles = [15]
dwells = [30, 90]
teeth = 120
[map]
limits = [5]
clutch_angles = [5, 15]
[[scenario]]
name = "half a turn"
"""
DRAWING = """
job = "dwell drawing"
title = "Three"
law = "cycloidal"
rise = 80
dwell = 100
clutch_angle = 12
swing = 25
radius_ratio = 1.2
inertia_ratio = 0.15
"""


def run(folder: Path, text: str) -> Path:
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    job.run(file, folder / "out")
    return folder / "out"


def test_a_small_study(tmp_path: Path) -> None:
    out = run(tmp_path, TYPES)
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
    out = run(tmp_path, DRAWING)
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


@pytest.mark.parametrize(
    ("text", "match"),
    [
        (TYPES.replace("swings", "swing"), "swing.*swings"),
        (TYPES.replace("dwells = [30, 90]", "dwells = []"), "dwells"),
        (TYPES.replace("dwells = [30, 90]", "dwells = [30, 190]"), "rise must be positive"),
        (TYPES.replace('law = "K"', 'law = "Kq"'), "no law is called"),
        (TYPES.replace("clutch_angles = [5, 15]", "clutch_angles = [5]"), "clutch_angles"),
        (DRAWING.replace("rise = 80", "rise = 0"), "rise"),
        (DRAWING.replace("clutch_angle = 12", "clutch_angle = 60"), "exceed twice clutch_angle"),
    ],
)
def test_errors_name_the_file_and_the_entry(tmp_path: Path, text: str, match: str) -> None:
    with pytest.raises(InputError, match=rf"(?s)small\.toml.*{match}"):
        run(tmp_path, text)
