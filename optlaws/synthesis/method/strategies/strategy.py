"""The cutting-plane loop: a subproblem is solved, and the constraints that its answer violates join the next one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Generic, TypeVar

Subproblem = TypeVar("Subproblem")
Result_co = TypeVar("Result_co", covariant=True)


class Strategy(ABC, Generic[Subproblem, Result_co]):
    """How the subproblem of a round is solved.

    Attributes
    ----------
    rounds
        The most rounds that it is given.
    """

    rounds: int

    @abstractmethod
    def answered(self, subproblem: Subproblem) -> tuple[Result_co | None, Subproblem | None]:
        """The result, or the subproblem of the next round; neither where the strategy fails."""


def cutting_plane_loop(
    strategy: Strategy[Subproblem, Result_co], subproblem: Subproblem
) -> tuple[Result_co | None, int]:
    """The result of a strategy, None where it fails or its rounds do not suffice, and the number of rounds."""
    onward: Subproblem | None = subproblem
    count, result = 0, None
    while onward is not None and count < strategy.rounds:
        count += 1
        result, onward = strategy.answered(onward)
    return result, count
