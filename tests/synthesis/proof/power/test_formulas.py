"""Formulas that are not convex, proven by boxes: their planes, tight bounds, exact checks, what is tampered with."""

import json
from dataclasses import replace

import numpy as np
import pytest

from optlaws import Certificate, Chebyshev, Functional, Problem, at_most, peak, synthesize
from optlaws.verification import verify
from tests.internals.synthesis import Box, FormulaRows, applies, leaves, model_of, searched
from tests.sampling import sampled

SMALL = Problem(B=1.8, order=3, basis=Chebyshev(5))
PROBLEMS = [
    replace(SMALL, minimise=peak("(1 + 0.5*a^2)*c + 0.5*a*b^2")),
    replace(SMALL, minimise=peak("b*c")),
    replace(SMALL, minimise=peak("sin(3*b)*c")),
    replace(SMALL, B=None, minimise="C", bounds={"peak(b*c)": at_most(3.5)}),
    replace(SMALL, minimise=peak("b*c + 0.1*abs(b)", side="high")),
    replace(SMALL, basis=Chebyshev(3), symmetric=False, minimise=peak("b*c + 0.3*b")),
    replace(SMALL, minimise=peak("c/(2 + b)")),
    replace(SMALL, B=None, minimise="C/4 + 0.2*peak(b*c)"),
    replace(SMALL, B=None, J=at_most(80), minimise=peak("b*c")),
    replace(SMALL, B=1.7, minimise="rms_c", bounds={"peak(b*c + 0.2*b^2)": at_most(4.5)}),
    replace(SMALL, minimise=peak("c^2 - b^2")),
]


@pytest.mark.sample(3)
@pytest.mark.parametrize("problem", sampled(PROBLEMS, 5), ids=repr)
def test_a_tight_bound_meets_the_objective_and_is_proven_exactly(problem: Problem) -> None:
    solution = synthesize(problem, bound="tight")
    assert solution.status == "optimal"
    assert solution.gap < 1e-8
    assert solution.objective <= synthesize(problem).objective * (1.0 + 1e-9)
    data = json.loads(json.dumps(solution.to_dict()))
    assert Certificate.from_dict(data["power_certificate"]).bound == solution.lower_bound
    assert verify(data).proven


def test_power_as_a_formula_has_the_optimum_of_power() -> None:
    formula = synthesize(replace(PROBLEMS[1], basis=Chebyshev(3)), bound="tight")
    power = synthesize(replace(SMALL, basis=Chebyshev(3), minimise="D"), bound="tight")
    assert formula.objective == pytest.approx(power.objective, rel=1e-9)
    assert formula.lower_bound == pytest.approx(power.lower_bound, rel=1e-8)


@pytest.mark.sample(8)
@pytest.mark.parametrize("problem", PROBLEMS, ids=repr)
def test_no_law_in_a_box_is_below_a_plane(problem: Problem) -> None:
    assert applies(problem)
    solution, random = synthesize(problem), np.random.default_rng(3)
    space = model_of(problem).space
    points = np.sort(random.uniform(0.1, 0.5 if space.symmetric else 0.9, space.terms))
    rows = FormulaRows(problem, 2.0 * solution.objective, points.tolist())
    worth = {
        leaf.name: leaf.value(solution.law) for _, leaf in leaves(problem.objective) if isinstance(leaf, Functional)
    }
    worth["B"] = solution.law.constants.B.value
    own = sorted(rows.model.places, key=rows.model.places.__getitem__)
    middle = np.append(solution.law.b(points), [worth[name] for name in own])
    half = 0.05 * random.uniform(0.1, 1.0, rows.size)
    box, k = Box(middle - half, middle + half), random.uniform(0.02, 0.48, 12)
    places, compared = rows.places(k), 0
    for name, sign in rows.kinds(box):
        planes = rows.curved(box, places, name, np.full(len(k), sign))
        family = next(one for one in rows.families if name.endswith(f"of {one.name}") and sign in one.signs)
        for _ in range(6):
            values = box.low + (box.high - box.low) * random.uniform(0.0, 1.0, rows.size)
            x = np.append(rows.coordinates(values), values[space.terms :])
            law = space.law(x[: space.terms])
            within = (np.abs(law.b(k)) <= rows.greatest["B"]) & (np.abs(law.c(k)) <= rows.greatest.get("C", np.inf))
            within &= planes.any(axis=1)
            truth = sign * np.asarray(family.value(x, family.u(k))) - family.right_side(x)
            assert ((planes @ np.append(values, 1.0))[within] <= truth[within] + 1e-9 * np.abs(truth).max()).all()
            compared += int(within.sum())
    assert compared > 100


@pytest.mark.long
def test_no_claim_above_the_optimum_is_ever_proven() -> None:
    problem = replace(PROBLEMS[1], basis=Chebyshev(3))
    solution = synthesize(problem)
    assert solution.active_set is not None
    search = searched(problem, solution.objective * 1.001, solution.active_set.x, 60, lambda _: False)
    assert search.certificate is None


def test_what_is_tampered_with_proves_nothing() -> None:
    solution = synthesize(replace(PROBLEMS[1], basis=Chebyshev(3)), bound="tight")
    proof = solution.power_certificate
    assert proof is not None
    assert replace(proof, claim=proof.bound * 1.01).bound == -np.inf
    assert replace(proof, tree=proof.tree[:-1]).bound == -np.inf
    assert replace(proof, problem=replace(proof.problem, B=1.5)).bound == -np.inf
