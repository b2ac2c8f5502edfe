"""Optimal laws for machines: proven, and read again from what is stored."""

import json
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import optlaws
from optlaws import (
    Certificate,
    Chebyshev,
    Functional,
    InfeasibleProblem,
    InputError,
    Link,
    Machine,
    Pieces,
    Problem,
    at_most,
    catalogue,
    pareto_front,
    shaped_law,
    smoothstep,
    synthesize,
)
from tests.internals.mechanisms import output_peak, output_rms
from tests.internals.synthesis import Sublevel, model_of, named, space_of
from tests.sampling import sampled
from tests.synthesis.judge import Judged

GRID = np.linspace(0.0, 1.0, 301)


def chain(seed: int, masses: int = 3) -> Machine:
    """A motor that drives masses one behind the other, lightly damped."""
    rng = np.random.default_rng(seed)
    names = ["motor", *(f"mass {i}" for i in range(1, masses + 1))]
    weights = dict(zip(names, rng.uniform(0.3, 2.0, size=masses + 1).tolist(), strict=True))
    links = [
        Link(first, second, float(rng.uniform(200.0, 2000.0)), float(rng.uniform(0.0, 3.0)))
        for first, second in pairwise(names)
    ]
    outputs = {"motor torque": "drive force", "last acceleration": f"acceleration {names[-1]}"}
    return Machine.from_masses(weights, links, drive="motor", outputs=outputs)


def constants(machine: Machine, seed: int) -> tuple[Functional, Functional]:
    """What is minimised, and what is bounded."""
    objectives = (
        machine.peak("motor torque"),
        machine.rms("motor torque", dwell=0.3),
        machine.peak("last acceleration", within=(0.0, 1.5)),
    )
    return objectives[seed % 3], machine.residual(1, "last acceleration", spread=0.05)


@pytest.mark.sample(3)
@pytest.mark.parametrize("seed", range(6))
def test_optima_are_proven_kept_and_right(seed: int) -> None:
    machine = chain(seed, masses=1 + seed % 3)
    objective, residual = constants(machine, seed)
    plain = Problem(order=3, basis=Chebyshev(7), minimise=objective, symmetric=bool(seed % 2), B=at_most(3.0))
    unbounded = synthesize(plain)
    allowed = 0.3 * residual.value(unbounded.law)
    solution = synthesize(
        Problem(
            order=3,
            basis=Chebyshev(7),
            minimise=objective,
            symmetric=bool(seed % 2),
            B=at_most(3.0),
            bounds={residual: at_most(allowed)},
        )
    )
    assert (unbounded.status.value, solution.status.value) == ("optimal", "optimal")
    assert unbounded.objective <= solution.objective * (1.0 + 1e-9)
    assert 0.0 <= solution.objective - solution.lower_bound <= 1e-7 * solution.objective
    judged = Judged(solution.law)
    assert judged.value(objective) == pytest.approx(solution.objective, rel=1e-8)
    assert judged.value(residual) <= allowed * (1.0 + 1e-8)


def test_pieces_and_cycles_are_proven_too() -> None:
    machine = chain(1, masses=1)
    pieces = Problem(order=3, basis=Pieces(4, 8, 3), minimise=machine.peak("motor torque"))
    cycle = Problem(order=3, basis=Chebyshev(7), minimise=machine.peak("motor torque", cycle=(0.2, 0.4)), monotone=True)
    for problem in (pieces, cycle):
        solution = synthesize(problem)
        assert solution.status.value == "optimal"
        assert Judged(solution.law).value(machine_constant(problem)) == pytest.approx(solution.objective, rel=1e-8)


def machine_constant(problem: Problem) -> Functional:
    ((_, term),) = problem.objective.terms
    assert isinstance(term, Functional)
    return term


def test_a_stored_solution_needs_no_machine_beside_it() -> None:
    machine = chain(2, masses=1)
    residual = machine.residual(1, "last acceleration", spread=0.1, damping=(0.0, 0.05))
    problem = Problem(order=3, basis=Chebyshev(7), minimise=machine.peak(), bounds={residual: at_most(1.0)})
    solution = synthesize(problem)
    stored = json.loads(json.dumps(solution.to_dict()))
    assert Problem.from_dict(stored["problem"]) == problem
    assert Certificate.from_dict(stored["certificate"]).bound == pytest.approx(solution.lower_bound, rel=1e-12)


