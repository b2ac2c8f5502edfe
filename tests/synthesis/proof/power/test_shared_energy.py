"""Boxes for B, C and D of loaders: rows hold for every law in a box, lines are above, proofs stand by themselves."""

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
    InputError,
    MotionLaw,
    Problem,
    Solution,
    Tightening,
    at_most,
    inertial_loader,
    synthesize,
)
from optlaws.verification import verify
from tests.internals.balancing import NAMES, D_loader
from tests.internals.synthesis import Box, BoxRows, _points, rows_of, secant_over_inverse, secant_over_root
from tests.sampling import examples

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
