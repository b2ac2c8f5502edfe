"""Proofs over the places of a peak hold in exact arithmetic, and no longer where anything that they need is missing."""

import json
from dataclasses import replace
from fractions import Fraction
from functools import cache

import pytest

from optlaws import Certificate, Chebyshev, Leaf, Problem, at_least, synthesize
from optlaws.verification import verify
from tests.internals.verification import prove

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
