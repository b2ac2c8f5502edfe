"""Dwell mechanisms of types I, II, III: reference tables, the composed motion, and the choice among them."""

from dataclasses import replace
from math import degrees, pi, radians
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from optlaws import (
    CamForces,
    DwellMachine,
    InfeasibleProblem,
    InputError,
    catalogue,
    compare_dwell_mechanisms,
    deg,
    dwell_machine,
    dwell_mechanism,
    smoothstep,
)
from tests.internals.balancing import DwellMechanism, DwellType, least_dwell
from tests.laws.examples import free_function_law
from tests.sampling import examples
from tests.tables import rows

K = catalogue["K"].law
SIX_DIGITS = 5.1e-6


def mechanism(kind: DwellType, row: dict[str, str]) -> DwellMechanism:
    swing, clutch, dwell, rise = (
        radians(float(row[name])) for name in ("gamma_sum", "phi_sp", "phi_dwell", "phi_rise")
    )
    return dwell_mechanism(
        kind,
        law=K,
        dwell=dwell,
        rise=rise,
        clutch_angle=clutch,
        swing=swing,
        radius_ratio=0.35 / swing,
        inertia_ratio=0.1,
    )


def example(kind: DwellType, **changed: object) -> DwellMechanism:
    data: dict[str, object] = {
        "law": K,
        "dwell": deg(90),
        "rise": deg(90),
        "clutch_angle": deg(15),
        "swing": deg(20),
        "radius_ratio": 0.35 / deg(20),
        "inertia_ratio": 0.1,
    }
    return dwell_mechanism(kind, **{**data, **changed})  # type: ignore[arg-type] # a test may give anything


@pytest.mark.parametrize("row", rows("types_grid"), ids=lambda row: "-".join(list(row.values())[:4]).split(":")[0])
def test_the_grid(row: dict[str, str]) -> None:
    first = mechanism("I", row)
    found = {"a_I": first.a, "S1_over_S_I": first.S1, "r0_over_S": first.radius_ratio}
    assert first.b == first.S_sp == 0.0
    for kind in ("II", "III"):
        if not row[f"a_{kind}"]:
            with pytest.raises(InputError, match="must exceed twice clutch_angle"):
                mechanism(kind, row)
            continue
        dwell_machine = mechanism(kind, row)
        found |= {
            f"a_{kind}": dwell_machine.a,
            f"b_{kind}": dwell_machine.b,
            f"b_{kind}_per_I1I": dwell_machine.b / 0.1,
        }
        found |= {f"S2_over_S_{kind}": dwell_machine.S2, f"phi2_{kind}": degrees(dwell_machine.phi2)}
    for name, value in found.items():
        assert value == pytest.approx(float(row[name]), rel=SIX_DIGITS), name


@pytest.mark.parametrize("row", rows("types_sensitivity")[::3], ids=lambda row: "-".join(list(row.values())[:3]))
def test_other_radii(row: dict[str, str]) -> None:
    swing, dwell = deg(float(row["gamma_sum"])), deg(float(row["phi_dwell"]))
    ratio = float(row["r0min/b"]) / swing
    for kind in ("I", "II", "III"):
        instance = example(kind, dwell=dwell, rise=pi - dwell, clutch_angle=deg(10), swing=swing, radius_ratio=ratio)
        assert instance.a == pytest.approx(float(row[f"a_{kind}"]), abs=5.1e-5)


LAWS: dict[str, dict[str, object]] = {
    "K": {},
    "smooth": {"law": smoothstep(3)},
    "mixed": {"law": catalogue["Co"].law, "law_1": smoothstep(3), "law_2": smoothstep(4)},
    "singular": {"law": catalogue["0317(1,5)"].law, "law_2": catalogue["modified sine"].law},
    "unsymmetric": {"law": free_function_law(3, 4, 6), "law_1": free_function_law(3, 4, 6)},
    "reverse share": {"reverse_share": 0.35},
}


