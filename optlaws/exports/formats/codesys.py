"""CODESYS SoftMotion: cams of points (XYVA, XY), and of exact polynomials to degree 7 (CamBuilder)."""

from __future__ import annotations

from optlaws.exports.format import Request, Written, file_format
from optlaws.exports.point_tables import chosen_table
from optlaws.exports.polynomial_pieces import iec_heading, polynomials_for
from optlaws.exports.text import fields, filled, iec_comment, iec_name, real, table_heading, template
from optlaws.motion.motion import Motion

MOST = 32_767  # nElements is an INT
STANDARD = (128, 256)
INTERPOLATIONS = {"linear": 1, "cubic": 3}


@file_format(
    "codesys-xyva",
    target="CODESYS SoftMotion, SMC_CAMXYVA in MC_CAM_REF",
    contents="dX, dY, dV, dA (LREAL)",
    model="quintic Hermite",
    limits=f"at most {MOST} points (nElements is an INT)",
    extension=".st",
)
def _xyva(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "CODESYS")
    table = chosen_table(motion, request, "quintic", MOST)
    rows = [
        f"        ({fields(dX=x, dY=y, dV=v, dA=a)})"
        for x, (y, v, a) in zip(table.x.tolist(), table.values.T.tolist(), strict=True)
    ]
    count = len(rows)
    text = "\n".join(
        [
            iec_comment(table_heading(motion, "CODESYS SoftMotion, SMC_CAMXYVA")) + "VAR_GLOBAL",
            f"    {name}_points : ARRAY[0..{count - 1}] OF SMC_CAMXYVA := [",
            ",\n".join(rows) + "];",
            _reference(name, motion, "SMC_CAM_TYPE.XYVA", count),
            "END_VAR",
            f"(* in the program, once before MC_CamTableSelect: {name}.pce := ADR({name}_points); *)",
            "",
        ]
    )
    return table.written(text, "quintic Hermite from y, V and A of the points")


@file_format(
    "codesys-xy",
    target="CODESYS SoftMotion, SMC_CAMTable_LREAL_128_2 or _256_2 in MC_CAM_REF",
    contents="x, y (LREAL)",
    model="clamped C2 cubic spline, or straight lines",
    limits=f"at most {STANDARD[-1]} points, the larger of the library's tables",
    extension=".st",
    takes=("points", "counts", "interpolation"),
)
def _xy(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "CODESYS")
    interpolation = request.interpolation_among(INTERPOLATIONS)
    table = chosen_table(motion, request, interpolation, STANDARD[-1])
    count = len(table.x)
    size = next(standard for standard in STANDARD if standard >= count)
    rows = [f"[{real(x)}, {real(y)}]" for x, y in zip(table.x.tolist(), table.values[0].tolist(), strict=True)]
    last = [rows[-1]] * (size - count)
    extent = [table.x[0], table.x[-1], table.values[0].min(), table.values[0].max()]
    scaling = ", ".join(
        f"f{side}{name_of} := {real(float(value))}"
        for side in ("Editor", "Table")
        for name_of, value in zip(("MasterMin", "MasterMax", "SlaveMin", "SlaveMax"), extent, strict=True)
    )
    quality = f", byVarType := 6, byInterpolationQuality := {INTERPOLATIONS[interpolation]}"
    text = "\n".join(
        [
            iec_comment(table_heading(motion, f"CODESYS SoftMotion, SMC_CAMTable_LREAL_{size}_2")) + "VAR_GLOBAL",
            f"    {name}_table : SMC_CAMTable_LREAL_{size}_2 := (Table := [",
            ",\n".join(f"        {row}" for row in [*rows, *last]) + "],",
            f"        {scaling});",
            _reference(name, motion, "SMC_CAM_TYPE.XY", count, quality),
            "END_VAR",
            f"(* in the program, once before MC_CamTableSelect: {name}.pce := ADR({name}_table); *)",
            "",
        ]
    )
    model = {"linear": "straight lines", "cubic": "clamped C2 cubic spline"}[interpolation]
    return table.written(text, model)


def _reference(name: str, motion: Motion, kind: str, count: int, more: str = "") -> str:
    return (
        f"    {name} : MC_CAM_REF := (byType := {kind}, nElements := {count}, xStart := {real(motion.start)}, "
        f"xEnd := {real(motion.stop)}{more});"
    )


DEGREE = 7


@file_format(
    "codesys-cambuilder",
    target="CODESYS SoftMotion, Poly7_Coeffs of CamBuilder",
    contents="x0, x1, a0 ... a7 (LREAL)",
    model="exact polynomials of degree 7",
    limits=f"degree 7, at most {MOST} segments (nElements is an INT), MAX_CAM_SEGMENT_COUNT of the library",
    extension=".st",
)
def _cam_builder(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "CODESYS")
    fit = polynomials_for(motion, request, DEGREE, MOST)
    run, count = fit.run, fit.count
    notes = (
        fit.in_words(motion.units.slave),
        f"the library's parameter MAX_CAM_SEGMENT_COUNT must be at least {count}",
        "library SM3_CamBuilder, namespace SMCB, of SoftMotion 4.17 or later",
    )
    heading = iec_heading(f"{name}: a cam for the CamBuilder of CODESYS SoftMotion", motion, run, notes)
    segments = [
        fields(x0=low, x1=high, **{f"a{n}": c for n, c in enumerate([*row, *[0.0] * (DEGREE + 1 - len(row))])})
        for low, high, row in zip(run.breaks, run.breaks[1:], run.coefficients, strict=False)
    ]
    appended = [f"camBuilder.Append(SMCB.Poly7_Coeffs({segment}));" for segment in segments]
    words = {"HEADING": heading.splitlines()[1:-1], "NAME": name, "COUNT": count, "SEGMENTS": appended}
    text = filled(template("codesys.st"), words)
    return Written(text, run, "exact polynomials of degree 7", count, "segments", notes=notes)
