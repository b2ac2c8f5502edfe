"""Limits of motions: of both sides, of slowing down, of the snap, and of laws that are given."""

import re
from dataclasses import replace
from math import inf, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    Axes,
    ConstantVelocity,
    Cycle,
    Drive,
    Dwell,
    Free,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    Move,
    Plan,
    Problem,
    Return,
    Rise,
    Status,
    catalogue,
    fastest,
)

MOVES = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "120 deg"), Dwell()]
PAIR = {"acceleration": ("-14 m/s^2", "20 m/s^2")}
KEPT = 1.0 + 1e-9


def cycle(**given: Any) -> Cycle:
    return Cycle(given.pop("segments", MOVES), **({"speed": "200 rpm"} | given))


def test_sides_of_the_acceleration_are_kept_apart_in_both_directions() -> None:
    """The jerk is least where both sides are used up; without limits the law would be symmetric."""
    limited = cycle(limits=PAIR, minimise="jerk")
    assert limited.status == "optimal"
    rise, _, back, _ = limited.peaks
    for peaks in (rise, back):
        (low, _), (high, _) = peaks.extremes[2]
        assert low == pytest.approx(-14.0, rel=1e-9)
        assert high == pytest.approx(20.0, rel=1e-9)
    # the return is the rise run backwards in time
    assert rise.peak(3) == pytest.approx(back.peak(3), rel=1e-8)


def test_deceleration_follows_the_motion() -> None:
    slowed = cycle(limits={"deceleration": "14 m/s^2", "acceleration": "25 m/s^2"}, minimise="jerk")
    assert slowed.limits_of_segments == ({2: (-14.0, 25.0)}, {}, {2: (-25.0, 14.0)}, {})
    rise, _, back, _ = slowed.peaks
    assert rise.extremes[2][0][0] == pytest.approx(-14.0, rel=1e-9)
    assert back.extremes[2][1][0] == pytest.approx(14.0, rel=1e-9)
    assert min(slowed(time, 1) for time in (0.02, 0.05, 0.08)) > 0.0
    alone = cycle(limits={"deceleration": "14 m/s^2"})
    assert alone.limits_of_segments[0] == {2: (-14.0, float("inf"))}


def test_with_free_breaks_a_move_under_two_accelerations_needs_the_velocity_of_a_triangle() -> None:
    """Speeding up with a and slowing down with d a motion of h in T has at least v = T a d/(a + d) (1 - sqrt(...))."""
    h, T, a, d = 0.035, 0.1, 40.0, 25.0
    m = a * d / (a + d)
    least = m * T * (1.0 - sqrt(1.0 - 2.0 * h / (m * T * T)))
    limits = {"acceleration": "40 m/s^2", "deceleration": "25 m/s^2"}
    near = cycle(limits=limits, minimise="velocity", order=2, degree=19)
    assert near.status == "optimal"
    assert least < near.objective < 1.03 * least


def test_snap_is_kept_and_named_where_no_law_keeps_it() -> None:
    smooth = cycle(limits={"snap": "160000 m/s^4"}, order=4)
    assert smooth.status == "optimal"
    for piece in smooth.pieces[::2]:
        assert piece.law.peak(4).value * abs(piece.stroke) / piece.duration**4 <= 160000.0 * KEPT
    with pytest.raises(
        InfeasibleProblem, match=r"the least is the snap 145273 m/s\^4, but its limit is the snap 60000"
    ):
        cycle(limits={"snap": "60000 m/s^4"}, order=4).status  # noqa: B018


@pytest.mark.parametrize(
    ("jerk", "remedy"),
    [("1000 m/s^3", "more time or a wider limit"), ("1150 m/s^3", "a wider limit or a higher degree")],
)
def test_a_higher_degree_is_offered_where_it_may_help(jerk: str, remedy: str) -> None:
    """A motion of 35 mm in 0.1 s has a jerk of 32 times 35 m/s^3 at least, whatever its degree."""
    rise = [Rise("35 mm", "0.1 s"), Dwell("0.1 s"), Return()]
    with pytest.raises(InfeasibleProblem, match=f"the least is the jerk .*: give it .*{remedy}") as refused:
        Cycle(rise, period="0.4 s", limits={"jerk": jerk}).solve()
    assert refused.value.tried.endswith("k = 0 is at 0 s (0 deg), k = 1 at 0.1 s (90 deg)")


