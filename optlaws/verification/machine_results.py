"""Plans of cycles, machines of several axes and cams: their solutions, and what is stated of their laws."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import inf, nextafter, sqrt
from typing import Any, NamedTuple

from optlaws.echo import shortened
from optlaws.errors import InputError, OptlawsError
from optlaws.files.reading import entries_of
from optlaws.lazy import imported
from optlaws.numbers import listed
from optlaws.numerics.exact import rounded_down, rounded_up
from optlaws.synthesis.problem.constants import FUNCTIONALS
from optlaws.tolerances import STORED_VALUE
from optlaws.verification.enclosing.balls import enclosed
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.file_entries import kind_of
from optlaws.verification.result import (
    Claim,
    Data,
    Verification,
    at_most,
    built,
    differences,
    every_claim,
    near,
    number,
    recomputed,
    with_claims,
)
from optlaws.verification.stated_solutions import solution

_MOST = 1000  # rows of a list
#: of a cam under limits that are not linear in its laws
_BOUNDING = "bounding_solutions"
_SOUGHT = 1e-7  # of a number: where searches end, each within 1e-9 of a time; a tenth of what the proofs leave
_NOUGHT = 1e-6  # of what is about 1: numbers that are less are compared with it
_NUMBERS = re.compile(r"((?<![\w.])\d+(?:\.\d+)?(?:e[-+]?\d+)?)")


def plan(data: Data) -> Verification:
    """Check the solutions of a plan, each by itself, that they are those of its cycle, and its numbers."""
    rows, entries = _solutions(data), _plan_of(data)
    others = {name: value for name, value in data.items() if name not in {*entries, "about"}}
    return of_cycle(lambda: imported("optlaws.cycles.cycle").Plan.from_dict(entries), lambda _: rows(), others)


def cam(data: Data) -> Verification:
    """Check the solutions of the laws of a cam, each by itself, and the numbers of the cam that has these laws."""
    known, claims, of_bounds = _solutions(data)(), list[Claim](), list[Claim]()
    bounding = _solutions(data, _BOUNDING)() if _BOUNDING in data else {}
    try:
        result = imported("optlaws.jobs.cam").stored(data)
        stated = {
            name: value
            for name, value in _renamed(data).items()
            if name not in {"about", "unit", "cam", "solutions", _BOUNDING}
        }
        wrong = result.plan.contradiction()
        # under the limits of the cam, which the laws by themselves do not have
        status = (result.data.get("laws") or {}).get("status", result.plan.status.value)
        detail = wrong or f"they meet its joints and keep its limits, in doubles; status {status}"
        claims = [recomputed("the laws of the motion", detail, wrong)]
        for name in getattr(result, "of_laws", ()):  # a barrel states none
            if name == "laws" or result.minimises_over_cycle:
                weaker = "" if result.bounds_hold else _CURVED if result.minimises_over_cycle else _FURTHER
                bounds = [each.bound for each in (bounding or known).values()]
                proven = _objective_of_laws(result.plan, list(known.values()), stated.get(name) or {}, weaker, bounds)
                of_bounds += [replace(claim, name=f"{name}.{claim.name}") for claim in proven]
        claims += _numbers(stated, result.data, of_bounds)
        entries = {*data, *stated}
        for name in (name for name, value in result.data.items() if value is not None and name not in entries):
            detail = "the file does not state it, though the page of such a cam does"
            claims.append(Claim(name, proven=False, detail=detail, checked=False))
    except OptlawsError as error:
        claims = [_unread("the cam", error, known)]
    parts = {**known, **bounding}.items()
    every = [claim for place, each in parts for claim in every_claim(each, f"{place}: ")]
    return with_claims(Verification(), [*every, *claims])


#: what the numbers of a cam were called in earlier files
_EARLIER = {"bulging_radius": "convex_radius", "hollow_radius": "concave_radius"}
_ANGLES = {"least_pressure_angle": "least", "largest_pressure_angle": "greatest"}


def _renamed(data: Data) -> dict[str, Any]:
    """The numbers of a cam by the names of today."""
    known = {_EARLIER.get(name, name): value for name, value in data.items() if name not in _ANGLES}
    angles = {name: data[earlier] for earlier, name in _ANGLES.items() if earlier in data}
    known |= {"pressure_angles": angles} if angles else {}
    return known | ({"return_cam": _renamed(known["return_cam"])} if "return_cam" in known else {})


def _solutions(data: Data, name: str = "solutions") -> Callable[[], dict[str, Verification]]:
    """The solutions of a plan or a cam by their places, which are verified when it is called."""
    rows = {f"{name}[{i}]": each for i, each in enumerate(listed(data[name], name, _MOST))}
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
    solved, unread, wrong, detail, numbers = None, None, "", "", list[Claim]()
    try:
        solved = read()
        wrong = solved.solve().contradiction()
        detail = wrong or f"they meet its joints and keep its limits, in doubles; status {solved.status.value}"
    except OptlawsError as error:
        unread = error
    known = parts(solved)
    if stated and solved is not None:
        weaker = "" if solved.of_its_problems() else _FURTHER
        proven = list(_objective_of_laws(solved, list(known.values()), stated, weaker))
        numbers = list(_numbers(stated, solved.report().stored, proven))
    every = [claim for place, each in known.items() for claim in every_claim(each, f"{place}: ")]
    name = "the laws of the cycle"
    claim = _unread(name, unread, known) if unread else recomputed(name, detail, wrong)
    return with_claims(Verification(), [*every, claim, *numbers])


def _unread(name: str, error: OptlawsError, known: Mapping[str, Verification]) -> Claim:
    """The claim of what cannot be read: not checked where that is because of a solution which is not proven."""
    false = [place for place, each in known.items() if not each.proven]
    detail = f"not compared before {', '.join(false)} can be proven" if false else str(error)
    return Claim(name, proven=False, detail=detail, checked=not false)


_OTHERWISE = "which is computed again in doubles, from more than the certificates of its laws"
#: why bounds of laws are none of the cycle's
_CURVED = "of laws under limits of the cam that are not linear in them"
_FURTHER = "of laws with further constraints than the cycle's, such as a part of a limit that they share"

#: the constant of a law by the order of its derivative, as a peak and as a root mean square
_CONSTANTS = {1: ("B", ""), 2: ("C", "rms_c"), 3: ("J", "rms_j"), 4: ("snap", "rms_snap")}


class _Share(NamedTuple):
    """What a law of a cycle has of its objective: below, above, and what no law of its problem is below; SI units."""

    duration: float
    ends: tuple[Fraction, ...] | None
    least: Fraction | None


def _objective_of_laws(
    plan: Any,
    known: Sequence[Verification],
    stated: Data,
    weaker: str = "",
    of_others: Sequence[float | None] | None = None,
) -> Iterator[Claim]:
    """The claims of the objective and the lower bound of a cycle in SI units, by the enclosed constants of its laws.

    Bounds are those of the solutions or of others of the same motions, unless these are of problems with further
    constraints: `weaker` says so.
    """
    objective = plan.specification.in_si
    bounds = [each.bound for each in known] if of_others is None else of_others
    bounds = [None if weaker or plan.bound is not None else bound for bound in bounds]
    shares = None if stated.get("objective") is None else _shares(plan, known, bounds)
    proven = None
    if shares is not None:
        total = partial(_total, shares, plan.duration, objective)
        if all(share.ends is not None for share in shares):
            claim = near("objective", number(stated, "objective"), (total(0, -inf), total(1, inf)), 0.0)
            # what is of a drive is computed again in doubles where no law determines it alone
            yield from [claim] if claim.proven or objective.kind.order else []
        known_of_all = all(share.least is not None for share in shares)
        proven = Fraction(total(None, -inf)) if known_of_all else None
    if stated.get("lower_bound") is None:
        return
    bound = number(stated, "lower_bound")
    claim = at_most("lower_bound", bound, proven, 0.0)
    if plan.bound is not None and not claim.proven:
        yield _sought_again(plan, bound)
        return
    why = weaker or ("" if proven and objective.kind.order else _OTHERWISE)
    if why and not claim.proven:
        above = plan.objective * (1.0 + STORED_VALUE) < bound
        detail = f"{bound!r} stated, {why}"
        # of what is computed again, a bound that differs has a claim among the numbers
        again = why is _OTHERWISE and not above
        claim = Claim("lower_bound", proven=False, detail=detail, checked=above, recomputed=again)
    yield claim


def _sought_again(plan: Any, bound: float) -> Claim:
    """The claim of a bound of laws that share a limit or were selected, which no certificate of one of them proves."""
    try:
        second = plan.specification.solve().lower_bound
    except OptlawsError as error:
        return Claim("lower_bound", proven=False, detail=str(error), checked=False)
    detail = f"{bound!r} stated, {second!r} by the same search in doubles, whose multipliers leave no certificate"
    agrees = second is not None and bound <= second * (1.0 + STORED_VALUE)
    return recomputed("lower_bound", detail, "" if agrees else detail)


def least_period(fastest: Any) -> Verification:
    """Check that the least times and the problems of the proofs are those of the cycle, by the same search."""
    name = "the motions of the proofs"
    try:
        again = fastest.specification.fastest()
    except OptlawsError as error:
        return with_claims(Verification(), [Claim(name, proven=False, detail=str(error), checked=False)])
    stated, second = map(_sought, (fastest, again))
    wrong = [
        f"{key} {shortened(value)} stated, {shortened(second.get(key))} by the same search in doubles"
        for key, value in stated.items()
        if not _alike(value, second.get(key))
    ]
    detail = "they are those of the cycle, in a millionth less than their times, by the same search in doubles"
    return with_claims(Verification(), [recomputed(name, detail, "; ".join(wrong))])


def _sought(fastest: Any) -> Data:
    """What a search for the least period finds: times, and the problems that have no laws in a little less."""
    known = {name: value for name, value in fastest.to_dict().items() if name not in {"given", "cycle", "proofs"}}
    return known | {name: proof.problem.to_dict() for name, proof in fastest.proofs.items()}


def _alike(*data: Any) -> bool:
    """Whether data are the same, their numbers, also those in formulas, but for where a search for a time may end."""
    first, second = (_NUMBERS.split(json.dumps(value)) for value in data)
    if first[::2] != second[::2]:
        return False
    pairs = zip(map(float, first[1::2]), map(float, second[1::2]), strict=True)
    return all(abs(each - other) <= _SOUGHT * max(abs(each), abs(other), _NOUGHT) for each, other in pairs)


def _total(shares: Sequence[_Share], period: float, objective: Any, end: int | None, side: float) -> float:
    """An objective of an end of all shares, or of what no law is below, rounded to a side."""
    every = [share.least if end is None or share.ends is None else share.ends[end] for share in shares]
    sizes = [(Fraction(share.duration), size or Fraction(0)) for share, size in zip(shares, every, strict=True)]
    if objective.mean:
        square = sum((time * size**2 for time, size in sizes), Fraction(0)) / Fraction(period)
        return nextafter(sqrt(rounded_up(square) if side > 0.0 else rounded_down(square)), side)
    summed = objective.kind.name in {"ENERGY", "HEAT"}
    total = sum((size for _, size in sizes), Fraction(0)) if summed else max(size for _, size in sizes)
    return rounded_up(total) if side > 0.0 else rounded_down(total)


def _shares(plan: Any, known: Sequence[Verification], bounds: Sequence[float | None]) -> list[_Share] | None:
    """What each law of a cycle has of its objective; None where that is not known of one of them."""
    objective = plan.specification.in_si
    if objective.of_load:
        return None
    values = imported("optlaws.cycles.optimisation.span_values")
    shares = list[_Share]()
    for (span, piece, solved), each, bound in zip(plan.laws, known, bounds, strict=True):
        value = values.span_value(span, objective.drive, objective.kind, mean=objective.mean)
        minimised = solved.problem.minimise == replace(solved.problem, minimise=value.objective).minimise
        if objective.kind.order:
            ends = _of_derivative(piece, objective)
        elif not values.is_exact(span, objective) or len(value.constants) > 1:
            ends = None
        elif minimised:
            ends = None if each.objective is None else _quantity(value, each.objective)
        else:
            ends = _quantity(value, enclosed(ExactLaw(solved.law).term(value.constants[0])))
        if ends is None:
            return None
        least = None if bound is None or not minimised else _quantity(value, (bound,))
        # a peak or a mean is no less than 0, whatever the law
        shares.append(_Share(piece.duration, ends, least[0] if least else None if value.summed else Fraction(0)))
    for piece in plan.specification.layout.pieces:
        ends = (_of_derivative if objective.kind.order else _at_rest)(piece, objective)
        if ends is None and objective.kind.name != "FORCE":
            return None
        shares.append(_Share(piece.duration, ends, ends[0] if ends else Fraction(0)))
    return shares


def _quantity(value: Any, ends: Sequence[float]) -> tuple[Fraction, ...] | None:
    """Dimensionless numbers in SI units; None where friction adds to a mean what depends on the way, or one is inf."""
    if inf in ends or (value.constant and not value.summed):
        return None
    return tuple(Fraction(value.unit) * Fraction(end) + Fraction(value.constant) for end in ends)


def _of_derivative(piece: Any, objective: Any) -> tuple[Fraction, ...] | None:
    """Below and above a derivative of a law; None where it jumps."""
    nu = objective.kind.order
    unit = abs(Fraction(piece.stroke)) / Fraction(piece.duration) ** nu
    constant = FUNCTIONALS[_CONSTANTS[nu][objective.mean]]
    low, high = enclosed(ExactLaw(piece.law).term(constant)) if unit else (0.0, 0.0)
    return None if high == inf else (unit * Fraction(low), unit * Fraction(high))


def _at_rest(piece: Any, objective: Any) -> tuple[Fraction, ...] | None:
    """Below and above what a dwell has of an objective of the drive; None where its force is no line, or in motion."""
    if piece.stroke:
        return None
    if objective.kind.name in {"POWER", "ENERGY"}:
        return Fraction(0), Fraction(0)
    linear = objective.drive.linear
    if objective.kind.name != "FORCE" or linear is None:
        return None
    resting = abs(Fraction(linear.constant) + Fraction(linear.stiffness) * Fraction(piece.offset))
    return resting, resting


def _numbers(stated: Data, known: Data, apart: Sequence[Claim] = ()) -> Iterator[Claim]:
    """The claims of numbers beside laws: those that differ from what the laws have, and what is only computed again.

    A number that has a claim of its own, of those `apart`, has no second one.
    """
    wrong = {claim.name: claim for claim in differences(*_by_name(stated, known), "")}
    refuted = {claim.name for claim in apart if claim.checked and not claim.proven}
    yield from (claim for claim in apart if claim.name in refuted or claim.name not in wrong)
    yield from (claim for name, claim in wrong.items() if name not in refuted)
    named = {claim.name for claim in apart}
    names = ", ".join(name for name, value in stated.items() if value is not None and name not in named)
    if names and not wrong:
        yield recomputed("the numbers", f"computed again in doubles, they agree: {names}")


def _by_name(stated: Data, known: Data) -> tuple[Data, Data]:
    """Both with the values beside the usual law by their names, of which earlier files have fewer."""
    rows = []
    for data in (stated, known):
        beside = data.get("usual_law")
        given = beside.get("values") if isinstance(beside, Mapping) else None
        rows.append({str(row.get("name")): row for row in listed(given or [], "usual_law.values", _MOST)})
        if len(rows[-1]) != len(given or []):
            return stated, known
    if not rows[0] or not rows[0].keys() <= rows[1].keys():
        return stated, known
    first, second = (
        {**data, "usual_law": {**data["usual_law"], "values": values}}
        for data, values in zip((stated, known), rows, strict=True)
    )
    return first, second


def axes(data: Data) -> Verification:
    """Check what is stated beside the axes of a machine: interlocks, overlap, run-ins and run-outs."""
    try:
        claims = list(_together(data))
    except OptlawsError as error:
        claims = [Claim("the axes together", proven=False, detail=str(error))]
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
    for name, row in (data.get("transitions") or {}).items():
        yield from _transition(f"transitions.{name}", row, plans)


def _transition(name: str, row: Data, plans: Mapping[str, Any]) -> Iterator[Claim]:
    """The claims of the numbers of a run-in or run-out, and that it meets the motion of its axis."""
    if row.get("cam") is None:
        # as earlier files have it
        yield Claim(name, proven=False, detail="its law and its proof are in transitions.json", checked=False)
        return
    cam = imported("optlaws.cycles.transitions").TransitionCam.from_dict(row["cam"])
    numbers = {key: value for key, value in row.items() if key not in {"axis", "cam"}}
    wrong = [replace(claim, name=f"{name}.{claim.name}") for claim in differences(numbers, cam.report().data, "")]
    plan = plans.get(row.get("axis", ""))
    missed = f"no axis is called {row.get('axis')!r}" if plan is None else cam.contradiction(plan)
    detail = f"it meets its axis, and its numbers agree, in doubles; status {cam.status.value}"
    yield from wrong
    if missed or not wrong:
        yield recomputed(name, detail, missed)


def overlap_of_axes(data: Data) -> Verification:
    """Check the objective, the interlocks and the bound of axes that overlap, all computed again from the machine."""
    overlap = built(imported("optlaws.cycles.axes.machine_axes").Overlap.stated, data, "the axes that overlap")
    return with_claims(Verification(), _overlap_claims(overlap))


def _overlap_claims(overlap: Any) -> Iterator[Claim]:
    wrong = built(lambda stated: stated.contradiction(), overlap, "the axes that overlap")
    detail = wrong or f"{overlap.objective!r} stated, which its axes have within their limits, in doubles"
    yield recomputed(f"the {overlap.goal}", detail, wrong)
    if not wrong:
        yield from (*_interlocks(overlap.axes), _bound(overlap), _binding(overlap))


def _interlocks(axes: Any) -> Iterator[Claim]:
    """The claims that interlocks are clear over the whole cycle, by enclosures of the positions."""
    for least in axes.clearances:
        detail = f"{least.status}, {least.text}; {least.bound!r} {least.unit} or more everywhere"
        yield Claim(f"interlock {least.interlock.label}", least.status == "clear", detail, least.status != "open")


def _bound(overlap: Any) -> Claim:
    """The claim that no instants have less than the lower bound, which is computed again."""
    name = "lower bound over all instants"
    try:
        again = overlap.again()
    except OptlawsError as error:
        return Claim(name, proven=False, detail=str(error))
    second = f"{again.lower_bound!r} by the same search in doubles, whose branches leave no certificate"
    detail = f"{overlap.lower_bound!r} stated, {second}"
    low = overlap.lower_bound <= again.lower_bound * (1.0 + STORED_VALUE)
    agrees = low and overlap.objective >= again.lower_bound * (1.0 - STORED_VALUE)
    return recomputed(name, detail, "" if agrees else detail)


def _binding(overlap: Any) -> Claim:
    """The claim that what is named binds and nothing else does, at the instants of the file.

    What leaves about as much as counts as none may be named or not.
    """
    name, stated = "what binds", set(overlap.binding)
    try:
        surely, hardly = (set(overlap.bound_by(share)) for share in (0.5, 2.0))
    except OptlawsError as error:
        return Claim(name, proven=False, detail=str(error))
    named = ", ".join(overlap.binding)
    detail = f"{named}, as the instants have it, in doubles"
    if stated != hardly:
        detail = f"{named} stated; {', '.join(sorted(hardly))} by the instants, in doubles"
    agrees = surely <= stated <= hardly and len(stated) == len(overlap.binding)
    return recomputed(name, detail, "" if agrees else detail)
