"""Limits of the torsion lever: transmission angles and the swing of the rocker."""

from __future__ import annotations

from math import degrees, pi
from typing import Protocol

import numpy as np

from optlaws.balancing.levers.linkage import FourBar
from optlaws.errors import InputError
from optlaws.numerics.tolerances import ANGLE_LIMIT

#: least transmission angle that is allowed unless another is given, radians
LEAST_TRANSMISSION = pi / 6.0
#: greatest swing of the rocker that is allowed unless another is given, radians
MOST_ROCKER_SWING = pi / 3.0


class Limited(Protocol):
    """A linkage with its limits, angles in radians."""

    @property
    def linkage(self) -> FourBar:
        """The four-bar linkage of the lever."""
        ...

    @property
    def least_transmission(self) -> float:
        """Least angle between the coupler and either link; the greatest is its supplement."""
        ...

    @property
    def most_rocker_swing(self) -> float:
        """Greatest swing of the rocker."""
        ...


def check(lever: Limited, chi02: float, chi01: float, where: str) -> None:
    """See that the linkage keeps to its limits from chi02 to chi01, radians; `where` is what an error adds."""
    ends = f"between {degrees(chi02):.6g} and {degrees(chi01):.6g} deg ({where})"
    low, high = lever.linkage.range
    if not low < chi02 < chi01 < high:
        raise InputError(
            f"the linkage passes a dead point {ends}: it can move from {degrees(low):.6g} to {degrees(high):.6g} deg; "
            "reduce swing or change lam"
        )
    least = lever.least_transmission
    angles = lever.linkage.transmission(chi02, chi01)
    for (smallest, greatest), link in zip(angles, ("rocker", "driven link"), strict=True):
        for angle, beyond, limit in (
            (smallest, least - smallest, least),
            (greatest, greatest - pi + least, pi - least),
        ):
            if beyond > ANGLE_LIMIT:
                raise InputError(
                    f"the angle between coupler and {link} is {degrees(angle):.6g} deg {ends}, the limit is "
                    f"{degrees(limit):.6g} deg (least_transmission); reduce swing or change beta or lam"
                )
    swing = float(np.diff(lever.linkage.rocker(np.array([chi02, chi01])))[0])
    if swing - lever.most_rocker_swing > ANGLE_LIMIT:
        raise InputError(
            f"the rocker swings by {degrees(swing):.6g} deg {ends}, the limit is "
            f"{degrees(lever.most_rocker_swing):.6g} deg (most_rocker_swing); reduce swing or beta"
        )
