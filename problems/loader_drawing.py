"""Both cams of a mechanism with an inertial loader, and the energy that they exchange."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from optlaws import MotionLaw, catalogue, deg
from optlaws.balancing import Loader, inertial_loader
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, empty_figure, plot_style
from optlaws.results import Cell, Entries, Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEADINGS = ("link", "B", "C", "D", "J")
ROLLER = 0.17


class Drawing(Entries):
    """The problem file; the angle shown in degrees."""

    law: str
    shown: float
    radius_ratio: float


def run(results: Results) -> None:
    """Draw the mechanism and its energies, and table the peaks of both links."""
    spec = results.read(Drawing)
    mechanism = inertial_loader(catalogue[spec.law].law)
    results.picture("mechanism", draw_mechanism(mechanism, deg(spec.shown), spec.radius_ratio))
    results.picture("exchange", draw_exchange(mechanism, spec.title))
    rows: list[list[Cell]] = []
    for name, law in (("executive", mechanism.executive), ("loader", mechanism.law)):
        peaks = law.constants
        rows.append([name, peaks.B.value, peaks.C.value, peaks.D.value, peaks.J.value])
    page = results.page("drawing").text(f"Law {spec.law}, Y = {mechanism.Y:.9g}.")
    page.figure("mechanism", "Both cams").figure("exchange", "What they exchange").table(HEADINGS, rows)
    assert abs(mechanism.Y - 0.684267782) < 1e-9
    assert abs(mechanism.law.constants.C.value - 6.080243) < 1e-6


Array = NDArray[np.float64]

_APART = 6.4
_SAMPLES = 721


def draw_mechanism(mechanism: Loader, shown: float, radius_ratio: float) -> Figure:
    """Executive cam and balancing cam on one shaft, at the cam angle `shown`; strokes are equal."""
    angles = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
    executive = _cycle(mechanism.executive, angles, 0.0)
    balancing = _cycle(mechanism.law, angles, 0.5)
    with plot_style():
        figure = empty_figure(8.4, 5.4)
        axes = figure.subplots()
        axes.set_axis_off()
        axes.set_aspect("equal")
        guide = radius_ratio + 2.2
        for x, ways, colour, label in (
            (0.0, executive, BLUES[3], "executive mass"),
            (_APART, balancing, GREEN, "loader"),
        ):
            top = cam(axes, (x, 0.0), radius_ratio + ways, angles, shown=shown, colour=colour)
            _slide(axes, x, roller=top, guide=guide, label=label)
        axes.plot([0.12, _APART - 0.12], [0.0, 0.0], color=GREY, linewidth=0.9, linestyle=(0, (8, 3, 2, 3)))
        axes.annotate("one shaft", (0.5 * _APART, 0.0), xytext=(0, 5), textcoords="offset points", ha="center")
        for x, name in ((0.0, "executive cam"), (_APART, "balancing cam")):
            axes.text(x, -radius_ratio - 1.45, name, ha="center")
        axes.set(xlim=(-3.0, _APART + 3.0), ylim=(-radius_ratio - 1.8, guide + 2.4))
        return figure


def draw_exchange(mechanism: Loader, title: str) -> Figure:
    """Velocities, energies and powers over the motion."""
    k = np.linspace(0.0, 1.0, 401)
    B, Y = mechanism.executive.peak(1).value, mechanism.Y
    b, b_l = mechanism.executive.b(k), mechanism.law.b(k)
    panels: tuple[tuple[str, dict[str, Array], str], ...] = (
        ("velocity", {"executive b": b, "loader b": b_l}, "velocity (dimensionless)"),
        ("energy", {"executive": (b / B) ** 2, "loader": (b_l / (Y * B)) ** 2}, "share of the kinetic energy"),
        (
            "power",
            {"executive Y² d": Y**2 * mechanism.executive.d(k), "loader d": mechanism.law.d(k)},
            "power (dimensionless)",
        ),
    )
    with plot_style():
        figure = empty_figure(10.2, 3.5)
        for axes, (name, curves, label) in zip(figure.subplots(1, 3).flat, panels, strict=True):
            for (text, values), colour in zip(curves.items(), (BLUES[3], GREEN), strict=True):
                axes.plot(k, values, color=colour, label=text)
            total = sum(curves.values()) if name != "velocity" else None
            if total is not None:
                axes.plot(k, total, color=WARM, linewidth=1.2, linestyle="--", label="sum")
            _below(axes, label)
        figure.suptitle(f"{title}, Y = {Y:.6g}", x=0.01, ha="left", fontsize=11.0)
        return figure


def _below(axes: Axes, label: str) -> None:
    axes.set(xlabel="k (dimensionless time)", ylabel=label)
    style: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.2), "ncols": 3}
    axes.legend(**{**style, "columnspacing": 1.0, "handlelength": 1.4})


def _cycle(law: MotionLaw, angles: Array, start: float) -> Array:
    """Ways over a turn: half of it the law, half of it the same law back."""
    k = np.clip(np.where(angles < np.pi, angles, angles - np.pi) / np.pi, 0.0, 1.0)
    there = start + law.a(k)
    return np.asarray(np.where(angles < np.pi, there, start + law.a(1.0) - law.a(k)))


def cam(axes: Axes, at: tuple[float, float], radii: Array, angles: Array, *, shown: float, colour: str) -> float:
    """A cam turned so that the angle `shown` is on top, with its roller there; the height of the roller's centre.

    `radii` is its pitch curve, the way of the roller's centre, at cam angles in radians over a whole turn.
    """
    from matplotlib.patches import Circle, Polygon

    phase = angles - shown + 0.5 * np.pi
    pitch = np.array([at[0] + radii * np.cos(phase), at[1] + radii * np.sin(phase)]).T
    along = np.gradient(pitch, axis=0)
    normal = np.array([along[:, 1], -along[:, 0]]).T / np.linalg.norm(along, axis=1)[:, None]
    axes.add_patch(Polygon(pitch - ROLLER * normal, closed=True, facecolor="#dfe9f3", edgecolor=colour, linewidth=1.4))
    axes.add_patch(Circle(at, 0.12, facecolor="white", edgecolor=GREY, linewidth=1.0, zorder=3))
    top = at[1] + float(np.interp(shown, angles, radii))
    axes.add_patch(Circle((at[0], top), ROLLER, facecolor="white", edgecolor=GREY, linewidth=1.2, zorder=4))
    return top


def _slide(axes: Axes, x: float, *, roller: float, guide: float, label: str) -> None:
    """A rod from a roller through a guide to a mass."""
    from matplotlib.patches import Rectangle

    width, height = 2.4, 0.7
    bottom = guide + 0.75 + roller - 1.2
    axes.plot([x, x], [roller, bottom], color=GREY, linewidth=3.0, solid_capstyle="butt", zorder=3)
    style: dict[str, Any] = {"facecolor": BLUES[3], "edgecolor": "none", "zorder": 4}
    axes.add_patch(Rectangle((x - 0.5 * width, bottom), width, height, **style))
    axes.text(x, bottom + 0.5 * height, label, color="white", ha="center", va="center", zorder=5)
    for side in (-1.0, 1.0):
        edge = x + side * 0.09
        axes.plot([edge, edge], [guide - 0.18, guide + 0.18], color=GREY, linewidth=1.4, zorder=3)
        for up in np.linspace(-0.15, 0.15, 4):
            axes.plot([edge, edge + side * 0.08], [guide + up, guide + up - 0.06], color=GREY, linewidth=1.0)


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
