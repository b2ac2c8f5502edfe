"""Limits of moves in SI units: closed forms, standard laws, motors that are too weak, curves, and their files."""

from math import exp, inf, nan, pi, sqrt

import numpy as np
import pytest

from optlaws import (
    Drive,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    MoveLimit,
    slider_crank,
)
from optlaws.typing import DriveObjective
from optlaws.verification import verify, verify_all

TABLE = ("0 deg", "45 deg", "0.25 s")
MOTOR = Motor("3e-4 kg m^2", peak_torque="6 N m", greatest_speed="3000 rpm")
DRIVE = Drive(Mechanism("0.8 kg m^2"), MOTOR, ratio=20, efficiency=0.85)
#: what the motor feels while it drives and while it brakes
DRIVING, BRAKING = (3e-4 + 0.8 / 400 * share for share in (1 / 0.85, 0.85))
ACCELERATION = 20 * (pi / 4) / 0.25**2


@pytest.mark.long
def test_a_table_has_closed_forms_in_si_units() -> None:
    limit = DRIVE.limit("peak torque", *TABLE)
    assert limit.value == pytest.approx(2.0 * (DRIVING + BRAKING) * ACCELERATION, rel=3e-6)
    assert limit.dimension == "N m"
    # at the peak torque, from both sides: v²/2 (1/c + 1/c') is the stroke
    time = DRIVE.limit("time", "0 deg", "45 deg")
    assert time.value == pytest.approx(sqrt(2.0 * (DRIVING + BRAKING) / 6.0 * 20 * pi / 4), rel=3e-6)
    assert str(time).endswith(" s")
    # a velocity that is greatest from half of the time on: least energy is what the motor gives its inertia
    energy = DRIVE.limit("energy", *TABLE)
    assert energy.value < 0.5 * DRIVING * (20 * pi / 4 / 0.25 * 2.0) ** 2
    assert energy.dimension == "J"
    plain = Mechanism("5 kg", "50 N", axis="length").limit("peak torque", "0 m", "0.3 m", "0.2 s")
    assert plain.dimension == "N"
    # with a lift driving takes more by twice of it, and braking less: the mean stays
    driving, braking = plain.value - 50.0, plain.value + 50.0
    assert 5.0 * 0.3 / 0.04 * 2.0 * (1.0 / driving + 1.0 / braking) == pytest.approx(1.0, rel=3e-6)


CRANK = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
LEVER = Mechanism("0.02 + 0.01*sin(x)^2", load="2*sin(x)", coulomb="0.5 N m", viscous="0.01 N m s/rad")


@pytest.mark.parametrize(
    ("mechanism", "minimise"),
    [(LEVER, "peak torque"), *(pytest.param(CRANK, name, marks=pytest.mark.long) for name in ("rms torque", "energy"))],
    ids=str,
)
def test_no_sheet_of_a_standard_law_is_below_the_limit(mechanism: Mechanism, minimise: DriveObjective) -> None:
    drive = Drive(mechanism, Motor("1e-3 kg m^2"), ratio=3.0, efficiency=(0.9, 0.8), regeneration=0.4)
    move = ("20 deg", "140 deg", "0.3 s")
    limit = drive.limit(minimise, *move, limits={"acceleration": "1000 rad/s^2"})
    for law in ("345", "modified sine", "cycloidal"):
        sheet = drive.sheet(law, *move)
        known = {
            "peak torque": sheet.peak_torque,
            "rms torque": sheet.rms_torque,
            "energy": sheet.motoring_energy - 0.4 * sheet.braking_energy,
        }[minimise]
        assert 0.15 * known < limit.value < known


