"""CODESYS CamBuilder: cams of exact polynomials to degree 7, built by the program itself."""

from __future__ import annotations

from optlaws.exports.controllers.polynomials_of import fields, iec_heading, polynomials_for
from optlaws.exports.format import Format, Request, Written, register
from optlaws.exports.identifiers import iec_name
from optlaws.motion.motion import Motion

DEGREE = 7
MOST = 32_767  # nElements of MC_CAM_REF is an INT


def _write(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "CODESYS")
    fit = polynomials_for(motion, request, DEGREE, MOST)
    run, count = fit.run, fit.count
    notes = (
        fit.in_words(motion.units.slave),
        f"the library's parameter MAX_CAM_SEGMENT_COUNT must be at least {count}",
        "library SM3_CamBuilder, namespace SMCB, of SoftMotion 4.17 or later",
    )
    segments = [
        f"    camBuilder.Append(SMCB.Poly7_Coeffs({_coefficients(low, high, row)}));"
        for low, high, row in zip(run.breaks, run.breaks[1:], run.coefficients, strict=False)
    ]
    text = "\n".join(
        [
            iec_heading(f"{name}: a cam for the CamBuilder of CODESYS SoftMotion", motion, run, notes)
            + f"FUNCTION_BLOCK {name}",
            "VAR_OUTPUT",
            "    camRef : MC_CAM_REF;",
            "END_VAR",
            "VAR",
            "    camBuilder : SMCB.CamBuilder;",
            f"    segments : ARRAY[1..{count}] OF SMC_CAM_SEGMENT;",
            "    built : BOOL := FALSE;",
            "END_VAR",
            "IF NOT built THEN",
            "    camBuilder.Init();",
            *segments,
            "    SMCB.InitCamRef(camRef, ADR(segments), XSIZEOF(segments));",
            "    camBuilder.Write(camRef);",
            "    built := TRUE;",
            "END_IF",
            "END_FUNCTION_BLOCK",
            "",
        ]
    )
    return Written(text, run, "exact polynomials of degree 7", count, "segments", notes=notes)


def _coefficients(low: float, high: float, row: tuple[float, ...]) -> str:
    powers = [*row, *[0.0] * (DEGREE + 1 - len(row))]
    return fields(x0=low, x1=high, **{f"a{n}": c for n, c in enumerate(powers)})


CAM_BUILDER = register(
    Format(
        name="codesys-cambuilder",
        target="CODESYS SoftMotion, Poly7_Coeffs of CamBuilder",
        contents="x0, x1, a0 ... a7 (LREAL)",
        model="exact polynomials of degree 7",
        limits=f"degree 7, at most {MOST} segments (nElements is an INT), MAX_CAM_SEGMENT_COUNT of the library",
        extension=".st",
        write=_write,
    )
)
