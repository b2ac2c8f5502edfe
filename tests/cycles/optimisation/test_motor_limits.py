"""Limits of a motor: kept by the laws at every place, and where they cannot be kept what is reachable is said."""

from typing import Any

import numpy as np
import pytest

from optlaws import Cycle, Drive, Dwell, InfeasibleProblem, InputError, Mechanism, Motor, Rise
from tests.internals.cycles import optimal

TABLE = Mechanism("0.8 kg m^2")
FALLING = [("0 rpm", "2.8 N m"), ("700 rpm", "2.8 N m"), ("1100 rpm", "0.4 N m")]


def indexed(motor: Motor, efficiency: float = 1.0, **others: Any) -> Cycle:
    drive = Drive(TABLE, motor, ratio=20, efficiency=efficiency)
    options: dict[str, Any] = {"minimise": "rms torque", "limits": {"motor": True}, **others}
    return Cycle([Rise("45 deg", "0.25 s"), Dwell()], period="0.6 s", advance="45 deg", drive=drive, **options)


RATED = Motor("3e-4 kg m^2", rated_torque="1.5 N m", peak_torque="2.7 N m", greatest_speed="1010 rpm")
CURVED = Motor("3e-4 kg m^2", rated_torque="1.5 N m", curve=FALLING)


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("motor", "efficiency"),
    [
        (RATED, 1.0),
        (CURVED, 0.85),
        pytest.param(RATED, 0.85, marks=pytest.mark.long),
        pytest.param(CURVED, 1.0, marks=pytest.mark.long),
    ],
)
def test_a_motor_is_kept_at_every_place(motor: Motor, efficiency: float) -> None:
    """By a dense look at the motor's own curve; and a limit binds, so that the free law would break it."""
    best, free = indexed(motor, efficiency), indexed(motor, efficiency, limits={})
    times = np.linspace(0.0, 0.25, 20001)
    x, v, w = (best(times, nu) for nu in range(3))
    torque = np.asarray(Drive(TABLE, motor, ratio=20, efficiency=efficiency).torque(x, v, w))
    assert (np.abs(torque) <= np.asarray(motor.peak_at(20 * v * (1 - 1e-9))) * (1 + 1e-7)).all()
    assert best.effort.rms_force <= 1.5
    assert best.objective > free.objective * (1 + 1e-4)
    sheet = Drive(TABLE, motor, ratio=20, efficiency=efficiency).sheet(
        best.solutions[0].law, 0.0, np.pi / 4, 0.25, period=0.6
    )
    assert max(margin.use for margin in sheet.margins) == pytest.approx(1.0, abs=1e-6)
    if efficiency == 1.0:
        assert best.status.value == "optimal"


def test_a_rating_of_the_mean_speed() -> None:
    """The motor turns 2.5 times in 0.6 s."""
    motor = Motor("3e-4 kg m^2", continuous=[("0 rpm", "1.6 N m"), ("250 rpm", "1.35 N m"), ("500 rpm", "1.1 N m")])
    best = indexed(motor, minimise="acceleration")
    assert best.effort.rms_force == pytest.approx(1.35, rel=1e-9)
    with pytest.raises(InfeasibleProblem, match=r"at most 1\.1, but"):
        indexed(Motor("3e-4 kg m^2", rated_torque="1.1 N m"), minimise="torque").status  # noqa: B018


def test_a_motor_that_is_too_weak_is_refused_before_laws_are_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the degree: 4 times stroke by squared time, and the inertia of load and motor; gears lose some more."""
    monkeypatch.setattr(optimal, "synthesize", None)
    weak = indexed(Motor("3e-4 kg m^2", peak_torque="1.9 N m"), minimise="acceleration")
    least = 4.0 * (np.pi / 4) / 0.25**2 * (0.8 / 20 + 20 * 3e-4)
    assert least == pytest.approx(2.31221, rel=1e-5)
    with pytest.raises(InfeasibleProblem, match=r"a ratio of 20: .* below 2.31221 N m, and 1.9 N m are allowed") as at:
        weak.objective  # noqa: B018
    assert getattr(at.value.proof, "value", None) == pytest.approx(least, rel=1e-6)
    with pytest.raises(InfeasibleProblem, match=r"a ratio of 5: .* 11.1893 N m, .* a ratio such as 42.6"):
        Cycle(
            [Rise("60 deg", "0.25 s"), Dwell()],
            period="0.6 s",
            advance="60 deg",
            minimise="rms torque",
            limits={"motor": True},
            drive=Drive(
                Mechanism("0.8 kg m^2", coulomb="6 N m"),
                Motor("3e-4 kg m^2", rated_torque="20 N m", peak_torque="6 N m", greatest_speed="3000 rpm"),
                ratio=5,
                efficiency=0.92,
            ),
        ).solve()
    with pytest.raises(InfeasibleProblem, match="180 deg/s on average"):
        indexed(Motor("3e-4 kg m^2", greatest_speed="500 rpm")).status  # noqa: B018


@pytest.mark.parametrize(
    ("others", "says"),
    [
        ({"drive": TABLE}, "there is no motor"),
        ({"drive": {"inertia": "1 kg m^2"}}, "there is no motor"),
        ({"limits": {"motor": "yes"}}, "limits: motor must be true or false"),
        ({"limits": {"motor": True, "energy": "3 J"}}, "give one of them"),
        (
            {"drive": Drive(TABLE, Motor(3e-4, curve=[(0.0, 3.0), (50.0, 1.0), (100.0, 0.5)]), ratio=20)},
            "bends upwards",
        ),
    ],
    ids=["mechanism", "constants", "text", "energy", "curve"],
)
def test_what_is_no_limit_of_a_motor_is_refused(others: dict[str, Any], says: str) -> None:
    options: dict[str, Any] = {"drive": Drive(TABLE, Motor(3e-4), ratio=20), "limits": {"motor": True}, **others}
    with pytest.raises(InputError, match=says):
        Cycle([Rise("45 deg", "0.25 s"), Dwell()], period="0.6 s", advance="45 deg", **options)
