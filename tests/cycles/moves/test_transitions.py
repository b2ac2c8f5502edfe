"""Run-ins and run-outs, and what no law beats of least times."""

import json
from collections.abc import Callable, Iterable
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Axes,
    BoundaryConditions,
    Cycle,
    Drive,
    Dwell,
    Free,
    InputError,
    Mechanism,
    Motor,
    Move,
    Problem,
    Return,
    Rise,
    TransitionCam,
    fastest,
    fastest_moves,
)
from optlaws.verification import verify_all
from tests.internals.cli import exit_code
from tests.synthesis.reference import least_share

LIMITS = {"velocity": "0.5 m/s", "acceleration": "4 m/s^2", "jerk": "100 m/s^3"}


@pytest.fixture(scope="module")
def slide() -> Cycle:
    moves = [Rise("35 mm", "120 deg", law="modified sine"), Dwell("60 deg"), Return(law="cycloidal")]
    return Cycle(moves, speed="60 rpm", limits=LIMITS)


@pytest.fixture(scope="module")
def start(slide: Cycle) -> TransitionCam:
    return slide.run_in("40 deg", rest="-20 mm", order=4)


def side_of(cycle: Cycle, degrees: float, nu: int, side: float) -> float:
    return float(cycle.at_angle(degrees + side * 1e-9, nu))


@pytest.mark.sample(3)
@pytest.mark.parametrize(("at", "rest", "order"), [(40.0, "50 mm", 4), (300.0, "-5 mm", 3), (120.0, "0 mm", 4)])
@pytest.mark.parametrize("kind", ["run-in", "run-out"])
def test_a_cam_in_a_given_angle_goes_from_rest_to_the_motion_of_the_cycle(
    slide: Cycle, kind: str, at: float, rest: str, order: int
) -> None:
    make = slide.run_in if kind == "run-in" else slide.run_out
    cam = make(f"{at} deg", rest=rest, over="150 deg", order=order)
    joined, still = (cam.duration, 0.0) if kind == "run-in" else (0.0, cam.duration)
    side = 1.0 if kind == "run-in" else -1.0
    assert cam.duration == pytest.approx(150.0 / 360.0)
    assert cam.master == pytest.approx((at - 150.0, at) if kind == "run-in" else (at, at + 150.0))
    assert cam(still) == pytest.approx(float(rest.split(maxsplit=1)[0]) / 1e3, abs=1e-15)
    for nu in range(order):
        size = max(cam.peak(nu), slide.peak(nu))
        assert cam(joined, nu) == pytest.approx(side_of(slide, at, nu, side), abs=1e-6 * size)
        assert nu == 0 or cam(still, nu) == pytest.approx(0.0, abs=1e-12 * size)
    assert list(cam.jumps.values())[:order] == [0.0] * order
    for nu, most in ((1, 0.5), (2, 4.0), (3, 100.0)):
        assert np.abs(cam(np.linspace(0.0, cam.duration, 2001), nu)).max() <= cam.peak(nu) * (1 + 1e-12)
        assert cam.peak(nu) <= most * (1.0 + 1e-9)
    assert cam.status.value == "optimal"


def share_of_limits(cam: TransitionCam, duration: float) -> float:
    """What laws of the cam's degree, from rest to its state in a time, take of LIMITS at the least, by HiGHS."""
    problem = cam.solution.problem
    ends = BoundaryConditions(
        (cam.rest, *[0.0] * (problem.order - 1)),
        tuple(cam.state[nu] * duration**nu for nu in range(problem.order)),
    )
    share = least_share(duration, 1.0, {"B": 0.5, "C": 4.0, "J": 100.0}, boundary=ends, basis=problem.basis)
    assert share is not None
    return share


