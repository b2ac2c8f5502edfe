"""Plane linkages that a crank drives: slider-crank, four-bar and toggle, their inertia and load at the crank."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import KW_ONLY
from math import acos, asin, ceil, cos, degrees, pi, sin
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from optlaws.entries.declared import ValueOf, declared, entry
from optlaws.entries.value_types import Choice, InSI, Kept, SINumber, Span, Table
from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.tracing import Traced
from optlaws.formulas.tree import Formula, Name
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism
from optlaws.mechanisms.linkages.mechanism_formulas import extremes_over, sign_over
from optlaws.mechanisms.linkages.mechanism_kinds import (
    LENGTH,
    NO_LOADS,
    Body,
    DrivenLink,
    Link,
    Loads,
    MechanismKind,
    Slide,
    bodies_of,
    formula_from,
    function_of,
)
from optlaws.numbers import NumberOrQuantity

FourBarBranch = Literal["open", "crossed"]
Ends: TypeAlias = Kept[tuple[float, float], "tuple[NumberOrQuantity, NumberOrQuantity]"]
BodiesByLink: TypeAlias = Kept[dict[str, Body], "Mapping[str, Any]"]
LengthsByLink: TypeAlias = Kept[dict[str, float], "Mapping[str, NumberOrQuantity]"]
LENGTHS = ("crank", "rod", "upper", "lower", "frame")
BRANCH = Choice(*get_args(FourBarBranch))
#: rad from the middle of its swing: beyond it the angle of a rocker from a direction has no formula without a jump
_MOST_SWING = 0.9 * pi
#: of a turn of the crank
_LOOKS = 2881
#: turns of the direction from which the angle of a rocker is measured, by turn of the crank
_TURNING = (0.0, 1.0, -1.0)


@declared
class LinkageKind(MechanismKind):
    """A linkage in a plane, which a crank drives."""

    _: KW_ONLY
    loads: Loads = entry(
        ValueOf(Loads), "What acts on the driven link, and the direction of gravity.", default=NO_LOADS
    )
    over: Ends = entry(Span(InSI("angle")), "The range of x, the crank's angle.", default=("0 deg", "360 deg"))

    @property
    def ends(self) -> tuple[float, float]:
        """The ends of the range of x, rad."""
        return self.over

    def _linkage(
        self,
        links: Mapping[str, Link | Slide],
        bodies: Mapping[str, Body],
        driven: DrivenLink,
        chains: Sequence[Sequence[tuple[Any, Any]]],
    ) -> Mechanism:
        """The mechanism of links with bodies, one of which does the work, and of points that a picture joins."""
        moved = [link.moved(bodies[name], self.loads.weight) for name, link in links.items()]
        inertia, load = ([term for terms in side for term in terms] for side in zip(*moved, strict=True))
        positions = () if driven.position is None else ((driven.name, driven.position),)
        points = tuple(tuple((formula_from(x), formula_from(y)) for x, y in chain) for chain in chains)
        acting = self.loads.on(driven, "angle")
        return self._mechanism(inertia, [*load, *acting], self.over, LinkGeometry(positions, points))


@declared
class SliderCrank(LinkageKind, kind="slider crank"):
    """The mechanism of a crank that drives a slide through a rod; x is the crank's angle from the slide's way.

    The slide is at s = r cos x + sqrt(l² - (r sin x - e)²) from the crank's pivot, farthest where x = 0 without offset.

    Raises
    ------
    InputError
        If the rod is too short for the crank and the offset within the range; the error names the angles that are
        reached.

    Examples
    --------
    >>> press = slider_crank("0.1 m", "0.4 m", bodies={"slider": "5 kg", "crank": "0.02 kg m^2"})
    >>> round(press.inertia("90 deg"), 9), round(press.driven_position("slider", 0.0), 9)
    (0.07, 0.5)
    """

    crank: SINumber = entry(LENGTH, "Its length r.", example="100 mm")
    rod: SINumber = entry(LENGTH, "Its length l.", example="400 mm")
    _: KW_ONLY
    offset: SINumber = entry(
        InSI("length"), "Of the slide's way from the crank's pivot, e, to the left.", default=0.0, example="20 mm"
    )
    bodies: BodiesByLink = entry(
        bodies_of(("crank",), ("rod",), ("slider",)),
        "Of the slider a mass, of the crank a moment of inertia about its pivot, or a `Body`.",
        example={"crank": "0.5 kg m^2", "slider": "12 kg"},
    )

    @property
    def mechanism(self) -> Mechanism:
        r, e = self.crank, self.offset
        _check_rod(r, self.rod, e, self.ends)
        x = Traced(Name("x"))
        sine, cosine = np.sin(x), np.cos(x)
        across = r * sine - e
        along = np.sqrt(self.rod**2 - across**2)
        position, velocity = r * cosine + along, -r * sine - (r * across * cosine) / along
        pin, slider = (r * cosine, r * sine), (position, e)
        crank = Link(pin, 1.0, r)
        rod = Link((along, -across), -pin[0] / along, self.rod, crank)
        return self._linkage(
            {"crank": crank, "slider": Slide(velocity), "rod": rod},
            self.bodies,
            DrivenLink("slider", position.formula, velocity.formula, "length"),
            [[(0.0, 0.0)], [(0.0, 0.0), pin, slider], [slider]],
        )


slider_crank = function_of(SliderCrank)


def _check_rod(crank: float, rod: float, offset: float, ends: tuple[float, float]) -> None:
    """Refuse a range in which the rod cannot reach the slide's way."""
    arcs = []
    if rod + offset <= crank:
        edge = asin(max((rod + offset) / crank, -1.0))
        arcs.append((edge, pi - edge))
    if offset - rod >= -crank:
        edge = asin(min((offset - rod) / crank, 1.0))
        arcs.append((pi - edge, 2.0 * pi + edge))
    beyond = sorted(_turned(arcs, ends))
    if not beyond:
        return
    lows, highs = zip(*beyond, strict=True)
    reached = [way for way in zip((ends[0], *highs), (*lows, ends[1]), strict=True) if way[0] < way[1]]
    near = "the mechanism does not reach it within the range"
    if reached:
        shown = f"{degrees(reached[0][0]):.6g} to {degrees(reached[-1][1]):.6g} deg"
        near = f"within the range it is reached from {shown} but for these"
    first = max(lows[0], ends[0])
    raise InputError(
        f"the rod of {rod:g} m is too short for a crank of {crank:g} m and an offset of {offset:g} m: at "
        f"{degrees(first):.6g} deg the pin is {abs(crank * sin(first) - offset):g} m from the "
        f"slide's way, and {near}; take a rod of more than {crank + abs(offset):g} m, or another range in over="
    )


