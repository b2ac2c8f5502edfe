"""The picture of the theory of machines: a residual vibration over a box of frequencies and damping ratios."""

from pathlib import Path

import numpy as np

from optlaws import smoothstep
from optlaws.files.writing import forced
from optlaws.plots.style import BLUES, WARM, empty_figure, plot_style, save_picture

FREQUENCIES, DAMPING = (18.0, 22.0), (0.0, 0.1)


def draw(folder: Path) -> Path:
    """Write root_box.svg into a folder."""
    nodes, weights = np.polynomial.legendre.leggauss(100)
    k = (nodes + 1) / 2
    frequency, damping = np.meshgrid(np.linspace(*FREQUENCIES, 161), np.linspace(*DAMPING, 121))
    root = 1j * frequency * np.exp(1j * np.arcsin(damping))
    integral = np.abs(np.exp(root[..., None] * (1 - k)) @ (weights / 2 * smoothstep(4).b(k)))
    place = np.unravel_index(integral.argmax(), integral.shape)
    with plot_style():
        figure = empty_figure(7.2, 3.8)
        axes = figure.subplots()
        filled = axes.contourf(frequency, damping, 1e3 * integral, levels=12, cmap="Blues")
        axes.contour(frequency, damping, 1e3 * integral, levels=filled.levels, colors=BLUES[3], linewidths=0.5)
        (low, high), (light, heavy) = FREQUENCIES, DAMPING
        outline = [low, high, high, low, low], [light, light, heavy, heavy, light]
        axes.plot(*outline, color=WARM, clip_on=False, zorder=5)
        axes.plot(frequency[place], damping[place], "o", color=WARM, clip_on=False, zorder=5)
        axes.grid(visible=False)
        axes.set_xlabel("frequency ν")
        axes.set_ylabel("damping ratio ζ")
        figure.colorbar(filled, label="|integral|, thousandths")
        return save_picture(figure, folder / "root_box")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
