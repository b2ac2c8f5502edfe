"""What is timed, and the tables that say so."""

import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
import scipy
from rich.console import Console
from rich.table import Table

import optlaws
from optlaws import Chebyshev, Problem, Solution, sweep, synthesize
from tests.bench.plain import Answer, Rows, highs, opti
from tests.documents import ROOT

DEGREES = (3, 9, 19, 41)
FIRST = Problem(B=1.641, order=4, monotone=True)
VELOCITIES = np.linspace(1.55, 2.5, 100)
REPEATS = 7
COLD = (
    "import casadi, time\n"
    "from optlaws import *\n"
    "casadi.nlpsol('x', 'ipopt', {{'x': (x := casadi.MX.sym('x')), 'f': x * x}}, {{'print_time': False, "
    "'ipopt.print_level': 0, 'ipopt.sb': 'yes'}})(x0=1)\n"
    "began = time.perf_counter()\n"
    "synthesize({problem!r})\n"
    "print(time.perf_counter() - began)"
)


@dataclass(frozen=True)
class Row:
    """Seconds a law takes, by way of asking, and what the plain ways answer."""

    problem: Problem
    solution: Solution
    cold: float
    single: float
    swept: float
    by_opti: float
    by_highs: float
    from_opti: Answer
    from_highs: Answer


def seconds(task: Callable[[], object], repeats: int = REPEATS) -> float:
    """Median wall time."""
    times = []
    for _ in range(repeats):
        began = perf_counter()
        task()
        times.append(perf_counter() - began)
    return median(times)


def python(*arguments: str) -> str:
    """What a fresh interpreter prints."""
    done = subprocess.run([sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout


def measured(degree: int) -> Row:
    """All ways of asking for one degree."""
    problem = replace(FIRST, basis=Chebyshev(degree))
    family = [replace(problem, B=float(B)) for B in VELOCITIES]
    # a cold law is the first of its shape, in a process that has loaded CasADi and IPOPT
    cold = median(float(python("-c", COLD.format(problem=problem))) for _ in range(3))
    solution = synthesize(problem)
    # their rows do not depend on B and are made beforehand, as those of a known shape are in optlaws
    rows = Rows(problem)
    from_opti, from_highs = (rows.judged(solve(rows, problem.B)) for solve in (opti, highs))
    return Row(
        problem=problem,
        solution=solution,
        cold=cold,
        single=seconds(lambda: synthesize(problem), 15),
        swept=seconds(lambda: list(sweep(family)), 3) / len(family),
        by_opti=seconds(lambda: opti(rows, problem.B)),
        by_highs=seconds(lambda: highs(rows, problem.B)),
        from_opti=from_opti,
        from_highs=from_highs,
    )


def times_table(rows: Sequence[Row]) -> Table:
    """Milliseconds a law."""
    headings = ("degree of Z", "cold", "single", "along B", "Opti, IPOPT", "linprog, HiGHS")
    table = Table(*headings, title="ms a law: l = 4, 0 <= b <= B = 1.641; along B: 1.55 to 2.5")
    for row in rows:
        times = (row.cold, row.single, row.swept, row.by_opti, row.by_highs)
        table.add_row(str(row.problem.basis.degree), *(f"{1e3 * value:.2f}" for value in times))
    return table


def ratios_table(rows: Sequence[Row]) -> Table:
    """Ratios to the plain ways, beside the aims."""
    headings = ("degree of Z", "single / Opti", "single / linprog", "along B / Opti")
    table = Table(*headings, title="ratios (aims: at most 1/10, 2 and 1/100; * missed)")
    for row in rows:
        found = (
            (row.single / row.by_opti, 0.1),
            (row.single / row.by_highs, 2.0),
            (row.swept / row.by_opti, 0.01),
        )
        table.add_row(str(row.problem.basis.degree), *(f"{value:.4f}{missed(value, aim)}" for value, aim in found))
    return table


def accuracy_table(rows: Sequence[Row]) -> Table:
    """What the answers are worth."""
    headings = (
        "degree of Z",
        "solver",
        "C claimed",
        "off the optimum",
        "true peak over claim",
        "b over B",
        "b below 0",
    )
    table = Table(*headings, title="accuracy: C claimed against the certified optimum, and the law's true extremes")
    for row in rows:
        best, B = row.solution.objective, row.problem.B
        low, high = row.solution.law.extrema(1)
        own = Answer(best, row.solution.law.peak(2).value, high.value, -low.value)
        for name, one in (
            ("optlaws", own),
            ("Opti, 200 points", row.from_opti),
            ("linprog, 200 points", row.from_highs),
        ):
            off = row.solution.gap if one is own else one.claimed / best - 1.0
            table.add_row(
                str(row.problem.basis.degree),
                name,
                f"{one.claimed:.9f}",
                f"{off:+.1e}" if one is not own else f"gap {off:.0e}",
                f"{one.acceleration / one.claimed - 1.0:+.1e}",
                f"{max(0.0, one.velocity / B - 1.0):.1e}",
                f"{max(0.0, one.backward):.1e}",
            )
    return table


def table_job() -> float:
    """Seconds of the whole table in a fresh process."""

    def run() -> None:
        with tempfile.TemporaryDirectory() as out:
            python("-m", "optlaws", "run", str(Path("problems") / "optimal_table.toml"), "--out", out)

    return seconds(run, 3)


def import_time() -> float:
    """Seconds of `import optlaws`, those of the bare interpreter taken away."""
    return seconds(lambda: python("-c", "import optlaws"), 9) - seconds(lambda: python("-c", ""), 9)


def missed(value: float, aim: float) -> str:
    """A star where an aim is missed."""
    return " *" if value > aim else ""


def main() -> None:
    """Measure and print."""
    console = Console(width=120)
    console.print(
        f"optlaws {optlaws.__version__}, CasADi {version('casadi')}, SciPy {scipy.__version__}, "
        f"NumPy {np.__version__}, Python {sys.version.split()[0]}, one BLAS thread, medians"
    )
    rows = [measured(degree) for degree in DEGREES]
    for table in (times_table(rows), ratios_table(rows), accuracy_table(rows)):
        console.print(table)
    job, imported = table_job(), import_time()
    console.print(f"the whole table, cold: {job:.2f} s (aim: less than 3 s){missed(job, 3.0)}")
    console.print(f"import optlaws: {imported:.3f} s (aim: less than 0.3 s){missed(imported, 0.3)}")
