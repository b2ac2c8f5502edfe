"""Scripts that come with optlaws and use its public names only: one for each published problem, run by its name.

They lie in `problems/` of a checkout and in the package where it is installed. No file of a user's is ever run.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from traceback import extract_tb

from optlaws.errors import OptlawsError
from optlaws.files.packaged import packaged
from optlaws.files.reading import check_names
from optlaws.results import Results

__path__ = [str(packaged("problems"))]


def names() -> list[str]:
    """Names of the problems that scripts solve.

    Examples
    --------
    >>> "lever_tables" in names(), "cam_press" in names()
    (True, False)
    """
    return sorted(file.stem for file in packaged("problems").glob("*.py") if file.stem != "__init__")


def run(name: str, out: Path | None = None) -> list[Path]:
    """Run the script of a problem that comes with optlaws and return the files written.

    Parameters
    ----------
    name
        The problem's name.
    out
        Folder for the results; `results/NAME` where you are unless given.

    Raises
    ------
    InputError
        If no script has this name.
    OptlawsError
        If a number is not what the script asserts of it; then nothing is written.
    """
    return results_of(name).write(out)


def results_of(name: str) -> Results:
    """The results of a script, not yet written; errors are as of `run`."""
    check_names([name], names(), "script")
    results = Results(packaged(f"problems/{name}.toml"))
    try:
        import_module(f"{__name__}.{name}").run(results)
    except AssertionError as error:
        line = extract_tb(error.__traceback__)[-1]
        raise OptlawsError(f"{name}: not as asserted in {line.filename}, line {line.lineno}: {line.line}") from None
    return results
