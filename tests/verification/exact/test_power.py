"""Trees over boxes and over places of a peak hold with every rounding enclosed."""

import json
from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from optlaws import (
    BoundaryConditions,
    Certificate,
    Chebyshev,
    InfeasibleProblem,
    Leaf,
    Problem,
    Split,
    at_least,
    synthesize,
)
from optlaws.verification import exact_bound, verify
from tests.internals.synthesis import rows_of
from tests.internals.verification import prove
from tests.sampling import examples

FIRST = Problem(B=1.641, order=4, basis=Chebyshev(5), minimise="D")
PROBLEMS = [
    replace(FIRST, basis=Chebyshev(9)),
    replace(FIRST, B=2.5, monotone=True),
    replace(FIRST, B=None, minimise="0.6*C/4 + 0.4*D/2.25"),
    replace(FIRST, minimise="max(C/4, D/2.25)"),
    replace(FIRST, minimise="rms_c + D"),
    replace(FIRST, B=None, minimise="C", D=4.0),
    Problem(order=3, symmetric=False, minimise="D", boundary=BoundaryConditions((0, 0.5, 0), (1, 0.2, 0))),
]


def proof(problem: Problem) -> Certificate:
    power_certificate = synthesize(problem, bound="tight").power_certificate
    assert power_certificate is not None
    return power_certificate


@pytest.mark.sample(3)
@pytest.mark.parametrize("problem", PROBLEMS, ids=str)
def test_what_doubles_prove_is_proven_in_balls(problem: Problem) -> None:
    solution = synthesize(problem, bound="tight")
    assert solution.status.value == "optimal"
    data = json.loads(json.dumps(solution.to_dict()["power_certificate"]))
    assert exact_bound(Certificate.from_dict(data)) == Fraction(solution.lower_bound)


def closes_whatever_rounds(certificate: Certificate) -> bool:
    """Whether boxes are empty after the same nodes with sums rounded down and with sums rounded up."""
    rows = rows_of(certificate.problem, certificate.claim or 0.0, certificate.points or ())
    assert rows is not None
    regions = [(rows.root(), rows.root())]
    for node in certificate.tree:
        box, inner = regions.pop()
        if isinstance(node, Split):
            left, left_inner = rows.after(box, node) or [], rows.after(inner, node) or []
        else:
            left, left_inner = rows.moved(box, node), rows.moved(inner, node, rounded=1)
        if len(left) != len(left_inner):
            return False
        regions += zip(left, left_inner, strict=True)
    return not regions


def all_is_proven(B: float, order: int, degree: int) -> None:
    try:
        solution = synthesize(Problem(B=B, order=order, basis=Chebyshev(degree), minimise="D"), bound="tight")
    except InfeasibleProblem:
        return
    certificate = solution.power_certificate
    assert certificate is not None
    assert exact_bound(certificate) == Fraction(solution.lower_bound)
    assert closes_whatever_rounds(certificate)


# rounding decided which of the last two nodes leaves no box
@example(B=1.6919579422228668, order=3, degree=7)
@example(B=1.7275155080248294, order=4, degree=5)
@given(B=st.floats(1.3, 2.6), order=st.sampled_from([3, 4]), degree=st.sampled_from([3, 5, 7]))
@examples(40)
def test_what_doubles_prove_of_the_least_power_is_proven_in_balls(B: float, order: int, degree: int) -> None:
    all_is_proven(B, order, degree)


@pytest.mark.long
def test_three_hundred_of_them_are() -> None:
    random = np.random.default_rng(11)
    for B in random.uniform(1.3, 2.6, 300).tolist():
        all_is_proven(B, int(random.choice([3, 4])), int(random.choice([3, 5, 7])))


def test_what_is_false_or_unfinished_is_not_proven() -> None:
    right = proof(FIRST)
    objective = synthesize(FIRST).objective
    assert exact_bound(right) is not None
    assert exact_bound(replace(right, claim=objective * (1 + 1e-7))) is None
    assert exact_bound(replace(right, tree=right.tree[:-1])) is None
    assert exact_bound(replace(right, tree=(*right.tree, right.tree[-1]))) is None
    assert exact_bound(replace(right, tree=(Split(-1, 1.0), *right.tree))) is None
    points = right.points or ()
    assert exact_bound(replace(right, points=points[:-1])) is None
    assert exact_bound(replace(right, points=(points[1], *points[1:]))) is None
    assert exact_bound(replace(right, problem=replace(FIRST, B=1.6))) is None
    assert exact_bound(replace(right, problem=replace(FIRST, minimise="C"))) is None


def test_each_place_of_a_file_takes_any_kind_of_certificate() -> None:
    data = json.loads(json.dumps(synthesize(FIRST, bound="tight").to_dict()))
    turned = {**data, "certificate": data["power_certificate"], "power_certificate": data["certificate"]}
    for file in (data, turned, {**turned, "power_certificate": None}, data["power_certificate"]):
        verification = verify(file)
        assert verification.proven
        assert verification.bound == data["lower_bound"]
    assert not verify({**turned, "certificate": data["certificate"], "power_certificate": None}).proven


# --- places of a peak ---


HELD_UP = {
    "velocity": Problem(B=at_least(2.2), order=3, minimise="rms_c"),
    "unsymmetric": Problem(B=at_least(2.2), order=2, basis=Chebyshev(7), minimise="J", symmetric=False),
    "acceleration": Problem(order=3, basis=Chebyshev(7), B=1.7, minimise="rms_c", C=at_least(7.5)),
    "one side": Problem(order=3, basis=Chebyshev(7), minimise="rms_c", bounds={"C_plus": at_least(7.0)}),
}


@cache
def proof_of(name: str) -> Certificate:
    proof = synthesize(HELD_UP[name], bound="tight").peak_certificate
    assert proof is not None
    return proof


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", HELD_UP)
def test_a_bound_over_the_places_of_a_peak_is_proven(name: str) -> None:
    proof = proof_of(name)
    assert prove(proof).value == Fraction(proof.claim or 0)
    claims = verify(json.loads(json.dumps(proof.to_dict()))).claims
    assert all(claim.proven for claim in claims)
    assert "steps" in {claim.name for claim in claims}


def test_neither_a_greater_claim_nor_a_lower_peak_nor_a_tree_with_less_in_it_is_proven() -> None:
    proof = proof_of("velocity")
    assert prove(replace(proof, claim=1.001 * (proof.claim or 0.0))).value is None
    assert prove(replace(proof, problem=replace(HELD_UP["velocity"], B=at_least(2.19)))).value is None
    assert prove(replace(proof, tree=proof.tree[:-1])).value is None
    weighed = [i for i, node in enumerate(proof.tree) if isinstance(node, Leaf) and node.contacts]
    for i in weighed[:: len(weighed) // 5]:
        less = (*proof.tree[:i], Leaf(), *proof.tree[i + 1 :])
        assert prove(replace(proof, tree=less)).value is None


def test_peaks_that_nothing_bounds_from_below_have_no_places() -> None:
    proof = proof_of("velocity")
    assert prove(replace(proof, problem=replace(HELD_UP["velocity"], B=None))).value is None
