"""How a follower touches a cam, in numbers: kinematics, forces and linear limits, whatever its kind."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from optlaws.cams.curves.extremes import CamExtremes, EnclosedExtreme, angle_of_tangent, enclosed_extremes
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Measured, Number
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import quantity
from optlaws.numbers import NumberOrQuantity
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet, Pair, Term
from optlaws.synthesis.functionals.makers import peak
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.windows import Window

PRESSURE, CURVATURE = "pressure angle", "radius of curvature"


@dataclass(frozen=True)
class LinearLimit:
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
        """The limit as a window of a problem."""
        return Window(self.formula, high=self.most, start=self.start, stop=self.stop)

    def excess(self) -> Functional:
        """The excess of the greatest value of the sum over the limit."""
        return peak(f"{self.formula} + ({-self.most!r})", side="high")


class Drag(NamedTuple):
    """The action on the follower of a friction force of 1 N along the surfaces, the way in which the cam's runs past.

    It drives the follower with `lever` N, or N m; `across` is its sideways part on a slide, N, and `moment` the one
    about where the force meets a slide's way, N m.
    """

    lever: Jet
    across: Jet | float = 0.0
    moment: Jet | float = 0.0


class Transmission(NamedTuple):
    """The action of a force of 1 N between cam and follower, at places of the turn or in intervals of them.

    Along the normal it drives the follower with `lever` N, or N m; `across` is its sideways part on a slide, N, and
    `moment` the one about where the slide's way meets the level of the contact, N m. Surfaces slide, or the roller
    rolls, by `sliding` m per radian of the cam; a roller has no drag, for it gives way.
    """

    lever: Jet
    sliding: Jet
    across: Jet
    moment: Jet
    drag: Drag | None = None

    def lever_with(self, friction: float) -> Jet:
        """The force or torque that drives the follower for a normal force of 1 N, friction of the surfaces included."""
        return self.lever if self.drag is None else self.lever + self.drag.lever * friction


@declared
class Friction(Declared, title="friction"):
    """Friction of a cam and its follower."""

    contact: float = entry(
        Number(least=0.0),
        "The coefficient between a face and the cam, or of a rolling roller with its pin, at its surface.",
        default=0.0,
        label="friction",
        example=0.05,
    )
    guide: float = entry(
        Number(least=0.0), "The coefficient of a slide in its guide.", default=0.0, label="in the guide", example=0.1
    )
    overhang: NumberOrQuantity | None = entry(
        Measured("length", least=0.0), "From where the cam touches to the guide.", default=None, example="80 mm"
    )
    length: NumberOrQuantity | None = entry(
        Measured("length", above=0.0), "Of the guide.", default=None, label="guide length", example="120 mm"
    )

    def _check(self) -> None:
        if self.guide and (self.overhang is None or self.length is None):
            raise InputError("guide is that of a slide, and needs overhang and length of its guide")

    @kept_property
    def _guide(self) -> tuple[float, float]:
        """Overhang and length of the guide, m."""
        overhang, length = self.overhang or "0 m", self.length or "1 m"
        return quantity(overhang, "length", "overhang"), quantity(length, "length", "length")

    def in_guide(self, transmission: Transmission) -> Jet:
        """Friction in the guide, of either sign of the velocity, for a normal force of 1 N."""
        drag = transmission.drag
        across = transmission.across + (0.0 if drag is None else drag.across * self.contact)
        moment = transmission.moment
        if drag is not None and isinstance(drag.moment, Jet):
            moment = moment + drag.moment * self.contact
        overhang, length = self._guide
        near = moment + across * (overhang + length)
        far = moment + across * overhang
        return (near.magnitude() + far.magnitude()) * (self.guide / length)


class ContactState(NamedTuple):
    """The position of a follower that touches a curve, as jets of the curve's own parameter; m and rad.

    `direction` is that of its roller's centre, or of the normal of its face, in its frame, `in_cam` in the cam's.
    """

    displacement: Jet
    direction: Jet
    in_cam: Jet


class CurvatureTerms(NamedTuple):
    """Texts of the velocities of a roller's centre, of the cubed speed times the curvature, and of what s'' takes."""

    along: str
    across: str
    turned: str
    factor: str


