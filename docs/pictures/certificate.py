"""The picture of the theory of certificates: the contacts of a law of least C, and the bound they prove for every B."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from optlaws import Chebyshev, Problem, ProblemArray, synthesize, synthesize_array
from optlaws.files.writing import forced
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, plot_style, save_picture


def draw(folder: Path) -> Path:
    """Write certificate.svg into a folder."""
    solution = synthesize(Problem(B=1.859, order=4, basis=Chebyshev(9)))
    proof, law = solution.certificate, solution.law
    with plot_style():
        figure = empty_figure(9.2, 4.0)
        left, right = figure.subplots(1, 2)
        k = np.linspace(0, 0.5, 301)
        left.plot(k, law.c(k), color=BLUES[3])
        left.axhline(solution.objective, color=GREY, linestyle=":")
        for contact in proof.contacts:
            left.plot([contact.k] * 2, [0, solution.objective], color=WARM, linewidth=0.9)
            left.plot(contact.k, solution.objective, "o", color=WARM, markersize=18 * contact.multiplier)
            left.text(contact.k + 0.006, 0.4, f"m = {contact.multiplier:.3f}", rotation=90, color=WARM)
        left.set_xlabel("k (dimensionless time)")
        left.set_ylabel("acceleration c")
        B = np.linspace(1.6, 2.1, 101)
        least = synthesize_array(ProblemArray(B=B, order=4, basis=Chebyshev(9)))
        right.plot(B, least.C, color=BLUES[3], label="least C")
        ends = [float(B[0]), float(B[-1])]
        bounds = [replace(proof, problem=replace(proof.problem, B=end)).bound for end in ends]
        right.plot(ends, bounds, color=WARM, label="bound by the certificate of B = 1.859")
        right.plot(1.859, solution.objective, "o", color=WARM)
        right.set_ylim(4.4, 5.6)
        right.set_xlabel("B")
        right.set_ylabel("C")
        right.legend(loc="upper right")
        return save_picture(figure, folder / "certificate")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
