"""The picture of the theory of cams: the lengths and angles of a roller on a slide and of one on an arm."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from optlaws import Cycle, DiscCam, Dwell, OscillatingRoller, Return, Rise, TranslatingRoller, deg
from optlaws.files.writing import forced
from optlaws.numbers import Array
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, plot_style, save_picture

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PLACE = deg(75)
PRIME, ROLLER, OFFSET, ARM, PIVOT = 40.0, 10.0, 12.0, 70.0, 90.0
UP = 1j


def slide_and_arm() -> tuple[DiscCam, DiscCam]:
    """A cam under a roller on a slide and one under a roller on an arm, in millimetres."""
    cycles = [
        Cycle([Rise(stroke, "140 deg"), Dwell("60 deg"), Return(stroke, "120 deg"), Dwell()], speed="60 rpm")
        for stroke in ("30 mm", "24 deg")
    ]
    slide = TranslatingRoller(f"{ROLLER} mm", offset=f"{OFFSET} mm")
    arm = OscillatingRoller(f"{ROLLER} mm", arm=f"{ARM} mm", pivot_distance=f"{PIVOT} mm")
    return DiscCam(cycles[0], f"{PRIME} mm", slide), DiscCam(cycles[1], f"{PRIME} mm", arm)


def draw_cam(axes: Axes, cam: DiscCam) -> tuple[complex, complex]:
    """Draw a cam turned to PLACE with its roller; the roller's centre and the outward normal there."""
    turn = np.exp(1j * PLACE)
    angles = np.linspace(0, 2 * np.pi, 361)
    circle = np.exp(1j * angles)

    def seen(points: Array) -> Array:
        return np.asarray(1e3 * (points[..., 0] + 1j * points[..., 1]) * turn)

    profile, pitch = seen(cam.profile(angles)), seen(cam.pitch_curve(angles))
    centre, foot = complex(seen(cam.pitch_curve(PLACE))), complex(seen(cam.profile(PLACE)))
    axes.fill(profile.real, profile.imag, color=BLUES[0], alpha=0.6)
    for curve, style in (
        (profile, {"color": BLUES[3]}),
        (pitch, {"color": BLUES[3], "linestyle": "--", "linewidth": 1.0}),
        (PRIME * circle, {"color": GREY, "linestyle": ":", "linewidth": 1.0}),
        (centre + ROLLER * circle, {"color": "black"}),
    ):
        axes.plot(curve.real, curve.imag, **style)
    axes.plot([0, centre.real], [0, centre.imag], "o", color="black", markersize=3.5)
    normal = (centre - foot) / abs(centre - foot)
    ends = np.array([foot - 8 * normal, centre + 48 * normal])
    axes.plot(ends.real, ends.imag, color=WARM, linewidth=1.2)
    axes.set_aspect("equal")
    axes.set_axis_off()
    return centre, normal


def line(axes: Axes, first: complex, last: complex, label: str, shift: complex, style: str = "-") -> None:
    """A thin line between two points, with its letter beside the middle."""
    axes.plot([first.real, last.real], [first.imag, last.imag], style, color="black", linewidth=0.9)
    write(axes, (first + last) / 2 + shift, label)


def arc(axes: Axes, centre: complex, radius: float, first: complex, last: complex, label: str) -> None:
    """The arc of the angle between two directions, with its letter."""
    turned = np.angle(last / first)
    points = centre + radius * first / abs(first) * np.exp(1j * np.linspace(0, turned, 40))
    axes.plot(points.real, points.imag, color="black", linewidth=0.9)
    write(axes, centre + (radius + 6) * first / abs(first) * np.exp(0.5j * turned), label)


def write(axes: Axes, at: complex, label: str) -> None:
    """A letter at a point."""
    axes.text(at.real, at.imag, label, ha="center", va="center")


def draw(folder: Path) -> Path:
    """Write cam_geometry.svg into a folder."""
    with plot_style():
        figure = empty_figure(9.2, 4.9)
        left, right = figure.subplots(1, 2)
        slide, arm = slide_and_arm()

        centre, normal = draw_cam(left, slide)
        line(left, complex(OFFSET, -8), centre + 52 * UP, "", 0j, "-.")
        line(left, 0j, complex(OFFSET, 0), "e", -5j)
        line(left, complex(OFFSET, 0), centre, "H + s", -11 + 0j)
        line(left, 0j, PRIME * np.exp(-2.3j), "r₀", -6 + 3j)
        arc(left, centre, 36, UP, normal, "α")
        write(left, centre + 5 - 2j, "R")
        left.set_title("roller on a slide")

        centre, normal = draw_cam(right, arm)
        pivot = complex(PIVOT, 0)
        along = 1j * (centre - pivot) / abs(centre - pivot)
        along = along if along.imag > 0 else -along
        line(right, 0j, pivot, "A", -5j)
        line(right, pivot, centre, "L", 3 + 5j)
        line(right, centre, centre + 46 * along, "", 0j, "-.")
        line(right, 0j, PRIME * np.exp(-2.3j), "r₀", -6 + 3j)
        arc(right, centre, 36, along, normal, "α")
        arc(right, pivot, 22, -1 + 0j, centre - pivot, "ψ")
        right.plot(pivot.real, pivot.imag, "^", color="black", markersize=7)
        right.set_title("roller on an arm")
        return save_picture(figure, folder / "cam_geometry")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
