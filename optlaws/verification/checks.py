"""What a file claims, claim by claim."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import inf, isfinite
from numbers import Real
from pathlib import Path
from typing import Any

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.synthesis.certificate import VIOLATION, Certificate
from optlaws.synthesis.problem import Problem
from optlaws.verification.balls import down, enclosure, up
from optlaws.verification.bound import Proof, prove
from optlaws.verification.conditions import excesses
from optlaws.verification.exact_law import enclosures, exact
from optlaws.verification.exact_limits import exact_limit
from optlaws.verification.result import Claim, Verification

#: how far stated numbers, computed in doubles, may be from the proven ones, relative
_BOUND, _VALUE = 1e-9, 1e-11
#: an optimum's greatest gap, and the greatest correction that rounding explains
_GAP, _CORRECTION = 1e-8, 1e-6


def verify(source: Mapping[str, Any] | Path | str) -> Verification:
    """Check every claim."""
    data = _read(source)
    if "contacts" in data:
        return _certificate_alone(Certificate.from_dict(data), data)
    if not {"problem", "law", "certificate"} <= data.keys():
        raise InputError(
            "neither a solution (problem, law, certificate) nor a certificate (contacts): nothing to verify"
        )
    return _solution(data)


def _read(source: Mapping[str, Any] | Path | str) -> Mapping[str, Any]:
    if isinstance(source, Mapping):
        return source
    try:
        data = json.loads(Path(source).read_text(encoding="utf-8"))
    except ValueError as error:
        raise InputError(f"{source}: not JSON: {error}") from None
    if not isinstance(data, dict):
        raise InputError(f"{source}: not a JSON object but {type(data).__name__}")
    return data


def _certificate_alone(certificate: Certificate, data: Mapping[str, Any]) -> Verification:
    proof = prove(certificate)
    claims = [*_certificate(proof, certificate), *_bound(proof, certificate, data)]
    return _verification(certificate.problem, certificate, proof, claims)


def _bound(proof: Proof, certificate: Certificate, data: Mapping[str, Any]) -> Iterator[Claim]:
    if certificate.program == VIOLATION:
        value = float(proof.value or 0)
        yield Claim("no law exists", value > 0.0, f"the constraints contradict each other by {value:.6g}")
    elif data.get("bound") is not None:
        yield _at_most("the certificate's bound", _number(data, "bound"), proof.value)


def _solution(data: Mapping[str, Any]) -> Verification:
    for name in ("problem", "law", "certificate"):
        if not isinstance(data[name], Mapping):
            raise InputError(f"{name} must be an object, got {data[name]!r}")
    problem = _problem(data["problem"])
    certificate = Certificate.from_dict(data["certificate"])
    if certificate.program == VIOLATION:
        raise InputError("a proof that no law exists beside a law: verify the certificate alone")
    law = exact(MotionLaw.from_dict(data["law"]))
    proof = prove(certificate)
    objective = enclosure(law.sum(problem.objective))
    bound, source = _best(proof, exact_limit(problem))
    gap = None
    if bound is not None:
        gap = up((Fraction(objective[1]) - bound) / Fraction(objective[1])) if objective[1] else 0.0
    constants = enclosures(law.law)
    found = excesses(problem, law)
    same = certificate.problem == problem
    claims = [
        *(Claim(e.name, e.holds, f"off by at most {max(e.by, 0.0):.1e}, {e.allowed:.1e} is allowed") for e in found),
        *_stated(data, objective, constants),
        Claim("the certificate's problem", same, "the file's" if same else f"another: {certificate.problem!r}"),
        *_certificate(proof, certificate),
        *_bound(proof, certificate, data["certificate"]),
    ]
    if data.get("lower_bound") not in (None, -inf):
        claims.append(_at_most("the lower bound", _number(data, "lower_bound"), bound, source))
    if data.get("status") == "optimal":
        claims.append(Claim("optimal", gap is not None and gap <= _GAP, f"the proven gap is {_shown(gap)}"))
    return _verification(
        problem,
        certificate,
        proof,
        claims,
        bound=None if bound is None else down(bound),
        objective=objective,
        gap=gap,
        constants=constants,
        excesses={one.name: one.by for one in found},
    )


def _verification(
    problem: Problem,
    certificate: Certificate,
    proof: Proof,
    claims: list[Claim],
    **known: Any,  # noqa: ANN401
) -> Verification:
    contradiction = certificate.program == VIOLATION
    known.setdefault("bound", None if contradiction or proof.value is None else down(proof.value))
    return Verification(
        problem=problem,
        infeasible=contradiction and proof.value is not None and proof.value > 0,
        charge=proof.charge,
        claims=tuple(claims),
        **known,
    )


def _certificate(proof: Proof, certificate: Certificate) -> Iterator[Claim]:
    count = len(certificate.contacts)
    greatest = max((abs(one.multiplier) for one in certificate.contacts), default=0.0)
    negative = [one for one in certificate.contacts if one.multiplier < -_BOUND * greatest]
    shown = f"{len(negative)} of {count} negative" if negative else f"{count}, none negative"
    yield Claim("multipliers", not negative, shown)
    if proof.unknown:
        detail = f"{proof.unknown} of {count} are not of constraints that this problem has"
        yield Claim("contacts", proven=False, detail=detail)
    detail = f"corrected by at most {proof.correction:.1e} of the greatest so that nothing depends on the law"
    yield Claim("sum of the rows", proof.value is not None and proof.correction <= _CORRECTION, detail)


def _stated(
    data: Mapping[str, Any], objective: tuple[float, float], constants: dict[str, tuple[float, float]]
) -> Iterator[Claim]:
    if "objective" in data:
        yield _near("the objective", _number(data, "objective"), objective)
    stated = data.get("constants", {})
    if not isinstance(stated, Mapping):
        raise InputError(f"constants must be an object, got {stated!r}")
    for name, pair in constants.items():
        if name in stated:
            one = stated[name]
            yield _near(name, _number(one, "value") if isinstance(one, Mapping) else _number(stated, name), pair)


def _near(name: str, stated: float, pair: tuple[float, float]) -> Claim:
    low, high = pair
    room = _VALUE * max(1.0, abs(high))
    return Claim(name, low - room <= stated <= high + room, f"{stated!r} stated, in [{low!r}, {high!r}]")


def _best(proof: Proof, limit: Fraction | None) -> tuple[Fraction | None, str]:
    if limit is not None and (proof.value is None or limit > proof.value):
        return limit, " by the limit of laws of any degree"
    return proof.value, ""


def _at_most(name: str, stated: float, proven: Fraction | None, source: str = "") -> Claim:
    if proven is None:
        return Claim(name, proven=False, detail=f"{stated!r} stated, nothing proven")
    holds = Fraction(stated) <= proven + Fraction(_BOUND) * max(Fraction(1), abs(proven))
    return Claim(name, holds, f"{stated!r} stated, {down(proven)!r} proven{source}")


def _problem(data: Mapping[str, Any]) -> Problem:
    try:
        return Problem.from_dict(data)
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"this is not a problem: {error}") from None


def _number(data: Mapping[str, Any], name: str) -> float:
    value = data.get(name)
    if isinstance(value, bool) or not isinstance(value, Real) or not isfinite(value):
        raise InputError(f"{name} must be a finite number, got {value!r}")
    return float(value)


def _shown(gap: float | None) -> str:
    return "not known" if gap is None else f"{gap:.1e}"
