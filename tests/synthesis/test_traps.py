"""Traps that were met and measured, each shut by a test."""

import pickle
import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import Chebyshev, Problem, Solution, Status, smoothstep, synthesize
from tests.internals.synthesis import Answer, LinearFamily, PieceSeries, Points, Program, exchange, ipopt
from tests.synthesis.independent import check_solution, velocity_of, z_of

SHAPES = [
    Problem(B=1.641, order=4, basis=Chebyshev(3)),
    Problem(B=1.859, order=4, basis=Chebyshev(9)),
    Problem(B=2.7, order=2, basis=Chebyshev(21)),
    Problem(B=2.7, order=5, basis=Chebyshev(19), monotone=True),
]
every_shape = pytest.mark.parametrize("problem", SHAPES, ids=lambda p: f"l{p.order}-n{p.basis.degree}-B{p.B:g}")


def test_without_b_at_most_b_the_optimum_would_be_another() -> None:
    # the constraint binds: |c| alone would let b rise above B beside the middle
    solution = synthesize(Problem(B=1.3, order=2, basis=Chebyshev(9)))
    assert any(c.constraint == "chord" for c in solution.certificate.contacts)
    assert float(solution.law.b(np.linspace(0.0, 1.0, 5001)).max()) <= 1.3 * (1 + 1e-10)


@pytest.mark.sample(4)
@pytest.mark.parametrize("B", [1.6500000000000001, *np.round(np.linspace(1.52, 1.74, 12), 6).tolist()])
def test_velocity_above_b_by_less_than_a_plain_check_sees_buys_no_acceleration(B: float) -> None:
    # near the middle B - b is of the order of (k - 1/2)²: 2e-11 too much of b was worth 2e-9 of C
    problem = Problem(B=B, order=4, basis=Chebyshev(19))
    alone = synthesize(problem)
    k = np.linspace(0.0, 0.499, 5000)
    assert float(((B - alone.law.b(k)) / (1.0 - 2.0 * k) ** 2).min()) >= -1e-8
    for step in (-0.05, 0.01):
        other = synthesize(problem, start=synthesize(replace(problem, B=B + step)))
        assert alone.objective >= other.lower_bound * (1 - 1e-11)
        assert other.objective >= alone.lower_bound * (1 - 1e-11)


def test_stopping_at_an_acceptable_level_is_no_success(monkeypatch: pytest.MonkeyPatch) -> None:
    class Acceptable:
        def __call__(self, **_: object) -> dict[str, list[float]]:
            return {"x": [0.0, 1.0], "lam_g": [0.0, 0.0, 0.0]}

        def stats(self) -> dict[str, object]:
            return {"success": True, "return_status": "Solved_To_Acceptable_Level", "iter_count": 3}

    monkeypatch.setattr(ipopt, "_solver", lambda *_, **__: Acceptable())
    family = LinearFamily("f", np.array([0.0, 1.0]), table=PieceSeries.whole(np.ones((1, 3))))
    program = Program((family,), np.ones((1, 2)), np.ones(1), np.array([0.0, 1.0]))
    points = Points(np.array([0.0, 0.5]), np.ones(2))
    answer = ipopt.solve_on_points(program, [points], None)
    assert not answer.success
    assert answer.status == "Solved_To_Acceptable_Level"
    # it may still show where the contacts are: the exact active set decides
    assert answer.usable


@pytest.mark.parametrize("noise", [1e-9, 1e-6, 1e-4])
def test_an_answer_of_a_solver_is_only_a_start(monkeypatch: pytest.MonkeyPatch, noise: float) -> None:
    problem = Problem(B=1.859, order=4, basis=Chebyshev(9), symmetric=False)
    true = synthesize(problem)
    honest, answers = exchange.answer_on_points, []
    numbers = np.random.default_rng(5)

    def rough(*args: Any) -> Answer:
        answers.append(honest(*args))
        x = answers[-1].x
        return replace(answers[-1], x=x * (1.0 + noise * numbers.normal(size=len(x))))

    monkeypatch.setattr(exchange, "answer_on_points", rough)
    solution = synthesize(problem)
    assert answers
    check_solution(solution)
    assert solution.objective == pytest.approx(true.objective, rel=1e-12)


def fingerprint(solution: Solution) -> tuple[object, ...]:
    return solution.objective, solution.lower_bound, solution.z, solution.law, solution.certificate


@every_shape
def test_the_same_problem_gives_the_same_floats(problem: Problem) -> None:
    first = synthesize(problem)
    synthesize(replace(problem, B=velocity_of(problem) + 0.01))
    assert fingerprint(synthesize(problem)) == fingerprint(first)


def test_another_process_gives_the_same_floats() -> None:
    problem = SHAPES[1]
    script = (
        "from optlaws import Chebyshev, Problem, synthesize\n"
        f"s = synthesize({problem!r})\n"
        "print(repr(s.objective), repr(s.lower_bound), *map(repr, s.z))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    here = synthesize(problem)
    assert done.stdout.split() == [repr(v) for v in (here.objective, here.lower_bound, *z_of(here))]
    assert done.stderr == ""


def test_powers_of_high_degree_do_not_spoil_the_constants() -> None:
    # at degree 17 and more, roots of an expanded b c gave D of 1462 where the truth is about 6
    law = synthesize(Problem(B=1.641, order=4, basis=Chebyshev(41))).law
    k = np.linspace(0.0, 1.0, 20_001)
    sampled = float(np.abs(law.b(k) * law.c(k)).max())
    assert sampled <= law.power_peak().value <= sampled * (1 + 1e-5)


def test_a_solution_survives_other_processes() -> None:
    solution = synthesize(SHAPES[1])
    again = pickle.loads(pickle.dumps(solution))  # noqa: S301
    assert fingerprint(again) == fingerprint(solution)
    assert synthesize(replace(SHAPES[1], B=1.86), start=again).iterations == 0


def test_a_solution_says_what_it_is() -> None:
    solution = synthesize(SHAPES[0])
    assert repr(solution).startswith("Solution(status='optimal', objective=6.87252932")
    assert solution.status is Status.OPTIMAL
    assert {"optlaws", "casadi", "numpy"} <= solution.versions.keys()
    assert solution.seconds > 0.0
    assert all(status.advice for status in Status)
    assert solution.constants.C.value < smoothstep(4).peak(2).value