@dataclass(frozen=True)
class FollowerContact(ABC):
    """A follower of a cam, in metres and radians, beside which the cam turns; its displacement s comes as a jet.

    `turning` is 1 where the cam turns counterclockwise, else -1. At the prime circle its motion has the displacement
    `lowest`, and it is at a `level`: a height above the cam's centre, or an angle from the line from pivot to centre.
    """

    turning: float
    lowest: float
    level: float
    #: the roller's radius; 0 for a face
    roller: float

    #: how many derivatives of the displacement a point of the profile takes
    lost: ClassVar[int]
    #: whether its linear limits are the limits themselves, and not lines beside them
    linear: ClassVar[bool] = True

    @property
    def pivot(self) -> float | None:
        """The distance of the pivot from the cam's centre; None on a slide."""
        distance: float | None = getattr(self, "distance", None)
        return distance

    @property
    def meets_axis(self) -> bool:
        """Whether it is a roller whose centre slides on a line through the cam's axis."""
        return False

    @abstractmethod
    def point(self, s: Jet) -> Pair:
        """The roller's centre, or where the face touches."""

    @abstractmethod
    def pressure(self, s: Jet) -> Jet:
        """The tangent of the pressure angle, above 0 where the cam pushes the follower along its turning in a rise."""

    @abstractmethod
    def profile_curvature(self, s: Jet) -> Jet:
        """The curvature of the profile, above 0 where it bulges outward."""

    @abstractmethod
    def radius_of_curvature(self, s: Jet) -> Term:
        """The radius of curvature of the profile, above 0 where it bulges outward."""

    @abstractmethod
    def curvature_excess(self, s: Jet, limit: float) -> Interval:
        """The excess over a limit of the least radius of curvature, above 0 where it is broken; of either dimension."""

    def normal(self, s: Jet) -> Pair | None:  # noqa: ARG002 - None unless a face has it
        """The outward normal of a flat face; None where the curve itself gives the normal."""
        return None

    def pressure_angles(self, motion: CamMotion) -> tuple[EnclosedExtreme, EnclosedExtreme]:
        """The least and the greatest pressure angle of a cam, rad."""
        low, high = enclosed_extremes(motion, self.pressure, 1)
        return angle_of_tangent(low), angle_of_tangent(high)

    @abstractmethod
    def least_convex_radius(self, motion: CamMotion) -> EnclosedExtreme:
        """The least radius of curvature of the profile where it bulges, m."""

    @abstractmethod
    def extremes(self, motion: CamMotion) -> CamExtremes:
        """Enclosed extremes over the whole motion."""

    def pitch_curvatures(self, motion: CamMotion) -> tuple[EnclosedExtreme, EnclosedExtreme]:  # noqa: ARG002 - of rollers
        """The least and the greatest curvature of the pitch curve, 1/m."""
        raise InputError("follower: a flat face has no roller: take a TranslatingRoller or an OscillatingRoller")

    @abstractmethod
    def state(self, point: Pair, normal: Pair) -> ContactState:
        """The state of the follower that touches a profile at a point with an outward normal, in cam coordinates."""

    @abstractmethod
    def transmission(self, s: Jet) -> Transmission:
        """Transmission of the cam's force to the follower; s with two derivatives by the cam's angle."""

    def linear_limits(
        self, piece: Piece, limits: Mapping[str, float], angle: float, *, below: bool
    ) -> list[LinearLimit]:
        """Limits of a cam, as `CamLimits.in_si` has them, as linear limits of a law over an angle of the cam in rad.

        Those that are not convex have lines on the side where they hold (`below`) or do not, which touch them where the
        piece's law is; without such lines they are left out.
        """
        pressure, radius = limits.get(PRESSURE), limits.get(CURVATURE)
        lines = [] if pressure is None else self.pressure_limits(piece, pressure, angle, below=below)
        return lines if radius is None else [*lines, *self.radius_limits(piece, radius, angle)]

    def pressure_limits(self, piece: Piece, limit: float, angle: float, *, below: bool) -> list[LinearLimit]:  # noqa: ARG002 - as others
        """The greatest tangent of the pressure angle as linear limits of a law; none unless there are such."""
        return []

    def radius_limits(self, piece: Piece, limit: float, angle: float) -> list[LinearLimit]:  # noqa: ARG002 - as others
        """The least radius of curvature as linear limits of a law; none unless there are such."""
        return []

    def curvature_terms(self, displacement: str, slope: str) -> CurvatureTerms | None:  # noqa: ARG002 - of rollers
        """The curvature of the pitch curve as texts of the displacement above the lowest and of s'; None of a face."""
        return None


def bearing(x: Jet, y: Jet) -> Jet:
    """The direction of a vector, rad.

    >>> turn = bearing(Jet((0.0, -1.0)), Jet((2.0, 0.0)))
    >>> round(float(turn.terms[0]), 6), float(turn.terms[1])
    (1.570796, 0.5)
    """
    first = np.arctan2(y.terms[0], x.terms[0])
    if x.order == 0:
        return Jet((first,))
    rates = ((x * y.slope() - y * x.slope()) / (x * x + y * y)).terms
    return Jet((first, *(rate / (i + 1) for i, rate in enumerate(rates))))


def shifted(point: Pair, normal: Pair, distance: float) -> Pair:
    """A point moved along a normal."""
    return point[0] + normal[0] * distance, point[1] + normal[1] * distance


def other_leg(sine: Jet) -> Jet:
    """The cosine of an acute angle whose sine is known, or the reverse."""
    return (sine * sine * -1.0 + 1.0).root()
