"""Mean power, work above the mean and flywheels: against the shaft's equation of motion and closed forms."""

from math import pi, radians

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

from optlaws import (
    CamForces,
    CamMotion,
    Cycle,
    DiscCam,
    Drive,
    Dwell,
    EnergyFluctuation,
    InputError,
    Mechanism,
    Motor,
    Return,
    Rise,
    TranslatingRoller,
    energy_fluctuation,
    slider_crank,
)
from tests.cams.placed import cam_of

PROCESS = {"over": "master", "force": [("0 deg", "0 N"), ("70 deg", "40 N"), ("70 deg", "-150 N"), ("360 deg", "0 N")]}
FRICTION = {"guide": 0.1, "overhang": "60 mm", "length": "80 mm"}


def forces() -> CamForces:
    drive = {"mass": "3 kg", "stiffness": "2 N/mm", "preload": "150 N"}
    return CamForces(cam_of("translating roller"), "90 rpm", drive, FRICTION, process=PROCESS)


@pytest.mark.parametrize("irregularity", [0.02, 0.3])
def test_a_shaft_with_the_flywheel_keeps_within_the_irregularity(irregularity: float) -> None:
    """Turned by a motor of constant torque: I d(w²)/dangle = 2 (mean - torque), over the angle, edge by edge."""
    machine = forces()
    energy = energy_fluctuation(machine)
    inertia = energy.flywheel(irregularity)
    square, start = energy.speed**2, energy.speed**2
    every: list[np.ndarray] = []
    for low, high in zip(machine.edges[:-1] + 1e-12, machine.edges[1:] - 1e-12, strict=True):
        angles = np.linspace(low, high, 2001)
        given = energy.mean_torque - np.asarray(machine.shaft_torque(angles))
        gained = start + 2.0 / inertia * cumulative_simpson(given, x=angles, initial=0.0)
        every.append(np.stack([angles, gained]))
        start = float(gained[-1])
    assert start == pytest.approx(square, rel=1e-8)
    places, squares = np.concatenate(every, axis=1)
    # the mean of the extreme speeds is that of the shaft: what is added to all squares is free
    least, most = squares.min() - square, squares.max() - square
    speed = energy.speed
    offset = ((0.5 * irregularity) ** 2 + 1) * speed**2 - 0.5 * (least + most)
    fastest, slowest = np.sqrt(most + offset), np.sqrt(least + offset)
    assert 0.5 * (fastest + slowest) == pytest.approx(speed, rel=1e-6)
    assert (fastest - slowest) / speed == pytest.approx(irregularity, rel=1e-4)
    assert places[squares.argmax()] == pytest.approx(energy.fastest_at, abs=0.02)
    assert places[squares.argmin()] == pytest.approx(energy.slowest_at, abs=0.02)


def test_the_mean_lies_in_the_enclosed_mean_of_the_torque() -> None:
    machine = forces()
    energy = energy_fluctuation(machine)
    low, high = machine.mean_torque
    assert low - 1e-12 <= energy.mean_torque <= high + 1e-12
    assert energy.mean_power == pytest.approx(energy.mean_torque * 3 * pi)


