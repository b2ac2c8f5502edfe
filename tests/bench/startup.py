"""What it costs to start: processor time of imports and commands, as ratios to `import numpy` in the same run.

Run it with `python -m tests.bench.startup`; `make bench` ends with it.
"""

import os
import subprocess
import sys
from statistics import median

from rich.console import Console
from rich.table import Table

from tests.documents import ROOT

REPEATS = 7
#: what is started, and how many times `import numpy` it may cost
AIMS = {
    "import numpy": (("-c", "import numpy"), 1.0),
    "import optlaws after numpy": (("-c", "import numpy, optlaws"), 2.5),
    "optlaws --help": (("-m", "optlaws", "--help"), 3.5),
    "optlaws solve": (("-m", "optlaws", "solve", "--order=4", "--degree=5", "--peak-velocity=1.7"), 6.0),
    "optlaws catalogue": (("-m", "optlaws", "catalogue"), 5.0),
}


def processor_seconds(arguments: tuple[str, ...]) -> float:
    """User and system time of a fresh interpreter."""
    before = os.times()
    subprocess.run([sys.executable, *arguments], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def main() -> None:
    """Measure turn by turn, so that what else the machine does meets all alike, and print."""
    spent: dict[str, list[float]] = {name: [] for name in AIMS}
    for _ in range(REPEATS):
        for name, (arguments, _) in AIMS.items():
            spent[name].append(processor_seconds(arguments))
    unit = median(spent["import numpy"])
    table = Table("start", "ms of processor", "over import numpy", "aim", title="start-up (* missed)")
    for name, (_, aim) in AIMS.items():
        ratio = median(spent[name]) / unit
        table.add_row(name, f"{1e3 * median(spent[name]):.0f}", f"{ratio:.1f}{' *' if ratio > aim else ''}", f"{aim:g}")
    Console(width=120).print(table)


if __name__ == "__main__":
    main()
