"""The job "fronts": tables and figures of exchanges, its errors, and what results/ holds."""

import json
from pathlib import Path

import numpy as np
import pytest

from optlaws import Problem, pareto_front, synthesize
from tests.documents import ROOT
from tests.internals.jobs import job
from tests.internals.plots import draw_front
from tests.jobs.examples import FRONTS
from tests.problems.written import table

RESULTS = ROOT / "results" / "fronts"


def run(folder: Path, text: str) -> Path:
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    job.run(file, folder / "out")
    return folder / "out"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return run(tmp_path_factory.mktemp("fronts"), FRONTS)


def test_every_point_is_tabled_with_its_bound(made: Path) -> None:
    rows = table(made / "fronts.csv")
    assert [(row["figure"], row["front"]) for row in rows] == (
        [("one", "l = 4")] * 4 + [("one", "l = 3")] * 3 + [("two", "B = 1.641")] * 4
    )
    for row in rows[:7]:
        assert float(row["lower bound"]) == pytest.approx(float(row["C"]), rel=1e-7)
        assert float(row["limit"]) < float(row["C"])


def test_points_can_be_solved_again(made: Path) -> None:
    for front in json.loads((made / "fronts.json").read_text("utf-8"))["fronts"]:
        for point in front["points"]:
            solution = synthesize(Problem.from_dict(point["problem"]))
            assert solution.objective == pytest.approx(point["values"][-1], rel=1e-8)


def test_the_figures_are_pictures(made: Path) -> None:
    for name, labels in (
        ("one", ("C at given B", "Savin", "smoothsteps", "modified sine", "limit of all laws")),
        ("two", ("J at given C", "limit of each constant alone")),
    ):
        text = (made / f"{name}.svg").read_text("utf-8")
        for label in labels:
            assert label in text
        assert f"{name}.svg" in (made / "fronts.md").read_text("utf-8")


def test_a_front_can_be_drawn_alone() -> None:
    front = pareto_front(Problem(order=3), ("B", "C"), points=3, between=(1.5, 1.8))
    (line,) = draw_front(front)
    assert line.axes is not None
    assert line.axes.get_ylabel() == "peak acceleration C (dimensionless)"
    surface = pareto_front(Problem(order=3), ("B", "C", "J"), points=4, between=(1.5, 1.8))
    (points,) = draw_front(surface)
    assert len(np.asarray(points.get_array())) == len(surface)  # type: ignore[attr-defined]


def test_results_in_the_repository_fall_and_keep_above_the_limits() -> None:
    rows = table(RESULTS / "fronts.csv")
    figures = {(row["figure"], row["front"]) for row in rows}
    assert len(figures) == 15
    for figure, front in figures:
        first, last = ("C", "D") if figure == "d-over-c" else ("B", figure[0].upper())
        mine = [row for row in rows if (row["figure"], row["front"]) == (figure, front)]
        values = np.array([[float(row[first]), float(row[last])] for row in mine])
        assert (np.diff(values[:, 0]) > 0.0).all()
        assert (np.diff(values[:, 1]) < 0.0).all()
        assert all(float(row["limit"]) < float(row[last]) for row in mine)


def test_more_conditions_cost_more() -> None:
    rows = table(RESULTS / "fronts.csv")
    for figure in ("c-over-b-by-order", "d-over-b-by-order"):
        ends = {row["front"]: float(row[figure[0].upper()]) for row in rows if row["figure"] == figure}
        assert [ends[f"l = {order}"] for order in (2, 3, 4, 5)] == sorted(ends.values())
