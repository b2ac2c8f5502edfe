"""Limits of the residual vibration of an elastic follower after a move, from quantities of its machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import tau
from typing import Any

from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Either, Listed, Measured, Number, is_list
from optlaws.errors import InputError
from optlaws.motion.quantities import positive_quantity, quantity
from optlaws.numbers import Quantity
from optlaws.synthesis.least_time.follower_residual import RESIDUAL, FollowerResidual

_EXAMPLE = '{"frequency": ("15.9 Hz", "17.5 Hz"), "damping": 0.05}'
_FREQUENCY = Measured("frequency", above=0.0)
_ACCELERATIONS = {"m": "acceleration", "rad": "angular acceleration"}


@declared
class VibratingFollower(Declared, title="a follower"):
    """An elastic follower that a move leaves vibrating.

    Examples
    --------
    >>> VibratingFollower(["27 Hz", "33 Hz"], damping=0.05).frequency
    ('27 Hz', '33 Hz')
    """

    frequency: Quantity | Sequence[Quantity] = entry(
        Either(_FREQUENCY, Listed(_FREQUENCY, least=2, most=2), which=is_list),
        "Its natural frequency, or the least and the greatest.",
        example=["27 Hz", "33 Hz"],
    )
    damping: float = entry(Number(least=0.0), "Its damping ratio.", default=0.0, example=0.05)


def vibration_limit(
    follower: VibratingFollower | Mapping[str, Any], limits: Mapping[str, Any]
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


def read_follower(follower: VibratingFollower | Mapping[str, Any]) -> FollowerResidual:
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
    read = ValueOf(VibratingFollower).read(follower, "follower")
    pair = read.frequency if isinstance(read.frequency, tuple) else (read.frequency, read.frequency)
    low, high = (tau * quantity(each, "frequency", "follower: frequency") for each in pair)
    return FollowerResidual(low, high, read.damping, 1.0)
