"""Faces: names are imported when first used, as the stubs say, and nothing heavy comes along."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

import optlaws
import optlaws.typing
from optlaws import Basis, MotionLaw
from optlaws.lazy import Registry
from tests.documents import ROOT
from tests.internals.laws import Segment
from tests.internals.synthesis import MAKERS, PLAIN

STUBS = sorted((ROOT / "optlaws").rglob("*.pyi"))
REGISTRIES: dict[str, Registry[Any]] = {
    "law": MotionLaw.kinds,
    "segment": Segment.kinds,
    "basis": Basis.kinds,
    "constant": MAKERS,
    "plain constant": PLAIN,
}


def package(file: Path) -> str:
    return ".".join(file.with_suffix("").relative_to(ROOT).parts).removesuffix(".__init__")


def python(script: str) -> str:
    return subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True).stdout


def homes(stub: Path) -> Iterator[tuple[str, ast.alias]]:
    """The imports of a stub, each with the module that has the name; rooms of optlaws come from optlaws itself."""
    for node in ast.parse(stub.read_text("utf-8")).body:
        if isinstance(node, ast.ImportFrom):
            room = ".".join(stub.parent.relative_to(ROOT).parts)
            assert node.level == 1
            for alias in node.names:
                yield ".".join(filter(None, (room, node.module))), alias


@pytest.mark.parametrize("stub", STUBS, ids=package)
def test_every_name_of_the_stub_is_there(stub: Path) -> None:
    face = import_module(package(stub))
    names = [alias.name for _, alias in homes(stub)]
    assert len(names) == len(set(names))
    assert set(face.__all__) == set(names) - ({"laws", "mechanisms", "synthesis"} if face is optlaws else set())
    for module, alias in homes(stub):
        assert alias.asname == alias.name, "type checkers take an import without `as` for one of the stub's own"
        assert getattr(face, alias.name) is getattr(import_module(module), alias.name)
        assert alias.name in dir(face)


def test_types_become_no_names_of_optlaws() -> None:
    types = set(vars(optlaws.typing)["__all__"])
    assert not types & set(vars(optlaws)["__all__"])
    for name in types:
        getattr(optlaws.typing, name)
        assert not hasattr(optlaws, name)


def removed_names() -> list[tuple[str, str]]:
    """Names of the version before, each with its package."""
    return [
        (package(stub), name)
        for stub in STUBS
        for call in ast.walk(ast.parse(stub.with_suffix(".py").read_text("utf-8")))
        if isinstance(call, ast.Call)
        for entry in call.keywords
        if entry.arg == "removed" and isinstance(entry.value, ast.Dict)
        for name in ast.literal_eval(entry.value)
    ]


@pytest.mark.parametrize(("face", "name"), removed_names())
def test_a_name_of_the_version_before_says_what_to_use(face: str, name: str) -> None:
    assert name not in import_module(face).__all__
    for script in (f"from {face} import {name}", f"import {face}; {face}.{name}"):
        with pytest.raises(ImportError, match=f"{face} has no {name} any more: "):
            exec(script, {})  # noqa: S102 - as users write it


def test_importing_optlaws_imports_no_subject() -> None:
    script = "import sys, optlaws; print(*(name for name in sys.modules if name.startswith('optlaws.')))"
    assert set(python(script).split()) <= {"optlaws.lazy"}


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("subject", "where"),
    [
        ("law", "optlaws.laws.storage import StoredLaw; table = StoredLaw.kinds"),
        ("segment", "optlaws.laws.segments.segment import Segment; table = Segment.kinds"),
        ("basis", "optlaws.synthesis.spaces.bases import Basis; table = Basis.kinds"),
        ("constant", "optlaws.synthesis.problem.constants import MAKERS as table"),
        ("plain constant", "optlaws.synthesis.problem.constants import PLAIN as table"),
    ],
)
def test_whoever_asks_first_sees_every_kind(subject: str, where: str) -> None:
    known = python(f"from {where}\nfor name in table: table[name]\nprint(*sorted(table))").split()
    assert set(known) == declared(subject)


def declared(subject: str) -> set[str]:
    calls = [
        node
        for node in ast.walk(ast.parse((ROOT / "optlaws" / "__init__.py").read_text("utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "declare"
    ]
    tables = {ast.literal_eval(call.args[0]): ast.literal_eval(call.args[1]) for call in calls}
    return {name for names in tables[subject].values() for name in names.split()}


def test_every_kind_of_the_package_is_declared() -> None:
    for subject, registry in REGISTRIES.items():
        own = {name for name, kind in registry.items() if getattr(kind, "func", kind).__module__.startswith("optlaws.")}
        assert own == declared(subject)


def test_a_stored_law_is_read_without_its_module_having_been_imported() -> None:
    law = optlaws.inertial_loader(optlaws.catalogue["K"].law).law
    script = f"from optlaws import MotionLaw; print(MotionLaw.from_dict({law.to_dict()!r}).kind)"
    assert python(script) == "loader\n"
