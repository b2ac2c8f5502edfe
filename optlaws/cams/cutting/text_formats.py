"""Outlines as text: tables of points, moves of a cutter in G-code, and drawings in SVG."""

from __future__ import annotations

from math import tau

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.cutting.arcs_and_chords import arcs, polygon
from optlaws.cams.cutting.file_options import Cutting
from optlaws.cams.cutting.outline import Outline
from optlaws.cams.cutting.spline import Spline, spline
from optlaws.errors import InputError
from optlaws.files.writing import MARK
from optlaws.numbers import Array
from optlaws.numerics.bisection import bisect_each

_SAMPLES = 7201


def as_points(outline: Outline, options: Cutting) -> str:
    """Angle of the cam in degrees, x and y in millimetres; the angles are even."""
    angles = np.linspace(0.0, tau, options.points)
    rows = zip(np.degrees(angles), *(1e3 * outline(angles)).T, strict=True)
    return _table(
        "cam angle (deg),x (mm),y (mm)", [[_decimal(t), *map(options.rounded, xy)] for t, *xy in rows], options
    )


def as_polar(outline: Outline, options: Cutting) -> str:
    """Angle around the centre in degrees, counterclockwise, and the radius in millimetres; the angles are even.

    Raises
    ------
    InputError
        If the curve turns back as seen from the centre, so that a ray meets it more than once.
    """
    rows = zip(np.linspace(0.0, 360.0, options.points), 1e3 * polar(outline, options.points), strict=True)
    return _table("polar angle (deg),radius (mm)", [[_decimal(t), options.rounded(r)] for t, r in rows], options)


def polar(outline: Outline, points: int) -> Array:
    """Radii at even angles around the centre, m, from the direction of x on; the last is the first again.

    Raises
    ------
    InputError
        If the curve turns back as seen from the centre.
    """
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

    def before(angle: Array) -> NDArray[np.bool_]:
        x, y = outline(angle).T
        return np.asarray(~(sign * (y * np.cos(bearings) - x * np.sin(bearings)) > 0.0))

    low, high = bisect_each(before, angles[which], angles[which + 1])
    return 0.5 * (low + high)


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
    feed = f" F{options.feed_rate:.9g}" if options.feed is not None else ""
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
