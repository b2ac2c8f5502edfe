"""One-sided peaks, mixtures, problems that begin at a neighbour's solution: against HiGHS and against each other."""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest

from optlaws import Chebyshev, Powers, Problem, at_most, between, synthesize
from tests.synthesis.judge import Judged, judge

# --- unsymmetric laws ---


# --- mixtures ---


@pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")
@pytest.mark.sample(3)
@pytest.mark.parametrize(("first", "second"), [("C/4", "J/32"), ("C/4", "rms_c/3.5"), ("rms_c/3.5", "J/32")])
@pytest.mark.parametrize("B", [None, 1.7], ids=str)
def test_a_mixture_leads_from_one_optimum_to_the_other(first: str, second: str, B: float | None) -> None:
    shares = [1e-3, 0.2, 0.4, 0.6, 0.8, 1 - 1e-3]
    found = [
        synthesize(Problem(B=B, order=4, minimise=f"{share!r}*{first} + {1 - share!r}*{second}")) for share in shares
    ]
    a, b = ([Judged(s.law).constant(name.partition("/")[0]) for s in found] for name in (first, second))
    for values in (a, b[::-1]):
        assert all(later <= earlier * (1 + 1e-8) for earlier, later in pairwise(values))
    # the worth of a mixture is concave in the share
    for left, middle, right in zip(found[1:], found[2:], found[3:], strict=False):
        assert middle.objective >= (left.objective + right.objective) / 2 * (1 - 1e-10)
    ends = [synthesize(Problem(B=B, order=4, minimise=name)) for name in (first, second)]
    assert found[-1].objective == pytest.approx(ends[0].objective, rel=1e-2)
    assert found[0].objective == pytest.approx(ends[1].objective, rel=1e-2)


# --- continuation ---

STARTS: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"B": 1.7}, {"B": 1.72}),
    ({"B": 1.7, "minimise": "J"}, {"B": 1.75}),
    ({"B": 1.7, "minimise": "snap"}, {"B": 1.71}),
    ({"B": 1.7, "minimise": "rms_c"}, {"B": 1.6}),
    ({"B": 1.7, "minimise": "rms_j"}, {"B": 1.65}),
    ({"B": 1.7, "minimise": "C_plus"}, {"B": 1.72}),
    ({"B": 2.1, "minimise": "C_minus", "symmetric": False, "order": 3}, {"B": 2.12}),
    ({"minimise": "0.5*C/4 + 0.5*J/32"}, {"minimise": "0.52*C/4 + 0.48*J/32"}),
    ({"minimise": "max(C/4, J/32)"}, {"minimise": "max(C/4, J/33)"}),
    ({"minimise": "0.5*rms_c/3.5 + 0.5*J/32", "B": 1.8}, {"minimise": "0.6*rms_c/3.5 + 0.4*J/32"}),
    ({"minimise": "J", "B": 1.8, "C": at_most(5.1)}, {"C": at_most(5.2)}),
    ({"minimise": "C", "B": between(1.5, 1.6)}, {"B": between(1.52, 1.62)}),
    ({"minimise": "C", "B": 2.5, "order": 3, "monotone": True}, {"B": 2.45}),
    ({"minimise": "J", "B": 2.5, "order": 3, "symmetric": False}, {"B": 2.55}),
    ({"B": 1.2, "order": 3, "symmetric": False}, {"B": 1.21}),
    ({"B": 1.641, "symmetric": False}, {"B": 1.651}),
    ({"minimise": "snap", "B": 1.641, "symmetric": False}, {"B": 1.651}),
    ({"minimise": "C_plus", "B": 2.5, "order": 3, "symmetric": False}, {"B": 2.51}),
    ({"minimise": "D", "B": 1.8, "order": 3, "symmetric": False}, {"B": 1.81}),
    ({"minimise": "D", "B": 1.7}, {"B": 1.72}),
    ({"minimise": "D", "order": 2}, {"order": 2}),
    ({"B": 1.85, "basis": Powers(9)}, {"B": 1.859, "basis": Chebyshev(9)}),
]


@pytest.mark.sample(4)
@pytest.mark.parametrize(("given", "change"), STARTS, ids=str)
def test_a_start_leads_to_the_cold_answer(given: dict[str, Any], change: dict[str, Any]) -> None:
    chosen: dict[str, Any] = {"order": 4, "basis": Chebyshev(9), **given}
    first = Problem(**chosen)
    second = replace(first, **change)
    warm, cold = synthesize(second, start=synthesize(first)), synthesize(second)
    judge(warm)
    assert warm.objective == pytest.approx(cold.objective, rel=1e-10 if first.convex else 1e-6)
    assert warm.lower_bound == pytest.approx(cold.lower_bound, rel=1e-10 if first.convex else 1e-6)
    assert warm.status == cold.status
    assert warm.problem == warm.certificate.problem == second


def test_a_start_of_another_kind_is_left_aside() -> None:
    problem = Problem(B=1.7, order=4, minimise="J")
    alone = synthesize(problem)
    for other in (
        replace(problem, minimise="C"),
        replace(problem, B=None),
        replace(problem, symmetric=False, B=2.4),
        replace(problem, C=at_most(9.0)),
        replace(problem, B=between(1.6, 1.8)),
        replace(problem, order=3, basis=Chebyshev(5)),
    ):
        solution = synthesize(problem, start=synthesize(other))
        assert (solution.objective, solution.z) == (alone.objective, alone.z)
