"""What a study costs: laws a second by one process and by two, where the time goes, and memory.

Run it with `python -m tests.bench.study`; `make bench` ends with it. `python -m tests.bench.study 100000` takes so many
points for the memory, and `python -m tests.bench.study million` measures a study of a million laws alone; `process` and
`array` measure the memory of a process after many mixed problems, and of an array of a million laws.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from pkgutil import resolve_name
from resource import RUSAGE_CHILDREN, RUSAGE_SELF, getrusage
from time import perf_counter, process_time
from typing import Any
from unittest.mock import patch

import msgspec
import numpy as np
from rich.console import Console
from rich.table import Table

from optlaws import (
    Chebyshev,
    OptlawsError,
    Problem,
    ProblemArray,
    Window,
    at_most,
    run_study,
    synthesize,
    synthesize_array,
)
from tests.internals.studies import StudyPoints, Task, blocks, read_study, task

RATE, EFFICIENCY = 300.0, 0.9
#: seconds for a million laws
MILLION = 120.0
POINTS = 3200
REPEATS = 3
#: megabytes of a process after many mixed problems, of an array of a million laws; and when the first are read
PROCESS, ARRAY = 150.0, 1024.0
READINGS = (0, 100, 500, 1_000, 2_000)


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


PARTS = {
    "programs": ("optlaws.synthesis.method.exchange.answer_on_points",),
    "Newton": ("optlaws.synthesis.method.contacts.newton",),
    "proof": ("optlaws.synthesis.search.certify",),
    "synthesis": ("optlaws.studies.chunk.synthesize", "optlaws.studies.chunk.solved"),
    "constants": ("optlaws.studies.chunk._of_solution", "optlaws.studies.chunk._of_solutions"),
}


def shares(points: int, degree: int) -> dict[str, float]:
    """Shares of the processor time that a study takes in one process; what is outside all parts is the study's own."""
    study = read_study(asked(points, degree))
    grid = StudyPoints.of(study)
    tasks = [msgspec.convert(task(study, grid, number), Task) for number in range(grid.chunks)]
    list(blocks(tasks[0]))
    spent: dict[str, float] = {}
    with ExitStack() as stack:
        for name, functions in PARTS.items():
            spent[name] = 0.0
            for function in functions:
                stack.enter_context(patch(function, side_effect=_timed(name, resolve_name(function), spent)))
        began = process_time()
        for one in tasks[1:]:
            list(blocks(one))
        whole = process_time() - began
    found = {name: seconds / whole for name, seconds in spent.items()}
    synthesis = found.pop("synthesis")
    found["other synthesis"] = synthesis - sum(found[name] for name in ("programs", "Newton", "proof"))
    found["study"] = 1.0 - synthesis - found["constants"]
    return found


def _timed(name: str, function: Callable[..., object], spent: dict[str, float]) -> Callable[..., object]:
    def run(*arguments: object, **options: object) -> object:
        began = process_time()
        try:
            return function(*arguments, **options)
        finally:
            spent[name] += process_time() - began

    return run


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


def mixed(random: np.random.Generator) -> Problem:
    """A problem as users may have them in turn: some have no law."""
    entries: tuple[dict[str, Any], ...] = (
        {},
        {"B": at_most(2.0)},
        {"B": round(random.uniform(1.0, 1.2), 3)},
        {"symmetric": True},
        {"windows": (Window("b", 0.5, 3.0, 0.4, 0.6),)},
        {"bounds": {"rms_c": at_most(round(random.uniform(3.5, 8.0), 2))}},
    )
    shared = {
        "B": round(random.uniform(1.3, 2.6), 3),
        "order": int(random.integers(2, 7)),
        "basis": Chebyshev(int(random.choice((3, 5, 7, 9, 12, 15, 19)))),
        "minimise": str(random.choice(("C", "D", "J", "rms_c", "C + 0.1*J"))),
    }
    return Problem(**{**shared, **entries[random.integers(len(entries))]})


def process() -> None:
    """Memory of a process from its imports to its last mixed problem."""
    random, failed = np.random.default_rng(20010), 0
    for number in range(READINGS[-1] + 1):
        if number in READINGS:
            print(f"{number:5} mixed problems, {failed} without a law: {memory():.0f} MB")
        try:
            synthesize(mixed(random))
        except OptlawsError:
            failed += 1
    print(f"aim: {PROCESS:g} MB")


def array() -> None:
    """The most memory of an array of a million laws, their constants, bounds and statuses."""
    laws = synthesize_array(ProblemArray(B=np.linspace(1.42, 2.6, 1_000_000), order=4, basis=Chebyshev(9)))
    assert all(np.isfinite(getattr(laws, name)).all() for name in ("C", "D", "J", "rms_c", "gap"))
    assert (laws.status == "optimal").all()
    most = getrusage(RUSAGE_SELF).ru_maxrss / 1024
    print(f"an array of {laws.size:,} laws: {most:.0f} MB at most; aim: {ARRAY:g} MB")


def main(points: int = POINTS) -> None:
    """Measure and print."""
    console = Console(width=120)
    parts = ("programs", "Newton", "proof", "other synthesis", "constants", "study")
    table = Table("degree of Z", "1 process, laws/s", "2 processes", "efficiency", *parts)
    table.title = f"studies over B, l = 4; aims: {RATE:g}/s at degree 9, efficiency {EFFICIENCY:g}; shares of the time"
    for degree in (5, 9, 19):
        # turn by turn, and the best of each: what else the machine does takes from either
        runs = [[watched(POINTS // 4 * workers, degree, workers).rate for workers in (1, 2)] for _ in range(REPEATS)]
        one, two = map(max, zip(*runs, strict=True))
        spent = shares(1280, degree)
        efficiency = two / (2.0 * one)
        table.add_row(
            str(degree),
            f"{one:.0f}{' *' if degree == 9 and one < RATE else ''}",
            f"{two:.0f}",
            f"{efficiency:.2f}{' *' if efficiency < EFFICIENCY else ''}",
            *(f"{spent[name]:.0%}" for name in parts),
        )
    console.print(table)
    seen = watched(points, 3, 2).megabytes
    early, late = max(seen[: len(seen) // 5]), max(seen[-len(seen) // 5 :])
    console.print(f"memory over {points} points: {early:.0f} MB in the first fifth, {late:.0f} MB in the last")
    for part in ("process", "array"):
        # what this process has imported and solved is none of theirs
        subprocess.run([sys.executable, "-m", "tests.bench.study", part], check=True)


if __name__ == "__main__":
    alone = {"million": million, "process": process, "array": array}
    if sys.argv[1:2] and sys.argv[1] in alone:
        alone[sys.argv[1]]()
    else:
        main(*map(int, sys.argv[1:2]))
