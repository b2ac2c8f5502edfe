"""Pictures of laws: displacement, velocity, acceleration and jerk, with peaks and with a problem's constraints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.errors import InputError
from optlaws.laws.curve import Curve
from optlaws.laws.law import MotionLaw
from optlaws.laws.report import law_panels
from optlaws.motion.piece import factor, unit_of
from optlaws.plots.report import draw_panel, draw_share
from optlaws.plots.style import BLUES, BROWN, GREEN, GREY, VIOLET, WARM, new_figure, plot_style
from optlaws.synthesis.limits.of_problem import limited_laws

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from optlaws.cycles.law_comparison import Comparison
    from optlaws.shown.report import Panel
    from optlaws.synthesis.solution import Solution

Panels = Sequence["Axes"]

#: what is drawn of a law, and its peaks
LETTERS = "abcj"
PEAKS = (None, "B", "C", "J")
_MARGIN = 0.08
#: of a sheet of laws
_COLUMNS = 6
_NAME_WIDTH = 22
#: curves drawn into one pair of axes, each by its peak
_COLOURS = (GREY, GREEN, BLUES[3], WARM)
_ABOVE: Any = {
    "loc": "lower right",
    "bbox_to_anchor": (1.0, 1.0),
    "ncols": 3,
    "borderaxespad": 0.2,
    "frameon": False,
    "fontsize": 9.0,
}


def panels(width: float = 7.2, height: float = 7.6) -> list[Axes]:
    """Four empty axes over one k, for a, b, c and j, in a new figure of the project's style."""
    with plot_style():
        four_axes = list(new_figure(width, height).subplots(4, 1, sharex=True))
    four_axes[-1].set(xlabel="k (all dimensionless)")
    return four_axes


def draw_curve(curve: Curve, axes: Axes | Panels | None = None, **style: Any) -> list[Artist]:
    """Draw a, b, c and j of a law, or of a mass, with their peaks, and return the artists.

    Into one pair of axes each is divided by its peak; `style` is of the curves.
    """
    drawn = law_panels(curve, LETTERS)
    if axes is not None and not isinstance(axes, Sequence | np.ndarray):
        shares = zip(drawn, LETTERS, _COLOURS, strict=True)
        return [
            artist
            for panel, name, colour in shares
            for artist in draw_share(panel, axes, name, **{"color": colour} | style)
        ]
    return _draw_each(curve, drawn, four(panels() if axes is None else axes), style)


def _draw_each(curve: Curve, drawn: Sequence[Panel], axes: Panels, style: Mapping[str, Any]) -> list[Artist]:
    """Draw a, b, c and j into axes of their own, under their peaks."""
    artists: list[Artist] = []
    for nu, (name, panel, each) in enumerate(zip(PEAKS, drawn, axes, strict=True)):
        artists += _with_peaks(panel, each, style)
        if name is not None and not each.get_title(loc="left"):
            peak = curve.peak(nu)
            each.set_title(f"{name} = {peak.value:.7g} at k = {peak.k:.6g}", loc="left", fontsize=9.0)
    return artists


def four(axes: Any) -> list[Axes]:
    """The axes of a, b, c and j.

    Examples
    --------
    >>> four([])
    Traceback (most recent call last):
    optlaws.errors.InputError: a, b, c and j are drawn into one pair of axes or into four, got 0
    """
    panels = list(np.ravel(np.asarray(axes, dtype=object)))
    if len(panels) != len(LETTERS):
        raise InputError(f"a, b, c and j are drawn into one pair of axes or into four, got {len(panels)}")
    return panels


def _with_peaks(panel: Panel, axes: Axes, style: Mapping[str, Any]) -> list[Artist]:
    """Draw a curve with its limits, small rings on both sides of every break, and dots at its peaks."""
    artists = draw_panel(panel, axes, **style)
    k, values, *_ = panel.series[0]
    look: Any = {"color": axes.lines[-len(artists)].get_color(), "linestyle": ""}
    gaps = np.flatnonzero(np.isnan(values[1:-1])) + 1
    sides = np.unique(np.concatenate([gaps - 1, gaps + 1]))
    if sides.size:
        ring: Any = {"marker": "o", "markerfacecolor": "white", "markersize": 3.0} | look
        artists += axes.plot(panel.per * k[sides], values[sides], **ring)
    if not isfinite(panel.peak):
        # but the highest hundredth, which may be unbounded near a break
        low, high = np.nanpercentile(values, [1.0, 99.0])
        room = _MARGIN * ((high - low) or 1.0)
        axes.set_ylim(min(low, 0.0) - room, max(high, 0.0) + room)
    elif panel.peaks:
        artists += axes.plot(*(np.transpose(panel.peaks) * [[panel.per], [1.0]]), marker="o", markersize=4.0, **look)
    return artists


