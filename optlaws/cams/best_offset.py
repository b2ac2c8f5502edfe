"""The best offset of a slide with a roller: the least greatest pressure angle over the turn, with its proof.

An offset lessens the pressure angle on one way and adds to it on the other. Where both are as great the offset is best:
every other breaks the angle at one of two places of the turn, as is shown for all offsets at once by intervals of them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan, sqrt
from typing import NamedTuple

import numpy as np

from optlaws.cams.curves.motion_by_angle import CamMotion, as_motion
from optlaws.cams.disc import DiscCam, Turning, sense
from optlaws.cams.followers.follower import positive
from optlaws.cams.followers.rollers import TranslatingRoller
from optlaws.cycles.cycle import Cycle
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import Array, Quantity
from optlaws.numerics.interval import Interval, between, exact
from optlaws.numerics.roots import bracketed_root, holds_throughout
from optlaws.tolerances import ROUNDOFF, SIZE_BRACKET

_OFFSET_SETTLED = 1e-12  # of a pressure angle: at the places that an offset is sought by it is the greatest to so much

_FIRST, _STEPS = 361, 30


class _Offsets(NamedTuple):
    """Offsets of a slide over a prime circle, and the tangents of pressure angles at places with them."""

    radius: float
    lowest: float
    turning: float

    def tangents(self, offset: float, s: Array, slope: Array) -> Array:
        """The tangents of the pressure angle at offsets, where the follower has a displacement and a slope."""
        level = sqrt((self.radius - abs(offset)) * (self.radius + abs(offset)))
        return np.asarray((slope - self.turning * offset) / (level + s - self.lowest))

    def beyond(self, tangent: float, s: Interval, slope: Interval, low: float, high: float) -> bool:
        """Whether every offset in a range is proven to exceed a tangent of the pressure angle somewhere."""
        least, most = (0.0 if low <= 0.0 <= high else min(abs(low), abs(high))), max(abs(low), abs(high))
        levels = (sqrt((self.radius - size) * (self.radius + size)) for size in (most, least))
        lower, upper = (level * (1.0 + way * 8.0 * ROUNDOFF) for level, way in zip(levels, (-1.0, 1.0), strict=True))
        along = slope - between(np.array(low), np.array(high)) * self.turning
        across = (s - self.lowest + between(np.array(lower), np.array(upper))) * tangent
        return bool(np.any((along - across).low > 0.0) or np.any((-along - across).low > 0.0))


@dataclass(frozen=True)
class BestOffset:
    """The offset of a slide with the least greatest pressure angle.

    Attributes
    ----------
    offset
        As of a `TranslatingRoller`, m.
    pressure_angle
        The greatest magnitude over the turn, enclosed from above, rad.
    lower_bound
        No offset has less, rad.
    proven
        Whether that is proven for every one of them.
    angles
        Angles of the cam at which the pressure angle is greatest and least, rad.
    cam
        The cam with the offset.
    """

    offset: float
    pressure_angle: float
    lower_bound: float
    proven: bool
    angles: tuple[float, float]
    cam: DiscCam


def best_offset(
    motion: Cycle | CamMotion,
    prime_radius: Quantity,
    follower: TranslatingRoller,
    *,
    turning: Turning = "counterclockwise",
) -> BestOffset:
    """The offset, or eccentricity, with which the pressure angle is as great on the way up as on the way back.

    No other one has a smaller greatest pressure angle over the whole motion.

    Parameters
    ----------
    motion, prime_radius, turning
        As of a `DiscCam`: the prime circle keeps its radius.
    follower
        A roller on a slide, whose own offset does not matter.

    Raises
    ------
    InputError
        If the follower is of another kind, or there is no such cam.

    Examples
    --------
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> best = best_offset(rise, "60 mm", TranslatingRoller("12 mm"))
    >>> round(1e3 * best.offset, 4), round(float(np.degrees(best.pressure_angle)), 4), best.proven
    (16.4239, 15.8865, True)
    """
    if not isinstance(follower, TranslatingRoller):
        raise InputError(f"follower must be a TranslatingRoller, whose slide has an offset, got {shortened(follower)}")
    radius, course = positive(prime_radius, "prime_radius"), as_motion(motion, follower.axis)
    offsets = _Offsets(radius, course.range[0], sense(turning))
    angles = np.unique([*np.linspace(*course.interval, _FIRST), *course.monotone_edges])
    last = np.inf
    for _ in range(_STEPS):
        s, slope = (np.asarray(term) for term in course.jet(angles, 1).terms)
        offset = _balanced(offsets, s, slope)
        cam = DiscCam(motion, prime_radius, replace(follower, offset=f"{offset!r} m"), turning=turning)
        ends = cam.extremes.pressure_angles
        reached, greatest = float(np.abs(offsets.tangents(offset, s, slope)).max()), max(-ends[0].low, ends[1].high)
        if greatest <= atan(reached) * (1.0 + _OFFSET_SETTLED) or abs(offset - last) <= ROUNDOFF * radius:
            break
        last, angles = offset, np.append(angles, [end.angle for end in ends])
    tangents = offsets.tangents(offset, s, slope)
    worst = angles[[int(np.argmax(tangents)), int(np.argmin(tangents))]]
    bound = reached * (1.0 - SIZE_BRACKET)
    at = course.jet(exact(worst), 1).terms
    proven = reached == 0.0 or holds_throughout(
        lambda low, high: offsets.beyond(bound, at[0], at[1], low, high), -radius, radius
    )
    return BestOffset(offset, greatest, atan(bound), proven, (float(worst[0]), float(worst[1])), cam)


def _balanced(offsets: _Offsets, s: Array, slope: Array) -> float:
    """The offset with which tangents at some places are as great to both sides."""

    def leaning(offset: float) -> float:
        tangents = offsets.tangents(offset, s, slope)
        return float(tangents.max() + tangents.min())

    most = offsets.radius * (1.0 - SIZE_BRACKET)
    return bracketed_root(leaning, -most, most)
