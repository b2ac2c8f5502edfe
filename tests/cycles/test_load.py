"""Elastic loads of whole cycles: steady motion against a follower, least peaks, limits, and errors."""

from typing import Any

import numpy as np
import pytest

from optlaws import Cycle, Dwell, Follower, InputError, Link, Machine, Return, Rise

LOAD: dict[str, Any] = {"period": "40 ms", "damping": 0.05, "mass": "2 kg"}


def strokes(law: str = "optimal") -> list[Any]:
    return [Rise("30 mm", "120 deg", law=law), Dwell("60 deg"), Return("30 mm", "120 deg", law=law), Dwell()]


def cycle(law: str = "optimal", **others: Any) -> Cycle:
    given: dict[str, Any] = {"speed": "300 rpm", "load": LOAD, "degree": 6} | others
    return Cycle(strokes(law), **given)


@pytest.mark.parametrize("law", ["modified sine", "optimal"])
def test_the_steady_motion_is_that_of_the_follower(law: str) -> None:
    driven = cycle(law)
    rise = driven.durations[0]
    follower = Follower(2 * np.pi * rise / 0.04, 0.05)
    laws = driven.pieces[0].law, driven.pieces[2].law
    mass = follower.cycle(*laws, dwell=0.5, fall_duration=1.0, rest=0.5)
    k, motion = np.linspace(0.0, 2.99, 101), driven.load_motion
    size = 0.03 / rise**2
    assert motion["acceleration"](k * rise) == pytest.approx(size * mass(k, 2), abs=1e-9 * size)
    assert motion["deflection"](k * rise) == pytest.approx(0.03 * mass(k) - driven(k * rise), abs=1e-12)
    assert motion.peak("acceleration").value == pytest.approx(size * mass.peak(2).value, rel=1e-9)
    assert motion.rms("acceleration") == pytest.approx(size * mass.rms(2), rel=1e-9)
    assert motion.peak("force").value == pytest.approx(2 * (2 * np.pi / 0.04) ** 2 * motion.peak("deflection").value)


@pytest.fixture(scope="module")
def others() -> dict[str, Any]:
    """The motions of the load under laws that were not made for it."""
    return {law: cycle(law).load_motion for law in ("modified sine", "cycloidal", "345", "optimal")}


@pytest.mark.sample(3)
@pytest.mark.parametrize("minimise", ["load acceleration", "rms load acceleration", "load force"])
def test_least_of_the_load_is_proven_and_less_than_under_any_other_law(minimise: str, others: dict[str, Any]) -> None:
    best = cycle(minimise=minimise, degree=9)
    assert best.status == "optimal"
    assert len(best.solutions) == 1
    assert best.lower_bound == pytest.approx(best.objective, rel=1e-6)
    output = minimise.rpartition(" ")[2]
    for law in ("modified sine", "cycloidal", "345", "optimal"):
        other = others[law]
        assert best.objective < (other.rms(output) if "rms" in minimise else other.peak(output).value)
    assert best([0.0, 0.2 / 3, 0.1, 0.2 / 6 * 5]) == pytest.approx([0.0, 0.03, 0.03, 0.0], abs=1e-11)


@pytest.mark.long
def test_a_stiff_load_moves_as_what_drives_it() -> None:
    best = cycle(load={"period": "0.2 ms", "damping": 0.3}, minimise="load acceleration")
    assert best.status == "optimal"
    assert best.objective == pytest.approx(max(part.peak(2) for part in best.peaks), rel=1e-2)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("period", "says"), [("0.1 ms", "vibrates 10000 times"), ("0.02 ms", "below 63 us")])
def test_a_load_with_too_many_peaks_is_refused(period: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        cycle(load={"period": period, "damping": 1e-4}, minimise="load acceleration", speed="60 rpm").status  # noqa: B018


def test_a_load_that_is_too_stiff_is_refused_before_it_is_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    stiff = cycle(load={"period": "0.1 ms", "damping": 1e-4}, minimise="load acceleration", speed="60 rpm")
    machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]])
    monkeypatch.setattr(type(machine.dynamics), "moved", None)
    with pytest.raises(InputError, match="vibrates 10000 times"):
        stiff.status  # noqa: B018 - it is refused by its numbers alone


def test_limits_of_the_load_are_kept() -> None:
    loose = cycle(minimise="rms acceleration")
    most = 0.9 * loose.load_motion.peak("acceleration").value
    kept = cycle(minimise="rms acceleration", limits={"load acceleration": f"{most!r} m/s^2"}, degree=9)
    assert kept.load_motion.peak("acceleration").value <= most * (1 + 1e-9)
    assert kept.status == "optimal"


@pytest.mark.long
def test_any_machine_in_seconds_is_a_load() -> None:
    axis = Machine.from_masses(
        {"motor": 0.0, "head": 2.0},
        [Link("motor", "head", stiffness=5e4, damping=20.0)],
        drive="motor",
        outputs={"belt": "force motor-head"},
    )
    best = cycle(load=axis, minimise="load belt", start="10 mm")
    assert best.status == "optimal"
    assert best.objective < cycle("modified sine", load=axis, start="10 mm").load_motion.peak("belt").value
    assert best(0.0) == pytest.approx(0.01)


def test_limits_of_the_force_are_kept_between_dwells() -> None:
    drive = {"mass": "2 kg", "gravity": "19.6 N", "dry": "5 N"}
    free = cycle(load=None, drive=drive, minimise="jerk", degree=9)
    most = 0.98 * free.effort.peak_force
    kept = cycle(load=None, drive=drive, minimise="jerk", limits={"force": f"{most!r} N"}, degree=9)
    assert kept.effort.peak_force <= most * (1 + 1e-9)
    assert kept.status == "optimal"
    assert kept.objective > free.objective


@pytest.mark.parametrize(
    ("others", "says"),
    [
        ({"load": None, "minimise": "load acceleration"}, "is of a load: give one, such as load="),
        ({"minimise": "load speed"}, "speed.*acceleration"),
        ({"load": {"period": "2 mm"}}, "load: period must be a time"),
        ({"load": {"priod": "2 ms"}}, "load: unknown entry of a load 'priod'; did you mean 'period'"),
        ({"load": {"period": "2 ms", "inertia": "2 kg m^2"}}, "give its mass, not its inertia"),
        ({"load": 3}, "load: a load must be a table of period, damping"),
        ({"limits": {"load acceleration": "3 m"}}, "limits, load acceleration must be an acceleration"),
        ({"limits": {"force": "3 m"}}, "limits: force must be a force"),
        ({"load": None, "limits": {"force": "3 N"}}, "are of a drive: give one"),
    ],
)
def test_what_is_wrong_is_said(others: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        cycle(**others).status  # noqa: B018 - laws are looked for when they are asked for
