"""Which of the three types suits given data: the smallest cam whose residual torque is small enough."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import degrees, inf, isfinite, pi
from typing import Unpack

from optlaws.balancing.dwells.mechanism import (
    DEFAULTS,
    KINDS,
    DwellEntries,
    DwellMechanism,
    DwellType,
    dwell_mechanism,
)
from optlaws.echo import keywords_of, shortened
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.motion.quantities import quantity
from optlaws.numbers import real
from optlaws.numerics.peaks import is_kept

SHORT, LONG = pi / 4.0, 5.0 * pi / 9.0


@dataclass(frozen=True)
class DwellComparison:
    """The three types for the same data, and which of them to take.

    Attributes
    ----------
    mechanisms
        The types that can be built.
    reasons
        For each type why it is or is not usable.
    chosen
        The usable type with the smallest cam; None where none is usable.
    by_rule
        What the rule of thumb of the paper takes: I up to 45 degrees of equal dwells, II above 100 degrees or with one
        dwell, else III.
    """

    mechanisms: Mapping[str, DwellMechanism]
    reasons: Mapping[str, str]
    chosen: DwellType | None
    by_rule: DwellType


@keywords_of(DwellEntries, **DEFAULTS)
def compare_dwell_mechanisms(
    *, most_torque: float, most_size: float = inf, **entries: Unpack[DwellEntries]
) -> DwellComparison:
    """Compare the types: the best has the smallest cam (a) among types with a small enough residual torque (b).

    Type I leaves no residual torque and has the largest cam, type II the other way round; so the choice is a trade of
    size against residual torque, and depends on every argument here, not on the dwell alone.

    Parameters
    ----------
    law, dwell, rise, swing, radius_ratio, inertia_ratio
        As for `dwell_mechanism`.
    clutch_angle, law_1, law_2, return_angle, return_law, lower_dwell, standstill, reverse_share
        As for `dwell_mechanism`, where the type has them.
    most_torque
        Greatest b that is acceptable.
    most_size
        Greatest a that is acceptable.

    Raises
    ------
    InputError
        If a limit is not positive, or none of the types can be built.

    Examples
    --------
    >>> from optlaws import catalogue, deg
    >>> comparison = compare_dwell_mechanisms(
    ...     law=catalogue["K"].law,
    ...     dwell=deg(90),
    ...     rise=deg(90),
    ...     clutch_angle=deg(15),
    ...     swing=deg(20),
    ...     radius_ratio=1.0026761,
    ...     inertia_ratio=0.1,
    ...     most_torque=0.5,
    ... )
    >>> comparison.chosen, comparison.by_rule
    ('III', 'III')
    >>> comparison.reasons["II"]
    'no: b = 1.98 exceeds 0.5'
    """
    make = partial(dwell_mechanism, **entries)
    upper, lower = entries["dwell"], entries.get("lower_dwell")
    dwells = [quantity(angle, "angle", "dwell", bare=True) for angle in (upper, upper if lower is None else lower)]
    return _compared(make, most_torque, most_size, _by_rule(*dwells))


def buildable(
    make: Callable[[DwellType], DwellMechanism],
) -> tuple[dict[str, DwellMechanism], dict[str, InputError]]:
    """The types that can be built from the same data, and for each other type the reason why not.

    Examples
    --------
    >>> from optlaws import catalogue, deg
    >>> data = dict(law=catalogue["K"].law, dwell=deg(90), rise=deg(90), swing=deg(20), lower_dwell=0.0)
    >>> mechanisms, refused = buildable(partial(dwell_mechanism, radius_ratio=1.0, inertia_ratio=0.1, **data))
    >>> [*mechanisms], [*refused]
    (['II'], ['I', 'III'])
    """
    built: dict[str, DwellMechanism] = {}
    refused: dict[str, InputError] = {}
    for kind in KINDS:
        try:
            built[kind] = make(kind)
        except InputError as error:
            refused[kind] = error
    return built, refused


def _compared(
    make: Callable[[DwellType], DwellMechanism], most_torque: float, most_size: float, by_rule: DwellType
) -> DwellComparison:
    for name, limit in (("most_torque", most_torque), ("most_size", most_size)):
        number = real(limit)
        if number is None or not number > 0.0:
            raise InputError(f"{name} must be positive, got {shortened(limit)}")
    built, refused = buildable(make)
    if not built:
        raise refused[KINDS[-1]]
    reasons: dict[str, str] = {
        kind: _reason(built[kind], most_torque, most_size) if kind in built else f"cannot be built: {refused[kind]}"
        for kind in KINDS
    }
    usable = [mechanism for kind, mechanism in built.items() if reasons[kind].startswith("yes")]
    chosen = min(usable, key=lambda mechanism: (mechanism.a, mechanism.b)).kind if usable else None
    return DwellComparison(built, reasons, chosen, by_rule)


def least_dwell(mechanism: DwellMechanism, most_torque: float, *, half_turn: bool = True) -> float:
    """The dwell from which on the residual torque b of a type is within a limit, radians.

    Parameters
    ----------
    mechanism
        A mechanism of type II or III with equal dwells; its dwell is varied.
    most_torque
        Limit of b.
    half_turn
        Whether rise and dwell make half a turn, so that the rise shrinks as the dwell grows; else the rise stays.

    Raises
    ------
    InfeasibleProblem
        If no dwell below half a turn will do.

    Examples
    --------
    >>> from math import degrees
    >>> from optlaws import catalogue, deg
    >>> mechanism = dwell_mechanism(
    ...     "III",
    ...     law=catalogue["K"].law,
    ...     dwell=deg(60),
    ...     rise=deg(120),
    ...     clutch_angle=deg(10),
    ...     swing=deg(20),
    ...     radius_ratio=1.0,
    ...     inertia_ratio=0.1,
    ... )
    >>> degrees(least_dwell(mechanism, 0.5))
    46.666667
    """

    def excess(dwell: float) -> float:
        rise = pi - dwell if half_turn else mechanism.rise
        varied = replace(mechanism, dwell=dwell, lower_dwell=dwell, rise=rise, return_angle=rise)
        return varied.b - most_torque

    low = 2.0 * mechanism.clutch_angle + mechanism.standstill
    span = pi - low
    return _root(excess, low + 1e-6 * span, pi - 1e-6 * span, f"type {mechanism.kind}, b <= {most_torque:g}")


def _root(excess: Callable[[float], float], low: float, high: float, what: str) -> float:
    if excess(high) > 0.0:
        raise InfeasibleProblem(f"no dwell up to {degrees(high):.6g} degrees will do for {what}")
    if excess(low) <= 0.0:
        return low
    from scipy.optimize import brentq

    return float(brentq(excess, low, high, xtol=1e-13))


def _reason(mechanism: DwellMechanism, most_torque: float, most_size: float) -> str:
    faults = [
        f"{name} = {value:.3g} exceeds {limit:g}"
        for name, value, limit in (("a", mechanism.a, most_size), ("b", mechanism.b, most_torque))
        if not is_kept(value, limit)
    ]
    if faults:
        return f"no: {' and '.join(faults)}"
    limits = f"b = {mechanism.b:.3g} is within {most_torque:g}"
    return f"yes: a = {mechanism.a:.4g}, {limits}" + (f", a within {most_size:g}" if isfinite(most_size) else "")


def _by_rule(dwell: float, lower_dwell: float) -> DwellType:
    if lower_dwell == 0.0 or max(dwell, lower_dwell) > LONG:
        return "II"
    return "I" if dwell == lower_dwell and dwell <= SHORT else "III"
