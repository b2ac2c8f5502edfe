"""Savin's families of laws: a base law whose acceleration is multiplied by y = 1 + alpha (k² - k + M)."""

from __future__ import annotations

from fractions import Fraction
from math import comb, factorial, isfinite

from optlaws.errors import InputError
from optlaws.laws.polynomial import PolynomialLaw

FAMILIES = {"I": 0, "II": 1, "III": 2, "IV": 3}


def savin(family: str, alpha: float) -> PolynomialLaw:
    """The member `alpha` of Savin's family I, II, III or IV (eq. 1.10, 1.14, 1.15, 1.16), dimensionless.

    Its acceleration is c = H (k(1-k))^u (1/2-k) y with u = 0 to 3 and y = 1 + alpha (k² - k + M), M such that the
    stroke is 1; alpha = 0 gives the base law.

    Raises
    ------
    InputError
        If the family is unknown, or alpha is outside the range in which y >= 0.

    Examples
    --------
    >>> savin("III", 0.0) == savin("II", -7.0)
    True
    >>> round(savin("III", 7.2).constants.B.value, 6)
    1.859375
    """
    if family not in FAMILIES:
        raise InputError(f"family {family!r} is unknown; known are {', '.join(FAMILIES)}")
    u = FAMILIES[family]
    low, high = alpha_range(family)
    if not isfinite(alpha) or not low <= alpha <= high:
        raise InputError(f"alpha of family {family} must be between {low} and {high} (y >= 0), got {alpha!r}")
    mean = Fraction(u + 1, 2 * (2 * u + 5))
    scale = Fraction(2 * factorial(2 * u + 3), factorial(u) * factorial(u + 1))
    exact = Fraction(alpha)
    multiplier = [1 + exact * mean, -exact, exact]
    acceleration = [Fraction(0)] * (2 * u + 4)
    for i in range(u + 1):
        for m, factor in enumerate(multiplier):
            part = scale * (-1) ** i * comb(u, i) * factor
            acceleration[u + i + m] += part / 2
            acceleration[u + i + m + 1] -= part
    displacement = [Fraction(0), Fraction(0)]
    displacement += [value / ((n + 1) * (n + 2)) for n, value in enumerate(acceleration)]
    return PolynomialLaw.from_powers(displacement)


def alpha_range(family: str) -> tuple[float, float]:
    """Least and greatest alpha of a family, -1/M and 1/(1/4 - M), between which y >= 0.

    Examples
    --------
    >>> alpha_range("III")
    (-6.0, 12.0)
    """
    u = FAMILIES[family]
    return -2.0 * (2 * u + 5) / (u + 1), 4.0 * (2 * u + 5) / 3.0
