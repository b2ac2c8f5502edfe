"""Integrals and root mean squares that are not convex, proven by boxes: their planes, tight bounds, what is changed."""

import json
from dataclasses import replace

import numpy as np
import pytest

from optlaws import Certificate, Chebyshev, Problem, at_most, integral, rms, synthesize
from tests.internals.synthesis import Box, FormulaRows, applies
from tests.sampling import sampled

SMALL = Problem(B=1.8, order=3, basis=Chebyshev(3))
PROBLEMS = [
    replace(SMALL, minimise=rms("b*c")),
    replace(SMALL, minimise=integral("exp(c/5)*b^2")),
    replace(SMALL, basis=Chebyshev(5), minimise=integral("a^2*c^2")),
    replace(SMALL, minimise=rms("c*(1 + 0.3*a^2)", start=0.1, stop=0.7)),
    replace(SMALL, basis=Chebyshev(5), minimise=integral("sin(3*b)^2 + c^2/20")),
    replace(SMALL, symmetric=False, minimise=integral("(b*c)^2 + table(k, 0:0, 0.4:1, 1:0)*c^2")),
    replace(SMALL, B=None, C=at_most(7.0), minimise="C/4", bounds={"rms(b*c)": at_most(3.5)}),
    replace(SMALL, basis=Chebyshev(5), minimise=rms("b*c")),
]


@pytest.mark.sample(3)
@pytest.mark.parametrize("problem", sampled(PROBLEMS, each=3), ids=repr)
def test_a_tight_bound_meets_the_objective(problem: Problem) -> None:
    solution = synthesize(problem, bound="tight")
    assert solution.status == "optimal"
    assert solution.gap < 1e-8
    data = json.loads(json.dumps(solution.to_dict()))["power_certificate"]
    assert Certificate.from_dict(data).bound == solution.lower_bound
    assert Certificate.from_dict({**data, "claim": data["claim"] * 1.001}).bound == -np.inf
    assert Certificate.from_dict({**data, "steps": data["steps"][:-1]}).bound == -np.inf


@pytest.mark.sample(4)
@pytest.mark.parametrize("problem", PROBLEMS, ids=repr)
def test_no_law_in_a_box_is_below_a_plane(problem: Problem) -> None:
    assert applies(problem)
    random = np.random.default_rng(3)
    space = FormulaRows(problem, 10.0, ()).space
    points = np.sort(random.uniform(0.1, 0.5 if space.symmetric else 0.9, space.terms))
    rows = FormulaRows(problem, 10.0, points.tolist())
    [beneath] = rows.integrals.values()
    family, nothing = beneath.family, np.zeros(rows.size + 1)
    for width in (0.02, 0.1, 0.5):
        middle = random.uniform(0.5, 1.5, rows.terms)
        low, high = (np.append(middle + side * width, np.full(rows.variables - rows.terms, 1.0)) for side in (-1, 1))
        box, touching = Box(low, high), middle + width * random.uniform(-1.0, 1.0, rows.terms)
        # without equations, for these laws keep none
        beneath.rows.equations = lambda: np.zeros((0, rows.size + 1))  # type: ignore[method-assign]
        plane = beneath.row(box, touching, {}, nothing)
        if family.root:
            plane = plane + beneath._square(box, nothing)
        assert plane.any()
        for _ in range(20):
            law = np.append(
                middle + width * random.uniform(-1.0, 1.0, rows.terms), np.ones(rows.variables - rows.terms)
            )
            x = np.append(rows.coordinates(law), law[rows.terms :])
            value = float(replace(family, root=False).value(x, np.ones(1))[0])
            assert plane @ np.append(law, 1.0) <= value + 1e-9 * abs(value)
