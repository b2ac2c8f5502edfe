"""What files hold: solutions and certificates, fronts, least times, plans and cams, claim by claim."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple

from optlaws.echo import unknown_key
from optlaws.errors import InputError
from optlaws.files.reading import check_names, entries_of, of_known_format
from optlaws.lazy import imported
from optlaws.numbers import listed, real
from optlaws.numerics.exact import rounded_up
from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.synthesis.least_time.timed_move import MoveObjective, TimedMove
from optlaws.synthesis.problem.constants import FUNCTIONALS, meant, present_name
from optlaws.synthesis.proof.data import problem_of
from optlaws.synthesis.proven.front import FrontPoint, ProvenFront
from optlaws.synthesis.proven.swept_parameter import SweptParameter
from optlaws.tolerances import BOUND_FEASIBILITY, NO_OBJECTIVE, STORED_VALUE
from optlaws.verification.conditions import Excess, excesses
from optlaws.verification.enclosing.balls import enclosed
from optlaws.verification.exact.bound import Along, Proof, least_time_of_any_law, prove
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.file_entries import NO_FILE, FileEntry, entries, is_entry, kind_of
from optlaws.verification.machine_results import axes, cam, least_period, of_cycle, overlap_of_axes, plan
from optlaws.verification.result import (
    Claim,
    Data,
    Verification,
    built,
    compare,
    every_claim,
    near,
    number,
    read,
    with_claims,
)
from optlaws.verification.stated_solutions import (
    arrays,
    certificate,
    drive_limit,
    exact_law,
    law_alone,
    move_limit,
    solution,
    stated_bound,
)

_STATED_GAP = 1e-12  # by how much a gap that was computed in doubles may be below the proven one
_MOST_POINTS = 1000


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
    if not entry.values:
        return
    if "law" not in entry.data:
        raise InputError("values of a front claim something of a point without a law")
    law = exact_law(entry.data["law"])
    for name, value in entry.values.items():
        constant = FUNCTIONALS.get(present_name(name))
        if constant is None:
            raise InputError(unknown_key(name, FUNCTIONALS, "constant"))
        yield near(f"the front's {name}", value, enclosed(law.term(constant)))


class _Known(NamedTuple):
    """Proven data of one certified law: bounds of the least objective, their slopes, and violations."""

    at: Fraction
    top: Fraction
    top_slope: Fraction
    proof: Proof
    excesses: list[Excess]


def _proven_front(data: Data) -> Verification:
    """Check every law and certificate of a front, and its gap at every value between."""
    front, stated = built(ProvenFront.from_dict, data, "the proven front"), number(data, "gap")
    swept, (low, high) = front.number, front.between
    known = [_known(front, point) for point in front]
    gaps = [_between(point, other, swept) for point, other in pairwise(known)]
    gap = None if None in gaps else rounded_up(max(gap for gap in gaps if gap is not None))
    shown = "not known" if gap is None else f"{gap:.3e}"
    claims = (
        _laws(swept, known),
        _certificates(swept, known),
        Claim(
            f"the gap at every {swept.name} from {low!r} to {high!r}",
            gap is not None and gap <= stated + _STATED_GAP,
            f"{stated:.3e} stated, {shown} proven",
        ),
    )
    return Verification(problem=swept.at(low), gap=gap, claims=claims)


def _known(front: ProvenFront, point: FrontPoint) -> _Known:
    """What is proven of a law; the bound of one problem is a bound of others along the front."""
    swept, (low, high), law = front.number, front.between, ExactLaw(point.law)
    top = Fraction(enclosed(law.sum(point.problem.objective))[1])
    slope = Fraction(enclosed(law.term(swept.weighted))[1]) if swept.concave else Fraction(0)
    claim, other = 2.0 * float(front.sides[:, 0].max()), high if point.value < high else low
    if swept.concave:
        along = Along(None, Fraction(1), swept.at(low), claim)
    else:
        along = Along(swept.at(other), Fraction(other) - Fraction(point.value), swept.at(high), claim)
    proof = prove(point.certificate, along)
    return _Known(Fraction(point.value), top, slope, proof, excesses(point.problem, law))


def _laws(swept: SweptParameter, known: list[_Known]) -> Claim:
    wrong = [(point, excess) for point in known for excess in point.excesses if not excess.holds]
    if not wrong:
        worst = max((excess.by for point in known for excess in point.excesses), default=0.0)
        detail = f"{len(known)} meet every condition, greatest deviation {max(worst, 0.0):.1e}"
        return Claim("laws", proven=True, detail=detail)
    point, excess = wrong[0]
    broken = len({point.at for point, _ in wrong})
    first = f"{excess.name} is violated by {excess.by:.1e} at {swept.name} = {float(point.at)!r}"
    return Claim("laws", proven=False, detail=f"{broken} of {len(known)} break conditions: {first}")


def _certificates(swept: SweptParameter, known: list[_Known]) -> Claim:
    wrong = [point for point in known if point.proof.value is None or point.proof.negative or point.proof.unknown]
    charge = max(point.proof.charge for point in known)
    detail = f"{len(known)} prove a bound, less {charge:.1e} at most for what depends on the law"
    if wrong:
        first = f"the first at {swept.name} = {float(wrong[0].at)!r}"
        detail = f"{len(wrong)} of {len(known)} prove nothing or have contacts that do not count, {first}"
    return Claim("certificates", not wrong, detail)


def _between(point: _Known, other: _Known, swept: SweptParameter) -> Fraction | None:
    """The greatest gap of any value between, relative as of a solution.

    It is the difference of a chord and two lines, each an affine function: at the ends or where they cross.
    """
    if point.proof.value is None or other.proof.value is None:
        return None
    width = other.at - point.at
    if swept.concave:
        differences = [
            (point.top - point.proof.value, point.top + point.top_slope * width - other.proof.value),
            (other.top - other.top_slope * width - point.proof.value, other.top - other.proof.value),
        ]
    else:
        rise, fall = point.proof.slope[0] * width, other.proof.slope[1] * width
        differences = [
            (point.top - point.proof.value, other.top - point.proof.value - rise),
            (point.top - other.proof.value + fall, other.top - other.proof.value),
        ]
    (first, last), (second, end) = differences
    turn = (last - first) - (end - second)
    shares = [Fraction(0), Fraction(1), *([(second - first) / turn] if turn else [])]
    gaps = [min(first + (last - first) * s, second + (end - second) * s) for s in shares if 0 <= s <= 1]
    least = min(point.top, other.top)
    scale = Fraction(swept.problem.objective.scale)
    return max(gaps) / (least if least > Fraction(NO_OBJECTIVE) * scale else scale)


def _least_time(data: Data) -> Verification:
    """Check the time, the limits that its law keeps and the proofs."""
    least, of_law = _stated(data), solution(data["solution"])
    claims = [*every_claim(of_law), *_limits(least), *_proofs(least, data), *_limit(least, data)]
    return with_claims(of_law, claims)


def _stated(data: Data) -> LeastTime[TimedMove]:
    check_names([data["unit"]] if "unit" in data else (), ("m", "rad"), "unit")
    stated = {key: value for key, value in data.items() if key not in {"unit", "about"}}
    return built(LeastTime.from_dict, stated, "the least time")


def _limits(least: LeastTime[TimedMove]) -> Iterator[Claim]:
    """The claim that the law satisfies every limit in the time, in the units of the file."""
    law = ExactLaw(least.law)
    for limit in least.move.limits_in(least.duration):
        used = Fraction(enclosed(law.term(limit.constant))[1]) / Fraction(limit.bound)
        holds = used <= 1 + Fraction(BOUND_FEASIBILITY)
        yield Claim(f"the limit of the {limit.name}", holds, f"the law uses {float(used):.9g} of it")
    broken = [excess for excess in excesses(least.move.within(least.duration), law) if not excess.holds]
    detail = "; ".join(f"{excess.name} is violated by {excess.by:.1e}" for excess in broken)
    yield Claim("the law in the least time", not broken, detail or "it keeps every condition of the move")


def _proofs(least: LeastTime[TimedMove], data: Data) -> Iterator[Claim]:
    """The claim that no law satisfies the limits in any shorter time."""
    wrong = least.contradiction
    if wrong:
        yield Claim("the least time", proven=False, detail=wrong)
    for proof, row in zip(least.proofs, data["proofs"], strict=True):
        shown = [prove(certificate) for certificate in proof.certificates(least.move)]
        stands = bool(shown) and all(each.value is not None and each.value > 0 for each in shown)
        times = (
            f"from {proof.shortest:.9g} s to {proof.longest:.9g} s" if proof.shortest else f"up to {proof.longest!r} s"
        )
        how = "the multipliers contradict the limits" if stands else "the multipliers do not contradict the limits"
        yield Claim(f"no law in a time {times}", stands, how)
        if shown:
            yield from stated_bound(shown[0], proof.certificate, row["certificate"], f"the certificate {times}")


def _limit(least: LeastTime[TimedMove], data: Data) -> Iterator[Claim]:
    """The claim that no law of any degree is faster: by the segments, or by a potential of the torque's phase plane.

    A file with another value than these is refused.
    """
    if least.best_possible is None or data["best_possible"] is None:
        return
    stated, move = number(data, "best_possible"), least.move
    known = {"the segments": least_time_of_any_law(move), "the phase plane": move.limit_of_torque}
    how, proven = max(((how, Fraction(each)) for how, each in known.items() if each is not None), key=itemgetter(1))
    holds = Fraction(stated) <= proven * (1 + Fraction(STORED_VALUE))
    # the program that finds the potential may find another one on another machine
    beside = "" if holds else ", as near to it as a conic program in doubles comes"
    detail = f"{stated!r} stated, {float(proven)!r} by {how}{beside}"
    yield Claim("the best possible time", proven=holds, detail=detail, checked=holds)


_KEYS = ("duration", "value", "lower_bound", "solution")


def _time_front(data: Data) -> Verification:
    """Check the least time, each solution, that its law is of the move in its time, and its numbers in SI units."""
    listed_rows = listed(data["points"], "points", _MOST_POINTS)
    rows = [entries_of(row, _KEYS, f"points[{i}]", alone=True) for i, row in enumerate(listed_rows)]
    solutions = [solution(row["solution"]) for row in rows]
    of_least, least = _least_time(data["fastest"]), _stated(data["fastest"])
    objective = built(MoveObjective.from_dict, data["minimise"], "what is least")
    durations = [number(row, "duration") for row in rows]
    ascending = bool(rows) and durations[0] >= least.duration and all(low < high for low, high in pairwise(durations))
    detail = (
        "they ascend, and all are at least the least time" if ascending else "they do not ascend from the least time on"
    )
    claims = [Claim("the times of the points", ascending, detail), *every_claim(of_least)]
    for duration, row, known in zip(durations, rows, solutions, strict=True):
        of_move = with_claims(known, [*every_claim(known), *_point(least, objective, row, known)])
        claims += every_claim(of_move, f"at {duration:.9g} s: ")
    nothing = dict.fromkeys(("minimise", "fastest", "points", "about"))
    return with_claims(of_least, [*claims, *compare(data, nothing, "the time front")])


def _point(least: LeastTime[TimedMove], objective: MoveObjective, row: Data, known: Verification) -> Iterator[Claim]:
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
    holds = low is not None and high is not None and low - little <= value <= high + little
    yield Claim(f"the {objective.name}", holds, f"{float(value)!r} stated, {_shown(high)} at most")
    stated, bound = real(row["lower_bound"]), None if known.bound is None else Fraction(known.bound) / unit
    below = row["lower_bound"] is None or (bound is not None and stated is not None and stated <= bound + little)
    yield Claim(f"no law with less {objective.name}", below, f"{row['lower_bound']!r} stated, {_shown(bound)} proven")


def _shown(value: Fraction | None) -> str:
    return "nothing" if value is None else repr(float(value))


def _fastest_cycle(data: Data) -> Verification:
    stored = imported("optlaws.cycles.fastest_cycle").FastestCycle

    def parts(fastest: Any) -> Mapping[str, Verification]:
        return {} if fastest is None else {**verify_all(fastest.claims()), "the least period": least_period(fastest)}

    return of_cycle(lambda: stored.from_dict(data), parts)


#: how an entry of each kind is verified
_VERIFIED: Mapping[str | None, Callable[[Data], Verification]] = {
    "array": arrays,
    "proven front": _proven_front,
    "drive limit": drive_limit,
    "move limit": move_limit,
    "least time": _least_time,
    "time front": _time_front,
    "axes": axes,
    "cam": cam,
    "overlap": overlap_of_axes,
    "plan": plan,
    "fastest cycle": _fastest_cycle,
    "solution": solution,
    "law": law_alone,
    "certificate": certificate,
}