@pytest.mark.long
def test_copper_heat_is_minimised_with_the_energy() -> None:
    energy, torque = (DRIVE.limit(kind, *TABLE).value for kind in ("energy", "rms torque"))
    values = [DRIVE.limit("energy", *TABLE, heat=heat).value for heat in (0.5, 5e6)]
    for heat, value in zip((0.5, 5e6), values, strict=True):
        least = energy + heat * torque**2 * 0.25
        assert least * (1.0 - 1e-6) <= value <= least * 1.5
    assert values[1] == pytest.approx(5e6 * torque**2 * 0.25, rel=1e-4)


def test_a_curve_counts_by_its_hull() -> None:
    curve = [("0 rpm", "4 N m"), ("800 rpm", "4 N m"), ("1400 rpm", "2 N m"), ("2000 rpm", "1 N m")]
    motor = Motor("3e-4 kg m^2", curve=curve)
    w = np.linspace(0.0, 2000.0, 41) * pi / 30
    lines = np.min([most - fall * w for most, fall in motor.peak_lines], axis=0)
    assert np.all(lines >= motor.peak_at(w) - 1e-12)
    corners = np.array([0.0, 800.0, 2000.0]) * pi / 30
    at_corners = np.min([most - fall * corners for most, fall in motor.peak_lines], axis=0)
    assert at_corners == pytest.approx([4.0, 4.0, 1.0])
    # a motor without a gear's losses: the fastest move by an integral over the greatest accelerations
    drive = Drive(Mechanism("0.8 kg m^2"), motor, ratio=20)
    limit = drive.limit("time", "0 deg", "45 deg")
    free = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", peak_torque="4 N m"), ratio=20)
    assert free.limit("time", "0 deg", "45 deg").value < limit.value
    inertia, (most, fall) = 3e-4 + 0.8 / 400, motor.peak_lines[1]
    known = 2.0 * half_time(20 * pi / 8, inertia, 4.0, most, fall)
    assert known * (1.0 - 1e-5) <= limit.value <= known * (1.0 + 1e-9)


def half_time(way: float, inertia: float, flat: float, most: float, fall: float) -> float:
    """The time for a way from rest at a torque that is flat, then falls with the speed: closed forms."""
    corner = (most - flat) / fall
    first, begun = corner * inertia / flat, 0.5 * corner**2 * inertia / flat
    rate, final = fall / inertia, most / fall

    def beyond(time: float) -> float:
        return final * time - (final - corner) * (1.0 - exp(-rate * time)) / rate - (way - begun)

    low, high = 0.0, 1.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if beyond(middle) < 0.0 else (low, middle)
    return float(first + low)


def test_a_motor_that_is_too_weak_is_told_what_is_reachable() -> None:
    weak = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", peak_torque="1.9 N m"), ratio=20, efficiency=0.85)
    least = sqrt(2.0 * (DRIVING + BRAKING) / 1.9 * 20 * pi / 4)
    with pytest.raises(InfeasibleProblem) as error:
        weak.limit("rms torque", *TABLE)
    assert f"at least {least:.4f}"[:-1] in str(error.value)
    assert "a peak of at least 2.33882 N m" in str(error.value)
    proof = error.value.proof
    assert isinstance(proof, MoveLimit)
    assert proof.value == pytest.approx(least, rel=3e-6)
    with pytest.raises(InfeasibleProblem, match=r"the stroke takes 0\.261799 s"):
        weak.limit("rms torque", *TABLE, limits={"velocity": "3 rad/s"})
    lifting = Mechanism("0.8 kg m^2", load="5 N m")
    with pytest.raises(InfeasibleProblem, match=r"the load takes a peak of at least 4\.99\d+ N m") as error:
        lifting.limit("time", "0 deg", "45 deg", limits={"torque": "4 N m"})
    assert isinstance(error.value.proof, MoveLimit)
    assert verify(error.value.proof.to_dict()).proven


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"minimise": "power"}, "peak torque"),
        ({"limits": {"speed": 3.0}}, "velocity"),
        ({"limits": {"torque": -1.0}}, "torque must be above 0"),
        ({"limits": {"velocity": "3 m/s"}}, "velocity"),
        ({"recovered": 1.5, "minimise": "energy"}, "recovered must be at most 1, got 1.5"),
        ({"recovered": nan, "minimise": "energy"}, "recovered"),
        ({"heat": 1.0}, "minimise='energy'"),
        ({"duration": None}, "duration is missing"),
        ({"minimise": "time"}, "leave out the duration"),
    ],
)
def test_wrong_input_is_named_with_its_remedy(options: dict[str, object], says: str) -> None:
    given: dict[str, object] = {"minimise": "rms torque", "duration": "0.25 s", **options}
    minimise, duration = given.pop("minimise"), given.pop("duration")
    with pytest.raises(InputError) as error:
        Mechanism("0.8 kg m^2").limit(minimise, "0 deg", "45 deg", duration, **given)  # type: ignore[arg-type]
    assert says in str(error.value)


