"""The lower bound: where its contacts are, that it stands by itself, and that nothing beats it."""

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    BoundaryConditions,
    Certificate,
    Chebyshev,
    Contact,
    InfeasibleProblem,
    InputError,
    Problem,
    Solution,
    SolverFailure,
    at_most,
    between,
    law_from_z,
    synthesize,
)
from tests.sampling import examples, sampled
from tests.synthesis.independent import acceleration_of, extremes, polynomial, velocity_of, z_of

PLAIN = [
    Problem(B=1.641, order=4, basis=Chebyshev(3)),
    Problem(B=1.859, order=4, basis=Chebyshev(9)),
    Problem(B=2.5, order=3, basis=Chebyshev(9)),
    Problem(B=2.5, order=4, basis=Chebyshev(9), monotone=True),
    Problem(B=1.4, order=2, basis=Chebyshev(15)),
    Problem(B=1.3, order=1, basis=Chebyshev(7)),
    Problem(B=2.3, order=6, basis=Chebyshev(8), monotone=True),
    Problem(B=1.53, order=5, basis=Chebyshev(13)),
]
GENERAL = [
    Problem(B=1.7, order=4, basis=Chebyshev(7), minimise="J"),
    Problem(B=1.859, order=5, basis=Chebyshev(7), minimise="snap"),
    Problem(B=1.7, order=3, basis=Chebyshev(9), minimise="C/8 + J/64"),
    Problem(order=4, basis=Chebyshev(9), minimise="max(C/4, J/32)"),
    Problem(B=between(1.5, 1.6), inflexion=0.5, order=4, basis=Chebyshev(9)),
    Problem(B=1.7, order=3, basis=Chebyshev(9), J=at_most(60.0)),
    Problem(B=1.7, order=3, basis=Chebyshev(9), minimise="C/4 + J/128", J=at_most(50.0)),
    Problem(B=1.8, C=at_most(5.0), order=3, basis=Chebyshev(9), minimise="J"),
    Problem(B=2.5, order=3, basis=Chebyshev(9), symmetric=False),
    Problem(B=2.5, order=3, basis=Chebyshev(9), symmetric=False, monotone=True),
    Problem(B=1.641, order=4, basis=Chebyshev(9), minimise="rms_c"),
    Problem(B=1.7, order=4, basis=Chebyshev(7), minimise="rms_c + C/8", J=at_most(60.0)),
    Problem(B=1.7, order=4, basis=Chebyshev(7), minimise="D"),
    Problem(B=2.1, order=2, basis=Chebyshev(9), minimise="D", monotone=True),
    Problem(B=1.7, order=4, basis=Chebyshev(7), D=at_most(4.0)),
    Problem(B=2.1, order=2, basis=Chebyshev(7), minimise="C + D", symmetric=False),
]
PROBLEMS = [*PLAIN, *GENERAL]
INFEASIBLE = [
    Problem(B=1.53, order=4, basis=Chebyshev(1)),
    Problem(B=1.12, order=4, basis=Chebyshev(3)),
    Problem(B=2.9, order=2, basis=Chebyshev(3), monotone=True),
    Problem(B=1.7, C=at_most(4.8), order=4, basis=Chebyshev(9)),
    Problem(B=between(1.5, 1.6), inflexion=0.5, J=at_most(40.0), order=4, basis=Chebyshev(9)),
]


def shape(problem: Problem) -> str:
    kind = "".join(["-monotone" * problem.monotone, "-unsymmetric" * (not problem.symmetric)])
    bounds = "".join(f"-{name}" for name in "CDJ" if getattr(problem, name) is not None)
    return f"l{problem.order}-n{polynomial(problem).degree}-B{problem.B}-{problem.minimise}{bounds}{kind}"


every_problem = pytest.mark.parametrize("problem", PROBLEMS, ids=shape)
every_plain = pytest.mark.parametrize("problem", PLAIN, ids=shape)


@cache
def solution_of(problem: Problem) -> Solution:
    return synthesize(problem)


@cache
def proof_of(problem: Problem) -> Certificate:
    with pytest.raises(InfeasibleProblem) as caught:
        synthesize(problem)
    proof = caught.value.proof
    assert isinstance(proof, Certificate)
    return proof


@every_problem
def test_the_bound_is_the_optimum_where_it_is_convex(problem: Problem) -> None:
    solution = solution_of(problem)
    certificate = solution.certificate
    assert certificate.problem == problem
    assert certificate.program == ("objective" if problem.convex else "relaxed")
    assert solution.lower_bound == max(certificate.bound, solution.best_possible or -np.inf)
    if problem.convex:
        assert certificate.bound == pytest.approx(solution.objective, rel=1e-8)


