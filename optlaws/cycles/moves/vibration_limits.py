"""The residual vibration of an elastic follower after a move, from quantities of its machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import tau
from typing import Any

from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Either, Listed, Measured, Number, is_list
from optlaws.motion.quantities import quantity
from optlaws.numbers import Quantity
from optlaws.synthesis.least_time.follower_residual import FollowerResidual

_FREQUENCY = Measured("frequency", above=0.0)


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
