"""TwinCAT: tables of positions, and motion functions of points with polynomials of degree 5 and 7 between them."""

from __future__ import annotations

from functools import partial

import numpy as np

from optlaws.exports.format import MOST_POINTS, Request, Written, file_format
from optlaws.exports.point_tables import chosen_table, is_cyclic
from optlaws.exports.polynomial_pieces import Fitted, ends_of, iec_heading, jumping, polynomials_for, refuse_jumps
from optlaws.exports.text import fields, iec_comment, iec_name, real, st_records, table_heading
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numerics.splines import hermite_powers

INTERPOLATIONS = {"linear": "MC_INTERPOLATIONTYPE_LINEAR", "spline": "MC_INTERPOLATIONTYPE_SPLINE"}


@file_format(
    "twincat-table",
    target="TwinCAT NC, table of positions in MC_CAM_REF",
    contents="master, slave (LREAL)",
    model="C2 cubic spline, cyclic or tangential, or straight lines",
    limits="no number of points is stated",
    extension=".st",
    takes=("points", "counts", "interpolation"),
)
def _table(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "TwinCAT")
    interpolation = request.interpolation_among(INTERPOLATIONS, "spline")
    cyclic, kind = is_cyclic(motion), {"linear": "linear", "spline": "cubic"}[interpolation]
    table = chosen_table(motion, request, kind, MOST_POINTS, ends="periodic" if cyclic else "clamped")
    count, spline = len(table.x), f"C2 cubic spline, {'cyclic' if cyclic else 'tangential'}"
    entries = f"TableType := MC_TABLETYPE_NONEQUIDISTANT, NoOfRows := {count}, NoOfColumns := 2"
    rows = [f"        {real(x)}, {real(y)}" for x, y in zip(table.x, table.values[0], strict=True)]
    text = "\n".join(
        [
            iec_comment(table_heading(motion, "TwinCAT, table of positions")) + "VAR_GLOBAL",
            f"    {name}_table : ARRAY[1..{count}, 1..2] OF LREAL := [",
            ",\n".join(rows) + "];",
            f"    {name} : MC_CAM_REF := (ArraySize := SIZEOF({name}_table), {entries});",
            "END_VAR",
            f"(* in the program, before MC_CamTableSelect: {name}.pArray := ADR({name}_table);",
            f"   for MC_CamIn: Options.InterpolationType := {INTERPOLATIONS[interpolation]}; its default is linear *)",
            "",
        ]
    )
    return table.written(text, "straight lines" if interpolation == "linear" else spline)


DEGREE = 7
#: by the degree of the polynomial: names in MC_MotionFunctionType and in EMotionFunctionType
FUNCTIONS = {5: ("MOTIONFUNCTYPE_POLYNOM5_MM", "Polynomial5"), 7: ("MOTIONFUNCTYPE_POLYNOM7_MM", "Polynomial7")}
_REMEDY = "take a smoother law, or a format whose pieces have ends of their own, such as codesys-cambuilder"
_LAST = ("MOTIONFUNCTYPE_NOTDEF", "Undefined")
_NC2 = ("MasterPos", "SlavePos", "SlaveVelo", "SlaveAcc", "SlaveJerk")
_MC3 = ("MasterPosition", "SlavePosition", "SlaveVelocity", "SlaveAcceleration", "SlaveJerk")


def _motion_function(motion: Motion, request: Request, *, third: bool) -> Written:
    name = iec_name(request.name, "TwinCAT")
    fit = _shared(motion, request)
    degrees = [5 if len(row) <= 6 or not any(row[6:]) else 7 for row in fit.run.coefficients]
    ends = ends_of(motion, fit.run, 4)
    values = np.array([*(end.first for end in ends), ends[-1].last]).T
    by_degree = {n: hermite_powers(np.array(fit.run.breaks), values[: (n + 1) // 2]).tolist() for n in FUNCTIONS}
    run = PiecewiseMotion(fit.run.breaks, [by_degree[degree][i] for i, degree in enumerate(degrees)])
    rows = [
        _point(i + 1, (x, *values[:, i].tolist()), degree, third=third)
        for i, (x, degree) in enumerate(zip(fit.run.breaks, [*degrees, 0], strict=True))
    ]
    kind = "MotionFunctionPoint" if third else "MC_MotionFunctionPoint"
    notes = (fit.in_words(motion.units.slave),)
    heading = iec_heading(f"{name}: a motion function for TwinCAT, {kind}", motion, run, notes)
    text = "\n".join([f"{heading}VAR_GLOBAL", *st_records(name, kind, rows), "END_VAR", ""])
    model = "Hermite polynomials of degree 5 and 7" if 7 in degrees else "Hermite polynomials of degree 5"
    return Written(text, run, model, len(rows), notes=notes)


def _shared(motion: Motion, request: Request) -> Fitted:
    """Polynomials whose neighbours share a point's entries: velocity, acceleration, and the jerk where it is used."""
    fit = polynomials_for(motion, request, DEGREE, MOST_POINTS - 1, points=True)
    refuse_jumps(motion, fit.run, "a point of TwinCAT", _REMEDY)
    if fit.run.degree > 5 and jumping(fit.run, 3) is not None:
        return polynomials_for(motion, request, 5, MOST_POINTS - 1, points=True)
    return fit


def _point(place: int, numbers: tuple[float, ...], degree: int, *, third: bool) -> str:
    """A point from the master's position, y, V, A and J, and the degree of the polynomial after it, 0 at the end."""
    function = FUNCTIONS.get(degree, _LAST)[third]
    if third:
        return fields(FunctionType=f"EMotionFunctionType.{function}", **dict(zip(_MC3, numbers, strict=True)))
    return fields(
        PointIndex=place,
        FunctionType=function,
        PointType="MOTIONPOINTTYPE_MOTION",
        RelIndexNextPoint=1 if degree else 0,
        **dict(zip(_NC2, numbers, strict=True)),
    )


_points = partial(
    file_format,
    model="Hermite polynomials of degree 5 or 7, by FunctionType",
    limits="one velocity, acceleration and jerk at each point; pieces of degree 7 at most",
    extension=".st",
)
_points(
    "twincat-nc2",
    target="TwinCAT NC2 camming, motion function of MC_MotionFunctionPoint",
    contents="PointIndex, FunctionType, PointType, RelIndexNextPoint, MasterPos, SlavePos, SlaveVelo, SlaveAcc, "
    "SlaveJerk (LREAL)",
)(partial(_motion_function, third=False))
_points(
    "twincat-mc3",
    target="TwinCAT MC3 camming, MotionFunctionPoint",
    contents="FunctionType, MasterPosition, SlavePosition, SlaveVelocity, SlaveAcceleration, SlaveJerk (LREAL)",
)(partial(_motion_function, third=True))