@pytest.mark.long
def test_joined_motions_have_limits_of_their_segments() -> None:
    """Of two free motions one may slow down less than the other."""
    limits = {"acceleration": ("-4 m/s^2", "12 m/s^2")}
    first = [Dwell("0.1 s"), Free("30 mm", "0.2 s", limits=limits), Free("-30 mm")]
    joined = Cycle(first, period="0.5 s", minimise="jerk")
    assert joined.status == "optimal"
    assert joined.peaks[1].extremes[2][0][0] >= -4.0 * KEPT
    assert joined.peaks[2].extremes[2][0][0] < -5.0
    snapped = Cycle([first[0], Free("30 mm", "0.2 s"), first[2]], period="0.5 s", limits={"snap": "89000 m/s^4"})
    (_, law) = snapped.pieces
    assert law.law.peak(4).value * law.stroke / law.duration**4 <= 89000.0 * KEPT
    with pytest.raises(InputError, match="give the snap of all of them the same limit"):
        Cycle([first[0], Free("30 mm", "0.2 s", limits={"snap": "89000 m/s^4"}), first[2]], period="0.5 s").status  # noqa: B018


@pytest.mark.long
def test_free_durations_share_what_both_sides_leave() -> None:
    segments = [Rise("35 mm"), Dwell("90 deg"), Rise("10 mm"), Dwell("20 deg"), Return()]
    shared = cycle(segments=segments, limits={"acceleration": ("-22 m/s^2", "30 m/s^2")})
    levels = [shared.peaks[i].extremes[2] for i in (0, 2, 4)]
    assert all(low >= -22.0 * KEPT for (low, _), _ in levels)
    assert levels[0][1][0] == pytest.approx(levels[1][1][0], rel=1e-6)


