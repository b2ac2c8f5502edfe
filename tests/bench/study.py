"""What a study costs: laws a second by one process and by two, and memory.

Run it with `python -m tests.bench.study`. `python -m tests.bench.study 100000` takes so many points for the memory, and
`python -m tests.bench.study million` measures a study of a million laws alone.
"""

import os
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from resource import RUSAGE_CHILDREN, RUSAGE_SELF, getrusage
from time import perf_counter
from typing import Any

from rich.console import Console
from rich.table import Table

from optlaws import run_study

RATE, EFFICIENCY = 300.0, 0.9
#: seconds for a million laws
MILLION = 120.0
POINTS = 3200
REPEATS = 3


def asked(points: int, degree: int) -> dict[str, Any]:
    """A study over B, as a user would ask for it."""
    return {"problem": {"order": 4, "degree": degree}, "vary": {"B": {"from": 1.55, "to": 2.5, "steps": points}}}


class Stopwatch:
    """Watches a study from its first chunk, when the processes have started, to its last; and the memory meanwhile."""

    def __init__(self) -> None:
        self.first: tuple[float, int] | None = None
        self.last = (0.0, 0)
        self.megabytes: list[float] = []

    def begin(self, total: int, counts: Mapping[str, int]) -> None:
        """Nothing is measured before the first chunk."""

    def advance(self, counts: Mapping[str, int]) -> None:
        """One chunk or several are done."""
        self.last = (perf_counter(), sum(counts.values()))
        self.first = self.first or self.last
        self.megabytes.append(memory())

    def end(self, counts: Mapping[str, int]) -> None:
        """All is measured."""

    @property
    def rate(self) -> float:
        """Laws a second."""
        assert self.first is not None
        return (self.last[1] - self.first[1]) / (self.last[0] - self.first[0])


def memory() -> float:
    """Megabytes that this process holds; 0 where the system does not tell."""
    file = Path("/proc/self/statm")
    return int(file.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20 if file.exists() else 0.0


def watched(points: int, degree: int, workers: int) -> Stopwatch:
    """A study into a directory that is thrown away."""
    watch = Stopwatch()
    with tempfile.TemporaryDirectory() as out:
        run_study(asked(points, degree), out, workers=workers, watch=watch)
    return watch


def million() -> None:
    """A million laws of least C over B, order and degree by two processes, into the store, to its table."""
    vary = {"order": [2, 3, 4, 5, 6], "degree": list(range(5, 25, 2)), "B": {"from": 1.5, "to": 2.5, "steps": 20_000}}
    with tempfile.TemporaryDirectory() as out:
        began = perf_counter()
        study = run_study({"problem": {}, "vary": vary}, out, workers=2)
        took = perf_counter() - began
        spent = sum(getrusage(who).ru_utime + getrusage(who).ru_stime for who in (RUSAGE_SELF, RUSAGE_CHILDREN))
        print(f"{len(study):,} laws in {took:.0f} s, {spent:.0f} s of processors; aim: under {MILLION:g} s")
        print(study.counts)


def main(points: int = POINTS) -> None:
    """Measure and print."""
    console = Console(width=120)
    table = Table("degree of Z", "1 process, laws/s", "2 processes", "efficiency")
    table.title = f"studies over B, l = 4; aims: {RATE:g}/s at degree 9, efficiency {EFFICIENCY:g}"
    for degree in (5, 9, 19):
        # turn by turn, and the best of each: what else the machine does takes from either
        runs = [[watched(POINTS // 4 * workers, degree, workers).rate for workers in (1, 2)] for _ in range(REPEATS)]
        one, two = map(max, zip(*runs, strict=True))
        efficiency = two / (2.0 * one)
        table.add_row(
            str(degree),
            f"{one:.0f}{' *' if degree == 9 and one < RATE else ''}",
            f"{two:.0f}",
            f"{efficiency:.2f}{' *' if efficiency < EFFICIENCY else ''}",
        )
    console.print(table)
    seen = watched(points, 3, 2).megabytes
    early, late = max(seen[: len(seen) // 5]), max(seen[-len(seen) // 5 :])
    console.print(f"memory over {points} points: {early:.0f} MB in the first fifth, {late:.0f} MB in the last")


if __name__ == "__main__":
    if sys.argv[1:] == ["million"]:
        million()
    else:
        main(*map(int, sys.argv[1:2]))
