"""Files that cut a cam: tables of points, G-code, SVG and DXF, by name and by the ending of the file; their options."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import KW_ONLY
from logging import ERROR, getLogger
from math import atan2, degrees, tau
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Unpack

import numpy as np

from optlaws.cams.curves.approximations import DEGREES, Spline, arcs, polygon, spline
from optlaws.cams.curves.plane_curve import Outline
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Choice, Measured, Text, Whole
from optlaws.errors import InputError, not_installed
from optlaws.files import writing
from optlaws.files.reading import check_names
from optlaws.files.writing import MARK
from optlaws.lazy import process_lock
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array, NumberOrQuantity
from optlaws.numerics.roots import bracketed_roots

if TYPE_CHECKING:
    from ezdxf.layouts.layout import Modelspace


DECIMALS, POINTS = Whole(0, 12), Whole(13, 100_000)
CutCurve = Literal["profile", "pitch", "cutter"]
CURVES = ("profile", "pitch", "cutter")
CutFormat = Literal["dxf spline", "dxf polyline", "dxf arcs", "svg", "csv", "csv polar", "g-code", "g-code arcs"]


class CuttingOptions(TypedDict, total=False):
    """The options of files for cutting, each of which `Cutting` documents."""

    tolerance: NumberOrQuantity | None
    decimals: int | None
    points: int | None
    degree: int | None
    feed: NumberOrQuantity | None
    about: str | None


@declared
class Cutting(Declared, title="a file for cutting"):
    """The checked options of a file for cutting; `about` is what the file says of itself."""

    tolerance: NumberOrQuantity = entry(
        Measured("length", above=0.0),
        "How far polygon, arcs or spline may be from the curve.",
        default="1 um",
    )
    decimals: int = entry(DECIMALS, "Of a millimetre.", default=6)
    points: int = entry(POINTS, "Of a table over the whole turn, the last being the first again.", default=721)
    degree: int = entry(Whole(min(DEGREES), max(DEGREES)), "That of splines, 3 or 5.", default=3)
    feed: NumberOrQuantity | None = entry(
        Measured("velocity", above=0.0),
        "Of the tool; the file has none unless given.",
        default=None,
        example="200 mm/min",
    )
    about: str = "cam"

    def _check(self) -> None:
        if self.degree not in DEGREES:
            raise InputError(f"degree must be 3 or 5, got {self.degree}")
        if not isinstance(self.about, str):
            raise InputError(f"about must be text, got {shortened(self.about)}")

    @property
    def metres(self) -> float:
        return quantity(self.tolerance, "length", "tolerance", above=0.0)

    @property
    def line(self) -> str:
        """The description of the file on one line of plain characters."""
        printable = "".join(
            character if " " <= character <= "~" and character not in "()<>&" else " " for character in self.about
        )
        return " ".join(printable.split())[:200] or "cam"

    def rounded(self, value: float) -> str:
        """A number of millimetres with the requested decimals; zero has no sign."""
        text = f"{value:.{self.decimals}f}"
        return text.removeprefix("-") if not text.strip("-0.") else text


_SAMPLES = 7201


def as_points(outline: Outline, options: Cutting) -> str:
    """Angle of the cam in degrees, x and y in millimetres; the angles are even."""
    angles = np.linspace(0.0, tau, options.points)
    rows = zip(np.degrees(angles), *(1e3 * outline(angles)).T, strict=True)
    return _table(
        "cam angle (deg),x (mm),y (mm)", [[_decimal(t), *map(options.rounded, xy)] for t, *xy in rows], options
    )


def as_polar(outline: Outline, options: Cutting) -> str:
    """Angle around the centre in degrees, counterclockwise, and the radius in millimetres; the angles are even."""
    rows = zip(np.linspace(0.0, 360.0, options.points), 1e3 * polar(outline, options.points), strict=True)
    return _table("polar angle (deg),radius (mm)", [[_decimal(t), options.rounded(r)] for t, r in rows], options)


def polar(outline: Outline, points: int) -> Array:
    """Radii at even angles around the centre, m, from the direction of x on; the last is the first again."""
    bearings = np.linspace(0.0, tau, points)
    met = outline(_met(outline, bearings[:-1]))
    radii = np.hypot(met[:, 0], met[:, 1])
    return np.append(radii, radii[0])


def _table(heading: str, rows: list[list[str]], options: Cutting) -> str:
    return "\n".join([f"# {options.line}; {MARK}", heading, *(",".join(row) for row in rows), ""])


def _decimal(angle: float) -> str:
    return f"{angle:.9f}".rstrip("0").rstrip(".")


def _met(outline: Outline, bearings: Array) -> Array:
    """The cam's angles at which rays from the centre meet the curve."""
    angles = np.linspace(0.0, tau, _SAMPLES)
    points = outline(angles)
    swept = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    sign = float(np.sign(swept[-1] - swept[0]))
    swept = sign * (swept - swept[0])
    if sign == 0.0 or np.any(np.diff(swept) <= 0.0) or abs(swept[-1] - tau) > 1e-6:
        raise InputError(
            "the curve turns back as seen from the centre, so that it has no radius over the polar angle: take the "
            "table of x and y"
        )
    first = float(np.arctan2(points[0, 1], points[0, 0]))
    turns = np.mod(sign * (bearings - first), tau)
    which = np.clip(np.searchsorted(swept, turns, side="right") - 1, 0, _SAMPLES - 2)

    def beyond(angle: Array) -> Array:
        x, y = outline(angle).T
        return np.asarray(sign * (y * np.cos(bearings) - x * np.sin(bearings)))

    low, high = angles[which], angles[which + 1]
    # a ray through a sample may pass it on the other side by rounding
    return bracketed_roots(beyond, (low, high), (np.minimum(beyond(low), 0.0), np.maximum(beyond(high), 0.0)))