def draw_solution(solution: Solution, axes: Axes | Panels | None = None, **style: Any) -> list[Artist]:
    """Draw the law of a solution with the limits of its problem, and the best possible of its order at any degree.

    Into one pair of axes, where every curve is divided by its peak, no limits are drawn.
    """
    if axes is not None and not isinstance(axes, Sequence | np.ndarray):
        return draw_curve(solution.law, axes, **style)
    by_order = four(panels() if axes is None else axes)
    drawn = [panel for panel in solution.report().panels if panel.name[-1] in LETTERS]
    artists = [*_draw_each(solution.law, drawn, by_order, style), *_best_possible(by_order, solution)]
    for panel in by_order:
        labelled = dict(zip(*reversed(panel.get_legend_handles_labels()), strict=True))
        if labelled:
            panel.legend(list(labelled.values()), list(labelled), **_ABOVE)
    return artists


#: curves that differ in colour and in grey
_COMPARED = (
    {"color": GREY, "linestyle": "--"},
    {"color": BLUES[3], "linestyle": "-"},
    {"color": WARM, "linestyle": "-."},
    {"color": GREEN, "linestyle": (0, (5, 1))},
    {"color": VIOLET, "linestyle": ":"},
    {"color": BROWN, "linestyle": (0, (3, 1, 1, 1))},
)


def draw_comparison(comparison: Comparison, axes: Panels | None = None, **style: Any) -> list[Artist]:
    """Draw a, b, c and j of several laws one over the other, with one legend in a new figure.

    They are in units of the machine where the comparison has its stroke and duration, else dimensionless.
    """
    by_order = four(panels() if axes is None else axes)
    if comparison.duration is not None:
        by_order[-1].set(xlabel="time, ms")
    looks = [{**_COMPARED[place % len(_COMPARED)], **style} for place in range(len(comparison.laws))]
    drawn = [
        [
            artist
            for nu, (panel, each) in enumerate(zip(law_panels(law, LETTERS), by_order, strict=True))
            for artist in _with_peaks(_in_machine(panel, nu, comparison), each, look)
        ]
        for law, look in zip(comparison.laws.values(), looks, strict=True)
    ]
    if axes is None:
        figure: Any = by_order[0].get_figure(root=True)
        firsts = [artists[0] for artists in drawn]
        figure.legend(firsts, list(comparison.laws), loc="outside lower center", ncols=3, frameon=False)
    return [artist for artists in drawn for artist in artists]


def _in_machine(panel: Panel, nu: int, comparison: Comparison) -> Panel:
    """The panel of a derivative over the time of the machine, in its units; as it is where these are not known."""
    stroke, duration = comparison.stroke, comparison.duration
    if stroke is None or duration is None:
        return panel
    size, name = factor(stroke, duration, nu), panel.name.rpartition(" ")[0]
    (curve,) = panel.series
    peaks = tuple((duration * k, size * value) for k, value in panel.peaks)
    ends = size * panel.ends[0], size * panel.ends[1]
    series = (curve._replace(at=duration * curve.at, values=size * curve.values),)
    unit = unit_of("length" if comparison.unit == "m" else "angle", nu)
    return replace(panel, name=name, unit=unit, series=series, peaks=peaks, ends=ends, per=1e3)


def accelerations_figure(laws: Mapping[str, MotionLaw]) -> Figure:
    """The acceleration of each law in a panel of its own, all to one scale, with the peaks B and C."""
    columns = min(len(laws), _COLUMNS)
    rows = -(-len(laws) // columns)
    with plot_style():
        figure = new_figure(max(3.2, 1.9 * columns), 0.5 + 1.7 * rows)
        axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for panel, (name, law) in zip(axes.flat, laws.items(), strict=False):
            (acceleration,) = law_panels(law, "c")
            _with_peaks(acceleration, panel, {})
            sizes = f"B {law.peak(1).value:.4g}, C {law.peak(2).value:.4g}"
            panel.set_title(f"{fill(name, _NAME_WIDTH)}\n{sizes}", fontsize=7.5)
            panel.set_ylabel("")
            panel.tick_params(labelsize=7.5)
        for panel in axes.flat[len(laws) :]:
            panel.set_axis_off()
        figure.supxlabel("k", fontsize=9.0)
        figure.supylabel("acceleration c (dimensionless)", fontsize=9.0)
    return figure


def _best_possible(by_order: Panels, solution: Solution) -> list[Artist]:
    name = solution.problem.titled(str(solution.problem.minimise))
    if solution.best_possible is None or name not in PEAKS:
        return []
    nu = PEAKS.index(name)
    text = f"no {limited_laws(solution.problem)} has a smaller {name}: {solution.best_possible:.6g}"
    signs = (1.0, -1.0) if solution.law.extrema(nu)[0].value < 0.0 else (1.0,)
    look: Any = {"color": "black", "linestyle": ":", "linewidth": 1.1, "label": text}
    return [by_order[nu].axhline(sign * solution.best_possible, **look) for sign in signs]
