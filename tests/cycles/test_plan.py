"""Cycles are values and plans answer them: what is forwarded, stored, copied, and read from files and lines."""

import copy
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from optlaws import (
    Axes,
    Chebyshev,
    ConstantVelocity,
    Cycle,
    DiscCam,
    Drive,
    Dwell,
    FastestCycle,
    Free,
    InfeasibleProblem,
    InputError,
    Machine,
    Mechanism,
    Motor,
    Move,
    Plan,
    Problem,
    Return,
    Rise,
    Status,
    TranslatingRoller,
    at_most,
    energy_fluctuation,
    smoothstep,
    synthesize,
)
from optlaws.verification import verify_all
from tests.internals.cycles import Answers, CycleReport, answer
from tests.internals.files import reading
from tests.internals.jobs import read_of_cycle_entries as read

LIMITS = {"acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
MOVES = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return(duration="120 deg"), Dwell()]
CYCLES = {
    "given": Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s"),
    "moves": Cycle(MOVES, speed="90 rpm", limits=LIMITS),
    "free": Cycle([Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")], period="0.5 s", minimise="rms jerk"),
    "load": Cycle(
        MOVES, speed="90 rpm", load={"period": "20 ms", "damping": 0.05}, minimise="load acceleration", degree=5
    ),
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


# --- values ---


BOTH_SIDES: dict[str, Any] = {"acceleration": ["-90 m/s^2", "95 m/s^2"], "velocity": "2 m/s"}
RISE: dict[str, Any] = {"by": "35 mm", "duration": "120 deg", "limits": {"jerk": "90000 m/s^3"}}


def cycle() -> Cycle:
    load = {"period": "20 ms", "damping": 0.05}
    return Cycle(
        [Rise(**RISE), Dwell("90 deg"), Return()], speed="200 rpm", limits=BOTH_SIDES, drive={"mass": "2 kg"}, load=load
    )


@pytest.mark.parametrize(
    "change",
    [
        lambda it: it.limits.__setitem__("velocity", "0.65 m/s"),
        lambda it: it.limits.__delitem__("velocity"),
        lambda it: it.limits.__ior__({"velocity": "0.65 m/s"}),
        lambda it: it.limits.update(velocity="0.65 m/s"),
        lambda it: it.limits.setdefault("jerk", "9 m/s^3"),
        lambda it: it.limits.clear(),
        lambda it: it.limits.pop("velocity"),
        lambda it: it.limits.popitem(),
        lambda it: it.limits["acceleration"].append("3 m/s^2"),
        lambda it: it.drive.__setitem__("mass", "3 kg"),
        lambda it: it.load.__setitem__("damping", 0.1),
        lambda it: it.segments[0].limits.__setitem__("jerk", "1 m/s^3"),
        lambda it: it.segments.append(Dwell()),
        lambda it: setattr(it, "limits", {}),
        lambda it: setattr(it.segments[0], "limits", {}),
    ],
)
def test_nothing_of_a_cycle_can_be_changed(change: Callable[[Any], Any]) -> None:
    given = cycle()
    before = given.to_json()
    with pytest.raises((TypeError, AttributeError, FrozenInstanceError)):
        change(given)
    assert given.to_json() == before


def test_what_it_was_made_from_may_change() -> None:
    limits = {"velocity": "2 m/s"}
    given = Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm", limits=limits)
    limits["velocity"] = "0.1 m/s"
    assert given.limits == {"velocity": "2 m/s"}
    via = [("0.1 s", "50 mm")]
    free = Free("60 mm", "0.3 s", via=via)
    via.append(("0.2 s", "55 mm"))
    assert free.via == (("0.1 s", "50 mm"),)


def test_copies_are_equal_and_have_the_same_hash() -> None:
    given = cycle()
    for other in (
        cycle(),
        copy.copy(given),
        copy.deepcopy(given),
        pickle.loads(pickle.dumps(given)),  # noqa: S301 - it was made here
        Cycle.from_json(given.to_json()),
    ):
        assert other == given
        assert hash(other) == hash(given)
        with pytest.raises(TypeError, match="not changed"):
            other.limits["velocity"] = "1 m/s"  # type: ignore[index] # which is what is tested
    assert len({given, cycle()}) == 1
    assert hash(DiscCam(given, "60 mm", TranslatingRoller("12 mm"))) == hash(
        DiscCam(cycle(), "60 mm", TranslatingRoller("12 mm"))
    )
    geared = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20)
    turning = [
        Cycle([Rise("45 deg", "0.2 s"), Dwell()], period="1 s", advance="45 deg", drive=geared) for _ in range(2)
    ]
    assert len(set(turning)) == 1


# --- data, problem files, tables and lines ---


PRESS = Cycle(
    [Rise("35 mm", "120 deg", name="up"), Dwell("90 deg"), Return("35 mm", "100 deg", law="modified sine"), Dwell()],
    speed="200 rpm",
    limits={"velocity": "740 mm/s"},
    drive={"mass": "2 kg"},
)
SHEAR = Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="400 ms", degree=15)
TURNING = Cycle([Free("30 mm", via=[("0.1 s", "10 mm")], duration="0.2 s"), Free("-30 mm")], period="0.5 s")
AWAY_AND_BACK = Cycle(
    [Free("30 mm", "0.1 s"), Dwell("50 ms"), Free("0 mm", "0.1 s", via=[("50 ms", "45 mm")]), Free("-30 mm")],
    period="0.5 s",
    degree=5,
)


@pytest.mark.sample(3)
@pytest.mark.parametrize("cycle", [PRESS, SHEAR, TURNING], ids=["press", "shear", "turning"])
def test_a_cycle_goes_through_json_and_a_problem_file(cycle: Cycle, tmp_path: Path) -> None:
    again = Cycle.from_json(cycle.to_json())
    assert again.to_dict() == cycle.to_dict()
    assert again.objective == pytest.approx(cycle.objective, rel=1e-12)
    file = tmp_path / "cycle.toml"
    file.write_text(cycle.to_toml("Of a cycle", axis="slide"), "utf-8")
    _, cycles = read(reading.toml(file), file)
    assert cycles["slide"].objective == pytest.approx(cycle.objective, rel=1e-12)
    assert cycles["slide"].to_dict() == cycle.to_dict()


def test_laws_and_machines_that_are_values_are_kept_as_data() -> None:
    machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    cycle = Cycle([Rise("35 mm", "0.1 s", law=smoothstep(4)), Return()], period="0.3 s", load=machine)
    again = Cycle.from_json(cycle.to_json())
    assert again.pieces[0].law == smoothstep(4)
    assert again.load == machine
    with pytest.raises(InputError, match="load: a problem file takes a mass on a spring only"):
        cycle.to_toml()


def test_a_law_that_is_a_value_goes_through_a_problem_file(tmp_path: Path) -> None:
    harmonic = synthesize(Problem(order=3, basis=Chebyshev(9), B=1.75)).law
    laws = [smoothstep(4), harmonic, PRESS.pieces[0].law]
    moves = [Move("10 mm", "60 deg", law=law, name='a "quoted" name') for law in laws]
    cycle = Cycle([*moves, Return(law="cycloidal")], speed="200 rpm")
    file = tmp_path / "cycle.toml"
    file.write_text(cycle.to_toml(axis="slide"), "utf-8")
    again = read(reading.toml(file), file)[1]["slide"]
    assert [piece.law for piece in again.pieces] == [piece.law for piece in cycle.pieces]
    assert [again.peak(nu) for nu in range(4)] == [cycle.peak(nu) for nu in range(4)]
    # and as often as it is written
    assert again.to_toml(axis="slide") == cycle.to_toml(axis="slide")


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ({}, "a stored cycle needs its segments"),
        ({"segments": [], "format": "other"}, "format 'optlaws cycle 1', got 'other'"),
        ({"segments": [{"kind": "dwel"}]}, "segment 1: unknown kind of a segment 'dwel'; did you mean 'dwell'"),
        ({"segments": [{"kind": "dwell", "by": "3 mm"}]}, "segment 1: unknown entry of a dwell 'by'; known are"),
        ({"segments": [{"kind": "dwell"}], "sped": "3 rpm"}, "unknown entry of a stored cycle 'sped'; did you mean"),
    ],
)
def test_what_is_no_stored_cycle_is_refused(data: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        Cycle.from_dict(data)


def test_the_same_motion_at_another_speed() -> None:
    for cycle in (PRESS, SHEAR, TURNING, AWAY_AND_BACK):
        fast = cycle.at("400 rpm")
        share = 0.15 / cycle.duration
        for nu in range(1, 4):
            assert fast.peak(nu) == pytest.approx(cycle.peak(nu) / share**nu, rel=1e-9)
        assert fast(0.2 * 0.15) == pytest.approx(cycle(0.2 * cycle.duration))
    assert [segment.label for segment in AWAY_AND_BACK.at("400 rpm").segments] == [
        "Free",
        "Dwell",
        "Free",
        "Free",
        "Free",
    ]
    with pytest.raises(InputError, match="speed must be an angular velocity"):
        PRESS.at("400 mm")


def test_a_line_angles_with_units_and_a_table_of_segments() -> None:
    assert repr(PRESS) == "Cycle([up, Dwell, Return, Dwell], period=0.3 s, minimise='acceleration')"
    many = Cycle([Move("1 mm", law="cycloidal"), *[Dwell("1 deg")] * 8], speed="60 rpm", advance="1 mm")
    assert "and 3 more" in repr(many)
    assert PRESS.at_angle("0.25 rad", 1) == pytest.approx(PRESS.at_angle(np.degrees(0.25), 1))
    with pytest.raises(InputError, match="angle must be an angle"):
        PRESS.at_angle("3 mm")
    frame = PRESS.to_pandas()
    assert frame["segment"].tolist() == ["up", "Dwell", "Return", "Dwell"]
    assert frame["peak velocity, m/s"].max() == pytest.approx(PRESS.peak(1))
    assert frame["duration, s"].sum() == pytest.approx(0.3)


def test_all_is_drawn_into_one_pair_of_axes_with_the_limits() -> None:
    axes = Figure().subplots()
    artists = PRESS.plot(axes)
    curves = [line for line in axes.lines if "/" in str(line.get_label())]
    assert len(curves) == 4
    assert {artist.axes for artist in artists} == {axes}
    assert all(np.abs(np.asarray(line.get_ydata())).max() == pytest.approx(1.0, rel=1e-6) for line in curves)
    assert any(line.get_linestyle() == "--" for line in axes.lines)
    with pytest.raises(InputError, match="one pair of axes or into four, got 2"):
        PRESS.plot(list(Figure().subplots(2, 1)))


def test_a_law_is_given_by_its_json_text_in_files_too(tmp_path: Path) -> None:
    law = smoothstep(4)
    cycle = Cycle([Rise("35 mm", "0.1 s", law=law.to_json()), Return(law="cycloidal")], period="0.3 s")
    assert cycle.pieces[0].law == law
    file = tmp_path / "stored.toml"
    file.write_text(cycle.to_toml(), "utf-8")
    assert read(reading.toml(file), file)[1]["axis"].pieces[0].law == law
    with pytest.raises(InputError, match=r"segment 1 \(Rise\): law: a law must be JSON text"):
        Cycle([Rise("35 mm", "0.1 s", law="{"), Return(law="cycloidal")], period="0.3 s")


def test_a_given_law_that_decides_the_objective_is_optimal_whatever_the_others_are() -> None:
    """The laws of least power are local; where a given law takes more than they do, none of them can be better."""
    moves = [Rise("20 mm", "0.2 s"), Return("20 mm", "0.1 s", law="modified sine"), Dwell()]
    drive = {"mass": "2 kg", "viscous": "3 N s/m"}
    plan = Cycle(moves, period="0.4 s", minimise="power", drive=drive, degree=5).solve()
    assert plan.solutions[0].status == "local"
    assert plan.objective == pytest.approx(plan.lower_bound, rel=1e-12)
    assert plan.status == "optimal"


def test_the_table_of_a_motion_has_its_elastic_load() -> None:
    """Of a massless spring and a mass: m x'' = k (s - x), without damping, and both columns are of one motion."""
    load = {"period": "23 ms", "damping": 0.0, "mass": "2 kg"}
    moves = [Rise("30 mm", "120 deg", law="cycloidal"), Dwell("60 deg"), Return(law="cycloidal")]
    cycle = Cycle(moves, speed="300 rpm", load=load)
    table = CycleReport(cycle).motion(721)
    columns = dict(zip(table.headings, np.array(table.rows).T, strict=True))
    accelerated, force = columns["acceleration of the load, m/s²"], columns["force of the load, N"]
    assert np.abs(accelerated).max() == pytest.approx(cycle.value("load acceleration"), rel=1e-3)
    np.testing.assert_allclose(np.abs(force), np.abs(2.0 * accelerated), atol=1e-6)
    stretched = columns["deflection of the load, m"] * (2.0 * np.pi / 0.023) ** 2
    np.testing.assert_allclose(np.abs(stretched), np.abs(accelerated), atol=1e-5)
