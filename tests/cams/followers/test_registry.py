"""A follower stands in its folder: nothing else asks of which kind one is, but where a slide's offset is sought."""

import ast
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import optlaws
from optlaws import InputError
from tests.internals.cams import CamFollower

PACKAGE = Path(optlaws.__file__).parent
FOLDER = PACKAGE / "cams" / "followers"
#: modules that make a follower of one kind, and ask of no other: arms with rollers, slides whose offset is sought,
#: and the cams that views and examples show first
MAKERS = {
    "balancing/dwells/dwell_machine.py": {"OscillatingRoller"},
    "cams/at_shaft.py": {"translating roller"},
    "cams/least_sizes.py": {"TranslatingRoller"},
    "jobs/sought_cam.py": {"TranslatingRoller"},
    "jobs/starters/starter.py": {"TranslatingRoller"},
    "explorer/views/cam_view.py": {"translating roller"},
}


def kind_modules() -> set[str]:
    return {kind.__module__.rpartition(".")[2] for kind in CamFollower.kinds().values()}


def kind_words() -> set[str]:
    """Names of classes in the files of the kinds, and the kinds' own."""
    trees = (ast.parse((FOLDER / f"{name}.py").read_text("utf-8")) for name in kind_modules())
    classes = {node.name for tree in trees for node in tree.body if isinstance(node, ast.ClassDef)}
    return {name for name in classes if not name.startswith("_")} | set(CamFollower.kinds())


def named(tree: ast.Module) -> Iterator[str]:
    """Names, attributes and whole texts of a module; examples in docstrings are longer texts."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.Attribute):
            yield node.attr
        elif isinstance(node, ast.alias):
            yield node.name
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def test_no_module_outside_the_folder_names_a_kind() -> None:
    words, faults = kind_words(), []
    assert {"TranslatingRoller", "SwingingFace", "SlidingFace", "RollerContact", "inclined flat"} <= words
    for path in PACKAGE.rglob("*.py"):
        place = path.relative_to(PACKAGE).as_posix()
        if path.parent == FOLDER or place == "__init__.py":  # which lists the public names
            continue
        source = path.read_text("utf-8")
        if any(word in source for word in words):
            seen = words.intersection(named(ast.parse(source))) - MAKERS.get(place, set())
            faults += [f"{place}: {name}" for name in sorted(seen)]
    assert faults == []


def test_no_module_of_the_folder_names_another_ones_kind() -> None:
    """Rollers and faces stand side by side; what they share is in their contact."""
    assert len(kind_modules()) > 1
    for module in kind_modules():
        imported = {
            node.module.rpartition(".")[2]
            for node in ast.walk(ast.parse((FOLDER / f"{module}.py").read_text("utf-8")))
            if isinstance(node, ast.ImportFrom) and node.module
        }
        assert not imported & kind_modules(), module


def test_no_follower_is_told_by_its_class() -> None:
    """Outside the files of the kinds `isinstance` asks only whether there is a follower at all."""
    files = [*(PACKAGE / "cams").rglob("*.py"), *(PACKAGE / "jobs" / "cam").rglob("*.py")]
    for path in files:
        if path.relative_to(PACKAGE).as_posix() in MAKERS:
            continue
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "isinstance":
                assert not kind_words().intersection(named(ast.Module([ast.Expr(node)], []))), path


def test_a_kind_is_read_by_its_name_and_refused_with_the_remedy() -> None:
    assert len(CamFollower.kinds()) == 5
    given = {"radius": "12 mm", "arm": "90 mm", "pivot_distance": "120 mm", "inclination": "10 deg"}
    for name, kind in CamFollower.kinds().items():
        entries = {key: value for key, value in given.items() if key in kind.__dataclass_fields__}  # type: ignore[attr-defined]
        follower = CamFollower.from_dict({"kind": name, **entries})
        assert isinstance(follower, kind)
        assert np.isfinite(follower.prime_radius(1.0))
        assert (follower.pivot is None) == (follower.axis == "length")
    with pytest.raises(InputError, match="translating roller"):
        CamFollower.from_dict({"kind": "translating rollr"})
    with pytest.raises(InputError, match="a follower needs its kind: give one of translating roller"):
        CamFollower.from_dict({"radius": "12 mm"})
