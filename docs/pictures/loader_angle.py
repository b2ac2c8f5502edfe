"""The picture of the theory of the best loaders: the angle that both links share, and the velocity of the loader."""

from math import asin, cos, pi, sin
from pathlib import Path

import numpy as np

from optlaws import Chebyshev, balanced_law
from optlaws.files.writing import forced
from optlaws.numbers import Array
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, plot_style, save_picture

HIGH, LOW = 1.875, 1.2


def limit_profile(B: float, k: Array) -> Array:
    """The profile b_l/B_l of the limit: at a peak velocity below 4/pi it rests at cos(angle) on its way down."""
    if B * pi >= 4:
        return np.asarray(np.minimum(1.0, pi * B / 2 * (0.5 - k)))

    def rate(angle: float) -> float:
        return (2 * sin(angle) - pi / 2) / (sin(angle) - 1 / B)

    def peak(angle: float) -> float:
        return rate(angle) ** 2 / (1 + (rate(angle) - 2) * cos(angle))

    angle = min(np.linspace(asin(1 / B) + 1e-6, pi / 2, 2001), key=peak)
    falls = np.maximum(1 - rate(angle) * k, cos(angle))
    return np.asarray(np.minimum(falls, rate(angle) * (0.5 - k)))


def draw(folder: Path) -> Path:
    """Write loader_angle.svg into a folder."""
    k = np.linspace(0, 0.5, 501)
    with plot_style():
        figure = empty_figure(9.2, 4.2)
        left, right = figure.subplots(1, 2)
        angle = np.linspace(0, pi / 2, 100)
        left.plot(np.cos(angle), np.sin(angle), color=BLUES[3])
        point = np.array([cos(0.7), sin(0.7)])
        left.plot([0, point[0]], [0, point[1]], color="black", linewidth=0.9)
        left.plot([point[0], point[0], 0], [0, point[1], point[1]], ":", color=GREY)
        left.plot(*point, "o", color=WARM)
        left.plot(0.2 * np.cos(angle[angle < 0.7]), 0.2 * np.sin(angle[angle < 0.7]), color="black", linewidth=0.9)
        left.text(0.24, 0.06, "θ")
        left.set_aspect("equal")
        left.set_xlabel("loader: b_l / B_l = cos θ")
        left.set_ylabel("executive link: b / B = sin θ")
        loader = balanced_law(HIGH, order=3, basis=Chebyshev(15)).loader
        right.plot(k, limit_profile(HIGH, k), color=BLUES[3], label=f"limit at B = {HIGH}")
        right.plot(k, loader.law.b(k) / loader.B, color=WARM, label=f"law of degree 15, B = {HIGH}")
        right.plot(k, limit_profile(LOW, k), "--", color=BLUES[3], label=f"limit at B = {LOW}")
        right.set_xlabel("k (dimensionless time)")
        right.set_ylabel("φ = b_l / B_l")
        right.legend(loc="lower left")
        return save_picture(figure, folder / "loader_angle")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
