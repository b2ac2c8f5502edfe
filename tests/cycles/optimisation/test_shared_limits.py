"""Motors in cycles: ratings that all motions share, and limits that are kept at every place."""

import math
import re
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Chebyshev,
    Cycle,
    Drive,
    Dwell,
    Free,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    Problem,
    Return,
    Rise,
    at_most,
    synthesize,
)
from tests.internals.cycles import optimal
from tests.sampling import sampled

INERTIA: dict[str, Any] = {"inertia": "0.02 kg m^2"}
MOTOR: dict[str, Any] = INERTIA | {"viscous": "0.01 N m s/rad", "dry": "0.3 N m"}
MOVES = (Rise("90 deg", "0.2 s"), Dwell("0.3 s"), Return(duration="0.3 s"), Dwell())
WAYS = (Free("90 deg", "0.2 s"), Free("30 deg", "0.2 s"), Free("-120 deg"))


def cycle(segments: Any = MOVES, **others: Any) -> Cycle:
    given: dict[str, Any] = {"period": "1 s", "drive": MOTOR, "degree": 5} | others
    return Cycle(list(segments), **given)


@pytest.mark.parametrize(("minimise", "constant", "nu"), sampled([("jerk", "J", 3), ("rms jerk", "rms_j", 3)]))
def test_equal_moves_share_the_limit_equally(minimise: str, constant: str, nu: int) -> None:
    """A single law under its own bound is the oracle."""
    stroke, duration, most = np.deg2rad(60.0), 0.2, 1.192
    single = synthesize(Problem(order=3, basis=Chebyshev(5), minimise=constant, symmetric=False, bounds={
        "rms_c": at_most(most / np.sqrt(2 * duration) / (0.02 * stroke / duration**2))
    }))  # fmt: skip
    both = [Rise("60 deg", "0.2 s"), Dwell("0.3 s"), Return(duration="0.2 s"), Dwell()]
    shared = cycle(both, minimise=minimise, drive=INERTIA, limits={"rms torque": f"{most} N m"})
    size = stroke / duration**nu * (np.sqrt(2 * duration) if minimise.startswith("rms") else 1.0)
    assert shared.status == "optimal"
    assert shared.objective == pytest.approx(size * single.objective, rel=1e-7)
    assert shared.effort.rms_force == pytest.approx(most, rel=1e-9)


def test_a_power_is_the_least_within_a_shared_limit() -> None:
    """Not convex: a single law under its own bound is the oracle."""
    stroke, duration, most = np.deg2rad(60.0), 0.2, 1.18
    single = synthesize(Problem(order=3, basis=Chebyshev(5), minimise="D", symmetric=False, bounds={
        "rms_c": at_most(most / np.sqrt(2 * duration) / (0.02 * stroke / duration**2))
    }))  # fmt: skip
    both = [Rise("60 deg", "0.2 s"), Dwell("0.3 s"), Return(duration="0.2 s"), Dwell()]
    shared = cycle(both, minimise="power", drive=INERTIA, limits={"rms torque": f"{most} N m"})
    assert shared.objective == pytest.approx(0.02 * stroke**2 / duration**3 * single.objective, rel=1e-5)


@pytest.mark.long
@pytest.mark.parametrize("minimise", sampled(["torque", "velocity", "acceleration", "rms jerk"], each=4))
def test_unequal_moves_are_proven_together(minimise: str) -> None:
    free = cycle(minimise=minimise)
    most = 0.5 * (free.effort.rms_force + cycle(minimise="rms torque").objective)
    kept = cycle(minimise=minimise, limits={"rms torque": f"{most!r} N m"})
    assert kept.status == "optimal"
    assert kept.effort.rms_force == pytest.approx(most, rel=1e-9)
    assert free.objective < kept.objective
    assert kept.lower_bound == pytest.approx(kept.objective, rel=1e-7)
    assert kept.lower_bound <= kept.objective  # type: ignore[operator] # a number


def test_a_limit_that_does_not_bind_changes_nothing() -> None:
    assert cycle(limits={"rms torque": "5 N m"}).objective == cycle().objective


def test_dry_friction_adds_its_square_where_motions_turn() -> None:
    """The work of inertia over a cycle is 0, so that without viscous friction the squares add up."""
    drive = INERTIA | {"dry": "0.3 N m"}
    smooth, rough = (cycle(WAYS, minimise="rms torque", drive=one, degree=3) for one in (INERTIA, drive))
    assert rough.status == "optimal"
    assert rough.objective == pytest.approx(np.hypot(smooth.objective, 0.3), rel=1e-9)
    assert rough.lower_bound == pytest.approx(rough.objective, rel=1e-7)


def test_viscous_and_dry_friction_are_bounded_by_the_way_that_must_be_gone() -> None:
    course = cycle(WAYS, minimise="rms torque", degree=3)
    assert course.status == "local"
    assert course.lower_bound is not None
    assert 0.99 * course.objective < course.lower_bound < course.objective
    kept = cycle(WAYS, limits={"rms torque": "0.8 N m"}, degree=3)
    assert kept.effort.rms_force <= 0.8 * (1 + 1e-9)
    assert kept.lower_bound is not None
    assert 0.98 * kept.objective < kept.lower_bound < kept.objective


