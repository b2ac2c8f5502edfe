"""What no law of any degree is below is `best_possible`; version 1.0 called it `limit`, and its files are read."""

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import optlaws
from optlaws.verification import verify_all
from tests.documents import ROOT
from tests.internals.jobs import solutions
from tests.internals.studies import row_of

SLIDE = optlaws.Cycle(
    [optlaws.Rise("35 mm", "180 deg"), optlaws.Return()], speed="60 rpm", limits={"acceleration": "20 m/s^2"}
)
RESULTS: dict[str, Callable[[], Any]] = {
    "solution": lambda: optlaws.synthesize(optlaws.Problem(order=3)),
    "array": lambda: optlaws.synthesize_array(optlaws.ProblemArray(B=[1.5, 1.6], order=3)),
    "fastest move": lambda: optlaws.fastest(
        optlaws.Problem(order=3), stroke="35 mm", limits={"acceleration": "20 m/s^2"}
    ),
    "fastest cycle": SLIDE.fastest,
}


def former(data: Any) -> Any:
    """The data as version 1.0 wrote them."""
    if isinstance(data, list):
        return [former(each) for each in data]
    if not isinstance(data, dict):
        return data
    return {"limit" if name == "best_possible" else name: former(value) for name, value in data.items()}


@pytest.mark.parametrize("name", RESULTS)
def test_files_of_the_version_before_are_read(name: str, tmp_path: Path) -> None:
    result = RESULTS[name]()
    old = former(json.loads(result.to_json()))
    assert '"limit"' in json.dumps(old)
    again = type(result).from_dict(old)
    assert again.to_json() == result.to_json()
    (tmp_path / "old.json").write_text(json.dumps(old), "utf-8")
    both = [verify_all(data) for data in (tmp_path / "old.json", json.loads(result.to_json()))]
    assert [each.proven for each in both[0].values()] == [each.proven for each in both[1].values()]


def test_the_checker_in_javascript_reads_them() -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("there is no node")
    solution = RESULTS["solution"]().to_dict()
    program = ROOT / "optlaws" / "explorer" / "page" / "check_proof.mjs"
    verdicts = []
    for data in (solution, former(solution), former({**solution, "best_possible": 99.0})):
        text = json.dumps(data)
        run = subprocess.run(
            [node, str(program), "--json", "/dev/stdin"], input=text, capture_output=True, text=True, check=False
        )
        rows = {row["path"]: row["verdict"] for row in json.loads(run.stdout)}
        verdicts.append((rows["the file: best possible"], run.returncode))
    assert verdicts == [("proven", 0), ("proven", 0), ("not proven", 1)]


def test_the_former_names_of_attributes_say_the_present_one() -> None:
    for name in ("solution", "array", "fastest move"):
        result = RESULTS[name]()
        with pytest.warns(DeprecationWarning, match=rf"{type(result).__name__}.limit is called \w+.best_possible now"):
            former_value = result.limit
        assert former_value == pytest.approx(result.best_possible, rel=0.0, abs=0.0)


def test_the_former_columns_of_tables_are_read() -> None:
    entries = {"job": "solutions", "title": "t", "problem": {}, "sweep": [{"B": [1.6]}]}
    stated = solutions.SolutionsProblemFile.from_dict({**entries, "columns": ["C", "limit", "above limit, %"]})
    assert stated.columns == ("C", "best possible", "above best possible, %")


def test_the_former_column_of_a_study_is_read() -> None:
    line = {"index": 0, "key": "k", "status": "optimal", "law": None, "error": None, "limit": 4.0}
    assert row_of(line, {}).best_possible == 4.0
