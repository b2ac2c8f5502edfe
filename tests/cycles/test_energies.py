"""Energy and heat over cycles: against quadrature of Lagrange's equations, closed forms and other laws."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import Cycle, Drive, Dwell, InputError, Mechanism, Motor, Return, Rise, slider_crank
from tests.internals.cycles import CycleReport
from tests.internals.files import tables

TABLE, LOADED = Mechanism("0.8 kg m^2"), Mechanism("0.8 kg m^2", load="3*sin(x)", coulomb=0.3)
MOTOR = Motor("3e-4 kg m^2", constant=0.3, friction={"coulomb": 0.02})
EACH: dict[str, Any] = {"period": "0.6 s", "advance": "45 deg"}
C = {"acceleration": "90 rad/s^2"}


def indexed(law: str = "optimal", **others: Any) -> Cycle:
    return Cycle([Rise("45 deg", "0.25 s", law=law), Dwell()], **EACH, **others)


def powers(cycle: Cycle, drive: Drive, times: np.ndarray) -> tuple[Any, Any]:
    """Torque and power at the motor, each energy by Lagrange's equation of the load and the gear by itself."""
    x, v, w = (cycle(times, nu) for nu in range(3))
    load = 0.8 * w + 3.0 * np.sin(x) + 0.3
    to_load, back = drive.efficiencies
    through = np.where(load * v > 0.0, load / to_load, load * back) / drive.ratio
    torque = drive.ratio * 3e-4 * w + 0.02 + through
    return torque, torque * drive.ratio * v


@pytest.mark.sample(3)
@pytest.mark.parametrize(("efficiency", "regeneration"), [(1.0, 0.0), (1.0, 1.0), (0.85, 0.4)])
def test_energies_of_a_given_law_are_quadratures(efficiency: float, regeneration: float) -> None:
    drive = Drive(LOADED, MOTOR, ratio=20, efficiency=efficiency, regeneration=regeneration)
    cycle = indexed("modified sine", drive=drive)
    effort = cycle.effort

    times = np.linspace(0.0, 0.25, 200001)
    torque, power = powers(cycle, drive, times)
    given, taken = (float(np.trapezoid(np.maximum(side * power, 0.0), times)) for side in (1.0, -1.0))
    assert (effort.motoring_energy, effort.braking_energy) == pytest.approx((given, taken), rel=1e-7)
    assert effort.energy == pytest.approx(given - regeneration * taken, rel=1e-7)
    assert indexed("modified sine", drive=drive, minimise="energy", limits=C).objective == pytest.approx(effort.energy)
    heat = float(np.trapezoid((torque / 0.3) ** 2, times)) + (1.0 - regeneration) * taken
    holding = 0.35 * (3.0 * np.sin(np.pi / 4) / 20 / 0.3) ** 2
    found = indexed("modified sine", drive=drive, minimise="heat").objective
    assert found == pytest.approx(heat + holding, rel=1e-7)


def test_least_energy_of_a_plain_inertia_is_that_of_its_greatest_speed() -> None:
    """J v²/2 of the least peak velocity within an acceleration: three phases, which laws of a degree come near."""
    best = indexed(drive=Drive(TABLE, Motor("3e-4 kg m^2"), ratio=20), minimise="energy", limits=C)
    inertia, h, t, most = 0.8 + 400 * 3e-4, np.pi / 4, 0.25, 90.0
    fastest = (most * t - np.sqrt((most * t) ** 2 - 4.0 * most * h)) / 2.0
    least = 0.5 * inertia * fastest**2
    assert best.lower_bound is not None
    assert best.lower_bound == pytest.approx(least, rel=1e-6)
    assert best.lower_bound <= best.objective < 1.12 * least
    assert best.objective >= 0.5 * inertia * best.peak(1) ** 2
    assert best.status.value == "local"


