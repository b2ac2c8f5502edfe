"""Pictures of mechanisms: the linkage in several positions, to scale, beside inertia, its slope and load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.tree import Formula
from optlaws.numbers import Array
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, new_figure, plot_style, titled

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from optlaws.mechanisms.linkages.mechanism import Mechanism

_MILLI = 1e3
_SAMPLES = 721
_SHOWN = 7  # positions of the linkage
_SCALES = {
    "angle": (180.0 / np.pi, "input, deg", ("J, kg m²", "J', kg m²/rad", "T, N m")),
    "length": (_MILLI, "input, mm", ("J, kg", "J', kg/m", "T, N")),
}


def draw_mechanism(mechanism: Mechanism, axes: Any = None, **style: Any) -> list[Artist]:
    """Draw a mechanism into four pairs of axes, one for the linkage alone, or a new figure; return the artists.

    One that has no linkage to draw has three panels.
    """
    with plot_style():
        linked = bool(mechanism.linkage.chains)
        panels = _new_panels(linked) if axes is None else list(np.ravel(np.array(axes, dtype=object)))
        if linked and len(panels) == 1:
            return _linkage(mechanism, panels[0])
        if len(panels) != 3 + linked:
            raise InputError(
                f"ax must be {3 + linked} pairs of axes for this mechanism{', or one for its linkage' * linked}, got "
                f"{len(panels)}"
            )
        artists = _linkage(mechanism, panels.pop(0)) if linked else []
        return artists + _curves(mechanism, panels, style)


def mechanism_figure(mechanism: Mechanism, title: str) -> Figure:
    """A mechanism with its inertia and load, as a figure."""
    figure: Figure = draw_mechanism(mechanism)[0].get_figure()  # type: ignore[assignment] # a figure of our own
    with plot_style():
        return titled(figure, title)


def _new_panels(linked: bool) -> list[Axes]:  # noqa: FBT001
    if not linked:
        return list(np.ravel(new_figure(7.2, 6.0).subplots(3, 1, sharex=True)))
    figure = new_figure(10.4, 5.4)
    grid = figure.add_gridspec(3, 2, width_ratios=(1.15, 1.0))
    first = figure.add_subplot(grid[0, 1])
    others = [figure.add_subplot(grid[i, 1], sharex=first) for i in (1, 2)]
    panels = [first, *others]
    for panel in panels[:2]:
        panel.tick_params(labelbottom=False)
    figure.align_ylabels(panels)
    return [figure.add_subplot(grid[:, 0]), *panels]


def _range(mechanism: Mechanism) -> Array:
    """Positions of the input at which it is drawn: a turn or 0.1 m where it has no bound."""
    low, high = mechanism.over if mechanism.has_end else (0.0, 2.0 * np.pi if mechanism.axis == "angle" else 0.1)
    return np.linspace(low, high, _SAMPLES)


def _curves(mechanism: Mechanism, panels: list[Axes], style: dict[str, Any]) -> list[Artist]:
    x = _range(mechanism)
    scale, label, names = _SCALES[mechanism.axis]
    values = (mechanism.inertia(x), mechanism.inertia(x, 1), mechanism.load(x))
    artists: list[Artist] = []
    for axes, name, curve, colour in zip(panels, names, values, (BLUES[3], GREEN, WARM), strict=True):
        artists += axes.plot(scale * x, curve, **{"color": colour, **style})
        axes.axhline(0.0, color=GREY, linewidth=0.8)
        axes.set(ylabel=name)
    panels[-1].set(xlabel=label)
    return artists


def _linkage(mechanism: Mechanism, axes: Axes) -> list[Artist]:
    """The links in several positions, the first one dark, with the paths of their joints."""
    x = _range(mechanism)
    closed = bool(np.isclose(x[-1] - x[0], 2.0 * np.pi))
    shown = np.linspace(x[0], x[-1], _SHOWN + closed)[: _SHOWN if closed else None]
    artists: list[Artist] = []
    axes.set_aspect("equal")
    for chain in mechanism.linkage.chains:
        joints = [_placed(point, x) for point in chain]
        for path in joints:
            if np.ptp(path, axis=1).max() > 0.0:
                artists += axes.plot(*path, color=GREY, linewidth=0.8, linestyle=":", zorder=1)
        if len(chain) == 1:
            fixed = not chain[0][0].names() | chain[0][1].names()
            marker: dict[str, Any] = {
                "marker": "^" if fixed else "s",
                "color": GREY if fixed else WARM,
                "markersize": 7.0 + 2.0 * fixed,
            }
            artists += axes.plot(*_placed(chain[0], shown[:1]), linestyle="", zorder=5, **marker)
            continue
        places = np.array([_placed(point, shown) for point in chain])
        for i in range(len(shown))[::-1]:
            line: dict[str, Any] = (
                {"color": BLUES[4], "linewidth": 2.2} if i == 0 else {"color": BLUES[1], "linewidth": 1.0}
            )
            artists += axes.plot(*places[:, :, i].T, marker="o", markersize=4.0 if i == 0 else 2.5, zorder=3, **line)
    axes.set(xlabel="x, mm", ylabel="y, mm", title=f"{mechanism.name}, {len(shown)} positions")
    return artists


def _placed(point: tuple[Formula, Formula], x: Array) -> Array:
    """A joint's coordinates in millimetres."""
    return _MILLI * np.array([evaluate(part, {"x": x}, NUMPY) + 0.0 * x for part in point])
