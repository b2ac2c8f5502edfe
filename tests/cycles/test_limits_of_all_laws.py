"""Every least time says beside it what no law of any degree beats, or that it is not known."""

from collections.abc import Callable, Iterable
from typing import Any

import pytest

from optlaws import Axes, Cycle, Drive, Dwell, Mechanism, Motor, Move, Problem, Return, Rise, fastest, fastest_moves

LIMITS: dict[str, Any] = {"velocity": "1 m/s", "acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
TABLE = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", peak_torque="4 N m", greatest_speed="900 rpm"), ratio=20)
SLIDE = Cycle([Rise("35 mm", "120 deg"), Dwell("60 deg"), Return()], speed="60 rpm", limits=LIMITS)
RESTING = Cycle(
    [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "120 deg"), Dwell()], speed="60 rpm", limits=LIMITS
)


def passing(limits: dict[str, Any] = LIMITS) -> Cycle:
    """A slide that passes a place at a velocity of its own."""
    moves = [
        Move("30 mm", "90 deg", end_velocity="0.3 m/s"),
        Move("20 mm", "90 deg", start_velocity="0.3 m/s"),
        Move("-50 mm"),
    ]
    return Cycle(moves, speed="60 rpm", limits=limits)


RESULTS: dict[str, Callable[[], Any]] = {
    "a move": lambda: fastest(Problem(order=3), stroke="100 mm", limits=LIMITS),
    "a move whose end moves": lambda: fastest(Problem(order=3), stroke="100 mm", limits=LIMITS, end_velocity="0.2 m/s"),
    "a move with a motor": lambda: fastest(Problem(order=3), stroke="45 deg", limits={}, drive=TABLE),
    "moves": lambda: fastest_moves(Problem(order=3), strokes=["10 mm", "20 mm"], limits=LIMITS)[1],
    "a cycle": SLIDE.fastest,
    "a cycle whose ends move": lambda: passing().fastest(),
    "a cycle with a drive": lambda: Cycle(
        [Rise("35 mm", "180 deg"), Return()], speed="60 rpm", drive={"mass": "2 kg"}, limits={"force": "40 N"}
    ).fastest(),
    "a start cam": lambda: SLIDE.run_in("60 deg"),
    "axes": lambda: Axes({"slide": RESTING}).fastest(),
}


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", RESULTS)
def test_every_least_time_says_what_no_law_beats_or_that_it_is_not_known(name: str) -> None:
    result = RESULTS[name]()
    rows: Iterable[Any] = result.summary()
    (row,) = (row for row in rows if row.name == "best possible")
    known = getattr(result, "best_possible", None)
    if row.text() == "not known":
        assert row.note == "for laws of any degree"
        assert known is None
    else:
        least = getattr(result, "period", None) or result.duration
        assert row.value <= least * (1.0 + 1e-9)
        assert known in {None, row.value}
        assert row.note.startswith(("no law of any degree takes less", "no law that never turns back takes less"))


@pytest.mark.parametrize("left", [(), ("velocity",), ("jerk",), ("velocity", "acceleration")])
def test_the_limit_of_a_cycle_whose_ends_move_is_that_of_its_slowest_move(left: tuple[str, ...]) -> None:
    limits = {name: most for name, most in LIMITS.items() if name not in left}
    least = passing(limits).fastest()
    assert least.best_possible is not None
    assert least.best_possible <= least.period
    velocity = f"{0.3 / least.best_possible!r} m/s"  # it turns with the master, which takes 1 s
    move = fastest(Problem(order=3), stroke="20 mm", limits=limits, start_velocity=velocity)
    assert move.best_possible == pytest.approx(least.best_possible / 4.0, rel=1e-9)