@pytest.mark.parametrize(
    ("limits", "says"),
    [
        ({"deceleraton": "4 m/s^2"}, "did you mean 'deceleration'"),
        ({"acceleration": ("3 m/s^2", "20 m/s^2")}, "the least must be below 0 and the greatest above 0"),
        ({"acceleration": ("-3 m/s^2",)}, "limits: acceleration must be a list of 2 at least"),
        ({"snap": ("-3 m/s^4", "9 m/s^4")}, "limits: snap must be a snap such as"),
        ({"snap": "9 m/s^3"}, r"limits: snap must be a snap such as '50000 m/s\^4' or .*, but '9 m/s\^3' is a jerk"),
        ({"deceleration": ("-3 m/s^2", "9 m/s^2")}, "limits: deceleration must be an acceleration"),
    ],
)
def test_limits_that_are_wrong_are_named_with_the_remedy(limits: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        cycle(limits=limits)


def test_slowing_down_is_refused_where_a_motion_turns() -> None:
    limits = {"deceleration": "40 m/s^2"}
    remedy = "give its acceleration as the least and the greatest"
    with pytest.raises(InputError, match=rf"segment 2 \(Free\) may turn back.*{remedy}"):
        Cycle([Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")], period="0.5 s", limits=limits)
    with pytest.raises(InputError, match=rf"segment 2 \(Return\) begins or ends against its way.*{remedy}"):
        Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="0.4 s", limits=limits)


def test_files_of_cycles_and_axes_keep_both_sides() -> None:
    rise = Move("35 mm", "120 deg", limits={"jerk": ("-9000 m/s^3", "8000 m/s^3")})
    given = cycle(segments=[rise, *MOVES[1:]], limits=PAIR)
    again = Cycle.from_json(given.to_json())
    assert again.limits_of_segments == given.limits_of_segments
    assert again.limits_of_segments[0] == {2: (-14.0, 20.0), 3: (-9000.0, 8000.0)}
    machine = Axes({"slide": {"segments": given.segments, "limits": PAIR}}, speed="200 rpm")
    assert 'acceleration = ["-14 m/s^2", "20 m/s^2"]' in machine.to_toml()
    assert Axes.from_json(machine.to_json())["slide"].limits_of_segments == given.limits_of_segments


def test_the_summary_says_how_much_of_such_limits_is_taken() -> None:
    slowed = cycle(limits={"deceleration": "14 m/s^2", "acceleration": "25 m/s^2"}, minimise="jerk")
    rows = {row.name: row for row in slowed.summary()}
    assert rows["deceleration"].value == pytest.approx(14.0, rel=1e-9)
    assert rows["deceleration"].note == "limit 14 m/s^2 of segment 1 (Rise)"
    assert slowed(rows["deceleration"].place, 2) == pytest.approx(-14.0, rel=1e-6)
    assert rows["acceleration along the motion"].note.startswith("limit 25 m/s^2 of segment")
    assert "snap" not in rows
    snapped = cycle(limits={"snap": "200000 m/s^4"}, order=4)
    (row,) = (row for row in snapped.summary() if row.name == "snap")
    assert 0.9 * 200000.0 < row.value <= 200000.0 * KEPT
    assert row.unit == "m/s⁴"
    (pair,) = (row for row in cycle(limits=PAIR, minimise="jerk").summary() if row.name == "lowest acceleration")
    assert pair.note == "limit -14 m/s^2 of segment 1 (Rise)"


def test_a_jerk_limit_of_laws_that_jump_at_their_ends_is_refused_with_the_remedy() -> None:
    with pytest.raises(InputError, match=r"segment 1 .*: its jerk is limited, but laws of order 2 .*: take order 3"):
        cycle(limits={"jerk": "9000 m/s^3"}, order=2)
    assert cycle(limits={"jerk": "9000 m/s^3"}).order == 3
    moved = (Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal"))
    assert Cycle(moved, period="0.25 s", limits={"jerk": "90000 m/s^3"}, order=2).order == 2


FORTH = {"velocity": ("0 m/s", "2 m/s")}
#: from a velocity to rest in more time than the way takes: the law of least acceleration overshoots and returns
BRAKED = [ConstantVelocity("0.4 m/s", "0.1 s"), Move("20 mm", "0.2 s"), Dwell("0.1 s"), Return()]
GOING_BACK = "formula: k^3*(10 - 15*k + 6*k^2) - 1.6*(k*(1 - k))^2*(1 - 2*k)"


def backwards(limited: Cycle | Plan, i: int, stop: float | None = None) -> float:
    """The greatest velocity against the way of a piece."""
    piece = limited.pieces[i]
    (low, _), (high, _) = piece.extremes(1, piece.start, stop or piece.stop)
    return max(0.0, -low if piece.stroke > 0.0 else high)


def test_a_velocity_from_0_on_never_turns_back() -> None:
    steady, _, *rest = BRAKED
    forth = [steady, Move("20 mm", "0.2 s", limits=FORTH), *rest]
    free, limited = (Cycle(ways, period="0.7 s", minimise="jerk") for ways in (BRAKED, forth))
    assert backwards(free, 1) > 0.01
    assert backwards(limited, 1) < 1e-9
    assert free.pieces[1].law.peak(3).value < limited.pieces[1].law.peak(3).value
    assert limited.limits_of_segments == ({}, {1: (0.0, 2.0)}, {}, {})
    assert all(taken.is_kept for taken in limited.limits_taken)
    assert {taken.share for taken in limited.limits_taken if "backwards" in taken.name} == {0.0}


def test_free_motions_that_must_not_turn_back_rest_where_they_meet() -> None:
    """Forth and back by h in T each without turning before the end is two motions to or from rest: C >= 4 h/T^2."""
    ways = [Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")]
    free, limited = (Cycle(ways, period="0.6 s", limits=limits) for limits in ({}, FORTH))
    assert limited.status == "optimal"
    assert limited(0.3, 1) == pytest.approx(0.0, abs=1e-9)
    assert limited.objective > 4.0 * 0.03 / 0.2**2 > free.objective
    assert backwards(limited, 1, 0.3) < 1e-9


def test_a_given_law_that_goes_back_is_refused_where_it_must_not() -> None:
    moves = [Rise("35 mm", "120 deg", law=GOING_BACK), Dwell("60 deg"), Return(law="cycloidal")]
    shown = cycle(segments=moves, limits=FORTH).unchecked()
    assert shown.status == "infeasible"
    (back,) = (taken for taken in shown.limits_taken if not taken.is_kept)
    assert back.value == pytest.approx(backwards(shown, 0))
    assert back.share == float("inf")
    with pytest.raises(InfeasibleProblem, match=r"segment 1 \(Rise\): it goes back at .* mm/s at .* of the master"):
        cycle(segments=moves, limits=FORTH).objective  # noqa: B018 - laws are looked at when they are needed
    with pytest.raises(InfeasibleProblem, match=r"segment 1 \(Rise\): its law goes back, .* at any speed"):
        cycle(segments=moves, limits=FORTH | {"acceleration": "20 m/s^2"}).fastest()
    with pytest.raises(InfeasibleProblem, match=r"axis slide: segment 1 \(Rise\): its law goes back, .* at any speed"):
        Axes({"slide": cycle(segments=moves, limits=FORTH | {"acceleration": "20 m/s^2"})}).fastest()


@pytest.mark.parametrize(
    ("segments", "error", "words"),
    [
        ([ConstantVelocity("1.5 m/s", "80 ms"), Return()], InfeasibleProblem, "begins or ends against its way"),
        (
            [Dwell("0.1 s"), Free("0 mm", "0.1 s", via=[("0.05 s", "5 mm")]), Dwell()],
            InputError,
            "ends where it begins, so that it must turn back",
        ),
    ],
)
def test_motions_that_must_turn_back_are_refused_where_they_must_not(segments: Any, error: Any, words: str) -> None:
    with pytest.raises(error, match=words):
        Cycle(segments, period="400 ms", limits=FORTH).objective  # noqa: B018


def test_the_fastest_cycle_and_the_fastest_move_never_turn_back_alike() -> None:
    limits = {"velocity": ("0 m/s", "1 m/s"), "acceleration": "20 m/s^2", "jerk": "900 m/s^3"}
    found = cycle(segments=[Rise("35 mm", "180 deg"), Return()], limits=limits).fastest()
    move = fastest(Problem(order=3), stroke="35 mm", limits=limits)
    assert found.status == "optimal"
    assert found.segments[0].least == pytest.approx(move.duration, rel=1e-8)


@pytest.mark.parametrize(
    ("smooth", "degree"),
    [
        ({}, 3),
        pytest.param({}, 9, marks=pytest.mark.long),
        pytest.param({"jerk": "900 m/s^3"}, 9, marks=pytest.mark.long),
    ],
    ids=str,
)
def test_joined_motions_of_the_fastest_cycle_never_turn_back(smooth: dict[str, str], degree: int) -> None:
    def turned_back(least: str) -> float:
        """The greatest velocity against the way of a piece, within limits of the velocity from the least one on."""
        limits: dict[str, Any] = {"velocity": (least, "1 m/s"), "acceleration": "20 m/s^2", **smooth}
        several = cycle(segments=ways, limits=limits, degree=degree).fastest().cycle
        return max(backwards(several, i) for i in range(len(several.pieces)))

    ways = [Dwell("90 deg"), Free("30 mm", "90 deg"), Free("5 mm", "60 deg"), Return("35 mm")]
    assert turned_back("0 m/s") < 1e-8
    if not smooth and degree > 3:
        assert turned_back("-1 m/s") > 0.1


_SOME = st.none() | st.floats(1.0, 99.0)


def accelerations(data: st.DataObject, name: str) -> tuple[dict[str, Any], tuple[float, float], tuple[float, float]]:
    """Limits of the acceleration as entries, as an interval of the axis, and as one along the motion."""
    entries: dict[str, Any] = {}
    signed, along = (-inf, inf), (-inf, inf)
    most, slow, low = (data.draw(_SOME, f"{name}: {what}") for what in ("most", "deceleration", "least"))
    if slow is not None:
        entries["deceleration"], along = f"{slow!r} m/s^2", (-slow, inf)
    if most is not None and low is not None:
        entries["acceleration"], signed = (f"{-low!r} m/s^2", f"{most!r} m/s^2"), (-low, most)
    elif most is not None:
        entries["acceleration"] = f"{most!r} m/s^2"
        signed, along = (signed, (along[0], most)) if slow is not None else ((-most, most), along)
    return entries, signed, along


@given(st.data(), st.booleans())
def test_limits_of_a_segment_are_what_those_of_cycle_and_segment_have_in_common(
    data: st.DataObject,
    back: bool,  # noqa: FBT001 - a case
) -> None:
    of_cycle, *known = accelerations(data, "cycle")
    of_segment, *more = accelerations(data, "segment")
    move = Move("-35 mm" if back else "35 mm", "120 deg", limits=of_segment, law="cycloidal")
    limited = cycle(segments=[move, Dwell("60 deg"), Move(to="0 mm", law="cycloidal")], limits=of_cycle)
    low, high = -inf, inf
    for signed, along in (known, more):
        turned = (-along[1], -along[0]) if back else along
        low, high = max(low, signed[0], turned[0]), min(high, signed[1], turned[1])
    assert limited.limits_of_segments[0].get(2, (-inf, inf)) == (low, high)


# --- laws that are given ---


LAWS = ("cycloidal", "modified sine", "modified trapezoid", "polynomial 3-4-5", "polynomial 4-5-6-7")
WEAK = Motor("3e-4 kg m^2", rated_torque="1 N m", peak_torque="3 N m", greatest_speed="600 rpm")
FROM_REST = [law for law in sorted(catalogue) if np.all(abs(catalogue[law].law(np.array([0.0, 1.0]), 1)) < 1e-9)]
GEARED = Drive(Mechanism("0.8 kg m^2", load="3 N m", viscous="0.5 N m s/rad"), WEAK, ratio=20)


def slide(law: str = "cycloidal", **entries: Any) -> Cycle:
    """A slide that rises faster than it returns."""
    moves = [Rise("35 mm", "120 deg", law=law), Dwell("60 deg"), Return(law=law)]
    return Cycle(moves, **{"speed": "200 rpm", **entries})


def table(law: str = "modified sine", **entries: Any) -> Cycle:
    """An indexing table that a geared motor drives."""
    moves = [Rise("45 deg", "0.25 s", law=law), Dwell()]
    return Cycle(moves, **{"period": "0.6 s", "advance": "45 deg", "drive": GEARED, **entries})


def values(cycle: Cycle) -> dict[str, tuple[float, str]]:
    """What a cycle takes, by dense sampling and sums, with its unit."""
    times = (np.arange(60_001) + 0.5) * (cycle.duration / 60_001)
    joints = np.array([joint["time"] for joint in cycle.joints])
    looks = np.concatenate([times, joints + 1e-9 * cycle.duration, joints - 1e-9 * cycle.duration])
    angle = cycle.axis == "angle"
    unit = "rad" if angle else "m"
    greatest = {
        name: (float(np.abs(cycle(looks, nu)).max()), f"{unit}/s{'' if nu == 1 else f'^{nu}'}")
        for nu, name in enumerate(("velocity", "acceleration", "jerk"), 1)
    }
    if cycle.drive is None:
        return greatest
    force, power = cycle.force(times), cycle.power(times)
    taken = cycle.effort.motoring_energy, cycle.effort.braking_energy
    regeneration = getattr(cycle.drive, "regeneration", 0.0)
    return greatest | {
        "torque" if angle else "force": (float(np.abs(force).max()), "N m" if angle else "N"),
        "rms torque" if angle else "rms force": (float(np.sqrt((force**2).mean())), "N m" if angle else "N"),
        "power": (float(np.abs(power).max()), "W"),
        "energy": (taken[0] - regeneration * taken[1], "J"),
    }


def refused(cycle: Cycle) -> InfeasibleProblem:
    with pytest.raises(InfeasibleProblem) as caught:
        cycle.objective  # noqa: B018 - the motion is needed for it
    for ask in (lambda: cycle.peaks, lambda: cycle(0.0), lambda: cycle.status):
        with pytest.raises(InfeasibleProblem):
            ask()
    assert cycle.unchecked().status is Status.INFEASIBLE
    return caught.value


@pytest.mark.sample(4)
@pytest.mark.parametrize("kind", ["velocity", "acceleration", "jerk", "force", "rms force", "power", "energy"])
@pytest.mark.parametrize("law", LAWS)
def test_a_slide_beyond_a_limit_is_refused_and_one_that_reaches_it_is_not(kind: str, law: str) -> None:
    drive = {"mass": "2 kg", "gravity": "20 N", "viscous": "5 N s/m"}
    value, unit = values(slide(law, drive=drive))[kind]
    assert slide(law, drive=drive, limits={kind: f"{1.001 * value!r} {unit}"}).status is Status.OPTIMAL
    error = refused(slide(law, drive=drive, limits={kind: f"{0.999 * value!r} {unit}"}))
    exact = error.proof[0].value  # type: ignore[index] # what is taken of each broken limit
    assert value * (1.0 - 1e-6) <= exact <= value * (1.0 + 1e-6)
    # a limit that is reached is kept, one that is missed by a millionth is not
    assert slide(law, drive=drive, limits={kind: f"{exact!r} {unit}"}).status is Status.OPTIMAL
    refused(slide(law, drive=drive, limits={kind: f"{exact * (1.0 - 1e-6)!r} {unit}"}))


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"peak_torque": "0.1 N m"}, "torque"),
        ({"rated_torque": "0.01 N m"}, "RMS torque"),
        ({"greatest_speed": "100 rpm"}, "velocity"),
        ({"peak_torque": "1 MN m", "curve": [("0 rpm", "5 N m"), ("1200 rpm", "0.5 N m")]}, "motor's curve"),
    ],
)
def test_a_motor_that_is_too_weak_is_refused_where_its_limits_are_to_be_kept(change: dict[str, Any], word: str) -> None:
    strong: dict[str, Any] = {"rated_torque": "9 N m", "peak_torque": "30 N m", "greatest_speed": "3000 rpm"}
    enough = replace(GEARED, motor=Motor("3e-4 kg m^2", **strong))
    assert table(drive=enough, limits={"motor": True}).sheet.fits
    weak = replace(GEARED, motor=Motor("3e-4 kg m^2", **{**strong, **change}))
    cycle = table(drive=weak, limits={"motor": True})
    assert word in str(refused(cycle))
    assert not cycle.unchecked().sheet.fits
    # without the limit it is what the sheet says
    assert (table(drive=weak).status, table(drive=weak).sheet.fits) == (Status.OPTIMAL, False)


