"""What is timed, and the tables that say so."""

import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
import scipy
from rich.console import Console
from rich.table import Table

import optlaws
from optlaws import Chebyshev, Problem, Solution, pareto_front, sweep, synthesize
from optlaws.typing import Bound
from tests.bench.plain import Answer, Claim, Rows, highs, opti, power_by_opti, power_by_slsqp
from tests.documents import ROOT

DEGREES = (3, 9, 19, 39)
FIRST = Problem(B=1.641, order=4, monotone=True)
POWER = Problem(B=1.641, order=4, basis=Chebyshev(9), minimise="D")
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
class Cost:
    """Seconds of a plain way: the program and its solution with rows given, and with rows made and the result read."""

    solver: float
    whole: float


@dataclass(frozen=True)
class Row:
    """Seconds a law takes, by way of asking, and what the plain ways answer."""

    problem: Problem
    solution: Solution
    cold: float
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


def python(*arguments: str) -> str:
    """What a fresh interpreter prints."""
    done = subprocess.run([sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout


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
    # a cold law is the first of its shape, in a process that has loaded CasADi and IPOPT
    cold = median(float(python("-c", COLD.format(problem=problem))) for _ in range(3))
    solution = synthesize(problem)
    rows = Rows(problem)
    return Row(
        problem=problem,
        solution=solution,
        cold=cold,
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
        "cold",
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
        times = (row.cold, row.single, row.swept, *plain)
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


def fronts_table() -> Table:
    """Fronts, beside as many laws one after the other by a plain way with its rows given."""
    table = Table("front", "points", "ms", "plain way", "ms", "ratio", "aim, ms", title="fronts of order 4, degree 9")
    chain = Problem(order=4, basis=Chebyshev(9))
    rows, quick, tight = (
        Rows(chain.at_velocity(1.6)),
        ("C over B", "linprog", highs),
        ("D over B, proven", "SLSQP", power_by_slsqp),
    )
    for (name, plain, solve), count, aim in ((quick, 50, 50.0), (quick, 1000, 250.0), (tight, 50, 5000.0)):
        bound: Bound = "tight" if solve is power_by_slsqp else "quick"
        over = ("B", name[0])
        front = pareto_front(chain, over=over, points=count, bound=bound)
        assert len(front) == count
        assert all(solution.gap < 1e-8 for solution in front)
        own = 1e3 * seconds(partial(pareto_front, chain, over=over, points=count, bound=bound), 3)
        velocities = front.values[:, 0].tolist()
        other = 1e3 * seconds(partial(list, map(partial(solve, rows), velocities)), 1)
        table.add_row(
            name, str(count), f"{own:.0f}{missed(own, aim)}", plain, f"{other:.0f}", f"{own / other:.2f}", f"{aim:.0f}"
        )
    return table


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
    for table in (times_table(rows), ratios_table(rows), accuracy_table(rows), *power_tables(), fronts_table()):
        console.print(table)
    job, imported = table_job(), import_time()
    console.print(f"the whole table, cold: {job:.2f} s (aim: less than 3 s){missed(job, 3.0)}")
    console.print(f"import optlaws: {imported:.3f} s (aim: less than 0.3 s){missed(imported, 0.3)}")
