"""What a follower does on a curve that is there: its displacement by the cam's angle, with derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from functools import singledispatch
from math import factorial, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.curves.jets import Jet, Pair
from optlaws.cams.curves.plane_curve import PlaneCurve
from optlaws.cams.cutting.outline import Outline
from optlaws.cams.followers.contact import Contact, FaceContact
from optlaws.cams.followers.oscillating_flat import SwingingFace
from optlaws.cams.followers.oscillating_roller import SwingingRoller
from optlaws.cams.followers.translating_flat import SlidingFace
from optlaws.cams.followers.translating_roller import SlidingRoller
from optlaws.errors import InputError
from optlaws.kept import kept_property

Array = NDArray[np.float64]

_SAMPLES = 721


class Touched(NamedTuple):
    """Where a follower is, as jets of the curve's own parameter: displacement, and direction in its own frame."""

    displacement: Jet
    direction: Jet


@dataclass(frozen=True)
class Following:
    """A follower on a closed curve, at any place of it: the cam's angle there, and the displacement.

    The follower is taken to touch the curve at one place, as it does where the curve bulges outward or its hollows are
    wider than the roller.

    Parameters
    ----------
    contact
        The follower, in numbers.
    curve
        The cam's profile as it is made, m; any parameter.
    phase
        By how much the cam's coordinates are turned, rad.
    outside
        How far outside of the profile the curve is, m: the radius of a cutter whose path it is.

    Examples
    --------
    >>> from optlaws.cams.disc import DiscCam
    >>> from optlaws.cams.followers.translating_roller import TranslatingRoller
    >>> from optlaws.cams.curves.motion_by_angle import CamMotion
    >>> motion = CamMotion.of_law("cycloidal", "40 mm", "360 deg")
    >>> cam = DiscCam(motion, base_radius="80 mm", follower=TranslatingRoller("12 mm"))
    >>> following = Following(cam.contact, cam.profile)
    >>> angle, displacement = (float(value) for value in following.at(np.array(1.0), 0))
    >>> round(angle, 12), round(displacement - cam.displacement(1.0), 12) + 0.0
    (1.0, 0.0)
    """

    contact: Contact
    curve: Outline
    phase: float = 0.0
    outside: float = 0.0

    @kept_property
    def outward(self) -> float:
        """1 where the curve runs counterclockwise, so that outward is to its right, else -1."""
        places = np.linspace(self.curve.breaks[0], self.curve.breaks[-1], _SAMPLES)
        x, y = self.curve(places).T
        area = float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
        if area == 0.0:
            raise InputError("the curve encloses nothing: no follower runs on it")
        return 1.0 if area > 0.0 else -1.0

    def at(self, places: Array, nu: int) -> tuple[Array, Array]:
        """The cam's angle at places of the curve, rad, and the derivative of order nu of the displacement by it."""
        angle, displacement = self.jets(places, nu)
        derivative = displacement
        for _ in range(nu):
            derivative = derivative.slope() / angle.slope().cut(derivative.order - 1)
        return np.asarray(angle.terms[0]), np.asarray(derivative.terms[0])

    def jets(self, places: Array, order: int) -> tuple[Jet, Jet]:
        """The cam's angle and the displacement, by the curve's parameter."""
        point = self._point(places, order + 1)
        slopes = (point[0].slope(), point[1].slope())
        length = (slopes[0] * slopes[0] + slopes[1] * slopes[1]).root()
        normal = (slopes[1] / length * self.outward, slopes[0] / length * -self.outward)
        profile = _moved((point[0].cut(order), point[1].cut(order)), normal, -self.outside)
        touched = read(self.contact, profile, normal)
        # what of the cam lies in the follower's direction: the normal of the face, or the roller's centre
        faced = isinstance(self.contact, FaceContact)
        seen = normal if faced else _moved(profile, normal, self.contact.roller)
        return (touched.direction + self.phase - bearing(*seen)) * self.contact.turning, touched.displacement

    def _point(self, places: Array, order: int) -> Pair:
        if isinstance(self.curve, PlaneCurve):
            return self.curve.jets(places, order)
        values = [self.curve(places, nu) / factorial(nu) for nu in range(order + 1)]
        return Jet(tuple(value[..., 0] for value in values)), Jet(tuple(value[..., 1] for value in values))


def bearing(x: Jet, y: Jet) -> Jet:
    """The direction of a vector, rad.

    Examples
    --------
    >>> turn = bearing(Jet((0.0, -1.0)), Jet((2.0, 0.0)))
    >>> round(float(turn.terms[0]), 6), float(turn.terms[1])
    (1.570796, 0.5)
    """
    first = np.arctan2(y.terms[0], x.terms[0])
    if x.order == 0:
        return Jet((first,))
    rates = ((x * y.slope() - y * x.slope()) / (x * x + y * y)).terms
    return Jet((first, *(rate / (i + 1) for i, rate in enumerate(rates))))


@singledispatch
def read(contact: Contact, point: Pair, normal: Pair) -> Touched:  # noqa: ARG001 - for those that are known
    """Where a follower is that touches a profile at a point with a normal away from it."""
    raise InputError(f"what a {type(contact).__name__} does on a curve is not known")


@read.register
def _sliding_roller(contact: SlidingRoller, point: Pair, normal: Pair) -> Touched:
    square = _square(contact.roller, point, normal)
    height = (square - contact.offset**2).root()
    displacement = height + (contact.lowest - contact.height)
    return Touched(displacement, bearing(*contact.point(displacement)))


@read.register
def _swinging_roller(contact: SwingingRoller, point: Pair, normal: Pair) -> Touched:
    square = _square(contact.roller, point, normal)
    cosine = (square - (contact.distance**2 + contact.arm**2)) / (-2.0 * contact.distance * contact.arm)
    psi = (cosine / _other(cosine)).arctangent() * -1.0 + 0.5 * pi
    displacement = psi + (contact.lowest - contact.first)
    return Touched(displacement, bearing(*contact.point(displacement)))


@read.register
def _sliding_face(contact: SlidingFace, point: Pair, normal: Pair) -> Touched:
    height = point[0] * normal[0] + point[1] * normal[1]
    return Touched(height + (contact.lowest - contact.height), height * 0.0 + 0.5 * pi)


@read.register
def _swinging_face(contact: SwingingFace, point: Pair, normal: Pair) -> Touched:
    sine = (point[0] * normal[0] + point[1] * normal[1] - contact.offset) / contact.distance
    phi = (sine / _other(sine)).arctangent()
    return Touched(phi + (contact.lowest - contact.first), phi * -1.0 + 0.5 * pi)


def _other(sine: Jet) -> Jet:
    """The cosine of an angle within a right one whose sine is known, or the other way around."""
    return (sine * sine * -1.0 + 1.0).root()


def _square(roller: float, point: Pair, normal: Pair) -> Jet:
    """How far the roller's centre is from the cam's, squared."""
    x, y = _moved(point, normal, roller)
    return x * x + y * y


def _moved(point: Pair, normal: Pair, distance: float) -> Pair:
    return point[0] + normal[0] * distance, point[1] + normal[1] * distance
