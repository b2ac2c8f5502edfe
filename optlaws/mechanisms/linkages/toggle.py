"""The toggle press: a crank bends and stretches a knee joint, whose lower link moves a ram."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY
from math import cos, degrees, sin
from typing import TypeAlias

import numpy as np

from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Choice, InSI, Kept, SINumber, Table
from optlaws.errors import InputError
from optlaws.formulas.tracing import Traced
from optlaws.formulas.tree import Formula
from optlaws.mechanisms.linkages.bodies import Body, DrivenLink, Moving, bodies_of, weight_load
from optlaws.mechanisms.linkages.four_bar import SIDES, FourBarBranch, FourBarKinematics, four_bar_of, moved_by_crank
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import LENGTH, BodiesByLink, LinkageKind, function_of
from optlaws.numbers import NumberOrQuantity

LengthsByLink: TypeAlias = Kept[dict[str, float], "Mapping[str, NumberOrQuantity]"]
LENGTHS = ("crank", "rod", "upper", "lower", "frame")
_LOOKS = 2881


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
        Choice(*SIDES),
        "Open where the knee is to the left of the way from the crank's pin to the upper link's pivot, else crossed.",
        default="open",
    )

    def _check(self) -> None:
        missing = [name for name in LENGTHS if name not in self.lengths]
        if missing:
            raise InputError(f"lengths: a toggle needs {', '.join(missing)} too")

    @property
    def mechanism(self) -> Mechanism:
        crank, rod, upper, lower, frame = (self.lengths[name] for name in LENGTHS)
        lengths = {"crank": crank, "coupler": rod, "rocker": upper, "frame": frame}
        linkage = four_bar_of(lengths, self.branch, self.ends)
        known, gravity = self.bodies, self.loads.weight
        by_crank = {"crank": known["crank"], "coupler": known["rod"], "rocker": known["upper"]}
        knee = _Knee(linkage, self.direction, lower, self.ends)
        inertia, load = moved_by_crank(linkage, by_crank, gravity)
        parts, weights = knee.moving(known["lower"], known["ram"], gravity)
        ram = DrivenLink("ram", knee.position.formula, knee.velocity.formula, "length")
        load += [*weights, *self.loads.on(ram, "angle")]
        geometry = LinkGeometry((("ram", knee.position.formula),), (*linkage.chains, knee.chain, knee.chain[1:]))
        return self._mechanism([*inertia, *parts], load, self.ends, geometry)


toggle = function_of(Toggle)


class _Knee:
    """The lower link and the ram, in coordinates along the ram's way and across it, from the upper link's pivot."""

    def __init__(self, linkage: FourBarKinematics, direction: float, lower: float, ends: tuple[float, float]) -> None:
        self.linkage, self.direction, self.lower = linkage, direction, lower
        self.along, self.across = linkage.rocker_along(direction)
        x = np.linspace(*ends, _LOOKS)
        beside = np.abs(linkage.values(self.across, x))
        if beside.max() >= lower:
            raise InputError(
                f"the lower link of {lower:g} m does not reach the ram's way at {degrees(x[np.argmax(beside)]):.6g} "
                f"deg, where the knee is {beside.max():.6g} m from it: make it longer, or take another range in over="
            )
        before = linkage.values(self.along, x)
        if before.min() <= 0.0:
            raise InputError(
                f"at {degrees(x[np.argmin(before)]):.6g} deg the knee is {-before.min():.6g} m behind the upper link's "
                "pivot, seen along the ram's way: take the other branch, the opposite direction, or a shorter range"
            )
        self.height: Traced = np.sqrt(lower**2 - self.across**2)
        self.velocity: Traced = -linkage.rocker_velocity * self.across * (1.0 + self.along / self.height)

    @property
    def position(self) -> Traced:
        """The ram's distance from the upper link's pivot."""
        return self.along + self.height

    def moving(self, lower: Body, ram: Body, gravity: tuple[float, float]) -> tuple[list[Formula], list[Formula]]:
        """Contribution of the lower link and the ram to the inertia and the load at the crank."""
        c, s = cos(self.direction), sin(self.direction)
        gravity_along = gravity[0] * c + gravity[1] * s, gravity[1] * c - gravity[0] * s
        parts = [Moving(ram.mass, self.velocity).inertia] if ram.mass else []
        weights = weight_load(ram.mass, gravity_along, (self.velocity, 0.0))
        if lower == Body():
            return parts, weights
        upper = self.linkage.rocker_velocity
        turning = -upper * self.along / self.height
        (p, q), (v, w) = (value / self.lower for value in lower.centre), (self.across, self.height)
        dx, dy = p * w + q * v, q * w - p * v
        velocity = -upper * v - turning * dy, upper * self.along + turning * dx
        parts += [Moving(lower.mass, part).inertia for part in velocity if lower.mass]
        parts += [Moving(lower.inertia, turning).inertia] if lower.inertia else []
        return parts, [*weights, *weight_load(lower.mass, gravity_along, velocity)]

    @property
    def chain(self) -> tuple[tuple[Formula, Formula], ...]:
        """Links from the knee to the ram as a picture draws them."""
        ex, ey = self.linkage.rocker_direction
        c, s = cos(self.direction), sin(self.direction)
        frame = self.linkage.frame
        knee = (frame + ex).formula, ey.formula
        return knee, ((frame + c * self.position).formula, (s * self.position).formula)
