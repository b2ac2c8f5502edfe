"""Checks of the data of a dwell mechanism: what fits, and which limit it breaks if it does not."""

from __future__ import annotations

from math import degrees, inf
from typing import TYPE_CHECKING

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.mechanisms.dwell.section_laws import REST, check_law, loader_of

if TYPE_CHECKING:
    from optlaws.mechanisms.dwell.mechanism import DwellMechanism

KINDS = ("I", "II", "III")
LAWS = ("law", "law_1", "law_2", "return_law")
POSITIVE = ("dwell", "rise", "return_angle", "swing", "radius_ratio", "inertia_ratio")
NOT_NEGATIVE = ("clutch_angle", "lower_dwell", "standstill")


def check(one: DwellMechanism) -> None:
    """Refuse what cannot be built.

    Raises
    ------
    InputError
        Naming the first quantity that does not fit, and the remedy.
    """
    if one.kind not in KINDS:
        raise InputError(f"kind must be one of {', '.join(KINDS)}, got {shortened(one.kind)}")
    for name in (*POSITIVE, *NOT_NEGATIVE):
        value = getattr(one, name)
        if not (0.0 < value < inf or (name in NOT_NEGATIVE and value == 0.0)):
            least = "at least 0" if name in NOT_NEGATIVE else "positive"
            raise InputError(f"{name} must be {least} and finite, got {shortened(value)}")
    if not 0.0 < one.reverse_share < 1.0:
        raise InputError(f"reverse_share must be between 0 and 1, got {shortened(one.reverse_share)}")
    for name in LAWS:
        check_law(name, getattr(one, name))
    _speeds(one)
    if one.kind == "I":
        _equal_dwells(one)
    else:
        _room(one)


def _speeds(one: DwellMechanism) -> None:
    back = loader_of(one.return_law).B / one.return_angle
    if abs(one.speed / back - 1.0) > REST:
        raise InputError(
            f"return_angle must suit the rise, for the loader keeps its speed in the dwell: it ends the rise with "
            f"{one.speed:.6g} S per radian (B / rise), and the return begins with {back:.6g}; for the return's law it "
            f"must be {degrees(loader_of(one.return_law).B / one.speed):.6g} degrees"
        )


def _equal_dwells(one: DwellMechanism) -> None:
    if abs(one.lower_dwell - one.dwell) > REST:
        raise InputError(
            f"lower_dwell of type I must equal dwell, {degrees(one.dwell):.6g} degrees, or its rocker drifts; got "
            f"{degrees(one.lower_dwell):.6g} degrees: take type II, or III if there are two dwells"
        )


def _room(one: DwellMechanism) -> None:
    for name, dwell in (("dwell", one.dwell), ("lower_dwell", one.lower_dwell)):
        if one.kind == "II" and dwell == 0.0:
            continue
        if one.free(dwell) <= REST or one.second(dwell) <= REST:
            least = degrees(2.0 * one.clutch_angle + (one.standstill if one.kind == "III" else 0.0))
            raise InputError(
                f"{name} must exceed twice clutch_angle{' and the standstill' if one.kind == 'III' else ''}, "
                f"{least:.6g} degrees, got {degrees(dwell):.6g} degrees"
            )
        if one.free(dwell) - one.second(dwell) < -REST:
            raise InputError(
                f"{name} of type III must leave room for the same way as the upper one: at least "
                f"{degrees(one.dwell - one.standstill):.6g} degrees, got {degrees(dwell):.6g} degrees"
            )
