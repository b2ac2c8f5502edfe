"""The picture of the theory of cycles: joints that are known, and the spans between them."""

from pathlib import Path

import numpy as np

from optlaws import Cycle, Dwell, Free, Return, Rise
from optlaws.files.writing import forced
from optlaws.plots.style import BLUES, WARM, empty_figure, plot_style, save_picture

SPANS = ((0.0, 0.15), (0.25, 0.65), (0.72, 0.92))


def draw(folder: Path) -> Path:
    """Write spans.svg into a folder."""
    segments = [
        Rise("30 mm", "0.15 s"),
        Dwell("0.1 s"),
        Free("15 mm", "0.12 s"),
        Free("-10 mm", "0.1 s"),
        Free("20 mm", "0.18 s"),
        Dwell("0.07 s"),
        Return("55 mm", "0.2 s"),
        Dwell(),
    ]
    cycle = Cycle(segments, period="1 s")
    times = np.linspace(0, 1, 501)
    joints = np.cumsum([0.0, 0.15, 0.1, 0.12, 0.1, 0.18, 0.07, 0.2])
    free = np.isin(np.arange(len(joints)), [3, 4])
    with plot_style():
        figure = empty_figure(9.2, 3.6)
        axes = figure.subplots()
        for i, span in enumerate(SPANS):
            axes.axvspan(*span, color=BLUES[0], alpha=0.35, linewidth=0)
            axes.text(sum(span) / 2, 2, f"span {i + 1}", ha="center", color=BLUES[4])
        axes.plot(times, 1e3 * cycle(times), color=BLUES[3])
        known, unknown = joints[~free], joints[free]
        axes.plot(known, 1e3 * cycle(known), "o", color="black", label="known joint")
        axes.plot(unknown, 1e3 * cycle(unknown), "o", color=WARM, markerfacecolor="white", label="position known alone")
        axes.set_xlabel("time, s")
        axes.set_ylabel("position, mm")
        axes.legend(loc="upper left")
        return save_picture(figure, folder / "spans")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
