"""The toggle press: a crank bends and stretches a knee joint, whose lower link moves a ram."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, degrees, sin
from typing import Any

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.slopes import added
from optlaws.formulas.tracing import Traced
from optlaws.formulas.tree import Formula
from optlaws.mechanisms.linkages.bodies import (
    NO_LOADS,
    Body,
    DrivenLink,
    Loads,
    Moving,
    bodies_of,
    ends_of,
    length,
    weight_load,
)
from optlaws.mechanisms.linkages.four_bar import FourBarBranch, FourBarKinematics, four_bar_of, moved_by_crank
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism
from optlaws.motion.quantities import si_number
from optlaws.numbers import NumberOrQuantity, finite
from optlaws.suggest import unknown_key

LENGTHS = ("crank", "rod", "upper", "lower", "frame")
_LOOKS = 2881


def toggle(
    lengths: Mapping[str, NumberOrQuantity],
    *,
    direction: NumberOrQuantity = "90 deg",
    bodies: Mapping[str, Any],
    loads: Loads = NO_LOADS,
    over: tuple[NumberOrQuantity, NumberOrQuantity] = ("0 deg", "360 deg"),
    branch: FourBarBranch = "open",
) -> Mechanism:
    """The mechanism of a knee joint: a crank moves the knee through a rod, and the knee a ram; x is the crank's angle.

    The upper link turns about a pivot of the frame, at the distance "frame" from the crank's; x is from that
    direction. The knee is the pin of rod, upper and lower link. The ram slides on a line through the upper link's
    pivot: its position is the distance from that pivot, greatest where the knee is stretched.

    Parameters
    ----------
    lengths
        Of "crank", "rod", "upper", "lower" link and "frame", such as "0.1 m", or numbers in m.
    direction
        Of the ram's way, from the direction in which the upper link's pivot is seen from the crank's.
    bodies
        Of "crank", "rod", "upper", "lower" and "ram": a moment of inertia about its pivot for crank and upper link, a
        mass for the ram, or a `Body`; the lower link begins at the knee.
    loads
        What acts on the ram, over its position; gravity's direction is from the frame's.
    over
        The range of x.
    branch
        "open" where the knee is to the left of the way from the crank's pin to the upper link's pivot, else "crossed".

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
    for name in lengths:
        if name not in LENGTHS:
            raise InputError(unknown_key(name, LENGTHS, "length"))
    missing = [name for name in LENGTHS if name not in lengths]
    if missing:
        raise InputError(f"lengths: a toggle needs {', '.join(missing)} too")
    crank, rod, upper, lower, frame = (length(lengths[name], name) for name in LENGTHS)
    ends = ends_of(over)
    linkage = four_bar_of({"crank": crank, "coupler": rod, "rocker": upper, "frame": frame}, branch, ends)
    angle = finite(si_number(direction, ("angle",), "direction"), "direction")
    known = bodies_of(bodies, pivoted=("crank", "upper"), coupled=("rod", "lower"), sliding=("ram",))
    by_crank = {"crank": known["crank"], "coupler": known["rod"], "rocker": known["upper"]}
    knee = _Knee(linkage, angle, lower, ends)
    inertia, load = moved_by_crank(linkage, by_crank, loads.weight)
    parts, weights = knee.moving(known["lower"], known["ram"], loads.weight)
    ram = DrivenLink("ram", knee.position.formula, knee.velocity.formula, "length")
    return Mechanism(
        added([*inertia, *parts]),
        added([*load, *weights, *loads.on(ram, "angle")]),
        over=ends,
        axis="angle",
        name="toggle",
        linkage=LinkGeometry((("ram", knee.position.formula),), (*linkage.chains, knee.chain, knee.chain[1:])),
    )


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
