"""The job "fronts": exchanges between two constants, tabled and drawn beside known laws and limits."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
import numpy as np

from optlaws.errors import InputError, located
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text
from optlaws.jobs.job import JobFile
from optlaws.laws import MotionLaw, smoothstep
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.savin import FAMILIES, alpha_range, savin
from optlaws.plots.front import draw_front, draw_proven_front
from optlaws.plots.style import (
    GREEN,
    GREY,
    WARM,
    empty_figure,
    name_point,
    plot_style,
    shades,
)
from optlaws.results import Page, Results
from optlaws.studies.problem_entries import Positive, ProblemEntries, gap, problem
from optlaws.synthesis import FUNCTIONALS, Problem
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.pareto import HEADINGS, Front, pareto_front
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.proven.front import ProvenFront
from optlaws.synthesis.proven.refine import proven_front

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DRAWN_GAP = 1e-4  # of an objective: a gap that no picture shows

Points = Annotated[int, msgspec.Meta(ge=2, le=1000)]
Pair = Annotated[list[Positive], msgspec.Meta(min_length=2, max_length=2)]
Constant = Literal["B", "C", "D", "J"]

_FEW = 5


class FrontEntries(ProblemEntries, kw_only=True, forbid_unknown_fields=True):
    """A front: the changes of its problem from the base problem, and its name in the legend."""

    label: Text
    points: Points | None = None
    between: Pair | None = None


class Picture(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A figure: the two constants of the fronts, its fronts, further marks, and the ranges of the axes."""

    name: Annotated[str, msgspec.Meta(pattern="^[a-z0-9-]+$")]
    title: Text
    over: Annotated[list[Constant], msgspec.Meta(min_length=2, max_length=2)]
    front: Annotated[list[FrontEntries], msgspec.Meta(min_length=1, max_length=5)]
    between: Pair | None = None
    points: Points | None = None
    catalogue: list[Text] = []
    limits: bool = True
    x: Pair | None = None
    y: Pair | None = None


class FrontsProblemFile(JobFile, kw_only=True, forbid_unknown_fields=True):
    """The problem file of fronts between constants."""

    problem: ProblemEntries
    figure: Annotated[list[Picture], msgspec.Meta(min_length=1)]
    points: Points = 50


Fronts = list[tuple[Picture, list[Front]]]


def run(results: Results) -> None:
    """Put the table, the page, the laws and the pictures of all fronts into results."""
    spec = results.read(FrontsProblemFile)
    names = [picture.name for picture in spec.figure]
    if len(set(names)) != len(names):
        raise InputError(f"figure: names must differ, got {', '.join(names)}")
    for picture in spec.figure:
        check_beside(picture)
    drawn: Fronts = [(picture, [_front(spec, picture, curve) for curve in picture.front]) for picture in spec.figure]
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


def _front(spec: FrontsProblemFile, picture: Picture, curve: FrontEntries) -> Front:
    where = f"figure {picture.name}, {curve.label}"
    stated = problem(where, spec.problem.given(), curve.given())
    between = curve.between or picture.between
    points = curve.points or picture.points or spec.points
    pair = (between[0], between[1]) if between else None
    with located(where):
        return pareto_front(stated, tuple(picture.over), points=points, between=pair)


def _lines(curve: FrontEntries, front: Front) -> list[list[tables.Cell]]:
    rows = front.rows_of(CONSTANTS)
    return [[curve.label, *row[:5], gap(point), *row[6:]] for row, point in zip(rows, front, strict=True)]


def _fill(page: Page, drawn: Fronts) -> None:
    for picture, fronts in drawn:
        few = []
        for curve, front in zip(picture.front, fronts, strict=True):
            lines = _lines(curve, front)
            last = len(lines) - 1
            few += [lines[i] for i in sorted({round(last * step / (_FEW - 1)) for step in range(_FEW)})]
        page.heading(picture.title).figure(picture.name, picture.title).table(("front", *HEADINGS), few)


