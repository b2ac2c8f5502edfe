"""SVG files at scale: one unit is a millimetre, and the curve is made of the Bézier curves of a cubic spline."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.cutting.file_options import Cutting
from optlaws.cams.cutting.outline import Outline
from optlaws.cams.cutting.spline import Spline, spline
from optlaws.files.writing import MARK

Array = NDArray[np.float64]

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
