"""Fronts over the time of a move with every rounding enclosed: the least time, and each law with its bound."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

from optlaws.files.reading import all_entries_of
from optlaws.numbers import real
from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.synthesis.least_time.move_objective import MoveObjective
from optlaws.synthesis.problem.constants import meant
from optlaws.tolerances import STORED_VALUE
from optlaws.verification.reading import built, number
from optlaws.verification.result import Claim, Verification

_KEYS = ("duration", "value", "lower_bound", "solution")


def time_front(data: Mapping[str, Any], of_least: Verification, of_points: Sequence[Verification]) -> Verification:
    """Check that each law is of the move in its time, and its numbers in SI units; the rest is known already.

    Parameters
    ----------
    data
        The file's entry.
    of_least, of_points
        What is known of the least time, and of the solution of each point.
    """
    stated = {key: value for key, value in data["fastest"].items() if key not in {"unit", "about"}}
    least = built(LeastTime.from_dict, stated, "the least time")
    objective = built(MoveObjective.from_dict, data["minimise"], "what is least")
    rows = [all_entries_of(row, _KEYS, f"points[{i}]") for i, row in enumerate(data["points"])]
    durations = [number(row, "duration") for row in rows]
    ascending = bool(rows) and durations[0] >= least.duration and all(low < high for low, high in pairwise(durations))
    detail = "they ascend, none below the least time" if ascending else "they do not ascend from the least time on"
    claims = [Claim("the times of the points", ascending, detail), *of_least.claims]
    for duration, row, known in zip(durations, rows, of_points, strict=True):
        where = f"at {duration:.9g} s"
        claims += [replace(claim, name=f"{where}: {claim.name}") for claim in known.claims]
        claims += [replace(claim, name=f"{where}: {claim.name}") for claim in _point(least, objective, row, known)]
    unchecked = [
        replace(claim, name=f"at {duration:.9g} s: {claim.name}")
        for duration, known in zip(durations, of_points, strict=True)
        for claim in known.unchecked
    ]
    return replace(of_least, claims=tuple(claims), unchecked=(*of_least.unchecked, *unchecked))


def _point(least: LeastTime, objective: MoveObjective, row: Mapping[str, Any], known: Verification) -> Iterator[Claim]:
    """The claim that a law belongs to the move in its time, with its objective and its lower bound, in SI units."""
    duration, move = number(row, "duration"), least.move
    with meant():
        same = known.problem == objective.problem(move, duration)
    yield Claim("the problem", same, f"its limits {'are' if same else 'are not'} those of the move in this time")
    of_law = objective.in_time(duration, move.stroke)
    unit = Fraction(of_law.bound)
    low, high = (None, None) if known.objective is None else (Fraction(side) / unit for side in known.objective)
    value = Fraction(number(row, "value"))
    # a value near 0, such as a residual that vanishes, is compared with its scale
    little = Fraction(STORED_VALUE) * max(abs(value), Fraction(of_law.constant.scale) / unit)
    near = low is not None and high is not None and low - little <= value <= high + little
    yield Claim(f"the {objective.name}", near, f"{float(value)!r} stated, {_shown(high)} at most")
    stated, bound = real(row["lower_bound"]), None if known.bound is None else Fraction(known.bound) / unit
    below = row["lower_bound"] is None or (bound is not None and stated is not None and stated <= bound + little)
    yield Claim(f"no law with less {objective.name}", below, f"{row['lower_bound']!r} stated, {_shown(bound)} proven")


def _shown(value: Fraction | None) -> str:
    return "nothing" if value is None else repr(float(value))
