"""The lower bound: what it says is checked from eq. 8 in exact rational arithmetic, and nothing beats it."""

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import comb

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf  # type: ignore[import-untyped]

from optlaws import (
    BoundaryConditions,
    Certificate,
    Chebyshev,
    Contact,
    InfeasibleProblem,
    InputError,
    Problem,
    Solution,
    construct,
    synthesize,
)
from optlaws.synthesis.certificate import CHORD, LOWER, MIDDLE, RATIO, UPPER
from tests.synthesis.independent import acceleration_of, extremes

PROBLEMS = [
    Problem(B=1.641, order=4, basis=Chebyshev(3)),
    Problem(B=1.859, order=4, basis=Chebyshev(9)),
    Problem(B=2.5, order=3, basis=Chebyshev(9)),
    Problem(B=2.5, order=4, basis=Chebyshev(9), monotone=True),
    Problem(B=1.4, order=2, basis=Chebyshev(15)),
    Problem(B=1.3, order=1, basis=Chebyshev(7)),
    Problem(B=2.3, order=6, basis=Chebyshev(8), monotone=True),
    Problem(B=1.53, order=5, basis=Chebyshev(13)),
]
INFEASIBLE = [
    Problem(B=1.53, order=4, basis=Chebyshev(1)),
    Problem(B=1.12, order=4, basis=Chebyshev(3)),
    Problem(B=2.9, order=2, basis=Chebyshev(3), monotone=True),
]
every_problem = pytest.mark.parametrize("problem", PROBLEMS, ids=lambda p: f"l{p.order}-n{p.basis.degree}-B{p.B:g}")
one_of = st.sampled_from(PROBLEMS)


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


# --- what the certificate sums, from eq. 8 in rational numbers ---


class Exact:
    """A polynomial in h = k - 1/2 with rational coefficients."""

    def __init__(self, powers: list[Fraction]) -> None:
        self.powers = powers

    def __call__(self, k: Fraction) -> Fraction:
        total = Fraction(0)
        for value in reversed(self.powers):
            total = total * (k - Fraction(1, 2)) + value
        return total

    def __mul__(self, other: "Exact") -> "Exact":
        product = [Fraction(0)] * (len(self.powers) + len(other.powers) - 1)
        for i, p in enumerate(self.powers):
            for j, q in enumerate(other.powers):
                product[i + j] += p * q
        return Exact(product)

    def derivative(self) -> "Exact":
        return Exact([n * value for n, value in enumerate(self.powers)][1:] or [Fraction(0)])


def edge(order: int) -> Exact:
    """k^l (k-1)^l = (h² - 1/4)^l."""
    powers = [Fraction(0)] * (2 * order + 1)
    for i in range(order + 1):
        powers[2 * i] = comb(order, i) * Fraction(-1, 4) ** (order - i)
    return Exact(powers)


def velocities(order: int, degree: int) -> list[Exact]:
    """b of S_l, then of k^l (k-1)^l (2k-1)^i for every i: even i too, which symmetric laws do not have."""
    shape = edge(order - 1)
    whole = Exact([Fraction(0), *(value / (n + 1) for n, value in enumerate(shape.powers))])
    stroke = whole(Fraction(1)) - whole(Fraction(0))
    found = [Exact([value / stroke for value in shape.powers])]
    for i in range(degree + 1):
        odd = Exact([*[Fraction(0)] * i, Fraction(2) ** i])
        found.append((edge(order) * odd).derivative())
    return found


def functional(order: int, b: Exact, constraint: str, k: Fraction) -> Fraction:
    """The left side f >= 0 or equation of a constraint, without C and B."""
    if constraint in {UPPER, LOWER}:
        return b.derivative()(k)
    if constraint == MIDDLE:
        return b(Fraction(1, 2))
    if constraint == CHORD:
        # (b(1/2) - b) / (1-2k)² by its powers of h; a term linear in h belongs to c(1/2) = 0 and is left out
        return Exact([-value / 4 for value in b.powers[2:]] or [Fraction(0)])(k)
    if k in {0, 1}:
        return quotient(order, b, k)
    return b(k) / (k * (1 - k)) ** (order - 1)