@every_problem
def test_contacts_are_where_the_law_touches(problem: Problem) -> None:
    solution = solution_of(problem)
    law = solution.law
    if solution.certificate.program != "objective":
        return  # its contacts are those of a program that is not as tight
    greatest = {name: getattr(law.constants, name).value for name in "CDJ"} | {"b": law.peak(1).value}
    greatest |= {"snap": law.peak(4).value, "C_plus": law.extrema(2)[1].value, "C_minus": -law.extrema(2)[0].value}
    for contact in solution.certificate.contacts:
        name, k, m = contact.constraint, contact.k, contact.multiplier
        nu = {"b": 1, "C": 2, "C_plus": 2, "C_minus": 2, "J": 3, "snap": 4}.get(name)
        assert m >= -1e-12
        if m < 1e-9:
            continue
        if nu is not None:
            assert contact.sign * law(k, nu) == pytest.approx(greatest[name], rel=1e-9)
        elif name == "chord":
            assert law.b(k) == pytest.approx(law.b(0.5), rel=1e-9)
        elif name in {"ratio", "forward"}:
            assert law.b(k) == pytest.approx(0.0, abs=1e-9 * law.b(0.5))


# --- it stands by itself ---

READER = """
import json, sys
sys.modules.update(dict.fromkeys(("casadi", "scipy", "mpmath", "matplotlib")))
from optlaws.synthesis.proof.certificate import Certificate
for line in sys.stdin:
    found = Certificate.from_dict(json.loads(line))
    print(repr(float(found.bound)), found.proves_infeasible)
"""


def test_it_is_recomputed_from_json_without_a_solver() -> None:
    certificates = [solution_of(problem).certificate for problem in PROBLEMS]
    proofs = [proof_of(problem) for problem in INFEASIBLE]
    text = "".join(
        json.dumps(certificate.to_dict(), allow_nan=False) + "\n" for certificate in [*certificates, *proofs]
    )
    done = subprocess.run([sys.executable, "-c", READER], input=text, capture_output=True, text=True, check=True)
    expected = [f"{float(certificate.bound)!r} False" for certificate in certificates] + ["-inf True"] * len(proofs)
    assert done.stdout.splitlines() == expected
    assert done.stderr == ""


@every_problem
def test_json_gives_an_equal_certificate_whatever_bound_is_written(problem: Problem) -> None:
    certificate = solution_of(problem).certificate
    data = json.loads(json.dumps(certificate.to_dict()))
    assert data["bound"] == certificate.bound
    data["bound"] = 1e9
    again = Certificate.from_dict(data)
    assert again == certificate
    assert again.bound == certificate.bound


# --- tampering ---


# what rounding may leave: a bound that meets the objective may stand a little above it
ROUNDING = 1 + 1e-13


Forgery = Callable[[Certificate], Certificate]
NAMES = ["C", "C_plus", "C_minus", "J", "snap", "D", "b", "chord", "ratio", "forward", "rms_c", "B at most"]
NAMES += ["B at least", "J at most", "tangent", "b / sqrt(2k)", "root of D", "part 1 of max(0.25*C, 0.03125*J)", ""]
SHARES, PLACES = st.floats(-3.0, 3.0), st.floats(0.0, 1.0)


def changed(which: int, change: Callable[[Contact], Contact]) -> Forgery:
    """With another contact in place of one."""

    def forge(proof: Certificate) -> Certificate:
        contacts = list(proof.contacts)
        contacts[which % len(contacts)] = change(contacts[which % len(contacts)])
        return proof.with_leaf(contacts=tuple(contacts))

    return forge


def turned(contact: Contact, seed: int, size: float) -> Contact:
    """With another direction, where it has one."""
    step = size * np.random.default_rng(seed).normal(size=len(contact.direction))
    return replace(contact, direction=tuple((np.array(contact.direction) + step).tolist()))


def weighed(which: int, factor: float, shift: float, more: list[float]) -> Forgery:
    """With an equation weighed otherwise, and more equations."""

    def forge(proof: Certificate) -> Certificate:
        weights = list(proof.equations)
        if weights:
            weights[which % len(weights)] = weights[which % len(weights)] * factor + shift
        return proof.with_leaf(equations=(*weights, *more))

    return forge


def of_kind(program: str) -> Forgery:
    """As a proof of another kind."""
    return lambda proof: Certificate.of_leaf(
        proof.problem, proof.contacts, proof.equations, program, proof.tangent or 0.0
    )


def a_contact(change: st.SearchStrategy[Callable[[Contact], Contact]]) -> st.SearchStrategy[Forgery]:
    return st.builds(changed, st.integers(0, 30), change)


