"""The exchange of points: flat optima, answers that are too coarse, and breaks of pieces."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import Chebyshev, Pieces, Problem, between, synthesize
from tests.internals.synthesis import ActiveSet, Answer, Program, exchange, model_of


def test_a_flat_optimum_of_pieces_is_the_answer_on_its_points() -> None:
    """Where c is constant along whole pieces no contacts show: the answer's own multipliers prove it."""
    pieces = Pieces((0.0, 0.25, 0.5, 0.75, 1.0), 7, 2)
    problem = Problem(B=between(1.640625, 3.28125), order=4, basis=pieces, minimise="C_plus", symmetric=False)
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.objective == pytest.approx(2.75220731, rel=1e-8)


def test_rounds_end_where_what_answers_exceed_falls_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    """Constants in very different units leave a solver with few digits, which more points do not add to."""
    answers: list[Answer] = []
    honest, numbers = exchange.answer_on_points, np.random.default_rng(3)

    def coarse(program: Program, *options: Any) -> Answer:
        answers.append(honest(program, *options))
        x = answers[-1].x
        noise = np.where(program.objective == 0.0, numbers.normal(size=len(x)), 0.0)
        return replace(answers[-1], x=x + 1e-3 * len(answers) * noise)

    monkeypatch.setattr(exchange, "answer_on_points", coarse)
    monkeypatch.setattr(exchange, "optimum_near", lambda *_: None)
    program = model_of(Problem(B=1.859, order=4, basis=Chebyshev(9), symmetric=False)).program
    outcome = exchange.solve(program)
    assert outcome.status.endswith("falls no more")
    assert outcome.rounds == len(answers) < exchange.ROUNDS / 2


def test_contacts_on_both_sides_of_a_break_stay_two() -> None:
    """Snap jumps at a break of pieces: one contact for both sides would leave one of them without a bound."""
    sides = (0.5 - 2.0**-50, 0.5)
    contacts = [(0, u, 1.0, False, 1.0) for u in sides]
    beside = [(0, 0.2, 1.0, True, 1.0), (0, 0.2 + 1e-12, 1.0, True, 1.0)]
    state = ActiveSet.of_contacts(np.zeros(1), [*beside, *contacts], np.zeros(0))
    merged = state.merged(1e-6)
    assert merged.u[1:].tolist() == list(sides)
    assert len(merged.u) == 3