def _json(about: str, drawn: Fronts) -> str:
    fronts = []
    for picture, some in drawn:
        for curve, front in zip(picture.front, some, strict=True):
            head = json.dumps({"figure": picture.name, "front": curve.label, "over": list(front.over)})
            points = ",\n".join(
                json.dumps(
                    {
                        "problem": point.problem.to_dict(),
                        "values": values,
                        "lower_bound": point.lower_bound,
                        "status": point.status.value,
                        "z": None if point.z_powers is None else list(point.z_powers),
                    }
                )
                for point, values in zip(front, front.values.tolist(), strict=True)
            )
            fronts.append(f'{head[:-1]}, "points": [\n{points}\n]}}')
    top = json.dumps({"about": f"{about}; {writing.MARK}"})[:-1]
    return f'{top}, "fronts": [\n' + ",\n".join(fronts) + "\n]}\n"


Ends = tuple[float, float]

SMOOTHSTEPS = "smoothstep"
_STROKES: dict[str, Any] = {"I": ":", "II": "-.", "III": "--", "IV": (0, (5, 1))}
_NEAR = 0.035  # of the axes: points nearer than this in both directions have their labels on different sides


def check_beside(picture: Picture) -> None:
    """Refuse names that are neither a family, nor "smoothstep", nor a law of the catalogue."""
    for name in picture.catalogue:
        if name not in FAMILIES and name != SMOOTHSTEPS:
            with located(f"figure {picture.name}, catalogue"):
                _ = catalogue[name]


def draw_beside(axes: Axes, picture: Picture, x: Ends, y: Ends) -> None:
    """Draw the data named by the picture's entry `catalogue`, within the window x, y."""
    for family in (name for name in picture.catalogue if name in FAMILIES):
        laws = [savin(family, float(alpha)) for alpha in np.linspace(*alpha_range(family), 61)]
        points = np.array([_point(law, picture) for law in laws])
        if not any(_inside(point, x, y) for point in points.tolist()):
            continue
        style: dict[str, Any] = {"color": GREEN, "linestyle": _STROKES[family], "linewidth": 1.2, "zorder": 3}
        axes.plot(*points.T, label=f"Savin's family {family} (l = {FAMILIES[family] + 2})", **style)
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
        if picture.limits and picture.over[0] == "B":
            _limit_curves(axes, picture, fronts, x)
        elif picture.limits:
            _corners(axes, picture, fronts, colours)
        axes.set(xlim=x, ylim=y, title=picture.title)
        figure.legend(loc="outside right upper")
        return figure


def _draw_curve(axes: Axes, front: Front, **style: Any) -> None:
    """The points of a front, and between them the front itself; straight lines where it is not convex."""
    dots = {**style, "marker": "o", "markersize": 2.2, "zorder": 4}
    exact = _exact(front)
    if exact is None:
        draw_front(front, axes, **dots)
    else:
        draw_proven_front(exact, axes, **style, zorder=4)
        draw_front(front, axes, **{**dots, "label": "_nolegend_", "linestyle": "none"})


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
    drawn: list[list[float | None]] = []
    for front in fronts:
        stated = front[0].problem
        limits = [known_limit(replace(stated, B=float(B), minimise=picture.over[1])) for B in values]
        if None in limits or limits in drawn:
            continue
        label = "limit of all laws" if not drawn else f"the same of order {stated.order}"
        stroke = ("-", "-.")[min(len(drawn), 1)]
        axes.plot(values, np.array(limits, dtype=float), label=label, color=GREY, linewidth=1.2, linestyle=stroke)
        drawn.append(limits)


def _corners(axes: Axes, picture: Picture, fronts: Sequence[Front], colours: Sequence[str]) -> None:
    """The limit of all laws in either constant, which no one law need reach in both."""
    for curve, front, shade in zip(picture.front, fronts, colours, strict=True):
        style: dict[str, Any] = {"color": shade, "linewidth": 1.1, "linestyle": (0, (1, 2)), "zorder": 2}
        stated = _freed(front[0].problem, picture.over[0])
        limits = [known_limit(replace(stated, minimise=name)) for name in picture.over]
        label = f"limit of each constant alone, {curve.label}"
        for line, value in zip((axes.axvline, axes.axhline), limits, strict=True):
            if value is not None:
                draw_line: Callable[..., Any] = line
                draw_line(value, label=label, **style)
                label = "_nolegend_"


def _freed(problem: Problem, name: str) -> Problem:
    changed: dict[str, Any] = {name: None}
    return replace(problem, **changed)
