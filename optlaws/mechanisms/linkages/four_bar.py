"""The four-bar: a crank that swings a rocker through a coupler, its inertia and load at the crank, in closed form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY
from math import ceil, cos, pi, sin
from typing import Any, Literal, get_args

import numpy as np

from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Choice, SINumber
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.tracing import Traced
from optlaws.formulas.tree import Formula, Name
from optlaws.mechanisms.linkages.assembly import check_four_bar
from optlaws.mechanisms.linkages.bodies import DrivenLink, Link, bodies_of
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import LENGTH, BodiesByLink, LinkageKind, function_of
from optlaws.numbers import Array

FourBarBranch = Literal["open", "crossed"]
BRANCH = Choice(*get_args(FourBarBranch))
#: rad from the middle of its swing: beyond it the angle of a rocker from a direction has no formula without a jump
_MOST_SWING = 0.9 * pi
#: of a turn of the crank
_LOOKS = 2881
#: turns of the direction from which the angle of a rocker is measured, by turn of the crank
_TURNING = (0.0, 1.0, -1.0)


class FourBarLinks:
    """Crank, coupler and rocker of a four-bar over the crank's angle x from the frame, in closed form; lengths in m.

    With the distance of the crank's pin from the rocker's pivot, R = a² + d² - 2 a d cos x its square, and
    P = (R + b² - c²)/2, H² = b² R - P², the pins and angular velocities are quotients of polynomials in cos x and sin x
    and of H alone: the angle of the rocker has the slope (a - d cos x + d sin x P/H) a/R.

    Raises
    ------
    InputError
        If it cannot be assembled everywhere in a range of x.
    """

    def __init__(self, lengths: Sequence[float], branch: FourBarBranch, ends: tuple[float, float]) -> None:
        a, b, c, d = lengths
        check_four_bar(a, b, c, d, ends)
        self.frame, self.ends = d, ends
        x = Traced(Name("x"))
        self.sine, self.cosine = np.sin(x), np.cos(x)
        self.base = d - a * self.cosine, -a * self.sine
        self.square = a**2 + d**2 - 2.0 * a * d * self.cosine
        share = (a**2 + d**2 + b**2 - c**2) / 2.0 - a * d * self.cosine
        root: Traced = np.sqrt(b**2 * self.square - share**2)
        # twice the area of the triangle of base, coupler and rocker; below 0 where they are crossed
        self.height = root if branch == "open" else -root
        self.of_rocker = share - self.square

        def turning(part: Traced) -> Traced:
            slope: Traced = a * (a - d * self.cosine + (d * self.sine) * part / self.height) / self.square
            return slope

        pin = a * self.cosine, a * self.sine
        self.crank = Link(pin, 1.0, a)
        self.coupler = Link(self._by_base(share, self.base), turning(self.of_rocker), b, self.crank)
        self.rocker = Link(self._by_base(self.of_rocker, self.base), turning(share), c)
        joint, pivot = (d + self.rocker.way[0], self.rocker.way[1]), (d, 0.0)
        self.chains = [[(0.0, 0.0)], [pivot], [(0.0, 0.0), pin, joint, pivot]]

    def _by_base(self, share: Traced, base: tuple[Traced, Traced]) -> tuple[Traced, Traced]:
        """What is a share of the base along it, and the height across it, each over the square of its length."""
        dx, dy = base
        return (share * dx - self.height * dy) / self.square, (share * dy + self.height * dx) / self.square

    def rocker_along(self, direction: float, turning: float = 0.0) -> tuple[Traced, Traced]:
        """The rocker's joint in coordinates along a direction, rad from the frame, and across it.

        The direction may turn with the crank (`turning` 1) or against it (-1).
        """
        dx, dy = self.base
        c: Any = cos(direction)
        s: Any = sin(direction)
        if turning:
            c, s = c * self.cosine - turning * s * self.sine, s * self.cosine + turning * c * self.sine
        return self._by_base(self.of_rocker, (c * dx + s * dy, c * dy - s * dx))

    def places(self, *parts: Traced) -> tuple[Array, ...]:
        """Angles of the crank over its range, and values of parts of the linkage there."""
        low, high = self.ends
        x = np.linspace(low, high, ceil(_LOOKS * max(1.0, (high - low) / (2.0 * pi))))
        return x, *(evaluate(part.formula, {"x": x}, NUMPY) + 0.0 * x for part in parts)

    @property
    def rocker_position(self) -> Formula | None:
        """The rocker's angle from the frame, without a jump over the range of x; None where it turns too far.

        One that turns round with the crank is measured from a direction that does.
        """
        x, ex, ey = self.places(*self.rocker.way)
        angles = np.unwrap(np.arctan2(ey, ex))
        for turning in _TURNING:
            swing = angles - turning * x
            if swing.max() - swing.min() <= 2.0 * _MOST_SWING:
                reference = float(0.5 * (swing.min() + swing.max()))
                along, across = self.rocker_along(reference, turning)
                turned: Traced = np.arctan(across / (along + self.rocker.length))
                from_frame = reference + 2.0 * turned
                return (from_frame + turning * Traced(Name("x")) if turning else from_frame).formula
        return None


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
        BRANCH,
        "Open where the rocker's pin is to the left of the way from the crank's pin to the rocker's pivot, crossed "
        "where it is to the right.",
        default="open",
    )

    @property
    def mechanism(self) -> Mechanism:
        linkage = FourBarLinks((self.crank, self.coupler, self.rocker, self.frame), self.branch, self.ends)
        return self._linkage(
            {"crank": linkage.crank, "coupler": linkage.coupler, "rocker": linkage.rocker},
            self.bodies,
            DrivenLink("rocker", linkage.rocker_position, linkage.rocker.turning.formula, "angle"),
            linkage.chains,
        )


four_bar = function_of(FourBar)
