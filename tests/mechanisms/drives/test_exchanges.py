"""Formulas of mechanisms and motors where constants of laws go: fronts, arrays and studies."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Chebyshev,
    Drive,
    Loads,
    Mechanism,
    Motor,
    Problem,
    ProblemArray,
    belt,
    integral,
    pareto_front,
    peak,
    rms,
    run_study,
    slider_crank,
    synthesize,
    synthesize_array,
)
from tests.internals.studies import Serial

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
    assert means[1] == pytest.approx(3.989601, rel=1e-6)  # another optimiser's
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