@pytest.mark.long
def test_errors_call_a_machine_by_few_words_and_can_be_run_again() -> None:
    machine = chain(2, masses=1)
    residual, peak = machine.residual(1, "last acceleration", spread=0.1), machine.peak()
    mixed, bounds = f"0.5*{peak.name} + C", {residual: at_most(1e-7)}
    problem = Problem(order=3, basis=Chebyshev(5), minimise=mixed, C=at_most(20.0), bounds=bounds, symmetric=False)
    with pytest.raises(InfeasibleProblem) as raised:
        synthesize(problem)
    shown, *others = str(raised.value).split("\n")
    assert "residual of mode 1 in 'last acceleration' of a machine of 2 states, within 10 %" in shown
    (code,) = (line for line in others if line.startswith("problem: "))
    texts = [line.removeprefix("where ") for line in others if line.startswith("where ")]
    known = dict[str, object](vars(optlaws))
    exec("\n".join(texts), known)  # noqa: S102 - what the error says can be run again
    assert eval(code.removeprefix("problem: "), known) == problem  # noqa: S307
    # each text stands once, and nowhere else
    assert (str(raised.value).count('"A":'), len(texts), shown.count('"A":'), code.count('"A":')) == (2, 2, 0, 0)
    solution = synthesize(replace(problem, bounds={}))
    assert '"A":' not in repr(solution) + solution._repr_html_() + problem._repr_html_()


def test_machines_of_many_states_are_stored_too() -> None:
    rng = np.random.default_rng(1)
    A = rng.normal(size=(40, 40))
    machine = Machine(A - 20.0 * np.eye(40), np.ones((40, 1)), np.ones((1, 40)))
    assert len(machine.peak().name) > 30_000
    problem = Problem(order=3, minimise=machine.peak(), bounds={machine.rms(): at_most(1.0)})
    assert Problem.from_dict(json.loads(json.dumps(problem.to_dict()))) == problem


def test_texts_of_laws_that_repeat_are_read_again() -> None:
    machine = chain(2, masses=1)
    for constant in (
        output_peak(of=machine, steady=True, side="low", offset=-1.5),
        output_rms(of=machine, steady=True),
    ):
        assert named(constant.name) == constant


def test_a_mode_that_the_output_does_not_see_is_left_with_nothing() -> None:
    A = [[0, 1, 0, 0], [-400, -2, 0, 0], [0, 0, 0, 1], [0, 0, -900, -3]]
    machine = Machine(A, [[0], [400], [0], [900]], [[1, 0, 0, 0], [0, 0, 1, 0]], outputs=["first", "second"])
    unseen = machine.residual(2, "first", spread=0.1)
    assert unseen.value(smoothstep(3)) < 1e-12
    problem = Problem(order=3, basis=Chebyshev(5), minimise="C", bounds={unseen: at_most(1e-3)}, symmetric=False)
    assert synthesize(problem).status.value == "optimal"


def one_sided(seed: int) -> tuple[Functional, Problem]:
    """A peak of one side of an output, with a constant load."""
    machine = chain(seed, masses=1 + seed % 3)
    whens: list[dict[str, Any]] = [{}, {"within": (0.0, 1.3)}, {"cycle": (0.2, 0.3)}]
    peak = machine.peak(side=("high", "low")[seed % 2], offset=2.0 * (seed % 3 - 1), **whens[seed % 3])
    return peak, Problem(order=3, basis=Chebyshev(7 + seed % 2), minimise=peak, symmetric=False)


@pytest.mark.sample(3)
@pytest.mark.parametrize("seed", sampled(range(12), each=4))
def test_peaks_of_one_side_are_proven(seed: int) -> None:
    peak, problem = one_sided(seed)
    solution = synthesize(problem)
    assert solution.status.value == "optimal"
    judged = Judged(solution.law).value(peak)
    assert judged == pytest.approx(solution.objective, rel=1e-8, abs=1e-8)
    # no law near it is better: the rows have no part in this
    space = space_of(problem.basis, problem.conditions, symmetric=False)
    rng = np.random.default_rng(seed)
    for _ in range(20):
        other = space.law(solution.active_set.x[: space.terms] + 1e-3 * rng.normal(size=space.terms))
        assert peak.value(other) >= solution.lower_bound


def test_peaks_of_one_side_below_0_do_not_make_laws_small() -> None:
    machine = chain(2, masses=1)
    peak = machine.peak(side="high", offset=-200.0)
    problem = Problem(order=3, basis=Chebyshev(7), minimise=peak, symmetric=False)
    space = space_of(problem.basis, problem.conditions, symmetric=False)
    rng = np.random.default_rng(3)
    for _ in range(10):
        law = space.law(rng.normal(size=space.terms))
        assert peak.value(law) < 0.0
        ((order, mean),) = Sublevel.of(model_of(problem)).means({peak.name: peak.value(law)}).items()
        assert np.abs(law(GRID, order)).mean() <= mean
    solution = synthesize(problem)
    assert solution.status.value == "optimal"
    assert solution.objective < -100.0


