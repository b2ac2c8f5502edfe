"""The figure of the job "optimal polydyne": residual acceleration over the frequency, and the cams' accelerations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws import drawing
from optlaws.jobs.follower.polydyne_laws import Compared
from optlaws.mechanisms.spectrum.residual import residual_phasor

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS = 601
_LEAST = 2e-3


def draw(title: str, found: Sequence[Sequence[Compared]], between: tuple[float, float]) -> dict[str, bytes]:
    """The figure as svg and png."""
    with drawing.style():
        figure = drawing.figure(9.6, 3.9 * len(found) + 1.1)
        panels = figure.subplots(len(found), 2, squeeze=False, width_ratios=(3, 2))
        for (left, right), laws in zip(panels, found, strict=True):
            _residuals(left, laws, between)
            _accelerations(right, laws)
        panels[-1, 0].set_xlabel("frequency nu of the follower")
        panels[-1, 1].set_xlabel("k")
        handles, labels = panels[0, 0].get_legend_handles_labels()
        figure.suptitle(title, x=0.01, ha="left", fontsize=11.0)
        figure.legend(handles, labels, loc="outside lower center", ncols=3)
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def _residuals(axes: Axes, laws: Sequence[Compared], between: tuple[float, float]) -> None:
    design = laws[0].design
    nu = np.linspace(*between, _POINTS)
    for one, style in zip(laws, _styles(laws), strict=True):
        amplitudes = nu**2 * np.abs(residual_phasor(one.cam, nu, design.damping))
        axes.semilogy(nu, np.maximum(amplitudes, _LEAST / 10), label=one.name, **style)
    axes.axvspan(*design.between, color="#f2f2f2", zorder=0)
    axes.plot(
        design.between, [design.residual] * 2, color="black", linewidth=0.9, linestyle=":", label="most that is asked"
    )
    axes.set(xlim=between, ylim=(_LEAST, None), title=f"damping ratio {design.damping:g}")
    axes.set_ylabel("residual acceleration")


def _accelerations(axes: Axes, laws: Sequence[Compared]) -> None:
    k = np.linspace(0.0, 1.0, _POINTS)
    for one, style in zip(laws, _styles(laws), strict=True):
        if one.polydyne:
            axes.plot(k, one.cam.c(k), **style)
    axes.set(xlim=(0.0, 1.0), title="acceleration of polydyne cams")


def _styles(laws: Sequence[Compared]) -> list[dict[str, Any]]:
    colours = {"optimal": iter(drawing.BLUES[1:]), "robust": iter((drawing.GREEN, "#66c2a5", "#a6761d", "#e6ab02"))}
    warm = iter((drawing.WARM, "#fdae61"))
    grey = iter(("#595959", "#8c8c8c", "#bfbfbf"))
    found = []
    for one in laws:
        if one.kind == "known":
            colour = next(warm if one.polydyne else grey, drawing.GREY)
            found.append({"color": colour, "linestyle": "-" if one.polydyne else "--", "linewidth": 1.2})
        else:
            style = "-" if one.polydyne else "-."
            found.append({"color": next(colours[one.kind], drawing.BLUES[-1]), "linestyle": style})
    return found
