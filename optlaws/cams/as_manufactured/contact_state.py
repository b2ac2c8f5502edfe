"""What a follower does on a curve that is there: its displacement by the cam's angle, with derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.cutting.outline import Outline
from optlaws.cams.followers.contact import Contact, shifted
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.series.enclosures.interval_arrays import Interval
from optlaws.series.enclosures.jets import Jet

Array = NDArray[np.float64]

_SAMPLES = 721


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
        angle, derivative = self.derivative(places, nu, 0)
        return np.asarray(angle.terms[0]), np.asarray(derivative.terms[0])

    def derivative(self, places: Array | Interval, nu: int, order: int) -> tuple[Jet, Jet]:
        """The cam's angle and the derivative of order nu by it, both with Taylor terms by the curve's parameter."""
        angle, derivative = self.jets(places, nu + order)
        pace = angle.slope()
        for _ in range(nu):
            derivative = derivative.slope() / pace
        return angle, derivative

    def jets(self, places: Array | Interval, order: int) -> tuple[Jet, Jet]:
        """The cam's angle and the displacement, by the curve's parameter."""
        point = self.curve.jets(places, order + 1)
        slopes = (point[0].slope(), point[1].slope())
        length = (slopes[0] * slopes[0] + slopes[1] * slopes[1]).root()
        normal = (slopes[1] / length * self.outward, slopes[0] / length * -self.outward)
        profile = shifted((point[0].cut(order), point[1].cut(order)), normal, -self.outside)
        state = self.contact.state(profile, normal)
        return (state.direction + self.phase - state.in_cam) * self.contact.turning, state.displacement
