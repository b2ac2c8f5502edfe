"""The picture on the first page: what modified sine's peak velocity and jerk allow."""

from pathlib import Path
from typing import Any

from optlaws import Chebyshev, Comparison, Problem, at_most, catalogue, synthesize
from optlaws.files.writing import forced
from optlaws.plots.style import empty_figure, plot_style, save_picture

PANELS = ((0, "displacement a", None), (1, "velocity b", "B"), (2, "acceleration c", "C"), (3, "jerk j", "J"))


def compared() -> Comparison:
    """Modified sine, and the laws of least C at its B and J with Z of degree 9 and 41."""
    sine = catalogue["modified sine"].law
    B, J = sine.constants.B.value, sine.constants.J.value
    laws = {
        f"least C, Z of degree {degree}": synthesize(Problem(B=B, J=at_most(J), order=3, basis=Chebyshev(degree))).law
        for degree in (9, 41)
    }
    return Comparison({"modified sine": sine, **laws})


def draw(folder: Path) -> Path:
    """Write gain.svg into a folder."""
    comparison = compared()
    with plot_style():
        figure = empty_figure(9.2, 5.6)
        axes = figure.subplots(2, 2, sharex=True)
        artists: list[Any] = comparison.plot(list(axes.flat))
        for axis, (_, label, peak) in zip(axes.flat, PANELS, strict=True):
            axis.set_ylabel(f"{label} (dimensionless)")
            if peak is not None:
                values = [getattr(law.constants, peak).value for law in comparison.laws.values()]
                same = max(values) - min(values) < 1e-6 * max(values)
                shown = values[:1] if same else values
                axis.set_title(f"{peak} = {', '.join(f'{value:.4g}' for value in shown)}{' for all' if same else ''}")
        for axis in axes[1]:
            axis.set_xlabel("k (dimensionless time)")
        lines = [artist for artist in artists if artist in axes[0, 0].lines and len(artist.get_xdata()) > 1]
        figure.legend(lines, list(comparison.laws), loc="outside lower center", ncols=3)
        return save_picture(figure, folder / "gain")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
