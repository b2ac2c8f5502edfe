"""Rules of the house: names of classes and of things, tolerances, docstrings, and what tests look inside."""

import ast
import inspect
import re
from collections import Counter
from collections.abc import Iterator
from doctest import DocTestParser
from importlib import import_module
from pathlib import Path
from types import FunctionType
from typing import NamedTuple

import pytest

from tests.documents import ROOT
from tests.imports import modules as known_modules

#: blocks of pages that are programs
PYTHON_BLOCK = re.compile(r"^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)


class Parts(NamedTuple):
    """What several rules look at in the package, which is parsed once: whole trees of it would take much memory."""

    parameters: list[tuple[Path, ast.arg | ast.AnnAssign]]
    docstrings: list[tuple[Path, str, str]]
    tolerances: dict[Path, list[str]]
    vague: dict[Path, set[str]]


@pytest.fixture(scope="module")
def parts() -> Parts:
    parts = Parts([], [], {}, {})
    for path in sorted((ROOT / "optlaws").rglob("*.py")):
        tree = ast.parse(path.read_text("utf-8"))
        parts.tolerances[path] = tolerances(tree)
        parts.vague[path] = set()
        for node in ast.walk(tree):
            parts.vague[path] |= vague_names_of(node)
            if isinstance(node, ast.arg | ast.AnnAssign):
                parts.parameters.append((path, node))
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
                parts.docstrings.append((path, getattr(node, "name", "module"), ast.get_docstring(node) or ""))
    return parts


def test_nu_is_the_order_of_a_derivative(parts: Parts) -> None:
    # but for the torsion lever, whose paper calls a share of its twist so
    for path, node in parts.parameters:
        if "lever" in str(path.relative_to(ROOT)):
            continue
        name = getattr(node.target, "id", None) if isinstance(node, ast.AnnAssign) else node.arg
        kind = node.annotation
        assert name != "nu" or kind is None or ast.unparse(kind) == "int", f"{path.name}: {ast.unparse(node)}"


LARGEST = 1e-2


def assigned(tree: ast.Module) -> Iterator[tuple[str, ast.expr]]:
    """Names that a module gives values to, each with its value; of a tuple each by itself."""
    for node in tree.body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                pair = (target, node.value)
                several = all(isinstance(one, ast.Tuple) for one in pair)
                pairs = zip(*(one.elts for one in pair), strict=True) if several else [pair]  # type: ignore[attr-defined]
                yield from ((name.id, value) for name, value in pairs if isinstance(name, ast.Name))


def tolerances(tree: ast.Module) -> list[str]:
    """Constants of a module that are numbers above 0 and below a hundredth."""
    known: dict[str, float] = {}
    for name, node in assigned(tree):
        try:
            value = eval(compile(ast.Expression(node), "constant", "eval"), {"__builtins__": {}, **known})  # noqa: S307
        except Exception:  # noqa: BLE001, S112 - not a plain number
            continue
        if isinstance(value, float | int):
            known[name] = value
    return [name for name, value in known.items() if 0.0 < value < LARGEST]


def test_every_tolerance_has_its_reason_beside_it_and_a_use(parts: Parts) -> None:
    """What several modules use stands in one place, all others where they are used."""
    bare, unused = [], []
    others = {path: path.read_text("utf-8") for path in parts.tolerances}
    words = {path: Counter(re.findall(r"\w+", source)) for path, source in others.items()}
    everywhere = Counter[str]()
    for counted in words.values():
        everywhere.update(counted)
    for path, names in parts.tolerances.items():
        lines = others[path].splitlines()
        for name in names:
            at = next(i for i, line in enumerate(lines) if re.match(rf"(?:\w+, )*{name}\b.*=", line))
            if "  # " not in lines[at] and not lines[at - 1].startswith("#"):
                bare.append(f"{path.name}: {name}")
            if (everywhere if path.name == "tolerances.py" else words[path])[name] < 2:
                unused.append(f"{path.name}: {name}")
    assert bare == []
    assert unused == []


def test_a_tolerance_is_seen() -> None:
    source = "A = 2.0**-48\nB, C = 3, 1e-9\nD: float = 4.0 * A\nE = -0.001\nF = 0.01\nG = 'x'"
    assert tolerances(ast.parse(source)) == ["A", "C", "D"]


#: such an import, or the same in a string or a comment
DEEP = re.compile(r"\bfrom\s+optlaws\.\w+\.\w")


def test_tests_look_inside_a_room_through_one_file() -> None:
    """A module that moves is followed in `tests/internals/` alone."""
    deep = {
        str(path.relative_to(ROOT)): node.module
        for path in sorted((ROOT / "tests").rglob("*.py"))
        if "internals" not in path.parts and DEEP.search(source := path.read_text("utf-8"))
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.ImportFrom)
        and (node.module or "").count(".") > 1
        and (node.module or "").startswith("optlaws.")
    }
    assert deep == {}


