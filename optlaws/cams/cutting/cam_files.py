"""Files that cut a cam: the formats by name and by the ending of the file, and the one door to them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Unpack

from optlaws.cams.cutting.dxf import as_arcs, as_polyline, as_spline
from optlaws.cams.cutting.file_options import Cutting, CuttingOptions
from optlaws.cams.cutting.outline import Outline
from optlaws.cams.cutting.text_formats import as_arc_moves, as_line_moves, as_points, as_polar, as_svg
from optlaws.errors import InputError
from optlaws.files import writing
from optlaws.suggest import unknown_key

Format = Callable[[Outline, Cutting], str]

#: formats by their names; one is added by an entry
FORMATS: dict[str, Format] = {
    "dxf spline": as_spline,
    "dxf polyline": as_polyline,
    "dxf arcs": as_arcs,
    "svg": as_svg,
    "csv": as_points,
    "csv polar": as_polar,
    "g-code": as_line_moves,
    "g-code arcs": as_arc_moves,
}
#: which of them a file is written in unless it is said
ENDINGS = {
    ".dxf": "dxf spline",
    ".svg": "svg",
    ".csv": "csv",
    ".nc": "g-code",
    ".ngc": "g-code",
    ".gcode": "g-code",
    ".tap": "g-code",
}


def format_of(file: Path, name: str | None = None) -> str:
    """The format that a file is written in.

    Raises
    ------
    InputError
        If the name is none of a format, or the file's ending says none.

    Examples
    --------
    >>> format_of(Path("profile.dxf")), format_of(Path("profile.dxf"), "dxf arcs")
    ('dxf spline', 'dxf arcs')
    >>> format_of(Path("cam.igs"))
    Traceback (most recent call last):
    optlaws.errors.InputError: the ending of 'cam.igs' says no format: end it with .csv, .dxf, ... or name one of ...
    """
    if name is not None:
        if name not in FORMATS:
            raise InputError(unknown_key(name, FORMATS, "format"))
        return name
    known = ENDINGS.get(file.suffix.lower())
    if known is None:
        raise InputError(
            f"the ending of {file.name!r} says no format: end it with {', '.join(sorted(ENDINGS))}, or name one of "
            f"{', '.join(FORMATS)}"
        )
    return known


def text(outline: Outline, name: str, options: Cutting) -> str:
    """The text of a file in a format."""
    return FORMATS[name](outline, options)


def write_outline(
    outline: Outline, file: str | Path, as_: str | None = None, **options: Unpack[CuttingOptions]
) -> Path:
    """The file of a closed curve, written whole or not at all: a profile, a pitch curve, the path of a cutter.

    `as_` is one of `FORMATS`, that of the file's ending unless given; options are those of `Cutting`.

    Raises
    ------
    InputError
        If the format or an entry is unknown, a value is out of its range, or the file cannot be written.
    """
    place = Path(file)
    name = format_of(place, as_)
    given: dict[str, Any] = {key: value for key, value in options.items() if value is not None}
    for key in given:
        if key not in Cutting.__dataclass_fields__:
            raise InputError(unknown_key(key, Cutting.__dataclass_fields__, "entry"))
    cutting = Cutting(**given)
    writing.check_place(place)
    return writing.write(place, text(outline, name, cutting), exact=True)
