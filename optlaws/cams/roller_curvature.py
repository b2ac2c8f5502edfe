"""The least radius of curvature of a roller's profile as a limit of a law.

The pitch curve bends by no more than 1/rho where s'' >= G(s, s'), which is not convex in the law.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, cos, pi, sin, sqrt

import numpy as np

from optlaws.cams.followers.contact import FollowerContact
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.reading import read
from optlaws.formulas.tree import Formula
from optlaws.kept import kept_property
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import TURN
from optlaws.numerics.taylor import Jet
from optlaws.synthesis.problem.windows import Window

_PLACES = 1001
_SLACK = 1e-9  # of a bound: what is broken by less is kept


@dataclass(frozen=True)
class RollerCurvature:
    """A greatest curvature of a roller's pitch curve as a limit of one piece's law: G(a, b) - c s''(1) <= 0.

    `radius` is the least radius of curvature of the pitch curve where it bulges, m; `period` is of a turn, in the unit
    of the piece's duration.
    """

    piece: Piece
    contact: FollowerContact
    radius: float
    period: float

    @property
    def _slope(self) -> float:
        """The derivative s' where b is 1."""
        return self.piece.stroke * self.period / (TURN * self.piece.duration)

    @property
    def factor(self) -> float:
        """The derivative s'' where c is 1, in strokes as G is."""
        return float(np.sign(self.piece.stroke)) * (self.period / (TURN * self.piece.duration)) ** 2

    @kept_property
    def least(self) -> str:
        """G as a text in a and b, in strokes."""
        slope = f"({self._slope!r}*b)"
        moved = f"({self.piece.offset - self.contact.lowest!r} + ({self.piece.stroke!r})*a)"
        terms = self.contact.curvature_terms(moved, slope)
        assert terms is not None  # noqa: S101 - it has a roller
        along, across, turned, factor = terms
        square = f"({along}^2 + {across}^2)"
        return f"({turned} - {square}^1.5/{self.radius!r})/({factor}*{abs(self.piece.stroke)!r})"

    def window(self) -> Window:
        """The limit as a window of a problem that is not convex."""
        return Window(f"{self.least} - ({self.factor!r})*c", high=0.0)

    def broken(self) -> bool:
        """Whether the piece's law breaks it somewhere on a grid."""
        k = np.linspace(0.0, 1.0, _PLACES)
        a, b, c = (np.asarray(quantity(k)) for quantity in (self.piece.law.a, self.piece.law.b, self.piece.law.c))
        needed = np.asarray(evaluate(self._formula, {"a": a, "b": b}, NUMPY))
        return bool((needed > self.factor * c + _SLACK).any())

    def at_rest(self) -> float | None:
        """The radius of the pitch curve, m, at an end where the follower rests, if it is too small for any law."""
        for k in (0.0, 1.0):
            law = self.piece.law
            if abs(float(law.b(k))) + abs(float(law.c(k))) > _SLACK:
                continue
            s = self.piece.offset + self.piece.stroke * float(law.a(k))
            radius = float(self.contact.radius_of_curvature(Jet((np.array(s), 0.0, 0.0)))) + self.contact.roller
            if 0.0 < radius * (1.0 + _SLACK) < self.radius:
                return radius
        return None

    def is_out_of_reach(self) -> bool:
        """Whether no path that bends so little reaches the piece's nearer end from rest at the farther one.

        With r from the centre and p that of the tangent, dp/dr is r times the curvature: back from the rest, where p is
        r, no path between the ends falls faster over the angle than the circle of the least radius that touches there.
        Known of a slide whose way meets the cam's axis, whose pitch curve runs around it with the cam's angle.
        """
        piece, contact, radius = self.piece, self.contact, self.radius
        angle, rest = TURN * piece.duration / self.period, 1.0 if piece.stroke > 0.0 else 0.0
        if not contact.meets_axis or angle >= pi or abs(float(piece.law.b(rest))) > _SLACK:
            return False
        shift = contact.level - contact.lowest + piece.offset
        near, far = sorted(shift + piece.stroke * float(piece.law.a(k)) for k in (0.0, 1.0))
        centre = far - radius
        if centre <= 0.0 or (centre > radius and angle >= asin(radius / centre)):
            return False
        reached = centre * cos(angle) + sqrt(radius**2 - (centre * sin(angle)) ** 2)
        return reached > near * (1.0 + _SLACK)

    @kept_property
    def _formula(self) -> Formula:
        return read(self.least)


def curvature_of(piece: Piece, contact: FollowerContact, least: float, period: float) -> RollerCurvature | None:
    """The limit of a piece's law where the profile is to have a least radius of curvature in m; None under a face."""
    if not contact.roller or piece.stroke == 0.0:
        return None
    return RollerCurvature(piece, contact, least + contact.roller, period)
