"""What it costs to start: processor time of imports and of whole commands, as ratios to `import numpy` in the same run.

Run it with `python -m tests.bench.startup`; `make bench` ends with it.
"""

import os
import subprocess
import sys
from resource import RUSAGE_CHILDREN, getrusage
from statistics import median
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.table import Table

from tests.documents import ROOT

REPEATS, REPEATS_OF_COMMANDS = 7, 3
FIRST = """
import time, optlaws
begin = time.process_time()
optlaws.synthesize(optlaws.Problem(B=1.7, order=4, basis=optlaws.Powers(5)))
print(time.process_time() - begin)
"""
#: what is started, and how many times `import numpy` it may cost; code may print the time that counts
AIMS = {
    "import numpy": (("-c", "import numpy"), 1.0),
    "import optlaws after numpy": (("-c", "import numpy, optlaws"), 2.5),
    "first `synthesize` in a process": (("-c", FIRST), 1.7),
    "optlaws --help": (("-m", "optlaws", "--help"), 2.0),
    "optlaws solve": (("-m", "optlaws", "solve", "--order=4", "--degree=5", "--peak-velocity=1.7"), 4.5),
    "optlaws catalogue": (("-m", "optlaws", "catalogue"), 3.5),
    "optlaws export --list": (("-m", "optlaws", "export", "--list"), 3.5),
}
EXPORT = ("export", "modified sine", "--stroke=35 mm", "--master=120 deg", "--duration=0.1 s", "--points=best")
#: commands that people wait for, pictures included; what they write goes to a folder that is left out here
COMMANDS = {
    "optlaws cycle cycle_press": (("cycle", "cycle_press", "--out"), 11.0),
    "optlaws run cam_press": (("run", "cam_press", "--out"), 16.0),
    "optlaws run optimal_table": (("run", "optimal_table", "--out"), 20.0),
    "optlaws verify, 104 solutions": (("verify", f"{ROOT}/results/optimal_table/laws.json"), 20.0),
    "optlaws export, a table's best points": ((*EXPORT, "--to=csv"), 6.0),
    "optlaws export, polynomials' best breaks": ((*EXPORT, "--to=br-acp10"), 9.0),
}
#: without it each start would compile what it imports anew
_ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def processor_seconds(arguments: tuple[str, ...]) -> float:
    """User and system time of a fresh interpreter, or the time that its code prints."""
    before = getrusage(RUSAGE_CHILDREN)
    done = subprocess.run([sys.executable, *arguments], cwd=ROOT, check=True, capture_output=True, env=_ENVIRONMENT)
    after = getrusage(RUSAGE_CHILDREN)
    if arguments[0] == "-c" and done.stdout:
        return float(done.stdout)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Measure turn by turn, so that what else the machine does meets all alike, and print."""
    with TemporaryDirectory() as folder:
        commands = {
            name: (("-m", "optlaws", *words, *([folder] if words[-1] == "--out" else [])), aim)
            for name, (words, aim) in COMMANDS.items()
        }
        starts = _spent({name: arguments for name, (arguments, _) in AIMS.items()}, REPEATS)
        whole = _spent({name: arguments for name, (arguments, _) in commands.items()}, REPEATS_OF_COMMANDS)
    unit = median(starts["import numpy"])
    table = Table("start", "ms of processor", "over import numpy", "aim", title="start-up and commands (* missed)")
    for name, (_, aim) in {**AIMS, **commands}.items():
        spent = median({**starts, **whole}[name])
        table.add_row(name, f"{1e3 * spent:.0f}", f"{spent / unit:.1f}{' *' if spent > aim * unit else ''}", f"{aim:g}")
    Console(width=120).print(table)


def _spent(by_name: dict[str, tuple[str, ...]], repeats: int) -> dict[str, list[float]]:
    spent: dict[str, list[float]] = {name: [] for name in by_name}
    for _ in range(repeats):
        for name, arguments in by_name.items():
            spent[name].append(processor_seconds(arguments))
    return spent


if __name__ == "__main__":
    main()
