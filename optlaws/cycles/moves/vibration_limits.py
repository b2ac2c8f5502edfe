"""Limits of the residual vibration of an elastic follower after a move, from quantities of its machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import tau
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.motion.quantities import positive_quantity, table
from optlaws.suggest import unknown_key
from optlaws.synthesis.least_time.follower_residual import RESIDUAL, FollowerResidual

_EXAMPLE = '{"frequency": ("15.9 Hz", "17.5 Hz"), "damping": 0.05}'
_KEYS = ("frequency", "damping")
_ACCELERATIONS = {"m": "acceleration", "rad": "angular acceleration"}


def vibration_limit(
    follower: Mapping[str, Any], limits: Mapping[str, Any]
) -> tuple[dict[str, Any], Callable[[str], FollowerResidual]]:
    """The limits without the follower's limit, and a function that builds that limit for a stroke in "m" or "rad".

    Raises
    ------
    InputError
        If the follower is wrong, or no limit names the residual acceleration.

    Examples
    --------
    >>> rest, left = vibration_limit({"frequency": "10 Hz"}, {"residual acceleration": "0.2 m/s^2", "jerk": "9 m/s^3"})
    >>> rest, round(left("m").highest, 6), left("m").most
    ({'jerk': '9 m/s^3'}, 62.831853, 0.2)
    """
    if RESIDUAL not in limits:
        raise InputError(f'a follower, as in {_EXAMPLE}, needs limits={{"{RESIDUAL}": "0.5 m/s^2"}}')
    free = read_follower(follower)
    rest = {name: limit for name, limit in limits.items() if name != RESIDUAL}

    def of_unit(unit: str) -> FollowerResidual:
        return replace(free, most=positive_quantity(limits[RESIDUAL], _ACCELERATIONS[unit], f"limits: {RESIDUAL}"))

    return rest, of_unit


def read_follower(follower: Mapping[str, Any]) -> FollowerResidual:
    """The residual acceleration of a follower in SI units, its limit 1.

    Raises
    ------
    InputError
        If an entry is unknown, missing or wrong.

    Examples
    --------
    >>> known = read_follower({"frequency": ("10 Hz", "12 Hz"), "damping": 0.05})
    >>> round(known.lowest, 6), round(known.highest, 6), known.most
    (62.831853, 75.398224, 1.0)
    """
    entries = table(follower, "follower", _EXAMPLE)
    for name in entries:
        if name not in _KEYS:
            raise InputError(unknown_key(name, _KEYS, "entry of a follower"))
    if "frequency" not in entries:
        raise InputError(f"a follower needs its frequency, as in {_EXAMPLE}")
    given = entries["frequency"]
    pair = given if isinstance(given, list | tuple) else (given, given)
    if len(pair) != 2:
        raise InputError(f"follower: frequency must be one, or the least and the greatest, got {shortened(given)}")
    low, high = (tau * positive_quantity(each, "frequency", "follower: frequency") for each in pair)
    return FollowerResidual(low, high, entries.get("damping", 0.0), 1.0)
