"""What the row of a table or a front says of an entry in it, held against the entry."""

from __future__ import annotations

from collections.abc import Iterator

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.suggest import unknown_key
from optlaws.synthesis.problem.constants import FUNCTIONALS
from optlaws.synthesis.proof.data import problem_of
from optlaws.verification.enclosing.balls import enclosed
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.file_entries import Entry
from optlaws.verification.reading import built
from optlaws.verification.result import Claim, Verification
from optlaws.verification.stated_numbers import near


def claims_in_context(entry: Entry, verification: Verification) -> Iterator[Claim]:
    """Status, problem, peak velocity and constants that stand around an entry, as claims.

    Raises
    ------
    InputError
        If a problem around it is none, or a constant is unknown.
    """
    around, problem = entry.around, verification.problem
    if around.status is not None:
        own = "infeasible" if _no_law(verification, around.above) else entry.data.get("status")
        yield Claim("the row's status", own == around.status, f"{around.status!r} stated, {own!r} inside")
    if around.asked is not None:
        asked = problem_of(around.asked)
        yield Claim("the row's problem", asked == problem, f"{asked!r}")
    if around.B is not None and problem is not None:
        yield Claim("the row's B", around.B == problem.B, f"{around.B!r} stated, {problem.B!r} in the problem")
    yield from _constants(entry)


def _no_law(verification: Verification, above: float | None) -> bool:
    """Whether no law exists: the constraints contradict each other, or a least value is above what is asked."""
    bound = verification.bound
    return verification.infeasible or (above is not None and bound is not None and bound > above)


def _constants(entry: Entry) -> Iterator[Claim]:
    if not entry.around.values:
        return
    if "law" not in entry.data:
        raise InputError("values of a front claim something of a point without a law")
    law = built(lambda data: ExactLaw(MotionLaw.from_dict(data)), entry.data["law"], "law")
    for name, value in entry.around.values.items():
        if name not in FUNCTIONALS:
            raise InputError(unknown_key(name, FUNCTIONALS, "constant"))
        yield near(f"the front's {name}", value, enclosed(law.term(FUNCTIONALS[name])))
