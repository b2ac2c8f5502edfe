"""Pictures of laws: displacement, velocity, acceleration and jerk, with peaks and with a problem's constraints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cycles.law_comparison import Comparison
from optlaws.errors import InputError
from optlaws.laws.curve import Curve
from optlaws.laws.law import MotionLaw
from optlaws.numbers import Array
from optlaws.plots.style import BLUES, BROWN, GREEN, GREY, VIOLET, WARM, new_figure, plot_style
from optlaws.synthesis.limits.of_problem import limited_laws
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.solution import Solution

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LOOKS_EQUAL = 1e-4  # of the highest peak: others so near look as high in a picture, and the first of them is marked

Panels = Sequence["Axes"]

QUANTITIES = ("displacement a", "velocity b", "acceleration c", "jerk j")
PEAKS = (None, "B", "C", "J")

_SAMPLES = 801
_MARGIN = 0.08
#: of the interval: how near to the highest peak a place is its own
_BESIDE = 0.01
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
_ONE_SIDED = {"C_plus": (2, 1.0), "C_minus": (2, -1.0)}


def panels(width: float = 7.2, height: float = 7.6) -> list[Axes]:
    """Four empty axes over one k, for a, b, c and j, in a new figure of the project's style."""
    with plot_style():
        four_axes = list(new_figure(width, height).subplots(4, 1, sharex=True))
    for axes, quantity in zip(four_axes, QUANTITIES, strict=True):
        axes.set(ylabel=quantity)
    four_axes[-1].set(xlabel="k (all dimensionless)")
    return four_axes


def draw_curve(
    curve: Curve,
    axes: Axes | Panels | None = None,
    **style: Any,
) -> list[Artist]:
    """Draw a, b, c and j of a law, or of a mass, with their peaks, and return the artists.

    Into one pair of axes each is divided by its peak; `style` is of the curves.
    """
    if axes is None:
        axes = panels()
    if not isinstance(axes, Sequence | np.ndarray):
        return [_line(curve, axes, nu, **{"color": _COLOURS[nu]} | style) for nu in range(4)]
    return [artist for nu, panel in enumerate(four(axes)) for artist in _with_peak(curve, panel, nu, style)]


def four(axes: Any) -> list[Axes]:
    """The axes of a, b, c and j.

    Examples
    --------
    >>> four([])
    Traceback (most recent call last):
    optlaws.errors.InputError: a, b, c and j are drawn into one pair of axes or into four, got 0
    """
    panels = list(np.ravel(np.asarray(axes, dtype=object)))
    if len(panels) != len(QUANTITIES):
        raise InputError(f"a, b, c and j are drawn into one pair of axes or into four, got {len(panels)}")
    return panels


def broken(curve: Curve, nu: int, count: int = _SAMPLES) -> tuple[Array, Array]:
    """Samples of a derivative to be drawn as a line: it is broken by nan where the derivative jumps or is infinite.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> k, c = broken(catalogue["constant acceleration"].law, 2, 3)
    >>> k.tolist(), c.tolist()
    ([0.0, 0.5, 0.5, 0.5, 1.0], [4.0, 4.0, nan, -4.0, -4.0])
    """
    k, values = curve.samples(count, nu)
    values = np.where(np.isfinite(values), values, np.nan)
    jumps = _jumps(curve, nu)
    if jumps.size:
        # at a break the value before it comes first, and the one after it at least twice
        last = np.searchsorted(k, jumps, side="right") - 1
        first = np.searchsorted(k, jumps, side="left")
        keep = np.ones(len(k), dtype=bool)
        for before, after in zip(first, last, strict=True):
            keep[before + 2 : after] = False
            values[before + 1] = np.nan
        k, values = k[keep], values[keep]
    return k, values


def _jumps(curve: Curve, nu: int) -> Array:
    """The places where the curve's derivative jumps; jumps of lower order make it infinite there."""
    if not isinstance(curve, MotionLaw):
        return np.empty(0)
    return np.unique([place for lower in range(1, nu + 1) for place, _ in curve.jumps(lower)])


