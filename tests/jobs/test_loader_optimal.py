"""The job "loader optimal", its errors, and what results/ holds."""

import json
from pathlib import Path

import pytest

from optlaws import InputError
from optlaws.jobs import job
from optlaws.laws import MotionLaw
from optlaws.mechanisms.loader.loader import loader
from tests.documents import ROOT
from tests.jobs.written import table

RESULTS = ROOT / "results" / "loader_optimal"
PRINTED = """# printed
code,law,B,C,D
Shun,3-4-5 polynomial,1.423,5.7,3.841
"""
SMALL = 'job = "loader optimal"\ntitle = "One"\nprinted = "printed.csv"\norders = [3]\ndegrees = [5]\nshown = "Shun"\n'


def run(folder: Path, text: str) -> Path:
    (folder / "printed.csv").write_text(PRINTED, "utf-8")
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    job.run(file, folder / "out")
    return folder / "out"


def test_a_small_job_beats_the_printed_law(tmp_path: Path) -> None:
    out = run(tmp_path, SMALL)
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


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("Shun", "Shum", "did you mean 'Shun'"),
        ("degrees = [5]", "degrees = [1]", "degrees"),
        ("orders", "order", "did you mean 'orders'"),
    ],
)
def test_wrong_files_are_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        run(tmp_path, SMALL.replace(old, new))


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
