"""A motion as a program: a C99 header, and a function block of IEC 61131-3 in Structured Text; errors are proven."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from optlaws.exports.error_bounds import DOUBLE, SINGLE, as_stored
from optlaws.exports.format import Request, Written, file_format
from optlaws.exports.polynomial_pieces import (
    exactly,
    jumps_of_single,
    labels_of,
    polynomials_for,
)
from optlaws.exports.text import (
    Labels,
    c_array,
    c_name,
    c_row,
    filled,
    iec_name,
    program_heading,
    real,
    safe,
    st_array,
    template,
)
from optlaws.files.writing import MARK
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion

_OFF = 1e-6  # of the acceleration's peak: how far polynomials may be off
#: the degree of polynomials for laws that are none, and of laws whose own polynomials are taken
_DEGREE, _OWN_DEGREE = 9, 40
_PIECES = 1000
_MODEL = f"the law's own polynomials to degree {_OWN_DEGREE}, else of degree {_DEGREE}"


def header(motion: PiecewiseMotion, name: str = "motion", labels: Labels | None = None) -> str:
    """The source of a C99 header that evaluates a motion, in double and in float.

    For the name "press" it holds `press_position(x)`, `press_velocity`, `press_acceleration`, `press_jerk` and
    `press_motion(x, values)` for all four at once, and the same in float with the ending `_f`; tables are constant,
    nothing is allocated and nothing included. In float, x and the breaks are what float holds of them.

    Parameters
    ----------
    motion
        The motion.
    name
        Before every name of the header.
    labels
        Units and notes for its heading.

    Raises
    ------
    InputError
        If the name is none in C, or a number is beyond float.

    Examples
    --------
    >>> source = header(PiecewiseMotion([0.0, 0.1], [[0.0, 0.0, 300.0, -2000.0]]), "press")
    >>> [line for line in source.splitlines() if "double press_position" in line]
    ['static inline double press_position(double x)']
    """
    called = c_name(name)
    lines = program_heading(motion, labels or Labels(), [DOUBLE, SINGLE])
    comment = "\n".join(f" * {line}".rstrip() for line in safe([*lines, "", MARK]))
    guard = f"OPTLAWS_{called.upper()}_H"
    parts = [
        f"/* {called}: a motion law.\n *\n{comment}\n */\n#ifndef {guard}\n#define {guard}\n",
        *(_functions(motion, called, single=single) for single in (False, True)),
        f"#endif /* {guard} */\n",
    ]
    return "\n".join(parts)


def _functions(motion: PiecewiseMotion, name: str, *, single: bool) -> str:
    """The tables and functions in one of the two floating-point types."""
    run, source = as_stored(motion, SINGLE if single else DOUBLE), template("motion.h")
    kind, f, suffix = ("float", "_f", "F") if single else ("double", "", "")
    if single:
        source = re.sub(r"\bname_\w+", r"\g<0>_f", source.replace("double", kind))
        source = re.sub(r"\b\d\.\d", r"\g<0>F", source)

    def numbers(values: Sequence[float]) -> list[str]:
        return [real(value, single=single) + suffix for value in values]

    tables = [
        *c_array(f"{kind} {name}_breaks{f}[{len(run.breaks)}]", numbers(run.breaks)),
        f"static const {kind} {name}_coefficients{f}[{len(run.breaks) - 1}][{run.degree + 1}] = {{",
        ",\n".join(c_row(numbers(row)) for row in run.powers().tolist()),
        "};",
    ]
    return filled(source, {**_sizes(run), "name": name, "TABLES": tables})


def function_block(
    motion: PiecewiseMotion, name: str = "FB_Motion", labels: Labels | None = None, *, single: bool = False
) -> str:
    """The source of a function block that evaluates a motion by Horner's scheme.

    Its output is position, velocity, acceleration and jerk at the input x; outside the motion x is brought to the
    nearer end, and `inside` says so. The piece is stored from call to call, so that a master that moves on costs one
    comparison. Nothing but arithmetic, arrays and loops is used, which every target of the standard has.

    Parameters
    ----------
    motion
        The motion.
    name
        Of the function block.
    labels
        Units and notes for its heading.
    single
        REAL in place of LREAL.

    Raises
    ------
    InputError
        If the name is none for a function block, or a number is beyond REAL.

    Examples
    --------
    >>> source = function_block(PiecewiseMotion([0.0, 0.1], [[0.0, 0.0, 300.0, -2000.0]]), "FB_Press")
    >>> [line for line in source.splitlines() if "coefficients :" in line]
    ['    coefficients : ARRAY[0..3] OF LREAL := [']
    """
    called, arithmetic = iec_name(name, "IEC 61131-3"), SINGLE if single else DOUBLE
    run = as_stored(motion, arithmetic)
    tables = [
        line
        for array, values in (("breaks", run.breaks), ("coefficients", run.powers().ravel().tolist()))
        for line in st_array(array, arithmetic.name, [real(value, single=single) for value in values])
    ]
    heading = safe([*program_heading(motion, labels or Labels(), [arithmetic]), MARK])
    words = {"NAME": called, "KIND": arithmetic.name, "HEADING": heading, "TABLES": tables, "WIDTH": run.degree + 1}
    return filled(template("motion.st"), {**_sizes(run), **words})


def _sizes(run: PiecewiseMotion) -> dict[str, object]:
    return {"LAST": len(run.breaks) - 1, "LAST_PIECE": len(run.breaks) - 2, "DEGREE": run.degree}


def _written(motion: Motion, request: Request, *, source: Callable[..., str], model: str) -> Written:
    """The law's own polynomials, cut where powers would lose digits, or approximations, as a program."""
    fit = None if request.points else exactly(motion, _OWN_DEGREE)
    fit = fit or polynomials_for(motion, request, _DEGREE, _PIECES, near=_OFF)
    notes = (fit.in_words(motion.units.slave),)
    text = source(fit.run, request.name, labels_of(motion, notes))
    return Written(text, fit.run, model, fit.count, "segments", notes=notes)


_program = partial(file_format, model=_MODEL, limits=f"at most {_PIECES} pieces", extension=".st")
_ST = "IEC 61131-3, a function block in Structured Text"

_program(
    "c99",
    target="C99, a header for double and float",
    contents="breaks and coefficients (double and float)",
    limits=f"at most {_PIECES} pieces, float for the functions with _f",
    extension=".h",
)(partial(_written, source=header, model="polynomials in double"))
_program("iec-st", target=_ST, contents="breaks and coefficients (LREAL)")(
    partial(_written, source=function_block, model="polynomials in LREAL")
)


@_program(
    "iec-st-real",
    target=f"{_ST}, in REAL",
    contents="breaks and coefficients (REAL)",
    model=f"{_MODEL}, in REAL32",
    limits=f"at most {_PIECES} pieces, REAL32",
)
def _real(motion: Motion, request: Request) -> Written:
    program = _written(motion, request, source=partial(function_block, single=True), model="polynomials in REAL")
    (roundings, words), stored = jumps_of_single(motion, program.run), as_stored(program.run, SINGLE)
    # the motion's own ends stay, which REAL32 may round
    run = PiecewiseMotion((program.run.start, *stored.breaks[1:-1], program.run.stop), stored.coefficients)
    return replace(program, run=run, notes=(*program.notes, words), roundings=roundings)
