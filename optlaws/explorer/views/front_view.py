"""Fronts as the page draws them: optimal laws along one constant, the best possible of all laws, and known laws."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cache, lru_cache
from typing import Any

import numpy as np

from optlaws import (
    FUNCTIONALS,
    Front,
    Problem,
    ProblemArray,
    SavinFamily,
    Solution,
    Status,
    at_most,
    catalogue,
    map_arrays,
    synthesize_array,
)
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views.law_view import digits, objective_title
from optlaws.explorer.views.panel_data import drawn, panel_data
from optlaws.explorer.views.requests import LawsRequest, problem_of, solved, without
from optlaws.laws.savin import FAMILIES
from optlaws.numbers import Array, bounded
from optlaws.synthesis.proof.infeasible import possible_velocities
from optlaws.tolerances import BOUND_SLACK

#: least and greatest of each axis that is drawn
RANGES = {"B": (1.1, 2.5), "C": (3.5, 10.0), "D": (2.0, 11.0), "J": (20.0, 140.0), "rms_c": (3.2, 7.0)}
_POINTS = 57
#: the chord of two points leaves the front by no more than this share of the picture, or is halved so often
_OFF, _HALVED = 1e-3, 3
#: sums with D in them are solved one by one
_POINTS_ALONE = 25
_LONGEST = 80
#: pairs that may be exchanged: the first is swept, the second is drawn over it
PAIRS = (("B", "C"), ("B", "D"), ("B", "J"), ("C", "D"), ("J", "C"))


def answer(request: LawsRequest) -> dict[str, Any]:
    """The front of a problem: where B is swept, of its own objective; else of the least second constant."""
    x, y = request.over
    if (x, y) not in PAIRS:
        raise InputError(f"over must be one of {', '.join('-'.join(pair) for pair in PAIRS)}, got {x}-{y}")
    line: dict[str, Any] = {"words": ""}
    if request.law.problem is not None:
        try:
            line = front(swept_problem(problem_of(request.law), x, y), x, y)
        except OptlawsError as error:  # the view of the law says why at length
            line = {"words": f"no front: {str(error.args[0])[:_LONGEST]}"}
    picture = {"x": x, "y": y, "ranges": [RANGES[x], RANGES[y]], "known": known_points(x, y)}
    return picture | {"families": families(x, y)} | line


def swept_problem(problem: Problem, x: str, y: str) -> Problem:
    """The problem whose first constant is to run: where that is not B, the second is minimised."""
    return without(problem, x) if x == "B" else without(problem, x, minimise=y)


@lru_cache(maxsize=64)
def front(problem: Problem, x: str, y: str) -> dict[str, Any]:
    """The optimal laws over x with what is proven of them, and the best possible at any degree, as curves."""
    span = _span(problem, x)
    if span is None:
        return {"words": f"no {x} has a law of this problem"}
    alone = not problem.convex and problem.minimise != "D"
    line = _laws(problem, (x, y), np.linspace(*span, _POINTS_ALONE if alone else _POINTS))
    for _ in range(_HALVED if problem.convex else 0):
        middles = _coarse(line.values, (RANGES[y][1] - RANGES[y][0]) * _OFF)
        if not middles.size:
            break
        points = (*line, *_laws(problem, (x, y), middles))
        order = np.argsort(Front((x, y), points).values[:, 0], kind="stable")
        line = Front((x, y), tuple(points[i] for i in order))
    report = line.report()
    quality = report.facts[-1]
    proven = all(law.status is Status.OPTIMAL for law in line)
    if not proven and bounded(quality.value) is not None:
        quality = quality._replace(
            note=f"{quality.note}: no law is below them by more than {100.0 * quality.value:.2g} %"
        )
    at = "at each B" if x == "B" else f"for each bound of {x}"
    words = f"least {objective_title(problem)} {at}: {quality.note}"
    return {"series": panel_data(report.panels[0])["series"], "words": words, "proven": proven}


def _laws(problem: Problem, over: tuple[str, str], values: Array) -> Front:
    """The optimal laws for values of the first constant; one whose bound does not bind stands where its own is."""
    entries = {each.name: getattr(problem, each.name) for each in fields(problem)}
    swept: Any = values if over[0] == "B" else map_arrays(at_most, values)
    laws = synthesize_array(ProblemArray(**entries | {over[0]: swept}))
    return Front(over, tuple(law for law in map(laws.result, range(laws.size)) if isinstance(law, Solution)))


def _coarse(line: Array, allowed: float) -> Array:
    """The middles between points of a line whose chord leaves the curve by more than is allowed, by the bends there."""
    at, values = line.T
    share = (at[1:-1] - at[:-2]) / np.maximum(at[2:] - at[:-2], np.finfo(float).tiny)
    bends = np.abs(values[1:-1] - values[:-2] - share * (values[2:] - values[:-2])) / 4.0
    rough = np.concatenate([[False], bends > allowed, [False]])
    middles: Array = (0.5 * (at[:-1] + at[1:]))[rough[:-1] | rough[1:]]
    return middles


def _span(problem: Problem, x: str) -> tuple[float, float] | None:
    """The least and the greatest feasible value in the picture; nonconvex constraints are not considered."""
    low, high = RANGES[x]
    if x == "B":
        least, greatest = possible_velocities(problem)
        if least is None:
            return None
        ends = max(low, least), high if greatest is None else min(high, greatest)
    else:
        optimum = solved(replace(problem, minimise=x))
        if not isinstance(optimum, Solution):
            return None
        ends = max(low, optimum.objective * (1.0 + BOUND_SLACK)), high
    return ends if ends[0] < ends[1] else None


#: the laws that the picture always names
NAMED = {"cycloidal", "modified sine", "modified trapezoid", "3-4-5 polynomial", "4-5-6-7 polynomial", "cubic"}
_MEMBERS = 33


@cache
def known_points(x: str, y: str) -> list[dict[str, Any]]:
    """Each standard law from rest to rest whose two constants are finite, with its text for the reader."""
    points = []
    for name, entry in catalogue.items():
        place = FUNCTIONALS[x].value(entry.law), FUNCTIONALS[y].value(entry.law)
        # what moves at its ends is no rival of laws from rest to rest
        if entry.continuity and all(bounded(number) is not None for number in place) and place[1] > 0.0:
            text = f"{name}: {x} = {digits(place[0], 6)}, {y} = {digits(place[1], 6)}"
            points.append({"name": name, "at": place, "text": text, "named": name in NAMED})
    return points


@cache
def families(x: str, y: str) -> list[dict[str, Any]]:
    """Savin's families I to IV over their alpha; family I begins where its J is finite."""
    lines = []
    for name in FAMILIES:
        family = SavinFamily.of(name)
        low, high = map(float, family.range)
        laws = [family.law(alpha) for alpha in np.linspace(low, high, _MEMBERS).tolist()]
        columns = [drawn(np.array([FUNCTIONALS[constant].value(law) for law in laws]), 5) for constant in (x, y)]
        lines.append({"name": name, "line": [list(column) for column in zip(*columns, strict=True)]})
    return lines
