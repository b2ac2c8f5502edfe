"""Laws by name or from files: names of the catalogue, JSON, and tables of points as CSV."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.files import reading
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.law import MotionLaw
from optlaws.laws.savin import FAMILIES, SavinFamily
from optlaws.numbers import not_negative

_EXACT_DIGITS = 1e-8  # of the stroke: a table whose last digit is less is taken as exact
#: and one of which it is more says nothing of velocities
_COARSEST = 0.01


#: of a measured spectrum in a formula or the name of a functional, unless its pairs stand there
SPECTRUM_FILE = re.compile(r"(spectrum\s*=\s*(['\"]))(?!\s*\{?\s*[-+.\deE]+\s*:)(.*?)\2")


def law_of_points(
    file: Path,
    tolerance: float | None = None,
    columns: Sequence[int | str] | None = None,
    *,
    content: str | None = None,
) -> MotionLaw:
    """The law of a table of points: as near as its last digit, or as its noise lets it be.

    Numbers stand between commas, semicolons, tabs or blanks, with points, or commas where these do not part them, and
    with the same unit behind all of a column or none. Lines before the first numbers are headings; lines behind the
    last ones without a number are not read.

    Parameters
    ----------
    file
        In UTF-8, UTF-16 or Latin-1.
    tolerance
        How far the law may be off a point, in the unit of the displacements; 0 for a law through them.
    columns
        Which hold the time or angle and the displacement, by their headings or by numbers from 1; where a table has
        just two, or is of optlaws, it need not be given.
    content
        The text of the file where it has been read.

    Raises
    ------
    InputError
        If the file cannot be read, has more columns and none are chosen, a line is no point, or no law keeps to them.
    """
    from optlaws.laws.catalogue.tables.columns import points_of
    from optlaws.laws.catalogue.tables.curve_pieces import law_of_pieces
    from optlaws.laws.making.through_points import MOST_THROUGH, law_of_table, law_through

    points = points_of(file, columns, content=content)
    if points.pieces and tolerance is None:
        with located(str(file)):
            if points.heights[0] == points.heights[-1]:
                raise InputError(
                    "it ends where it begins, as a whole cycle does: read_cycle_table and `optlaws cycle` divide it"
                )
            return law_of_pieces(points.pieces)
    k, a, unit = points.places.tolist(), points.heights.tolist(), points.digit
    stroke = abs(a[-1] - a[0])
    if unit > _COARSEST * stroke > 0.0:
        raise InputError(f"{file}: the displacements have too few digits, {unit:g} of a stroke of {stroke:g}")
    try:
        if tolerance is not None:
            return law_through(k, a, not_negative(tolerance, "tolerance"))
        exact = unit <= _EXACT_DIGITS * stroke and len(k) <= MOST_THROUGH
        return law_of_table(k, a, 0.0 if exact else unit, lines=points.lines)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


_MEMBER = re.compile(r"\s*(?:family\s+)?(IV|I{1,3})\s*(?:\((.*)\))?\s*", re.IGNORECASE)
_TABLES = (".csv", ".txt", ".tsv", ".tab", ".dat")
_ENDINGS = (".json", *_TABLES)
_OPTIONS: dict[str, Callable[[str], Any]] = {"tolerance": float, "columns": lambda text: tuple(text.split(","))}
#: a file's name, and the remark on its table in brackets
_OF_TABLE = re.compile(r"(.+)\((?=[^()]*=)([^()]*)\)", re.DOTALL)
_LONGEST = 100
#: before a formula that stands for a law
_FORMULA = "formula:"


def read_law(
    text: str | Path, *, tolerance: float | None = None, columns: Sequence[int | str] | None = None
) -> MotionLaw:
    """The law that a text names.

    Parameters
    ----------
    text
        A name or code of the catalogue ("modified sine", "0317(1,5)"), a member of Savin's families by alpha or B
        ("III(7.2)", "III(B=1.8)"), a formula of k ("formula: k - sin(2*pi*k)/(2*pi)"), the JSON text of a law, which
        begins with "{", a JSON file with a law, alone or of a solution, any other file with a table of points or of a
        controller; of a table (.csv, .txt, .tsv, .tab, .dat) the tolerance and columns may stand behind it in brackets:
        "old.csv(tolerance=0.02; columns=1,3)".
    tolerance
        How far the law of a table may be off its points, in the unit of its displacements, 0 for a law through them;
        the last digit, or what its noise requires, unless given.
    columns
        Columns of the time or angle and of the displacement, by headings or numbers from 1; of a table of more than
        two.

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
        name, options = _of_table(text)
        file, tolerance, columns = Path(name), options.get("tolerance", tolerance), options.get("columns", columns)
    if file is not None and file.suffix.lower() not in {".json", ""}:
        return law_of_points(file, tolerance, columns)
    if tolerance is not None or columns is not None:
        raise InputError(
            f"a tolerance and columns are of a table of points ({', '.join(_TABLES)}), got {shortened(text)}"
        )
    if file is not None:
        return stored_law(file)
    if is_stored(str(text)):
        return MotionLaw.from_json(str(text))
    if is_formula(str(text)):
        from optlaws.laws.making.formula_law import formula_law

        return formula_law(str(text).lstrip().removeprefix(_FORMULA))
    chosen = member(str(text))
    if chosen is not None:
        family, alpha = chosen
        return family.law(alpha)
    return catalogue[str(text)].law