def test_the_least_time_is_that_of_a_linear_program_and_proven(slide: Cycle, start: TransitionCam) -> None:
    assert start.least is not None
    assert start.status.value == "optimal"
    assert start.least.gap <= 1.001e-6
    assert all(proof.stands(start.least.least.move) for proof in start.least.least.proofs)
    assert share_of_limits(start, start.duration) == pytest.approx(1.0, rel=1e-5)
    # and no time before, though the ends move
    assert min(share_of_limits(start, part * start.duration) for part in (0.3, 0.6, 0.9)) > 1.0
    for nu, most in ((1, 0.5), (2, 4.0), (3, 100.0)):
        assert start.peak(nu) <= most * (1.0 + 1e-9)
    given = slide.run_in("40 deg", rest="-20 mm", order=4, over=f"{1.0001 * start.duration!r} s")
    assert given.status.value == "optimal"


def test_a_run_out_is_a_run_in_backwards() -> None:
    moves = [Rise("35 mm", "180 deg", law="cycloidal"), Return("35 mm", "180 deg", law="cycloidal")]
    cycle = Cycle(moves, speed="60 rpm", limits=LIMITS)
    into, out = cycle.run_in("60 deg", rest="-20 mm"), cycle.run_out("300 deg", rest="-20 mm")
    assert out.duration == pytest.approx(into.duration, rel=1e-9)
    times = np.linspace(0.0, into.duration, 51)
    backwards = np.maximum(out.duration - times, 0.0)  # durations agree but for rounding
    for nu, sign in enumerate((1.0, -1.0, 1.0)):
        assert out(backwards, nu) == pytest.approx(sign * into(times, nu), abs=1e-9 * into.peak(nu))


def test_jumps_at_a_joint_have_the_side_that_the_cam_joins() -> None:
    cycle = Cycle([Rise("35 mm", "180 deg", law="0050"), Return(law="0050")], speed="60 rpm")
    into, out = (make("180 deg", rest="0 mm", over="90 deg") for make in (cycle.run_in, cycle.run_out))
    assert [into.state[2], out.state[2]] == pytest.approx([-4 * 0.035 / 0.25] * 2)
    assert cycle.run_out("0 deg", rest="5 mm", over="90 deg").state[2] == pytest.approx(4 * 0.035 / 0.25)
    turning = Cycle([Rise("90 deg", "180 deg", law="cycloidal"), Dwell()], period="1 s", advance="90 deg")
    assert turning.run_out("0 deg", rest="-1 rad", over="0.3 s").state[0] == pytest.approx(0.0, abs=1e-12)
    assert turning.run_in("360 deg", rest="-1 rad", over="0.3 s").state[0] == pytest.approx(pi / 2)


def test_where_it_rests_where_it_meets_it_goes_back_and_forth(slide: Cycle) -> None:
    place = f"{1e3 * float(slide.at_angle(40)):.17g} mm"
    cam, back = (make("40 deg", rest=place, over="150 deg") for make in (slide.run_in, slide.run_out))
    assert [cam(0.0), cam(cam.duration)] == pytest.approx([float(slide.at_angle(40))] * 2, abs=1e-15)
    assert back(0.0, 1) == pytest.approx(float(slide.at_angle(40, 1)))
    assert back(back.duration, 1) == pytest.approx(0.0, abs=1e-12)
    assert float(np.min(cam(np.linspace(0.0, cam.duration, 101)))) < cam(0.0) - 1e-3


def test_units_change_nothing() -> None:
    def least(unit: float) -> TransitionCam:
        limits = {"acceleration": f"{4 * unit} m/s^2", "jerk": f"{100 * unit} m/s^3"}
        moves = [Rise(f"{35 * unit} mm", "120 deg", law="cycloidal"), Dwell("60 deg"), Return(law="cycloidal")]
        return Cycle(moves, speed="60 rpm", limits=limits).run_in("60 deg", rest=f"{-20 * unit} mm")

    assert least(1e-9).duration == pytest.approx(least(1e6).duration, rel=1e-8)


def test_law_and_proof_are_plain_data(slide: Cycle, start: TransitionCam) -> None:
    given = slide.run_out("300 deg", over="150 deg")
    for cam in (start, given):
        assert TransitionCam.from_json(cam.to_json()) == cam
        assert all(found.proven for found in verify_all(cam.claims()).values())


