"""Claims of a file, one by one, and their verification."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from optlaws.echo import unknown_key
from optlaws.errors import InputError
from optlaws.files.reading import of_known_format
from optlaws.lazy import imported
from optlaws.synthesis.problem.constants import FUNCTIONALS, present_name
from optlaws.synthesis.proof.data import problem_of
from optlaws.verification.enclosing.balls import enclosed
from optlaws.verification.file_entries import NO_FILE, FileEntry, entries, is_entry, kind_of
from optlaws.verification.fronts_and_times import (
    least_time,
    of_cycle,
    overlap_of_axes,
    plan,
    proven_front,
    time_front,
)
from optlaws.verification.reading import built, read
from optlaws.verification.result import Claim, Verification
from optlaws.verification.stated_solutions import (
    arrays,
    certificate,
    drive_limit,
    exact_law,
    law_alone,
    move_limit,
    solution,
)
from optlaws.verification.statements import Data, near


def verify(source: Mapping[str, Any] | Path | str) -> Verification:
    """Check every claim of one solution, certificate or law."""
    data = of_known_format(read(source), "the file")
    if not is_entry(data):
        several = ", ".join(list(entries(data))[:3])
        inside = f"; it holds others, such as {several}: verify those with verify_all" if several else ""
        raise InputError(
            "neither a solution (problem, law, certificate) nor a certificate (problem, contacts) nor a law with its "
            f"constants: nothing to verify{inside}"
        )
    return built(verified, FileEntry(data), "the file")


def verify_all(source: Mapping[str, Any] | Path | str) -> dict[str, Verification]:
    """Check every solution, certificate and law with constants, by where it is; refuse whatever else is claimed."""
    claimed = entries(read(source))
    if not claimed:
        raise InputError(f"{NO_FILE}: nothing in it is a solution, a certificate or a law with its constants")
    return {path: built(verified, entry, path or "the file") for path, entry in claimed.items()}


def verified(entry: FileEntry) -> Verification:
    """Check what an entry states, and what stands around it."""
    if not entry.data:
        claim = Claim(f"{entry.status}", proven=False, detail="no certificate stands beside it")
        return Verification(claims=(claim,))
    alone = _VERIFIED[kind_of(entry.data)](entry.data)
    return replace(alone, claims=(*alone.claims, *_in_context(entry, alone)))


def _fastest_cycle(data: Data) -> Verification:
    stored = imported("optlaws.cycles.fastest_cycle").FastestCycle
    checked = of_cycle(lambda: stored.from_dict(data), lambda fastest: verify_all(fastest.claims()) if fastest else {})
    detail = "that they are those of the cycle, in a millionth less than their times, is not computed again"
    motions = Claim("the motions of the proofs", proven=False, detail=detail, checked=False)
    return replace(checked, unchecked=(*checked.unchecked, motions))


def _in_context(entry: FileEntry, verification: Verification) -> Iterator[Claim]:
    """Status, problem, peak velocity and constants that stand around an entry, as claims."""
    problem, bound = verification.problem, verification.bound
    if entry.status is not None:
        # the constraints contradict each other, or a least value exceeds its bound
        above = entry.above is not None and bound is not None and bound > entry.above
        inside = "infeasible" if verification.infeasible or above else entry.data.get("status")
        yield Claim("the row's status", inside == entry.status, f"{entry.status!r} stated, {inside!r} inside")
    if entry.problem is not None:
        stated = problem_of(entry.problem)
        yield Claim("the row's problem", stated == problem, f"{stated!r}")
    if entry.B is not None and problem is not None:
        yield Claim("the row's B", entry.B == problem.B, f"{entry.B!r} stated, {problem.B!r} in the problem")
    if entry.values and "law" not in entry.data:
        raise InputError("values of a front claim something of a point without a law")
    for name, value in entry.values.items():
        constant = FUNCTIONALS.get(present_name(name))
        if constant is None:
            raise InputError(unknown_key(name, FUNCTIONALS, "constant"))
        yield near(f"the front's {name}", value, enclosed(exact_law(entry.data["law"]).term(constant)))


#: how an entry of each kind is verified
_VERIFIED: Mapping[str | None, Callable[[Data], Verification]] = {
    "array": arrays,
    "proven front": proven_front,
    "drive limit": drive_limit,
    "move limit": move_limit,
    "least time": least_time,
    "time front": time_front,
    "overlap": overlap_of_axes,
    "plan": plan,
    "fastest cycle": _fastest_cycle,
    "solution": solution,
    "law": law_alone,
    "certificate": certificate,
}