@pytest.mark.long
def test_energies_of_motions_are_summed() -> None:
    """Forth and back of a constant inertia take the same: the sum of both, and of their bounds."""
    drive = {"inertia": "0.8 kg m^2"}
    there = Cycle([Rise("45 deg", "0.25 s"), Dwell()], **EACH, drive=drive, minimise="energy", limits=C)
    moves = [Rise("45 deg", "0.25 s"), Dwell("0.05 s"), Return(duration="0.25 s"), Dwell()]
    both = Cycle(moves, period="0.6 s", drive=drive, minimise="energy", limits=C)
    assert both.objective == pytest.approx(2.0 * there.objective, rel=1e-6)
    assert both.lower_bound == pytest.approx(2.0 * there.lower_bound, rel=1e-6)  # type: ignore[operator] # a number
    assert both.effort.energy == pytest.approx(both.objective, rel=1e-9)
    fed_back = Cycle(moves, period="0.6 s", drive=drive | {"regeneration": 1.0})
    assert fed_back.effort.energy == pytest.approx(0.0, abs=1e-9 * both.objective)


def test_heat_of_no_law_is_below_the_bound() -> None:
    drive = Drive(LOADED, MOTOR, ratio=20)
    best = indexed(drive=drive, minimise="heat")
    assert best.lower_bound is not None
    assert 0.95 * best.objective < best.lower_bound < best.objective
    for law in ("345", "cubic"):
        assert indexed(law, drive=drive, minimise="heat").objective > best.objective
    winding = indexed(drive=Drive(LOADED, MOTOR, ratio=20, regeneration=1.0), minimise="heat")
    torque = indexed(drive=drive, minimise="rms torque")
    assert winding.objective == pytest.approx(0.6 * (torque.objective / 0.3) ** 2, rel=1e-6)


@pytest.mark.parametrize("unit", [1e-12, pytest.param(1e9, marks=pytest.mark.long)])
def test_other_units_are_the_same_law(unit: float) -> None:
    best, other = (
        indexed(
            drive=Drive(Mechanism(0.8 * size), Motor(3e-4 * size, constant=0.3 * size**0.5), ratio=20), minimise="heat"
        )
        for size in (1.0, unit)
    )
    assert other.objective == pytest.approx(unit * best.objective, rel=1e-6)


def test_an_energy_of_a_cycle_is_kept() -> None:
    drive = {"inertia": "0.8 kg m^2"}
    calm = indexed(drive=drive)
    most = 0.93 * calm.effort.energy
    kept = indexed(drive=drive, limits={"energy": f"{most!r} J"})
    assert kept.effort.energy <= most * (1 + 1e-9)
    assert kept.objective > calm.objective


@pytest.mark.parametrize(
    ("entries", "error", "says"),
    [
        ({"drive": TABLE, "minimise": "energy"}, InputError, "give a limit of the acceleration"),
        ({"drive": TABLE, "minimise": "heat"}, InputError, "motor constant"),
        ({"drive": Drive(TABLE, Motor(3e-4)), "minimise": "heat"}, InputError, "motor constant"),
        ({"minimise": "energy", "limits": C}, InputError, "of a drive: give one"),
        ({"drive": TABLE, "limits": {"energy": "3 J", "rms torque": "1 N m"}}, InputError, "give one of them"),
        (
            {"drive": {"inertia": "0.8 kg m^2", "regeneration": 1.5}},
            InputError,
            "drive: regeneration must be at most 1, got 1.5",
        ),
    ],
    ids=["energy", "heat", "constant", "none", "two", "share"],
)
def test_what_has_no_energy_is_refused(entries: dict[str, Any], error: type[Exception], says: str) -> None:
    with pytest.raises(error, match=says):
        indexed(**entries).effort  # noqa: B018 - laws are looked for when they are needed


def test_tables_of_results_have_the_torque_of_a_motor() -> None:
    """A table at the steps of a file: its last columns are those of the drive at these times."""
    cycle = indexed("modified sine", drive=Drive(LOADED, MOTOR, ratio=20))
    heading, *rows = [
        line for line in tables.to_csv(*CycleReport(cycle).motion(13), about="").splitlines() if line and line[0] != "#"
    ]
    assert heading.endswith('"torque, N m","power, W","motor speed, rpm"')
    values = np.array([[float(cell) for cell in row.split(",")] for row in rows])
    times = np.linspace(0.0, 0.6, 13)
    assert values[:, -3] == pytest.approx(np.asarray(cycle.force(times)), rel=1e-6)
    assert values[:, -2] == pytest.approx(np.asarray(cycle.power(times)), rel=1e-6, abs=1e-6)