def test_limits_of_segments_and_of_one_side_bind_too() -> None:
    peak = slide().peak(2)
    rise = Rise("35 mm", "120 deg", law="cycloidal", limits={"acceleration": f"{0.9 * peak!r} m/s^2"})
    error = refused(Cycle([rise, Dwell("60 deg"), Return(law="cycloidal")], speed="200 rpm"))
    assert str(error).startswith("segment 1 (Rise): it takes the acceleration 21.9911 m/s^2 at 30 deg of the master")
    assert "1.05409 times as much time" in str(error)  # the root of 1/0.9
    back = -float(np.min(slide()(np.linspace(0.0, 0.1, 9001), 2)))
    for share, holds in ((1.001, True), (0.999, False)):
        for limits in (
            {"acceleration": (f"{-share * back!r} m/s^2", "99 m/s^2")},
            {"deceleration": f"{share * back!r} m/s^2", "acceleration": "99 m/s^2"},
        ):
            cycle = slide(limits=limits)
            assert cycle.unchecked().status is (Status.OPTIMAL if holds else Status.INFEASIBLE)


def test_snap_and_jumps_inside_a_law() -> None:
    law = slide("polynomial 4-5-6-7").pieces[0].law
    snap = law.peak(4).value * 0.035 / 0.1**4
    smooth = slide("polynomial 4-5-6-7", limits={"snap": f"{1.001 * snap!r} m/s^4"})
    assert smooth.unchecked().limits_taken[0].value == pytest.approx(snap, rel=1e-12)
    assert "its acceleration jumps" in str(refused(slide("parabolic", limits={"jerk": "1e9 m/s^3"})))


