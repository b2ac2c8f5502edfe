"""The picture of the theory of overlapping motions: a dwell that begins somewhere in a box, and the bound before it."""

from pathlib import Path

import numpy as np

from optlaws.numbers import Array
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, plot_style, save_picture

BOX = (0.55, 0.75)
JERK, ACCELERATION = 60.0, 8.0


def way(time: Array) -> Array:
    """The greatest distance covered in a time from rest, within the jerk, then within the acceleration."""
    ramp = ACCELERATION / JERK
    first, rest = np.clip(time, 0, ramp), np.maximum(time - ramp, 0)
    return np.asarray(JERK * first**3 / 6 + JERK * first**2 / 2 * rest + ACCELERATION * rest**2 / 2)


def draw(folder: Path) -> list[Path]:
    """Write instant_box.svg and instant_box.png into a folder."""
    t = np.linspace(0, 1, 501)
    with plot_style():
        figure = empty_figure(9.2, 4.0)
        left, right = figure.subplots(1, 2)
        for begin, style in ((BOX[0], "-"), (sum(BOX) / 2, "--"), (BOX[1], ":")):
            left.plot(t, np.maximum(1 - way(begin - t), 0), style, color=BLUES[3])
        left.text(0.4, 0.45, "1 - R(τ - t)", color=BLUES[3])
        left.axvspan(*BOX, color=BLUES[0], alpha=0.35, linewidth=0)
        left.text(sum(BOX) / 2, 0.05, "τ in the box", ha="center", color=GREY)
        left.set_xlabel("time t")
        left.set_ylabel("position y, dwell at 1")
        instant, seen = np.linspace(*BOX, 201), 0.42
        right.plot(instant, way(instant - seen), color=BLUES[3], label="R(τ - t)")
        right.plot(BOX, way(np.array(BOX) - seen), color=WARM, label="chord over the box")
        middle = sum(BOX) / 2
        right.plot([BOX[0], middle], way(np.array([BOX[0], middle]) - seen), "--", color=WARM, label="after a split")
        right.plot([middle, BOX[1]], way(np.array([middle, BOX[1]]) - seen), "--", color=WARM)
        right.axvspan(*BOX, color=BLUES[0], alpha=0.35, linewidth=0)
        right.set_xticks([BOX[0], middle, BOX[1]])
        right.set_xlabel("begin of the dwell τ")
        right.set_ylabel(f"greatest distance at t = {seen}")
        right.legend()
        return save_picture(figure, folder / "instant_box")


if __name__ == "__main__":
    draw(Path(__file__).parent)
