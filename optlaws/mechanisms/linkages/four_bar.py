"""The four-bar: a crank that swings a rocker through a coupler, its inertia and load at the crank, in closed form."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from math import ceil, cos, pi, sin
from typing import Any, Literal

import numpy as np

from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Choice, SINumber
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.tracing import Traced
from optlaws.formulas.tree import Formula, Name, Number, number
from optlaws.kept import kept_property
from optlaws.mechanisms.linkages.assembly import check_four_bar
from optlaws.mechanisms.linkages.bodies import Body, DrivenLink, Moving, bodies_of, weight_load
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import LENGTH, BodiesByLink, LinkageKind, function_of

FourBarBranch = Literal["open", "crossed"]
SIDES: dict[FourBarBranch, float] = {"open": 1.0, "crossed": -1.0}
#: rad from the middle of its swing: beyond it the angle of a rocker from a direction has no formula without a jump
_MOST_SWING = 0.9 * pi
#: of a turn of the crank
_LOOKS = 2881
#: turns of the direction from which the angle of a rocker is measured, by turn of the crank
_TURNING = (0.0, 1.0, -1.0)


@dataclass(frozen=True)
class FourBarKinematics:
    """The kinematics of a four-bar over the crank's angle x from the frame, in closed form; lengths in m.

    With the distance of the crank's pin from the rocker's pivot, R = a² + d² - 2 a d cos x its square, and
    P = (R + b² - c²)/2, H² = b² R - P², the pins and angular velocities are quotients of polynomials in cos x and sin x
    and of H alone: the angle of the rocker has the slope (a - d cos x + d sin x P/H) a/R.

    Attributes
    ----------
    crank, coupler, rocker, frame
        a, b, c and d.
    side
        1 where the pin of coupler and rocker is to the left of the way from crank's pin to rocker's pivot, else -1.
    """

    crank: float
    coupler: float
    rocker: float
    frame: float
    side: float

    @kept_property
    def waves(self) -> tuple[Traced, Traced]:
        """Sine and cosine of the crank's angle."""
        x = Traced(Name("x"))
        return np.sin(x), np.cos(x)

    @kept_property
    def base(self) -> tuple[Traced, Traced]:
        """The way from the crank's pin to the rocker's pivot."""
        sine, cosine = self.waves
        return self.frame - self.crank * cosine, -self.crank * sine

    @kept_property
    def square(self) -> Traced:
        """R, the square of its length."""
        return self.crank**2 + self.frame**2 - 2.0 * self.crank * self.frame * self.waves[1]

    @kept_property
    def share(self) -> Traced:
        """P, the product of that way and the coupler as vectors."""
        constant = (self.crank**2 + self.frame**2 + self.coupler**2 - self.rocker**2) / 2.0
        return constant - self.crank * self.frame * self.waves[1]

    @kept_property
    def height(self) -> Traced:
        """H, twice the area of the triangle of that way, coupler and rocker; below 0 where they are crossed."""
        root: Traced = np.sqrt(self.coupler**2 * self.square - self.share**2)
        return root if self.side > 0.0 else -root

    @kept_property
    def rocker_velocity(self) -> Traced:
        """The rocker's angular velocity by x."""
        sine, cosine = self.waves
        turning = self.crank - self.frame * cosine + (self.frame * sine) * self.share / self.height
        return self.crank * turning / self.square

    @kept_property
    def coupler_velocity(self) -> Traced:
        """The coupler's angular velocity by x."""
        sine, cosine = self.waves
        missing = self.share - self.square
        turning = self.crank - self.frame * cosine + (self.frame * sine) * missing / self.height
        return self.crank * turning / self.square

    @kept_property
    def coupler_direction(self) -> tuple[Traced, Traced]:
        """The way from the crank's pin to the rocker's."""
        return self._combined(self.share, self.base)

    @kept_property
    def rocker_direction(self) -> tuple[Traced, Traced]:
        """The way from the rocker's pivot to its pin."""
        return self._combined(self.share - self.square, self.base)

    def rocker_along(self, direction: float, turning: float = 0.0) -> tuple[Traced, Traced]:
        """The rocker's joint in coordinates along a direction, rad from the frame, and across it.

        The direction may turn with the crank (`turning` 1) or against it (-1).
        """
        (dx, dy), (sine, cosine) = self.base, self.waves
        c: Any = cos(direction)
        s: Any = sin(direction)
        if turning:
            c, s = c * cosine - turning * s * sine, s * cosine + turning * c * sine
        return self._combined(self.share - self.square, (c * dx + s * dy, c * dy - s * dx))

    def _combined(self, share: Traced, base: tuple[Traced, Traced]) -> tuple[Traced, Traced]:
        dx, dy = base
        return (share * dx - self.height * dy) / self.square, (share * dy + self.height * dx) / self.square

    def rocker_position(self, ends: tuple[float, float]) -> Formula | None:
        """The rocker's angle from the frame, without a jump over a range of x; None where it turns too far.

        One that turns round with the crank is measured from a direction that does.
        """
        x = np.linspace(*ends, ceil(_LOOKS * max(1.0, (ends[1] - ends[0]) / (2.0 * pi))))
        ex, ey = (self.values(part, x) for part in self.rocker_direction)
        angles = np.unwrap(np.arctan2(ey, ex))
        for turning in _TURNING:
            swing = angles - turning * x
            if swing.max() - swing.min() <= 2.0 * _MOST_SWING:
                reference = float(0.5 * (swing.min() + swing.max()))
                along, across = self.rocker_along(reference, turning)
                turned: Traced = np.arctan(across / (along + self.rocker))
                from_frame = reference + 2.0 * turned
                return (from_frame + turning * Traced(Name("x")) if turning else from_frame).formula
        return None

    @staticmethod
    def values(part: Traced, x: Any) -> Any:
        """Values of a part of the four-bar at angles of the crank."""
        return evaluate(part.formula, {"x": x}, NUMPY) + 0.0 * x

    def coupler_moving(self, body: Body, gravity: tuple[float, float]) -> tuple[list[Formula], list[Formula]]:
        """Contribution of a body on the coupler to the inertia and the load at the crank."""
        if body == Body():
            return [], []
        (sine, cosine), turning, (p, q) = self.waves, self.coupler_velocity, body.centre
        a, b, d = self.crank, self.coupler, self.frame
        # the crank's direction times the way from its pin to the centre of mass
        beside, ahead = d * cosine - a, d * sine
        share = (p / b) * (self.share * beside + self.height * ahead)
        if q:
            share = share + (q / b) * (self.share * ahead - self.height * beside)
        square = a**2 + 2.0 * a * turning * share / self.square
        inertia = [(body.mass * square).formula] if body.mass else []
        inertia.append(Moving(body.about_joint, turning).inertia)
        if not body.mass or not any(gravity):
            return inertia, []
        bx, by = self.coupler_direction
        dx, dy = (p / b) * bx - (q / b) * by, (p / b) * by + (q / b) * bx
        velocity = -a * sine - turning * dy, a * cosine + turning * dx
        return inertia, weight_load(body.mass, gravity, velocity)

    def crank_weight(self, body: Body, gravity: tuple[float, float]) -> list[Formula]:
        """The load at the crank by the weight of a body on it."""
        (sine, cosine), (p, q) = self.waves, body.centre
        return weight_load(body.mass, gravity, (-p * sine - q * cosine, p * cosine - q * sine))

    def rocker_weight(self, body: Body, gravity: tuple[float, float]) -> list[Formula]:
        """The load at the crank by the weight of a body on the rocker."""
        if not body.mass or not any(gravity) or not any(body.centre):
            return []
        (ex, ey), turning = self.rocker_direction, self.rocker_velocity
        p, q = (value / self.rocker for value in body.centre)
        return weight_load(body.mass, gravity, (-turning * (p * ey + q * ex), turning * (p * ex - q * ey)))

    @property
    def chains(self) -> tuple[tuple[tuple[Formula, Formula], ...], ...]:
        """Pivots and links as a picture draws them."""
        zero, pivot = Number(0.0), (number(self.frame), Number(0.0))
        sine, cosine = self.waves
        ex, ey = self.rocker_direction
        pin = (self.crank * cosine).formula, (self.crank * sine).formula
        joint = (self.frame + ex).formula, ey.formula
        return ((zero, zero),), (pivot,), ((zero, zero), pin, joint, pivot)


