"""The wheel as a user gets it: installed without extras in a new environment, where the blocks of README.md are run.

`python -m tests.check_wheel [--lowest] [PYTHON ...]` does it with each Python that is named (3.12, or a path), this one
unless one is named, and with the lowest versions that dependencies may have. It prints what was installed and how large
it is, and ends with 1 where a block fails.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from argparse import ArgumentParser
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.documents import ROOT

#: run by the Python of the new environment, in a folder that has the first page and how its blocks are run
BLOCKS = """
import sys
from tests.documents import FIRST_PAGE, documents
import optlaws
assert "site-packages" in optlaws.__file__, optlaws.__file__
# made from a file of the wheel that is no module
assert "press_motion" in optlaws.smoothstep(3).export("c99", stroke="35 mm", duration="0.1 s", name="press").text
count = failed = 0
document = documents.parse(FIRST_PAGE)
for example in document.examples():
    count += 1
    try:
        example.evaluate()
    except Exception as error:
        failed += 1
        print(f"line {example.line}: {error}", file=sys.stderr)
print(f"{count} examples of README.md, {failed} failed")
sys.exit(failed > 0)
"""
_MEGABYTE = 1e6
_LARGEST = 6


def uv(*arguments: str) -> None:
    """Run uv, without what this environment says of others."""
    from uv import find_uv_bin

    subprocess.run([find_uv_bin(), *arguments], check=True, env=environment())


def environment() -> dict[str, str]:
    """The environment of a user, who has no checkout."""
    return {name: value for name, value in os.environ.items() if name not in {"PYTHONPATH", "VIRTUAL_ENV"}}


def built(folder: Path) -> Path:
    """The wheel of this checkout."""
    command = [sys.executable, "-m", "hatchling", "build", "--target", "wheel", "--directory", str(folder)]
    subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL, env=environment())
    (wheel,) = folder.glob("*.whl")
    return wheel


def size(path: Path) -> float:
    """What a file, or all of a folder, takes, in MB."""
    files = [path] if path.is_file() else [file for file in path.rglob("*") if file.is_file()]
    return sum(file.stat().st_size for file in files) / _MEGABYTE


def checked(wheel: Path, python: str, *, lowest: bool) -> bool:
    """Install a wheel with one Python and run the blocks; whether none fails."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        place, tools, page = folder / "environment", folder / "tools", folder / "page"
        uv("venv", "--quiet", "--python", python, str(place))
        own = str(place / "bin" / "python")
        versions = ["--resolution", "lowest-direct"] if lowest else []
        uv("pip", "install", "--quiet", "--python", own, *versions, str(wheel))
        # what runs the blocks stands beside the environment, not in it
        uv("pip", "install", "--quiet", "--python", own, "--target", str(tools), f"sybil=={version('sybil')}")
        (page / "tests").mkdir(parents=True)
        shutil.copy(ROOT / "README.md", page)
        shutil.copy(ROOT / "tests" / "documents.py", page / "tests")
        paths = {"PYTHONPATH": os.pathsep.join([str(page), str(tools)]), "MPLBACKEND": "Agg"}
        done = subprocess.run(
            [own, "-W", "ignore::DeprecationWarning", "-c", BLOCKS], check=False, cwd=page, env=environment() | paths
        )
        (packages,) = place.glob("lib/python*/site-packages")
        sizes = sorted(((size(part), part.name) for part in packages.iterdir()), reverse=True)
        largest = ", ".join(f"{part} {large:.0f}" for large, part in sizes[:_LARGEST])
        count = sum(part.suffix == ".dist-info" for part in packages.iterdir())
        kind = "lowest" if lowest else "newest"
        print(
            f"Python {python}, {kind} versions: {count} packages, {sum(large for large, _ in sizes):.0f} MB ({largest})"
        )
    return done.returncode == 0


def main() -> int:
    """Check with each Python."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("python", nargs="*", default=[sys.executable])
    parser.add_argument("--lowest", action="store_true")
    given = parser.parse_args()
    with TemporaryDirectory() as folder:
        wheel = built(Path(folder))
        print(f"{wheel.name}: {size(wheel):.2f} MB")
        results = [checked(wheel, python, lowest=given.lowest) for python in given.python]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
