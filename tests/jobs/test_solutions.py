"""The job "solutions": its table, its errors, and that results/ is what it gives."""

import json
from pathlib import Path

import pytest

from optlaws import Certificate, MotionLaw, Problem, synthesize
from tests.documents import ROOT
from tests.internals.jobs import job
from tests.jobs.examples import SOLUTIONS
from tests.sampling import sampled
from tests.tables import table


def run(folder: Path, text: str) -> Path:
    (folder / "printed.csv").write_text("# comment\nB,C\n1.53,7.3617\n", "utf-8")
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    job.done(file).write(folder / "out")
    return folder / "out"


def test_rows_are_the_product_of_the_sweeps_and_each_is_a_solution(tmp_path: Path) -> None:
    out = run(tmp_path, SOLUTIONS)
    rows = table(out / "table.csv")
    assert [(row["B asked"], row["degree of Z"], row["basis"]) for row in rows] == [
        (B, degree, basis)
        for B in ("1.53", "1.5 to 1.8", "free")
        for degree, basis in (("3", "powers"), ("9", "chebyshev"))
    ]
    alone = synthesize(Problem(B=1.53, order=4))
    assert float(rows[1]["C"]) == pytest.approx(alone.objective, rel=1e-7)
    assert {row["status"] for row in rows} == {"optimal"}
    assert [row["C, printed"] for row in rows] == ["7.3617", "7.3617", "", "", "", ""]
    assert all(float(row["C, law of least J"]) >= float(row["C"]) for row in rows)
    assert "Few words." in (out / "table.md").read_text("utf-8")


def test_laws_stand_their_own_proof(tmp_path: Path) -> None:
    content = json.loads((run(tmp_path, SOLUTIONS) / "laws.json").read_text("utf-8"))
    assert len(content["rows"]) == 6
    for row in content["rows"]:
        found = row["solution"]
        assert Problem.from_dict(row["asked"]) == Problem.from_dict(found["problem"])
        law = MotionLaw.from_dict(found["law"])
        assert law.peak(2).value == pytest.approx(found["objective"], rel=1e-13)
        assert Certificate.from_dict(found["certificate"]).bound == pytest.approx(found["lower_bound"], rel=1e-12)


def test_a_problem_without_a_law_is_a_row_that_says_so(tmp_path: Path) -> None:
    out = run(tmp_path, SOLUTIONS.replace("B = [1.53,", "B = [1.05,"))
    rows = table(out / "table.csv")
    assert [row["status"] for row in rows[:2]] == ["infeasible", "infeasible"]
    assert rows[0]["C"] == ""
    stored = json.loads((out / "laws.json").read_text("utf-8"))["rows"]
    assert all(Certificate.from_dict(row["proof"]).proves_infeasible for row in stored[:2])
    assert not any("proof" in row for row in stored[2:])


@pytest.mark.parametrize("name", sampled(["j_minimal", "d_minimal"]))
def test_results_in_the_repository_are_what_the_job_gives(tmp_path: Path, name: str) -> None:
    job.done(ROOT / "problems" / f"{name}.toml").write(tmp_path)
    for file in ("table.csv", "table.md"):
        assert (tmp_path / file).read_bytes() == (ROOT / "results" / name / file).read_bytes()


@pytest.mark.parametrize("name", ["d_minimal", "j_minimal", "mixed", "orders"])
def test_results_in_the_repository_hold_together(name: str) -> None:
    rows = table(ROOT / "results" / name / "table.csv")
    for row in rows:
        objective = float(row.get("objective") or row[name[0].upper()])
        assert float(row["best possible"]) * (1.0 - 1e-7) <= float(row["lower bound"]) <= objective * (1.0 + 1e-7)
        assert row["status"] in {"optimal", "local"}
        assert (float(row["gap"]) <= 1e-8) == (row["status"] == "optimal")


def test_least_power_is_below_that_of_the_laws_of_least_acceleration() -> None:
    for row in table(ROOT / "results" / "d_minimal" / "table.csv"):
        assert float(row["D"]) < float(row["D, law of least C"])
        assert float(row["C"]) > float(row["C, law of least C"])