def four_bar_of(lengths: Mapping[str, float], branch: FourBarBranch, ends: tuple[float, float]) -> FourBarKinematics:
    """The kinematics of a four-bar that can be assembled over a range of its crank."""
    check_four_bar(**lengths, ends=ends)
    return FourBarKinematics(**lengths, side=SIDES[branch])


@declared
class FourBar(LinkageKind, kind="four bar"):
    """The mechanism of a crank that swings a rocker through a coupler; x is the crank's angle from the frame.

    The frame goes from the crank's pivot to the rocker's. The driven link is the rocker, its position the angle of its
    pin from the frame's direction; loads on it are torques over its angle, and gravity's direction is from the frame's.

    Raises
    ------
    InputError
        If the four-bar cannot be assembled everywhere in the range; the error names the dead centres.

    Examples
    --------
    >>> linkage = four_bar("0.1 m", "0.3 m", "0.25 m", "0.35 m", bodies={"rocker": "0.05 kg m^2"})
    >>> round(linkage.inertia("90 deg"), 9), round(linkage.driven_position("rocker", "90 deg"), 6)
    (0.006471764, 1.907443)
    """

    crank: SINumber = entry(LENGTH, "Its length between pins.", example="100 mm")
    coupler: SINumber = entry(LENGTH, "Its length between pins.", example="300 mm")
    rocker: SINumber = entry(LENGTH, "Its length between pins.", example="250 mm")
    frame: SINumber = entry(LENGTH, "The distance of the pivots.", example="350 mm")
    _: KW_ONLY
    bodies: BodiesByLink = entry(
        bodies_of(("crank", "rocker"), ("coupler",), ()),
        'Of crank and rocker a moment of inertia about the pivot, or a `Body`; `Body("2 kg", centre=("80 mm", '
        '"50 mm"))` is a mass at a point of the coupler, along it from the crank\'s pin and across it.',
        example={"rocker": "0.05 kg m^2"},
    )
    branch: FourBarBranch = entry(
        Choice(*SIDES),
        "Open where the rocker's pin is to the left of the way from the crank's pin to the rocker's pivot, crossed "
        "where it is to the right.",
        default="open",
    )

    @property
    def mechanism(self) -> Mechanism:
        lengths = {"crank": self.crank, "coupler": self.coupler, "rocker": self.rocker, "frame": self.frame}
        linkage = four_bar_of(lengths, self.branch, self.ends)
        inertia, load = moved_by_crank(linkage, self.bodies, self.loads.weight)
        position = linkage.rocker_position(self.ends)
        load += self.loads.on(DrivenLink("rocker", position, linkage.rocker_velocity.formula, "angle"), "angle")
        driven = () if position is None else (("rocker", position),)
        return self._mechanism(inertia, load, self.ends, LinkGeometry(driven, linkage.chains))


four_bar = function_of(FourBar)


def moved_by_crank(
    linkage: FourBarKinematics, bodies: Mapping[str, Body], gravity: tuple[float, float]
) -> tuple[list[Formula], list[Formula]]:
    """Inertia and load at the crank by the bodies on crank, coupler and rocker."""
    inertia, load = linkage.coupler_moving(bodies["coupler"], gravity)
    parts = [number(bodies["crank"].about_joint), *inertia]
    if bodies["rocker"] != Body():
        parts.append(Moving(bodies["rocker"].about_joint, linkage.rocker_velocity).inertia)
    weights = linkage.crank_weight(bodies["crank"], gravity) + linkage.rocker_weight(bodies["rocker"], gravity)
    return parts, [*load, *weights]
