"""Problem files of many problems on the page: a row for each problem, and the law of the selected row."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import msgspec

from optlaws import Problem
from optlaws.errors import OptlawsError
from optlaws.explorer.views.law_view import refusal
from optlaws.explorer.views.requests import Question, without_files
from optlaws.files.problem_file import convert
from optlaws.jobs.fronts import FrontsProblemFile
from optlaws.jobs.solutions import SolutionsProblemFile, swept_entries
from optlaws.studies.points import StudyPoints
from optlaws.studies.problem_entries import problem, shown
from optlaws.studies.specification import entries, read_study

_MOST_ROWS = 400
_WHERE = Path("the study")
Row = tuple[dict[str, Any], Problem]


class StudyRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A problem file of any job, as its own entries."""

    study: dict[str, Any]


def answer(request: StudyRequest) -> dict[str, Any]:
    """The rows of a study: the differences from row to row, and the law of each in the page's form."""
    try:
        without_files(request.study)
        return _view(request.study)
    except OptlawsError as error:
        return {"refused": refusal(error)}


def _view(study: Mapping[str, Any]) -> dict[str, Any]:
    count, rows = rows_of(study)
    listed = [*islice(rows, _MOST_ROWS)]
    names = list(dict.fromkeys(name for differing, _ in listed for name in differing))
    job = str(study.get("job", "study"))
    return {
        "title": str(study.get("title", job)),
        "text": " ".join(str(study.get("text", "")).split()),
        "job": job,
        "names": names,
        "rows": [
            {"cells": [str(differing.get(name, "")) for name in names], "law": law_entries(stated)}
            for differing, stated in listed
        ],
        "note": _note(job, count),
    }


def _note(job: str, count: int) -> str:
    if not count:
        return f"The page has no view of the job {job}: `optlaws run` makes the results of this file."
    return "" if count <= _MOST_ROWS else f"The first {_MOST_ROWS} of {count} problems."


def rows_of(study: Mapping[str, Any]) -> tuple[int, Iterator[Row]]:
    """How many problems a study has, and each with the entries in which it differs; none of a job without problems.

    Raises
    ------
    InputError
        If an entry is unknown or wrong.

    Examples
    --------
    >>> count, rows = rows_of({"problem": {"order": 4}, "vary": {"B": [1.6, 1.7]}})
    >>> count, next(rows)[0]
    (2, {'B': 1.6})
    """
    kinds: dict[str, Callable[[Mapping[str, Any]], tuple[int, Iterator[Row]]]]
    kinds = {"solutions": _solutions, "fronts": _fronts, "atlas": _points}
    job = study.get("job", "atlas" if "vary" in study else None)
    return kinds[job](study) if isinstance(job, str) and job in kinds else (0, iter(()))


def _solutions(study: Mapping[str, Any]) -> tuple[int, Iterator[Row]]:
    spec = convert(dict(study), SolutionsProblemFile, _WHERE)
    base = spec.problem.given()
    swept = [*swept_entries(spec)]
    return len(swept), (
        ({name: shown(name, value) for name, value in entry.items()}, problem(f"row {i}", base, entry))
        for i, entry in enumerate(swept, 1)
    )


def _fronts(study: Mapping[str, Any]) -> tuple[int, Iterator[Row]]:
    """Each front by the law with the least of its second constant."""
    spec = convert(dict(study), FrontsProblemFile, _WHERE)
    fronts = [(picture, front) for picture in spec.figure for front in picture.front]
    return len(fronts), (
        (
            {"figure": picture.title, "front": front.label, "over": " ".join(picture.over)},
            problem(f"figure {picture.name}", spec.problem.given(), front.given(), {"minimise": picture.over[1]}),
        )
        for picture, front in fronts
    )


def _points(study: Mapping[str, Any]) -> tuple[int, Iterator[Row]]:
    spec = read_study(study)
    points, base = StudyPoints.of(spec), spec.problem.given()
    return len(points), (
        (inputs, problem(f"point {i + 1}", entries(base, inputs)))
        for i in range(len(points))
        for inputs in (points.inputs(i),)
    )


def law_entries(stated: Problem) -> dict[str, Any]:
    """A problem in the page's form of a law: with weights where a single constant is minimised.

    Examples
    --------
    >>> law_entries(Problem(order=4, B=1.7))["weights"]
    {'C': 1.0}
    """
    plain = stated.to_dict()
    if plain.get("minimise") in {"C", "D", "J", "rms_c"}:
        return {"weights": {plain.pop("minimise"): 1.0}, "problem": plain}
    return {"problem": plain}


def example() -> dict[str, Any]:
    """The study that the page shows where none was given."""
    return {
        "job": "solutions",
        "title": "What more boundary conditions cost",
        "text": "The least C by order l, each further derivative zero at the ends, at given and at free B.",
        "problem": {"degree": 9},
        "sweep": [{"B": [1.641, 1.859, "free"]}, {"order": [2, 3, 4, 5]}],
    }


QUESTIONS: dict[str, Question] = {"study": (StudyRequest, answer)}