def as_line_moves(outline: Outline, options: Cutting) -> str:
    """G1 from corner to corner, once around, back to the first."""
    corners = 1e3 * polygon(outline, options.metres).corners
    moves = [f"G1 {_at(corner, options)}" for corner in (*corners[1:], corners[0])]
    return _program(corners[0], moves, options)


def as_arc_moves(outline: Outline, options: Cutting) -> str:
    """G2 (clockwise) and G3 with I and J from where the move begins, G1 where it is straight."""
    chain = arcs(outline, options.metres)
    rows = zip(1e3 * chain.points, 1e3 * chain.ends, 1e3 * chain.centres, chain.bulges, strict=True)
    moves = []
    for start, stop, centre, bulge in rows:
        if bulge == 0.0:
            moves.append(f"G1 {_at(stop, options)}")
            continue
        i, j = centre - start
        turn = "G3" if bulge > 0.0 else "G2"
        moves.append(f"{turn} {_at(stop, options)} I{options.rounded(float(i))} J{options.rounded(float(j))}")
    return _program(1e3 * chain.points[0], moves, options)


def _program(start: np.ndarray, moves: list[str], options: Cutting) -> str:
    """Units, plane and mode, the way to the start, and the moves: spindle, depth and compensation are the user's."""
    given = options.feed
    feed = "" if given is None else f" F{60e3 * quantity(given, 'velocity', 'feed', above=0.0):.9g}"
    return "\n".join(
        [
            f"({options.line}; {MARK})",
            "G21 G17 G90 G40",
            f"G0 {_at(start, options)}",
            moves[0] + feed,
            *moves[1:],
            "",
        ]
    )


def _at(point: np.ndarray, options: Cutting) -> str:
    return f"X{options.rounded(float(point[0]))} Y{options.rounded(float(point[1]))}"


_MARGIN = 5.0
_CROSS = 3.0


