"""Limits bind laws that are given: refused, or reported, by the exact greatest value of the whole segment or cycle."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    ConstantVelocity,
    Cycle,
    Drive,
    Dwell,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    Move,
    Return,
    Rise,
    Status,
    catalogue,
)

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


@pytest.mark.parametrize("kind", ["torque", "rms torque", "power", "energy", "acceleration"])
def test_a_table_beyond_a_limit_is_refused(kind: str) -> None:
    value, unit = values(table())[kind]
    assert table(limits={kind: f"{1.001 * value!r} {unit}"}).status is Status.OPTIMAL
    error = refused(table(limits={kind: f"{0.999 * value!r} {unit}"}))
    assert error.proof[0].value == pytest.approx(value, rel=1e-6)  # type: ignore[index]
    assert kind in str(error)


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


def test_a_cycle_that_is_not_refused_has_its_greatest_speed_beyond_its_own() -> None:
    limits: Mapping[str, str] = {"acceleration": "1 m/s^2", "velocity": "0.01 m/s"}
    cycle = slide(limits=limits)
    refused(cycle)
    assert cycle.fastest().rpm == pytest.approx(20.0 / 7.0, rel=1e-12)
    assert cycle.fastest().cycle.peak(1) == pytest.approx(0.01, rel=1e-12)


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
