"""One row of a study, with its law and its problem."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.synthesis import Problem

CONSTANTS = ("B", "C", "D", "J", "rms_c")


@dataclass(frozen=True)
class StudyPoint:
    """One row of a study.

    Attributes
    ----------
    index, key
        Its number in the study, and a hash of its problem.
    inputs
        What varies, at this point.
    problem
        The whole problem.
    status
        "optimal", "local" or "inaccurate" where there is a law (see `Status`); otherwise "infeasible", "not found",
        "wrong input", "time limit", "worker died" or "error", and `error` says more.
    objective
        As in `Solution`; None where there is no law.
    lower_bound
        As in `Solution`; None where there is no law.
    gap
        As in `Solution`; None where there is no law.
    limit
        As in `Solution`; None where there is no law.
    constants
        B, C, D, J and rms_c of the law; empty where there is none, None for one without bound.
    law
        The law; None where there is none.
    seconds
        Wall time.
    """

    index: int
    key: str
    inputs: Mapping[str, Any]
    status: str
    objective: float | None
    lower_bound: float | None
    gap: float | None
    limit: float | None
    constants: Mapping[str, float | None]
    seconds: float
    error: str | None
    entries: Mapping[str, Any] = field(repr=False)
    stored: Mapping[str, Any] | None = field(repr=False)

    @kept_property
    def law(self) -> MotionLaw | None:
        """The law."""
        return None if self.stored is None else MotionLaw.from_dict(self.stored)

    @kept_property
    def problem(self) -> Problem:
        """The problem; InputError where the point asks for none."""
        return Problem.from_dict(self.entries)


def study_point(row: Mapping[str, Any], asked: Mapping[str, Any]) -> StudyPoint:
    """The point of a stored row; `asked` has the entries of its problem."""
    kept = ("index", "key", "inputs", "status", "objective", "lower_bound", "gap", "limit", "seconds", "error")
    return StudyPoint(
        **{name: row[name] for name in kept},
        constants={name: row[name] for name in CONSTANTS} if row["law"] is not None else {},
        entries=asked,
        stored=row["law"],
    )