def as_svg(outline: Outline, options: Cutting) -> str:
    """The curve as one closed path, with a cross at the cam's centre; y points up on the paper."""
    # SVG's y points down
    points = beziers(spline(outline, options.metres)) * [1e3, -1e3]
    low, high = points.min(axis=(0, 1)) - _MARGIN, points.max(axis=(0, 1)) + _MARGIN
    box = [options.rounded(length) for length in (*low, *(high - low))]
    pieces = "\n".join(f"C {_pair(a, options)} {_pair(b, options)} {_pair(c, options)}" for _, a, b, c in points)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{box[2]}mm" height="{box[3]}mm" viewBox="{" ".join(box)}">\n'
        f"<desc>{options.line}; {MARK}</desc>\n"
        f'<path id="profile" fill="none" stroke="black" stroke-width="0.1" d="M {_pair(points[0, 0], options)}\n'
        f'{pieces}\nZ"/>\n'
        f'<path id="centre" fill="none" stroke="black" stroke-width="0.1" '
        f'd="M {-_CROSS} 0 H {_CROSS} M 0 {-_CROSS} V {_CROSS}"/>\n</svg>\n'
    )


def beziers(curve: Spline) -> Array:
    """The Bézier control points of each piece of a cubic spline, m, shape (n, 4, 2)."""
    places = np.array(curve.breaks)
    third = np.diff(places)[:, None] / 3.0
    points, tangents = curve(places), curve(places, 1)
    return np.stack(
        [points[:-1], points[:-1] + third * tangents[:-1], points[1:] - third * tangents[1:], points[1:]], axis=1
    )


def _pair(point: Array, options: Cutting) -> str:
    return f"{options.rounded(float(point[0]))},{options.rounded(float(point[1]))}"


LAYER, CENTRE = "PROFILE", "CENTRE"
_MILLIMETRES = 4
_OLD = "R12"  # knows no units
_lock = process_lock()


def as_spline(outline: Outline, options: Cutting) -> str:
    """A clamped SPLINE of degree 3 or 5 whose parameter is the cam's angle in radians."""
    fitted = spline(outline, options.metres, options.degree)

    def draw(space: Modelspace) -> None:
        from ezdxf.math import BSpline

        points = [(1e3 * x, 1e3 * y, 0.0) for x, y in fitted.controls.tolist()]
        curve = BSpline(points, order=fitted.degree + 1, knots=fitted.knots.tolist())
        space.add_spline(dxfattribs={"layer": LAYER}).apply_construction_tool(curve)

    return _document("R2000", options, draw)


def as_polyline(outline: Outline, options: Cutting) -> str:
    """A closed LWPOLYLINE with its corners on the curve."""
    corners = np.round(1e3 * polygon(outline, options.metres).corners, options.decimals)

    def draw(space: Modelspace) -> None:
        space.add_lwpolyline(corners.tolist(), format="xy", close=True, dxfattribs={"layer": LAYER})

    return _document("R2000", options, draw)


def as_arcs(outline: Outline, options: Cutting) -> str:
    """ARCs that touch each other, and LINEs where it is straight, in a file of release 12, which all cutters read."""
    chain = arcs(outline, options.metres)
    rows = zip(1e3 * chain.points, 1e3 * chain.ends, 1e3 * chain.centres, 1e3 * chain.radii, chain.bulges, strict=True)

    def draw(space: Modelspace) -> None:
        for start, stop, centre, radius, bulge in rows:
            attributes = {"layer": LAYER}
            if bulge == 0.0:
                space.add_line(start.tolist(), stop.tolist(), dxfattribs=attributes)
                continue
            first, last = (degrees(atan2(*(point - centre)[::-1])) for point in (start, stop))
            # an ARC always runs counterclockwise
            first, last = (first, last) if bulge > 0.0 else (last, first)
            space.add_arc(centre.tolist(), float(radius), first, last, dxfattribs=attributes)

    return _document(_OLD, options, draw)


