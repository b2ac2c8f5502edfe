"""Certified laws a second where B is an array, beside what a good user of HiGHS does: one model kept and warm started.

The rival minimises C at 200 points of the half interval, without proof and to what points show; its row bounds are
changed by one vectorised call for each B. Every time counts all: the walk from one structure to the next, the laws,
their verification and their bounds; nothing is kept from one run to the next.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from statistics import median
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from optlaws import (
    Chebyshev,
    Problem,
    ProblemArray,
    SolutionArray,
    pareto_front,
    proven_front,
    synthesize,
    synthesize_array,
    synthesize_many,
)
from tests.bench.plain import POINTS, Rows, power_by_slsqp

Array = NDArray[np.float64]

DEGREES = (5, 9, 19, 39)
ENDS = (1.42, 2.6)
#: laws in a run, with the laws a second that are aimed at by degree
AIMS = {4_000: (50_000, 40_000, 18_000, 8_000), 40_000: (150_000, 100_000, 60_000, 25_000)}
#: of the rival's time a law, for 4,000 laws
SHARES = (1 / 8, 1 / 8, 1 / 5, 1 / 4)
#: laws of least D a second, solutions a second of ready problems, and seconds of a front of 1,000 points; degree 9
POWERS, SOLUTIONS, FRONT = 1_000, 15_000, 0.3
#: milliseconds a law in small arrays, by how many
SMALL = {10: 1.0, 100: 0.3}
#: of the time that SLSQP takes for a law of least D, from one start and without proof; and where it is asked
POWER_SHARE, POWER_VELOCITIES = 1 / 3, (1.5, 1.641, 1.8, 2.0, 2.2)
REPEATS = 3
RIVALS = 200


@dataclass(frozen=True)
class Run:
    """Seconds of the processor, and what was solved in them."""

    seconds: float
    laws: SolutionArray


def run(degree: int, count: int, minimise: str = "C") -> Run:
    """The median of some runs over as many B."""
    problems = ProblemArray(B=np.linspace(*ENDS, count), order=4, basis=Chebyshev(degree), minimise=minimise)
    times = []
    for _ in range(REPEATS):
        began = process_time()
        laws = synthesize_array(problems)
        times.append(process_time() - began)
    return Run(median(times), laws)


class WarmHighs:
    """One model of HiGHS that is kept: simplex without presolve, each B begun at the vertex of the one before."""

    def __init__(self, problem: Problem) -> None:
        highspy: Any = import_module("highspy")
        self.rows = Rows(problem)
        free, one = self.rows.b.shape[1], np.ones((POINTS, 1))
        matrix = np.block([[self.rows.c, -one], [-self.rows.c, -one], [self.rows.b, np.zeros((POINTS, 1))]])
        self.model = highspy.Highs()
        self.model.setOptionValue("output_flag", False)  # noqa: FBT003 - it has no name
        self.model.setOptionValue("presolve", "off")
        self.model.setOptionValue("solver", "simplex")
        infinite = highspy.kHighsInf
        columns = free + 1
        self.model.addVars(columns, np.full(columns, -infinite), np.full(columns, infinite))
        self.model.changeColsCost(1, np.array([free], dtype=np.int32), np.ones(1))
        fixed = np.concatenate([-self.rows.c0, self.rows.c0, -self.rows.b0])
        entries = np.arange(matrix.size, dtype=np.int32)
        self.model.addRows(
            len(matrix),
            np.full(len(matrix), -infinite),
            fixed,
            matrix.size,
            entries[::columns].copy(),
            np.asarray(entries % columns, dtype=np.int32),
            matrix.reshape(-1),
        )
        self.places = np.arange(2 * POINTS, 3 * POINTS, dtype=np.int32)

    def least(self, B: float) -> float:
        """The least C at this B, as the points show it."""
        low, high = -B - self.rows.b0, B - self.rows.b0
        low[-1] = high[-1]
        self.model.changeRowsBounds(POINTS, self.places, low, high)
        self.model.run()
        return float(self.model.getInfo().objective_function_value)


def rival(degree: int) -> float:
    """Seconds a law of the rival."""
    warm = WarmHighs(Problem(B=ENDS[0], order=4, basis=Chebyshev(degree)))
    warm.least(ENDS[0])
    began = process_time()
    for B in np.linspace(*ENDS, RIVALS).tolist():
        warm.least(B)
    return (process_time() - began) / RIVALS


def seconds(work: Callable[[], object]) -> float:
    """The median of some runs, of the processor's time."""
    times = []
    for _ in range(REPEATS):
        began = process_time()
        work()
        times.append(process_time() - began)
    return median(times)