def test_a_drive_without_motor_has_force_and_power_in_table_and_picture() -> None:
    cycle = Cycle([Rise("35 mm", "0.1 s", law="345"), Dwell()], period="0.3 s", advance="35 mm", drive={"mass": "2 kg"})
    heading, *rows = [
        line for line in tables.to_csv(*CycleReport(cycle).motion(31), about="").splitlines() if line and line[0] != "#"
    ]
    assert heading.endswith('"jerk, m/s³","force, N","power, W"')
    acceleration, _, force, power = np.array([row.split(",")[-4:] for row in rows], dtype=float).T
    assert force == pytest.approx(2.0 * acceleration, rel=1e-6, abs=1e-6)
    assert power == pytest.approx(force * cycle(np.linspace(0.0, 0.3, 31), 1), rel=1e-6, abs=1e-6)
    panels = cycle.plot()[0].figure.axes
    assert [panel.get_ylabel() for panel in panels[4:]] == ["force, N", "power, W"]
    curve = max(panels[4].lines, key=lambda line: len(line.get_xydata()))
    assert float(np.max(np.abs(curve.get_ydata()))) == pytest.approx(cycle.effort.peak_force, rel=1e-3)


@pytest.mark.long
def test_a_crank_takes_a_quarter_of_the_energy_of_the_quintic() -> None:
    """Crank 0.1 m, rod 0.4 m, slider 5 kg: 4.416 by the quintic; at most 1.196 where C is at most 12, elsewhere."""
    press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
    given: dict[str, Any] = {"period": "0.5 s", "advance": "180 deg", "drive": press}
    known = Cycle([Rise("180 deg", "0.3 s", law="345"), Dwell()], **given)
    assert known.effort.motoring_energy / np.pi == pytest.approx(4.416, abs=5e-4)
    limits = {"acceleration": f"{12 * np.pi / 0.09!r} rad/s^2"}
    best = Cycle([Rise("180 deg", "0.3 s"), Dwell()], **given, minimise="energy", limits=limits)
    assert best.lower_bound is not None
    assert best.lower_bound < best.objective < 1.196 * np.pi


@pytest.mark.long
def test_a_limit_of_the_energy_is_shared() -> None:
    """Two moves that together keep less energy than the laws of least acceleration, whose peak is then greater."""
    moves = [Rise("45 deg", "0.25 s"), Dwell("0.05 s"), Return(duration="0.25 s"), Dwell()]
    given: dict[str, Any] = {"period": "0.6 s", "drive": {"inertia": "0.8 kg m^2"}}
    free = Cycle(moves, **given)
    most = 0.93 * free.effort.energy
    kept = Cycle(moves, **given, limits={"energy": f"{most!r} J"})
    assert kept.effort.energy <= most * (1 + 1e-8)
    assert kept.lower_bound is not None
    assert free.objective < kept.objective
    assert free.objective * (1 - 1e-9) <= kept.lower_bound <= kept.objective


@pytest.mark.sample(12)
@pytest.mark.parametrize("regeneration", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(
    ("gravity", "dry", "size"), [(19.6, 5.0, 1.0), (-30.0, 2.0, 1.0), (19.6, 0.0, 1e-9), (0.0, 3.0, 1e6)]
)
def test_an_energy_is_at_least_the_work_of_its_load(
    gravity: float, dry: float, size: float, regeneration: float
) -> None:
    """Of the work of the load no more than a share comes back, whatever the law: standard laws are above it too."""
    drive: Any = {"mass": f"{2.0 * size!r} kg", "gravity": f"{gravity * size!r} N", "dry": f"{dry * size!r} N"}
    drive |= {"regeneration": regeneration}
    limits = {"acceleration": "60 m/s^2"}
    moves: list[Any] = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()]
    best = Cycle(moves, speed="200 rpm", minimise="energy", drive=drive, limits=limits, degree=5)
    works = [size * 0.035 * (way * gravity + dry) for way in (1.0, -1.0)]
    assert best.lower_bound is not None
    assert best.lower_bound >= sum(max(work, regeneration * work) for work in works) * (1.0 - 1e-9) - 1e-12 * size
    assert best.lower_bound <= best.objective + 1e-9 * size
    for law in ("cycloidal", "modified sine", "simple harmonic"):
        usual = [replace(move, law=law) if isinstance(move, Rise | Return) else move for move in moves]
        assert best.lower_bound <= Cycle(usual, speed="200 rpm", drive=drive).effort.energy + 1e-9 * size
