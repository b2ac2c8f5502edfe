"""Peak constants that no law can beat, in closed form (derivations: docs/theory/limits.md)."""

from __future__ import annotations

from math import hypot, isfinite

from optlaws.errors import InputError


def acceleration_limit(B: float, *, monotone: bool = False, order: int = 2) -> float:
    """Infimum of C over all laws with b <= B, b(1/2) = B, zero end positions (dimensionless).

    Rest-to-rest laws (order >= 2) may come as near as they like; where `monotone`, b >= 0 is asked too. With order 1
    the end velocities are free and the infimum is lower.

    Parameters
    ----------
    B
        Peak velocity, above 1.
    monotone
        Whether b >= 0 is asked.
    order
        Number l of boundary conditions at each end.

    Raises
    ------
    InputError
        If B is not a finite number above 1.

    Examples
    --------
    >>> acceleration_limit(2.0)
    4.0
    >>> acceleration_limit(3.0, monotone=True)
    9.0
    """
    if not isfinite(B) or B <= 1.0:
        msg = f"B must be a finite number above 1 (the mean velocity is 1), got {B!r}"
        raise InputError(msg)
    if order == 1:
        return B * B if monotone and B > 2.0 else 4.0 * (B - 1.0)
    if B <= 2.0:
        return B * B / (B - 1.0)
    return B * B if monotone else 2.0 * (B - 2.0 + hypot(B - 2.0, B))
