"""Exchanges between two constants, tabled and drawn beside known laws and limits."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import ceil, inf, log10
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from optlaws import (
    FUNCTIONALS,
    Front,
    MotionLaw,
    Problem,
    ProvenFront,
    SavinFamily,
    Solution,
    Status,
    catalogue,
    limit,
    pareto_front,
    proven_front,
    savin,
    smoothstep,
)
from optlaws.plots.style import GREEN, GREY, WARM, empty_figure, name_point, plot_style, shades
from optlaws.results import MARK, Cell, Entries, Page, Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DRAWN_GAP = 1e-4  # of an objective: a gap that no picture shows
_FEW = 5
CONSTANTS = ("B", "C", "D", "J")
#: what is kept of a solution, and further proofs that some have
_RECORDED = ("status", "objective", "lower_bound", "best_possible", "constants", "z", "law", "problem", "certificate")
_FURTHER = ("power_certificate", "peak_certificate")
HEADINGS = (*CONSTANTS, "lower bound", "gap", "best possible", "status")
FAMILIES = {name: SavinFamily.of(name) for name in ("I", "II", "III", "IV")}


class Curve(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A front: its name in the legend, the changes of its problem from the base problem, and its points."""

    label: str
    points: int | None = None
    between: tuple[float, float] | None = None
    order: int | None = None
    degree: int | None = None
    B: float | None = None

    def problem(self, base: dict[str, Any]) -> Problem:
        """The problem of the front."""
        own = {"order": self.order, "degree": self.degree, "B": self.B}
        return Problem.from_dict(base | {name: value for name, value in own.items() if value is not None})


