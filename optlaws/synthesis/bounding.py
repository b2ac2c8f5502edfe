"""From an optimum's multipliers to a certificate, and the best bound that can be proven."""

from __future__ import annotations

import numpy as np

from optlaws.synthesis.active_set import ActiveSet
from optlaws.synthesis.certificate import OBJECTIVE, RELAXED, VIOLATION, Certificate, Contact
from optlaws.synthesis.exchange import solve
from optlaws.synthesis.problem import Problem
from optlaws.synthesis.programs import ROOT, Model, relaxed
from optlaws.synthesis.rows import NormFamily

_TANGENTS = 4
_NEAR = 0.9
_NO_NORM = 1e-300


def certify(problem: Problem, found: Model, optimum: ActiveSet, objective: float, limit: float | None) -> Certificate:
    """The certificate of an optimum; of the relaxed program, solved here, where the problem is not convex.

    The tangent is moved to where the relaxed optimum asks for it, as long as that may pay: not below the limit.
    """
    if problem.convex:
        return certificate(problem, found, optimum, OBJECTIVE)
    tangent = float(np.sqrt(objective))
    best: Certificate | None = None
    for _ in range(_TANGENTS):
        loose = relaxed(problem, tangent)
        outcome = solve(loose.program)
        if outcome.optimum is None:
            break
        proof = certificate(problem, loose, outcome.optimum, RELAXED, tangent)
        if best is None or proof.bound > best.bound:
            best = proof
        if limit is not None and best.bound < _NEAR * limit:
            break
        moved = float(outcome.optimum.x[loose.places[ROOT]])
        if abs(moved - tangent) < 1e-6 * tangent:
            break
        tangent = moved
    return best if best is not None else Certificate(problem, (), (), RELAXED, tangent)


def certificate(problem: Problem, found: Model, optimum: ActiveSet, program: str, tangent: float = 0.0) -> Certificate:
    """Contacts and multipliers of an optimum in terms of k."""
    contacts = []
    for i, family in enumerate(found.program.families):
        mine = np.flatnonzero(optimum.family == i)
        direction: tuple[float, ...] = ()
        if isinstance(family, NormFamily):
            image = family.matrix @ np.append(optimum.x, 1.0)
            direction = tuple((image / max(float(np.linalg.norm(image)), _NO_NORM)).tolist())
        for j, k in zip(mine, family.k(optimum.u[mine]), strict=True):
            multiplier = float(optimum.multipliers[j])
            place = float(min(max(k, 0.0), 1.0))
            contacts.append(Contact(family.name, float(optimum.s[j]), place, multiplier, direction))
    equations = tuple(optimum.equality_multipliers.tolist())
    return Certificate(problem, tuple(contacts), equations, program, tangent)


def violation_certificate(problem: Problem, found: Model, optimum: ActiveSet) -> Certificate:
    """The certificate that no law exists."""
    return certificate(problem, found, optimum, VIOLATION)


def lower_bound(proof: Certificate, limit: float | None) -> float:
    """The better of the certificate's bound and the limit."""
    return max(proof.bound, -np.inf if limit is None else limit)
