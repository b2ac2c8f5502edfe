"""The job "follower": cams for an elastic follower, at and off their design, tabled and drawn (Savin's Fig. 4)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.pages.page import Page
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.savin.family import FAMILIES
from optlaws.laws.savin.savin import savin
from optlaws.mechanisms.cam.polydyne import polydyne
from optlaws.mechanisms.follower.follower import Follower
from optlaws.mechanisms.follower.off_design import Deviation, off_design
from optlaws.mechanisms.spectrum.spectrum import response_spectrum
from optlaws.studies.points.problem_entries import Positive
from optlaws.suggest import unknown_key

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Ratio = Annotated[float, msgspec.Meta(ge=0.0, le=10.0)]
Vibrating = Annotated[float, msgspec.Meta(ge=0.0, lt=1.0)]
Percent = Annotated[float, msgspec.Meta(gt=-100.0, le=1000.0)]
Some = msgspec.Meta(min_length=1)


class AskedCam(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A cam: the law meant for the mass, and the damping ratio for which (1.27) corrects it, if it does."""

    name: Text
    law: Text
    alpha: float | None = None
    design_damping: Ratio | None = None


class Run(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A cam on followers whose nu deviates."""

    cam: Text
    damping: Ratio
    change: Literal["speed", "stiffness"] = "speed"


class SpectrumPicture(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The figure of the response spectra."""

    cams: Annotated[list[Text], Some]
    damping: Vibrating
    least: Positive = msgspec.field(name="from")
    most: Positive = msgspec.field(name="to")
    points: Annotated[int, msgspec.Meta(ge=2, le=100_000)] = 1000


class CurvePicture(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The figure of accelerations over time: cam, mass as designed, mass off its design."""

    cams: Annotated[list[Text], msgspec.Meta(min_length=1, max_length=4)]
    damping: Ratio
    deviations: Annotated[list[Percent], msgspec.Meta(min_length=1, max_length=3)]
    until: Annotated[float, msgspec.Meta(ge=1.0, le=10.0)] = 1.5


class Study(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    nu: Positive
    deviations: Annotated[list[Percent], Some]
    cam: Annotated[list[AskedCam], Some]
    off_design: Annotated[list[Run], Some]
    spectrum: SpectrumPicture
    curves: CurvePicture
    text: str = ""


@dataclass(frozen=True)
class Cam:
    """A cam of the study.

    Parameters
    ----------
    name
        What the file calls it.
    reference
        The law meant for the mass.
    design_damping
        Damping ratio for which it is corrected, None if it is not.
    law
        What is cut.
    """

    name: str
    reference: MotionLaw
    design_damping: float | None
    law: MotionLaw


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Study, file)
    cams = {entry.name: _cam(entry, spec.nu) for entry in spec.cam}
    if len(cams) != len(spec.cam):
        raise InputError("cam: names must differ")
    for name in [*(run.cam for run in spec.off_design), *spec.spectrum.cams, *spec.curves.cams]:
        if name not in cams:
            raise InputError(unknown_key(name, cams, "cam"))
    if spec.spectrum.least >= spec.spectrum.most:
        raise InputError(f"spectrum: from must be below to, got {spec.spectrum.least:g} and {spec.spectrum.most:g}")
    about = f"{spec.title}; from {file.name}"
    written = [writing.write(out / name, text) for name, text in texts(spec, cams, about).items()]
    figures = {
        "spectrum": spectrum(spec, [cams[name] for name in spec.spectrum.cams]),
        "curves": curves(spec, [cams[name] for name in spec.curves.cams]),
    }
    return written + drawing.save_pictures(figures, out)


def _cam(asked: AskedCam, nu: float) -> Cam:
    try:
        reference = _law(asked)
        cut = reference if asked.design_damping is None else polydyne(reference, nu, asked.design_damping)
    except InputError as error:
        raise InputError(f"cam {asked.name}: {error}") from None
    return Cam(asked.name, reference, asked.design_damping, cut)


def _law(asked: AskedCam) -> MotionLaw:
    if (asked.law in FAMILIES) != (asked.alpha is not None):
        raise InputError(f"the laws {', '.join(FAMILIES)} need an alpha, and no other takes one")
    return catalogue[asked.law].law if asked.alpha is None else savin(asked.law, asked.alpha)


COEFFICIENTS = ("cam", "i", "Q_i of the mass", "q_i of the cam")
CAMS = ("cam", "B", "k of B", "C", "k of C", "c(0)", "c(1)", "B of the mass law", "C of the mass law")
OFF_DESIGN = (
    "cam", "damping", "change", "deviation of nu, %", "nu", "n", "C of the mass law", "C of the mass", "k",
    "dynamic factor", "C in the dwell", "residual displacement", "residual acceleration",
)  # fmt: skip


def texts(spec: Study, cams: Mapping[str, Cam], about: str) -> dict[str, str]:
    """Every table of the study as CSV, and the page that shows them, by file name."""
    runs = [(entry, _deviations(spec, cams[entry.cam], entry)) for entry in spec.off_design]
    return {
        "coefficients.csv": tables.to_csv(COEFFICIENTS, _coefficients(cams), about=about),
        "cams.csv": tables.to_csv(CAMS, [_peaks(cam) for cam in cams.values()], about=about),
        "off_design.csv": tables.to_csv(OFF_DESIGN, [_line(*pair) for pair in _pairs(runs)], about=about),
        "follower.md": str(_page(spec, cams, runs)),
    }


Runs = list[tuple["Run", tuple[Deviation, ...]]]


def _deviations(spec: Study, cam: Cam, run: Run) -> tuple[Deviation, ...]:
    design = Follower(spec.nu, run.damping)
    return off_design(cam.law, cam.reference, design, deviations=spec.deviations, change=run.change)


def _pairs(runs: Runs) -> list[tuple[Run, Deviation]]:
    return [(run, deviation) for run, deviations in runs for deviation in deviations]


def _line(run: Run, deviation: Deviation) -> list[tables.Cell]:
    response, peak = deviation.response, deviation.peak
    return [
        run.cam,
        run.damping,
        run.change,
        deviation.percent,
        response.nu,
        response.nu * response.damping,
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


def _coefficients(cams: Mapping[str, Cam]) -> list[list[tables.Cell]]:
    rows: list[list[tables.Cell]] = []
    for cam in cams.values():
        if isinstance(cam.law, PolynomialLaw) and isinstance(cam.reference, PolynomialLaw):
            pairs = zip(cam.reference.to_powers(), cam.law.to_powers(), strict=True)
            rows += [[cam.name, i, _rounding_is_zero(Q), _rounding_is_zero(q)] for i, (Q, q) in enumerate(pairs)]
    return rows


def _peaks(follower_cam: Cam) -> list[tables.Cell]:
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


def _page(spec: Study, cams: Mapping[str, Cam], runs: Runs) -> Page:
    heads = ["cam", "damping", "change", *(f"{percent:+g} %" if percent else "0 %" for percent in spec.deviations)]
    off = {
        "Dynamic factor off design": [[deviation.dynamic_factor for deviation in deviations] for _, deviations in runs],
        "Residual acceleration off design": [
            [_rounding_is_zero(deviation.response.residual_acceleration) for deviation in deviations]
            for _, deviations in runs
        ],
    }
    page = Page(spec.title).text(spec.text)
    page.figure("curves", "Accelerations of cam and mass").figure("spectrum", "Response spectra")
    page.heading("The cams").table(CAMS, [_peaks(cam) for cam in cams.values()], digits=8)
    for title, values in off.items():
        lines: list[list[tables.Cell]] = [
            [run.cam, run.damping, run.change, *row] for (run, _), row in zip(runs, values, strict=True)
        ]
        page.heading(title).table(heads, lines, digits=6)
    return page.heading("Coefficients of the laws in powers of k").table(COEFFICIENTS, _coefficients(cams), digits=8)


_POINTS = 801
_STROKES: tuple[Any, ...] = ("-", "--", "-.", (0, (1, 1)), (0, (5, 1)))
_COLOURS = (drawing.BLUES[4], drawing.WARM, drawing.GREEN, drawing.BLUES[1], drawing.GREY)
_OFF = (drawing.WARM, drawing.GREEN, drawing.BLUES[1])


def curves(spec: Study, cams: Sequence[Cam]) -> Figure:
    """Acceleration of cam and mass over k, one panel for each cam."""
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
        return figure


def spectrum(spec: Study, cams: Sequence[Cam]) -> Figure:
    """Residual acceleration and dynamic factor over nu."""
    asked = spec.spectrum
    nu = np.linspace(asked.least, asked.most, asked.points)
    with drawing.style():
        figure = drawing.figure(8.6, 6.4)
        upper, lower = figure.subplots(2, 1, sharex=True)
        for i, cam in enumerate(cams):
            response = response_spectrum(cam.law, nu, asked.damping)
            look: dict[str, Any] = {"color": _COLOURS[i % len(_COLOURS)], "linestyle": _STROKES[i % len(_STROKES)]}
            C = cam.reference.constants.C.value
            drawing.draw_spectrum(response, upper, over=C, label=cam.name, **look)
            drawing.draw_spectrum(response, lower, what="peak", over=C, **look)
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
        return figure
