"""The slider-crank: a crank that drives a slide through a rod, its inertia and load at the crank."""

from __future__ import annotations

from dataclasses import KW_ONLY
from math import degrees
from typing import Any

import numpy as np

from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import InSI, SINumber
from optlaws.errors import InputError
from optlaws.formulas.tracing import Traced
from optlaws.formulas.tree import Formula, Name, Number
from optlaws.mechanisms.linkages.bodies import Body, DrivenLink, Moving, bodies_of, formula_from, weight_load
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import LENGTH, BodiesByLink, LinkageKind, function_of


@declared
class SliderCrank(LinkageKind, kind="slider crank"):
    """The mechanism of a crank that drives a slide through a rod; x is the crank's angle from the slide's way.

    The slide is at s = r cos x + sqrt(l² - (r sin x - e)²) from the crank's pivot, farthest where x = 0 without offset.

    Raises
    ------
    InputError
        If the rod is too short for the crank and the offset within the range; the error names the angles that are
        reached.

    Examples
    --------
    >>> press = slider_crank("0.1 m", "0.4 m", bodies={"slider": "5 kg", "crank": "0.02 kg m^2"})
    >>> round(press.inertia("90 deg"), 9), round(press.driven_position("slider", 0.0), 9)
    (0.07, 0.5)
    """

    crank: SINumber = entry(LENGTH, "Its length r.", example="100 mm")
    rod: SINumber = entry(LENGTH, "Its length l.", example="400 mm")
    _: KW_ONLY
    offset: SINumber = entry(
        InSI("length"), "Of the slide's way from the crank's pivot, e, to the left.", default=0.0, example="20 mm"
    )
    bodies: BodiesByLink = entry(
        bodies_of(("crank",), ("rod",), ("slider",)),
        "Of the slider a mass, of the crank a moment of inertia about its pivot, or a `Body`.",
        example={"crank": "0.5 kg m^2", "slider": "12 kg"},
    )

    @property
    def mechanism(self) -> Mechanism:
        r, rod_length, e, known, g = self.crank, self.rod, self.offset, self.bodies, self.loads.weight
        _check(r, rod_length, e, self.ends)
        x = Traced(Name("x"))
        sine, cosine = np.sin(x), np.cos(x)
        across = r * sine - e if e else r * sine
        along = np.sqrt(rod_length**2 - across**2)
        position = r * cosine + along
        velocity = -r * sine - (r * across * cosine) / along
        crank_body, rod_body, slid = known["crank"], known["rod"], known["slider"].mass
        moving, weights = [Moving(slid, velocity)], weight_load(slid, g, (velocity, 0.0))
        (p, q) = crank_body.centre
        weights += weight_load(crank_body.mass, g, (-p * sine - q * cosine, p * cosine - q * sine))
        if rod_body != Body():
            parts, more = _rod(rod_body, g, rod_length, (r, sine, cosine), (across, along))
            moving, weights = moving + parts, weights + more
        moving = [Moving(crank_body.about_joint, 1.0), *(part for part in moving if part.weight)]
        slider = DrivenLink("slider", position.formula, velocity.formula, "length")
        zero = Number(0.0)
        pin, joint = ((r * cosine).formula, (r * sine).formula), (position.formula, formula_from(e))
        chains = (((zero, zero),), ((zero, zero), pin, joint), (joint,))
        load = [*weights, *self.loads.on(slider, "angle")]
        return self._mechanism(
            [part.inertia for part in moving], load, self.ends, LinkGeometry((("slider", position.formula),), chains)
        )


slider_crank = function_of(SliderCrank)


def _rod(
    body: Body, gravity: tuple[float, float], rod: float, crank: tuple[float, Any, Any], triangle: tuple[Any, Any]
) -> tuple[list[Moving], list[Formula]]:
    """The rod's centre of mass and its turning; the rod goes from the crank's pin to the slide."""
    (r, sine, cosine), (across, along), (p, q) = crank, triangle, body.centre
    turning = -r * cosine / along
    # the rod's direction is (along, -across)/rod
    dx, dy = (p * along + q * across) / rod, (q * along - p * across) / rod
    velocity = -r * sine - turning * dy, r * cosine + turning * dx
    moving = [Moving(body.inertia, turning), *(Moving(body.mass, part) for part in velocity)]
    return moving, weight_load(body.mass, gravity, velocity)


def _check(crank: float, rod: float, offset: float, ends: tuple[float, float]) -> None:
    """Refuse a range in which the rod cannot reach the slide's way."""
    x = np.linspace(*ends, 7201)
    far = np.abs(crank * np.sin(x) - offset)
    if far.max() < rod:
        return
    where = x[far >= rod]
    reached = x[far < rod]
    near = (
        f"within the range it is reached from {degrees(reached[0]):.6g} to {degrees(reached[-1]):.6g} deg but for these"
        if reached.size
        else "it is reached nowhere in the range"
    )
    raise InputError(
        f"the rod of {rod:g} m is too short for a crank of {crank:g} m and an offset of {offset:g} m: at "
        f"{degrees(where[0]):.6g} deg the pin is {far[far >= rod][0]:g} m from the "
        f"slide's way, and {near}; take a rod of more than {crank + abs(offset):g} m, or another range in over="
    )
