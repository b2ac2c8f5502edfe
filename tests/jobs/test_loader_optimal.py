"""The job "loader optimal", its errors, and what results/ holds."""

import json
from pathlib import Path

import pytest

from optlaws.jobs import job
from optlaws.laws import MotionLaw
from optlaws.mechanisms.loader.loader import loader
from tests.documents import ROOT
from tests.jobs.examples import LOADER_OPTIMAL, ONE_PRINTED
from tests.jobs.written import table

RESULTS = ROOT / "results" / "loader_optimal"


def run(folder: Path, text: str) -> Path:
    (folder / "printed.csv").write_text(ONE_PRINTED, "utf-8")
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    job.run(file, folder / "out")
    return folder / "out"


def test_a_small_job_beats_the_printed_law(tmp_path: Path) -> None:
    out = run(tmp_path, LOADER_OPTIMAL)
    (row,) = table(out / "table.csv")
    assert float(row["limit"]) < float(row["l = 3, degree 5"]) < float(row["C_l"]) == pytest.approx(5.65924975)
    kept = json.loads((out / "laws.json").read_text("utf-8"))["laws"]["Shun"]
    for found in kept.values():
        law = MotionLaw.from_dict(found["law"])
        assert law.constants.B.value == pytest.approx(1.875, rel=1e-9)
        said = found["loader"]["constants"]["C"]["value"]
        assert said == pytest.approx(loader(law).C, rel=1e-9)
    assert kept["C no greater"]["executive"]["C"] <= 10.0 / 3.0**0.5 * (1.0 + 1e-8)
    for name in ("table.md", "figure.svg", "figure.png"):
        assert (out / name).stat().st_size > 1000


def test_results_hold_laws_between_the_limit_and_the_printed_ones() -> None:
    rows = table(RESULTS / "table.csv")
    assert len(rows) == 12
    for row in rows:
        least = [float(value) for name, value in row.items() if name.startswith("l = ")]
        assert float(row["limit"]) < min(least)
        if row["C_l"]:
            assert max(least) < float(row["C_l"])
    for row in table(RESULTS / "rivals.csv"):
        if row["rival"] == "C no greater":
            assert float(row["C"]) <= float(row["printed C"]) * (1.0 + 1e-6)
