"""Which faults the tests would miss: python -m tests.mutants [--sample 40] [--seed 1] [module ...].

Cosmic Ray changes one operator, number or comparison at a time in a copy of the tree; the tests of that module run
until one fails. Every module has its sample, drawn by the seed. Survivors that change nothing are listed with the
reason in equivalent.toml; any other one is printed, and the exit code is 1 where less than 90 % are killed.
"""

import random
import sys
import tomllib
from argparse import ArgumentParser
from pathlib import Path

from tests.mutants.modules import TESTS
from tests.mutants.trying import Mutant, mutants, report, run


def main() -> int:
    """Draw, try, report."""
    parser = ArgumentParser(prog="python -m tests.mutants")
    parser.add_argument("modules", nargs="*", default=list(TESTS))
    parser.add_argument("--sample", type=int, default=12)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=2)
    asked = parser.parse_args()
    chosen: list[Mutant] = []
    for module in asked.modules:
        every = mutants(module)
        drawn = random.Random(f"{asked.seed} {module}").sample(every, min(asked.sample, len(every)))  # noqa: S311
        chosen += sorted(drawn, key=lambda one: (one.line, one.column))
    equivalent = tomllib.loads((Path(__file__).parent / "equivalent.toml").read_text())
    return 0 if report(run(chosen, asked.processes), equivalent) else 1


if __name__ == "__main__":
    sys.exit(main())
