"""How the time of a result grows with its size, and what its bound leaves: degrees, pieces, segments, counts, points.

`python -m tests.bench.growth` prints a table. Times are of the processor, the least of some runs.
"""

import random
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from time import process_time
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from optlaws import (
    BSplines,
    Chebyshev,
    Cycle,
    Dwell,
    Free,
    Move,
    Pieces,
    Problem,
    ProblemArray,
    Return,
    Rise,
    pareto_front,
    synthesize,
    synthesize_array,
)

DEGREES = (3, 5, 9, 13, 19, 29, 39, 61, 81, 101, 151, 200)
PIECES = (2, 4, 8, 16, 32, 50, 100, 150, 200)
SEGMENTS = (2, 5, 10, 20, 50, 100, 200)
FREE = SEGMENTS[1:]  # a dwell and one motion would have nowhere to go
COUNTS = (1, 10, 100, 1_000, 10_000, 100_000)
POINTS = (10, 100, 1_000, 10_000)
ROWS = (100, 1_000, 10_000, 65_536)
#: runs of which the fastest counts, where one takes less than so many seconds
REPEATS, SHORT = 3, 0.5
PRESS = ("0.5 m/s", "20 m/s^2")

#: what a run leads to: the status, and what the bound leaves of the objective; None where nothing is proven
Outcome = tuple[str, float | None]


@dataclass(frozen=True)
class Growth:
    """A kind of result that grows: its name, what is counted, the sizes, and what is run."""

    name: str
    counted: str
    sizes: tuple[int, ...]
    run: Callable[[int], Outcome]


@dataclass(frozen=True)
class Measured:
    """One result: its kind, its size, seconds of the processor, its status and gap."""

    name: str
    counted: str
    size: int
    seconds: float
    status: str
    gap: float | None


def law(order: int, degree: int, *, monotone: bool) -> Outcome:
    """The law of least C at B = 1.641."""
    return proven(Problem(B=1.641, order=order, basis=Chebyshev(degree), monotone=monotone))


def proven(problem: Problem) -> Outcome:
    """A law and what its bound leaves."""
    solution = synthesize(problem)
    return str(solution.status), solution.gap


def of_pieces(minimise: str, count: int) -> Outcome:
    """The law of so many free pieces."""
    return proven(Problem(order=3, B=1.8, basis=Pieces(count), minimise=minimise))


def of_splines(count: int) -> Outcome:
    """The law whose Z is of so many pieces."""
    return proven(Problem(order=3, B=1.8, basis=BSplines(count, 3)))


@lru_cache
def positions(count: int) -> tuple[int, ...]:
    """Positions in millimetres, of which no two that follow each other are the same; the last is 0."""
    drawn, places = random.Random(1), [0]  # noqa: S311 - the same for every run
    for _ in range(count - 1):
        places.append(drawn.choice([place for place in range(10, 61, 10) if place != places[-1]]))
    return (*places[1:], 0)


def moves(count: int, law: str = "optimal", **others: Any) -> Cycle:
    """A cycle of moves of 50 ms from rest to rest."""
    segments = [Move(to=f"{place} mm", duration="50 ms", law=law) for place in positions(count)]
    return Cycle(segments, period=f"{50 * count} ms", **others)


def free_motions(count: int, **others: Any) -> Cycle:
    """A cycle of a dwell and free motions of 50 ms, which are one law together."""
    segments = [Free(to=f"{place} mm", duration="50 ms") for place in positions(count - 1)]
    return Cycle([Dwell("20 ms"), *segments], period=f"{20 + 50 * (count - 1)} ms", **others)


def in_proportion(count: int) -> Outcome:
    """The greatest speed of a cycle of moves that take equal angles."""
    segments = [Move(to=f"{place} mm", duration=f"{360 / count!r} deg") for place in positions(count)]
    velocity, acceleration = PRESS
    limits = {"velocity": velocity, "acceleration": acceleration}
    fastest = Cycle(segments, speed="1 rpm", limits=limits).fastest()
    assert fastest.lower_bound is not None
    return str(fastest.status), fastest.period / fastest.lower_bound - 1.0


def cycle(make: Callable[[int], Cycle], count: int) -> Outcome:
    """A cycle with its laws and what its bound leaves; given laws have none."""
    whole = make(count)
    value, bound = whole.objective, whole.lower_bound
    return str(whole.status), value / bound - 1.0 if bound and whole.solutions else None


