"""Cams for an elastic follower, at and off their design, tabled and drawn (Savin's Fig. 4)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import msgspec
import numpy as np

from optlaws import (
    Deviation,
    Follower,
    MotionLaw,
    PolynomialLaw,
    catalogue,
    off_design,
    polydyne,
    response_spectrum,
    savin,
)
from optlaws.plots.machine import draw_spectrum
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, empty_figure, plot_style
from optlaws.results import Cell, Entries, Page, Results

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class CutCam(msgspec.Struct):
    """A cam: the law meant for the mass, and the damping ratio for which (1.27) corrects it, if it does."""

    name: str
    law: str
    alpha: float | None = None
    design_damping: float | None = None


class Run(msgspec.Struct):
    """A cam on followers whose frequency deviates."""

    cam: str
    damping: float
    change: Literal["speed", "stiffness"] = "speed"


class SpectrumPicture(msgspec.Struct, rename={"least": "from", "most": "to"}):
    """The figure of the response spectra."""

    cams: list[str]
    damping: float
    least: float
    most: float
    points: int


class CurvePicture(msgspec.Struct):
    """The figure of accelerations over time: cam, mass as designed, mass off its design."""

    cams: list[str]
    damping: float
    deviations: list[float]
    until: float


class Study(Entries):
    """The problem file."""

    frequency: float
    deviations: list[float]
    cam: list[CutCam]
    off_design: list[Run]
    spectrum: SpectrumPicture
    curves: CurvePicture


@dataclass(frozen=True)
class Cam:
    """A cam of the study: the law meant for the mass, and what is cut."""

    name: str
    reference: MotionLaw
    law: MotionLaw


Runs = list[tuple[Run, tuple[Deviation, ...]]]


def run(results: Results) -> None:
    """Table what the mass does under every cam at and off its design, and draw accelerations and spectra."""
    spec = results.read(Study)
    cams = {entry.name: _cam(entry, spec.frequency) for entry in spec.cam}
    runs = [(entry, _deviations(spec, cams[entry.cam], entry)) for entry in spec.off_design]
    rows = [_line(entry, deviation) for entry, deviations in runs for deviation in deviations]
    results.table("coefficients", COEFFICIENTS, _coefficients(cams))
    results.table("cams", CAMS, [_peaks(cam) for cam in cams.values()])
    results.table("off_design", OFF_DESIGN, rows)
    _fill(results.page("follower").text(spec.text), spec, cams, runs)
    results.picture("spectrum", spectrum(spec, [cams[name] for name in spec.spectrum.cams]))
    results.picture("curves", curves(spec, [cams[name] for name in spec.curves.cams]))
    corrected = {entry.name: entry.design_damping for entry in spec.cam}
    for entry, deviations in runs:
        as_designed = next(deviation for deviation in deviations if deviation.percent == 0.0)
        if corrected[entry.cam] == entry.damping:
            assert abs(as_designed.dynamic_factor - 1.0) < 1e-9, entry
            assert as_designed.response.residual_acceleration < 1e-9, entry


def _cam(entry: CutCam, frequency: float) -> Cam:
    reference = catalogue[entry.law].law if entry.alpha is None else savin(entry.law, entry.alpha)
    law = reference if entry.design_damping is None else polydyne(reference, frequency, entry.design_damping)
    return Cam(entry.name, reference, law)


COEFFICIENTS = ("cam", "i", "Q_i of the mass", "q_i of the cam")
CAMS = ("cam", "B", "k of B", "C", "k of C", "c(0)", "c(1)", "B of the mass law", "C of the mass law")
OFF_DESIGN = (
    "cam", "damping", "change", "deviation of nu, %", "nu", "n", "C of the mass law", "C of the mass", "k",
    "dynamic factor", "C in the dwell", "residual displacement", "residual acceleration",
)  # fmt: skip


def _deviations(spec: Study, cam: Cam, run: Run) -> tuple[Deviation, ...]:
    design = Follower(spec.frequency, run.damping)
    return off_design(cam.law, cam.reference, design, deviations=spec.deviations, change=run.change)


def _line(run: Run, deviation: Deviation) -> list[Cell]:
    response, peak = deviation.response, deviation.peak
    return [
        run.cam,
        run.damping,
        run.change,
        deviation.percent,
        response.frequency,
        response.frequency * response.damping,
        deviation.reference.constants.C.value,
        peak.value,
        round(peak.k, 6),
        deviation.dynamic_factor,
        _rounding_is_zero(response.dwell_peak(2).value),
        _rounding_is_zero(response.residual_displacement),
        _rounding_is_zero(response.residual_acceleration),
    ]


def _rounding_is_zero(value: float) -> float:
    # what is left at the design is rounding, and differs between machines
    return 0.0 if abs(value) < 1e-9 else value


def _coefficients(cams: Mapping[str, Cam]) -> list[list[Cell]]:
    rows: list[list[Cell]] = []
    for cam in cams.values():
        if isinstance(cam.law, PolynomialLaw) and isinstance(cam.reference, PolynomialLaw):
            pairs = zip(cam.reference.to_powers(), cam.law.to_powers(), strict=True)
            rows += [[cam.name, i, _rounding_is_zero(Q), _rounding_is_zero(q)] for i, (Q, q) in enumerate(pairs)]
    return rows


def _peaks(follower_cam: Cam) -> list[Cell]:
    cam, mass = follower_cam.law.constants, follower_cam.reference.constants
    ends = [_rounding_is_zero(value) for value in follower_cam.law.c([0.0, 1.0]).tolist()]
    return [
        follower_cam.name,
        cam.B.value,
        round(cam.B.k, 6),
        cam.C.value,
        round(cam.C.k, 6),
        *ends,
        mass.B.value,
        mass.C.value,
    ]


def _fill(page: Page, spec: Study, cams: Mapping[str, Cam], runs: Runs) -> None:
    heads = ["cam", "damping", "change", *(f"{percent:+g} %" if percent else "0 %" for percent in spec.deviations)]
    off = {
        "Dynamic factor off design": [[deviation.dynamic_factor for deviation in deviations] for _, deviations in runs],
        "Residual acceleration off design": [
            [_rounding_is_zero(deviation.response.residual_acceleration) for deviation in deviations]
            for _, deviations in runs
        ],
    }
    page.figure("curves", "Accelerations of cam and mass").figure("spectrum", "Response spectra")
    page.heading("The cams").table(CAMS, [_peaks(cam) for cam in cams.values()], digits=8)
    for title, values in off.items():
        lines: list[list[Cell]] = [
            [run.cam, run.damping, run.change, *row] for (run, _), row in zip(runs, values, strict=True)
        ]
        page.heading(title).table(heads, lines, digits=6)
    page.heading("Coefficients of the laws in powers of k").table(COEFFICIENTS, _coefficients(cams), digits=8)


_POINTS = 801
_STROKES: tuple[Any, ...] = ("-", "--", "-.", (0, (1, 1)), (0, (5, 1)))
_COLOURS = (BLUES[4], WARM, GREEN, BLUES[1], GREY)
_OFF = (WARM, GREEN, BLUES[1])


def curves(spec: Study, cams: Sequence[Cam]) -> Figure:
    """Acceleration of cam and mass over k, one panel for each cam."""
    shown = spec.curves
    k = np.linspace(0.0, shown.until, _POINTS)
    rise = k[k <= 1.0]
    with plot_style():
        figure = empty_figure(8.6, 3.1 * len(cams) + 0.9)
        panels = figure.subplots(len(cams), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        for axes, cam in zip(panels, cams, strict=True):
            axes.plot(rise, cam.law.c(rise), color=GREY, linestyle="--", label="cam")
            exact = Follower(spec.frequency, shown.damping).response(cam.law)
            axes.plot(k, exact.c(k), color=BLUES[4], label=f"mass, nu = {spec.frequency:g}", zorder=4)
            for percent, colour in zip(shown.deviations, _OFF, strict=False):
                frequency = spec.frequency * (1.0 + percent / 100.0)
                response = Follower(frequency, shown.damping).response(cam.law)
                axes.plot(
                    k, response.c(k), color=colour, linewidth=1.2, label=f"mass, nu = {frequency:g} ({percent:+g} %)"
                )
            axes.axvline(1.0, color=GREY, linewidth=0.8)
            axes.set_title(cam.name)
            axes.set_ylabel("acceleration a''")
        panels[-1].set_xlabel("time k, in durations of the rise (dwell from 1 on)")
        panels[-1].set_xlim(0.0, shown.until)
        figure.suptitle(
            f"Accelerations of cam and mass, damping ratio {shown.damping:g}", x=0.01, ha="left", fontsize=11.0
        )
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
        return figure


def spectrum(spec: Study, cams: Sequence[Cam]) -> Figure:
    """Residual acceleration and dynamic factor over the frequency."""
    shown = spec.spectrum
    frequencies = np.linspace(shown.least, shown.most, shown.points)
    with plot_style():
        figure = empty_figure(8.6, 6.4)
        upper, lower = figure.subplots(2, 1, sharex=True)
        for i, cam in enumerate(cams):
            response = response_spectrum(cam.law, frequencies, shown.damping)
            look: dict[str, Any] = {"color": _COLOURS[i % len(_COLOURS)], "linestyle": _STROKES[i % len(_STROKES)]}
            C = cam.reference.constants.C.value
            draw_spectrum(response, upper, over=C, label=cam.name, **look)
            draw_spectrum(response, lower, what="peak", over=C, **look)
        for axes in (upper, lower):
            axes.axvline(spec.frequency, color=GREY, linewidth=0.8, zorder=1)
        upper.set(xlabel="", xlim=(shown.least, shown.most), ylim=(0.0, None), ylabel="residual acceleration / C")
        lower.set(
            xlabel="nu, radians of the free vibration in the rise",
            ylim=(0.0, None),
            ylabel="dynamic factor max |a''| / C",
        )
        figure.suptitle(
            f"Response spectra, damping ratio {shown.damping:g}; design at nu = {spec.frequency:g}",
            x=0.01,
            ha="left",
            fontsize=11.0,
        )
        figure.legend(loc="outside lower center", ncols=3)
        return figure


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
