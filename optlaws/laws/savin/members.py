"""Members of Savin's families by a peak constant: B(alpha), C(alpha) and D(alpha) inverted."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import finite

if TYPE_CHECKING:
    from optlaws.laws.savin.family import SavinFamily

_HALVINGS = 200


def alphas(
    family: SavinFamily, *, B: float | None = None, C: float | None = None, D: float | None = None
) -> tuple[float, ...]:
    """Every alpha of a family whose member has the peak given: what `SavinFamily.alphas` gives.

    Examples
    --------
    >>> from optlaws.laws.savin.family import SavinFamily
    >>> alphas(SavinFamily(2), B=1.75)
    (9.6,)
    """
    given = [(name, value) for name, value in (("B", B), ("C", C), ("D", D)) if value is not None]
    if len(given) != 1:
        raise InputError(f"give exactly one of B, C and D, got {' and '.join(name for name, _ in given) or 'none'}")
    ((name, value),) = given
    value = finite(value, name)
    if name == "B":
        return (_alpha_of_velocity(family, value),)
    peak, (best, least) = (family.C, family.least_C) if name == "C" else (family.D, family.least_D)

    def height(alpha: float) -> float:
        return peak(alpha).value

    low, high = map(float, family.range)
    _check_reachable(family, name, value, least.value, max(height(low), height(high)))
    if value == least.value:
        return (best,)
    return tuple(_root(lambda alpha: height(alpha) - value, best, end) for end in (low, high) if height(end) >= value)


def _alpha_of_velocity(family: SavinFamily, B: float) -> float:
    low, high = family.range
    most, least = (Fraction(family.B(float(alpha)).value) for alpha in (low, high))
    _check_reachable(family, "B", B, float(least), float(most))
    alpha = float(low + (high - low) * (most - Fraction(B)) / (most - least))
    return min(max(alpha, float(low)), float(high))


def _check_reachable(family: SavinFamily, name: str, value: float, least: float, most: float) -> None:
    if not least <= value <= most:
        raise InputError(f"{name} of {family} reaches from {least:.9g} to {most:.9g}, got {shortened(value)}")


def _root(excess: Callable[[float], float], inner: float, outer: float) -> float:
    """The place between, to the last digit: excess is below zero at the inner end and not below at the outer one."""
    if excess(outer) == 0.0:
        return outer
    for _ in range(_HALVINGS):
        middle = 0.5 * (inner + outer)
        if middle in (inner, outer):
            break
        if excess(middle) < 0.0:
            inner = middle
        else:
            outer = middle
    return outer
