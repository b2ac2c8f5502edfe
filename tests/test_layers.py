"""The layers of optlaws: each knows those below it and none above."""

import ast
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from tests.documents import ROOT
from tests.imports import Import, cycles, declared, imports, modules

BASE = {"echo", "errors", "files", "kept", "lazy", "numbers", "sentences", "shown", "spelling", "tolerances"}
KNOWN = BASE | {"numerics", "entries"}
CORE = KNOWN | {"formulas", "laws", "synthesis", "mechanisms", "motion", "cycles", "exports", "cams", "verification"}
MAY_IMPORT = {
    "echo": set[str](),
    "errors": {"echo", "sentences"},
    "formulas": KNOWN,
    "entries": BASE | {"motion"},
    "files": {"echo", "errors", "lazy", "tolerances"},
    "kept": set[str](),
    "lazy": {"spelling"},
    "numbers": {"echo", "errors"},
    "sentences": set[str](),
    "shown": {"numbers", "sentences"},
    "spelling": set[str](),
    "tolerances": set[str](),
    "numerics": BASE - {"shown"},
    "laws": KNOWN | {"formulas"},
    "synthesis": KNOWN | {"formulas", "laws"},
    "mechanisms": KNOWN | {"formulas", "laws", "synthesis", "motion"},
    "verification": KNOWN | {"formulas", "laws", "synthesis", "mechanisms"},
    "motion": KNOWN | {"laws"},
    "cycles": KNOWN | {"formulas", "laws", "synthesis", "mechanisms", "motion"},
    "exports": KNOWN | {"laws", "mechanisms", "motion"},
    "cams": KNOWN | {"formulas", "laws", "synthesis", "mechanisms", "motion", "cycles", "exports"},
    "balancing": CORE,
    "plots": CORE,
    "studies": CORE,
    "schemas": {"cycles", "echo", "errors"},
    "results": {"kept", "echo", "errors", "files", "plots", "shown"},
    "problems": {"echo", "errors", "files", "results"},
    "jobs": CORE | {"plots", "studies", "results", "problems"},
    "explorer": CORE | {"plots", "studies", "jobs", "optlaws"},
    "typing": CORE | {"balancing", "studies"},
    "cli": CORE | {"balancing", "plots", "studies", "jobs", "results", "explorer", "optlaws"},
    "__main__": {"cli"},
}

#: registries that a room above fills with kinds of its own; the tables of optlaws/__init__.py say which
KINDS = {"basis", "constant", "export format", "law", "plain constant", "segment", "what moves"}

