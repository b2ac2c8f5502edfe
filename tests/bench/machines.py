"""What a proven law for a machine takes: 8 states, three modes whose residuals are bounded over 10 %, degree 15.

Every law is of another machine, so that nothing is kept from one to the next. Times are those of the processor, the
least of some runs: what else the machine does only adds to them.
"""

from collections.abc import Callable, Mapping
from itertools import pairwise
from time import process_time

from rich.console import Console
from rich.table import Table

from optlaws import Chebyshev, Functional, Link, Machine, Problem, at_most, smoothstep, synthesize

AIM = 0.05
REPEATS = 7
MASSES = {"motor": 1.0, "first": 0.8, "second": 0.7, "third": 0.6, "last": 0.5}
STIFFNESSES = (900.0, 700.0, 600.0, 500.0)
OBJECTIVES: Mapping[str, Callable[[Machine], Functional | str]] = {
    "C": lambda _: "C",
    "peak motor torque": lambda machine: machine.peak("torque"),
    "RMS motor torque": lambda machine: machine.rms("torque"),
}


def chain(factor: float = 1.0) -> Machine:
    """A motor that drives four masses, one behind the other."""
    links = [Link(*pair, stiffness, 0.5) for pair, stiffness in zip(pairwise(MASSES), STIFFNESSES, strict=True)]
    outputs = {"torque": "drive force", "tip": "acceleration last"}
    return Machine.from_masses(MASSES | {"motor": factor}, links, drive="motor", outputs=outputs)


def asked(machine: Machine, objective: Callable[[Machine], Functional | str]) -> Problem:
    """The least of an objective, a fifth of a smooth law's residual of the first three modes allowed."""
    residuals = [machine.residual(mode, "tip", spread=0.05) for mode in (1, 2, 3)]
    bounds = {residual: at_most(0.2 * residual.value(smoothstep(3))) for residual in residuals}
    return Problem(order=3, basis=Chebyshev(15), symmetric=False, minimise=objective(machine), bounds=bounds)


def seconds(objective: Callable[[Machine], Functional | str], repeats: int = REPEATS) -> tuple[list[float], str]:
    """What law after law takes, its machine and its problem included, and the last one's status."""
    times, status = [], ""
    for i in range(repeats):
        began = process_time()
        status = str(synthesize(asked(chain(1.0 + 1e-3 * i), objective)).status)
        times.append(process_time() - began)
    return times, status


def main(repeats: int = REPEATS) -> None:
    """Measure and print."""
    title = f"ms, 8 states, three residuals bounded, degree 15; aim: {1e3 * AIM:g} ms"
    table = Table("least", "first", "then", "status", title=title)
    for name, objective in OBJECTIVES.items():
        times, status = seconds(objective, repeats)
        table.add_row(name, f"{1e3 * times[0]:.0f}", f"{1e3 * min(times):.0f}", status)
    Console(width=120).print(table)


if __name__ == "__main__":
    main()
