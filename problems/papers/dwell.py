"""Computations for the paper on balancing cam mechanisms for links that dwell: its formulas, its rule, its claims."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from math import tau
from pathlib import Path
from typing import Any

import numpy as np

from optlaws import InputError, MotionLaw, catalogue, deg, savin
from optlaws.balancing import Clutch, DwellMechanism, DwellType, Section, compare_dwell_mechanisms, dwell_mechanism

from .computing import Claim, Number, Quantities, computation, entries

_DWELLS = (45, 60, 75, 90, 105, 120, 135, 150)


@cache
def _mechanism(kind: DwellType, dwell: float = 90.0, clutch: float = 15.0, rise: float | None = None) -> DwellMechanism:
    """One of the mechanisms behind the figures: angles in degrees, rise and dwell half a turn unless given."""
    return dwell_mechanism(
        kind,
        law=catalogue["K"].law,
        dwell=deg(dwell),
        rise=deg(180.0 - dwell if rise is None else rise),
        clutch_angle=deg(clutch),
        swing=deg(20.0),
        radius_ratio=0.35 / deg(20.0),
        inertia_ratio=0.1,
    )


def _at_speed(kind: DwellType, rpm: float) -> DwellMechanism:
    """A mechanism whose clutch needs 20 ms, at a speed of its cam shaft."""
    return _mechanism(kind, 90.0, 6.0 * rpm * 0.02, 90.0)


def _drawn(kind: DwellType, draw: np.random.Generator) -> DwellMechanism:
    law, other, third = (savin(family, float(draw.uniform(0.0, 5.0))) for family in ("III", "II", "IV"))
    return dwell_mechanism(
        kind,
        law=law,
        law_1=third if kind == "III" else other,
        law_2=other,
        dwell=deg(float(draw.uniform(60.0, 140.0))),
        rise=deg(float(draw.uniform(50.0, 110.0))),
        clutch_angle=deg(float(draw.uniform(5.0, 15.0))),
        swing=deg(float(draw.uniform(8.0, 25.0))),
        radius_ratio=float(draw.uniform(0.5, 2.5)),
        inertia_ratio=float(draw.uniform(0.05, 0.3)),
    )


@computation("dwell.mechanism")
def mechanism(kind: DwellType, draw: np.random.Generator) -> Quantities:
    """A mechanism drawn at random at a random speed, in physical units: angles, ways, times, torques, teeth."""
    mechanism = _drawn(kind, draw)
    omega, L, I = draw.uniform(5.0, 20.0), draw.uniform(0.1, 0.5), draw.uniform(0.01, 0.1)
    S = mechanism.swing * L
    quantities = {
        "omega": omega,
        "L": L,
        "I": I,
        "I1": mechanism.inertia_ratio * I,
        "r0": mechanism.radius_ratio * S,
        "S": S,
    }
    quantities |= {
        "g_S": mechanism.swing,
        "ph_v": mechanism.rise,
        "ph_S": mechanism.rise,
        "ph_p": mechanism.dwell,
        "ph_sp": mechanism.clutch_angle,
    }
    quantities |= {
        "ph1": mechanism.phi1,
        "ph2": mechanism.phi2,
        "T_v": mechanism.rise / omega,
        "T_p": mechanism.dwell / omega,
    }
    quantities |= {
        "T": tau / omega,
        "T_S": mechanism.rise / omega,
        "T1": mechanism.phi1 / omega,
        "T2": mechanism.phi2 / omega,
    }
    quantities |= {
        "t_sp": _duration(mechanism, "clutch", omega),
        "S1": mechanism.S1 * S,
        "S2": mechanism.S2 * S,
        "S_sp": mechanism.S_sp * S,
    }
    quantities |= {
        "g1": mechanism.S1 * mechanism.swing,
        "g2": mechanism.S2 * mechanism.swing,
        "g_sp": mechanism.S_sp * mechanism.swing,
    }
    quantities |= {
        "w_max": _fastest(mechanism) * mechanism.swing * omega,
        "a": mechanism.a,
        "rmax2": (mechanism.radius_ratio + 1.0) * S,
    }
    quantities |= {"rmax1": mechanism.a * (mechanism.radius_ratio + 1.0) * S, "b": mechanism.b} | _peaks(mechanism)
    return quantities | _torques(mechanism, quantities) | _teeth(mechanism, draw)


def _duration(mechanism: DwellMechanism, name: str, omega: float) -> float:
    return next((section.angle for section in mechanism.sections if section.name == name), 0.0) / omega


def _fastest(mechanism: DwellMechanism) -> float:
    """Greatest speed of the loader's rocker in the rise, S per radian, from its composed motion."""
    low, high = mechanism.motion.extrema(1, (0.0, mechanism.rise / mechanism.cycle))
    return max(abs(low.value), abs(high.value)) / mechanism.cycle


