"""Rules of the house: how much a function takes, and that a name of a class means one class."""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.documents import ROOT

MOST_ARGUMENTS = 8
#: rooms whose functions take no more; what belongs together is one value, or the entries of a `TypedDict`
FEW_ARGUMENTS = ("cams", "cycles", "exports", "jobs", "laws", "motion", "plots")

#: names that several classes have still
SEVERAL_CLASSES = frozenset(
    [
        "Asked",
        "Bounds",
        "Box",
        "Cell",
        "Drive",
        "Edge",
        "Entry",
        "Extreme",
        "Interval",
        "Jet",
        "Line",
        "Model",
        "Motion",
        "OfFormula",
        "OutputConstant",
        "OutputPeak",
        "OutputRms",
        "Part",
        "Peak",
        "Power",
        "Row",
        "Search",
        "Segment",
        "StateSpace",
        "Stretch",
        "Sum",
        "Table",
        "Top",
        "Units",
        "_Laws",
        "_Part",
    ]
)


def nodes(folder: Path) -> Iterator[tuple[Path, ast.AST]]:
    """Every node of the syntax trees below a folder, with its file."""
    for path in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            yield path, node


def arguments(function: ast.FunctionDef | ast.AsyncFunctionDef) -> list[str]:
    """Names of what a function takes, but for the value or the class that it is a method of."""
    listed = function.args
    names = [argument.arg for argument in (*listed.posonlyargs, *listed.args, *listed.kwonlyargs)]
    return names[1:] if names[:1] in (["self"], ["cls"]) else names


@pytest.mark.parametrize("room", FEW_ARGUMENTS)
def test_a_function_takes_few_arguments(room: str) -> None:
    functions = (
        (path, node)
        for path, node in nodes(ROOT / "optlaws" / room)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    )
    many = [f"{path.name}: {node.name}" for path, node in functions if len(arguments(node)) > MOST_ARGUMENTS]
    assert many == []


def test_a_name_of_a_class_means_one_class() -> None:
    names = Counter(node.name for _, node in nodes(ROOT / "optlaws") if isinstance(node, ast.ClassDef))
    assert {name for name, count in names.items() if count > 1} <= SEVERAL_CLASSES