#: words that say nothing of what a thing is
VAGUE = {"asked", "said", "told", "made", "held", "wanted", "kept", "own", "found", "one"}
#: the entries of each kind of nodes that name a thing
NAMED_BY = {
    name: [entry for entry in getattr(kind, "_fields", ()) if entry in {"id", "arg", "name", "attr"}]
    for name, kind in vars(ast).items()
}
ROOMS = sorted(
    path for path in (ROOT / "optlaws").iterdir() if path.suffix == ".py" or (path / "__init__.py").is_file()
)


def vague_names(source: str) -> set[str]:
    """Names of a program that say nothing of what they stand for: variables, arguments, functions and attributes."""
    return {name for node in ast.walk(ast.parse(source)) for name in vague_names_of(node)}


def vague_names_of(node: ast.AST) -> set[str]:
    """Those of one node."""
    return VAGUE.intersection([getattr(node, entry) for entry in NAMED_BY[type(node).__name__]])


@pytest.mark.parametrize("room", ROOMS, ids=lambda path: path.stem)
def test_names_say_what_a_thing_is(room: Path, parts: Parts) -> None:
    found = {path: names for path, names in parts.vague.items() if room in (path, *path.parents)}
    assert found
    assert {str(path): names for path, names in found.items() if names} == {}


def test_names_in_examples_say_what_a_thing_is(parts: Parts) -> None:
    texts = {f"{path.relative_to(ROOT)}: {name}, {i}": text for i, (path, name, text) in enumerate(parts.docstrings)}
    texts |= {str(page): page.read_text("utf-8") for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]}
    blocks = [(place, block) for place, text in texts.items() for block in re.findall(PYTHON_BLOCK, text)]
    blocks += [
        (place, example.source) for place, text in texts.items() for example in DocTestParser().get_examples(text)
    ]
    blocks += [(str(path), path.read_text("utf-8")) for path in (ROOT / "docs" / "examples").glob("*.py")]
    assert [(place, names) for place, block in blocks if (names := vague_names(block))] == []


def test_a_vague_name_is_seen() -> None:
    assert vague_names("kept_property\ndef one(own): return own.found") == {"one", "own", "found"}


FEWEST_WORDS = 4


def test_the_first_line_of_a_docstring_has_at_least_four_words(parts: Parts) -> None:
    short = [
        f"{path.relative_to(ROOT)}: {line}"
        for path, _, text in parts.docstrings
        if text and len(re.findall(r"[\w'²³]+", line := text.partition("\n")[0])) < FEWEST_WORDS
    ]
    assert short == []


def test_every_method_has_a_docstring_or_that_of_the_method_that_it_overrides() -> None:
    # ruff sees each class by itself and would have the same text twice; a property's name may say it all, but the
    # reference shows what has a docstring alone
    pages = "".join(page.read_text("utf-8") for page in (ROOT / "docs" / "reference" / "api").glob("*.md"))
    shown = set(re.findall(r"\w+", "".join(re.findall(r":members: (.*)", pages))))
    modules = [import_module(name) for name in known_modules(ROOT / "optlaws") if name != "optlaws.__main__"]
    classes = {kind for module in modules for kind in vars(module).values() if inspect.isclass(kind)}
    silent = [
        f"{kind.__module__}: {kind.__qualname__}.{name}"
        for kind in classes
        if kind.__module__.startswith("optlaws.") and not kind.__name__.startswith("_")
        for name, method in vars(kind).items()
        if not name.startswith("_") and name not in inspect.get_annotations(kind)
        if isinstance(method, FunctionType | classmethod | staticmethod)
        or (isinstance(method, property) and kind.__name__ in shown)
        if inspect.getdoc(getattr(kind, name)) is None
    ]
    assert sorted(silent) == []
