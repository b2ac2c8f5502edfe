"""TwinCAT: position tables for MC_CamTableSelect, interpolated as the coupling says."""

from __future__ import annotations

from optlaws.errors import InputError
from optlaws.exports.code.literals import real
from optlaws.exports.format import MOST_POINTS, Format, Request, Written, register
from optlaws.exports.identifiers import iec_name
from optlaws.exports.spacing import chosen
from optlaws.exports.tables.table import NumberFormat, PointTable, linear_table, spline_table
from optlaws.exports.tables.text_lines import heading, iec_comment
from optlaws.motion.motion import Motion

INTERPOLATIONS = {"linear": "MC_INTERPOLATIONTYPE_LINEAR", "spline": "MC_INTERPOLATIONTYPE_SPLINE"}


def _write(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "TwinCAT")
    interpolation = request.interpolation or "spline"
    if interpolation not in INTERPOLATIONS:
        raise InputError(f"interpolation must be one of {', '.join(INTERPOLATIONS)}, got {interpolation!r}")
    cyclic = motion.repeats and abs(motion.advance) <= 1e-9 * motion.stroke

    def make(count: int) -> PointTable:
        number_format = NumberFormat(request.counts)
        if interpolation == "linear":
            return linear_table(motion, count, number_format)
        return spline_table(motion, count, number_format, ends="periodic" if cyclic else "clamped")

    table = chosen(motion, request, make, least=2, most=MOST_POINTS)
    text = _text(name, motion, table, INTERPOLATIONS[interpolation])
    model = (
        "straight lines" if interpolation == "linear" else f"C2 cubic spline, {'cyclic' if cyclic else 'tangential'}"
    )
    return Written(text, table.run, model, len(table.x), resolution=table.resolution, bound=table.bound)


def _text(name: str, motion: Motion, table: PointTable, interpolation: str) -> str:
    count = len(table.x)
    kind = f"TableType := MC_TABLETYPE_NONEQUIDISTANT, NoOfRows := {count}, NoOfColumns := 2"
    rows = [f"        {real(x)}, {real(y)}" for x, y in zip(table.x, table.values[0], strict=True)]
    return "\n".join(
        [
            iec_comment(heading(motion, "TwinCAT, table of positions")) + "VAR_GLOBAL",
            f"    {name}_table : ARRAY[1..{count}, 1..2] OF LREAL := [",
            ",\n".join(rows) + "];",
            f"    {name} : MC_CAM_REF := (ArraySize := SIZEOF({name}_table), {kind});",
            "END_VAR",
            f"(* in the program, before MC_CamTableSelect: {name}.pArray := ADR({name}_table);",
            f"   for MC_CamIn: Options.InterpolationType := {interpolation}; its default is linear *)",
            "",
        ]
    )


TABLE = register(
    Format(
        name="twincat-table",
        target="TwinCAT NC, table of positions in MC_CAM_REF",
        contents="master, slave (LREAL)",
        model="C2 cubic spline, cyclic or tangential, or straight lines",
        limits="no number of points is stated",
        extension=".st",
        write=_write,
        takes=("points", "counts", "interpolation"),
    )
)
