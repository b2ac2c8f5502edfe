"""The job "dwell drawing": cams of the three types for one executive motion, and the motion of their rockers."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees, tau
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.files import tables, writing
from optlaws.files.problem_file import Degrees, Positive, Text, convert
from optlaws.jobs.loader.cams import cam
from optlaws.jobs.pages.page import Page
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.dwell.mechanism import KINDS, DwellMechanism, dwell_mechanism

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEADINGS = ("type", "section", "from", "to", "way")


class Drawing(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file; angles in degrees."""

    job: str
    title: Text
    law: Text
    rise: Degrees
    dwell: Degrees
    clutch_angle: Degrees
    swing: Degrees
    radius_ratio: Positive
    inertia_ratio: Positive


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Drawing, file)
    law = catalogue[spec.law].law
    types = {
        kind: dwell_mechanism(
            kind,
            law=law,
            dwell=deg(spec.dwell),
            rise=deg(spec.rise),
            clutch_angle=deg(spec.clutch_angle),
            swing=deg(spec.swing),
            radius_ratio=spec.radius_ratio,
            inertia_ratio=spec.inertia_ratio,
        )
        for kind in KINDS
    }
    rows: list[list[tables.Cell]] = []
    for kind, mechanism in types.items():
        place = 0.0
        for section in mechanism.sections:
            rows.append(
                [kind, section.name, degrees(place), degrees(place + section.angle), round(section.travel, 12) + 0.0]
            )
            place += section.angle
    figures = {"mechanism": draw_cams(types), "motion": draw_motions(types)}
    said = "; ".join(f"{kind}: a = {mechanism.a:.5g}, b = {mechanism.b:.5g}" for kind, mechanism in types.items())
    page = Page(spec.title).text(f"Law {spec.law}; {said}.")
    page.figure("mechanism", "The cams").figure("motion", "The motions")
    page.text("Cam angles in degrees, ways of the rocker in strokes of the executive link.").table(HEADINGS, rows)
    return [
        writing.write(out / "drawing.md", str(page)),
        *drawing.save_pictures(figures, out),
    ]


SHADES = {
    "dwell": "#eeeeee",
    "clutch": "#fbe0cc",
    "run-out": "#cfe0f0",
    "run-up": "#e3d6ee",
    "reverse": "#cfe5dc",
    "standstill": "#f7f7f7",
}
_SAMPLES = 721


def draw_cams(types: Mapping[str, DwellMechanism]) -> Figure:
    """The executive cam and the balancing cams of the types, to one scale."""
    angles = np.linspace(0.0, tau, _SAMPLES)
    radii = {"executive cam": _executive(next(iter(types.values())), angles)}
    for kind, mechanism in types.items():
        k = np.clip(angles / mechanism.cycle, 0.0, 1.0)
        ways = mechanism.motion.a(k)
        radii[f"type {kind}, a = {mechanism.a:.3g}"] = mechanism.radius_ratio + ways - ways.min()
    apart = 2.0 * max(float(values.max()) for values in radii.values()) + 0.5
    with drawing.style():
        figure = drawing.figure(11.0, 3.6)
        axes = figure.subplots()
        axes.set_axis_off()
        axes.set_aspect("equal")
        for i, (name, radius) in enumerate(radii.items()):
            colour = drawing.BLUES[3] if i == 0 else drawing.GREEN
            cam(axes, (i * apart, 0.0), radius, angles, shown=0.0, colour=colour)
            axes.text(i * apart, -0.5 * apart - 0.25, name, ha="center")
        _scale(axes, -0.45 * apart, -0.5 * apart + 0.4)
        axes.set(xlim=(-0.55 * apart, 3.55 * apart), ylim=(-0.5 * apart - 0.5, 0.5 * apart + 0.1))
        return figure


def _scale(axes: Axes, x: float, y: float) -> None:
    """A bar as long as the stroke of the executive link, from a place to the right."""
    axes.plot([x, x + 1.0], [y, y], "|-", color=drawing.GREY, linewidth=1.2, markersize=7.0)
    axes.text(x + 0.5, y + 0.2, "stroke S", color=drawing.GREY, ha="center", fontsize=9.0)


def draw_motions(types: Mapping[str, DwellMechanism]) -> Figure:
    """Way and speed of the rocker over the cam angle, with the sections of the dwells."""
    from matplotlib.patches import Patch

    with drawing.style():
        figure = drawing.figure(9.6, 6.4)
        panels = figure.subplots(len(types), 2, sharex=True, squeeze=False)
        for (kind, mechanism), (left, right) in zip(types.items(), panels, strict=True):
            k = np.linspace(0.0, 1.0, 1601)
            place = k * degrees(mechanism.cycle)
            _sections(left, mechanism)
            _sections(right, mechanism)
            left.plot(place, mechanism.motion.a(k), color=drawing.GREEN)
            ways = _executive(mechanism, np.deg2rad(place)) - mechanism.radius_ratio
            left.plot(place, ways, color=drawing.BLUES[3], linestyle="--")
            right.plot(place, mechanism.motion.b(k) / mechanism.cycle, color=drawing.GREEN)
            left.set_title(f"type {kind}")
            left.set_ylabel("way (S)")
            right.set_ylabel("speed (S per radian)")
            left.set(xlim=(0.0, degrees(mechanism.cycle)), xticks=np.arange(0.0, degrees(mechanism.cycle) + 1.0, 45.0))
        for axes in panels[-1]:
            axes.set_xlabel("cam angle (degrees)")
        lines = panels[0][0].lines[:2]
        used = [
            name for name in SHADES if any(name == s.name for mechanism in types.values() for s in mechanism.sections)
        ]
        patches = [Patch(facecolor=SHADES[name]) for name in used]
        labels = ["loader's rocker", "executive link", *used]
        figure.legend([*lines, *patches], labels, loc="outside lower center", ncols=4)
        return figure


def _sections(axes: Axes, mechanism: DwellMechanism) -> None:
    place = 0.0
    for section in mechanism.sections:
        end = place + degrees(section.angle)
        if section.name in SHADES:
            axes.axvspan(place, end, color=SHADES[section.name], linewidth=0.0, zorder=0)
        place = end


def _executive(mechanism: DwellMechanism, angles: np.ndarray) -> np.ndarray:
    """Radii of the executive cam."""
    up = np.clip(angles / mechanism.rise, 0.0, 1.0)
    down = np.clip((angles - mechanism.rise - mechanism.dwell) / mechanism.return_angle, 0.0, 1.0)
    return np.asarray(mechanism.radius_ratio + mechanism.law.a(up) - mechanism.return_law.a(down))
