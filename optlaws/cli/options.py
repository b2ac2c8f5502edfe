"""Options shared by several commands: whole numbers, laws by name or file, --json, files to write."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter, Token

import optlaws
from optlaws.echo import shortened
from optlaws.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _whole(_: object, tokens: Sequence[Token]) -> int:
    # the parser itself would cut 2.5 to 2
    return int(tokens[0].value)


def _numbers_without_unit(remedy: str, tokens: Sequence[Token]) -> list[float]:
    try:
        return [float(token.value) for token in tokens]
    except ValueError:
        given = " ".join(token.value for token in tokens)
        raise ValueError(f"{shortened(given)} is no number without a unit: {remedy}") from None


def _follower_frequency(_: object, tokens: Sequence[Token]) -> float:
    remedy = "the frequency nu is in radians in the rise; one in Hz is --natural-frequency, with --duration or --speed"
    return _numbers_without_unit(remedy, tokens)[0]


def _law_frequencies(_: object, tokens: Sequence[Token]) -> list[float]:
    remedy = "the frequency nu is in radians in the motion: 2 pi times that in Hz and the duration in s"
    return _numbers_without_unit(remedy, tokens)


#: frequencies of an elastic follower without dimension, which people give in Hz
FollowerFrequency = Annotated[float, Parameter(converter=_follower_frequency)]
Frequencies = Annotated[list[float], Parameter(converter=_law_frequencies)]
Whole = Annotated[int, Parameter(converter=_whole)]
#: how long a motion takes, which older scripts call its time
#: a quantity that may be below 0, which is the library's to take or to refuse
Signed = Annotated[str | None, Parameter(allow_leading_hyphen=True)]
Duration = Annotated[str | None, Parameter(name=("--duration", "--time"), allow_leading_hyphen=True)]
AsJson = Annotated[bool, Parameter(name="--json")]
#: where a command draws what it has found
Plot = Annotated[Path | None, Parameter(name="--plot")]


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class TableOptions:
    """Options for reading a table of points.

    Parameters
    ----------
    tolerance
        Of a table of points: how far the law may be off them, in the unit of the displacements, 0 for a law through
        them; by default, the last digit or the noise of the table.
    columns
        Of a table of more than two: those of the time or angle and of the displacement, by headings or numbers, as 1,3.
    """

    tolerance: float | None = None
    columns: str | None = None


WHOLE_TABLE = TableOptions()

_PICTURES = (".png", ".svg")


def read_law(
    text: str,
    alpha: float | None = None,
    B: float | None = None,
    *,
    by: str = "",
    points: TableOptions = WHOLE_TABLE,
) -> optlaws.MotionLaw:
    """The law of a text, as every command takes it; a family I to IV may have its member by alpha, or B, beside it.

    `by` are the options that choose a member; `points` are those of a table of points.

    Raises
    ------
    InputError
        If there is no such law, the file cannot be read or holds none, or a member is given of what is no family.

    Examples
    --------
    >>> read_law("iii", alpha=7.2) == read_law("III(7.2)")
    True
    """
    from optlaws.laws.catalogue import reading

    family = reading.family_of(text)
    if alpha is None and B is None:
        if family is not None and by:
            low, high = map(float, optlaws.SavinFamily.of(family).range)
            raise InputError(f"laws of family {family} need {by}: alpha is from {low:.9g} to {high:.9g}")
        columns = None if points.columns is None else points.columns.split(",")
        return reading.read_law(text, tolerance=points.tolerance, columns=columns)
    if family is None:
        raise InputError(
            f"{by} choose a member of a family I, II, III or IV, and no other takes it, got {shortened(text)}"
        )
    return optlaws.savin(family, alpha, B=B)


def check_files(*files: Path | None, plot: Path | None = None) -> None:
    """Refuse, before anything is computed, files that could not be written, and a --plot that is no kind of picture."""
    from optlaws.files.writing import check_place

    if plot is not None and plot.suffix not in _PICTURES:
        raise InputError(f"--plot takes a file name that ends in {' or '.join(_PICTURES)}, got {plot}")
    for file in (*files, plot):
        if file is not None:
            check_place(file)


def save(file: Path, data: Mapping[str, Any]) -> None:
    """Write the file of --output, with the name of its author program."""
    from optlaws.files.writing import MARK, write

    write(file, json.dumps({"about": MARK, **data}, indent=1) + "\n")


def save_picture(file: Path, value: Any) -> None:
    """Draw the picture of --plot into its file."""
    from optlaws.plots.style import plot_style

    with plot_style():
        save_figure(file, value.plot()[0].get_figure(root=True))


def save_figure(file: Path, figure: Figure) -> None:
    """Write a figure into the file of --plot, in the format of the file's ending."""
    from optlaws.files.writing import write
    from optlaws.plots.style import rendered

    write(file, rendered(figure, file.suffix[1:]))
