"""The job "dwell types": criteria, ways and tooth counts of the three types over the dwell, nomograms and a map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from math import degrees, pi
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.errors import InfeasibleProblem
from optlaws.files import tables, writing
from optlaws.files.problem_file import Degrees, Positive, Text, convert
from optlaws.jobs.pages.page import Page
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.dwell.choice import buildable, least_dwell
from optlaws.mechanisms.dwell.clutch import Clutch
from optlaws.mechanisms.dwell.mechanism import DwellMechanism, dwell_mechanism

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

Some = msgspec.Meta(min_length=1)


class Scenario(msgspec.Struct, forbid_unknown_fields=True):
    """A name, and the angle of the rise in degrees; 180 less the dwell unless given."""

    name: Text
    rise: Degrees | None = None

    def angle(self, dwell: float) -> float:
        """The rise that goes with a dwell, in degrees."""
        return 180.0 - dwell if self.rise is None else self.rise


class Map(msgspec.Struct, forbid_unknown_fields=True):
    """Limits of b over the inertia ratio, and the range of clutch angles in degrees."""

    limits: Annotated[list[Positive], Some]
    clutch_angles: Annotated[list[Degrees], msgspec.Meta(min_length=2, max_length=2)]


class Types(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file; angles in degrees."""

    job: str
    title: Text
    law: Text
    radius_over_length: Positive
    inertia_ratio: Positive
    swings: Annotated[list[Degrees], Some]
    clutch_angles: Annotated[list[Degrees], Some]
    dwells: Annotated[list[Degrees], Some]
    teeth: Annotated[int, msgspec.Meta(ge=1)]
    map: Map
    scenario: Annotated[list[Scenario], Some]

    def types(self, scenario: Scenario, swing: float, clutch_angle: float, dwell: float) -> dict[str, DwellMechanism]:
        """The types that these angles, in degrees, allow; type I is always among them."""
        make = partial(
            dwell_mechanism,
            law=catalogue[self.law].law,
            dwell=deg(dwell),
            rise=deg(scenario.angle(dwell)),
            clutch_angle=deg(clutch_angle),
            swing=deg(swing),
            radius_ratio=self.radius_over_length / deg(swing),
            inertia_ratio=self.inertia_ratio,
        )
        made, refused = buildable(make)
        if "I" in refused:
            raise refused["I"]
        return made


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
    def given(self) -> list[tables.Cell]:
        """The first cells of a row."""
        return [self.scenario, self.swing, self.clutch_angle, self.dwell, self.rise]


GIVEN = ("scenario", "swing", "clutch angle", "dwell", "rise")
CRITERIA = ("a I", "a II", "a III", "b II", "b III", "S1 I", "S2 II", "S2 III")
TEETH = ("type", "scenario", "swing", "clutch angle", "dwell", "p/N", "N for p = 1", "nearest p", "N", "off by")


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Types, file)
    cases = list(_cases(spec))
    about = f"{spec.title}; from {file.name}; angles in degrees"
    rows = [[*case.given, *_criteria(case)] for case in cases]
    teeth = [row for case in cases for row in _teeth(case, spec.teeth)]
    figures = {
        "size_of_type_I": draw_first(spec),
        "nomograms": draw_all(spec),
        "map": draw_map(catalogue[spec.law].law, spec.map.limits, spec.map.clutch_angles),
    }
    return [
        writing.write(out / "criteria.csv", tables.to_csv((*GIVEN, *CRITERIA), rows, about=about)),
        writing.write(out / "teeth.csv", tables.to_csv(TEETH, teeth, about=about)),
        writing.write(out / "dwell_types.md", str(_page(spec, rows, teeth))),
        *drawing.save_pictures(figures, out),
    ]


def _cases(spec: Types) -> Iterator[Case]:
    for scenario, swing, clutch, dwell in product(spec.scenario, spec.swings, spec.clutch_angles, spec.dwells):
        types = spec.types(scenario, swing, clutch, dwell)
        yield Case(scenario.name, swing, clutch, dwell, scenario.angle(dwell), types)


def _criteria(case: Case) -> list[tables.Cell]:
    wanted = [name.split() for name in CRITERIA]
    return [getattr(case.types[kind], name) if kind in case.types else None for name, kind in wanted]


def _teeth(case: Case, most: int) -> Iterator[list[tables.Cell]]:
    for kind in ("II", "III"):
        if kind in case.types:
            clutch = Clutch(case.types[kind])
            best = clutch.nearest(most)
            yield [kind, *case.given[:4], clutch.ratio, 1.0 / clutch.ratio, best.p, best.N, degrees(best.error)]


