"""Tooth counts: eq. 33 and 35 against the reference table and the composed motion."""

from dataclasses import replace
from math import degrees, tau
from typing import cast

import pytest
from scipy.integrate import quad

from optlaws import Clutch, InputError, catalogue, deg, dwell_mechanism, smoothstep
from optlaws.typing import DwellType
from tests.balancing.dwells.test_mechanism import example, mechanism
from tests.internals.balancing import DwellMechanism
from tests.tables import rows


@pytest.mark.parametrize("kind", sorted({row["type"] for row in rows("types_clutch")}))
def test_the_table(kind: str) -> None:
    # the condition of type II does not know the clutch angle, but no mechanism has a dwell as short as two of them
    mine = [row for row in rows("types_clutch") if row["type"] == kind]
    for row in (row for row in mine if float(row["phi_dwell"]) > 2 * float(row["phi_sp"])):
        check_clutch(row)


def check_clutch(row: dict[str, str]) -> None:
    clutch = Clutch(mechanism(cast("DwellType", row["type"]), row))
    assert clutch.ratio == pytest.approx(float(row["p_over_N"]), rel=1e-7)
    assert 1.0 / clutch.ratio == pytest.approx(float(row["N_for_p1"]), rel=5.1e-6)
    best = clutch.nearest(120)
    assert f"{best.p}/{best.N}" == row["nearest_p/N (N<=120)"] or (best.p == 0 and row["nearest_p/N (N<=120)"] == "0")
    assert degrees(best.error) == pytest.approx(float(row["angle_error_deg"]), abs=5.1e-5)


def turned(one: DwellMechanism) -> float:
    """What the free loader gains on the rocker while the clutch is open, in turns, from the composed motion."""
    start = one.rise + one.clutch_angle
    open_angle = one.dwell - 2.0 * one.clutch_angle
    motion, cycle = one.motion, one.cycle
    inside = [k * cycle for k in motion.breaks if start < k * cycle < start + open_angle]
    rocker = quad(lambda place: motion.b(place / cycle) / cycle, start, start + open_angle, points=inside)[0]
    loader = motion.b(start / cycle) / cycle * open_angle
    return one.swing * (rocker - loader) / tau


@pytest.mark.parametrize(
    "one",
    [
        example("II"),
        example("III"),
        example("II", law=smoothstep(3), reverse_share=0.4),
        example("III", law=smoothstep(3), law_2=catalogue["Co"].law, standstill=deg(10)),
    ],
)
def test_the_ratio_is_what_the_halves_of_the_clutch_turn_against_each_other(one: DwellMechanism) -> None:
    assert Clutch(one).ratio == pytest.approx(turned(one), rel=1e-9)
    # the way of a type II rocker is against that of the loader; of III it is shorter
    assert Clutch(one).ratio > 0.0


@pytest.mark.parametrize("kind", ["II", "III"])
def test_the_changes_that_make_a_clutch_exact_do_so(kind: DwellType) -> None:
    start = example(kind, law=smoothstep(3), clutch_angle=deg(12))
    teeth = Clutch(start).teeth(2, 25)
    assert abs(teeth.error) > 1e-3
    assert teeth.swing is not None
    changed = [replace(start, swing=teeth.swing)]
    if teeth.dwell is not None:
        changed.append(replace(start, dwell=teeth.dwell, lower_dwell=teeth.dwell))
    if teeth.rise is not None:
        changed.append(replace(start, rise=teeth.rise, return_angle=teeth.rise))
    assert len(changed) == 3
    for one in changed:
        assert Clutch(one).ratio == pytest.approx(2 / 25, rel=1e-12)


def test_the_peak_velocity_that_makes_a_clutch_exact() -> None:
    instance = example("III")
    expected = Clutch(instance).teeth(1, 50)
    assert expected.B2 is not None
    slack = instance.swing * instance.speed * instance.phi2 / tau
    assert slack * (1.0 - 1.0 / expected.B2) == pytest.approx(1 / 50, rel=1e-12)
    assert Clutch(instance).teeth(1, 3).B2 is None
    assert Clutch(example("II")).teeth(1, 11).B2 is None


def test_choices_are_sorted_by_error() -> None:
    found = Clutch(example("II")).choices(20, 60)
    assert [abs(one.error) for one in found] == sorted(abs(one.error) for one in found)
    assert all(one.p >= 1 and 20 <= one.N <= 60 for one in found)
    assert found[0].N == Clutch(example("II")).nearest(60).N


def test_wrong_data_are_refused() -> None:
    with pytest.raises(InputError, match="type I has no clutch"):
        Clutch(example("I"))
    with pytest.raises(InputError, match="no lower dwell"):
        Clutch(example("II", lower_dwell=0.0, rise=deg(135)), lower=True)
    clutch = Clutch(example("III"))
    for wrong in (
        lambda: clutch.nearest(0),
        lambda: clutch.choices(0, 5),
        lambda: clutch.teeth(1, 0),
        lambda: clutch.teeth(-1, 9),
    ):
        with pytest.raises(InputError, match="whole number"):
            wrong()
    assert clutch.teeth(0, 5).swing is None


def test_the_lower_dwell_has_a_clutch_of_its_own() -> None:
    mechanism = dwell_mechanism(
        "III",
        law=smoothstep(3),
        dwell=deg(80),
        lower_dwell=deg(100),
        rise=deg(90),
        clutch_angle=deg(10),
        swing=deg(20),
        radius_ratio=1.0,
        inertia_ratio=0.1,
    )
    upper, lower = Clutch(mechanism), Clutch(mechanism, lower=True)
    assert lower.rocker_turn == upper.rocker_turn
    assert lower.ratio - upper.ratio == pytest.approx(mechanism.swing * mechanism.speed * deg(20) / tau)
