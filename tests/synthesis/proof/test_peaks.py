"""Peaks bounded from below, proven over every place that they may have: what is claimed, and what is not accepted."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    B,
    BoundaryConditions,
    Certificate,
    Chebyshev,
    InputError,
    J,
    Leaf,
    Pieces,
    Problem,
    Solution,
    Split,
    at_least,
    at_most,
    synthesize,
)
from optlaws.verification import verify
from tests.internals.synthesis import PeakRows, PlaceRange
from tests.sampling import sampled
from tests.synthesis.judge import Judged, judge

FAST = Problem(B=at_least(2.2), order=3, minimise="rms_c")
EARLY = Problem(B=at_least(2.2), order=2, basis=Chebyshev(7), minimise="J", symmetric=False)
ENDS = BoundaryConditions((0, 0, 0), (1, 1.0, 0))


@pytest.fixture(scope="module")
def fast() -> Solution:
    return synthesize(FAST, bound="tight")


@pytest.fixture(scope="module")
def certificate(fast: Solution) -> Certificate:
    assert fast.peak_certificate is not None
    return fast.peak_certificate


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "problem",
    sampled(
        [
            EARLY,
            Problem(order=3, basis=Chebyshev(7), minimise="rms_c", J=at_least(600)),
            Problem(order=3, basis=Chebyshev(5), minimise="C", B=2.4, symmetric=False, boundary=ENDS),
            Problem(order=3, basis=Chebyshev(7), B=1.7, minimise="rms_c", C=at_least(7.5)),
        ]
    ),
    ids=repr,
)
def test_a_tight_bound_meets_the_objective(problem: Problem) -> None:
    quick, solution = synthesize(problem), synthesize(problem, bound="tight")
    assert (quick.status, solution.status) == ("local", "optimal")
    assert quick.peak_certificate is None
    judge_tight(solution)
    assert solution.objective == pytest.approx(quick.objective, rel=1e-8)
    assert solution.lower_bound > quick.lower_bound


def judge_tight(solution: Solution) -> None:
    peak_certificate = solution.peak_certificate
    assert peak_certificate is not None
    assert peak_certificate.bound == solution.lower_bound
    # what a solution without that certificate claims
    plain = max(solution.certificate.bound, -np.inf if solution.best_possible is None else solution.best_possible)
    judge(replace(solution, lower_bound=plain, status=type(solution.status).LOCAL))


def test_no_law_with_its_peak_at_a_place_is_better(fast: Solution) -> None:
    assert fast.constants.B.k == pytest.approx(0.5)
    places = [synthesize(replace(FAST, symmetric=False, inflexion=k)).objective for k in (0.2, 0.35, 0.45, 0.5)]
    assert places == sorted(places, reverse=True)
    assert places[-1] == pytest.approx(fast.objective, rel=1e-8)


def test_a_claim_above_what_a_law_has_is_not_proven(certificate: Certificate, fast: Solution) -> None:
    assert not replace(certificate, claim=fast.objective * (1.0 + 1e-7)).proven
    assert replace(certificate, claim=0.9 * certificate.bound).proven


def leaves_of(certificate: Certificate) -> list[int]:
    return [i for i, node in enumerate(certificate.tree) if isinstance(node, Leaf)]


def test_every_leaf_is_needed(certificate: Certificate) -> None:
    generator = np.random.default_rng(3)
    for i in generator.choice(leaves_of(certificate), 12, replace=False):
        fewer = (*certificate.tree[:i], *certificate.tree[i + 1 :])
        assert replace(certificate, tree=fewer).bound == -np.inf
        empty = (*certificate.tree[:i], Leaf(), *certificate.tree[i + 1 :])
        assert certificate.tree[i] == Leaf() or not replace(certificate, tree=empty).proven
    assert not replace(certificate, tree=(*certificate.tree, Leaf())).proven


def test_every_cell_of_a_file_is_needed(certificate: Certificate) -> None:
    data = json.loads(json.dumps(certificate.to_dict()))
    for i in range(0, len(data["cells"]), 5):
        with pytest.raises(InputError, match="cells"):
            Certificate.from_dict({**data, "cells": [*data["cells"][:i], *data["cells"][i + 1 :]]})
        with pytest.raises(InputError, match="cells"):
            Certificate.from_dict({**data, "cells": [*data["cells"], data["cells"][i]]})
    assert Certificate.from_dict({**data, "cells": data["cells"][::-1]}) == certificate


def test_cells_may_meet_anywhere(certificate: Certificate) -> None:
    data = json.loads(json.dumps(certificate.to_dict()))
    easy = next(cell for cell in data["cells"] if cell["reach"] > 0.01)
    parts = [{**easy, "k": easy["k"] - 0.75 * easy["reach"], "reach": 0.25 * easy["reach"]}]
    parts += [{**easy, "k": easy["k"] + 0.25 * easy["reach"], "reach": 0.75 * easy["reach"]}]
    other = Certificate.from_dict({**data, "cells": [*(cell for cell in data["cells"] if cell is not easy), *parts]})
    assert len(other.tree) == len(certificate.tree) + 2
    assert sorted(map(str, other.to_dict()["cells"])) != sorted(map(str, data["cells"]))
    assert Certificate.from_dict(other.to_dict()) == other


def narrowest(certificate: Certificate) -> int:
    """The number, among the cells, of the narrowest: where the law has its peak."""
    cells = certificate.to_dict()["cells"]
    return min((i for i, cell in enumerate(cells) if cell["reach"] > 0.0), key=lambda i: float(cells[i]["reach"]))


@pytest.mark.parametrize(
    "change",
    [
        lambda leaf: replace(leaf, contacts=()),
        lambda leaf: replace(
            leaf, equations=tuple(2.0 * equation + 1.0 for equation in leaf.equations), contacts=leaf.contacts[1:]
        ),
    ],
)
def test_a_leaf_that_says_too_little_is_refused(certificate: Certificate, change: Any) -> None:
    i = leaves_of(certificate)[narrowest(certificate)]
    tree = (*certificate.tree[:i], change(certificate.tree[i]), *certificate.tree[i + 1 :])
    assert not replace(certificate, tree=tree).proven


def test_a_leaf_over_more_places_is_refused(certificate: Certificate) -> None:
    data = json.loads(json.dumps(certificate.to_dict()))
    data["cells"][narrowest(certificate)]["reach"] *= 3.0
    with pytest.raises(InputError, match="cells"):
        Certificate.from_dict(data)


@pytest.mark.parametrize("node", [Split(0, 0.0), Split(0, 0.5), Split(0, 2.0), Split(1, 0.25)], ids=repr)
def test_splits_at_no_place_between_prove_nothing(certificate: Certificate, node: Split) -> None:
    first = next(i for i, one in enumerate(certificate.tree) if isinstance(one, Split))
    assert not replace(certificate, tree=(*certificate.tree[:first], node, *certificate.tree[first + 1 :])).proven


def test_what_is_asked_of_another_problem_is_not_proven(certificate: Certificate) -> None:
    assert not replace(certificate, peak="J").proven
    assert not replace(certificate, peak="rms_c").proven
    assert not replace(certificate, problem=replace(FAST, B=at_least(2.1))).proven
    assert not replace(certificate, problem=replace(FAST, B=at_most(2.2))).proven
    assert not replace(certificate, problem=replace(FAST, symmetric=False, basis=Pieces(4, 6, 4))).proven


@pytest.mark.parametrize("nu_and_k", [(B, 0.3), (J, 0.0), (J, 0.11)], ids=repr)
def test_values_and_peaks_of_laws_below_the_claim_are_within_the_bounds(nu_and_k: Any) -> None:
    peak, k = nu_and_k
    problem = Problem(order=3, basis=Chebyshev(7), minimise="rms_c", bounds={peak: at_least(2.0)})
    best = synthesize(Problem(order=3, basis=Chebyshev(7), minimise="rms_c"))
    rows = PeakRows(problem, peak, 1.3 * best.objective)
    others = [synthesize(replace(best.problem, minimise=one)) for one in ("C", "J", "rms_j")]
    for law in (best.law, *(one.law for one in others)):
        judged = Judged(law)
        assert judged.rms(2) < rows.claim
        curve = judged.derivatives[peak.nu]
        second = curve.slope().slope()
        for reach in (0.01, 0.1):
            places = np.linspace(max(k - reach, 0.0), k + reach, 101)
            assert rows.remainder(k, reach) >= reach**2 / 2.0 * np.abs(second(places)).max()
        # without contacts there is what the claim alone says
        for sign in (1.0, -1.0):
            assert rows.upper(k, sign, Leaf()) >= sign * float(curve(k))
    assert rows.remainder(k, 0.0) == 0.0


def test_an_end_that_is_free_is_a_place_of_its_own() -> None:
    problem = Problem(order=3, basis=Chebyshev(7), minimise="rms_c", J=at_least(600.0))
    solution = synthesize(problem, bound="tight")
    assert solution.constants.J.k == 0.0
    assert solution.peak_certificate is not None
    data = json.loads(json.dumps(solution.peak_certificate.to_dict()))
    inner = [cell for cell in data["cells"] if cell["reach"] > 0.0]
    assert len(inner) < len(data["cells"])
    with pytest.raises(InputError, match="cells"):
        Certificate.from_dict({**data, "cells": inner})
    assert not PeakRows(problem, J, solution.objective).excluded(PlaceRange(1.0, 0.0, 0.0), Leaf())


@pytest.mark.parametrize(
    "wrong", [{"claim": -1.0}, {"claim": float("nan")}, {"cells": [{"k": 2.0}]}, {"more": 1}, {"constant": 5}], ids=str
)
def test_what_is_no_certificate_is_refused(certificate: Certificate, wrong: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        Certificate.from_dict(certificate.to_dict() | wrong)


def test_a_solution_that_is_optimal_by_places_is_proven(fast: Solution) -> None:
    data = json.loads(json.dumps(fast.to_dict()))
    assert verify(data).proven
    weighed = [cell for cell in data["peak_certificate"]["cells"] if cell["contacts"]]
    weighed[-1]["contacts"] = []
    broken = verify(data)
    assert not broken.proven
    assert {claim.name for claim in broken.claims if not claim.proven} >= {"steps"}


@pytest.mark.long
def test_one_of_two_peaks_may_prove_alone() -> None:
    problem = Problem(B=1.7, order=4, minimise="rms_c", C=at_least(6.5), J=at_least(120.0))
    solution = synthesize(problem, bound="tight")
    assert solution.lower_bound <= solution.objective
    judge_tight(solution)
    assert solution.peak_certificate is not None
    assert solution.peak_certificate.peak == "C"
