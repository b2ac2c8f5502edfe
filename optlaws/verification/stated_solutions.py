"""Solutions, certificates, laws and limits of files: what is proven of each, and of what it states."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import partial
from math import inf

from flint import arb, ctx, fmpq, fmpq_poly

from optlaws.echo import shortened
from optlaws.entries.value_types import Choice
from optlaws.errors import InputError, located
from optlaws.files.reading import entries_of, renamed_entries
from optlaws.laws import MotionLaw
from optlaws.mechanisms.linkages.move_limit import MoveLimit
from optlaws.numbers import real
from optlaws.numerics.exact import rounded_down, rounded_up
from optlaws.synthesis.limits.drive_limits import DriveLimit
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import evaluate
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.spaces.bases import PiecewiseBasis, PolynomialBasis
from optlaws.synthesis.status import measure
from optlaws.synthesis.stored_rows import StatedSolution
from optlaws.synthesis.stored_solutions import read_solutions
from optlaws.tolerances import BOUND_FEASIBILITY, COEFFICIENT_ROUNDING, OPTIMALITY_GAP
from optlaws.verification.conditions import excesses
from optlaws.verification.enclosing.balls import at, enclosed, rational
from optlaws.verification.enclosing.taylor_models import between, least_and_greatest
from optlaws.verification.exact.bound import Proof, exact_limit, prove
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.exact.rows import NoExactRowsError
from optlaws.verification.result import (
    Claim,
    Data,
    Proven,
    Verification,
    at_most,
    built,
    compare,
    near,
    number,
    of_number,
    recomputed,
    with_claims,
)

_STATED_PLACE = 1e-7  # of a constant: what its value may be less at a place that was computed in doubles
_NEGATIVE_MULTIPLIER = 1e-9  # of the greatest multiplier: one so little below 0 is none

_WHOLE = (fmpq(-1), fmpq(1))
_ORDERS = {"B": 1, "C": 2, "J": 3}
#: further certificates of a solution
_BESIDE = ("power_certificate", "peak_certificate")
_IN_DOUBLES = "its enclosure has no end; in doubles it holds"
#: claims that the enclosure of the objective decides
_BY_OBJECTIVE = ("the objective", "the gap", "optimal", "the status")
#: and those that the bound decides
_BY_BOUND = ("the lower bound", "the gap", "optimal", "the status")


def exact_law(data: object) -> ExactLaw:
    """The very function that the numbers of a law describe."""
    return built(lambda entries: ExactLaw(MotionLaw.from_dict(entries)), data, "law")


def law_alone(data: Data) -> Verification:
    """The constants of a law."""
    law = exact_law(data["law"])
    claims = compare(data, {"law": None, "constants": partial(_constants, law), "about": None}, "the law")
    return Verification(constants=law.enclosures(), claims=tuple(claims))


def certificate(data: Data) -> Verification:
    """The bound of a certificate, or that its problem has no law."""
    proof_of = built(Certificate.from_dict, data, "the certificate")
    proof = _proof(proof_of)
    contradiction = proof_of.program == VIOLATION
    known = Verification(
        problem=proof_of.problem,
        bound=None if contradiction or proof.value is None else rounded_down(proof.value),
        infeasible=contradiction and proof.value is not None and proof.value > 0,
        charge=proof.charge,
    )
    return with_claims(known, _proof_claims(proof, proof_of, data, "the certificate"))


def _proof(certificate: Certificate) -> Proof:
    """What a certificate proves; nothing, and why, where there are no exact rows."""
    try:
        return prove(certificate)
    except NoExactRowsError as error:
        return Proof(None, no_rows=str(error))


def arrays(data: Data) -> Verification:
    """The entries of all problems beside solutions, which are verified one by one: they must agree with them."""
    try:
        read_solutions(data)
    except InputError as error:
        return Verification(claims=(Claim("the problems", proven=False, detail=str(error)),))
    return with_claims(Verification(), [recomputed("the problems", "they are those of the solutions")])


def drive_limit(data: Data) -> Verification:
    """A limit of drives, whose bound is computed again from its potential."""
    return _of_drive(built(DriveLimit.stated, data, "the drive's limit"), Fraction(1))


def move_limit(data: Data) -> Verification:
    """A limit of drives in SI units, by the unit of its move."""
    moved, wrong = built(MoveLimit.stated, data, "the limit of a move")
    detail = wrong or f"{moved.unit!r} {moved.dimension}, computed again from the drive and the move"
    return _of_drive(moved.drive_limit, Fraction(moved.unit), Claim("the move and its unit", not wrong, detail))


def _of_drive(limit: DriveLimit, unit: Fraction, *claims: Claim) -> Verification:
    wrong = built(lambda stated: stated.contradiction(), limit, "the drive's limit")
    detail = f"{limit.value!r} stated, {limit.bound!r} proven by the phase plane; {limit.attained!r} attained"
    claims = (*claims, Claim("the drive's limit", not wrong, wrong or detail))
    known = limit.bound > -inf and all(claim.proven for claim in claims)
    return Verification(bound=rounded_down(Fraction(limit.bound) * unit) if known else None, claims=claims)


def solution(data: Data) -> Verification:
    """A law with its problem and its proofs."""
    data = renamed_entries(data)
    entries_of(data, ("problem", "law", "certificate"), "the solution")
    beside = [key for key in _BESIDE if data.get(key) is not None]
    for name in ("problem", "law", "certificate", *beside):
        if not isinstance(data[name], Mapping):
            raise InputError(f"{name} must be an object, got {shortened(data[name])}")
    problem, law = built(Problem.from_dict, data["problem"], "problem"), exact_law(data["law"])
    proofs = {}
    for key in ("certificate", *beside):
        proof_of = built(Certificate.from_dict, data[key], _name(key))
        if proof_of.program == VIOLATION:
            raise InputError("a proof that no law exists beside a law: verify the certificate alone")
        proofs[key] = proof_of, _proof(proof_of)
    drive = None if data.get("drive_limit") is None else built(DriveLimit.from_dict, data["drive_limit"], "drive_limit")
    bound, source, no_rows = _best(problem, proofs, drive)
    objective, scale = enclosed(law.sum(problem.objective)), problem.objective.scale
    conditions = excesses(problem, law)
    # long formulas may have enclosures without an end, which neither prove nor refute
    open_ended = objective == (-inf, inf)
    again = evaluate(problem, law.law) if open_ended or not all(each.known for each in conditions) else None
    within = (again.objective,) * 2 if again and open_ended else objective
    highest, gap, over = within[1], None, 0.0
    if bound is not None and highest < inf:
        size = Fraction(measure(highest, scale))
        gap = rounded_up((Fraction(highest) - bound) / size)
        if data.get("lower_bound") is not None:
            over = float((Fraction(number(data, "lower_bound")) - bound) / size)
    stated: dict[str, Proven] = {
        "objective": of_number(lambda value: near("the objective", value, within, scale)),
        "best_possible": of_number(
            lambda value: at_most("the best possible", value, exact_limit(problem), scale, " by its closed form")
        ),
        "z": lambda z, _: [_of_z(z, problem, law)],
        "constants": partial(_constants, law),
        **{key: partial(_beside, problem, *proofs[key]) for key in proofs},
        "drive_limit": lambda *_: [_drive_claim(problem, drive)],
        "lower_bound": of_number(lambda value: at_most("the lower bound", value, bound, scale, source)),
        "gap": of_number(partial(_gap, gap, over)),
        "status": partial(_status, gap, over),
    }
    others = {key: None for key in StatedSolution.__struct_fields__ if key not in stated}
    claims = [
        Claim(each.name, each.holds, f"greatest deviation {max(each.by, 0.0):.1e}, {each.allowed:.1e} is allowed")
        if again is None or each.known
        else _in_doubles(Claim(each.name, again.excess <= BOUND_FEASIBILITY, f"deviation {again.excess:.1e}"))
        for each in conditions
    ]
    of_file = list(compare(data, stated | others, "the solution"))
    if open_ended:
        of_file = [_in_doubles(claim) if claim.name in _BY_OBJECTIVE else claim for claim in of_file]
    if no_rows:
        of_file = [_in_doubles(claim, no_rows) if claim.name in _BY_BOUND else claim for claim in of_file]
    known = Verification(
        problem=problem,
        bound=None if bound is None or no_rows else rounded_down(bound),
        objective=objective,
        gap=None if open_ended or no_rows else gap,
        constants=law.enclosures(),
        excesses={condition.name: condition.by for condition in conditions},
        charge=proofs["certificate"][1].charge,
    )
    return with_claims(known, [*claims, *of_file])


def _in_doubles(claim: Claim, why: str = _IN_DOUBLES) -> Claim:
    """A claim that doubles alone support; one that they refute stays not proven."""
    return recomputed(claim.name, why) if claim.proven else claim


def _name(key: str) -> str:
    return f"the {key.replace('_', ' ')}"


def _best(
    problem: Problem, proofs: Mapping[str, tuple[Certificate, Proof]], drive: DriveLimit | None
) -> tuple[Fraction | None, str, str]:
    """The highest bound of the problem, by what if not by its first certificate, and why it is of doubles if it is."""
    of_problem = {key: each for key, each in proofs.items() if each[0].problem == problem}
    known = [
        (value, f" by {_name(key)}" if key in _BESIDE else "", proof.no_rows)
        for key, (proof_of, proof) in of_problem.items()
        if (value := _in_exact_rows_or_doubles(proof_of, proof)) is not None
    ]
    if drive is not None and drive.is_of(problem):
        known.append((Fraction(drive.bound), " by the phase plane", ""))
    limit = exact_limit(problem)
    if limit is not None:
        known.append((limit, " by the limit of laws of any degree", ""))
    return max(known, key=lambda bound: bound[0], default=(None, "", ""))


def _in_exact_rows_or_doubles(certificate: Certificate, proof: Proof) -> Fraction | None:
    """The bound of a certificate, in doubles where there are no exact rows; None where there is none."""
    if proof.no_rows and certificate.estimate > -inf:
        return Fraction(certificate.estimate)
    return proof.value


def _constants(law: ExactLaw, stated: object, name: str) -> Iterator[Claim]:
    """B, C, D, J and rms_c with their places."""
    if not isinstance(stated, Mapping):
        raise InputError(f"{name} must be an object, got {stated!r}")
    balls = law.constants()
    if unknown := [each for each in stated if each not in balls]:
        raise InputError(f"{name}: {unknown[0]!r} is none of {', '.join(balls)}")
    for each, statement in stated.items():
        entry, key = (statement, "value") if isinstance(statement, Mapping) else (stated, each)
        # JSON knows no infinite number
        value = inf if entry.get(key, 0) is None else number(entry, key)
        yield near(each, value, enclosed(balls[each]))
        if "k" in entry and value < inf:
            yield _reached(each, value, number(entry, "k"), law)


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
    return Claim(name, by <= allowed, f"greatest deviation {by:.1e}, {allowed:.1e} is allowed")


def _beside(problem: Problem, proof_of: Certificate, proof: Proof, data: Data, key: str) -> Iterator[Claim]:
    """The claims of a certificate beside a law."""
    same = proof_of.problem == problem
    yield Claim(f"{_name(key)}'s problem", same, "the file's" if same else f"another: {proof_of.problem!r}")
    yield from _proof_claims(proof, proof_of, data, _name(key))


def _drive_claim(problem: Problem, drive: DriveLimit | None) -> Claim:
    same = drive is not None and drive.is_of(problem)
    return Claim("the drive's limit", same, "of the file's problem" if same else "of another problem")


def _proof_claims(proof: Proof, proof_of: Certificate, data: Data, name: str) -> Iterator[Claim]:
    """Claims of a certificate: the claims of its leaves, and its bound."""
    if proof_of.points is None and not proof_of.peak:
        yield from _leaf_claims(proof, proof_of)
    else:
        left = "no law has" if proof.value is not None else "the steps do not prove that no law has"
        yield Claim("steps", proof.value is not None, f"{left} an objective below {proof_of.claim!r}")
    if proof_of.program == VIOLATION:
        value = float(proof.value or 0)
        yield Claim("no law exists", value > 0.0, f"the constraints contradict each other by {value:.6g}")
    yield from stated_bound(proof, proof_of, data, name)


def stated_bound(proof: Proof, proof_of: Certificate, data: Data, name: str) -> Iterator[Claim]:
    """The claim of a bound that stands in a certificate."""
    if data.get("bound") is not None:
        value = _in_exact_rows_or_doubles(proof_of, proof)
        claim = at_most(f"{name}'s bound", number(data, "bound"), value, proof_of.problem.objective.scale)
        yield _in_doubles(claim, proof.no_rows) if proof.no_rows else claim


def _leaf_claims(proof: Proof, proof_of: Certificate) -> Iterator[Claim]:
    count = len(proof_of.contacts)
    greatest = max((abs(contact.multiplier) for contact in proof_of.contacts), default=0.0)
    negative = [contact for contact in proof_of.contacts if contact.multiplier < -_NEGATIVE_MULTIPLIER * greatest]
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
    yield Claim("sum of the rows", proof.value is not None, proof.no_rows or detail, checked=not proof.no_rows)


def _gap(gap: float | None, over: float, value: float) -> Claim:
    """The claim of a gap; `over` is how far the stated bound, another claim, is above the proven."""
    holds = gap is not None and value >= gap - max(over, 0.0) - OPTIMALITY_GAP
    return Claim("the gap", holds, f"{value:.1e} stated, {_shown(gap)} proven")


def _status(gap: float | None, over: float, status: object, name: str) -> Iterator[Claim]:
    with located("the solution"):
        read = Choice("optimal", "local", "inaccurate").read(status, name)
    if read == "optimal":
        yield Claim("optimal", gap is not None and gap <= OPTIMALITY_GAP, f"the proven gap is {_shown(gap)}")
    else:
        # what is as good as optimal is called so, unless doubles prove less
        far = gap is None or gap - min(over, 0.0) > OPTIMALITY_GAP / 2.0
        yield Claim("the status", far, f"{read!r} stated, the proven gap is {_shown(gap)}")


def _shown(gap: float | None) -> str:
    return "not known" if gap is None else f"{gap:.1e}"
