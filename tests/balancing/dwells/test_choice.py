"""Choosing a type, and the dwells from which on a type will do."""

from math import degrees
from typing import Any

import pytest

from optlaws import InfeasibleProblem, InputError, catalogue, compare_dwell_mechanisms, deg, dwell_mechanism
from tests.internals.balancing import least_dwell
from tests.tables import rows

K = catalogue["K"].law
GIVEN: dict[str, Any] = {"swing": deg(20), "radius_ratio": 0.35 / deg(20), "inertia_ratio": 0.1}


def compared(dwell: float, **changed: float) -> str | None:
    data: dict[str, Any] = {"rise": deg(180 - dwell), "clutch_angle": deg(10), "most_torque": 0.5, **GIVEN, **changed}
    return compare_dwell_mechanisms(law=K, dwell=deg(dwell), **data).chosen


@pytest.mark.parametrize("row", rows("types_thresholds"), ids=lambda row: "-".join(list(row.values())[:4]))
def test_least_dwells(row: dict[str, str]) -> None:
    half_turn = row["scenario"] == "A"
    for kind in ("II", "III"):
        clutch = deg(float(row["phi_sp"]))
        mechanism = dwell_mechanism(kind, law=K, dwell=deg(60), rise=deg(90), clutch_angle=clutch, **GIVEN)
        limit = float(row["b_limit"])
        if not row[f"dwell_from_{kind}"]:
            with pytest.raises(InfeasibleProblem, match="no dwell"):
                least_dwell(mechanism, limit, half_turn=half_turn)
            continue
        # the table gives the first quarter of a degree at which b is within the limit
        angle = degrees(least_dwell(mechanism, limit, half_turn=half_turn))
        assert -1e-6 <= float(row[f"dwell_from_{kind}"]) - angle <= 0.25 + 1e-6


def test_the_choice_goes_from_I_over_III_to_II_as_the_dwell_grows() -> None:
    assert [compared(dwell) for dwell in (30, 45, 48, 90, 106, 108, 150)] == ["I", "I", "III", "III", "III", "II", "II"]


def test_the_choice_depends_on_more_than_the_dwell() -> None:
    assert compared(90, inertia_ratio=0.01) == "II"
    assert compared(90, clutch_angle=deg(40)) == "I"
    assert compared(90, most_size=1.2) is None


def test_reasons_are_given() -> None:
    data: dict[str, Any] = {"rise": deg(120), "clutch_angle": deg(10), **GIVEN}
    comparison = compare_dwell_mechanisms(law=K, dwell=deg(60), most_torque=0.25, most_size=1.35, **data)
    assert comparison.reasons["I"].startswith("no: a = 1.39 exceeds 1.35")
    assert comparison.reasons["III"].startswith("no: b = 0.3 exceeds 0.25")
    assert comparison.chosen is None
    unequal = compare_dwell_mechanisms(law=K, dwell=deg(60), lower_dwell=0.0, most_torque=5.0, **data)
    assert unequal.reasons["I"].startswith("cannot be built: lower_dwell of type I")
    assert (unequal.chosen, unequal.by_rule) == ("II", "II")


def test_a_limit_that_is_reached_is_kept() -> None:
    data: dict[str, Any] = {"rise": deg(120), "clutch_angle": deg(10), "dwell": deg(60), "law": K, **GIVEN}
    reached = dwell_mechanism("III", **data)
    for share, kept in ((1.0 - 1e-12, True), (1.0, True), (1.0 - 1e-6, False)):
        comparison = compare_dwell_mechanisms(most_torque=share * reached.b, most_size=share * reached.a, **data)
        assert comparison.reasons["III"].startswith("yes" if kept else "no")


def test_wrong_data_are_refused() -> None:
    with pytest.raises(InputError, match="most_torque must be positive"):
        compared(60, most_torque=0.0)
    with pytest.raises(InputError, match="most_torque must be positive, got '1'"):
        compared(60, most_torque="1")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"swing must be above 0, got -1\.0"):
        compared(60, swing=-1.0)
