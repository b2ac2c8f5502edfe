"""A cam away from the frequency it was made for: what errors of speed and stiffness cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw, Peak
from optlaws.mechanisms.checks import motion_law
from optlaws.mechanisms.follower.follower import Follower
from optlaws.mechanisms.follower.response import Response
from optlaws.numbers import numbers

Change = Literal["speed", "stiffness"]

DEVIATIONS = (-10.0, -5.0, 0.0, 5.0, 10.0)


@dataclass(frozen=True)
class Deviation:
    """A follower off its design and its response.

    Parameters
    ----------
    percent
        Change of nu in percent of the design's.
    response
        What the mass does.
    reference
        The law meant for the mass.

    Examples
    --------
    >>> from optlaws.laws.savin import savin
    >>> worst = off_design(savin("III", 7.2), savin("III", 7.2), Follower(nu=20))[0]
    >>> worst.percent, worst.dynamic_factor
    (-10.0, 2.035976)
    """

    percent: float
    response: Response
    reference: MotionLaw

    @property
    def dynamic_factor(self) -> float:
        """max |a_m''| of the rise over C of the reference."""
        return self.response.dynamic_factor(self.reference)

    @property
    def peak(self) -> Peak:
        """max |a_m''| of the rise and its place."""
        return self.response.peak(2)


def off_design(
    cam: MotionLaw,
    reference: MotionLaw,
    design: Follower,
    *,
    deviations: Sequence[float] = DEVIATIONS,
    change: Change = "speed",
) -> tuple[Deviation, ...]:
    """Responses to one cam of followers whose nu deviates from the design's.

    nu = T sqrt(stiffness/mass) falls by as many percent as the speed rises, to first order, and by half as many as the
    stiffness falls. A change of speed leaves the damping ratio as it is, a change of stiffness n = h T / 2 mass.

    Parameters
    ----------
    cam
        Law of the cam.
    reference
        Law meant for the mass, whose C the dynamic factor refers to.
    design
        The follower for which the cam was made.
    deviations
        Changes of nu in percent, above -100.
    change
        "speed" keeps the damping ratio, "stiffness" keeps n.

    Raises
    ------
    InputError
        If an argument is out of range or unknown.

    Examples
    --------
    >>> from optlaws.laws.savin import savin
    >>> from optlaws.mechanisms import polydyne
    >>> law = savin("IV", 11.0)
    >>> [round(deviation.dynamic_factor, 6) for deviation in off_design(polydyne(law, nu=20), law, Follower(nu=20))]
    [1.185564, 1.102502, 1.0, 0.963659, 0.945973]
    """
    meant = motion_law(reference, "reference")
    percents = numbers(list(deviations), "deviations")
    if min(percents, default=0.0) <= -100.0:
        raise InputError(f"deviations are changes of nu in percent and must be above -100, got {min(percents):g}")
    if change not in ("speed", "stiffness"):
        raise InputError(f'change must be "speed" or "stiffness", got {shortened(change)}')
    compared = []
    for percent in percents:
        factor = 1.0 + percent / 100.0
        ratio = design.damping if change == "speed" else design.damping / factor
        compared.append(Deviation(percent, Follower(design.nu * factor, ratio).response(cam), meant))
    return tuple(compared)
