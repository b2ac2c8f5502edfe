"""Outlines in closed form."""

from dataclasses import dataclass
from math import pi, tau

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Ellipse:
    """An ellipse around the cam's centre, counterclockwise; half axes in metres."""

    a: float
    b: float
    breaks: tuple[float, ...] = (0.0, tau)

    def __call__(self, angle: Array, nu: int = 0) -> Array:
        turned = np.asarray(angle) + 0.5 * pi * nu
        return np.stack([self.a * np.cos(turned), self.b * np.sin(turned)], axis=-1)
