"""A motion as a function block of IEC 61131-3 in Structured Text: position and derivatives at a time or a master."""

from __future__ import annotations

from functools import partial

from optlaws.exports.error_bounds import DOUBLE, SINGLE, as_stored
from optlaws.exports.format import Request, Written, file_format
from optlaws.exports.formats.program_polynomials import (
    SOURCE_MODEL,
    SOURCE_PIECES,
    jumps_in_words,
    jumps_of_single,
    labels_of,
    source_polynomials,
)
from optlaws.exports.program_text import filled, st_array, template
from optlaws.exports.text import Labels, iec_name, program_heading, real, safe
from optlaws.files.writing import MARK
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion


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
        Units and notes for its program_heading.
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
    called = iec_name(name, "IEC 61131-3")
    arithmetic = SINGLE if single else DOUBLE
    run, kind = as_stored(motion, arithmetic), arithmetic.name
    lines = program_heading(motion, labels or Labels(), [arithmetic])
    words = {
        "NAME": called,
        "KIND": kind,
        "HEADING": safe([*lines, MARK]),
        "TABLES": [
            line
            for array, values in (("breaks", run.breaks), ("coefficients", run.powers().ravel().tolist()))
            for line in st_array(array, kind, [real(value, single=single) for value in values])
        ],
        "LAST": len(run.breaks) - 1,
        "LAST_PIECE": len(run.breaks) - 2,
        "DEGREE": run.degree,
        "WIDTH": run.degree + 1,
    }
    return filled(template("motion.st"), words)


def _write(motion: Motion, request: Request, *, single: bool) -> Written:
    fit, notes = source_polynomials(motion, request)
    text = function_block(fit.run, request.name, labels_of(motion, notes), single=single)
    if not single:
        return Written(text, fit.run, "polynomials in LREAL", fit.count, "segments", notes=notes)
    roundings = jumps_of_single(fit.run)
    notes = (*notes, jumps_in_words(motion, roundings))
    run = _single(fit.run)
    return Written(text, run, "polynomials in REAL", fit.count, "segments", notes=notes, roundings=roundings)


def _single(run: PiecewiseMotion) -> PiecewiseMotion:
    """The polynomials in REAL32 where the motion lies: its ends stay, which REAL32 may round."""
    stored = as_stored(run, SINGLE)
    return PiecewiseMotion((run.start, *stored.breaks[1:-1], run.stop), stored.coefficients)


file_format(
    "iec-st",
    target="IEC 61131-3, a function block in Structured Text",
    contents="breaks and coefficients (LREAL)",
    model=SOURCE_MODEL,
    limits=f"at most {SOURCE_PIECES} pieces",
    extension=".st",
)(partial(_write, single=False))
file_format(
    "iec-st-real",
    target="IEC 61131-3, a function block in Structured Text, in REAL",
    contents="breaks and coefficients (REAL)",
    model=f"{SOURCE_MODEL}, in REAL32",
    limits=f"at most {SOURCE_PIECES} pieces, REAL32",
    extension=".st",
)(partial(_write, single=True))
