"""The atlas: its table is what synthesize gives, and laws are looked up in it."""

import csv
import json
import sys
from math import inf
from pathlib import Path
from typing import Any

import pytest

from optlaws import Chebyshev, InfeasibleProblem, InputError, Problem, Solution, at_most, sweep, synthesize
from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.jobs import COLUMNS, best_law, look_up, run
from tests.internals.jobs import read_of_atlas as read
from tests.internals.studies import read_study
from tests.jobs import examples
from tests.sampling import sampled

ATLAS = ROOT / "results" / "atlas" / "atlas.csv"


def test_the_atlas_is_complete_and_small() -> None:
    study = read_study(ROOT / "problems" / "atlas.toml")
    rows = list(csv.DictReader(line for line in ATLAS.read_text("utf-8").splitlines() if not line.startswith("#")))
    assert len(rows) == len(study.names()) * 684 == 2736
    assert sum(file.stat().st_size for file in ATLAS.parent.iterdir()) < 1_000_000
    convex = [row for row in rows if row["minimise"] != "D"]
    assert {row["status"] for row in convex} == {"optimal", "infeasible"}
    for row in convex:
        if row["C"]:
            assert float(row["lower bound"]) == pytest.approx(float(row[row["minimise"]]), rel=1e-7)


@pytest.mark.parametrize("place", [0, 500, 1200, 2000, 2700])
def test_rows_of_the_atlas_are_what_synthesize_gives(place: int) -> None:
    point = read(ATLAS)[place]
    objective = synthesize(
        Problem(B=point.B, order=point.order, basis=Chebyshev(point.degree), minimise=point.minimise)
    ).objective
    assert point.constants[point.minimise] == pytest.approx(objective, rel=2e-6)


def test_more_freedom_never_costs() -> None:
    values = {(p.minimise, p.order, p.degree, p.B): p.constants[p.minimise] for p in read(ATLAS)}
    compared = 0
    for (minimise, order, degree, B), value in values.items():
        better = values.get((minimise, order, {5: 9, 9: 15}.get(degree, 0), B))
        # least D is found from several starts, not proven
        if better is not None and minimise != "D":
            compared += 1
            assert better <= value * (1.0 + 1e-7)
    assert compared > 1300


def test_a_law_is_looked_up_by_B_or_by_its_bounds() -> None:
    near = look_up(ATLAS, minimise="C", order=4, B=1.71)
    assert (near.B, near.degree) == (1.7, 15)
    best = look_up(ATLAS, minimise="C", order=4, most={"D": 6.0})
    assert best.constants["D"] <= 6.0
    others = [p for p in read(ATLAS) if (p.minimise, p.order) == ("C", 4) and p.constants["D"] <= 6.0]
    assert best.constants["C"] == min(p.constants["C"] for p in others)


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("minimise", "order", "B", "most"),
    sampled(
        [
            ("C", 4, None, {"D": 5.0}),
            ("C", 4, None, {"D": 3.4}),
            ("C", 5, None, {"B": 1.7, "J": 300.0}),
            ("D", 4, None, {"C": 5.0}),
            ("D", 2, None, {"J": 1720.0}),
            ("D", 5, 2.3, {"J": 58.0}),
            ("J", 3, 1.375, {"D": 3.85, "J": 380.0}),
            ("J", 4, None, {"rms_c": 3.7, "C": 6.0}),
            ("rms_c", 4, None, {"D": 3.36}),
            ("rms_c", 3, 1.75, {"J": 255.0}),
        ]
    ),
)
def test_no_law_of_the_atlas_that_keeps_the_limits_is_better(
    minimise: str, order: int, B: float | None, most: dict[str, float]
) -> None:
    asked: dict[str, Any] = {"minimise": minimise, "order": order, "B": B, "most": most}
    rivals = [
        point.constants[minimise]
        for point in read(ATLAS)
        if point.order == order
        and minimise in point.constants
        and (B is None or point.B == B)
        and all(point.constants.get(name, inf) <= value for name, value in most.items())
    ]
    point, best = look_up(ATLAS, **asked), best_law(ATLAS, **asked)
    assert point.constants[minimise] == min(rivals)
    assert all(point.constants[name] <= value for name, value in most.items())
    # the table has eight digits
    assert best.objective <= min(rivals) * (1.0 + 1e-7)
    constants = {name: getattr(best.constants, name) for name in most}
    values = {name: constant if isinstance(constant, float) else constant.value for name, constant in constants.items()}
    assert all(values[name] <= value * (1.0 + 1e-9) for name, value in most.items())
    for degree in (5, 9, 15):
        bounds = {name: at_most(value) for name, value in most.items()}
        problem = Problem(B=B, order=order, basis=Chebyshev(degree), minimise=minimise, bounds=bounds)
        (other,) = sweep([problem], errors="return")
        assert not isinstance(other, Solution) or best.objective <= other.objective * (1.0 + 1e-9)