def test_constant_velocities_and_holding_forces_bind_too() -> None:
    moves = [ConstantVelocity("1.5 m/s", "80 ms"), Return()]
    with pytest.raises(InfeasibleProblem, match=r"^segment 1 \(ConstantVelocity\): it takes the velocity 1500 mm/s"):
        Cycle(moves, period="400 ms", limits={"velocity": "1.2 m/s"}).peaks  # noqa: B018 - a property that is refused
    held = slide(drive={"mass": "1 g", "preload": "100 N"}, limits={"force": "99 N"})
    assert {taken.where for taken in refused(held).proof} == {  # type: ignore[attr-defined]
        "segment 1 (Rise)",
        "segment 2 (Dwell)",
        "segment 3 (Return)",
    }
    with pytest.raises(InputError, match="give one, such as drive="):
        slide(limits={"force": "99 N"}).peaks  # noqa: B018 - a property that is refused


def test_a_given_law_beside_an_optimal_one_is_refused_by_its_own_limit() -> None:
    moves = [Rise("35 mm", "120 deg", law="cycloidal"), Dwell("60 deg"), Return()]
    assert Cycle(moves, speed="200 rpm", limits={"acceleration": "22 m/s^2"}).status is Status.OPTIMAL
    error = refused(Cycle(moves, speed="200 rpm", limits={"acceleration": "21 m/s^2"}))
    assert [taken.where for taken in error.proof] == ["segment 1 (Rise)"]  # type: ignore[attr-defined]


