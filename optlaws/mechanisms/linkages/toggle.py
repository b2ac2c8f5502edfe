"""The toggle press: a crank bends and stretches a knee joint, whose lower link moves a ram."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY
from math import cos, degrees, sin
from typing import TypeAlias

import numpy as np

from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import InSI, Kept, SINumber, Table
from optlaws.errors import InputError
from optlaws.formulas.tracing import Traced
from optlaws.mechanisms.linkages.bodies import DrivenLink, Link, Slide, bodies_of
from optlaws.mechanisms.linkages.four_bar import BRANCH, FourBarBranch, FourBarLinks
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import LENGTH, BodiesByLink, LinkageKind, function_of
from optlaws.numbers import NumberOrQuantity

LengthsByLink: TypeAlias = Kept[dict[str, float], "Mapping[str, NumberOrQuantity]"]
LENGTHS = ("crank", "rod", "upper", "lower", "frame")


@declared
class Toggle(LinkageKind, kind="toggle"):
    """The mechanism of a knee joint: a crank moves the knee through a rod, and the knee a ram; x is the crank's angle.

    The upper link turns about a pivot of the frame, at the distance "frame" from the crank's; x is from that
    direction. The knee is the pin of rod, upper and lower link. The ram slides on a line through the upper link's
    pivot: its position is the distance from that pivot, greatest where the knee is stretched.

    Raises
    ------
    InputError
        If it cannot be assembled everywhere in the range; the error names the dead centres.

    Examples
    --------
    >>> lengths = {"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "200 mm", "frame": "280 mm"}
    >>> press = toggle(lengths, bodies={"ram": "40 kg", "crank": "0.05 kg m^2"})
    >>> round(press.driven_position("ram", "0 deg"), 6), round(press.driven_position("ram", "180 deg"), 6)
    (0.382283, 0.291583)
    """

    lengths: LengthsByLink = entry(
        Table(LENGTH, LENGTHS),
        "Of crank, rod, upper and lower link, and frame.",
        example={"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "200 mm", "frame": "280 mm"},
    )
    _: KW_ONLY
    direction: SINumber = entry(
        InSI("angle"),
        "Of the ram's way, from the direction in which the upper link's pivot is seen from the crank's.",
        default="90 deg",
    )
    bodies: BodiesByLink = entry(
        bodies_of(("crank", "upper"), ("rod", "lower"), ("ram",)),
        "Of crank and upper link a moment of inertia about the pivot, of the ram a mass, or a `Body`; the lower link "
        "begins at the knee.",
        example={"ram": "40 kg"},
    )
    branch: FourBarBranch = entry(
        BRANCH,
        "Open where the knee is to the left of the way from the crank's pin to the upper link's pivot, else crossed.",
        default="open",
    )

    def _check(self) -> None:
        missing = [name for name in LENGTHS if name not in self.lengths]
        if missing:
            raise InputError(f"lengths: a toggle needs {', '.join(missing)} too")

    @property
    def mechanism(self) -> Mechanism:
        *lengths, lower, frame = (self.lengths[name] for name in LENGTHS)
        linkage = FourBarLinks((*lengths, frame), self.branch, self.ends)
        along, across = linkage.rocker_along(self.direction)
        _check_knee(linkage, along, across, lower)
        height: Traced = np.sqrt(lower**2 - across**2)
        upper = linkage.rocker.turning
        position, velocity = along + height, -upper * across * (1.0 + along / height)
        knee = Link((along, across), upper, linkage.rocker.length)
        links: dict[str, Link | Slide] = {
            "crank": linkage.crank,
            "rod": linkage.coupler,
            "upper": linkage.rocker,
            "ram": Slide(velocity, self.direction),
            "lower": Link((height, -across), -upper * along / height, lower, knee, self.direction),
        }
        joint = linkage.chains[-1][2]
        ram = (frame + cos(self.direction) * position, sin(self.direction) * position)
        return self._linkage(
            links,
            self.bodies,
            DrivenLink("ram", position.formula, velocity.formula, "length"),
            [*linkage.chains, [joint, ram], [ram]],
        )


toggle = function_of(Toggle)


def _check_knee(linkage: FourBarLinks, along: Traced, across: Traced, lower: float) -> None:
    """Refuse a range in which the lower link does not reach the ram's way, or the knee is behind the pivot."""
    x, before, beside = linkage.places(along, across)
    far, behind = int(np.argmax(np.abs(beside))), int(np.argmin(before))
    if abs(beside[far]) >= lower:
        raise InputError(
            f"the lower link of {lower:g} m does not reach the ram's way at {degrees(x[far]):.6g} deg, where the knee "
            f"is {abs(beside[far]):.6g} m from it: make it longer, or take another range in over="
        )
    if before[behind] <= 0.0:
        raise InputError(
            f"at {degrees(x[behind]):.6g} deg the knee is {-before[behind]:.6g} m behind the upper link's pivot, seen "
            "along the ram's way: take the other branch, the opposite direction, or a shorter range"
        )