@pytest.mark.sample(6)
@pytest.mark.parametrize("changed", LAWS.values(), ids=LAWS.keys())
@pytest.mark.parametrize("kind", ["I", "II", "III"])
def test_the_composed_motion_is_continuous_and_closes(kind: DwellType, changed: dict[str, object]) -> None:
    instance = example(kind, **changed)
    motion = instance.motion
    assert motion.jumps(1) == ()
    assert motion.a(1.0) == pytest.approx(0.0, abs=1e-12)
    assert motion.b(1.0) == pytest.approx(motion.b(0.0), rel=1e-12)
    low, high = motion.extrema(0)
    assert instance.a == pytest.approx(
        (instance.radius_ratio + high.value - low.value) / (instance.radius_ratio + 1.0), rel=1e-12
    )
    # the same displacement by integrating the acceleration twice
    edges = np.concatenate([np.linspace(s, e, 5)[:-1] for s, e in zip(motion.breaks, motion.breaks[1:], strict=False)])
    nodes, weights = np.polynomial.legendre.leggauss(24)
    place, speed = 0.0, motion.b(0.0)
    for start, end in zip(edges, [*edges[1:], 1.0], strict=True):
        # nodes are drawn towards both ends, where a fractional power may begin
        k = start + (end - start) * smoothstep(3).a(0.5 * (nodes + 1.0))
        factor = 0.5 * (end - start) * weights * smoothstep(3).b(0.5 * (nodes + 1.0))
        place += (end - start) * speed + float(factor @ ((end - k) * motion.c(k)))
        speed += float(factor @ motion.c(k))
        assert place == pytest.approx(motion.a(end), abs=1e-9)


@pytest.mark.parametrize("changed", LAWS.values(), ids=LAWS.keys())
def test_type_II_has_no_net_travel_in_a_dwell(changed: dict[str, object]) -> None:
    instance = example("II", **changed)
    start, end = instance.rise / instance.cycle, (instance.rise + instance.dwell) / instance.cycle
    motion = instance.motion
    assert motion.a(end) == pytest.approx(motion.a(start), abs=1e-12)
    inside = [k for k in motion.breaks if start < k < end]
    travel = quad(motion.b, start, end, points=inside, limit=200)[0]
    assert travel == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("kind", ["II", "III"])
@pytest.mark.parametrize("changed", LAWS.values(), ids=LAWS.keys())
def test_criterion_b_is_the_ratio_of_peak_torques(kind: DwellType, changed: dict[str, object]) -> None:
    instance = example(kind, **changed)
    k = np.linspace(0.0, 1.0, 40001)
    place = k * instance.cycle
    dwells = ((place > instance.rise) & (place < instance.rise + instance.dwell)) | (
        place > instance.rise + instance.dwell + instance.return_angle
    )
    torque = np.abs(instance.motion.d(k[dwells])).max() / instance.cycle**3
    executive = np.abs(instance.law.d(k)).max() / instance.rise**3
    assert instance.b == pytest.approx(instance.inertia_ratio * torque / executive, rel=1e-5)


def test_power_is_balanced_while_the_executive_link_moves() -> None:
    instance = example("III", law=smoothstep(4))
    k = np.linspace(0.0, 1.0, 201)
    executive = instance.law.d(k) / instance.rise**3
    loader = instance.motion.d(k * instance.rise / instance.cycle) / instance.cycle**3
    assert loader == pytest.approx(-(instance.loader.Y**2) * executive, abs=1e-12 * np.abs(executive).max())


def test_unequal_dwells() -> None:
    longer = {"lower_dwell": deg(120), "rise": deg(75)}
    third, second = example("III", **longer), example("II", **longer)
    assert [round(degrees(section.angle)) for section in third.sections if section.name == "standstill"] == [30]
    assert third.remarks == second.remarks == ()
    for one in (third, second):
        assert one.motion.a(1.0) == pytest.approx(0.0, abs=1e-12)
    single = example("II", lower_dwell=0.0, rise=deg(135))
    assert single.motion.jumps(1) == ()
    assert single.motion.b(1.0) == pytest.approx(single.motion.b(0.0))
    shorter = example("III", lower_dwell=deg(60), rise=deg(105), standstill=deg(30))
    assert shorter.motion.a(1.0) == pytest.approx(0.0, abs=1e-12)
    reasons: dict[DwellType, str] = {
        "I": "lower_dwell of type I must equal dwell",
        "III": "at least 90 degrees, got 60",
    }
    for kind, why in reasons.items():
        with pytest.raises(InputError, match=why):
            example(kind, lower_dwell=deg(60), rise=deg(105))
    with pytest.raises(InputError, match="lower_dwell must exceed"):
        example("III", lower_dwell=0.0)


