"""Outlines of closed curves to be cut, and their division, finer where they bend more."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import ceil, tau
from typing import Any, Protocol

import numpy as np

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics.branch_and_bound import extremes
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet, Pair

_SMALLEST_SPEED = 1e-9  # of a place on an outline, so that shares of it can be taken
_OUTLINE_SHARE = 1e-3  # no part of an outline is left without places, however straight it is

Density = Callable[[Array], Array]

MOST_PARTS = 200_000
_SAMPLES = 1025


class Outline(Protocol):
    """A closed plane curve over the cam's angle.

    Called with angles in radians, shape (...), and the order of the derivative, it gives metres (per radian to that
    order), shape (..., 2). Between `breaks`, angles that increase from 0 to 2 pi, it is smooth. In intervals of angles
    `jets` encloses it: statements on deviations rest on that.
    """

    @property
    def breaks(self) -> tuple[float, ...]:
        """Angles between which it is smooth, from 0 to 2 pi."""

    def __call__(self, angle: Array, /, nu: int = 0) -> Array:
        """Points, or derivatives by the angle."""

    def jets(self, angle: Array | Interval, order: int, /) -> Pair:
        """Both coordinates with their Taylor terms, at places or in intervals of places between breaks."""


def stretches(outline: Outline) -> list[tuple[float, float]]:
    """The smooth stretches of an outline, in radians."""
    breaks = [float(place) for place in outline.breaks]
    if len(breaks) < 2 or abs(breaks[0]) > 1e-12 or abs(breaks[-1] - tau) > 1e-9:
        raise InputError("only a closed outline can be cut: its breaks must run from 0 to a whole turn")
    return list(pairwise(breaks))


def divided(outline: Outline, density: Density, factor: float = 1.0) -> Array:
    """Angles from 0 to a whole turn, the breaks among them, at a multiple of a density in parts per radian."""
    shares = [_accumulated(density, *ends) for ends in stretches(outline)]
    parts = factor * sum(float(sums[-1]) for _, sums in shares)
    if parts > MOST_PARTS:
        raise InputError(f"tolerance requires {parts:.3g} parts, more than {MOST_PARTS}: give a wider one")
    cuts = [np.zeros(1)]
    for places, sums in shares:
        count = max(1, ceil(factor * float(sums[-1])))
        cuts.append(np.interp(np.linspace(0.0, float(sums[-1]), count + 1)[1:], sums, places))
    return np.concatenate(cuts)


def _accumulated(density: Density, start: float, stop: float) -> tuple[Array, Array]:
    """Places on a stretch, and the density integrated up to them."""
    places = np.linspace(start, stop, _SAMPLES)
    values = density(0.5 * (places[1:] + places[:-1]))
    values = values + _OUTLINE_SHARE * max(float(values.max()), _SMALLEST_SPEED)
    return places, np.append(0.0, np.cumsum(values)) * (stop - start) / (_SAMPLES - 1)


def curvature(outline: Outline, angles: Array) -> Array:
    """Signed curvature, 1/m: positive where the outline turns left as the angle grows."""
    first, second = outline(angles, 1), outline(angles, 2)
    speed = np.hypot(first[..., 0], first[..., 1])
    return np.asarray((first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]) / speed**3)


def speed(outline: Outline, angles: Array) -> Array:
    """Metres per radian along the outline."""
    first = outline(angles, 1)
    return np.hypot(first[..., 0], first[..., 1])


def greatest_deviation(
    off: Callable[[Any, int], Jet], places: Array, tolerance: float, *, share: float, order: int = 2
) -> float:
    """The greatest magnitude of a deviation between places where it is smooth, as `extremes` proves it.

    Where it is above a tolerance, it is one that the deviation has.
    """
    met = float(np.abs(off(0.5 * (places[1:] + places[:-1]), 0).terms[0]).max())
    if met > tolerance:
        return met
    known = extremes(off, places, share=share, order=order, enough=tolerance, magnitude=True)
    return known.peak if known.peak > tolerance else known.bound