@given(
    law=st.sampled_from(LAWS),
    kind=st.sampled_from(["velocity", "acceleration", "jerk", "torque", "rms torque"]),
    stroke=st.floats(1e-9, 1e9),
    period=st.floats(1e-6, 1e6),
    share=st.floats(0.01, 100.0),
)
def test_status_refusal_and_greatest_speed_agree_in_all_units(
    law: str, kind: str, stroke: float, period: float, share: float
) -> None:
    moves = [Move(f"{stroke!r} rad", "120 deg", law=law), Dwell("60 deg"), Move(f"{-stroke!r} rad", "180 deg", law=law)]
    entries: dict[str, Any] = {"drive": {"inertia": "1 kg m^2"}}
    cycle = Cycle(moves, period=f"{period!r} s", **entries)
    value, unit = values(cycle)[kind]
    limited = replace(cycle, limits={kind: f"{share * value!r} {unit}"})
    shown = limited.unchecked()
    kept = all(taken.is_kept for taken in shown.limits_taken)
    assert (shown.status is Status.OPTIMAL) is kept
    if abs(share - 1.0) > 1e-4:
        assert kept is (share > 1.0)
    fastest = limited.fastest()
    nu = {"velocity": 1, "acceleration": 2, "jerk": 3, "torque": 2, "rms torque": 2}[kind]
    assert fastest.period == pytest.approx(period * share ** (-1.0 / nu), rel=1e-5)
    # the cycle at that speed keeps them, and one that is faster does not
    assert fastest.cycle.status is Status.OPTIMAL
    least = fastest.period
    assert replace(limited, period=f"{least * (1.0 + 1e-8)!r} s").status is Status.OPTIMAL
    assert replace(limited, period=f"{least * (1.0 - 1e-6)!r} s").unchecked().status is Status.INFEASIBLE