def _of_table(text: str) -> tuple[str, dict[str, Any]]:
    """The name of a file, with the remark on its table in brackets."""
    match = _OF_TABLE.fullmatch(text)
    if match is None or not match[1].lower().endswith(_TABLES):
        return text, {}
    options: dict[str, Any] = {}
    for part in match[2].split(";"):
        name, _, value = (piece.strip() for piece in part.partition("="))
        try:
            options[name] = _OPTIONS[name](value)
        except (KeyError, ValueError):
            raise InputError(
                f"options of a table are written as in old.csv(tolerance=0.02; columns=1,3), got {shortened(text)}"
            ) from None
    return match[1], options


def is_formula(text: str) -> bool:
    """Whether a text is taken for a formula: it begins with "formula:".

    Examples
    --------
    >>> is_formula("formula: k"), is_formula("modified sine")
    (True, False)
    """
    return text.lstrip().startswith(_FORMULA)


def is_stored(text: str) -> bool:
    """Whether a text is taken for the JSON text of a law: it begins with "{".

    Examples
    --------
    >>> is_stored(catalogue["cycloidal"].law.to_json()), is_stored("cycloidal")
    (True, False)
    """
    return text.lstrip().startswith("{")


def is_file(text: str) -> bool:
    """Whether a text means a file: it has the ending of a law or a table, or is no law's name but an existing file's.

    Examples
    --------
    >>> is_file("law.json"), is_file("modified sine")
    (True, False)
    """
    if is_formula(text) or is_stored(text):
        return False
    text = _of_table(text)[0]
    if text.lower().endswith(_ENDINGS):
        return True
    return text not in catalogue and reading.is_file(Path(text))


def with_files(entries: Any, folder: Path) -> Any:
    """The entries of a file in a folder, to which the files that they name are relative.

    A law of a file becomes its JSON text; catalogues of motors and measured spectra are then found from where we are.

    Examples
    --------
    >>> with_files({"drive": {"motors": "motors.toml"}, "law": "cycloidal"}, Path("press"))
    {'drive': {'motors': 'press/motors.toml'}, 'law': 'cycloidal'}
    """
    if isinstance(entries, str):
        return SPECTRUM_FILE.sub(lambda match: f"{match[1]}{(folder / match[3]).as_posix()}{match[2]}", entries)
    if isinstance(entries, Mapping):
        inside = {with_files(name, folder): with_files(each, folder) for name, each in entries.items()}
        law, motors = entries.get("law"), entries.get("motors")
        if isinstance(law, str) and not is_formula(law) and not is_stored(law) and law not in catalogue:
            beside = str(folder / law)
            if is_file(beside):
                inside["law"] = read_law(beside).to_json()
        if isinstance(motors, str) and motors:
            inside["motors"] = (folder / motors).as_posix()
        return inside
    return [with_files(each, folder) for each in entries] if isinstance(entries, list) else entries


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
    if not isinstance(data, dict) or "kind" not in data:
        entries = ", ".join(map(shortened, list(data)[:6])) if isinstance(data, dict) else ""
        contents = f"its entries are {entries}" if entries else "it is no object with entries"
        raise InputError(
            f"{file} holds no law: {contents}, and a law has a 'kind': `optlaws solve --output` writes laws"
        )
    try:
        return MotionLaw.from_dict(data)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def family_of(text: str) -> str | None:
    """The name I to IV if a text names a family, without a member.

    Examples
    --------
    >>> family_of(" iii "), family_of("III(7.2)")
    ('III', None)
    """
    name = text.strip().upper()
    return name if name in FAMILIES else None
