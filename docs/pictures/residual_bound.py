"""The picture of the theory of robust laws: a residual vibration below its bound, and the rows that prove it."""

from pathlib import Path

import numpy as np

from optlaws import (
    Chebyshev,
    MotionLaw,
    Problem,
    at_most,
    cam_constant,
    polydyne,
    residual_vibration,
    savin,
    synthesize,
)
from optlaws.files.writing import forced
from optlaws.numbers import Array
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, plot_style, save_picture

DESIGN, LOW, HIGH, MOST = 20, 18, 22, 0.1


def amplitudes(law: MotionLaw, frequencies: Array) -> Array:
    """The complex amplitude of the residual acceleration of an undamped follower on the polydyne cam of a law."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    k = (nodes + 1) / 2
    b = polydyne(law, frequency=DESIGN).b(k)
    rows = np.exp(1j * np.outer(frequencies, 1 - k))
    return np.asarray(-(frequencies**2) * (rows @ (weights / 2 * b)))


def draw(folder: Path) -> Path:
    """Write residual_bound.svg into a folder."""
    around = residual_vibration(frequency=(LOW, HIGH), design=DESIGN)
    least = cam_constant("C", frequency=DESIGN)
    solution = synthesize(Problem(order=4, basis=Chebyshev(15), minimise=least, bounds={around: at_most(MOST)}))
    contacts = [contact for contact in solution.certificate.contacts if contact.direction]
    frequencies = np.linspace(LOW - 1, HIGH + 1, 401)
    inside = (frequencies >= LOW) & (frequencies <= HIGH)
    with plot_style():
        figure = empty_figure(9.2, 4.6)
        left, right = figure.subplots(1, 2)
        residual = amplitudes(solution.law, frequencies)
        family = amplitudes(savin("III", 7.2), frequencies)
        left.plot(frequencies, np.abs(family), color=GREY, label="family III, α = 7.2")
        left.plot(frequencies, np.abs(residual), color=BLUES[3], label="robust law")
        left.plot([LOW, HIGH], [MOST, MOST], color=WARM, label=f"ε = {MOST}")
        left.set_xlabel("frequency ν")
        left.set_ylabel("|p|, residual acceleration")
        left.set_ylim(0, 0.5)
        circle = MOST * np.exp(1j * np.linspace(0, 2 * np.pi, 181))
        right.plot(circle.real, circle.imag, color=WARM)
        right.plot(residual[inside].real, residual[inside].imag, color=BLUES[3])
        for contact in contacts:
            unit = complex(*contact.direction)
            ends = MOST * unit * (1 + np.array([-0.8j, 0.8j]))
            right.plot(ends.real, ends.imag, color="black", linewidth=0.9)
            right.plot(MOST * unit.real, MOST * unit.imag, "o", color="black", markersize=4)
            frequency = LOW + contact.k * (HIGH - LOW)
            right.annotate(
                f"ν = {frequency:.2f}", (MOST * unit.real, MOST * unit.imag), (6, 6), textcoords="offset points"
            )
        right.set_aspect("equal")
        right.set_xlabel("Re p")
        right.set_ylabel("Im p")
        figure.legend(handles=left.lines, loc="outside lower center", ncols=3)
        return save_picture(figure, folder / "residual_bound")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