INVENTED = st.builds(
    Contact,
    st.sampled_from([name for name in NAMES if name != "rms_c"]),
    st.sampled_from([1.0, -1.0]),
    PLACES,
    st.floats(-10.0, 10.0, allow_subnormal=False),
)
#: what becomes of a certificate
FORGERIES: dict[str, st.SearchStrategy[Forgery]] = {
    "multiplier": a_contact(SHARES.map(lambda share: lambda c: replace(c, multiplier=c.multiplier * share))),
    "place": a_contact(PLACES.map(lambda k: lambda c: replace(c, k=k))),
    "place beside": a_contact(
        st.floats(-1e-3, 1e-3).map(lambda step: lambda c: replace(c, k=min(max(c.k + step, 0.0), 1.0)))
    ),
    "name": a_contact(st.sampled_from(NAMES).map(lambda name: lambda c: replace(c, constraint=name))),
    "sign": a_contact(st.just(lambda c: replace(c, sign=-c.sign))),
    "direction": a_contact(
        st.tuples(st.integers(0, 2**32 - 1), st.floats(0.0, 3.0)).map(lambda by: lambda c: turned(c, *by))
    ),
    "equations": st.builds(weighed, st.integers(0, 30), SHARES, SHARES, st.lists(st.just(3.0), max_size=1)),
    "tangent": st.floats(-10.0, 10.0).map(lambda tangent: lambda proof: replace(proof, tangent=tangent)),
    "kind": st.sampled_from(["objective", "relaxed", "violation", "wishful"]).map(of_kind),
    "invented contacts": st.builds(
        lambda contacts, weights: lambda proof: proof.with_leaf(contacts=tuple(contacts), equations=tuple(weights)),
        st.lists(INVENTED, min_size=1, max_size=6),
        st.lists(st.floats(-10.0, 10.0), max_size=2),
    ),
}
#: whose contacts have directions, and whose power has a tangent
OF_KIND = {
    "direction": [p for p in PROBLEMS if "rms" in str(p.minimise)],
    "tangent": [p for p in PROBLEMS if not p.convex],
}


@pytest.mark.parametrize("kind", FORGERIES)
@given(data=st.data())
def test_a_forged_certificate_proves_nothing_false(kind: str, data: st.DataObject) -> None:
    problem = data.draw(st.sampled_from(OF_KIND.get(kind, PROBLEMS)))
    solution, forge = solution_of(problem), data.draw(FORGERIES[kind])
    try:
        forged = forge(solution.certificate)
    except InputError:
        assert kind == "kind"
        return
    assert forged.bound <= solution.objective * ROUNDING
    assert not forged.proves_infeasible


@every_problem
def test_without_one_contact_it_proves_nothing_false(problem: Problem) -> None:
    solution = solution_of(problem)
    contacts = solution.certificate.contacts
    for i in range(len(contacts)):
        forged = solution.certificate.with_leaf(contacts=contacts[:i] + contacts[i + 1 :])
        assert forged.bound <= solution.objective * ROUNDING
        assert not forged.proves_infeasible
    for nothing in (
        solution.certificate.with_leaf(contacts=()),
        solution.certificate.with_leaf(contacts=(), equations=()),
    ):
        assert nothing.bound <= solution.objective / 2
        assert not nothing.proves_infeasible


@pytest.mark.sample(2)
@pytest.mark.parametrize("problem", INFEASIBLE, ids=shape)
def test_a_proof_of_infeasibility_says_nothing_of_a_feasible_problem(problem: Problem) -> None:
    feasible = replace(problem, B=1.859, C=None, J=None, basis=Chebyshev(9), order=3)
    assert solution_of(feasible).objective > 0.0
    assert not replace(proof_of(problem), problem=feasible).proves_infeasible


@pytest.mark.sample(4)
@pytest.mark.parametrize("problem", [p for p in PROBLEMS if isinstance(p.B, float)], ids=shape)
@pytest.mark.parametrize("B", sampled([1.5, 1.2, 1.8, 2.4, 2.1, 2.8]))
def test_with_another_b_it_speaks_of_another_problem_truly(problem: Problem, B: float) -> None:
    forged = replace(solution_of(problem).certificate, problem=replace(problem, B=B))
    try:
        true = solution_of(replace(problem, B=B)).objective
    except (InfeasibleProblem, SolverFailure):
        return
    assert forged.bound <= true * (1 + 1e-12)


