"""Figures of the job "follower": accelerations over time, and response spectra."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws import drawing
from optlaws.mechanisms.follower.follower import Follower
from optlaws.mechanisms.spectrum.spectrum import response_spectrum

if TYPE_CHECKING:
    from optlaws.jobs.follower.follower import Cam, Study

_POINTS = 801
_STROKES: tuple[Any, ...] = ("-", "--", "-.", (0, (1, 1)), (0, (5, 1)))
_COLOURS = (drawing.BLUES[4], drawing.WARM, drawing.GREEN, drawing.BLUES[1], drawing.GREY)
_OFF = (drawing.WARM, drawing.GREEN, drawing.BLUES[1])


def curves(spec: Study, cams: Sequence[Cam]) -> dict[str, bytes]:
    """Acceleration of cam and mass over k, one panel for each cam, as svg and png."""
    asked = spec.curves
    k = np.linspace(0.0, asked.until, _POINTS)
    rise = k[k <= 1.0]
    with drawing.style():
        figure = drawing.figure(8.6, 3.1 * len(cams) + 0.9)
        panels = figure.subplots(len(cams), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        for axes, cam in zip(panels, cams, strict=True):
            axes.plot(rise, cam.law.c(rise), color=drawing.GREY, linestyle="--", label="cam")
            exact = Follower(spec.nu, asked.damping).response(cam.law)
            axes.plot(k, exact.c(k), color=drawing.BLUES[4], label=f"mass, nu = {spec.nu:g}", zorder=4)
            for percent, colour in zip(asked.deviations, _OFF, strict=False):
                nu = spec.nu * (1.0 + percent / 100.0)
                response = Follower(nu, asked.damping).response(cam.law)
                axes.plot(k, response.c(k), color=colour, linewidth=1.2, label=f"mass, nu = {nu:g} ({percent:+g} %)")
            axes.axvline(1.0, color=drawing.GREY, linewidth=0.8)
            axes.set_title(cam.name)
            axes.set_ylabel("acceleration a''")
        panels[-1].set_xlabel("time k, in durations of the rise (dwell from 1 on)")
        panels[-1].set_xlim(0.0, asked.until)
        figure.suptitle(
            f"Accelerations of cam and mass, damping ratio {asked.damping:g}", x=0.01, ha="left", fontsize=11.0
        )
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def spectrum(spec: Study, cams: Sequence[Cam]) -> dict[str, bytes]:
    """Residual acceleration and dynamic factor over nu, as svg and png."""
    asked = spec.spectrum
    nu = np.linspace(asked.least, asked.most, asked.points)
    with drawing.style():
        figure = drawing.figure(8.6, 6.4)
        upper, lower = figure.subplots(2, 1, sharex=True)
        for i, cam in enumerate(cams):
            found = response_spectrum(cam.law, nu, asked.damping)
            look: dict[str, Any] = {"color": _COLOURS[i % len(_COLOURS)], "linestyle": _STROKES[i % len(_STROKES)]}
            C = cam.reference.constants.C.value
            drawing.draw_spectrum(found, upper, over=C, label=cam.name, **look)
            drawing.draw_spectrum(found, lower, what="peak", over=C, **look)
        for axes in (upper, lower):
            axes.axvline(spec.nu, color=drawing.GREY, linewidth=0.8, zorder=1)
        upper.set(xlabel="", xlim=(asked.least, asked.most), ylim=(0.0, None), ylabel="residual acceleration / C")
        lower.set(ylim=(0.0, None), ylabel="dynamic factor max |a''| / C")
        figure.suptitle(
            f"Response spectra, damping ratio {asked.damping:g}; design at nu = {spec.nu:g}",
            x=0.01,
            ha="left",
            fontsize=11.0,
        )
        figure.legend(loc="outside lower center", ncols=3)
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}
