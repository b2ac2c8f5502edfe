"""The command `optlaws run`: the jobs of problem files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

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
        Folder for the results of a single file; otherwise results/NAME beside the folder of the problem file, and of a
        name results/NAME where you are.
    """
    from optlaws.files import writing
    from optlaws.files.packaged import problem_file, problem_names
    from optlaws.jobs import job

    if not files:
        raise InputError(f"name at least one problem file, or one of those packaged: {', '.join(problem_names())}")
    if out is not None and len(files) > 1:
        raise InputError("--out takes the results of one problem file; several were named")
    sources = [problem_file(file) for file in files]
    for place in (out or folder for _, folder in sources):
        if place is not None:
            writing.check_place(place / "results.md")

    def shown() -> Iterator[str]:
        for file, folder in sources:
            with busy(f"{file}"):
                results = job.done(file)
            yield from written(results, out or folder)

    return Answer(shown, list)


def written(results: Results, out: Path | None) -> Iterator[str]:
    """Write the results of a problem file; the lines of their pages, and the files."""
    from optlaws.jobs import job

    files = results.write(job.folder_of(results.file) if out is None else out)
    for text in (file for file in files if file.suffix == ".md"):
        yield from (line for line in text.read_text("utf-8").splitlines() if not line.startswith("<!--"))
    yield from (str(_near(file)) for file in files)


def _near(file: Path) -> Path:
    try:
        return file.resolve().relative_to(Path.cwd())
    except ValueError:
        return file
