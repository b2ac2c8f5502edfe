"""Outlines in closed form."""

from dataclasses import dataclass
from math import pi, tau

import numpy as np
from numpy.typing import NDArray

from tests.internals.cams import Outline
from tests.internals.numerics import Interval, Pair, variable

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Ellipse(Outline):
    """An ellipse around the cam's centre, counterclockwise; half axes in metres."""

    a: float
    b: float
    breaks: tuple[float, ...] = (0.0, tau)

    def __call__(self, angle: Array, nu: int = 0) -> Array:
        turned = np.asarray(angle) + 0.5 * pi * nu
        return np.stack([self.a * np.cos(turned), self.b * np.sin(turned)], axis=-1)

    def jets(self, angle: Array | Interval, order: int) -> Pair:
        sine, cosine = variable(angle, order).waves()
        return cosine * self.a, sine * self.b


@dataclass(frozen=True)
class Bumped(Outline):
    """A circle with a bump height/(1 + ((angle - centre)/width)²) upon it, counterclockwise; metres and radians."""

    radius: float
    height: float
    centre: float
    width: float
    breaks: tuple[float, ...] = (0.0, tau)

    def jets(self, places: Array | Interval, order: int) -> Pair:
        at = variable(places, order)
        away = (at - self.centre) / self.width
        out, (sine, cosine) = self.height / (away * away + 1.0) + self.radius, at.waves()
        return cosine * out, sine * out
