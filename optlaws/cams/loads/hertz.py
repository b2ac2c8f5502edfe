"""Pressure where a cam touches its follower along a line, by Hertz."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.motion.quantities import quantity
from optlaws.numbers import finite
from optlaws.series.enclosures.interval_arrays import highest
from optlaws.series.enclosures.jets import Jet
from optlaws.suggest import unknown_key

Array = NDArray[np.float64]

#: Young's modulus and Poisson's ratio within the ranges of J. M. Gere, Mechanics of Materials, 5th edition, appendix H
#: (steel 190 to 210 GPa and 0.27 to 0.30, cast iron 83 to 170 and 0.2 to 0.3, bronze 96 to 120 and 0.34, aluminium
#: 6061-T6 70 and 0.33); 210 GPa and 0.30 are those of EN 1993-1-1. One's own is a mapping with "young" and "poisson".
MATERIALS = {
    "steel": ("210 GPa", 0.30),
    "cast iron": ("110 GPa", 0.26),
    "bronze": ("110 GPa", 0.34),
    "aluminium": ("70 GPa", 0.33),
}
_ENTRIES = ("young", "poisson")


@dataclass(frozen=True)
class LineContact:
    """A contact along a line: p = sqrt(N E / (pi width R)) with 1/E the sum of (1 - nu²)/E of both bodies.

    Attributes
    ----------
    width
        Of the line, m.
    modulus
        E of both together, Pa.
    roller_curvature
        Of the follower, 1/m; 0 of a face.

    Examples
    --------
    >>> contact = line_contact("20 mm", ("steel", "steel"), roller=0.012)
    >>> round(float(contact.pressure(np.array(1000.0), np.array(0.08))) / 1e6, 3)
    419.51
    """

    width: float
    modulus: float
    roller_curvature: float

    def pressure(self, force: Array, radius: Array) -> Array:
        """Greatest pressure under a force in N, where the cam has a radius of curvature in m; Pa.

        0 where nothing is pressed. The radius is below 0 where the cam is hollow.

        Raises
        ------
        InputError
            If a hollow of the cam is narrower than the roller.
        """
        with np.errstate(divide="ignore"):
            squared = self.squared(Jet((np.asarray(force),)), Jet((1.0 / np.asarray(radius),)))
        return np.asarray(np.sqrt(np.maximum(squared.terms[0], 0.0)))

    def squared(self, force: Jet, curvature: Jet) -> Jet:
        """The square of it where the cam has a curvature: smooth where the follower lifts off, and below 0 beyond.

        Raises
        ------
        InputError
            As for `pressure`.
        """
        both = curvature + self.roller_curvature
        if np.any(highest(both.terms[0]) < 0.0):
            raise InputError("the cam is hollow where a flat face or a roller that is wider would touch it elsewhere")
        return force * both * (self.modulus / (pi * self.width))


def line_contact(width: Any, materials: Any, roller: float) -> LineContact:  # noqa: ANN401 - they are checked here
    """A contact from its width, the materials of cam and follower, and the follower's radius in m (0 for a face).

    A material is one of `MATERIALS`, whose values are those of a handbook, or {"young": "3 GPa", "poisson": 0.4} from a
    data sheet.

    Raises
    ------
    InputError
        If the width is no length above 0, or a material is not known.

    Examples
    --------
    >>> line_contact("20 mm", ("steel", {"young": "3 GPa", "poisson": 0.4}), 0.012).width
    0.02
    """
    length = quantity(width, "length", "width")
    if length <= 0.0:
        raise InputError(f"width must be above 0, got {shortened(width)}")
    if not isinstance(materials, tuple | list) or len(materials) != 2:
        raise InputError(f"materials must be two, of the cam and of the follower, got {shortened(materials)}")
    yielding = sum((1.0 - poisson**2) / young for young, poisson in map(_material, materials))
    return LineContact(length, 1.0 / yielding, 1.0 / roller if roller else 0.0)


def _material(given: Any) -> tuple[float, float]:  # noqa: ANN401
    """Young's modulus in Pa, and Poisson's ratio."""
    if isinstance(given, str):
        if given not in MATERIALS:
            raise InputError(
                f"{unknown_key(given, MATERIALS, 'material')}; one of your own is {{'young': '3 GPa', 'poisson': 0.4}}"
            )
        young, poisson = MATERIALS[given]
    elif isinstance(given, Mapping) and set(given) == set(_ENTRIES):
        young, poisson = given["young"], finite(given["poisson"], "poisson")
    else:
        raise InputError(f"a material is a name or has 'young' and 'poisson', got {shortened(given)}")
    modulus = quantity(young, "pressure", "young")
    if modulus <= 0.0 or not -1.0 < poisson < 0.5 + 1e-12:
        raise InputError(f"young must be above 0 and poisson between -1 and 0.5, got {shortened(given)}")
    return modulus, poisson