def _turned(arcs: Iterable[tuple[float, float]], ends: tuple[float, float]) -> list[tuple[float, float]]:
    """Arcs of the crank's angle, rad, with whole turns added, that are in a range of it."""
    turns = 2.0 * pi * np.arange(ends[0] // (2.0 * pi) - 1.0, ends[1] // (2.0 * pi) + 2.0)
    moved = [(low + turn, high + turn) for low, high in arcs for turn in turns.tolist()]
    return [(low, high) for low, high in moved if low <= ends[1] and high >= ends[0]]


class FourBarLinks:
    """Crank, coupler and rocker of a four-bar over the crank's angle x from the frame, in closed form.

    Their lengths, and that of the frame, are in m, by the names that errors give them.
    With the distance of the crank's pin from the rocker's pivot, R = a² + d² - 2 a d cos x its square, and
    P = (R + b² - c²)/2, H² = b² R - P², the pins and angular velocities are quotients of polynomials in cos x and sin x
    and of H alone: the angle of the rocker has the slope (a - d cos x + d sin x P/H) a/R.

    Raises
    ------
    InputError
        If it cannot be assembled everywhere in a range of x.
    """

    def __init__(self, lengths: dict[str, float], branch: FourBarBranch, ends: tuple[float, float]) -> None:
        a, b, c, d = lengths.values()
        _check_assembly(lengths, ends)
        self.ends, x = ends, Traced(Name("x"))
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

    @property
    def rocker_position(self) -> Formula | None:
        """The rocker's angle from the frame, without a jump over the range of x; None where it turns too far.

        One that turns round with the crank is measured from a direction that does.
        """
        low, high = self.ends
        x = np.linspace(low, high, ceil(_LOOKS * max(1.0, (high - low) / (2.0 * pi))))
        ex, ey = (evaluate(part.formula, {"x": x}, NUMPY) for part in self.rocker.way)
        angles = np.unwrap(np.arctan2(ey, ex))
        for turning in _TURNING:
            swing = angles - turning * x
            reference = float(0.5 * (swing.min() + swing.max()))
            along, across = self.rocker_along(reference, turning)
            # it is never opposite to the direction from which its angle is measured
            before = along + self.rocker.length
            if swing.max() - swing.min() <= 2.0 * _MOST_SWING and sign_over(before.formula, low, high)[0] > 0:
                turned: Traced = np.arctan(across / before)
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
    >>> four_bar("0.2 m", "0.3 m", "0.1 m", "0.35 m", bodies={}, over=("0 rad", "1 rad"))
    Traceback (most recent call last):
    optlaws.errors.InputError: the crank reaches no angle from -28.955 to 28.955 deg: coupler and rocker are in line, ...
    """  # noqa: E501 - a line of output

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
        lengths = {name: getattr(self, name) for name in ("crank", "coupler", "rocker", "frame")}
        linkage = FourBarLinks(lengths, self.branch, self.ends)
        return self._linkage(
            {"crank": linkage.crank, "coupler": linkage.coupler, "rocker": linkage.rocker},
            self.bodies,
            DrivenLink("rocker", linkage.rocker_position, linkage.rocker.turning.formula, "angle"),
            linkage.chains,
        )


four_bar = function_of(FourBar)


def _check_assembly(lengths: dict[str, float], ends: tuple[float, float]) -> None:
    """Refuse a range of the crank's angle, rad from the frame, that a four-bar does not reach."""
    crank, coupler, rocker, frame = lengths.values()
    longest = max(lengths, key=lambda name: lengths[name])
    others = sum(lengths.values()) - lengths[longest]
    if lengths[longest] >= others:
        raise InputError(
            f"the links do not close: the {longest} of {lengths[longest]:g} m is as long as the others together, "
            f"{others:g} m; make it shorter"
        )
    # the distance of the crank's pin from the rocker's pivot is sqrt(middle - swing cos x)
    middle, swing = crank**2 + frame**2, 2.0 * crank * frame
    stretched, folded = ((middle - reach**2) / swing for reach in (coupler + rocker, coupler - rocker))
    in_line, unreached = " and ".join([*lengths][1:3]), {}
    if stretched >= -1.0:
        edge = acos(min(stretched, 1.0))
        unreached["stretched"] = edge, 2.0 * pi - edge
    if folded <= 1.0:
        edge = acos(max(folded, -1.0))
        unreached["folded"] = -edge, edge
    for how, arc in unreached.items():
        for first, last in _turned([arc], ends):
            raise InputError(
                f"the crank reaches no angle from {degrees(first):.6g} to {degrees(last):.6g} deg: "
                f"{in_line} are in line, {how}, at these dead centres, beyond which the crank cannot go, and the "
                f"range is {degrees(ends[0]):.6g} to {degrees(ends[1]):.6g} deg. {_grashof(lengths)}; take a range "
                "in over= between dead centres, or other lengths"
            )


def _grashof(lengths: dict[str, float]) -> str:
    """Grashof's rule in the numbers of a four-bar."""
    names = sorted(lengths, key=lambda name: lengths[name])
    outer, inner = lengths[names[0]] + lengths[names[3]], lengths[names[1]] + lengths[names[2]]
    sums = f"shortest and longest link make {outer:g} m, the two others {inner:g} m"
    if outer > inner:
        return f"By Grashof's rule no link turns fully: {sums}"
    turning = "crank" if names[0] in {"crank", "frame"} else names[0]
    return f"By Grashof's rule the {turning} turns fully: {sums}"


@declared
class Toggle(LinkageKind, kind="toggle"):
    """The mechanism of a knee joint: a crank moves the knee through a rod, and the knee a ram; x is the crank's angle.

    The upper link turns about a pivot of the frame, at the distance "frame" from the crank's; x is from that
    direction. The knee is the pin of rod, upper and lower link. The ram slides on a line through the upper link's
    pivot: its position is the distance from that pivot, greatest where the knee is stretched.

    Raises
    ------
    InputError
        If it cannot be assembled everywhere in the range; the error names the dead centres.

    Examples
    --------
    >>> lengths = {"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "200 mm", "frame": "280 mm"}
    >>> press = toggle(lengths, bodies={"ram": "40 kg", "crank": "0.05 kg m^2"})
    >>> round(press.driven_position("ram", "0 deg"), 6), round(press.driven_position("ram", "180 deg"), 6)
    (0.382283, 0.291583)
    """

    lengths: LengthsByLink = entry(
        Table(LENGTH, LENGTHS),
        "Between joints: of the crank; of the rod, from the crank's pin to the knee; of the upper link, from its pivot "
        "to the knee; of the lower link, from the knee to the ram; of the frame, from the crank's pivot to the upper "
        "link's.",
        example={"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "200 mm", "frame": "280 mm"},
    )
    _: KW_ONLY
    direction: SINumber = entry(
        InSI("angle"),
        "The direction in which the ram moves when the knee is stretched: the angle, counterclockwise, from the line "
        "from the crank's pivot to the upper link's.",
        default="90 deg",
    )
    bodies: BodiesByLink = entry(
        bodies_of(("crank", "upper"), ("rod", "lower"), ("ram",)),
        "Of crank and upper link a moment of inertia about the pivot, of the ram a mass; of rod and lower link a "
        "`Body` whose centre is given from the crank's pin and from the knee.",
        example={"ram": "40 kg"},
    )
    branch: FourBarBranch = entry(
        BRANCH,
        "Open where the knee is to the left of the way from the crank's pin to the upper link's pivot, crossed where "
        "it is to the right.",
        default="open",
    )

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        for name in LENGTHS:
            if name in data:
                raise InputError(f"{name} is a length of the toggle: give it in the table lengths = {{ {name} = ... }}")
        return data

    def _check(self) -> None:
        missing = [name for name in LENGTHS if name not in self.lengths]
        if missing:
            raise InputError(f"lengths: a toggle needs {', '.join(missing)} too")

    @property
    def mechanism(self) -> Mechanism:
        crank, rod, upper_link, lower, frame = (self.lengths[name] for name in LENGTHS)
        driving = {"crank": crank, "rod": rod, "upper link": upper_link, "frame": frame}
        linkage = FourBarLinks(driving, self.branch, self.ends)
        along, across = linkage.rocker_along(self.direction)
        _check_knee(linkage, along, across, lower)
        height: Traced = np.sqrt(lower**2 - across**2)
        upper = linkage.rocker.turning
        position, velocity = along + height, -upper * across * (1.0 + along / height)
        knee = Link((along, across), upper, linkage.rocker.length)
        links: dict[str, Link | Slide] = {
            "crank": linkage.crank,
            "rod": linkage.coupler,
            "upper": linkage.rocker,
            "ram": Slide(velocity, self.direction),
            "lower": Link((height, -across), -upper * along / height, lower, knee, self.direction),
        }
        joint = linkage.chains[-1][2]
        ram = (frame + cos(self.direction) * position, sin(self.direction) * position)
        return self._linkage(
            links,
            self.bodies,
            DrivenLink("ram", position.formula, velocity.formula, "length"),
            [*linkage.chains, [joint, ram], [ram]],
        )


toggle = function_of(Toggle)


def _check_knee(linkage: FourBarLinks, along: Traced, across: Traced, lower: float) -> None:
    """Refuse a range in which the lower link does not reach the ram's way, or the knee is behind the pivot."""
    signs = [sign_over(part.formula, *linkage.ends)[0] for part in (lower - across, lower + across, along)]
    if min(signs[:2]) <= 0:
        beside = extremes_over(across.formula, *linkage.ends)
        at = beside.most_at if beside.most == beside.peak else beside.least_at
        raise InputError(
            f"the lower link of {lower:g} m does not reach the ram's way at {degrees(at):.6g} deg, where the knee "
            f"is {beside.peak:.6g} m from it: make it longer, or take another range in over="
        )
    if signs[2] <= 0:
        before = extremes_over(along.formula, *linkage.ends)
        raise InputError(
            f"at {degrees(before.least_at):.6g} deg the knee is {-before.least:.6g} m behind the upper link's pivot, "
            "seen along the ram's way: take the other branch, the opposite direction, or a shorter range"
        )