def test_power_is_bounded_as_d_is() -> None:
    least = cycle([Rise("60 deg", "0.2 s"), Dwell()], minimise="power", drive=INERTIA, advance="60 deg")
    single = synthesize(Problem(order=3, basis=Chebyshev(5), minimise="D", symmetric=False))
    size = 0.02 * np.deg2rad(60.0) ** 2 / 0.2**3
    assert least.status == "local"
    assert least.objective == pytest.approx(size * single.objective, rel=1e-7)
    assert least.lower_bound == pytest.approx(size * single.lower_bound, rel=1e-9)
    assert least.effort.peak_power == pytest.approx(least.objective, rel=1e-9)


def test_limits_of_the_power_are_kept_with_friction() -> None:
    most = 0.8 * cycle().effort.peak_power
    kept = cycle(limits={"power": f"{most!r} W"})
    assert kept.effort.peak_power <= most * (1 + 1e-9)
    assert kept.status == "local"
    assert kept.lower_bound == pytest.approx(cycle().objective, rel=1e-7)


@pytest.mark.sample(2)
@pytest.mark.parametrize("drive", [MOTOR, INERTIA | {"stiffness": "0.3 N m/rad"}], ids=["friction", "spring"])
def test_the_bound_of_the_power_by_energy_is_below_what_any_law_takes(drive: dict[str, Any]) -> None:
    def moves(law: str) -> list[Any]:
        return [Rise("90 deg", "0.2 s", law=law), Dwell("0.3 s"), Return(duration="0.3 s", law=law), Dwell()]

    least = cycle(moves("optimal"), minimise="power", drive=drive)
    assert least.lower_bound is not None
    assert 0.7 * least.objective < least.lower_bound < least.objective
    for law in ("constant acceleration", "modified sine", "345", "cubic"):
        assert cycle(moves(law), drive=drive).effort.peak_power > least.lower_bound


@pytest.mark.parametrize(
    ("others", "error", "says"),
    [
        ({"limits": {"rms torque": "1 N m"}}, InfeasibleProblem, r"at most 1, but no law, .* takes less than 1\.409"),
        ({"segments": WAYS, "limits": {"rms torque": "0.5 N m"}}, InfeasibleProblem, "no law takes less than 0.7752"),
        ({"drive": INERTIA | {"gravity": "2 N m"}, "limits": {"rms torque": "1 N m"}}, InfeasibleProblem,
         "what is given takes 1.41421356"),
        ({"limits": {"rms torque": "1 N"}}, InputError, "limits: rms torque must be a torque"),
        ({"limits": {"power": "1 N m/rad"}}, InputError, "limits: power must be a power such as '500 W'"),
        ({"limits": {"rms torque": "1 N m", "rms force": "1 N"}}, InputError, "are the same: give one"),
        ({"segments": [{"kind": "rise", "by": "9 deg", "limits": {"rms torque": "1 N m"}}]}, InputError,
         "segment 1: limits: rms torque is of the whole cycle"),
        ({"drive": None, "limits": {"rms torque": "1 N m"}}, InputError, "are of a drive: give one"),
        ({"drive": None, "minimise": "power"}, InputError, "are of a drive: give one"),
        ({"segments": WAYS, "minimise": "power"}, InputError, "may turn back, where dry friction jumps"),
        ({"segments": WAYS, "minimise": "rms torque", "drive": MOTOR | {"gravity": "1 N m"}}, InputError,
         "without stiffness, preload and gravity"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said(others: dict[str, Any], error: type[Exception], says: str) -> None:
    with pytest.raises(error, match=says):
        cycle(**others).status  # noqa: B018 - laws are looked for when they are asked for


def test_what_is_too_little_is_told_with_what_it_takes() -> None:
    table = [Rise("90 deg", "0.2 s"), Dwell("0.3 s"), Return(duration="0.3 s"), Dwell()]
    slide = [Rise("30 mm", "0.2 s"), Dwell("0.3 s"), Return(duration="0.3 s"), Dwell()]
    for moves, drive, kind, unit in ((table, INERTIA, "torque", "N m"), (slide, {"mass": "2 kg"}, "force", "N")):
        # the velocity of the least rms acceleration is a parabola: 12 h²/T³ of its square in all
        way = math.pi / 2 if kind == "torque" else 0.03
        least = float(next(iter(drive.values())).split()[0]) * (12.0 * way**2 * (0.2**-3 + 0.3**-3)) ** 0.5
        with pytest.raises(InfeasibleProblem, match=f"the RMS {kind} over the cycle is to be at most") as error:
            assert cycle(moves, drive=drive, limits={f"rms {kind}": f"{0.9 * least!r} {unit}"}).status
        message = re.search(
            r"at most ([\d.e-]+), but no law, of whatever degree, takes less than ([\d.e-]+)", str(error.value)
        )
        assert message is not None
        assert [float(text) for text in message.groups()] == pytest.approx([0.9 * least, least], rel=1e-7)
    given = [Rise("90 deg", "0.2 s", law="cycloidal"), Dwell("0.3 s"), Return(duration="0.3 s"), Dwell()]
    with pytest.raises(InfeasibleProblem, match=r"what is given takes \d"):
        assert cycle(given, drive=INERTIA, limits={"rms torque": "0.5 N m"}).status


# --- limits at every place ---


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
