"""Mutants of a module, and what its tests say of them."""

import os
import py_compile
import shutil
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory

from cosmic_ray import plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_and_test
from cosmic_ray.testing import run_tests
from cosmic_ray.util import read_python_source
from cosmic_ray.work_item import MutationSpec, TestOutcome

from tests.mutants.modules import TESTS

ROOT = Path(__file__).parent.parent.parent
NEEDED = ("optlaws", "problems", "docs", "tests", "conftest.py", "pyproject.toml")
#: bits and remainders are not what these modules are about, and | stands in annotations
SENSIBLE = ("Add", "Sub", "Mul", "Div")
KINDS = (
    "NumberReplacer",
    "ReplaceComparisonOperator",
    "ReplaceUnaryOperator",
    "ReplaceBinaryOperator",
    "ReplaceTrueWithFalse",
    "ReplaceFalseWithTrue",
    "ReplaceAndWithOr",
    "ReplaceOrWithAnd",
    "AddNot",
    "ReplaceBreakWithContinue",
    "ReplaceContinueWithBreak",
    "ZeroIterationForLoop",
)
AIM = 0.9
TIMEOUT = 240.0


@dataclass(frozen=True)
class Mutant:
    """A module with one thing changed."""

    module: str
    operator: str
    occurrence: int
    line: int
    column: int
    end: tuple[int, int]

    @property
    def name(self) -> str:
        """What equivalent.toml calls it: the line's text is what stays when lines move."""
        text = file_of(self.module).read_text().splitlines()[self.line - 1].strip()
        return f"{self.module}: {text} [{self.operator.rpartition('/')[2]} at {self.column}]"


@dataclass(frozen=True)
class Tried:
    """What became of a mutant, and the change in full."""

    mutant: Mutant
    killed: bool
    change: str


def file_of(module: str) -> Path:
    """Where a module is."""
    return ROOT.joinpath(*module.split(".")).with_suffix(".py")


def wanted(operator: str) -> bool:
    """Whether a kind of change is one to try."""
    name = operator.rpartition("/")[2]
    if name.startswith("ReplaceBinaryOperator"):
        return all(part in SENSIBLE for part in name.split("_")[1:])
    return name.startswith(KINDS)


def guard(mutant: Mutant) -> bool:
    """Whether it is the `strict` of a zip over what has one length: a guard that cannot act."""
    line = file_of(mutant.module).read_text().splitlines()[mutant.line - 1]
    return line[: mutant.column].endswith("strict=")


def mutants(module: str) -> list[Mutant]:
    """All there are, but for guards."""
    nodes = list(ast_nodes(get_ast(read_python_source(file_of(module)))))
    found = []
    for name in sorted(filter(wanted, plugins.operator_names())):
        operator = plugins.get_operator(name)()
        places = (place for node in nodes for place in operator.mutation_positions(node))
        ends = enumerate(place[:2] for place in places)
        found += [Mutant(module, name, i, start[0], start[1], end) for i, (start, end) in ends]
    return [one for one in found if not guard(one)]


def copied(place: Path) -> None:
    """A tree to change, old and compiled, so that only what is changed is compiled again."""
    skipped = shutil.ignore_patterns("__pycache__", "*.pyc", ".*")
    for name in NEEDED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, place / name, ignore=skipped)
        else:
            shutil.copy(ROOT / name, place / name)
    for path in place.rglob("*.py"):
        os.utime(path, (1e9, 1e9))
        py_compile.compile(str(path), quiet=1)


def command(module: str) -> str:
    """What runs a module's tests."""
    tests = " ".join([*TESTS[module], str(file_of(module).relative_to(ROOT))])
    return f"{sys.executable} -m pytest -x -q -m 'not long or sample' -p no:cacheprovider {tests}"


def passes(module: str) -> bool:
    """Whether a module's tests pass as it is: else each mutant would count as killed."""
    outcome, _ = run_tests(command(module), TIMEOUT)
    return bool(outcome == TestOutcome.SURVIVED)


def tried(mutant: Mutant) -> Tried:
    """Run the module's tests against the mutant in the tree at hand."""
    path = file_of(mutant.module).relative_to(ROOT)
    change = MutationSpec(path, mutant.operator, mutant.occurrence, (mutant.line, mutant.column), mutant.end)
    result = mutate_and_test([change], command(mutant.module), TIMEOUT)
    return Tried(mutant, result.test_outcome != TestOutcome.SURVIVED, result.diff or result.output or "")


def begin(top: str) -> None:
    """Give a process a tree of its own."""
    place = Path(top) / str(os.getpid())
    place.mkdir()
    copied(place)
    os.chdir(place)
    os.environ |= {"CI": "1", "PYTHONPATH": str(place)}


def run(chosen: Sequence[Mutant], processes: int) -> list[Tried]:
    """Try them all."""
    with TemporaryDirectory() as top:
        spawn = get_context("spawn")
        with ProcessPoolExecutor(processes, spawn, partial(begin, top)) as pool:
            modules = list(dict.fromkeys(one.module for one in chosen))
            broken = [module for module, fine in zip(modules, pool.map(passes, modules), strict=True) if not fine]
            if broken:
                raise SystemExit(f"tests fail without any change: {', '.join(broken)}")
            return [told(one) for one in pool.map(tried, chosen)]


def told(one: Tried) -> Tried:
    """Say what became of a mutant as soon as it is known."""
    sys.stderr.write(f"{'killed' if one.killed else 'SURVIVED'} {one.mutant.name}\n")
    return one


def report(found: Sequence[Tried], equivalent: dict[str, str]) -> bool:
    """Print a table and the survivors; whether enough were killed."""
    lines, survivors = [], []
    total = killed = 0
    for module, group in groupby(found, key=lambda one: one.mutant.module):
        own = [one for one in group if one.killed or one.mutant.name not in equivalent]
        alive = [one for one in own if not one.killed]
        survivors += alive
        lines.append(f"{module:42}{len(own) - len(alive):5} of {len(own)}")
        total, killed = total + len(own), killed + len(own) - len(alive)
    share = killed / max(total, 1)
    lines.append(f"{'all':42}{killed:5} of {total}, {share:.0%}")
    lines += [f"\nsurvived: {survivor.mutant.name}\n{survivor.change}" for survivor in survivors]
    sys.stdout.write("\n".join(lines) + "\n")
    return share >= AIM