def quotient(order: int, b: Exact, k: Fraction) -> Fraction:
    """b / (k(1-k))^(l-1) at an end: the derivative of order l - 1 of both."""
    base = edge(order - 1)
    upper, lower = b, Exact([(-1) ** (order - 1) * value for value in base.powers])
    for _ in range(order - 1):
        upper, lower = upper.derivative(), lower.derivative()
    return upper(k) / lower(k)


SIGN = {UPPER: 1, LOWER: -1, CHORD: -1, RATIO: -1, MIDDLE: 1}
MIRROR = {UPPER: LOWER, LOWER: UPPER, CHORD: CHORD, RATIO: RATIO, MIDDLE: MIDDLE}


def with_mirror_images(certificate: Certificate) -> Iterator[tuple[str, Fraction, Fraction]]:
    for contact in certificate.contacts:
        k, half = Fraction(contact.k), Fraction(contact.multiplier) / 2
        yield contact.constraint, k, half
        yield MIRROR[contact.constraint], 1 - k, half


def largest(order: int, b: Exact, constraint: str) -> Fraction:
    return max(abs(functional(order, b, constraint, Fraction(i, 16))) for i in range(17))


def weak_duality(certificate: Certificate) -> tuple[Fraction, list[tuple[Fraction, Fraction]]]:
    """The sum at Z = 0, and for each power of Z the sum beside what its terms could come to at other places."""
    order = certificate.order
    base, *free = velocities(order, certificate.degree)
    contacts = [c for c in with_mirror_images(certificate) if c[2] > 0 or c[0] == MIDDLE]
    constant = Fraction(0)
    for name, k, m in contacts:
        constant += m * SIGN[name] * functional(order, base, name, k)
        if name == MIDDLE:
            constant -= m * Fraction(certificate.B)
    residuals = []
    for b in free:
        terms = [m * SIGN[name] * functional(order, b, name, k) for name, k, m in contacts]
        size = sum((abs(m) * largest(order, b, name) for name, _, m in contacts), Fraction(0))
        residuals.append((sum(terms, Fraction(0)), size))
    return constant, residuals


def share_of(certificate: Certificate) -> Fraction:
    return sum(
        (Fraction(c.multiplier) for c in certificate.contacts if c.constraint in {UPPER, LOWER} and c.multiplier > 0),
        Fraction(0),
    )


@every_problem
def test_the_bound_is_the_weak_duality_sum_of_eq_8(problem: Problem) -> None:
    solution = solution_of(problem)
    constant, residuals = weak_duality(solution.certificate)
    for left, size in residuals:
        assert abs(left) <= Fraction(1, 10**10) * size
    with mp.workdps(40):
        bound = mpf(constant.numerator) / constant.denominator
        share = share_of(solution.certificate)
        bound /= mpf(share.numerator) / share.denominator
        assert solution.lower_bound == pytest.approx(float(bound), rel=1e-10)
        assert solution.lower_bound <= bound * (1 + mpf("1e-15"))


@pytest.mark.parametrize("problem", INFEASIBLE, ids=lambda p: f"l{p.order}-n{p.basis.degree}-B{p.B:g}")
def test_a_proof_of_infeasibility_is_a_contradiction_in_eq_8(problem: Problem) -> None:
    proof = proof_of(problem)
    assert proof.proves_infeasible
    assert proof.bound == -np.inf
    assert all(c.constraint in {CHORD, RATIO, MIDDLE} for c in proof.contacts)
    constant, residuals = weak_duality(proof)
    assert constant > 0
    for left, size in residuals:
        assert abs(left) <= Fraction(1, 10**10) * size


@every_problem
def test_contacts_are_where_the_law_touches(problem: Problem) -> None:
    solution = solution_of(problem)
    law, C = solution.law, solution.objective
    for contact in solution.certificate.contacts:
        if contact.constraint == UPPER:
            assert law.c(contact.k) == pytest.approx(C, rel=1e-9)
        elif contact.constraint == LOWER:
            assert law.c(contact.k) == pytest.approx(-C, rel=1e-9)
        elif contact.constraint == CHORD:
            assert law.b(contact.k) == pytest.approx(problem.B, rel=1e-9)
        elif contact.constraint == RATIO:
            assert law.b(contact.k) == pytest.approx(0.0, abs=1e-9 * problem.B)
        if contact.constraint != MIDDLE:
            assert contact.multiplier >= -1e-12


# --- it stands by itself ---

