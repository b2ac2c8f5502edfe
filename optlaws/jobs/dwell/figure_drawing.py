"""Drawings of balancing mechanisms for dwells: cams to one scale, and motions over the cycle."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees, tau
from typing import TYPE_CHECKING

import numpy as np

from optlaws import drawing
from optlaws.jobs.loader.cams import cam

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from optlaws.mechanisms.dwell.mechanism import DwellMechanism

SHADES = {
    "dwell": "#eeeeee",
    "clutch": "#fbe0cc",
    "run-out": "#cfe0f0",
    "run-up": "#cfe0f0",
    "reverse": "#cfe5dc",
    "standstill": "#f7f7f7",
}
_SAMPLES = 721


def draw_cams(types: Mapping[str, DwellMechanism]) -> dict[str, bytes]:
    """The executive cam and the balancing cams of the types, to one scale, as svg and png."""
    angles = np.linspace(0.0, tau, _SAMPLES)
    radii = {"executive cam": _executive(next(iter(types.values())), angles)}
    for kind, one in types.items():
        k = np.clip(angles / one.cycle, 0.0, 1.0)
        ways = one.motion.a(k)
        radii[f"type {kind}, a = {one.a:.3g}"] = one.radius_ratio + ways - ways.min()
    apart = 2.0 * max(float(one.max()) for one in radii.values()) + 0.5
    with drawing.style():
        figure = drawing.figure(11.0, 3.6)
        axes = figure.subplots()
        axes.set_axis_off()
        axes.set_aspect("equal")
        for i, (name, radius) in enumerate(radii.items()):
            colour = drawing.BLUES[3] if i == 0 else drawing.GREEN
            cam(axes, (i * apart, 0.0), radius, angles, shown=0.0, colour=colour)
            axes.text(i * apart, -0.5 * apart - 0.25, name, ha="center")
        axes.set(xlim=(-0.55 * apart, 3.55 * apart), ylim=(-0.5 * apart - 0.5, 0.5 * apart + 0.1))
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def draw_motions(types: Mapping[str, DwellMechanism]) -> dict[str, bytes]:
    """Way and speed of the rocker over the cam angle, with the sections of the dwells, as svg and png."""
    from matplotlib.patches import Patch

    with drawing.style():
        figure = drawing.figure(9.6, 6.4)
        panels = figure.subplots(len(types), 2, sharex=True, squeeze=False)
        for (kind, one), (left, right) in zip(types.items(), panels, strict=True):
            k = np.linspace(0.0, 1.0, 1601)
            place = k * degrees(one.cycle)
            _sections(left, one)
            _sections(right, one)
            left.plot(place, one.motion.a(k), color=drawing.GREEN)
            ways = _executive(one, np.deg2rad(place)) - one.radius_ratio
            left.plot(place, ways, color=drawing.BLUES[3], linestyle="--")
            right.plot(place, one.motion.b(k) / one.cycle, color=drawing.GREEN)
            left.set_title(f"type {kind}")
            left.set_ylabel("way (S)")
            right.set_ylabel("speed (S per radian)")
            left.set(xlim=(0.0, degrees(one.cycle)), xticks=np.arange(0.0, degrees(one.cycle) + 1.0, 45.0))
        for axes in panels[-1]:
            axes.set_xlabel("cam angle (degrees)")
        lines = panels[0][0].lines[:2]
        used = [name for name in SHADES if any(name == s.name for one in types.values() for s in one.sections)]
        patches = [Patch(facecolor=SHADES[name]) for name in used]
        labels = ["loader's rocker", "executive link", *used]
        figure.legend([*lines, *patches], labels, loc="outside lower center", ncols=4)
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def _sections(axes: Axes, one: DwellMechanism) -> None:
    place = 0.0
    for section in one.sections:
        end = place + degrees(section.angle)
        if section.name in SHADES:
            axes.axvspan(place, end, color=SHADES[section.name], linewidth=0.0, zorder=0)
        place = end


def _executive(one: DwellMechanism, angles: np.ndarray) -> np.ndarray:
    """Radii of the executive cam."""
    up = np.clip(angles / one.rise, 0.0, 1.0)
    down = np.clip((angles - one.rise - one.dwell) / one.return_angle, 0.0, 1.0)
    return np.asarray(one.radius_ratio + one.law.a(up) - one.return_law.a(down))
