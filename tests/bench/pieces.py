"""What laws of many pieces take, and the exponent with which that grows."""

from time import perf_counter

import numpy as np
from rich.console import Console
from rich.table import Table

from optlaws import Pieces, Problem, synthesize

COUNTS = (25, 50, 100, 200)
OBJECTIVES = ("C", "rms_c")


def measured(minimise: str, count: int) -> tuple[float, str]:
    """Seconds that the least of a constant over so many pieces takes, and the status."""
    began = perf_counter()
    # the middle must be a break of symmetric laws
    solution = synthesize(Problem(order=3, B=1.8, basis=Pieces(count + count % 2), minimise=minimise))
    return perf_counter() - began, str(solution.status)


def exponent(counts: tuple[int, ...], seconds: list[float]) -> float:
    """The slope of seconds over counts, both by their logarithms."""
    return float(np.polyfit(np.log(counts), np.log(seconds), 1)[0])


def main(counts: tuple[int, ...] = COUNTS) -> None:
    """Measure once and print."""
    table = Table("minimise", *(f"{count} pieces" for count in counts), "exponent", title="seconds, order 3, B = 1.8")
    for minimise in OBJECTIVES:
        rows = [measured(minimise, count) for count in counts]
        cells = [f"{seconds:.2f} {status}" for seconds, status in rows]
        table.add_row(minimise, *cells, f"{exponent(counts, [seconds for seconds, _ in rows]):.2f}")
    Console(width=120).print(table)


if __name__ == "__main__":
    main()
