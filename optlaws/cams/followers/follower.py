"""What every follower of a disc cam is: lengths with units, which become a contact in numbers once the cam is known."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

from optlaws.cams.followers.contact import Contact
from optlaws.cycles.asked.quantities import quantity
from optlaws.echo import shortened
from optlaws.errors import InputError


@dataclass(frozen=True)
class Place:
    """Where a follower is put: the base circle's radius, the range of its motion, and how the cam turns.

    Parameters
    ----------
    radius
        Distance of the roller's centre, or of the face, from the cam's centre where the follower is lowest, m.
    lowest, highest
        Least and greatest displacement, m or rad.
    slopes
        Least and greatest derivative of the displacement by the cam's angle.
    turning
        1 where the cam turns counterclockwise, else -1.
    """

    radius: float
    lowest: float
    highest: float
    slopes: tuple[float, float]
    turning: float


class Follower(ABC):
    """A follower of a disc cam, as a person gives it."""

    @property
    @abstractmethod
    def axis(self) -> str:
        """Whether it moves by a "length" or an "angle"."""

    @abstractmethod
    def contact(self, place: Place) -> Contact:
        """How it touches a cam.

        Raises
        ------
        InputError
            If there is no such mechanism; the error says the remedy.
        """


def positive(value: Any, name: str) -> float:  # noqa: ANN401 - it is checked here
    """A length above 0, in metres.

    Raises
    ------
    InputError
        If it is none.

    Examples
    --------
    >>> positive("12 mm", "roller")
    0.012
    """
    length = quantity(value, "length", name)
    if length <= 0.0:
        raise InputError(f"{name} must be above 0, got {shortened(value)}")
    return length


def roller_radius(value: Any, place: Place) -> float:  # noqa: ANN401 - it is checked here
    """The radius of a roller whose centre runs on a base circle, in metres.

    Raises
    ------
    InputError
        If it is none, or nothing would be left of the cam.

    Examples
    --------
    >>> roller_radius("12 mm", Place(0.08, 0.0, 0.03, (-0.1, 0.1), 1.0))
    0.012
    """
    radius = positive(value, "roller: radius")
    if radius >= place.radius:
        raise InputError(
            f"roller: its radius {shown(radius)} is not less than that of the base circle, {shown(place.radius)}, on"
            " which its centre runs: nothing is left of the cam: make the roller smaller or the base circle larger"
        )
    return radius


def shown(length: float) -> str:
    """A length in millimetres.

    Examples
    --------
    >>> shown(0.08)
    '80 mm'
    """
    return f"{1e3 * length:.9g} mm"
