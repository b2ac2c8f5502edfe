"""Criteria, ways and tooth counts of the three types of balancing mechanisms over the dwell, nomograms and a map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import degrees, pi
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from optlaws import InfeasibleProblem, InputError, MotionLaw, catalogue, deg
from optlaws.balancing import Clutch, DwellMechanism, DwellType, dwell_mechanism, least_dwell
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, empty_figure, plot_style
from optlaws.results import Cell, Entries, Page, Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D


class Scenario(msgspec.Struct):
    """A name, and the angle of the rise in degrees; 180 less the dwell unless given."""

    name: str
    rise: float | None = None

    def angle(self, dwell: float) -> float:
        """The rise that goes with a dwell, in degrees."""
        return 180.0 - dwell if self.rise is None else self.rise


class Map(msgspec.Struct):
    """Limits of b over the inertia ratio, and the range of clutch angles in degrees."""

    limits: list[float]
    clutch_angles: list[float]


class Types(Entries):
    """The problem file; angles in degrees."""

    law: str
    radius_over_length: float
    inertia_ratio: float
    swings: list[float]
    clutch_angles: list[float]
    dwells: list[float]
    teeth: int
    map: Map
    scenario: list[Scenario]

    def types(self, scenario: Scenario, swing: float, clutch_angle: float, dwell: float) -> dict[str, DwellMechanism]:
        """The types that these angles, in degrees, allow; type I is always among them."""
        types = {}
        for kind in ("I", "II", "III"):
            try:
                types[kind] = dwell_mechanism(
                    kind,
                    law=catalogue[self.law].law,
                    dwell=deg(dwell),
                    rise=deg(scenario.angle(dwell)),
                    clutch_angle=deg(clutch_angle),
                    swing=deg(swing),
                    radius_ratio=self.radius_over_length / deg(swing),
                    inertia_ratio=self.inertia_ratio,
                )
            except InputError:  # the clutch leaves no room
                continue
        return types


@dataclass(frozen=True)
class Case:
    """One row: angles in degrees and the types that can be built."""

    scenario: str
    swing: float
    clutch_angle: float
    dwell: float
    rise: float
    types: Mapping[str, DwellMechanism]

    @property
    def given(self) -> list[Cell]:
        """The first cells of a row."""
        return [self.scenario, self.swing, self.clutch_angle, self.dwell, self.rise]


GIVEN = ("scenario", "swing", "clutch angle", "dwell", "rise")
CRITERIA = ("a I", "a II", "a III", "b II", "b III", "S1 I", "S2 II", "S2 III")
TEETH = ("type", "scenario", "swing", "clutch angle", "dwell", "p/N", "N for p = 1", "nearest p", "N", "off by")


def run(results: Results) -> None:
    """Table criteria and tooth counts of all cases, and draw them over the dwell."""
    spec = results.read(Types)
    cases = [
        Case(scenario.name, swing, clutch, dwell, scenario.angle(dwell), spec.types(scenario, swing, clutch, dwell))
        for scenario, swing, clutch, dwell in product(spec.scenario, spec.swings, spec.clutch_angles, spec.dwells)
    ]
    criteria = [[*case.given, *_criteria(case)] for case in cases]
    teeth = [row for case in cases for row in _teeth(case, spec.teeth)]
    results.table("criteria", (*GIVEN, *CRITERIA), criteria, "angles in degrees")
    results.table("teeth", TEETH, teeth, "angles in degrees")
    results.picture("size_of_type_I", draw_first(spec))
    results.picture("nomograms", draw_all(spec))
    results.picture("map", draw_map(catalogue[spec.law].law, spec.map.limits, spec.map.clutch_angles))
    _fill(results.page("dwell_types"), spec, criteria, teeth)
    assert len(cases) == 108
    assert [f"{size:.5f}" for size in criteria[2][5:8]] == ["1.26133", "1.00000", "1.19802"]
    both = [case.types for case in cases if "II" in case.types]
    assert all(types["II"].b > types["III"].b and types["II"].a < types["III"].a for types in both)


def _criteria(case: Case) -> list[Cell]:
    columns = [name.split() for name in CRITERIA]
    return [getattr(case.types[kind], name) if kind in case.types else None for name, kind in columns]


def _teeth(case: Case, most: int) -> Iterator[list[Cell]]:
    for kind in ("II", "III"):
        if kind in case.types:
            clutch = Clutch(case.types[kind])
            best = clutch.nearest(most)
            yield [kind, *case.given[:4], clutch.ratio, 1.0 / clutch.ratio, best.p, best.N, degrees(best.error)]


def _fill(page: Page, spec: Types, rows: Sequence[Sequence[Cell]], teeth: Sequence[Sequence[Cell]]) -> None:
    about = (
        f"Law {spec.law} throughout; least radius {spec.radius_over_length:g} rocker lengths, inertia ratio "
        f"{spec.inertia_ratio:g} (b is proportional to it). Angles in degrees, ways in strokes of the executive link. "
        "b of type I is 0. A cell is empty where the clutch leaves no room."
    )
    pictures = (
        ("The cam of type I grows with the dwell", "size_of_type_I"),
        ("Criteria a and b of the three types", "nomograms"),
        ("The type with the smallest cam", "map"),
    )
    page.text(about)
    for title, name in pictures:
        page.figure(name, title)
    page.heading("Criteria and ways").table((*GIVEN, *CRITERIA), rows, digits=6).heading("Tooth counts")
    page.text(f"The nearest p/N with at most {spec.teeth} teeth; the angle it is off in degrees.")
    page.table(TEETH, teeth, digits=6)


COLOURS = {"I": GREY, "II": BLUES[3], "III": GREEN}
_POINTS = 49


def draw_first(spec: Types) -> Figure:
    """Criterion a of type I over the dwell, a curve for each swing and scenario."""
    dwells = np.linspace(1.0, max(spec.dwells), _POINTS)
    strokes = ("-", "--", "-.", ":")
    with plot_style():
        figure = empty_figure()
        axes = figure.subplots()
        for scenario, stroke in zip(spec.scenario, strokes, strict=False):
            for swing, shade in zip(spec.swings, BLUES[-len(spec.swings) :], strict=False):
                sizes = [spec.types(scenario, swing, 0.0, dwell)["I"].a for dwell in dwells.tolist()]
                label = f"swing {swing:g}°, {scenario.name}"
                axes.plot(dwells, sizes, color=shade, linestyle=stroke, label=label)
        axes.set(xlabel="dwell, deg", ylabel="a: greatest radius over that of the executive cam")
        axes.set(title=f"Cam of the loader of type I, law {spec.law}", ylim=(1.0, None))
        axes.legend(loc="upper left")
        return figure


def draw_all(spec: Types) -> Figure:
    """Criteria a and b of the types in the first scenario, a panel for each swing and clutch angle."""
    with plot_style():
        rows, columns = len(spec.swings), len(spec.clutch_angles)
        figure = empty_figure(3.5 * columns + 1.0, 2.7 * rows + 0.9)
        panels = figure.subplots(rows, columns, squeeze=False, sharex=True)
        handles: dict[str, Line2D] = {}
        for i, swing in enumerate(spec.swings):
            for j, clutch in enumerate(spec.clutch_angles):
                axes = panels[i, j]
                handles |= _panel(axes, spec, swing, clutch, last=j == columns - 1)
                axes.set(title=f"swing {swing:g}°, clutch angle {clutch:g}°")
                if j == 0:
                    axes.set_ylabel("a: size of the cam")
                if i == rows - 1:
                    axes.set_xlabel("dwell, deg")
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
        return figure


def _panel(axes: Axes, spec: Types, swing: float, clutch: float, *, last: bool) -> dict[str, Line2D]:
    least, most = min(spec.dwells), max(spec.dwells)
    dwells = np.linspace(max(least, 2.0 * clutch + 2.0), most, _POINTS)
    cases = [spec.types(spec.scenario[0], swing, clutch, dwell) for dwell in dwells.tolist()]
    handles: dict[str, Line2D] = {}
    for kind in ("I", "II", "III"):
        (handles[f"a, type {kind}"],) = axes.plot(dwells, [case[kind].a for case in cases], color=COLOURS[kind])
    axes.set(xlim=(least, most), ylim=(0.9, 4.0))
    torque = axes.twinx()
    torque.spines["right"].set_visible(True)
    torque.grid(visible=False)
    for kind in ("II", "III"):
        values = [case[kind].b for case in cases]
        (handles[f"b, type {kind}"],) = torque.semilogy(dwells, values, color=COLOURS[kind], linestyle="--")
    torque.set_ylim(0.02, 200.0)
    if last:
        torque.set_ylabel("b: residual torque")
    else:
        torque.set_yticklabels([])
    return handles


SHADES = {"I": "#eeeeee", "III": "#cfe5dc", "II": "#cfe0f0"}
RULE = (45.0, 100.0)
_EDGE_POINTS = 21
_WHOLE = 180.0


def draw_map(law: MotionLaw, limits: Sequence[float], clutch_angles: Sequence[float]) -> Figure:
    """A panel for each limit of b over the inertia ratio, with the paper's rule drawn on it.

    Neither swing nor least radius matters: the order of the sizes is always II, III, I.
    """
    clutches = np.linspace(clutch_angles[0], clutch_angles[1], _EDGE_POINTS)
    with plot_style():
        figure = empty_figure(3.3 * len(limits) + 0.6, 4.3)
        panels = figure.subplots(1, len(limits), squeeze=False, sharey=True)[0]
        for axes, limit in zip(panels, limits, strict=True):
            third = np.array([_from("III", law, limit, clutch) for clutch in clutches.tolist()])
            second = np.array([_from("II", law, limit, clutch) for clutch in clutches.tolist()])
            axes.fill_betweenx(clutches, 0.0, third, color=SHADES["I"], linewidth=0.0)
            axes.fill_betweenx(clutches, third, second, color=SHADES["III"], linewidth=0.0)
            axes.fill_betweenx(clutches, second, _WHOLE, color=SHADES["II"], linewidth=0.0)
            for edge in (third, second):
                axes.plot(edge, clutches, color=GREY, linewidth=1.0)
            middle = _EDGE_POINTS // 2
            edges = (0.0, third[middle], second[middle], _WHOLE)
            for kind, low, high in zip(("I", "III", "II"), edges, edges[1:], strict=False):
                axes.text(0.5 * (low + high), clutches[middle], kind, ha="center", va="center", fontsize=13.0)
            for place in RULE:
                line = axes.axvline(place, color=WARM, linestyle="--", linewidth=1.3)
            axes.set(xlim=(0.0, _WHOLE), ylim=tuple(clutch_angles), xlabel="dwell, deg")
            axes.set_title(f"b ≤ {limit:g} I1/I")
            axes.grid(visible=False)
            axes.set_xticks([0, *RULE, _WHOLE])
        panels[0].set_ylabel("clutch angle, deg")
        figure.legend([line], ["the paper's rule: I up to 45°, II above 100°"], loc="outside lower center")
        return figure


def _from(kind: DwellType, law: MotionLaw, limit: float, clutch: float) -> float:
    """The dwell in degrees from which on a type keeps to the limit; half a turn where it never does."""
    dwell = deg(2.0 * clutch + 1.0)
    mechanism = dwell_mechanism(
        kind,
        law=law,
        dwell=dwell,
        rise=pi - dwell,
        clutch_angle=deg(clutch),
        swing=1.0,
        radius_ratio=1.0,
        inertia_ratio=1.0,
    )
    try:
        return degrees(least_dwell(mechanism, limit))
    except InfeasibleProblem:
        return _WHOLE


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
