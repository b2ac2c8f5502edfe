"""Process forces over time, master and positions: against the equation of motion integrated and torques by hand."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from optlaws import Cycle, Drive, Dwell, InputError, Loads, Mechanism, Motor, Return, Rise, slider_crank

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
