"""Rounds of any way: the result ends them, so does a way that leads nowhere, and there are no more than it is given."""

from dataclasses import dataclass, field

import pytest

from tests.internals.synthesis import Strategy, cutting_plane_loop


@dataclass
class Counting(Strategy[int, str]):
    """Counts upward until it has a result or gives up."""

    rounds: int
    done_at: int | None = None
    gives_up_at: int | None = None
    seen: list[int] = field(default_factory=list)

    def answered(self, held: int) -> tuple[str | None, int | None]:
        self.seen.append(held)
        if held == self.done_at:
            return f"found at {held}", None
        return None, None if held == self.gives_up_at else held + 1


@pytest.mark.parametrize(
    ("way", "result", "count"),
    [
        (Counting(5, done_at=2), "found at 2", 3),
        (Counting(3, done_at=2), "found at 2", 3),
        (Counting(2, done_at=2), None, 2),
        (Counting(5, gives_up_at=1), None, 2),
        (Counting(0, done_at=0), None, 0),
    ],
)
def test_each_round_holds_what_the_last_one_led_to(way: Counting, result: str | None, count: int) -> None:
    assert cutting_plane_loop(way, 0) == (result, count)
    assert way.seen == list(range(count))
