"""Siemens S7-1500T: points and elements of the library LCamHdl, which fill the technology object TO_Cam."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from optlaws.exports.format import Request, Written, file_format
from optlaws.exports.polynomial_pieces import Ends, Fitted, ends_of, fields, iec_heading, polynomials_for, refuse_jumps
from optlaws.exports.text import iec_name
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numerics.splines import hermite_powers

SEGMENTS = 50
POINTS = SEGMENTS + 1
_REMEDY = "take siemens-elements, whose elements have ends of their own, or a smoother law"
#: codes of LCamHdl_ProfileConstants; an element of each takes one segment of the TO
DWELL, CONST_VELO, POLY_5, ADD_POLY = 2, 3, 5, 44
START_JERK = 1  # LCAMHDL_POLY_MODE_BOUNDARY_VALUES_AND_START_JERK


@file_format(
    "siemens-elements",
    target="Siemens S7-1500T, LCamHdl_typeAdvancedElement of LCamHdl_CreateCamAdvanced",
    contents="leading and following values, geoVelo and geoAccel at both ends (LREAL), camProfileType",
    model="quintic polynomials, straight lines, dwells",
    limits=f"at most {SEGMENTS} segments in a TO_Cam; degree 5 (POLY_7 takes two segments of degree 6: not used)",
    extension=".st",
)
def _write_elements(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "SIMATIC AX")
    fit = polynomials_for(motion, request, 5, SEGMENTS)
    ends = ends_of(motion, fit.run, 3)
    rows = [
        fields(**_bounds(end), camProfileType=_profile(row))
        for end, row in zip(ends, fit.run.coefficients, strict=True)
    ]
    run = PiecewiseMotion(fit.run.breaks, [_quintic(end) for end in ends])
    text, notes = _configuration(name, "LCamHdl_typeAdvancedElement", rows, motion, (run, fit))
    return Written(text, run, "quintic polynomials by their ends", len(rows), "segments", notes=notes)


@file_format(
    "siemens-polynomials",
    target="Siemens S7-1500T, LCamHdl_typePolynomialElement of LCamHdl_AddCamPolynomial",
    contents="leading and following values, geoVelo and geoAccel at both ends, geoJerkStart (LREAL), polynomialMode 1",
    model="exact polynomials of degree 6",
    limits=f"at most {SEGMENTS} segments in a TO_Cam, degree 6",
    extension=".st",
)
def _write_polynomials(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "SIMATIC AX")
    fit = polynomials_for(motion, request, 6, SEGMENTS)
    ends = ends_of(motion, fit.run, 4)
    rows = [
        fields(**_bounds(end), geoJerkStart=end.first[3], camProfileType=ADD_POLY, polynomialMode=START_JERK)
        for end in ends
    ]
    run = PiecewiseMotion(fit.run.breaks, [_sixth(end) for end in ends])
    text, notes = _configuration(name, "LCamHdl_typePolynomialElement", rows, motion, (run, fit))
    return Written(
        text, run, "polynomials of degree 6 by their ends and start jerk", len(rows), "segments", notes=notes
    )


def _bounds(ends: Ends) -> dict[str, object]:
    """The fields that elements of all kinds have."""
    return {
        "leadingValueStart": ends.x[0],
        "leadingValueEnd": ends.x[1],
        "followingValueStart": ends.first[0],
        "followingValueEnd": ends.last[0],
        "geoVeloStart": ends.first[1],
        "geoVeloEnd": ends.last[1],
        "geoAccelStart": ends.first[2],
        "geoAccelEnd": ends.last[2],
    }


def _profile(row: Sequence[float]) -> int:
    degree = max((n for n, c in enumerate(row) if c), default=0)
    return POLY_5 if degree > 1 else (DWELL, CONST_VELO)[degree]


def _quintic(ends: Ends) -> list[float]:
    """The quintic with the values of both ends."""
    return list(hermite_powers(np.array(ends.x), np.array([ends.first[:3], ends.last[:3]]).T)[0].tolist())


def _sixth(ends: Ends) -> list[float]:
    """The quintic through the end values plus a multiple of u³ (1 - u)³ that matches the jerk at the start."""
    quintic, length = _quintic(ends), ends.x[1] - ends.x[0]
    share = ends.first[3] / 6.0 - quintic[3]
    bump = {3: share, 4: -3.0 * share / length, 5: 3.0 * share / length**2, 6: -share / length**3}
    return [c + bump.get(n, 0.0) for n, c in enumerate([*quintic, 0.0])]


@file_format(
    "siemens-points",
    target="Siemens S7-1500T, LCamHdl_typeBasicPoint of LCamHdl_CreateCamBasic",
    contents="leadingValue, followingValue, velocityRatio, accelerationRatio (LREAL)",
    model="quintic polynomials",
    limits=f"at most {POINTS} points, which make the {SEGMENTS} segments of a TO_Cam",
    extension=".st",
)
def _write_points(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "SIMATIC AX")
    fit = polynomials_for(motion, request, 5, SEGMENTS, points=True)
    refuse_jumps(motion, fit.run, "a basic point", _REMEDY)
    ends = ends_of(motion, fit.run, 3)
    values = np.array([*(end.first for end in ends), ends[-1].last]).T
    run = PiecewiseMotion(fit.run.breaks, hermite_powers(np.array(fit.run.breaks), values))
    rows = [
        fields(leadingValue=x, followingValue=y, velocityRatio=v, accelerationRatio=a)
        for x, (y, v, a) in zip(run.breaks, values.T.tolist(), strict=True)
    ]
    text, notes = _configuration(name, "LCamHdl_typeBasicPoint", rows, motion, (run, fit))
    return Written(text, run, "quintic polynomials between points", len(rows), notes=notes)


def _configuration(
    name: str, kind: str, rows: Sequence[str], motion: Motion, run_and_fit: tuple[PiecewiseMotion, Fitted]
) -> tuple[str, tuple[str, ...]]:
    """The text of a configuration, and its notes."""
    run, fit = run_and_fit
    notes = (fit.in_words(motion.units.slave), f"{fit.count} of the {SEGMENTS} segments of the TO")
    lines = [
        iec_heading(f"{name}: a cam for LCamHdl and a TO_Cam of the S7-1500T, {kind}", motion, run, notes)
        + "USING Simatic.Ax.LCamHdl;",
        f"CONFIGURATION {name}_configuration",
        "    VAR_GLOBAL",
        f"        {name} : ARRAY[1..{len(rows)}] OF {kind} := [",
        ",\n".join(f"            ({row})" for row in rows),
        "        ];",
        "    END_VAR",
        "END_CONFIGURATION",
        "",
    ]
    return "\n".join(lines), notes
