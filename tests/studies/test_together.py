"""Points that are solved together: the rows are those of each alone, and each has its share of the time."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Any

import msgspec
import numpy as np
import pytest

from optlaws import Problem, ProblemArray, Solution, open_study, run_study, synthesize_array
from tests.internals.studies import (
    Serial,
    Silent,
    StudyPoints,
    Task,
    along_B,
    array_along_B,
    blocks,
    entries,
    key,
    read_study,
    task,
)
from tests.sampling import sampled
from tests.studies.sweeping import solved

ASKED: dict[str, Any] = {
    "problem": {"basis": "chebyshev"},
    "vary": {"degree": [5, 9], "B": [0.9, 1.05, 1.5, 1.6, 1.7]},
    "together": [{"order": [3, 4], "monotone": [True, False]}],
}


class StopAfter(Silent):
    """Ends a run by Ctrl-C when so many points are done."""

    def __init__(self, points: int) -> None:
        self.points = points

    def advance(self, counts: Mapping[str, int]) -> None:
        if sum(counts.values()) >= self.points:
            raise KeyboardInterrupt


def tasks(asked: dict[str, Any], **changes: Any) -> list[Task]:
    study = read_study(asked)
    points = StudyPoints.of(study)
    return [msgspec.convert(task(study, points, i) | changes, Task) for i in range(points.chunks)]


def test_rows_are_those_of_each_alone() -> None:
    asked = ASKED | {"chunk": 10}
    many = [row for task in tasks(asked) for row in solved(task)]
    alone = [row for task in tasks(asked, alone=True) for row in solved(task)]
    assert len(many) == len(alone) == 20
    assert {row["status"] for row in many} == {"optimal", "infeasible", "invalid"}
    for one, other in zip(many, alone, strict=True):
        assert list(one) == list(other)
        for name in ("index", "key", "inputs", "status", "error"):
            assert one[name] == other[name]
        for name in ("objective", "lower_bound", "best_possible", "B", "C", "rms_c") if other["law"] else ():
            assert one[name] == pytest.approx(other[name], rel=1e-10)
        assert (one["law"] is None) == (other["law"] is None)
        assert one["key"] == key(entries({"basis": "chebyshev"}, one["inputs"]))
        assert one["seconds"] > 0.0


def test_a_row_has_its_share_of_the_time() -> None:
    (one,) = tasks({"problem": {"order": 4}, "vary": {"B": {"from": 1.5, "to": 1.8, "steps": 12}}, "chunk": 12})
    began = perf_counter()
    (block,) = blocks(one)
    took = perf_counter() - began
    seconds = [msgspec.json.decode(row)["seconds"] for row in block]
    assert len(set(seconds)) == 1
    assert 0.3 * took < sum(seconds) <= took


def test_studies_that_are_solved_as_arrays_have_great_chunks_and_others_small_ones() -> None:
    steps = {"from": 1.5, "to": 1.8, "steps": 100_000}
    for problem, vary, chunk in (
        ({"order": 4}, {"B": steps}, 4096),
        ({"order": 4}, {"minimise": ["C", "{w}*C/4 + J/40"], "w": [0.5, 1.0], "B": steps}, 4096),
        ({"order": 4}, {"minimise": ["C", "D"], "B": steps}, 4096),
        ({"order": 4}, {"minimise": ["C", "0.5*C + 0.5*D"], "B": steps}, 64),
        ({"order": 4}, {"D": ["free", 6.0], "B": steps}, 64),
        ({"order": 4, "bounds": {"D": 6.0}}, {"B": steps}, 64),
    ):
        points = StudyPoints.of(read_study({"problem": problem, "vary": vary}))
        assert points.chunk == chunk
    assert StudyPoints.of(read_study({"problem": {"order": 4}, "vary": {"B": steps}, "bound": "tight"})).chunk == 4


def test_a_study_goes_on_in_the_chunks_it_was_begun_with(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = {"problem": {"order": 4, "degree": 5}, "vary": {"B": {"from": 1.5, "to": 1.8, "steps": 40}}}
    with monkeypatch.context() as patch:
        patch.setattr("optlaws.studies.points._TOGETHER", 2)
        with pytest.raises(KeyboardInterrupt):
            run_study(asked, tmp_path / "study", executor=Serial(), watch=StopAfter(4))
    begun = open_study(tmp_path / "study")
    assert begun.about["chunk"] == 2
    assert sum(begun.counts.values()) == 4
    done = begun[1]
    study = run_study(asked, tmp_path / "study", executor=Serial())
    assert study.finished
    assert study[1].seconds == done.seconds


def test_an_error_of_all_spoils_no_more_than_its_own_row(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("of none in particular")

    monkeypatch.setattr("optlaws.studies.chunk.solved_rows", broken)
    (one,) = tasks({"problem": {"order": 4}, "vary": {"B": [1.5, 1.6]}, "chunk": 2})
    assert [row["status"] for row in solved(one)] == ["optimal", "optimal"]


def test_text_with_a_place_for_B_is_no_line_along_it() -> None:
    run = [(0, {"B": 1.5}), (1, {"B": 1.6})]
    assert not along_B({"order": 4, "minimise": "{B}*C + J"}, run)
    assert along_B({"order": 4, "minimise": "J"}, run)
    for minimise in ("D", "Q"):
        assert array_along_B({"order": 4, "minimise": minimise}, run, "quick") is None
    array = array_along_B({"order": 4, "minimise": "J"}, run, "quick")
    assert array is not None
    assert array[1] == Problem(order=4, minimise="J", B=1.6)


@pytest.mark.long
@pytest.mark.parametrize("weights", sampled([[0.5], [0.5, 1.0]]))
def test_any_number_may_run_and_the_rows_are_those_of_each_alone(weights: list[float]) -> None:
    length = 130 * len(weights)
    asked = {
        "problem": {"order": 4, "degree": 5},
        "vary": {
            "minimise": ["C", "{w}*C/4 + J/32"],
            "w": weights,
            "J": [[0.0, J] for J in np.linspace(57.0, 90.0, 130).tolist()],
        },
        "chunk": 2 * length,
    }
    asked["problem"] |= {"B": 1.7}  # type: ignore[operator]
    (one,) = tasks(asked)
    assert [len(block) for block in blocks(one)] == [length, length]
    many = solved(one)
    (alone,) = tasks(asked, alone=True)
    picked = [0, 129, length, length + 40, 2 * length - 1]
    turned = replace(alone, points=[alone.points[i] for i in picked])
    for i, row in zip(picked, solved(turned), strict=True):
        assert all(many[i][name] == row[name] for name in ("index", "key", "inputs", "status"))
        assert (many[i]["error"] is None) == (row["error"] is None)
        for name in ("objective", "lower_bound", "best_possible", "B", "C", "J") if row["law"] else ():
            assert many[i][name] == pytest.approx(row[name], rel=1e-9)


def test_lines_are_whole_in_chunks_of_many() -> None:
    for vary, chunk in (
        ({"minimise": ["C", "D"], "order": [3, 4], "B": {"from": 1.5, "to": 2.0, "steps": 57}}, 15),
        ({"J": [[0, J] for J in range(60, 100)], "B": {"from": 1.5, "to": 2.0, "steps": 57}}, 171),
        ({"minimise": ["C", "D"], "order": [3, 4], "B": {"from": 1.5, "to": 2.0, "steps": 5}}, 2),
        ({"degree": [5, 9], "order": list(range(2, 22)), "B": {"from": 1.5, "to": 2.0, "steps": 50}}, 150),
    ):
        points = StudyPoints.of(read_study({"problem": {"degree": 5, "order": 4, "minimise": "C"}, "vary": vary}))
        assert points.chunk == chunk


def test_stored_laws_are_those_of_the_solutions() -> None:
    velocities = np.array([1.05, 1.5, 1.6, 1.9])
    for asked in (ProblemArray(order=4, B=velocities), ProblemArray(order=3, B=velocities, symmetric=False)):
        found = synthesize_array(asked)
        results = map(found.result, range(found.size))
        laws = [result.law.to_dict() if isinstance(result, Solution) else None for result in results]
        assert found.stored_laws() == laws
        assert laws[0] is None
