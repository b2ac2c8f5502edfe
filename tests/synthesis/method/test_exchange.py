"""The exchange of points: flat optima, answers that are too coarse, and breaks of pieces."""

import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    BSplines,
    Chebyshev,
    Pieces,
    Problem,
    Window,
    at_most,
    between,
    residual_vibration,
    synthesize,
)
from tests.internals.numerics import conic_optimum
from tests.internals.synthesis import (
    ActiveSet,
    Answer,
    Points,
    Program,
    exchange,
    first_points,
    model_of,
    optimum_on_points,
    quadratic_steps,
    stepwise_on_points,
)


def test_a_flat_optimum_of_pieces_is_the_answer_on_its_points() -> None:
    """Where c is constant along whole pieces no contacts show: the answer's own multipliers prove it."""
    pieces = Pieces((0.0, 0.25, 0.5, 0.75, 1.0), 7, 2)
    problem = Problem(B=between(1.640625, 3.28125), order=4, basis=pieces, minimise="C_plus", symmetric=False)
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.objective == pytest.approx(2.75220731, rel=1e-8)


def test_two_sides_of_a_bound_that_meet_at_a_place_are_ended_by_the_simplex_method() -> None:
    """C_plus at its bound at one place, and nowhere above it, leaves no interior for Clarabel: the law touches there.

    Newton's method stands still beside the place, where the law exceeds the bound by more than it may.
    """
    problem = Problem(
        B=1.3079101944714775,
        order=4,
        basis=BSplines(breaks=(0.0, 0.33, 0.345, 0.402, 0.5, 0.598, 0.655, 0.67, 1.0), degree=3, continuity=2),
        minimise="max(0.0005254237288135593*J, 0.0004915254237288136*J)",
        symmetric=False,
        J=at_most(1355.2827834879922),
        bounds={"C_plus": between(9.973950881109433, 9.973950881109433)},
        boundary=BoundaryConditions(start=(0.25, -0.135, -2.709, -4.78), end=(0.65, -0.213, -0.197, 1.409)),
        windows=(
            Window("c", low=-9.069070061211054, high=8.864715484898024, start=0.405, stop=0.695),
            Window("b", high=1.3360671887817792, start=0.466, stop=0.64),
            Window("j", high=333.4271517914283, start=0.428, stop=0.62),
        ),
    )
    solution = synthesize(problem)
    assert solution.law.peak(2).value == pytest.approx(9.973950881109433, rel=1e-9)
    assert solution.objective <= 0.04545822


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
    monkeypatch.setattr(exchange, "polished", lambda *_: None)
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


def test_cones_whose_rows_are_nearly_dependent_hold_at_their_points() -> None:
    """A residual over a band has far fewer degrees of freedom than places: its singular values fall by 1e5."""
    spectrum = [(16.0, 0.2), (18.0, 1.0), (19.0, 0.4), (22.0, 0.9), (24.0, 0.0), (26.0, 0.0), (27.0, 0.3)]
    limit = residual_vibration(spectrum=spectrum, damping=0.02)
    program = model_of(Problem(order=3, basis=Chebyshev(9), bounds={limit: at_most(0.1)})).program
    points = first_points(program)
    answer = optimum_on_points(program, points)
    excess = [
        (grid.s * family.value(answer.x, grid.u)).max() - family.right_side(answer.x)
        for family, grid in zip(program.families, points, strict=True)
    ]
    assert max(excess) <= 1e-9
    assert program.objective_at(answer.x) == pytest.approx(6.373893320, rel=1e-8)


def test_of_thousands_of_rows_few_are_given_to_the_solver_of_a_quadratic_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that its answer exceeds join them, so that the step is that of all rows."""
    problem = Problem(order=3, basis=Chebyshev(9), minimise="peak((1 + 0.5*sin(6*a))*c + 3*b^2)", symmetric=False)
    model = model_of(problem)
    many = [
        Points(np.repeat(np.linspace(0.0, 1.0, 1500), 2), np.tile([1.0, -1.0], 1500)) for _ in model.program.families
    ]
    start = exchange.initial_guess(model.program, many)
    given: list[int] = []
    honest = conic_optimum

    def counted(curvature: Any, cost: Any, rows: Any, *others: Any, **options: Any) -> Any:
        given.append(rows.shape[0])
        return honest(curvature, cost, rows, *others, **options)

    monkeypatch.setattr(quadratic_steps, "conic_optimum", counted)
    few = stepwise_on_points(model.program, many, start)
    assert max(given) < 500
    monkeypatch.setattr(quadratic_steps, "_FEW_ROWS", 100_000)
    every = stepwise_on_points(model.program, many, start)
    assert max(given) > 3000
    assert few.success
    assert model.program.objective_at(few.x) == pytest.approx(model.program.objective_at(every.x), rel=1e-9)
    rows = np.concatenate(
        [
            grid.s * family.value(few.x, grid.u) - family.right_side(few.x)
            for family, grid in zip(model.program.families, many, strict=True)
        ]
    )
    assert rows.max() <= 1e-9


def test_a_start_ends_where_a_law_that_is_known_is_better(monkeypatch: pytest.MonkeyPatch) -> None:
    """After a few rounds more points only raise the objective, so that the start cannot lead to a better law."""
    model = model_of(Problem(order=3, basis=Chebyshev(9), minimise="peak(abs(c) + 3*b^2)", symmetric=False))
    monkeypatch.setattr(exchange, "polished", lambda *_: None)
    asked: list[float] = []

    def worse(x: Any) -> bool:
        asked.append(float(model.program.objective @ x))
        return len(asked) == 2

    outcome = exchange.solve(model.program, worse=worse)
    assert (outcome.optimum, outcome.tried, len(asked)) == (None, (), 2)
    assert outcome.rounds == 5
    assert outcome.status.startswith("no better than a law that is known")


def test_a_law_of_linear_rows_needs_neither_casadi_nor_scipy() -> None:
    script = (
        "import sys, optlaws\n"
        "optlaws.synthesize(optlaws.Problem(B=1.641, order=4))\n"
        "print(sorted({name.partition('.')[0] for name in sys.modules} & {'casadi', 'scipy'}))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
