"""Claims of a file, one by one, and their verification."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from math import inf
from pathlib import Path
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import entries_of, of_known_format
from optlaws.laws import MotionLaw
from optlaws.mechanisms.linkages.move_limit import MoveLimit
from optlaws.numbers import listed
from optlaws.suggest import unknown_key
from optlaws.synthesis.limits.drive_limits import DriveLimit
from optlaws.synthesis.limits.rounding import rounded_down, rounded_up
from optlaws.synthesis.problem.constants import FUNCTIONALS, present_name
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.proof.data import problem_of
from optlaws.synthesis.proven.front import ProvenFront
from optlaws.synthesis.status import measure
from optlaws.synthesis.stored_solutions import read_solutions
from optlaws.tolerances import CORRECTED_MULTIPLIER, OPTIMALITY_GAP
from optlaws.verification.conditions import excesses
from optlaws.verification.enclosing.balls import enclosed
from optlaws.verification.exact.bound import Proof, prove
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.exact.sublevel_bounds import exact_limit
from optlaws.verification.file_entries import (
    NO_FILE,
    FileEntry,
    check_keys,
    entries,
    is_array,
    is_drive_limit,
    is_entry,
    is_least_time,
    is_move_limit,
    is_overlap,
    is_proven_front,
    is_time_front,
)
from optlaws.verification.fronts_and_times import least_time, overlap_of_axes, proven_front, time_front
from optlaws.verification.reading import built, number, read
from optlaws.verification.result import Claim, Verification
from optlaws.verification.stated_numbers import at_most, near, stated_constants, stated_numbers

_NEGATIVE_MULTIPLIER = 1e-9  # of the greatest multiplier: one so little below 0 is none

#: where further certificates of a solution are
_MOST_POINTS = 1000
_BESIDE = ("power_certificate", "peak_certificate")


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
    return built(_entry, FileEntry(data), "the file")


def verify_all(source: Mapping[str, Any] | Path | str) -> dict[str, Verification]:
    """Check every solution, certificate and law with constants, by where it is; refuse whatever else is claimed."""
    claimed = entries(read(source))
    if not claimed:
        raise InputError(f"{NO_FILE}: nothing in it is a solution, a certificate or a law with its constants")
    return {path: built(_entry, entry, path or "the file") for path, entry in claimed.items()}


def _entry(entry: FileEntry) -> Verification:
    if not entry.data:
        claim = Claim(f"{entry.around.status}", proven=False, detail="no certificate stands beside it")
        return Verification(problem=None, bound=None, claims=(claim,))
    check_keys(entry.data)
    alone = _alone(entry.data)
    return replace(alone, claims=(*alone.claims, *claims_in_context(entry, alone)))


def _alone(data: Mapping[str, Any]) -> Verification:
    return next(verified for known, verified in _KINDS if known(data))(data)


def _front(data: Mapping[str, Any]) -> Verification:
    return proven_front(built(ProvenFront.from_dict, data, "the proven front"), number(data, "gap"))


def _least_time(data: Mapping[str, Any]) -> Verification:
    return least_time(data, _solution(data["solution"]))


def _time_front(data: Mapping[str, Any]) -> Verification:
    check_keys(data["fastest"])
    points = listed(data["points"], "points", _MOST_POINTS)
    solutions = [
        _solution(entries_of(point, ["solution"], f"points[{i}]")["solution"]) for i, point in enumerate(points)
    ]
    return time_front(data, _least_time(data["fastest"]), solutions)


def _law_alone(data: Mapping[str, Any]) -> Verification:
    law = _law(data)
    return Verification(problem=None, bound=None, constants=law.enclosures(), claims=tuple(stated_constants(data, law)))


def _certificate(data: Mapping[str, Any]) -> Verification:
    certificate = built(Certificate.from_dict, data, "the certificate")
    proof = prove(certificate)
    return _verification(certificate.problem, certificate, proof, list(_proof_claims(proof, certificate, data)))


def _arrays(data: Mapping[str, Any]) -> Verification:
    """Claims of a stored array: its arrays must agree with its solutions, which are verified one by one."""
    try:
        read_solutions(data)
    except InputError as error:
        claim = Claim("the arrays", proven=False, detail=str(error))
        return Verification(problem=None, bound=None, claims=(claim,))
    detail = "their problems, laws, bounds and proofs are those of the solutions"
    claim = Claim("the arrays", proven=False, detail=detail, checked=False)
    return Verification(problem=None, bound=None, unchecked=(claim,))


def _limit_of_drive(data: Mapping[str, Any]) -> Verification:
    """A limit of drives, whose bound is computed again from its potential; in SI units by the unit of its move."""
    claims, unit = [], Fraction(1)
    if is_drive_limit(data):
        limit = built(DriveLimit.stated, data, "the drive's limit")
    else:
        moved, wrong = built(MoveLimit.stated, data, "the limit of a move")
        limit, unit = moved.drive_limit, Fraction(moved.unit)
        detail = wrong or f"{moved.unit!r} {moved.dimension}, computed again from the drive and the move"
        claims.append(Claim("the move and its unit", not wrong, detail))
    wrong = built(lambda stated: stated.contradiction(), limit, "the drive's limit")
    detail = f"{limit.value!r} stated, {limit.bound!r} proven by the phase plane; {limit.attained!r} attained"
    claims.append(Claim("the drive's limit", not wrong, wrong or detail))
    bound = None if any(not claim.proven for claim in claims) or limit.bound == -inf else Fraction(limit.bound) * unit
    return Verification(problem=None, bound=None if bound is None else rounded_down(bound), claims=tuple(claims))


def _law(data: Mapping[str, Any]) -> ExactLaw:
    return built(lambda entry: ExactLaw(MotionLaw.from_dict(entry)), data["law"], "law")


def _solution(data: Mapping[str, Any]) -> Verification:
    beside = [key for key in _BESIDE if data.get(key) is not None]
    for name in ("problem", "law", "certificate", *beside):
        if not isinstance(data[name], Mapping):
            raise InputError(f"{name} must be an object, got {shortened(data[name])}")
    problem = built(Problem.from_dict, data["problem"], "problem")
    law = _law(data)
    proofs = {}
    for key in ("certificate", *beside):
        certificate = built(Certificate.from_dict, data[key], _name(key))
        if certificate.program == VIOLATION:
            raise InputError("a proof that no law exists beside a law: verify the certificate alone")
        proofs[key] = certificate, prove(certificate)
    objective = enclosed(law.sum(problem.objective))
    drive = None if data.get("drive_limit") is None else built(DriveLimit.from_dict, data["drive_limit"], "drive_limit")
    bound, source = _best(problem, proofs, drive)
    gap = None
    if bound is not None and objective[1] < inf:
        size = Fraction(measure(objective[1], problem.objective.scale))
        gap = rounded_up((Fraction(objective[1]) - bound) / size)
    constants = law.enclosures()
    conditions = excesses(problem, law)
    claims = [
        *(
            Claim(e.name, e.holds, f"off by at most {max(e.by, 0.0):.1e}, {e.allowed:.1e} is allowed")
            for e in conditions
        ),
        *stated_numbers(data, problem, law, objective),
        *stated_constants(data, law),
    ]
    for key, (certificate, proof) in proofs.items():
        same = certificate.problem == problem
        detail = "the file's" if same else f"another: {certificate.problem!r}"
        claims.append(Claim(f"{_name(key)}'s problem", same, detail))
        accurate = data.get("status") != "inaccurate"
        claims += _proof_claims(proof, certificate, data[key], _name(key), accurate=accurate)
    if drive is not None:
        same = drive.is_of(problem)
        claims.append(Claim("the drive's limit", same, "of the file's problem" if same else "of another problem"))
    if data.get("lower_bound") is not None:
        scale = problem.objective.scale
        claims.append(at_most("the lower bound", number(data, "lower_bound"), bound, scale, source))
    claims += _of_gap(data, gap, _over(data, bound, objective[1], problem))
    return _verification(
        problem,
        *proofs["certificate"],
        claims,
        bound=None if bound is None else rounded_down(bound),
        objective=objective,
        gap=gap,
        constants=constants,
        excesses={condition.name: condition.by for condition in conditions},
    )


def _name(key: str) -> str:
    return f"the {key.replace('_', ' ')}"


def _best(
    problem: Problem, proofs: Mapping[str, tuple[Certificate, Proof]], drive: DriveLimit | None
) -> tuple[Fraction | None, str]:
    """The highest bound that is proven of the problem, and by what if not by its first certificate."""
    known = [
        (proof.value, f" by {_name(key)}" if key in _BESIDE else "")
        for key, (certificate, proof) in proofs.items()
        if certificate.problem == problem and proof.value is not None
    ]
    if drive is not None and drive.is_of(problem):
        known.append((Fraction(drive.bound), " by the phase plane"))
    limit = exact_limit(problem)
    if limit is not None:
        known.append((limit, " by the limit of laws of any degree"))
    return max(known, key=lambda bound: bound[0], default=(None, ""))


def _verification(
    problem: Problem,
    certificate: Certificate,
    proof: Proof,
    claims: list[Claim],
    **known: Any,
) -> Verification:
    contradiction = certificate.program == VIOLATION
    known.setdefault("bound", None if contradiction or proof.value is None else rounded_down(proof.value))
    return Verification(
        problem=problem,
        infeasible=contradiction and proof.value is not None and proof.value > 0,
        charge=proof.charge,
        claims=tuple(claim for claim in claims if claim.checked),
        unchecked=tuple(claim for claim in claims if not claim.checked),
        **known,
    )


def _proof_claims(
    proof: Proof,
    certificate: Certificate,
    data: Mapping[str, Any],
    name: str = "the certificate",
    *,
    accurate: bool = True,
) -> Iterator[Claim]:
    """Claims of a certificate: the claims of its leaves, and its bound."""
    if certificate.peak:
        verdict = "holds" if certificate.proven else "does not hold"
        unchecked = "proofs over the places of a peak are not checked in exact arithmetic yet"
        yield Claim(name, proven=False, detail=f"it {verdict} in double precision; {unchecked}")
        return
    if certificate.points is None:
        yield from _leaf_claims(proof, certificate, accurate=accurate)
    else:
        left = "no law has" if proof.value is not None else "the steps do not show that no law has"
        yield Claim("steps", proof.value is not None, f"{left} an objective below {certificate.claim!r}")
    if certificate.program == VIOLATION:
        value = float(proof.value or 0)
        yield Claim("no law exists", value > 0.0, f"the constraints contradict each other by {value:.6g}")
    elif data.get("bound") is not None:
        scale = certificate.problem.objective.scale
        yield at_most(f"{name}'s bound", number(data, "bound"), proof.value, scale)


def _leaf_claims(proof: Proof, certificate: Certificate, *, accurate: bool) -> Iterator[Claim]:
    count = len(certificate.contacts)
    greatest = max((abs(contact.multiplier) for contact in certificate.contacts), default=0.0)
    negative = [contact for contact in certificate.contacts if contact.multiplier < -_NEGATIVE_MULTIPLIER * greatest]
    shown = f"{len(negative)} of {count} negative" if negative else f"{count}, none negative"
    yield Claim("multipliers", not negative, shown)
    if proof.unknown:
        detail = f"{proof.unknown} of {count} are not of constraints that this problem has"
        yield Claim("contacts", proven=False, detail=detail)
    detail = f"corrected by at most {proof.correction:.1e} of the greatest so that nothing depends on the law"
    if not proof.by_rows:
        detail = "not needed: what is minimised is never below the bound"
    small = proof.correction <= CORRECTED_MULTIPLIER or not accurate
    yield Claim("sum of the rows", proof.value is not None and small, detail)


def _over(data: Mapping[str, Any], bound: Fraction | None, highest: float, problem: Problem) -> float:
    """By how much the stated bound is above the proven one, in the measure of gaps; less than 0 where it is below."""
    if data.get("lower_bound") is None or bound is None or highest == inf:
        return 0.0
    size = measure(highest, problem.objective.scale)
    return float((Fraction(number(data, "lower_bound")) - bound) / Fraction(size))


def _of_gap(data: Mapping[str, Any], gap: float | None, over: float) -> Iterator[Claim]:
    """Claims of gap and status; `over` is how far the stated bound, another claim, is above the proven."""
    if data.get("gap") is not None:
        value = number(data, "gap")
        holds = gap is not None and value >= gap - max(over, 0.0) - OPTIMALITY_GAP
        yield Claim("the gap", holds, f"{value:.1e} stated, {_shown(gap)} proven")
    if data.get("status") == "optimal":
        yield Claim("optimal", gap is not None and gap <= OPTIMALITY_GAP, f"the proven gap is {_shown(gap)}")
    elif data.get("status") is not None:
        # what is as good as optimal is called so, unless doubles prove less
        far = gap is None or gap - min(over, 0.0) > OPTIMALITY_GAP / 2.0
        yield Claim("the status", far, f"{data['status']!r} stated, the proven gap is {_shown(gap)}")


def _shown(gap: float | None) -> str:
    return "not known" if gap is None else f"{gap:.1e}"


def claims_in_context(entry: FileEntry, verification: Verification) -> Iterator[Claim]:
    """Status, problem, peak velocity and constants that stand around an entry, as claims."""
    around, problem = entry.around, verification.problem
    if around.status is not None:
        inside = "infeasible" if _no_law(verification, around.above) else entry.data.get("status")
        yield Claim("the row's status", inside == around.status, f"{around.status!r} stated, {inside!r} inside")
    if around.problem is not None:
        stated = problem_of(around.problem)
        yield Claim("the row's problem", stated == problem, f"{stated!r}")
    if around.B is not None and problem is not None:
        yield Claim("the row's B", around.B == problem.B, f"{around.B!r} stated, {problem.B!r} in the problem")
    yield from _constants(entry)


def _no_law(verification: Verification, above: float | None) -> bool:
    """Whether no law exists: the constraints contradict each other, or a least value exceeds its bound."""
    bound = verification.bound
    return verification.infeasible or (above is not None and bound is not None and bound > above)


def _constants(entry: FileEntry) -> Iterator[Claim]:
    if not entry.around.values:
        return
    if "law" not in entry.data:
        raise InputError("values of a front claim something of a point without a law")
    law = _law(entry.data)
    for name, value in entry.around.values.items():
        constant = FUNCTIONALS.get(present_name(name))
        if constant is None:
            raise InputError(unknown_key(name, FUNCTIONALS, "constant"))
        yield near(f"the front's {name}", value, enclosed(law.term(constant)))


#: what an entry is, and how it is verified; the first that fits
_KINDS: tuple[tuple[Callable[[Mapping[str, Any]], bool], Callable[[Mapping[str, Any]], Verification]], ...] = (
    (is_array, _arrays),
    (is_proven_front, _front),
    (is_drive_limit, _limit_of_drive),
    (is_move_limit, _limit_of_drive),
    (is_least_time, _least_time),
    (is_time_front, _time_front),
    (is_overlap, overlap_of_axes),
    (lambda data: "certificate" in data, _solution),
    (lambda data: "law" in data, _law_alone),
    (lambda _: True, _certificate),
)
