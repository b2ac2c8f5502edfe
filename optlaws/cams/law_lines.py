"""Limits of a cam as lines in its law: pressure angles of slides and arms, radii of curvature under flat faces."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import hypot

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.followers.contact import Contact
from optlaws.cams.followers.oscillating_roller import SwingingRoller
from optlaws.cams.followers.translating_flat import SlidingFace
from optlaws.cams.followers.translating_roller import SlidingRoller
from optlaws.cams.least_sizes import CURVATURE, PRESSURE
from optlaws.cycles.asked.conversion import Piece
from optlaws.cycles.asked.programme import TURN
from optlaws.synthesis.functionals.makers import peak
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.windows import Window

Array = NDArray[np.float64]

_LINES, _PARTS, _LOOKS = 16, 24, 2001


@dataclass(frozen=True)
class Wall:
    """A limit of a cam that is linear in a law: the sum of factors times a, b, c is at most `most` in a part of it."""

    factors: tuple[float, float, float]
    most: float
    start: float = 0.0
    stop: float = 1.0

    @property
    def formula(self) -> str:
        """The sum as a text."""
        return " + ".join(f"({factor!r})*{name}" for factor, name in zip(self.factors, "abc", strict=True) if factor)

    def window(self) -> Window:
        """It as a window of a problem."""
        return Window(self.formula, high=self.most, start=self.start, stop=self.stop)

    def needed(self) -> Functional:
        """By how much the greatest value of the sum goes beyond it."""
        return peak(f"{self.formula} + ({-self.most!r})", side="high")


def walls_of(piece: Piece, contact: Contact, limits: dict[str, float], period: float, *, below: bool) -> list[Wall]:
    """What the limits of a cam ask of a piece's law.

    Parameters
    ----------
    piece
        With its displacement; its law guides where lines touch limits that are not convex.
    contact
        The follower, in numbers.
    limits
        As `read_cam_limits` gives them; those that are not convex and have no lines are left out.
    period
        Of a turn, in the unit of the piece's duration.
    below
        Whether lines are on the side where the limits are kept, or where they are broken.
    """
    angle, stroke = TURN * piece.duration / period, piece.stroke
    size = abs(stroke)
    walls: list[Wall] = []
    if stroke == 0.0:
        return walls
    if isinstance(contact, SlidingRoller) and PRESSURE in limits:
        high = (contact.height - contact.lowest + piece.offset) / size
        offset = contact.turning * contact.offset / (limits[PRESSURE] * size)
        for sign in (1.0, -1.0):
            slope = sign * stroke / (angle * limits[PRESSURE] * size)
            walls.append(Wall((-stroke / size, slope, 0.0), high + sign * offset))
    if isinstance(contact, SlidingFace) and CURVATURE in limits:
        high = (contact.height - contact.lowest + piece.offset - limits[CURVATURE]) / size
        walls.append(Wall((-stroke / size, 0.0, -stroke / (size * angle**2)), high))
    if isinstance(contact, SwingingRoller) and PRESSURE in limits:
        for sign in (1.0, -1.0):
            walls += _arm_walls(piece, contact, limits[PRESSURE], angle, sign=sign, below=below)
    return walls


def _arm_walls(
    piece: Piece, contact: SwingingRoller, limit: float, angle: float, *, sign: float, below: bool
) -> list[Wall]:
    """Lines below or above what an arm's pressure angle allows, sign s' <= G(psi), over the piece's swing.

    Where G is hollow its chords are as good as it is. Where it bulges, a line below it is good at one psi, and there is
    one for every part of the time, at the psi that the piece's law has then; a single one is above it.
    """
    start, size = contact.first - contact.lowest + piece.offset, abs(piece.stroke)
    sine = _Sine(limit * contact.distance / contact.arm, sign * contact.turning * contact.distance / contact.arm)
    low, high = sorted((start, start + piece.stroke))
    times = np.linspace(0.0, 1.0, _PARTS + 1).tolist()
    if sine.hollow(low, high):
        lines = [(*line, 0.0, 1.0) for line in sine.chords(low, high, below=below)]
    elif below:
        psi = [start + piece.stroke * float(piece.law.a(0.5 * sum(pair))) for pair in pairwise(times)]
        slopes = [sine.slope(at) for at in psi]
        shifts = [sine.shift(slope, low, high, below=True) for slope in slopes]
        lines = list(zip(slopes, shifts, times, times[1:], strict=False))
    else:
        slope = sine.chord(low, high)
        lines = [(slope, sine.shift(slope, low, high, below=False), 0.0, 1.0)]
    walls = []
    for slope, shift, first, last in lines:
        # sign stroke b / angle - slope stroke a <= slope start + shift - sign turning
        factors = (-slope * piece.stroke / size, sign * piece.stroke / (angle * size), 0.0)
        walls.append(Wall(factors, (slope * start + shift - sign * contact.turning) / size, first, last))
    return walls


@dataclass(frozen=True)
class _Sine:
    """G = sine sin psi + cosine cos psi."""

    sine: float
    cosine: float

    def value(self, psi: Array) -> Array:
        """G."""
        return np.asarray(self.sine * np.sin(psi) + self.cosine * np.cos(psi))

    def slope(self, psi: float) -> float:
        """G'."""
        return float(self.sine * np.cos(psi) - self.cosine * np.sin(psi))

    def chord(self, first: float, last: float) -> float:
        """The slope of a chord."""
        ends = self.value(np.array([first, last]))
        return float((ends[1] - ends[0]) / (last - first))

    def hollow(self, low: float, high: float) -> bool:
        """Whether it lies above its chords between two angles less than half a turn apart."""
        return bool((self.value(np.linspace(low, high, _LOOKS)) >= 0.0).all())

    def shift(self, slope: float, low: float, high: float, *, below: bool) -> float:
        """What makes a line of a slope lie below it, or above it, between two angles."""
        looks = np.linspace(low, high, _LOOKS)
        off = self.value(looks) - slope * looks
        # between two looks it goes beyond these by less than this
        slack = hypot(self.sine, self.cosine) * float(looks[1] - looks[0]) ** 2
        return float(off.min()) - slack if below else float(off.max()) + slack

    def chords(self, low: float, high: float, *, below: bool) -> list[tuple[float, float]]:
        """Slopes and shifts of lines of which the least is near it where it is hollow, on one side of it."""
        lines = []
        for first, last in pairwise(np.linspace(low, high, _LINES + 1).tolist()):
            slope = self.chord(first, last)
            under = float(self.value(np.array(first))) - slope * first
            lines.append((slope, under if below else self.shift(slope, low, high, below=False)))
        return lines
