"""Limits of both sides apart, of slowing down, and of the snap: against closed forms, and kept over the whole cycle."""

from math import inf, sqrt
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    Axes,
    ConstantVelocity,
    Cycle,
    Dwell,
    Free,
    InfeasibleProblem,
    InputError,
    Move,
    Plan,
    Problem,
    Return,
    Rise,
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
    ways = [Dwell("90 deg"), Free("30 mm", "90 deg"), Free("5 mm", "60 deg"), Return("35 mm")]
    several = cycle(segments=ways, limits=limits).fastest().cycle
    assert max(backwards(several, i) for i in range(len(several.pieces))) < 1e-8


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