def others(console: Console) -> None:
    """What else is solved in arrays: least power, root mean squares, solutions one by one, fronts."""
    table = Table("degree 9", "laws", "measured", "aim", title="other uses of arrays, one process")
    for minimise, aim in (("D", f"{POWERS:,}/s"), ("rms_c", ""), ("J", "")):
        outcome = run(9, 4_000, minimise)
        table.add_row(f"least {minimise}", "4,000", f"{4_000 / outcome.seconds:,.0f}/s", aim)
    for count, most in SMALL.items():
        each = 1e3 * run(9, count).seconds / count
        table.add_row("least C", str(count), f"{each:.2f} ms a law{'' if each <= most else '*'}", f"{most:g} ms")
    problem = Problem(order=4, basis=Chebyshev(9))
    ready = [replace(problem, B=B) for B in np.linspace(*ENDS, 4_000).tolist()]
    many = seconds(lambda: [one.objective for one in synthesize_many(ready)])
    table.add_row("synthesize_many", "4,000", f"{4_000 / many:,.0f}/s", f"{SOLUTIONS:,}/s")
    table.add_row(
        "pareto_front", "1,000", f"{seconds(lambda: pareto_front(problem, points=1_000)):.2f} s", f"{FRONT} s"
    )
    for name, share in power_shares(problem).items():
        table.add_row(f"least D {name} / SLSQP", "", f"{share:.3f}{'' if share <= POWER_SHARE else '*'}", "0.333")
    proven = seconds(lambda: proven_front(problem, between=ENDS))
    table.add_row("proven_front to 1e-9", str(len(proven_front(problem, between=ENDS))), f"{proven:.2f} s", "")
    console.print(table)


def by_slsqp(problem: Problem, B: float) -> None:
    """The law of least D by SLSQP, its rows made for it."""
    power_by_slsqp(Rows(problem), B)


def power_shares(problem: Problem) -> dict[str, float]:
    """Time of a law of least D with its bound, of that of SLSQP with its rows made: alone, and among 1,000 laws."""
    asked = [replace(problem, B=B, minimise="D") for B in POWER_VELOCITIES]
    rivals, alone = [], []
    for one, B in zip(asked, POWER_VELOCITIES, strict=True):
        rivals.append(seconds(partial(by_slsqp, one, B)))
        alone.append(seconds(partial(synthesize, one)))
    velocities = np.linspace(POWER_VELOCITIES[0], POWER_VELOCITIES[-1], 1_000)
    many = ProblemArray(B=velocities, order=problem.order, basis=problem.basis, minimise="D")
    rival = sum(rivals)
    return {
        "alone": sum(alone) / rival,
        "in an array": seconds(lambda: synthesize_array(many)) / many.size * len(rivals) / rival,
    }


def main(degrees: tuple[int, ...] = DEGREES) -> None:
    """Measure once and print."""
    headings = ("degree of Z", *(f"{count:,} laws" for count in AIMS), "alone", "us a law", "HiGHS us", "ratio")
    table = Table(*headings, title=f"certified laws/s, B from {ENDS[0]} to {ENDS[1]} (* aim missed)")
    for degree in degrees:
        place = DEGREES.index(degree)
        cells, alone = [], 0
        synthesize_array(ProblemArray(B=np.linspace(*ENDS, 200), order=4, basis=Chebyshev(degree)))
        for count, aims in AIMS.items():
            outcome = run(degree, count)
            speed = count / outcome.seconds
            alone += len(outcome.laws.others)
            cells.append(f"{speed:,.0f}{'' if speed >= aims[place] else '*'}")
            if count == min(AIMS):
                own = outcome.seconds / count
        other = rival(degree)
        share = own / other
        cells += [
            str(alone),
            f"{1e6 * own:.0f}",
            f"{1e6 * other:.0f}",
            f"{share:.3f}{'' if share <= SHARES[place] else '*'}",
        ]
        table.add_row(str(degree), *cells)
    console = Console(width=120)
    console.print(table)
    others(console)


if __name__ == "__main__":
    main()
