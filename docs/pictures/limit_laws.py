"""The picture of the theory of limits: velocities of the laws that attain them, at two peak velocities."""

from pathlib import Path

import numpy as np

from optlaws.files.writing import forced
from optlaws.plots.style import DISTINCT, empty_figure, plot_style, save_picture
from optlaws.synthesis.limits import limit_law

SHOWN = (("C", 3, "C"), ("D", 3, "D"), ("RMS", 3, "RMS of c"), ("J", 2, "J, l = 2"), ("J", 3, "J, l = 3"))
STYLES = ("-", "-", "-", "--", "-")  # up to B = 3/2 the law of least J with l = 2 is that of least RMS


def draw(folder: Path) -> Path:
    """Write limit_laws.svg into a folder."""
    k = np.linspace(0, 0.5, 401)
    with plot_style():
        figure = empty_figure(9.2, 4.4)
        panels = figure.subplots(1, 2)
        for axes, B in zip(panels, (1.35, 2.2), strict=True):
            for (name, order, label), colour, style in zip(SHOWN, DISTINCT, STYLES, strict=False):
                axes.plot(k, limit_law(name, B, order=order).b(k), style, color=colour, label=label)
            axes.set_title(f"B = {B}")
            axes.set_xlabel("k (dimensionless time)")
            axes.set_ylabel("velocity b")
        figure.legend(handles=panels[0].lines, loc="outside lower center", ncols=len(SHOWN))
        return save_picture(figure, folder / "limit_laws")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