def test_entries_of_the_catalogue_stand_for_their_laws() -> None:
    machine, entry = chain(1), catalogue["cycloidal"]
    for constant in (machine.peak(), machine.rms(), machine.residual()):
        assert constant.value(entry) == constant.value(entry.law)  # type: ignore[arg-type]
    nu = machine.modes[0].frequency
    assert shaped_law(entry, nu) == shaped_law(entry.law, nu)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="law must be a motion law"):
        shaped_law("cycloidal", nu)  # type: ignore[arg-type]


def test_fronts_call_constants_of_machines_by_their_titles() -> None:
    machine = chain(2, masses=1)
    residual = machine.residual(1, "last acceleration", spread=0.1)
    front = pareto_front(Problem(order=3, basis=Chebyshev(7), symmetric=False), over=(residual, "C"), points=3)
    shown = [repr(front), *front.headings, front.plot()[0].axes.get_xlabel()]
    assert residual.title in shown
    assert not any('"A"' in text for text in shown)
    assert len(front.headings) == len(front.rows[0])


def test_a_constant_load_is_added_and_sides_are_those_of_the_output() -> None:
    machine, law = chain(1), smoothstep(4)
    low, high = machine.response(law).extrema("motor torque")
    assert machine.peak(side="high").value(law) == high.value
    assert machine.peak(side="low").value(law) == -low.value
    assert machine.peak(offset=100.0).value(law) == pytest.approx(100.0 + high.value, rel=1e-14)
    assert machine.peak(side="low", offset=-3.0).value(law) == pytest.approx(3.0 - low.value, rel=1e-14)
    # the mean square with a load: the mean is what the masses' momentum at the end says
    plain, loaded, opposite = (machine.rms(offset=load).value(law) ** 2 for load in (0.0, 2.0, -2.0))
    assert loaded + opposite == pytest.approx(2.0 * plain + 8.0, rel=1e-13)


@pytest.mark.parametrize(
    ("says", "make"),
    [
        ("did you mean 'motor torque'", lambda machine: machine.peak("motor torqe")),
        ("mode must be a whole number from 1 to 1", lambda machine: machine.residual(2)),
        ("before the output: residual\\(1, 'sway'\\)", lambda machine: machine.residual("sway")),
        ("mode must be a whole number", lambda machine: machine.residual(1.5)),
        ("the first before the last", lambda machine: machine.peak(within=(1.0, 1.0))),
        ("two times", lambda machine: machine.peak(within=3.0)),
        ("durations of the rise, from 0", lambda machine: machine.rms(dwell=-1.0)),
        ("did you mean 'low'", lambda machine: machine.peak(side="lwo")),
        ("offset", lambda machine: machine.peak(offset="heavy")),
        ("spread is a share", lambda machine: machine.residual(spread=10.0)),
        ("damping must be a ratio", lambda machine: machine.residual(damping=(0.2, 0.1))),
        ("rest to rest", lambda machine: synthesize(Problem(order=1, minimise=machine.peak()))),
        ("needs its B, such as", lambda _: Problem(order=3, minimise="""output_peak(of='{"A": [[-1]]}')""")),
        ("as JSON text", lambda _: Problem(order=3, minimise="output_rms(of='{A}')")),
        ("must be a machine", lambda _: Problem(order=3, minimise="output_rms(of=3)")),
        ("unstable", lambda _: Problem(order=3, minimise="""output_rms(of='{"A": [[1]], "B": [[1]], "C": [[1]]}')""")),
    ],
)
def test_wrong_constants_are_named(says: str, make: object) -> None:
    assert callable(make)
    with pytest.raises(InputError, match=says):
        make(chain(2, masses=1))


def test_decays_and_defective_modes_have_no_residual() -> None:
    decaying = Machine([[-3.0]], [[3.0]], [[1.0]])
    assert decaying.modes == ()
    with pytest.raises(InputError, match="no vibrating mode"):
        decaying.residual()
    values = np.array([[-0.1, 9.0], [-9.0, -0.1]])
    driving = Machine(np.block([[values, np.eye(2)], [np.zeros((2, 2)), values]]), np.ones((4, 1)), np.eye(4))
    (only,) = driving.modes
    assert only.frequency == pytest.approx(np.hypot(9.0, 0.1), rel=1e-7)
    with pytest.raises(InputError, match="defective"):
        driving.residual()
    # side by side they are one vibration, with an amplitude
    beside = Machine(np.kron(np.eye(2), values), np.ones((4, 1)), np.array([[1.0, 0.0, 1.0, 0.0]]))
    alone = Machine(values, np.ones((2, 1)), np.array([[2.0, 0.0]]))
    law = synthesize(Problem(order=3, basis=Chebyshev(5))).law
    assert beside.residual().value(law) == pytest.approx(alone.residual().value(law), rel=1e-10)
