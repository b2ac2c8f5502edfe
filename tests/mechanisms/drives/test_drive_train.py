"""Drives against sums of another kind, and their formulas where constants of laws go."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from optlaws import (
    Body,
    Chebyshev,
    Cycle,
    Drive,
    InfeasibleProblem,
    InputError,
    Loads,
    Mechanism,
    Motor,
    Problem,
    ProblemArray,
    Return,
    Rise,
    belt,
    integral,
    pareto_front,
    peak,
    rack,
    read_law,
    read_motors,
    rms,
    run_study,
    slider_crank,
    smoothstep,
    synthesize,
    synthesize_array,
    toggle,
    with_end_velocity,
)
from optlaws.typing import DriveSheet
from tests.internals.studies import Serial

RPM = np.pi / 30.0
TABLE = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20, efficiency=0.85)
PRESS = slider_crank(
    "0.1 m", "0.4 m", bodies={"slider": "5 kg", "crank": 0.02}, loads=Loads("-60*s", gravity="0 deg")
).with_friction(coulomb="0.5 N m", viscous="0.02 N m s/rad")
MOTOR = Motor(2e-4, friction={"coulomb": 0.05, "viscous": 1e-4})


def test_rotary_table() -> None:
    sheet = TABLE.sheet("modified sine", "0 deg", "45 deg", "0.25 s", period="0.6 s")
    law, turn = read_law("modified sine"), np.pi / 4.0
    assert sheet.peak_torque == pytest.approx(3.686, abs=5e-4)
    assert sheet.rms_torque == pytest.approx(1.490, abs=5e-4)
    assert sheet.peak_speed / RPM == pytest.approx(1056.0, abs=0.5)
    assert sheet.motoring_power == pytest.approx(229.0, abs=0.5)
    # what is braked is what was stored, less what the gear takes
    accelerated = law.peak(2).value * turn / 0.25**2
    assert sheet.peak_torque == pytest.approx((3e-4 * 20.0 + 0.8 / 0.85 / 20.0) * accelerated)
    stored = 0.5 * (law.peak(1).value * turn / 0.25) ** 2
    assert sheet.motoring_energy == pytest.approx(stored * (3e-4 * 400.0 + 0.8 / 0.85))
    assert sheet.braking_energy == pytest.approx(stored * (3e-4 * 400.0 + 0.8 * 0.85))
    assert sheet.braking_heat == pytest.approx(sheet.braking_energy / 0.6)
    assert sheet.inertia_match == pytest.approx(0.8 / 400.0 / 3e-4)
    assert sheet.fits and sheet.margins == ()  # noqa: PT018 - without limits there are none


def by_hand(k: float, ratio: float, stroke: float) -> tuple[float, float]:
    """Torque and power of the motor of a press."""
    law, duration, start = smoothstep(3), 0.3, 0.3 if stroke > 0.0 else 2.8
    x, v, w = start + stroke * law(k), stroke / duration * law(k, 1), stroke / duration**2 * law(k, 2)
    side = np.sign(stroke)
    load = PRESS.inertia(x) * w + PRESS.inertia(x, 1) * v**2 / 2.0 + 0.02 * v + 0.5 * side + PRESS.load(x)
    flows = load * side > 0.0
    torque = ratio * (2e-4 * w + 1e-4 * v) + 0.05 * side + load / ratio * (1.0 / 0.9 if flows else 0.8)
    return torque * side, torque * ratio * v


@pytest.mark.sample(2)
@pytest.mark.parametrize("stroke", [2.5, -2.5])
def test_sheet_and_formulas_of_a_press(stroke: float) -> None:
    drive = Drive(PRESS, MOTOR, ratio=5.0, efficiency=(0.9, 0.8), regeneration=0.6)
    start = 0.3 if stroke > 0.0 else 2.8
    sheet = drive.sheet(smoothstep(3), start, stroke, 0.3)

    def over(function: Callable[[float], float]) -> float:
        return quad(function, 0.0, 1.0, limit=400, epsabs=1e-9, epsrel=1e-9)[0]

    k = np.linspace(1e-9, 1.0 - 1e-9, 2001)
    torques, powers = np.transpose([by_hand(float(at), 5.0, stroke) for at in k])
    assert sheet.peak_torque == pytest.approx(np.abs(torques).max(), rel=1e-5)
    assert sheet.motoring_power == pytest.approx(powers.max(), rel=1e-5)
    assert sheet.braking_power == pytest.approx(-powers.min(), rel=1e-5)
    assert sheet.rms_torque == pytest.approx(over(lambda at: by_hand(at, 5.0, stroke)[0] ** 2) ** 0.5, rel=1e-8)
    driven = 0.3 * over(lambda at: max(by_hand(at, 5.0, stroke)[1], 0.0))
    braked = 0.3 * over(lambda at: max(-by_hand(at, 5.0, stroke)[1], 0.0))
    assert (sheet.motoring_energy, sheet.braking_energy) == pytest.approx((driven, braked), rel=1e-8)
    assert sheet.energy == pytest.approx(driven - 0.6 * braked, rel=1e-8)
    # the formulas are the same
    moved = drive.dimensionless(start, stroke, 0.3)
    assert rms(moved.torque).value(smoothstep(3)) * moved.unit == pytest.approx(sheet.rms_torque, rel=1e-8)
    assert integral(moved.energy).value(smoothstep(3)) * moved.energy_unit == pytest.approx(sheet.energy, rel=1e-8)
    # and so is the torque at a place
    law, at = smoothstep(3), np.array([0.2, 0.5, 0.83])
    x, v, w = start + stroke * law(at), stroke / 0.3 * law(at, 1), stroke / 0.09 * law(at, 2)
    assert np.sign(stroke) * drive.torque(x, v, w) == pytest.approx([by_hand(float(p), 5.0, stroke)[0] for p in at])


@pytest.mark.parametrize("efficiency", [1.0, pytest.param((0.9, 0.8), marks=pytest.mark.long)])
def test_a_gear_without_load_takes_its_torque_against_the_motion(efficiency: Any) -> None:
    """As friction of the motor does, in torques, sheets, bounds and the best ratio; at rest there is none of it."""
    free = Drive(PRESS, MOTOR, ratio=5.0, efficiency=efficiency)
    geared = replace(free, no_load_torque="30 mN m")
    rubbing = replace(free, motor=replace(MOTOR, coulomb=MOTOR.coulomb + 0.03))
    speeds = np.array([-1.0, 1.0, 2.0])
    more = geared.torque(0.4, speeds, 1.0) - free.torque(0.4, speeds, 1.0)
    assert more == pytest.approx(0.03 * np.sign(speeds))
    assert geared.torque(0.4, 0.0, 0.0) == free.torque(0.4, 0.0, 0.0)
    move: tuple[Any, ...] = ("modified sine", 0.3, 2.5, 0.3)
    assert geared.sheet(*move, period=0.5) == rubbing.sheet(*move, period=0.5)
    assert geared.limit("rms torque", *move[1:]).value == rubbing.limit("rms torque", *move[1:]).value
    assert geared.best_ratio(*move).ratio == rubbing.best_ratio(*move).ratio
    assert Drive.from_json(geared.to_json()) == geared
    assert "no_load_torque" not in free.to_dict()


def test_the_load_is_held_between_moves() -> None:
    lift = Drive(rack("20 mm", "12 kg", loads=Loads(gravity="180 deg")), Motor("1e-4 kg m^2"), ratio=4)
    move = lift.sheet(smoothstep(3), 0.0, "1 turn", "0.4 s")
    whole = lift.sheet(smoothstep(3), 0.0, "1 turn", "0.4 s", period="1 s")
    assert move.holding_torque == pytest.approx(12.0 * 9.80665 * 0.02 / 4.0)
    mean = 0.4 * move.rms_torque**2 + 0.6 * move.holding_torque**2
    assert whole.rms_torque == pytest.approx(mean**0.5)
    assert lift.sheet(smoothstep(3), 0.0, "-1 turn", "0.4 s").holding_torque == pytest.approx(-move.holding_torque)


def test_holding_between_moves_may_take_the_greatest_torque() -> None:
    """A gear that loses much helps to brake a load that sinks slowly, and does not help to hold it."""
    limits = {"peak_torque": "0.5 N m", "curve": [("0 rpm", "0.5 N m"), ("3000 rpm", "0.5 N m")]}
    motor = Motor("1e-6 kg m^2", **limits)  # type: ignore[arg-type]
    lift = Drive(rack("20 mm", "12 kg", loads=Loads(gravity="180 deg")), motor, ratio=4, efficiency=(0.5, 0.5))
    alone, held = (lift.sheet(smoothstep(3), 0.0, "-1 turn", "10 s", period=period) for period in ("10 s", "12 s"))
    assert alone.peak_torque < 0.51 * held.peak_torque
    assert held.peak_torque == pytest.approx(-held.holding_torque) == pytest.approx(-alone.holding_torque)
    assert (held.peak_torque_at, held.curve_use_at) == (1.0, 1.0)
    assert held.curve_use == pytest.approx(held.peak_torque / 0.5)
    assert alone.fits
    assert not held.fits


def test_best_ratio_by_closed_form_and_by_search() -> None:
    law = smoothstep(3)
    found = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2")).best_ratio(law, 0.0, "45 deg", "0.25 s")
    assert found.ratio == pytest.approx((0.8 / 3e-4) ** 0.5)
    # squares over squares of the ratio bend upward
    squares, by = found.rms_torques**2, found.ratios**2
    assert (np.diff(np.diff(squares) / np.diff(by)) > 0.0).all()
    drive = Drive(PRESS, MOTOR, efficiency=(0.9, 0.8))

    def size(log: float) -> float:
        return drive.with_ratio(float(np.exp(log))).sheet(law, 0.3, 2.5, 0.3, period=0.5).rms_torque

    least = minimize_scalar(size, bounds=(1.0, 4.0), method="bounded", options={"xatol": 1e-7})
    found = drive.best_ratio(law, 0.3, 2.5, 0.3, period=0.5)
    assert found.rms_torque == pytest.approx(least.fun, rel=1e-9)
    assert found.ratio == pytest.approx(np.exp(least.x), rel=1e-4)


def test_limits_of_the_motor_hold_the_ratio() -> None:
    move: tuple[Any, ...] = ("modified sine", 0.0, "45 deg", "0.25 s")
    slow = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", greatest_speed="1500 rpm"))
    found = slow.best_ratio(*move)
    assert found.unlimited == pytest.approx(51.639778)
    assert slow.with_ratio(found.ratio).sheet(*move).peak_speed / RPM == pytest.approx(1500.0, rel=2e-6)
    curved = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", curve=[("0 rpm", "3.1 N m"), ("4000 rpm", "0 N m")]))
    limited = curved.best_ratio(*move)
    sheet = curved.with_ratio(limited.ratio).sheet(*move)
    assert limited.ratio < 0.99 * limited.unlimited
    assert sheet.curve_use == pytest.approx(1.0, abs=1e-5)
    assert sheet.fits
    weak = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", peak_torque="1 N m", greatest_speed="1500 rpm"))
    with pytest.raises(InfeasibleProblem, match=r"no ratio lets the motor .* least peak torque there is 2\.\d+ N m"):
        weak.best_ratio(*move)


def test_catalogue_of_motors(tmp_path: Path) -> None:
    file = tmp_path / "motors.toml"
    file.write_text(
        '[m1]\ninertia = "3e-4 kg m^2"\npeak_torque = "9 N m"\nviscous = "1e-4 N m s/rad"\n'
        'curve = [["0 rpm", "9 N m"], ["2000 rpm", "9 N m"], ["4000 rpm", "3 N m"]]\n'
        '[m2]\ninertia = 1e-3\nrated_torque = 4.0\ngreatest_speed = "3000 rpm"\n'
    )
    motors = read_motors(file)
    assert list(motors) == ["m1", "m2"]
    assert motors["m1"].peak_at(np.array([0.0, 1000.0, 3000.0, -3000.0, 4001.0]) * RPM) == pytest.approx(
        [9, 9, 6, 6, 0]
    )
    assert motors["m1"].greatest_speed == pytest.approx(4000.0 * RPM)
    for motor in motors.values():
        assert Motor.from_json(motor.to_json()) == motor
    file.write_text('[m1]\nintertia = "3e-4 kg m^2"\ninertia = 1.0\n')
    with pytest.raises(
        InputError, match=r"motors\.toml: m1: unknown entry of a motor 'intertia'; did you mean 'inertia'"
    ):
        read_motors(file)


def test_sheets_are_kept_and_shown() -> None:
    limits = {"peak_torque": "3 N m", "rated_torque": "2 N m", "greatest_speed": "3000 rpm"}
    drive = Drive(TABLE.mechanism, Motor("3e-4 kg m^2", **limits), ratio=20, efficiency=0.85)  # type: ignore[arg-type]
    sheet = drive.sheet("modified sine", 0.0, "45 deg", "0.25 s", period="0.6 s")
    assert DriveSheet.from_json(sheet.to_json()) == sheet
    used = {margin.name: margin.use for margin in sheet.margins}
    assert used == pytest.approx({"peak torque": 3.685803 / 3, "RMS torque": 1.489759 / 2, "speed": 1055.762 / 3000})
    assert not sheet.fits
    assert "too weak" in [row.note for row in sheet.summary()]
    pictured = drive.plot("modified sine", 0.0, "45 deg", "0.25 s")
    assert len(pictured) == 5
    assert max(pictured[-1].get_ydata()) == pytest.approx(sheet.peak_torque, rel=1e-4)
    assert max(pictured[-1].get_xdata()) == pytest.approx(sheet.peak_speed / RPM, rel=1e-4)
    lines = drive.best_ratio("cycloidal", 0.0, "20 deg", "0.3 s").plot()
    assert len(lines) == 4


REFUSED: list[tuple[Callable[[], Any], str]] = [
    (lambda: Drive(Mechanism("2 kg", axis="length"), MOTOR), "take rack\\(\\), belt\\(\\) or screw\\(\\)"),
    (lambda: Drive(PRESS, MOTOR, ratio=0.0), "ratio must be above 0"),
    (lambda: Drive(PRESS, MOTOR, efficiency=1.2), "efficiency must be at most 1, got 1.2"),
    (lambda: Drive(PRESS, MOTOR, efficiency=(0.9, 0.0)), "efficiency: back must be above 0, got 0.0"),
    (lambda: Drive(PRESS, MOTOR, regeneration=-1.0), "regeneration must be at least 0, got -1.0"),
    (lambda: Drive(PRESS, PRESS), "motor: a motor must be a table of name, inertia, "),  # type: ignore[arg-type]
    (
        lambda: TABLE.sheet("cycloidal", 0.0, 1.0, 0.5, period=0.4),
        "period must be at least the duration of the move, 0.5 s",
    ),
    (lambda: Motor("3 kg"), "inertia must be a moment of inertia"),
    (lambda: Motor(1.0, peak_torque="0 N m"), "peak_torque must be above 0"),
    (lambda: Motor(1.0, curve=[("9 rpm", "1 N m"), ("3 rpm", "1 N m")]), "two speeds at least, which rise"),
    (
        lambda: Motor(1.0, curve=[1.0, 2.0]),
        "curve 1 must be a list of an angular velocity and a torque .* such as \\['200 rpm', '0.4 N m'\\]",
    ),
    (lambda: Motor(1.0, friction={"dry": 1.0}), "unknown friction of a motor 'dry'"),
]


@pytest.mark.parametrize(("wrong", "message"), REFUSED, ids=range(len(REFUSED)))
def test_what_cannot_be_is_refused(wrong: Callable[[], Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        wrong()


@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-6])
def test_the_greatest_inertia_is_that_of_the_whole_way(width: float) -> None:
    bump = Mechanism(f"1 + 4*exp(-((x - 0.3)/{width!r})^2)", over=(-1.0, 2.0))
    drive = Drive(bump, Motor("1 kg m^2"), ratio=2.0)
    assert drive.sheet("cycloidal", 0.0, 1.0, 1.0).inertia_match == pytest.approx(5.0 / 4.0, rel=1e-9)
    assert drive.sheet("cycloidal", 0.3, 1.0, 1.0).inertia_match == pytest.approx(5.0 / 4.0, rel=1e-9)
    assert drive.sheet("cycloidal", 0.4, 1.0, 1.0).inertia_match == pytest.approx(bump.inertia(0.4) / 4.0, rel=1e-9)
    cycle = Cycle([Rise("1 rad", "1 s", law="cycloidal"), Return(law="cycloidal")], period="2 s", drive=drive)
    assert cycle.sheet.inertia_match == pytest.approx(5.0 / 4.0, rel=1e-9)


def test_a_law_that_overshoots_meets_the_inertia_beyond_its_stroke() -> None:
    law = with_end_velocity(smoothstep(3), -1.0)
    (low, high) = (extreme.value for extreme in law.extrema(0))
    assert high > 1.01
    drive = Drive(Mechanism("1 + x^2"), Motor("1 kg m^2"))
    assert drive.sheet(law, 0.0, 1.0, 1.0).inertia_match == pytest.approx(1.0 + max(high, -low) ** 2, rel=1e-9)


@pytest.mark.long
def test_formulas_of_a_toggle_with_masses_behind_a_lossy_gear_can_be_read() -> None:
    lengths = {"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "200 mm", "frame": "280 mm"}
    moving = {
        name: Body("2 kg", inertia="0.01 kg m^2", centre=("0.1 m", "10 mm")) for name in ("rod", "upper", "lower")
    }
    knee = toggle(lengths, bodies={"ram": "40 kg", **moving}, loads=Loads(gravity="90 deg"))
    drive = Drive(knee, Motor("3e-4 kg m^2"), ratio=10, efficiency=0.9)
    text = drive.dimensionless("10 deg", "120 deg", "0.5 s").torque
    assert len(text) > 100_000
    assert rms(text).value(smoothstep(3)) > 0.0


# --- fronts, arrays and studies ---


MOVE = ("0 deg", "10 rad", "0.3 s")
LIFT = Drive(
    belt("30 mm", "8 kg", loads=Loads(gravity="180 deg")).with_friction(viscous="0.02 N m s/rad"),
    Motor("3e-4 kg m^2"),
    ratio=2.5,
)
ENTRIES: dict[str, Any] = {"order": 3, "symmetric": False, "monotone": True}
K = np.linspace(0.0, 1.0, 20001)


def torque(law: Any, drive: Drive = LIFT) -> Any:
    v, w = 10.0 / 0.3 * law(K, 1), 10.0 / 0.09 * law(K, 2)
    load = 8.0 * 0.03**2 * w + 0.02 * v + 8.0 * 9.80665 * 0.03
    return 3e-4 * drive.ratio * w + load / drive.ratio


def test_peak_against_rms_torque_is_a_proven_front() -> None:
    moved = LIFT.dimensionless(*MOVE)
    front = pareto_front(Problem(basis=Chebyshev(9), **ENTRIES), (peak(moved.torque), rms(moved.torque)), points=4)
    assert {point.status.value for point in front} == {"optimal"}
    rows: Any = front.rows
    peaks, means = (np.array([row[place] * moved.unit for row in rows]) for place in (4, 5))
    assert (np.diff(peaks) > 0.0).all()
    assert (np.diff(means) < 0.0).all()
    for point, highest, mean in zip(front, peaks, means, strict=True):
        values = torque(point.law)
        assert np.abs(values).max() == pytest.approx(highest, rel=1e-5)
        assert np.sqrt(np.trapezoid(values**2, K)) == pytest.approx(mean, rel=1e-6)


@pytest.mark.long
def test_peak_torque_against_energy() -> None:
    """The energy that is given falls as the peak rises, above what no law that never turns back can beat."""
    moved = LIFT.dimensionless(*MOVE)
    over = (peak(moved.torque), integral(moved.energy))
    front = pareto_front(Problem(basis=Chebyshev(5), **ENTRIES), over, points=3, between=(2.6, 4.0))
    energies = []
    for point, highest in zip(front, np.geomspace(2.6, 4.0, 3), strict=True):
        values = torque(point.law)
        given = np.trapezoid(np.maximum(values * 2.5 * 10.0 / 0.3 * point.law(K, 1), 0.0), 0.3 * K)
        energies.append(float(given))
        assert given == pytest.approx(point.objective * moved.energy_unit, rel=1e-6)
        assert np.abs(values).max() <= highest * moved.unit * (1.0 + 1e-6)
        assert 0.9 * given < point.lower_bound * moved.energy_unit < given
    assert energies == sorted(energies, reverse=True)


def test_gear_ratios_are_an_array() -> None:
    """Laws of many ratios at once are those of each, and the RMS torque has its least between."""
    ratios = (2.0, 4.0, 6.0, 8.0)
    moves = [LIFT.with_ratio(ratio).dimensionless(*MOVE) for ratio in ratios]
    several = synthesize_array(
        ProblemArray(basis=Chebyshev(9), minimise=[rms(moved.torque) for moved in moves], **ENTRIES)
    )
    means = [float(value) * moved.unit for value, moved in zip(several.objective, moves, strict=True)]
    assert [str(status) for status in several.status] == ["optimal"] * 4
    assert np.argmin(means) == 2
    for i in (0, 3):
        alone = synthesize(Problem(basis=Chebyshev(9), minimise=rms(moves[i].torque), **ENTRIES))
        assert means[i] == pytest.approx(alone.objective * moves[i].unit, rel=1e-7)
        assert np.sqrt(np.trapezoid(torque(alone.law, LIFT.with_ratio(ratios[i])) ** 2, K)) == pytest.approx(
            means[i], rel=1e-6
        )


@pytest.mark.long
def test_lengths_of_a_crank_and_ratios_are_a_study(tmp_path: Path) -> None:
    def moved(crank: str) -> Any:
        press = slider_crank(crank, "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
        return press.dimensionless("0 deg", "180 deg", "0.3 s")

    cranks = [moved("80 mm"), moved("100 mm")]
    problem = {**ENTRIES, "degree": 9, "basis": "chebyshev"}
    study = run_study(
        {"problem": problem, "vary": {"minimise": [rms(each.torque).name for each in cranks]}},
        tmp_path / "study",
        executor=Serial(),
    )
    table = study.to_pandas()
    means = table["objective"].to_numpy() * [each.unit for each in cranks]
    assert means[0] < means[1]
    assert (table["lower_bound"] <= table["objective"]).all()
    turning = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"))
    by_place = "rms((3e-4*{i} + 0.8/{i})*c)"  # a text with the ratio as what varies
    study = run_study(
        {"problem": {**problem, "minimise": by_place}, "vary": {"i": [20.0, 50.0]}},
        tmp_path / "ratios",
        executor=Serial(),
    )
    for ratio, value in zip((20.0, 50.0), study.to_pandas()["objective"], strict=True):
        alone = turning.with_ratio(ratio).dimensionless("0 rad", "1 rad", "1 s")
        same = synthesize(Problem(basis=Chebyshev(9), minimise=rms(alone.torque), **ENTRIES))
        assert value == pytest.approx(same.objective * alone.unit, rel=1e-6)