def test_cycles_cams_and_mechanisms_say_the_same() -> None:
    """Of a slide on a cam, of its cycle with friction, and of mechanisms whose torque has an integral by hand."""
    moves = [Rise("40 mm", "100 deg", law="3-4-5"), Dwell("30 deg"), Return(duration="140 deg", law="3-4-5"), Dwell()]
    drive = {"mass": "3 kg", "stiffness": "2 N/mm", "preload": "150 N", "dry": "7 N", "viscous": "20 N s/m"}
    cycle = Cycle(moves, speed="150 rpm", drive=drive)
    cam = DiscCam(cycle, "70 mm", TranslatingRoller("12 mm", offset="9 mm"))
    of_cam, of_cycle = energy_fluctuation(CamForces(cam)), energy_fluctuation(cycle)
    for name, value in of_cam.to_dict().items():
        assert getattr(of_cycle, name) == pytest.approx(value, rel=1e-9), name
    assert of_cycle.mean_power == pytest.approx(cycle.effort.mean_power, rel=1e-9)
    rubbed = 2 * 7.0 * 0.04 + 20.0 * 0.04**2 * 10 / 7 * (1 / (100 / 900) + 1 / (140 / 900))
    assert 2 * pi * of_cam.mean_torque == pytest.approx(rubbed, rel=1e-9)

    wave = energy_fluctuation(Mechanism("1 kg m^2", load="3 + 2*sin(x)"), speed="60 rpm")
    assert [wave.mean_torque, wave.energy] == pytest.approx([3.0, 4.0], rel=1e-12)
    assert [wave.fastest_at, wave.slowest_at] == pytest.approx([0.0, pi], abs=1e-9)
    kinked = Mechanism("1 kg m^2", load={"0 deg": "0 N m", "130 deg": "6 N m", "360 deg": "0 N m"})
    assert energy_fluctuation(kinked, speed="60 rpm").energy == pytest.approx(1.5 * pi, rel=1e-12)
    # a crank at an even speed: kinetic energy comes back, so its greatest swing is the work above the mean
    crank = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
    places = np.linspace(0.0, 2 * pi, 200001)
    kinetic = 0.5 * np.asarray(crank.inertia(places)) * (4 * pi) ** 2
    assert energy_fluctuation(crank, speed="120 rpm").energy == pytest.approx(np.ptp(kinetic), rel=1e-8)


def test_of_a_cycle_with_a_motor_it_is_the_power_of_the_motor() -> None:
    press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
    drive = Drive(press, Motor("3e-4 kg m^2"), ratio=8, efficiency=0.9)
    cycle = Cycle(
        [Rise("180 deg", "0.3 s", law="345"), Return(duration="0.4 s", law="345"), Dwell()], period="1 s", drive=drive
    )
    energy = energy_fluctuation(cycle)
    times = (np.arange(1_000_000) + 0.5) * 1e-6
    power = np.asarray(cycle.power(times))
    work = np.cumsum(power - power.mean()) * 1e-6
    assert energy.mean_power == pytest.approx(float(power.mean()), rel=1e-6)
    assert energy.energy == pytest.approx(float(np.ptp(work)), rel=1e-5)


@pytest.mark.parametrize("unit", [1e-12, 1e9])
def test_other_units_of_torques(unit: float) -> None:
    def of(size: float) -> EnergyFluctuation:
        return energy_fluctuation(Mechanism(f"{size!r} kg m^2", load=f"{size!r}*(3 + 2*sin(x))"), speed="60 rpm")

    assert of(unit).energy == pytest.approx(unit * of(1.0).energy, rel=1e-12)
    assert of(unit).flywheel(0.1) == pytest.approx(unit * of(1.0).flywheel(0.1), rel=1e-12)


def test_a_shaft_that_nothing_turns_needs_no_flywheel() -> None:
    energy = energy_fluctuation(CamForces(cam_of("translating flat"), "60 rpm", {"mass": "0 kg"}))
    assert (energy.energy, energy.mean_power, energy.flywheel(0.01)) == (0.0, 0.0, 0.0)


def test_wrong_shafts_say_why() -> None:
    fluctuation = energy_fluctuation(forces())
    for irregularity in (0.0, -0.1, 2.0, float("nan")):
        with pytest.raises(InputError, match="irregularity"):
            fluctuation.flywheel(irregularity)
    part = DiscCam(CamMotion.of_law("3-4-5", "40 mm", "120 deg"), "80 mm", TranslatingRoller("12 mm"))
    crank = Mechanism("1 kg m^2", load="sin(x)")
    for machine, speed, says in (
        (CamForces(part, "60 rpm", {"mass": "2 kg"}), None, "a part of the turn"),
        (forces(), "60 rpm", "speed is that of a mechanism"),
        (crank, None, "speed is missing"),
        (crank, "60 N", "speed"),
        (Mechanism("1 kg m^2", over=(0.0, radians(90.0))), "60 rpm", "no whole turn"),
        (Mechanism("1 kg", axis="length"), "60 rpm", "no whole turn"),
        (Cycle([Rise("1 mm", "90 deg"), Return()], speed="60 rpm"), None, "are of a drive"),
        (3.0, None, "must be a CamForces, a Cycle or a Mechanism"),
    ):
        with pytest.raises(InputError, match=says):
            energy_fluctuation(machine, speed=speed)  # type: ignore[arg-type]
