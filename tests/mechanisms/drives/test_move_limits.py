"""Limits of moves in SI units: closed forms, standard laws, motors, random drives, and their files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from functools import cache
from math import exp, inf, nan, pi, sqrt
from typing import Any, NamedTuple

import numpy as np
import pytest

from optlaws import (
    Drive,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    MoveLimit,
    SolverFailure,
    catalogue,
    rack,
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


# --- random drives ---


LAWS = ("345", "cycloidal", "modified sine", "modified trapezoid", "simple harmonic", "parabolic")
KINDS: tuple[DriveObjective, ...] = ("energy", "rms torque", "peak torque", "time")
#: integration of a sheet, and of the motion that a limit has
AGREES = 1e-6


class RandomMove(NamedTuple):
    """A drive with a move of it, in units of torque and time; torques are about 1 in these."""

    seed: int
    torque: float = 1.0
    time: float = 1.0

    @property
    def numbers(self) -> np.random.Generator:
        return np.random.default_rng(self.seed)

    def parts(self) -> tuple[Drive, float, float, float, DriveObjective, float]:
        draw = self.numbers
        kind = KINDS[self.seed % len(KINDS)]
        unit, second = self.torque * 10.0 ** draw.uniform(-9, 9), self.time * 10.0 ** draw.uniform(-3, 3)
        ratio, stroke = 10.0 ** draw.uniform(-3, 3), draw.choice([-1.0, 1.0]) * 10.0 ** draw.uniform(-1, 1)
        start = draw.uniform(-3, 3)
        size = unit * second**2 / abs(stroke) * 10.0 ** draw.uniform(-3, 1)
        bulge = draw.choice([0.0, draw.uniform(0, 3)])
        inertia = f"{size:.17g} + {bulge * size:.17g}*sin(x + {draw.uniform(0, 6):.17g})^2"
        lift, spring = draw.choice([0.0, draw.uniform(-2, 2)]), draw.choice([0.0, draw.uniform(-1, 1)])
        load = f"{unit * lift:.17g} + {unit * spring / abs(stroke):.17g}*(x - {start:.17g})"
        wave = draw.choice([0.0, draw.uniform(-1, 1)])
        coulomb, viscous = (draw.choice([0.0, draw.uniform(0, 0.5)]) for _ in range(2))
        mechanism = Mechanism(
            inertia,
            f"{load} + {unit * wave:.17g}*sin(x)",
            coulomb=coulomb * unit,
            viscous=viscous * unit * second / abs(stroke),
        )
        motor = Motor(draw.choice([0.0, 0.3]) * size / ratio**2)
        shares = draw.choice([1.0, draw.uniform(0.5, 1.0)]), draw.choice([1.0, draw.uniform(0.5, 1.0)])
        drive = Drive(mechanism, motor, ratio, shares, regeneration=float(draw.choice([0.0, 1.0, draw.uniform(0, 1)])))
        return drive, start, stroke, second, kind, 10.0 ** draw.uniform(0.6, 2.0)

    def limits(self) -> dict[str, Any]:
        """An acceleration, and perhaps a velocity over a part of the way."""
        _, start, stroke, second, kind, accelerates = self.parts()
        known: dict[str, Any] = {"acceleration": accelerates * abs(stroke) / second**2}
        if self.seed % 3 == 0 and kind != "peak torque":
            low, high = np.sort(np.random.default_rng(self.seed + 10**6).uniform(0, 1, 2))
            most = 10.0 ** np.random.default_rng(self.seed).uniform(0.2, 0.8) * abs(stroke) / second
            known["velocity"] = [(start + low * stroke, start + high * stroke, most)]
        return known

    def limit(self) -> MoveLimit:
        drive, start, stroke, second, kind, _ = self.parts()
        return drive.limit(kind, start, stroke, None if kind == "time" else second, limits=self.limits())


def keeps(move: RandomMove, law: str, second: float) -> bool:
    """Whether a standard law keeps the limits of a move in a time."""
    _, start, stroke, _, _, _ = move.parts()
    limits, k = move.limits(), np.linspace(0.0, 1.0, 4001)
    of = catalogue[law].law
    if np.max(np.abs(of(k, 2))) * abs(stroke) / second**2 > limits["acceleration"]:
        return False
    for first, last, most in limits.get("velocity", ()):
        low, high = sorted((end - start) / stroke for end in (first, last))
        a = of(k)
        within = (a >= low - 1e-3) & (a <= high + 1e-3)
        if np.any(of(k, 1)[within] * abs(stroke) / second > most):
            return False
    return True


def own_value(move: RandomMove, law: str) -> tuple[float, float]:
    """What a law takes, and the size of the numbers whose difference it is."""
    drive, start, stroke, second, kind, _ = move.parts()
    sheet = drive.sheet(law, start, stroke, second)
    if kind == "energy":
        return sheet.energy, sheet.motoring_energy + sheet.braking_energy
    value = sheet.peak_torque if kind == "peak torque" else sheet.rms_torque
    return value, value


def check(seed: int) -> str:
    """The outcome of a random move: what is claimed of it holds."""
    move = RandomMove(seed)
    _, _, _, second, kind, _ = move.parts()
    try:
        limit = move.limit()
    except InfeasibleProblem as error:
        proven = error.proof is not None and not any(keeps(move, law, second) for law in LAWS)
        return "infeasible" if proven else f"infeasible without a proof, {seed}"
    except SolverFailure:
        return "failure"
    assert limit.attained >= limit.value, (seed, limit.value, limit.attained)
    assert limit.gap >= 0.0, seed
    for law in LAWS if kind != "time" else ():
        if keeps(move, law, second):
            value, size = own_value(move, law)
            assert limit.value <= value + AGREES * size, (seed, law, limit.value, value)
    if kind == "time" and limit.value:
        fast = [law for law in LAWS if keeps(move, law, limit.value * (1.0 - AGREES))]
        assert not fast, (seed, fast)
    if seed % 10 == 0:
        assert verify(limit.to_dict()).proven, seed
        other = RandomMove(seed, torque=2.0**20, time=2.0**-10).limit()
        # the energy is torque times a way without a unit
        factor = 2.0**-10 if kind == "time" else 2.0**20
        assert other.value == pytest.approx(limit.value * factor, rel=1e-6), seed
    return "bound" if limit.value not in {0.0, -np.inf} else "nothing known"


@pytest.mark.parametrize(
    "seed", [3, 4, 586, *(pytest.param(seed, marks=pytest.mark.long) for seed in (*range(3), *range(5, 20), 290, 950))]
)
def test_a_random_drive_takes_no_less_than_its_limit(seed: int) -> None:
    assert check(seed) in {"bound", "infeasible", "nothing known"}


@pytest.mark.long
@pytest.mark.parametrize(("seed", "gap"), [(50, 1e-4), (142, 0.5), (274, 1e-3), (348, 0.6), (350, 1e-2)])
def test_a_bound_and_a_motion_are_known_of_loads_that_help_or_rub(seed: int, gap: float) -> None:
    limit = RandomMove(seed).limit()
    assert 0.0 < limit.value <= limit.attained <= limit.value * (1.0 + gap)


@pytest.mark.long
def test_a_thousand_random_drives_take_no_less_than_their_limits() -> None:
    counts = Counter(check(seed) for seed in range(20, 1020))
    assert counts.keys() <= {"bound", "infeasible", "nothing known", "failure"}
    assert counts["failure"] <= 10
    assert counts["bound"] >= 700


# --- files ---


MOVE = ("0 deg", "45 deg", "0.25 s")


def proof_of(drive: Drive | Mechanism, *move: Any, **options: Any) -> MoveLimit:
    with pytest.raises(InfeasibleProblem) as caught:
        drive.limit(*move, **options)
    assert isinstance(caught.value.proof, MoveLimit)
    return caught.value.proof


MECHANISM = Mechanism("0.8 kg m^2")
PRESS = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
WINDOW: dict[str, Any] = {"velocity": [("10 deg", "20 deg", "4 rad/s")]}
LIFTING = Mechanism("0.8 kg m^2", load="5 N m")
HEATED: dict[str, Any] = {"limits": {"torque": "60 N m"}, "recovered": 0.5, "heat": 0.1}
MADE: dict[str, Callable[[], MoveLimit]] = {
    "time of a drive": lambda: DRIVE.limit("time", *MOVE[:2]),
    "peak torque of a drive": lambda: DRIVE.limit("peak torque", *MOVE),
    "energy of a drive": lambda: DRIVE.limit("energy", *MOVE, limits={"acceleration": "80 rad/s^2"}),
    "rms torque within a window": lambda: MECHANISM.limit("rms torque", *MOVE, limits=WINDOW),
    "rms torque of a press": lambda: PRESS.limit("rms torque", "0 deg", "180 deg", "0.3 s"),
    "energy with heat": lambda: MECHANISM.limit("energy", *MOVE, **HEATED),
    "peak force of a slide": lambda: rack("20 mm", "5 kg").limit("peak torque", "0 rad", "1 rad", "0.5 s"),
    "proof that the time is short": lambda: proof_of(MECHANISM, "rms torque", *MOVE, limits={"torque": "30 N m"}),
    "proof that the load is beyond": lambda: proof_of(LIFTING, "time", *MOVE[:2], limits={"torque": "4 N m"}),
}


@pytest.mark.parametrize(("load", "peak"), [("60*x", 30.0), ("5 N m", 5.0)])
def test_the_peak_that_a_load_takes_in_any_time_is_bounded_and_attained(load: str, peak: float) -> None:
    """A spring takes its mean torque over the stroke, a weight what it weighs, however slowly either is moved."""
    proof = proof_of(Mechanism("1 kg m^2", load=load), "time", "0 rad", "1 rad", limits={"torque": "2 N m"})
    assert 0.99 * peak < proof.value <= peak
    assert proof.attained == pytest.approx(peak, rel=1e-9)


#: of a drive and of a mechanism, with an energy and without, and a proof that there is none
ENTRIES = [name for name in MADE if name.startswith(("peak torque of", "energy", "rms torque w", "proof that the t"))]


@cache
def limit_of(name: str) -> MoveLimit:
    return MADE[name]()


def changed(data: dict[str, Any], path: tuple[Any, ...], value: object) -> dict[str, Any]:
    other = deepcopy(data)
    inside: Any = other
    for key in path[:-1]:
        inside = inside[key]
    inside[path[-1]] = value
    return other


def noticed(data: dict[str, Any]) -> bool:
    try:
        return not verify(data).proven
    except InputError:
        return True


@pytest.mark.sample(9)
@pytest.mark.parametrize("name", MADE)
def test_each_limit_is_verified_and_read_again(name: str) -> None:
    limit = limit_of(name)
    data = limit.to_dict()
    again = verify(data)
    assert again.proven, (name, *map(str, again.claims))
    assert again.bound == pytest.approx(limit.value, rel=1e-12), name
    assert MoveLimit.from_json(limit.to_json()) == limit, name


@pytest.mark.sample(9)
@pytest.mark.parametrize("name", MADE)
def test_each_statement_of_a_file_is_that_of_its_move(name: str) -> None:
    limit = limit_of(name)
    data = limit.to_dict()
    wrong = {"unit": data["unit"] * 1.001, "dimension": "banana", "move": {}}
    for key, value in wrong.items():
        assert noticed(changed(data, (key,), value)), (name, key)
    move = data["move"]
    for key in ("stroke", "duration"):
        if move[key] is not None:
            assert noticed(changed(data, ("move", key), move[key] * 1.001)), (name, key)
    drive = ("drive", "mechanism") if "drive" in move else ("mechanism",)
    moved = move[drive[0]]["mechanism"] if len(drive) == 2 else move[drive[0]]
    assert noticed(changed(data, ("move", *drive, "inertia"), f"1.001*({moved['inertia']})")), name
    for key, other in (("value", 1.001), ("attained", 0.999)):
        if data["drive_limit"][key] is not None:
            assert noticed(changed(data, ("drive_limit", key), data["drive_limit"][key] * other)), (name, key)


def test_a_limit_of_another_drive_is_not_proven() -> None:
    one, other = (limit_of(name).to_dict() for name in ("rms torque of a press", "rms torque within a window"))
    assert not verify({**one, "move": other["move"]}).proven


def test_what_a_limit_does_not_use_is_not_in_its_file() -> None:
    for name, limit in zip(ENTRIES, map(limit_of, ENTRIES), strict=True):
        data = limit.to_dict()
        beside = {"heat", "recovered"} & data["move"].keys()
        of_drive = "drive" in data["move"]
        assert beside == (set() if data["move"]["minimise"] != "energy" else {"heat"} if of_drive else beside), name
        for key in {"heat", "recovered"} - beside:
            with pytest.raises(InputError, match=key):
                verify(changed(data, ("move", key), 0.1))
    with pytest.raises(InputError, match="recovered is a part of the energy that is minimised"):
        MECHANISM.limit("rms torque", *MOVE, recovered=0.5)
    with pytest.raises(InputError, match="recovered of a drive is its regeneration"):
        replace(limit_of("energy of a drive").move, recovered=0.5)


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["time of a drive", "peak torque of a drive", "energy with heat"])
def test_no_number_stands_beside_a_certificate_that_proves_nothing(name: str) -> None:
    data = limit_of(name).to_dict()
    for key in ("level", "price", "near"):
        for value in (1e-3, 7.0):
            wrong = changed(data, ("drive_limit", key), data["drive_limit"][key] + value)
            assert noticed(wrong) or (verify(wrong).bound or 0.0) <= limit_of(name).attained, (name, key)
    pieces = len(data["drive_limit"]["edges"]) - 1
    broken = changed(data, ("drive_limit", "potential"), [[0.0] * 5] * pieces)
    assert noticed(broken), name
    assert noticed(changed(broken, ("drive_limit", "attained"), None)), name


def test_a_file_without_its_move_is_refused_with_a_remedy() -> None:
    for name, limit in zip(ENTRIES, map(limit_of, ENTRIES), strict=True):
        data = {key: value for key, value in limit.to_dict().items() if key != "move"}
        for read in (verify, MoveLimit.from_dict):
            with pytest.raises(
                InputError, match=r"did not store its mechanism and its move.*compute it again"
            ) as caught:
                read(data)
            assert len(str(caught.value)) < 300, name
