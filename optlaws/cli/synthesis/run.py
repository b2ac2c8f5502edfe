"""The command `optlaws run`: the jobs of problem files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from optlaws.cli.show import busy, show
from optlaws.errors import InputError

if TYPE_CHECKING:
    from optlaws.results import Results


def run(*files: Path, out: Path | None = None) -> None:
    """Do the jobs of problem files and write their results.

    Parameters
    ----------
    files
        Problem files (TOML), or names of those that come with optlaws, such as optimal_table.
    out
        Folder for the results of a single file; otherwise results/NAME beside the folder of the problem file, and of a
        name results/NAME where you are.
    """
    from optlaws.files import writing
    from optlaws.files.packaged import problem_file, problem_names

    if not files:
        raise InputError(f"name at least one problem file, or one of those packaged: {', '.join(problem_names())}")
    if out is not None and len(files) > 1:
        raise InputError("--out takes the results of one problem file; several were named")
    sources = [problem_file(file) for file in files]
    for place in (out or folder for _, folder in sources):
        if place is not None:
            writing.check_place(place / "results.md")
    for file, folder in sources:
        done(file, out or folder)


def done(file: Path, out: Path | None) -> Results:
    """Do the job of a problem file, write its results, and print its tables and the files."""
    from optlaws.jobs import job

    with busy(f"{file}"):
        results = job.done(file)
        written = results.write(job.folder_of(file) if out is None else out)
    for text in (w for w in written if w.suffix == ".md"):
        lines = text.read_text(encoding="utf-8").splitlines()
        show(*(line for line in lines if not line.startswith("<!--")))
    for result in written:
        print(_near(result))
    return results


def _near(file: Path) -> Path:
    try:
        return file.resolve().relative_to(Path.cwd())
    except ValueError:
        return file
