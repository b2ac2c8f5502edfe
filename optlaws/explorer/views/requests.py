"""The page's requests, read from JSON with their limits: laws by a problem, by a name or as stored."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Annotated, Any, TypeVar

import msgspec

from optlaws import MotionLaw, Problem, Solution, synthesize
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.laws.catalogue import reading
from optlaws.mechanisms.machine.spectrum import MOST_POINTS
from optlaws.numbers import whole

#: beyond this nobody drags, and an answer takes longer than a page should wait
MOST_ORDER, MOST_DEGREE, MOST_LAWS = 12, 41, 4
#: beyond this the envelope of the vibration, which the residual is, says nothing of what little is left to see
MOST_DAMPING = 0.5

Struct = TypeVar("Struct", bound=msgspec.Struct)
Text = Annotated[str, msgspec.Meta(max_length=60)]
Frequency = Annotated[float, msgspec.Meta(gt=0.0, le=1000.0)]


class LawRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, frozen=True):
    """A law: a problem, the name of a standard law, or a stored law."""

    problem: dict[str, Any] | None = None
    name: Annotated[str, msgspec.Meta(max_length=100)] | None = None
    law: dict[str, Any] | None = None
    title: Annotated[str, msgspec.Meta(max_length=200)] | None = None


class LawsRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Laws side by side, of which one is active, and what a view computes of them.

    Of a front the constants that are exchanged; of a machine the stroke, the time and the mass, or the inertia, that
    the active law moves; of a follower the highest displayed frequency nu, the selected one and the damping, the band
    in which the greatest residual is sought, and a spectrum, pairs of a frequency and an amplitude: nu, or Hz where the
    duration of the motion is given.
    """

    laws: Annotated[list[LawRequest], msgspec.Meta(min_length=1, max_length=MOST_LAWS)]
    active: Annotated[int, msgspec.Meta(ge=0)] = 0
    over: tuple[str, str] = ("B", "C")
    stroke: Text = ""
    time: Text = ""
    mass: Text = ""
    frequency: Frequency = 20.0
    most: Annotated[float, msgspec.Meta(ge=10.0, le=1000.0)] = 80.0
    damping: Annotated[float, msgspec.Meta(ge=0.0, le=MOST_DAMPING)] = 0.0
    band: tuple[Frequency, Frequency] | None = None
    spectrum: Annotated[list[tuple[float, float]], msgspec.Meta(min_length=2, max_length=MOST_POINTS)] | None = None
    duration: Text | None = None

    @property
    def law(self) -> LawRequest:
        """The law that is active."""
        return self.laws[min(self.active, len(self.laws) - 1)]


def read(text: bytes, kind: type[Struct]) -> Struct:
    """A question of the page; an `InputError` says where it is no JSON, or has an entry that is unknown or wrong."""
    try:
        return msgspec.json.decode(text, type=kind)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"the question cannot be read: {error}") from None


def without_files(entries: Any) -> None:
    """Refuse what names a file, such as a measured spectrum, a law or a catalogue of motors: the page reads none."""
    if isinstance(entries, str):
        for match in reading.SPECTRUM_FILE.finditer(entries):
            raise InputError(f"spectrum: {match[3]!r} names a file, and the page reads none: drop it onto the page")
    elif isinstance(entries, Mapping):
        if entries.get("motors") is not None:
            raise InputError("motors: the page reads no catalogue: give the motor as a table, or start with the file")
        law = entries.get("law")
        if isinstance(law, str) and reading.is_file(law):
            raise InputError(f"law: {law} names a file, and the page reads none: take a law of the catalogue")
        for name, entry in entries.items():
            without_files(name)
            without_files(entry)
    elif isinstance(entries, list | tuple):
        for entry in entries:
            without_files(entry)


def check_size(order: Any, degree: Any) -> None:
    """Refuse laws of a higher order or degree than the explorer takes, where they are known."""
    if order is not None:
        whole(order, "order", least=1, most=MOST_ORDER)
    if degree is not None:
        whole(degree, "degree", most=MOST_DEGREE)


def problem_of(request: LawRequest) -> Problem:
    """The problem of a page's request."""
    entries = request.problem or {}
    without_files(entries)
    check_size(entries.get("order"), entries.get("degree"))
    return Problem.from_dict(entries)


_LAST: dict[int, Solution] = {}


@lru_cache(maxsize=512)
def solved(problem: Problem) -> Solution | InfeasibleProblem | SolverFailure:
    """The solution of a problem, or the reason why there is none."""
    # while a law is dragged each problem is next to the last one: a convex one has the same optimum from wherever
    start = _LAST.get(0) if problem.convex else None
    try:
        solution = _LAST[0] = synthesize(problem, start=start)
    except (InfeasibleProblem, SolverFailure) as error:
        return error
    return solution


def without(problem: Problem, constant: str, **changes: Any) -> Problem:
    """The problem without its bound of a constant, with other entries replaced."""
    if hasattr(problem, constant):
        free: dict[str, Any] = {constant: None}
        return replace(problem, **free, **changes)
    others = {name: bound for name, bound in problem.bounds.items() if name.name != constant}
    return replace(problem, bounds=others, **changes)


def given_law(request: LawRequest) -> MotionLaw:
    """The law of a name or of stored data; no file is read."""
    if request.law is not None:
        return MotionLaw.from_dict(request.law)
    name = request.name or ""
    if reading.is_file(name):
        raise InputError(f"{name} names a file, and the page reads none: start `optlaws explore` with it")
    return reading.read_law(name)


@lru_cache(maxsize=128)
def stored_law(text: bytes) -> MotionLaw:
    """A law as it is stored, or that of a stored solution, from JSON."""
    entries = msgspec.json.decode(text)
    return Solution.from_dict(entries).law if "certificate" in entries else MotionLaw.from_dict(entries)


def result_of(request: LawRequest) -> MotionLaw | Solution:
    """The requested law, in any of its forms; of a problem its solution."""
    if request.problem is None:
        return given_law(request)
    answer = solved(problem_of(request))
    if isinstance(answer, Solution):
        return answer
    raise answer.with_traceback(None)


def law_of(request: LawRequest) -> MotionLaw:
    """The requested law alone."""
    result = result_of(request)
    return result.law if isinstance(result, Solution) else result
