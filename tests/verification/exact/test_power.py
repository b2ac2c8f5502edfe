"""Trees over boxes with every rounding enclosed."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

from optlaws import BoundaryConditions, Certificate, Chebyshev, Problem, Split, synthesize
from optlaws.verification import exact_bound, verify

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
