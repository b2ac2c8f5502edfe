"""Known laws beside a front: Savin's families as curves, smoothsteps and laws of the catalogue as points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws import drawing
from optlaws.errors import InputError
from optlaws.laws import MotionLaw, smoothstep
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.savin.family import FAMILIES
from optlaws.laws.savin.savin import alpha_range, savin
from optlaws.synthesis import FUNCTIONALS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from optlaws.jobs.laws.fronts import Picture

Pair = tuple[float, float]

SMOOTHSTEPS = "smoothstep"
_STROKES: dict[str, Any] = {"I": ":", "II": "-.", "III": "--", "IV": (0, (5, 1))}
_NEAR = 0.035  # of the axes: points nearer than this in both directions have their labels on different sides


def check_beside(picture: Picture) -> None:
    """Refuse names that are neither a family, nor "smoothstep", nor a law of the catalogue.

    Raises
    ------
    InputError
        If there is one.
    """
    for name in picture.catalogue:
        if name not in FAMILIES and name != SMOOTHSTEPS:
            try:
                _ = catalogue[name]
            except InputError as error:
                raise InputError(f"figure {picture.name}, catalogue: {error}") from None


def draw_beside(axes: Axes, picture: Picture, x: Pair, y: Pair) -> None:
    """Draw what the picture's entry `catalogue` names, as far as it lies in the window x, y."""
    for family in (name for name in picture.catalogue if name in FAMILIES):
        laws = [savin(family, float(alpha)) for alpha in np.linspace(*alpha_range(family), 61)]
        points = np.array([_point(law, picture) for law in laws])
        if not any(_inside(point, x, y) for point in points.tolist()):
            continue
        style: dict[str, Any] = {"color": drawing.GREEN, "linestyle": _STROKES[family], "linewidth": 1.2, "zorder": 3}
        axes.plot(*points.T, label=f"Savin's family {family} (l = {FAMILIES[family] + 2})", **style)
    if SMOOTHSTEPS in picture.catalogue:
        _smoothsteps(axes, picture, x, y)
    _laws(axes, picture, x, y)


def _smoothsteps(axes: Axes, picture: Picture, x: Pair, y: Pair) -> None:
    label = "smoothsteps, by order l"
    for order in (2, 3, 4, 5):
        point = _point(smoothstep(order), picture)
        if _inside(point, x, y):
            ring: dict[str, Any] = {
                "color": drawing.WARM,
                "markerfacecolor": "white",
                "markersize": 11.0,
                "zorder": 5,
            }
            axes.plot(*point, "o", label=label, **ring)
            centred: dict[str, Any] = {"ha": "center", "va": "center_baseline", "fontsize": 8.0, "zorder": 6}
            axes.annotate(f"{order}", point, color=drawing.WARM, **centred)
            label = "_nolegend_"


def _laws(axes: Axes, picture: Picture, x: Pair, y: Pair) -> None:
    """Laws of the catalogue as numbered points, with their names in the legend."""
    named = [name for name in picture.catalogue if name not in FAMILIES and name != SMOOTHSTEPS]
    found = [(catalogue[name].name, _point(catalogue[name].law, picture)) for name in named]
    shown = [(name, point) for name, point in found if _inside(point, x, y)]
    from matplotlib.patheffects import withStroke

    for number, (name, point) in enumerate(shown, 1):
        diamond: dict[str, Any] = {"color": drawing.WARM, "markersize": 5.0, "zorder": 5}
        axes.plot(*point, "D", label=f"{number}  {name}", **diamond)
        before = [other for _, other in shown[: number - 1]]
        crowded = any(_near(point, other, x, y) for other in before)
        place: dict[str, Any] = {"xytext": (-6, -9) if crowded else (6, 4), "textcoords": "offset points"}
        text: dict[str, Any] = {"fontsize": 8.0, "zorder": 6, "ha": "right" if crowded else "left"}
        text["path_effects"] = [withStroke(linewidth=2.5, foreground="white")]
        axes.annotate(f"{number}", point, color=drawing.WARM, **place, **text)


def _near(first: Pair, second: Pair, x: Pair, y: Pair) -> bool:
    return abs(first[0] - second[0]) < _NEAR * (x[1] - x[0]) and abs(first[1] - second[1]) < _NEAR * (y[1] - y[0])


def _inside(point: Sequence[float], x: Pair, y: Pair) -> bool:
    return x[0] <= point[0] <= x[1] and y[0] <= point[1] <= y[1]


def _point(law: MotionLaw, picture: Picture) -> Pair:
    x, y = (FUNCTIONALS[name].value(law) for name in picture.over)
    return x, y
