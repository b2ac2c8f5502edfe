"""Tables of points as CSV, cartesian over the cam's angle or polar over even angles around its centre."""

from __future__ import annotations

from math import tau

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.cutting.file_options import Cutting
from optlaws.cams.cutting.outline import Outline
from optlaws.errors import InputError
from optlaws.files.writing import MARK

Array = NDArray[np.float64]

_SAMPLES = 7201
_HALVINGS = 60


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
    return _halved(outline, angles[which], angles[which + 1], bearings, sign)


def _halved(outline: Outline, low: Array, high: Array, bearings: Array, sign: float) -> Array:
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        points = outline(middle)
        beyond = sign * (points[:, 1] * np.cos(bearings) - points[:, 0] * np.sin(bearings)) > 0.0
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return 0.5 * (low + high)
