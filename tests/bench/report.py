"""What is timed, and the tables that say so."""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from statistics import median
from time import perf_counter

import numpy as np
import scipy
from rich.console import Console
from rich.table import Table

import optlaws
from optlaws import Chebyshev, Problem, Solution, sweep, synthesize
from tests.bench.plain import Answer, Claim, Rows, highs, opti, power_by_opti, power_by_slsqp

DEGREES = (3, 9, 19, 39)
FIRST = Problem(B=1.641, order=4, monotone=True)
POWER = Problem(B=1.641, order=4, basis=Chebyshev(9), minimise="D")
VELOCITIES = np.linspace(1.55, 2.5, 100)
REPEATS = 7


@dataclass(frozen=True)
class Cost:
    """Seconds of a plain way: the program and its solution with rows given, and with rows made and the result read."""

    solver: float
    whole: float


@dataclass(frozen=True)
class Row:
    """Seconds a law takes, by way of asking, and what the plain ways answer."""

    problem: Problem
    solution: Solution
    single: float
    swept: float
    by_opti: Cost
    by_highs: Cost
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


def cost(solve: Callable[[Rows, float], Claim], problem: Problem, rows: Rows) -> Cost:
    """What a plain way costs; its rows do not depend on B, and a careful user keeps them."""
    assert isinstance(problem.B, float)
    B = problem.B

    def whole() -> None:
        own = Rows(problem)
        own.read(solve(own, B))

    return Cost(seconds(lambda: solve(rows, B)), seconds(whole))


def judged(solve: Callable[[Rows, float], Claim], problem: Problem, rows: Rows) -> Answer:
    """What its answer is worth."""
    assert isinstance(problem.B, float)
    return rows.judged(solve(rows, problem.B))


def measured(degree: int) -> Row:
    """All ways of asking for one degree."""
    problem = replace(FIRST, basis=Chebyshev(degree))
    family = [replace(problem, B=float(B)) for B in VELOCITIES]
    solution = synthesize(problem)
    rows = Rows(problem)
    return Row(
        problem=problem,
        solution=solution,
        single=seconds(lambda: synthesize(problem), 15),
        swept=seconds(lambda: list(sweep(family)), 3) / len(family),
        by_opti=cost(opti, problem, rows),
        by_highs=cost(highs, problem, rows),
        from_opti=judged(opti, problem, rows),
        from_highs=judged(highs, problem, rows),
    )


def times_table(rows: Sequence[Row]) -> Table:
    """Milliseconds a law."""
    headings = (
        "degree of Z",
        "single",
        "along B",
        "Opti",
        "Opti, rows given",
        "linprog",
        "linprog, rows given",
    )
    table = Table(*headings, title="ms a law: l = 4, 0 <= b <= B = 1.641; along B: 1.55 to 2.5")
    for row in rows:
        plain = (row.by_opti.whole, row.by_opti.solver, row.by_highs.whole, row.by_highs.solver)
        times = (row.single, row.swept, *plain)
        table.add_row(degree_of(row.problem), *(f"{1e3 * value:.2f}" for value in times))
    return table


def ratios_table(rows: Sequence[Row]) -> Table:
    """Ratios to the plain ways, beside the aims."""
    headings = (
        "degree of Z",
        "single / Opti",
        "... rows given",
        "single / linprog",
        "... rows given",
        "along B / Opti",
        "... rows given",
    )
    table = Table(*headings, title="ratios (aims: at most 1/10, 1/2 and 1/100; * missed)")
    for row in rows:
        found = (
            (row.single / row.by_opti.whole, 0.1),
            (row.single / row.by_opti.solver, 0.1),
            (row.single / row.by_highs.whole, 0.5),
            (row.single / row.by_highs.solver, 0.5),
            (row.swept / row.by_opti.whole, 0.01),
            (row.swept / row.by_opti.solver, 0.01),
        )
        table.add_row(degree_of(row.problem), *(f"{value:.4f}{missed(value, aim)}" for value, aim in found))
    return table


def degree_of(problem: Problem) -> str:
    """The degree of Z."""
    return str(problem.basis.to_dict()["degree"])


def power_tables() -> list[Table]:
    """The law of least D: times beside the plain ways, and what the answers are worth."""
    problem, rows = POWER, Rows(POWER)
    solution = synthesize(problem)
    own = seconds(lambda: synthesize(problem), 15)
    tight = synthesize(problem, bound="tight")
    proven = seconds(lambda: synthesize(problem, bound="tight"), 5)
    ways = (("Opti, IPOPT", power_by_opti, 1 / 3), ("SLSQP", power_by_slsqp, 0.4))
    times = Table("solver", "ms a law", "ms, rows given", "optlaws / it", "... rows given", "aim")
    times.title = (
        f"least D: l = 4, degree 9, b <= B = 1.641; optlaws {1e3 * own:.2f} ms, {len(solution.starts)} starts; "
        f"with a tight bound {1e3 * proven:.0f} ms, gap {tight.gap:.0e}"
    )
    worth = Table("solver", "D claimed", "off optlaws", "true peak over claim", "b over B")
    worth.title = "accuracy: true extremes of each law; one start and 200 points but for optlaws"
    B, low_high = POWER.B, solution.law.extrema(1)
    assert isinstance(B, float)
    peak = solution.law.power_peak().value
    gap = f"bound {solution.lower_bound:.6f}"
    worth.add_row(
        "optlaws", f"{solution.objective:.9f}", gap, *worth_of(solution.objective, peak, low_high[1].value / B)
    )
    for name, solve, aim in ways:
        found, answer = cost(solve, problem, rows), judged(solve, problem, rows)
        ratios = (f"{ratio:.4f}{missed(ratio, aim)}" for ratio in (own / found.whole, own / found.solver))
        times.add_row(name, f"{1e3 * found.whole:.2f}", f"{1e3 * found.solver:.2f}", *ratios, f"{aim:.3f}")
        off = f"{answer.claimed / solution.objective - 1.0:+.1e}"
        worth.add_row(name, f"{answer.claimed:.9f}", off, *worth_of(answer.claimed, answer.power, answer.velocity / B))
    return [times, worth]


def worth_of(claimed: float, power: float, velocity: float) -> tuple[str, str]:
    """True peak over claim and b over B, as text."""
    return f"{power / claimed - 1.0:+.1e}", f"{max(0.0, velocity - 1.0):.1e}"


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
        assert isinstance(B, float)
        low, high = row.solution.law.extrema(1)
        law = row.solution.law
        own = Answer(best, law.peak(2).value, law.power_peak().value, high.value, -low.value)
        for name, one in (
            ("optlaws", own),
            ("Opti, 200 points", row.from_opti),
            ("linprog, 200 points", row.from_highs),
        ):
            off = row.solution.gap if one is own else one.claimed / best - 1.0
            table.add_row(
                degree_of(row.problem),
                name,
                f"{one.claimed:.9f}",
                f"{off:+.1e}" if one is not own else f"gap {off:.0e}",
                f"{one.acceleration / one.claimed - 1.0:+.1e}",
                f"{max(0.0, one.velocity / B - 1.0):.1e}",
                f"{max(0.0, one.backward):.1e}",
            )
    return table


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
    for table in (times_table(rows), ratios_table(rows), accuracy_table(rows), *power_tables()):
        console.print(table)
