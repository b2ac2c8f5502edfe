"""Plans of cycles, machines of several axes and cams: their solutions, and what is stated of their laws."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from math import inf, nextafter, sqrt
from typing import Any

from optlaws.errors import InputError, OptlawsError
from optlaws.files.reading import entries_of
from optlaws.lazy import imported
from optlaws.numbers import listed
from optlaws.synthesis.limits.rounding import rounded_down, rounded_up
from optlaws.synthesis.problem.constants import FUNCTIONALS
from optlaws.tolerances import STORED_VALUE
from optlaws.verification.enclosing.balls import enclosed
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.file_entries import kind_of
from optlaws.verification.reading import built, number
from optlaws.verification.result import (
    Claim,
    Data,
    Verification,
    at_most,
    differences,
    every_claim,
    near,
    with_claims,
)
from optlaws.verification.stated_solutions import solution

_MOST = 1000  # rows of a list


def plan(data: Data) -> Verification:
    """Check the solutions of a plan, each by itself, that they are those of its cycle, and its numbers."""
    rows, entries = _solutions(data), _plan_of(data)
    others = {name: value for name, value in data.items() if name not in {*entries, "about"}}
    return of_cycle(lambda: imported("optlaws.cycles.cycle").Plan.from_dict(entries), lambda _: rows(), others)


def cam(data: Data) -> Verification:
    """Check the solutions of the laws of a cam, each by itself, and the numbers of the cam that has these laws."""
    known, claims = _solutions(data)(), list[Claim]()
    try:
        result = imported("optlaws.jobs.cam").stored(data)
        stated = {name: value for name, value in data.items() if name not in {"about", "unit", "cam", "solutions"}}
        wrong = result.plan.contradiction()
        detail = wrong or f"they meet its joints and keep its limits, in doubles; status {result.plan.status.value}"
        claims = [Claim("the laws of the motion", proven=False, detail=detail, checked=bool(wrong))]
        of_laws = stated.get("laws") or {}
        proven = list(_objective_of_cycle(result.plan, [each.bound for each in known.values()], of_laws))
        claims += [replace(claim, name=f"laws.{claim.name}") for claim in proven]
        if getattr(result, "takes_its_bound", False):
            above = result.bound > result.plan.objective * (1.0 + STORED_VALUE)
            detail = f"{result.bound!r} stated, of laws under limits of the cam that are not linear in them"
            claims.append(Claim("best.lower_bound", proven=False, detail=detail, checked=above))
        claims += _numbers(stated, result.data)
    except OptlawsError as error:
        claims.append(Claim("the cam", proven=False, detail=str(error)))
    every = [claim for place, each in known.items() for claim in every_claim(each, f"{place}: ")]
    return with_claims(Verification(), [*every, *claims])


def _solutions(data: Data) -> Callable[[], dict[str, Verification]]:
    """The solutions of a plan or a cam by their places, which are verified when it is called."""
    rows = {f"solutions[{i}]": each for i, each in enumerate(listed(data["solutions"], "solutions", _MOST))}
    for place, each in rows.items():
        if not isinstance(each, Mapping) or kind_of(each) != "solution":
            raise InputError(f"{place} is no solution with its problem, its law and its certificate")
    return lambda: {place: solution(each) for place, each in rows.items()}


def _plan_of(data: Data) -> Data:
    """The entries of a plan without its numbers."""
    return {name: data[name] for name in ("cycle", "solutions", "chosen", "bound") if name in data}


def of_cycle(
    read: Callable[[], Any], parts: Callable[[Any], Mapping[str, Verification]], stated: Data | None = None
) -> Verification:
    """Check the parts of a plan, each by itself, that its laws are those of its cycle, and what is stated of them."""
    solved, numbers = None, list[Claim]()
    try:
        solved = read()
        wrong = solved.solve().contradiction()
        detail = wrong or f"they meet its joints and keep its limits, in doubles; status {solved.status.value}"
    except OptlawsError as error:
        wrong = detail = str(error)
    known = parts(solved)
    if stated and solved is not None:
        proven = list(_objective_of_cycle(solved, [each.bound for each in known.values()], stated))
        numbers = [*proven, *_numbers(stated, solved.report().stored, {claim.name for claim in proven})]
    every = [claim for place, each in known.items() for claim in every_claim(each, f"{place}: ")]
    claim = Claim("the laws of the cycle", proven=False, detail=detail, checked=bool(wrong))
    return with_claims(Verification(), [*every, claim, *numbers])


#: the constant of a law by the order of its derivative, as a peak and as a root mean square
_CONSTANTS = {1: ("B", ""), 2: ("C", "rms_c"), 3: ("J", "rms_j"), 4: ("snap", "rms_snap")}


def _objective_of_cycle(plan: Any, bounds: list[float | None], stated: Data) -> Iterator[Claim]:
    """The claims of the objective and the lower bound of a cycle, in SI units, where it is of a derivative."""
    objective = plan.specification.in_si
    nu, mean = objective.kind.order, objective.mean
    name = _CONSTANTS.get(nu, ("", ""))[mean]
    if plan.bound is not None:
        detail = (
            f"{plan.bound!r} stated, which laws that share a limit or were selected among equals do not prove alone"
        )
        yield Claim("lower_bound", proven=False, detail=detail, checked=False)
    if not name or not bounds or stated.get("objective") is None:
        return
    proven = {id(piece): bound for (_, piece, _), bound in zip(plan.laws, bounds, strict=True)}
    rows = list[tuple[Fraction, list[float | None]]]()
    for piece in plan.pieces:
        unit = abs(Fraction(piece.stroke)) / Fraction(piece.duration) ** nu
        low, high = enclosed(ExactLaw(piece.law).term(FUNCTIONALS[name])) if unit else (0.0, 0.0)
        if high == inf:
            return
        share = Fraction(piece.duration) / Fraction(plan.duration)
        rows.append((share * unit**2 if mean else unit, [low, high, proven.get(id(piece), low)]))

    def total(i: int) -> Fraction:
        sizes = [weight * Fraction(values[i] or 0.0) ** (2 if mean else 1) for weight, values in rows]
        return sum(sizes, Fraction(0)) if mean else max(sizes)

    low, high = rounded_down(total(0)), rounded_up(total(1))
    ends = (nextafter(sqrt(low), -inf), nextafter(sqrt(high), inf)) if mean else (low, high)
    yield near("objective", number(stated, "objective"), ends, 0.0)
    if stated.get("lower_bound") is not None and plan.bound is None and plan.of_its_problems():
        least = Fraction(nextafter(sqrt(rounded_down(total(2))), -inf)) if mean else total(2)
        yield at_most("lower_bound", number(stated, "lower_bound"), least, 0.0)


def _numbers(stated: Data, known: Data, apart: Container[str] = ()) -> Iterator[Claim]:
    """The claims of numbers beside laws: those that differ from what the laws have, and what is only computed again.

    What has a claim of its own stands `apart`.
    """
    wrong = list(differences(stated, known, ""))
    yield from wrong
    names = ", ".join(name for name, value in stated.items() if value is not None and name not in apart)
    if names and not wrong:
        yield Claim(
            "the numbers", proven=False, detail=f"computed again in doubles, they agree: {names}", checked=False
        )


def axes(data: Data) -> Verification:
    """Check what is stated of the axes of a machine together: their interlocks, and their overlap."""
    try:
        claims = list(_together(data))
    except OptlawsError as error:
        claims = [Claim("the axes together", proven=False, detail=str(error))]
    if data.get("transitions") is not None:
        detail = "their laws and proofs are in transitions.json"
        claims.append(Claim("the transitions", proven=False, detail=detail, checked=False))
    return with_claims(Verification(), claims)


def _together(data: Data) -> Iterator[Claim]:
    face = imported("optlaws.cycles.axes.machine_axes")
    read = imported("optlaws.cycles.cycle").Plan.from_dict
    plans = {name: read(_plan_of(plan)) for name, plan in data["axes"].items()}
    rows, overlap = listed(data.get("interlocks") or [], "interlocks", _MOST), data.get("overlap")
    rules = [entries_of(row, ["rule"], "an interlock")["rule"] for row in rows]
    if overlap is None:
        known = face.Axes(plans, interlocks=rules)
        yield from _interlocks(known)
    else:
        axes = face.Axes({name: plan.specification for name, plan in plans.items()}, interlocks=rules)
        entries = {name: value for name, value in overlap.items() if name not in {"status", "gain"}}
        known = face.Overlap.stated({**entries, "axes": axes})
        yield from _overlap_claims(known)
    stated = {name: data[name] for name in ("interlocks", "overlap") if data.get(name) is not None}
    yield from _numbers(stated, known.report().data)


def overlap_of_axes(data: Data) -> Verification:
    """Check the objective, the interlocks and the bound of axes that overlap, all computed again from the machine."""
    overlap = built(imported("optlaws.cycles.axes.machine_axes").Overlap.stated, data, "the axes that overlap")
    return with_claims(Verification(), _overlap_claims(overlap))


def _overlap_claims(overlap: Any) -> Iterator[Claim]:
    wrong = built(lambda stated: stated.contradiction(), overlap, "the axes that overlap")
    detail = wrong or f"{overlap.objective!r} stated, which its axes have within their limits, in doubles"
    yield Claim(f"the {overlap.goal}", proven=False, detail=detail, checked=bool(wrong))
    if not wrong:
        yield from (*_interlocks(overlap.axes), _bound(overlap), _binding(overlap))


def _interlocks(axes: Any) -> Iterator[Claim]:
    """The claims that interlocks are clear over the whole cycle, by enclosures of the positions."""
    for least in axes.clearances:
        detail = f"{least.status}, {least.text}; {least.bound!r} {least.unit} or more everywhere"
        yield Claim(f"interlock {least.interlock.label}", least.status == "clear", detail, least.status != "open")


def _bound(overlap: Any) -> Claim:
    """The claim that no other instants have less, sought again."""
    name = "no other instants"
    try:
        again = overlap.again()
    except OptlawsError as error:
        return Claim(name, proven=False, detail=str(error))
    detail = f"{overlap.lower_bound!r} stated, {again.lower_bound!r} sought again"
    low = overlap.lower_bound <= again.lower_bound * (1.0 + STORED_VALUE)
    agrees = low and overlap.objective >= again.lower_bound * (1.0 - STORED_VALUE)
    return Claim(name, proven=False, detail=detail, checked=not agrees)


def _binding(overlap: Any) -> Claim:
    """The claim that what is named leaves no room and nothing else does, at the instants of the file.

    What leaves about as much as counts as none may be named or not.
    """
    name, stated = "what leaves no room", set(overlap.binding)
    try:
        surely, hardly = (set(overlap.bound_by(share)) for share in (0.5, 2.0))
    except OptlawsError as error:
        return Claim(name, proven=False, detail=str(error))
    detail = f"{', '.join(overlap.binding)} stated; {', '.join(sorted(hardly))} by the instants, in doubles"
    agrees = surely <= stated <= hardly and len(stated) == len(overlap.binding)
    return Claim(name, proven=False, detail=detail, checked=not agrees)
