"""Cams in drawings: pitch curves of displacements, rollers, masses and the frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from optlaws import drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

FILL = "#dfe9f3"
ROLLER = 0.17
MASS = (2.4, 0.7)


def cam(axes: Axes, at: tuple[float, float], radii: Array, angles: Array, *, shown: float, colour: str) -> float:
    """A cam turned so that the angle `shown` is on top, with its roller there; the height of the roller's centre.

    `radii` is its pitch curve, the way of the roller's centre, at cam angles in radians over a whole turn.
    """
    from matplotlib.patches import Circle, Polygon

    phase = angles - shown + 0.5 * np.pi
    pitch = np.array([at[0] + radii * np.cos(phase), at[1] + radii * np.sin(phase)]).T
    along = np.gradient(pitch, axis=0)
    normal = np.array([along[:, 1], -along[:, 0]]).T / np.linalg.norm(along, axis=1)[:, None]
    axes.add_patch(Polygon(pitch - ROLLER * normal, closed=True, facecolor=FILL, edgecolor=colour, linewidth=1.4))
    axes.add_patch(Circle(at, 0.12, facecolor="white", edgecolor=drawing.GREY, linewidth=1.0, zorder=3))
    top = at[1] + float(np.interp(shown, angles, radii))
    axes.add_patch(Circle((at[0], top), ROLLER, facecolor="white", edgecolor=drawing.GREY, linewidth=1.2, zorder=4))
    return top


def slide(axes: Axes, x: float, *, roller: float, guide: float, label: str) -> None:
    """A rod from a roller through a guide to a mass."""
    from matplotlib.patches import Rectangle

    width, height = MASS
    bottom = guide + 0.75 + roller - 1.2
    axes.plot([x, x], [roller, bottom], color=drawing.GREY, linewidth=3.0, solid_capstyle="butt", zorder=3)
    style: dict[str, Any] = {"facecolor": drawing.BLUES[3], "edgecolor": "none", "zorder": 4}
    axes.add_patch(Rectangle((x - 0.5 * width, bottom), width, height, **style))
    axes.text(x, bottom + 0.5 * height, label, color="white", ha="center", va="center", zorder=5)
    for side in (-1.0, 1.0):
        edge = x + side * 0.09
        axes.plot([edge, edge], [guide - 0.18, guide + 0.18], color=drawing.GREY, linewidth=1.4, zorder=3)
        for up in np.linspace(-0.15, 0.15, 4):
            axes.plot([edge, edge + side * 0.08], [guide + up, guide + up - 0.06], color=drawing.GREY, linewidth=1.0)
