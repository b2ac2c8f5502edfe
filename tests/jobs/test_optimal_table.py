"""The job "optimal table": its verdicts, and that results/ is what it gives."""

import csv
import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from optlaws import Certificate, MotionLaw, Problem
from optlaws.files import writing
from optlaws.jobs import job
from tests.documents import ROOT

FILE = ROOT / "problems" / "optimal_table.toml"
RESULTS = ROOT / "results" / "optimal_table"
DIGITS, GRID = "reproduced to its digits", "reproduced to its digits on the paper's grid"
# row: verdict on B, C, D
VERDICTS = {
    "1.53": (DIGITS, GRID, "reproduced to 0.03 %"),
    "1.641": (DIGITS, GRID, GRID),
    "1.75": (DIGITS, GRID, GRID),
    "1.859": (DIGITS, GRID, DIGITS),
    "1.969": (DIGITS, GRID, DIGITS),
    "2.078": (DIGITS, GRID, DIGITS),  # the greatest c; the deceleration is greater by 0.6 %
    "2.187": (DIGITS, GRID, GRID),
    "2.297": (DIGITS, GRID, DIGITS),
    "2.406": (DIGITS, GRID, DIGITS),
    "2.461": (DIGITS, GRID, DIGITS),
    "2.5": (DIGITS, DIGITS, GRID),
    "2.6": (DIGITS, "misprint", GRID),
    "2.7": (DIGITS, GRID, GRID),
}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("results")
    written = job.run(FILE, out)
    assert sorted(written) == sorted(out.iterdir())
    return out


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
    assert [line[:2] for line in misprints] == [["2.406", "z1"], ["2.6", "C"]]
    assert misprints[0][2:4] == ["-296.8323", "-296.3323"]
    assert "-296.3323 gives the printed B, C and D" in misprints[0][6]
    assert misprints[1][2] == "10.52"
    assert "10.352" in misprints[1][6]


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


@pytest.mark.parametrize("name", ["table.csv", "verdicts.csv", "table.md"])
def test_results_in_the_repository_are_what_the_job_gives(made: Path, name: str) -> None:
    assert (made / name).read_bytes() == (RESULTS / name).read_bytes()


def numbers(value: Any, path: str = "") -> Iterator[tuple[str, float | str]]:  # noqa: ANN401
    if isinstance(value, dict):
        for name, part in value.items():
            yield from numbers(part, f"{path}.{name}")
    elif isinstance(value, list):
        yield f"{path}.length", len(value)
        for i, part in enumerate(value):
            yield from numbers(part, f"{path}[{i}]")
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield path, float(value)
    else:
        yield path, str(value)


def test_laws_in_the_repository_are_what_the_job_gives(made: Path) -> None:
    mine, kept = (dict(numbers(json.loads((where / "laws.json").read_text("utf-8")))) for where in (made, RESULTS))
    assert mine.keys() == kept.keys()
    for path, value in kept.items():
        if isinstance(value, str):
            # the seal is that of all digits
            assert str(mine[path]).split(writing.MARK)[0] == value.split(writing.MARK)[0], path
        elif path.endswith((".objective", ".lower_bound", ".limit", ".B.value", ".C.value", ".D.value", ".J.value")):
            assert mine[path] == pytest.approx(value, rel=1e-9), path


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
            assert certificate.bound == pytest.approx(found["lower_bound"], rel=1e-13)
            assert law.peak(2).value == pytest.approx(found["objective"], rel=1e-13)
            assert certificate.bound * (1 - 1e-14) <= found["objective"] <= certificate.bound * (1 + 1e-8)


def test_the_table_has_what_each_row_promises() -> None:
    headings, *lines = table(RESULTS / "table.csv")
    assert len(lines) == 13
    for line in lines:
        cells = dict(zip(headings, line, strict=True))
        richer = [float(cells[name]) for name in headings if name.startswith("C optimal, l=4")]
        assert richer == sorted(richer, reverse=True)
        assert float(cells["limit"]) < richer[-1]
        assert float(cells["C exact"]) >= float(cells["lower bound"]) - 1e-3
        assert float(cells["C optimal"]) == pytest.approx(float(cells["lower bound"]), rel=1e-8)
        assert abs(float(cells["B exact"]) - float(cells["B"])) < 5e-4


def test_the_figure_is_a_picture(made: Path) -> None:
    for where in (made, RESULTS):
        assert (where / "figure.png").read_bytes().startswith(b"\x89PNG")
        text = (where / "figure.svg").read_text("utf-8")
        assert text.startswith("<?xml")
        for label in ("peak velocity B", "Savin", "limit of all laws"):
            assert label in text


def test_the_problem_file_names_the_printed_data() -> None:
    data = tomllib.loads(FILE.read_text("utf-8"))
    assert (FILE.parent / data["printed"]).is_file()
    assert data["job"] in job.JOBS