def _line(curve: Curve, axes: Axes, nu: int, **style: Any) -> Artist:
    k, values = broken(curve, nu)
    scale = curve.peak(nu).value if nu else 1.0
    if not isfinite(scale) or not scale:
        scale = float(np.nanmax(np.abs(values), initial=0.0)) or 1.0
    letter = "abcj"[nu]
    named = {"label": letter if scale == 1.0 else f"{letter} / {scale:.6g}"} | style
    (line,) = axes.plot(k, values / scale, **named)
    return line


def _with_peak(curve: Curve, axes: Axes, nu: int, style: dict[str, Any], *, titled: bool = True) -> Iterator[Artist]:
    k, values = broken(curve, nu)
    (line,) = axes.plot(k, values, **{"color": BLUES[3]} | style)
    yield line
    yield from _sides(axes, k, values, line.get_color())
    name = PEAKS[nu]
    if name is None:
        return
    peak = curve.peak(nu)
    if titled and not axes.get_title(loc="left"):
        axes.set_title(f"{name} = {peak.value:.7g} at k = {peak.k:.6g}", loc="left", fontsize=9.0)
    if isfinite(peak.value):
        yield from axes.plot(*_first_peak(curve, nu, k, values), "o", color=line.get_color(), markersize=4.0)
    else:
        _keep_to(axes, values)


def _first_peak(curve: Curve, nu: int, k: Array, values: Array) -> tuple[list[float], list[float]]:
    """The first of the peaks that look equally high: which of them is the highest may be rounding."""
    low, high = curve.extrema(nu)
    peak = high if high.value >= -low.value else low
    first = int(np.nanargmax(np.abs(values) >= (1.0 - _LOOKS_EQUAL) * abs(peak.value)))
    if abs(peak.value) * (1.0 - _LOOKS_EQUAL) > abs(values[first]) or abs(k[first] - peak.k) < _BESIDE:
        return [peak.k], [peak.value]
    # rounding decides where a flat peak comes near its height, but not where its top is
    while first + 1 < len(values) and abs(values[first + 1]) > abs(values[first]):
        first += 1
    return [float(k[first])], [float(values[first])]


def _sides(axes: Axes, k: Array, values: Array, colour: Any) -> Iterator[Artist]:
    """Small rings on both sides of every break of a line."""
    gaps = np.flatnonzero(np.isnan(values[1:-1])) + 1
    ends = np.unique(np.concatenate([gaps - 1, gaps + 1]))
    if ends.size:
        yield from axes.plot(k[ends], values[ends], "o", color=colour, markerfacecolor="white", markersize=3.0)


def _keep_to(axes: Axes, values: Array) -> None:
    """Set the range to the finite values except the highest hundredth, which may be unbounded near a break."""
    low, high = np.nanpercentile(values, [1.0, 99.0])
    room = _MARGIN * ((high - low) or 1.0)
    axes.set_ylim(min(low, 0.0) - room, max(high, 0.0) + room)


@dataclass(frozen=True)
class Mark:
    """A limit of a, b, c or j over a part of the motion, and the constraint that sets it."""

    nu: int
    value: float
    start: float
    stop: float
    what: str


def marks(problem: Problem) -> Iterator[Mark]:
    """The limits that a problem sets to b, c and j: bounds of B, C, J and of one-sided peaks, and windows."""
    for nu, name in enumerate(PEAKS):
        bounds = None if name is None else problem.range(name)
        if bounds is not None and isfinite(bounds.high):
            text = f"{name} = {bounds.high:.6g}" if bounds.fixed else f"{name} at most {bounds.high:.6g}"
            yield from (Mark(nu, sign * bounds.high, 0.0, 1.0, text) for sign in (1.0, -1.0))
    for name, (nu, sign) in _ONE_SIDED.items():
        bounds = problem.range(name)
        if bounds is not None and isfinite(bounds.high):
            yield Mark(nu, sign * bounds.high, 0.0, 1.0, f"{name} at most {bounds.high:.6g}")
    for window in problem.windows:
        for value in {window.low, window.high} - {inf, -inf}:
            yield Mark(window.nu, value, window.start, window.stop, "window")