def _page(spec: Types, rows: Sequence[Sequence[tables.Cell]], teeth: Sequence[Sequence[tables.Cell]]) -> Page:
    said = (
        f"Law {spec.law} throughout; least radius {spec.radius_over_length:g} rocker lengths, inertia ratio "
        f"{spec.inertia_ratio:g} (b is proportional to it). Angles in degrees, ways in strokes of the executive link. "
        "b of type I is 0. A cell is empty where the clutch leaves no room."
    )
    pictures = (
        ("The cam of type I grows with the dwell", "size_of_type_I"),
        ("Criteria a and b of the three types", "nomograms"),
        ("The type with the smallest cam", "map"),
    )
    page = Page(spec.title).text(said)
    for title, name in pictures:
        page.figure(name, title)
    page.heading("Criteria and ways").table((*GIVEN, *CRITERIA), rows, digits=6).heading("Tooth counts")
    page.text(f"The nearest p/N with at most {spec.teeth} teeth; the angle it is off in degrees.")
    return page.table(TEETH, teeth, digits=6)


COLOURS = {"I": drawing.GREY, "II": drawing.BLUES[3], "III": drawing.GREEN}
_POINTS = 49


def draw_first(spec: Types) -> Figure:
    """Criterion a of type I over the dwell, a curve for each swing and scenario."""
    dwells = np.linspace(1.0, max(spec.dwells), _POINTS)
    strokes = ("-", "--", "-.", ":")
    with drawing.style():
        figure = drawing.figure()
        axes = figure.subplots()
        for scenario, stroke in zip(spec.scenario, strokes, strict=False):
            for swing, shade in zip(spec.swings, drawing.BLUES[-len(spec.swings) :], strict=False):
                sizes = [spec.types(scenario, swing, 0.0, dwell)["I"].a for dwell in dwells.tolist()]
                label = f"swing {swing:g}°, {scenario.name}"
                axes.plot(dwells, sizes, color=shade, linestyle=stroke, label=label)
        axes.set(xlabel="dwell (degrees)", ylabel="a: greatest radius over that of the executive cam")
        axes.set(title=f"Cam of the loader of type I, law {spec.law}", ylim=(1.0, None))
        axes.legend(loc="upper left")
        return figure


def draw_all(spec: Types) -> Figure:
    """Criteria a and b of the types in the first scenario, a panel for each swing and clutch angle."""
    with drawing.style():
        rows, columns = len(spec.swings), len(spec.clutch_angles)
        figure = drawing.figure(3.5 * columns + 1.0, 2.7 * rows + 0.9)
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
                    axes.set_xlabel("dwell (degrees)")
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
    with drawing.style():
        figure = drawing.figure(3.3 * len(limits) + 0.6, 4.3)
        panels = figure.subplots(1, len(limits), squeeze=False, sharey=True)[0]
        for axes, limit in zip(panels, limits, strict=True):
            third = np.array([_from("III", law, limit, clutch) for clutch in clutches.tolist()])
            second = np.array([_from("II", law, limit, clutch) for clutch in clutches.tolist()])
            axes.fill_betweenx(clutches, 0.0, third, color=SHADES["I"], linewidth=0.0)
            axes.fill_betweenx(clutches, third, second, color=SHADES["III"], linewidth=0.0)
            axes.fill_betweenx(clutches, second, _WHOLE, color=SHADES["II"], linewidth=0.0)
            for edge in (third, second):
                axes.plot(edge, clutches, color=drawing.GREY, linewidth=1.0)
            middle = _EDGE_POINTS // 2
            edges = (0.0, third[middle], second[middle], _WHOLE)
            for kind, low, high in zip(("I", "III", "II"), edges, edges[1:], strict=False):
                axes.text(0.5 * (low + high), clutches[middle], kind, ha="center", va="center", fontsize=13.0)
            for place in RULE:
                line = axes.axvline(place, color=drawing.WARM, linestyle="--", linewidth=1.3)
            axes.set(xlim=(0.0, _WHOLE), ylim=tuple(clutch_angles), xlabel="dwell (degrees)")
            axes.set_title(f"b ≤ {limit:g} I1/I")
            axes.grid(visible=False)
            axes.set_xticks([0, *RULE, _WHOLE])
        panels[0].set_ylabel("clutch angle (degrees)")
        figure.legend([line], ["the paper's rule: I up to 45°, II above 100°"], loc="outside lower center")
        return figure


def _from(kind: str, law: MotionLaw, limit: float, clutch: float) -> float:
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
