"""The command `optlaws run`: the jobs of problem files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from optlaws.cli.app import Stopped
from optlaws.cli.options import takes
from optlaws.cli.show import Answer, busy
from optlaws.errors import InputError
from optlaws.results import Results


@takes(json=False)
def run(*files: Path, out: Path | None = None) -> Answer:
    """Do the jobs of problem files and write their results.

    Parameters
    ----------
    files
        Problem files (TOML), or names of those that come with optlaws, such as optimal_table.
    out
        Folder for the results of a single file; results/NAME where you are unless given.
    """
    from optlaws.files.packaged import problem_file, problem_names
    from optlaws.jobs import job

    if not files:
        raise InputError(f"name at least one problem file, or one of those packaged: {', '.join(problem_names())}")
    if out is not None and len(files) > 1:
        raise InputError("--out takes the results of one problem file; several were named")
    sources = [problem_file(file) for file in files]
    for source in sources:
        check_folder(source, out)

    def shown() -> Iterator[str]:
        for source in sources:
            with busy(f"optlaws: {source.name}"):
                results = job.done(source)
            yield from written(results, out)

    return Answer(shown, list)


def check_folder(file: Path, out: Path | None) -> None:
    """Refuse, before anything is computed, a folder in which the results of a problem file could not be written."""
    from optlaws.files.writing import check_place

    check_place((out or Path("results", file.stem)) / "results.md")


def written(results: Results, out: Path | None) -> Iterator[str]:
    """Write the results of a problem file; the lines of their pages, and the files."""
    files = results.write(out)
    for text in (file for file in files if file.suffix == ".md"):
        yield from (line for line in text.read_text("utf-8").splitlines() if not line.startswith("<!--"))
    yield from (str(_near(file)) for file in files)
    if results.stopped:
        raise Stopped(results.stopped)


def _near(file: Path) -> Path:
    try:
        return file.resolve().relative_to(Path.cwd())
    except ValueError:
        return file
