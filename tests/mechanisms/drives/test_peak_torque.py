"""The least peak torque by the energy of a stroke, against another method and against laws."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import Cycle, Drive, Dwell, Loads, Mechanism, Motor, Rise, slider_crank, toggle
from tests.internals.mechanisms import least_peak_torque

GEARED = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20, efficiency=0.85)
LOADED = Mechanism("0.8 kg m^2", load="3 N m", viscous="0.5 N m s/rad", coulomb="2 N m")
FORCE = Loads({"0 deg": "0 N", "120 deg": "-90 N", "360 deg": "0 N"}, over="input")
PRESS = Drive.of_input(slider_crank("0.1 m", "0.4 m", bodies={"slider": "12 kg"}, loads=FORCE))
PLATEAU = {"0 deg": 0.0, "60 deg": 0.0, "90 deg": -2e3, "120 deg": -2e3, "150 deg": 0.0, "360 deg": 0.0}
#: the load, which gives more than it takes, drives it
KNEE = toggle(
    {"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "200 mm", "frame": "280 mm"},
    bodies={"ram": "40 kg", "crank": "0.05 kg m^2"},
    loads=Loads(PLATEAU, over="input"),
)
#: with a load that drives it too, whose torque is a table of its angle
TURNED = Mechanism("0.5 kg m^2", {"0 deg": "0 N m", "60 deg": "0 N m", "90 deg": "-120 N m", "120 deg": "-120 N m",
    "150 deg": "0 N m", "360 deg": "0 N m"})  # fmt: skip
DRIVEN = Drive(TURNED, Motor("3e-4 kg m^2"), ratio=10, efficiency=0.92)
RUBBING = replace(GEARED, mechanism=LOADED)


@pytest.mark.sample(3)
@pytest.mark.parametrize("drive", [GEARED, RUBBING, PRESS], ids=["geared", "rubbing", "press"])
@pytest.mark.parametrize("stroke", [0.8, -0.8])
def test_it_is_the_limit_of_the_phase_plane(drive: Drive, stroke: float) -> None:
    """A potential whose certificate is proven has as much, found by a linear program over position and velocity."""
    start = 1.0
    known = drive.limit("peak torque", start, stroke, 0.25).value
    assert least_peak_torque(drive, start, stroke, 0.25) == pytest.approx(known, rel=2e-3)


def test_a_load_that_drives_has_a_bound_by_its_work() -> None:
    drive = Drive.of_input(KNEE)
    x = np.linspace(0.0, 2.0 * np.pi, 20001)
    load = np.asarray(KNEE.torque(x, 0.0, 0.0, 1.0))
    work = np.concatenate([[0.0], np.cumsum(0.5 * (load[1:] + load[:-1]) * np.diff(x))])
    braked = ((work - work[-1])[:-1] / (x[-1] - x[:-1])).max()
    bound = least_peak_torque(drive, 0.0, 2.0 * np.pi, 0.8)
    assert bound == pytest.approx(braked, rel=1e-4)
    assert bound > 18.0


@pytest.mark.long
def test_the_phase_plane_has_no_more_where_the_load_drives() -> None:
    drive = Drive.of_input(KNEE)
    bound = least_peak_torque(drive, 0.0, 2.0 * np.pi, 0.8)
    assert 0.999 * bound < drive.limit("peak torque", "0 deg", "360 deg", "0.8 s").value < bound


def test_of_an_inertia_that_vanishes_the_energy_says_nothing() -> None:
    """A crank without inertia of its own has none at its dead centres; the search for a torque never ended there."""
    bare = slider_crank("0.1 m", "0.4 m", bodies={"slider": "12 kg"}, loads=FORCE)
    assert least_peak_torque(Drive.of_input(bare), 0.0, 2.0 * np.pi, 0.5) == 0.0


@pytest.mark.long
def test_a_flywheel_that_bears_a_force_has_a_proven_bound() -> None:
    """The knee's torque is five times as great as that of the motor; no certificate was found before."""
    force = {"0 deg": 0.0, "150 deg": 0.0, "175 deg": 1.5e3, "200 deg": 1.5e3, "215 deg": 0.0, "360 deg": 0.0}
    lengths = {"crank": "48 mm", "rod": "230 mm", "upper": "180 mm", "lower": "190 mm", "frame": "270 mm"}
    bodies = {"crank": "0.15 kg m^2", "ram": "25 kg"}
    press = toggle(lengths, bodies=bodies, loads=Loads(force, over="input"))
    known = least_peak_torque(Drive.of_input(press), 0.0, 2.0 * np.pi, 0.9)
    assert press.load(np.linspace(0.0, 2.0 * np.pi, 1001)).max() > 5.0 * known
    assert 0.997 * known < press.limit("peak torque", "0 deg", "360 deg", "0.9 s").value < known


@pytest.mark.long
@pytest.mark.parametrize(("drive", "degree"), [(KNEE, 3), (DRIVEN, 2)], ids=["knee", "geared"])
def test_a_cycle_of_least_torque_has_this_bound(drive: Drive | Mechanism, degree: int) -> None:
    given: dict[str, Any] = {"period": "1 s", "advance": "360 deg", "drive": drive, "minimise": "torque"}
    cycle = Cycle([Rise("360 deg", "0.8 s", law="modified sine"), Dwell()], **given)
    best = Cycle([Rise("360 deg", "0.8 s"), Dwell()], **given, degree=degree, limits={"jerk": "3000 rad/s^3"})
    assert best.lower_bound is not None
    assert 0.25 * best.objective < best.lower_bound < best.objective < cycle.value("torque")
