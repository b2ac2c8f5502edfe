"""Trees of proofs as plain values: leaves that close a region of laws, splits that divide one, tightenings, places."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from math import isfinite
from typing import NamedTuple, TypeVar

from optlaws.echo import shortened
from optlaws.errors import InputError


@dataclass(frozen=True)
class Contact:
    """A constraint at one k: which family of rows, with which sign, and its multiplier (dimensionless).

    `direction` belongs to an RMS and to a complex amplitude: the unit vector by which its size is bounded from below;
    to the peak velocity of a loader: the coordinates of the law whose tangent bounds it.

    Examples
    --------
    >>> Contact("C", 1.0, 0.25, 0.5).multiplier
    0.5
    """

    constraint: str
    sign: float
    k: float
    multiplier: float
    direction: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        finite = all(map(isfinite, (self.multiplier, *self.direction)))
        if not 0.0 <= self.k <= 1.0 or not finite or abs(self.sign) != 1.0:
            raise InputError(
                f"a contact needs k in [0, 1], a sign 1 or -1, a finite multiplier and direction, got {shortened(self)}"
            )


@dataclass(frozen=True)
class Leaf:
    """Multipliers of a sum of rows that no law of a region obeys.

    Attributes
    ----------
    contacts, equations, claim
        Multipliers of the rows at contacts, of the program's equations, and of "the objective is below the claim".

    Examples
    --------
    >>> Leaf((Contact("C", 1.0, 0.25, 0.5),), (0.1,)).equations
    (0.1,)
    """

    contacts: tuple[Contact, ...] = ()
    equations: tuple[float, ...] = ()
    claim: float = 0.0

    def __post_init__(self) -> None:
        if not all(map(isfinite, (*self.equations, self.claim))):
            raise InputError(f"multipliers of equations and of the claim must be finite numbers, got {shortened(self)}")


@dataclass(frozen=True)
class Tightening(Leaf):
    """A sum of rows that moves one side of a region; where the sides then cross, it closes the region as a leaf does.

    Attributes
    ----------
    variable
        Which variable's side moves.
    side
        1 raises the least value, -1 lowers the greatest.

    Examples
    --------
    >>> Tightening((Contact("power", 1.0, 0.25, 0.5),), (0.1,), variable=0, side=1).side
    1
    """

    variable: int = field(kw_only=True)
    side: int = field(kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.side not in {1, -1}:
            raise InputError(f"a tightening needs a side 1 or -1, got {shortened(self)}")


@dataclass(frozen=True)
class Split:
    """A region cut in two at a value of a variable; what follows in a tree closes the part below first.

    Examples
    --------
    >>> Split(0, 0.25).at
    0.25
    """

    variable: int
    at: float

    def __post_init__(self) -> None:
        if not isfinite(self.at):
            raise InputError(f"a split needs a finite value, got {shortened(self.at)}")


Node = Leaf | Split
Region = TypeVar("Region")


def closes(tree: Iterable[Node], roots: Iterable[Region], after: Callable[[Region, Node], list[Region] | None]) -> bool:
    """Whether a tree leaves no region, where each node is applied to the region that was cut off last.

    `after` gives what remains of a region after a node, and None where it is no node of such regions.
    """
    regions = [*roots]
    for node in tree:
        left = after(regions.pop(), node) if regions else None
        if left is None:
            return False
        regions += left
    return not regions


class PlaceRange(NamedTuple):
    """Places from one to another, and the sign with which the peak is there.

    >>> PlaceRange(1.0, 0.0, 0.5).parts(0.125)[0]
    PlaceRange(sign=1.0, low=0.125, high=0.5)
    """

    sign: float
    low: float
    high: float

    @property
    def k(self) -> float:
        return (self.low + self.high) / 2.0

    @property
    def reach(self) -> float:
        """The distance of the ends from the middle."""
        return (self.high - self.low) / 2.0

    def holds(self, other: PlaceRange) -> bool:
        """Whether the other one is part of it: an end alone is part of no longer one."""
        inside = self.low <= other.low <= other.high <= self.high
        return inside and self.sign == other.sign and (self.low == self.high) == (other.low == other.high)

    def parts(self, at: float) -> list[PlaceRange]:
        """The part of the range above a place, then the part below it."""
        return [self._replace(low=at), self._replace(high=at)]

    def after(self, node: Node) -> list[PlaceRange] | None:
        """The parts between which a split divides the range; None if it is none of them."""
        if isinstance(node, Split) and node.variable == 0 and self.low < node.at < self.high:
            return self.parts(node.at)
        return None
