"""Layouts of cam tables in the files of controllers by their fields, and the pieces of motion that these state."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.numbers import Array


@dataclass(frozen=True)
class FieldLayout:
    """Fields of the structure of a controller, by their contents.

    `fields` says what a field holds and its name: x, y, v, a, j of points; x0, y0, ... and x1, y1, ... of the ends of a
    piece; c0, c1, ... of powers counted from where a piece begins; "type" of what runs after a point.
    """

    name: str
    fields: str
    profiles: Mapping[str, str] | None = None  #: what numbers stand for in the field of the type

    @cached_property
    def roles(self) -> dict[str, str]:
        """Meanings of fields by their names in lower case."""
        pairs = (field.split("=") for field in self.fields.split())
        return {name.lower(): role for role, name in pairs}

    @cached_property
    def needed(self) -> frozenset[str]:
        """Names of the fields without which it is another layout."""
        optional = {"v", "a", "j", "j0", "type"}
        return frozenset(name for name, role in self.roles.items() if role not in optional)


_ENDS = (
    "x0=leadingValueStart x1=leadingValueEnd y0=followingValueStart y1=followingValueEnd v0=geoVeloStart "
    "v1=geoVeloEnd a0=geoAccelStart a1=geoAccelEnd"
)
#: numbers of MC_MotionFunctionType; its names are in the catalogue, apart from those of polynomials
_NC2 = {
    "0": "NOTDEF",
    "1": "POLYNOM1",
    "3": "POLYNOM3",
    "5": "POLYNOM5",
    "7": "POLYNOM7",
    "10": "SINUSLINIE",
    "11": "MODSINUSLINIE",
    "12": "BESTEHORN",
    "13": "BESCHLTRAPEZ",
    "15": "POLYNOM5_MM",
    "24": "POLYNOM7_MM",
}
#: numbers of EMotionFunctionType
_MC3 = {
    "0": "Undefined",
    "1": "Linear",
    "2": "Polynomial3",
    "3": "Polynomial5",
    "4": "Polynomial7",
    "8": "ModifiedSinusoid",
}
#: numbers of LCamHdl_ProfileConstants; the polynomial of all that is given has no name
_LCAMHDL = {"2": "DWELL", "3": "POLYNOM1", "4": "POLYNOM3", "5": "POLYNOM5", "44": ""}

LAYOUTS = (
    FieldLayout("CODESYS SMC_CAMXYVA", "x=dX y=dY v=dV a=dA"),
    FieldLayout(
        "CODESYS Poly7_Coeffs", "x0=x0 x1=x1 c0=a0 c1=a1 c2=a2 c3=a3 c4=a4 c5=a5 c6=a6 c7=a7",
    ),
    FieldLayout(
        "TwinCAT MC_MotionFunctionPoint",
        "x=MasterPos y=SlavePos v=SlaveVelo a=SlaveAcc j=SlaveJerk type=FunctionType",
        _NC2,
    ),
    FieldLayout(
        "TwinCAT MotionFunctionPoint",
        "x=MasterPosition y=SlavePosition v=SlaveVelocity a=SlaveAcceleration j=SlaveJerk type=FunctionType",
        _MC3,
    ),
    FieldLayout(
        "Siemens LCamHdl_typeBasicPoint", "x=leadingValue y=followingValue v=velocityRatio a=accelerationRatio",
    ),
    FieldLayout("Siemens LCamHdl elements", f"{_ENDS} j0=geoJerkStart type=camProfileType", _LCAMHDL),
    FieldLayout("Rockwell CAM", "x=Master y=Slave"),
    FieldLayout("B&R MC_CAMPROFILE_TYP", "c0=a c1=b c2=c c3=d c4=e c5=f c6=g x1=x"),
    FieldLayout(
        "ABB MC_PPROFILE", "x=master_position y=interpolation_point v=Velocity_ratio a=Acceleration_ratio",
    ),
    FieldLayout("ROS 2 JointTrajectory", "y=positions v=velocities a=accelerations x=time_from_start"),
)  # fmt: skip


_POLYNOMIAL = re.compile(r"POLY(?:NOM(?:IAL)?)?_?([1357])(?:_MM)?", re.IGNORECASE)
_DEGREES = {"linear": 1, "line": 1, "polyfive": 5}
#: profiles after the last point, which run nowhere
_NONE = ("notdef", "undefined", "nonextsegment")


class CurvePiece(NamedTuple):
    """A piece of a cam: where it begins and ends, and its positions over the distance from where it begins."""

    start: float
    stop: float
    position: Callable[[Array], Array]


def powers(start: float, stop: float, coefficients: Sequence[float]) -> CurvePiece:
    """The piece of ascending powers of the distance from where it begins.

    >>> powers(10.0, 12.0, [1.0, 0.0, 0.5]).position(np.array([0.0, 2.0])).tolist()
    [1.0, 3.0]
    """
    _check(start, stop)
    return CurvePiece(start, stop, np.polynomial.Polynomial(list(coefficients)))


def hermite(start: float, stop: float, first: Sequence[float], last: Sequence[float]) -> CurvePiece:
    """The polynomial with a position and derivatives by the master at each end, as many as are given there.

    >>> hermite(0.0, 2.0, [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]).position(np.array([1.0])).tolist()
    [0.5]
    """
    from scipy.interpolate import BPoly

    _check(start, stop)
    return CurvePiece(start, stop, BPoly.from_derivatives([0.0, stop - start], [list(first), list(last)]))


def of_profile(
    profile: str | None, places: tuple[float, float], first: Sequence[float], last: Sequence[float]
) -> CurvePiece:
    """The piece of a profile by its name, between two places with the position and its derivatives at each.

    It is a polynomial ("POLYNOM5_MM", "Polynomial5", "Linear"), or a law of the catalogue between two rests; None is
    the polynomial of all that is given.
    """
    (start, stop), known = places, (profile or "").lower()
    if profile is None or known in _NONE:
        return hermite(start, stop, first, last)
    polynomial = _POLYNOMIAL.fullmatch(profile)
    if polynomial or known in _DEGREES:
        degree = int(polynomial[1]) if polynomial else _DEGREES[known]
        orders = (degree + 1) // 2
        if min(len(first), len(last)) < orders:
            raise InputError(f"{profile} needs the position and {orders - 1} derivatives at both ends")
        return hermite(start, stop, first[:orders], last[:orders])
    if known == "dwell":
        return hermite(start, stop, first[:1], last[:1])
    try:
        law = catalogue[profile].law
    except InputError:
        raise InputError(f"there is no profile {shortened(profile)} that is known here") from None
    if any(first[1:2]) or any(last[1:2]):
        raise InputError(f"{profile} goes from rest to rest, and a velocity is given at an end: it is not known here")
    _check(start, stop)
    length = stop - start
    return CurvePiece(start, stop, lambda d: first[0] + (last[0] - first[0]) * law(np.clip(d / length, 0.0, 1.0)))


def _check(start: float, stop: float) -> None:
    if not stop > start:
        raise InputError(
            f"the master goes from {start:.9g} to {stop:.9g}: places must increase, and a file hold one cam"
        )