def test_a_limit_of_energy_has_no_greatest_speed_that_is_known() -> None:
    limited = slide(drive={"mass": "2 kg"}, limits={"energy": "1 J"})
    with pytest.raises(InputError, match="energy"):
        limited.fastest()


@pytest.mark.parametrize("law", FROM_REST)
@pytest.mark.parametrize("between", [(), (Dwell("0.05 s"),)])
def test_accelerations_that_jump_where_segments_meet_break_every_limit_of_the_jerk(
    law: str, between: tuple[Dwell, ...]
) -> None:
    moves = [Rise("35 mm", "0.1 s", law=law), *between, Return(law="polynomial 3-4-5")]
    limited = Cycle(moves, period="0.25 s", limits={"jerk": "1e15 m/s^3"})
    shown = limited.unchecked()
    # a nanosecond beside a place, an acceleration that is continuous has changed little
    times = np.concatenate([[joint["time"] for joint in shown.joints], np.linspace(0.0, 0.25, 2001)[1:-1]])
    apart = np.abs(shown(times + 1e-9, 2) - shown(times - 1e-9, 2))
    jumps = bool(np.max(apart) > 1e-3 * shown.peak(2))
    assert shown.status is (Status.INFEASIBLE if jumps else Status.OPTIMAL)
    assert (shown.limits_taken[0].value == np.inf) is jumps
    if jumps:
        assert str(refused(limited)).startswith("segment 1 (Rise): its acceleration jumps at ")
        with pytest.raises(
            InfeasibleProblem, match=r"^segment 1 \(Rise\): its (law|acceleration) jumps, so that no speed"
        ):
            limited.fastest()


