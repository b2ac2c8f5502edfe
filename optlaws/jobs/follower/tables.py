"""Tables of the job "follower"."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from optlaws.files import tables, writing
from optlaws.laws import PolynomialLaw
from optlaws.mechanisms.follower.follower import Follower
from optlaws.mechanisms.follower.off_design import Deviation, off_design

if TYPE_CHECKING:
    from optlaws.jobs.follower.follower import Cam, Run, Study

COEFFICIENTS = ("cam", "i", "Q_i of the mass", "q_i of the cam")
CAMS = ("cam", "B", "k of B", "C", "k of C", "c(0)", "c(1)", "B of the mass law", "C of the mass law")
OFF_DESIGN = (
    "cam", "damping", "change", "deviation of nu, %", "nu", "n", "C of the mass law", "C of the mass", "k",
    "dynamic factor", "C in the dwell", "residual displacement", "residual acceleration",
)  # fmt: skip


def texts(spec: Study, cams: Mapping[str, Cam], about: str) -> dict[str, str]:
    """Every table of the study as CSV, and the page that shows them, by file name."""
    runs = [(one, _deviations(spec, cams[one.cam], one)) for one in spec.off_design]
    return {
        "coefficients.csv": tables.to_csv(COEFFICIENTS, _coefficients(cams), about=about),
        "cams.csv": tables.to_csv(CAMS, [_peaks(one) for one in cams.values()], about=about),
        "off_design.csv": tables.to_csv(OFF_DESIGN, [_line(*pair) for pair in _pairs(runs)], about=about),
        "follower.md": _markdown(spec, cams, runs),
    }


Runs = list[tuple["Run", tuple[Deviation, ...]]]


def _deviations(spec: Study, cam: Cam, run: Run) -> tuple[Deviation, ...]:
    design = Follower(spec.nu, run.damping)
    return off_design(cam.law, cam.reference, design, deviations=spec.deviations, change=run.change)


def _pairs(runs: Runs) -> list[tuple[Run, Deviation]]:
    return [(run, one) for run, found in runs for one in found]


def _line(run: Run, one: Deviation) -> list[tables.Cell]:
    response, peak = one.response, one.peak
    return [
        run.cam,
        run.damping,
        run.change,
        one.percent,
        response.nu,
        response.nu * response.damping,
        one.reference.constants.C.value,
        peak.value,
        round(peak.k, 6),
        one.dynamic_factor,
        _rounding_is_zero(response.dwell_peak(2).value),
        _rounding_is_zero(response.residual_displacement),
        _rounding_is_zero(response.residual_acceleration),
    ]


def _rounding_is_zero(value: float) -> float:
    # what is left at the design is rounding, and differs between machines
    return 0.0 if abs(value) < 1e-9 else value


def _coefficients(cams: Mapping[str, Cam]) -> list[list[tables.Cell]]:
    rows: list[list[tables.Cell]] = []
    for one in cams.values():
        if isinstance(one.law, PolynomialLaw) and isinstance(one.reference, PolynomialLaw):
            pairs = zip(one.reference.to_powers(), one.law.to_powers(), strict=True)
            rows += [[one.name, i, _rounding_is_zero(Q), _rounding_is_zero(q)] for i, (Q, q) in enumerate(pairs)]
    return rows


def _peaks(one: Cam) -> list[tables.Cell]:
    cam, mass = one.law.constants, one.reference.constants
    ends = [_rounding_is_zero(value) for value in one.law.c([0.0, 1.0]).tolist()]
    return [
        one.name,
        cam.B.value,
        round(cam.B.k, 6),
        cam.C.value,
        round(cam.C.k, 6),
        *ends,
        mass.B.value,
        mass.C.value,
    ]


def _markdown(spec: Study, cams: Mapping[str, Cam], runs: Runs) -> str:
    heads = ["cam", "damping", "change", *(f"{percent:+g} %" if percent else "0 %" for percent in spec.deviations)]

    def table(values: Mapping[str, list[list[float]]]) -> list[str]:
        lines = []
        for name, rows in values.items():
            cells: list[list[tables.Cell]] = [
                [run.cam, run.damping, run.change, *row] for (run, _), row in zip(runs, rows, strict=True)
            ]
            lines += [f"## {name}", "", tables.to_markdown(heads, cells, digits=6)]
        return lines

    off = table(
        {
            "Dynamic factor off design": [[one.dynamic_factor for one in found] for _, found in runs],
            "Residual acceleration off design": [
                [_rounding_is_zero(one.response.residual_acceleration) for one in found] for _, found in runs
            ],
        }
    )
    text = [f"# {spec.title}", "", f"<!-- {writing.MARK} -->", ""]
    if spec.text.strip():
        text += [spec.text.strip(), ""]
    return "\n".join(
        [
            *text,
            "![Accelerations of cam and mass](curves.svg)",
            "",
            "![Response spectra](spectrum.svg)",
            "",
            "## The cams",
            "",
            tables.to_markdown(CAMS, [_peaks(one) for one in cams.values()], digits=8),
            *off,
            "## Coefficients of the laws in powers of k",
            "",
            tables.to_markdown(COEFFICIENTS, _coefficients(cams), digits=8),
        ]
    )