def _document(release: str, options: Cutting, draw: Callable[[Modelspace], None]) -> str:
    """The text of a file with a drawing and the cam's centre, the same whenever it is written."""
    ezdxf = _ezdxf()
    stream = io.StringIO()
    with _without_date(ezdxf):
        document = ezdxf.new(release, units=0 if release == _OLD else _MILLIMETRES)
        for name in (LAYER, CENTRE):
            document.layers.add(name)
        draw(document.modelspace())
        document.modelspace().add_point((0.0, 0.0), dxfattribs={"layer": CENTRE})
        document.write(stream)
    return f"999\n{options.line}; {MARK}\n{stream.getvalue()}"


def _ezdxf() -> Any:
    try:
        import ezdxf
    except ImportError:
        raise not_installed("a DXF file needs ezdxf", "'optlaws[cad]'") from None
    return ezdxf


@contextmanager
def _without_date(ezdxf: Any) -> Iterator[None]:
    with _lock:
        # it warns of the units of release 12 even where there are none
        logger = getLogger("ezdxf")
        previous, level = ezdxf.options.write_fixed_meta_data_for_testing, logger.level
        ezdxf.options.write_fixed_meta_data_for_testing = True
        logger.setLevel(ERROR)
        try:
            yield
        finally:
            ezdxf.options.write_fixed_meta_data_for_testing = previous
            logger.setLevel(level)


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
#: the default of these for a file
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
    """The format that a file is written in."""
    if name is not None:
        check_names([name], FORMATS, "format")
        return name
    known = ENDINGS.get(file.suffix.lower())
    if known is None:
        raise InputError(
            f"the ending of {file.name!r} names no format: use the ending {', '.join(sorted(ENDINGS))}, or name one of "
            f"{', '.join(FORMATS)}"
        )
    return known


@declared
class CutFile(Cutting, title="a file"):
    """A file that cuts the cam."""

    _: KW_ONLY
    name: str = entry(Text(), "Of the file, in the folder of results.", example="profile.dxf")
    format: CutFormat | None = entry(
        Choice(*FORMATS), "That of the name's ending unless given.", default=None, example="dxf spline"
    )
    curve: CutCurve | None = entry(
        Choice(*CURVES), "The profile, or the path of a cutter with a radius, unless given.", default=None
    )
    cutter_radius: NumberOrQuantity | None = entry(
        Measured("length", above=0.0), "Of the cutter whose path the file has.", default=None, example="10 mm"
    )

    def _check(self) -> None:
        super()._check()
        if Path(self.name).name != self.name:
            raise InputError(f"name must be that of a file in the folder of results, got {self.name!r}")
        writing.check_name(Path(self.name))
        format_of(Path(self.name), self.format)

    def check_writer(self) -> None:
        """Refuse a format whose writer is not installed, before anything is computed for it."""
        if format_of(Path(self.name), self.format).startswith("dxf"):
            _ezdxf()

    def write(self, outline: Outline, file: Path, *, force: bool = False) -> Path:
        """The file of a closed curve at a place, written whole or not at all; `force` replaces other contents."""
        writing.check_place(file)
        text = FORMATS[format_of(file, self.format)](outline, self)
        return writing.write(file, text, exact=True, force=force)


def write_outline(
    outline: Outline,
    file: str | Path,
    as_: str | None = None,
    *,
    force: bool = False,
    **options: Unpack[CuttingOptions],
) -> Path:
    """The file of a closed curve, written whole or not at all: a profile, a pitch curve, the path of a cutter.

    `as_` is the format; options are those of `Cutting`.
    """
    place = Path(file)
    given: dict[str, Any] = {key: value for key, value in options.items() if value is not None}
    check_names(given, Cutting.__dataclass_fields__, "entry")
    return CutFile(name=place.name, **(given | {"format": as_})).write(outline, place, force=force)
