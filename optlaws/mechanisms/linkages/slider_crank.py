"""The slider-crank: a crank that drives a slide through a rod, its inertia and load at the crank."""

from __future__ import annotations

from dataclasses import KW_ONLY
from math import degrees

import numpy as np

from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import InSI, SINumber
from optlaws.errors import InputError
from optlaws.formulas.tracing import Traced
from optlaws.formulas.tree import Name
from optlaws.mechanisms.linkages.bodies import DrivenLink, Link, Slide, bodies_of
from optlaws.mechanisms.linkages.mechanism import Mechanism
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
        r, e = self.crank, self.offset
        _check(r, self.rod, e, self.ends)
        x = Traced(Name("x"))
        sine, cosine = np.sin(x), np.cos(x)
        across = r * sine - e
        along = np.sqrt(self.rod**2 - across**2)
        position, velocity = r * cosine + along, -r * sine - (r * across * cosine) / along
        pin, slider = (r * cosine, r * sine), (position, e)
        crank = Link(pin, 1.0, r)
        rod = Link((along, -across), -pin[0] / along, self.rod, crank)
        return self._linkage(
            {"crank": crank, "slider": Slide(velocity), "rod": rod},
            self.bodies,
            DrivenLink("slider", position.formula, velocity.formula, "length"),
            [[(0.0, 0.0)], [(0.0, 0.0), pin, slider], [slider]],
        )


slider_crank = function_of(SliderCrank)


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
