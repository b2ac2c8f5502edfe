"""Constants of the cam law of a mass law, so that the mass law can be chosen for the cam's sake.

The cam law a + 2 n b/nu² + c/nu² (1.27) is affine in the mass law, hence its peaks are convex in it.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.mechanisms.polydyne_cam import cam_factors, polydyne
from optlaws.numbers import not_negative, positive
from optlaws.numerics import chebyshev
from optlaws.synthesis.problem.combined import CombinedPeak, CombinedPower
from optlaws.synthesis.problem.constants import FUNCTIONALS, MAKERS, Functional
from optlaws.synthesis.spaces.space import LawSpace

_BASES = {"B": 1, "C": 2, "C_plus": 2, "C_minus": 2, "D": 1, "J": 3}
_SIGNS = {"C_plus": (1.0,), "C_minus": (-1.0,)}
_ORDER, _JERK_ORDER = 4, 5


@dataclass(frozen=True, repr=False)
class CamPeak(CombinedPeak):
    """Peak of a derivative of the cam law; constructed by `cam_constant`."""

    frequency: float = 1.0
    damping: float = 0.0

    def value(self, law: MotionLaw) -> float:
        """The peak over the whole rise of the cam."""
        lowest, highest = cam_law(law, self.frequency, self.damping).extrema(self.nu)
        return max(sign * extreme.value for sign in self.signs for extreme in (lowest, highest))

    def check(self, space: LawSpace) -> None:
        """Refuse laws whose cam would jump in velocity, or in acceleration where its jerk counts."""
        check_order(self.name, space, _JERK_ORDER if self.nu == _BASES["J"] else _ORDER)

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """The mass's derivative is the response to the cam's, which is at most `gain` times as much in the mean."""
        sides = 2.0 if len(self.signs) == 1 else 1.0
        return ((self.nu, sides * gain(self.frequency, self.damping)),)


@dataclass(frozen=True, repr=False)
class CamPower(CombinedPower):
    """Peak of the power b c of the cam law; constructed by `cam_constant`."""

    frequency: float = 1.0
    damping: float = 0.0

    def value(self, law: MotionLaw) -> float:
        """The peak over the whole rise of the cam."""
        return cam_law(law, self.frequency, self.damping).power_peak().value

    def check(self, space: LawSpace) -> None:
        """Refuse laws whose cam would jump in velocity."""
        check_order(self.name, space, _ORDER)

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """A bound of the velocity: from rest to rest b of the cam is at most the root of 2 D k and of 2 D (1-k)."""
        return ((1, gain(self.frequency, self.damping)),)


def cam_constant(name: str, *, frequency: float, damping: float = 0.0) -> Functional:
    """A constant of the cam law with which an elastic follower's mass executes the sought law.

    Parameters
    ----------
    name
        "B", "C", "C_plus", "C_minus", "D" or "J": which constant of the cam.
    frequency
        Frequency nu at which the cam is to run.
    damping
        Ratio zeta = n/nu.

    Raises
    ------
    InputError
        If the name is unknown or a number out of range.

    Examples
    --------
    >>> from optlaws import savin
    >>> C_cam = cam_constant("C", frequency=20, damping=0.05)
    >>> C_cam, round(C_cam.value(savin("III", 7.2)), 6)
    (C_cam(frequency=20.0, damping=0.05), 5.755781)
    """
    check_names([name], _BASES, "constant of the cam")
    frequency, ratio = positive(frequency, "frequency"), not_negative(damping, "damping")
    written = f"{name}_cam(frequency={frequency!r}{f', damping={ratio!r}' if ratio else ''})"
    weights = (Fraction(1), *cam_factors(frequency, ratio))
    known = FUNCTIONALS[name]
    if name == "D":
        return CamPower(written, known.reference, convex=False, weights=weights, frequency=frequency, damping=ratio)
    return CamPeak(
        written,
        known.reference,
        convex=True,
        nu=_BASES[name],
        weights=weights,
        signs=_SIGNS.get(name, (1.0, -1.0)),
        frequency=frequency,
        damping=ratio,
    )


def cam_law(law: MotionLaw, frequency: float, damping: float) -> MotionLaw:
    """The law of `polydyne`, computed quickly and without checks for a polynomial, whose ends the problem checks."""
    if not isinstance(law, PolynomialLaw):
        return polydyne(law, frequency, damping)
    once, twice = map(float, cam_factors(frequency, damping))
    series = np.array(law.acceleration or (0.0,))
    slope = chebyshev.derivative(series)
    series[: len(slope)] += once * slope
    slope = chebyshev.derivative(slope)
    series[: len(slope)] += twice * slope
    return PolynomialLaw(series, a0=law.a0, b0=law.b0)


def gain(frequency: float, damping: float) -> float:
    """The greatest mean of |c| of the mass, in units of the mean of |c| of its cam.

    It is nu² times the integral over the rise of the magnitude of the response to an impulse, which is at most k,
    and exp(-n k)/lambda below critical damping; from critical damping on it has no zero and the whole is at most 1.

    >>> gain(20.0, 0.0), gain(0.5, 0.0), gain(20.0, 1.0)
    (20.0, 0.125, 1.0)
    """
    greatest = 0.5 * frequency**2
    return min(greatest, frequency / sqrt(1.0 - damping**2) if damping < 1.0 else 1.0)


def check_order(name: str, space: LawSpace, order: int) -> None:
    """Refuse laws that do not begin and end smoothly enough for a cam."""
    boundary = space.boundary
    jump = "acceleration" if order > _ORDER else "velocity"
    if boundary.order < order:
        raise InputError(
            f"{name} needs mass laws of order {order} at least, whose cam's {jump} does not jump at the ends; "
            f"the problem has order {boundary.order}"
        )
    if any(boundary.start[1:order]) or any(boundary.end[1:order]):
        raise InputError(
            f"{name} needs mass laws from rest to rest, derivatives 1 to {order - 1} zero at both ends, "
            f"got {shortened(boundary)}"
        )
    continuity = getattr(space, "continuity", order)
    if continuity < order - 1:
        raise InputError(
            f"{name} needs mass laws whose derivatives up to {order - 1} are continuous at the breaks, so that its "
            f"cam's {jump} does not jump; give a continuity of at least {order - 1}, got {continuity}"
        )


def _maker(name: str) -> Any:
    def make(*, frequency: float, damping: float = 0.0) -> Functional:
        return cam_constant(name, frequency=frequency, damping=damping)

    return make


for _name in _BASES:
    MAKERS.setdefault(f"{_name}_cam", _maker(_name))