DAMAGES: dict[str, Callable[[dict[str, Any]], None]] = {
    "kind": lambda data: data.update(kind="stop"),
    "unit": lambda data: data.update(unit="mm"),
    "best": lambda data: data.update(best=data["least"]["solution"]),
    "state": lambda data: data["state"].pop(),
    "velocity": lambda data: data["state"].__setitem__(1, 1.001 * data["state"][1]),
    "rest": lambda data: data.update(rest=-0.021),
    "duration": lambda data: data.update(duration=0.99 * data["duration"]),
    "period": lambda data: data.update(period=0.0),
    "unknown": lambda data: data.update(more=1),
    "missing": lambda data: data.pop("at"),
    "proof": lambda data: data["least"]["proofs"].pop(),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_files_are_refused(start: TransitionCam, damage: str) -> None:
    data = json.loads(start.to_json())
    DAMAGES[damage](data)
    with pytest.raises(InputError):
        TransitionCam.from_dict(data)


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"at": "400 deg"}, "at must be within the cycle"),
        ({"at": 60}, "without a unit"),
        ({"at": "40 deg", "rest": "20 deg"}, "rest must be a length"),
        ({"at": "40 deg", "over": "0 deg"}, "over must be above 0"),
        ({"at": "40 deg", "order": 1}, "order must be"),
        ({"at": "150 deg", "rest": "35 mm", "over": "90 deg"}, "place of rest at 150 deg, and rests"),
        ({"at": "150 deg", "rest": "35 mm"}, "least time is not sought; give `over`"),
    ],
)
def test_wrong_inputs_are_named(slide: Cycle, given: dict[str, Any], named: str) -> None:
    with pytest.raises(InputError, match=named):
        slide.run_in(**given)


def test_limits_of_a_least_time_are_named(slide: Cycle) -> None:
    with pytest.raises(InputError, match="nothing limits the least time"):
        replace(slide, limits={}).run_in("40 deg", rest="-20 mm")
    with pytest.raises(InputError, match="not of a drive: give `over`"):
        replace(slide, limits={"force": "50 N"}, drive={"mass": "2 kg"}).run_in("40 deg", rest="-20 mm")
    with pytest.raises(InputError, match="velocity: its two values must be opposite"):
        replace(slide, limits={"velocity": ("-1 m/s", "2 m/s")}).run_in("40 deg", rest="-20 mm")
    one_sided = replace(slide, limits={"acceleration": ("-3 m/s^2", "5 m/s^2")})
    for make, rest in ((one_sided.run_in, "-20 mm"), (one_sided.run_out, "60 mm")):
        low, high = (value for value, _ in make("40 deg", rest=rest).piece.extremes(2, 0.0, 9.0))
        assert (low, high) == pytest.approx((-3.0, 5.0), rel=1e-8)


def test_a_force_is_a_limit_in_a_given_time(slide: Cycle) -> None:
    heavy = replace(slide, limits={"force": "3.6 N"}, drive={"mass": "2 kg"})
    cam = heavy.run_in("40 deg", rest="-20 mm", over="200 deg")
    assert cam.peak(2) <= 1.8 * (1.0 + 1e-9)


def test_free_motions_are_joined_and_times_outside_refused() -> None:
    cycle = Cycle([Free("30 mm", "0.4 s"), Free("-30 mm")], period="1 s", minimise="rms acceleration")
    cam = cycle.run_in("90 deg", rest="-10 mm", over="0.3 s", order=4)
    assert [float(cam(0.3, nu)) for nu in range(4)] == pytest.approx([float(cycle(0.25, nu)) for nu in range(4)])
    with pytest.raises(InputError, match=r"lasts from 0 to 0\.3 s"):
        cam(0.31)


def test_exports_and_pictures_are_of_the_cam(slide: Cycle, start: TransitionCam) -> None:
    motion = start.motion("720 mm")
    assert (motion.start, motion.stop) == pytest.approx((0.0, 720.0 * start.duration))
    assert motion.repeats is False
    assert motion.ends(1)[1] == pytest.approx(1e3 * start.state[1] / 720.0)
    assert start.export("codesys-xyva", points=61).report.deviation[0].value < 1e-2
    panels = {artist.axes for artist in start.plot(cycle=slide)}
    assert len(panels) == 4
    assert start._repr_html_().count("jump of jerk") == 1


