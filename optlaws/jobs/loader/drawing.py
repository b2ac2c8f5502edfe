"""The job "loader drawing": both cams of a mechanism with an inertial loader, and the energy they exchange."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from optlaws import drawing
from optlaws.files import tables, writing
from optlaws.files.problem_file import Positive, Text, convert
from optlaws.jobs.loader.cams import cam, slide
from optlaws.jobs.pages.page import Page
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.loader.loader import Loader, loader

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEADINGS = ("link", "B", "C", "D", "J")


class Drawing(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file; the angle shown in degrees."""

    job: str
    title: Text
    law: Text
    shown: Annotated[float, msgspec.Meta(ge=0, lt=360)]
    radius_ratio: Positive


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Drawing, file)
    mechanism = loader(catalogue[spec.law].law)
    figures = {
        "mechanism": draw_mechanism(mechanism, deg(spec.shown), spec.radius_ratio),
        "exchange": draw_exchange(mechanism, spec.title),
    }
    rows: list[list[tables.Cell]] = []
    for name, law in (("executive", mechanism.executive), ("loader", mechanism.law)):
        peaks = law.constants
        rows.append([name, peaks.B.value, peaks.C.value, peaks.D.value, peaks.J.value])
    page = Page(spec.title).text(f"Law {spec.law}, Y = {mechanism.Y:.9g}.")
    page.figure("mechanism", "Both cams").figure("exchange", "What they exchange").table(HEADINGS, rows)
    return [
        writing.write(out / "drawing.md", str(page)),
        *drawing.save_pictures(figures, out),
    ]


Array = NDArray[np.float64]

_APART = 6.4
_SAMPLES = 721


def draw_mechanism(mechanism: Loader, shown: float, radius_ratio: float) -> Figure:
    """Executive cam and balancing cam on one shaft, at the cam angle `shown`; strokes are equal."""
    angles = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
    executive = _cycle(mechanism.executive, angles, 0.0)
    balancing = _cycle(mechanism.law, angles, 0.5)
    with drawing.style():
        figure = drawing.figure(8.4, 5.4)
        axes = figure.subplots()
        axes.set_axis_off()
        axes.set_aspect("equal")
        guide = radius_ratio + 2.2
        for x, ways, colour, label in (
            (0.0, executive, drawing.BLUES[3], "executive mass"),
            (_APART, balancing, drawing.GREEN, "loader"),
        ):
            top = cam(axes, (x, 0.0), radius_ratio + ways, angles, shown=shown, colour=colour)
            slide(axes, x, roller=top, guide=guide, label=label)
        axes.plot([0.12, _APART - 0.12], [0.0, 0.0], color=drawing.GREY, linewidth=0.9, linestyle=(0, (8, 3, 2, 3)))
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
    with drawing.style():
        figure = drawing.figure(10.2, 3.5)
        for axes, (name, curves, label) in zip(figure.subplots(1, 3).flat, panels, strict=True):
            for (text, values), colour in zip(curves.items(), (drawing.BLUES[3], drawing.GREEN), strict=True):
                axes.plot(k, values, color=colour, label=text)
            total = sum(curves.values()) if name != "velocity" else None
            if total is not None:
                axes.plot(k, total, color=drawing.WARM, linewidth=1.2, linestyle="--", label="sum")
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
