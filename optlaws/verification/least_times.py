"""Least times of moves with every rounding enclosed: the law keeps the limits, and no law does in a shorter time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.tolerances import BOUND_FEASIBILITY
from optlaws.verification.conditions import excesses
from optlaws.verification.enclosing.balls import enclosed
from optlaws.verification.exact.bound import prove
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.reading import built, number
from optlaws.verification.result import Claim, Verification


def least_time(data: Mapping[str, Any], of_law: Verification) -> Verification:
    """Check the time, the limits that its law keeps and the proofs; `of_law` is what is known of its solution."""
    stated = {key: value for key, value in data.items() if key not in {"unit", "about"}}
    least = built(LeastTime.from_dict, stated, "the least time")
    claims = (*of_law.claims, *_limits(least), *_proofs(least))
    return replace(of_law, claims=claims, unchecked=(*of_law.unchecked, *_limit(least, data)))


def _limits(least: LeastTime) -> Iterator[Claim]:
    """The claim that the law satisfies every limit in the time, in the units of the file."""
    law = ExactLaw(least.law)
    for limit in least.move.limits_in(least.duration):
        used = Fraction(enclosed(law.term(limit.constant))[1]) / Fraction(limit.bound)
        holds = used <= 1 + Fraction(BOUND_FEASIBILITY)
        yield Claim(f"the limit of the {limit.name}", holds, f"the law uses {float(used):.9g} of it")
    broken = [excess for excess in excesses(least.move.within(least.duration), law) if not excess.holds]
    detail = "; ".join(f"{excess.name} is broken by {excess.by:.1e}" for excess in broken)
    yield Claim("the law in the least time", not broken, detail or "it keeps every condition of the move")


def _proofs(least: LeastTime) -> Iterator[Claim]:
    """The claim that no law satisfies the limits in any shorter time."""
    wrong = least.contradiction
    if wrong:
        yield Claim("the least time", proven=False, detail=wrong)
    for proof in least.proofs:
        shown = [prove(certificate) for certificate in proof.certificates(least.move)]
        stands = bool(shown) and all(each.value is not None and each.value > 0 for each in shown)
        times = (
            f"from {proof.shortest:.9g} s to {proof.longest:.9g} s" if proof.shortest else f"up to {proof.longest!r} s"
        )
        how = "the multipliers contradict the limits" if stands else "the multipliers do not contradict the limits"
        yield Claim(f"no law in a time {times}", stands, how)


def _limit(least: LeastTime, data: Mapping[str, Any]) -> Iterator[Claim]:
    """The closed form for all laws, recomputed in doubles; a file with another value is refused."""
    if least.limit is not None:
        detail = f"{number(data, 'limit')!r} stated, {least.limit!r} by the segments"
        yield Claim("the limit of all laws", proven=False, detail=detail, checked=False)