READER = """
import json, sys
sys.modules.update(dict.fromkeys(("casadi", "scipy", "mpmath", "matplotlib", "flint")))
from optlaws.synthesis.certificate import Certificate
for line in sys.stdin:
    found = Certificate.from_dict(json.loads(line))
    print(repr(float(found.bound)), found.proves_infeasible)
"""


def test_it_is_recomputed_from_json_by_numpy_alone() -> None:
    certificates = [solution_of(problem).certificate for problem in PROBLEMS]
    proofs = [proof_of(problem) for problem in INFEASIBLE]
    text = "".join(json.dumps(one.to_dict(), allow_nan=False) + "\n" for one in [*certificates, *proofs])
    done = subprocess.run([sys.executable, "-c", READER], input=text, capture_output=True, text=True, check=True)
    wanted = [f"{float(one.bound)!r} False" for one in certificates] + ["-inf True"] * len(proofs)
    assert done.stdout.splitlines() == wanted
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


def altered(certificate: Certificate, index: int, change: Callable[[Contact], Contact]) -> Certificate:
    contacts = list(certificate.contacts)
    contacts[index] = change(contacts[index])
    return replace(certificate, contacts=tuple(contacts))


@given(problem=one_of, which=st.integers(0, 30), factor=st.floats(-3.0, 3.0))
def test_a_multiplier_that_is_scaled_proves_nothing_false(problem: Problem, which: int, factor: float) -> None:
    solution = solution_of(problem)
    index = which % len(solution.certificate.contacts)
    forged = altered(solution.certificate, index, lambda c: replace(c, multiplier=c.multiplier * factor))
    assert forged.bound <= solution.objective
    assert not forged.proves_infeasible


@given(problem=one_of, which=st.integers(0, 30), k=st.floats(0.0, 1.0))
def test_a_contact_that_is_moved_proves_nothing_false(problem: Problem, which: int, k: float) -> None:
    solution = solution_of(problem)
    index = which % len(solution.certificate.contacts)
    forged = altered(solution.certificate, index, lambda c: replace(c, k=k))
    assert forged.bound <= solution.objective
    assert not forged.proves_infeasible


@given(problem=one_of, which=st.integers(0, 30), step=st.floats(-1e-3, 1e-3))
def test_a_contact_that_is_moved_a_little_proves_nothing_false(problem: Problem, which: int, step: float) -> None:
    solution = solution_of(problem)
    index = which % len(solution.certificate.contacts)
    forged = altered(solution.certificate, index, lambda c: replace(c, k=min(max(c.k + step, 0.0), 1.0)))
    assert forged.bound <= solution.objective


@every_problem
def test_without_one_contact_it_proves_nothing_false(problem: Problem) -> None:
    solution = solution_of(problem)
    contacts = solution.certificate.contacts
    for i in range(len(contacts)):
        forged = replace(solution.certificate, contacts=contacts[:i] + contacts[i + 1 :])
        assert forged.bound <= solution.objective
        assert not forged.proves_infeasible
    assert replace(solution.certificate, contacts=()).bound == -np.inf
    assert not replace(solution.certificate, contacts=()).proves_infeasible


@every_problem
@pytest.mark.parametrize("B", [1.2, 1.5, 1.8, 2.1, 2.4, 2.8])
def test_with_another_b_it_speaks_of_another_problem_truly(problem: Problem, B: float) -> None:
    forged = replace(solution_of(problem).certificate, B=B)
    try:
        true = solution_of(replace(problem, B=B)).objective
    except InfeasibleProblem:
        return
    assert forged.bound <= true * (1 + 1e-12)


@given(
    problem=one_of,
    names=st.lists(st.sampled_from([UPPER, LOWER, CHORD, RATIO, MIDDLE]), min_size=1, max_size=6),
    data=st.data(),
)
def test_invented_contacts_prove_nothing_false(problem: Problem, names: list[str], data: st.DataObject) -> None:
    contacts = tuple(
        Contact(name, data.draw(st.floats(0.0, 1.0)), data.draw(st.floats(-10.0, 10.0, allow_subnormal=False)))
        for name in names
    )
    forged = replace(solution_of(problem).certificate, contacts=contacts)
    assert forged.bound <= solution_of(problem).objective
    assert not forged.proves_infeasible


