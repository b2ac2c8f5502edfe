"""Siemens S7-1500T: points and elements of the library LCamHdl, which fill the technology object TO_Cam."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from optlaws.exports.format import Request, Written, file_format
from optlaws.exports.polynomial_pieces import Ends, Fitted, ends_of, iec_heading, polynomials_for, refuse_jumps
from optlaws.exports.text import fields, iec_name, st_records
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numerics.splines import hermite_powers

SEGMENTS = 50
POINTS = SEGMENTS + 1
_REMEDY = "take siemens-elements, whose elements have ends of their own, or a smoother law"
#: codes of LCamHdl_ProfileConstants; an element of each takes one segment of the TO
DWELL, CONST_VELO, POLY_5, ADD_POLY = 2, 3, 5, 44
#: the mode is LCAMHDL_POLY_MODE_BOUNDARY_VALUES_AND_START_JERK
_BY_START_JERK = {"camProfileType": ADD_POLY, "polynomialMode": 1}


_siemens = partial(file_format, extension=".st")


def _elements(motion: Motion, request: Request, *, degree: int, kind: str, model: str) -> Written:
    name = iec_name(request.name, "SIMATIC AX")
    fit = polynomials_for(motion, request, degree, SEGMENTS)
    ends = ends_of(motion, fit.run, 3 if degree == 5 else 4)
    run = PiecewiseMotion(fit.run.breaks, [_quintic(end) if degree == 5 else _sixth(end) for end in ends])
    rows = [
        fields(**_bounds(end), **(_profile(row) if degree == 5 else {"geoJerkStart": end.first[3], **_BY_START_JERK}))
        for end, row in zip(ends, fit.run.coefficients, strict=True)
    ]
    text, notes = _configuration(name, kind, rows, motion, (run, fit))
    return Written(text, run, model, len(rows), "segments", notes=notes)


_siemens(
    "siemens-elements",
    target="Siemens S7-1500T, LCamHdl_typeAdvancedElement of LCamHdl_CreateCamAdvanced",
    contents="leading and following values, geoVelo and geoAccel at both ends (LREAL), camProfileType",
    model="quintic polynomials, straight lines, dwells",
    limits=f"at most {SEGMENTS} segments in a TO_Cam; degree 5 (POLY_7 takes two segments of degree 6: not used)",
)(partial(_elements, degree=5, kind="LCamHdl_typeAdvancedElement", model="quintic polynomials by their ends"))
_siemens(
    "siemens-polynomials",
    target="Siemens S7-1500T, LCamHdl_typePolynomialElement of LCamHdl_AddCamPolynomial",
    contents="leading and following values, geoVelo and geoAccel at both ends, geoJerkStart (LREAL), polynomialMode 1",
    model="exact polynomials of degree 6",
    limits=f"at most {SEGMENTS} segments in a TO_Cam, degree 6",
)(
    partial(
        _elements,
        degree=6,
        kind="LCamHdl_typePolynomialElement",
        model="polynomials of degree 6 by their ends and start jerk",
    )
)


def _bounds(ends: Ends) -> dict[str, object]:
    names = ("leadingValue", "followingValue", "geoVelo", "geoAccel")
    sides = zip(names, (ends.x[0], *ends.first), (ends.x[1], *ends.last), strict=False)
    return {
        f"{name}{side}": value for name, *values in sides for side, value in zip(("Start", "End"), values, strict=True)
    }


def _profile(row: Sequence[float]) -> dict[str, object]:
    degree = max((n for n, c in enumerate(row) if c), default=0)
    return {"camProfileType": POLY_5 if degree > 1 else (DWELL, CONST_VELO)[degree]}


def _quintic(ends: Ends) -> list[float]:
    """The quintic with the values of both ends."""
    return list(hermite_powers(np.array(ends.x), np.array([ends.first[:3], ends.last[:3]]).T)[0].tolist())


def _sixth(ends: Ends) -> list[float]:
    """The quintic through the end values plus a multiple of u³ (1 - u)³ that matches the jerk at the start."""
    quintic, length = _quintic(ends), ends.x[1] - ends.x[0]
    share = ends.first[3] / 6.0 - quintic[3]
    bump = {3: share, 4: -3.0 * share / length, 5: 3.0 * share / length**2, 6: -share / length**3}
    return [c + bump.get(n, 0.0) for n, c in enumerate([*quintic, 0.0])]


@_siemens(
    "siemens-points",
    target="Siemens S7-1500T, LCamHdl_typeBasicPoint of LCamHdl_CreateCamBasic",
    contents="leadingValue, followingValue, velocityRatio, accelerationRatio (LREAL)",
    model="quintic polynomials",
    limits=f"at most {POINTS} points, which make the {SEGMENTS} segments of a TO_Cam",
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
    run, fit = run_and_fit
    notes = (fit.in_words(motion.units.slave), f"{fit.count} of the {SEGMENTS} segments of the TO")
    heading = iec_heading(f"{name}: a cam for LCamHdl and a TO_Cam of the S7-1500T, {kind}", motion, run, notes)
    lines = [
        f"{heading}USING Simatic.Ax.LCamHdl;",
        f"CONFIGURATION {name}_configuration",
        "    VAR_GLOBAL",
        *st_records(name, kind, rows, "        "),
        "    END_VAR",
        "END_CONFIGURATION",
        "",
    ]
    return "\n".join(lines), notes
