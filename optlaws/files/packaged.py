"""Data that come with optlaws: problem files by their names."""

from __future__ import annotations

from pathlib import Path

from optlaws.echo import unknown_key
from optlaws.errors import InputError

_PACKAGE = Path(__file__).resolve().parents[1]
#: an installed package carries its data; in a checkout they lie beside the package
_ROOTS = (_PACKAGE / "packaged", _PACKAGE.parent)


def packaged(place: str) -> Path:
    """A file or folder that comes with optlaws, by its place in the repository."""
    for root in _ROOTS:
        if (root / place).exists():
            return root / place
    raise InputError(f"{place} did not come with this optlaws; name the file")


def problem_names() -> list[str]:
    """Names of the problem files that come with optlaws."""
    return sorted(file.stem for file in packaged("problems").glob("*.toml"))


def problem_file(given: Path) -> Path:
    """A problem file: the given one or, if it does not exist, the packaged file of this name or path.

    Examples
    --------
    >>> problem_file(Path("optimal_table")).name
    'optimal_table.toml'
    """
    if given.suffix or len(given.parts) != 1 or given.exists():
        return _or_packaged(given)
    names = problem_names()
    if given.name not in names:
        raise InputError(
            f"{given} is no file, and {unknown_key(given.name, names, 'packaged problem')} (optlaws has "
            f"{', '.join(names)})"
        )
    return packaged(f"problems/{given.name}.toml")


def is_problem(text: str) -> bool:
    """Whether a text means a problem file: it ends in .toml, or is the name of a packaged file."""
    return text.lower().endswith(".toml") or (text in problem_names() and not Path(text).exists())


def _or_packaged(given: Path) -> Path:
    """A file of the user or, if it does not exist, the packaged file of this path."""
    if given.is_absolute() or given.exists() or ".." in given.parts:
        return given
    return next((root / given for root in _ROOTS if (root / given).is_file()), given)
