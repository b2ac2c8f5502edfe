"""How the force between cam and follower acts: its lever on the follower, how the surfaces slide, what guides bear."""

from __future__ import annotations

from dataclasses import dataclass
from functools import singledispatch
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.curves.jets import Jet
from optlaws.cams.followers.contact import Contact
from optlaws.cams.followers.oscillating_flat import SwingingFace
from optlaws.cams.followers.oscillating_roller import SwingingRoller
from optlaws.cams.followers.translating_flat import SlidingFace
from optlaws.cams.followers.translating_roller import SlidingRoller
from optlaws.errors import InputError

Array = NDArray[np.float64]


class Transmission(NamedTuple):
    """What a force of 1 N between cam and follower does, at places of the turn.

    Attributes
    ----------
    lever
        On the follower: 1 N along the normal drives it with so many N, or N m.
    sliding
        How fast the surfaces slide, or the roller rolls, m per radian of the cam.
    dragged
        Lever on the follower of a force along the surfaces, the way in which the cam's runs past, m.
    across
        Sideways part of the normal's force on a slide, and 0 on an arm, N.
    aside
        How far from a slide's way the force acts, m.
    """

    lever: Array
    sliding: Array
    dragged: Array
    across: Array
    aside: Array


@dataclass(frozen=True)
class Friction:
    """Friction of a cam and its follower; coefficients without a dimension, lengths in metres.

    Attributes
    ----------
    contact
        Of a face that slides on the cam; of a roller, what rolling and its pin take, at the roller's surface.
    guide
        Of a slide in its guide.
    overhang, length
        From where the cam touches to the guide, and the guide's length.
    """

    contact: float = 0.0
    guide: float = 0.0
    overhang: float = 0.0
    length: float = 1.0

    def held_back(self, transmission: Transmission, turning: float, *, faced: bool) -> Array:
        """Friction in the guide, of either sign of the velocity, for a normal force of 1 N."""
        if not self.guide:
            return 0.0 * transmission.lever
        # the surface of the cam drags a face along; a roller gives way
        dragged = -turning * self.contact if faced else 0.0
        across = transmission.across + dragged
        near = transmission.aside + (self.overhang + self.length) * across
        far = transmission.aside + self.overhang * across
        return np.asarray(self.guide * (np.abs(near) + np.abs(far)) / self.length)


@singledispatch
def transmission(contact: Contact, s: Jet) -> Transmission:  # noqa: ARG001 - for those that are known
    """How a follower takes the force of its cam.

    Parameters
    ----------
    contact
        The follower, in numbers.
    s
        Its displacement with two derivatives by the cam's angle.
    """
    raise InputError(f"what forces do to a {type(contact).__name__} is not known")


@transmission.register
def _sliding_roller(contact: SlidingRoller, s: Jet) -> Transmission:
    tangent = np.asarray(contact.pressure(s).terms[0])
    cosine = 1.0 / np.sqrt(1.0 + tangent**2)
    along, across = (np.asarray(component.terms[0]) for component in contact.components(s))
    none = 0.0 * cosine
    return Transmission(cosine, _rolling(contact, along, across), none, tangent * cosine * contact.turning, none)


@transmission.register
def _swinging_roller(contact: SwingingRoller, s: Jet) -> Transmission:
    tangent = np.asarray(contact.pressure(s).terms[0])
    lever = contact.arm / np.sqrt(1.0 + tangent**2)
    along, across = (np.asarray(component.terms[0]) for component in contact.components(s))
    none = 0.0 * lever
    return Transmission(lever, _rolling(contact, along, across), none, none, none)


@transmission.register
def _sliding_face(contact: SlidingFace, s: Jet) -> Transmission:
    height = np.abs(np.asarray(contact.point(s)[1].terms[0]))
    aside = np.asarray(contact.point(s)[0].terms[0])
    none = 0.0 * height
    return Transmission(1.0 + none, height, none, none, aside)


@transmission.register
def _swinging_face(contact: SwingingFace, s: Jet) -> Transmission:
    lever = np.abs(np.asarray(contact.reach(s).terms[0]))
    x, y = (np.asarray(coordinate.terms[0]) for coordinate in contact.point(s))
    nx, ny = (np.asarray(coordinate.terms[0]) for coordinate in contact.normal(s))
    rate = np.asarray(s.slope().terms[0])
    sliding = np.abs(contact.turning * (x * nx + y * ny) + rate * contact.offset)
    none = 0.0 * lever
    return Transmission(lever, sliding, none - contact.turning * contact.offset, none, none)


def _rolling(contact: SlidingRoller | SwingingRoller, along: Array, across: Array) -> Array:
    """How fast the roller's surface runs past its centre: the centre's own way, less the cam's turning with it."""
    return np.abs(np.hypot(along, across) - contact.roller)