def test_forward_contacts_count_only_where_b_at_least_0_is_asked() -> None:
    problem = Problem(B=2.5, order=4, basis=Chebyshev(9), monotone=True)
    asked = solution_of(problem)
    free = solution_of(replace(problem, monotone=False))
    assert any(c.constraint == RATIO for c in asked.certificate.contacts)
    assert replace(asked.certificate, monotone=False).bound <= free.objective < asked.objective
    # the other way round the bound holds for fewer laws, and stays
    assert replace(free.certificate, monotone=True).bound == free.lower_bound


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: Contact("c < C", 0.1, 1.0),
        lambda: Contact(UPPER, -0.1, 1.0),
        lambda: Contact(UPPER, 1.1, 1.0),
        lambda: Contact(UPPER, float("nan"), 1.0),
        lambda: Contact(UPPER, 0.1, float("inf")),
        lambda: Contact(UPPER, 0.1, float("nan")),
    ],
)
def test_a_contact_that_makes_no_sense_is_refused(wrong: Callable[[], Contact]) -> None:
    with pytest.raises(InputError):
        wrong()


# --- no law beats the bound ---


@cache
def inner(problem: Problem) -> np.ndarray:
    """Z of a law well inside the constraints: the mean of optima of poorer shapes and other norms."""
    parts = []
    for degree in range(problem.basis.degree, 0, -2):
        try:
            found = solution_of(replace(problem, basis=Chebyshev(degree)))
        except InfeasibleProblem:
            break
        parts.append(np.pad(np.asarray(found.z), (0, problem.basis.degree - degree)))
    return np.asarray(np.mean(parts, axis=0))


@settings(max_examples=60)
@given(
    problem=one_of,
    seed=st.integers(0, 2**32 - 1),
    symmetric=st.booleans(),
    size=st.floats(1e-3, 30.0),
)
def test_no_feasible_law_beats_the_bound(problem: Problem, seed: int, symmetric: bool, size: float) -> None:  # noqa: FBT001
    solution = solution_of(problem)
    order, basis = problem.order, problem.basis
    step = np.random.default_rng(seed).normal(size=basis.size) * 4.0**order * size
    if symmetric:
        step[::2] = 0.0
    step = tangent(order, step, symmetric=symmetric)
    start = inner(problem)
    scale = 1.0
    for _ in range(60):
        law = construct(BoundaryConditions.rest(order), start + scale * step, basis)
        b = acceleration_of(law).integ(lbnd=0.0) + law.to_dict()["b0"]
        lowest, highest = extremes(b)
        if highest <= problem.B * (1 + 1e-12) and (not problem.monotone or lowest >= -1e-12):
            break
        scale /= 2.0
    assert law.b(0.5) == pytest.approx(problem.B, rel=1e-11)
    assert law.peak(2).value >= solution.lower_bound * (1 - 1e-9)


def tangent(order: int, step: np.ndarray, *, symmetric: bool) -> np.ndarray:
    """The step without what it changes in b(1/2) and, through Z_0, in c(1/2)."""
    k, y = Fraction(1, 2), np.polynomial.chebyshev.Chebyshev
    weight = float(edge(order)(k))
    z = y(step, domain=(0.0, 1.0))
    step = step.copy()
    step[1] -= z.deriv()(0.5) / 2.0  # b(1/2) = k^l (k-1)^l Z'(1/2)
    if not symmetric:
        z = y(step, domain=(0.0, 1.0))
        bend = edge(order).derivative().derivative()
        step[0] -= (float(bend(k)) * z(0.5) + weight * z.deriv(2)(0.5)) / float(bend(k))
    return step


def test_the_mean_of_a_law_and_its_mirror_image_is_no_worse() -> None:
    problem = Problem(B=1.859, order=4, basis=Chebyshev(9))
    step = tangent(4, np.random.default_rng(1).normal(size=10) * 20.0, symmetric=False)
    z = np.asarray(solution_of(problem).z) + step
    mirrored = -z * (-1.0) ** np.arange(10)
    one, mean = (construct(BoundaryConditions.rest(4), part, Chebyshev(9)) for part in (z, (z + mirrored) / 2))
    assert mean.peak(2).value <= one.peak(2).value
    assert mean.b(0.5) == pytest.approx(one.b(0.5), rel=1e-13)
