"""Exchanges between peak constants: what results/ holds of them, and their pictures."""

import json

import numpy as np
import pytest

from optlaws import Problem, pareto_front, synthesize
from tests.documents import ROOT
from tests.internals.plots import draw_front
from tests.problems.written import table

RESULTS = ROOT / "results" / "fronts"


@pytest.mark.parametrize("place", [0, 100, 200, 300])
def test_points_can_be_solved_again(place: int) -> None:
    fronts = json.loads((RESULTS / "fronts.json").read_text("utf-8"))["fronts"]
    known = [
        each
        for front in fronts
        if front["over"][-1] != "D"
        for each in zip(front["points"], front["values"], strict=True)
    ]
    point, values = known[place % len(known)]
    assert synthesize(Problem.from_dict(point["problem"])).objective == pytest.approx(values[-1], rel=1e-8)


@pytest.mark.parametrize("name", ["c-over-b-by-order", "d-over-c"])
def test_the_figures_name_what_stands_beside(name: str) -> None:
    text = (RESULTS / f"{name}.svg").read_text("utf-8")
    limit = "best possible" if name == "c-over-b-by-order" else "best possible of each"
    assert all(label in text for label in ("Savin", "smoothsteps", "modified sine", limit))
    assert f"{name}.svg" in (RESULTS / "fronts.md").read_text("utf-8")


def test_a_front_can_be_drawn_alone() -> None:
    front = pareto_front(Problem(order=3), ("B", "C"), points=3, between=(1.5, 1.8))
    line, *_ = draw_front(front)
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
        assert all(float(row["best possible"]) < float(row[last]) for row in mine)


def test_more_conditions_cost_more() -> None:
    rows = table(RESULTS / "fronts.csv")
    for figure in ("c-over-b-by-order", "d-over-b-by-order"):
        ends = {row["front"]: float(row[figure[0].upper()]) for row in rows if row["figure"] == figure}
        assert [ends[f"l = {order}"] for order in (2, 3, 4, 5)] == sorted(ends.values())