FILE = """
job = "cycle"
title = "Start and stop"
speed = "60 rpm"
rows = 11

[[axis]]
name = "slide"
limits = { acceleration = "4 m/s^2", jerk = "100 m/s^3" }
segment = [
    { kind = "rise", by = "10 mm", duration = "40 deg", law = "C1" },
    { kind = "rise", by = "20 mm", duration = "80 deg", law = "C2" },
    { kind = "return", duration = "200 deg", law = "formula: k^3*(10 - 15*k + 6*k^2)" },
    { kind = "dwell" },
]
run_in = [{ at = "20 deg", rest = "-20 mm", over = "90 deg" }]
run_out = [{ at = "240 deg", over = "150 deg", order = 4 }]
export = [{ to = "codesys-xyva", points = 13 }]
"""


def test_a_problem_file_has_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "slide.toml"
    file.write_text(FILE, "utf-8")
    assert exit_code(["cycle", str(file), "--json"]) == 0
    known = json.loads(capsys.readouterr().out)["transitions"]
    assert {name: cam["kind"] for name, cam in known.items()} == {"slide_run_in": "run-in", "slide_run_out": "run-out"}
    file.write_text(FILE.replace('at = "240 deg"', 'at = "400 deg"'), "utf-8")
    assert exit_code(["cycle", str(file), "--json"]) != 0
    assert "axis slide: run-out: at must be within the cycle" in capsys.readouterr().err


@pytest.mark.long
def test_they_are_tabled_drawn_exported_and_proven(tmp_path: Path) -> None:
    file = tmp_path / "slide.toml"
    file.write_text(FILE, "utf-8")
    assert exit_code(["run", str(file), "--out", str(tmp_path / "out")]) == 0
    names = {path.name for path in (tmp_path / "out").iterdir()}
    for cam in ("slide_run_in", "slide_run_out"):
        assert {f"{cam}.csv", f"{cam}.svg", f"{cam}_codesys-xyva.st"} <= names
    table = [row.split(",") for row in (tmp_path / "out" / "slide_run_in.csv").read_text("utf-8").splitlines()[2:]]
    assert [float(cell) for cell in table[-1][:4]] == pytest.approx([20.0, 0.25, 10 * (0.5 - 1 / pi), 90.0], rel=1e-6)
    # the laws are proven, the numbers beside them computed again: nothing is left unchecked
    stored = tmp_path / "out" / "cycle.json"
    assert exit_code(["verify", str(stored)]) == 0
    data = json.loads(stored.read_text("utf-8"))
    assert {"transitions.slide_run_in.cam.best", "transitions.slide_run_out.cam.best"} < verify_all(data).keys()
    for name, value in (("velocity", 0.3), ("axis", "ram"), ("cam", data["transitions"]["slide_run_out"]["cam"])):
        data["transitions"]["slide_run_in"] |= {name: value}
        assert not all(each.proven for each in verify_all(data).values())
    data["transitions"] = {"slide_run_in": {"kind": "run-in"}}
    assert [claim.name for claim in verify_all(data)[""].unchecked] == ["transitions.slide_run_in"]


def test_the_summary_says_what_no_law_of_any_degree_beats_or_that_it_is_not_known() -> None:
    """Of a cycle with a dwell: in a given time from rest to rest, into a motion, and in the least time."""
    segments = [Rise("35 mm", "90 deg", law="cycloidal"), Dwell("90 deg"), Return(law="cycloidal")]
    cycle = Cycle(segments, speed="30 rpm", limits=LIMITS)

    def limit(**given: Any) -> Any:
        return next(row.value for row in cycle.run_in(**given).summary() if row.name == "best possible")

    assert limit(at="30 deg", over="90 deg") == "not known"
    assert limit(at="30 deg", rest="-20 mm") == "not known"
    assert 0.5 < limit(at="120 deg", over="90 deg") <= 1.0
    least = cycle.run_in(at="120 deg").least
    assert least is not None
    assert limit(at="120 deg") == least.best_possible
    # seven segments over 35 mm: the acceleration and the jerk bind, not the velocity
    ramp, peak = 0.04, (-0.16 + (0.16**2 + 16.0 * 0.035) ** 0.5) / 2.0
    assert least.best_possible == pytest.approx(2.0 * (peak / 4.0 + ramp), rel=1e-9)


