"""The layers of optlaws: each knows those below it and none above."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.documents import ROOT
from tests.imports import Import, cycles, imports

BASE = {"echo", "errors", "files", "kept", "locks", "numbers", "suggest"}
KNOWN = BASE | {"series"}
CORE = KNOWN | {"laws", "synthesis", "mechanisms", "verification"}
MAY_IMPORT = {
    "echo": set[str](),
    "errors": {"echo"},
    "files": {"echo", "errors", "suggest"},
    "kept": set[str](),
    "locks": set[str](),
    "numbers": {"echo", "errors"},
    "suggest": {"echo"},
    "series": BASE,
    "laws": KNOWN,
    "synthesis": KNOWN | {"laws"},
    "mechanisms": KNOWN | {"laws", "synthesis"},
    "verification": KNOWN | {"laws", "synthesis"},
    "drawing": CORE,
    "studies": CORE | {"drawing"},
    "jobs": CORE | {"drawing", "studies"},
    "cli": CORE | {"drawing", "studies", "jobs", "optlaws"},
    "__main__": {"cli"},
}

#: circles that only a type checker sees: fewer is better, none is the aim
CIRCLES = 0
MUST_NOT_IMPORT = {
    "errors": {"casadi", "matplotlib", "scipy"},
    "series": {"casadi", "matplotlib", "scipy"},
    "laws": {"casadi", "matplotlib", "scipy"},
    "synthesis": {"matplotlib"},
    "mechanisms": {"matplotlib"},
    "verification": {"casadi", "matplotlib", "scipy"},
}


def layer(module: str) -> str:
    """The layer a module of optlaws belongs to; `optlaws` itself re-exports and is one of its own."""
    return module.split(".")[1] if "." in module else module


def trespasses(package: Path) -> list[str]:
    return [str(one) for one in imports(package) if layer(one.source) != "optlaws" and not is_allowed(one)]


def is_allowed(one: Import) -> bool:
    source = layer(one.source)
    top = one.target.split(".")[0]
    if top != "optlaws":
        return top not in MUST_NOT_IMPORT.get(source, set())
    return layer(one.target) in MAY_IMPORT.get(source, set()) | {source}


def ring(package: Path, *, typing: bool = False) -> list[list[str]]:
    return cycles([one for one in imports(package) if "optlaws" not in (one.source, one.target)], typing=typing)


def test_every_module_has_a_layer() -> None:
    found = {layer(one.source) for one in imports(ROOT / "optlaws")}
    assert found <= MAY_IMPORT.keys() | {"optlaws"}


def test_no_layer_knows_one_above_it() -> None:
    assert trespasses(ROOT / "optlaws") == []


def test_no_modules_import_each_other() -> None:
    assert ring(ROOT / "optlaws") == []


def test_no_more_modules_know_each_other_by_their_types() -> None:
    assert len(ring(ROOT / "optlaws", typing=True)) <= CIRCLES


def test_importing_optlaws_is_light() -> None:
    heavy = ["casadi", "matplotlib", "scipy.optimize"]
    script = f"import sys, optlaws; print(*(name for name in {heavy} if name in sys.modules))"
    loaded = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert loaded.stdout.split() == []


def write(root: Path, sources: dict[str, str]) -> Path:
    for name, source in {"__init__.py": "", **sources}.items():
        path = root / "optlaws" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(source, "utf-8")
    return root / "optlaws"


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("laws/law.py", "import casadi as ca"),
        ("laws/law.py", "from scipy.interpolate import PPoly"),
        ("laws/law.py", "def plot():\n    import matplotlib.pyplot as plt"),
        ("laws/law.py", "from ..synthesis import solve"),
        ("laws/law.py", "from optlaws import synthesis"),
        ("laws/__init__.py", "from .. import mechanisms"),
        (
            "laws/law.py",
            "import typing\nif typing.TYPE_CHECKING:\n    import optlaws.synthesis",
        ),
        ("laws/law.py", "from optlaws import MotionLaw"),
        ("synthesis/solve.py", "import optlaws.mechanisms.follower"),
        ("synthesis/solve.py", "from optlaws import drawing"),
        ("studies/run.py", "from optlaws.cli import main"),
        ("errors.py", "import optlaws.laws"),
        ("novelty.py", "import optlaws.laws"),
    ],
)
def test_a_trespass_is_seen(tmp_path: Path, name: str, source: str) -> None:
    empty = {f"{package}/__init__.py": "" for package in ("laws", "synthesis", "mechanisms", "studies")}
    package = write(tmp_path, empty | {"drawing.py": "", "cli.py": ""} | {name: source})
    assert len(trespasses(package)) == 1


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("laws/law.py", "import numpy as np\nfrom optlaws.errors import InputError\nfrom . import peaks"),
        ("synthesis/solve.py", "import casadi as ca\nfrom optlaws.laws import MotionLaw"),
        ("cli.py", "from optlaws import __version__, studies"),
        ("__init__.py", "from optlaws.cli import main"),
        ("__main__.py", "from optlaws.cli import main"),
    ],
)
def test_what_the_layers_allow_is_no_trespass(tmp_path: Path, name: str, source: str) -> None:
    package = write(tmp_path, {"laws/__init__.py": "", "laws/peaks.py": "", "studies.py": "", name: source})
    assert trespasses(package) == []


def test_a_cycle_is_seen_whether_direct_or_through_others(tmp_path: Path) -> None:
    package = write(
        tmp_path,
        {
            "laws/__init__.py": "from .law import MotionLaw",
            "laws/law.py": "from . import peaks",
            "laws/peaks.py": "def peak():\n    from optlaws.laws import MotionLaw",
            "laws/savin.py": "from .law import MotionLaw",
        },
    )
    assert ring(package) == [["optlaws.laws", "optlaws.laws.law", "optlaws.laws.peaks"]]


def test_an_import_for_the_type_checker_closes_no_cycle(tmp_path: Path) -> None:
    package = write(
        tmp_path,
        {
            "laws/law.py": "from optlaws.laws.peaks import peak",
            "laws/peaks.py": "import typing\nif typing.TYPE_CHECKING:\n    import optlaws.laws.law",
        },
    )
    assert ring(package) == []
    assert ring(package, typing=True) == [["optlaws.laws.law", "optlaws.laws.peaks"]]