class Picture(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A figure: the two constants of the fronts, its fronts, further marks, and the ranges of the axes."""

    name: str
    title: str
    over: tuple[str, str]
    front: list[Curve]
    between: tuple[float, float] | None = None
    points: int | None = None
    catalogue: list[str] = []
    x: tuple[float, float] | None = None
    y: tuple[float, float] | None = None


class Exchanges(Entries):
    """The problem file: the base problem, the figures, and the points of a front."""

    problem: dict[str, Any]
    figure: list[Picture]
    points: int


Fronts = list[tuple[Picture, list[Front]]]


def run(results: Results) -> None:
    """Put the table, the page, the laws and the pictures of all fronts into results."""
    spec = results.read(Exchanges)
    drawn: Fronts = [(picture, [_front(spec, picture, curve) for curve in picture.front]) for picture in spec.figure]
    for front in (front for _, fronts in drawn for front in fronts):
        assert (np.diff(front.values, axis=0) * [1.0, -1.0] > 0.0).all(), "each is an exchange"
        assert all(point.best_possible is None or point.best_possible < point.objective for point in front)
    lines = [
        [picture.name, *line]
        for picture, fronts in drawn
        for curve, front in zip(picture.front, fronts, strict=True)
        for line in _lines(curve, front)
    ]
    results.table("fronts", ("figure", "front", *HEADINGS), lines)
    _fill(results.page("fronts").text(spec.text), drawn)
    results.text("fronts.json", _json(results.about, drawn))
    for picture, fronts in drawn:
        results.picture(picture.name, draw(picture, fronts))


def _front(spec: Exchanges, picture: Picture, curve: Curve) -> Front:
    points = curve.points or picture.points or spec.points
    between = curve.between or picture.between
    return pareto_front(curve.problem(spec.problem), picture.over, points=points, between=between)


def _gap(solution: Solution) -> str:
    """The gap; where it is closed the power of ten above it, for what lies below differs between machines."""
    if solution.status is Status.OPTIMAL:
        return f"1e{ceil(log10(max(solution.gap, 1e-10)))}"
    return f"{solution.gap:.3g}"


def _lines(curve: Curve, front: Front) -> list[list[Cell]]:
    rows = front.rows_of(CONSTANTS)
    return [[curve.label, *row[:5], _gap(point), *row[6:]] for row, point in zip(rows, front, strict=True)]


def _fill(page: Page, drawn: Fronts) -> None:
    for picture, fronts in drawn:
        few = []
        for curve, front in zip(picture.front, fronts, strict=True):
            lines = _lines(curve, front)
            last = len(lines) - 1
            few += [lines[i] for i in sorted({round(last * step / (_FEW - 1)) for step in range(_FEW)})]
        page.heading(picture.title).figure(picture.name, picture.title).table(("front", *HEADINGS), few)


def _json(about: str, drawn: Fronts) -> str:
    """The fronts with their solutions and proofs for `optlaws verify`, a line for each point."""
    fronts = []
    for picture, some in drawn:
        for curve, front in zip(picture.front, some, strict=True):
            data = front.to_dict()
            head = json.dumps(
                {"about": f"{picture.name}: {curve.label}", "over": data["over"], "values": data["values"]}
            )
            points = ",\n".join(json.dumps(_record(point)) for point in data["points"])
            fronts.append(f'{head[:-1]}, "points": [\n{points}\n]}}')
    top = json.dumps({"about": f"{about}; {MARK}"})[:-1]
    return f'{top}, "fronts": [\n' + ",\n".join(fronts) + "\n]}\n"


def _record(point: dict[str, Any]) -> dict[str, Any]:
    """A solution with its proofs, without what differs between runs."""
    return {name: point[name] for name in _RECORDED} | {
        name: point[name] for name in _FURTHER if point.get(name) is not None
    }


Ends = tuple[float, float]

SMOOTHSTEPS = "smoothstep"
_STROKES: dict[str, Any] = {"I": ":", "II": "-.", "III": "--", "IV": (0, (5, 1))}
_NEAR = 0.035  # of the axes: points nearer than this in both directions have their labels on different sides


def draw_beside(axes: Axes, picture: Picture, x: Ends, y: Ends) -> None:
    """Draw the data named by the picture's entry `catalogue`, within the window x, y."""
    for family in (name for name in picture.catalogue if name in FAMILIES):
        low, high = FAMILIES[family].range
        laws = [savin(family, float(alpha)) for alpha in np.linspace(float(low), float(high), 61)]
        points = np.array([_point(law, picture) for law in laws])
        if not any(_inside(point, x, y) for point in points.tolist()):
            continue
        style: dict[str, Any] = {"color": GREEN, "linestyle": _STROKES[family], "linewidth": 1.2, "zorder": 3}
        axes.plot(*points.T, label=f"Savin's family {family} (l = {FAMILIES[family].u + 2})", **style)
    if SMOOTHSTEPS in picture.catalogue:
        _smoothsteps(axes, picture, x, y)
    _laws(axes, picture, x, y)


def _smoothsteps(axes: Axes, picture: Picture, x: Ends, y: Ends) -> None:
    label = "smoothsteps, by order l"
    ring: dict[str, Any] = {"color": WARM, "markerfacecolor": "white", "markersize": 6.5, "zorder": 5}
    for order in (2, 3, 4, 5):
        point = _point(smoothstep(order), picture)
        if _inside(point, x, y):
            axes.plot(*point, "o", label=label, **ring)
            # in words, for bare numbers are those of the catalogue's laws
            name_point(axes, f"l = {order}", point, (7.0, -9.0))
            label = "_nolegend_"


def _laws(axes: Axes, picture: Picture, x: Ends, y: Ends) -> None:
    """Laws of the catalogue as numbered points, with their names in the legend."""
    named = [name for name in picture.catalogue if name not in FAMILIES and name != SMOOTHSTEPS]
    points = [(catalogue[name].name, _point(catalogue[name].law, picture)) for name in named]
    shown = [(name, point) for name, point in points if _inside(point, x, y)]
    for number, (name, point) in enumerate(shown, 1):
        diamond: dict[str, Any] = {"color": WARM, "markersize": 5.0, "zorder": 5}
        axes.plot(*point, "D", label=f"{number}  {name}", **diamond)
        before = [other for _, other in shown[: number - 1]]
        crowded = any(_near(point, other, x, y) for other in before)
        name_point(axes, f"{number}", point, (-6.0, -9.0) if crowded else (6.0, 4.0))


def _near(first: Ends, second: Ends, x: Ends, y: Ends) -> bool:
    return abs(first[0] - second[0]) < _NEAR * (x[1] - x[0]) and abs(first[1] - second[1]) < _NEAR * (y[1] - y[0])


def _inside(point: Sequence[float], x: Ends, y: Ends) -> bool:
    return x[0] <= point[0] <= x[1] and y[0] <= point[1] <= y[1]


def _point(law: MotionLaw, picture: Picture) -> Ends:
    x, y = (FUNCTIONALS[name].value(law) for name in picture.over)
    return x, y


_MARGIN = 0.06


def draw(picture: Picture, fronts: Sequence[Front]) -> Figure:
    """Fronts of two constants, with known laws beside them and the limits of all laws below."""
    x, y = (_window(picture, fronts, axis) for axis in (0, 1))
    with plot_style():
        figure = empty_figure(8.6, 5.0)
        axes = figure.subplots()
        colours = shades(len(fronts))
        for curve, front, shade in zip(picture.front, fronts, colours, strict=True):
            _draw_curve(axes, front, color=shade, label=curve.label)
        draw_beside(axes, picture, x, y)
        if picture.over[0] == "B":
            _limit_curves(axes, picture, fronts, x)
        else:
            _corners(axes, picture, fronts, colours)
        axes.set(xlim=x, ylim=y, title=picture.title)
        if own := axes.get_legend():
            own.remove()  # all of it stands beside the picture
        figure.legend(loc="outside right upper")
        return figure


def _draw_curve(axes: Axes, front: Front, **style: Any) -> None:
    """The points of a front, and between them the front itself; straight lines where it is not convex."""
    dots = {**style, "marker": "o", "markersize": 2.2, "zorder": 4}
    exact = _exact(front)
    if exact is None:
        front.plot(axes, **dots)
    else:
        exact.plot(axes, **style, zorder=4)
        front.plot(axes, **{**dots, "label": "_nolegend_", "linestyle": "none"})


def _exact(front: Front) -> ProvenFront | None:
    """The front at every value, where it is known."""
    name, minimised = front.over
    ends = [_upper_end(point.problem, name) for point in (front[0], front[len(front) - 1])]
    if not front[0].problem.convex or not ends[0] < ends[1]:
        return None
    free = _freed(front[0].problem, name)
    return proven_front(free, (name, minimised), between=(ends[0], ends[1]), gap=_DRAWN_GAP)


def _upper_end(problem: Problem, name: str) -> float:
    stated = problem.range(name)
    return inf if stated is None else stated.high


def _window(picture: Picture, fronts: Sequence[Front], axis: int) -> Ends:
    given = (picture.x, picture.y)[axis]
    if given is not None:
        return given[0], given[1]
    values = np.concatenate([front.values[:, axis] for front in fronts])
    low, high = float(values.min()), float(values.max())
    return low - _MARGIN * (high - low), high + _MARGIN * (high - low)


def _limit_curves(axes: Axes, picture: Picture, fronts: Sequence[Front], x: Ends) -> None:
    """The limit of all laws at each B, which fronts of different orders mostly share."""
    values = np.linspace(max(x[0], 1.0 + 1e-3), x[1], 200)
    drawn: list[list[float]] = []
    for front in fronts:
        stated = front[0].problem
        limits = [limit(picture.over[1], float(B), order=stated.order) for B in values]
        if limits in drawn:
            continue
        label = "best possible" if not drawn else f"the same of order {stated.order}"
        stroke = ("-", "-.")[min(len(drawn), 1)]
        axes.plot(values, np.array(limits), label=label, color=GREY, linewidth=1.2, linestyle=stroke)
        drawn.append(limits)


def _corners(axes: Axes, picture: Picture, fronts: Sequence[Front], colours: Sequence[str]) -> None:
    """The limit of all laws in either constant, which no one law need reach in both."""
    for curve, front, shade in zip(picture.front, fronts, colours, strict=True):
        style: dict[str, Any] = {"color": shade, "linewidth": 1.1, "linestyle": (0, (1, 2)), "zorder": 2}
        stated = _freed(front[0].problem, picture.over[0])
        velocity = stated.B if isinstance(stated.B, float) else None
        limits = [limit(name, velocity, order=stated.order) for name in picture.over]
        label = f"best possible of each, {curve.label}"
        for line, value in zip((axes.axvline, axes.axhline), limits, strict=True):
            draw_line: Callable[..., Any] = line
            draw_line(value, label=label, **style)
            label = "_nolegend_"


def _freed(problem: Problem, name: str) -> Problem:
    changed: dict[str, Any] = {name: None}
    return replace(problem, **changed)