def test_the_best_degree_is_sought_among_all() -> None:
    best = best_law(ATLAS, minimise="C", order=4, most={"D": 5.0})
    assert best.problem.basis == Chebyshev(15)
    assert best.objective == pytest.approx(4.531553, abs=1e-6)


def test_where_no_degree_has_a_law_the_proof_is_of_the_greatest() -> None:
    with pytest.raises(InfeasibleProblem) as results:
        best_law(ATLAS, minimise="C", order=4, B=2.2, most={"D": 4.0})
    assert isinstance(results.value.problem, Problem)
    assert results.value.problem.basis == Chebyshev(15)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"order": 7}, "the atlas has order = 2, 3, 4, 5, not 7"),
        ({"minimise": "snap"}, "the atlas has minimise = C, D, J, rms_c, not snap"),
        ({"B": 9.0}, "the atlas has B from 1.3 to 2.7, not 9"),
        ({"most": {"rms": 4.0}}, "did you mean 'rms_c'"),
        ({"most": {"C": 3.0}}, r"keeps C <= 3 \(the least there is 4\.\d+\)"),
    ],
)
def test_what_the_atlas_has_not_is_said(asked: dict[str, object], message: str) -> None:
    expected: dict[str, object] = {"minimise": "C", "order": 4, **asked}
    with pytest.raises(InputError, match=message):
        look_up(ATLAS, **expected)  # type: ignore[arg-type] # the wrong ones are the point


def test_the_command_solves_what_was_asked(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--order", "4", "--peak-velocity", "1.71", "--most", "D=6.15", "--file", str(ATLAS), "--json"]
    assert exit_code(["atlas", *arguments]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["nearest"]["constants"]["D"] <= 6.15
    assert data["constants"]["B"] == pytest.approx(1.71)
    assert data["constants"]["D"] <= 6.15 * (1.0 + 1e-9)
    assert exit_code(["atlas", "--order", "4", "--file", "nowhere.csv"]) == 2
    assert "optlaws run problems/atlas.toml" in capsys.readouterr().err


def test_the_job_writes_table_and_figures(tmp_path: Path) -> None:
    file = tmp_path / "atlas.toml"
    file.write_text(examples.ATLAS)
    written = run(file, tmp_path / "out")
    assert sorted(one.name for one in written) == sorted(
        ["atlas.csv", "atlas.md", *(f"least-{name}.{kind}" for name in "cd" for kind in ("svg", "png"))]
    )
    lines = written[0].read_text("utf-8").splitlines()
    assert tuple(lines[1].split(",")) == COLUMNS
    assert len(lines) == 2 + 16
    file.write_text(examples.ATLAS.replace("order = [3, 4]\n", "") + "order = [3, 4]\n")
    with pytest.raises(InputError, match="an atlas varies minimise, order, degree, B"):
        run(file, tmp_path / "out")


def test_the_command_study_says_what_it_did(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = tmp_path / "small.toml", str(tmp_path / "study")
    file.write_text("[problem]\norder = 4\n[vary]\nB = [1.5, 1.2]\ndegree = [3]\n")
    assert exit_code(["study", str(file), "--out", out, "--workers", "1", "--json"]) == 0
    results = capsys.readouterr()
    assert json.loads(results.out)["counts"] == {"optimal": 1, "infeasible": 1}
    assert "2 of 2" in results.err
    assert exit_code(["study", "--status", out]) == 0
    assert "2 of 2 points, finished" in capsys.readouterr().out
    for wrong, text in (
        ([], "name a study file"),
        ([str(file), "--status", out], "--status takes a directory and neither"),
        ([str(tmp_path / "no.toml")], "cannot read"),
        (["--status", str(tmp_path)], "contains no study"),
    ):
        assert exit_code(["study", *wrong]) == 2
        assert text in capsys.readouterr().err


def test_a_cluster_without_its_package_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "small.toml"
    file.write_text("[problem]\norder = 4\n[vary]\nB = [1.5]\n")
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert exit_code(["study", str(file), "--dask", "tcp://x:1"]) == 2
    assert "pip install 'optlaws[cluster]'" in capsys.readouterr().err
