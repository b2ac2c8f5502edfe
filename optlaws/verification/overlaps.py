"""Axes whose moves overlap: their times, limits and interlocks, and the bound that no other instants pass."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from optlaws.errors import OptlawsError
from optlaws.lazy import imported
from optlaws.tolerances import STORED_VALUE
from optlaws.verification.reading import built
from optlaws.verification.result import Claim, Verification


def overlap_of_axes(data: Mapping[str, Any]) -> Verification:
    """Check the objective, the interlocks and the bound of axes that overlap, all computed again from the machine."""
    overlap = built(imported("optlaws.cycles.machine_axes").Overlap.stated, data, "the axes that overlap")
    wrong = built(lambda stated: stated.contradiction(), overlap, "the axes that overlap")
    detail = wrong or f"{overlap.objective!r} stated, which its axes have within their limits, in doubles"
    claims = [Claim(f"the {overlap.goal}", proven=False, detail=detail, checked=bool(wrong))]
    if not wrong:
        claims += [*_interlocks(overlap), _bound(overlap)]
    return Verification(
        problem=None,
        bound=None,
        claims=tuple(claim for claim in claims if claim.checked),
        unchecked=tuple(claim for claim in claims if not claim.checked),
    )


def _interlocks(overlap: Any) -> Iterator[Claim]:
    """The claims that interlocks are clear over the whole cycle, by enclosures of the positions."""
    for least in overlap.axes.clearances:
        detail = f"{least.status}, {least.text}; {least.bound!r} {least.unit} or more everywhere"
        yield Claim(f"interlock {least.interlock.label}", least.status == "clear", detail, least.status != "open")


def _bound(overlap: Any) -> Claim:
    """The claim that no other instants have less, with what leaves no room, sought again."""
    name = "no other instants"
    try:
        again = overlap.again()
    except OptlawsError as error:
        return Claim(name, proven=False, detail=str(error))
    detail = f"{overlap.lower_bound!r} stated, {again.lower_bound!r} sought again; bound by {', '.join(again.binding)}"
    low = overlap.lower_bound <= again.lower_bound * (1.0 + STORED_VALUE)
    agrees = low and overlap.binding == again.binding and overlap.objective >= again.lower_bound * (1.0 - STORED_VALUE)
    return Claim(name, proven=False, detail=detail, checked=not agrees)
