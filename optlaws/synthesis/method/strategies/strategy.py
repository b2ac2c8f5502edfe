"""Rounds of solving: what is held is answered, and what the answer breaks is held in the next round."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Generic, TypeVar

Held = TypeVar("Held")
Result_co = TypeVar("Result_co", covariant=True)


class Strategy(ABC, Generic[Held, Result_co]):
    """A way of answering a round.

    Attributes
    ----------
    rounds
        How many it is given.
    """

    rounds: int

    @abstractmethod
    def answered(self, held: Held) -> tuple[Result_co | None, Held | None]:
        """The result, or what the next round holds; neither where this way leads nowhere."""


def cutting_plane_loop(way: Strategy[Held, Result_co], held: Held) -> tuple[Result_co | None, int]:
    """What a way leads to, None where it leads nowhere or its rounds do not do, and the number of rounds."""
    onward: Held | None = held
    count, result = 0, None
    while onward is not None and count < way.rounds:
        count += 1
        result, onward = way.answered(onward)
    return result, count