def _peaks(mechanism: DwellMechanism) -> dict[str, float]:
    laws = {"": mechanism.law, "1": mechanism.law_1, "2": mechanism.law_2}
    quantities = {f"{name}{i}": getattr(law.constants, name).value for i, law in laws.items() for name in "BCD"}
    return quantities | {"B": mechanism.loader.B}


def _torques(mechanism: DwellMechanism, given: Quantities) -> dict[str, float]:
    """Greatest torques on the shaft of the cam and of the rocker, from the composed motion itself."""
    sections = [section for section in mechanism.sections if section.name in {"reverse", "run-out", "run-up"}]
    if not sections:
        return {
            "M1": 0.0,
            "M2": _most(mechanism.law, 1.0, given["ph_v"], given["omega"]) * given["I"] * mechanism.swing**2,
        }
    strongest = max(sections, key=lambda section: _power(section, given["omega"]))
    scale, whole = strongest.scale, strongest.angle / (strongest.end - strongest.start)
    turned = given["omega"] / whole
    law = strongest.law
    assert law is not None
    return {
        "M1": _power(strongest, given["omega"]) * given["I1"] * mechanism.swing**2 / given["omega"],
        "M1_driven": given["I1"] * mechanism.swing * abs(scale) * law.peak(2).value * turned**2,
        "M2": _most(mechanism.law, 1.0, given["ph_v"], given["omega"])
        * given["I"]
        * mechanism.swing**2
        / given["omega"],
        "M2_driven": given["I"] * mechanism.swing * mechanism.law.peak(2).value * (given["omega"] / given["ph_v"]) ** 2,
    }


def _power(section: Section, omega: float) -> float:
    assert section.law is not None
    return _most(section.law, abs(section.scale), section.angle / (section.end - section.start), omega)


def _most(law: MotionLaw, scale: float, angle: float, omega: float) -> float:
    """Greatest velocity times acceleration in time, from a dense grid and a parabola at its top."""
    k = np.linspace(0.0, 1.0, 20_001)
    values = np.abs(law.d(k))
    i = int(np.clip(np.argmax(values), 1, len(k) - 2))
    left, top, right = values[i - 1 : i + 2]
    bend = left - 2.0 * top + right
    peak = top - (right - left) ** 2 / (8.0 * bend) if bend else top
    return float(peak * scale**2 * (omega / angle) ** 3)


def _teeth(mechanism: DwellMechanism, draw: np.random.Generator) -> dict[str, float]:
    if mechanism.kind == "I":
        return {}
    clutch, N = Clutch(mechanism), float(draw.integers(20, 100))
    turns = {"g_load": clutch.loader_turn, "g_rock": clutch.rocker_turn}
    return turns | {"N": N, "p": clutch.ratio * N, "g_z": tau / N}


@computation("dwell.study")
def study(name: str, place: float, problems: Path) -> Number:
    """A swing or clutch angle of the study behind the figures, degrees."""
    return Number(float(entries(problems / "dwell_types.toml")[name][int(place)]))


@computation("dwell.drift")
def drift() -> Claim:
    """Way that the rocker of type I is off after a turn whose lower dwell is 60 instead of 90 degrees, in S."""
    mechanism = _mechanism("I")
    refused = _refused(lambda: dwell_mechanism("I", **_data(mechanism), lower_dwell=deg(60.0)))
    return Claim(mechanism.speed * (mechanism.dwell - deg(60.0)) if refused else 0.0, ">=", 0.1)


@computation("dwell.step_of_speed")
def step_of_speed() -> Claim:
    """Step of the loader's speed, as a share, if the return of type I took 60 degrees and the rise 90."""
    mechanism = _mechanism("I")
    refused = _refused(lambda: dwell_mechanism("I", **_data(mechanism), return_angle=deg(60.0)))
    return Claim(mechanism.rise / deg(60.0) - 1.0 if refused else 0.0, ">=", 0.1)


def _data(mechanism: DwellMechanism) -> dict[str, Any]:
    names = ("law", "dwell", "rise", "clutch_angle", "swing", "radius_ratio", "inertia_ratio")
    return {name: getattr(mechanism, name) for name in names}


def _refused(make: Callable[[], object]) -> bool:
    try:
        make()
    except InputError:
        return True
    return False


@computation("dwell.size")
def size(kind: DwellType, dwell: float) -> Claim:
    """Criterion a of a type at a dwell in degrees, beside 1.5: the cam grows by half."""
    return Claim(_mechanism(kind, dwell).a, ">=", 1.5)


