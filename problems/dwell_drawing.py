"""Balancing cams of the three types for one executive motion, and the motion of their rockers."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees, tau
from typing import TYPE_CHECKING

import numpy as np

from optlaws import catalogue, deg
from optlaws.balancing import DwellMechanism, dwell_mechanism
from optlaws.plots.style import BLUES, GREEN, GREY, empty_figure, plot_style
from optlaws.results import Cell, Entries, Results

from .loader_drawing import cam

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEADINGS = ("type", "section", "from", "to", "travel")


class Drawing(Entries):
    """The problem file; angles in degrees."""

    law: str
    rise: float
    dwell: float
    clutch_angle: float
    swing: float
    radius_ratio: float
    inertia_ratio: float


def run(results: Results) -> None:
    """Draw the cams and the motions of the three types, and table their sections."""
    spec = results.read(Drawing)
    types = {
        kind: dwell_mechanism(
            kind,
            law=catalogue[spec.law].law,
            dwell=deg(spec.dwell),
            rise=deg(spec.rise),
            clutch_angle=deg(spec.clutch_angle),
            swing=deg(spec.swing),
            radius_ratio=spec.radius_ratio,
            inertia_ratio=spec.inertia_ratio,
        )
        for kind in ("I", "II", "III")
    }
    rows: list[list[Cell]] = []
    for kind, mechanism in types.items():
        place = 0.0
        for section in mechanism.sections:
            end = place + section.angle
            rows.append([kind, section.name, degrees(place), degrees(end), round(section.travel, 12) + 0.0])
            place = end
    results.picture("mechanism", draw_cams(types))
    results.picture("motion", draw_motions(types))
    criteria = "; ".join(f"{kind}: a = {mechanism.a:.5g}, b = {mechanism.b:.5g}" for kind, mechanism in types.items())
    page = results.page("drawing").text(f"Law {spec.law}; {criteria}.")
    page.figure("mechanism", "The cams").figure("motion", "The motions")
    page.text("Cam angles in degrees, travel of the rocker in strokes of the executive link.").table(HEADINGS, rows)
    assert [f"{mechanism.a:.4f}" for mechanism in types.values()] == ["1.7854", "1.0000", "1.5951"]
    assert [f"{mechanism.b:.4f}" for mechanism in types.values()] == ["0.0000", "1.9827", "0.1500"]


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
    with plot_style():
        figure = empty_figure(11.0, 3.6)
        axes = figure.subplots()
        axes.set_axis_off()
        axes.set_aspect("equal")
        for i, (name, radius) in enumerate(radii.items()):
            colour = BLUES[3] if i == 0 else GREEN
            cam(axes, (i * apart, 0.0), radius, angles, shown=0.0, colour=colour)
            axes.text(i * apart, -0.5 * apart - 0.25, name, ha="center")
        _scale(axes, -0.45 * apart, -0.5 * apart + 0.4)
        axes.set(xlim=(-0.55 * apart, 3.55 * apart), ylim=(-0.5 * apart - 0.5, 0.5 * apart + 0.1))
        return figure


def _scale(axes: Axes, x: float, y: float) -> None:
    """A bar as long as the stroke of the executive link, from a place to the right."""
    axes.plot([x, x + 1.0], [y, y], "|-", color=GREY, linewidth=1.2, markersize=7.0)
    axes.text(x + 0.5, y + 0.2, "stroke S", color=GREY, ha="center", fontsize=9.0)


def draw_motions(types: Mapping[str, DwellMechanism]) -> Figure:
    """Position and speed of the rocker over the cam angle, with the sections of the dwells."""
    from matplotlib.patches import Patch

    with plot_style():
        figure = empty_figure(9.6, 6.4)
        panels = figure.subplots(len(types), 2, sharex=True, squeeze=False)
        for (kind, mechanism), (left, right) in zip(types.items(), panels, strict=True):
            k = np.linspace(0.0, 1.0, 1601)
            place = k * degrees(mechanism.cycle)
            _sections(left, mechanism)
            _sections(right, mechanism)
            left.plot(place, mechanism.motion.a(k), color=GREEN)
            ways = _executive(mechanism, np.deg2rad(place)) - mechanism.radius_ratio
            left.plot(place, ways, color=BLUES[3], linestyle="--")
            right.plot(place, mechanism.motion.b(k) / mechanism.cycle, color=GREEN)
            left.set_title(f"type {kind}")
            left.set_ylabel("position, S")
            right.set_ylabel("speed, S per radian")
            left.set(xlim=(0.0, degrees(mechanism.cycle)), xticks=np.arange(0.0, degrees(mechanism.cycle) + 1.0, 45.0))
        for axes in panels[-1]:
            axes.set_xlabel("cam angle, deg")
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


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
