import os
import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import optlaws
from tests.documents import ROOT

PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
PINS = [Requirement(line) for line in (ROOT / "constraints.txt").read_text("utf-8").splitlines()]
REQUIRED = [
    requirement
    for lines in (PROJECT["dependencies"], *PROJECT["optional-dependencies"].values())
    for line in lines
    if (requirement := Requirement(line)).name != "optlaws"
]


def test_the_package_is_marked_as_typed() -> None:
    assert (ROOT / "optlaws" / "py.typed").is_file()


def test_there_is_one_version() -> None:
    assert optlaws.__version__ == metadata.version("optlaws") == PROJECT["version"]


def test_the_command_is_installed() -> None:
    (command,) = metadata.entry_points(group="console_scripts", name="optlaws")
    assert callable(command.load())


def test_a_constraint_is_a_name_and_one_version() -> None:
    one_version = re.compile(r"==[0-9][0-9a-z.]*")
    wrong = [pin for pin in PINS if pin.url or pin.extras or not one_version.fullmatch(str(pin.specifier))]
    assert list(map(str, wrong)) == []


def test_every_dependency_has_a_reason() -> None:
    page = (ROOT / "docs" / "architecture.md").read_text("utf-8").partition("## Dependencies")[2].partition("\n## ")[0]
    reasons = [line.split("|")[1].strip() for line in page.splitlines() if line.startswith("| ")][1:]
    assert reasons == sorted(Requirement(line).name for line in PROJECT["dependencies"])


@pytest.mark.parametrize("requirement", REQUIRED, ids=str)
def test_every_dependency_is_pinned_to_a_version_it_allows(requirement: Requirement) -> None:
    pins = [pin for pin in PINS if canonicalize_name(pin.name) == canonicalize_name(requirement.name)]
    assert pins
    for pin in pins:
        (specifier,) = pin.specifier
        assert requirement.specifier.contains(specifier.version)


#: what of the tests uses most of the libraries
WITH_LOWEST = ("tests/test_public_api.py", "tests/laws", "tests/files", "tests/cycles", "tests/exports", "tests/cli")


@pytest.mark.long
def test_the_lowest_versions_that_are_allowed_install_and_pass(tmp_path: Path) -> None:
    from uv import find_uv_bin

    uv, python = find_uv_bin(), tmp_path / "bin" / "python"
    extras = "cad,control,studies,test"
    for command in (
        [uv, "venv", "--quiet", "--python", sys.executable, str(tmp_path)],
        [
            uv,
            "pip",
            "install",
            "--quiet",
            "--python",
            str(python),
            "--resolution",
            "lowest-direct",
            "-e",
            f"{ROOT}[{extras}]",
        ],
        # what old libraries warn of in new ones that they use is not of optlaws
        [str(python), "-m", "pytest", "-q", "-W", "ignore::DeprecationWarning", "-p", "no:cacheprovider", *WITH_LOWEST],
    ):
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        process = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, env=environment)
        assert process.returncode == 0, process.stdout[-3000:] + process.stderr[-3000:]