def test_forward_contacts_count_only_where_b_at_least_0_is_asked() -> None:
    problem = Problem(B=2.5, order=4, basis=Chebyshev(9), monotone=True)
    asked = solution_of(problem)
    free = solution_of(replace(problem, monotone=False))
    assert any(c.constraint == "ratio" for c in asked.certificate.contacts)
    assert replace(asked.certificate, problem=free.problem).bound <= free.objective < asked.objective
    # the other way round the bound holds for fewer laws, and stays
    assert replace(free.certificate, problem=problem).bound == pytest.approx(free.certificate.bound, rel=1e-13)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: Contact("C", 1.0, -0.1, 1.0),
        lambda: Contact("C", 1.0, 1.1, 1.0),
        lambda: Contact("C", 1.0, float("nan"), 1.0),
        lambda: Contact("C", 1.0, 0.1, float("inf")),
        lambda: Contact("C", 1.0, 0.1, float("nan")),
        lambda: Contact("C", 0.0, 0.1, 1.0),
        lambda: Contact("C", 2.0, 0.1, 1.0),
        lambda: Contact("C", float("nan"), 0.1, 1.0),
    ],
)
def test_a_contact_that_makes_no_sense_is_refused(wrong: Callable[[], Contact]) -> None:
    with pytest.raises(InputError):
        wrong()


@pytest.mark.parametrize("data", [None, 3, "certificate", [], {}])
def test_what_is_no_table_is_no_certificate(data: Any) -> None:
    with pytest.raises(InputError, match="not a certificate"):
        Certificate.from_dict(data)


# --- no law beats the bound ---


@cache
def inner(problem: Problem) -> np.ndarray:
    """Z of a law well inside the constraints: the mean of optima of poorer shapes and other norms."""
    parts = []
    for degree in range(polynomial(problem).degree, 0, -2):
        try:
            solution = solution_of(replace(problem, basis=Chebyshev(degree)))
        except InfeasibleProblem:
            break
        parts.append(np.pad(np.asarray(z_of(solution)), (0, polynomial(problem).degree - degree)))
    return np.asarray(np.mean(parts, axis=0))


@examples(60)
@given(
    problem=st.sampled_from(PLAIN), seed=st.integers(0, 2**32 - 1), symmetric=st.booleans(), size=st.floats(1e-3, 30.0)
)
def test_no_feasible_law_beats_the_bound(problem: Problem, seed: int, symmetric: bool, size: float) -> None:  # noqa: FBT001
    solution = solution_of(problem)
    order, basis = problem.order, polynomial(problem)
    step = np.random.default_rng(seed).normal(size=basis.size) * 4.0**order * size
    if symmetric:
        step[::2] = 0.0
    step = tangent(order, step, symmetric=symmetric)
    start = inner(problem)
    scale = 1.0
    for _ in range(60):
        law = law_from_z(BoundaryConditions.rest(order), start + scale * step, basis)
        b = acceleration_of(law).integ(lbnd=0.0) + law.to_dict()["b0"]
        lowest, highest = extremes(b)
        if highest <= velocity_of(problem) * (1 + 1e-12) and (not problem.monotone or lowest >= -1e-12):
            break
        scale /= 2.0
    assert law.b(0.5) == pytest.approx(problem.B, rel=1e-11)
    assert law.peak(2).value >= solution.lower_bound * (1 - 1e-9)


def tangent(order: int, step: np.ndarray, *, symmetric: bool) -> np.ndarray:
    """The step without what it changes in b(1/2) and, through Z_0, in c(1/2)."""
    k, y = np.polynomial.Polynomial([0.0, 1.0]), np.polynomial.chebyshev.Chebyshev
    edge = (k * (k - 1.0)) ** order
    z = y(step, domain=(0.0, 1.0))
    step = step.copy()
    step[1] -= z.deriv()(0.5) / 2.0  # b(1/2) = k^l (k-1)^l Z'(1/2)
    if not symmetric:
        z, bend = y(step, domain=(0.0, 1.0)), edge.deriv(2)(0.5)
        step[0] -= (bend * z(0.5) + edge(0.5) * z.deriv(2)(0.5)) / bend
    return step


def test_the_mean_of_a_law_and_its_mirror_image_is_no_worse() -> None:
    problem = Problem(B=1.859, order=4, basis=Chebyshev(9))
    step = tangent(4, np.random.default_rng(1).normal(size=10) * 20.0, symmetric=False)
    z = np.asarray(z_of(solution_of(problem))) + step
    mirrored = -z * (-1.0) ** np.arange(10)
    one, mean = (law_from_z(BoundaryConditions.rest(4), part, Chebyshev(9)) for part in (z, (z + mirrored) / 2))
    assert mean.peak(2).value <= one.peak(2).value
    assert mean.b(0.5) == pytest.approx(one.b(0.5), rel=1e-13)


@pytest.mark.parametrize("multiplier", [1e300, 1e308])
def test_sums_beyond_double_precision_prove_nothing(multiplier: float) -> None:
    solution = synthesize(Problem(B=1.859, order=4, basis=Chebyshev(5)))
    data = solution.certificate.to_dict()
    data["contacts"][0]["multiplier"] = multiplier
    assert Certificate.from_dict(data).bound <= solution.objective