def test_accelerations_that_neighbours_share_do_not_jump() -> None:
    harmonic = [Rise("35 mm", "0.1 s", law="simple harmonic"), Return(law="simple harmonic")]
    limits = {"jerk": "1e6 m/s^3"}
    assert Cycle(harmonic, period="0.2 s", limits=limits).peak(3) == pytest.approx(0.0175 * (10 * np.pi) ** 3)
    # an optimal law takes the acceleration of its neighbour; one that is given does not
    assert Cycle([harmonic[0], Return()], period="0.2 s", limits=limits).status is Status.OPTIMAL
    assert "jumps at 0 deg" in str(refused(Cycle(harmonic, period="0.25 s", limits=limits)))
    of_snap = Cycle(harmonic, period="0.25 s", limits={"snap": "1e9 m/s^4"})
    assert "segment 1 (Rise): its law jumps" in str(refused(of_snap))


def test_the_limit_that_needs_the_most_time_is_told_first() -> None:
    """With the time that the error asks for, to the digits that it has, the law keeps all its limits."""

    def moved(duration: float) -> Cycle:
        limits = {"acceleration": "18 m/s^2", "jerk": "1500 m/s^3"}
        rise = Rise("35 mm", f"{duration!r} s", law="modified sine", limits=limits)
        return Cycle([rise, Return(law="cycloidal")], period="0.5 s")

    with pytest.raises(
        InfeasibleProblem, match=r"; also beyond its limit: segment 1 \(Rise\): acceleration, "
    ) as broken:
        moved(0.1).solve()
    longer = re.search(r"takes the jerk .* give it ([\d.]+) times as much time", str(broken.value))
    assert longer is not None
    more = float(longer[1]) * (1.0 + 1e-5)
    assert max(taken.share for taken in moved(0.1 * more).solve().limits_taken) <= 1.0
