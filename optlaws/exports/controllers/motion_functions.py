"""TwinCAT motion functions: points with boundary values, between which polynomials of degree 5 and 7 run."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from optlaws.exports.controllers.polynomials_of import (
    ends_of,
    fields,
    iec_heading,
    leaping,
    polynomials_for,
    refuse_leaps,
)
from optlaws.exports.format import MOST_POINTS, Format, Request, Written, register
from optlaws.exports.identifiers import iec_name
from optlaws.exports.interpolation import hermite_powers
from optlaws.exports.pieces.fitting import Fitted
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion

DEGREE = 7
#: by the degree of the polynomial: names in MC_MotionFunctionType and in EMotionFunctionType
FUNCTIONS = {5: ("MOTIONFUNCTYPE_POLYNOM5_MM", "Polynomial5"), 7: ("MOTIONFUNCTYPE_POLYNOM7_MM", "Polynomial7")}
_REMEDY = "take a smoother law, or a format whose pieces have ends of their own, such as codesys-cambuilder"
_LAST = ("MOTIONFUNCTYPE_NOTDEF", "Undefined")


def _write(motion: Motion, request: Request, *, third: bool) -> Written:
    name = iec_name(request.name, "TwinCAT")
    fit = _shared(motion, request)
    degrees = [5 if len(row) <= 6 or not any(row[6:]) else 7 for row in fit.run.coefficients]
    ends = ends_of(motion, fit.run, 4)
    values = np.array([*(end.first for end in ends), ends[-1].last]).T
    run = _run(fit.run.breaks, values, degrees)
    rows = [
        (_of_mc3 if third else _of_nc2)(i, x, values[:, i].tolist(), degree)
        for i, (x, degree) in enumerate(zip(fit.run.breaks, [*degrees, 0], strict=True))
    ]
    kind = "MotionFunctionPoint" if third else "MC_MotionFunctionPoint"
    notes = (fit.in_words(motion.units.slave),)
    text = "\n".join(
        [
            iec_heading(f"{name}: a motion function for TwinCAT, {kind}", motion, run, notes) + "VAR_GLOBAL",
            f"    {name} : ARRAY[1..{len(rows)}] OF {kind} := [",
            ",\n".join(f"        ({row})" for row in rows),
            "    ];",
            "END_VAR",
            "",
        ]
    )
    model = "Hermite polynomials of degree 5 and 7" if 7 in degrees else "Hermite polynomials of degree 5"
    return Written(text, run, model, len(rows), notes=notes)


def _shared(motion: Motion, request: Request) -> Fitted:
    """Polynomials whose neighbours share what a point holds: velocity and acceleration, and the jerk where one is used.

    Raises
    ------
    InputError
        If velocity or acceleration leap, for a point holds one value of each.
    """
    fit = polynomials_for(motion, request, DEGREE, MOST_POINTS - 1, points=True)
    refuse_leaps(motion, fit.run, "a point of TwinCAT", _REMEDY)
    if fit.run.degree > 5 and leaping(fit.run, 3) is not None:
        return polynomials_for(motion, request, 5, MOST_POINTS - 1, points=True)
    return fit


def _run(breaks: tuple[float, ...], values: NDArray[np.float64], degrees: list[int]) -> PiecewiseMotion:
    x = np.array(breaks)
    five, seven = hermite_powers(x, values[:3]), hermite_powers(x, values)
    rows = [five[i].tolist() if degree == 5 else seven[i].tolist() for i, degree in enumerate(degrees)]
    return PiecewiseMotion(breaks, rows)


def _of_nc2(place: int, x: float, values: list[float], degree: int) -> str:
    function = FUNCTIONS[degree][0] if degree else _LAST[0]
    y, v, a, j = values
    return fields(
        PointIndex=place + 1,
        FunctionType=function,
        PointType="MOTIONPOINTTYPE_MOTION",
        RelIndexNextPoint=1 if degree else 0,
        MasterPos=x,
        SlavePos=y,
        SlaveVelo=v,
        SlaveAcc=a,
        SlaveJerk=j,
    )


def _of_mc3(place: int, x: float, values: list[float], degree: int) -> str:  # noqa: ARG001 - as the other
    function = FUNCTIONS[degree][1] if degree else _LAST[1]
    y, v, a, j = values
    return fields(
        FunctionType=f"EMotionFunctionType.{function}",
        MasterPosition=x,
        SlavePosition=y,
        SlaveVelocity=v,
        SlaveAcceleration=a,
        SlaveJerk=j,
    )


def _write_nc2(motion: Motion, request: Request) -> Written:
    return _write(motion, request, third=False)


def _write_mc3(motion: Motion, request: Request) -> Written:
    return _write(motion, request, third=True)


LIMITS = "one velocity, acceleration and jerk at each point; pieces of degree 7 at most"
NC2 = register(
    Format(
        name="twincat-nc2",
        target="TwinCAT NC2 camming, motion function of MC_MotionFunctionPoint",
        contents="PointIndex, FunctionType, PointType, RelIndexNextPoint, MasterPos, SlavePos, SlaveVelo, SlaveAcc, "
        "SlaveJerk (LREAL)",
        model="Hermite polynomials of degree 5 or 7, by FunctionType",
        limits=LIMITS,
        extension=".st",
        write=_write_nc2,
    )
)
MC3 = register(
    Format(
        name="twincat-mc3",
        target="TwinCAT MC3 camming, MotionFunctionPoint",
        contents="FunctionType, MasterPosition, SlavePosition, SlaveVelocity, SlaveAcceleration, SlaveJerk (LREAL)",
        model="Hermite polynomials of degree 5 or 7, by FunctionType",
        limits=LIMITS,
        extension=".st",
        write=_write_mc3,
    )
)
