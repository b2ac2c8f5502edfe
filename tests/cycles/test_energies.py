"""Energy, heat and process forces over cycles: against quadrature, closed forms and the equation of motion."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from optlaws import Cycle, Drive, Dwell, InputError, Loads, Mechanism, Motor, Return, Rise, slider_crank
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
            drive=Drive(Mechanism(0.8 * size), Motor(3e-4 * size, constant=0.3 * size**0.5), ratio=20),
            minimise="heat",
            degree=5,
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


def motion_table(cycle: Cycle, rows: int) -> tuple[str, np.ndarray]:
    """The heading and the numbers of a table of the motion."""
    text = tables.to_csv(*CycleReport(cycle).motion(rows), about="")
    heading, *rest = [line for line in text.splitlines() if line and line[0] != "#"]
    return heading, np.array([line.split(",") for line in rest], dtype=float)


def test_force_and_power_are_in_table_and_picture_and_the_speed_of_a_motor_too() -> None:
    heading, _ = motion_table(indexed("modified sine", drive=Drive(LOADED, MOTOR, ratio=20)), 13)
    assert heading.endswith('"torque, N m","power, W","motor speed, rpm"')
    cycle = Cycle([Rise("35 mm", "0.1 s", law="345"), Dwell()], period="0.3 s", advance="35 mm", drive={"mass": "2 kg"})
    heading, values = motion_table(cycle, 31)
    assert heading.endswith('"jerk, m/s³","force, N","power, W"')
    acceleration, _, force, power = values[:, -4:].T
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


@pytest.mark.sample(6)
@pytest.mark.parametrize(
    ("gravity", "dry", "size", "regeneration"),
    [
        (19.6, 5.0, 1.0, 0.5),
        (-30.0, 2.0, 1.0, 0.0),
        (-30.0, 2.0, 1.0, 0.5),
        (-30.0, 2.0, 1.0, 1.0),
        (19.6, 0.0, 1e-9, 0.5),
        (0.0, 3.0, 1e6, 0.5),
    ],
)
def test_an_energy_is_at_least_the_work_of_its_load(
    gravity: float, dry: float, size: float, regeneration: float
) -> None:
    """Of the work of the load no more than a share comes back, whatever the law: standard laws are above it too."""
    drive: Any = {"mass": f"{2.0 * size!r} kg", "gravity": f"{gravity * size!r} N", "dry": f"{dry * size!r} N"}
    drive |= {"regeneration": regeneration}
    limits = {"acceleration": "60 m/s^2"}
    moves: list[Any] = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()]
    best = Cycle(moves, speed="200 rpm", minimise="energy", drive=drive, limits=limits, degree=3)
    works = [size * 0.035 * (way * gravity + dry) for way in (1.0, -1.0)]
    assert best.lower_bound is not None
    assert best.lower_bound >= sum(max(work, regeneration * work) for work in works) * (1.0 - 1e-9) - 1e-12 * size
    assert best.lower_bound <= best.objective + 1e-9 * size
    for law in ("cycloidal", "modified sine", "simple harmonic"):
        usual = [replace(move, law=law) if isinstance(move, Rise | Return) else move for move in moves]
        assert best.lower_bound <= Cycle(usual, speed="200 rpm", drive=drive).effort.energy + 1e-9 * size


# --- process forces ---


BODIES = {"crank": "0.02 kg m^2", "slider": "5 kg"}
PRESS = slider_crank("0.1 m", "0.4 m", bodies=BODIES)
PUSHED = {"0 s": "0 N", "0.1 s": "0 N", "0.15 s": "-60 N", "0.25 s": "-60 N", "0.3 s": "0 N", "1 s": "0 N"}
MASTER = {"0 deg": "0 N", "36 deg": "0 N", "54 deg": "-60 N", "90 deg": "-60 N", "108 deg": "0 N", "360 deg": "0 N"}


def strokes(law: str = "345") -> list[Any]:
    return [Rise("180 deg", "0.3 s", law=law), Dwell("0.1 s"), Return(duration="0.3 s", law=law), Dwell()]


def pushed(times: np.ndarray | float) -> np.ndarray:
    return np.asarray(np.interp(times, [0.0, 0.1, 0.15, 0.25, 0.3, 1.0], [0.0, 0.0, -60.0, -60.0, 0.0, 0.0]))


def slope(x: np.ndarray | float) -> np.ndarray:
    """Of the slider's position by the crank's angle, from its closed form."""
    return np.asarray(-0.1 * np.sin(x) - 0.01 * np.sin(x) * np.cos(x) / np.sqrt(0.16 - (0.1 * np.sin(x)) ** 2))


@pytest.mark.parametrize(
    "load",
    [{"force": PUSHED}, pytest.param({"force": MASTER, "over": "master"}, marks=pytest.mark.long)],
    ids=["time", "master"],
)
def test_the_torque_moves_the_crank_as_the_cycle_says(load: dict[str, Any]) -> None:
    """The equation of motion of crank and slider under it and the process, integrated from rest."""
    cycle = Cycle(strokes(), period="1 s", drive=PRESS, load=load | {"on": "slider"})

    def inertia(x: float) -> float:
        return float(0.02 + 5.0 * slope(x) ** 2)

    def moved(t: float, state: np.ndarray) -> list[float]:
        x, v = state
        turning = (inertia(x + 1e-6) - inertia(x - 1e-6)) / 2e-6
        acting = float(cycle.force(t)) + float(pushed(t)) * slope(x)
        return [v, (acting - 0.5 * turning * v * v) / inertia(x)]

    answer = solve_ivp(moved, (0.0, 0.3), [0.0, 0.0], rtol=1e-9, atol=1e-11, max_step=5e-3, dense_output=True)
    times = np.linspace(0.0, 0.3, 13)
    assert answer.sol is not None
    assert answer.sol(times)[0] == pytest.approx(cycle(times), abs=2e-6)
    assert Cycle.from_json(cycle.to_json()).effort == cycle.effort


@pytest.mark.long
def test_least_torque_of_a_process_is_of_its_motor() -> None:
    """The objective of the law found is its torque by hand, of a gear with losses; less than of another law."""
    drive = Drive(PRESS, Motor("3e-4 kg m^2"), ratio=8, efficiency=0.9)
    given: dict[str, Any] = {"period": "1 s", "drive": drive, "load": {"force": PUSHED, "on": "slider"}}
    best = Cycle(strokes("optimal"), minimise="rms torque", **given)
    times = np.linspace(0.0, 1.0, 100001)
    x, v, w = (best(times, nu) for nu in range(3))
    load = np.asarray(PRESS.torque(x, v, w)) - pushed(times) * slope(x)
    through = np.where(v == 0.0, load, np.where(load * v > 0.0, load / 0.9, load * 0.9)) / 8
    torque = 8 * 3e-4 * w + through
    assert best.objective == pytest.approx(np.sqrt(np.trapezoid(torque**2, times)), rel=1e-6)
    assert best.effort.peak_force == pytest.approx(np.abs(torque).max(), rel=1e-5)
    assert best.objective < 0.9 * Cycle(strokes(), minimise="rms torque", **given).effort.rms_force


def test_a_force_over_a_position_is_that_of_the_mechanism() -> None:
    """Over the slider's position, or the crank's, it is the process force that a mechanism may have itself."""
    over = {"0.3 m": "0 N", "0.4 m": "-300 N", "0.5 m": "-300 N"}
    beside = Cycle(strokes(), period="1 s", drive=PRESS, load={"force": over, "over": "driven", "on": "slider"})
    within = slider_crank("0.1 m", "0.4 m", bodies=BODIES, loads=Loads(over))
    assert beside.effort.peak_force == pytest.approx(Cycle(strokes(), period="1 s", drive=within).effort.peak_force)
    torque = {"0 deg": "0 N m", "180 deg": "-9 N m"}
    beside = Cycle(strokes(), period="1 s", drive=PRESS, load={"torque": torque, "over": "input"})
    assert beside.force(0.35) == pytest.approx(9.0)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_other_units_of_a_process(unit: float) -> None:
    def least(size: float) -> float:
        load = {"torque": [("0 s", 0.0), ("0.1 s", -3.0 * size), ("0.6 s", 0.0)]}
        moves = [Rise("45 deg", "0.25 s"), Dwell()]
        drive = Mechanism(0.8 * size)
        return Cycle(moves, period="0.6 s", advance="45 deg", drive=drive, load=load, minimise="rms torque").objective

    assert least(unit) == pytest.approx(unit * least(1.0), rel=1e-7)


@pytest.mark.parametrize(
    ("entries", "says"),
    [
        ({"load": {"force": "3 N"}, "drive": None}, "a process force is of a drive"),
        ({"load": {"force": "3 N"}}, "on='slider'"),
        ({"load": {"force": "3 N", "on": "slidr"}}, "did you mean 'slider'"),
        ({"load": {"force": "3 N", "on": "slider", "ovr": "time"}}, "did you mean 'over'"),
        ({"load": {"force": "3 N", "on": "slider", "over": "tme"}}, "did you mean 'time'"),
        ({"load": {"force": "3 N", "torque": "1 N m"}}, "not both"),
        ({"load": {"force": {"0 s": "0 N", "0.9 s": "3 N"}, "on": "slider"}}, "give a table over the whole cycle"),
        ({"load": {"force": {"0 m": "0 N", "0.9 m": "3 N"}, "on": "slider"}}, "time"),
    ],
    ids=["none", "link", "name", "entry", "over", "two", "end", "dimension"],
)
def test_wrong_processes_are_refused(entries: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        Cycle(strokes(), **{"period": "1 s", "drive": PRESS, **entries})


def test_the_work_of_a_process_is_its_force_times_the_way_and_a_wrong_sign_is_remarked() -> None:
    drive = Drive(PRESS, Motor("3e-4 kg m^2"), ratio=8)

    def rows(load: dict[str, Any], driven: Any = drive) -> dict[str, Any]:
        cycle = Cycle(strokes(), period="1 s", drive=driven, load=load)
        return {row.name: row.value for row in cycle.summary()}

    known = rows({"force": PUSHED, "on": "slider"})
    times = np.linspace(0.0, 1.0, 200_001)
    cycle = Cycle(strokes(), period="1 s", drive=drive)
    x, v = cycle(times), cycle(times, 1)
    power = -pushed(times) * slope(x) * v
    work = float(np.trapezoid(power, times))
    assert known["work against the load in a cycle"] == pytest.approx(work, rel=1e-6)
    other = {place: force.replace("-60", "60") for place, force in PUSHED.items()}
    turned = rows({"force": other, "on": "slider"})
    assert turned["work against the load in a cycle"] == pytest.approx(-work, rel=1e-6)
    wrong = turned if work > 0.0 else known
    assert f"the load drives the machine: it gives {abs(work):.4g} J in a cycle" in wrong["remark"]
    right = known if work > 0.0 else turned
    assert "remark" not in right


def test_a_force_over_the_position_works_on_the_way_back_too_and_is_remarked() -> None:
    over = {"0.3 m": "0 N", "0.4 m": "-300 N", "0.5 m": "-300 N"}
    cycle = Cycle(strokes(), period="1 s", drive=PRESS, load={"force": over, "over": "driven", "on": "slider"})
    rows = {row.name: row.value for row in cycle.summary()}
    # along 0.1 m of 300 N and 0.1 m on which it grows to that
    assert rows["work against the load in a cycle"] == 0.0
    assert "gives back 45 J of the 45 J that it takes" in rows["remark"]
    weight = Cycle(strokes(), period="1 s", drive=Mechanism("0.8 kg m^2", load="5*x + 2"))
    assert {row.name: row.value for row in weight.summary()}["work against the load in a cycle"] == 0.0
    assert "remark" not in {row.name for row in weight.summary()}
