"""The picture of the theory of lines: the contacts of the laws of least C along B, and the least C itself."""

from pathlib import Path

import numpy as np

from optlaws import Chebyshev, ProblemArray, synthesize_array
from optlaws.files.writing import forced
from optlaws.plots.style import BLUES, WARM, empty_figure, plot_style, save_picture

END = 0.5
SHOWN = {"C": (BLUES[3], "c = C"), "chord": (WARM, "b = B")}


def draw(folder: Path) -> Path:
    """Write contact_places.svg into a folder."""
    laws = synthesize_array(ProblemArray(B=np.linspace(1.42, 2.3, 200), order=4, basis=Chebyshev(9)))
    lists = [law.certificate.contacts for law in laws]
    # two places between the ends, one at the end k = 1/2, one equation: as many as the five coordinates and C
    affine = [B for B, contacts in zip(laws.B, lists, strict=True) if sorted(c.k == END for c in contacts) == [0, 0, 1]]
    with plot_style():
        figure = empty_figure(9.2, 4.0)
        left, right = figure.subplots(1, 2)
        for constraint, (colour, label) in SHOWN.items():
            places = [
                (B, contact.k)
                for B, contacts in zip(laws.B, lists, strict=True)
                for contact in contacts
                if contact.constraint == constraint
            ]
            left.plot(*zip(*places, strict=True), ".", color=colour, markersize=2.5, label=label)
        left.set_ylabel("k (dimensionless time)")
        left.legend(markerscale=4)
        right.plot(laws.B, laws.C, color=BLUES[3])
        right.set_ylabel("C")
        for axis in (left, right):
            axis.axvspan(min(affine), max(affine), color=BLUES[0], alpha=0.35, linewidth=0)
            axis.set_xlabel("B")
        return save_picture(figure, folder / "contact_places")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
