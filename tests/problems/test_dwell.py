"""What results/ holds of balancing mechanisms for links that dwell."""

import pytest

from tests.documents import ROOT
from tests.mechanisms.reference import rows
from tests.problems.written import table

RESULTS = ROOT / "results" / "dwell_types"


def test_cases_without_room_for_the_clutch_have_type_I_alone() -> None:
    lines = table(RESULTS / "criteria.csv")
    tight = [line for line in lines if float(line["dwell"]) <= 2.0 * float(line["clutch angle"])]
    assert tight
    assert all(line["a I"] and not line["a II"] and not line["b III"] for line in tight)
    case = ("half a turn", "20", "15", "90")
    long = next(line for line in lines if tuple(line[name] for name in GIVEN) == case)
    assert float(long["b II"]) == pytest.approx(1.9826981, rel=1e-7)
    teeth = {row["type"]: row for row in table(RESULTS / "teeth.csv") if tuple(row[name] for name in GIVEN) == case}
    assert [(kind, row["nearest p"], row["N"]) for kind, row in teeth.items()] == [
        ("II", "9", "103"),
        ("III", "2", "95"),
    ]


GIVEN = ("scenario", "swing", "clutch angle", "dwell")


def test_the_drawing_has_every_section() -> None:
    text = (ROOT / "results" / "dwell_drawing" / "drawing.md").read_text("utf-8")
    assert text.count("| reverse ") == 2


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