def test_the_return_must_take_over_the_speed_of_the_loader() -> None:
    with pytest.raises(InputError, match=r"return_angle must suit the rise.*must be 90 degrees"):
        example("II", return_angle=deg(80))
    other = smoothstep(3)
    K_speed = example("II").speed
    angle = example("II", law=other, return_law=other).loader.B / K_speed
    instance = example("II", return_law=other, return_angle=angle)
    assert instance.motion.jumps(1) == ()
    assert instance.remarks == (
        f"rise, return and dwells add up to {degrees(instance.cycle):.6g} degrees, not to one turn",
    )


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"dwell": 0.0}, "dwell must be above 0, got 0.0"),
        ({"rise": -1.0}, "rise must be above 0, got -1.0"),
        ({"swing": float("nan")}, "swing must be a finite real number, got nan"),
        ({"dwell": "90"}, "dwell must be an angle such as '45 deg', got '90' without a unit"),
        ({"rise": "90 mm"}, "rise must be an angle such as '45 deg', but '90 mm' is a length"),
        ({"rise": True}, "rise must be a finite real number, got True"),
        ({"reverse_share": "half"}, "reverse_share must be a finite real number, got 'half'"),
        ({"clutch_angle": -0.1}, "clutch_angle must be at least 0"),
        ({"clutch_angle": deg(45)}, "dwell must exceed twice clutch_angle, 90 degrees"),
        ({"reverse_share": 1.0}, "reverse_share"),
        ({"law": {"kind": "none"}}, "law: format of a law must be 1"),
        ({"law_1": smoothstep(1)}, "law_1: it must run from rest to rest"),
        ({"law_2": K.to_json()}, "law_2: it must be a MotionLaw"),
    ],
)
def test_wrong_data_are_refused(changed: dict[str, object], reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        example("II", **changed)
    with pytest.raises(InputError, match="unknown type 'IV'; did you mean 'I'"):
        example("IV")  # type: ignore[arg-type] # on purpose


@examples(30)
@given(dwell=st.floats(0.8, 2.0), clutch=st.floats(0.02, 0.3), radius=st.floats(0.3, 4.0), share=st.floats(0.25, 0.75))
def test_size_and_residual_torque_are_traded(dwell: float, clutch: float, radius: float, share: float) -> None:
    data = {"dwell": dwell, "rise": pi - dwell, "clutch_angle": clutch, "radius_ratio": radius}
    first, second, third = (example(kind, **data) for kind in ("I", "II", "III"))
    assert second.a <= third.a <= first.a
    assert 0.0 == first.b < third.b < second.b
    shared = example("II", **data, reverse_share=share)
    assert pytest.approx(shared.S1 + 2.0 * shared.S_sp) == shared.S2
    assert shared.motion.a(1.0) == pytest.approx(0.0, abs=1e-12)
    assert replace(third, inertia_ratio=0.2).b == pytest.approx(2.0 * third.b)


def test_what_is_not_given_is_as_what_stands_for_it() -> None:
    law = catalogue["K"].law
    data = {"kind": "III", "law": law, "dwell": 1.5, "rise": 1.4, "swing": 0.35, "radius_ratio": 1.0}
    made = DwellMechanism(inertia_ratio=0.1, **data)  # type: ignore[arg-type] # a dict of all kinds
    assert (made.law_1, made.law_2, made.return_law) == (law, law, law)
    assert (made.return_angle, made.lower_dwell) == (1.4, 1.5)
    other = replace(made, kind="II", lower_dwell=0.0)
    assert (other.lower_dwell, other.return_angle) == (0.0, 1.4)


# --- the choice of a type ---


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


def test_wrong_limits_are_refused() -> None:
    with pytest.raises(InputError, match="most_torque must be positive"):
        compared(60, most_torque=0.0)
    with pytest.raises(InputError, match="most_torque must be positive, got '1'"):
        compared(60, most_torque="1")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"swing must be above 0, got -1\.0"):
        compared(60, swing=-1.0)