#: what several folders have one of their own of
SEVERAL = {
    "atlas",
    "axes",
    "catalogue",
    "below_peak",
    "cam",
    "certificate",
    "checks",
    "constants",
    "cycle",
    "dwell",
    "export",
    "family",
    "follower",
    "front",
    "law",
    "laws",
    "ledger",
    "lever",
    "limits",
    "loader",
    "machine",
    "mechanism",
    "motion",
    "nomogram",
    "of_basis",
    "optimal",
    "peaks",
    "reading",
    "report",
    "rows",
    "run",
    "savin",
    "search",
    "segment",
    "solve",
    "space",
    "splines",
    "study",
    "summary",
    "table",
    "tables",
}
#: what finds a law or a proof: no part of what checks a proof again
FINDERS = (
    "optlaws.synthesis.method",
    "optlaws.synthesis.solve",
    "optlaws.synthesis.proof.make",
)
CHECKERS = (
    "optlaws.verification",
    "optlaws.synthesis.proof.certificate",
    "optlaws.synthesis.proof.data",
    "optlaws.synthesis.proof.duality",
    "optlaws.synthesis.proof.peak_rows",
    "optlaws.synthesis.proof.power.box",
    "optlaws.synthesis.proof.nodes",
)
MUST_NOT_IMPORT = {
    "errors": {"casadi", "matplotlib", "scipy"},
    "numerics": {"casadi", "matplotlib", "scipy"},
    "formulas": {"matplotlib", "scipy"},
    "laws": {"casadi", "matplotlib", "scipy"},
    "synthesis": {"matplotlib"},
    "mechanisms": {"matplotlib"},
    "motion": {"casadi", "matplotlib", "scipy"},
    "cycles": {"matplotlib"},
    "exports": {"casadi", "matplotlib"},
    "cams": {"matplotlib"},
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


def known(package: Path) -> list[Import]:
    """Imports within the package; a package's face, which shows what lies in it, has none."""
    faces = {name for name, path in modules(package).items() if path.name == "__init__.py"}
    return [one for one in imports(package) if one.source not in faces and one.target != "optlaws"]


def ring(package: Path, *, typing: bool = True) -> list[list[str]]:
    return cycles([one for one in imports(package) if "optlaws" not in (one.source, one.target)], typing=typing)


def rooms(package: Path) -> list[Import]:
    """Who knows whom among the folders below the layers; what lies in a layer itself is a room of its own."""
    folders = {name for name, path in modules(package).items() if path.name == "__init__.py"}

    def room(module: str) -> str:
        names = module.split(".")
        folder = len(names) > 3 or (len(names) == 3 and module in folders)
        return ".".join(names[: 3 if folder else 2])

    arrows = {(room(one.source), room(one.target)) for one in known(package) if one.target.startswith("optlaws.")}
    return [Import(source, target, 0, typing=False) for source, target in sorted(arrows) if source != target]


def reachable(package: Path, prefix: str) -> set[str]:
    """All that modules of a prefix import, directly or not."""
    known_value = known(package)
    seen = {one.source for one in known_value if f"{one.source}.".startswith(f"{prefix}.")}
    assert seen, f"there is no {prefix}"
    while new := {one.target for one in known_value if one.source in seen} - seen:
        seen |= new
    return seen


def test_every_module_has_a_layer() -> None:
    found = {layer(one.source) for one in imports(ROOT / "optlaws")}
    assert found <= MAY_IMPORT.keys() | {"optlaws"}


def test_no_layer_knows_one_above_it() -> None:
    assert trespasses(ROOT / "optlaws") == []


def arrows_in_strings(package: Path) -> list[str]:
    """Tables of the face by which a layer would know one above it, but for kinds."""
    return [f"{subject}: {one}" for subject, one in declared(package) if subject not in KINDS and not is_allowed(one)]


def test_tables_of_names_hide_no_arrow_upwards() -> None:
    assert arrows_in_strings(ROOT / "optlaws") == []
    assert {subject for subject, _ in declared(ROOT / "optlaws")} == KINDS


def test_an_arrow_in_a_table_is_seen(tmp_path: Path) -> None:
    face = 'declare("drawing", {"optlaws.jobs.cam": "cam"})\ndeclare("segment", {"optlaws.jobs.part": "part"})'
    registries = 'DRAWINGS = Registry("drawing")\nSEGMENTS = Registry("segment")'
    package = write(tmp_path, {"__init__.py": face, "cams/disc.py": registries, "jobs/cam.py": ""})
    assert arrows_in_strings(package) == ["drawing: optlaws.cams.disc:1 imports optlaws.jobs.cam"]


def test_no_modules_import_each_other() -> None:
    assert ring(ROOT / "optlaws") == []


def test_no_rooms_know_each_other() -> None:
    assert cycles(rooms(ROOT / "optlaws")) == []


@pytest.mark.parametrize("checker", CHECKERS)
def test_what_checks_a_proof_knows_nothing_that_finds_one(checker: str) -> None:
    met = reachable(ROOT / "optlaws", checker)
    assert sorted(name for name in met if f"{name}.".startswith(tuple(f"{finder}." for finder in FINDERS))) == []


def test_a_name_means_one_module_unless_every_room_has_such_a_one() -> None:
    names = Counter(path.stem for path in (ROOT / "optlaws").rglob("*.py") if not path.name.startswith("__"))
    assert {name for name, count in names.items() if count > 1} <= SEVERAL


def test_no_module_repeats_its_folder_in_its_name() -> None:
    files = (path for path in (ROOT / "optlaws").rglob("*.py") if path.stem != path.parent.name)
    assert [str(path) for path in files if path.stem.startswith(path.parent.name)] == []


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
        ("laws/law.py", "import typing\nif typing.TYPE_CHECKING:\n    import optlaws.synthesis"),
        ("laws/law.py", "from optlaws import MotionLaw"),
        ("synthesis/solve.py", "import optlaws.mechanisms.machine.follower"),
        ("synthesis/solve.py", "from optlaws.plots import style"),
        ("synthesis/solution.py", "def plot():\n    from optlaws.plots import law"),
        ("synthesis/solution.py", "class S:\n    def repr(self):\n        from optlaws.plots import law"),
        ("synthesis/solution.py", "class S:\n    def plot(self):\n        from optlaws.cams import disc"),
        ("studies/run.py", "from optlaws.cli import main"),
        ("errors.py", "import optlaws.laws"),
        ("novelty.py", "import optlaws.laws"),
    ],
)
def test_a_trespass_is_seen(tmp_path: Path, name: str, source: str) -> None:
    empty = {
        f"{package}/__init__.py": "" for package in ("laws", "synthesis", "mechanisms", "studies", "plots", "cams")
    }
    package = write(tmp_path, empty | {"plots/law.py": "", "cams/disc.py": "", "cli.py": ""} | {name: source})
    assert len(trespasses(package)) == 1


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("laws/law.py", "import numpy as np\nfrom optlaws.errors import InputError\nfrom . import peaks"),
        ("synthesis/solve.py", "import casadi as ca\nfrom optlaws.laws import MotionLaw"),
        ("laws/law.py", "class Law:\n    def plot(self):\n        from optlaws.plots.law import draw_curve"),
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


