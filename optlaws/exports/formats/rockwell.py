"""Rockwell Logix: arrays of CAM and CAM_EXTENDED for MCCP, and rows of CAM_PROFILE as it computes them."""

from __future__ import annotations

import struct
from functools import partial

from optlaws.exports.format import MOST_POINTS, Request, Written, file_format
from optlaws.exports.point_tables import NumberFormat, PointTable, chosen_table, end_slopes
from optlaws.exports.text import iec_comment, iec_name, real, table_heading
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion

SEGMENT_TYPES = ("linear", "cubic")  # by their codes
CALCULATED = 2  # Status of an element of CAM_PROFILE
_CUBIC = "C2 cubic spline clamped to StartSlope and EndSlope"
_logix = partial(
    file_format,
    model=f"{_CUBIC}, or straight lines",
    limits="no number of points is stated",
    extension=".st",
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
        [CALCULATED, *_halves(x, y), int(cubic), *_halves(0.0, *(*slopes, 0.0, 0.0, 0.0)[:3])]
        for x, (y, *slopes) in rows
    ]


def _halves(*values: float) -> list[int]:
    return [half for value in values for half in _HALVES.unpack(_DOUBLE.pack(value + 0.0))]


def _table(motion: Motion, request: Request, *, single: bool) -> tuple[PointTable, bool]:
    """The table, and whether it is of cubics."""
    interpolation = request.interpolation_among(SEGMENT_TYPES)
    return chosen_table(motion, request, interpolation, MOST_POINTS, single=single), interpolation == "cubic"


def _array(motion: Motion, request: Request, *, single: bool) -> Written:
    name = iec_name(request.name, "Logix")
    table, cubic = _table(motion, request, single=single)
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
    return table.written(text, _CUBIC if cubic else "straight lines", (slopes,))


@_logix(
    "rockwell-cam-profile",
    target="Rockwell Logix, rows of CAM_PROFILE as in L5K and L5X",
    contents="Status, X, Y, type, C0 to C3 as 14 DINT",
    extension=".txt",
)
def _profile(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "Logix")
    table, cubic = _table(motion, request, single=False)
    data = ",\n".join(f"  [{','.join(map(str, row))}]" for row in profile_rows(table.run, cubic=cubic))
    text = iec_comment(table_heading(motion, "Rockwell Logix, elements of CAM_PROFILE")) + f"{name} := [\n{data}\n];\n"
    return table.written(text, _CUBIC if cubic else "straight lines")


_logix(
    "rockwell-cam",
    target="Rockwell Logix, array of CAM for MCCP",
    contents="Master, Slave (REAL), SegmentType",
    limits="REAL32; no number of points is stated",
)(partial(_array, single=True))
_logix(
    "rockwell-cam-extended",
    target="Rockwell Logix 5380, 5480, 5580, array of CAM_EXTENDED for MCCP",
    contents="Master, Slave (LREAL), SegmentType",
)(partial(_array, single=False))
