"""The nomogram of inertial loaders: Y, B, C and D over e13, a curve for each gamma_w."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from optlaws import drawing

_PANELS = (
    ("Y", "energy parameter Y"),
    ("B of loader", "peak velocity B of the loader"),
    ("C of loader", "peak acceleration C of the loader"),
    ("D of loader", "peak power D of the loader"),
)


def draw(title: str, headings: Sequence[str], rows: Sequence[Sequence[float]]) -> dict[str, bytes]:
    """The figure as svg and png."""
    values = np.array(rows)
    column = {name: values[:, i] for i, name in enumerate(headings)}
    from matplotlib import colormaps

    shares = np.unique(column["gamma_w"])
    shades = colormaps["viridis"](np.linspace(0.0, 0.85, len(shares)))
    with drawing.style():
        figure = drawing.figure(9.0, 6.6)
        for axes, (name, label) in zip(figure.subplots(2, 2).flat, _PANELS, strict=True):
            for gamma_w, shade in zip(shares, shades, strict=True):
                here = column["gamma_w"] == gamma_w
                axes.plot(column["e13"][here], column[name][here], color=shade, label=f"{gamma_w:g}")
            axes.set(xlabel="e13 = 1/B of the executive law", ylabel=label)
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, title="gamma_w = B/C", loc="outside right upper")
        figure.suptitle(f"{title} (all dimensionless)", x=0.01, ha="left", fontsize=11.0)
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}
