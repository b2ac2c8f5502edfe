"""Faces: names are imported when first used, type checkers see the same names, and nothing heavy comes along."""

import ast
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

import optlaws
from optlaws import Basis, MotionLaw
from optlaws.lazy import Registry
from tests.contracts.faces import faces, stub
from tests.documents import ROOT
from tests.internals.laws import Segment
from tests.internals.synthesis import MAKERS, PLAIN

FACES = dict(faces())
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


@pytest.mark.parametrize("file", FACES, ids=package)
def test_type_checkers_see_the_names_of_the_table(file: Path) -> None:
    assert file.with_suffix(".pyi").read_text("utf-8") == stub(file, FACES[file])


@pytest.mark.parametrize("file", FACES, ids=package)
def test_every_name_of_the_table_is_there(file: Path) -> None:
    face = import_module(package(file))
    for module, names in FACES[file].items():
        for name in names.split():
            assert getattr(face, name) is getattr(import_module(module), name)
            assert name in dir(face)


def removed_names() -> list[tuple[str, str]]:
    """Names of the version before, each with its package."""
    return [
        (package(file), name)
        for file in FACES
        for call in ast.walk(ast.parse(file.read_text("utf-8")))
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


def test_no_stub_is_without_its_table() -> None:
    assert {file.with_suffix(".py") for file in (ROOT / "optlaws").rglob("*.pyi")} == set(FACES)


def test_importing_optlaws_imports_no_subject() -> None:
    script = "import sys, optlaws; print(*(name for name in sys.modules if name.startswith('optlaws.')))"
    assert set(python(script).split()) <= {
        f"optlaws.{name}" for name in ("lazy", "laws", "locks", "mechanisms", "synthesis")
    }


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
        own = {name for name, kind in registry.items() if kind.__module__.startswith("optlaws.")}
        assert own == declared(subject)


def test_a_stored_law_is_read_without_its_module_having_been_imported() -> None:
    law = optlaws.inertial_loader(optlaws.catalogue["K"].law).law
    script = f"from optlaws import MotionLaw; print(MotionLaw.from_dict({law.to_dict()!r}).kind)"
    assert python(script) == "loader\n"