def test_files_of_limits_are_verified() -> None:
    limit = DRIVE.limit("rms torque", *TABLE)
    checked = verify(limit.to_dict())
    assert checked.proven
    assert checked.bound == pytest.approx(limit.value, rel=1e-12)
    assert verify(limit.drive_limit.to_dict()).proven
    assert list(verify_all({"a": limit.to_dict(), "b": [limit.drive_limit.to_dict()]})) == ["a", "b[0]"]
    data = limit.to_dict()
    data["drive_limit"]["value"] *= 1.01
    assert not verify(data).proven
    with pytest.raises(InputError, match="above what its certificate proves"):
        MoveLimit.from_dict(data)
    with pytest.raises(InputError, match="unit"):
        verify({**limit.to_dict(), "unit": -1.0})


def test_the_same_move_in_other_units_has_the_same_limit() -> None:
    plain = Mechanism("0.8 kg m^2", load="3*x").limit("rms torque", "0 deg", "45 deg", "0.25 s").value
    for unit in (1e-9, 1e9):
        other = Mechanism(0.8 * unit, load=f"x*{3.0 * unit!r}").limit("rms torque", "0 deg", "45 deg", "0.25 s")
        assert other.value == pytest.approx(plain * unit, rel=2e-6)
        slow = Mechanism("0.8 kg m^2", load=f"x*{3.0 * unit**2!r}").limit("rms torque", 0.0, pi / 4, 0.25 / unit)
        assert slow.value == pytest.approx(plain * unit**2, rel=2e-6)
    assert inf > plain


@pytest.mark.sample(3)
@pytest.mark.parametrize("regeneration", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(
    ("way", "size"),
    [(-1.0, 1e-9), (1.0, 1e9), *(pytest.param(way, 1.0, marks=pytest.mark.long) for way in (1.0, -1.0))],
)
def test_an_energy_is_at_least_the_work_of_the_load(regeneration: float, way: float, size: float) -> None:
    """Of a weight that is lifted or lowered: the work, of which no more than a share comes back; all of it exactly."""
    weight, rubs = 2.3536 * size, 0.2 * size
    lift = Mechanism(f"{0.01 * size!r} kg m^2", f"{weight!r} N m", coulomb=rubs)
    drive = Drive(lift, Motor(1e-3 * size), ratio=2.5, regeneration=regeneration)
    move, limits = ("0 rad", way * 10.0, "0.3 s"), {"acceleration": "2000 rad/s^2"}
    limit, work = drive.limit("energy", *move, limits=limits), 10.0 * (way * weight + rubs)
    least = max(work, regeneration * work)
    assert limit.value >= least - 1e-9 * abs(work)
    assert limit.value <= limit.attained
    assert MoveLimit.from_json(limit.to_json()) == limit
    if regeneration == 1.0:  # whatever the law
        assert limit.value == pytest.approx(work, rel=1e-9)
        assert limit.attained == pytest.approx(work, rel=1e-9)
    for law in ("cycloidal", "simple harmonic"):
        assert limit.value <= drive.sheet(law, *move).energy + 1e-9 * abs(work)
