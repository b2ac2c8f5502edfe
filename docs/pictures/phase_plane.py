"""The picture of the theory of drives: the motion of a limit in the phase plane, and the nearest law."""

from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from optlaws import Powers, Problem, at_most, drive_limit, drive_torque, rms, synthesize
from optlaws.files.writing import forced
from optlaws.plots.style import BLUES, WARM, empty_figure, plot_style, save_picture

MOST = 2.2


def draw(folder: Path) -> Path:
    """Write phase_plane.svg into a folder."""
    torque = drive_torque(inertia="1 + 0.6*a^2", load="3*a")
    limit = drive_limit(torque, "rms torque", B=MOST)
    problem = Problem(order=3, basis=Powers(11), symmetric=False, monotone=True, B=at_most(MOST), minimise=rms(torque))
    law = synthesize(problem).law
    _, position, velocity = limit.motion()
    places = 2 / np.pi * np.arcsin(np.sqrt(position[1:-1]))
    s = np.linspace(1e-3, 1 - 1e-3, 301)
    velocity = CubicSpline(places, velocity[1:-1] / np.sin(np.pi * places))(s) * np.sin(np.pi * s)
    position = np.sin(np.pi * s / 2) ** 2
    k = np.linspace(0, 1, 401)
    motions = (
        (position, velocity, np.gradient(velocity**2 / 2, position), BLUES[3], f"limit: {limit.value:.4f}"),
        (law(k), law.b(k), law.c(k), WARM, f"law of order 3: {rms(torque).value(law):.4f}"),
    )
    with plot_style():
        figure = empty_figure(9.2, 4.2)
        left, right = figure.subplots(1, 2)
        for a, b, c, colour, label in motions:
            left.plot(a, b, color=colour, label=label)
            right.plot(a, (1 + 0.6 * a**2) * c + 0.6 * a * b**2 + 3 * a, color=colour)
        left.set_ylabel("velocity b")
        right.set_ylabel("torque")
        for axes in (left, right):
            axes.set_xlabel("position a")
        left.legend()
        return save_picture(figure, folder / "phase_plane")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
