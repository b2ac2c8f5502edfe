"""Why there is no law: infeasible, with proof and with what would help, or a failure of the solver."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from math import ceil, floor

from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.synthesis.families import names
from optlaws.synthesis.families.family import LinearFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.method.discretised.on_points import first_points
from optlaws.synthesis.method.exchange import Outcome, answer_on_points, solve
from optlaws.synthesis.method.presolve import contradiction
from optlaws.synthesis.problem.constants import C, Functional
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.program.writer import Model, extreme_velocity, least_violation, model_of
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.proof.make import spread, violation_certificate
from optlaws.synthesis.proof.no_law import beyond_limit, convex_part
from optlaws.synthesis.proof.nodes import Contact
from optlaws.synthesis.spaces.bases import Basis, PolynomialBasis
from optlaws.synthesis.spaces.of_basis import space_of

_INFEASIBLE_WEIGHTLESS = 1e-9  # a weight of a proof of infeasibility that is less is none
_DEEP_LAW_EXCESS = 1e-3  # by how much a law far below all of the field may miss a bound

_FREE = 1e-15  # of a law's coordinate: what moves a value by less does not move it but for rounding
_VALUE_ROUNDING = 1e-13  # of a value that all laws have: a bound that is nearer does not exclude it for certain

_DEPTH = 1e5  # of an objective: beyond what laws of the field have
_PLAIN = 2  # so few equations contradict each other whatever freedom the law has
_MORE_FREEDOM = {PolynomialBasis: "A higher degree of Z", Basis: "More pieces, a higher degree, a lower continuity"}

_TEXT = {
    RowName.BELOW_PEAK: "b <= B",
    RowName.VELOCITY: "|b| <= B",
    RowName.RATIO: "b >= 0",
    RowName.FORWARD: "b >= 0",
    "C": "|c| <= C",
    "J": "|j| <= J",
    "D": "|d| <= D",
}


def failure(problem: Problem, outcome: Outcome) -> InfeasibleProblem | SolverFailure:
    """The error for a program without a law; an elastic phase finds the contradicting constraints, or a limit does."""
    outcome_text, rounds = f"the solver said {outcome.status!r}", f"{outcome.rounds} rounds of exchange"
    tried = f"{outcome_text} after {outcome.iterations} iterations, {rounds}"
    straight = convex_part(problem)
    elastic = least_violation(straight)
    disagreement = _disagreement(elastic)
    if disagreement is not None:
        return InfeasibleProblem(
            _disagreeing(problem, disagreement, elastic),
            problem=problem,
            proof=disagreement,
            tried="the equations contradict each other by linear algebra alone (error.proof has their multipliers)",
        )
    beyond = beyond_limit(problem)
    trial = solve(elastic.program)
    proof = None if trial.optimum is None else violation_certificate(elastic, trial.optimum)
    if proof is not None and not proof.proves_infeasible:
        proof = next((each for each in spread(elastic, proof) if each.proves_infeasible), proof)
    if proof is not None and proof.proves_infeasible:
        return InfeasibleProblem(
            beyond or _why(problem, proof, elastic), problem=problem, proof=proof, tried=_contradiction(proof)
        )
    if trial.optimum is not None:
        tried += f"; the constraints leave {-trial.optimum.x[-1]:.3e} to spare"
    if beyond:
        return InfeasibleProblem(beyond, problem=problem, tried=tried)
    if falls_for_ever(problem):
        scale = problem.objective.scale
        deep = f"{-_DEPTH:.0f}" if scale == 1.0 else f"{-_DEPTH * scale:g}"
        msg = (
            f"{problem.minimise} has no least value: there are laws with {deep} and less. A bound on C, J or "
            "B from above, or end conditions of a higher order, help"
        )
        return SolverFailure(msg, problem=problem, tried=tried)
    msg = "no law was found, and no proof that none exists; try a degree higher or lower by 2, or other numbers"
    remarks = [remark for constant in problem.constants for remark in constant.remarks]
    return SolverFailure("; mind that ".join([msg, *remarks]), problem=problem, tried=tried)


def beyond_known_value(problem: Problem) -> InfeasibleProblem | None:
    """The error for a window that excludes a value which all laws have, at an end or in the middle of symmetric ones.

    >>> from optlaws import Window
    >>> beyond_known_value(Problem(order=4, windows=(Window("a", low=0.3, high=0.3),))).proof.contacts[0].k
    0.0
    """
    excluded = next(_excluded_values(problem), None)
    if excluded is None:
        return None
    window, contact = excluded
    proof = Certificate.of_leaf(problem, (contact,), [0.0] * len(model_of(problem).program.right), VIOLATION)
    at = contact.k if window.start <= contact.k <= window.stop else 1.0 - contact.k
    return InfeasibleProblem(
        f"no law of order {problem.order} keeps {window!r}: it excludes the value that every law of the "
        f"problem has at k = {at:g}. Another interval or bound helps",
        problem=problem,
        proof=proof,
        tried=_contradiction(proof),
    )


def _excluded_values(problem: Problem) -> Iterator[tuple[Window, Contact]]:
    """Windows that exclude, by more than rounding, a value which no coordinate moves, each with the contact there."""
    space = space_of(problem.basis, problem.conditions, symmetric=problem.symmetric)
    for number, window in enumerate(problem.windows, 1):
        if window.motion is not None or window.value:
            continue
        halves = (names.window(number), names.mirrored(names.window(number)))
        parts = window.first_half() if problem.symmetric else (window,)
        places = product(zip(parts, halves, strict=False), (0.0, 0.5, 1.0))
        for part, name, k in ((part, name, k) for (part, name), k in places if part.start <= k <= part.stop):
            *slopes, value = space.row(part.nu, k).tolist()
            sign = 1.0 if value > part.high else -1.0
            excess = max(value - part.high, part.low - value)
            if excess > _VALUE_ROUNDING * max(1.0, abs(value)) and all(abs(slope) <= _FREE for slope in slopes):
                yield window, Contact(names.window_side(name, sign), sign, k, 1.0)


def falls_for_ever(problem: Problem) -> bool:
    """Whether the objective, negative for some one-sided peaks, is bounded only by an artificial row."""
    if not problem.convex:
        return False
    model = model_of(problem)
    program = model.program
    ground = LinearFamily.of_row("objective at least", -program.objective, _DEPTH)
    bounded = replace(program, families=(*program.families, ground))
    deepest = solve(bounded).optimum
    # so far down nothing shows which contacts are exact: a law that keeps all bounds is enough
    x = answer_on_points(bounded, first_points(bounded), None).x if deepest is None else deepest.x
    return program.objective_at(x) < -0.99 * _DEPTH and program.violation(x) < _DEEP_LAW_EXCESS


def _contradiction(proof: Certificate) -> str:
    parts = _parts(proof.problem)
    acting = [contact for contact in proof.contacts if contact.multiplier > 0.0]
    placed = [(*parts.get(contact.constraint, (C, 0)), contact.k) for contact in acting]
    ordered = sorted(placed, key=lambda place: (place[2], place[1]))
    words = dict.fromkeys(constant.where(k, part).partition(" = ") for constant, part, k in ordered)
    symbols = dict.fromkeys(symbol for symbol, _, _ in words)
    places = ", ".join(f"{shown} = {', '.join(at for symbol, _, at in words if symbol == shown)}" for shown in symbols)
    return f"the constraints contradict each other at {places}"


def _why(problem: Problem, proof: Certificate, elastic: Model) -> str:
    """Constraints that contradict each other: those with a multiplier in the proof."""
    acting = [_named(problem, contact.constraint) for contact in proof.contacts if contact.multiplier > 0.0]
    acting += _equations(problem, proof, elastic)
    demands = " and ".join(dict.fromkeys(reversed(acting)))
    return (
        f"no law of order {problem.order} with {_shape(problem)} has {demands}. "
        f"{_MORE_FREEDOM[_kind(problem)]} or a lower order helps{_possible(problem)}"
    )


def _disagreement(elastic: Model) -> Certificate | None:
    """Proof that the equations alone have no solution."""
    weights = contradiction(elastic.program.equalities, elastic.program.right)
    if weights is None:
        return None
    stated = tuple(elastic.program.stated_multipliers(weights).tolist())
    proof = Certificate.of_leaf(elastic.problem, (), stated, VIOLATION)
    return proof if proof.proves_infeasible else None


def _disagreeing(problem: Problem, proof: Certificate, elastic: Model) -> str:
    texts = list(dict.fromkeys(_equations(problem, proof, elastic)))
    law = f"no law of order {problem.order} with {_shape(problem)} has {' and '.join(texts)}: "
    if len(texts) <= _PLAIN:
        return f"{law}with the end conditions {'that' if len(texts) == 1 else 'these'} cannot be. Leave one out"
    return f"{law}these equations contradict each other. {_MORE_FREEDOM[_kind(problem)]} may help, or one left out"


def _equations(problem: Problem, proof: Certificate, elastic: Model) -> list[str]:
    """The equations that have a multiplier in the proof."""
    weights = elastic.program.multipliers_of_equations(proof.equations).tolist()
    return [
        f"{name} = {problem.B:g}"
        if name == names.velocity_at_peak(problem.peak_at) and isinstance(problem.B, float)
        else name
        for name, weight in zip(elastic.equation_names, weights, strict=True)
        if abs(weight) > _INFEASIBLE_WEIGHTLESS
    ]


def _kind(problem: Problem) -> type[PolynomialBasis | Basis]:
    return PolynomialBasis if isinstance(problem.basis, PolynomialBasis) else Basis


def _shape(problem: Problem) -> str:
    basis = problem.basis
    return f"Z of degree {basis.degree}" if isinstance(basis, PolynomialBasis) else repr(basis)


def _parts(problem: Problem) -> dict[str, tuple[Functional, int]]:
    """Constants and their parts by the names of their rows."""
    return {name: (constant, i) for constant in problem.constants for i, name in enumerate(constant.part_names)}


def _named(problem: Problem, constraint: str) -> str:
    parts = _parts(problem)
    constraint = parts[constraint][0].name if constraint in parts else constraint
    number = names.window_number(constraint)
    if number is not None:
        return repr(problem.windows[number - 1])
    limits = problem.range(constraint)
    if constraint not in _TEXT and limits is not None:
        return f"{constraint} <= {limits.high:g}"
    text = _TEXT.get(constraint, constraint)
    bounded = None if text[-1] not in "CDJ" else problem.range(text[-1])
    return f"{text} everywhere" if bounded is None else f"{text} = {bounded.high:g} everywhere"


def possible_velocities(problem: Problem) -> tuple[float | None, float | None]:
    """The least and the greatest B that the problem can have in place of its own, to six digits, inward.

    None where there is no such end, or where no B has a law; of a problem that D bounds, for the rest of it.

    >>> possible_velocities(Problem(B=1.2, order=6))
    (1.221697, None)
    """
    low, high = (_extreme(problem, greatest=greatest) for greatest in (False, True))
    least = ceil(low * 1e6) / 1e6 if low is not None else None
    return least, floor(high * 1e6) / 1e6 if high is not None else None


def _possible(problem: Problem) -> str:
    """The range of B that this order and degree can have, in words."""
    if not isinstance(problem.B, float):
        return ""
    low, high = possible_velocities(problem)
    least = f"from {low:.7g}" if low is not None else ""
    greatest = f"up to {high:.7g}" if high is not None else ""
    return f"; so does a B {' '.join(p for p in (least, greatest) if p)}" if least or greatest else ""


def _extreme(problem: Problem, *, greatest: bool) -> float | None:
    if greatest and problem.peak_at is None:
        return None
    extreme = extreme_velocity(problem, greatest=greatest)
    optimum = solve(extreme.program).optimum
    return None if optimum is None else float(optimum.x[extreme.places["B"]])