# --- torques of a machine ---


DATA: dict[str, Any] = {
    "law": catalogue["3-4-5"].law,
    "dwell": "90 deg",
    "rise": "90 deg",
    "swing": "20 deg",
    "arm": "100 mm",
    "prime_radius": "45 mm",
    "inertia": "0.05 kg m^2",
    "loader_inertia": "0.005 kg m^2",
}


def machine(kind: DwellType, **arguments: Any) -> DwellMachine:
    return dwell_machine(kind, **DATA | {"speed": "100 rpm", "clutch_time": "20 ms"} | arguments)


def test_the_clutch_s_time_is_an_angle_that_grows_with_the_speed() -> None:
    # eq. (16): phi_sp = 6 n t_sp degrees
    for rpm in (60.0, 100.0, 150.0):
        assert machine("III", speed=f"{rpm} rpm").clutch_angle == pytest.approx(radians(6.0 * rpm * 0.02))


@pytest.mark.parametrize("kind", ["I", "II", "III"])
def test_torques_by_the_paper_s_formulas(kind: DwellType) -> None:
    model = machine(kind)
    law, time, gS = DATA["law"], 0.15, radians(20.0)
    D, C = law.power_peak().value, law.peak(2).value
    assert model.balanced_torque == pytest.approx(D * 0.05 * gS**2 / (0.5 * pi * time**2))
    # (22): the same through what the rocker itself takes
    assert model.balanced_torque == pytest.approx(D * gS * model.driven_torque / (C * 0.5 * pi))
    assert model.reduction == pytest.approx(model.mechanism.b, rel=1e-9)
    if kind == "II":
        g2, ph2 = model.mechanism.S2 * gS, model.mechanism.phi2
        assert model.residual_torque == pytest.approx(D * 0.005 * g2**2 / (ph2 * (ph2 / model.rate) ** 2))
        assert model.loader_driven_torque == pytest.approx(C * g2 * 0.005 / (ph2 / model.rate) ** 2)
        # by eq. (21)
        assert model.residual_torque == pytest.approx(D * g2 * model.loader_driven_torque / (C * ph2))


@pytest.mark.parametrize("kind", ["I", "III"])
def test_both_cams_on_one_shaft_take_no_torque_but_in_the_dwells(kind: DwellType) -> None:
    model = machine(kind)
    cams = model.cams("8 mm", "115 mm")
    moved = {
        # the loader's inertia while it is coupled: eq. (2) with the same swing
        "executive": 0.05,
        "loader": 0.05 / model.mechanism.loader.Y**2,
    }
    angles = np.linspace(0.01, 1.55, 60)
    speed = f"{model.rate!r} rad/s"
    torques = [
        CamForces(cam, speed=speed, drive={"inertia": f"{moved[name]!r} kg m^2"}).shaft_torque(angles)
        for name, cam in cams.items()
    ]
    assert np.abs(torques[0]).max() == pytest.approx(model.balanced_torque, rel=1e-2)
    # S is the swing of the executive rocker; the loader's way in the rise is that of its law
    assert np.abs(torques[0] + torques[1]).max() < 1e-9 * model.balanced_torque


def test_what_makes_no_turn_or_leaves_no_room_says_so() -> None:
    with pytest.raises(InputError, match="no cam comes back"):
        machine("III", dwell="100 deg").cams("8 mm", "115 mm")
    with pytest.raises(InputError, match="dwell must exceed twice clutch_angle"):
        machine("III", speed="400 rpm")
    with pytest.raises(InputError, match="clutch_time must be at least 0"):
        machine("II", clutch_time="-1 ms")
    with pytest.raises(InputError, match="loader_inertia must be a moment of inertia"):
        machine("II", loader_inertia="1 kg")