@computation("dwell.torque_over_speed")
def torque_over_speed() -> Claim:
    """Torque of the loader's rocker in the dwell at twice the speed over that at the speed, type III."""
    mechanism = _mechanism("III")
    run_out = next(section for section in mechanism.sections if section.name == "run-out")
    return Claim(_power(run_out, 2.0) / 2.0 / _power(run_out, 1.0), ">=", 1.01)


@computation("dwell.size_over_speed")
def size_over_speed(kind: DwellType, clutch: str) -> Claim:
    """How much a changes from 60 to 180 rpm, with the clutch in a fixed angle or a fixed time of 20 ms."""
    mechanisms = {rpm: _at_speed(kind, rpm) if clutch == "time" else _mechanism(kind) for rpm in (60.0, 120.0, 180.0)}
    sizes = [_size_in_time(mechanism, rpm * tau / 60.0) for rpm, mechanism in mechanisms.items()]
    return Claim(max(sizes) / min(sizes) - 1.0, "<=", 1e-9)


def _size_in_time(mechanism: DwellMechanism, omega: float) -> float:
    """Criterion a of types I and III from speeds and times: the rocker's greatest speed for the time it keeps it."""
    fastest = _fastest(mechanism) * omega
    way = (
        fastest * mechanism.dwell / omega
        if mechanism.kind == "I"
        else mechanism.S2 + 2.0 * fastest * _duration(mechanism, "clutch", omega)
    )
    return 1.0 + way / (mechanism.radius_ratio + 1.0)


@computation("dwell.longer_way_back")
def longer_way_back() -> Claim:
    """The least of S2 - S1 over 50 mechanisms of type II drawn at random, in S."""
    draw = np.random.default_rng(3)
    drawn = [_drawn("II", draw) for _ in range(50)]
    return Claim(min(mechanism.S2 - mechanism.S1 for mechanism in drawn), ">=", 0.0)


@computation("dwell.falls")
def falls(kind: DwellType, criterion: str) -> Claim:
    """The greatest rise of a criterion from one dwell to the next, 45 to 150 degrees by 15, as a share."""
    values = _over_dwells(kind, criterion)
    return Claim(max(after / before - 1.0 for before, after in pairwise(values)), "<=", 0.0)


@computation("dwell.grows")
def grows(kind: DwellType, criterion: str) -> Claim:
    """The least rise of a criterion from one dwell to the next, as a share."""
    values = _over_dwells(kind, criterion)
    return Claim(min(after / before - 1.0 for before, after in pairwise(values)), ">=", 0.0)


def _over_dwells(kind: DwellType, criterion: str) -> Sequence[float]:
    return [getattr(_mechanism(kind, float(dwell)), criterion) for dwell in _DWELLS]


@computation("dwell.torque_ratio_grows_with_speed")
def torque_ratio_grows_with_speed(kind: DwellType) -> Claim:
    """The least rise of b from 60 over 120 to 180 rpm with a clutch that needs 20 ms, as a share."""
    values = [_at_speed(kind, rpm).b for rpm in (60.0, 120.0, 180.0)]
    return Claim(min(after / before - 1.0 for before, after in pairwise(values)), ">=", 0.0)


@computation("dwell.self_adjusting")
def self_adjusting(kind: DwellType) -> Claim:
    """How much b changes from a speed to twice the speed, with a clutch in a fixed angle, from the torques."""
    mechanism = _mechanism(kind)
    moving = max((s for s in mechanism.sections if s.name in {"reverse", "run-out"}), key=lambda s: _power(s, 1.0))
    ratios = [_power(moving, omega) / _most(mechanism.law, 1.0, mechanism.rise, omega) for omega in (10.0, 20.0)]
    return Claim(abs(ratios[1] / ratios[0] - 1.0), "<=", 1e-9)


@computation("dwell.teeth_over_clutch")
def teeth_over_clutch() -> Claim:
    """How much p/N of type II changes while the clutch angle goes from 5 to 20 degrees, as it would with the speed."""
    ratios = [Clutch(_mechanism("II", 90.0, clutch)).ratio for clutch in (5.0, 20.0)]
    return Claim(abs(ratios[1] / ratios[0] - 1.0), "<=", 1e-9)


@computation("dwell.choice")
def choice() -> Claim:
    """a of the chosen type less the least a among the types with a small enough b."""
    mechanism = _mechanism("III")
    compared = compare_dwell_mechanisms(**_data(mechanism), most_torque=1.0)
    usable = [mechanism.a for mechanism in compared.mechanisms.values() if mechanism.b <= 1.0]
    chosen = compared.mechanisms[compared.chosen or ""]
    return Claim(chosen.a - min(usable), "<=", 0.0)
