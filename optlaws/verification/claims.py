"""Claims of a file, one by one, and their verification."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from math import inf
from pathlib import Path
from typing import Any

from flint import arb, ctx, fmpq, fmpq_poly

from optlaws.echo import shortened, unknown_key
from optlaws.errors import InputError
from optlaws.files.reading import entries_of, of_known_format
from optlaws.laws import MotionLaw
from optlaws.lazy import imported
from optlaws.mechanisms.linkages.move_limit import MoveLimit
from optlaws.numbers import listed, real
from optlaws.synthesis.limits.drive_limits import DriveLimit
from optlaws.synthesis.limits.rounding import rounded_down, rounded_up
from optlaws.synthesis.problem.constants import FUNCTIONALS, present_name
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.proof.data import problem_of
from optlaws.synthesis.proven.front import ProvenFront
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.synthesis.spaces.splines import PiecewiseBasis
from optlaws.synthesis.status import measure
from optlaws.synthesis.stored_solutions import read_solutions
from optlaws.tolerances import COEFFICIENT_ROUNDING, OPTIMALITY_GAP, STATED_BOUND
from optlaws.verification.conditions import excesses
from optlaws.verification.enclosing.balls import at, enclosed, rational
from optlaws.verification.enclosing.taylor_models import between, least_and_greatest
from optlaws.verification.exact.bound import Proof, prove
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.exact.limit import exact_limit
from optlaws.verification.file_entries import NO_FILE, FileEntry, check_keys, entries, is_entry, kind_of
from optlaws.verification.fronts_and_times import least_time, overlap_of_axes, plan_of_cycle, proven_front, time_front
from optlaws.verification.reading import built, number, read
from optlaws.verification.result import Claim, Verification

_STATED_CONSTANT = 1e-11  # of a constant: what one that was computed in doubles may be off
_STATED_PLACE = 1e-7  # of a constant: what its value may be less at a place that was computed in doubles

_WHOLE = (fmpq(-1), fmpq(1))
_ORDERS = {"B": 1, "C": 2, "J": 3}


def at_most(name: str, stated: float, proven: Fraction | None, scale: float, source: str = "") -> Claim:
    """The claim that a stated bound is proven up to rounding; a bound near 0 is compared with its scale."""
    if proven is None:
        return Claim(name, proven=False, detail=f"{stated!r} stated, nothing proven")
    holds = Fraction(stated) <= proven + Fraction(STATED_BOUND) * max(Fraction(scale), abs(proven))
    return Claim(name, holds, f"{stated!r} stated, {rounded_down(proven)!r} proven{source}")


def stated_numbers(
    data: Mapping[str, Any], problem: Problem, law: ExactLaw, objective: tuple[float, float]
) -> Iterator[Claim]:
    """Objective, limit and Z of a solution."""
    if "objective" in data:
        yield near("the objective", number(data, "objective"), objective, problem.objective.scale)
    if data.get("limit") is not None:
        stated, scale = number(data, "limit"), problem.objective.scale
        yield at_most("the limit", stated, exact_limit(problem), scale, " by its closed form")
    if data.get("z") is not None:
        yield _of_z(data["z"], problem, law)


def stated_constants(data: Mapping[str, Any], law: ExactLaw) -> Iterator[Claim]:
    """B, C, D, J and rms_c with their places."""
    stated = data.get("constants", {})
    if not isinstance(stated, Mapping):
        raise InputError(f"constants must be an object, got {stated!r}")
    balls = law.constants()
    if unknown := [name for name in stated if name not in balls]:
        raise InputError(f"constants: {unknown[0]!r} is none of {', '.join(balls)}")
    for name, statement in stated.items():
        entry, key = (statement, "value") if isinstance(statement, Mapping) else (stated, name)
        # JSON knows no infinite number
        value = inf if entry.get(key, 0) is None else number(entry, key)
        yield near(name, value, enclosed(balls[name]))
        if "k" in entry and value < inf:
            yield _reached(name, value, number(entry, "k"), law)


def near(name: str, stated: float, pair: tuple[float, float], scale: float = 1.0) -> Claim:
    """The claim that a stated value is the proven one up to rounding; a value near 0 is compared with its scale."""
    low, high = pair
    room = _STATED_CONSTANT * max(scale, abs(high)) if high < inf else 0.0
    # an enclosure that is wider than what may be off proves nothing of a number in it
    narrow = low == high or high - low <= room
    return Claim(name, narrow and low - room <= stated <= high + room, f"{stated!r} stated, in [{low!r}, {high!r}]")


def _reached(name: str, value: float, k: float, law: ExactLaw) -> Claim:
    if not 0.0 <= k <= 1.0:
        return Claim(f"place of {name}", proven=False, detail=f"k = {k!r} is not in [0, 1]")
    place = Fraction(k)
    with ctx.workprec(law.precision):
        magnitudes = []
        for piece in law.pieces:
            if piece.start <= place <= piece.stop:
                b, *others = (piece.value(nu, place) for nu in (1, _ORDERS.get(name, 2)))
                magnitudes.append(abs(b * others[0]) if name == "D" else abs(others[0]))
    highest = max((enclosed(magnitude)[1] for magnitude in magnitudes), default=0.0)
    # a constant power is the same everywhere, and 0 times infinity at its end
    holds = highest >= value - _STATED_PLACE * max(1.0, value) or not all(
        magnitude.is_finite() for magnitude in magnitudes
    )
    return Claim(f"place of {name}", holds, f"{highest!r} at k = {k!r}")


def _of_z(z: object, problem: Problem, law: ExactLaw) -> Claim:
    """The claim that Z with the end conditions gives the law."""
    basis, order, conditions = problem.basis, problem.order, problem.conditions
    if not isinstance(basis, PolynomialBasis | PiecewiseBasis):
        raise InputError(f"z is given, but laws in {basis!r} have no Z")
    if not isinstance(z, list | tuple) or any(real(coefficient) is None for coefficient in z):
        raise InputError(f"z must be a list of numbers, got {z!r}")
    if len(z) != basis.size:
        return Claim("Z", proven=False, detail=f"it has {len(z)} coefficients, {basis!r} has {basis.size}")
    exact = [Fraction(coefficient) for coefficient in z]
    pieces = basis.pieces(exact) if isinstance(basis, PiecewiseBasis) else [exact]
    if len(pieces) != len(law.pieces):
        return Claim("Z", proven=False, detail=f"Z has {len(pieces)} pieces, the law {len(law.pieces)}")
    k = fmpq_poly([0, 1])
    a0, a1 = (fmpq_poly([rational(coefficient) for coefficient in part]) for part in (conditions.a0(), conditions.a1()))
    off = []
    for powers, piece in zip(pieces, law.polynomials, strict=True):
        whole = fmpq_poly([rational(Fraction(power)) for power in powers])
        if isinstance(basis, PiecewiseBasis):
            whole = whole((k - rational(piece.start)) / rational(piece.stop - piece.start))
        a = a0 + k**order * (a1 + (k - 1) ** order * whole)
        at_k = fmpq_poly([rational((piece.start + piece.stop) / 2), 1 / piece.rate])
        off.append(a(at_k) - piece.derivative(0))
    return _small("Z", off, law, COEFFICIENT_ROUNDING * (1.0 + float(sum(map(abs, exact))) / 4.0**order))


def _small(name: str, off: list[fmpq_poly], law: ExactLaw, allowed: float) -> Claim:
    """The claim that polynomials in y are small from -1 to 1."""
    with ctx.workprec(law.precision):
        # what is not small at a few places need not be enclosed everywhere
        least = max(enclosed(abs(at(polynomial, arb(y) / 4)))[0] for polynomial in off for y in range(-4, 5))
        if least > allowed:
            return Claim(name, proven=False, detail=f"off by {least:.1e} or more, {allowed:.1e} is allowed")
        by = enclosed(law.magnitude(least_and_greatest([value for part in off for value in between(part, *_WHOLE)])))[1]
    return Claim(name, by <= allowed, f"off by at most {by:.1e}, {allowed:.1e} is allowed")


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
    alone = _VERIFIED[kind_of(entry.data)](entry.data)
    return replace(alone, claims=(*alone.claims, *claims_in_context(entry, alone)))


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


def _plan(data: Mapping[str, Any]) -> Verification:
    solutions = {f"solutions[{i}]": each for i, each in enumerate(listed(data["solutions"], "solutions", _MOST_POINTS))}
    for place, solution in solutions.items():
        if not isinstance(solution, Mapping) or kind_of(solution) != "solution":
            raise InputError(f"{place} is no solution with its problem, its law and its certificate")
        check_keys(solution)
    read = imported("optlaws.cycles.cycle").Plan.from_dict
    return plan_of_cycle(lambda: read(data), lambda _: {place: _solution(each) for place, each in solutions.items()})


def _fastest_cycle(data: Mapping[str, Any]) -> Verification:
    read = imported("optlaws.cycles.fastest_cycle").FastestCycle.from_dict
    checked = plan_of_cycle(lambda: read(data), lambda fastest: verify_all(fastest.claims()) if fastest else {})
    detail = "that they are those of the cycle, in a millionth less than their times, is not computed again"
    motions = Claim("the motions of the proofs", proven=False, detail=detail, checked=False)
    return replace(checked, unchecked=(*checked.unchecked, motions))


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
    if kind_of(data) == "drive limit":
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
        claims += _proof_claims(proof, certificate, data[key], _name(key))
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
) -> Iterator[Claim]:
    """Claims of a certificate: the claims of its leaves, and its bound."""
    if certificate.peak:
        verdict = "holds" if certificate.proven else "does not hold"
        unchecked = "proofs over the places of a peak are not checked in exact arithmetic yet"
        yield Claim(name, proven=False, detail=f"it {verdict} in double precision; {unchecked}")
        return
    if certificate.points is None:
        yield from _leaf_claims(proof, certificate)
    else:
        left = "no law has" if proof.value is not None else "the steps do not show that no law has"
        yield Claim("steps", proof.value is not None, f"{left} an objective below {certificate.claim!r}")
    if certificate.program == VIOLATION:
        value = float(proof.value or 0)
        yield Claim("no law exists", value > 0.0, f"the constraints contradict each other by {value:.6g}")
    elif data.get("bound") is not None:
        scale = certificate.problem.objective.scale
        yield at_most(f"{name}'s bound", number(data, "bound"), proof.value, scale)


def _leaf_claims(proof: Proof, certificate: Certificate) -> Iterator[Claim]:
    count = len(certificate.contacts)
    greatest = max((abs(contact.multiplier) for contact in certificate.contacts), default=0.0)
    negative = [contact for contact in certificate.contacts if contact.multiplier < -_NEGATIVE_MULTIPLIER * greatest]
    shown = f"{len(negative)} of {count} negative" if negative else f"{count}, none negative"
    yield Claim("multipliers", not negative, shown)
    if proof.unknown:
        detail = f"{proof.unknown} of {count} are not of constraints that this problem has"
        yield Claim("contacts", proven=False, detail=detail)
    detail = "it depends on the law by more than is bounded"
    if proof.value is not None:
        detail = f"less {proof.charge:.1e} at most for what depends on the law"
    if not proof.by_rows:
        detail = "not needed: what is minimised is never below the bound"
    yield Claim("sum of the rows", proof.value is not None, detail)


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


#: how an entry of each kind is verified
_VERIFIED: Mapping[str | None, Callable[[Mapping[str, Any]], Verification]] = {
    "array": _arrays,
    "proven front": _front,
    "drive limit": _limit_of_drive,
    "move limit": _limit_of_drive,
    "least time": _least_time,
    "time front": _time_front,
    "overlap": overlap_of_axes,
    "plan": _plan,
    "fastest cycle": _fastest_cycle,
    "solution": _solution,
    "law": _law_alone,
    "certificate": _certificate,
}
