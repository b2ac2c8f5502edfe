"""Plots of fronts: a constant over another, a third in colour, or the least objective over a move's time."""

from __future__ import annotations

from itertools import pairwise
from math import floor, log10
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from optlaws.motion.quantities import MILLI
from optlaws.plots.style import BLUES, GREY, WARM, name_point, new_axes
from optlaws.sentences import listed, quantity_name
from optlaws.synthesis.report import axis_label

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from optlaws.cycles.advising.advice import Advice
    from optlaws.cycles.moves.time_front import TimeFront
    from optlaws.numbers import Array
    from optlaws.shown.report import Panel
    from optlaws.synthesis.pareto import Front
    from optlaws.synthesis.proven.front import ProvenFront

_BESIDE_POINT = 1e-6  # of the time between two points of a front: so near to one what is drawn is what holds between

_BETWEEN = 8
_FALLS, _NOTHING = 30.0, 1e-6  # by how much values fall that are drawn by their logarithms, and what is rounding
#: values that are further apart are drawn by their logarithms
_WIDE = 10.0
_NAMES = 0.22  # of the width, for names beside points at the right


def draw_front(front: Front | ProvenFront, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw a front into axes, new ones by default, and return the artists: a third constant gives the colour.

    A front of points is its points, with a line down to what no law of the space is below; one that is proven at every
    value is a curve.
    """
    axes = axes or new_axes()
    axes.set(xlabel=axis_label(front.over[0]), ylabel=axis_label(front.over[1]))
    panels = front.report().panels
    if panels:
        curve, below, *_ = panels[0].series
        every, problem = not hasattr(front, "points"), next(iter(cast("Front", front))).problem
        look = {"linewidth": 1.4} if every else {"marker": "o", "markersize": 4.5, "linewidth": 0.0}
        named = {"label": f"order {problem.order}, {problem.basis!r}", **look, **style}
        artists: list[Artist] = list(axes.plot(curve.at, curve.values, **named))
        colour = style.get("color", artists[0].get_color())  # type: ignore[attr-defined] # of a line
        bound: dict[str, Any] = {"color": GREY, "label": "lower bound" * (not axes.get_legend())}
        if every:
            artists += axes.plot(below.at, below.values, linewidth=0.8, **bound)
        else:
            artists += axes.plot(below.at, below.values, linewidth=0.0, marker="_", markersize=9.0, **bound)
            artists.append(axes.vlines(curve.at, below.values, curve.values, color=colour, alpha=0.35, linewidth=1.0))
        axes.legend(fontsize=8.0)
        return artists
    values = cast("Front", front).values
    style = {"s": 18.0, "c": values[:, 2], **{key: value for key, value in style.items() if key != "color"}}
    points = axes.scatter(values[:, 0], values[:, 1], **style)
    bar = axes.get_figure(root=True).colorbar(points, ax=axes)  # type: ignore[union-attr] # these axes have a figure
    bar.set_label(axis_label(front.over[2]))
    return [points]


def draw_time_front(front: TimeFront, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw a front over the time into axes, new ones by default, with its lower bound; return the artists."""
    axes = axes or new_axes()
    colour = style.pop("color", BLUES[-1])
    label = style.pop("label", front.minimise)
    times = np.array(front.durations)
    lower, upper = np.array(front.lower_bounds), np.array(front.values)
    # values that go down to nothing are seen by their logarithms, and nothing at the foot of the scale
    foot = _foot(upper)
    line = {"color": colour, "linewidth": 1.4, "linestyle": "-", "zorder": 4, **style}
    none = upper < foot
    points = axes.plot(MILLI * times, np.where(none, np.nan, upper), marker="o", markersize=3.0, label=label, **line)
    if none.any():
        points += axes.plot(
            MILLI * times[none],
            np.full(none.sum(), foot),
            color=colour,
            marker="v",
            markersize=6.0,
            linewidth=0.0,
            label="0 but for rounding",
            clip_on=False,
        )
    if front.falls:
        # both sides jump at points, and are smooth between two of them
        near = [_BESIDE_POINT * (high - low) for low, high in pairwise(times)]
        inside = [
            np.linspace(low + by, high - by, _BETWEEN) for by, (low, high) in zip(near, pairwise(times), strict=True)
        ]
        shown = np.unique(np.concatenate([times, *inside]))
        between = [front(float(time)) for time in shown]
        below = np.maximum([point.lower_bound for point in between], foot)
        bound = axes.plot(MILLI * shown, below, color=GREY, linewidth=0.9, label="lower bound")
        axes.fill_between(
            MILLI * shown,
            below,
            np.maximum([point.value for point in between], foot),
            color=colour,
            alpha=0.15,
            linewidth=0,
            label="between bound and law",
        )
    else:
        below = np.maximum(lower, foot)
        bound = axes.plot(MILLI * times, below, color=GREY, linewidth=0.0, marker="_", label="lower bound")
    least = axes.axvline(MILLI * front.fastest.duration, color=WARM, linewidth=1.0, linestyle="--", label="least time")
    axes.set(xlabel="time of the move, ms", ylabel=f"least {quantity_name(front.minimise)},\n{front.unit}")
    if foot:
        axes.set_yscale("log")
    axes.set_ylim(bottom=foot)
    return [*points, *bound, least]


def _foot(values: Array) -> float:
    """Where a logarithmic scale of values begins, a power of ten; 0 where they are drawn as they are.

    >>> _foot(np.array([17.7, 0.6, 2e-13])), _foot(np.array([17.7, 0.6])), _foot(np.array([17.7, 9.0]))
    (0.01, 0.0, 0.0)
    """
    greatest, least = float(values.max()), float(values.min())
    if not least * _FALLS < greatest:
        return 0.0
    seen = float(values[values > greatest * _NOTHING].min())
    return 10.0 ** floor(log10(seen) - (seen > least))


def draw_advice(advice: Advice, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw what is minimised over the second measure: the front, what no law is below, all laws; return the artists.

    Laws that have more of a third measure than the usual one, to which the bound does not apply, have open markers.
    """
    from optlaws.cycles.advising.advice import more_than_usual

    axes = axes or new_axes()
    x, y = ({law.name: law.values[name] for law in advice} for name in (advice.second, advice.minimise))
    units = {measure.name: measure.heading for measure in advice.measures}
    artists = [artist for panel in advice.report().panels for artist in _front_of_advice(panel, axes, style)]
    chosen, usual = advice.recommendation.law.name, advice.recommendation.usual
    more = {law.name: more_than_usual(law, usual, advice.guarded, advice.second) for law in advice}
    known_x = [value for value in x.values() if np.isfinite(value) and value > 0.0]
    far = max(known_x) > _WIDE * min(known_x)
    axes.set(xscale="log" if far else "linear", xlabel=units[advice.second], ylabel=units[advice.minimise])
    opened: dict[str, Any] = {"linewidth": 0.0, "markersize": 5.0, "fillstyle": "none"}
    for kind, colour, marker in (("given", GREY, "D"), ("standard", GREY, "s"), ("optimal", BLUES[3], "o")):
        names = [law.name for law in advice if law.kind == kind and np.isfinite(x[law.name] * y[law.name])]
        full = [name for name in names if not more[name]]
        known: Any = {"color": colour, "marker": marker, "linewidth": 0.0, "markersize": 5.0, "label": f"{kind} laws"}
        artists += axes.plot([x[name] for name in full], [y[name] for name in full], **known) if names else []
        beyond = [name for name in names if more[name]]
        axes.plot([x[name] for name in beyond], [y[name] for name in beyond], color=colour, marker=marker, **opened)
        for name in (name for name in names if name != chosen and "," not in name):
            name_point(axes, name, (x[name], y[name]), (6.0, -3.0), color=colour, fontsize=7.5)
    if usual is not None and any(more.values()):
        of = [quantity_name(each) for each in advice.guarded if any(each in exceeded for exceeded in more.values())]
        label = f"open markers: more {listed(of, 'or')} than {usual.name}"
        artists += axes.plot([], [], color=GREY, marker="s", label=label, **opened)
    ring: Any = {"color": WARM, "marker": "o", "markersize": 11.0, "fillstyle": "none", "linewidth": 0.0, "zorder": 5}
    artists += axes.plot(x[chosen], y[chosen], label="recommended law", **ring)
    name_point(axes, f"{y[chosen]:.4g}", (x[chosen], y[chosen]), (-8.0, -14.0))
    # room for the names at the right
    axes.margins(x=0.06)
    low, high = axes.get_xlim()
    axes.set_xlim(low, high * (high / low) ** _NAMES if far else high + _NAMES * (high - low))
    axes.legend(fontsize=7.5, loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2)
    return artists


def _front_of_advice(panel: Panel, axes: Axes, style: dict[str, Any]) -> list[Artist]:
    """The points of the front, and between them what is reached and what no law is below."""
    front, reached, below = panel.series
    colour = style.pop("color", BLUES[3])
    line = {"color": colour, "marker": "o", "markersize": 3.0, "linewidth": 0.0, "label": front.name, **style}
    points = axes.plot(front.at, front.values, **line)
    shade: Any = {"color": colour, "alpha": 0.15, "linewidth": 0.0, "label": "whether laws are here is not known"}
    between = axes.fill_between(reached.at, below.values, reached.values, **shade)
    return [*points, between, *axes.plot(below.at, below.values, color=GREY, linewidth=0.8, label=below.name)]