def draw_solution(
    solution: Solution,
    axes: Axes | Panels | None = None,
    **style: Any,
) -> list[Artist]:
    """Draw the law of a solution with the limits of its problem, and the limit of its order at any degree.

    Into one pair of axes, where every curve is divided by its peak, no limits are drawn.
    """
    if axes is None:
        axes = panels()
    artists = draw_curve(solution.law, axes, **style)
    if not isinstance(axes, Sequence | np.ndarray):
        return artists
    by_order = four(axes)
    artists += [_marked(by_order[mark.nu], mark) for mark in _without_idle(solution)]
    artists += _limit(by_order, solution)
    for panel in by_order:
        if any(not str(line.get_label()).startswith("_") for line in panel.lines):
            labelled = dict(zip(*reversed(panel.get_legend_handles_labels()), strict=True))
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
    """Draw a, b, c and j of several laws one over the other, dimensionless, with one legend in a new figure."""
    by_order = four(panels() if axes is None else axes)
    artists: list[Artist] = []
    firsts = []
    for place, law in enumerate(comparison.laws.values()):
        look = {**_COMPARED[place % len(_COMPARED)], **style}
        drawn = [
            artist for nu, panel in enumerate(by_order) for artist in _with_peak(law, panel, nu, look, titled=False)
        ]
        firsts.append(drawn[0])
        artists += drawn
    if axes is None:
        figure: Any = by_order[0].get_figure(root=True)
        figure.legend(firsts, list(comparison.laws), loc="outside lower center", ncols=3, frameon=False)
    return artists


def accelerations_figure(laws: Mapping[str, MotionLaw]) -> Figure:
    """The acceleration of each law in a panel of its own, all to one scale, with the peaks B and C."""
    columns = min(len(laws), _COLUMNS)
    rows = -(-len(laws) // columns)
    with plot_style():
        figure = new_figure(max(3.2, 1.9 * columns), 0.5 + 1.7 * rows)
        axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for panel, (name, law) in zip(axes.flat, laws.items(), strict=False):
            list(_with_peak(law, panel, 2, {"color": BLUES[3]}, titled=False))
            panel.set_title(
                f"{fill(name, _NAME_WIDTH)}\nB {law.peak(1).value:.4g}, C {law.peak(2).value:.4g}", fontsize=7.5
            )
            panel.tick_params(labelsize=7.5)
        for panel in axes.flat[len(laws) :]:
            panel.set_axis_off()
        figure.supxlabel("k", fontsize=9.0)
        figure.supylabel("acceleration c (dimensionless)", fontsize=9.0)
    return figure


def _without_idle(solution: Solution) -> list[Mark]:
    """Marks but those far below every value of a law that never goes there, such as -B where b is never negative."""
    near = []
    for mark in marks(solution.problem):
        low, high = solution.law.extrema(mark.nu)
        if mark.what == "window" or low.value - 0.5 * abs(mark.value) <= mark.value <= high.value + 2 * abs(mark.value):
            near.append(mark)
    return near


def _marked(axes: Axes, mark: Mark) -> Artist:
    if mark.start == mark.stop:
        (point,) = axes.plot([mark.start], [mark.value], "D", color=WARM, markersize=5.0, label="via point")
        return point
    (line,) = axes.plot([mark.start, mark.stop], [mark.value] * 2, "--", color=WARM, lw=1.1, label=mark.what)
    return line


def _limit(by_order: Sequence[Axes], solution: Solution) -> list[Artist]:
    name = solution.problem.titled(str(solution.problem.minimise))
    if solution.limit is None or name not in PEAKS:
        return []
    nu = PEAKS.index(name)
    text = f"no {limited_laws(solution.problem)} has a smaller {name}: {solution.limit:.6g}"
    signs = (1.0, -1.0) if solution.law.extrema(nu)[0].value < 0.0 else (1.0,)
    lines = [
        by_order[nu].plot([0.0, 1.0], [sign * solution.limit] * 2, ":", color="black", lw=1.1, label=text)
        for sign in signs
    ]
    return [line for some in lines for line in some]
