"""A cycle asks and its plan answers: what is forwarded, stored, and taken in place of a cycle."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Axes,
    Cycle,
    DiscCam,
    Drive,
    Dwell,
    FastestCycle,
    Free,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    Plan,
    Return,
    Rise,
    Status,
    TranslatingRoller,
    at_most,
    energy_fluctuation,
    synthesize,
)
from optlaws.verification import verify_all
from tests.internals.cycles import Answers, answer

LIMITS = {"acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
MOVES = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return(duration="120 deg"), Dwell()]
CYCLES = {
    "given": Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s"),
    "moves": Cycle(MOVES, speed="90 rpm", limits=LIMITS),
    "free": Cycle([Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")], period="0.5 s", minimise="rms jerk"),
    "load": Cycle(MOVES, speed="90 rpm", load={"period": "20 ms", "damping": 0.05}, minimise="load acceleration"),
    "rated": Cycle(MOVES, speed="90 rpm", drive={"mass": "2 kg"}, minimise="acceleration", limits={"rms force": "8 N"}),
    "motor": Cycle(
        [Rise("45 deg", "0.25 s"), Dwell()],
        period="0.6 s",
        advance="45 deg",
        drive=Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", rated_torque="2 N m"), ratio=20),
    ),
}
EVERY = pytest.mark.parametrize("cycle", CYCLES.values(), ids=CYCLES)


def asked(of: Cycle | Plan, name: str) -> Any:
    try:
        return getattr(of, name)
    except InputError as error:
        return str(error)


@EVERY
def test_a_cycle_forwards_what_its_plan_answers(cycle: Cycle) -> None:
    plan = cycle.solve()
    assert cycle.solve() is plan is plan.solve()
    assert plan.specification is cycle is cycle.specification
    names = [name for name, value in vars(Answers).items() if isinstance(value, answer)]
    assert {"objective", "status", "pieces", "effort", "sheet", "peaks"} <= set(names)
    for name in names:
        value = asked(plan, name)
        assert asked(cycle, name) is value or asked(cycle, name) == value, name
    times = np.linspace(-cycle.duration, 2.0 * cycle.duration, 7)
    assert cycle(times, 1).tolist() == plan(times, 1).tolist()


@EVERY
def test_a_plan_that_is_stored_has_its_laws(cycle: Cycle, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = cycle.solve()
    text = plan.to_json()
    monkeypatch.setattr(Cycle, "solve", None)  # no law is looked for any more
    read = Plan.from_json(text)
    assert read.to_json() == text
    assert read.pieces == plan.pieces
    assert (read.objective, read.status, read.remarks) == (plan.objective, plan.status, plan.remarks)


def test_a_plan_takes_as_many_solutions_as_it_has_motions() -> None:
    cycle = CYCLES["moves"]
    with pytest.raises(InputError, match="the cycle has 2 optimised motions, got 1 solutions"):
        cycle.with_solutions(cycle.solutions[:1])
    with pytest.raises(InputError, match="a plan needs its cycle"):
        Plan.from_dict({"solutions": []})


def test_other_solutions_are_judged_anew() -> None:
    cycle = Cycle(MOVES, speed="90 rpm")
    calmer = [synthesize(replace(solution.problem, J=at_most(60.0))) for solution in cycle.solutions]
    plan = cycle.with_solutions(calmer)
    assert plan.peak(3) < cycle.peak(3)
    assert plan.objective == pytest.approx(plan.peak(2), rel=1e-15)
    # the bound is that of the problems with the further bound
    assert plan.lower_bound == pytest.approx(plan.objective, rel=1e-6)
    assert plan.with_solutions(cycle.solutions) == cycle.solve()
    fast = plan.at("180 rpm")
    assert fast.peak(2) == pytest.approx(4.0 * plan.peak(2), rel=1e-12)
    assert fast.peak(3) == pytest.approx(8.0 * plan.peak(3), rel=1e-12)


def test_a_plan_stands_where_a_cycle_does() -> None:
    cycle = replace(CYCLES["moves"], drive={"mass": "2 kg"})
    plan, roller = cycle.solve(), TranslatingRoller("12 mm")
    cams = [DiscCam(motion, "60 mm", roller, phase="20 deg") for motion in (cycle, plan)]
    assert cams[0].extremes == cams[1].extremes
    assert energy_fluctuation(cycle) == energy_fluctuation(plan)
    axes = Axes({"slide": plan})
    assert axes["slide"].objective == plan.objective
    assert axes.to_dict() == Axes({"slide": cycle}).to_dict()
    assert axes.fastest().objective == Axes({"slide": cycle}).fastest().objective


def test_an_unchecked_plan_says_what_is_broken() -> None:
    cycle = replace(CYCLES["given"], limits={"velocity": "600 mm/s"})
    plan = cycle.unchecked()
    assert plan.status is Status.INFEASIBLE
    assert Plan.from_json(plan.to_json()).status is Status.INFEASIBLE
    (taken,) = plan.limits_taken
    assert taken.value == pytest.approx(2.0 * 0.035 / 0.1, rel=1e-12)


def test_fastest_cycles_and_transitions_leave_as_cycles_do() -> None:
    fastest = CYCLES["moves"].fastest()
    start = fastest.cycle.run_in("60 deg", rest="-5 mm", over="200 deg")
    for motion, peak in ((fastest, fastest.cycle.peak(2)), (start, start.peak(2))):
        report = motion.report()
        assert motion.summary() == report.facts
        assert report.panels[2].peak == pytest.approx(peak, rel=1e-12)
        assert report.data["status"] == motion.status.value
        assert motion.export("csv", points=31).points == 31
        assert motion.polynomials(unit="m").breaks[0] == 0.0
        assert motion._repr_html_().count("<svg") == 4


def test_a_plan_with_laws_beyond_a_limit_is_infeasible_wherever_they_come_from() -> None:
    cycle = Cycle(MOVES, speed="90 rpm", limits={"jerk": "500 m/s^3"})
    wild = replace(cycle, limits={}).solutions
    assert cycle.with_solutions(cycle.solutions).status is cycle.status
    assert cycle.with_solutions(wild).status is Status.INFEASIBLE
    data = cycle.solve().to_dict()
    data["solutions"] = [solution.to_dict() for solution in wild]
    assert Plan.from_dict(data).status is Status.INFEASIBLE


def test_axes_with_a_plan_beyond_a_limit_are_infeasible() -> None:
    moves = [Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")]
    shown = Cycle(moves, period="0.25 s", limits={"velocity": "616 mm/s"}).unchecked()
    assert Axes({"x": Cycle(moves, period="0.25 s"), "y": shown}).status is Status.INFEASIBLE


def test_a_fastest_cycle_is_a_plan_that_is_stored(monkeypatch: pytest.MonkeyPatch) -> None:
    fastest = CYCLES["moves"].fastest()
    assert (fastest.peak(2), fastest(0.01, 1)) == (fastest.cycle.peak(2), fastest.cycle(0.01, 1))
    assert fastest.limits_taken == fastest.cycle.limits_taken
    text, gains = fastest.to_json(), fastest.gains
    with monkeypatch.context() as patched:
        patched.setattr("optlaws.cycles.fastest_cycle.FastestSearch", None)  # nothing is sought any more
        read = FastestCycle.from_json(text)
        assert read == fastest
        assert read.to_json() == text
        assert read.proof_rows() == fastest.proof_rows()
        assert all(checked.proven for checked in verify_all(read.claims()).values())
    assert FastestCycle.from_json(text).gains == gains
    data = fastest.to_dict()
    for changes, error, named in (
        ({"period": 2.0 * fastest.period}, InputError, "has a period of"),
        ({"given": {**data["given"], "limits": {}}}, InputError, "keeps other limits than its cycle"),
        ({"status": "best"}, InputError, "status"),
        ({"cycle": {**data["cycle"], "period": None, "speed": "1000 rpm"}}, InputError, "durations sum"),
    ):
        with pytest.raises(error, match=named):
            FastestCycle.from_dict(data | changes)
    tight = {"acceleration": "10 m/s^2"}
    with pytest.raises(InfeasibleProblem, match="its limit is 10 m/s"):
        FastestCycle.from_dict(data | {name: {**data[name], "limits": tight} for name in ("given", "cycle")})
