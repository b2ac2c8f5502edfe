"""Every problem file run on a copy of results/: the results say the same again, but for a processor's rounding.

`python -m tests.check_results NAME...` leaves out the files that are named, prints what differs, and ends with 1 where
anything does. Two processes run all files, those with most results first, so that both end together: to begin sixty
times takes as long as to solve.
"""

import io
import os
import shutil
import sys
from collections.abc import Collection
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stdout
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.files import say_the_same


def written(name: str) -> list[str]:
    """The files that a problem file writes where this process is."""
    said = io.StringIO()
    with redirect_stdout(said):
        code = exit_code(["run", "--force", name])
    if code:
        msg = f"optlaws run {name} ends with {code}"
        raise RuntimeError(msg)
    lines = said.getvalue().splitlines()
    return [line.removeprefix("results/") for line in lines if line.startswith("results/") and " " not in line]


def size(name: str) -> int:
    """The bytes of all results of a problem file."""
    return sum(file.stat().st_size for file in (ROOT / "results" / name).glob("*"))


def differences(kept: Path, anew: Path, names: Collection[str], unsteady: Collection[str]) -> list[str]:
    """What is in one place alone, and what says something else; `names` are those that the problem files wrote."""
    files = [file.relative_to(kept) for file in kept.rglob("*") if file.is_file()]
    there = {file.as_posix() for file in files if file.parts[0] not in unsteady}
    differing = [f"{name}: {'not written' if name in there else 'not kept'}" for name in sorted(there ^ set(names))]
    for name in sorted(there & set(names)):
        first, second = ((folder / name).read_bytes() for folder in (kept, anew))
        if not say_the_same(first, second, Path(name).suffix):
            differing.append(f"{name}: says something else")
    return differing


def main(unsteady: Collection[str]) -> int:
    """Print what differs, but for files whose end is decided by rounding."""
    problems = sorted(
        {file.stem for file in (ROOT / "problems").glob("*.toml")} - set(unsteady), key=size, reverse=True
    )
    with TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "results", Path(folder, "results"), ignore=lambda *_: unsteady)
        with ProcessPoolExecutor(2, get_context("spawn"), initializer=os.chdir, initargs=(folder,)) as pool:
            names = [name for some in pool.map(written, problems) for name in some]
        differing = differences(ROOT / "results", Path(folder, "results"), names, unsteady)
    differing.append("results/ differs from what the problem files give" if differing else "results/ agrees with them")
    sys.stdout.writelines(f"{line}\n" for line in differing)
    return len(differing) > 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
