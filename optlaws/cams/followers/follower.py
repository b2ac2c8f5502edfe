"""Base class of the followers of disc cams: lengths with units that become a contact in numbers, and kinds by name."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from importlib import import_module
from typing import Any, ClassVar, Self

from optlaws.cams.followers.contact import FollowerContact
from optlaws.entries.declared import Kinded
from optlaws.errors import InputError
from optlaws.motion.quantities import quantity
from optlaws.numbers import NumberOrQuantity
from optlaws.sentences import Amount


@dataclass(frozen=True)
class Place:
    """The place of a follower: the radius of the prime circle, the range of its motion, and the sense of turning.

    `radius` is the distance of the roller's centre, or of the face, from the cam's centre where the follower is lowest,
    m; displacements are in m or rad, `slopes` their least and greatest derivative by the cam's angle; `turning` is 1
    where the cam turns counterclockwise, else -1.
    """

    radius: float
    lowest: float
    highest: float
    slopes: tuple[float, float]
    turning: float


class CamFollower(Kinded, ABC, title="a follower"):
    """A follower of a disc cam, as a person gives it.

    A kind is a declared class, which is known by its kind: nothing else names it.
    """

    #: whether it moves by a "length" or an "angle"
    axis: ClassVar[str]
    #: its entries that are lengths, from which its size follows
    lengths: ClassVar[tuple[str, ...]] = ()
    #: the limit that is linear in the law and says the least prime circle of all laws; None where none is
    sizing_limit: ClassVar[str | None] = None

    @classmethod
    def kinds(cls) -> dict[str, type[Self]]:
        """The kinds of followers by their names in problem files, those of this folder among them."""
        for module in ("faces", "rollers"):
            import_module(f"{__package__}.{module}")
        # slides before arms, whichever was imported first
        return dict(sorted(super().kinds().items(), reverse=True))

    @abstractmethod
    def contact(self, place: Place) -> FollowerContact:
        """How it touches a cam."""

    @abstractmethod
    def prime_radius(self, level: float) -> float:
        """The radius of the prime circle on which the follower's contact is at a `level` when lowest, m."""

    @property
    def size(self) -> float:
        """The greatest length of the follower, m."""
        return max((abs(quantity(getattr(self, name), "length", name)) for name in self.lengths), default=0.0)

    @property
    def pivot(self) -> NumberOrQuantity | None:
        """The distance of the pivot from the cam's centre; None on a slide."""
        distance: NumberOrQuantity | None = getattr(self, "pivot_distance", None)
        return distance

    def from_beneath(self) -> CamFollower:
        """The same follower on its slide, seen from below the shaft."""
        return self


def positive(value: Any, name: str) -> float:
    """A length above 0, in metres."""
    return quantity(value, "length", name, above=0.0)


def roller_radius(value: Any, place: Place) -> float:
    """The radius of a roller whose centre rests on a prime circle where it is lowest, in metres."""
    radius = positive(value, "roller: radius")
    if radius >= place.radius:
        raise InputError(
            f"roller: its radius {shown(radius)} is not less than that of the prime circle, {shown(place.radius)}, on"
            " which its centre runs: the cam would have no material: make the roller smaller or the prime circle larger"
        )
    return radius


def stated_prime_radius(prime_radius: Any, base_radius: Any, follower: CamFollower) -> Any:
    """The prime radius from the entries of a file; earlier files call it `base_radius`, as under a flat face.

    Raises
    ------
    InputError
        If there is a `base_radius` beside it, or under a roller, where the two circles differ.

    Examples
    --------
    >>> from optlaws import TranslatingFlat
    >>> stated_prime_radius(None, "28 mm", TranslatingFlat())
    '28 mm'
    """
    if base_radius is None:
        return prime_radius
    if prime_radius is not None:
        raise InputError("base_radius: prime_radius gives the size of the cam: leave base_radius out")
    roller = getattr(follower, "radius", None)
    if roller is None:
        return base_radius
    prime = positive(base_radius, "base_radius") + positive(roller, "roller: radius")
    raise InputError(
        "base_radius: in earlier files it was the distance of the roller's centre, which is the prime circle: write"
        f" prime_radius = {base_radius!r} for the same cam, or prime_radius = '{shown(prime)}' if the base circle of"
        f" the profile has {base_radius}"
    )


def shown(length: float) -> Amount:
    """A length in millimetres."""
    return Amount(1e3 * length, "mm", 9)


def follower_names() -> str:
    """Names of the classes, as an error lists them."""
    *names, last = [kind.__name__ for kind in CamFollower.kinds().values()]
    return f"{', '.join(names)} or {last}"
