"""A law by what a person calls it: a name of the catalogue, a member of Savin's families, a stored file, a table."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.catalogue.point_file import law_of_points
from optlaws.laws.law import MotionLaw
from optlaws.laws.savin.family import FAMILIES, SavinFamily

_MEMBER = re.compile(r"\s*(?:family\s+)?(IV|I{1,3})\s*(?:\((.*)\))?\s*", re.IGNORECASE)
_TABLES = (".csv", ".txt", ".tsv", ".tab", ".dat")
_ENDINGS = (".json", *_TABLES)
_SAID: dict[str, Callable[[str], Any]] = {"tolerance": float, "columns": lambda text: tuple(text.split(","))}
#: a file's name and what is said of its table in brackets
_OF_TABLE = re.compile(r"(.+)\((?=[^()]*=)([^()]*)\)", re.DOTALL)
_LONGEST = 100


def read_law(
    text: str | Path, *, tolerance: float | None = None, columns: Sequence[int | str] | None = None
) -> MotionLaw:
    """The law that a text names.

    Parameters
    ----------
    text
        A name or code of the catalogue ("modified sine", "0317(1,5)"), a member of Savin's families by alpha or B
        ("III(7.2)", "III(B=1.8)"), a JSON file with a law, alone or of a solution, a file with a table of points
        (.csv, .txt, .tsv, .tab, .dat), whose tolerance and columns may stand behind it in brackets:
        "old.csv(tolerance=0.02; columns=1,3)".
    tolerance
        Of a table: how far the law may be off its points, in the unit of its displacements, 0 for a law through them;
        the last digit, or what its noise asks for, unless given.
    columns
        Of a table of more than two: those of the time or angle and of the displacement, by headings or numbers from 1.

    Warns
    -----
    NoisyTable
        If a table without a tolerance is noisy.

    Raises
    ------
    InputError
        If there is no such law, or the file cannot be read or holds none.

    Examples
    --------
    >>> read_law("Modified Sine").constants.C
    Peak(value=5.527957, k=0.125)
    >>> read_law("III(7.2)") == SavinFamily.of("III").law(7.2)
    True
    """
    file = text if isinstance(text, Path) else None
    if isinstance(text, str) and member(text) is None and is_file(text):
        name, said = _of_table(text)
        file, tolerance, columns = Path(name), said.get("tolerance", tolerance), said.get("columns", columns)
    if file is not None and file.suffix.lower() in _TABLES:
        return law_of_points(file, tolerance, columns)
    if tolerance is not None or columns is not None:
        raise InputError(
            f"a tolerance and columns are of a table of points ({', '.join(_TABLES)}), got {shortened(text)}"
        )
    if file is not None:
        return stored_law(file)
    chosen = member(str(text))
    if chosen is not None:
        family, alpha = chosen
        return family.law(alpha)
    return catalogue[str(text)].law


def _of_table(text: str) -> tuple[str, dict[str, Any]]:
    """The name of a file, and what is said of its table in brackets."""
    match = _OF_TABLE.fullmatch(text)
    if match is None or not match[1].lower().endswith(_TABLES):
        return text, {}
    said: dict[str, Any] = {}
    for part in match[2].split(";"):
        name, _, value = (piece.strip() for piece in part.partition("="))
        try:
            said[name] = _SAID[name](value)
        except (KeyError, ValueError):
            raise InputError(
                f"a table is said to be read as in old.csv(tolerance=0.02; columns=1,3), got {shortened(text)}"
            ) from None
    return match[1], said


def is_file(text: str) -> bool:
    """Whether a text is taken for a file: it ends as one of a law or a table, or is no law's name and a file is there.

    Examples
    --------
    >>> is_file("law.json"), is_file("modified sine")
    (True, False)
    """
    text = _of_table(text)[0]
    if text.lower().endswith(_ENDINGS):
        return True
    return text not in catalogue and reading.is_file(Path(text))


def is_table(text: str) -> bool:
    """Whether a text is taken for a file with a table of points.

    Examples
    --------
    >>> is_table("old.csv"), is_table("old.csv(tolerance=0.02)"), is_table("law.json")
    (True, True, False)
    """
    return _of_table(text)[0].lower().endswith(_TABLES)


def member(text: str) -> tuple[SavinFamily, float] | None:
    """The family and alpha of a text such as "III(7.2)" or "III(B=1.8)"; None where it names no family.

    Raises
    ------
    InputError
        If it names a family alone, or what is in brackets is no number, or no member.

    Examples
    --------
    >>> member("III(7.2)"), member("cubic")
    ((SavinFamily(u=2), 7.2), None)
    """
    match = _MEMBER.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None:
        return None
    family = SavinFamily.of(match[1].upper())
    if match[2] is None:
        low, high = map(float, family.range)
        name = match[1].upper()
        raise InputError(
            f"{family} has a law for each alpha from {low:.9g} to {high:.9g}: say which by {name}(alpha) or {name}(B=x)"
        )
    name, given, value = match[2].rpartition("=")
    try:
        number = float(value)
    except ValueError:
        raise InputError(
            f"a member is named by a number, such as III(7.2) or III(B=1.8), got {shortened(text)}"
        ) from None
    if given and name.strip() == "B":
        return family, family.alphas(B=number)[0]
    if given and name.strip().casefold() != "alpha":
        raise InputError(f"a member is named by alpha or B, such as III(7.2) or III(B=1.8), got {shortened(text)}")
    family.check(number)
    return family, number


def stored_law(file: Path) -> MotionLaw:
    """The law in a JSON file, alone or under "law" as in what `optlaws solve --output` writes.

    Raises
    ------
    InputError
        If the file cannot be read or holds no law.
    """
    data: Any = reading.json_file(file)
    if isinstance(data, dict) and "kind" not in data and "law" in data:
        data = data["law"]
    try:
        return MotionLaw.from_dict(data)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def family_of(text: str) -> str | None:
    """The name I to IV if a text is that of a family, without a member.

    Examples
    --------
    >>> family_of(" iii "), family_of("III(7.2)")
    ('III', None)
    """
    name = text.strip().upper()
    return name if name in FAMILIES else None
