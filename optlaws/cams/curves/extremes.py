"""Extremes of a cam over its whole motion: pressure angles, radii of curvature and undercut, all proven."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import atan, inf, nextafter
from typing import Literal, TypeAlias

from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.motion.quantities import in_degrees
from optlaws.numerics.branch_and_bound import extremes
from optlaws.numerics.peaks import is_kept
from optlaws.numerics.taylor import Jet
from optlaws.sentences import Amount, sentence
from optlaws.tolerances import CAM_FEASIBILITY, EQUAL_EXTREMES, ROUNDOFF

_CAM_EXTREMES = 1e-10  # pressure angles and radii of curvature

#: of the displacement's jet; shorter than it by as many orders as the function takes derivatives
Function: TypeAlias = Callable[[Jet], Jet]

_PARTS = 12

UndercutStatus = Literal["free", "undercut", "undecided"]
FREE: UndercutStatus = "free"
UNDERCUT: UndercutStatus = "undercut"
UNDECIDED: UndercutStatus = "undecided"


@dataclass(frozen=True)
class EnclosedExtreme:
    """An extreme value, between `low` and `high`, and an angle in rad at which it is reached to within these.

    Examples
    --------
    >>> EnclosedExtreme(0.999999, 1.000001, 0.5).value
    1.0
    """

    low: float
    high: float
    angle: float

    @property
    def value(self) -> float:
        """The middle of the enclosure."""
        return 0.5 * (self.low + self.high)

    def __neg__(self) -> EnclosedExtreme:
        return EnclosedExtreme(-self.high, -self.low, self.angle)


def enclosed_extremes(
    motion: CamMotion, function: Function, lost: int, tolerance: float = _CAM_EXTREMES
) -> tuple[EnclosedExtreme, EnclosedExtreme]:
    """The least and the greatest value of a function of a motion's jet, which is shorter than that by `lost` orders."""
    known = extremes(
        lambda angle, order: function(motion.jet(angle, order + lost)), motion.breaks, share=tolerance, parts=_PARTS
    )
    return EnclosedExtreme(known.low, known.least, known.least_at), EnclosedExtreme(
        known.most, known.high, known.most_at
    )


def first_least(*known: EnclosedExtreme) -> EnclosedExtreme:
    """The least of several extremes, and the first angle of those that are as low as one another.

    >>> first_least(EnclosedExtreme(1.0, 1.0, 5.3), EnclosedExtreme(1.0 + 1e-15, 1.0 + 1e-15, 0.2))
    EnclosedExtreme(low=1.0, high=1.0, angle=0.2)
    """
    low, high = min(extreme.low for extreme in known), min(extreme.high for extreme in known)
    alike = high + EQUAL_EXTREMES * max(abs(low), abs(high))
    return EnclosedExtreme(low, high, min(extreme.angle for extreme in known if extreme.high <= alike))


@dataclass(frozen=True)
class Undercut:
    """The undercut of a cam by its follower, with its proof.

    Attributes
    ----------
    status
        "free" where the profile is proven to have a radius of curvature above 0 wherever it bulges, so that it has no
        cusp and no loop; "undercut" where it is proven not to; "undecided" where the enclosure holds the limit.
    simple
        Whether it is proven besides that the profile does not cross itself and that the follower, where it touches,
        cuts it nowhere else; never of a motion over a part of the turn.
    margin
        The least radius of curvature of the profile where it bulges, m; below 0 by how much the roller is too large.
    """

    status: UndercutStatus
    simple: bool
    margin: EnclosedExtreme

    @classmethod
    def of(cls, margin: EnclosedExtreme, *, simple: bool) -> Undercut:
        """The verdict on undercut by the least radius of curvature; `simple` counts where there is no undercut."""
        status = FREE if margin.low > 0.0 else UNDERCUT if margin.high < 0.0 else UNDECIDED
        return cls(status, simple and status == FREE, margin)

    @property
    def free(self) -> bool:
        """Whether the absence of undercut is proven."""
        return self.status == FREE

    def __str__(self) -> str:
        if self.status == UNDERCUT:
            return sentence(
                "undercut at {}: the radius of curvature of the profile would be {} there: make the prime circle larger"
                " or a roller smaller, or spread the motion over more of the turn",
                in_degrees(self.margin.angle), Amount(1e3 * self.margin.value, "mm"),
            )  # fmt: skip
        if self.status == UNDECIDED:
            width = Amount(1e3 * (self.margin.high - self.margin.low), "mm", 3)
            return sentence("undecided: the least radius of curvature is 0 to within {}", width)
        return "no undercut" + (", and the profile does not cross itself" if self.simple else ", locally")


@dataclass(frozen=True)
class FollowerSize:
    """What a cam needs of its follower by a `name`, enclosed, m, and where it must be no more than a `limit`, that."""

    name: str
    extreme: EnclosedExtreme
    limit: float | None = None

    @property
    def within(self) -> bool:
        """Whether it is not beyond its limit, but for rounding."""
        return self.limit is None or is_kept(self.extreme.low, self.limit, CAM_FEASIBILITY)

    def __str__(self) -> str:
        given = "" if self.limit is None else sentence(" of {}", Amount(1e3 * self.limit, "mm"))
        return sentence("the {}, {}{}", self.name, Amount(1e3 * self.extreme.value, "mm", 7), given)


@dataclass(frozen=True)
class CamExtremes:
    """Enclosed extremes over the whole interval of a cam's motion; radians and metres.

    Attributes
    ----------
    pressure_angles
        The least and the greatest pressure angle, with their signs.
    least_convex_radius
        The least radius of curvature of the profile where it is convex.
    least_concave_radius
        The least radius where it is concave, as a positive number; None where it is proven to be concave nowhere. A
        cutter must be smaller.
    undercut
        What is proven of undercut.
    sizes
        Sizes that its kind of follower has, with their limits.
    """

    pressure_angles: tuple[EnclosedExtreme, EnclosedExtreme]
    least_convex_radius: EnclosedExtreme
    least_concave_radius: EnclosedExtreme | None
    undercut: Undercut
    sizes: tuple[FollowerSize, ...] = ()

    @property
    def greatest_pressure_angle(self) -> EnclosedExtreme:
        """The greatest magnitude of the pressure angle."""
        least, greatest = self.pressure_angles
        return greatest if greatest.value >= -least.value else -least

    @property
    def beyond(self) -> tuple[FollowerSize, ...]:
        """Sizes of the follower that are beyond their limits."""
        return tuple(size for size in self.sizes if not size.within)


def angle_of_tangent(tangent: EnclosedExtreme) -> EnclosedExtreme:
    """The enclosed angle of an enclosed tangent, rad."""
    return widened(atan(tangent.low), atan(tangent.high), tangent.angle, 1.0)


def widened(low: float, high: float, angle: float, size: float) -> EnclosedExtreme:
    """An enclosure, a little wider for the roundings of a few operations on numbers up to a size."""
    slack = 8.0 * ROUNDOFF * abs(size)
    return EnclosedExtreme(nextafter(low - slack, -inf), nextafter(high + slack, inf), angle)
