"""A law by what a person calls it: a name of the catalogue, a member of Savin's families, a stored file, a table."""

from __future__ import annotations

import re
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
_TABLE = ".csv"
_ENDINGS = (".json", _TABLE)
_LONGEST = 100


def read_law(text: str | Path) -> MotionLaw:
    """The law that a text names.

    Parameters
    ----------
    text
        A name or code of the catalogue ("modified sine", "0317(1,5)"), a member of Savin's families by alpha or B
        ("III(7.2)", "III(B=1.8)"), a JSON file with a law, alone or of a solution, a CSV file with a table of
        points.

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
    if isinstance(text, Path):
        return stored_law(text)
    chosen = member(text)
    if chosen is not None:
        family, alpha = chosen
        return family.law(alpha)
    return stored_law(Path(text)) if is_file(text) else catalogue[text].law


def is_file(text: str) -> bool:
    """Whether a text is taken for a file: it ends in .json or .csv, or is no law's name and a file is there.

    Examples
    --------
    >>> is_file("law.json"), is_file("modified sine")
    (True, False)
    """
    if text.lower().endswith(_ENDINGS):
        return True
    return text not in catalogue and reading.storable(text) and Path(text).is_file()


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
    """The law in a JSON file, alone or under "law" as in what `optlaws solve --output` writes, or of a table in CSV.

    Raises
    ------
    InputError
        If the file cannot be read or holds no law.
    """
    if file.suffix.lower() == _TABLE:
        return law_of_points(file)
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
