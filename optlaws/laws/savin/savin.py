"""Savin's laws: members of his families by alpha or by a peak constant."""

from __future__ import annotations

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.savin.family import SavinFamily


def savin(
    family: str | int,
    alpha: float | None = None,
    *,
    B: float | None = None,
    C: float | None = None,
    D: float | None = None,
    branch: str | None = None,
) -> PolynomialLaw:
    """A member of Savin's families I to IV (eq. 1.10, 1.14, 1.15, 1.16) or of those beyond, dimensionless.

    Its acceleration is c = H (k(1-k))^u (1/2-k) y with y = 1 + alpha (k² - k + M), M such that the stroke is 1;
    alpha = 0 gives the base law.

    Parameters
    ----------
    family
        "I", "II", "III", "IV", or the exponent u of the base law, any integer of at least 0; family I is u = 0.
    alpha
        Parameter of the member; or else exactly one of the next three.
    B, C, D
        The peak that the member shall have. B has one member, C and D may have two.
    branch
        "lower" or "upper", which of two members: alpha below or above that of the least C, or D.

    Raises
    ------
    InputError
        If the family is unknown, alpha is outside the range in which y >= 0, no member has the peak, or two have it
        and `branch` does not say which.

    Examples
    --------
    >>> savin("III", 0.0) == savin("II", -7.0)
    True
    >>> savin("III", alpha=7.2)
    PolynomialLaw(degree=9, B=1.85938, C=6.76096, D=7.16667, J=54.3787)
    >>> savin("I", B=1.45)
    PolynomialLaw(degree=5, B=1.45, C=6.8, D=3.29666, J=21.6)
    """
    known = SavinFamily.of(family)
    given = [name for name, value in (("alpha", alpha), ("B", B), ("C", C), ("D", D)) if value is not None]
    if len(given) != 1:
        raise InputError(f"a member is given by one of alpha, B, C and D, got {' and '.join(given) or 'none'}")
    if alpha is not None:
        if branch is not None:
            raise InputError("branch tells two members of one C or D apart; alpha alone names a member")
        return known.law(alpha)
    if branch not in (None, "lower", "upper"):
        raise InputError(f"branch must be 'lower' or 'upper', got {shortened(branch)}")
    members = known.alphas(B=B, C=C, D=D)
    if len(members) == 1:
        return known.law(members[0])
    if branch is None:
        both = " and ".join(f"{member:.9g}" for member in members)
        raise InputError(
            f"{known} has two members of this {given[0]}, alpha = {both}; say branch='lower' or branch='upper'"
        )
    return known.law(members[0 if branch == "lower" else 1])


def alpha_range(family: str | int) -> tuple[float, float]:
    """Least and greatest alpha of a family, -1/M and 1/(1/4 - M), between which y >= 0.

    Parameters
    ----------
    family
        "I", "II", "III", "IV" or the exponent u of its base law.

    Raises
    ------
    InputError
        If the family is unknown.

    Examples
    --------
    >>> alpha_range("III")
    (-6.0, 12.0)
    """
    low, high = SavinFamily.of(family).range
    return float(low), float(high)
