"""Cams of PLCs, in languages of IEC 61131-3: B&R, CODESYS, Rockwell, Siemens and TwinCAT; points and polynomials."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from fractions import Fraction
from functools import partial

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.error_bounds import SINGLE, as_stored
from optlaws.exports.format import MOST_POINTS, Request, Written, file_format
from optlaws.exports.point_tables import NumberFormat, PointTable, chosen_table, end_slopes, is_cyclic
from optlaws.exports.polynomial_pieces import (
    Ends,
    Fitted,
    ends_of,
    iec_heading,
    jumping,
    jumps_of_single,
    polynomials_for,
    refuse_jumps,
)
from optlaws.exports.text import fields, filled, iec_comment, iec_name, real, st_records, table_heading, template
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numbers import Array
from optlaws.numerics.splines import hermite_powers

_WHOLE_NUMBER = 1e-6  # a number of a controller so near to a whole one is meant to be whole

_cam = partial(file_format, extension=".st")


def _variables(heading: str, lines: Sequence[str], *after: str, kind: str = "VAR_GLOBAL") -> str:
    """Declarations of variables behind a comment, and what follows them."""
    return "\n".join([f"{heading}{kind}", *lines, "END_VAR", *after, ""])


def _at_points(motion: Motion, run: PiecewiseMotion, orders: int) -> Array:
    """The derivatives below an order at the points that polynomials share, a row for each."""
    ends = ends_of(motion, run, orders)
    return np.array([*(end.first for end in ends), ends[-1].last]).T


# B&R ACP10: cam profiles of REAL32 polynomials to degree 6 over whole-number periods (MC_CAMPROFILE_TYP)

_BR_DEGREE, _BR_MOST = 6, 64
_BR_LARGEST = 2**31 - 1
_BR_CLOSES = 0.1  # warning 37111 of the drive begins there
_BR_LETTERS = "abcdefgx"


@_cam(
    "br-acp10",
    target="B&R ACP10, MC_CAMPROFILE_TYP",
    contents="MasterPeriod, SlavePeriod (DINT), PolynomialNumber, a ... g, x (REAL32)",
    model="REAL32 polynomials to degree 6",
    limits=f"at most {_BR_MOST} polynomials, whole-number periods, REAL32, the first begins at 0 (error 5304)",
    extension=".var",
    takes=("points", "counts"),
)
def _br(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "B&R")
    scale = 1.0 if request.counts is None else request.counts / motion.stroke
    master = _br_period(motion.length, "master", motion.units.master, least=1)
    slave = _br_period(scale * motion.advance, "slave", motion.units.slave, least=-_BR_LARGEST)
    fit = polynomials_for(motion, request, _BR_DEGREE, _BR_MOST)
    profile = _br_profile(fit.run, scale, master, slave)
    roundings, rounded = jumps_of_single(motion, fit.run)
    # the motion that the drive runs, where the exact one lies and in its units
    powers = [[c / scale for c in row] for row in profile.coefficients]
    for row in powers:
        row[0] += fit.run.coefficients[0][0]
    run = PiecewiseMotion([*(x + fit.run.start for x in profile.breaks[:-1]), fit.run.stop], powers)
    notes = (
        fit.in_words(motion.units.slave),
        rounded,
        "powers of each polynomial count from where it begins, x is where it ends: compare a point before use",
        *(() if request.counts is None else (f"slave in increments, {request.counts} over the stroke",)),
    )
    rows = [
        ", ".join(
            f"{letter} := {real(number, single=True)}"
            for letter, number in zip(_BR_LETTERS, (*row, *[0.0] * (_BR_DEGREE + 1 - len(row)), x), strict=True)
        )
        for row, x in zip(profile.coefficients, profile.breaks[1:], strict=True)
    ]
    head = f"MasterPeriod := {master}, SlavePeriod := {slave}, PolynomialNumber := {len(rows)}"
    lines = [
        f"    {name} : MC_CAMPROFILE_TYP := ({head}, PolynomialData := [",
        ",\n".join(f"        ({row})" for row in rows) + "]);",
    ]
    heading = iec_heading(f"{name}: a cam profile for B&R ACP10, MC_CAMPROFILE_TYP", motion, run, notes)
    text, model = _variables(heading, lines, kind="VAR"), "REAL32 polynomials to degree 6"
    return Written(text, run, model, len(rows), "segments", notes=notes, roundings=roundings)


def _br_period(value: float, of: str, unit: str, least: int) -> int:
    whole = round(value)
    if abs(value - whole) > _WHOLE_NUMBER * max(1.0, abs(value)) or not least <= whole <= _BR_LARGEST:
        remedies = {"master": "master='360 deg'", "slave": "another unit or stroke, or counts=..."}
        raise InputError(
            f"B&R takes whole-number periods (DINT), and that of the {of} is {value:.9g} {unit}: choose {remedies[of]}"
        )
    return whole


def _br_profile(run: PiecewiseMotion, scale: float, master: int, slave: int) -> PiecewiseMotion:
    """The polynomials from 0 to the master's period in REAL32, the first from 0; the drive's checks pass."""
    first = Fraction(run.coefficients[0][0])
    rows = [[Fraction(c) * Fraction(scale) for c in row] for row in run.coefficients]
    for row in rows:
        row[0] -= first * Fraction(scale)
    breaks = [float(Fraction(x) - Fraction(run.start)) for x in run.breaks[:-1]] + [float(master)]
    stored = as_stored(PiecewiseMotion(breaks, [[float(c) for c in row] for row in rows]), SINGLE)
    off = abs(float(stored.ends(0)[1][-1]) - slave)
    if off > _BR_CLOSES:
        raise InputError(
            f"in REAL32 the last polynomial ends {off:.3g} beside the slave's period {slave}, which the drive refuses "
            f"(5304, 37111: at most {_BR_CLOSES}): take fewer counts, a larger unit, or more pieces"
        )
    return stored


# CODESYS SoftMotion: cams of points (XYVA, XY), and of exact polynomials to degree 7 (CamBuilder)

_CODESYS_MOST = 32_767  # nElements is an INT
_CODESYS_TABLES = (128, 256)
_CODESYS_QUALITY = {"linear": 1, "cubic": 3}
_CODESYS_DEGREE = 7


@_cam(
    "codesys-xyva",
    target="CODESYS SoftMotion, SMC_CAMXYVA in MC_CAM_REF",
    contents="dX, dY, dV, dA (LREAL)",
    model="quintic Hermite",
    limits=f"at most {_CODESYS_MOST} points (nElements is an INT)",
)
def _codesys_xyva(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "CODESYS")
    table = chosen_table(motion, request, "quintic", _CODESYS_MOST)
    rows = [
        f"        ({fields(dX=x, dY=y, dV=v, dA=a)})"
        for x, (y, v, a) in zip(table.x.tolist(), table.values.T.tolist(), strict=True)
    ]
    lines = [f"    {name}_points : ARRAY[0..{len(rows) - 1}] OF SMC_CAMXYVA := [", ",\n".join(rows) + "];"]
    text = _codesys_cam(name, motion, lines, "points", "SMC_CAMXYVA", f"SMC_CAM_TYPE.XYVA, nElements := {len(rows)}")
    return table.written(text, "quintic Hermite from y, V and A of the points")


@_cam(
    "codesys-xy",
    target="CODESYS SoftMotion, SMC_CAMTable_LREAL_128_2 or _256_2 in MC_CAM_REF",
    contents="x, y (LREAL)",
    model="clamped C2 cubic spline, or straight lines",
    limits=f"at most {_CODESYS_TABLES[-1]} points, the larger of the library's tables",
    takes=("points", "counts", "interpolation"),
)
def _codesys_xy(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "CODESYS")
    interpolation = request.interpolation_among(_CODESYS_QUALITY)
    table = chosen_table(motion, request, interpolation, _CODESYS_TABLES[-1])
    count = len(table.x)
    kind = f"SMC_CAMTable_LREAL_{next(size for size in _CODESYS_TABLES if size >= count)}_2"
    rows = [f"[{real(x)}, {real(y)}]" for x, y in zip(table.x.tolist(), table.values[0].tolist(), strict=True)]
    last = [rows[-1]] * (next(size for size in _CODESYS_TABLES if size >= count) - count)
    extent = [table.x[0], table.x[-1], table.values[0].min(), table.values[0].max()]
    scaling = ", ".join(
        f"f{side}{name_of} := {real(float(value))}"
        for side in ("Editor", "Table")
        for name_of, value in zip(("MasterMin", "MasterMax", "SlaveMin", "SlaveMax"), extent, strict=True)
    )
    lines = [
        f"    {name}_table : {kind} := (Table := [",
        ",\n".join(f"        {row}" for row in [*rows, *last]) + "],",
        f"        {scaling});",
    ]
    quality = f", byVarType := 6, byInterpolationQuality := {_CODESYS_QUALITY[interpolation]}"
    text = _codesys_cam(name, motion, lines, "table", kind, f"SMC_CAM_TYPE.XY, nElements := {count}", quality)
    return table.written(text, {"linear": "straight lines", "cubic": "clamped C2 cubic spline"}[interpolation])


def _codesys_cam(
    name: str, motion: Motion, lines: Sequence[str], array: str, kind: str, entries: str, more: str = ""
) -> str:
    """The variables of a cam of points, with the reference to them."""
    ends = f"xStart := {real(motion.start)}, xEnd := {real(motion.stop)}"
    return _variables(
        iec_comment(table_heading(motion, f"CODESYS SoftMotion, {kind}")),
        [*lines, f"    {name} : MC_CAM_REF := (byType := {entries}, {ends}{more});"],
        f"(* in the program, once before MC_CamTableSelect: {name}.pce := ADR({name}_{array}); *)",
    )


@_cam(
    "codesys-cambuilder",
    target="CODESYS SoftMotion, Poly7_Coeffs of CamBuilder",
    contents="x0, x1, a0 ... a7 (LREAL)",
    model="exact polynomials of degree 7",
    limits=f"degree 7, at most {_CODESYS_MOST} segments (nElements is an INT), MAX_CAM_SEGMENT_COUNT of the library",
)
def _codesys_polynomials(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "CODESYS")
    fit = polynomials_for(motion, request, _CODESYS_DEGREE, _CODESYS_MOST)
    run, count = fit.run, fit.count
    notes = (
        fit.in_words(motion.units.slave),
        f"the library's parameter MAX_CAM_SEGMENT_COUNT must be at least {count}",
        "library SM3_CamBuilder, namespace SMCB, of SoftMotion 4.17 or later",
    )
    heading = iec_heading(f"{name}: a cam for the CamBuilder of CODESYS SoftMotion", motion, run, notes)
    appended = []
    for low, high, row in zip(run.breaks, run.breaks[1:], run.coefficients, strict=False):
        powers = {f"a{n}": c for n, c in enumerate([*row, *[0.0] * (_CODESYS_DEGREE + 1 - len(row))])}
        appended.append(f"camBuilder.Append(SMCB.Poly7_Coeffs({fields(x0=low, x1=high, **powers)}));")
    words = {"HEADING": heading.splitlines()[1:-1], "NAME": name, "COUNT": count, "SEGMENTS": appended}
    text = filled(template("codesys.st"), words)
    return Written(text, run, "exact polynomials of degree 7", count, "segments", notes=notes)


# Rockwell Logix: arrays of CAM and CAM_EXTENDED for MCCP, and rows of CAM_PROFILE as it computes them

_LOGIX_TYPES = ("linear", "cubic")  # by their codes
_LOGIX_CALCULATED = 2  # Status of an element of CAM_PROFILE
_LOGIX_CUBIC = "C2 cubic spline clamped to StartSlope and EndSlope"
_logix = partial(
    _cam,
    model=f"{_LOGIX_CUBIC}, or straight lines",
    limits="no number of points is stated",
    takes=("points", "counts", "digits", "interpolation"),
)
_HALVES = struct.Struct(">ii")
_DOUBLE = struct.Struct(">d")


def profile_rows(run: PiecewiseMotion, *, cubic: bool = True) -> list[list[int]]:
    """The elements of CAM_PROFILE for a motion of cubics: 14 DINT each, halves of doubles, the upper one first.

    Status, X, Y, segment type, C0, C1, C2, C3: y = Y + C1 d + C2 d² + C3 d³ with d = x - X. The last element is the
    last point alone.
    """
    rows = [*zip(run.breaks, run.coefficients, strict=False), (run.stop, (float(run.ends(0)[1][-1]),))]
    return [
        [_LOGIX_CALCULATED, *_halves(x, y), int(cubic), *_halves(0.0, *(*slopes, 0.0, 0.0, 0.0)[:3])]
        for x, (y, *slopes) in rows
    ]


def _halves(*values: float) -> list[int]:
    return [half for value in values for half in _HALVES.unpack(_DOUBLE.pack(value + 0.0))]


def _logix_table(motion: Motion, request: Request, *, single: bool) -> tuple[str, PointTable, bool]:
    """The name and the table, and whether it is of cubics."""
    name, interpolation = iec_name(request.name, "Logix"), request.interpolation_among(_LOGIX_TYPES)
    return name, chosen_table(motion, request, interpolation, MOST_POINTS, single=single), interpolation == "cubic"


def _logix_array(motion: Motion, request: Request, *, single: bool) -> Written:
    name, table, cubic = _logix_table(motion, request, single=single)
    start, end = (real(slope, single=single) for slope in end_slopes(motion, NumberFormat(single=single)).tolist())
    rows = [
        f"{name}[{i}].Master := {real(x, single=single)}; {name}[{i}].Slave := {real(y, single=single)}; "
        f"{name}[{i}].SegmentType := {int(cubic)};"
        for i, (x, y) in enumerate(zip(table.x.tolist(), table.values[0].tolist(), strict=True))
    ]
    structure = "CAM" if single else "CAM_EXTENDED"
    slopes = f"MCCP: StartSlope = {start}, EndSlope = {end}"
    heading = table_heading(motion, f"Rockwell Logix, {structure}")
    text = iec_comment((f"tag {name} : {structure}[{len(rows)}]", slopes, *heading)) + "\n".join([*rows, ""])
    return table.written(text, _LOGIX_CUBIC if cubic else "straight lines", (slopes,))


@_logix(
    "rockwell-cam-profile",
    target="Rockwell Logix, rows of CAM_PROFILE as in L5K and L5X",
    contents="Status, X, Y, type, C0 to C3 as 14 DINT",
    extension=".txt",
)
def _logix_profile(motion: Motion, request: Request) -> Written:
    name, table, cubic = _logix_table(motion, request, single=False)
    data = ",\n".join(f"  [{','.join(map(str, row))}]" for row in profile_rows(table.run, cubic=cubic))
    text = iec_comment(table_heading(motion, "Rockwell Logix, elements of CAM_PROFILE")) + f"{name} := [\n{data}\n];\n"
    return table.written(text, _LOGIX_CUBIC if cubic else "straight lines")


_logix(
    "rockwell-cam",
    target="Rockwell Logix, array of CAM for MCCP",
    contents="Master, Slave (REAL), SegmentType",
    limits="REAL32; no number of points is stated",
)(partial(_logix_array, single=True))
_logix(
    "rockwell-cam-extended",
    target="Rockwell Logix 5380, 5480, 5580, array of CAM_EXTENDED for MCCP",
    contents="Master, Slave (LREAL), SegmentType",
)(partial(_logix_array, single=False))


# Siemens S7-1500T: points and elements of the library LCamHdl, which fill the technology object TO_Cam

_TO_SEGMENTS = 50
_TO_REMEDY = "take siemens-elements, whose elements have ends of their own, or a smoother law"
#: codes of LCamHdl_ProfileConstants; an element of each takes one segment of the TO
_DWELL, _CONST_VELO, _POLY_5, _ADD_POLY = 2, 3, 5, 44
#: the mode is LCAMHDL_POLY_MODE_BOUNDARY_VALUES_AND_START_JERK
_BY_START_JERK = {"camProfileType": _ADD_POLY, "polynomialMode": 1}


def _siemens_elements(motion: Motion, request: Request, *, degree: int, kind: str, model: str) -> Written:
    name = iec_name(request.name, "SIMATIC AX")
    fit = polynomials_for(motion, request, degree, _TO_SEGMENTS)
    ends = ends_of(motion, fit.run, 3 if degree == 5 else 4)
    run = PiecewiseMotion(fit.run.breaks, [_quintic(end) if degree == 5 else _sixth(end) for end in ends])
    rows = [
        fields(**_bounds(end), **(_profile(row) if degree == 5 else {"geoJerkStart": end.first[3], **_BY_START_JERK}))
        for end, row in zip(ends, fit.run.coefficients, strict=True)
    ]
    text, notes = _siemens_file(name, kind, rows, motion, (run, fit))
    return Written(text, run, model, len(rows), "segments", notes=notes)


_cam(
    "siemens-elements",
    target="Siemens S7-1500T, LCamHdl_typeAdvancedElement of LCamHdl_CreateCamAdvanced",
    contents="leading and following values, geoVelo and geoAccel at both ends (LREAL), camProfileType",
    model="quintic polynomials, straight lines, dwells",
    limits=f"at most {_TO_SEGMENTS} segments in a TO_Cam; degree 5 (POLY_7 takes two segments of degree 6: not used)",
)(partial(_siemens_elements, degree=5, kind="LCamHdl_typeAdvancedElement", model="quintic polynomials by their ends"))
_cam(
    "siemens-polynomials",
    target="Siemens S7-1500T, LCamHdl_typePolynomialElement of LCamHdl_AddCamPolynomial",
    contents="leading and following values, geoVelo and geoAccel at both ends, geoJerkStart (LREAL), polynomialMode 1",
    model="exact polynomials of degree 6",
    limits=f"at most {_TO_SEGMENTS} segments in a TO_Cam, degree 6",
)(
    partial(
        _siemens_elements,
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
    return {"camProfileType": _POLY_5 if degree > 1 else (_DWELL, _CONST_VELO)[degree]}


def _quintic(ends: Ends) -> list[float]:
    """The quintic with the values of both ends."""
    return list(hermite_powers(np.array(ends.x), np.array([ends.first[:3], ends.last[:3]]).T)[0].tolist())


def _sixth(ends: Ends) -> list[float]:
    """The quintic through the end values plus a multiple of u³ (1 - u)³ that matches the jerk at the start."""
    quintic, length = _quintic(ends), ends.x[1] - ends.x[0]
    share = ends.first[3] / 6.0 - quintic[3]
    bump = {3: share, 4: -3.0 * share / length, 5: 3.0 * share / length**2, 6: -share / length**3}
    return [c + bump.get(n, 0.0) for n, c in enumerate([*quintic, 0.0])]


@_cam(
    "siemens-points",
    target="Siemens S7-1500T, LCamHdl_typeBasicPoint of LCamHdl_CreateCamBasic",
    contents="leadingValue, followingValue, velocityRatio, accelerationRatio (LREAL)",
    model="quintic polynomials",
    limits=f"at most {_TO_SEGMENTS + 1} points, which make the {_TO_SEGMENTS} segments of a TO_Cam",
)
def _siemens_points(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "SIMATIC AX")
    fit = polynomials_for(motion, request, 5, _TO_SEGMENTS, points=True)
    refuse_jumps(motion, fit.run, "a basic point", _TO_REMEDY)
    values = _at_points(motion, fit.run, 3)
    run = PiecewiseMotion(fit.run.breaks, hermite_powers(np.array(fit.run.breaks), values))
    rows = [
        fields(leadingValue=x, followingValue=y, velocityRatio=v, accelerationRatio=a)
        for x, (y, v, a) in zip(run.breaks, values.T.tolist(), strict=True)
    ]
    text, notes = _siemens_file(name, "LCamHdl_typeBasicPoint", rows, motion, (run, fit))
    return Written(text, run, "quintic polynomials between points", len(rows), notes=notes)


def _siemens_file(
    name: str, kind: str, rows: Sequence[str], motion: Motion, run_and_fit: tuple[PiecewiseMotion, Fitted]
) -> tuple[str, tuple[str, ...]]:
    run, fit = run_and_fit
    notes = (
        fit.in_words(motion.units.slave),
        f"{fit.count} of the {_TO_SEGMENTS} segments of the TO",
        "a source of SIMATIC AX; in TIA Portal the rows are start values of an array of this type in a data block",
    )
    heading = iec_heading(f"{name}: a cam for LCamHdl and a TO_Cam of the S7-1500T, {kind}", motion, run, notes)
    opening = f"{heading}USING Simatic.Ax.LCamHdl;\nCONFIGURATION {name}_configuration\n    VAR_GLOBAL"
    records = st_records(name, kind, rows, "        ")
    return "\n".join([opening, *records, "    END_VAR", "END_CONFIGURATION", ""]), notes


# TwinCAT: tables of positions, and motion functions of points with polynomials of degree 5 and 7 between them

_TWINCAT_QUALITY = {"linear": "MC_INTERPOLATIONTYPE_LINEAR", "spline": "MC_INTERPOLATIONTYPE_SPLINE"}


@_cam(
    "twincat-table",
    target="TwinCAT NC, table of positions in MC_CAM_REF",
    contents="master, slave (LREAL)",
    model="C2 cubic spline, cyclic or tangential, or straight lines",
    limits="no number of points is stated",
    takes=("points", "counts", "interpolation"),
)
def _twincat_table(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "TwinCAT")
    interpolation = request.interpolation_among(_TWINCAT_QUALITY, "spline")
    cyclic, kind = is_cyclic(motion), {"linear": "linear", "spline": "cubic"}[interpolation]
    table = chosen_table(motion, request, kind, MOST_POINTS, ends="periodic" if cyclic else "clamped")
    count, spline = len(table.x), f"C2 cubic spline, {'cyclic' if cyclic else 'tangential'}"
    entries = f"TableType := MC_TABLETYPE_NONEQUIDISTANT, NoOfRows := {count}, NoOfColumns := 2"
    rows = [f"        {real(x)}, {real(y)}" for x, y in zip(table.x, table.values[0], strict=True)]
    quality = _TWINCAT_QUALITY[interpolation]
    text = _variables(
        iec_comment(table_heading(motion, "TwinCAT, table of positions")),
        [
            f"    {name}_table : ARRAY[1..{count}, 1..2] OF LREAL := [",
            ",\n".join(rows) + "];",
            f"    {name} : MC_CAM_REF := (ArraySize := SIZEOF({name}_table), {entries});",
        ],
        f"(* in the program, before MC_CamTableSelect: {name}.pArray := ADR({name}_table);",
        f"   for MC_CamIn: Options.InterpolationType := {quality}; its default is linear *)",
    )
    return table.written(text, "straight lines" if interpolation == "linear" else spline)


_TWINCAT_DEGREE = 7
#: by the degree of the polynomial: names in MC_MotionFunctionType and in EMotionFunctionType
_FUNCTIONS = {5: ("MOTIONFUNCTYPE_POLYNOM5_MM", "Polynomial5"), 7: ("MOTIONFUNCTYPE_POLYNOM7_MM", "Polynomial7")}
_TWINCAT_REMEDY = "take a smoother law, or a format whose pieces have ends of their own, such as codesys-cambuilder"
_LAST = ("MOTIONFUNCTYPE_NOTDEF", "Undefined")
_NC2 = ("MasterPos", "SlavePos", "SlaveVelo", "SlaveAcc", "SlaveJerk")
_MC3 = ("MasterPosition", "SlavePosition", "SlaveVelocity", "SlaveAcceleration", "SlaveJerk")


def _twincat_function(motion: Motion, request: Request, *, third: bool) -> Written:
    name = iec_name(request.name, "TwinCAT")
    # neighbours share a point's entries: velocity, acceleration, and the jerk where it is used
    fit = polynomials_for(motion, request, _TWINCAT_DEGREE, MOST_POINTS - 1, points=True)
    refuse_jumps(motion, fit.run, "a point of TwinCAT", _TWINCAT_REMEDY)
    if fit.run.degree > 5 and jumping(fit.run, 3) is not None:
        fit = polynomials_for(motion, request, 5, MOST_POINTS - 1, points=True)
    degrees = [5 if len(row) <= 6 or not any(row[6:]) else 7 for row in fit.run.coefficients]
    values = _at_points(motion, fit.run, 4)
    by_degree = {n: hermite_powers(np.array(fit.run.breaks), values[: (n + 1) // 2]).tolist() for n in _FUNCTIONS}
    run = PiecewiseMotion(fit.run.breaks, [by_degree[degree][i] for i, degree in enumerate(degrees)])
    rows = [
        _twincat_point(i + 1, (x, *values[:, i].tolist()), degree, third=third)
        for i, (x, degree) in enumerate(zip(fit.run.breaks, [*degrees, 0], strict=True))
    ]
    kind = "MotionFunctionPoint" if third else "MC_MotionFunctionPoint"
    notes = (fit.in_words(motion.units.slave),)
    heading = iec_heading(f"{name}: a motion function for TwinCAT, {kind}", motion, run, notes)
    model = "Hermite polynomials of degree 5 and 7" if 7 in degrees else "Hermite polynomials of degree 5"
    return Written(_variables(heading, st_records(name, kind, rows)), run, model, len(rows), notes=notes)


def _twincat_point(place: int, numbers: tuple[float, ...], degree: int, *, third: bool) -> str:
    """A point from the master's position, y, V, A and J, and the degree of the polynomial after it, 0 at the end."""
    function = _FUNCTIONS.get(degree, _LAST)[third]
    if third:
        return fields(FunctionType=f"EMotionFunctionType.{function}", **dict(zip(_MC3, numbers, strict=True)))
    return fields(
        PointIndex=place,
        FunctionType=function,
        PointType="MOTIONPOINTTYPE_MOTION",
        RelIndexNextPoint=1 if degree else 0,
        **dict(zip(_NC2, numbers, strict=True)),
    )


_twincat = partial(
    _cam,
    model="Hermite polynomials of degree 5 or 7, by FunctionType",
    limits="one velocity, acceleration and jerk at each point; pieces of degree 7 at most",
)
_twincat(
    "twincat-nc2",
    target="TwinCAT NC2 camming, motion function of MC_MotionFunctionPoint",
    contents="PointIndex, FunctionType, PointType, RelIndexNextPoint, MasterPos, SlavePos, SlaveVelo, SlaveAcc, "
    "SlaveJerk (LREAL)",
)(partial(_twincat_function, third=False))
_twincat(
    "twincat-mc3",
    target="TwinCAT MC3 camming, MotionFunctionPoint",
    contents="FunctionType, MasterPosition, SlavePosition, SlaveVelocity, SlaveAcceleration, SlaveJerk (LREAL)",
)(partial(_twincat_function, third=True))
