"""Boxes for formulas and loaders: rows hold for every law in a box, and tight bounds meet the objective."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    Certificate,
    Chebyshev,
    Functional,
    InputError,
    MotionLaw,
    Problem,
    Solution,
    Tightening,
    Window,
    at_most,
    inertial_loader,
    peak,
    synthesize,
)
from optlaws.verification import verify
from tests.internals.balancing import NAMES, D_loader
from tests.internals.synthesis import (
    Box,
    BoxRows,
    FormulaRows,
    _points,
    applies_to_formulas,
    leaves,
    model_of,
    rows_of,
    searched,
    secant_over_inverse,
    secant_over_root,
)
from tests.sampling import examples, sampled

PROBLEM = Problem(B=1.7, order=3, basis=Chebyshev(7), monotone=True, minimise="C_loader")
OBJECTIVES = ("C_loader", "D_loader", "0.5*C/4 + 0.5*C_loader/4", "D_loader/2 + C_loader/4 + B_loader + C/20")
SHARES = st.lists(st.floats(0.01, 1.0), min_size=5, max_size=5)
PLACES = st.lists(st.floats(0.0, 0.5), min_size=4, max_size=4)
SEEDS = st.integers(0, 2**32 - 1)


@cache
def corners() -> tuple[MotionLaw, ...]:
    """Laws at the corners, as it were, of all those with b >= 0."""
    return tuple(
        synthesize(replace(PROBLEM, minimise=name)).law for name in ("C", "J", "C_loader", "D_loader", "B_loader")
    )


@cache
def rows(minimise: str) -> BoxRows:
    problem = replace(PROBLEM, minimise=minimise)
    claim = 2.0 * synthesize(problem).objective
    found = rows_of(problem, claim, _points(problem, claim))
    assert found is not None
    return found


def values(boxes: BoxRows, law: MotionLaw) -> np.ndarray:
    """The variables of a box that a law has: velocities, peaks of the objective, and the integral."""
    peaks = {name: constant.value(law) for name, constant in NAMES.items()}
    own = [peaks[name] for name in sorted(boxes.model.places, key=boxes.model.places.__getitem__)]
    return np.array([*law.b(boxes.points), *own, 0.5 / inertial_loader(law).Y])


@examples(60)
@given(st.sampled_from(OBJECTIVES), SHARES, SEEDS, st.floats(-6.0, 0.0), PLACES)
def test_no_law_in_a_box_breaks_a_row(
    minimise: str, shares: list[float], seed: int, size: float, k: list[float]
) -> None:
    boxes, root = rows(minimise), rows(minimise).root()
    velocities = np.array(shares) @ np.array([law.b(boxes.points) for law in corners()]) / sum(shares)
    law = boxes.space.law(boxes.coordinates(velocities))
    at = values(boxes, law)
    objective = boxes.objective() @ np.append(at[: len(at) - 1], [0.0, 1.0])
    if objective > 0.0:
        return  # the boxes speak of laws below the claim only
    assert (at >= root.low - 1e-10).all()
    assert (at <= root.high + 1e-10).all()
    away = 10.0**size * np.random.default_rng(seed).random((2, len(at)))
    box = Box(at - away[0] * (at - root.low), at + away[1] * (root.high - at))
    places = boxes.places(np.array([0.0, 0.5, *k]))
    low, high = boxes.brackets(box, places.k, places.rows[0])  # type: ignore[attr-defined]
    assert (low <= law.b(places.k) + 1e-10).all()
    assert (high >= law.b(places.k) - 1e-10).all()
    point = np.append(at, 1.0)
    for name, sign in boxes.kinds(box):
        held = boxes.curved(box, places, name, np.full(len(places.k), sign))
        assert (held @ point).max() <= 1e-9, name
    assert {contact.constraint for contact, _ in boxes.beside(box)} == set(boxes.alone)
    assert all(row @ point <= 1e-9 for _, row in boxes.beside(box))


@examples(100)
@given(st.floats(1.01, 4.0), st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 0.999))
def test_lines_are_above_and_touch(B: float, t: float, first: float, last: float) -> None:
    most = B / max(t * t, 0.02) * 0.999
    low, high = sorted((first * most, last * most))
    square = np.array([t * t])
    line = secant_over_root(B, square, np.array([low]), np.array([high]))
    q = low + (high - low) * np.linspace(0.0, 1.0, 4001) ** 3
    h = np.sqrt(q * (2.0 * B - t * t * q)) / (B - t * t * q)
    room = line.slope * q + line.height - h
    assert room.min() >= -1e-12 * (1.0 + h.max())
    # it is the lowest of its slope: somewhere it touches
    assert room.min() <= 1e-4 * (1.0 + h.max())
    assert line.least[0] <= h.min() * (1.0 + 1e-12)
    assert line.greatest[0] >= h.max() * (1.0 - 1e-12)
    inverse = secant_over_inverse(np.array([1.0]), np.array([1.0 + last]))
    b = np.linspace(1.0, 1.0 + last, 101)
    assert (inverse.slope * b + inverse.height - 1.0 / b).min() >= -1e-15


@cache
def proven(minimise: str) -> Solution:
    return synthesize(replace(PROBLEM, minimise=minimise), bound="tight")


@pytest.mark.sample(3)
@pytest.mark.parametrize("minimise", [*OBJECTIVES[:3], pytest.param(OBJECTIVES[3], marks=pytest.mark.long)])
def test_the_best_law_is_proven(minimise: str) -> None:
    solution = proven(minimise)
    assert solution.status.value == "optimal"
    assert 0.0 <= solution.gap <= 1e-8
    proof = solution.power_certificate
    assert proof is not None
    again = Certificate.from_dict(json.loads(json.dumps(proof.to_dict())))
    assert again.bound == proof.bound == solution.lower_bound
    # no law of the rest is below
    weights = {repr(term): weight for weight, term in solution.problem.objective.terms}
    for law in corners():
        assert sum(weight * NAMES[name].value(law) for name, weight in weights.items()) >= proof.bound


@pytest.mark.long
def test_a_bound_of_c_and_of_the_loader_are_part_of_the_proof() -> None:
    capped = synthesize(replace(PROBLEM, C=at_most(5.4)), bound="tight")
    assert capped.status.value == "optimal"
    assert capped.objective > proven("C_loader").objective
    held = synthesize(replace(PROBLEM, minimise="C", bounds={"C_loader": at_most(capped.objective)}), bound="tight")
    assert held.status.value == "optimal"
    assert held.objective == pytest.approx(5.4, rel=1e-7)


def test_what_is_not_proven_is_not_claimed() -> None:
    proof = proven("C_loader").power_certificate
    assert proof is not None
    assert replace(proof, claim=proof.bound * 1.001).bound == -np.inf
    assert replace(proof, tree=proof.tree[:-1]).bound == -np.inf
    assert replace(proof, problem=replace(PROBLEM, monotone=False)).bound == -np.inf
    assert replace(proof, problem=replace(PROBLEM, basis=Chebyshev(9))).bound == -np.inf
    contacts = [contact for node in proof.tree if isinstance(node, Tightening) for contact in node.contacts]
    assert {contact.constraint for contact in contacts} & {"C_loader, ++", "C_loader, -+"}


def test_exact_verification_says_that_it_knows_no_loaders() -> None:
    proof = proven("C_loader").power_certificate
    assert proof is not None
    with pytest.raises(InputError, match=r"exact verification knows .*, not C_loader"):
        verify(proof.to_dict())


@pytest.mark.long
def test_a_law_of_higher_degree_beats_a_bound_of_a_lower_one() -> None:
    """The proof speaks of its own degree: a bound is no limit."""
    lower, higher = (
        synthesize(replace(PROBLEM, basis=Chebyshev(degree), minimise=D_loader), bound="tight") for degree in (5, 9)
    )
    assert higher.objective < lower.lower_bound
    assert lower.status.value == higher.status.value == "optimal"


# --- formulas that are not convex ---


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


def test_a_window_whose_row_is_nothing_at_an_end_does_not_stop_the_search() -> None:
    """A displacement that is given there bounds no law; scaled to the box, what rounding leaves of it would."""
    windows = (Window("a", 0.0, 1.0), Window("c - b^2", high=4.0))
    problem = Problem(order=3, basis=Chebyshev(9), symmetric=False, windows=windows)
    solution = synthesize(problem, bound="tight")
    assert solution.status.value == "optimal"
    assert verify(solution.to_dict()).proven


def test_power_as_a_formula_has_the_optimum_of_power() -> None:
    formula = synthesize(replace(PROBLEMS[1], basis=Chebyshev(3)), bound="tight")
    power = synthesize(replace(SMALL, basis=Chebyshev(3), minimise="D"), bound="tight")
    assert formula.objective == pytest.approx(power.objective, rel=1e-9)
    assert formula.lower_bound == pytest.approx(power.lower_bound, rel=1e-8)


@pytest.mark.sample(8)
@pytest.mark.parametrize("problem", PROBLEMS, ids=repr)
def test_no_law_in_a_box_is_below_a_plane(problem: Problem) -> None:
    assert applies_to_formulas(problem)
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