# --- limits of all laws ---


WIDE_LIMITS: dict[str, Any] = {"velocity": "1 m/s", "acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
TABLE = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", peak_torque="4 N m", greatest_speed="900 rpm"), ratio=20)
SLIDE = Cycle([Rise("35 mm", "120 deg"), Dwell("60 deg"), Return()], speed="60 rpm", limits=WIDE_LIMITS)
RESTING = Cycle(
    [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "120 deg"), Dwell()], speed="60 rpm", limits=WIDE_LIMITS
)


def passing(limits: dict[str, Any] = WIDE_LIMITS) -> Cycle:
    """A slide that passes a place at a velocity of its own."""
    moves = [
        Move("30 mm", "90 deg", end_velocity="0.3 m/s"),
        Move("20 mm", "90 deg", start_velocity="0.3 m/s"),
        Move("-50 mm"),
    ]
    return Cycle(moves, speed="60 rpm", limits=limits)


RESULTS: dict[str, Callable[[], Any]] = {
    "a move": lambda: fastest(Problem(order=3), stroke="100 mm", limits=WIDE_LIMITS),
    "a move whose end moves": lambda: fastest(
        Problem(order=3), stroke="100 mm", limits=WIDE_LIMITS, end_velocity="0.2 m/s"
    ),
    "a move with a motor": lambda: fastest(Problem(order=3), stroke="45 deg", limits={}, drive=TABLE),
    "moves": lambda: fastest_moves(Problem(order=3), strokes=["10 mm", "20 mm"], limits=WIDE_LIMITS)[1],
    "a cycle": SLIDE.fastest,
    "a cycle whose ends move": lambda: passing().fastest(),
    "a cycle with a drive": lambda: Cycle(
        [Rise("35 mm", "180 deg"), Return()], speed="60 rpm", drive={"mass": "2 kg"}, limits={"force": "40 N"}
    ).fastest(),
    "a start cam": lambda: SLIDE.run_in("60 deg"),
    "axes": lambda: Axes({"slide": RESTING}).fastest(),
}


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", RESULTS)
def test_every_least_time_says_what_no_law_beats_or_that_it_is_not_known(name: str) -> None:
    result = RESULTS[name]()
    rows: Iterable[Any] = result.summary()
    (row,) = (row for row in rows if row.name == "best possible")
    known = getattr(result, "best_possible", None)
    if row.text() == "not known":
        assert row.note == "for laws of any degree"
        assert known is None
    else:
        least = getattr(result, "period", None) or result.duration
        assert row.value <= least * (1.0 + 1e-9)
        assert known in {None, row.value}
        assert row.note.startswith(("no law of any degree takes less", "no law that never turns back takes less"))


@pytest.mark.parametrize("left", [(), ("velocity",), ("jerk",), ("velocity", "acceleration")])
def test_the_limit_of_a_cycle_whose_ends_move_is_that_of_its_slowest_move(left: tuple[str, ...]) -> None:
    limits = {name: most for name, most in WIDE_LIMITS.items() if name not in left}
    least = passing(limits).fastest()
    assert least.best_possible is not None
    assert least.best_possible <= least.period
    velocity = f"{0.3 / least.best_possible!r} m/s"  # it turns with the master, which takes 1 s
    move = fastest(Problem(order=3), stroke="20 mm", limits=limits, start_velocity=velocity)
    assert move.best_possible == pytest.approx(least.best_possible / 4.0, rel=1e-9)