def test_an_import_for_the_type_checker_closes_a_cycle_when_it_is_counted(tmp_path: Path) -> None:
    package = write(
        tmp_path,
        {
            "laws/law.py": "from optlaws.laws.peaks import peak",
            "laws/peaks.py": "import typing\nif typing.TYPE_CHECKING:\n    import optlaws.laws.law",
        },
    )
    assert ring(package, typing=False) == []
    assert ring(package) == [["optlaws.laws.law", "optlaws.laws.peaks"]]


def test_rooms_that_know_each_other_are_seen(tmp_path: Path) -> None:
    rooms_of = ("synthesis", "synthesis/method", "synthesis/proof")
    faces = {f"{room}/__init__.py": "" for room in rooms_of}
    one_way = {"synthesis/method/ipopt.py": "", "synthesis/proof/make.py": "from optlaws.synthesis.method import ipopt"}
    package = write(tmp_path, faces | one_way)
    assert cycles(rooms(package)) == []
    assert "optlaws.synthesis.method.ipopt" in reachable(package, "optlaws.synthesis.proof")
    write(
        tmp_path, {"synthesis/proof/farkas.py": "", "synthesis/method/flat.py": "import optlaws.synthesis.proof.farkas"}
    )
    assert ring(package) == []
    assert cycles(rooms(package)) == [["optlaws.synthesis.method", "optlaws.synthesis.proof"]]


def test_no_package_imports_its_own_modules() -> None:
    # a thread that imports one of them waits for its package, which waits for it
    package = ROOT / "optlaws"
    packages = {name for name, path in modules(package).items() if path.name == "__init__.py"}
    tops = {
        name: {node.lineno for node in ast.parse(modules(package)[name].read_text("utf-8")).body} for name in packages
    }
    within = [
        found
        for found in imports(package)
        if found.source in packages - {"optlaws"}
        and not found.typing
        and found.line in tops[found.source]
        and found.target.startswith(f"{found.source}.")
    ]
    assert not within, "\n".join(map(str, within))
