"""Why there is no law: infeasible, with proof and with what would help, or a failure of the solver."""

from __future__ import annotations

from math import ceil, floor

from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.synthesis.bases import PolynomialBasis
from optlaws.synthesis.bounding import violation_certificate
from optlaws.synthesis.certificate import Certificate
from optlaws.synthesis.exchange import Outcome, solve
from optlaws.synthesis.problem import Problem
from optlaws.synthesis.programs import Model, extreme_velocity, least_violation

_WEIGHTLESS = 1e-9

_TEXT = {
    "chord": "b <= B",
    "b": "|b| <= B",
    "ratio": "b >= 0",
    "forward": "b >= 0",
    "C": "|c| <= C",
    "J": "|j| <= J",
    "D": "|d| <= D",
}


def failure(problem: Problem, outcome: Outcome) -> InfeasibleProblem | SolverFailure:
    """The error to raise; an elastic phase tells which constraints contradict each other."""
    tried = f"IPOPT said {outcome.status!r} after {outcome.iterations} iterations, {outcome.rounds} rounds of exchange"
    elastic = least_violation(problem)
    trial = solve(elastic.program)
    if trial.optimum is not None:
        proof = violation_certificate(problem, elastic, trial.optimum)
        if proof.proves_infeasible:
            return InfeasibleProblem(
                _why(problem, proof, elastic), problem=problem, proof=proof, tried=_contradiction(proof)
            )
        tried += f"; the constraints leave {-trial.optimum.x[-1]:.3e} to spare"
    msg = "no law was found, and none was shown not to exist; try a degree higher or lower by 2, or other numbers"
    return SolverFailure(msg, problem=problem, tried=tried)


def _contradiction(proof: Certificate) -> str:
    places = ", ".join(f"{contact.k:.4g}" for contact in proof.contacts if contact.multiplier > 0.0)
    return f"the constraints contradict each other at k = {places} (error.proof is the certificate)"


def _why(problem: Problem, proof: Certificate, elastic: Model) -> str:
    """Which constraints contradict each other: those with a multiplier in the proof."""
    names = [_named(problem, c.constraint) for c in proof.contacts if c.multiplier > 0.0]
    names += [
        f"{name} = {problem.B:g}" if name == "b(1/2) = B" and isinstance(problem.B, float) else name
        for name, weight in zip(elastic.equation_names, proof.equations, strict=True)
        if abs(weight) > _WEIGHTLESS
    ]
    basis = problem.basis
    shape = f"Z of degree {basis.degree}" if isinstance(basis, PolynomialBasis) else repr(basis)
    asked = " and ".join(dict.fromkeys(reversed(names)))
    return (
        f"no law of order {problem.order} with {shape} has {asked}. "
        f"A higher degree of Z or a lower order helps{_possible(problem)}"
    )


def _named(problem: Problem, constraint: str) -> str:
    if constraint.startswith("window "):
        return repr(problem.windows[int(constraint.split()[1].rstrip(",")) - 1])
    text = _TEXT.get(constraint, constraint)
    value = getattr(problem, text[-1], None) if text[-1] in "CDJ" else None
    return f"{text} = {value!r} everywhere" if value is not None else f"{text} everywhere"


def _possible(problem: Problem) -> str:
    """Which B this order and degree can have, to six digits, inward."""
    if not isinstance(problem.B, float):
        return ""
    low, high = (_extreme(problem, greatest=greatest) for greatest in (False, True))
    least = f"from {ceil(low * 1e6) / 1e6:.7g}" if low is not None else ""
    greatest = f"up to {floor(high * 1e6) / 1e6:.7g}" if high is not None else ""
    return f"; so does a B {' '.join(p for p in (least, greatest) if p)}" if least or greatest else ""


def _extreme(problem: Problem, *, greatest: bool) -> float | None:
    found = extreme_velocity(problem, greatest=greatest)
    optimum = solve(found.program).optimum
    return None if optimum is None else float(optimum.x[found.places["B"]])