def array(count: int) -> Outcome:
    """Laws along B, of degree 9."""
    laws = synthesize_array(ProblemArray(B=np.linspace(1.42, 2.6, count), order=4, basis=Chebyshev(9)))
    return "optimal" if (laws.status == "optimal").all() else "mixed", float(laws.gap.max())


def front(count: int) -> Outcome:
    """A front of B and C, of degree 9."""
    solutions = pareto_front(Problem(order=4, basis=Chebyshev(9)), points=count).points
    statuses = {str(solution.status) for solution in solutions}
    return "optimal" if statuses == {"optimal"} else "mixed", max(solution.gap for solution in solutions)


@lru_cache
def press() -> Cycle:
    """A cycle that is exported."""
    segments = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()]
    return Cycle(segments, speed="200 rpm")


def table(count: int) -> Outcome:
    """A table of so many points, with its report."""
    press().export("csv", points=count)
    return "", None


def limited(count: int) -> Cycle:
    """Moves within a limit of the velocity."""
    return moves(count, limits={"velocity": "1.6 m/s"})


GROWTHS = (
    Growth("law, l = 4, 0 <= b", "degree of Z", DEGREES, partial(law, 4, monotone=True)),
    Growth("law, l = 3", "degree of Z", DEGREES, partial(law, 3, monotone=False)),
    Growth("free pieces, C", "pieces", PIECES, partial(of_pieces, "C")),
    Growth("free pieces, J", "pieces", PIECES, partial(of_pieces, "J")),
    Growth("free pieces, rms c", "pieces", PIECES, partial(of_pieces, "rms_c")),
    Growth("Z in B-splines, C", "pieces", PIECES, of_splines),
    Growth("given laws", "segments", SEGMENTS, partial(cycle, partial(moves, law="cycloidal"))),
    Growth("optimal moves", "segments", SEGMENTS, partial(cycle, moves)),
    Growth("moves, velocity limit", "segments", SEGMENTS, partial(cycle, limited)),
    Growth("greatest speed of moves", "segments", SEGMENTS, in_proportion),
    Growth("free motions, acceleration", "segments", FREE, partial(cycle, free_motions)),
    Growth(
        "free motions, velocity limit",
        "segments",
        FREE,
        partial(cycle, partial(free_motions, limits={"velocity": "2 m/s"})),
    ),
    Growth(
        "free motions, rms acceleration",
        "segments",
        FREE,
        partial(cycle, partial(free_motions, minimise="rms acceleration")),
    ),
    Growth("free motions, rms jerk", "segments", FREE, partial(cycle, partial(free_motions, minimise="rms jerk"))),
    Growth("free motions, jerk", "segments", FREE, partial(cycle, partial(free_motions, minimise="jerk"))),
    Growth("array", "laws", COUNTS, array),
    Growth("front", "points", POINTS, front),
    Growth("exported table", "points", ROWS, table),
)


def measured(growth: Growth, size: int) -> Measured:
    """One result and the least time of some runs."""
    times: list[float] = []
    outcome: Outcome = ("", None)
    while not times or (len(times) < REPEATS and times[0] < SHORT):
        began = process_time()
        outcome = growth.run(size)
        times.append(process_time() - began)
    return Measured(growth.name, growth.counted, size, min(times), *outcome)


def exponent(rows: list[Measured]) -> float:
    """The slope of the seconds over the greater half of the sizes, both by their logarithms."""
    last = rows[-max(3, (len(rows) + 1) // 2) :]
    return float(np.polyfit(np.log([row.size for row in last]), np.log([row.seconds for row in last]), 1)[0])


def main() -> None:
    """Measure once and print."""
    printed = Table("kind", "sizes", "seconds", "exponent", "greatest gap", "status", title="growth")
    for growth in GROWTHS:
        growth.run(growth.sizes[0])
        rows = [measured(growth, size) for size in growth.sizes]
        gaps = [row.gap for row in rows if row.gap is not None]
        printed.add_row(
            growth.name,
            f"{rows[0].size:,} to {rows[-1].size:,} {growth.counted}",
            f"{rows[0].seconds:.3g} to {rows[-1].seconds:.3g}",
            f"{exponent(rows):.2f}",
            f"{max(gaps):.1e}" if gaps else "",
            ", ".join(sorted({row.status for row in rows if row.status})),
        )
    Console(width=140).print(printed)


if __name__ == "__main__":
    main()
