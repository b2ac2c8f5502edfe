"""The picture of the theory of least power: the chord that bounds the acceleration in a box, and the first box."""

from pathlib import Path

import numpy as np

from optlaws import Chebyshev, Problem, synthesize
from optlaws.files.writing import forced
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, plot_style, save_picture

B = 1.8
BOX = (0.7, 1.5)


def draw(folder: Path) -> Path:
    """Write power_box.svg into a folder."""
    solution = synthesize(Problem(B=B, order=4, basis=Chebyshev(9), minimise="D"))
    law, D = solution.law, solution.objective
    with plot_style():
        figure = empty_figure(9.2, 4.2)
        left, right = figure.subplots(1, 2)
        b = np.linspace(0.4, B, 201)
        left.fill_between(b, -D / b, D / b, color=BLUES[0], alpha=0.35, linewidth=0)
        left.plot(b, D / b, color=BLUES[3], label="D / b")
        for ends, style, label in (
            (BOX, "-", "chord over the box"),
            ((BOX[0], sum(BOX) / 2), "--", "after a split"),
            ((sum(BOX) / 2, BOX[1]), "--", None),
        ):
            left.plot(ends, [D / end for end in ends], style, color=WARM, label=label)
        k = np.linspace(0, 0.5, 201)
        moving = law.b(k) > b[0]
        left.plot(law.b(k)[moving], law.c(k)[moving], color="black", linewidth=1.2, label="law of least D")
        left.set_xlabel("velocity b")
        left.set_ylabel("acceleration c")
        left.set_ylim(-1, 12)
        left.legend()
        upper = np.minimum(np.sqrt(2 * D * k), B)
        square = np.maximum(B**2 - 2 * D * (0.5 - k), -2 * D * k)
        lower = np.sign(square) * np.sqrt(np.abs(square))
        right.fill_between(k, lower, upper, color=BLUES[0], alpha=0.5, linewidth=0, label="first box")
        right.plot(k, law.b(k), color="black", linewidth=1.2, label="law of least D")
        right.plot([0, 0.5], [0, B], "o", color=GREY)
        right.set_xlabel("k (dimensionless time)")
        right.set_ylabel("velocity b")
        right.legend(loc="upper left")
        return save_picture(figure, folder / "power_box")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
